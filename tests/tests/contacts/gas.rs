//! A gas of hard balls in a box: what the kinetic theory says of it.

use pointmass::index::Structure;
use pointmass::shape::Cuboid;
use pointmass::{Contacts, Impact, Meetings, Observer, Particle, Scene, Time, Vec3};
use pointmass_tests::{ks, started};

const SIDE: f32 = 1.0;

/// Balls of one speed in random directions, on a lattice of so many along each side.
fn balls(n: usize, radius: f32) -> Vec<Particle> {
    (0..n * n * n)
        .map(|i| {
            let place = |k: usize| (k as f32 + 0.5) * (SIDE / n as f32);
            let random = pointmass::rng::Stream::new(3, 0, i as u32);
            let [u, v] = random.units(0);
            let (y, turn) = (1.0 - 2.0 * u, v * core::f32::consts::TAU);
            let r = (1.0 - y * y).sqrt();
            let direction = Vec3::new(r * turn.cos(), y, r * turn.sin());
            Particle {
                position: Vec3::new(place(i % n), place(i / n % n), place(i / n / n)),
                velocity: direction,
                radius,
                elasticity: 1.0,
                ..Particle::REST
            }
        })
        .collect()
}

/// Adds up what the walls get.
#[derive(Default)]
struct Walls {
    impulse: f64,
}

impl Observer for Walls {
    fn hit(&mut self, hit: &Impact) {
        if hit.other.is_none() {
            self.impulse += f64::from(hit.mass) * f64::from((hit.after - hit.before).dot(hit.normal));
        }
    }

    fn touched(&mut self, touch: &Impact) {
        self.hit(touch);
    }
}

/// A gas that has come to rest in a box, and what it does there.
struct Gas {
    /// Mean square of the speed along each axis \[m²/s²\].
    square: f64,
    /// Change of its energy in ten thousand meetings, as a share.
    drift: f64,
    /// Kolmogorov's and Smirnov's distance of the speeds from Maxwell's.
    far: f64,
    /// On the walls \[Pa\].
    pressure: f64,
    /// Centres in the volume that is open to them \[1/m³\].
    density: f64,
}

fn gas(across: usize, radius: f32, steps: usize, by_position: bool) -> Gas {
    let start = balls(across, radius);
    let n = start.len() as f64;
    let inside = Cuboid { min: Vec3::ZERO, max: Vec3::splat(SIDE) };
    let scene = Scene {
        start: &start,
        colliders: &inside,
        meetings: if by_position { Meetings::Through } else { Meetings::IMPULSE },
        constraints: if by_position { &Contacts::HARD } else { &() },
        // Balls that overlap for a part of a sub-step are smaller for it.
        substeps: if by_position { 4 } else { 1 },
        index: &Structure::Grid,
        ..Scene::EMPTY
    };
    let mut system = started(&scene, start.len(), 1);
    let energy = |velocity: &[Vec3]| velocity.iter().map(|v| 0.5 * f64::from(v.dot(*v))).sum::<f64>();
    let before = energy(system.particles().velocity);
    let dt = Time::from_seconds(0.005);
    // Twenty meetings of each ball are over after ten times as many as there are balls.
    while system.totals().contacts < 10 * start.len() as u64 {
        system.step(&scene, dt);
    }
    let after = energy(system.particles().velocity);
    let square = 2.0 * after / n / 3.0;
    let far = ks(system.particles().velocity.iter().map(|v| f64::from(v.length())), |v| maxwell(v, square.sqrt()));
    let drift = (after - before) / before * 1e4 / system.totals().contacts as f64;

    let (mut walls, began) = (Walls::default(), system.time());
    for _ in 0..steps {
        system.step_observed(&scene, dt, &mut walls);
    }
    let time = (system.time() - began).seconds_f64();
    assert_eq!(system.totals().caps.bounces, 0);
    for x in system.particles().position {
        assert!(x.min_element() >= radius * 0.999 && x.max_element() <= SIDE - radius * 0.999, "{x}");
    }
    let open = f64::from(SIDE - 2.0 * radius);
    let pressure = walls.impulse / (6.0 * open * open * time);
    Gas { square, drift, far, pressure, density: n / open.powi(3) }
}

/// Pressure over density and mean square speed (Carnahan and Starling, "Equation of State for Nonattracting Rigid
/// Spheres", J. Chem. Phys. 51, 1969).
fn carnahan_starling(density: f64, radius: f32) -> f64 {
    let filled = density * 4.0 / 3.0 * core::f64::consts::PI * f64::from(radius).powi(3);
    (1.0 + filled + filled.powi(2) - filled.powi(3)) / (1.0 - filled).powi(3)
}

const STEPS: usize = if cfg!(debug_assertions) { 300 } else { 2000 };

/// Beside a wall a gas is denser than elsewhere. That tells less the smaller the balls are against the box: at 8 % filling
/// with balls a thirtieth as wide as the box about 3 %, here half of that.
#[test]
fn equal_speeds_become_maxwell_s_and_press_as_carnahan_and_starling_say() {
    for by_position in [false, true] {
        let gas = gas(11, 0.02, STEPS, by_position);
        assert!(gas.drift.abs() < 1e-5, "{}", gas.drift);
        // 1.63 once in a hundred times.
        assert!(gas.far < 1.63, "{}", gas.far);
        let z = gas.pressure / (gas.density * gas.square);
        let want = carnahan_starling(gas.density, 0.02);
        println!("open volume: {z:.4}, Carnahan and Starling {want:.4}, by position: {by_position}");
        assert!((z / want - 1.0).abs() < 0.03);
    }
}

/// The distribution function of speeds whose mean square along each axis is `a`².
fn maxwell(v: f64, a: f64) -> f64 {
    let x = v / a;
    erf(x / 2f64.sqrt()) - (2.0 / core::f64::consts::PI).sqrt() * x * (-0.5 * x * x).exp()
}

/// Abramowitz and Stegun 7.1.26, to 1.5e-7.
fn erf(x: f64) -> f64 {
    let t = 1.0 / (1.0 + 0.327_591_1 * x);
    let [a, b, c, d, e] = [0.254_829_592, -0.284_496_736, 1.421_413_741, -1.453_152_027, 1.061_405_429];
    1.0 - t * (a + t * (b + t * (c + t * (d + t * e)))) * (-x * x).exp()
}
