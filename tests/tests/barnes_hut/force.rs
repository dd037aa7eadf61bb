//! The sums as a force: what it needs, and whether the memory it is given makes a difference.

use super::{BOTH, UNIT, law, nested, particles};
use pointmass::{
    Drag, Force, ForceKind, Gravity, Heap, Inline, Method, MutualGravity, Particle, Scene, Size, System, Time, Vec3,
};
use pointmass_tests::fields::Charges;
use pointmass_tests::points::Spread;
use pointmass_tests::{f64s, gap, often, run, started};

/// The accelerations in a system, from the change of velocities in a step so short that nothing moves.
fn accelerations(start: &[Particle], force: &MutualGravity, capacity: usize) -> Vec<Vec3> {
    let scene = Scene { start, forces: force, ..Scene::EMPTY };
    let mut system = started(&scene, capacity, 0);
    let dt = Time::from_ticks(1 << 12);
    system.step(&scene, dt);
    system.particles().velocity.iter().map(|&v| v / dt.seconds()).collect()
}

#[test]
fn a_system_feels_what_the_tree_says() {
    let charges = Charges::masses(Spread::Plummer, 1000, 1);
    let start = particles(&charges);
    for theta in [0.3, 0.5, 0.7] {
        for quadrupole in BOTH {
            let force = MutualGravity { theta, quadrupole, ..UNIT };
            let found: Vec<_> = accelerations(&start, &force, 1000).into_iter().map(Some).collect();
            let sums = charges.sums(law(theta, 0.01, quadrupole));
            let apart = found.iter().zip(&sums).map(|(a, b)| {
                let [a, b] = [a, b].map(|sum| f64s(sum.expect("it is there")));
                gap(a, b) / gap(b, [0.0; 3])
            });
            // The force is multiplied by the mass and divided by it.
            let apart = apart.fold(0.0, f64::max);
            assert!(apart < 1e-6, "{theta}, {quadrupole}: {apart:e}");
            let twice = MutualGravity { constant: 2.0, ..force };
            let twice: Vec<_> = accelerations(&start, &twice, 1000).into_iter().map(|a| Some(a * 0.5)).collect();
            assert_eq!(twice, found);
        }
    }
    // The force by itself, over a state without a tree, is that over all pairs.
    let scene = Scene { start: &start, ..Scene::EMPTY };
    let system = started(&scene, 1000, 0);
    let mut totals = [vec![Vec3::ZERO; 1000], vec![Vec3::ZERO; 1000]];
    UNIT.add_to(&system.state(&scene), 0..1000, &mut totals[0]);
    MutualGravity { theta: 0.0, ..UNIT }.add_to(&system.state(&scene), 0..1000, &mut totals[1]);
    assert_eq!(totals[0], totals[1]);
}

#[test]
fn a_force_that_needs_a_tree_needs_columns() {
    let (far, near, plain) = (UNIT, MutualGravity { theta: 0.0, ..UNIT }, (Gravity::EARTH, Drag {}));
    let columns = |force: &dyn Force| Scene { forces: force, ..Scene::EMPTY }.columns();
    let kind = ForceKind::MutualGravity(far);
    let without: [&dyn Force; 6] = [&(), &plain, &near, &[near], &vec![near], &ForceKind::MutualGravity(near)];
    for force in without {
        assert_eq!(columns(force), 1);
    }
    let dynamic: [&dyn Force; 2] = [&near, &far];
    let with: [&dyn Force; 13] = [
        &far,
        &&far,
        &kind,
        &(far,),
        &(plain, far),
        &(far, plain, near),
        &(near, plain, near, far),
        &(plain, near, far, plain, near),
        &(plain, near, plain, plain, near, (near, far)),
        &[near, far],
        &&[near, far][..],
        &vec![ForceKind::MutualGravity(near), kind.clone()],
        &dynamic,
    ];
    for (i, force) in with.iter().enumerate() {
        assert_eq!(columns(*force), 6, "{i}");
    }
    assert_eq!(columns(&(far, far, [far])), 6, "one tree does for all");
    for &method in Method::ALL {
        let scene = |forces| Scene { forces, integrator: method.integrator(), ..Scene::EMPTY };
        assert_eq!(scene(&far).columns(), scene(&near).columns() + 5);
        assert_eq!(scene(&far).size().columns, scene(&far).columns());
    }
    assert!(MutualGravity { theta: f32::NAN, ..UNIT }.needs().mass_tree.is_none());
}

#[test]
fn a_system_without_those_columns_is_unfit() {
    let start = particles(&Charges::masses(Spread::Cube, 200, 1));
    for &method in Method::ALL {
        let integrator = method.integrator();
        let plain = Scene { start: &start, integrator, ..Scene::EMPTY };
        let scene = Scene { forces: &UNIT, ..plain };
        for columns in plain.columns()..scene.columns() {
            let mut system = System::with(Heap::new(Size { columns, ..scene.size() }));
            let error = system.start(&scene, 0).expect_err("it does not fit");
            assert_eq!((error.need, error.have.columns), (scene.size(), columns));
            system.start(&plain, 0).expect("it fits");
            let report = system.step(&scene, Time::SECOND);
            assert_eq!((report.caps.insufficient_memory, system.time()), (1, Time::ZERO));
        }
        let mut system = System::with(Heap::new(scene.size()));
        system.start(&scene, 0).expect("it fits");
        assert_eq!(system.step(&scene, Time::from_seconds(0.01)).caps.insufficient_memory, 0);
    }
}

/// The hash after some steps with so much room.
fn hash(start: &[Particle], force: &MutualGravity, method: Method, capacity: usize) -> u64 {
    let scene = Scene { start, forces: force, integrator: method.integrator(), ..Scene::EMPTY };
    let mut system = started(&scene, capacity, 0);
    run(&mut system, &scene, 1e-3, 5);
    assert_eq!(system.len(), start.len());
    system.hash()
}

#[test]
fn the_capacity_makes_no_difference() {
    let numbers = [1, 100, 126, 127, 128, 129, 130, 133, 150, 175, 200, 1000];
    for spread in [Spread::Plummer, Spread::Cube, Spread::Clusters, Spread::Lattice].into_iter().take(often(4)) {
        for n in numbers.into_iter().filter(|&n| n <= often(1500)) {
            let start = particles(&Charges::masses(spread, n, 1));
            for quadrupole in BOTH {
                let force = MutualGravity { quadrupole, ..UNIT };
                let expected = hash(&start, &force, Method::Rk4, n);
                for capacity in [n + 1, 3 * n, 10 * n] {
                    assert_eq!(hash(&start, &force, Method::Rk4, capacity), expected, "{spread:?}, {n} of {capacity}");
                }
            }
        }
    }
}

#[test]
fn the_capacity_makes_no_difference_to_nested_points() {
    for n in [128, 200, 500, 1000].into_iter().take(often(4).max(2)) {
        let start = particles(&nested(n));
        let expected = hash(&start, &UNIT, Method::Verlet, n);
        for capacity in [n + 1, 3 * n, 10 * n] {
            assert_eq!(hash(&start, &UNIT, Method::Verlet, capacity), expected, "{n} of {capacity}");
        }
    }
}

#[test]
fn it_does_not_matter_who_owns_the_memory() {
    let start = particles(&Charges::masses(Spread::Plummer, 150, 1));
    let scene = Scene { start: &start, forces: &UNIT, integrator: Method::Rk4.integrator(), ..Scene::EMPTY };
    assert!(scene.columns() <= 10);
    let mut inline = Box::new(System::with(Inline::<200, 0, 0, 10>::new()));
    inline.start(&scene, 0).expect("it fits");
    for i in 1..=5 {
        inline.step(&scene, Time::from_seconds_f64(1e-3 * f64::from(i)) - inline.time());
    }
    assert_eq!(inline.hash(), hash(&start, &UNIT, Method::Rk4, 150));
}

#[test]
fn fewer_than_128_are_summed_pair_by_pair() {
    let direct = MutualGravity { theta: 0.0, ..UNIT };
    for n in 100..200 {
        let start = particles(&Charges::masses(Spread::Plummer, n, 1));
        let equal = accelerations(&start, &UNIT, 200) == accelerations(&start, &direct, n);
        assert_eq!(equal, n < 128, "{n}");
    }
}

#[test]
fn what_is_fixed_stays_and_acts() {
    let mut start = particles(&Charges::masses(Spread::Plummer, 200, 1));
    start.iter_mut().for_each(|particle| particle.fixed = true);
    start.push(Particle { position: Vec3::X * 2.0, ..Particle::REST });
    let a = accelerations(&start, &UNIT, 201);
    assert!(a[..200].iter().all(|&a| a == Vec3::ZERO));
    let pull: f32 = start[..200].iter().map(|p| p.mass).sum::<f32>() / 4.0;
    assert!((a[200].x + pull).abs() < 0.1 * pull, "{} {pull}", a[200]);
}
