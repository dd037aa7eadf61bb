//! Rigid bodies that fall on solids of all sizes in any pose: they meet them by their corners, by edges that cross and by faces.

use pointmass::constrain::{HullBuf, RigidBodies, RigidBox};
use pointmass::force::Friction;
use pointmass::shape::{Capsule, Collider, Cuboid, MeshBuf, Sphere};
use pointmass::{ContactMaterial, Gravity, Method, Particle, Scene, Time, Vec3};
use pointmass_tests::{Random, started};

/// A box that stands anywhere.
struct Posed {
    half: Vec3,
    middle: Vec3,
    axes: [Vec3; 3],
}

impl Posed {
    /// That of eight particles that lie as those of a solid box do.
    fn of(half: Vec3, places: &[Vec3]) -> Self {
        let axis = |bit: usize| {
            let along = |(i, place): (usize, &Vec3)| if i >> bit & 1 == 1 { *place } else { -*place };
            places.iter().enumerate().map(along).sum::<Vec3>().normalize()
        };
        Self { half, middle: places.iter().sum::<Vec3>() / 8.0, axes: [0, 1, 2].map(axis) }
    }

    /// How far it is from a place \[m\]; below zero inside.
    fn gap(&self, place: Vec3) -> f32 {
        let away = place - self.middle;
        let out = Vec3::from_array([0, 1, 2].map(|k| away.dot(self.axes[k]).abs())) - self.half;
        out.max(Vec3::ZERO).length() + out.max_element().min(0.0)
    }

    /// How far it is from a segment \[m\], which is convex along that.
    fn gap_to(&self, [from, to]: [Vec3; 2]) -> f32 {
        let (mut low, mut high) = (0.0, 1.0);
        for _ in 0..60 {
            let [a, b] = [(2.0 * low + high) / 3.0, (low + 2.0 * high) / 3.0];
            let [one, other] = [a, b].map(|t| self.gap(from.lerp(to, t)));
            (low, high) = if one < other { (low, b) } else { (a, high) };
        }
        self.gap(from.lerp(to, low))
    }

    /// How far it is from another along the axis that separates them most \[m\]; below zero, how deep in it.
    fn apart(&self, other: &Self) -> f32 {
        let across = self.axes.into_iter().flat_map(|a| other.axes.map(|b| a.cross(b).normalize_or_zero()));
        let axes = self.axes.into_iter().chain(other.axes).chain(across).filter(|axis| *axis != Vec3::ZERO);
        let reach = |of: &Self, axis: Vec3| (0..3).map(|k| of.axes[k].dot(axis).abs() * of.half[k]).sum::<f32>();
        let way = other.middle - self.middle;
        axes.map(|axis| way.dot(axis).abs() - reach(self, axis) - reach(other, axis)).fold(f32::MIN, f32::max)
    }
}

/// A solid of the scenery.
enum Solid {
    Ball(Sphere),
    Rod(Capsule),
    Block(Cuboid),
    /// A block in any pose, of triangles.
    Mesh(Posed, MeshBuf),
}

/// A box as a mesh, whose faces have so many cells a side, of two triangles each.
fn meshed(posed: &Posed, cells: u32) -> MeshBuf {
    let (mut vertices, mut triangles) = (Vec::new(), Vec::new());
    for (side, (k, sign)) in [0, 1, 2].into_iter().flat_map(|k| [(k, -1.0), (k, 1.0)]).enumerate() {
        let [out, along, across] = [k, k + 1, k + 2].map(|k| posed.axes[k % 3] * posed.half[k % 3]);
        let share = |i: u32| 2.0 * i as f32 / cells as f32 - 1.0;
        let place = |u, v| posed.middle + out * sign + along * share(u) + across * share(v);
        vertices.extend((0..=cells).flat_map(|u| (0..=cells).map(move |v| (u, v))).map(|(u, v)| place(u, v)));
        let at = |u, v| (side as u32 * (cells + 1) + u) * (cells + 1) + v;
        for (u, v) in (0..cells).flat_map(|u| (0..cells).map(move |v| (u, v))) {
            let [a, b, c, d] = [at(u, v), at(u + 1, v), at(u + 1, v + 1), at(u, v + 1)];
            let turned = |[a, b, c]: [u32; 3]| if sign > 0.0 { [a, b, c] } else { [a, c, b] };
            triangles.extend([[a, b, c], [a, c, d]].map(turned));
        }
    }
    MeshBuf::new(vertices, triangles).expect("a box is a mesh")
}

impl Solid {
    /// One in the middle, or farther off, of some size beside bodies of about `scale` \[m\].
    fn any(random: &mut Random, kind: usize, (at, scale): (Vec3, f32)) -> Self {
        let radius = random.magnitude(0.03, 1.0) * scale;
        let along = random.direction() * (2.0 * scale);
        let half = Vec3::from_array([0, 1, 2].map(|_| random.magnitude(0.03, 1.0))) * scale;
        match kind {
            0 => Self::Ball(Sphere { center: at, radius }),
            1 => Self::Rod(Capsule { from: at - along, to: at + along, radius }),
            2 => Self::Block(Cuboid { min: at - half, max: at + half }),
            _ => {
                let x = random.direction();
                let z = x.cross(random.direction()).normalize();
                let posed = Posed { half, middle: at, axes: [x, z.cross(x), z] };
                let mesh = meshed(&posed, [1, 2, 6][random.word() as usize % 3]);
                Self::Mesh(posed, mesh)
            }
        }
    }

    fn collider(&self) -> &dyn Collider {
        match self {
            Self::Ball(sphere) => sphere,
            Self::Rod(capsule) => capsule,
            Self::Block(cuboid) => cuboid,
            Self::Mesh(_, mesh) => mesh,
        }
    }

    /// How far a box is from it \[m\]; below zero, how deep in it.
    fn gap(&self, posed: &Posed) -> f32 {
        match self {
            Self::Ball(Sphere { center, radius }) => posed.gap(*center) - radius,
            Self::Rod(Capsule { from, to, radius }) => posed.gap_to([*from, *to]) - radius,
            Self::Block(Cuboid { min, max }) => {
                let (half, middle) = ((*max - *min) * 0.5, (*max + *min) * 0.5);
                posed.apart(&Posed { half, middle, axes: Vec3::AXES })
            }
            Self::Mesh(solid, _) => posed.apart(solid),
        }
    }
}

/// Whatever way it falls on a ball, a rod or a block, and however thin that is, a body is stopped at its surface.
#[test]
fn bodies_are_stopped_by_solids() {
    fall_on(&mut Random::new(61), 240, 0.03, |case| case / 2 % 3);
}

/// The same where it is a mesh, coarse or fine: on thin posts of many triangles a body may miss some that it has no room for, and goes deeper by little.
#[test]
fn bodies_are_stopped_by_meshes() {
    fall_on(&mut Random::new(62), 120, 0.08, |_| 3);
}

/// Lets so many bodies fall on solids of some kind, or the long run's number of them: they go in by such a share of half their longest side at the most.
fn fall_on(random: &mut Random, count: usize, share: f32, kind: impl Fn(usize) -> usize) {
    for case in 0..if cfg!(debug_assertions) { count } else { 25 * count } {
        let scale = [0.01, 1.0, 30.0][case % 3];
        let at = Vec3::ONE * if case % 4 == 3 { 20.0 * scale } else { 0.0 };
        let solid = Solid::any(random, kind(case), (at, scale));
        let half = Vec3::from_array([0, 1, 2].map(|_| random.magnitude(0.15, 0.5))) * scale;
        let corner =
            |i: usize| half * Vec3::from_array([0, 1, 2].map(|bit| if i >> bit & 1 == 1 { 1.0 } else { -1.0 }));
        let hulls = [HullBuf::of(&(0..8).map(corner).collect::<Vec<_>>()).expect("a hull")];
        let (axis, angle) = (random.direction(), random.between(0.0, 1.5));
        let turn = (axis * angle.sin()).extend(angle.cos()).to_array();
        // As high above it as it takes to be without.
        let mut place = at + random.vector(0.3) * Vec3::new(1.0, 0.0, 1.0) * scale;
        let body = loop {
            let upright = RigidBox::new(half, place, 0);
            let body = RigidBox { turn, hull: (case % 2 == 1).then_some(0), ..upright };
            let places = body.solid(Particle::REST).map(|particle| particle.position);
            if solid.gap(&Posed::of(half, &places)) > 0.05 * scale {
                break body;
            }
            place.y += 0.1 * scale;
        };
        let velocity = Vec3::NEG_Y * (random.between(0.0, 4.0) * scale);
        let start = body.solid(Particle { velocity, material: Some(0), ..Particle::REST });
        let mu = random.between(0.0, 1.0);
        let substeps = [10, 20, 40][case / 6 % 3];
        let method = Method::ALL[case % Method::ALL.len()];
        let scene = Scene {
            start: &start,
            forces: &Gravity { acceleration: Vec3::NEG_Y * (9.81 * scale) },
            colliders: solid.collider(),
            materials: &[ContactMaterial { elasticity: None, friction: Some(Friction { static_: mu, kinetic: mu }) }],
            constraints: &RigidBodies { boxes: [body], hulls: &hulls[..], balls: 0 },
            integrator: &method,
            substeps,
            ..Scene::EMPTY
        };
        let mut system = started(&scene, start.len(), 1);
        for frame in 1..=60 {
            system.step_to(&scene, Time::frame(frame, 60));
            let particles = system.particles();
            let gap = solid.gap(&Posed::of(half, particles.position));
            let fast = particles.velocity.iter().map(|v| v.length()).fold(0.0, f32::max);
            // And by a part of the way that it goes in a sub-step.
            let most = share * half.max_element() + 0.3 * fast / (60.0 * substeps as f32);
            assert!(-gap < most, "{case} after {frame}: {gap} of {half}, {substeps} {method:?}, {most}");
        }
    }
}
