//! Bodies that hang from each other by ropes: what several ropes pull at is solved for all of them together.

use pointmass::scene::{Model, SceneFile};
use pointmass::{Measures, Method, Scene, Time, Vec3};
use pointmass_tests::{gap, is_third, run, started};

/// So many boxes of 0.2 m, each on a rope of 0.3 m to the one above, all along one line; the first rope is fixed, or there is none.
fn chain(masses: &[f32], segments: u32, tilt: f32, is_hung: bool) -> Model {
    let along = Vec3::new(tilt.sin(), -tilt.cos(), 0.0);
    let (mut boxes, mut ropes) = (Vec::new(), Vec::new());
    for (i, mass) in masses.iter().enumerate() {
        let from = along * (0.5 * i as f32);
        let (to, middle) = (from + along * 0.3, from + along * 0.4);
        let [a, b, c] = [from, to, middle].map(|place| format!("[{}, {}, {}]", place.x, place.y, place.z));
        boxes.push(format!(
            r#"{{"sides": [0.2, 0.2, 0.2], "mass": {mass}, "position": {c}, "turn": [0, 0, {tilt}], "elasticity": 0}}"#
        ));
        let above = if i == 0 { "null".into() } else { format!(r#"{{"box": {}}}"#, i - 1) };
        let fixed = if i == 0 { r#""fixed": [0],"# } else { "" };
        if i > 0 || is_hung {
            ropes.push(format!(
                r#"{{"curve": [{a}, {b}], "segments": {segments}, "diameter": 0.008, "density": 1000, {fixed} "ends": [{above}, {{"box": {i}}}]}}"#
            ));
        }
    }
    let gravity = if is_hung { r#"{"gravity": {"acceleration": [0, -9.80665, 0]}}"# } else { "" };
    let text =
        format!(r#"{{"forces": [{gravity}], "boxes": [{}], "ropes": [{}]}}"#, boxes.join(", "), ropes.join(", "));
    let file = SceneFile::from_json("it.json", &text).unwrap_or_else(|error| panic!("{error}: {text}"));
    Model::load(&file, "it.json", &mut ()).unwrap()
}

/// They swing for ever, in few sub-steps as in many, whichever are heavier, and ropes stay as long as they are.
#[test]
fn bodies_below_each_other_keep_their_energy() {
    let cases: [(&[f32], u32); 4] = [(&[1.0, 1.0], 8), (&[1.0; 5], 3), (&[2.0, 1.0, 0.7], 2), (&[1.0, 0.5, 3.0], 1)];
    let mut turn = 0;
    for (masses, segments) in cases {
        let model = chain(masses, segments, 0.5, true);
        for substeps in [1u32, 2, 5] {
            for method in [Method::Symplectic, Method::Verlet, Method::Rk4] {
                if !is_third(&mut turn) {
                    continue;
                }
                let scene = Scene { substeps, integrator: method.integrator(), ..model.scene() };
                let mut system = started(&scene, model.particles.len(), 1);
                let name = format!("{masses:?}, {segments} segments, {substeps} sub-steps, {method}");
                let energy = |system: &_| Measures::of(system, &scene).energy.total();
                let begun = energy(&system);
                // What falls as far as it can is so much lower.
                let weight: f64 = masses.iter().enumerate().map(|(i, &m)| f64::from(m) * (0.4 + 0.5 * i as f64)).sum();
                let swing = 9.80665 * weight * (1.0 - 0.5f64.cos());
                let (mut gained, mut lost) = (0.0f64, 0.0f64);
                for half in 1..=10 {
                    run(&mut system, &scene, 1.0 / 60.0, 30 * half);
                    let change = (energy(&system) - begun) / swing;
                    (gained, lost) = (gained.max(change), lost.max(-change));
                    let x = system.particles().position;
                    for rope in 0..masses.len() {
                        let first = 8 * masses.len() + rope * (segments as usize + 1);
                        let link = 0.3 / segments as f32;
                        let off = |ends: &[Vec3]| (ends[0].distance(ends[1]) / link - 1.0).abs();
                        let worst = x[first..=first + segments as usize].windows(2).map(off).fold(0.0, f32::max);
                        // A body that turns takes an end along on its arc, behind what the rope has been solved for.
                        assert!(worst < 0.02 / (substeps * substeps) as f32, "{name}: {worst}");
                    }
                }
                println!("{name}: {gained:.4} gained, {lost:.4} lost of {swing:.3} J");
                let most = 0.06 / f64::from(substeps);
                assert!(gained < most && lost < most, "{name}: {gained} gained, {lost} lost");
            }
        }
    }
}

/// How far they have swung after a second does not depend on how many sub-steps there are.
#[test]
fn bodies_below_each_other_swing_alike_in_few_sub_steps() {
    let model = chain(&[1.0, 0.4, 2.0, 1.0], 4, 0.4, true);
    for method in [Method::Symplectic, Method::Verlet] {
        let lowest = |substeps: u32| {
            let scene = Scene { substeps, integrator: method.integrator(), ..model.scene() };
            let mut system = started(&scene, model.particles.len(), 1);
            for frame in 1..=60 {
                let report = system.step_to(&scene, Time::frame(frame, 60));
                assert_eq!(report.effort.capped, 0, "{substeps}, {method}, frame {frame}");
            }
            system.particles().position[24..32].iter().sum::<Vec3>() / 8.0
        };
        let should = lowest(24);
        for substeps in [1u32, 2, 6] {
            let off = (lowest(substeps) - should).length();
            assert!(off < 0.02 / substeps as f32, "{method}, {substeps}: {off} m");
        }
    }
}

/// Bodies that nobody holds keep their momenta, and gain no energy, while their ropes are solved again and again.
#[test]
fn free_bodies_on_several_ropes_keep_their_momenta() {
    for (masses, segments, substeps, method) in [
        (&[1.0f32, 1.0, 1.0][..], 3u32, 1u32, Method::Symplectic),
        (&[2.0, 0.5, 1.0, 3.0], 1, 4, Method::Verlet),
        (&[1.0, 3.0, 1.0], 5, 3, Method::Rk4),
    ] {
        let mut model = chain(masses, segments, 0.7, false);
        for (i, particle) in model.particles.iter_mut().enumerate() {
            let body = (i / 8).min(masses.len()) as f32;
            particle.velocity = Vec3::new((3.0 * body).sin(), (5.0 * body).cos(), 0.6 - 0.4 * body);
        }
        let scene = Scene { substeps, integrator: method.integrator(), ..model.scene() };
        let mut system = started(&scene, model.particles.len(), 1);
        let begun = Measures::of(&system, &scene);
        run(&mut system, &scene, 1.0 / 60.0, 30);
        let (set_out, mut most) = (Measures::of(&system, &scene).energy.total(), 0.0f64);
        for half in 2..=12 {
            run(&mut system, &scene, 1.0 / 60.0, 30 * half);
            most = most.max(Measures::of(&system, &scene).energy.total());
        }
        let now = Measures::of(&system, &scene);
        let name = format!("{masses:?}, {substeps}, {method}");
        let mass: f64 = model.particles.iter().map(|p| f64::from(p.mass)).sum();
        assert!(gap(begun.momentum, now.momentum) < 1e-5 * mass, "{name}: {:?} {:?}", begun.momentum, now.momentum);
        let turned = gap(begun.angular_momentum, now.angular_momentum);
        assert!(turned < 2e-3 * mass, "{name}: {turned} {:?}", begun.angular_momentum);
        println!("{name}: {set_out} J, then {most} J, L off by {turned}");
        assert!(most < set_out * 1.002, "{name}: {most} J of {set_out}");
    }
}
