//! `sinks` of the course: whatever is removed touched a sink in that step, and nothing passes through one.

use crate::course::{begun, load};
use pointmass::scene::{Model, Solid};
use pointmass::shape::{MeshBuf, Shape};
use pointmass::{Heap, Scene, System, Time, Vec3};
use std::collections::BTreeMap;
use std::sync::Arc;

type P = [f64; 3];

fn p(v: Vec3) -> P {
    v.to_array().map(f64::from)
}

fn sub(a: P, b: P) -> P {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

fn dot(a: P, b: P) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn length(a: P) -> f64 {
    dot(a, a).sqrt()
}

/// The point that is a + s (b − a).
fn mix(a: P, b: P, s: f64) -> P {
    [0, 1, 2].map(|i| a[i] + s * (b[i] - a[i]))
}

fn to_segment(x: P, a: P, b: P) -> f64 {
    let along = sub(b, a);
    let s = (dot(sub(x, a), along) / dot(along, along)).clamp(0.0, 1.0);
    length(sub(x, mix(a, b, s)))
}

fn to_triangle(x: P, [a, b, c]: [P; 3]) -> f64 {
    let (ab, ac, ax) = (sub(b, a), sub(c, a), sub(x, a));
    let (aa, bb, cc) = (dot(ab, ab), dot(ac, ac), dot(ab, ac));
    let determinant = aa * bb - cc * cc;
    let (u, v) = (dot(ax, ab), dot(ax, ac));
    let (s, t) = ((bb * u - cc * v) / determinant, (aa * v - cc * u) / determinant);
    if s >= 0.0 && t >= 0.0 && s + t <= 1.0 {
        return length([0, 1, 2].map(|i| ax[i] - s * ab[i] - t * ac[i]));
    }
    to_segment(x, a, b).min(to_segment(x, b, c)).min(to_segment(x, c, a))
}

/// The distance to a surface, negative inside of what is closed: worked out here from the definition of each shape.
fn signed_distance(x: P, shape: &Shape<Arc<MeshBuf>>) -> f64 {
    match shape {
        Shape::Line(line) => to_segment(x, p(line.from), p(line.to)),
        Shape::Box(cube) => {
            let (a, b) = (p(cube.min), p(cube.max));
            let out: P = [0, 1, 2].map(|i| (a[i].min(b[i]) - x[i]).max(x[i] - a[i].max(b[i])));
            let deepest = out.into_iter().fold(f64::NEG_INFINITY, f64::max);
            if deepest <= 0.0 { deepest } else { length(out.map(|d| d.max(0.0))) }
        }
        Shape::Capsule(pill) => to_segment(x, p(pill.from), p(pill.to)) - f64::from(pill.radius),
        Shape::Sphere(ball) => length(sub(x, p(ball.center))) - f64::from(ball.radius),
        Shape::Cylinder(can) => {
            let [x, y, z] = sub(x, p(can.center));
            let (out, up) = (x.hypot(z) - f64::from(can.radius), y.abs() - f64::from(can.height) / 2.0);
            if out.max(up) <= 0.0 { out.max(up) } else { out.max(0.0).hypot(up.max(0.0)) }
        }
        Shape::Cone(cone) => {
            let [x, y, z] = sub(x, p(cone.center));
            let (radius, half) = (f64::from(cone.radius), f64::from(cone.height) / 2.0);
            let x = [x.hypot(z), y, 0.0];
            let (middle, rim, apex) = ([0.0, -half, 0.0], [radius, -half, 0.0], [0.0, half, 0.0]);
            let distance = to_segment(x, middle, rim).min(to_segment(x, rim, apex));
            let inside = x[1] > -half && x[0] < radius * (half - x[1]) / (2.0 * half);
            if inside { -distance } else { distance }
        }
        Shape::Circle(disc) => {
            let from = sub(x, p(disc.center));
            let normal = p(disc.normal);
            let up = dot(from, normal) / length(normal);
            let out = (dot(from, from) - up * up).max(0.0).sqrt() - f64::from(disc.radius);
            out.max(0.0).hypot(up)
        }
        Shape::Mesh(mesh) => {
            let corner = |i: u32| p(mesh.view().vertices()[i as usize]);
            let faces = mesh.view().triangles().iter().map(|t| t.map(corner));
            let distance = faces.clone().map(|face| to_triangle(x, face)).fold(f64::INFINITY, f64::min);
            // The mesh of the course is convex and holds the origin.
            let inside = faces.into_iter().all(|[a, b, c]| {
                let (u, v) = (sub(b, a), sub(c, a));
                let normal = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]];
                dot(normal, sub(x, a)) * dot(normal, a) < 0.0
            });
            if inside { -distance } else { distance }
        }
        Shape::Triangle(_) | Shape::Plane(_) | Shape::HeightField(_) => panic!("the course has no such sink"),
    }
}

/// Whether a surface has an inside.
fn is_closed(shape: &Shape<Arc<MeshBuf>>) -> bool {
    !matches!(shape, Shape::Line(_) | Shape::Circle(_))
}

/// How a particle moves in a step: places and velocities at its ends.
#[derive(Clone, Copy, Debug)]
struct Path {
    x: [P; 2],
    v: [P; 2],
    dt: f64,
}

impl Path {
    /// Hermite's cubic, the definition of a path.
    fn at(&self, s: f64) -> P {
        let ([x0, x1], [v0, v1]) = (self.x, self.v);
        let (s2, s3) = (s * s, s * s * s);
        let (a, b) = (1.0 - 3.0 * s2 + 2.0 * s3, 3.0 * s2 - 2.0 * s3);
        let (c, d) = ((s - 2.0 * s2 + s3) * self.dt, (s3 - s2) * self.dt);
        [0, 1, 2].map(|i| a * x0[i] + b * x1[i] + c * v0[i] + d * v1[i])
    }

    /// The smallest distance to a surface, and how far that may be from the true one: paths are followed along at
    /// most eight chords that stray by 1e-4 m if they can, and looked at here in 512 places.
    fn nearest(&self, shape: &Shape<Arc<MeshBuf>>) -> (f64, f64) {
        const PLACES: usize = 512;
        let places: Vec<P> = (0..=PLACES).map(|i| self.at(i as f64 / PLACES as f64)).collect();
        let nearest = places.iter().map(|&x| signed_distance(x, shape).abs()).fold(f64::INFINITY, f64::min);
        let spacing = places.windows(2).map(|pair| length(sub(pair[1], pair[0]))).fold(0.0, f64::max);
        let eighth = PLACES / 8;
        let stray = (0..8).map(|i| {
            let [a, b] = [i * eighth, (i + 1) * eighth].map(|i| places[i]);
            (1..eighth)
                .map(|j| length(sub(places[i * eighth + j], mix(a, b, j as f64 / eighth as f64))))
                .fold(0.0, f64::max)
        });
        (nearest, 1e-4 + 0.5 * spacing + stray.fold(0.0, f64::max))
    }
}

/// Places and velocities by id.
fn states(system: &System<Heap>) -> BTreeMap<u32, (P, P)> {
    let particles = system.particles();
    let rows = particles.serial.iter().zip(particles.position.iter().zip(particles.velocity));
    rows.map(|(&id, (&x, &v))| (id, (p(x), p(v)))).collect()
}

/// Steps a system and tells the paths of the survivors and of those removed.
fn step(system: &mut System<Heap>, model: &Model, dt: Time) -> [Vec<Path>; 2] {
    let before = states(system);
    // What the same step comes to if nothing is removed.
    let mut free = system.clone();
    free.step(&Scene { sinks: &(), ..model.scene() }, dt);
    system.step(&model.scene(), dt);
    let (unhindered, after) = (states(&free), states(system));
    let mut paths = [Vec::new(), Vec::new()];
    for (id, &(x1, v1)) in &unhindered {
        // The newborn have not moved: their source gives them no speed.
        let (x0, v0) = before.get(id).copied().unwrap_or((x1, v1));
        paths[usize::from(!after.contains_key(id))].push(Path {
            x: [x0, x1],
            v: [v0, v1],
            dt: f64::from(dt.seconds()),
        });
    }
    assert!(after.keys().all(|id| unhindered.contains_key(id)));
    paths
}

#[test]
fn what_is_removed_touched_a_sink_in_that_step_and_nothing_else_did() {
    let Some((_, model)) = load("sinks") else { return };
    let sinks = &model.forces.1;
    assert_eq!(sinks.len(), 7);
    // Seconds are what it takes to reach the sinks: debug builds make longer steps instead.
    let per_second = if cfg!(debug_assertions) { 15 } else { 60 };
    let mut system = begun(&model, 400);
    let mut taken = [0; 7];
    let (mut removed, mut precise) = (0, 0);
    for frame in 1..=30 * per_second {
        let dt = Time::frame(frame, per_second as u32) - system.time();
        let [survivors, gone] = step(&mut system, &model, dt);
        for path in &gone {
            removed += 1;
            let near: Vec<_> = sinks.iter().map(|sink| path.nearest(&sink.shape)).collect();
            let touched = near.iter().position(|(distance, room)| distance <= room);
            let Some(which) = touched else {
                panic!("removed in frame {frame} without touching a sink: {path:?} {near:?}")
            };
            taken[which] += 1;
            precise += usize::from(near[which].1 < 0.02);
        }
        for path in &survivors {
            for sink in sinks.iter().filter(|sink| is_closed(&sink.shape)) {
                let [from, to] = path.x.map(|x| signed_distance(x, &sink.shape));
                assert!(
                    from >= -1e-5 && to >= -1e-5,
                    "inside of a sink, alive, after frame {frame}: {path:?} {from} {to}"
                );
            }
        }
    }
    assert_eq!(system.totals().died.sink, removed as u64);
    assert_eq!(system.totals().died.total(), removed as u64);
    assert!(removed > 50, "too few to show anything: {removed}");
    assert!(precise * 2 > removed, "only {precise} of {removed} are known to 2 cm");
    println!("{removed} removed, {precise} of them known to 2 cm; by sink {taken:?}");
}

#[test]
fn distances_are_right() {
    let Some((_, model)) = load("sinks") else { return };
    // Against the engine's own nearest point, which is written in quite another way.
    use pointmass::shape::Surface;
    for sink in &model.forces.1 {
        for i in 0..2000u32 {
            let x = [1664525u32, 22695477, 134775813].map(|k| (i.wrapping_mul(k) >> 8) as f32 / 8_388_608.0 - 1.0);
            let x = Vec3::from(x) * 6.0;
            let near = f64::from((sink.shape.nearest(x) - x).length());
            let own = signed_distance(p(x), &sink.shape).abs();
            assert!((near - own).abs() < 1e-4, "{:?} {x}: {near} {own}", sink.shape);
        }
    }
    let _: &Vec<Solid> = &model.scenery;
}
