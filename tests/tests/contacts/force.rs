//! Balls that push each other apart.

use pointmass::force::{Friction, Perturbation, State};
use pointmass::index::Structure;
use pointmass::scene::{Model, SceneFile};
use pointmass::{Force, Ledger, Particle, Penalty, Rk4, Scene, Time, Vec3};
use pointmass_tests::{Random, f64s, often, started};

const PENALTY: Penalty =
    Penalty { stiffness: 800.0, damping: 0.3, friction: Friction { static_: 0.6, kinetic: 0.4 }, reach: 1.0 };

fn with_state<T>(start: &[Particle], then: impl FnOnce(&State<'_>) -> T) -> T {
    let scene = Scene { start, ..Scene::EMPTY };
    then(&started(&scene, start.len(), 0).state(&scene))
}

fn forces(start: &[Particle]) -> Vec<Vec3> {
    with_state(start, |state| {
        let mut total = vec![Vec3::ZERO; start.len()];
        PENALTY.add_to(state, 0..start.len(), &mut total);
        total
    })
}

fn cloud(random: &mut Random, n: usize) -> Vec<Particle> {
    (0..n)
        .map(|_| Particle {
            position: random.vector(0.5),
            velocity: random.vector(3.0),
            radius: random.between(0.0, 0.5),
            mass: random.magnitude(0.01, 100.0),
            ..Particle::REST
        })
        .collect()
}

#[test]
fn it_never_pulls_and_both_feel_the_same() {
    let mut random = Random::new(51);
    let mut touching = 0;
    for _ in 0..often(20_000) {
        let start = cloud(&mut random, 2);
        let [a, b] = forces(&start)[..] else { unreachable!() };
        assert_eq!(a, -b);
        let apart = start[0].position - start[1].position;
        let (normal, relative) = (apart.normalize(), start[0].velocity - start[1].velocity);
        let push = a.dot(normal);
        let size = a.length().max(1e-3);
        assert!(push >= -1e-5 * size, "{start:?} {a}");
        let (across, slip) = (a - normal * push, relative - normal * relative.dot(normal));
        assert!(across.length() <= PENALTY.friction.kinetic * push + 1e-5 * size, "outside of the cone");
        assert!(across.dot(slip) <= 1e-5 * size * slip.length(), "friction drives");
        let overlap = start[0].radius + start[1].radius - apart.length();
        assert!(overlap > 0.0 || a == Vec3::ZERO);
        touching += usize::from(overlap > 0.0);
    }
    assert!(touching > often(2000));
}

#[test]
fn its_jacobian_is_symmetric_and_its_slope_along_the_line_of_centres() {
    let mut random = Random::new(52);
    let dot = |a: &[Vec3], b: &[Vec3]| a.iter().zip(b).map(|(a, b)| f64::from(a.dot(*b))).sum::<f64>();
    for _ in 0..20 {
        let start = cloud(&mut random, 20);
        let action = |along: &[Vec3], [position, velocity]: [f32; 2]| {
            with_state(&start, |state| {
                let mut total = vec![Vec3::ZERO; start.len()];
                PENALTY.add_jacobian(state, &Perturbation { along, position, velocity }, &mut total);
                total
            })
        };
        let [a, b]: [Vec<Vec3>; 2] = core::array::from_fn(|_| (0..20).map(|_| random.vector(1.0)).collect());
        let [ja, jb] = [&a, &b].map(|along| action(along, [1.0, 0.3]));
        let size = dot(&ja, &ja).sqrt() * dot(&b, &b).sqrt();
        assert!((dot(&a, &jb) - dot(&b, &ja)).abs() <= 1e-5 * size);
        assert!(dot(&a, &ja) <= 1e-6 * size && dot(&a, &ja) < 0.0);
        let mut diagonal = vec![Vec3::ZERO; 20];
        with_state(&start, |state| PENALTY.add_stiffness(state, [0.7, 0.3], &mut diagonal));
        for (row, entry) in diagonal.iter().enumerate() {
            for axis in 0..3 {
                let mut unit = vec![Vec3::ZERO; 20];
                unit[row][axis] = 1.0;
                let own = -action(&unit, [0.7, 0.3])[row][axis];
                assert!((entry[axis] - own).abs() <= 1e-5 * (1.0 + own), "{entry} {own}");
            }
        }
    }
    // Two on a line that close in: nothing is left out.
    let at = |x: f32| Particle {
        position: Vec3::X * x,
        velocity: Vec3::X * -x,
        radius: 0.3,
        mass: 1.0 + x,
        ..Particle::REST
    };
    let start = [at(0.0), at(0.5)];
    for weights in [[1.0, 0.0], [0.0, 1.0], [0.7, 0.3]] {
        let along = [Vec3::X * 0.4, Vec3::X * -0.9];
        let mut told = [Vec3::ZERO; 2];
        let change = Perturbation { along: &along, position: weights[0], velocity: weights[1] };
        with_state(&start, |state| PENALTY.add_jacobian(state, &change, &mut told));
        let moved = |h: f32| {
            let mut start = start;
            for (ball, &along) in start.iter_mut().zip(&along) {
                ball.position += along * (h * weights[0]);
                ball.velocity += along * (h * weights[1]);
            }
            forces(&start)
        };
        let h = 1.0 / 1024.0;
        let (low, high) = (moved(-h), moved(h));
        for row in 0..2 {
            let slope = (high[row] - low[row]) / (2.0 * h);
            assert!((told[row] - slope).length() < 1e-3 * slope.length(), "{} {slope}", told[row]);
        }
    }
}

#[test]
fn a_tenth_of_critical_damping_gives_back_0_744_of_the_speed() {
    let ball = |x: f32, v: f32| Particle {
        position: Vec3::X * x,
        velocity: Vec3::X * v,
        radius: 0.5,
        mass: if v > 0.0 { 1.0 } else { 3.0 },
        ..Particle::REST
    };
    let start = [ball(-0.501, 0.3), ball(0.501, -0.7)];
    let penalty = Penalty { stiffness: 1e5, damping: 0.1, reach: 1.0, ..Penalty::NONE };
    let scene = Scene { start: &start, forces: &penalty, integrator: &Rk4, ..Scene::EMPTY };
    let mut system = started(&scene, 2, 1);
    let mut ledger = Ledger::new(&system, &scene);
    for _ in 0..400 {
        system.step_observed(&scene, Time::from_seconds(1e-4), &mut ledger);
    }
    let v = system.particles().velocity;
    let restitution = v[1].x - v[0].x;
    assert!((restitution / 0.744 - 1.0).abs() < 0.01, "{restitution}");
    let momentum = f64::from(v[0].x) + 3.0 * f64::from(v[1].x);
    assert!((momentum + 1.8).abs() < 1e-5, "{momentum}");
    // Half of the reduced mass times the square of a speed that falls from 1 m/s.
    let lost = 0.5 * 0.75 * (1.0 - f64::from(restitution).powi(2));
    let books = ledger.books();
    assert!((books.work("penalty") + lost).abs() < 0.01 * lost, "{books:?} {lost}");
    assert!(books.remainder.abs() < 0.01 * lost, "{books:?}");
}

#[test]
fn every_index_finds_the_same_neighbours() {
    let start = cloud(&mut Random::new(53), 60);
    let after = |index: &dyn pointmass::index::IndexChoice| {
        let scene = Scene { start: &start, forces: &PENALTY, index, ..Scene::EMPTY };
        let mut system = started(&scene, 60, 1);
        system.step(&scene, Time::from_seconds(1e-4));
        system.particles().velocity.to_vec()
    };
    let want = after(&());
    for structure in Structure::ALL {
        for (v, want) in after(structure).iter().zip(&want) {
            // Only the order of the sum differs.
            assert!((*v - *want).length() <= 1e-4 * (1.0 + want.length()), "{structure}: {v} {want}");
        }
    }
}

#[test]
fn a_scene_says_how_far_it_reaches() {
    let text = r#"{ "particles": [
        { "position": [-0.9, 0, 0], "velocity": [1, 0, 0], "radius": 0.3, "mass": 1 },
        { "position": [0.9, 0, 0], "velocity": [-1, 0, 0], "radius": 0.7, "mass": 1 }],
        "contacts": { "force": { "stiffness": 10000 } } }"#;
    let file = SceneFile::from_json("balls.json", text).expect("a scene");
    let model = Model::load(&file, "balls.json", &mut ()).expect("a model");
    let scene = model.scene();
    let mut system = started(&scene, 2, 1);
    for _ in 0..1000 {
        system.step(&scene, Time::from_seconds(1e-3));
    }
    let speed = f64s(system.particles().velocity[0])[0];
    assert!((speed + 1.0).abs() < 0.01, "turned back: {speed}");
}
