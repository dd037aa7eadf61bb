//! Balls against every shape, held against distances in double precision.

use pointmass::shape::{
    Affine, Collider, Cone, Contact, Cuboid, Cylinder, MeshBuf, Placed, Plane, Segment, Surface, Triangle,
};
use pointmass::{Mat3, Time, Vec3};
use pointmass_tests::surfaces::{Vec, cross, distance, dot, first_touch, forms, minus, near, plus, to_triangle, unit};
use pointmass_tests::{Form, Random, every, f64s, gap, often};

/// The direction away from a surface: a difference quotient of the distance.
fn away(distance: impl Fn(Vec) -> f64, x: Vec) -> Vec {
    let axis = |i: usize| core::array::from_fn(|k| if i == k { 1e-6 } else { 0.0 });
    unit(core::array::from_fn(|i| distance(plus(x, axis(i), 1.0)) - distance(plus(x, axis(i), -1.0))))
}

/// Holds the first hits of random balls on a collider against the oracle; returns how many there were.
fn hold(
    name: &str,
    collider: &dyn Collider,
    distance: &dyn Fn(Vec) -> f64,
    paths: impl Iterator<Item = (Segment, f32)>,
) -> usize {
    let mut hits = 0;
    for (segment, size) in paths {
        let (from, to, radius) = (f64s(segment.from), f64s(segment.to), f64::from(segment.radius));
        // As the ball rounds its distances: some units in the last place of its coordinates.
        let tolerance = f64::from(size) * 2e-6;
        let apart = distance(from) - radius;
        if apart < tolerance {
            continue;
        }
        let hit = collider.first_hit(&segment);
        let (expected, least) = first_touch(distance, from, to, radius);
        if least > tolerance {
            assert!(hit.is_none(), "{name}: {segment:?} {hit:?} though it stays {least} m away");
        }
        let Some(hit) = hit else {
            // It may only just touch.
            let deepest = (0..=100).map(|i| distance(plus(from, minus(to, from), f64::from(i) / 100.0)) - radius);
            let deepest = deepest.fold(f64::INFINITY, f64::min);
            assert!(deepest > -tolerance && distance(to) - radius > -tolerance, "{name}: {segment:?} missed {deepest}");
            continue;
        };
        hits += 1;
        let there = plus(from, minus(to, from), f64::from(hit.time));
        let left = distance(there) - radius;
        assert!(left.abs() < tolerance, "{name}: {segment:?} {hit:?} at {left} m");
        let way = gap(to, from);
        let out = away(distance, there);
        let closing = -dot(unit(minus(to, from)), out);
        // Where it comes nearer at a slant, an error of the distance is one of the way over the cosine.
        if closing > 0.02 {
            let expected = expected.expect("it touches");
            let error = (f64::from(hit.time) - expected).abs() * way;
            assert!(error < 2.0 * tolerance / closing, "{name}: {segment:?} {hit:?}, {error} m from {expected}");
        }
        if radius > 0.01 {
            let cosine = dot(f64s(hit.normal), out);
            assert!(cosine > 0.999, "{name}: {segment:?} {hit:?} leans {out:?}");
        }
    }
    hits
}

#[test]
fn balls_first_touch_where_an_oracle_says() {
    let mut random = Random::new(61);
    for form in forms() {
        let paths: std::vec::Vec<_> = (0..often(6000))
            .map(|_| {
                let ((from, size), (to, _)) = (near(&form, &mut random), near(&form, &mut random));
                // A third of them go far beyond.
                let to = if random.unit() < 0.3 { from + (to - from) * 20.0 } else { to };
                let size = size.max(to.abs().max_element());
                let radius = random.magnitude(1e-3, 0.5);
                (Segment { radius, ..Segment::new(from, to) }, size)
            })
            .collect();
        let hits = hold(&format!("{form:?}"), &form, &|x| distance(&form, x), paths.into_iter());
        assert!(hits > often(100), "{form:?}: {hits}");
    }
}

#[test]
fn what_overlaps_is_hit_at_once_or_left() {
    let mut random = Random::new(62);
    for form in forms() {
        let (mut hits, mut leaves) = (0, 0);
        for _ in 0..often(10_000) {
            let (from, _) = near(&form, &mut random);
            let apart = distance(&form, f64s(from));
            let radius = apart as f32 + random.magnitude(1e-3, 0.1);
            let out = away(|x| distance(&form, x), f64s(from));
            let step = random.direction() * 0.01;
            let closing = -dot(unit(f64s(step)), out);
            // Near the middle of a hollow solid there is more than one nearest place.
            let kinks = (distance(&form, plus(f64s(from), out, 0.02)) - apart - 0.02).abs() > 1e-3;
            if apart < 0.01 || kinks || closing.abs() < 0.05 {
                continue;
            }
            let hit = form.first_hit(&Segment { radius, ..Segment::new(from, from + step) });
            if closing > 0.0 {
                hits += 1;
                assert_eq!(hit.map(|hit| hit.time), Some(0.0), "{form:?} {from} {radius} {step}");
            } else if let Some(hit) = hit {
                // Away from one wall it may come nearer to another.
                assert!(dot(f64s(step), f64s(hit.normal)) < 1e-9, "{form:?} {from} {radius} {step} {hit:?}");
            } else {
                leaves += 1;
            }
        }
        assert!(hits > often(200) && leaves > often(200), "{form:?}: {hits} {leaves}");
    }
}

#[test]
fn contacts_are_the_nearest_places_within_reach() {
    let mut random = Random::new(63);
    for form in forms() {
        let (mut within, mut without) = (0, 0);
        for _ in 0..often(10_000) {
            let (center, size) = near(&form, &mut random);
            let reach = random.magnitude(0.01, 1.0);
            let mut contacts: std::vec::Vec<Contact> = vec![];
            form.contacts(center, reach, Time::ZERO, &mut |contact| contacts.push(*contact));
            let tolerance = 2e-6 * f64::from(size);
            for contact in &contacts {
                let apart = gap(f64s(contact.point), f64s(center));
                assert!((apart - f64::from(contact.distance)).abs() < tolerance && contact.distance <= reach);
                assert!(contact.distance >= 0.0 && (contact.normal.length() - 1.0).abs() < 1e-6);
                let rest = contact.point + contact.normal * contact.distance - center;
                assert!(f64::from(rest.length()) < tolerance, "{form:?} {center} {contact:?}");
            }
            let nearest = contacts.iter().map(|c| f64::from(c.distance)).fold(f64::INFINITY, f64::min);
            let expected = distance(&form, f64s(center));
            if expected < f64::from(reach) - tolerance {
                within += 1;
                assert!((nearest - expected).abs() < tolerance, "{form:?} {center}: {nearest}, not {expected}");
            } else if expected > f64::from(reach) + tolerance {
                without += 1;
                assert!(contacts.is_empty(), "{form:?} {center} {reach}: {contacts:?}");
            }
        }
        assert!(within > often(100) && without > often(100), "{form:?}: {within} {without}");
    }
}

/// A point that lies on a solid leans on it, whichever side of it rounding has put it on, or neither.
#[test]
fn whoever_lies_on_a_solid_leans_on_it() {
    let mut random = Random::new(64);
    for form in forms() {
        let surface = match &form {
            Form::Box(solid) => solid as &dyn Surface,
            Form::Sphere(solid) => solid,
            Form::Cylinder(solid) => solid,
            Form::Cone(solid) => solid,
            Form::Capsule(solid) => solid,
            _ => continue,
        };
        for _ in 0..often(20_000) {
            let at = surface.sample([(); 3].map(|()| random.unit()));
            let mut nearest = f32::INFINITY;
            form.contacts(at.point, 1e-3, Time::ZERO, &mut |contact| {
                assert!((contact.normal.length() - 1.0).abs() < 1e-6, "{form:?} {at:?}: {contact:?}");
                nearest = nearest.min(contact.distance);
            });
            assert!(nearest <= 4e-6 * at.point.abs().max_element().max(1.0), "{form:?} {at:?}: {nearest}");
        }
    }
}

#[test]
fn in_the_corner_of_a_box_a_ball_leans_on_three_faces() {
    let unit = pointmass::shape::Cuboid { min: Vec3::ZERO, max: Vec3::ONE };
    let mut normals = vec![];
    unit.contacts(Vec3::new(0.1, 0.2, 0.95), 0.25, Time::ZERO, &mut |contact| normals.push(contact.normal));
    assert_eq!(normals, [Vec3::X, Vec3::Y, Vec3::NEG_Z]);
}

/// A map of space in double precision: the images of the unit vectors, and of the origin.
fn mapped(map: &Affine, x: Vec) -> Vec {
    let m = map.linear;
    let axes = [m.x_axis, m.y_axis, m.z_axis].map(f64s);
    (0..3).fold(f64s(map.shift), |sum, i| plus(sum, axes[i], x[i]))
}

/// The way back, by Cramer's rule.
fn unmapped(map: &Affine, x: Vec) -> Vec {
    let m = map.linear;
    let [a, b, c] = [m.x_axis, m.y_axis, m.z_axis].map(f64s);
    let (x, whole) = (minus(x, f64s(map.shift)), dot(a, cross(b, c)));
    [dot(x, cross(b, c)) / whole, dot(x, cross(c, a)) / whole, dot(x, cross(a, b)) / whole]
}

/// Random ways of balls near a place.
fn ways(random: &mut Random, middle: Vec3, spread: f32, n: usize) -> std::vec::Vec<(Segment, f32)> {
    let way = |_| {
        let (from, to) = (middle + random.vector(spread), middle + random.vector(spread));
        let radius = spread * random.magnitude(1e-2, 0.3);
        // Its own coordinates and the placed collider's, rounded there and back.
        let size = 3.0 * (middle.abs().max_element() + spread);
        (Segment { radius, ..Segment::new(from, to) }, size)
    };
    (0..n).map(way).collect()
}

#[test]
fn turned_mirrored_and_scaled_shapes_are_touched_where_they_stand() {
    let mut random = Random::new(64);
    let turn = Mat3::from_axis_angle(Vec3::new(1.0, 2.0, -1.0).normalize(), 0.7);
    let mirror = Mat3::from_diagonal(Vec3::new(1.0, -1.0, 1.0));
    for linear in [turn, turn * 3.0, turn * mirror * 0.1, Mat3::from_diagonal(Vec3::splat(20.0))] {
        let map = Affine { linear, shift: Vec3::new(0.5, -2.0, 1.0) };
        let scale = f64::from(linear.x_axis.length());
        for form in forms() {
            let (middle, _) = near(&form, &mut random);
            let placed = Placed::new(form.clone(), map).expect("it can be undone");
            let paths = ways(&mut random, map.point(middle), 1.5 * scale as f32, often(2000));
            let away = |x| scale * distance(&form, unmapped(&map, x));
            hold(&format!("{map:?} {form:?}"), &placed, &away, paths.into_iter().step_by(every(3)));
        }
    }
}

#[test]
fn squashed_and_sheared_shapes_are_touched_where_they_stand() {
    let mut random = Random::new(65);
    let turn = Mat3::from_axis_angle(Vec3::new(1.0, 2.0, -1.0).normalize(), 0.7);
    let shear = Mat3::from_cols(Vec3::new(1.0, 0.2, 0.0), Vec3::new(0.8, 1.0, 0.1), Vec3::new(-0.3, 0.4, 0.7));
    let flat = Mat3::from_diagonal(Vec3::new(2.0, 0.4, 0.7));
    let upright = Mat3::from_diagonal(Vec3::new(0.5, 2.0, 0.5));
    let center = Vec3::new(0.3, -0.2, 0.5);
    let cuboid = Cuboid { min: Vec3::new(-0.5, -0.4, -0.3), max: Vec3::new(0.6, 0.7, 0.9) };
    let (cylinder, cone) = (Cylinder { center, radius: 0.5, height: 1.2 }, Cone { center, radius: 0.6, height: 1.1 });
    let [a, b, c] = [Vec3::new(0.1, 0.4, -0.3), Vec3::new(1.0, 0.2, -0.1), Vec3::new(0.3, 0.9, 0.8)];
    let tetrahedron = [[0, 1, 2], [0, 2, 3], [0, 3, 1], [1, 3, 2]];
    let vertices = [Vec3::new(-0.5, -0.3, 0.6), a, b, c];
    let mesh = MeshBuf::new(vertices.to_vec(), tetrahedron.to_vec()).expect("a tetrahedron is a mesh");
    for linear in [shear, turn * flat, shear * flat * turn, turn * upright] {
        let map = Affine { linear, shift: Vec3::new(0.5, -2.0, 1.0) };
        let at = |x: Vec3| mapped(&map, f64s(x));
        let mut hold = |name: &str, collider: &dyn Collider, away: &dyn Fn(Vec) -> f64| {
            let paths = ways(&mut random, map.point(center), 1.5, often(3000));
            let hits = hold(&format!("{name} {map:?}"), collider, away, paths.into_iter().step_by(every(3)));
            assert!(hits > often(30) / every(3), "{name}: {hits}");
        };
        let corners = |i: usize, j: usize, k: usize| {
            at(Vec3::new(
                [cuboid.min.x, cuboid.max.x][i],
                [cuboid.min.y, cuboid.max.y][j],
                [cuboid.min.z, cuboid.max.z][k],
            ))
        };
        let mut faces = vec![];
        for side in [0, 1] {
            let x = [(0, 0), (1, 0), (1, 1), (0, 1)].map(|(u, v)| corners(side, u, v));
            let y = [(0, 0), (1, 0), (1, 1), (0, 1)].map(|(u, v)| corners(u, side, v));
            let z = [(0, 0), (1, 0), (1, 1), (0, 1)].map(|(u, v)| corners(u, v, side));
            faces.extend([x, y, z].iter().flat_map(|q| [[q[0], q[1], q[2]], [q[0], q[2], q[3]]]));
        }
        let nearest =
            |faces: &[[Vec; 3]], x: Vec| faces.iter().map(|f| to_triangle(x, *f)).fold(f64::INFINITY, f64::min);
        hold("box", &Placed::new(cuboid, map).expect("sound"), &|x| nearest(&faces, x));
        let sides = tetrahedron.map(|t| t.map(|i| at(vertices[i as usize])));
        hold("mesh", &Placed::new(mesh.view(), map).expect("sound"), &|x| nearest(&sides, x));
        let triangle = Triangle { corners: [a, b, c] };
        hold("triangle", &Placed::new(triangle, map).expect("sound"), &|x| nearest(&[[a, b, c].map(at)], x));
        let plane = Plane { point: a, normal: (b - a).cross(c - a) };
        let normal = unit(cross(minus(at(b), at(a)), minus(at(c), at(a))));
        hold("plane", &Placed::new(plane, map).expect("sound"), &|x| dot(minus(x, at(a)), normal).abs());
        if linear == turn * upright {
            let turned = Affine { linear: turn, ..map };
            let (height, radius) = (cylinder.height * 2.0, cylinder.radius * 0.5);
            let middle = upright * center;
            let tall = Form::Cylinder(Cylinder { center: middle, radius, height });
            hold("cylinder", &Placed::new(cylinder, map).expect("sound"), &|x| distance(&tall, unmapped(&turned, x)));
            let tall = Form::Cone(Cone { center: middle, radius: cone.radius * 0.5, height: cone.height * 2.0 });
            hold("cone", &Placed::new(cone, map).expect("sound"), &|x| distance(&tall, unmapped(&turned, x)));
        }
    }
}
