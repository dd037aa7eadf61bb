//! Particles in the company of others, that differ from these in something.

use pointmass::shape::{Cuboid, Mesh, Plane, Scenery, Shape, Sphere, Surface};
use pointmass::{Drag, Gravity, Heap, Integrator, Method, Particle, Scene, System, Time, Vec3};

/// Points that are alike, and balls beside one another that fall among them.
fn crowd(count: u32) -> Vec<Particle> {
    let place =
        |i: u32| Vec3::new((i % 16) as f32 * 0.2 - 1.6, 0.3 + (i / 256) as f32 * 0.1, (i / 16 % 16) as f32 * 0.2);
    let speed = |i: u32| Vec3::new(0.1, (i % 7) as f32 * 0.3, -0.1);
    let like = |i| Particle { position: place(i), velocity: speed(i), drag: 0.1, elasticity: 0.5, ..Particle::REST };
    (0..count).map(like).collect()
}

/// Particles that each differ from those of the crowd in one thing, or in all.
fn strangers() -> Vec<Particle> {
    let like = Particle { position: Vec3::new(0.1, 0.8, 1.0), drag: 0.1, ..Particle::REST };
    vec![
        Particle { radius: 0.2, ..like },
        Particle { elasticity: 0.9, ..like },
        Particle { drag: 0.7, ..like },
        Particle { mass: 0.3, ..like },
        Particle { fixed: true, ..like },
        Particle { radius: 0.1, elasticity: 0.0, drag: 0.0, mass: 4.0, ..like },
        like,
    ]
}

/// The places and velocities of one that is put in after some frames, and before as many others as the scene begins with, frame by frame.
fn ways(scene: &Scene<'_>, stranger: &Particle, frames: u32) -> Vec<[u32; 6]> {
    let mut system = System::with(Heap::new(scene.size_for(2 * scene.start.len() + 1)));
    system.start(scene, 3).expect("it fits");
    (1..=10).for_each(|frame| {
        system.step_to(scene, Time::frame(frame, frames));
    });
    let id = system.spawn(stranger).expect("there is room");
    scene.start.iter().for_each(|like| assert!(system.spawn(like).is_ok()));
    let places = (11..=10 + 2 * u64::from(frames)).map(|frame| {
        system.step_to(scene, Time::frame(frame, frames));
        let (row, particles) = (system.row(id).expect("it lives"), system.particles());
        let [a, b, c] = particles.position[row].to_array().map(f32::to_bits);
        let [d, e, f] = particles.velocity[row].to_array().map(f32::to_bits);
        [a, b, c, d, e, f]
    });
    places.collect()
}

/// A sphere or a box on the ground.
fn thing(i: u32) -> Shape<Mesh<'static>> {
    let (center, half) = (Vec3::new(i as f32 * 0.3 - 3.0, 0.1, 1.0), Vec3::splat(0.1));
    let chest = Shape::Box(Cuboid { min: center - half, max: center + half });
    if i.is_multiple_of(2) { Shape::Sphere(Sphere { center, radius: 0.1 }) } else { chest }
}

#[test]
fn who_differs_from_all_others_goes_as_if_alone() {
    let ground = Plane { point: Vec3::ZERO, normal: Vec3::Y };
    let things = Scenery::new((0..20).map(thing).map(|thing| (thing.clone(), thing.bounds())).collect());
    let (forces, mut hits) = ((Gravity::EARTH, Drag {}), 0);
    // Others choose a step, or come to a solution, for all together.
    let methods = Method::ALL.iter().filter(Integrator::is_local);
    for (trial, method) in methods.enumerate() {
        for (i, stranger) in strangers().iter().enumerate() {
            let frames = [24, 60, 144][(trial + i) % 3];
            let crowd = crowd([1, 300, 1500][(trial + i) / 3 % 3]);
            let plain = Scene { forces: &forces, colliders: &ground, integrator: method, ..Scene::EMPTY };
            for scene in [plain, Scene { colliders: &things, ..plain }] {
                let alone = ways(&scene, stranger, frames);
                let among = ways(&Scene { start: &crowd, ..scene }, stranger, frames);
                assert!(alone == among, "{method:?}, {frames} frames, {} others, {stranger:?}", crowd.len());
                let turns = alone.windows(2).filter(|two| {
                    let [before, now] = [two[0][4], two[1][4]].map(f32::from_bits);
                    before < 0.0 && now > 0.0
                });
                hits += turns.count();
            }
        }
    }
    assert!(hits > 200, "{hits}");
}
