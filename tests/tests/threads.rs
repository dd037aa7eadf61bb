//! Steps on several threads in memory for no more particles than there are.

use pointmass::shape::{Collider, Cuboid, Mesh, Plane, Scenery, Shape, Sphere, Surface};
use pointmass::{Drag, Gravity, Method, Particle, Scene, Time, Vec3};
use pointmass_tests::{Random, every, is_third, started};
use rayon::ThreadPool;

/// Particles that fall, some of them onto what there is.
fn falling(count: usize, random: &mut Random) -> Vec<Particle> {
    let mut place = || Vec3::Y * 1.2 + random.vector(1.0);
    (0..count).map(|_| Particle { position: place(), drag: 0.2, ..Particle::REST }).collect()
}

/// However many they are, and however they are shared, all bits are those of no pool.
#[test]
fn any_number_of_particles_is_shared() {
    let mut random = Random::new(91);
    let threads: &[usize] = if cfg!(debug_assertions) { &[2, 3] } else { &[1, 2, 3, 8] };
    let pools: Vec<ThreadPool> = threads
        .iter()
        .map(|&threads| rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("there are threads"))
        .collect();
    let ground = Plane { point: Vec3::ZERO, normal: Vec3::new(0.1, 1.0, 0.0) };
    let ball = |x: f32| Sphere { center: Vec3::new(x, 0.4, 0.0), radius: 0.3 };
    let things = [-0.5, 0.0, 0.5].map(|x| Shape::<Mesh<'_>>::Sphere(ball(x)));
    let chest = Cuboid { min: Vec3::new(-0.9, -0.1, -0.9), max: Vec3::new(-0.5, 0.3, -0.5) };
    let all = things.into_iter().chain([Shape::Plane(ground), Shape::Box(chest)]);
    let scenery = Scenery::new(all.map(|thing| (thing.clone(), thing.bounds())).collect());
    let walls: [&dyn Collider; 4] = [&(), &ground, &(ground, ball(0.1)), &scenery];
    // A tile has more rows than the smaller share of some of these.
    let edges = [10_239, 10_241, 10_242, 11_000, 11_519, 12_800, 20_481];
    let counts = edges.into_iter().chain((0..2).map(|_| random.between(1.0e4, 4.6e4) as usize)).collect::<Vec<_>>();
    let mut cases = 0;
    for (round, count) in counts.into_iter().enumerate().step_by(every(4)) {
        let start = falling(count, &mut random);
        // The method that is one pass over the rows goes past all of them.
        let others = Method::ALL.iter().enumerate().filter(|(nth, _)| nth % 3 == round % 3);
        let others = others.map(|(nth, &method)| (method, walls[(nth + round) % 4]));
        for (method, colliders) in others.chain(walls.map(|walls| (Method::Symplectic, walls))) {
            if !is_third(&mut cases) {
                continue;
            }
            let scene = Scene {
                start: &start,
                forces: &(Gravity::EARTH, Drag {}),
                colliders,
                integrator: &method.integrator(),
                ..Scene::EMPTY
            };
            let run = || {
                let mut system = started(&scene, count, 1);
                (1..=2).for_each(|frame| {
                    system.step_to(&scene, Time::frame(frame, 4));
                });
                system.hash()
            };
            let alone = run();
            for pool in &pools {
                let threads = pool.current_num_threads();
                assert_eq!(pool.install(run), alone, "{count} by {method:?} on {threads} threads");
            }
        }
    }
}
