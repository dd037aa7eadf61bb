//! Parts that the suites share: random numbers that owe nothing to the engine's, statistics, and runs.

pub mod busy;
pub mod emitting;
pub mod fields;
pub mod needles;
pub mod points;
pub mod solids;
pub mod surfaces;

use core::ops::Range;
use pointmass::force::{Perturbation, State};
use pointmass::index::Structure;
use pointmass::shape::{Line, Mesh, Shape};
use pointmass::{Force, Heap, Integrator, Method, Particle, Scene, Size, System, Time, Vec3};

/// Standard gravity \[m/s²\].
pub const G: f64 = 9.80665;

/// A shape whose mesh, if it is one, is borrowed for ever.
pub type Form = Shape<Mesh<'static>>;

/// A point as a shape: a line without length.
#[must_use]
pub const fn point(at: Vec3) -> Form {
    Shape::Line(Line { from: at, to: at })
}

/// How often to repeat something: `n` times, a tenth of that in debug builds.
#[must_use]
pub const fn often(n: usize) -> usize {
    if cfg!(debug_assertions) { n.div_ceil(10) } else { n }
}

/// Tells whether to run the next case of many: each of them, in debug builds every sixth, each time another one of an innermost loop of as many.
#[must_use]
pub const fn is_run(cases: &mut usize) -> bool {
    is_one_of(6, cases)
}

/// The same where cases are fewer: in debug builds it is every third.
#[must_use]
pub const fn is_third(cases: &mut usize) -> bool {
    is_one_of(3, cases)
}

const fn is_one_of(n: usize, cases: &mut usize) -> bool {
    let case = *cases;
    *cases += 1;
    !cfg!(debug_assertions) || (case + case / n).is_multiple_of(n)
}

/// How far it is from a case to the next that runs: `n` in debug builds, otherwise one.
#[must_use]
pub const fn every(n: usize) -> usize {
    if cfg!(debug_assertions) { n } else { 1 }
}

/// All methods; in debug builds every third, and others in the next round.
pub fn methods(round: usize) -> impl Iterator<Item = Method> {
    Method::ALL.iter().copied().skip(round % every(3)).step_by(every(3))
}

/// The structures to try in the `i`th of some cases: all in two of them, in debug builds one in each.
#[must_use]
pub fn structures(i: usize) -> &'static [Structure] {
    let all = Structure::ALL;
    if cfg!(debug_assertions) { &all[i % all.len()..=i % all.len()] } else { &all[..if i < 2 { all.len() } else { 1 }] }
}

/// A system on the heap that has started `scene`, with room for `capacity` particles.
///
/// # Panics
/// Never: the memory is made for the scene.
#[must_use]
pub fn started(scene: &Scene<'_>, capacity: usize, seed: u64) -> System<Heap> {
    let mut system = System::with(Heap::new(Size { particles: capacity, ..scene.size() }));
    system.start(scene, seed).expect("the memory is made for the scene");
    system
}

/// Steps `n` times, the i-th step ending at i × `h` seconds to the nearest tick; begins at time zero.
pub fn run(system: &mut System<Heap>, scene: &Scene<'_>, h: f64, n: u32) {
    for i in 1..=n {
        system.step(scene, Time::from_seconds_f64(h * f64::from(i)) - system.time());
    }
}

/// A vector in double precision.
#[must_use]
pub fn f64s(v: Vec3) -> [f64; 3] {
    v.to_array().map(f64::from)
}

/// Length of a difference, in double precision.
#[must_use]
pub fn gap(a: [f64; 3], b: [f64; 3]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b) * (a - b)).sum::<f64>().sqrt()
}

/// A force along x alone, told as the acceleration at a time \[s\], place \[m\] and speed \[m/s\].
#[derive(Clone, Copy, Debug)]
pub struct Law<F>(pub F);

impl<F: Fn(f32, f32, f32) -> f32 + Sync> Force for Law<F> {
    fn add_to(&self, state: &State<'_>, rows: Range<usize>, total: &mut [Vec3]) {
        for (total, row) in total.iter_mut().zip(rows) {
            let (t, x, v) = (state.time.seconds(), state.position[row].x, state.velocity[row].x);
            total.x += state.mass[row] * (self.0)(t, x, v);
        }
    }

    /// By central differences.
    fn add_jacobian(&self, state: &State<'_>, change: &Perturbation<'_>, total: &mut [Vec3]) {
        const D: f32 = 1.0 / 128.0;
        for (row, total) in total.iter_mut().enumerate() {
            let (t, x, v) = (state.time.seconds(), state.position[row].x, state.velocity[row].x);
            let by_x = ((self.0)(t, x + D, v) - (self.0)(t, x - D, v)) / (2.0 * D);
            let by_v = ((self.0)(t, x, v + D) - (self.0)(t, x, v - D)) / (2.0 * D);
            total.x += state.mass[row] * (by_x * change.position + by_v * change.velocity) * change.along[row].x;
        }
    }
}

/// Place and speed along x after `n` steps of `h` under `force`, from `x` and `v`.
#[must_use]
pub fn follow(integrator: impl Integrator, force: &dyn Force, [x, v]: [f64; 2], h: f64, n: u32) -> [f64; 2] {
    let start = [Particle { position: Vec3::X * x as f32, velocity: Vec3::X * v as f32, drag: 1.0, ..Particle::REST }];
    let scene = Scene { start: &start, forces: force, integrator: &integrator, ..Scene::EMPTY };
    let mut system = started(&scene, 1, 0);
    run(&mut system, &scene, h, n);
    let particles = system.particles();
    match particles.position {
        [x] => [f64::from(x.x), f64::from(particles.velocity[0].x)],
        _ => [f64::INFINITY; 2],
    }
}

/// Random numbers: SplitMix64 (Steele, Lea, Flood, "Fast Splittable Pseudorandom Number Generators", OOPSLA 2014).
#[derive(Clone, Debug)]
pub struct Random(u64);

impl Random {
    /// A sequence of its own for each seed.
    #[must_use]
    pub const fn new(seed: u64) -> Self {
        Self(seed)
    }

    /// 64 bits.
    pub const fn word(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// Uniform in [0, 1).
    pub fn unit(&mut self) -> f32 {
        (self.word() >> 40) as f32 / 16_777_216.0
    }

    /// Uniform in [`low`, `high`).
    pub fn between(&mut self, low: f32, high: f32) -> f32 {
        low + (high - low) * self.unit()
    }

    /// Between `low` and `high`, its logarithm uniform.
    pub fn magnitude(&mut self, low: f32, high: f32) -> f32 {
        low * (high / low).powf(self.unit())
    }

    /// Uniform in the cube of half side `half`.
    pub fn vector(&mut self, half: f32) -> Vec3 {
        Vec3::from_array(core::array::from_fn(|_| self.between(-half, half)))
    }

    /// A uniform direction.
    pub fn direction(&mut self) -> Vec3 {
        loop {
            let v = self.vector(1.0);
            let square = v.dot(v);
            if (0.01..1.0).contains(&square) {
                return v / square.sqrt();
            }
        }
    }
}

/// Kolmogorov and Smirnov's D √n against a distribution function: above 1.95 once in a thousand times if it is right.
#[must_use]
pub fn ks(values: impl IntoIterator<Item = f64>, cdf: impl Fn(f64) -> f64) -> f64 {
    let mut values: Vec<f64> = values.into_iter().collect();
    values.sort_by(f64::total_cmp);
    let n = values.len() as f64;
    let gap = |(i, &x): (usize, &f64)| {
        let p = cdf(x);
        (p - i as f64 / n).abs().max((p - (i + 1) as f64 / n).abs())
    };
    values.iter().enumerate().map(gap).fold(0.0, f64::max) * n.sqrt()
}

/// The limit of `ks` at one error in a thousand.
pub const KS: f64 = 1.95;

/// Pearson's χ² of counts against shares of the whole.
#[must_use]
pub fn chi_squared(counts: &[u32], shares: &[f64]) -> f64 {
    assert_eq!(counts.len(), shares.len());
    let all: f64 = counts.iter().copied().map(f64::from).sum();
    counts.iter().zip(shares).map(|(&n, share)| (f64::from(n) - all * share).powi(2) / (all * share)).sum()
}

/// χ² of 10 × 10 cells that should hold equally many; both coordinates are in [0, 1). Above 148.2 once in a thousand
/// times if they do.
#[must_use]
pub fn chi_squared_100(places: impl IntoIterator<Item = [f64; 2]>) -> f64 {
    let mut cells = [0; 100];
    for [u, v] in places {
        let cell = |x: f64| ((x * 10.0) as usize).min(9);
        cells[10 * cell(u) + cell(v)] += 1;
    }
    chi_squared(&cells, &[0.01; 100])
}

/// The limit of `chi_squared_100` at one error in a thousand.
pub const CHI_99: f64 = 148.2;

/// The angle of (x, y) as a part of a turn, in [0, 1).
#[must_use]
pub fn turn(x: f64, y: f64) -> f64 {
    (y.atan2(x) / core::f64::consts::TAU).rem_euclid(1.0)
}

/// The slope of the line that fits the logarithms of `errors` over those of `steps`: a method's order.
#[must_use]
pub fn order(steps: &[f64], errors: &[f64]) -> f64 {
    let n = steps.len() as f64;
    let mean = |values: &[f64]| values.iter().map(|x| x.ln()).sum::<f64>() / n;
    let (mx, my) = (mean(steps), mean(errors));
    let part = |(x, y): (&f64, &f64)| ((x.ln() - mx) * (y.ln() - my), (x.ln() - mx).powi(2));
    let (xy, xx) = steps.iter().zip(errors).map(part).fold((0.0, 0.0), |a, b| (a.0 + b.0, a.1 + b.1));
    xy / xx
}

/// The vertices, at distance 1 from the origin, and the triangles of a regular icosahedron, seen from outside
/// anticlockwise.
#[must_use]
pub fn icosahedron() -> (Vec<Vec3>, Vec<[u32; 3]>) {
    let phi = f32::midpoint(1.0, 5f32.sqrt());
    let mut vertices = vec![];
    for (a, b) in [(1.0, phi), (-1.0, phi), (1.0, -phi), (-1.0, -phi)] {
        vertices.extend([Vec3::new(0.0, a, b), Vec3::new(a, b, 0.0), Vec3::new(b, 0.0, a)]);
    }
    let near = |i: u32, j: u32| (vertices[i as usize].distance(vertices[j as usize]) - 2.0).abs() < 1e-3;
    let mut triangles = vec![];
    for i in 0..12 {
        for j in i + 1..12 {
            for k in j + 1..12 {
                if near(i, j) && near(j, k) && near(k, i) {
                    let [a, b, c] = [i, j, k].map(|i| vertices[i as usize]);
                    let outward = (b - a).cross(c - a).dot(a) > 0.0;
                    triangles.push(if outward { [i, j, k] } else { [i, k, j] });
                }
            }
        }
    }
    (vertices.into_iter().map(Vec3::normalize).collect(), triangles)
}

/// The README's examples have to compile and run.
#[cfg(doctest)]
#[doc = include_str!("../../README.md")]
struct Readme;
