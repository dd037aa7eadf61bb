//! Looking along straight lines through the scene: for shadows, and for the ground under a dot.

use super::camera::Lens;
use super::model::{Facet, Model, Role};
use glam::{Mat3, Vec2, Vec3, Vec3Swizzles};

/// The number of walls that are not worth a box each.
const LEAF: usize = 4;

/// From this depth on walls are halved, which leaves a tree that is no deeper than twice as much, however many there are.
const HALVING: usize = 48;

/// The deepest that a tree can be.
const DEPTH: usize = 2 * HALVING;

/// The triangles of a model.
///
/// Places and directions are given in view coordinates. Inside they are turned upright, because
/// most walls follow the axes of the world, and then their boxes fit tightly.
#[derive(Debug, Default)]
pub(super) struct Rays {
    upright: Mat3,
    /// Few and huge; boxes around them would hold everything.
    endless: Vec<Wall>,
    /// The others, sorted into a tree of boxes.
    solid: Vec<Wall>,
    nodes: Vec<Node>,
}

/// A triangle.
#[derive(Clone, Copy, Debug)]
struct Wall {
    corner: Vec3,
    sides: [Vec3; 2],
    flat: Vec3,
    opacity: f32,
}

/// A box around a run of walls. An inner node has no walls of its own; its first child follows it.
#[derive(Clone, Copy, Debug)]
struct Node {
    low: Vec3,
    high: Vec3,
    walls: (usize, usize),
    second_child: usize,
}

/// A place where a ray meets a wall.
#[derive(Clone, Copy, Debug)]
pub(super) struct Hit {
    pub(super) distance: f32,
    pub(super) normal: Vec3,
}

impl Rays {
    pub(super) fn new(model: &Model, lens: &Lens) -> Self {
        let upright = lens.turn.transpose();
        let walls = |role| {
            let facets = model.facets.iter().map(|facet| (facet, &model.skins[facet.skin]));
            let walls = facets.filter(move |(_, skin)| skin.role == role);
            walls.map(|(facet, skin)| Wall::new(facet, upright, skin.opacity)).collect()
        };
        let (endless, solid) = (walls(Role::Endless), walls(Role::Solid));
        let mut rays = Self { upright, endless, solid, nodes: Vec::new() };
        if !rays.solid.is_empty() {
            rays.sort(0, rays.solid.len(), 0);
        }
        rays
    }

    /// The first wall along a ray, if there is one within `reach`.
    pub(super) fn first(&self, from: Vec3, towards: Vec3, reach: f32) -> Option<Hit> {
        let mut packet = Packet::new(self.upright * from, [self.upright * towards], reach);
        let mut hit = None;
        let mut look = |wall: &Wall, packet: &mut Packet<1>| {
            let [distance] = wall.distances(packet);
            if distance < packet.reach[0] {
                packet.reach = [distance];
                hit = Some(Hit { distance, normal: self.upright.transpose() * wall.flat });
            }
        };
        self.endless.iter().for_each(|wall| look(wall, &mut packet));
        self.walk(packet, look);
        hit
    }

    /// The share of a lamp that can be seen from a place. The lamp is a round disc `reach` away whose
    /// radius is `width` times as much, looked at in a pattern that is turned by `turn`.
    ///
    /// Only walls entered from outside count. For solids that changes nothing, and a room may be
    /// lit by a lamp outside it, which is how people light the rooms they want to look into.
    pub(super) fn seen(&self, from: Vec3, towards: Vec3, width: f32, reach: f32, turn: f32) -> f32 {
        let (from, towards) = (self.upright * from, self.upright * towards);
        let (x, y) = towards.any_orthonormal_pair();
        let ray = |at: Vec2| towards + width * (at.x * x + at.y * y);
        // Four rays say whether this is the edge of a shadow; if so, ask more.
        let few = self.passing(Packet::new(from, spread::<4>(turn).map(ray), reach));
        if few == 0.0 || few == 1.0 {
            return few;
        }
        self.passing(Packet::new(from, spread::<24>(turn).map(ray), reach))
    }

    /// The share of light that gets through along some rays.
    fn passing<const N: usize>(&self, packet: Packet<N>) -> f32 {
        let mut passing = [1.0; N];
        self.walk(packet, |wall, packet| {
            if wall.flat.dot(packet.from - wall.corner) > 0.0 {
                let distances = wall.distances(packet);
                for at in 0..N {
                    passing[at] *= if distances[at] < packet.reach[at] { 1.0 - wall.opacity } else { 1.0 };
                    packet.reach[at] = if passing[at] > 0.0 { packet.reach[at] } else { -1.0 };
                }
            }
        });
        passing.iter().sum::<f32>() / N as f32
    }

    /// Visits the solid walls that rays may meet, in no particular order. The visitor may shorten the rays.
    fn walk<const N: usize>(&self, mut packet: Packet<N>, mut visit: impl FnMut(&Wall, &mut Packet<N>)) {
        // One child of each node waits; trees are no deeper than this.
        let mut open = [0; DEPTH + 2];
        let mut count = usize::from(!self.nodes.is_empty());
        while count > 0 {
            count -= 1;
            let at = open[count];
            let node = &self.nodes[at];
            if !packet.crosses(node) {
                continue;
            }
            if node.second_child > 0 {
                open[count] = node.second_child;
                open[count + 1] = at + 1;
                count += 2;
            }
            for wall in &self.solid[node.walls.0..node.walls.1] {
                visit(wall, &mut packet);
            }
        }
    }

    /// Puts a box around some walls, and boxes around both parts of them.
    fn sort(&mut self, first: usize, end: usize, depth: usize) {
        let walls = &mut self.solid[first..end];
        let mut node = Node { low: Vec3::INFINITY, high: Vec3::NEG_INFINITY, walls: (first, end), second_child: 0 };
        for place in walls.iter().flat_map(Wall::corners) {
            node.low = node.low.min(place);
            node.high = node.high.max(place);
        }
        let at = self.nodes.len();
        let low_half = match walls.len() {
            0..=LEAF => 0,
            count if depth >= HALVING => count / 2,
            _ => split(walls),
        };
        if low_half > 0 {
            node.walls = (0, 0);
            self.nodes.push(node);
            self.sort(first, first + low_half, depth + 1);
            self.nodes[at].second_child = self.nodes.len();
            self.sort(first + low_half, end, depth + 1);
        } else {
            self.nodes.push(node);
        }
    }
}

/// Parts walls so that rays are likely to miss the boxes of most: the chance to meet a box goes with its surface. Tells how
/// many come first.
fn split(walls: &mut [Wall]) -> usize {
    const BINS: usize = 16;
    let middles = walls.iter().map(Wall::middle);
    let (low, high) = middles.fold((Vec3::INFINITY, Vec3::NEG_INFINITY), |(low, high), at| (low.min(at), high.max(at)));
    let bin = |wall: &Wall, axis: usize| {
        let part = (wall.middle()[axis] - low[axis]) / (high[axis] - low[axis]);
        ((part * BINS as f32) as usize).min(BINS - 1)
    };
    let mut best = (f32::INFINITY, 0, 0);
    for axis in 0..3 {
        let mut bins = [Bounds::default(); BINS];
        walls.iter().for_each(|wall| bins[bin(wall, axis)].add(wall));
        let mut below = [0.0; BINS];
        let mut sum = Bounds::default();
        for at in 0..BINS {
            below[at] = sum.cost();
            sum = sum.join(&bins[at]);
        }
        let mut sum = Bounds::default();
        for at in (1..BINS).rev() {
            sum = sum.join(&bins[at]);
            let cost = below[at] + sum.cost();
            if cost < best.0 {
                best = (cost, axis, at);
            }
        }
    }
    let (_, axis, border) = best;
    let mut count = 0;
    for at in 0..walls.len() {
        if bin(&walls[at], axis) < border {
            walls.swap(count, at);
            count += 1;
        }
    }
    if (1..walls.len()).contains(&count) {
        return count;
    }
    // All in one place.
    walls.len() / 2
}

/// A box around some walls.
#[derive(Clone, Copy, Debug)]
struct Bounds {
    low: Vec3,
    high: Vec3,
    count: usize,
}

impl Default for Bounds {
    fn default() -> Self {
        Self { low: Vec3::INFINITY, high: Vec3::NEG_INFINITY, count: 0 }
    }
}

impl Bounds {
    fn add(&mut self, wall: &Wall) {
        for corner in wall.corners() {
            (self.low, self.high) = (self.low.min(corner), self.high.max(corner));
        }
        self.count += 1;
    }

    fn join(&self, other: &Self) -> Self {
        Self { low: self.low.min(other.low), high: self.high.max(other.high), count: self.count + other.count }
    }

    /// The number of walls that rays are tried on, times that of the rays.
    fn cost(&self) -> f32 {
        let sides = (self.high - self.low).max(Vec3::ZERO);
        if self.count == 0 { 0.0 } else { self.count as f32 * (sides * sides.yzx()).element_sum() }
    }
}

/// Some rays from one place.
struct Packet<const N: usize> {
    from: Vec3,
    /// The directions, one array for each coordinate, and one over them.
    towards: [[f32; N]; 3],
    inverse: [[f32; N]; 3],
    /// How far to look, in lengths of the direction; negative for not at all.
    reach: [f32; N],
}

impl<const N: usize> Packet<N> {
    fn new(from: Vec3, rays: [Vec3; N], reach: f32) -> Self {
        let towards = [0, 1, 2].map(|axis| rays.map(|ray| ray[axis]));
        // No division by zero, which would make the boxes' bounds meaningless.
        let inverse = towards.map(|row| row.map(|d| 1.0 / if d.abs() < 1e-12 { 1e-12 } else { d }));
        Self { from, towards, inverse, reach: [reach; N] }
    }

    /// Whether any of the rays crosses a box.
    fn crosses(&self, node: &Node) -> bool {
        let (mut enter, mut leave) = ([0.0; N], self.reach);
        for axis in 0..3 {
            let (low, high) = (node.low[axis] - self.from[axis], node.high[axis] - self.from[axis]);
            for at in 0..N {
                let (a, b) = (low * self.inverse[axis][at], high * self.inverse[axis][at]);
                let (near, far) = if a < b { (a, b) } else { (b, a) };
                enter[at] = if near > enter[at] { near } else { enter[at] };
                leave[at] = if far < leave[at] { far } else { leave[at] };
            }
        }
        // Rounding must not lose a wall that lies flat in its box.
        (0..N).fold(false, |any, at| any | (enter[at] <= leave[at] * 1.000_01))
    }
}

/// Places evenly spread over a disc that is turned by `turn`.
fn spread<const N: usize>(turn: f32) -> [Vec2; N] {
    const GOLDEN: f32 = 2.399_963_2;
    std::array::from_fn(|step| {
        let radius = ((step as f32 + 0.5) / N as f32).sqrt();
        radius * Vec2::from_angle(turn + GOLDEN * step as f32)
    })
}

impl Wall {
    fn new(facet: &Facet, upright: Mat3, opacity: f32) -> Self {
        let [a, b, c] = facet.corners.map(|corner| upright * corner.place);
        Self { corner: a, sides: [b - a, c - a], flat: upright * facet.flat, opacity }
    }

    /// The middle of its box.
    fn middle(&self) -> Vec3 {
        let [a, b, c] = self.corners();
        0.5 * (a.min(b).min(c) + a.max(b).max(c))
    }

    fn corners(&self) -> [Vec3; 3] {
        [self.corner, self.corner + self.sides[0], self.corner + self.sides[1]]
    }

    /// How far along each ray the wall is; infinite or not a number for not at all (Möller and
    /// Trumbore's method).
    fn distances<const N: usize>(&self, packet: &Packet<N>) -> [f32; N] {
        let out = packet.from - self.corner;
        let flat = self.sides[1].cross(self.sides[0]);
        let (u, v) = (self.sides[1].cross(out), out.cross(self.sides[0]));
        let height = self.sides[1].dot(v);
        std::array::from_fn(|at| {
            let dot = |a: Vec3| a.x * packet.towards[0][at] + a.y * packet.towards[1][at] + a.z * packet.towards[2][at];
            let scale = 1.0 / dot(flat);
            let (u, v, distance) = (scale * dot(u), scale * dot(v), scale * height);
            if (u >= 0.0) & (v >= 0.0) & (u + v <= 1.0) & (distance > 0.0) { distance } else { f32::INFINITY }
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::draw::{Camera, Material, Piece, Stage, shapes};

    fn rays(piece: Piece) -> Rays {
        // The default camera's view coordinates are the world's.
        let stage = Stage { pieces: vec![piece], ..Stage::default() };
        let lens = Lens::new(&Camera::default(), 64, 48);
        Rays::new(&Model::new(&stage, &lens), &lens)
    }

    fn ball() -> Piece {
        Piece { surface: shapes::sphere(Vec3::ZERO, 1.0), ..Piece::default() }
    }

    #[test]
    fn the_first_wall_is_found() {
        let rays = rays(ball());
        for towards in [Vec3::X, Vec3::Y, Vec3::NEG_Z, Vec3::ONE.normalize()] {
            let hit = rays.first(-3.0 * towards, towards, 10.0).unwrap();
            assert!((hit.distance - 2.0).abs() < 5e-3, "{towards}: {}", hit.distance);
            assert!(hit.normal.dot(towards) < -0.99);
            assert!(rays.first(-3.0 * towards, towards, 1.9).is_none());
            assert!(rays.first(-3.0 * towards, -towards, 10.0).is_none());
        }
    }

    #[test]
    fn solids_cast_shadows_and_rooms_do_not() {
        // Beside the poles, where many triangles meet.
        let below = Vec3::new(0.1, -3.0, 0.2);
        let upwards = |piece: Piece, from: Vec3| rays(piece).seen(from, Vec3::Y, 0.0, 10.0, 0.0);
        assert_eq!(upwards(ball(), below), 0.0);
        assert_eq!(upwards(ball(), below.with_y(0.0)), 1.0);
        assert_eq!(upwards(Piece { endless: true, ..ball() }, below), 1.0);
        let material = Material { opacity: 0.25, ..Material::default() };
        assert_eq!(upwards(Piece { material, ..ball() }, below), 0.75);
        assert_eq!(Rays::default().seen(below, Vec3::Y, 0.0, 10.0, 0.0), 1.0);
    }
}
