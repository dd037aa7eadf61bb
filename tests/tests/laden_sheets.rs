//! Sheets that bear what is tied to them: weights, bars, and hooks that they hang from, whatever the sub-steps.

use pointmass::scene::{Model, SceneFile};
use pointmass::{Heap, System, Time};
use pointmass_tests::{f64s, methods, started};
use serde_json::{Value, json};

/// The points of an edge of the sheet.
const EDGE: usize = 13;
const G: f64 = 9.81;

/// A sheet of 1 m and 0.2 kg in the plane z = 0, below a top edge of which some points are fixed.
fn sheet(fixed: &[usize]) -> Value {
    json!({
        "form": {"sheet": {"corner": [-0.5, 1, 0], "sides": [[1, 0, 0], [0, -1, 0]], "cells": [EDGE - 1, EDGE - 1]}},
        "density": 0.2, "shell": {"stretch": [400, 400], "shear": 100, "bending": 2e-5, "damping": 0.02}, "fixed": fixed,
    })
}

fn top() -> Vec<usize> {
    (0..EDGE).collect()
}

fn bottom() -> Vec<usize> {
    (EDGE * (EDGE - 1)..EDGE * EDGE).collect()
}

/// A bar along the bottom edge.
fn bar() -> Value {
    json!({
        "cloths": [sheet(&top())],
        "boxes": [{"sides": [1, 0.02, 0.02], "mass": 0.5, "position": [0, -0.01, 0]}],
        "ties": [{"of": {"cloth": 0}, "points": bottom(), "to": {"box": 0}}],
    })
}

/// A weight at a corner, and one within a cell.
fn weights() -> Value {
    json!({
        "cloths": [sheet(&top())],
        "particles": [{"position": [-0.5, 0, 0], "mass": 0.1}, {"position": [0.22, 0.53, 0], "mass": 0.3}],
        "ties": [{"points": [0, 1], "to": {"cloth": 0}}],
    })
}

/// Two hooks that nothing moves: bodies at corners, or particles within cells.
fn hooks(within: bool) -> Value {
    let at = |x: f64| json!({"position": [x, 0.97, 0], "mass": 1, "fixed": true});
    let block = |x: f64| json!({"sides": [0.1, 0.1, 0.1], "mass": 1, "position": [x, 1.05, 0], "fixed": true});
    let tie = |point: usize, body: usize| json!({"of": {"cloth": 0}, "points": [point], "to": {"box": body}});
    if within {
        json!({"cloths": [sheet(&[])], "particles": [at(-0.46), at(0.46)], "ties": [{"points": [0, 1], "to": {"cloth": 0}}]})
    } else {
        json!({"cloths": [sheet(&[])], "boxes": [block(-0.5), block(0.5)], "ties": [tie(0, 0), tie(EDGE - 1, 1)]})
    }
}

fn model(parts: &Value, substeps: u32, method: &str, acceleration: f64) -> Model {
    let mut scene = json!({
        "run": {"duration": 10, "dt": 1.0 / 60.0, "substeps": substeps, "integrator": method},
        "forces": [{"gravity": {"acceleration": [0, -acceleration, 0]}}, {"drag": {}}],
    });
    scene.as_object_mut().expect("an object").extend(parts.as_object().expect("an object").clone());
    let file = SceneFile::from_json("it.json", &scene.to_string()).unwrap_or_else(|error| panic!("{error}"));
    Model::load(&file, "it.json", &mut ()).unwrap_or_else(|error| panic!("{error}"))
}

/// How low the lowest particle is after so many seconds, and how fast the fastest \[m, m/s\].
fn hangs(parts: &Value, substeps: u32, method: &str) -> [f32; 2] {
    let mut parts = parts.clone();
    // Drag, so that it comes to rest.
    for kind in ["cloths", "boxes", "particles"] {
        for body in parts.get_mut(kind).and_then(Value::as_array_mut).into_iter().flatten() {
            body["drag"] = json!(if kind == "cloths" { 0.002 } else { 0.3 });
        }
    }
    let model = model(&parts, substeps, method, G);
    let scene = model.scene();
    let mut system = started(&scene, model.particles.len(), 1);
    for frame in 1..=240 {
        system.step_to(&scene, Time::frame(frame, 60));
    }
    let particles = system.particles();
    let low = particles.position.iter().map(|place| place.y).fold(f32::INFINITY, f32::min);
    let fast = particles.velocity.iter().map(|velocity| velocity.length()).fold(0.0, f32::max);
    [low, fast]
}

/// What hangs from a sheet, or a sheet that hangs, is as low in one sub-step as in many, but for some times how far all falls in a sub-step.
#[test]
fn sheets_bear_what_is_tied_to_them() {
    for (name, parts) in [("bar", bar()), ("weights", weights()), ("hooks", hooks(false)), ("within", hooks(true))] {
        let [right, _] = hangs(&parts, 30, "verlet");
        for (round, substeps) in [1, 2, 6].into_iter().enumerate() {
            for method in methods(round) {
                let method = method.to_string();
                // The corner beyond a hook hangs over it in one of two ways, and Euler's method shakes it from one to the other.
                if name == "within" && method == "euler" {
                    continue;
                }
                let [low, fast] = hangs(&parts, substeps, &method);
                let falls = (G / (60.0 * f64::from(substeps)).powi(2)) as f32;
                let name = format!("{name}: {method} x{substeps}");
                assert!((low - right).abs() < 4.0 * falls + 0.004, "{name}: {low} for {right} m");
                assert!(fast < 0.1 + if method == "euler" { 60.0 * falls } else { 0.0 }, "{name}: {fast} m/s");
            }
        }
    }
}

/// A sheet below another, sewn on edge to edge.
fn curtains(fixed: &[usize]) -> Value {
    let mut lower = sheet(&[]);
    lower["form"]["sheet"]["corner"] = json!([-0.5, 0, 0]);
    json!({
        "cloths": [sheet(fixed), lower],
        "ties": [{"of": {"cloth": 1}, "points": top(), "to": {"cloth": 0}}],
    })
}

/// A rod along the hem, or a rope.
fn hem(fixed: &[usize], kind: &str) -> Value {
    let curve = json!([[-0.5, 0, 0], [0.5, 0, 0]]);
    let along = match kind {
        "strand" => {
            json!({"form": {"curve": curve}, "segments": EDGE - 1, "radius": 0.008, "young": 1e7, "density": 900, "damping": 0.01})
        }
        _ => json!({"curve": curve, "segments": EDGE - 1, "diameter": 0.016, "density": 900}),
    };
    json!({
        "cloths": [sheet(fixed)], (format!("{kind}s")): [along],
        "ties": [{"of": {(kind): 0}, "points": top(), "to": {"cloth": 0}}],
    })
}

/// Two bodies that are solved for apart and sewn together hang still, as low as with many sub-steps but for what the seam opens: some n² g h² where n
/// rows hang below.
#[test]
fn sheets_hang_still_with_what_is_solved_for_apart() {
    for (name, parts) in [("curtains", curtains(&top())), ("rod", hem(&top(), "strand")), ("rope", hem(&top(), "rope"))]
    {
        let [right, _] = hangs(&parts, 30, "verlet");
        for (round, substeps) in [1, 2, 6].into_iter().enumerate() {
            for method in methods(round) {
                let method = method.to_string();
                let [low, fast] = hangs(&parts, substeps, &method);
                let falls = (G / (60.0 * f64::from(substeps)).powi(2)) as f32;
                let name = format!("{name}: {method} x{substeps}");
                assert!((low - right).abs() < (EDGE * EDGE) as f32 * falls + 0.004, "{name}: {low} for {right} m");
                assert!(fast < 0.1 + 60.0 * falls, "{name}: {fast} m/s");
            }
        }
    }
}

/// The momentum and the angular momentum of all, the sum of the sizes of the former, and the energy of motion.
fn momenta(system: &System<Heap>) -> ([f64; 3], [f64; 3], f64, f64) {
    let particles = system.particles();
    let (mut sum, mut spin, mut size, mut energy) = ([0.0; 3], [0.0; 3], 0.0, 0.0);
    for row in 0..particles.position.len() {
        let mass = f64::from(particles.mass[row]);
        let [x, v] = [particles.position[row], particles.velocity[row]].map(f64s);
        for k in 0..3 {
            let [next, last] = [(k + 1) % 3, (k + 2) % 3];
            sum[k] += mass * v[k];
            spin[k] += mass * (x[next] * v[last] - x[last] * v[next]);
            energy += 0.5 * mass * v[k] * v[k];
        }
        size += mass * v.iter().map(|v| v * v).sum::<f64>().sqrt();
    }
    (sum, spin, size, energy)
}

/// A free sheet and what is tied to it keep their momenta, and gain no energy.
#[test]
fn free_sheets_keep_their_momenta_with_what_is_tied_to_them() {
    let weights = json!({
        "cloths": [sheet(&[])],
        "particles": [{"position": [-0.5, 0, 0], "mass": 0.5, "velocity": [0, 0, 1]},
            {"position": [0.48, 0.52, 0], "mass": 0.3, "velocity": [0, 0.3, -1]}],
        "ties": [{"points": [0, 1], "to": {"cloth": 0}}],
    });
    let mut bar = bar();
    (bar["cloths"][0]["fixed"], bar["boxes"][0]["velocity"]) = (json!([]), json!([0, 0, 2]));
    let mut curtains = curtains(&[]);
    curtains["cloths"][1]["velocity"] = json!([0, 0, 1]);
    for (name, parts) in [("weights", weights), ("bar", bar), ("curtains", curtains)] {
        for (round, substeps) in [1, 3, 10].into_iter().enumerate() {
            for method in
                methods(round).filter(|method| !matches!(method.to_string().as_str(), "euler" | "lecture_midpoint"))
            {
                let name = format!("{name}: {method} x{substeps}");
                let model = model(&parts, substeps, &method.to_string(), 0.0);
                let scene = model.scene();
                let mut system = started(&scene, model.particles.len(), 1);
                let (sum, spin, _, begun) = momenta(&system);
                for frame in 1..=180 {
                    system.step_to(&scene, Time::frame(frame, 60));
                    let (now, turning, size, energy) = momenta(&system);
                    for k in 0..3 {
                        assert!((now[k] - sum[k]).abs() < 2e-5 * size, "{name}: {now:?} for {sum:?}");
                        assert!((turning[k] - spin[k]).abs() < 1e-4 * size, "{name}: {turning:?} for {spin:?}");
                    }
                    assert!(energy < 1.01 * begun, "{name}: {energy} of {begun} J");
                }
            }
        }
    }
}
