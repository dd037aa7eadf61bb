//! Rigid bodies that are convex hulls against geometry and mechanics: hulls of points, dice of all kinds, stones.

use pointmass::constrain::{Hull, HullBuf, HullError, RigidBodies, RigidBox};
use pointmass::draw::body;
use pointmass::force::Friction;
use pointmass::shape::Plane;
use pointmass::{ContactMaterial, Gravity, Heap, Measures, Method, Particle, Scene, System, Time, Vec3};
use pointmass_tests::{Random, chi_squared, f64s, gap, run, started};

const DOWN: Gravity = Gravity { acceleration: Vec3::new(0.0, -9.81, 0.0) };
const GROUND: Plane = Plane { point: Vec3::ZERO, normal: Vec3::Y };

/// Material 0 with a coefficient of friction.
const fn rough(mu: f32) -> [ContactMaterial; 1] {
    [ContactMaterial { elasticity: None, friction: Some(Friction { static_: mu, kinetic: mu }) }]
}

const PHI: f32 = 1.618_034;

/// The corners of a Platonic solid in the box from −1 to 1, by the number of its faces.
fn platonic(faces: u32) -> Vec<Vec3> {
    let signs = |v: Vec3| {
        (0..8).map(move |i| v * Vec3::from_array([0, 1, 2].map(|bit| if i >> bit & 1 == 1 { 1.0 } else { -1.0 })))
    };
    let turned = |y: f32, z: f32| {
        signs(Vec3::new(0.0, y, z)).chain(signs(Vec3::new(z, 0.0, y))).chain(signs(Vec3::new(y, z, 0.0)))
    };
    match faces {
        4 => signs(Vec3::ONE).filter(|v| v.x * v.y * v.z > 0.0).collect(),
        6 => signs(Vec3::ONE).collect(),
        8 => turned(0.0, 1.0).collect(),
        12 => signs(Vec3::ONE / PHI).chain(turned(1.0 / PHI / PHI, 1.0)).collect(),
        _ => turned(1.0 / PHI, 1.0).collect(),
    }
}

/// The faces, corners and edges of each; and of one with edges of 1 m the volume \[m³\] and, for 1 kg, the moment of inertia \[kg m²\].
const SOLIDS: [(u32, [usize; 3], f64, f64); 5] = [
    (4, [4, 6, 4], 0.117_851_130, 0.05),
    (6, [8, 12, 6], 1.0, 1.0 / 6.0),
    (8, [6, 12, 8], 0.471_404_521, 0.1),
    (12, [20, 30, 12], 7.663_118_961, 0.607_355_039),
    (20, [12, 30, 20], 2.181_694_991, 0.261_803_399),
];

/// Says that a hull is a closed convex polyhedron around the points.
fn assert_hull(hull: &Hull<'_>, points: &[Vec3], shift: Vec3, size: f32) {
    assert_eq!(hull.fault(), None);
    assert_eq!(hull.corners.len() + hull.faces.len(), hull.edges.len() + 2);
    for face in hull.faces {
        for point in points {
            let out = face.normal.dot(*point - shift) - face.offset;
            assert!(out < 5e-4 * size, "{point} is {out} m outside");
        }
        let corners: Vec<_> = hull.polygon(face).collect();
        for (i, a) in corners.iter().enumerate() {
            let (b, c) = (corners[(i + 1) % corners.len()], corners[(i + 2) % corners.len()]);
            assert!((b - *a).cross(c - b).dot(face.normal) > 0.0, "the corners go round counterclockwise");
            assert!((face.normal.dot(*a) - face.offset).abs() < 5e-4 * size);
        }
    }
}

#[test]
fn hulls_of_platonic_solids_have_their_corners_edges_faces_and_volumes() {
    let mut random = Random::new(3);
    for (faces, counts, volume, inertia) in SOLIDS {
        for (scale, far) in [(1.0, 0.0), (0.01, 0.3), (100.0, 1e4)] {
            let shift = random.direction() * far;
            let mut points: Vec<_> = platonic(faces).iter().map(|&point| point * scale + shift).collect();
            let hull = HullBuf::of(&points).unwrap_or_else(|error| panic!("{faces} at {scale}: {error}"));
            let found = [hull.lend().corners.len(), hull.lend().edges.len(), hull.lend().faces.len()];
            assert_eq!(found, counts, "{faces}, {scale}");
            assert_hull(&hull.lend(), &points, shift, scale);
            let [a, b] = hull.lend().edges[0].ends.map(|end| hull.lend().corners[usize::from(end)]);
            let edge = f64::from((a - b).length());
            let found = f64::from(hull.lend().volume());
            assert!((found / (volume * edge.powi(3)) - 1.0).abs() < 2e-4, "{faces}, {scale}: {found} m³");
            let square = |k: usize| hull.lend().particles().iter().map(|x| f64::from(x[k] * x[k])).sum::<f64>() / 8.0;
            for [i, j] in [[0, 1], [1, 2], [2, 0]] {
                let found = (square(i) + square(j)) / (edge * edge);
                assert!((found / inertia - 1.0).abs() < 3e-4, "{faces}, {scale}: {found} for {inertia}");
            }
            // What is inside, or there twice, or in the middle of an edge or a face, changes nothing.
            let (a, b) = (points[0], points[1]);
            points.extend([a, shift, (a + b) * 0.5, shift + (a - shift) * 0.7]);
            let again = HullBuf::of(&points).expect("the same hull");
            assert_eq!(again.lend().faces.len(), counts[2], "{faces}, {scale}");
        }
    }
}

/// Of what is sheared and stretched anyhow, Σ m x xᵀ goes along: A S Aᵀ. Eight particles have it, and the centre of the whole.
#[test]
fn particles_of_a_hull_have_its_centre_and_inertia() {
    let mut random = Random::new(5);
    for faces in [4, 6, 8, 12, 20] {
        let [x, y, z] = [Vec3::X, Vec3::Y, Vec3::Z].map(|axis| axis + random.vector(0.6));
        let by = |v: Vec3| x * v.x + y * v.y + z * v.z;
        let points: Vec<_> = platonic(faces).into_iter().map(by).collect();
        let [own, plain] = [&points, &platonic(faces)].map(|points| HullBuf::of(points).expect("a hull"));
        assert!(own.lend().centroid().length() < 1e-5);
        let square = plain.lend().particles().iter().map(|x| x.x * x.x).sum::<f32>() / 8.0;
        let particles = own.lend().particles();
        assert!(particles.iter().sum::<Vec3>().length() < 1e-5);
        for i in 0..3 {
            for j in 0..3 {
                let found = particles.iter().map(|p| p[i] * p[j]).sum::<f32>() / 8.0;
                let right = square * [x, y, z].iter().map(|axis| axis[i] * axis[j]).sum::<f32>();
                assert!((found - right).abs() < 1e-3 * square, "{faces}: {found} for {right}");
            }
        }
    }
}

#[test]
fn hulls_say_why_there_is_none() {
    let ring = |n: usize, y: f32| {
        (0..n).map(move |i| {
            let (sin, cos) = (i as f32 / n as f32 * core::f32::consts::TAU).sin_cos();
            Vec3::new(cos, y, sin)
        })
    };
    let mut random = Random::new(6);
    let ball: Vec<_> = (0..200).map(|_| random.direction()).collect();
    for (points, error) in [
        (vec![], HullError::Flat),
        (vec![Vec3::ONE; 9], HullError::Flat),
        (vec![Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::X + Vec3::Y], HullError::Flat),
        (vec![Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::NAN], HullError::NotFinite),
        (vec![Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::Z * 1e30], HullError::NotFinite),
        (ball, HullError::TooManyCorners),
        (ring(33, 0.0).chain([Vec3::Y]).collect(), HullError::TooManySides),
    ] {
        assert_eq!(HullBuf::of(&points), Err(error));
    }
    for n in [3, 5, 16, 32] {
        let prism: Vec<_> = ring(n, 0.0).chain(ring(n, 1.0)).collect();
        let hull = HullBuf::of(&prism).unwrap_or_else(|error| panic!("{n}: {error}"));
        assert_eq!(hull.lend().faces.len(), n + 2);
    }
}

/// Points in a ball anyhow: everything is in their hull, and the hull is closed.
#[test]
fn hulls_of_random_points_hold_them_all() {
    let mut random = Random::new(7);
    for n in 4..60 {
        let points: Vec<_> = (0..n).map(|_| random.direction() * random.between(0.2, 1.0)).collect();
        let hull = HullBuf::of(&points).unwrap_or_else(|error| panic!("{n}: {error}"));
        let shift = points[0] - nearest(&points, &hull.lend());
        assert_hull(&hull.lend(), &points, shift, 1.0);
    }
}

/// The place in the hull of the first point, whichever of its corners is as far from the others: a hull is about its centroid.
fn nearest(points: &[Vec3], hull: &Hull<'_>) -> Vec3 {
    let low = |list: &[Vec3]| list.iter().fold(Vec3::INFINITY, |low, &point| low.min(point));
    points[0] - low(points) + low(hull.corners)
}

/// A quaternion x, y, z, w that turns one unit vector onto another.
fn onto(from: Vec3, to: Vec3) -> [f32; 4] {
    let axis = from.cross(to);
    let w = 1.0 + from.dot(to);
    if w > 1e-4 { [axis.x, axis.y, axis.z, w] } else { [0.0, 0.0, 1.0, 0.0] }
}

/// A body of a hull with a face down on a plane through a point, and its particles.
fn lying(hull: &Hull<'_>, face: usize, on: Vec3, normal: Vec3, whole: Particle) -> (RigidBox, [Particle; 8]) {
    let face = hull.faces[face];
    let of = RigidBox::with_hull(hull, 0, on + normal * face.offset, 0);
    let of = RigidBox { turn: onto(face.normal, -normal), ..of };
    (of, of.solid_hull(hull, whole))
}

#[test]
fn a_hull_dropped_flat_bounces_to_e_squared_of_its_height() {
    for (faces, elasticity, method, scale, substeps) in [
        (4, 0.5f32, Method::Rk4, 1.0f32, 10),
        (8, 0.8, Method::Verlet, 0.01, 20),
        (12, 1.0, Method::Rk4, 100.0, 5),
        (20, 0.0, Method::Symplectic, 1.0, 50),
        (20, 0.7, Method::Rk4, 0.1, 20),
    ] {
        let points: Vec<_> = platonic(faces).iter().map(|&point| point * 0.05 * scale).collect();
        let hulls = [HullBuf::of(&points).expect("a hull")];
        let hull = hulls[0].lend();
        let at = Vec3::new(2.0, 1.0, -1.0) * scale;
        let (of, start) = lying(&hull, 1, at, Vec3::Y, Particle { elasticity, material: Some(0), ..Particle::REST });
        let (bodies, materials) = (RigidBodies { boxes: [of], hulls: &hulls[..], balls: 0 }, rough(0.5));
        let forces = Gravity { acceleration: Vec3::NEG_Y * 9.81 * scale };
        let parts = Scene { start: &start, forces: &forces, colliders: &GROUND, materials: &materials, ..Scene::EMPTY };
        let scene = Scene { constraints: &bodies, substeps, integrator: method.integrator(), ..parts };
        let mut system = started(&scene, 8, 0);
        let (mut has_hit, mut top) = (false, 0f32);
        for frame in 1..=110 {
            system.step_to(&scene, Time::frame(frame, 120));
            has_hit |= system.totals().hits > 0;
            let x = system.particles().position;
            let height = (x.iter().map(|x| x.y).sum::<f32>() / 8.0 - hull.faces[1].offset) / scale;
            if has_hit && frame < 54 + (108.0 * elasticity) as u64 / 2 + 2 {
                top = top.max(if system.particles().velocity[0].y >= -0.2 * scale { height } else { 0.0 });
            }
        }
        let right = elasticity * elasticity;
        // Four of a pentagon's corners, which it stands on unevenly, share the blow in so many passes: what they leave over turns it a little.
        let left = if faces == 12 { 0.016 } else { 6e-3 };
        assert!((top - right).abs() < left, "{faces}, {elasticity}, {method}, {scale}: {top} for {right}");
    }
}

#[test]
fn a_hull_slides_down_a_slope_if_it_is_steeper_than_friction_holds() {
    for (i, (degrees, mu)) in
        [(20.0f32, 0.3f32), (20.0, 0.4), (30.0, 0.5), (35.0, 0.8), (50.0, 0.0)].into_iter().enumerate()
    {
        let (sin, cos) = degrees.to_radians().sin_cos();
        let normal = Vec3::new(sin, cos, 0.0);
        let scale = [1.0, 0.01, 100.0][i % 3];
        let method = [Method::Symplectic, Method::Verlet, Method::Rk4][i % 3];
        // Flat prisms do not tip over.
        let points: Vec<_> =
            platonic([6, 8, 12][i % 3]).iter().map(|v| Vec3::new(v.x, 0.2 * v.y, v.z) * 0.1 * scale).collect();
        let hulls = [HullBuf::of(&points).expect("a hull")];
        let hull = hulls[0].lend();
        let area = |face: &pointmass::constrain::HullFace| {
            hull.triangles(face).map(|[a, b, c]| (b - a).cross(c - a).length()).sum::<f32>()
        };
        let widest = (0..hull.faces.len()).max_by(|&a, &b| area(&hull.faces[a]).total_cmp(&area(&hull.faces[b])));
        let from = Vec3::new(3.0, -2.0, 1.0) * scale;
        let whole = Particle { mass: 2.0, material: Some(0), ..Particle::REST };
        let (of, start) = lying(&hull, widest.expect("faces"), from, normal, whole);
        let slope = Plane { point: from, normal };
        let (bodies, materials) = (RigidBodies { boxes: [of], hulls: &hulls[..], balls: 0 }, rough(mu));
        let forces = Gravity { acceleration: Vec3::NEG_Y * 9.81 * scale };
        let parts = Scene { start: &start, forces: &forces, colliders: &slope, materials: &materials, ..Scene::EMPTY };
        let scene = Scene { constraints: &bodies, substeps: 20, integrator: method.integrator(), ..parts };
        let mut system = started(&scene, 8, 0);
        run(&mut system, &scene, 1.0 / 60.0, 60);
        let middle = system.particles().position.iter().sum::<Vec3>() / 8.0;
        let way = (middle - of.center).length() / scale;
        let right = 0.5 * 9.81 * (sin - mu * cos).max(0.0);
        // In the first sub-step they may not touch yet.
        let late = 9.81 * mu * cos / 1200.0;
        assert!((way - right).abs() < 4e-3 * right + 2.0 * late, "{degrees}° at {mu}, {method}: {way} m for {right}");
    }
}

/// A hull of 1 × 2 × 3 flips about its middle axis; angular momentum and energy stay. Eight equal particles of a box flip as it does.
#[test]
fn a_free_hull_keeps_its_angular_momentum_and_energy() {
    for (faces, substeps, method) in
        [(6, 20, Method::Symplectic), (12, 10, Method::Verlet), (20, 50, Method::Rk4), (4, 5, Method::Verlet)]
    {
        let points: Vec<_> = platonic(faces).iter().map(|v| *v * Vec3::new(0.1, 0.2, 0.3)).collect();
        let hulls = [HullBuf::of(&points).expect("a hull")];
        let of = RigidBox::with_hull(&hulls[0].lend(), 0, Vec3::new(5.0, -3.0, 2.0), 0);
        let spin = Vec3::new(0.02, 5.0, 0.0);
        let start = of.solid_hull(&hulls[0].lend(), Particle::REST);
        let start = start.map(|p| Particle { velocity: spin.cross(p.position - of.center), ..p });
        let bodies = RigidBodies { boxes: [of], hulls: &hulls[..], balls: 0 };
        let scene =
            Scene { start: &start, constraints: &bodies, substeps, integrator: method.integrator(), ..Scene::EMPTY };
        let mut system = started(&scene, 8, 0);
        let before = Measures::of(&system, &scene);
        let mut least = 1f32;
        for frame in 1..=600 {
            system.step_to(&scene, Time::frame(frame, 60));
            let omega = system.particles();
            let arm = omega.position[2] - omega.position[0];
            least = least.min(arm.normalize().dot((start[2].position - start[0].position).normalize()));
        }
        let after = Measures::of(&system, &scene);
        let size = gap(before.angular_momentum, [0.0; 3]);
        assert!(gap(before.angular_momentum, after.angular_momentum) < 1e-4 * size, "{faces}");
        assert!((after.energy.kinetic / before.energy.kinetic - 1.0).abs() < 1e-2, "{faces}");
        assert!(least < -0.8, "{faces}: it has not flipped: {least}");
    }
}

/// A uniform rotation: a direction in four dimensions.
fn any_turn(random: &mut Random) -> [f32; 4] {
    loop {
        let turn: [f32; 4] = core::array::from_fn(|_| random.between(-1.0, 1.0));
        if (0.01..1.0).contains(&turn.iter().map(|x| x * x).sum::<f32>()) {
            return turn;
        }
    }
}

/// Dice of some hulls in rows, turned anyhow and thrown with a spin each.
fn dice(seed: u64, hulls: &[HullBuf], count: u32, apart: f32, inward: f32) -> (Vec<Particle>, Vec<RigidBox>) {
    let mut random = Random::new(seed);
    let (mut start, mut boxes) = (Vec::new(), Vec::new());
    let row = f64::from(count).sqrt().ceil() as u32;
    let middle = 0.5 * (row - 1) as f32 * apart;
    for i in 0..count {
        let number = i % hulls.len() as u32;
        let hull = hulls[number as usize].lend();
        let at = Vec3::new((i % row) as f32 * apart, random.between(0.3, 0.8), (i / row) as f32 * apart);
        let of = RigidBox { turn: any_turn(&mut random), ..RigidBox::with_hull(&hull, number as u16, at, 8 * i) };
        let velocity = random.vector(0.6) + Vec3::new(middle - at.x, 0.0, middle - at.z) * inward;
        let whole = Particle { velocity, mass: 0.1, elasticity: 0.4, material: Some(0), ..Particle::REST };
        let spin = random.direction() * random.between(15.0, 30.0);
        let particles = of.solid_hull(&hull, whole);
        start.extend(particles.map(|p| Particle { velocity: p.velocity + spin.cross(p.position - at), ..p }));
        boxes.push(of);
    }
    (start, boxes)
}

/// The corners of a body now, and the normals of its faces.
fn corners(system: &System<Heap>, scene: &Scene<'_>, of: &RigidBox, hull: &Hull<'_>) -> (Vec<[f64; 3]>, Vec<[f64; 3]>) {
    let now = body(&system.state(scene), of, scene.start).expect("it is there");
    let turned = |v: Vec3| now.axes * (v / of.half);
    let corners = hull.corners.iter().map(|&corner| f64s(now.center + turned(corner))).collect();
    (corners, hull.faces.iter().map(|face| f64s(turned(face.normal))).collect())
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// By how much two convex bodies overlap: the least over the normals of both and all differences of their corners across each other \[m\].
fn overlap(a: &(Vec<[f64; 3]>, Vec<[f64; 3]>), b: &(Vec<[f64; 3]>, Vec<[f64; 3]>), edges: [&Hull<'_>; 2]) -> f64 {
    let sides = |of: &(Vec<[f64; 3]>, Vec<[f64; 3]>), hull: &Hull<'_>| -> Vec<[f64; 3]> {
        let corner = |number: u8| of.0[usize::from(number)];
        let along = |[from, to]: [u8; 2]| [0, 1, 2].map(|k| corner(to)[k] - corner(from)[k]);
        hull.edges.iter().map(|edge| along(edge.ends)).collect()
    };
    let [u, v] = [sides(a, edges[0]), sides(b, edges[1])];
    let cross =
        |a: [f64; 3], b: [f64; 3]| [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
    let crossed = u.iter().flat_map(|&u| v.iter().map(move |&v| cross(u, v)));
    let axes = a.1.iter().chain(&b.1).copied().chain(crossed);
    let range = |of: &[[f64; 3]], axis: [f64; 3]| {
        let along = of.iter().map(|&corner| dot(axis, corner));
        along.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| (low.min(x), high.max(x)))
    };
    let depth = |axis: [f64; 3]| {
        let size = dot(axis, axis).sqrt();
        let ((low, high), (other_low, other_high)) = (range(&a.0, axis), range(&b.0, axis));
        if size < 1e-9 { f64::INFINITY } else { (high - other_low).min(other_high - low) / size }
    };
    axes.map(depth).fold(f64::INFINITY, f64::min)
}

/// Kinetic and potential energy \[J\].
fn energy(system: &System<Heap>, scene: &Scene<'_>) -> f64 {
    let energy = Measures::of(system, scene).energy;
    energy.kinetic + energy.potential
}

/// Dice of all kinds that meet in the air and on the ground: at rest within five seconds, none in another, and energy only falls.
#[test]
fn dice_of_all_kinds_come_to_rest() {
    let hulls = [4, 8, 12, 20, 6].map(|faces| {
        let points: Vec<_> = platonic(faces).iter().map(|&point| point * 0.05).collect();
        HullBuf::of(&points).expect("a hull")
    });
    for (seed, substeps) in [(2, 20), (3, 10), (4, 4), (5, 3)] {
        let (start, boxes) = dice(seed, &hulls, 16, 0.16, 1.5);
        let (bodies, materials) = (RigidBodies { boxes, hulls: &hulls[..], balls: 0 }, rough(0.4));
        let parts = Scene { start: &start, forces: &DOWN, colliders: &GROUND, materials: &materials, ..Scene::EMPTY };
        let scene = Scene { constraints: &bodies, substeps, integrator: Method::Verlet.integrator(), ..parts };
        let mut system = started(&scene, start.len(), 0);
        let first = energy(&system, &scene);
        let (mut least, mut risen) = (first, 0f64);
        for frame in 1..=300 {
            system.step_to(&scene, Time::frame(frame, 60));
            let now = energy(&system, &scene);
            least = least.min(now);
            risen = risen.max((now - least) / first);
        }
        assert!(risen < 1e-5, "{substeps} sub-steps: energy grew by {risen}");
        assert!(system.totals().contacts > 50 && system.totals().caps.contacts == 0, "{:?}", system.totals());
        let fastest = system.particles().velocity.iter().map(|v| v.length()).fold(0.0, f32::max);
        assert!(fastest < 2e-3, "{substeps} sub-steps: {fastest} m/s");
        let hull = |of: &RigidBox| hulls[usize::from(of.hull.expect("a hull"))].lend();
        let seen: Vec<_> = bodies.boxes.iter().map(|of| corners(&system, &scene, of, &hull(of))).collect();
        for (i, a) in seen.iter().enumerate() {
            let low = a.0.iter().map(|corner| corner[1]).fold(f64::INFINITY, f64::min);
            assert!(low > -1e-3, "{substeps} sub-steps, {i}: {low} m in the ground");
            for (j, b) in seen[..i].iter().enumerate() {
                let depth = overlap(a, b, [&hull(&bodies.boxes[i]), &hull(&bodies.boxes[j])]);
                assert!(depth < 0.002, "{substeps} sub-steps: {i} is {depth} m in {j}");
            }
        }
    }
}

/// Throws dice of a kind that do not meet each other, and counts the faces they fall on; asserts that they lie on one.
fn throw(seed: u64, faces: u32, count: u32) -> Vec<u32> {
    let points: Vec<_> = platonic(faces).iter().map(|&point| point * 0.05).collect();
    let hulls = [HullBuf::of(&points).expect("a hull")];
    let (start, boxes) = dice(seed, &hulls, count, 5.0, 0.0);
    let (bodies, materials) = (RigidBodies { boxes, hulls: &hulls[..], balls: 0 }, rough(0.5));
    let parts = Scene { start: &start, forces: &DOWN, colliders: &GROUND, materials: &materials, ..Scene::EMPTY };
    let scene = Scene { constraints: &bodies, substeps: 10, ..parts };
    let mut system = started(&scene, start.len(), 0);
    run(&mut system, &scene, 1.0 / 60.0, 300);
    let fastest = system.particles().velocity.iter().map(|v| v.length()).fold(0.0, f32::max);
    assert!(fastest < 2e-3, "{fastest} m/s");
    let mut counts = vec![0; faces as usize];
    for of in &bodies.boxes {
        let (_, normals) = corners(&system, &scene, of, &hulls[0].lend());
        let down = |normal: &[f64; 3]| -normal[1] / dot(*normal, *normal).sqrt();
        let lowest = (0..normals.len()).max_by(|&a, &b| down(&normals[a]).total_cmp(&down(&normals[b])));
        let lowest = lowest.expect("faces");
        assert!(down(&normals[lowest]) > 0.9995, "on an edge: {}", down(&normals[lowest]));
        counts[lowest] += 1;
    }
    counts
}

#[test]
fn dice_of_twenty_faces_are_fair() {
    // χ² of 19 degrees of freedom that chance exceeds once in a hundred times; of 3.
    for (faces, count, most) in [(20, 120, 36.19), (4, 60, 11.34)] {
        let counts = throw(5, faces, count);
        let shares = vec![1.0 / f64::from(faces); faces as usize];
        assert!(chi_squared(&counts, &shares) < most, "{counts:?}");
    }
}

#[test]
#[ignore = "long: thousands of throws, in release"]
fn dice_of_all_kinds_are_fair_in_the_long_run() {
    for (faces, most) in [(4, 11.34), (8, 18.48), (12, 24.72), (20, 36.19)] {
        let counts = throw(9, faces, 3000);
        let shares = vec![1.0 / f64::from(faces); faces as usize];
        assert!(chi_squared(&counts, &shares) < most, "{counts:?}");
    }
}

/// A tower of octahedra on their faces and boxes between them stands, since boxes are as hulls to hulls.
#[test]
fn a_tower_of_hulls_and_boxes_stands() {
    let flat = |faces| {
        let points: Vec<_> = platonic(faces).iter().map(|v| *v * 0.05).collect();
        HullBuf::of(&points).expect("a hull")
    };
    let hulls = [flat(8), flat(12), flat(6), flat(20)];
    let part = Particle { material: Some(0), ..Particle::REST };
    let (mut start, mut boxes, mut top) = (Vec::new(), Vec::new(), 0.0);
    for i in 0..8u32 {
        let first = start.len() as u32;
        if i % 2 == 1 {
            boxes.push(RigidBox::new(Vec3::new(0.05, 0.01, 0.05), Vec3::Y * (top + 0.01), first));
            start.extend(boxes[i as usize].solid(part));
            top += 0.02;
            continue;
        }
        let number = (i / 2 % 4) as u16;
        let hull = hulls[usize::from(number)].lend();
        let (of, _) = lying(&hull, 0, Vec3::Y * top, Vec3::Y, part);
        let of = RigidBox { first, hull: Some(number), ..of };
        start.extend(of.solid_hull(&hull, part));
        boxes.push(of);
        // The faces of these solids are parallel in pairs.
        top += 2.0 * hull.faces[0].offset;
    }
    let (bodies, materials) = (RigidBodies { boxes, hulls: &hulls[..], balls: 0 }, rough(0.5));
    let parts = Scene { start: &start, forces: &DOWN, colliders: &GROUND, materials: &materials, ..Scene::EMPTY };
    let scene = Scene { constraints: &bodies, substeps: 20, ..parts };
    let mut system = started(&scene, start.len(), 0);
    run(&mut system, &scene, 1.0 / 60.0, 300);
    for of in &bodies.boxes {
        let x = &system.particles().position[of.first as usize..][..8];
        let middle = x.iter().sum::<Vec3>() / 8.0;
        assert!((middle - of.center).length() < 2e-3, "{of:?}: {middle}");
    }
}
