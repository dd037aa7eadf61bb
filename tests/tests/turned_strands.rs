//! Strands whose ends are turned about themselves, against closed forms: what they carry around, what it takes, and when they writhe.

use pointmass::scene::{Model, SceneFile};
use pointmass::{
    ConstraintKind, Gravity, Heap, Measures, Method, Particle, Scene, StrandParams, Strands, System, Time, Vec3,
};
use pointmass_tests::{Random, run, started};
use std::f32::consts::TAU;

const G: f32 = 9.81;

type Tuft = Strands<Vec<u32>, [u32; 1]>;

/// A shaft along x, clamped behind its first points, with an arm along z at its end that carries a load there.
#[derive(Clone, Copy)]
struct Crank {
    edges: u32,
    edge: f32,
    load: f32,
    twisting: f32,
    damping: f32,
    /// How many points are fixed behind the shaft, the last at its beginning.
    fixed: u32,
    /// True if its points go from the load to the clamp, so that the tip is what is turned.
    backward: bool,
    /// The mass of the clamp's points, if they are not fixed, but held by that.
    heavy: Option<f32>,
}

impl Crank {
    fn start(&self) -> Vec<Particle> {
        let clamp = |i: u32| i < self.fixed;
        let point = |i: u32| Particle {
            position: Vec3::X * (self.edge * (i as f32 + 1.0 - self.fixed as f32)),
            mass: self.heavy.filter(|_| clamp(i)).unwrap_or(1e-3),
            fixed: clamp(i) && self.heavy.is_none(),
            ..Particle::REST
        };
        let mut start: Vec<_> = (0..self.fixed + self.edges).map(point).collect();
        let end = start[start.len() - 1].position;
        start.push(Particle { position: end + Vec3::Z * self.edge, mass: self.load, ..Particle::REST });
        if self.backward {
            start.reverse();
        }
        start
    }

    /// As a strand that is turned at its clamp with a rate, right-handed about x.
    fn strand(&self, rate: f32) -> Tuft {
        let params = StrandParams {
            stretch: Some(1e5),
            bending: [100.0 * self.twisting; 2],
            twisting: self.twisting,
            damping: self.damping,
        };
        let count = self.fixed + self.edges + 1;
        let turning = if self.backward { [0.0, -rate] } else { [rate, 0.0] };
        let held = if self.heavy.is_some() { [!self.backward, self.backward] } else { [false; 2] };
        Strands { turning, held, ..Strands::of((0..count).collect(), [count], params) }
    }

    /// How far the arm is turned about the shaft.
    fn angle(&self, system: &System<Heap>) -> f32 {
        let x = system.particles().position;
        let arm = if self.backward { x[0] - x[1] } else { x[x.len() - 1] - x[x.len() - 2] };
        (-arm.y).atan2(arm.z)
    }
}

/// By how much a winch is behind that is turned by an angle against its load, for each unit of torque that the load has at its arm then \[1/J\].
fn lag(crank: &Crank, angle: f32, (substeps, method): (u32, Method)) -> f32 {
    let (start, down) = (crank.start(), Gravity { acceleration: Vec3::NEG_Y * G });
    let [driven, still] = [angle, 0.0].map(|rate| crank.strand(rate));
    let [first, then] = [&driven, &still].map(|constraints| Scene {
        start: &start,
        forces: &down,
        constraints,
        substeps,
        integrator: method.integrator(),
        ..Scene::EMPTY
    });
    let mut system = started(&first, start.len(), 0);
    for frame in 1..=180 {
        system.step_to(if frame > 60 { &then } else { &first }, Time::frame(frame, 60));
    }
    let has = crank.angle(&system);
    (has - angle) / (crank.load * G * crank.edge * has.cos())
}

/// A winch that is turned by φ lifts a load m g at an arm r until its shaft is twisted by the load's torque: of a shaft that is longer by L it is behind by
/// m g r cos α L / (G J) more, whatever the arm does.
#[test]
fn a_winch_is_behind_by_the_twist_that_its_load_makes() {
    for (number, (edge, more, way)) in [
        (0.05f32, 6u32, (10u32, Method::Symplectic)),
        (0.08, 4, (20, Method::Verlet)),
        (0.04, 8, (8, Method::Rk4)),
        (0.05, 10, (5, Method::Symplectic)),
    ]
    .into_iter()
    .enumerate()
    {
        // Weightless but for its load, which twists the longer shaft by about 0.3 rad.
        let (edges, load) = (4u32, 0.2f32);
        let twisting = load * G * edge * edge * (edges + more) as f32 / 0.3;
        let damping = (0.3 * edge / G).sqrt();
        let (fixed, backward) = (2 + number as u32 % 3, number % 2 == 1);
        let short = Crank { edges, edge, load, twisting, damping, fixed, backward, heavy: None };
        let long = Crank { edges: edges + more, ..short };
        for angle in [-1.2, 0.9] {
            let [short, long] = [&short, &long].map(|crank| lag(crank, angle, way));
            let share = (long - short) * twisting / (edge * more as f32);
            assert!((share - 1.0).abs() < 0.03, "{way:?}, {more} edges more, by {angle}: {share}");
        }
    }
}

/// The end of a strand that nobody holds but what turns it: its clamp is so heavy that it stays, and the arm goes around as fast.
#[test]
fn a_free_strand_whose_end_is_turned_is_given_energy() {
    for (method, backward) in [(Method::Symplectic, false), (Method::Verlet, true)] {
        let heavy = Some(100.0);
        let (edge, load) = (0.05f32, 0.01f32);
        let crank = Crank { edges: 6, edge, load, twisting: 0.05, damping: 0.01, fixed: 2, backward, heavy };
        let (start, integrator, rate) = (crank.start(), method.integrator(), 4.0f32);
        let driven = crank.strand(rate);
        let scene = Scene { start: &start, constraints: &driven, substeps: 10, integrator, ..Scene::EMPTY };
        let mut system = started(&scene, start.len(), 0);
        run(&mut system, &scene, 1.0 / 60.0, 90);
        // More than half a turn.
        let (has, should) = (crank.angle(&system), rate * 1.5 - TAU);
        assert!((has - should).abs() < 0.02, "{method}: {has}, not {should}");
        let (energy, should) = (Measures::of(&system, &scene).energy.kinetic, 0.5 * load * (rate * edge).powi(2));
        assert!((energy / f64::from(should) - 1.0).abs() < 0.1, "{method}: {energy}, not {should}");
    }
}

/// How far a straight wire between two clamps gets from its axis, as a share of its length, once its tip has been turned slowly by so many radians.
fn writhe(edges: u32, angle: f32, ratio: f32, substeps: u32, method: Method) -> f32 {
    let (along, long, bending) = (Vec3::new(0.6, 0.0, 0.8), 0.5f32, 2e-3f32);
    let (edge, last) = (long / edges as f32, edges + 2);
    let mut random = Random::new(1);
    let point = |i: u32| {
        let is_fixed = i < 2 || i + 1 >= last;
        let aside = if is_fixed { Vec3::ZERO } else { random.vector(1e-4 * long) };
        let position = along * (edge * (i as f32 - 1.0)) + aside;
        Particle { position, mass: 0.02 * edge, fixed: is_fixed, ..Particle::REST }
    };
    let start: Vec<_> = (0..=last).map(point).collect();
    let params = StrandParams {
        stretch: Some(400.0 * bending / long.powi(2)),
        bending: [bending; 2],
        twisting: ratio * bending,
        damping: 1e-3,
    };
    let still = Strands::of((0..=last).collect::<Vec<u32>>(), [last + 1], params);
    let driven = Strands { turning: [0.0, angle / 4.0], ..still.clone() };
    let integrator = method.integrator();
    let [first, then] =
        [&driven, &still].map(|constraints| Scene { start: &start, constraints, substeps, integrator, ..Scene::EMPTY });
    let mut system = started(&first, start.len(), 0);
    for frame in 1..=480 {
        system.step_to(if frame > 240 { &then } else { &first }, Time::frame(frame, 60));
    }
    let far = |x: &Vec3| x.cross(along).length() / long;
    system.particles().position.iter().map(far).fold(0.0, f32::max)
}

/// Clamped at both ends and turned at one by θ: straight until θ = 8.9868 B / C, twice the first root of tan x = x (Love, "A Treatise on the
/// Mathematical Theory of Elasticity", 1927, article 272).
#[test]
fn a_wire_that_is_turned_writhes_at_its_theoretical_twist() {
    for (edges, ratio, substeps, method, sense) in [
        (18u32, 1.5f32, 10, Method::Symplectic, 1.0f32),
        (12, 2.0, 5, Method::Verlet, -1.0),
        (24, 1.0, 8, Method::Rk4, 1.0),
    ] {
        let critical = 8.9868 / ratio * sense;
        let [below, above] = [0.93, 1.08].map(|share| writhe(edges, share * critical, ratio, substeps, method));
        assert!(below < 3e-3, "{method}, {edges} edges: {below}");
        assert!(above > 0.02, "{method}, {edges} edges: {above}");
    }
}

#[test]
fn rates_that_cannot_be_are_refused_by_name() {
    let strand = Strands::of(vec![0, 1], [2], StrandParams::round(1e-3, 1e9, 0.3));
    for wrong in [f32::NAN, f32::INFINITY] {
        let fault = Strands { turning: [0.0, wrong], ..strand.clone() }.fault();
        assert_eq!(fault, Some(("turning", "has to be finite, in rad/s")));
    }
    let curve = r#"{"curve": [[0, 0, 0], [1, 0, 0]]}"#;
    let field = r#"{"on": {"shape": {"sphere": {"center": [0, 1, 0], "radius": 0.1}}, "count": 3, "length": 0.2}}"#;
    let load = |form: &str, rest: &str| {
        let text = format!(
            r#"{{"strands": [{{"form": {form}, "segments": 8, "radius": 1e-3, "young": 1e9, "density": 1000, {rest}}}]}}"#
        );
        let file = SceneFile::from_json("it.json", &text).map_err(|error| error.to_string())?;
        Model::load(&file, "it.json", &mut ()).map_err(|error| error.to_string())
    };
    for (form, rest, end) in [
        (curve, r#""turning": [1, 0]"#, "root"),
        (curve, r#""turning": [0, 1], "fixed": [0, 1, 8]"#, "tip"),
        (curve, r#""turning": [1, 0], "fixed": [0, 2], "held": [false, true]"#, "root"),
        (field, r#""turning": [1, -1]"#, "tip"),
    ] {
        let said = load(form, rest).expect_err("nothing is turned");
        let words = format!("strands[0].turning: needs a {end} that is held, or clamped by two neighbours in fixed");
        assert!(said.contains(&words), "{rest}: {said}");
    }
    for (form, rest, held, turning) in [
        (curve, r#""turning": [1, 0], "held": [true, false]"#, [true, false], [1.0, 0.0]),
        (curve, r#""turning": [1, -2], "fixed": [0, 1, 7, 8]"#, [false; 2], [1.0, -2.0]),
        (field, r#""turning": [3, 0]"#, [false; 2], [3.0, 0.0]),
        (curve, r#""fixed": [0]"#, [false; 2], [0.0; 2]),
    ] {
        let model = load(form, rest).expect("it is sound");
        let [ConstraintKind::Strands(made)] = &model.constraints.0[..] else { panic!("{:?}", model.constraints.0) };
        assert_eq!((made.held, made.turning), (held, turning), "{rest}");
    }
    let remarks = |fixed: bool| {
        let text = format!(
            r#"{{"particles": [{{"position": [0, 0, 0], "fixed": {fixed}}}, {{"position": [1, 0, 0], "fixed": true}}, {{"position": [2, 0, 0]}}],
            "constraints": [{{"strands": {{"particles": [0, 1, 2], "points": [3], "turning": [1, 0],
            "params": {{"bending": [1, 1], "twisting": 1}}}}}}]}}"#
        );
        SceneFile::from_json("it.json", &text).expect("it is sound").remarks()
    };
    assert!(remarks(true).is_empty(), "{:?}", remarks(true));
    assert!(remarks(false)[0].contains("constraints[0].strands.turning: no root is held or clamped"));
}
