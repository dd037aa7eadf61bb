//! Sheets and meshes of scene files that say their Young's modulus: they stretch and bend by it, however many cells they have.

use pointmass::scene::{Files, Model, SceneFile};
use pointmass::shape::MeshBuf;
use pointmass::{ConstraintKind, Method, Scene, Sheet, ShellParams, Vec3};
use pointmass_tests::{run, started};

/// Gravity on Earth \[m/s²\].
const G: f64 = 9.80665;

/// A sheet, under any name as a mesh.
struct One(Sheet);

impl Files for One {
    fn text(&mut self, path: &str) -> Result<String, String> {
        Err(path.into())
    }
    fn mesh(&mut self, _: &str) -> Result<MeshBuf, String> {
        MeshBuf::new(self.0.positions().collect(), self.0.triangles().collect()).map_err(|error| error.to_string())
    }
    fn exists(&mut self, _: &str) -> bool {
        true
    }
}

fn model(text: &str, sheet: Sheet) -> Result<Model, String> {
    let file = SceneFile::from_json("it.json", text).map_err(|error| error.to_string())?;
    Model::load(&file, "it.json", &mut One(sheet)).map_err(|error| error.to_string())
}

/// What a cloth is, and how it is held.
struct Case<'a> {
    sheet: Sheet,
    /// True if its form is a mesh.
    is_mesh: bool,
    isotropic: &'a str,
    is_held: fn(Vec3) -> bool,
}

impl Case<'_> {
    /// Loads it, in gravity.
    fn load(&self) -> Model {
        let fixed: Vec<_> =
            self.sheet.positions().enumerate().filter(|&(_, place)| (self.is_held)(place)).map(|(i, _)| i).collect();
        let Sheet { corner, sides: [first, second], cells } = self.sheet;
        let [corner, first, second] = [corner, first, second].map(|v| v.to_array());
        let form = if self.is_mesh {
            r#"{"mesh": "it.off"}"#.to_string()
        } else {
            format!(r#"{{"sheet": {{"corner": {corner:?}, "sides": [{first:?}, {second:?}], "cells": {cells:?}}}}}"#)
        };
        let text = format!(
            r#"{{"forces": [{{"gravity": {{"acceleration": [0, -9.80665, 0]}}}}],
            "cloths": [{{"form": {form}, "isotropic": {}, "fixed": {fixed:?}}}]}}"#,
            self.isotropic
        );
        model(&text, self.sheet).expect("it is sound")
    }

    /// How much lower all particles of one side hang after a second, as a mean \[m\].
    fn lower(&self, (method, substeps): (Method, u32), is_end: fn(Vec3) -> bool) -> f64 {
        let model = self.load();
        let scene = Scene { substeps, integrator: method.integrator(), ..model.scene() };
        let mut system = started(&scene, model.particles.len(), 1);
        run(&mut system, &scene, 1.0 / 60.0, 60);
        let now = system.particles().position;
        let ends = self.sheet.positions().zip(now).filter(|&(place, _)| is_end(place));
        let lower: Vec<_> = ends.map(|(place, now)| f64::from(place.y) - f64::from(now.y)).collect();
        lower.iter().sum::<f64>() / lower.len() as f64
    }
}

/// Hung by an edge, the mean of the edge below is lower by ρ g L² / (2 E).
#[test]
fn sheets_that_hang_stretch_by_their_modulus_however_fine_they_are() {
    let isotropic = r#"{"young": 1e6, "poisson": 0.5, "thickness": 2e-3, "density": 1100, "damping": 0.02}"#;
    let should = 1100.0 * G * 0.6 * 0.6 / 2e6;
    let ways = [(Method::Symplectic, 10), (Method::Verlet, 5), (Method::Rk4, 10), (Method::Symplectic, 20)];
    for (number, cells) in [[2, 3], [3, 5], [5, 10], [8, 20]].into_iter().enumerate() {
        for is_mesh in [false, true] {
            let sheet = Sheet { corner: Vec3::ZERO, sides: [Vec3::X * 0.3, Vec3::NEG_Y * 0.6], cells };
            let case = Case { sheet, is_mesh, isotropic, is_held: |place| place.y == 0.0 };
            let mass: f32 = case.load().particles.iter().map(|particle| particle.mass).sum();
            assert!((mass / (1100.0 * 2e-3 * 0.3 * 0.6) - 1.0).abs() < 1e-5, "{mass}");
            let lower = case.lower(ways[number], |place| place.y < -0.5999);
            let name = format!("{cells:?}, a mesh: {is_mesh}, {:?}", ways[number]);
            // Green's strain is stiffer by one and a half times the strain, which is up to 0.6 %.
            assert!((lower / should - 1.0).abs() < 0.015, "{name}: {lower}, not {should}");
        }
    }
}

/// Clamped at one end, a plate sags as a beam of the stiffness D = E t³ / (12 (1 − ν²)) for each metre of its width: by ρ t g L⁴ / (8 D).
#[test]
fn plates_sag_by_their_modulus_however_fine_they_are() {
    let (long, thick, young, poisson) = (0.07, 1e-3, 2e8, 0.4);
    let isotropic = r#"{"young": 2e8, "poisson": 0.4, "thickness": 1e-3, "density": 920, "damping": 0.02}"#;
    let bending = young * thick * thick * thick / (12.0 * (1.0 - poisson * poisson));
    let should = 920.0 * thick * G * long * long * long * long / (8.0 * bending);
    for (cells, way) in [(8u32, (Method::Symplectic, 10)), (12, (Method::Verlet, 20)), (10, (Method::Rk4, 10))] {
        for is_mesh in [false, true] {
            // The clamp is at the second of two rows that are fixed.
            let cell = long as f32 / (cells as f32 - 1.0);
            let sides = [Vec3::X * (cell * cells as f32), Vec3::Z * (0.2 * long as f32)];
            let sheet = Sheet { corner: Vec3::NEG_X * cell, sides, cells: [cells, cells.div_ceil(5)] };
            let is_held = |place: Vec3| place.x < 1e-4;
            let lower = Case { sheet, is_mesh, isotropic, is_held }.lower(way, |place| place.x > 0.0699);
            let name = format!("{cells} cells, a mesh: {is_mesh}, {way:?}");
            assert!((lower / should - 1.0).abs() < 0.03, "{name}: {lower}, not {should}");
        }
    }
}

/// The numbers of the shell are those that a text of the field gives, unless the bending stiffness is said.
#[test]
fn isotropic_sheets_are_shells_of_their_modulus_and_thickness() {
    let sheet = Sheet { corner: Vec3::ZERO, sides: [Vec3::X, Vec3::Y], cells: [2, 2] };
    for (rest, bending) in [("", 2e11 * 8e-9 / (12.0 * 0.91)), (r#", "bending": 0"#, 0.0), (r#", "bending": 3"#, 3.0)] {
        let isotropic = format!(r#"{{"young": 2e11, "poisson": 0.3, "thickness": 2e-3, "density": 7850{rest}}}"#);
        let model = Case { sheet, is_mesh: false, isotropic: &isotropic, is_held: |_| false }.load();
        let [ConstraintKind::Shell(shell)] = &model.constraints.0[..] else { panic!("{:?}", model.constraints.0) };
        let ShellParams { stretch: [warp, weft], shear, bending: has, damping } = shell.params;
        let near = |a: f32, b: f32| (a - b).abs() <= 1e-5 * b;
        assert!(near(warp, 4e8) && near(weft, 4e8) && near(shear, 4e8 / 2.6), "{:?}", shell.params);
        assert!(near(has, bending) && damping == 0.0, "{has}, not {bending}");
    }
}

#[test]
fn isotropic_sheets_that_cannot_be_are_refused_by_name() {
    let sheet = Sheet { corner: Vec3::ZERO, sides: [Vec3::X, Vec3::Y], cells: [2, 2] };
    let form = r#"{"sheet": {"corner": [0, 0, 0], "sides": [[1, 0, 0], [0, 1, 0]], "cells": [2, 2]}}"#;
    let solid = r#""young": 1e6, "thickness": 1e-3"#;
    for (rest, words) in [
        (format!(r#""isotropic": {{{solid}}}"#), "isotropic.density: is missing: say it, in kg/m³"),
        (format!(r#""mass": 1, "isotropic": {{{solid}, "density": 900}}"#), "isotropic.density: in kg/m³, says what"),
        (
            format!(r#""density": 1, "isotropic": {{{solid}, "density": 900}}"#),
            "isotropic.density: in kg/m³, says what",
        ),
        (format!(r#""isotropic": {{{solid}, "density": 0}}"#), "isotropic.density: has to be above zero, not 0"),
        (format!(r#""isotropic": {{{solid}, "density": 1e-44}}"#), "isotropic.density: and thickness make it heavier"),
        (
            format!(r#""mass": 1, "isotropic": {{{solid}, "poisson": 0.6}}"#),
            "isotropic.poisson: has to be from 0 to 0.5",
        ),
        (format!(r#""mass": 1, "isotropic": {{{solid}, "bending": -1}}"#), "isotropic.bending: has to be zero or more"),
        (format!(r#""mass": 1, "isotropic": {{{solid}, "damping": -1}}"#), "isotropic.damping: has to be zero or more"),
        (
            r#""mass": 1, "isotropic": {"young": 0, "thickness": 1e-3}"#.into(),
            "isotropic.young: has to be above zero, not 0",
        ),
        (
            r#""mass": 1, "isotropic": {"young": 1, "thickness": 0}"#.into(),
            "isotropic.thickness: has to be above zero, not 0",
        ),
        (
            r#""mass": 1, "isotropic": {"young": 1e38, "thickness": 1e3}"#.into(),
            "isotropic.young: and thickness make it stiffer or softer than 32-bit",
        ),
        (
            format!(r#""mass": 1, "isotropic": {{{solid}}}, "shell": {{"stretch": [1, 1], "shear": 1}}"#),
            "isotropic: say one of isotropic",
        ),
        (format!(r#""density": 1, "isotropic": {{{solid}}}, "hung": {{"stretch": [1, 1]}}"#), "isotropic: say one of"),
        (
            format!(r#""mass": 1, "isotropic": {{{solid}}}, "limits": {{"shear": 0.1}}"#),
            "limits: are those of cloth made of springs",
        ),
    ] {
        let said = model(&format!(r#"{{"cloths": [{{"form": {form}, {rest}}}]}}"#), sheet).expect_err("it is wrong");
        assert!(said.contains(&format!("cloths[0].{words}")), "{rest}: {said}");
    }
}
