//! Charges, and sums over far groups in a run.

use super::{UNIT, cloud, forces};
use pointmass::force::State;
use pointmass::index::BarnesHut;
use pointmass::{Coulomb, Force, Measures, Method, MutualGravity, Particle, Scene, Time, Vec3};
use pointmass_tests::fields::used;
use pointmass_tests::{Random, f64s, gap, run, started};

/// Unlike UNIT in sign only.
const MIRROR: Coulomb = Coulomb { constant: -1.0, ..Coulomb::VACUUM };

#[test]
fn two_microcoulombs_fly_apart() {
    let at = |x: f32| Particle { position: Vec3::X * x, mass: 1e-3, charge: 1e-6, ..Particle::REST };
    let start = [at(-0.05), at(0.05)];
    let rk4 = Method::Rk4.integrator();
    let scene = Scene { start: &start, forces: &Coulomb::VACUUM, integrator: rk4, ..Scene::EMPTY };
    let mut system = started(&scene, 2, 0);
    let before = Measures::of(&system, &scene).energy.total();
    assert!((before / (8.987_551_792_3e9 * 1e-12 / 0.1) - 1.0).abs() < 1e-6, "{before}");
    let time = (1u32..10_000).find_map(|i| {
        system.step(&scene, Time::from_seconds_f64(2e-5 * f64::from(i)) - system.time());
        let p = system.particles();
        let over = gap(f64s(p.position[0]), f64s(p.position[1])) - 0.4;
        let speed = gap(f64s(p.velocity[0]), f64s(p.velocity[1]));
        (over >= 0.0).then(|| system.time().seconds_f64() - over / speed)
    });
    let time = time.expect("they get there");
    // 1261 steps of half an ulp of 0.2 m, 7e-9 m, at 16 m/s each.
    assert!((time / 0.025_215_840_6 - 1.0).abs() < 1e-6, "{time}");
    let after = Measures::of(&system, &scene).energy.total();
    assert!((after / before - 1.0).abs() < 1e-6, "{before} becomes {after}");
}

#[test]
fn charges_act_as_masses_do_but_for_the_sign() {
    let start: Vec<Particle> = cloud(300).iter().map(|p| Particle { charge: p.mass, ..*p }).collect();
    let scene = Scene { start: &start, ..Scene::EMPTY };
    let system = started(&scene, 300, 0);
    let direct = forces(&system, &scene, &MIRROR);
    assert_eq!(direct, forces(&system, &scene, &UNIT));
    let state = system.state(&scene);
    assert_eq!(MIRROR.energy(&state), UNIT.energy(&state));
    // Equal signs repel, unlike ones attract.
    for (charge, sign) in [(2.0, 1.0), (-2.0, -1.0), (0.0, 0.0)] {
        let start =
            [(1.0, 3.0), (0.0, charge)].map(|(x, charge)| Particle { position: Vec3::X * x, charge, ..Particle::REST });
        let scene = Scene { start: &start, ..Scene::EMPTY };
        let force = forces(&started(&scene, 2, 0), &scene, &Coulomb { constant: 2.0, ..Coulomb::VACUUM });
        assert_eq!(force, [Vec3::X * (12.0 * sign), Vec3::X * (-12.0 * sign)]);
    }
    // Steps, with a tree of each.
    for theta in [0.0, 0.6] {
        let (charge, mass) =
            (Coulomb { theta, softening: 0.1, ..MIRROR }, MutualGravity { theta, softening: 0.1, ..UNIT });
        let end = |forces: &dyn Force| {
            let scene = Scene { start: &start, forces, ..Scene::EMPTY };
            let mut system = started(&scene, 310, 0);
            run(&mut system, &scene, 1e-3, 5);
            system.hash()
        };
        assert_eq!(end(&charge), end(&mass), "{theta}");
        // A force of no strength that has a tree of its own made changes nothing.
        let (no_charge, no_mass) = (Coulomb { constant: 0.0, ..charge }, MutualGravity { constant: 0.0, ..mass });
        assert_eq!(end(&(charge, no_mass)), end(&mass), "{theta}");
        assert_eq!(end(&(mass, no_charge)), end(&mass), "{theta}");
    }
}

#[test]
fn trees_take_their_columns() {
    let (mass, charge) = (MutualGravity { theta: 0.5, ..UNIT }, Coulomb { theta: 0.5, ..MIRROR });
    let columns = |forces: &dyn Force| Scene { forces, ..Scene::EMPTY }.columns();
    assert_eq!(
        [&mass as &dyn Force, &charge, &(mass, charge), &(charge, charge), &MIRROR].map(columns),
        [6, 6, 11, 6, 1]
    );
}

/// A cloud of bodies with charges of both signs, or of one.
fn bodies(n: usize, mixed: bool) -> Vec<Particle> {
    let mut random = Random::new(12);
    let sign = |i: usize| if mixed && i.is_multiple_of(2) { -1.0 } else { 1.0 };
    (0..n)
        .map(|i| {
            let position = random.direction() * random.unit().cbrt();
            let (mass, velocity) = (random.between(0.5, 1.5) / n as f32, random.vector(0.5));
            Particle { position, velocity, mass, charge: sign(i) * mass, ..Particle::REST }
        })
        .collect()
}

#[test]
fn far_groups_conserve_momentum_and_are_near_the_direct_sum() {
    let n = if cfg!(debug_assertions) { 1000 } else { 20_000 };
    let steps = if cfg!(debug_assertions) { 20 } else { 100 };
    let gravity = MutualGravity { softening: 0.02, theta: 0.5, quadrupole: true, ..UNIT };
    let charge = Coulomb { constant: 1.0, softening: 0.02, theta: 0.5, quadrupole: true };
    let direct = (MutualGravity { theta: 0.0, ..gravity }, Coulomb { theta: 0.0, ..charge });
    // Signs that cancel leave sums small beside their terms.
    let cases: [(&str, bool, &dyn Force, &dyn Force, f64); 3] = [
        ("gravity", false, &gravity, &direct.0, 3e-3),
        ("charge", false, &charge, &direct.1, 3e-3),
        ("both signs", true, &charge, &direct.1, 3e-2),
    ];
    for (name, mixed, far, near, bound) in cases {
        let start = bodies(n, mixed);
        let scene = Scene { start: &start, forces: far, ..Scene::EMPTY };
        let mut system = started(&scene, n, 0);
        let (mut of_mass, mut of_charge) = (used(BarnesHut::words(n + 8)), used(BarnesHut::words(n + 8)));
        let state = system.state(&scene);
        let mass_tree = BarnesHut::over(&mut of_mass, state.position, state.mass);
        let charge_tree = BarnesHut::over(&mut of_charge, state.position, state.charge);
        let state = State { mass_tree: mass_tree.as_ref(), charge_tree: charge_tree.as_ref(), ..state };
        let mut sums = [vec![Vec3::ZERO; n], vec![Vec3::ZERO; n]];
        far.add_to(&state, 0..n, &mut sums[0]);
        near.add_to(&state, 0..n, &mut sums[1]);
        let square = |v: [f64; 3]| v.iter().map(|x| x * x).sum::<f64>();
        let whole: f64 = sums[1].iter().map(|f| square(f64s(*f))).sum();
        let off: f64 = sums[0].iter().zip(&sums[1]).map(|(a, b)| gap(f64s(*a), f64s(*b)).powi(2)).sum();
        let off = (off / whole).sqrt();
        assert!(off < bound, "{name}: {off} of the RMS force");

        let before = Measures::of(&started(&Scene { forces: &(), ..scene }, n, 0), &Scene::EMPTY).momentum;
        for i in 1..=steps {
            system.step(&scene, Time::from_seconds_f64(1e-3 * f64::from(i)) - system.time());
        }
        let p = system.particles();
        let sum = |part: &dyn Fn(usize) -> f64| (0..n).map(part).sum::<f64>();
        let size = sum(&|i| f64::from(p.mass[i] * p.velocity[i].length()));
        let after: [f64; 3] = core::array::from_fn(|k| sum(&|i| f64::from(p.mass[i]) * f64::from(p.velocity[i][k])));
        let drift = gap(before, after) / size;
        println!("{name}: forces off by {off:.2e}, momentum by {drift:.2e}");
        assert!(drift < 1e-4, "{name}: {drift} of all momentum");
    }
}
