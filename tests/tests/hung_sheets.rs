//! Sheets of scene files that say how far they stretch where they hang: they do, however many cells they have.

use pointmass::scene::{Model, SceneFile};
use pointmass::{Method, Scene};
use pointmass_tests::{is_third, run, started};

fn model(text: &str) -> Result<Model, String> {
    let file = SceneFile::from_json("it.json", text).map_err(|error| error.to_string())?;
    Model::load(&file, "it.json", &mut ()).map_err(|error| error.to_string())
}

/// A sheet that hangs by an edge is longer by so many percent, the mean of its lower edge, however many cells it has.
#[test]
fn sheets_stretch_by_their_percent_however_fine_they_are() {
    let (percent, mut cases) = ([0.5, 6.0], 0);
    for (number, cells) in [[1u32, 1u32], [3, 2], [8, 8], [5, 16]].into_iter().enumerate() {
        for along in 0..2 {
            for scale in [0.3, 3.0f32] {
                if !is_third(&mut cases) {
                    continue;
                }
                let count = (cells[0] + 1) * (cells[1] + 1);
                let held = (0..count).filter(|i| [i % (cells[0] + 1), i / (cells[0] + 1)][along] == 0);
                let (down, wide) = (format!("[0, -{scale}, 0]"), format!("[{}, 0, 0]", 0.7 * scale));
                let sides = if along == 0 { [down, wide] } else { [wide, down] }.join(", ");
                let drag = 0.2 * 0.7 * scale * scale * 8.0 / count as f32;
                let text = format!(
                    r#"{{"forces": [{{"gravity": {{"acceleration": [0, -9.80665, 0]}}}}, {{"drag": {{}}}}], "cloths": [{{"density": 0.2,
                    "form": {{"sheet": {{"corner": [0, 0, 0], "sides": [{sides}], "cells": {cells:?}}}}},
                    "hung": {{"stretch": {percent:?}, "shear": 0.2, "damping": 0.05}}, "drag": {drag}, "fixed": {:?}}}]}}"#,
                    held.collect::<Vec<_>>()
                );
                let model = model(&text).unwrap();
                let method = [Method::Symplectic, Method::Verlet, Method::Rk4][number % 3];
                let scene = Scene { substeps: 10, integrator: method.integrator(), ..model.scene() };
                let mut system = started(&scene, model.particles.len(), 1);
                run(&mut system, &scene, 1.0 / 60.0, 240);
                let x = system.particles().position;
                let last = |i: &u32| [i % (cells[0] + 1), i / (cells[0] + 1)][along] == cells[along];
                let below: Vec<_> = (0..count).filter(last).map(|i| f64::from(x[i as usize].y)).collect();
                let share = -below.iter().sum::<f64>() / below.len() as f64 / f64::from(scale) - 1.0;
                let should = 0.01 * percent[along];
                let name = format!("{cells:?} along {along}, {scale} m, {method}");
                assert!((share / should - 1.0).abs() < 0.03, "{name}: {share}, not {should}");
            }
        }
    }
}

#[test]
fn hung_sheets_that_cannot_be_are_refused_by_name() {
    let sheet = r#"{"sheet": {"corner": [0, 0, 0], "sides": [[1, 0, 0], [0, 1, 0]], "cells": [2, 2]}}"#;
    for (rest, words) in [
        (r#""mass": 1, "hung": {"stretch": [1, 1]}"#, "hung: needs the cloth's density"),
        (r#""density": 1, "hung": {"stretch": [1, 0]}"#, "hung.stretch: has to be above zero, not 0"),
        (
            r#""density": 1, "hung": {"stretch": [1, 1e-45]}"#,
            "hung.stretch: makes it stiffer or softer than 32-bit floats",
        ),
        (r#""density": 1, "hung": {"stretch": [1, 1], "shear": -1}"#, "hung.shear: has to be zero or more"),
        (
            r#""density": 1, "hung": {"stretch": [1, 1]}, "shell": {"stretch": [1, 1], "shear": 1}"#,
            "hung: say either hung, by what it does, or shell",
        ),
        (
            r#""density": 1, "hung": {"stretch": [1, 1]}, "limits": {"shear": 0.1}"#,
            "limits: are those of cloth made of springs",
        ),
    ] {
        let said = model(&format!(r#"{{"cloths": [{{"form": {sheet}, {rest}}}]}}"#)).unwrap_err();
        assert!(said.contains(&format!("cloths[0].{words}")), "{rest}: {said}");
    }
    let said = model(r#"{"cloths": [{"form": {"mesh": "it.off"}, "density": 1, "hung": {"stretch": [1, 1]}}]}"#);
    assert!(said.unwrap_err().contains("cloths[0].hung: is for sheets"));
}
