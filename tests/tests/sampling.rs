//! Where births lie and where they go: uniform by area, and by the laws of the directions.
//!
//! Every limit is that of one error in a thousand; seeds are fixed, so a run that passes passes always.

use core::f64::consts::{FRAC_PI_2, FRAC_PI_4, PI};
use pointmass::emit::Burst;
use pointmass::shape::{Capsule, Cone, Cuboid, Cylinder, Disc, Line, Mesh, MeshBuf, Shape, Sphere, Surface};
use pointmass::{Emitter, Scene, Spread, Time, Varied, Vec3};
use pointmass_tests::{
    CHI_99, Form, KS, Random, chi_squared, chi_squared_100, f64s, gap, icosahedron, ks, often, point, started, turn,
};

/// Places of birth, and directions, of very many births all at once.
fn births<S: Surface + Sync>(emitter: Emitter<S>) -> Vec<([f64; 3], [f64; 3])> {
    let n = often(100_000);
    let burst = Some(Burst { count: n as u32, at: 0.0, every: 0.0 });
    let emitter = Emitter { burst, speed: Varied::exactly(1.0), ..emitter };
    let scene = Scene { emitters: &emitter, ..Scene::EMPTY };
    let mut system = started(&scene, n, 11);
    // In 2⁻³² s they go 2⁻³² m.
    system.step(&scene, Time::from_ticks(1));
    let p = system.particles();
    p.position.iter().zip(p.velocity).map(|(&x, &v)| (f64s(x), f64s(v))).collect()
}

/// Places and normals on a shape, from which the births leave straight.
fn spots<M: Surface + Sync>(shape: Shape<M>) -> Vec<([f64; 3], [f64; 3])> {
    births(Emitter::new(shape, 0.0))
}

/// Asserts that a share of the births is what it should be, within 3.3 standard deviations.
fn assert_share(count: usize, of: usize, share: f64, what: &str) {
    let n = of as f64;
    let deviation = (count as f64 - n * share) / (n * share * (1.0 - share)).sqrt();
    assert!(deviation.abs() < 3.3, "{what}: {} for {share}", count as f64 / n);
}

fn assert_even(cells: impl IntoIterator<Item = [f64; 2]>, what: &str) {
    let chi = chi_squared_100(cells);
    assert!(chi < CHI_99, "{what}: {chi}");
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

const CENTER: Vec3 = Vec3::new(0.5, -0.25, 2.0);

fn from_center(x: [f64; 3]) -> [f64; 3] {
    core::array::from_fn(|i| x[i] - f64s(CENTER)[i])
}

#[test]
fn sphere() {
    let spots = spots(Form::Sphere(Sphere { center: CENTER, radius: 1.5 }));
    // Archimedes: zones of equal height are equally large. In two directions, since only y is special to the engine.
    assert_even(spots.iter().map(|s| from_center(s.0)).map(|[x, y, z]| [(y / 1.5 + 1.0) / 2.0, turn(x, z)]), "about y");
    assert_even(spots.iter().map(|s| from_center(s.0)).map(|[x, y, z]| [(x / 1.5 + 1.0) / 2.0, turn(y, z)]), "about x");
    for (x, n) in spots {
        assert!(gap(from_center(x), n.map(|n| 1.5 * n)) < 2e-6);
    }
}

#[test]
fn disc() {
    // Any two vectors of the plane will do: (2, −1, 0)/√5 and (3, 6, 5)/√70 are perpendicular to (1, 2, −3).
    let spots = spots(Form::Circle(Disc { center: CENTER, normal: Vec3::new(1.0, 2.0, -3.0), radius: 0.5 }));
    let cell = |x: [f64; 3]| {
        let x = from_center(x);
        let (a, b) = (dot(x, [2.0, -1.0, 0.0]) / 5f64.sqrt(), dot(x, [3.0, 6.0, 5.0]) / 70f64.sqrt());
        [(a * a + b * b) / 0.25, turn(a, b)]
    };
    assert_even(spots.iter().map(|s| cell(s.0)), "disc");
    let d = ks(spots.iter().map(|s| cell(s.0)[0].sqrt()), |r| r.clamp(0.0, 1.0).powi(2));
    assert!(d < KS, "r = √u: {d}");
    for (x, n) in spots {
        assert!(dot(from_center(x), n).abs() < 5e-7 && (dot(n, [1.0, 2.0, -3.0]) / 14f64.sqrt() - 1.0).abs() < 1e-6);
    }
}

#[test]
fn cuboid() {
    let (min, size) = (Vec3::new(-1.0, 0.5, 2.0), [1.0, 2.0, 0.25]);
    let spots = spots(Form::Box(Cuboid { min, max: min + Vec3::from_array(size.map(|x| x as f32)) }));
    let areas = [0, 0, 1, 1, 2, 2].map(|axis| size[(axis + 1) % 3] * size[(axis + 2) % 3]);
    let all: f64 = areas.iter().sum();
    let mut faces: [Vec<[f64; 2]>; 6] = Default::default();
    for (x, n) in &spots {
        let face = (0..6).find(|&f| n[f / 2] == [-1.0, 1.0][f % 2]).expect("a normal along an axis");
        let [axis, i, j] = [0, 1, 2].map(|k| (face / 2 + k) % 3);
        let place = |k: usize| (x[k] - f64s(min)[k]) / size[k];
        assert!((place(axis) - (face % 2) as f64).abs() < 1e-6);
        faces[face].push([place(i), place(j)]);
    }
    let counts = faces.each_ref().map(|face| face.len() as u32);
    let chi = chi_squared(&counts, &areas.map(|a| a / all));
    assert!(chi < 20.5, "six faces by area: χ²(5) = {chi}");
    for (i, face) in faces.into_iter().enumerate() {
        assert_even(face, &format!("face {i}"));
    }
}

#[test]
fn cylinder() {
    let spots = spots(Form::Cylinder(Cylinder { center: CENTER, radius: 1.0, height: 2.0 }));
    let part = |n: fn(f64) -> bool| spots.iter().filter(move |s| n(s.1[1])).map(|s| from_center(s.0));
    let [top, bottom] = [part(|n| n == 1.0).count(), part(|n| n == -1.0).count()];
    assert_share(top + bottom, spots.len(), 1.0 / 3.0, "caps");
    assert_share(top, top + bottom, 0.5, "upper cap");
    assert_even(part(|n| n == 0.0).map(|[x, y, z]| [(y + 1.0) / 2.0, turn(x, z)]), "side");
    assert_even(part(|n| n == 1.0).map(|[x, _, z]| [x * x + z * z, turn(x, z)]), "upper cap");
    assert_even(part(|n| n == -1.0).map(|[x, _, z]| [x * x + z * z, turn(x, z)]), "lower cap");
    assert!(part(|n| n == 0.0).all(|[x, _, z]| (x.hypot(z) - 1.0).abs() < 1e-6));
    assert!(part(|n| n.abs() == 1.0).all(|[_, y, _]| (y.abs() - 1.0).abs() < 1e-6));
}

#[test]
fn capsule() {
    // Along any axis: here seen along y, the middle of it in the origin.
    let axis = Vec3::new(1.0, 2.0, -2.0) / 3.0;
    let (from, to) = (CENTER - axis, CENTER + axis);
    let (right, up) = pointmass::math::frame(axis);
    let spots = spots(Form::Capsule(Capsule { from, to, radius: 1.0 }));
    let seen = |v: [f64; 3]| [right, axis, up].map(|side| f64s(side).iter().zip(v).map(|(a, b)| a * b).sum::<f64>());
    let turned: Vec<_> = spots.iter().map(|s| (seen(from_center(s.0)), seen(s.1))).collect();
    let part = |n: fn(f64) -> bool| turned.iter().filter(move |s| n(s.1[1])).map(|s| s.0);
    // The side is as long as the ends are wide; between them no normal leans.
    let side = |n: f64| n.abs() < 1e-6;
    assert_share(part(side).count(), spots.len(), 0.5, "side");
    assert_even(part(side).map(|[x, y, z]| [((y + 1.0) / 2.0).clamp(0.0, 0.999_999), turn(x, z)]), "side");
    assert_even(part(|n| n > 1e-6).map(|[x, y, z]| [(y - 1.0).clamp(0.0, 0.999_999), turn(x, z)]), "upper end");
    assert_even(part(|n| n < -1e-6).map(|[x, y, z]| [(-y - 1.0).clamp(0.0, 0.999_999), turn(x, z)]), "lower end");
}

#[test]
fn cone() {
    let spots = spots(Form::Cone(Cone { center: CENTER, radius: 1.0, height: 2.0 }));
    let part = |base: bool| spots.iter().filter(move |s| (s.1[1] == -1.0) == base).map(|s| from_center(s.0));
    // R / (R + slant) = 1 / (1 + √5).
    assert_share(part(true).count(), spots.len(), 0.309_017, "base");
    assert_even(part(true).map(|[x, _, z]| [x * x + z * z, turn(x, z)]), "base");
    // The mantle is a sector: its area grows with the square of the distance from the apex.
    assert_even(part(false).map(|[x, y, z]| [((1.0 - y) / 2.0).powi(2), turn(x, z)]), "mantle");
    assert!(part(false).all(|[x, y, z]| (x.hypot(z) - (1.0 - y) / 2.0).abs() < 1e-6));
}

#[test]
fn line() {
    let (from, to) = (Vec3::new(1.0, 1.0, 0.0), Vec3::new(-1.0, 2.0, 3.0));
    let spots = spots(Form::Line(Line { from, to }));
    let along = f64s(to - from);
    // (1, 2, 0) and (−6, 3, −5) are perpendicular to (−2, 1, 3) and to each other.
    let place = |x: [f64; 3]| dot(core::array::from_fn(|i| x[i] - f64s(from)[i]), along) / dot(along, along);
    let angle = |n| turn(dot(n, [1.0, 2.0, 0.0]) / 5f64.sqrt(), dot(n, [-6.0, 3.0, -5.0]) / 70f64.sqrt());
    assert_even(spots.iter().map(|&(x, n)| [place(x), angle(n)]), "place and normal");
    let hundred = spots.iter().map(|s| place(s.0) * 10.0).map(|t| [t / 10.0, t.fract()]);
    assert_even(hundred, "100 pieces");
    assert!(spots.iter().all(|(_, n)| dot(*n, along).abs() < 2e-6 && (dot(*n, *n) - 1.0).abs() < 1e-6));
}

/// A closed mesh of triangles of very different sizes: a pulled and stretched icosahedron.
fn stretched() -> MeshBuf {
    let (vertices, triangles) = icosahedron();
    let stretch = |v: Vec3| Vec3::new(3.0 * v.x, v.y + 0.3 * v.x, 0.2 * v.z) * (1.5 + v.y);
    MeshBuf::new(vertices.into_iter().map(stretch).collect(), triangles).expect("its triangles are its own")
}

fn areas(mesh: Mesh<'_>) -> Vec<f64> {
    let area = |t: &[u32; 3]| {
        let [a, b, c] = t.map(|i| mesh.vertices()[i as usize]);
        let (b, c) = (f64s(b - a), f64s(c - a));
        // Lagrange: |b × c|² = b² c² − (b·c)².
        0.5 * (dot(b, b) * dot(c, c) - dot(b, c).powi(2)).sqrt()
    };
    mesh.triangles().iter().map(area).collect()
}

#[test]
fn mesh_by_area() {
    let mesh = stretched();
    assert_eq!(mesh.view().triangles().len(), 20);
    let areas = areas(mesh.view());
    let all: f64 = areas.iter().sum();
    let normals: Vec<_> = mesh
        .view()
        .triangles()
        .iter()
        .map(|t| {
            let [a, b, c] = t.map(|i| mesh.view().vertices()[i as usize]);
            (a, (b - a).cross(c - a).normalize())
        })
        .collect();
    let mut counts = [0; 20];
    for (x, n) in spots(Shape::Mesh(mesh.view())) {
        let off = |(corner, normal): &(Vec3, Vec3)| {
            let offset: [f64; 3] = core::array::from_fn(|i| x[i] - f64s(*corner)[i]);
            dot(offset, f64s(*normal)).abs() + gap(n, f64s(*normal))
        };
        let nearest = (0..20).min_by(|&i, &j| off(&normals[i]).total_cmp(&off(&normals[j]))).expect("there are twenty");
        assert!(off(&normals[nearest]) < 1e-5);
        counts[nearest] += 1;
    }
    let chi = chi_squared(&counts, &areas.iter().map(|a| a / all).collect::<Vec<_>>());
    assert!(chi < 43.8, "χ²(19) = {chi}");
}

/// `n` triangles beside each other along x, triangle `i` in [i, i + 1) and of area `area(i)`.
fn row_of_triangles(n: usize, area: impl Fn(usize) -> f64) -> MeshBuf {
    let corners = |i: usize| {
        let x = i as f32;
        // 0.75 wide, so that rounding does not carry a birth into the next.
        let height = (area(i) * 2.0 / 0.75) as f32;
        [Vec3::new(x, 0.0, 0.0), Vec3::new(x + 0.75, 0.0, 0.0), Vec3::new(x, 0.0, -height)]
    };
    let triangle = |i: usize| [0, 1, 2].map(|k| (3 * i + k) as u32);
    MeshBuf::new((0..n).flat_map(corners).collect(), (0..n).map(triangle).collect()).expect("it is a mesh")
}

/// Asserts that in a mesh of `n` triangles of sizes `area(i)` the births fall into 20 groups of triangles by area.
fn assert_by_area(n: usize, area: impl Fn(usize) -> f64 + Copy, group: impl Fn(usize) -> usize) {
    let mut counts = [0; 20];
    for (x, _) in spots(Shape::Mesh(row_of_triangles(n, area).view())) {
        counts[group(x[0] as usize)] += 1;
    }
    let mut shares = [0.0; 20];
    let all: f64 = (0..n).map(area).sum();
    (0..n).for_each(|i| shares[group(i)] += area(i) / all);
    let chi = chi_squared(&counts, &shares);
    assert!(chi < 43.8, "χ²(19) = {chi} for {counts:?} of {shares:?}");
}

#[test]
fn mesh_of_a_hundred_thousand_triangles() {
    // Sizes over six orders of magnitude, in a jumbled order; once by size and once by place.
    let n = 100_000;
    let rank = |i: usize| i * 61_803 % 100_000;
    let area = |i: usize| 0.1f64.powf(6.0 * rank(i) as f64 / 1e5);
    assert_by_area(n, area, |i| (rank(i) / 2000).min(19));
    assert_by_area(n, area, |i| i / 5000);
}

#[test]
fn many_tiny_triangles_beside_a_large_one_get_their_share() {
    // 99,999 of 4e-8 each beside one of 1: together 0.4 %, that is 400 births of 100,000.
    for tiny in [1e-5, 1e-6, 1e-7, 4e-8] {
        let n = 100_000;
        let area = |i: usize| if i == 777 { 1.0 } else { tiny };
        let spots = spots(Shape::Mesh(row_of_triangles(n, area).view()));
        let count = spots.iter().filter(|s| s.0[0] as usize != 777).count();
        let share = tiny * 99_999.0;
        assert_share(count, spots.len(), share / (1.0 + share), &format!("all triangles of {tiny}"));
    }
}

#[test]
fn triangle() {
    let corners = [Vec3::new(1.0, 0.0, 1.0), Vec3::new(3.0, 0.5, 0.0), Vec3::new(0.0, 2.0, -1.0)];
    let mesh = MeshBuf::new(corners.to_vec(), vec![[0, 1, 2]]).expect("a triangle is a mesh");
    let spots = spots(Shape::Mesh(mesh.view()));
    // Cramer's rule for x = a + v (b − a) + w (c − a), in the normal equations.
    let [a, e, f] = [f64s(corners[0]), f64s(corners[1] - corners[0]), f64s(corners[2] - corners[0])];
    let weights = |x: [f64; 3]| {
        let x: [f64; 3] = core::array::from_fn(|i| x[i] - a[i]);
        let (ee, ef, ff, xe, xf) = (dot(e, e), dot(e, f), dot(f, f), dot(x, e), dot(x, f));
        let d = ee * ff - ef * ef;
        let (v, w) = ((xe * ff - xf * ef) / d, (xf * ee - xe * ef) / d);
        [1.0 - v - w, v, w]
    };
    let all: Vec<[f64; 3]> = spots.iter().map(|s| weights(s.0)).collect();
    let n = all.len() as f64;
    for k in 0..3 {
        let mean = all.iter().map(|w| w[k]).sum::<f64>() / n;
        let square = all.iter().map(|w| (w[k] - 1.0 / 3.0).powi(2)).collect::<Vec<_>>();
        let variance = square.iter().sum::<f64>() / n;
        // The fourth central moment of a weight is 1/135, so that of its square about the variance is 1/135 − 1/324.
        assert!((mean - 1.0 / 3.0).abs() < 3.3 * (1.0 / 18.0 / n).sqrt(), "mean {mean}");
        assert!((variance - 1.0 / 18.0).abs() < 3.3 * ((1.0 / 135.0 - 1.0 / 324.0) / n).sqrt(), "variance {variance}");
        assert!(all.iter().all(|w| w[k] > -1e-6));
    }
    // 100 equal triangles: in tenths of two sides, each small parallelogram halved.
    let cell = |[_, v, w]: [f64; 3]| {
        let (i, j) = ((v * 10.0).floor(), (w * 10.0).floor());
        let upper = v * 10.0 - i + w * 10.0 - j > 1.0;
        // Row i holds 10 − i lower and 9 − i upper triangles, 100 − (10 − i)² before it.
        let number = 100.0 - (10.0 - i) * (10.0 - i) + 2.0 * j + if upper { 1.0 } else { 0.0 };
        number.clamp(0.0, 99.0)
    };
    assert_even(all.iter().map(|&w| cell(w) / 100.0 + 0.005).map(|t| [t, (t * 10.0).fract()]), "hundred triangles");
}

/// Angles to `axis` and turns about it.
fn angles(spread: Spread, axis: Vec3) -> Vec<(f64, f64)> {
    let n = f64s(axis.normalize());
    let emitter = Emitter { direction: Some(axis), spread, ..Emitter::new(point(Vec3::ZERO), 0.0) };
    let (a, b) = axis.normalize().any_orthonormal_pair();
    let angle = |d: [f64; 3]| {
        let across: [f64; 3] = core::array::from_fn(|i| d[i] - dot(d, n) * n[i]);
        (dot(across, across).sqrt().atan2(dot(d, n)), turn(dot(d, f64s(a)), dot(d, f64s(b))))
    };
    births(emitter).into_iter().map(|(_, d)| angle(d)).collect()
}

const AXES: [Vec3; 4] = [Vec3::Y, Vec3::NEG_Z, Vec3::new(1.0, -2.0, 0.5), Vec3::new(1e-4, 0.0, -1.0)];

#[test]
fn directions_uniform_in_solid_angle() {
    for axis in AXES {
        for cutoff in [0.1, FRAC_PI_4, FRAC_PI_2, 2.5, PI] {
            let angles = angles(Spread::Uniform(cutoff as f32), axis);
            let d = ks(angles.iter().map(|a| a.0), |a| ((1.0 - a.cos()) / (1.0 - cutoff.cos())).clamp(0.0, 1.0));
            assert!(d < KS, "{cutoff} about {axis}: {d}");
            assert!(angles.iter().all(|a| a.0 < cutoff + 1e-6));
            assert_even(angles.iter().map(|&(a, t)| [(1.0 - a.cos()) / (1.0 - cutoff.cos()), t]), "angle and turn");
        }
    }
}

#[test]
fn directions_by_the_lecture() {
    for axis in AXES {
        for cutoff in [0.1, FRAC_PI_4, FRAC_PI_2] {
            let angles = angles(Spread::Lecture(cutoff as f32), axis);
            // The density cos α / sin c, integrated.
            let d = ks(angles.iter().map(|a| a.0), |a| (a.sin() / cutoff.sin()).clamp(0.0, 1.0));
            assert!(d < KS, "{cutoff} about {axis}: {d}");
            assert!(angles.iter().all(|a| a.0 < cutoff + 1e-6));
            assert_even(angles.iter().map(|&(a, t)| [a.sin() / cutoff.sin(), t]), "angle and turn");
        }
    }
}

#[test]
fn the_two_laws_differ_in_their_mean_angle() {
    let mean = |spread| {
        let angles = angles(spread, Vec3::Y);
        angles.iter().map(|a| a.0.to_degrees()).sum::<f64>() / angles.len() as f64
    };
    // π/2 − 1 and 1 rad; a standard deviation of at most 23° leaves 0.24° at 100,000 births.
    let tolerance = 3.3 * 23.0 / (often(100_000) as f64).sqrt();
    assert!((mean(Spread::Lecture(FRAC_PI_2 as f32)) - 32.704).abs() < tolerance);
    assert!((mean(Spread::Uniform(FRAC_PI_2 as f32)) - 57.296).abs() < tolerance);
}

#[test]
fn places_and_directions_are_independent() {
    let emitter = Emitter {
        direction: Some(Vec3::X),
        spread: Spread::Uniform(PI as f32),
        ..Emitter::new(Form::Sphere(Sphere { center: Vec3::ZERO, radius: 1.0 }), 0.0)
    };
    let births = births(emitter);
    for i in 0..3 {
        for j in 0..3 {
            assert_even(births.iter().map(|(x, d)| [(x[i] + 1.0) / 2.0, (d[j] + 1.0) / 2.0]), "place and direction");
        }
    }
}

#[test]
fn without_a_spread_births_leave_along_the_normal_or_the_direction() {
    let sphere = || Form::Sphere(Sphere { center: Vec3::ZERO, radius: 1.0 });
    for (x, d) in births(Emitter::new(sphere(), 0.0)) {
        assert!(gap(x, d) < 1e-6);
    }
    for (_, d) in births(Emitter { direction: Some(Vec3::new(0.0, 3.0, 4.0)), ..Emitter::new(sphere(), 0.0) }) {
        assert!(gap(d, [0.0, 0.6, 0.8]) < 1e-6);
    }
}

#[test]
fn the_random_numbers_here_are_sound() {
    let mut random = Random::new(0);
    assert_even((0..100_000).map(|_| [random.unit(), random.unit()].map(f64::from)), "pairs");
}
