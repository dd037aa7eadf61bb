//! Soft bodies of scene files: what they weigh and how soft they are does not depend on how finely they are filled, nor on what fills them.

use core::f64::consts::TAU;
use pointmass::constrain::ConstraintKind;
use pointmass::scene::{Files, Model, SceneFile};
use pointmass::shape::MeshBuf;
use pointmass::{Method, Scene, Vec3};
use pointmass_tests::{G, Random, icosahedron, run, started};

/// One mesh under any name.
struct One(Vec<Vec3>, Vec<[u32; 3]>);

impl Files for One {
    fn text(&mut self, path: &str) -> Result<String, String> {
        Err(path.into())
    }
    fn mesh(&mut self, _: &str) -> Result<MeshBuf, String> {
        MeshBuf::new(self.0.clone(), self.1.clone()).map_err(|error| error.to_string())
    }
    fn exists(&mut self, _: &str) -> bool {
        true
    }
}

/// The corners and triangles of a box about a place.
fn cuboid(sides: Vec3, middle: Vec3) -> One {
    let corner = |i: u32| Vec3::new((i & 1) as f32, (i >> 1 & 1) as f32, (i >> 2) as f32) - 0.5;
    let faces = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let triangles = faces.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).collect();
    One((0..8).map(|i| middle + corner(i) * sides).collect(), triangles)
}

fn model(text: &str, mesh: &mut One) -> Result<Model, String> {
    let file = SceneFile::from_json("it.json", text).map_err(|error| error.to_string())?;
    Model::load(&file, "it.json", mesh).map_err(|error| error.to_string())
}

/// A scene of one soft body.
fn body(form: &str, spacing: f32, rest: &str) -> String {
    format!(r#"{{"soft_bodies": [{{"form": {form}, "spacing": {spacing}, "density": 800, {rest}}}]}}"#)
}

fn triple(v: Vec3) -> String {
    format!("[{}, {}, {}]", v.x, v.y, v.z)
}

#[test]
fn mass_and_centre_are_those_of_the_solid_however_fine_it_is() {
    let mut random = Random::new(5);
    let (corners, triangles) = icosahedron();
    // Of edges 4 / √(10 + 2√5) long, as its corners are at distance 1.
    let edge = 4.0 / (10.0 + 2.0 * 5f64.sqrt()).sqrt();
    let round = 5.0 * (3.0 + 5f64.sqrt()) / 12.0 * edge.powi(3);
    for number in 0..60 {
        let scale = 10f32.powf(random.between(-2.0, 1.0));
        let sides = Vec3::from_array([0; 3].map(|_| random.between(0.5, 2.0)));
        let [position, velocity, turn, spin, far] = [0; 5].map(|_| random.vector(2.0));
        let spacing = scale * random.between(0.08, 0.35);
        // From outside, from inside, and with corners of their own for each triangle.
        let mut mesh = match number % 4 {
            0 => One(vec![], vec![]),
            1 => One(corners.iter().map(|v| *v + far).collect(), triangles.clone()),
            2 => One(corners.clone(), triangles.iter().map(|&[a, b, c]| [a, c, b]).collect()),
            _ => {
                let apart = triangles.as_flattened().iter().map(|&corner| corners[corner as usize]);
                One(apart.collect(), (0..triangles.len() as u32).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect())
            }
        };
        let is_box = number % 4 == 0;
        let form = if is_box { format!(r#"{{"box": {}}}"#, triple(sides)) } else { r#"{"mesh": "it.off"}"#.into() };
        let [at, v, turned, spun] = [position, velocity, turn, spin].map(triple);
        let rest = format!(
            r#""scale": {scale}, "position": {at}, "velocity": {v}, "turn": {turned}, "spin": {spun}, "give": 2, "drag": 0.3"#
        );
        let model = model(&body(&form, spacing, &rest), &mut mesh).unwrap();
        let all = &model.particles;
        let volume =
            f64::from(scale).powi(3) * if is_box { sides.to_array().map(f64::from).iter().product() } else { round };
        let mass: f64 = all.iter().map(|p| f64::from(p.mass)).sum();
        let mean = |of: &dyn Fn(usize) -> Vec3| {
            let weighed = |axis: usize| (0..all.len()).map(move |i| f64::from(of(i)[axis]) * f64::from(all[i].mass));
            Vec3::from_array([0, 1, 2].map(|axis| (weighed(axis).sum::<f64>() / mass) as f32))
        };
        let name = format!("{number}: {} particles, {spacing} of {scale} m", all.len());
        assert!((mass / (800.0 * volume) - 1.0).abs() < 1e-4, "{name}: {mass} kg, {volume} m³");
        assert!((mean(&|i| all[i].position) - position).length() < 1e-5 * (1.0 + scale), "{name}");
        assert!((mean(&|i| all[i].velocity) - velocity).length() < 1e-4 * (1.0 + scale), "{name}");
        assert!(
            all.iter()
                .all(|p| (p.velocity - velocity - spin.cross(p.position - position)).length() < 1e-4 * (1.0 + scale))
        );
        assert!((all.iter().map(|p| p.drag).sum::<f32>() - 0.3).abs() < 1e-4, "{name}");
        // There are as many as cells of the spacing fill it, and they lie so far apart.
        let room = volume / f64::from(spacing).powi(3);
        assert!(all.len() as f64 > 0.4 * room && (all.len() as f64) < 2.2 * room, "{name}: {room}");
        let nearest = all[1..].iter().map(|p| p.position.distance(all[0].position)).fold(f32::INFINITY, f32::min);
        let apart = if is_box { 0.6..1.6 } else { 0.999..1.001 };
        assert!(apart.contains(&(nearest / spacing)), "{name}: {nearest} m");
    }
}

/// A box is filled alike whether the file says its sides or a mesh does.
#[test]
fn a_mesh_of_a_box_is_that_box() {
    for (sides, spacing) in [([0.4, 0.8, 0.6], 0.1), ([0.4, 0.8, 0.6], 0.2), ([1.0, 0.25, 0.5], 0.25f32)] {
        let sides = Vec3::from_array(sides);
        let rest = r#""position": [1, 2, 3], "turn": [0.2, 0.5, 0], "give": 3"#;
        let form = format!(r#"{{"box": {}}}"#, triple(sides));
        let said = model(&body(&form, spacing, rest), &mut One(vec![], vec![])).unwrap();
        let mut mesh = cuboid(sides, Vec3::new(3.0, -1.0, 2.0));
        let read = model(&body(r#"{"mesh": "it.off"}"#, spacing, rest), &mut mesh).unwrap();
        assert_eq!(said.particles.len(), read.particles.len());
        for (a, b) in said.particles.iter().zip(&read.particles) {
            assert!(a.position.distance(b.position) < 1e-5 && (a.mass / b.mass - 1.0).abs() < 1e-5, "{a:?} {b:?}");
        }
    }
}

/// Where the upper part is held the rest hangs by g / (2 π f)², or by so many percent of the height, whatever the mesh and the share that is held.
/// A cavity weighs nothing, and what stands apart counts, whichever way the triangles of each are turned; what crosses is refused.
#[test]
fn meshes_of_several_shells_weigh_what_is_filled() {
    let shells = |of: &[(f32, Vec3)], turned: usize| {
        let mut all = One(Vec::new(), Vec::new());
        for (i, &(side, middle)) in of.iter().enumerate() {
            let (first, One(corners, triangles)) = (all.0.len() as u32, cuboid(Vec3::splat(side), middle));
            all.0.extend(corners);
            let turn = |[a, b, c]: [u32; 3]| if turned >> i & 1 == 1 { [a, c, b] } else { [a, b, c] };
            all.1.extend(triangles.into_iter().map(|face| turn(face.map(|corner| first + corner))));
        }
        all
    };
    let text = body(r#"{"mesh": "it.off"}"#, 0.5, r#""position": [0, 0, 0], "give": 2"#);
    for turned in 0..4 {
        for (of, volume) in
            [([(4.0, Vec3::ZERO), (2.0, Vec3::ZERO)], 56.0), ([(4.0, Vec3::ZERO), (2.0, Vec3::X * 4.0)], 72.0)]
        {
            let model = model(&text, &mut shells(&of, turned)).unwrap();
            let mass: f64 = model.particles.iter().map(|p| f64::from(p.mass)).sum();
            assert!((mass / (800.0 * volume) - 1.0).abs() < 1e-5, "{turned} {volume}: {mass}");
            // As many particles as cells that are filled.
            assert!((model.particles.len() as f64 / (8.0 * volume) - 1.0).abs() < 0.02, "{}", model.particles.len());
        }
        let error = model(&text, &mut shells(&[(4.0, Vec3::ZERO), (2.0, Vec3::X * 2.0)], turned)).unwrap_err();
        assert!(error.contains("form") && error.contains("pass through each other"), "{error}");
    }
}

#[test]
fn what_is_held_hangs_by_its_softness_however_fine_it_is() {
    let (corners, triangles) = icosahedron();
    let mut round = One(corners, triangles);
    for (number, spacing) in [0.5f32, 0.25, 0.16].into_iter().enumerate() {
        for (k, (softness, sag)) in [
            (r#""frequency": 3"#, [G / (3.0 * TAU) / (3.0 * TAU), 0.0]),
            (r#""give": 4"#, [0.0, 0.04]),
            (r#""give": 0"#, [0.0; 2]),
        ]
        .into_iter()
        .enumerate()
        {
            for (form, height) in [(r#"{"box": [1, 1.5, 0.75]}"#, 1.5), (r#"{"mesh": "it.off"}"#, 2.0 * 0.850_650_8)] {
                let form_scale = 0.5;
                let rest = format!(
                    r#""scale": {form_scale}, "position": [0, 2, 0], {softness}, "damping": 0.08, "held": [[-9, 2.1, -9], [9, 9, 9]]"#
                );
                let text = body(form, spacing * form_scale as f32, &rest).replacen(
                    '{',
                    r#"{"forces": [{"gravity": {"acceleration": [0, -9.80665, 0]}}], "#,
                    1,
                );
                let model = model(&text, &mut round).unwrap();
                let method = [Method::Symplectic, Method::Verlet, Method::Rk4, Method::Midpoint][(number + k) % 4];
                let scene = Scene { substeps: 10, integrator: method.integrator(), ..model.scene() };
                let mut system = started(&scene, model.particles.len(), 1);
                run(&mut system, &scene, 1.0 / 60.0, 120);
                let sag = sag[0] + sag[1] * height * form_scale;
                let name = format!("{form} {spacing} {softness} {method}, {} particles", model.particles.len());
                assert!(model.particles.iter().any(|p| p.fixed), "{name}");
                for (p, x) in model.particles.iter().zip(system.particles().position) {
                    let fell = f64::from(p.position.y - x.y);
                    let should = if p.fixed { 0.0 } else { sag };
                    assert!((fell - should).abs() < 0.01 * should + 2e-5, "{name}: {fell} m, not {should}");
                }
            }
        }
    }
}

/// Drawn out at a speed it swings by x'' + τ ω² x' + ω² x = 0, whatever the mesh.
#[test]
fn it_swings_at_its_frequency_however_fine_it_is() {
    let (corners, triangles) = icosahedron();
    let mut round = One(corners, triangles);
    for (spacing, form) in [(0.5f32, "box"), (0.2, "box"), (0.15, "box"), (0.6, "mesh"), (0.3, "mesh"), (0.25, "mesh")]
    {
        for (frequency, fades) in [(1.0, 0.0), (6.0, 0.05), (40.0, 0.2)] {
            let what = if form == "box" { "[1, 0.6, 1]" } else { r#""it.off""# };
            let rest = format!(
                r#""position": [0, 0, 0], "frequency": {frequency}, "damping": {}, "turn": [0.1, 0.2, 0.3]"#,
                fades / frequency
            );
            let mut model = model(&body(&format!(r#"{{"{form}": {what}}}"#), spacing, &rest), &mut round).unwrap();
            let faster = 0.1 * TAU as f32 * frequency as f32;
            model.particles.iter_mut().for_each(|p| p.velocity = p.position * faster);
            let scene = Scene { substeps: 10, ..model.scene() };
            let mut system = started(&scene, model.particles.len(), 1);
            let arms: f32 = model.particles.iter().map(|p| p.position.length_squared()).sum();
            let omega = TAU * frequency;
            let slows = 0.5 * omega * omega * fades / frequency;
            let swings = (omega * omega - slows * slows).sqrt();
            for quarter in 1..=5u32 {
                run_on(&mut system, &scene, 1.0 / (200.0 * frequency), quarter);
                let x = system.particles().position.iter().zip(&model.particles);
                let share = x.map(|(x, p)| (*x - p.position).dot(p.position)).sum::<f32>() / arms;
                let t = f64::from(quarter) / (4.0 * frequency);
                let should = f64::from(faster) / swings * (-slows * t).exp() * (swings * t).sin();
                let name = format!("{form} {spacing}, {frequency} Hz, {fades}, {} particles", model.particles.len());
                assert!((f64::from(share) - should).abs() < 0.003, "{name}, quarter {quarter}: {share}, not {should}");
            }
        }
    }
}

/// Goes on with steps of `h` \[s\] to the end of the next fifty.
fn run_on(system: &mut pointmass::System<pointmass::Heap>, scene: &Scene<'_>, h: f64, fifty: u32) {
    for i in 50 * (fifty - 1) + 1..=50 * fifty {
        system.step(scene, pointmass::Time::from_seconds_f64(h * f64::from(i)) - system.time());
    }
}

#[test]
fn what_is_held_goes_with_its_motion_and_is_counted_behind_ropes() {
    let text = r#"{"particles": [{}], "ropes": [{"curve": [[0, 0, 0], [1, 0, 0]], "segments": 3, "weight": 1}],
        "soft_bodies": [{"form": {"box": [1, 1, 1]}, "spacing": 0.5, "density": 1, "give": 1, "damping": 0.1, "position": [3, 0, 0],
        "held": [[9, 9, 9], [-9, 0, -9]], "motion": {"drift": [0.5, 0, 0]}}]}"#;
    let model = model(text, &mut One(vec![], vec![])).unwrap();
    assert_eq!((&model.ropes[..], &model.soft_bodies[..]), (&[1][..], &[5][..]));
    let mut system = started(&model.scene(), 13, 1);
    run(&mut system, &model.scene(), 1.0 / 60.0, 240);
    for (p, x) in model.particles.iter().zip(system.particles().position).skip(5) {
        assert!((*x - p.position).distance(Vec3::X * 2.0) < 0.02, "{p:?}: {x}");
    }
    let clusters = model.constraints.0.iter().filter(|one| matches!(one, ConstraintKind::Cluster(_))).count();
    assert_eq!((clusters, model.particles[5].radius), (1, 0.2));
}

#[test]
fn what_cannot_be_filled_is_refused_by_name() {
    let (corners, mut triangles) = icosahedron();
    let (form, more) = (r#"{"mesh": "it.off"}"#, r#""position": [0, 0, 0], "give": 1"#);
    let said = |text: &str, mesh: &mut One| model(text, mesh).map(|_| String::new()).unwrap_or_else(|error| error);
    let last = triangles.pop().unwrap();
    let open = One(corners.clone(), triangles.clone());
    triangles.push([last[0], last[2], last[1]]);
    let turned = One(corners.clone(), triangles);
    let flat = cuboid(Vec3::new(1.0, 0.0, 1.0), Vec3::ZERO);
    for (mesh, words) in [
        (&open, "form: is no closed mesh: at its edge from ["),
        (&open, "a triangle is missing there: close it"),
        (&turned, "both of its triangles run along it the same way: turn them alike"),
        (&flat, "form: is a mesh that encloses nothing"),
    ] {
        let said = said(&body(form, 0.3, more), &mut One(mesh.0.clone(), mesh.1.clone()));
        assert!(said.contains(words), "{said}");
    }
    for (form, spacing, rest, words) in [
        (r#"{"box": [1, 0, 1]}"#, 0.1, more, "form.box: has to be above zero, not 0"),
        (
            r#"{"box": [1, 1, 1]}"#,
            0.9,
            more,
            "spacing: leaves room for 1 of its particles, of which there have to be two: take 0.5",
        ),
        (
            r#"{"box": [1, 1, 1]}"#,
            1e-3,
            more,
            "spacing: makes 1000000000 particles; the soft bodies of a scene may have 262144",
        ),
        (r#"{"box": [1, 1, 1]}"#, 0.0, more, "spacing: has to be above zero"),
        (
            r#"{"box": [1, 1, 1]}"#,
            0.1,
            r#""position": [0, 0, 0]"#,
            "give: is missing: say give, in percent, or frequency",
        ),
        (r#"{"box": [1, 1, 1]}"#, 0.1, r#""position": [0, 0, 0], "give": 1, "frequency": 1"#, "give: say either"),
        (r#"{"box": [1, 1, 1]}"#, 0.1, r#""position": [0, 0, 0], "frequency": 0"#, "frequency: has to be above zero"),
        (
            r#"{"box": [1, 1, 1]}"#,
            0.1,
            r#""position": [0, 0, 0], "frequency": 1e-30"#,
            "frequency: makes it softer than",
        ),
        (
            r#"{"box": [1, 1, 1]}"#,
            0.1,
            r#""position": [0, 0, 0], "give": 1, "held": [[2, 2, 2], [3, 3, 3]]"#,
            "held: has none of",
        ),
        (
            r#"{"box": [1, 1, 1]}"#,
            0.1,
            r#""position": [0, 0, 0], "give": 1, "held": [[-2, -2, -2], [3, 3, 3]]"#,
            "held: has all of",
        ),
        (
            r#"{"box": [1, 1, 1]}"#,
            0.1,
            r#""position": [0, 0, 0], "give": 1, "motion": {}"#,
            "motion: leads what is held; say held",
        ),
        (
            r#"{"box": [1, 1, 1]}"#,
            0.1,
            r#""position": [0, 0, 0], "give": 1, "material": 0"#,
            "material: 0 is out of range",
        ),
        (r#"{"box": [1e20, 1e20, 1e20]}"#, 1e19, more, "scale: makes it inf m³ large"),
    ] {
        let said = said(&body(form, spacing, rest), &mut One(vec![], vec![]));
        assert!(said.contains(&format!("soft_bodies[0].{words}")), "{form} {spacing} {rest}: {said}");
    }
}

/// Balls that overlap where they begin get a remark, if they answer each other's touch: in a box they are as far apart as whole numbers of cells allow.
/// Contacts by position leave those of a rigid body alone.
#[test]
fn a_body_whose_balls_overlap_gets_a_remark() {
    let position = r#""contacts": {"position": {}},"#;
    let force = r#""contacts": {"force": {"stiffness": 1000}},"#;
    for (spacing, give, radius, contacts, is_odd) in [
        (0.1, 1, r#", "radius": 0.08"#, position, true),
        (0.1, 0, r#", "radius": 0.08"#, position, false),
        (0.1, 0, r#", "radius": 0.08"#, force, true),
        (0.1, 1, r#", "radius": 0.08"#, "", false),
        (0.1, 1, r#", "radius": 0.05"#, position, false),
        (0.1, 1, "", r#""contacts": {"impulse": {}},"#, false),
        (0.3, 1, r#", "radius": 0.16"#, position, false),
        (0.35, 1, r#", "radius": 0.17"#, position, true),
        (0.66, 1, "", position, true),
    ] {
        let text = format!(
            r#"{{{contacts} "soft_bodies": [{{"form": {{"box": [1, 1, 1]}}, "spacing": {spacing}, "density": 100,
            "position": [0, 1, 0], "give": {give}{radius}}}]}}"#
        );
        let file = SceneFile::from_json("it.json", &text).unwrap_or_else(|error| panic!("{error}"));
        let remarks = file.remarks();
        let told = remarks.iter().any(|remark| remark.starts_with("soft_bodies[0].radius: balls of"));
        assert_eq!(told, is_odd, "{spacing} {give} {radius} {contacts}: {remarks:?}");
    }
}
