//! Bodies on sheets: they lie as high as these are thick, and are carried along by friction when these are drawn away.

use super::G;
use pointmass::scene::{Model, SceneFile};
use pointmass::{Time, Vec3};
use pointmass_tests::every;

const SIDE: f32 = 0.16;

/// A table, a cloth on it that is drawn away at 0.2 s, and a box on the cloth.
fn laid(scale: f32, mass: f32, friction: f32, thickness: f32, method: &str, substeps: u32) -> Model {
    let (cells, half) = (14, 0.3 * scale);
    let (thick, side, sheet) = (thickness * scale, SIDE * scale, 2.0 * half);
    let (low, high) = (0.5 * thick, thick + 0.3 * side);
    let held: Vec<u32> = (0..=cells).collect();
    let feel = format!("{{\"contact\": {{\"friction\": {{\"static\": {friction}, \"kinetic\": {friction}}}}}}}");
    let text = format!(
        r#"{{"run": {{"integrator": "{method}", "substeps": {substeps}, "dt": 0.0166666667}}, "materials": [{feel}],
        "scenery": [{{"shape": {{"plane": {{"point": [0, 0, 0], "normal": [0, 1, 0]}}}}, "material": 0}}],
        "forces": [{{"gravity": {{"acceleration": [0, -{G}, 0]}}}}],
        "constraints": [{{"attach": {{"particles": {held:?}, "motion": {{"keys": [{{"time": 0.2}}, {{"time": 0.25, "place": [0, 0, {first}]}},
            {{"time": 0.6, "place": [0, 0, {last}]}}]}}}}}}],
        "cloths": [{{"form": {{"sheet": {{"corner": [-{half}, {low}, {half}], "sides": [[{sheet}, 0, 0], [0, 0, -{sheet}]], "cells": [{cells}, {cells}]}}}},
            "density": 0.25, "material": 0, "elasticity": 0, "thickness": {thick}, "fixed": {held:?},
            "shell": {{"stretch": [4000, 4000], "shear": 1000, "bending": 5e-5, "damping": 2e-3}}}}],
        "boxes": [{{"sides": [{side}, {side_y}, {side}], "mass": {mass}, "position": [0, {high}, 0], "material": 0, "elasticity": 0}}]}}"#,
        first = 0.1 * scale,
        last = 1.2 * scale,
        side_y = 0.6 * side,
    );
    let file = SceneFile::from_json("laid.json", &text).expect("it is sound");
    Model::load(&file, "laid.json", &mut ()).expect("it can be made")
}

#[test]
fn a_cloth_is_drawn_away_from_under_a_box() {
    for case in [
        (1.0, 0.5, 0.2, 0.006, "symplectic", 20),
        (1.0, 0.4, 0.3, 0.008, "euler", 30),
        (2.0, 2.0, 0.3, 0.006, "verlet", 20),
        (0.5, 0.1, 0.2, 0.01, "rk4", 20),
    ]
    .into_iter()
    .step_by(every(2))
    {
        let (scale, mass, friction, thickness, method, substeps) = case;
        let model = laid(scale, mass, friction, thickness, method, substeps);
        let body = model.particles.len() - 8;
        let mut system = model.system(0, 1).expect("there is memory");
        let mut at = |frame: u64| {
            while system.time() < Time::frame(frame, 60) {
                system.step(&model.scene(), Time::frame(1, 60));
            }
            let rows = system.particles();
            let mean = |of: &[Vec3]| of[body..].iter().sum::<Vec3>() / 8.0;
            (mean(rows.position), mean(rows.velocity))
        };
        let [lay, from, to, end] = [12, 15, 19, 40].map(&mut at);
        let height = |x: Vec3| (x.y - 0.3 * SIDE * scale) / (thickness * scale);
        assert!((0.96..1.01).contains(&height(lay.0)), "{case:?}: it lies at {}", height(lay.0));
        // It slides on what goes faster, and then on the table.
        let gained = (to.1.z - from.1.z) / (friction * G * 4.0 / 60.0);
        assert!((gained - 1.0).abs() < 0.08, "{case:?}: it gains {gained} of what friction gives");
        assert!(height(end.0).abs() < 0.02 && end.1.length() < 1e-3 * scale, "{case:?}: {end:?}");
        let way = end.0 / scale;
        assert!((0.02..0.12).contains(&way.z) && way.x.abs() < 1e-3, "{case:?}: {way}");
    }
}

#[test]
fn what_cannot_be_is_refused_by_name() {
    let refused = |cloth: &str| {
        let text = format!(
            r#"{{"contacts": {{"position": {{}}}}, "boxes": [{{"sides": [1, 1, 1], "mass": 1, "position": [0, 9, 0]}}],
            "cloths": [{{"form": {{"sheet": {{"corner": [0, 0, 0], "sides": [[1, 0, 0], [0, 0, 1]], "cells": [20, 10]}}}}, "mass": 1,
             "springs": {{"structural": {{"ks": 100, "kd": 0}}}}, {cloth}}}]}}"#
        );
        let file = SceneFile::from_json("a.json", &text).expect("it is sound");
        file.check().and_then(|()| Model::load(&file, "a.json", &mut ())).map(|_| ()).map_err(|error| error.to_string())
    };
    // Neighbours in so fine a sheet would push each other as balls.
    assert_eq!(refused(r#""thickness": 0.05"#), Ok(()));
    let message = refused(r#""thickness": 0.051"#).expect_err("too thick");
    assert!(message.contains("cloths[0].thickness") && message.contains("shortest edge"), "{message}");
    let torn = refused(r#""breaks_at": 1.5, "limits": {"warp": [0.9, 1.1]}"#).expect_err("it would not tear");
    assert!(torn.contains("cloths[0].limits") && torn.contains("breaks_at"), "{torn}");
}
