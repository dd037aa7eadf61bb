//! Rods and plates, which lie on more of rough ground than compact bodies.

use pointmass::constrain::{RigidBodies, RigidBox};
use pointmass::force::Friction;
use pointmass::shape::{Collider, HeightField, MeshBuf, Segment};
use pointmass::{ContactMaterial, Gravity, Method, Particle, Scene, Time, Vec3};
use pointmass_tests::{Random, every, started};

/// Points a side of the ground.
const COLUMNS: usize = 21;

/// The ground as a mesh.
fn mesh(origin: Vec3, spacing: f32, heights: &[f32]) -> MeshBuf {
    let place =
        |n: usize| origin + Vec3::new((n % COLUMNS) as f32 * spacing, heights[n], (n / COLUMNS) as f32 * spacing);
    let cells = (0..COLUMNS as u32 - 1).flat_map(|j| (0..COLUMNS as u32 - 1).map(move |i| j * COLUMNS as u32 + i));
    let next = COLUMNS as u32;
    let triangles = cells.flat_map(|n| [[n, n + next, n + 1], [n + 1, n + next, n + next + 1]]);
    MeshBuf::new((0..heights.len()).map(place).collect(), triangles.collect()).expect("it is a mesh")
}

/// They fall on ridges and bumps, many of which they lie over: the middle of their length stays above the ground, or in the air over it.
#[test]
fn rough_ground_holds_rods_and_plates() {
    let mut random = Random::new(94);
    for round in (0..120).step_by(every(17)) {
        let scale = [1.0, 0.1, 5.0][round % 3];
        let (spacing, high) = (0.25 * scale, random.between(0.02, 0.1) * scale);
        let wave = |n: usize| (core::f32::consts::TAU * (n % COLUMNS) as f32 / 8.0).cos();
        let is_ridged = round / 3 % 2 == 0;
        let heights: Vec<f32> = (0..COLUMNS * COLUMNS)
            .map(|n| high * if is_ridged { wave(n) } else { random.between(-1.0, 1.0) })
            .collect();
        let edge = -0.5 * (COLUMNS - 1) as f32 * spacing;
        let origin = Vec3::new(edge, 0.0, edge);
        let field = HeightField::new(origin, spacing, COLUMNS, &heights).expect("it is full");
        let of_triangles = mesh(origin, spacing, &heights);
        let ground: &dyn Collider = if round % 2 == 0 { &field } else { &of_triangles };
        let half = [[1.0, 0.01, 0.01], [0.02, 0.03, 1.0], [0.6, 0.015, 0.5], [0.01, 0.5, 0.05]][round / 6 % 4];
        let turn = [random.between(-0.3, 0.3), random.between(-0.3, 0.3), random.between(-0.3, 0.3), 1.0];
        let at = Vec3::new(random.between(-0.5, 0.5), 0.8, random.between(-0.5, 0.5)) * scale;
        let of = RigidBox { turn, ..RigidBox::new(Vec3::from(half) * scale, at, 0) };
        let start = of.solid(Particle { mass: 0.5, elasticity: 0.0, material: Some(0), ..Particle::REST });
        let bodies = RigidBodies::boxes([of]);
        let materials = [ContactMaterial { elasticity: None, friction: Some(Friction { static_: 0.5, kinetic: 0.5 }) }];
        let forces = Gravity { acceleration: Vec3::NEG_Y * 9.81 * scale };
        let (substeps, method) =
            ([5, 10, 20][random.word() as usize % 3], Method::ALL[1 + round % (Method::ALL.len() - 1)]);
        let parts =
            Scene { start: &start, forces: &forces, materials: &materials, constraints: &bodies, ..Scene::EMPTY };
        let scene = Scene { colliders: ground, substeps, integrator: method.integrator(), ..parts };
        let mut system = started(&scene, 8, 1);
        for frame in 1..=120 {
            system.step_to(&scene, Time::frame(frame, 60));
            let middle = system.particles().position.iter().sum::<Vec3>() / 8.0;
            let down = Segment::new(Vec3 { y: 2.0 * scale, ..middle }, Vec3 { y: -scale, ..middle });
            let Some(hit) = ground.first_hit(&down) else { break };
            let above = middle.y - down.at(hit.time).y;
            // Its middle may hang into a dip between two crests, but not below where it is thin.
            let least = half.into_iter().fold(f32::INFINITY, f32::min) * scale;
            assert!(above > -least, "round {round}, {half:?}, {substeps} sub-steps, {}: {above} m", method.name());
        }
    }
}
