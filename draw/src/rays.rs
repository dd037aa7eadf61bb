//! Looking along straight lines through the scene: for shadows, and for the ground under a dot.

use super::camera::Lens;
use super::model::{Facet, Model, Role, Skin};
use glam::{Mat3, Vec2, Vec3};
use pointmass::rays::{Aabb8, IndexBuf, Pieces, Structure, Visitor};
use pointmass::shape::{self, Aabb, Segment};
use std::ops::ControlFlow;
use wide::f32x8;

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
    solid: Walls,
    index: IndexBuf,
}

/// A triangle.
#[derive(Clone, Copy, Debug)]
struct Wall {
    corner: Vec3,
    sides: [Vec3; 2],
    flat: Vec3,
    opacity: f32,
    /// True if light is stopped from behind as well.
    open: bool,
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
            walls.map(|(facet, skin)| Wall::new(facet, upright, skin)).collect::<Vec<_>>()
        };
        let (endless, solid) = (walls(Role::Endless), Walls::new(walls(Role::Solid)));
        let index = IndexBuf::new(Structure::Bvh, &solid);
        Self { upright, endless, solid, index }
    }

    /// The first wall along a ray, if there is one within `reach`.
    pub(super) fn first(&self, from: Vec3, towards: Vec3, reach: f32) -> Option<Hit> {
        let path = Segment::new(self.upright * from, self.upright * (from + reach * towards));
        let endless = self.endless.iter().filter_map(|wall| wall.hit(&path));
        let hits = endless.chain(self.index.view().first_hit(&self.solid, &path));
        let hit = hits.min_by(|a, b| a.time.total_cmp(&b.time))?;
        Some(Hit { distance: hit.time * reach, normal: self.upright.transpose() * hit.normal })
    }

    /// The share of a lamp that can be seen from a place. The lamp is a round disc `reach` away whose
    /// radius is `width` times as much, looked at in a pattern that is turned by `turn`.
    ///
    /// Of what is closed only walls entered from outside count. For solids that changes nothing, and a room may be
    /// lit by a lamp outside it, which is how people light the rooms they want to look into.
    pub(super) fn seen(&self, from: Vec3, towards: Vec3, width: f32, reach: f32, turn: f32) -> f32 {
        let (from, towards) = (self.upright * from, self.upright * towards);
        let (x, y) = towards.any_orthonormal_pair();
        let ray = |at: Vec2| towards + width * (at.x * x + at.y * y);
        // Four rays say whether this is the edge of a shadow; if so, ask more.
        let few = self.passing(spread::<4>(turn).map(ray), from, reach);
        if few == 0.0 || few == 1.0 {
            return few;
        }
        self.passing(spread::<24>(turn).map(ray), from, reach)
    }

    /// The share of light that gets through along some rays from one place.
    fn passing<const N: usize>(&self, rays: [Vec3; N], from: Vec3, reach: f32) -> f32 {
        let packet = Packet::new(from, rays, reach);
        let mut light =
            Light { bundle: Bundle::new(&packet, reach), packet, walls: &self.solid.walls, passing: [1.0; N] };
        self.index.view().visit(&self.solid, &mut light);
        light.passing.iter().sum::<f32>() / N as f32
    }
}

/// Walls as pieces of a structure, and the largest of their coordinates.
#[derive(Debug, Default)]
struct Walls {
    walls: Vec<Wall>,
    reach: f32,
}

impl Walls {
    fn new(walls: Vec<Wall>) -> Self {
        let mut walls = Self { walls, reach: 0.0 };
        let reach = |at: usize| walls.box_of(at).min.abs().max(walls.box_of(at).max.abs()).max_element();
        walls.reach = (0..walls.count()).map(reach).filter(|reach| reach.is_finite()).fold(0.0, f32::max);
        walls
    }
}

impl Pieces for Walls {
    fn count(&self) -> usize {
        self.walls.len()
    }

    fn box_of(&self, wall: usize) -> Aabb {
        let [a, b, c] = self.walls[wall].corners();
        Aabb { min: a.min(b).min(c), max: a.max(b).max(c) }
    }

    fn hit(&self, wall: usize, path: &Segment) -> Option<shape::Hit> {
        self.walls[wall].hit(path)
    }

    fn reach(&self) -> f32 {
        self.reach
    }
}

/// Light on its way through walls.
struct Light<'w, const N: usize> {
    bundle: Bundle,
    packet: Packet<N>,
    walls: &'w [Wall],
    /// The share of each ray that has got through so far.
    passing: [f32; N],
}

impl<const N: usize> Visitor for Light<'_, N> {
    fn enters(&mut self, bounds: &Aabb) -> bool {
        let mut boxes = Aabb8::EMPTY;
        for axis in 0..3 {
            (boxes.min[axis][0], boxes.max[axis][0]) = (bounds.min[axis], bounds.max[axis]);
        }
        self.enters_which(&boxes) & 1 != 0
    }

    /// Most boxes are beside all rays, which one look tells; those among the rays are held against each ray.
    fn enters_which(&mut self, boxes: &Aabb8) -> u32 {
        let boxes = Boxes::new(boxes, self.packet.from);
        let among = boxes.met(self.bundle.inverse, self.bundle.reach);
        let mut entered = 0;
        for at in 0..N {
            if entered & among == among {
                break;
            }
            if self.packet.reach[at] >= 0.0 {
                let inverse = [0, 1, 2].map(|axis| self.packet.inverse[axis][at]);
                entered |= boxes.met([inverse; 2], self.packet.reach[at]);
            }
        }
        entered & among
    }

    fn visit(&mut self, wall: usize) -> ControlFlow<()> {
        let (wall, packet) = (&self.walls[wall], &mut self.packet);
        if wall.open || wall.flat.dot(packet.from - wall.corner) > 0.0 {
            let distances = wall.distances(packet);
            for ((distance, reach), passing) in distances.iter().zip(&mut packet.reach).zip(&mut self.passing) {
                *passing *= if distance < reach { 1.0 - wall.opacity } else { 1.0 };
                *reach = if *passing > 0.0 { *reach } else { -1.0 };
            }
            if packet.reach.iter().all(|&reach| reach < 0.0) {
                return ControlFlow::Break(());
            }
        }
        ControlFlow::Continue(())
    }
}

/// All between the least and the greatest coordinates of some directions: rays from one place are held against eight boxes for the
/// price of one.
struct Bundle {
    /// One over the least, and one over the greatest.
    inverse: [[f32; 3]; 2],
    reach: f32,
}

impl Bundle {
    fn new<const N: usize>(packet: &Packet<N>, reach: f32) -> Self {
        let least = packet.towards.map(|row| over(row.into_iter().fold(f32::INFINITY, f32::min), -STILL));
        let greatest = packet.towards.map(|row| over(row.into_iter().fold(f32::NEG_INFINITY, f32::max), STILL));
        Self { inverse: [least, greatest], reach }
    }
}

/// Steps shorter than this count as this long: a division by zero would make the boxes' bounds meaningless.
const STILL: f32 = 1e-12;

/// One over a step; over `short`, if it is shorter.
fn over(step: f32, short: f32) -> f32 {
    1.0 / if step.abs() < STILL { short } else { step }
}

/// Eight boxes, seen from where rays begin.
struct Boxes {
    min: [f32x8; 3],
    max: [f32x8; 3],
}

impl Boxes {
    #[inline(always)]
    fn new(boxes: &Aabb8, from: Vec3) -> Self {
        let seen = |planes: &[[f32; 8]; 3]| [0, 1, 2].map(|axis| f32x8::new(planes[axis]) - f32x8::splat(from[axis]));
        Self { min: seen(&boxes.min), max: seen(&boxes.max) }
    }

    /// Tells which of them are met by what is, at t, between t · least and t · greatest along each axis, t being at most `reach`; given is
    /// one over both. t · greatest ≥ min and t · least ≤ max are bounds of t from below or above, as the signs are.
    #[inline(always)]
    fn met(&self, [least, greatest]: [[f32; 3]; 2], reach: f32) -> u32 {
        let (mut enter, mut leave) = (f32x8::ZERO, f32x8::splat(reach));
        for axis in 0..3 {
            let (min, max) =
                (self.min[axis] * f32x8::splat(greatest[axis]), self.max[axis] * f32x8::splat(least[axis]));
            if greatest[axis] > 0.0 {
                enter = min.fast_max(enter);
            } else {
                leave = min.fast_min(leave);
            }
            if least[axis] > 0.0 {
                leave = max.fast_min(leave);
            } else {
                enter = max.fast_max(enter);
            }
        }
        // Rounding must not lose a wall that lies flat in its box.
        enter.simd_le(leave * f32x8::splat(1.000_01)).to_bitmask()
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
        let inverse = towards.map(|row| row.map(|step| over(step, STILL)));
        Self { from, towards, inverse, reach: [reach; N] }
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
    fn new(facet: &Facet, upright: Mat3, skin: &Skin) -> Self {
        let [a, b, c] = facet.corners.map(|corner| upright * corner.place);
        let Skin { opacity, open, .. } = *skin;
        Self { corner: a, sides: [b - a, c - a], flat: upright * facet.flat, opacity, open }
    }

    fn corners(&self) -> [Vec3; 3] {
        [self.corner, self.corner + self.sides[0], self.corner + self.sides[1]]
    }

    /// Where a path meets it, from either side.
    fn hit(&self, path: &Segment) -> Option<shape::Hit> {
        let [time] = self.distances(&Packet::new(path.from, [path.step()], 1.0));
        let hit = shape::Hit { time, normal: self.flat, slack: 0.0, velocity: Vec3::ZERO, material: None, face: 0 };
        (time <= 1.0).then_some(hit)
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
    use crate::{Camera, Material, Piece, Stage, shapes};

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
