//! Goals: a crowd is at its places by the time, is held there and let go, by any method and step, and the ledger knows of it.

use pointmass::scene::{Model, SceneFile};
use pointmass::shape::{Mesh, Shape, Sphere};
use pointmass::{Drag, Goal, Gravity, Heap, Ledger, Measures, Particle, Scene, System, Time, Vec3};
use pointmass_tests::{Random, icosahedron, methods, often, started};

const G: Vec3 = Vec3::new(0.5, -9.8, 0.0);

/// A crowd all over the place.
fn crowd(count: usize) -> Vec<Particle> {
    let mut random = Random::new(5);
    let mut one = || Particle {
        position: random.vector(3.0),
        velocity: random.vector(4.0),
        mass: random.between(0.1, 5.0),
        drag: random.between(0.0, 0.05),
        ..Particle::REST
    };
    (0..count).map(|_| one()).collect()
}

/// How far the farthest is from its place, and how fast the fastest is.
fn off(system: &System<Heap>, scene: &Scene<'_>, goal: &Goal<Mesh<'_>>) -> [f32; 2] {
    let state = system.state(scene);
    let way = |row| (goal.place(&state, row).expect("it lives") - state.position[row]).length();
    let farthest = (0..system.len()).map(way).fold(0.0, f32::max);
    [farthest, state.velocity.iter().map(|v| v.length()).fold(0.0, f32::max)]
}

#[test]
fn a_crowd_is_there_by_the_time_and_let_go_by_every_method_and_step() {
    let sphere = Shape::Sphere(Sphere { center: Vec3::new(1.0, 2.0, -1.0), radius: 0.5 });
    let mut goal = Goal::<Mesh<'_>>::new(sphere, 3.0);
    (goal.start, goal.release, goal.against) = (0.5, Some(4.0), Some(G));
    let start = crowd(200);
    for (i, fps) in [60u32, 100, 240].into_iter().enumerate() {
        for method in methods(i) {
            let forces = (Gravity { acceleration: G }, Drag {}, goal.clone());
            let scene = Scene { start: &start, forces: &forces, integrator: &method, ..Scene::EMPTY };
            let mut system = started(&scene, start.len(), 2);
            let to = |system: &mut System<Heap>, seconds: f32| {
                while system.time() < Time::from_seconds(seconds) {
                    system.step(&scene, Time::frame(1, fps));
                }
            };
            to(&mut system, 3.0);
            let [way, speed] = off(&system, &scene, &goal);
            assert!(way < 1e-3 && speed < 0.02, "{} at {fps}: {way} m, {speed} m/s", method.name());
            to(&mut system, 3.9);
            let [way, speed] = off(&system, &scene, &goal);
            assert!(way < 1e-4 && speed < 1e-3, "{} held at {fps}: {way} m, {speed} m/s", method.name());
            // Free again: nothing but gravity acts on who hardly moves.
            to(&mut system, 4.02);
            let (before, were) = (system.time(), system.particles().velocity.to_vec());
            system.step(&scene, Time::frame(1, fps));
            let gained = G * (system.time() - before).seconds();
            let falls = |(v, was): (&Vec3, &Vec3)| (*v - *was - gained).length() < 0.02 * gained.length();
            assert!(system.particles().velocity.iter().zip(&were).all(falls), "{} at {fps}", method.name());
        }
    }
}

/// Where leading begins and ends between two steps it does for all stages of a method alike, those at the end of the step before included.
#[test]
fn a_goal_acts_in_the_steps_of_its_time_alone() {
    for (i, fps) in [60_u32, 100, 240].into_iter().enumerate() {
        for method in methods(i) {
            let point = Shape::Sphere(Sphere { center: Vec3::Y * 5.0, radius: 0.0 });
            let led = Goal::<Mesh<'_>> { start: 1.0, release: Some(4.0), against: Some(G), ..Goal::new(point, 2.5) };
            let (start, forces) = ([Particle::REST; 1], (Gravity { acceleration: G }, led));
            let scene = Scene { start: &start, forces: &forces, integrator: &method, ..Scene::EMPTY };
            let mut system = started(&scene, 1, 1);
            let mut frame = 0;
            let mut to = |system: &mut System<Heap>, seconds: u64| {
                while frame < seconds * u64::from(fps) {
                    frame += 1;
                    system.step_to(&scene, Time::frame(frame, fps));
                }
                system.particles().velocity[0]
            };
            let before = to(&mut system, 1);
            assert!((before - G).length() < 1e-4, "{} at {fps}: {before} m/s before", method.name());
            let held = to(&mut system, 4);
            let after = to(&mut system, 5) - held;
            assert!(
                held.length() < 1e-2 && (after - G).length() < 1e-3,
                "{} at {fps}: {held}, {after} m/s",
                method.name()
            );
        }
    }
}

#[test]
fn places_are_spread_over_a_mesh_and_are_each_ones_own() {
    let (vertices, triangles) = icosahedron();
    let mut areas = vec![0; triangles.len()];
    let mesh = Mesh::new(&vertices, &triangles, &mut areas).expect("it is one");
    let goal = Goal::new(Shape::Mesh(mesh), 2.0);
    let start = vec![Particle::REST; often(10_000)];
    let scene = Scene { start: &start, forces: &goal, integrator: &pointmass::Midpoint, ..Scene::EMPTY };
    let mut system = started(&scene, start.len(), 3);
    let places = |system: &System<Heap>| {
        let state = system.state(&scene);
        (0..system.len()).filter_map(|row| goal.place(&state, row)).collect::<Vec<_>>()
    };
    let first = places(&system);
    // Uniform on a surface that is symmetric about the origin: no mean, and all directions alike.
    let n = first.len() as f32;
    let mean = first.iter().copied().sum::<Vec3>() / n;
    let squares = first.iter().map(|x| *x * *x).sum::<Vec3>() / n;
    assert!(mean.length() < 5.0 / n.sqrt() && (squares - squares.element_sum() / 3.0).length() < 3.0 / n.sqrt());
    for frame in 1..=120 {
        system.step_to(&scene, Time::frame(frame, 60));
    }
    assert_eq!(places(&system), first);
    let size = 2.0 * vertices[0].length();
    let [way, _] = off(&system, &scene, &goal);
    assert!(way < 1e-3 * size, "{way} m of {size} m");
}

#[test]
fn the_ledger_has_what_goals_give_and_take() {
    let sphere = Shape::<Mesh<'_>>::Sphere(Sphere { center: Vec3::Y, radius: 0.5 });
    let goal = Goal { against: Some(G), release: Some(2.5), ..Goal::new(sphere, 2.0) };
    let start = crowd(50);
    let forces = (Gravity { acceleration: G }, goal);
    let scene = Scene { start: &start, forces: &forces, integrator: &pointmass::Rk4, ..Scene::EMPTY };
    let mut system = started(&scene, start.len(), 2);
    let (mut ledger, opening) = (Ledger::new(&system, &scene), Measures::of(&system, &scene).energy.total());
    for frame in 1..=720 {
        system.step_observed(&scene, Time::frame(frame, 240) - system.time(), &mut ledger);
    }
    let (books, closing) = (ledger.books(), Measures::of(&system, &scene).energy.total());
    let work = books.work("goals");
    assert!(work.abs() > 100.0 && books.remainder.abs() < 1e-3 * work.abs(), "{books:?}");
    assert!((opening + work - closing).abs() < 2e-3 * work.abs());
}

#[test]
fn files_lead_those_of_a_material_against_their_own_gravity() {
    let goal = |rest: &str| {
        format!(
            r#"{{"forces": [{{"gravity": {{"acceleration": [0, -9.8, 0]}}}}], "materials": [{{}}, {{}}],
            "particles": [{{"material": 0}}, {{"material": 1}}, {{}}],
            "goals": [{{"shape": {{"sphere": {{"center": [0, 3, 0], "radius": 0.001}}}}, "arrive": 1{rest}}}]}}"#
        )
    };
    let file = |rest: &str| SceneFile::from_json("a.json", &goal(rest)).and_then(|scene| scene.check().map(|()| scene));
    let scene = file(r#", "material": 1"#).expect("it can be used");
    assert_eq!(SceneFile::from_json("", &scene.to_json()), Ok(scene.clone()));
    let model = Model::load(&scene, "a.json", &mut ()).expect("it can be run");
    let mut system = model.system(3, 1).expect("a little memory");
    for frame in 1..=120 {
        system.step_to(&model.scene(), Time::frame(frame, 60));
    }
    let [free, led, other] = [0, 1, 2].map(|row| system.particles().position[row]);
    assert!((led - Vec3::Y * 3.0).length() < 2e-3 && free == other && free.y < -19.0, "{led} {free} {other}");
    for (rest, told) in [
        (r#", "settle": 0"#, "goals[0].settle: has to be above zero"),
        (r#", "start": 2"#, "goals[0].arrive: 1 s is before start, 2 s"),
        (r#", "release": 0.5"#, "goals[0].release: 0.5 s is before arrive, 1 s"),
        (r#", "material": 9"#, "goals[0].material"),
        (r#", "when": 9"#, "unknown field `when`"),
    ] {
        let error = file(rest).expect_err(rest).to_string();
        assert!(error.contains(told), "{rest}: {error}");
    }
}
