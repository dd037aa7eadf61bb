//! Emitters, and runs of them cut into steps in many ways.

use crate::{Form, Random, started};
use pointmass::shape::Sphere;
use pointmass::{Emitter, Heap, Scene, Spread, System, Time, Varied, Vec3};

/// A run of 2.5 s cut into steps in many ways; every cut ends at the same instant.
#[must_use]
pub fn cuts() -> Vec<Vec<Time>> {
    let end = Time::from_seconds(2.5);
    let mut all: Vec<Vec<Time>> =
        [24, 30, 60, 144].map(|fps| (1..=fps * 5 / 2).map(|n| Time::frame(n.into(), fps)).collect()).into();
    all.push(vec![end]);
    let mut random = Random::new(1);
    for longest in [0.01, 0.3] {
        let (mut ends, mut now) = (vec![], Time::ZERO);
        while now < end {
            now = (now + Time::from_seconds(random.between(0.0, longest)) + Time::from_ticks(1)).min(end);
            ends.push(now);
        }
        all.push(ends);
    }
    all
}

/// A system on the heap after steps that end at `ends`.
pub fn play(scene: &Scene<'_>, capacity: usize, ends: &[Time]) -> System<Heap> {
    let mut system = started(scene, capacity, 5);
    for &end in ends {
        system.step(scene, end - system.time());
    }
    system
}

/// Instant, bits of the place, bits of the velocity of all who live, in that order.
pub type Birth = (u64, [u32; 3], [u32; 3]);

/// All who live, the oldest first.
#[must_use]
pub fn living(system: &System<Heap>) -> Vec<Birth> {
    let p = system.particles();
    let row = |i: usize| {
        let bits = |v: Vec3| v.to_array().map(f32::to_bits);
        (p.born[i].ticks(), bits(p.position[i]), bits(p.velocity[i]))
    };
    let mut births: Vec<Birth> = (0..system.len()).map(row).collect();
    births.sort_unstable();
    births
}

/// Where `varied` gives birth.
#[must_use]
pub fn sphere() -> Form {
    Form::Sphere(Sphere { center: Vec3::new(1.0, -2.0, 0.5), radius: 0.7 })
}

/// Births on a sphere with every property varied, but at rest: they stay where they were born.
#[must_use]
pub fn varied(rate: f32) -> Emitter<Form> {
    let varied = |mean| Varied { mean, half_width: 0.25 * mean };
    Emitter {
        mass: varied(2.0),
        drag: varied(0.5),
        elasticity: varied(0.4),
        spread: Spread::Uniform(0.4),
        color: Some([128; 4]),
        color_half_width: [50, 60, 70, 80],
        ..Emitter::new(sphere(), rate)
    }
}
