//! How far a point is from a surface, in double precision, and when a ball first touches it: oracles for sweeps.

use crate::{Form, Random, f64s, gap};
use pointmass::Vec3;
use pointmass::shape::{Capsule, Cone, Cuboid, Cylinder, Disc, Line, Plane, Sphere, Triangle};

/// A vector in double precision.
pub type Vec = [f64; 3];

/// A sum of a vector and a multiple of another.
#[must_use]
pub fn plus(a: Vec, b: Vec, t: f64) -> Vec {
    core::array::from_fn(|i| a[i] + b[i] * t)
}

/// The difference.
#[must_use]
pub fn minus(a: Vec, b: Vec) -> Vec {
    plus(a, b, -1.0)
}

/// The scalar product.
#[must_use]
pub fn dot(a: Vec, b: Vec) -> f64 {
    (0..3).map(|i| a[i] * b[i]).sum()
}

/// The vector product.
#[must_use]
pub fn cross(a: Vec, b: Vec) -> Vec {
    core::array::from_fn(|i| a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3])
}

/// Over its length.
#[must_use]
pub fn unit(a: Vec) -> Vec {
    a.map(|x| x / gap(a, [0.0; 3]))
}

/// From a point to a straight line between two others.
#[must_use]
pub fn to_line(x: Vec, a: Vec, b: Vec) -> f64 {
    let along = minus(b, a);
    let square = dot(along, along);
    let t = if square > 0.0 { (dot(minus(x, a), along) / square).clamp(0.0, 1.0) } else { 0.0 };
    gap(x, plus(a, along, t))
}

/// From a point to a triangle.
#[must_use]
pub fn to_triangle(x: Vec, corners: [Vec; 3]) -> f64 {
    let [a, b, c] = corners;
    let normal = cross(minus(b, a), minus(c, a));
    let is_beside = |a: Vec, b: Vec| dot(cross(minus(b, a), minus(x, a)), normal) < 0.0;
    if normal == [0.0; 3] || is_beside(a, b) || is_beside(b, c) || is_beside(c, a) {
        return to_line(x, a, b).min(to_line(x, b, c)).min(to_line(x, c, a));
    }
    dot(minus(x, a), unit(normal)).abs()
}

/// From a point to the surface that a profile in the plane of (radius, height) sweeps about the y axis.
fn to_swept(x: Vec, center: Vec3, profile: &[[f64; 2]]) -> f64 {
    let x = minus(x, f64s(center));
    let x = [x[0].hypot(x[2]), x[1], 0.0];
    let ends = profile.windows(2).map(|e| to_line(x, [e[0][0], e[0][1], 0.0], [e[1][0], e[1][1], 0.0]));
    ends.fold(f64::INFINITY, f64::min)
}

/// From a point to the surface \[m\], never below zero.
///
/// # Panics
/// If it is a mesh or the like, for which there are its triangles.
#[must_use]
pub fn distance(form: &Form, x: Vec) -> f64 {
    match form {
        Form::Line(Line { from, to }) => to_line(x, f64s(*from), f64s(*to)),
        Form::Box(Cuboid { min, max }) => {
            let [low, high] = [min.min(*max), min.max(*max)].map(f64s);
            let out: Vec = core::array::from_fn(|i| (low[i] - x[i]).max(x[i] - high[i]));
            let deepest = out.iter().copied().fold(f64::NEG_INFINITY, f64::max);
            if deepest < 0.0 { -deepest } else { gap(out.map(|d| d.max(0.0)), [0.0; 3]) }
        }
        Form::Circle(Disc { center, normal, radius }) => {
            let (offset, normal) = (minus(x, f64s(*center)), unit(f64s(*normal)));
            let height = dot(offset, normal);
            let out = gap(plus(offset, normal, -height), [0.0; 3]);
            height.hypot((out - f64::from(*radius)).max(0.0))
        }
        Form::Sphere(Sphere { center, radius }) => (gap(x, f64s(*center)) - f64::from(*radius)).abs(),
        Form::Cylinder(Cylinder { center, radius, height }) => {
            let [r, h] = [*radius, *height].map(f64::from);
            to_swept(x, *center, &[[0.0, -h / 2.0], [r, -h / 2.0], [r, h / 2.0], [0.0, h / 2.0]])
        }
        Form::Cone(Cone { center, radius, height }) => {
            let [r, h] = [*radius, *height].map(f64::from);
            to_swept(x, *center, &[[0.0, -h / 2.0], [r, -h / 2.0], [0.0, h / 2.0]])
        }
        Form::Capsule(Capsule { from, to, radius }) => (to_line(x, f64s(*from), f64s(*to)) - f64::from(*radius)).abs(),
        Form::Triangle(Triangle { corners }) => to_triangle(x, corners.map(f64s)),
        Form::Plane(Plane { point, normal }) => dot(minus(x, f64s(*point)), unit(f64s(*normal))).abs(),
        _ => panic!("a mesh is its triangles"),
    }
}

/// When a ball on a straight way first touches a surface, as a share of the way: it goes forward by as much as is surely
/// free until nothing is left of that. Also how near it comes at the least, over and above its radius \[m\].
#[must_use]
pub fn first_touch(distance: impl Fn(Vec) -> f64, from: Vec, to: Vec, radius: f64) -> (Option<f64>, f64) {
    let (step, length) = (minus(to, from), gap(to, from));
    let (mut way, mut least) = (0.0, f64::INFINITY);
    for _ in 0..100_000 {
        let left = distance(plus(from, step, way / length)) - radius;
        least = least.min(left);
        if left < 1e-12 {
            return (Some(way / length), least);
        }
        way += left;
        if way > length {
            return (None, least.min(distance(to) - radius));
        }
    }
    (Some(way / length), least)
}

/// Shapes that a ball may meet: small, thin, far from the origin and of all kinds.
#[must_use]
pub fn forms() -> [Form; 17] {
    let center = Vec3::new(0.3, -0.2, 0.5);
    let far = Vec3::new(100.0, -70.0, 40.0);
    let triangle = |at: Vec3, a: Vec3, b: Vec3| Form::Triangle(Triangle { corners: [at, at + a, at + b] });
    [
        Form::Box(Cuboid { min: Vec3::new(-0.5, -0.4, -0.3), max: Vec3::new(0.6, 0.7, 0.9) }),
        Form::Box(Cuboid { min: Vec3::new(-1.0, 0.1, -1.0), max: Vec3::new(1.0, 0.101, 1.0) }),
        Form::Box(Cuboid { min: far, max: far + Vec3::new(1.0, 2.0, -0.5) }),
        Form::Sphere(Sphere { center, radius: 0.7 }),
        Form::Sphere(Sphere { center: far, radius: 0.7 }),
        Form::Cylinder(Cylinder { center, radius: 0.5, height: 1.2 }),
        Form::Cylinder(Cylinder { center, radius: 0.9, height: 0.001 }),
        Form::Cone(Cone { center, radius: 0.6, height: 1.1 }),
        Form::Cone(Cone { center: far, radius: 0.6, height: 0.4 }),
        Form::Capsule(Capsule { from: center, to: Vec3::new(-0.5, 0.6, 0.1), radius: 0.4 }),
        Form::Capsule(Capsule { from: far, to: far + Vec3::new(0.0, 2.0, 0.001), radius: 0.02 }),
        Form::Capsule(Capsule { from: center, to: center, radius: 0.5 }),
        Form::Circle(Disc { center, normal: Vec3::new(1.0, 2.0, -3.0), radius: 0.8 }),
        triangle(center, Vec3::new(1.0, 0.2, -0.1), Vec3::new(0.3, 0.9, 0.8)),
        triangle(far, Vec3::new(2.0, 0.0, 0.01), Vec3::new(1.0, 0.02, 0.0)),
        Form::Plane(Plane { point: center, normal: Vec3::new(-1.0, 2.0, 0.5) }),
        Form::Line(Line { from: center, to: Vec3::new(-0.5, 0.3, 0.2) }),
    ]
}

/// A place near a shape, and how large coordinates there are \[m\].
pub fn near(form: &Form, random: &mut Random) -> (Vec3, f32) {
    use pointmass::shape::Surface;
    let middle = match form {
        Form::Plane(plane) => plane.point,
        other => other.bounds().center(),
    };
    (middle + random.vector(1.5), middle.abs().max_element() + 1.5)
}
