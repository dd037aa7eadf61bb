//! What does nothing, or not what it seems to say, told by name; and nothing told where it is meant.

use crate::tool::Folder;

/// Holds what `run` remarks on a scene against what it should say of it: nothing, or something with these words.
#[track_caller]
fn remarked(text: &str, args: &str, said: Option<&str>) {
    let folder = Folder::with("a.json", text);
    let answer = folder.run(&format!("run a.json --steps 0 {args}"));
    let warnings = answer.warnings();
    match said {
        Some(words) => assert!(warnings.iter().any(|warning| warning.contains(words)), "{text}: {warnings:?}"),
        None => assert_eq!(warnings, [""; 0], "{text}"),
    }
}

/// Contacts by force ask for no elasticity: where one is said and their damping does something else, the damping that does it is named.
#[test]
fn elasticities_that_contacts_by_force_do_not_ask_are_remarked_on() {
    let scene = |elasticity: &str, damping: &str, scenery: &str| {
        format!(
            r#"{{"run": {{"dt": 1e-3}}, "particles": [{{"radius": 0.1, "elasticity": {elasticity}, "material": 0}}, {{"position": [1, 0, 0], "radius": 0.1}}],
            "contacts": {{"force": {{"stiffness": 1e5 {damping}}}}}, "materials": [{{}}], "scenery": [{scenery}]}}"#
        )
    };
    let floor = r#"{"shape": {"plane": {"point": [0, -1, 0], "normal": [0, 1, 0]}}}"#;
    let said =
        "a.json:contacts.force.damping: 0 gives back 1.00 of the speed, whatever particles[0].elasticity, 0.3, and";
    remarked(&scene("0.3", "", ""), "", Some(said));
    remarked(&scene("0.3", "", floor), "", Some("for 0.3 take 0.50"));
    remarked(&scene("0.3", r#", "damping": 0.02"#, ""), "", Some("0.02 gives back 0.94"));
    // The floor takes the elasticity, and the damping was thought of.
    remarked(&scene("0.3", r#", "damping": 0.02"#, floor), "", None);
    for (elasticity, damping) in [("0.5", ""), ("1", ""), ("0.3", r#", "damping": 0.5"#)] {
        remarked(&scene(elasticity, damping, ""), "", None);
    }
    let of_material = scene("0.5", "", "").replace("[{}]", r#"[{"contact": {"elasticity": 0.25}}]"#);
    remarked(&of_material, "", Some("whatever materials[0].contact.elasticity, 0.25, and"));
    let none = of_material.replace(r#""contacts": {"force": {"stiffness": 1e5 }},"#, "");
    remarked(&none, "", None);
    remarked(&none, "--response force", Some("--response force: a damping of 0.1 gives back 0.74"));
    remarked(&none, "--response impulse", None);
}

/// Colours of particles are bytes, all others shares: where one is said as the other, the remark says so.
#[test]
fn colors_by_the_other_scale_are_remarked_on() {
    let particle = |color: &str| format!(r#"{{"particles": [{{}}, {{"position": [1, 0, 0], "color": {color}}}]}}"#);
    remarked(
        &particle("[1, 0, 0, 1]"),
        "",
        Some("a.json:particles[1].color: red, green, blue and opacity of particles are bytes"),
    );
    for color in ["[255, 0, 0, 255]", "[0, 0, 0, 0]", "[1, 1, 1, 255]", "[90, 0, 0, 1]"] {
        remarked(&particle(color), "", None);
    }
    let shape = r#""shape": {"sphere": {"center": [0, 0, 0], "radius": 1}}, "rate": 1, "lifetime": 1, "material": 0"#;
    let emitter = |color: &str| format!(r#"{{"emitters": [{{{shape}, "color": {color}}}], "materials": [{{}}]}}"#);
    remarked(&emitter("[0, 1, 1, 1]"), "", Some("a.json:emitters[0].color: red, green, blue and opacity"));
    remarked(&emitter("[0, 10, 10, 255]"), "", None);
    let life = |keys: &str| format!(r#"{{"emitters": [{{{shape}}}], "materials": [{{"life": {{"color": {keys}}}}}]}}"#);
    let said = "a.json:materials[0].life.color: 255 is a factor of";
    remarked(&life("[[0, 0, 255, 0], [1, 0, 0, 0]]"), "", Some(said));
    remarked(&life(r#"{"keys": [[0, 0, 0, 255]]}"#), "", Some(said));
    remarked(&life(r#"{"between": [{"keys": [[0, 1, 1, 1]]}, {"keys": [[0, 255, 1, 1]]}]}"#), "", Some(said));
    remarked(&life("[[0, 1, 0.5, 0], [1, 3, 3, 3]]"), "", None);
}
