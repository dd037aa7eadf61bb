//! Blocks and balls on slopes: Coulomb's law of dry friction.

use pointmass::force::Friction;
use pointmass::shape::{Collider, Cuboid, MeshBuf, Placed, Plane};
use pointmass::{ContactMaterial, Gravity, Method, Particle, Scene, Vec3};
use pointmass_tests::{G, run, started};

/// The material of what lies on the floor, number 0.
fn materials(mu: f32) -> [ContactMaterial; 1] {
    [ContactMaterial { elasticity: Some(0.0), friction: Some(Friction { static_: mu, kinetic: mu }) }]
}

/// How far it is after some seconds, and how fast.
fn slide(collider: &dyn Collider, mu: f32, particle: Particle, seconds: u32) -> (Vec3, Vec3) {
    let (start, materials) = ([Particle { material: Some(0), elasticity: 0.0, ..particle }], materials(mu));
    let integrator = Method::Verlet.integrator();
    let scene = Scene {
        start: &start,
        forces: &Gravity::EARTH,
        colliders: collider,
        materials: &materials,
        integrator,
        ..Scene::EMPTY
    };
    let mut system = started(&scene, 1, 0);
    run(&mut system, &scene, 1.0 / 60.0, 60 * seconds);
    (system.particles().position[0] - particle.position, system.particles().velocity[0])
}

#[test]
fn a_block_slides_if_the_slope_is_steeper_than_its_friction() {
    for radius in [0.0f32, 0.2] {
        for mu in [0.1f32, 0.5, 1.2] {
            for turn in [0.0f32, 0.7, 2.5] {
                for over in [-0.5f32, 0.5] {
                    let angle = mu.atan() + over.to_radians();
                    let along = Vec3::new(turn.cos(), 0.0, turn.sin());
                    let normal = Vec3::Y * angle.cos() + along * angle.sin();
                    let slope = Plane { point: Vec3::ZERO, normal };
                    let down = along * angle.cos() - Vec3::Y * angle.sin();
                    // A hair above, since rounding could put a point below.
                    let position = normal * (radius + 1e-6) + down * 0.3;
                    let (way, _) = slide(&slope, mu, Particle { position, radius, ..Particle::REST }, 4);
                    if over < 0.0 {
                        assert!(way.length() < 1e-5, "µ {mu}, radius {radius}: it crept by {way}");
                    } else {
                        let a = G * (f64::from(angle.sin()) - f64::from(mu) * f64::from(angle.cos()));
                        let (went, expected) = (f64::from(way.dot(down)), 8.0 * a);
                        assert!(
                            (went / expected - 1.0).abs() < 1e-3,
                            "µ {mu}, radius {radius}: {went}, not {expected}"
                        );
                    }
                }
            }
        }
    }
}

#[test]
fn a_sliding_block_stops_where_its_energy_is_gone() {
    let floor = Plane { point: Vec3::ZERO, normal: Vec3::Y };
    let slab = Cuboid { min: Vec3::new(-20.0, -1.0, -20.0), max: Vec3::new(20.0, 0.0, 20.0) };
    let map = pointmass::shape::Affine::IDENTITY;
    let placed = Placed::new(slab, map).expect("it is where it is");
    let (vertices, triangles) = (
        vec![
            Vec3::new(-20.0, 0.0, -20.0),
            Vec3::new(-20.0, 0.0, 20.0),
            Vec3::new(20.0, 0.0, 20.0),
            Vec3::new(20.0, 0.0, -20.0),
        ],
        vec![[0, 1, 2], [0, 2, 3]],
    );
    let mesh = MeshBuf::new(vertices, triangles).expect("a square is a mesh");
    let floors: [(&str, &dyn Collider); 4] = [("plane", &floor), ("box", &slab), ("placed", &placed), ("mesh", &mesh)];
    for (name, collider) in floors {
        for radius in [0.0f32, 0.1] {
            for (v, mu) in [(1.0f32, 0.4f32), (3.0, 0.3), (6.0, 0.8)] {
                let velocity = Vec3::new(0.6, 0.0, 0.8) * v;
                let particle = Particle { position: Vec3::new(1.0, radius, -3.0), velocity, radius, ..Particle::REST };
                let (way, after) = slide(collider, mu, particle, 4);
                let expected = f64::from(v * v) / (2.0 * f64::from(mu) * G);
                let went = f64::from(way.length());
                assert!((went / expected - 1.0).abs() < 0.01, "{name}, {radius}, {v} m/s: {went}, not {expected}");
                assert!(after.length() < 1e-6, "{name}, {radius}: {after}");
            }
        }
    }
}
