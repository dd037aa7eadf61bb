//! What touches: blows since the picture before, and what lies on scenery, on bodies, on balls and on cloth now.

use super::AHEAD;
use super::sheets::{self, across};
use glam::{Mat3, Vec3};
use pointmass::constrain::{Hull, HullFace, HullList};
use pointmass::draw::{Instance, Line, arrow, body};
use pointmass::force::State;
use pointmass::index::{SpatialIndex, Structure};
use pointmass::scene::Model;
use pointmass::shape::{Collider, Surface, Triangle};
use pointmass::{Attention, Color, Heap, Impact, Observer, RigidBodies, RigidBox, System};
use std::collections::HashMap;
use std::ops::Range;

/// The colours of what is struck, of what lies on scenery, and of balls, bodies and cloth that lie on each other.
const BLOW: Color = [240, 60, 60, 255];
const SCENERY: Color = [250, 170, 40, 255];
const EACH_OTHER: Color = [60, 200, 230, 255];

/// How far apart things touch all the same, and the length of a line, in lengths of an arrow: about a pixel, and half an arrow.
const SLACK: f32 = 0.02;
const LONG: f32 = 0.5;

/// The blows since the picture before; watches the steps between.
#[derive(Debug, Default)]
pub(crate) struct Blows(Vec<Impact>);

impl Observer for Blows {
    fn attention(&self) -> Attention {
        Attention::Events
    }

    fn hit(&mut self, hit: &Impact) {
        self.0.push(*hit);
    }

    fn touched(&mut self, touch: &Impact) {
        self.0.push(*touch);
    }
}

impl Blows {
    /// The lines of all contacts, and forgets the blows. Arrows show where blows have pushed: as far as what came goes in a tenth of a second, but no
    /// farther than `length` \[m\]. Blows that took away no more than a pixel's way in the time between two pictures \[s\] are rest.
    pub(crate) fn lines(&mut self, system: &System<Heap>, model: &Model, length: f32, between: f32) -> Vec<Line> {
        let scene = model.scene();
        let state = system.state(&scene);
        let bodies = Bodies::of(&state, model);
        let slack = SLACK * length;
        let mut lines = Lines { all: Vec::new(), long: LONG * length, slack };
        let particles = system.particles();
        lines.lean(&state, (particles.serial, particles.inverse_mass), model, &bodies);
        lines.pile(&state, particles.serial, &bodies);
        lines.cross(&bodies);
        if model.contacts.is_some() {
            lines.crowd(&state);
        }
        let sheets = &model.constraints.3;
        lines.all.extend(sheets::lines(&state, sheets, &model.particles, lines.long, EACH_OTHER));
        for blow in self.0.drain(..).filter(|blow| blow.closing * between > slack) {
            // Of a body that is the place itself, else the middle of a ball.
            let others = [Some(blow.id), blow.other];
            let is_body = others.into_iter().flatten().any(|id| bodies.has(id.serial()));
            let radius = system.row(blow.id).filter(|_| !is_body).map_or(0.0, |row| state.radius[row]);
            let long = length.min(blow.closing * AHEAD);
            lines.all.extend(arrow(blow.place - blow.normal * radius, blow.normal * long, BLOW));
        }
        lines.all
    }
}

/// A rigid body, or a piece of one, as it stands.
struct Standing<'m> {
    /// The number of its body.
    of: usize,
    center: Vec3,
    rotation: Mat3,
    half: Vec3,
    hull: Option<Hull<'m>>,
}

/// All rigid bodies, piece by piece, and their particles by their place in the scene's start.
struct Bodies<'m> {
    standing: Vec<Standing<'m>>,
    members: Vec<Range<u32>>,
}

impl<'m> Bodies<'m> {
    fn of(state: &State<'_>, model: &'m Model) -> Self {
        let RigidBodies { boxes, hulls: all, .. } = &model.constraints.1;
        let stand = |(number, of): (usize, &RigidBox)| {
            let Instance { center, axes, .. } = body(state, of, &model.particles)?;
            let axis = |axis: Vec3| axis.normalize_or_zero();
            let rotation = Mat3::from_cols(axis(axes.x_axis), axis(axes.y_axis), axis(axes.z_axis));
            let hulls = of.hull.map(usize::from).map_or(0..0, |first| first..first + usize::from(of.pieces));
            let mut pieces: Vec<_> = hulls
                .filter_map(|hull| all.hull(hull))
                .map(|hull| {
                    let half = if of.pieces > 1 { hull.half() } else { of.half };
                    Standing { of: number, center: center + rotation * hull.center, rotation, half, hull: Some(hull) }
                })
                .collect();
            if pieces.is_empty() {
                pieces.push(Standing { of: number, center, rotation, half: of.half, hull: None });
            }
            Some(pieces)
        };
        let mut members: Vec<_> = boxes.iter().map(|of| of.first..of.first.saturating_add(of.count)).collect();
        members.sort_unstable_by_key(|range| range.start);
        Self { standing: boxes.iter().enumerate().filter_map(stand).flatten().collect(), members }
    }

    /// Tells whether a particle of the scene's start belongs to one.
    fn has(&self, serial: u32) -> bool {
        let next = self.members.partition_point(|range| range.start <= serial);
        next.checked_sub(1).is_some_and(|last| self.members[last].contains(&serial))
    }
}

impl Standing<'_> {
    fn corners(&self) -> Vec<Vec3> {
        let place = |own: Vec3| self.center + self.rotation * own;
        match &self.hull {
            Some(hull) => hull.corners.iter().map(|&corner| place(corner)).collect(),
            None => (0..8u32)
                .map(|i| place(Vec3::from([0, 1, 2].map(|k| if i >> k & 1 == 0 { -1.0 } else { 1.0 })) * self.half))
                .collect(),
        }
    }

    fn edges(&self) -> Vec<[Vec3; 2]> {
        let corners = self.corners();
        let ends: Vec<[usize; 2]> = match &self.hull {
            Some(hull) => hull.edges.iter().map(|edge| edge.ends.map(usize::from)).collect(),
            None => {
                let along = |k: usize| (0..8).filter(move |i| i >> k & 1 == 0).map(move |i| [i, i | 1 << k]);
                (0..3).flat_map(along).collect()
            }
        };
        ends.into_iter().map(|ends| ends.map(|end| corners[end])).collect()
    }

    /// The face nearest to a place, if that is within `reach` \[m\] of it, or behind: the place on the face, and its normal.
    fn face(&self, place: Vec3, reach: f32) -> Option<[Vec3; 2]> {
        let way = place - self.center;
        if way.length_squared() > (self.half.length() + reach).powi(2) {
            return None;
        }
        let own = self.rotation.transpose() * way;
        let (normal, far) = match &self.hull {
            Some(hull) => {
                // Beyond an edge no face is near, though its plane is.
                let outside = |face: &&HullFace| face.normal.dot(own) > face.offset;
                let triangles = hull.faces.iter().filter(outside).flat_map(|face| hull.triangles(face));
                let nearest = triangles.map(|corners| own.distance(Triangle { corners }.nearest(own))).reduce(f32::min);
                if nearest.is_some_and(|far| far > reach) {
                    return None;
                }
                let faces = hull.faces.iter().map(|face| (face.normal, face.normal.dot(own) - face.offset));
                faces.max_by(|a, b| a.1.total_cmp(&b.1))?
            }
            None => {
                // Beyond an edge no face is near, though its plane is.
                let nearest = own.clamp(-self.half, self.half);
                if (own - nearest).length() > reach {
                    return None;
                }
                let faces = Vec3::AXES.into_iter().map(|axis| axis * own.dot(axis).signum());
                let faces = faces.map(|normal| (normal, normal.dot(own) - normal.abs().dot(self.half)));
                faces.max_by(|a, b| a.1.total_cmp(&b.1))?
            }
        };
        let normal = self.rotation * normal;
        (far <= reach).then(|| [place - normal * far, normal])
    }
}

/// The lines of what lies.
struct Lines {
    all: Vec<Line>,
    /// Their length \[m\], and how far apart things touch all the same \[m\].
    long: f32,
    slack: f32,
}

impl Lines {
    fn push(&mut self, place: Vec3, normal: Vec3, color: Color) {
        self.all.push(Line::plain([place, place + normal * self.long], color));
    }

    /// What lies on scenery: balls, cloth with its thickness, points, and the corners of bodies. Who is fixed lies on nothing.
    fn lean(&mut self, state: &State<'_>, (serial, weights): (&[u32], &[f32]), model: &Model, bodies: &Bodies<'_>) {
        let mut thick: HashMap<u32, f32> = HashMap::new();
        let sheets = &model.constraints.3;
        for (corners, thickness) in sheets.triangles.iter().zip(&sheets.thickness) {
            for number in corners.iter().filter_map(|&corner| sheets.particles.get(corner as usize)) {
                let half = thick.entry(*number).or_default();
                *half = half.max(0.5 * thickness);
            }
        }
        let loose = (0..serial.len()).filter(|&row| weights[row] > 0.0 && !bodies.has(serial[row]));
        let loose = loose.map(|row| {
            let thick = thick.get(&serial[row]).copied().unwrap_or(0.0);
            (state.position[row], state.position[row], thick.max(state.radius[row]))
        });
        let corners = |body: &Standing<'_>| {
            body.corners().into_iter().map(|corner| (body.center, corner, 0.0)).collect::<Vec<_>>()
        };
        for (center, place, radius) in loose.chain(bodies.standing.iter().flat_map(corners)) {
            let mut touched = Vec::new();
            model.colliders.contacts(place, radius + self.slack, state.time, &mut |contact| touched.push(*contact));
            for contact in touched {
                // A corner that has sunk in a little sees the surface from behind.
                let is_behind = contact.normal.dot(center - contact.point) < 0.0;
                self.push(contact.point, if is_behind { -contact.normal } else { contact.normal }, SCENERY);
            }
        }
    }

    /// What lies on rigid bodies: balls, and the corners of others.
    fn pile(&mut self, state: &State<'_>, serial: &[u32], bodies: &Bodies<'_>) {
        let balls = (0..serial.len()).filter(|&row| state.radius[row] > 0.0 && !bodies.has(serial[row]));
        let balls = balls.map(|row| (usize::MAX, state.position[row], state.radius[row]));
        let corners = bodies.standing.iter();
        let corners = corners.flat_map(|body| body.corners().into_iter().map(move |corner| (body.of, corner, 0.0)));
        for (of, place, radius) in balls.chain(corners) {
            for body in bodies.standing.iter().filter(|body| body.of != of) {
                if let Some([on, normal]) = body.face(place, radius + self.slack) {
                    self.push(on, normal, EACH_OTHER);
                }
            }
        }
    }

    /// Edges of rigid bodies that cross those of others.
    fn cross(&mut self, bodies: &Bodies<'_>) {
        let edges: Vec<_> = bodies.standing.iter().map(Standing::edges).collect();
        for (number, one) in bodies.standing.iter().enumerate() {
            for (other, edges_of_other) in bodies.standing.iter().zip(&edges).take(number) {
                let way = one.center - other.center;
                if one.of == other.of || way.length() > one.half.length() + other.half.length() + self.slack {
                    continue;
                }
                for (a, b) in edges[number].iter().flat_map(|a| edges_of_other.iter().map(move |b| (a, b))) {
                    let touching = across([*a, *b]).filter(|[on, off]| on.distance(*off) <= self.slack);
                    if let Some([on, off]) = touching {
                        let normal = (a[1] - a[0]).cross(b[1] - b[0]).normalize_or_zero();
                        self.push((on + off) * 0.5, normal * normal.dot(way).signum(), EACH_OTHER);
                    }
                }
            }
        }
    }

    /// Balls that touch each other.
    fn crowd(&mut self, state: &State<'_>) {
        let widest = state.radius.iter().copied().fold(0.0, f32::max);
        if !(widest > 0.0) {
            return;
        }
        let reach = 2.0 * widest + self.slack;
        let structure = Structure::Grid;
        let mut memory = vec![0; structure.words(state.position.len())];
        let mut index = structure.in_room(&mut memory, state.near.room());
        if index.build(state.position, reach).is_err() {
            return;
        }
        // One large ball has many within reach: only those who touch are kept.
        let touch = |a: usize, b: usize| {
            let (way, radii) = (state.between(a, b), [state.radius[a], state.radius[b]]);
            let is_near = way.length() <= radii[0] + radii[1] + self.slack;
            is_near && radii[0] > 0.0 && radii[1] > 0.0
        };
        let mut pairs = Vec::new();
        index.pairs(reach, &mut |row, others| {
            let touching = others.iter().filter(|&&other| touch(row as usize, other as usize));
            pairs.extend(touching.map(|&other| [row as usize, other as usize]));
        });
        pairs.sort_unstable();
        for [a, b] in pairs {
            let normal = state.between(a, b).normalize_or_zero();
            let on = state.position[a] + normal * state.radius[a];
            let half = normal * (0.5 * self.long);
            self.all.push(Line::plain([on - half, on + half], EACH_OTHER));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use pointmass::constrain::HullBuf;

    /// Two beams that stand on edge, one across the other, touch in one place, whether they are boxes or hulls, and nowhere once they are apart.
    #[test]
    fn edges_of_bodies_touch_where_they_cross() {
        let half = Vec3::new(1.0, 0.1, 0.1);
        let corners = [0, 1, 2, 3, 4, 5, 6, 7];
        let corners = corners.map(|i| Vec3::from([0, 1, 2].map(|k| if i >> k & 1 == 0 { -1.0 } else { 1.0 })) * half);
        let made = HullBuf::of(&corners).expect("a hull");
        let on_edge = Mat3::from_rotation_x(std::f32::consts::FRAC_PI_4);
        let beam = |height: f32, turn: f32, is_hull: bool| Standing {
            of: usize::from(turn > 1.0),
            center: Vec3::new(0.2, height, -0.1),
            rotation: Mat3::from_rotation_y(turn) * on_edge,
            half,
            hull: is_hull.then(|| made.lend()),
        };
        for i in 0..4 {
            for (height, count) in [(0.2 * 2.0_f32.sqrt() + 1e-3, 1), (0.3, 0), (-0.3, 0)] {
                let standing = vec![beam(0.0, 0.3, i & 1 == 0), beam(height, 1.4, i & 2 == 0)];
                let mut lines = Lines { all: Vec::new(), long: 0.5, slack: 5e-3 };
                lines.cross(&Bodies { standing, members: Vec::new() });
                assert_eq!(lines.all.len(), count, "{height}");
                for Line { ends: [on, to], .. } in lines.all {
                    let place = Vec3::new(0.2, 0.5 * height, -0.1);
                    assert!(on.distance(place) < 1e-4 && to.distance(place + Vec3::Y * 0.5) < 1e-4, "{on} {to}");
                }
            }
        }
    }

    /// A box is touched where it is touched as a hull, and nothing is that lies beyond a sharp tip.
    #[test]
    fn hulls_are_touched_where_they_are() {
        let half = Vec3::new(0.3, 0.2, 0.1);
        let corners = [0, 1, 2, 3, 4, 5, 6, 7];
        let corners = corners.map(|i| Vec3::from([0, 1, 2].map(|k| if i >> k & 1 == 0 { -1.0 } else { 1.0 })) * half);
        let made = HullBuf::of(&corners).expect("a hull");
        let rotation = Mat3::from_rotation_z(0.4);
        let plain = Standing { of: 0, center: Vec3::X, rotation, half, hull: None };
        let hull = Standing { of: 0, center: Vec3::X, rotation, half, hull: Some(made.lend()) };
        let mut touched = 0;
        for i in 0..1000 {
            let own = Vec3::from([i % 10, i / 10 % 10, i / 100].map(|k| 0.1 * k as f32 - 0.4613));
            let place = plain.center + rotation * own;
            let [plain, hull] = [&plain, &hull].map(|body| body.face(place, 0.12));
            assert_eq!(plain.is_some(), hull.is_some(), "{own}");
            touched += i32::from(plain.is_some());
        }
        assert!((100..900).contains(&touched), "{touched}");
        let tip = [Vec3::X * 0.5, Vec3::new(-0.5, 0.1, 0.0), Vec3::new(-0.5, -0.1, 0.1), Vec3::new(-0.5, -0.1, -0.1)];
        let made = HullBuf::of(&tip).expect("a hull");
        let sharp = Standing {
            of: 0,
            center: Vec3::ZERO,
            rotation: Mat3::IDENTITY,
            half: made.lend().half(),
            hull: Some(made.lend()),
        };
        let end = made.lend().corners.iter().map(|corner| corner.x).fold(0.0, f32::max);
        assert!(sharp.face(Vec3::X * (end + 0.19), 0.2).is_some() && sharp.face(Vec3::X * (end + 0.21), 0.2).is_none());
    }
}
