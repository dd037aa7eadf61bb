//! Births and deaths that depend on who is there: places inside shapes, death in a crowd, birth where particles are few.

use pointmass::emit::Burst;
use pointmass::force::Curl;
use pointmass::index::{InKd, IndexChoice, Structure};
use pointmass::shape::{Capsule, Cone, Cuboid, Cylinder, Disc, MeshBuf, Shape, Sphere, Surface};
use pointmass::{Chance, Dense, Emitter, Heap, Particle, Scene, Size, System, Time, Varied, Vec3, WhereSparse, Wind};
use pointmass_tests::{CHI_99, Form, chi_squared_100, every, f64s, gap, icosahedron, often, run, started, turn};

/// Places of birth inside a shape.
fn inside(shape: impl Surface + Sync) -> Vec<[f64; 3]> {
    let n = often(20_000);
    let burst = Some(Burst { count: n as u32, at: 0.0, every: 0.0 });
    let emitter = Emitter { burst, inside: true, ..Emitter::new(shape, 0.0) };
    let scene = Scene { emitters: &emitter, ..Scene::EMPTY };
    let mut system = started(&scene, n, 5);
    system.step(&scene, Time::from_ticks(1));
    assert_eq!(system.len(), n);
    system.particles().position.iter().map(|x| x.to_array().map(f64::from)).collect()
}

fn assert_even(cells: impl IntoIterator<Item = [f64; 2]>, what: &str) {
    let chi = chi_squared_100(cells);
    assert!(chi < CHI_99, "{what}: {chi}");
}

#[test]
fn births_inside_are_even_by_volume() {
    let center = Vec3::new(0.5, -0.25, 2.0);
    let [cx, cy, cz] = center.to_array().map(f64::from);
    let places = inside(Form::Sphere(Sphere { center, radius: 1.5 }));
    let cell = |[x, y, z]: [f64; 3]| {
        let r = ((x - cx).powi(2) + (y - cy).powi(2) + (z - cz).powi(2)).sqrt() / 1.5;
        assert!(r < 1.0 + 1e-6);
        [r.powi(3).min(0.999_999), turn(x - cx, z - cz)]
    };
    assert_even(places.into_iter().map(cell), "sphere");

    let places = inside(Form::Box(Cuboid { min: Vec3::new(-1.0, 0.0, 2.0), max: Vec3::new(3.0, 0.5, 4.0) }));
    assert_even(places.iter().map(|&[x, y, _]| [(x + 1.0) / 4.0, y / 0.5]), "box");
    assert_even(places.iter().map(|&[x, _, z]| [(x + 1.0) / 4.0, (z - 2.0) / 2.0]), "box");

    let places = inside(Form::Cylinder(Cylinder { center, radius: 0.5, height: 3.0 }));
    let cell = |[x, y, z]: [f64; 3]| {
        let square = ((x - cx).powi(2) + (z - cz).powi(2)) / 0.25;
        [square.min(0.999_999), (y - cy + 1.5) / 3.0]
    };
    assert_even(places.into_iter().map(cell), "cylinder");

    // A cone's share below a height goes as the cube of the distance from its tip.
    let cone = Cone { center, radius: 0.8, height: 2.0 };
    let places = inside(Form::Cone(cone));
    let cell = |[x, y, z]: [f64; 3]| {
        let tip = 1.0 - (y - (cy - 1.0)) / 2.0;
        [tip.clamp(0.0, 1.0).powi(3).min(0.999_999), turn(x - cx, z - cz)]
    };
    assert_even(places.into_iter().map(cell), "cone");
}

#[test]
fn births_inside_meshes_are_inside() {
    let (vertices, triangles) = icosahedron();
    let mesh = MeshBuf::new(vertices, triangles).expect("its triangles are its own");
    let places = inside(Shape::Mesh(mesh));
    // Inside the ball around it, more of them in the ball that it encloses than that alone would hold if they lay anywhere.
    let radius = |[x, y, z]: &[f64; 3]| (x * x + y * y + z * z).sqrt();
    let outer = 1.0f64;
    // The ratio of the radii of an icosahedron's inner and outer spheres, and its volume for an outer radius of 1.
    let (inner, volume) = (0.794_654 * outer, 2.536_150 * outer.powi(3));
    assert!(places.iter().all(|x| radius(x) <= outer + 1e-6));
    let within = places.iter().filter(|x| radius(x) < inner).count() as f64 / places.len() as f64;
    let share = 4.0 / 3.0 * core::f64::consts::PI * inner.powi(3) / volume;
    let deviation = (within - share) / (share * (1.0 - share) / places.len() as f64).sqrt();
    assert!(deviation.abs() < 3.3, "{within} for {share}");
}

#[test]
fn of_a_crowd_as_many_are_left_as_may_be() {
    for (count, most) in [(30usize, 9u32), (100, 0), (12, 20), (61, 59)] {
        let dense = Dense { radius: 0.1, most };
        let (mut left, seeds) = (0, 400);
        for seed in 0..seeds {
            let start: Vec<Particle> =
                (0..count).map(|i| Particle { position: Vec3::X * (i as f32 * 1e-4), ..Particle::REST }).collect();
            let scene = Scene { start: &start, reapers: &dense, ..Scene::EMPTY };
            let mut system = started(&scene, count, seed);
            let report = system.step(&scene, Time::frame(1, 60));
            assert_eq!(report.died.density as usize + system.len(), count);
            left += system.len();
        }
        // A binomial number of each is left.
        let share = ((most as f64 + 1.0) / count as f64).min(1.0);
        let mean = left as f64 / f64::from(seeds as u32);
        let deviation = (count as f64 * share * (1.0 - share) / f64::from(seeds as u32)).sqrt();
        assert!((mean - count as f64 * share).abs() <= 3.5 * deviation, "{count}, {most}: {mean}");
    }
}

#[test]
fn who_has_died_does_not_crowd_and_the_newborn_do() {
    let here = |lifetime: f32| Particle { lifetime, ..Particle::REST };
    // Nine of ten die of age in the step: the last has room.
    let start: Vec<Particle> = (0..10).map(|i| here(if i == 3 { 0.0 } else { 0.01 })).collect();
    let dense = Dense { radius: 1.0, most: 0 };
    let scene = Scene { start: &start, reapers: &dense, ..Scene::EMPTY };
    let mut system = started(&scene, 10, 1);
    let report = system.step(&scene, Time::frame(1, 60));
    assert_eq!((report.died.lifetime, report.died.density, system.len()), (9, 0, 1));
    // A hundred newborn crowd each other out in the step of their birth.
    let burst = Some(Burst { count: 100, at: 0.0, every: 0.0 });
    let emitter = Emitter { burst, ..Emitter::new(Form::Sphere(Sphere { center: Vec3::ZERO, radius: 0.1 }), 0.0) };
    let scene = Scene { emitters: &emitter, reapers: &dense, ..Scene::EMPTY };
    let mut system = started(&scene, 100, 1);
    let report = system.step(&scene, Time::frame(1, 60));
    assert!(report.born == 100 && report.died.density > 80, "{report:?}");
}

const ROOM: Cuboid = Cuboid { min: Vec3::ZERO, max: Vec3::ONE };

/// A box with an inflow and a whirl, kept between two densities for so many seconds, by an index.
fn kept(index: &dyn IndexChoice, rate: u32, seconds: u64, then: &mut dyn FnMut(&System<Heap>)) {
    let stir = Wind { field: Curl { speed: 0.4, scale: 0.3, drift: Vec3::ZERO, seed: 1 }, coefficient: None };
    let newborn = Particle { drag: 5.0, ..Particle::REST };
    let where_sparse = Some(WhereSparse { radius: 0.125, fewest: 15 });
    let fill = Emitter { inside: true, where_sparse, ..Emitter::new(Form::Box(ROOM), 40_000.0) };
    let side = Cuboid { min: Vec3::new(0.01, 0.3, 0.3), max: Vec3::new(0.02, 0.7, 0.7) };
    let inflow = Emitter {
        inside: true,
        direction: Some(Vec3::X),
        speed: Varied::exactly(1.0),
        ..Emitter::new(Form::Box(side), 600.0)
    };
    let emitters = [fill, inflow].map(|emitter| emitter.giving_birth_to(&newborn));
    let dense = Dense { radius: 0.125, most: 24 };
    let scene = Scene { emitters: &emitters, forces: &stir, colliders: &ROOM, reapers: &dense, index, ..Scene::EMPTY };
    let mut system = System::with(Heap::new(Size { particles: 8000, ..scene.size() }));
    system.start(&scene, 7).expect("it fits");
    for frame in 1..=seconds * u64::from(rate) {
        system.step(&scene, Time::frame(frame, rate) - system.time());
        if frame % u64::from(rate / 4) == 0 {
            then(&system);
        }
    }
    let totals = system.totals();
    assert!(totals.refused == 0 && totals.died.density > 1000 && totals.born > 2000, "{totals:?}");
}

#[test]
fn numbers_of_neighbours_are_kept_between_two_bounds() {
    // With all checks fine steps take long.
    let rates = if cfg!(debug_assertions) { &[24, 36][..] } else { &[24, 60, 144] };
    let seconds = if cfg!(debug_assertions) { 2 } else { 3 };
    for &rate in rates {
        kept(&InKd, rate, seconds, &mut |system| {
            if system.time() + Time::SECOND < Time::from_seconds(seconds as f32) {
                return;
            }
            let x = system.particles().position;
            let is_inner = |x: &&Vec3| x.min_element() > 0.125 && x.max_element() < 0.875;
            let neighbours = |place: &Vec3| x.iter().filter(|other| other.distance(*place) <= 0.125).count() - 1;
            let counts: Vec<usize> = x.iter().filter(is_inner).map(neighbours).collect();
            let held = counts.iter().filter(|&&n| (10..=30).contains(&n)).count();
            let share = held as f64 / counts.len() as f64;
            let [least, most] = [counts.iter().min(), counts.iter().max()];
            assert!(
                share >= 0.99,
                "{rate}/s at {} s: {share} of {}, {least:?} to {most:?}",
                system.time().seconds(),
                counts.len()
            );
        });
    }
}

#[test]
fn every_index_gives_the_same_births_and_deaths() {
    let mut hashes = Vec::new();
    for index in
        [&() as &dyn IndexChoice, &Structure::Grid, &Structure::Hash, &Structure::Octree, &Structure::Bvh, &InKd]
            .into_iter()
            .step_by(every(2))
    {
        let mut all = Vec::new();
        kept(index, 25, 1, &mut |system| all.push(system.hash()));
        hashes.push(all);
    }
    assert!(hashes.windows(2).all(|pair| pair[0] == pair[1]));
}

#[test]
fn reapers_in_a_list_choose_one_after_the_other() {
    let start: Vec<Particle> =
        (0..500).map(|i| Particle { position: Vec3::X * (i as f32 * 0.01), ..Particle::REST }).collect();
    let both = (Chance { rate: 5.0 }, [Dense { radius: 0.05, most: 3 }]);
    let scene = Scene { start: &start, reapers: &both, ..Scene::EMPTY };
    let mut system = started(&scene, 500, 3);
    run(&mut system, &scene, 1.0 / 60.0, 30);
    let died = system.totals().died;
    assert!(died.chance > 20 && died.density > 100, "{died:?}");
    assert_eq!(died.total() as usize + system.len(), 500);
}

/// Uniform by volume in what is thin, and lies along no axis.
#[test]
fn births_inside_thin_capsules_are_even_by_volume() {
    for (to, radius) in [(Vec3::ONE, 0.01), (Vec3::new(-3.0, 2.0, 0.5), 0.002), (Vec3::Y * 0.1, 0.5), (Vec3::ZERO, 1.0)]
    {
        let places = inside(Shape::<MeshBuf>::Capsule(Capsule { from: Vec3::ZERO, to, radius }));
        let (axis, wide) = (f64s(to), f64::from(radius));
        let long = gap(axis, [0.0; 3]);
        // The volume below a height along the axis, of whole slices and of the ends.
        let whole = wide * wide * long + 4.0 / 3.0 * wide.powi(3);
        let end = |z: f64| wide * wide * z - z.powi(3) / 3.0;
        let cell = |x: [f64; 3]| {
            let z = if long > 0.0 { x.iter().zip(axis).map(|(x, a)| x * a).sum::<f64>() / long } else { x[1] };
            let out = (x.iter().map(|x| x * x).sum::<f64>() - z * z).max(0.0);
            let beyond = (-z).max(z - long).max(0.0).min(wide);
            let below = if z < 0.0 {
                end(wide) - end(beyond)
            } else {
                end(wide) + wide * wide * z.min(long) + end((z - long).max(0.0))
            };
            [(below / whole).clamp(0.0, 0.999_999), (out / (wide * wide - beyond * beyond)).clamp(0.0, 0.999_999)]
        };
        assert_even(places.into_iter().map(cell), &format!("capsule to {to}, {radius} m thick"));
    }
}

/// Births for which no place is found inside lie on the surface, and are counted.
#[test]
fn births_for_which_there_is_no_place_inside_are_counted() {
    let disc = Disc { center: Vec3::ZERO, normal: Vec3::Y, radius: 1.0 };
    let burst = Some(Burst { count: 10, at: 0.0, every: 0.0 });
    let emitter = Emitter { burst, inside: true, ..Emitter::new(disc, 0.0) };
    let scene = Scene { emitters: &emitter, ..Scene::EMPTY };
    let mut system = started(&scene, 10, 5);
    let report = system.step(&scene, Time::from_ticks(1));
    assert_eq!([report.born, report.caps.outside], [10; 2]);
    assert!(system.particles().position.iter().all(|x| x.y == 0.0 && x.length() <= 1.0));
}

/// However many places are to be tried, a step ends; what is left is refused, and counted, whether a rate or bursts ask for them.
#[test]
fn places_to_be_tried_are_bounded_and_counted() {
    let where_sparse = Some(WhereSparse { radius: 1.0, fewest: 1 });
    let shape = || Form::Sphere(Sphere { center: Vec3::ZERO, radius: 0.1 });
    let burst = |count, every| Some(Burst { count, at: 0.0, every });
    let (step, room) = (Time::frame(1, 60), 50);
    let seconds = f64::from(step.seconds());
    for (rate, burst, owed) in [
        (1e9, None, 1e9 * seconds),
        (0.0, burst(u32::MAX, 0.0), f64::from(u32::MAX)),
        (0.0, burst(4_000_000_000, 1e-6), 4e9 * 1e6 * seconds),
        (0.0, burst(1, 2e-9), 1e9 * 0.5 * seconds),
    ] {
        let emitter = Emitter { where_sparse, burst, ..Emitter::new(shape(), rate) };
        let scene = Scene { emitters: &emitter, ..Scene::EMPTY };
        let mut system = started(&scene, room, 5);
        let report = system.step(&scene, step);
        assert_eq!(report.born, 1, "{rate} {burst:?}");
        let tried = 16.0 * room as f64;
        assert!((report.refused as f64 / (owed - tried) - 1.0).abs() < 0.2, "{rate} {burst:?}: {report:?}");
    }
}
