//! Methods that choose their own steps.

use core::ops::Range;
use pointmass::force::State;
use pointmass::integrate::Tuned;
use pointmass::{
    Adaptive, Embedded, Euler, Force, Gravity, Heap, Integrator, Method, Midpoint, Particle, Report, Rk4, Scene, Size,
    Spring, System, Time, Tuning, Vec3,
};
use pointmass_tests::{Law, follow, run, started};

/// Takes one step of `dt`; returns its report, and the system after it.
fn one_step(scene: &Scene<'_>, dt: f64) -> (Report, System<Heap>) {
    let mut system = started(scene, 2, 0);
    let report = system.step(scene, Time::from_seconds_f64(dt));
    (report, system)
}

#[test]
fn free_fall_takes_four_halvings() {
    // The two differ by g h²/4: 0.1 s has to become 6.25 ms. At 3.1 ms they would differ by a quarter of the tolerance.
    let integrator = Adaptive { tolerance: 1e-4, ..Adaptive::around(Euler) };
    let start = [Particle::REST];
    let scene = Scene { start: &start, forces: &Gravity::EARTH, integrator: &integrator, ..Scene::EMPTY };
    let (report, _) = one_step(&scene, 0.1);
    assert_eq!((report.effort.rejected, report.effort.accepted, report.effort.capped), (4, 16, 0));
}

#[test]
fn a_fast_spring_at_its_rest_length_is_not_taken_for_calm() {
    // By its positions alone a step of 1 s would do: the lecture's slip.
    let start = [
        Particle { fixed: true, ..Particle::REST },
        Particle { position: Vec3::X, velocity: Vec3::X * 10.0, ..Particle::REST },
    ];
    let springs = [Spring::new([0, 1], 1.0, 1e6)];
    for integrator in [&Adaptive::around(Rk4) as &dyn Integrator, &Embedded::USUAL] {
        let scene = Scene { start: &start, springs: &springs, integrator, ..Scene::EMPTY };
        let (report, system) = one_step(&scene, 1.0);
        assert!(report.effort.accepted > 500, "{:?}", report.effort);
        // x = 1 + 0.01 sin 1000 t: after 160 swings the phase is lost at this tolerance, the amplitude is not.
        assert!((system.particles().position[1].x - 1.0).abs() < 0.0105);
    }
}

#[test]
fn a_tighter_tolerance_errs_less() {
    let end = |integrator: &dyn Integrator| follow(integrator, &Law(|_, x: f32, _| -4.0 * x), [1.0, 0.0], 0.5, 20)[0];
    let exact = 20f64.cos();
    let mut last = f64::INFINITY;
    for tolerance in [1e-2, 1e-3, 1e-4, 1e-5] {
        let error = (end(&Embedded { tolerance, ..Embedded::USUAL }) - exact).abs();
        assert!(error < 0.5 * last && error < 300.0 * f64::from(tolerance), "{tolerance}: {error}");
        last = error;
        let error = (end(&Adaptive { tolerance, ..Adaptive::around(Midpoint) }) - exact).abs();
        assert!(error < 300.0 * f64::from(tolerance), "{tolerance}: {error}");
    }
}

#[test]
fn steps_end_where_the_system_s_do() {
    for integrator in [&Adaptive::around(Rk4) as &dyn Integrator, &Embedded::USUAL] {
        let start = [Particle { velocity: Vec3::X, ..Particle::REST }];
        let scene = Scene { start: &start, integrator, ..Scene::EMPTY };
        let mut system = started(&scene, 1, 0);
        run(&mut system, &scene, 0.013, 77);
        assert!((system.particles().position[0].x - 1.001).abs() < 1e-5);
        assert_eq!(system.time(), Time::from_seconds_f64(1.001));
    }
}

#[test]
fn caps_are_kept_and_counted() {
    let start = [Particle { position: Vec3::X, ..Particle::REST }];
    let law = Law(|_, x: f32, _| -1e6 * x);
    let attempts = 20;
    for integrator in
        [&Adaptive { attempts, ..Adaptive::around(Rk4) } as &dyn Integrator, &Embedded { attempts, ..Embedded::USUAL }]
    {
        let scene = Scene { start: &start, forces: &law, integrator, ..Scene::EMPTY };
        let (report, system) = one_step(&scene, 1.0);
        assert!(report.effort.capped > 0 && report.effort.evaluations < 20 * 12 + 12, "{:?}", report.effort);
        assert_eq!(system.time(), Time::SECOND);
    }
    let smallest = Time::from_seconds(0.125);
    for integrator in
        [&Adaptive { smallest, ..Adaptive::around(Rk4) } as &dyn Integrator, &Embedded { smallest, ..Embedded::USUAL }]
    {
        let scene = Scene { start: &start, forces: &law, integrator, ..Scene::EMPTY };
        let (report, _) = one_step(&scene, 1.0);
        assert!(report.effort.accepted <= 8 && report.effort.capped > 0, "{:?}", report.effort);
    }
}

#[test]
fn the_step_found_is_kept_and_dropped_when_something_happens() {
    let start = [Particle { position: Vec3::X, ..Particle::REST }];
    let law = Law(|_, x: f32, _| -400.0 * x);
    let scene = Scene { start: &start, forces: &law, integrator: &Embedded::USUAL, ..Scene::EMPTY };
    let mut system = started(&scene, 2, 0);
    let rejected = |system: &mut System<Heap>| system.step(&scene, Time::frame(1, 4)).effort.rejected;
    let first = rejected(&mut system);
    assert!(rejected(&mut system) < first);
    // It is part of the state: without it the bits would differ.
    let mut again = system.clone();
    assert_eq!(again.hash(), system.hash());
    let id = system.spawn(&Particle { position: Vec3::Y, ..Particle::REST }).expect("there is room");
    assert!(system.remove(&scene, id) && again.hash() != system.hash());
    assert!(rejected(&mut system) > rejected(&mut again), "what is put in by hand starts anew");
}

#[test]
fn a_tuned_method_is_that_method() {
    let tuning = Tuning { tolerance: 1e-5, inner: Method::Midpoint, newton: 3, ..Tuning::DEFAULT };
    let law = Law(|t: f32, x: f32, v: f32| t.cos() - x - 0.1 * v);
    for (method, integrator) in [
        (Method::Adaptive, &Adaptive { tolerance: 1e-5, ..Adaptive::around(Midpoint) } as &dyn Integrator),
        (Method::Embedded, &Embedded { tolerance: 1e-5, ..Embedded::USUAL }),
        (Method::Implicit, &pointmass::Implicit { newton: 3, ..pointmass::Implicit::USUAL }),
        (Method::Verlet, &pointmass::Verlet),
    ] {
        let tuned = Tuned { method, tuning };
        assert_eq!((tuned.columns(), tuned.needs_start()), (integrator.columns(), integrator.needs_start()));
        let ends = [&tuned as &dyn Integrator, integrator].map(|it| follow(it, &law, [1.0, 0.5], 0.1, 50));
        assert_eq!(ends[0], ends[1], "{method}");
    }
}

#[test]
fn far_from_the_origin_rounding_is_no_error() {
    // At 100 km positions have steps of 8 mm: no tolerance below that can be met.
    let start = [Particle { position: Vec3::X * 1e5, velocity: Vec3::new(3.3, 2.2, 1.1), ..Particle::REST }];
    let integrator = Adaptive::around(Rk4);
    let scene = Scene { start: &start, forces: &Gravity::EARTH, integrator: &integrator, ..Scene::EMPTY };
    let mut system = System::with(Heap::new(Size { particles: 1, ..scene.size() }));
    system.start(&scene, 0).expect("it fits");
    run(&mut system, &scene, 0.1, 50);
    let effort = system.totals().effort;
    assert_eq!((effort.rejected, effort.capped), (0, 0), "{effort:?}");
}

/// −k x³ along each axis.
struct Steep(f32);

impl Force for Steep {
    fn add_to(&self, state: &State<'_>, rows: Range<usize>, total: &mut [Vec3]) {
        for (total, &x) in total.iter_mut().zip(&state.position[rows]) {
            *total -= x * x * x * self.0;
        }
    }
}

#[test]
fn a_step_that_leads_beyond_all_numbers_is_taken_back() {
    // A sixtieth of a second is two dozen swings, and so long that the whole step and both halves end in NaN alike.
    for axis in [Vec3::X, Vec3::Y, Vec3::Z] {
        for integrator in [&Adaptive::around(Rk4) as &dyn Integrator, &Embedded::USUAL] {
            let start = [Particle { position: axis * 100.0, ..Particle::REST }];
            let scene = Scene { start: &start, forces: &Steep(1e4), integrator, ..Scene::EMPTY };
            let (report, system) = one_step(&scene, 1.0 / 60.0);
            assert_eq!((report.died.nonfinite, report.effort.capped), (0, 0), "{axis}: {:?}", report.effort);
            assert!(system.particles().position[0].length() < 100.1 && report.effort.accepted > 500, "{axis}");
        }
    }
}

#[test]
fn what_is_lost_from_the_beginning_costs_nothing() {
    // One flies beyond all numbers: the others go on in steps that suit them.
    let start =
        [Particle { position: Vec3::X, ..Particle::REST }, Particle { velocity: Vec3::Y * 3e38, ..Particle::REST }];
    for integrator in [&Adaptive::around(Rk4) as &dyn Integrator, &Embedded::USUAL] {
        let scene = Scene { start: &start, forces: &Gravity::EARTH, integrator, ..Scene::EMPTY };
        let (report, system) = one_step(&scene, 16.0);
        assert_eq!((report.died.nonfinite, system.len()), (1, 1));
        assert!(report.effort.evaluations < 1000, "{:?}", report.effort);
    }
}

#[test]
fn no_step_is_shorter_than_a_tick() {
    // A blow of ten nanoseconds, whose end no step is short enough for; then nothing.
    let start = [Particle { position: Vec3::X, ..Particle::REST }];
    let law = Law(|t: f32, _, _| if t < 1e-8 { 1e22 } else { 0.0 });
    let integrator = Embedded { smallest: Time::ZERO, ..Embedded::USUAL };
    let scene = Scene { start: &start, forces: &law, integrator: &integrator, ..Scene::EMPTY };
    let (report, system) = one_step(&scene, 1.0 / 60.0);
    assert!(report.effort.evaluations < 5000 && report.effort.capped > 0, "{:?}", report.effort);
    let v = system.particles().velocity[0].x;
    assert!((0.9e14..1.1e14).contains(&v), "{v}");
}
