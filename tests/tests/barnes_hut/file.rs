//! The force in a file.

use super::UNIT;
use pointmass::scene::{Files, Model, SceneFile};
use pointmass::shape::MeshBuf;
use pointmass::{ForceKind, MutualGravity};

/// A disk without a file.
struct NoFiles;

impl Files for NoFiles {
    fn text(&mut self, path: &str) -> Result<String, String> {
        Err(format!("no {path}"))
    }
    fn mesh(&mut self, path: &str) -> Result<MeshBuf, String> {
        Err(format!("no {path}"))
    }
    fn exists(&mut self, _: &str) -> bool {
        false
    }
}

#[test]
fn a_file_says_theta() {
    let text = r#"{"forces": [{"mutual_gravity": {"constant": 2.5, "theta": 0.5, "quadrupole": true}},
        {"gravity": {"acceleration": [0, -1, 0]}}, {"mutual_gravity": {"softening": 0.1}}, {"mutual_gravity": {}}]}"#;
    let file = SceneFile::from_json("a.json", text).expect("it is sound");
    let far = MutualGravity { constant: 2.5, softening: 0.0, theta: 0.5, quadrupole: true };
    // Files of before say nothing about it.
    let near = MutualGravity { softening: 0.1, ..MutualGravity::NEWTON };
    let kinds = [far, near, MutualGravity::NEWTON].map(ForceKind::MutualGravity);
    assert_eq!([&file.forces[0], &file.forces[2], &file.forces[3]], [&kinds[0], &kinds[1], &kinds[2]]);
    file.check().expect("it is sound");
    let written = file.to_json();
    assert_eq!(SceneFile::from_json("b.json", &written), Ok(file.clone()));
    assert!(written.contains("\"theta\": 0.5") && written.contains("\"quadrupole\": true"), "{written}");
    let model = Model::load(&file, "a.json", &mut NoFiles).expect("it is sound");
    let without = SceneFile { forces: file.forces[1..].to_vec(), ..file };
    let without = Model::load(&without, "a.json", &mut NoFiles).expect("it is sound");
    assert_eq!(model.scene().columns(), without.scene().columns() + 5);
    assert_eq!(model.size(10).columns, model.scene().columns());
}

#[test]
fn a_theta_that_cannot_be_is_refused() {
    for (theta, sound) in
        [("0", true), ("-0.0", true), ("1e-30", true), ("2", true), ("-0.1", false), ("-1e-30", false)]
    {
        let text = format!(r#"{{"forces": [{{"drag": {{}}}}, {{"mutual_gravity": {{"theta": {theta}}}}}]}}"#);
        let file = SceneFile::from_json("a.json", &text).expect("it is well-formed");
        match file.check() {
            Ok(()) => assert!(sound, "{theta}"),
            Err(error) => {
                let error = error.to_string();
                assert!(!sound && error.contains("forces[1].theta") && error.contains("zero or more"), "{error}");
            }
        }
        assert_eq!(Model::load(&file, "a.json", &mut NoFiles).is_ok(), sound);
    }
    for theta in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
        let forces = vec![ForceKind::MutualGravity(MutualGravity { theta, ..UNIT })];
        let error = SceneFile { forces, ..SceneFile::new() }.check().expect_err("it is no number");
        assert!(error.to_string().contains("forces[0]"), "{error}");
    }
    for wrong in [r#""theta": "much""#, r#""theta": null"#, r#""quadrupole": 1"#, r#""Theta": 0.5"#] {
        let text = format!(r#"{{"forces": [{{"mutual_gravity": {{{wrong}}}}}]}}"#);
        assert!(SceneFile::from_json("a.json", &text).is_err(), "{wrong}");
    }
    let schema = pointmass::scene::schema();
    assert!(schema.contains("\"theta\"") && schema.contains("\"quadrupole\""));
}
