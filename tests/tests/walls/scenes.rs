//! Scene files with walls that move, ground and balls.

use pointmass::scene::{Files, Model, SceneFile, write_scn};
use pointmass::shape::MeshBuf;
use pointmass::{Heap, Method, Scene, System, Time, Vec3};
use pointmass_tests::is_third;

struct NoFiles;

impl Files for NoFiles {
    fn text(&mut self, path: &str) -> Result<String, String> {
        Err(format!("there is no {path}"))
    }
    fn mesh(&mut self, path: &str) -> Result<MeshBuf, String> {
        Err(format!("there is no {path}"))
    }
    fn exists(&mut self, _: &str) -> bool {
        false
    }
}

fn load(text: &str) -> Result<Model, String> {
    let file = SceneFile::from_json("test.json", text).map_err(|error| error.to_string())?;
    Model::load(&file, "test.json", &mut NoFiles).map_err(|error| error.to_string())
}

const MILL: &str = r#"{
  "particles": [{"position": [0.5, 3, 0.5], "radius": 0.1}, {"position": [3, 1, 0], "velocity": [0, 0, 0]}],
  "forces": [{"gravity": {"acceleration": [0, -9.8, 0]}}],
  "scenery": [
    {"shape": {"heightfield": {"origin": [-4, 0, -4], "spacing": 4, "columns": 3, "heights": [0, 1, 0, 1, 2, 1, 0, 1, 0]}}},
    {"shape": {"box": {"min": [-3.5, 0.9, -0.1], "max": [3.5, 1.6, 0.1]}}, "motion": {"spin": 0.5, "axis": [0, 1, 0]}}
  ]
}"#;

#[test]
fn a_scene_with_a_mill_on_a_hill_runs() {
    let model = load(MILL).expect("nothing is wrong with it");
    let mut system = System::with(Heap::new(model.size(4)));
    system.start(&model.scene(), 0).expect("the memory is made for it");
    for i in 1..=60 {
        system.step(&model.scene(), Time::frame(i, 60) - system.time());
    }
    let p = system.particles();
    assert_eq!(p.position.len(), 2);
    // The ball lies on the hill or rolls down it; the point was taken by the blade.
    assert!(p.position[0].y > 1.0 && (p.position[0] - Vec3::new(0.5, 3.0, 0.5)).length() > 0.5, "{}", p.position[0]);
    assert!(system.totals().hits > 0);
}

#[test]
fn what_scn_cannot_say_is_warned_of() {
    let file = SceneFile::from_json("test.json", MILL).expect("it is a scene");
    assert_eq!(SceneFile::from_json("again.json", &file.to_json()).expect("it was written"), file);
    let (text, warnings) = write_scn(&file);
    assert!(warnings.iter().any(|w| w.contains("scenery[1].motion")), "{warnings:?}");
    assert!(warnings.iter().any(|w| w.contains("scenery[0]") && w.contains("a height field")), "{warnings:?}");
    assert!(!text.contains("heightfield") && text.contains("box"));
}

#[test]
fn what_cannot_be_used_is_refused() {
    let grid = |columns: u32| {
        format!(
            r#"{{"scenery": [{{"shape": {{"heightfield":
            {{"origin": [0, 0, 0], "spacing": 1, "columns": {columns}, "heights": [0, 0, 0, 0]}}}}}}]}}"#
        )
    };
    assert!(load(&grid(2)).is_ok());
    assert!(load(&grid(3)).expect_err("no full rows").contains("full rows"));
    let still = r#"{"scenery": [{"shape": {"sphere": {"center": [0, 0, 0], "radius": 1}}, "motion": {"spin": 1, "axis": [0, 0, 0]}}]}"#;
    assert!(load(still).expect_err("no axis").contains("scenery[0].motion"));
    let squashed = |radius: f32| {
        format!(
            r#"{{"particles": [{{"position": [0, 5, 0], "radius": {radius}}}],
            "groups": [{{"matrix": [[2, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]}}],
            "scenery": [{{"shape": {{"sphere": {{"center": [0, 0, 0], "radius": 1}}}}, "group": 0}}]}}"#
        )
    };
    assert!(load(&squashed(0.0)).is_ok(), "points meet an ellipsoid");
    assert!(load(&squashed(0.1)).expect_err("balls do not").contains("scenery[0].group"));
}

/// A floor that goes anywhere at an even speed, as a lift does, is one that stands still to what lies on it and goes along: points, balls, ropes and cloths stay
/// down on it, whatever the sub-steps.
#[test]
fn what_lies_on_a_lift_stays_down_on_it() {
    let things = [
        r#""particles": [{"position": [0, 0, 0], "velocity": V}, {"position": [0.3, 0.05, 0], "velocity": V, "radius": 0.05}]"#,
        r#""ropes": [{"curve": [[0, 0, 0], [0.5, 0, 0.1]], "segments": 10, "diameter": 0.01, "density": 900, "velocity": V}]"#,
        r#""cloths": [{"form": {"sheet": {"corner": [0, 0, 0], "sides": [[0.5, 0, 0], [0, 0, 0.5]], "cells": [5, 5]}},
            "density": 0.3, "shell": {"stretch": [1000, 1000], "shear": 60, "bending": 5e-5, "damping": 0.003}, "velocity": V}]"#,
    ];
    let mut cases = 0;
    for speed in [-5.0f32, -1.0, -0.1, 0.1, 1.0, 5.0] {
        for along in [0.0, 1.0] {
            for (thing, &method) in
                things.iter().flat_map(|thing| Method::ALL.iter().map(move |method| (thing, method)))
            {
                if !is_third(&mut cases) {
                    continue;
                }
                let velocity = format!("[{}, {speed}, 0]", along * speed);
                let text = format!(
                    r#"{{"forces": [{{"gravity": {{"acceleration": [0, -9.81, 0]}}}}],
                    "scenery": [{{"shape": {{"plane": {{"point": [0, 0, 0], "normal": [0, 1, 0]}}}}, "motion": {{"drift": {velocity}}}}}],
                    {}}}"#,
                    thing.replace('V', &velocity)
                );
                let model = load(&text).expect("nothing is wrong with it");
                for substeps in [1, 3, 10] {
                    let scene = Scene { substeps, integrator: method.integrator(), ..model.scene() };
                    let mut system = System::with(Heap::new(scene.size()));
                    system.start(&scene, 0).expect("the memory is made for it");
                    for frame in 1..=60 {
                        system.step_to(&scene, Time::frame(frame, 60));
                        let floor = speed * frame as f32 / 60.0;
                        let p = system.particles();
                        for (x, radius) in p.position.iter().zip(p.radius) {
                            let (above, what) = (x.y - floor - radius, &model.particles.len());
                            let most = 1e-4 + 1e-5 * speed.abs();
                            assert!(
                                above.abs() < most,
                                "{what} {} {velocity} {substeps}, {frame}: {above}",
                                method.name()
                            );
                        }
                    }
                }
            }
        }
    }
}
