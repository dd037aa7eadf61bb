//! Remarks on what does nothing, or not what it seems to say; and none where it is meant.

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
            r#"{{"run": {{"dt": 1e-4}}, "particles": [{{"radius": 0.1, "elasticity": {elasticity}, "material": 0}}, {{"position": [1, 0, 0], "radius": 0.1}}],
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

/// Forces that look for what nobody has, and what no force looks for.
#[test]
fn forces_and_what_they_look_for_belong_together() {
    let scene = |particle: &str, forces: &str| {
        format!(r#"{{"particles": [{{}}, {{"position": [1, 0, 0] {particle}}}], "forces": [{forces}]}}"#)
    };
    let wind = |rest: &str| format!(r#"{{"wind": {{"field": [{{"uniform": {{"velocity": [1, 0, 0]}}}}] {rest}}}}}"#);
    let (drag, charge) = (r#", "drag": 1"#, r#", "charge": 1e-6"#);
    let power = r#"{"power_law": {"strength": 1, "exponent": 2, "reach": 1, "weight": "charge"}}"#;
    let lj = |cutoff: f32| format!(r#"{{"lennard_jones": {{"epsilon": 1e-9, "sigma": 0.5, "cutoff": {cutoff}}}}}"#);
    for (particle, forces, said) in [
        ("", &*wind(""), Some("a.json:forces[0].wind.coefficient: without one it brakes by each particle's own drag")),
        ("", &wind(r#", "coefficient": 1"#), None),
        (drag, &wind(""), None),
        (drag, "", Some("a.json:particles[1].drag: 1 brakes nobody")),
        (drag, r#"{"drag": {}}"#, None),
        // As every .scn has it.
        ("", r#"{"drag": {}}"#, None),
        (drag, r#"{"drag": {}}, {"drag": {}}"#, Some("a.json:forces[1].drag: it stands among the forces twice")),
        (
            charge,
            r#"{"gravity": {"acceleration": [0, -1, 0]}}"#,
            Some("a.json:particles[1].charge: 0.000001 C does nothing"),
        ),
        (charge, r#"{"coulomb": {}}"#, None),
        (charge, power, None),
        ("", r#"{"coulomb": {}}"#, Some("a.json:forces[0].coulomb: nobody has a charge")),
        ("", power, Some("a.json:forces[0].power_law: nobody has a charge")),
        ("", &lj(0.4), Some("a.json:forces[0].lennard_jones.cutoff: 0.4 m is within sigma, 0.5 m")),
        // As wide as the pull begins: what repels alone is meant.
        ("", &lj(0.5613), None),
    ] {
        remarked(&scene(particle, forces), "", said);
    }
    let emitter = r#""emitters": [{"shape": {"sphere": {"center": [0, 0, 0], "radius": 1}}, "rate": 1, "charge": {"mean": 0, "half_width": 1}}]"#;
    remarked(&format!(r#"{{{emitter}, "forces": [{{"coulomb": {{}}}}]}}"#), "", None);
    remarked(&format!("{{{emitter}}}"), "", Some("a.json:emitters[0].charge: 1 C does nothing"));
    let hung = r#""ropes": [{"curve": [[0, 0, 0], [1, 0, 0]], "segments": 4, "weight": 1, "drag": 1}]"#;
    remarked(&format!(r#"{{{hung}, "forces": [{}]}}"#, wind("")), "", None);
}

/// Emitters that bring nobody, or not as they seem to say.
#[test]
fn emitters_that_do_nothing_are_remarked_on() {
    let scene = |shape: &str, rest: &str| {
        format!(r#"{{"run": {{"duration": 2}}, "emitters": [{{"shape": {{{shape}}}, "speed": 1, {rest}}}]}}"#)
    };
    let sphere = r#""sphere": {"center": [0, 0, 0], "radius": 0}"#;
    let cone = r#""cone": {"center": [0, 0, 0], "radius": 0, "height": 0}"#;
    for (shape, rest, said) in [
        (
            sphere,
            r#""rate": 1, "where_sparse": {"radius": 1, "fewest": 0}"#,
            Some("a.json:emitters[0].where_sparse.fewest: fewer than 0"),
        ),
        (sphere, r#""rate": 1, "where_sparse": {"radius": 1, "fewest": 1}"#, None),
        (
            sphere,
            r#""rate": 1, "start": 2"#,
            Some("a.json:emitters[0].start: 2 s is not before the run's end, at run.duration of 2 s"),
        ),
        (sphere, r#""rate": 1, "start": 1.9"#, None),
        (sphere, r#""burst": {"count": 5, "at": 3}"#, Some("a.json:emitters[0].burst.at: 3 s is not before")),
        (sphere, r#""burst": {"count": 5}"#, None),
        (cone, r#""rate": 1"#, Some("a.json:emitters[0].shape.cone: without a radius and a height it is a point")),
        (cone, r#""rate": 1, "direction": [0, 1, 0]"#, None),
        (
            sphere,
            r#""rate": 1, "lifetime": {"mean": 2, "half_width": -0.5}"#,
            Some("a.json:emitters[0].lifetime.half_width: -0.5 counts as 0.5"),
        ),
        (
            sphere,
            r#""rate": 1, "motion": {"swing": [1, 0, 0]}"#,
            Some("a.json:emitters[0].motion.frequency: 0 swings nothing"),
        ),
        (sphere, r#""rate": 1, "motion": {"swing": [1, 0, 0], "frequency": 1}"#, None),
    ] {
        remarked(&scene(shape, rest), "", said);
    }
}

/// Curves over lives that have no end, and numbers below zero that count otherwise.
#[test]
fn lives_without_an_end_and_numbers_below_zero_are_remarked_on() {
    let scene = |lifetime: f32, curve: &str| {
        format!(
            r#"{{"particles": [{{"material": 1, "lifetime": {lifetime}}}], "materials": [{{"life": {{"size": [[0, 1], [1, 2]]}}}},
            {{"life": {{"buoyancy": {curve}}}}}]}}"#
        )
    };
    let grows = "[[0, 1], [1, 2]]";
    remarked(&scene(0.0, grows), "", Some("a.json:materials[1].life.buoyancy: it goes over a life"));
    remarked(&scene(1.0, grows), "", None);
    remarked(&scene(0.0, r#"{"keys": [[0, 1], [1, 2]], "over": "seconds"}"#), "", None);
    remarked(&scene(0.0, "[[0, 1]]"), "", None);
    remarked(r#"{"materials": [{"shininess": -5}]}"#, "", Some("a.json:materials[0].shininess: -5 counts as 1"));
    remarked(r#"{"materials": [{"shininess": 0}]}"#, "", None);
    let spring = |length: f32| {
        format!(
            r#"{{"particles": [{{}}, {{"position": [1, 0, 0]}}], "springs": [{{"ends": [0, 1], "rest_length": {length}, "ks": 1}}]}}"#
        )
    };
    remarked(&spring(-1.0), "", Some("a.json:springs[0].rest_length: -1 m is below 0"));
    remarked(&spring(0.0), "", None);
}

/// Balls that begin sunk into scenery that stands still stay so, and are remarked on, and births without a speed; nothing that is lifted out, flies out or only touches is.
#[test]
fn what_begins_inside_of_scenery_is_remarked_on() {
    let floor = r#"{"shape": {"plane": {"point": [0, 0, 0], "normal": [0, 1, 0]}}}"#;
    let ball = |height: f32, rest: &str| format!(r#"{{"position": [0, {height}, 0], "radius": 0.1 {rest}}}"#);
    let scene = |particles: &str, scenery: &str, rest: &str| {
        format!(r#"{{"particles": [{particles}], "scenery": [{scenery}] {rest}}}"#)
    };
    let sunk = "a.json:particles[1].position: it is 0.05 m inside of scenery[1]";
    let high = ball(9.0, "");
    let aside = r#"{"shape": {"sphere": {"center": [50, 0, 0], "radius": 1}}}"#;
    let two = format!("{aside}, {floor}");
    remarked(&scene(&format!("{high}, {}", ball(0.05, "")), &two, ""), "", Some(sunk));
    remarked(&scene(&format!("{high}, {0}, {0}", ball(0.05, "")), &two, ""), "", Some("scenery[1], as 1 more are"));
    for (particle, rest) in [
        (ball(0.1, ""), ""),
        (ball(0.0995, ""), ""),
        (ball(0.05, r#", "fixed": true"#), ""),
        (ball(0.05, r#", "velocity": [0, 1, 0]"#), ""),
        (ball(0.05, ""), r#", "contacts": {"position": {}}"#),
    ] {
        remarked(&scene(&particle, floor, rest), "", None);
    }
    // Within a hollow ball, and where a group has taken the floor.
    remarked(&scene(&ball(0.0, ""), r#"{"shape": {"sphere": {"center": [0, 0, 0], "radius": 1}}}"#, ""), "", None);
    let lower = r#", "groups": [{"matrix": [[1, 0, 0, 0], [0, 1, 0, -1], [0, 0, 1, 0], [0, 0, 0, 1]]}]"#;
    let moved = floor.replace("}}}", r#"}}, "group": 0}"#);
    remarked(&scene(&ball(0.0, ""), &moved, lower), "", None);
    remarked(&scene(&ball(-1.05, ""), &moved, lower), "", Some("0.05"));
    let born = |height: f32, rest: &str| {
        format!(
            r#"{{"scenery": [{floor}], "emitters": [{{"shape": {{"circle": {{"center": [0, {height}, 0], "normal": [0, 1, 0], "radius": 1}}}},
            "rate": 1, "radius": 0.1 {rest}}}]}}"#
        )
    };
    remarked(&born(0.0, ""), "", Some("a.json:emitters[0].shape: births are 0.1 m inside of scenery[0]"));
    remarked(&born(0.0, r#", "speed": 1"#), "", None);
    remarked(&born(0.1, ""), "", None);
}

/// Rigid links that begin far from their lengths, which the first step puts there.
#[test]
fn links_that_begin_far_from_their_lengths_are_remarked_on() {
    let scene = |link: &str| {
        format!(
            r#"{{"particles": [{{}}, {{"position": [1, 0, 0]}}, {{"position": [2, 0, 0]}}], "constraints": [{link}]}}"#
        )
    };
    let rod = |rest: &str| scene(&format!(r#"{{"distance": {{"ends": [0, 1], {rest}}}}}"#));
    let said = "a.json:constraints[0].distance.length: 5 m is far from the 1 m that particles 0 and 1 begin apart";
    remarked(&rod(r#""length": 5"#), "", Some(said));
    remarked(&rod(r#""length": 5, "tether": true"#), "", None);
    remarked(&rod(r#""length": 0.5, "tether": true"#), "", Some("0.5 m is far from the 1 m"));
    remarked(&rod(r#""length": 1.01"#), "", None);
    remarked(&rod(r#""length": 5, "compliance": 0.1"#), "", None);
    let rope = r#"{"rope": {"particles": [0, 1, 2], "lengths": [1, 0.2]}}"#;
    remarked(
        &scene(rope),
        "",
        Some("a.json:constraints[0].rope.lengths: 0.2 m is far from the 1 m that particles 1 and 2"),
    );
}

/// A `.scn` is remarked on as its conversion to JSON is, at line and column of its commands, through included files; only forces, which nobody has written, are no matter.
#[test]
fn scn_is_remarked_on_as_json_is() {
    let folder = Folder::new();
    folder.write("in.scn", "\n particle_sink 1 0 0 0  sphere 0 0 0 1");
    folder.write(
        "a.scn",
        "particle_gravity 0 -9 0 particle_gravity 0 -1 0\ninclude in.scn\ntri -1  0 0 0  1 1 1  2 2 2\nbackground 255 255 255\n\
        material 255 0 0 0 0 0 0 0 0 0 0 0 0 0 0 -1 1 0\n\n particle_source 1 0 0 2 1 -1  0 1 45 sphere 0 0 0 1\n\
        particle 0 0 0 0 0 0 1 0 0 1 0 -1\nparticle_spring 0 0 -1 1 1",
    );
    let answer = folder.run("run a.scn --steps 0");
    let warnings = answer.warnings();
    for said in [
        "a.scn:1:25: particle_gravity: it takes the place of the one before",
        "in.scn:2:2: particle_sink: intensity: it divides by ca, la and qa",
        "a.scn:3:1: tri: its corners lie on a line",
        "a.scn:4:1: background: 255 is far beyond white",
        "a.scn:5:1: material: ambient: 255 is far beyond white",
        "a.scn:5:1: material: shininess: -1 counts as 1",
        "a.scn:7:2: particle_source: elasticity: 2 is above 1",
        "a.scn:7:2: particle_source: rate: neither this nor a burst",
        "a.scn:7:2: particle_source: angle_cutoff: 45 rad is not from 0 to π/2: the lecture's recipe takes its sine, which is less again beyond; of degrees take 0.7854",
        "a.scn:9:1: particle_spring: ends: the spring joins particle 0 to itself",
        "a.scn:9:1: particle_spring: rest_length: -1 m is below 0",
    ] {
        assert!(warnings.iter().any(|warning| warning.starts_with(said)), "{said}: {warnings:?}");
    }
    assert_eq!(folder.run("convert a.scn b.json").code, 0);
    let of_json = folder.run("run b.json --steps 0").warnings().len();
    // One gravity is left of two, and an include is told of.
    assert_eq!(warnings.len(), of_json + 2, "{warnings:?}");
    folder.write("a.scn", "particle_source 1 0 0 0 1 -1  1 1 1.5708 sphere 0 0 0 1 particle_gravity 0 -9 0");
    assert_eq!(folder.run("run a.scn --steps 0").warnings(), [""; 0]);
    let cone = |angle: &str| {
        format!(
            r#"{{"emitters": [{{"shape": {{"sphere": {{"center": [0, 0, 0], "radius": 1}}}}, "rate": 1, "spread": {{"lecture": {angle}}}}}]}}"#
        )
    };
    remarked(&cone("90"), "", Some("a.json:emitters[0].spread: 90 rad is not from 0 to π/2"));
    remarked(&cone("1.5708"), "", None);
}

/// Constraints and forces that name nobody do nothing, and are named themselves.
#[test]
fn what_names_nobody_is_remarked_on() {
    let constraint =
        |name: &str, rest: &str| format!(r#"{{"particles": [{{}}], "constraints": [{{"{name}": {{{rest}}}}}]}}"#);
    for (name, rest) in [
        ("attach", r#""particles": [], "motion": {}"#),
        ("strain_limits", r#""triangles": [], "warp": [1, 0, 0], "params": {"warp": [0.9, 1.02]}"#),
    ] {
        let said = format!("a.json:constraints[0].{name}: it names no particles, so it does nothing");
        remarked(&constraint(name, rest), "", Some(&said));
    }
    let force = |text: &str| format!(r#"{{"particles": [{{}}, {{}}, {{}}], "forces": [{{{text}}}]}}"#);
    let none = ["pressure.triangles", "aerodynamics.triangles", "cylinder_drag.segments"];
    let texts = [
        r#""pressure": {"triangles": [], "amount": 1}"#,
        r#""aerodynamics": {"triangles": [], "field": [], "drag": 1}"#,
        r#""cylinder_drag": {"segments": [], "field": [], "diameter": 0.01}"#,
    ];
    for (name, text) in none.into_iter().zip(texts) {
        let said = format!("a.json:forces[0].{name}: it has none, so it pushes nobody");
        remarked(&force(text), "", Some(&said));
    }
}
