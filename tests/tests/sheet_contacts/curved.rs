//! Sheets between curved scenery and other sheets, in long steps.

use super::cloths::{Cloths, G, cotton, square};
use pointmass::force::Friction;
use pointmass::material::ContactMaterial;
use pointmass::shape::{Collider, Sphere};
use pointmass::{Gravity, Method, Scene, Time, Vec3};
use pointmass_tests::{every, started};

/// Two sheets fly over a ball, one on the other: in a step they go around a part of it that a straight way would cut off.
#[test]
fn what_goes_around_a_ball_in_a_step_does_not_pass_what_lies_on_it() {
    for (rate, substeps, size, speed, method) in [
        (10u32, 40u32, 1.0f32, 1.0f32, Method::Symplectic),
        (6, 60, 0.1, 1.5, Method::Rk4),
        (15, 20, 10.0, 2.0, Method::Verlet),
        (4, 80, 1.0, 0.5, Method::Symplectic),
    ]
    .into_iter()
    .step_by(every(2))
    {
        let ball = Sphere { center: Vec3::ZERO, radius: 0.1 * size };
        let mut cloths = Cloths::default();
        for layer in 0..3 {
            let center = Vec3::new(-0.03 - 0.02 * layer as f32, 0.105 + 0.008 * layer as f32, 0.01) * size;
            let lean = 0.3 * layer as f32;
            let sides = [Vec3::new(0.3, 0.0, 0.3 * lean), Vec3::new(-0.3 * lean, 0.0, 0.3)].map(|side| side * size);
            let velocity = Vec3::new(speed * (1.0 - 0.3 * layer as f32), 0.0, 0.2 * speed) * size;
            cloths.add(&square(center, sides, 7), cotton(size), |x| x, velocity);
        }
        cloths.start.iter_mut().for_each(|particle| particle.material = Some(0));
        let smooth = [ContactMaterial { friction: Some(Friction { static_: 0.1, kinetic: 0.1 }), elasticity: None }];
        let gravity = Gravity { acceleration: Vec3::NEG_Y * (G * size) };
        let constraints = (&cloths.shells[..], cloths.contacts(0.004 * size));
        let colliders: &dyn Collider = &ball;
        let scene = Scene {
            start: &cloths.start,
            forces: &gravity,
            colliders,
            materials: &smooth,
            constraints: &constraints,
            substeps,
            integrator: method.integrator(),
            ..Scene::EMPTY
        };
        let mut system = started(&scene, cloths.start.len(), 0);
        assert_eq!(cloths.crossings(system.particles().position), 0);
        for frame in 1..=u64::from(rate * 4 / 5) {
            system.step_to(&scene, Time::frame(frame, rate));
            let x = system.particles().position;
            let inside = x.iter().filter(|x| x.length() < ball.radius).count();
            let crossings = cloths.crossings(x);
            assert!(
                crossings == 0 && inside == 0,
                "1/{rate} s, {substeps}, {size} m, frame {frame}: {crossings} {inside}"
            );
        }
        assert!(system.totals().hits > 0 && system.totals().contacts > 0, "{:?}", system.totals());
    }
}
