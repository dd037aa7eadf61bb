//! Balls in bowls: a surface that curves gives nothing to what slides on it, whichever way contacts are kept.

use pointmass::motion::Motion;
use pointmass::shape::{Aabb, Capsule, Collider, Cylinder, Moving, Sphere};
use pointmass::{Constraint, Contacts, Gravity, Meetings, Method, Particle, Scene, Time, Vec3};
use pointmass_tests::{is_run, started};

const G: f32 = 9.8;

/// The ways to keep contacts: none, by impulse, and by position in so many sub-steps.
const WAYS: [(&str, Meetings, &dyn Constraint, u32); 4] = [
    ("through", Meetings::Through, &(), 1),
    ("by impulse", Meetings::IMPULSE, &(), 1),
    ("by position", Meetings::Through, &Contacts::HARD, 1),
    ("by position in twelve", Meetings::Through, &Contacts::HARD, 12),
];

/// Balls that fall into a bowl of a radius of 1 m.
fn balls(count: usize, elasticity: f32, home: Vec3) -> Vec<Particle> {
    (0..count as u16)
        .map(|i| {
            let high = if i % 2 == 0 { -0.6 } else { -0.3 };
            let position = home + Vec3::new(-0.5 + 0.2 * f32::from(i), high, 0.11 * f32::from(i));
            Particle { position, velocity: Vec3::new(0.3, 0.0, 0.4), radius: 0.08, elasticity, ..Particle::REST }
        })
        .collect()
}

/// The energy of each kilogram at the beginning, above the lowest place \[J/kg\], and how much it has risen at the most above the least before.
fn energies(scene: &Scene<'_>, h: f64, end: f64, floor: f32) -> [f32; 2] {
    let mut system = started(scene, scene.start.len(), 1);
    let (mut opening, mut least, mut risen) = (0.0, f32::INFINITY, 0.0f32);
    for i in 0..=(end / h).round() as u32 {
        system.step(scene, Time::from_seconds_f64(h * f64::from(i)) - system.time());
        let all = system.particles();
        let each = all.position.iter().zip(all.velocity);
        let energy = each.map(|(x, v)| 0.5 * v.length_squared() + G * (x.y - floor)).sum::<f32>();
        if i == 0 {
            opening = energy;
        }
        least = least.min(energy);
        risen = risen.max(energy - least);
    }
    [opening, risen]
}

/// One alone keeps its energy by impulse as closely as without contacts; what is gained by being pushed apart is little of it, and comes and goes.
#[test]
fn balls_in_bowls_gain_nothing() {
    let mut cases = 0;
    let all = Aabb { min: Vec3::NEG_INFINITY, max: Vec3::INFINITY };
    for far in [0.0f32, 20.0] {
        let home = Vec3::new(far, -far, 0.5 * far);
        let sphere = Sphere { center: home, radius: 1.0 };
        let tank = Cylinder { center: home, radius: 1.0, height: 2.0 };
        let pill = Capsule { from: home - Vec3::X * 0.5, to: home + Vec3::X * 0.5, radius: 1.0 };
        for (name, bowl) in [("sphere", &sphere as &dyn Collider), ("tank", &tank), ("capsule", &pill)] {
            for &method in Method::ALL {
                for (way, meetings, constraints, substeps) in WAYS {
                    for (count, elasticity, h) in [
                        (1, 0.0, 1.0 / 60.0),
                        (1, 0.5, 1.0 / 24.0),
                        (2, 0.0, 1.0 / 24.0),
                        (2, 0.6, 1.0 / 60.0),
                        (6, 0.3, 1.0 / 60.0),
                    ] {
                        // Explicit Euler gains in flight.
                        if method == Method::Euler || !is_run(&mut cases) {
                            continue;
                        }
                        // What turns within itself drives nobody that slides without friction.
                        let motion = Motion { pivot: home, spin: 0.5, ..Motion::STILL };
                        let spinning = Moving::new(bowl, &all, motion);
                        let spins = cases % 2 == 0 && name != "capsule";
                        let colliders: &dyn Collider = if spins { &spinning } else { bowl };
                        let start = balls(count, elasticity, home);
                        let forces = Gravity { acceleration: Vec3::NEG_Y * G };
                        let scene = Scene {
                            start: &start,
                            forces: &forces,
                            colliders,
                            integrator: &method,
                            meetings,
                            constraints,
                            substeps,
                            ..Scene::EMPTY
                        };
                        let [opening, risen] = energies(&scene, h, 4.0, home.y - 1.0);
                        let is_exact = way == "through" || way == "by impulse" && count == 1;
                        // What methods of first order show as energy comes and goes by v g h / 2.
                        let first_order = matches!(method, Method::Symplectic | Method::Implicit);
                        let exact = if spins { 0.01 } else { 1e-3 };
                        let most =
                            if is_exact { exact } else { 0.05 + f32::from(u8::from(first_order)) * 2.0 * h as f32 };
                        let case =
                            format!("{count} in a {name} ({spins}) at {far} m, {way}, {method} by {h}, {elasticity}");
                        assert!(risen < most * opening, "{case}: {risen} J of {opening} J");
                    }
                }
            }
        }
    }
}
