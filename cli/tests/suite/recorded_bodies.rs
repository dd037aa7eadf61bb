//! The surfaces of rigid bodies in recordings: closed, as large as the bodies, where these are, and behind all particles.

use crate::recorded::{Record, glb, obj, ply, vtk, vtp};
use crate::tool::Folder;
use serde_json::json;
use std::fs;

const STEPS: usize = 12;

/// The weight of all of the scene \[kg\]: a ball, a sheet, four bodies.
const MASS: f64 = 1.0 + 1.0 + 4.0 * 0.7;

/// Two boxes and two dice that spin through the air, a sheet and a ball.
fn scene() -> String {
    let body = |form: &str, x: f64, sides: [f64; 3]| {
        json!({"form": form, "sides": sides, "mass": 0.7, "position": [x, 2.0, -x], "turn": [0.3, x, -0.2],
            "velocity": [0.5, 1.0, x], "spin": [3.0, -2.0, 1.0 + x], "load": [0.2, 0.0, -0.1], "drag": 0.001, "colors": [[10, 20, 30, 255]]})
    };
    let mut boxes = vec![
        body("box", 0.0, [0.4, 0.2, 0.3]),
        body("icosahedron", 1.0, [0.3; 3]),
        body("tetrahedron", 2.0, [0.2, 0.3, 0.25]),
    ];
    boxes[0]["count"] = json!([2, 1, 1]);
    boxes[0]["spacing"] = json!([-1.5, 0, 0]);
    let sheet = json!({"corner": [0, 4, 0], "sides": [[1, 0, 0], [0, 0, 1]], "cells": [2, 1]});
    json!({
        "run": {"dt": 0.05, "substeps": 10, "integrator": "symplectic"},
        "forces": [{"gravity": {"acceleration": [0, -9.8, 0]}}, {"drag": {}}],
        "particles": [{"position": [5, 5, 5]}],
        "cloths": [{"form": {"sheet": sheet}, "mass": 1, "springs": {"structural": {"ks": 5}}}],
        "boxes": boxes
    })
    .to_string()
}

/// Of each body: the particles, the corners and the faces that it has, and how large it is.
fn bodies() -> [(usize, usize, usize, f64); 4] {
    let phi = (1.0 + 5f64.sqrt()) / 2.0;
    let ico = 5.0 / 12.0 * (3.0 + 5f64.sqrt()) * (0.3 / phi).powi(3);
    let cuboid = (8, 8, 12, 0.4 * 0.2 * 0.3);
    [cuboid, cuboid, (8, 12, 20, ico), (8, 4, 4, 0.2 * 0.3 * 0.25 / 3.0)]
}

fn places(record: &Record) -> Vec<[f64; 3]> {
    let [x, y, z] = ["x", "y", "z"].map(|name| &record.columns[name]);
    (0..x.len()).map(|row| [x[row], y[row], z[row]]).collect()
}

fn minus(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    core::array::from_fn(|i| a[i] - b[i])
}

/// Six times the volume of the tetrahedron between three corners and a place.
fn volume([a, b, c]: [[f64; 3]; 3], from: [f64; 3]) -> f64 {
    let [a, b, c] = [a, b, c].map(|x| minus(x, from));
    a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) + a[2] * (b[0] * c[1] - b[1] * c[0])
}

#[track_caller]
fn holds(what: &str, record: &Record) {
    let (x, flat) = (places(record), 4);
    let (mut corner, mut face, mut particle) = (7 + 8 * 4, flat, 7);
    for (particles, corners, faces, size) in bodies() {
        let middle = x[particle..particle + particles].iter().fold([0.0; 3], |sum, x| minus(sum, x.map(|x| -x / 8.0)));
        let mut sides = std::collections::BTreeMap::new();
        let (mut all, mut least) = (0.0, f64::INFINITY);
        for numbers in &record.faces[face..face + faces] {
            assert!(numbers.iter().all(|&n| (corner..corner + corners).contains(&(n as usize))), "{what}: {numbers:?}");
            let part = volume([0, 1, 2].map(|i| x[numbers[i] as usize]), middle) / 6.0;
            (all, least) = (all + part, least.min(part));
            for i in 0..3 {
                *sides.entry([numbers[i], numbers[(i + 1) % 3]]).or_insert(0) += 1;
            }
        }
        assert!(least > 0.0 && (all / size - 1.0).abs() < 1e-3, "{what}: {all} m³, not {size}; {least}");
        assert!(
            sides.iter().all(|(&[a, b], &count)| count == 1 && sides.get(&[b, a]) == Some(&1)),
            "{what}: it is open"
        );
        if let Some(ids) = record.columns.get("id") {
            assert!(ids[corner..corner + corners].iter().all(|&id| id == ids[particle]), "{what}");
            // What they sum up to is that of the particles.
            for name in ["mass", "drag"] {
                assert!(record.columns[name][corner..corner + corners].iter().all(|&x| x == 0.0), "{what}: {name}");
            }
        }
        (corner, face, particle) = (corner + corners, face + faces, particle + particles);
    }
    assert_eq!((x.len(), record.faces.len()), (corner, face), "{what}");
    let mass: f64 = record.columns.get("mass").map_or(MASS, |masses| masses.iter().sum());
    assert!((mass / MASS - 1.0).abs() < 1e-6, "{what}: {mass} kg");
}

#[test]
fn rigid_bodies_are_recorded_with_their_surfaces() {
    let folder = Folder::with("a.json", scene());
    let outs: String = ["ply", "obj", "vtp", "glb", "csv"].map(|end| format!(" --out a.{end}")).concat();
    folder.run(&format!("run a.json --steps {STEPS}{outs}")).fine();
    let animated = glb(&fs::read(folder.path("a.glb")).expect("it is there"));
    assert_eq!(animated.len(), STEPS + 1);
    let mut before: Option<Record> = None;
    for (i, animated) in animated.iter().enumerate() {
        holds("glb", animated);
        let ply = ply(&folder, &format!("a_{i:06}.ply"));
        holds("ply", &ply);
        let text = folder.read(&format!("a_{i:06}.vtp"));
        holds("vtp", &vtp(&text));
        assert_eq!(vtk(&text)[&("FieldData".into(), "particles".into())], [39.0]);
        let text = folder.read(&format!("a_{i:06}.obj"));
        holds("obj", &obj(&text));
        assert!(text.contains("# 39 particles, then corners of bodies"));
        // A free particle is a point; those of bodies are in these.
        assert_eq!(text.lines().filter(|line| line.starts_with("p ")).collect::<Vec<_>>(), ["p 1"]);
        // Corners go as fast as they say, to the second order of a step.
        if let Some(before) = before {
            let (now, then) = (places(&ply), places(&before));
            for corner in 39..now.len() {
                for (axis, name) in ["vx", "vy", "vz"].into_iter().enumerate() {
                    let mean = 0.5 * (ply.columns[name][corner] + before.columns[name][corner]);
                    let way = (now[corner][axis] - then[corner][axis]) / 0.05;
                    assert!((way - mean).abs() < 0.05, "{i}, {corner}, {name}: {way} m/s, {mean} m/s");
                }
            }
        }
        before = Some(ply);
    }
    // Tables hold the particles.
    assert_eq!(folder.read("a.csv").lines().count(), 1 + 39 * (STEPS + 1));
}
