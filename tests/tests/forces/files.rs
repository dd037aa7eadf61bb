//! Forces as files say them.

use pointmass::ForceKind;
use pointmass::scene::{SceneFile, write_scn};

/// Every force that a file can name, as a list in JSON.
const ALL: &str = r#"[
    {"gravity": {"acceleration": [0, -9.81, 0]}},
    {"drag": {}},
    {"mutual_gravity": {"constant": 1, "theta": 0.5}},
    {"quadratic_drag": {"coefficient": 0.02}},
    {"coulomb": {"softening": 0.1, "theta": 0.5, "quadrupole": true}},
    {"wind": {"coefficient": 0.1, "field": [
        {"uniform": {"velocity": [1, 0, 0]}},
        {"gusts": {"velocity": [1, 0, 0], "amplitude": 0.5, "frequency": 0.2}},
        {"vortex": {"center": [0, 0, 0], "axis": [0, 1, 0], "speed": -2, "core": 0.5}},
        {"curl": {"speed": 1, "scale": 0.5, "drift": [0, 1, 0], "seed": 3}}
    ]}},
    {"lennard_jones": {"epsilon": 1, "sigma": 0.3, "cutoff": 0.75}},
    {"power_law": {"strength": -1, "exponent": 12, "softening": 0.1, "reach": 2, "weight": "charge"}},
    {"viscosity": {"coefficient": 1, "reach": 0.5}},
    {"pressure": {"triangles": [[0, 1, 2], [0, 2, 1]], "amount": 2, "outside": 0.5}},
    {"cylinder_drag": {"segments": [[0, 1], [1, 2]], "field": [{"uniform": {"velocity": [1, 0, 0]}}], "diameter": 0.01, "friction": 0.02}}
]"#;

fn file(forces: &str) -> Result<SceneFile, String> {
    let text = format!(r#"{{"particles": [{{}}, {{}}, {{}}], "forces": {forces}}}"#);
    SceneFile::from_json("a.json", &text).map_err(|error| error.to_string())
}

#[test]
fn every_force_is_read_and_written() {
    let scene = file(ALL).expect("it is well-formed");
    scene.check().expect("it is sound");
    assert_eq!(SceneFile::from_json("b.json", &scene.to_json()), Ok(scene.clone()));
    for force in &scene.forces {
        assert!(ALL.contains(&format!("{{\"{}\": ", force.kind())), "{force:?}");
    }
    // Those that have defaults need not say more.
    let short =
        r#"[{"coulomb": {}}, {"wind": {"field": []}}, {"power_law": {"strength": 1, "exponent": 2, "reach": 1}}]"#;
    file(short).expect("it is well-formed").check().expect("it is sound");
}

#[test]
fn scn_says_what_it_leaves_out() {
    let scene = file(ALL).expect("it is well-formed");
    let (text, warnings) = write_scn(&scene);
    assert_eq!(text.lines().next(), Some("particle_gravity 0 -9.81 0"));
    for force in scene.forces.iter().skip(3) {
        let warned = warnings.iter().filter(|w| w.contains(&format!("'{}'", force.kind()))).count();
        assert_eq!(warned, 1, "{force:?} in {warnings:?}");
    }
    let sink = r#"{"shape": {"sphere": {"center": [0, 0, 0], "radius": 1}}, "intensity": 1, "ca": 1, "la": 0, "qa": 0"#;
    for (softening, count) in [("", 0), (", \"softening\": 0", 0), (", \"softening\": 0.1", 1)] {
        let text = format!(r#"{{"sinks": [{sink}{softening}}}]}}"#);
        let scene = SceneFile::from_json("a.json", &text).expect("it is well-formed");
        let (_, warnings) = write_scn(&scene);
        assert_eq!(warnings.iter().filter(|w| w.starts_with("sinks[0].softening")).count(), count);
    }
    let text = format!(r#"{{"sinks": [{sink}, "softening": -1}}]}}"#);
    let error =
        SceneFile::from_json("a.json", &text).expect("it is well-formed").check().expect_err("it is below zero");
    assert!(error.to_string().contains("sinks[0].softening") && error.to_string().contains("-1"), "{error}");
}

#[test]
fn what_cannot_be_is_refused_by_its_path() {
    let power = r#"{"power_law": {"strength": 1, "exponent": 2, "softening": 0, "reach": 1}}"#;
    let vortex =
        r#"{"wind": {"field": [{"vortex": {"center": [0, 0, 0], "axis": [0, 1, 0], "speed": 1, "core": 1}}]}}"#;
    let atoms = r#"{"lennard_jones": {"epsilon": 1, "sigma": 1, "cutoff": 2}}"#;
    let gas = r#"{"pressure": {"triangles": [[0, 1, 2]], "amount": 1}}"#;
    let rope = r#"{"cylinder_drag": {"segments": [[0, 1], [1, 2]], "field": [], "diameter": 0.01}}"#;
    let cases = [
        (r#"{"quadratic_drag": {"coefficient": -1}}"#.into(), "coefficient", "zero or more, not -1"),
        (r#"{"coulomb": {"theta": -0.5}}"#.into(), "theta", "zero or more, not -0.5"),
        (r#"{"coulomb": {"softening": -1}}"#.into(), "softening", "zero or more"),
        (r#"{"wind": {"field": [], "coefficient": -2}}"#.into(), "coefficient", "zero or more"),
        (vortex.replace("0, 1, 0", "0, 0, 0"), "field[0].axis", "direction"),
        (vortex.replace("\"core\": 1", "\"core\": 0"), "field[0].core", "above zero, not 0"),
        (atoms.replace("\"sigma\": 1", "\"sigma\": 0"), "sigma", "above zero"),
        (atoms.replace("\"cutoff\": 2", "\"cutoff\": 1e30"), "cutoff", "at most"),
        (power.replace("\"exponent\": 2", "\"exponent\": 13"), "exponent", "from 0 to 12, not 13"),
        (power.replace("\"reach\": 1", "\"reach\": -1"), "reach", "above zero"),
        (r#"{"viscosity": {"coefficient": 1, "reach": 0}}"#.into(), "reach", "above zero"),
        (gas.replace("[0, 1, 2]", "[0, 1, 2], [1, 2, 3]"), "triangles[1]", "particle 3 is out of range; there are 3"),
        (gas.replace("\"amount\": 1", "\"amount\": -1"), "amount", "zero or more"),
        (rope.replace("[1, 2]", "[1, 3]"), "segments[1]", "particle 3 is out of range; there are 3"),
        (rope.replace("0.01", "0"), "diameter", "above zero, not 0"),
        (rope.replace("0.01", "0.01, \"viscosity\": -1"), "viscosity", "zero or more, not -1"),
        (rope.replace("0.01", "0.01, \"friction\": -1"), "friction", "zero or more, not -1"),
    ];
    for (force, path, message) in cases {
        let scene = file(&format!(r#"[{{"drag": {{}}}}, {force}]"#)).expect("it is well-formed");
        let error = scene.check().expect_err(&force).to_string();
        assert!(error.contains(&format!("forces[1].{path}")) && error.contains(message), "{force}: {error}");
    }
    for force in [power, vortex, atoms, gas, rope] {
        file(&format!("[{force}]")).expect("it is well-formed").check().expect("it is sound");
        let more = force.replacen("\": {\"", "\": {\"more\": 1, \"", 1);
        assert!(file(&format!("[{more}]")).is_err_and(|error| error.contains("more")), "{more}");
    }
    // A program can say what JSON cannot.
    let mut scene = file(&format!("[{atoms}]")).expect("it is well-formed");
    for wrong in [f32::NAN, f32::INFINITY] {
        if let ForceKind::LennardJones(law) = &mut scene.forces[0] {
            law.0.epsilon = wrong;
        }
        let error = scene.check().expect_err("it is no number").to_string();
        assert!(error.contains("forces[0].epsilon") && error.contains("finite"), "{error}");
    }
}
