//! Sinks take whom they pull to them.

use pointmass::shape::{Cone, Cuboid, Cylinder, Disc, Line, MeshBuf, Shape, Surface, Triangle};
use pointmass::{Method, Particle, Scene, Sink, Vec3};
use pointmass_tests::{Random, f64s, gap, often, run, started};

/// A closed mesh whose edges are all acute.
fn tetrahedron(middle: Vec3, size: f32) -> MeshBuf {
    let signs = [[1.0, 1.0, 1.0], [1.0, -1.0, -1.0], [-1.0, 1.0, -1.0], [-1.0, -1.0, 1.0]];
    let corners = signs.map(|signs| middle + Vec3::from(signs) * size);
    MeshBuf::new(corners.to_vec(), vec![[0, 1, 2], [0, 3, 1], [0, 2, 3], [1, 3, 2]]).expect("it is a mesh")
}

/// From rest everyone goes straight to the nearest place, which is a rim, an edge or a corner as often as not, and arrives there
/// when a constant pull says.
#[test]
fn who_is_pulled_to_a_rim_or_an_edge_is_taken_there() {
    for (round, (middle, scale)) in
        [(Vec3::ZERO, 1.0f32), (Vec3::new(20.0, -7.0, 3.0), 1.0), (Vec3::Y, 8.0), (Vec3::X, 0.25)]
            .into_iter()
            .enumerate()
    {
        let tilt = Vec3::new(0.3, 1.0, -0.2);
        let (low, high) = (middle + Vec3::NEG_Z * scale, middle + Vec3::new(0.2, 0.1, 1.0) * scale);
        let corners = [[-1.0, 0.0, -1.0], [1.0, 0.2, -1.0], [0.0, 0.0, 1.0]].map(|at| middle + Vec3::from(at) * scale);
        let shapes: [(&str, Shape<MeshBuf>); 7] = [
            ("disc", Shape::Circle(Disc { center: middle, normal: tilt, radius: scale })),
            ("line", Shape::Line(Line { from: low, to: high })),
            ("triangle", Shape::Triangle(Triangle { corners })),
            ("box", Shape::Box(Cuboid { min: middle - scale, max: middle + scale })),
            ("cylinder", Shape::Cylinder(Cylinder { center: middle, radius: scale, height: scale })),
            ("cone", Shape::Cone(Cone { center: middle, radius: scale, height: scale })),
            ("tetrahedron", Shape::Mesh(tetrahedron(middle, scale))),
        ];
        let mut random = Random::new(40 + round as u64);
        for (name, shape) in shapes {
            let places = (0..often(200)).map(|_| middle + random.vector(3.0 * scale));
            let start: Vec<_> = places.map(|position| Particle { position, ..Particle::REST }).collect();
            let sink = Sink { shape, group: None, intensity: 6.0, ca: 1.0, la: 0.0, qa: 0.0, softening: 0.0 };
            let far = |p: &Particle| gap(f64s(sink.shape.nearest(p.position)), f64s(p.position));
            let latest = start.iter().map(|p| (2.0 * far(p) / f64::from(sink.intensity)).sqrt()).fold(0.0, f64::max);
            for &method in Method::ALL {
                // Methods that ask beyond the surface, where it pulls back, lead some past it, more in long steps.
                let is_plain = [Method::Euler, Method::Symplectic, Method::Implicit].contains(&method);
                let (dt, few) = if is_plain { (1.0 / 30.0, 0) } else { (1.0 / 120.0, start.len() / 20) };
                let integrator = method.integrator();
                let scene = Scene { start: &start, forces: &sink, sinks: &sink, integrator, ..Scene::EMPTY };
                let mut system = started(&scene, start.len(), 0);
                run(&mut system, &scene, dt, (latest / dt) as u32 + 3);
                let left = system.len();
                assert!(left <= few, "{name}, {method}, {scale}: {left} of {} are left", start.len());
            }
        }
    }
}
