//! Rigid bodies on scenery that is round: they meet it by their corners, by edges that cross it and by faces.

use pointmass::constrain::{HullBuf, RigidBodies, RigidBox};
use pointmass::force::Friction;
use pointmass::shape::{Capsule, Collider, Sphere};
use pointmass::{ContactMaterial, Gravity, Method, Particle, Scene, Time, Vec3};
use pointmass_tests::{Random, started};

/// A body of eight particles, from which its pose is told.
struct Posed {
    half: Vec3,
    middle: Vec3,
    axes: [Vec3; 3],
}

impl Posed {
    /// That of particles that lie as those of a box do.
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
}

/// Whatever way it falls on a capsule or a ball, and however thin that is, a body is stopped at its surface: with a few corners, an edge or a face.
#[test]
fn bodies_are_stopped_by_what_is_round() {
    let mut random = Random::new(61);
    for case in 0..if cfg!(debug_assertions) { 240 } else { 6000 } {
        let scale = [0.01, 1.0, 30.0][case % 3];
        let far = Vec3::ONE * if case % 4 == 3 { 20.0 * scale } else { 0.0 };
        let radius = random.magnitude(0.03, 1.0) * scale;
        let along = random.direction() * (2.0 * scale);
        let ends = [far - along, far + along];
        let half = Vec3::from_array([0, 1, 2].map(|_| random.magnitude(0.15, 0.5))) * scale;
        let is_ball = case % 5 == 0;
        let capsule = Capsule { from: ends[0], to: ends[1], radius };
        let sphere = Sphere { center: far, radius };
        let colliders: &dyn Collider = if is_ball { &sphere } else { &capsule };

        let speed = random.between(0.0, 4.0) * scale;
        let (axis, angle) = (random.direction(), random.between(0.0, 1.5));
        let turn = (axis * angle.sin()).extend(angle.cos()).to_array();
        let corners: Vec<_> = (0..8)
            .map(|i| half * Vec3::from_array([0, 1, 2].map(|bit| if i >> bit & 1 == 1 { 1.0 } else { -1.0 })))
            .collect();
        let hull = HullBuf::of(&corners).expect("a hull");
        let is_hull = case % 2 == 1;
        // As high above it as it takes to be without.
        let mut place = far + random.vector(0.3) * Vec3::new(1.0, 0.0, 1.0) * scale;
        let gap_of = |places: &[Vec3]| {
            let posed = Posed::of(half, places);
            if is_ball { posed.gap(far) - radius } else { posed.gap_to(ends) - radius }
        };
        let cuboid = loop {
            let plain =
                if is_hull { RigidBox::with_hull(&hull.lend(), 0, place, 0) } else { RigidBox::new(half, place, 0) };
            let cuboid = RigidBox { turn, ..plain };
            if gap_of(&cuboid.solid(Particle::REST).map(|particle| particle.position)) > 0.05 * scale {
                break cuboid;
            }
            place.y += 0.1 * scale;
        };
        let whole = Particle { mass: 1.0, velocity: Vec3::NEG_Y * speed, material: Some(0), ..Particle::REST };
        let start = cuboid.solid(whole);
        let hulls = [hull.lend()];
        let bodies = RigidBodies { boxes: [cuboid], hulls: &hulls[..], balls: 0 };
        let gravity = Gravity { acceleration: Vec3::NEG_Y * (9.81 * scale) };
        let mu = random.between(0.0, 1.0);
        let materials = [ContactMaterial { elasticity: None, friction: Some(Friction { static_: mu, kinetic: mu }) }];
        let method = Method::ALL[case % Method::ALL.len()];
        let substeps = [10, 20, 40][case / 2 % 3];
        let scene = Scene {
            start: &start,
            forces: &gravity,
            colliders,
            materials: &materials,
            constraints: &bodies,
            integrator: &method,
            substeps,
            ..Scene::EMPTY
        };
        let mut system = started(&scene, start.len(), 1);
        for frame in 1..=60 {
            system.step_to(&scene, Time::frame(frame, 60));
            let gap = gap_of(system.particles().position);
            let fast = system.particles().velocity.iter().map(|v| v.length()).fold(0.0, f32::max);
            // By a hundredth of its longest side, and by a part of the way that it goes in a sub-step.
            let most = 0.02 * half.max_element() + 0.15 * fast / (60.0 * substeps as f32);
            assert!(-gap < most, "{case} after {frame}: {gap} of {half}, {radius}, {substeps} {method:?}");
        }
    }
}
