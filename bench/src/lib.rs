//! Means of the benches to measure with: systems of a given size, and a hand-written loop to hold them against.

pub mod dice;
pub mod drop;
pub mod neighbours;

use pointmass::rng::Stream;
use pointmass::shape::{Disc, Mesh, Shape};
use pointmass::{Emitter, Heap, Particle, Scene, Spread, System, Time, Varied, Vec3};
use std::time::Instant;

/// Steps of [`FRAME`] after which as many of a [`high_jet`] die as are born.
pub const FILLING: usize = 360;

/// `n` particles of 1 kg with drag 0.1 kg/s, spread over a cube of 2 m with speeds up to 1 m/s.
#[must_use]
pub fn cloud(n: u32) -> Vec<Particle> {
    let at = |i: u32, place: u32| {
        let [x, y] = Stream::new(1, 0, i).units(place);
        let [z, _] = Stream::new(1, 0, i).units(place + 1);
        Vec3::new(x, y, z) * 2.0 - 1.0
    };
    let particle = |i| Particle { position: at(i, 0), velocity: at(i, 2), drag: 0.1, ..Particle::REST };
    (0..n).map(particle).collect()
}

/// A system started with a scene, with room for `capacity` particles, in memory as the program and the npm package take it: what all have in
/// common is there once.
///
/// # Panics
/// If there is no memory for it.
#[must_use]
pub fn started(scene: &Scene<'_>, capacity: usize) -> System<Heap> {
    let size = pointmass::Size { particles: capacity, ..scene.size() };
    let heap = Heap::alike(size, &scene.likeness()).expect("there is memory for a bench");
    let mut system = System::with(heap);
    system.start(scene, 1).expect("the memory was made for the scene");
    system
}

/// A circle of 10 cm at such a height \[m\] that births lead up from.
fn nozzle(height: f32) -> Shape<Mesh<'static>> {
    Shape::Circle(Disc { center: Vec3::Y * height, normal: Vec3::Y, radius: 0.1 })
}

/// A jet that holds about `n` drops in the air, each for 2 s.
#[must_use]
pub fn jet(n: f32) -> Emitter<Shape<Mesh<'static>>> {
    Emitter {
        speed: Varied { mean: 6.0, half_width: 1.0 },
        spread: Spread::Uniform(0.3),
        drag: Varied::exactly(0.1),
        lifetime: Varied::exactly(2.0),
        ..Emitter::new(nozzle(1.0), n / 2.0)
    }
}

/// The same that leave at 10 m/s, higher up, and live for 3 to 5 s, long enough to bounce off the ground and lie on it: about `n` at once, a tenth
/// of whom touch the ground in a step of [`FRAME`].
#[must_use]
pub fn high_jet(n: f32) -> Emitter<Shape<Mesh<'static>>> {
    Emitter {
        shape: nozzle(2.25),
        speed: Varied { mean: 10.0, half_width: 1.0 },
        drag: Varied::exactly(0.2),
        elasticity: Varied::exactly(0.5),
        lifetime: Varied { mean: 4.0, half_width: 1.0 },
        rate: n / 4.0,
        ..jet(n)
    }
}

/// Nanoseconds that one call takes, of so many.
pub fn timed(calls: usize, mut call: impl FnMut()) -> f64 {
    let start = Instant::now();
    (0..calls).for_each(|_| call());
    start.elapsed().as_nanos() as f64 / calls as f64
}

/// A sixtieth of a second.
pub const FRAME: Time = Time::frame(1, 60);

/// The least a particle system can do: gravity, drag and symplectic Euler in one loop over separate columns.
#[derive(Clone, Debug)]
pub struct Bare {
    /// x, y and z, then vx, vy and vz.
    pub columns: [Vec<f32>; 6],
}

impl Bare {
    /// The same particles.
    #[must_use]
    pub fn new(particles: &[Particle]) -> Self {
        let column = |i: usize| {
            let of = |p: &Particle| if i < 3 { p.position[i] } else { p.velocity[i - 3] };
            particles.iter().map(of).collect()
        };
        Self { columns: core::array::from_fn(column) }
    }

    /// One step.
    pub fn step(&mut self, dt: f32) {
        let (position, velocity) = self.columns.split_at_mut(3);
        for ((x, v), g) in position.iter_mut().zip(velocity).zip([0.0, -9.80665, 0.0]) {
            for (x, v) in x.iter_mut().zip(v) {
                *v += (g - 0.1 * *v) * dt;
                *x += *v * dt;
            }
        }
    }
}

/// `n` points of Plummer's sphere with scale length 1, without the outermost thousandth.
#[must_use]
pub fn plummer(n: usize) -> Vec<Vec3> {
    let point = |i: u32| {
        let ([mass, height], [turn, _]) = (Stream::new(2, 0, i).units(0), Stream::new(2, 0, i).units(1));
        // The radius within which there is so much of the mass (Aarseth, Hénon and Wielen 1974).
        let radius = 1.0 / ((0.999 * mass).max(1e-9).powf(-2.0 / 3.0) - 1.0).sqrt();
        let z = 2.0 * height - 1.0;
        let ring = (1.0 - z * z).max(0.0).sqrt();
        let (sin, cos) = pointmass::math::sin_cos_turns(turn);
        Vec3::new(ring * cos, ring * sin, z) * radius
    };
    (0..n as u32).map(point).collect()
}
