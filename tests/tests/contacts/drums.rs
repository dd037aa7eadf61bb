//! Balls that meet by impulse stay in the rooms that hold them, however these move.

use pointmass::force::Friction;
use pointmass::index::Structure;
use pointmass::motion::{Key, Motion, Script};
use pointmass::shape::{Aabb, Moving};
use pointmass::{ContactMaterial, Gravity, Meetings, Method, Particle, Scene, Time, Vec3};
use pointmass_tests::solids::{Solid, extent, inside, solids};
use pointmass_tests::{Random, f64s, is_run, often, started};

/// Where a room is in the middle of its way, and how it moves: it turns, swings, shakes, and goes from key to key.
fn motions(middle: Vec3, size: f32) -> Vec<(&'static str, Motion<Vec<Key>>)> {
    let about = Motion { pivot: middle, ..Motion::with_keys(vec![], 0.0) };
    let key = |time: f32, place: Vec3, rotation: Vec3| Key { time, place: place * size, rotation };
    let keys = vec![
        key(0.0, Vec3::ZERO, Vec3::ZERO),
        key(0.3, Vec3::new(0.3, 0.2, -0.1), Vec3::new(1.0, 0.5, -1.0)),
        key(0.5, Vec3::new(-0.3, 0.4, 0.2), Vec3::new(-1.0, 0.5, 1.0)),
        key(0.9, Vec3::ZERO, Vec3::ZERO),
    ];
    vec![
        ("turns slowly", Motion { axis: Vec3::Z, spin: 0.5, ..about.clone() }),
        ("turns", Motion { axis: Vec3::new(1.0, 0.2, 3.0), spin: -2.0, ..about.clone() }),
        ("turns off its middle", Motion { pivot: middle + Vec3::X * size, spin: 1.0, ..about.clone() }),
        ("swings", Motion { swing: Vec3::new(0.5, 0.3, 0.0) * size, frequency: 1.0, ..about.clone() }),
        ("shakes", Motion { swing: Vec3::new(0.0, 0.05, 0.02) * size, frequency: 20.0, ..about.clone() }),
        ("drifts", Motion { drift: Vec3::new(0.7, 1.0, -0.4) * size, ..about.clone() }),
        ("goes by keys", Motion { keys, period: 0.9, ..about.clone() }),
        (
            "turns and shakes",
            Motion { spin: 1.0, axis: Vec3::X, swing: Vec3::Y * (0.05 * size), frequency: 10.0, ..about },
        ),
    ]
}

/// Balls that lie apart from each other and from the walls, if they find room.
fn balls(solid: &Solid, random: &mut Random, count: usize, radius: f32, elasticity: f32) -> Vec<Particle> {
    let mut start: Vec<Particle> = vec![];
    for _ in 0..40 * count {
        let position = inside(solid, random);
        let apart = start.iter().all(|other| other.position.distance(position) > 2.02 * radius);
        if apart && (solid.depth)(f64s(position)) > f64::from(1.01 * radius) {
            let velocity = random.direction() * (random.unit() * extent(solid));
            let mass = random.magnitude(0.2, 5.0);
            start.push(Particle { position, velocity, radius, mass, elasticity, material: Some(0), ..Particle::REST });
        }
        if start.len() == count {
            break;
        }
    }
    start
}

/// The farthest that a ball is outside of a room in a second, a share of the coordinates there; infinite if one is lost.
fn farthest_out(solid: &Solid, motion: &Motion<Vec<Key>>, random: &mut Random) -> (f64, String) {
    let mut any = |count: usize| random.word() as usize % count;
    let (elasticity, mu) = ([0.0, 0.5, 0.9, 1.0][any(4)], [0.0, 0.3, 1.0][any(3)]);
    let (rate, substeps) = [(240, 1), (144, 1), (60, 1), (60, 4), (15, 1), (24, 2)][any(6)];
    let (method, index) = (Method::ALL[any(Method::ALL.len())], Structure::ALL[any(Structure::ALL.len())]);
    let count = [1, 2, 10, 50][any(4)];
    let (size, middle) = (extent(solid), solid.middle);
    let radius = (solid.depth)(f64s(middle)) as f32 * random.between(0.05, 0.25);
    let start = balls(solid, random, count, radius, elasticity);
    let friction = (mu > 0.0).then_some(Friction { static_: mu, kinetic: mu });
    let materials = [ContactMaterial { elasticity: Some(elasticity), friction }];
    let gravity = Gravity { acceleration: random.direction() * (9.8 * size) };
    let bounds = Aabb { min: middle - 2.0 * size, max: middle + 2.0 * size };
    let room = Moving::new(&*solid.collider, &bounds, motion.clone());
    let parts = Scene { start: &start, forces: &gravity, colliders: &room, materials: &materials, ..Scene::EMPTY };
    let integrator = method.integrator();
    let scene = Scene { meetings: Meetings::IMPULSE, integrator, substeps, index: &index, ..parts };
    let mut system = started(&scene, start.len(), 1);
    let mut farthest = 0.0f64;
    for frame in 1..=u64::from(rate) {
        system.step_to(&scene, Time::frame(frame, rate));
        let now = motion.frame(system.time());
        for &x in system.particles().position {
            let out = f64::from(radius) - (solid.depth)(f64s(now.local(x)));
            farthest = if out <= farthest { farthest } else { out };
        }
    }
    let lost = if system.len() == start.len() { 0.0 } else { f64::INFINITY };
    let share = farthest / f64::from(solid.size + 3.0 * size) + lost;
    (share, format!("e {elasticity}, mu {mu}, {rate}/{substeps}, {method}, {index:?}, {} balls", start.len()))
}

#[test]
fn drums_keep_their_balls() {
    let mut random = Random::new(51);
    let (mut cases, mut failures) = (0, vec![]);
    for solid in solids() {
        // Rounding takes more of a room that is nearly flat, whose faces are turned from single precision.
        let bound = if solid.name.starts_with("flattened") { 5e-5 } else { 2e-6 };
        for (name, motion) in motions(solid.middle, extent(&solid)) {
            for _ in 0..often(20) {
                if !is_run(&mut cases) {
                    continue;
                }
                let (share, how) = farthest_out(&solid, &motion, &mut random);
                if !(share < bound) {
                    failures.push(format!("{} {name}: {how}: {share:e}", solid.name));
                }
            }
        }
    }
    assert!(failures.is_empty(), "{} {failures:#?}", failures.len());
}
