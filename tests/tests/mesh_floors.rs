//! Cloth on floors of triangles: flat ones are as flat as planes.

use pointmass::constrain::{Shell, ShellParams};
use pointmass::force::Friction;
use pointmass::shape::{Collider, MeshBuf, Plane};
use pointmass::{ContactMaterial, Contacts, Gravity, Method, Particle, Scene, Sheet, Time, Vec3};
use pointmass_tests::{Random, every, started};

/// A frame of axes, turned anyhow.
fn axes(random: &mut Random) -> [Vec3; 3] {
    let y = random.direction();
    let x = y.cross(random.direction()).normalize();
    [x, y, x.cross(y)]
}

/// A flat floor of triangles of all shapes, so many cells a side, through the middle of the world.
fn floor(random: &mut Random, [x, _, z]: [Vec3; 3], half: f32, cells: u32) -> MeshBuf {
    let cell = 2.0 * half / cells as f32;
    let jitter = |random: &mut Random| random.between(-0.3, 0.3) * cell;
    let places = (0..=cells).flat_map(|v| (0..=cells).map(move |u| [u, v].map(|i| i as f32 * cell - half)));
    let places: Vec<_> = places.map(|[u, v]| x * (u + jitter(random)) + z * (v + jitter(random))).collect();
    let at = |u: u32, v: u32| v * (cells + 1) + u;
    let pair = |v: u32, u: u32| {
        let [a, b, c, d] = [at(u, v), at(u, v + 1), at(u + 1, v + 1), at(u + 1, v)];
        if (u + v).is_multiple_of(2) { [[a, b, c], [a, c, d]] } else { [[a, b, d], [b, c, d]] }
    };
    let triangles = (0..cells).flat_map(|v| (0..cells).flat_map(move |u| pair(v, u)));
    MeshBuf::new(places, triangles.collect::<Vec<_>>()).expect("a floor is a mesh")
}

#[test]
fn cloth_slides_over_flat_triangles_as_over_a_plane() {
    let mut random = Random::new(31);
    for round in (0..60).step_by(every(11)) {
        let scale = [1.0, 0.1, 20.0][round % 3];
        let turn @ [x, y, z] = axes(&mut random);
        let cells = [7, 20, 40][round / 3 % 3];
        let triangles = floor(&mut random, turn, 4.0 * scale, cells);
        let plane = Plane { point: Vec3::ZERO, normal: y };
        let side = |by: Vec3| by * (0.5 * scale);
        let corner = (x + z) * (-0.25 * scale) + y * (0.01 * scale);
        let sheet = Sheet { corner, sides: [side(x), side(z)], cells: [4, 4] };
        // Times go by the root of the size.
        let pace = scale.sqrt();
        let aside = x * random.between(-1.0, 1.0) + z * random.between(-1.0, 1.0);
        let velocity = aside * (random.between(0.5, 3.0) * pace);
        let particle = Particle { mass: 0.004, velocity, elasticity: 0.0, material: Some(0), ..Particle::REST };
        let start: Vec<_> = sheet.particles(particle).collect();
        let params =
            ShellParams { stretch: [200.0 / scale; 2], shear: 80.0 / scale, bending: 1e-4 * scale, damping: 1e-3 };
        let shell = Shell {
            particles: (0..25).collect::<Vec<u32>>(),
            triangles: sheet.triangles().collect::<Vec<_>>(),
            hinges: sheet.hinges().collect::<Vec<_>>(),
            warp: x,
            params,
        };
        let mu = [0.0, 0.2][round % 2];
        let materials = [ContactMaterial { elasticity: None, friction: Some(Friction { static_: mu, kinetic: mu }) }];
        let forces = Gravity { acceleration: y * -9.81 };
        let method = Method::ALL[random.word() as usize % Method::ALL.len()];
        let substeps = [1, 4, 10][random.word() as usize % 3];
        let course = |colliders: &dyn Collider| {
            let (materials, constraints) = (&materials[..], &shell);
            let parts = Scene { start: &start, forces: &forces, materials: &materials, constraints, ..Scene::EMPTY };
            let scene = Scene { colliders, substeps, integrator: method.integrator(), ..parts };
            let mut system = started(&scene, start.len(), 0);
            (0..40).for_each(|_| {
                system.step(&scene, Time::from_seconds(pace / 60.0));
            });
            let all = system.particles();
            let mean = |of: &[Vec3]| of.iter().sum::<Vec3>() / of.len() as f32;
            [mean(all.position) / scale, mean(all.velocity) / pace]
        };
        let ([place, speed], [there, fast]) = (course(&triangles), course(&plane));
        let what = format!("{} in {substeps}, {scale} m, {cells} cells, friction {mu}, {velocity}", method.name());
        assert!(place.distance(there) < 1e-3, "{what}: {place}, not {there}");
        assert!(speed.distance(fast) < 5e-3, "{what}: {speed}, not {fast} m/s");
    }
}

/// A ball that contacts keep by position is braked by no edge that is level with the faces beside it.
#[test]
fn balls_slide_over_flat_triangles_as_over_a_plane() {
    let mut random = Random::new(32);
    for round in (0..120).step_by(every(11)) {
        let scale = [1.0, 0.1, 20.0][round % 3];
        let turn @ [x, y, z] = axes(&mut random);
        let cells = [7, 20, 60][round / 3 % 3];
        let triangles = floor(&mut random, turn, 4.0 * scale, cells);
        let plane = Plane { point: Vec3::ZERO, normal: y };
        let radius = [0.12, 0.3][round / 9 % 2] * scale;
        let aside = x * random.between(-1.0, 1.0) + z * random.between(-1.0, 1.0);
        let velocity = aside * (random.between(0.3, 2.0) * scale.sqrt());
        let position = y * radius;
        let start = [Particle { position, velocity, radius, elasticity: 0.0, material: Some(0), ..Particle::REST }];
        let mu = [0.0, 0.1][round % 2];
        let materials = [ContactMaterial { elasticity: None, friction: Some(Friction { static_: mu, kinetic: mu }) }];
        let forces = Gravity { acceleration: y * -9.81 };
        let integrator = Method::ALL[round % Method::ALL.len()];
        let substeps = [1, 4, 12, 50][round % 4];
        let end = |colliders: &dyn Collider| {
            let scene = Scene {
                start: &start,
                colliders,
                forces: &forces,
                materials: &materials,
                constraints: &Contacts::HARD,
                substeps,
                integrator: &integrator,
                ..Scene::EMPTY
            };
            let mut system = started(&scene, 1, 1);
            for i in 1..=60 {
                system.step(&scene, Time::from_seconds(i as f32 * scale.sqrt() / 60.0) - system.time());
            }
            let all = system.particles();
            ([all.position[0], all.velocity[0]], system.totals().caps.contacts)
        };
        let ([on, fast], full) = end(&triangles);
        let ([wanted, speed], _) = end(&plane);
        let case = format!("{round}: {integrator} in {substeps}, {scale} m, {cells} cells, {radius} m");
        let (off, slower) = ((on - wanted).length(), (fast - speed).length());
        assert!(off < 5e-3 * scale && slower < 5e-3 * scale.sqrt(), "{case}: {off} m, {slower} m/s off");
        assert_eq!(full, 0, "{case}");
    }
}
