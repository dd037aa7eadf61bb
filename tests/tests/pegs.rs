//! Loaded ropes over pegs, against Atwood's machine and capstan's law: how far the loads go, and what they keep.

use pointmass::force::Friction;
use pointmass::shape::Capsule;
use pointmass::{ContactMaterial, Gravity, Measures, Method, Particle, Rope, Scene, Time, Vec3};
use pointmass_tests::{Random, is_third, started};
use std::f32::consts::PI;

const G: f32 = 9.81;
const RADIUS: f32 = 0.2;
const HANGS: f32 = 0.8;
const LINKS: usize = 60;
/// The rope's mass for each metre \[kg/m\].
const DENSITY: f32 = 0.02;

/// A rope over a peg, with a load at each end.
struct Peg {
    down: Vec3,
    axis: Vec3,
    friction: f32,
    loads: [f32; 2],
}

/// What becomes of it: how far the first load rises and the second falls \[m\], the most energy that it gains \[J\], how much longer it gets as a share, and
/// how near its points come to the peg's axis \[m\].
struct Seen {
    moved: [f32; 2],
    gained: f64,
    longer: f32,
    nearest: f32,
}

impl Peg {
    fn place(&self, along: f32) -> Vec3 {
        let (side, arc, radius) = (self.axis.cross(self.down), PI * RADIUS, RADIUS + 1e-4);
        if along < HANGS {
            return side * -radius + self.down * (HANGS - along);
        }
        if along > HANGS + arc {
            return side * radius + self.down * (along - HANGS - arc);
        }
        let angle = (along - HANGS) / RADIUS;
        side * (-radius * angle.cos()) - self.down * (radius * angle.sin())
    }

    fn long() -> f32 {
        2.0 * HANGS + PI * RADIUS
    }

    fn start(&self) -> Vec<Particle> {
        let edge = Self::long() / LINKS as f32;
        let mass = |i: usize| match i {
            0 => self.loads[0],
            LINKS => self.loads[1],
            _ => DENSITY * edge,
        };
        let point = |i| Particle {
            position: self.place(edge * i as f32),
            mass: mass(i),
            elasticity: 0.0,
            material: Some(0),
            ..Particle::REST
        };
        (0..=LINKS).map(point).collect()
    }

    /// How fast the loads are to get \[m/s²\], by T₂ / T₁ = exp(μ π).
    fn acceleration(&self) -> f32 {
        let times = (self.friction * PI).exp();
        let [light, heavy] = self.loads.map(|load| load + DENSITY * HANGS);
        let driving = (heavy - times * light).max(0.0);
        G * driving / (heavy + times * light + DENSITY * PI * RADIUS)
    }

    fn run(&self, method: Method, substeps: u32, frames: u64) -> Seen {
        let start = self.start();
        let lengths: Vec<f32> = start.windows(2).map(|ends| ends[0].position.distance(ends[1].position)).collect();
        let rope = Rope::rigid((0..start.len() as u32).collect::<Vec<_>>(), lengths.clone());
        let peg = Capsule { from: -self.axis, to: self.axis, radius: RADIUS };
        let friction = Friction { static_: self.friction, kinetic: self.friction };
        let scene = Scene {
            start: &start,
            forces: &Gravity { acceleration: self.down * G },
            colliders: &peg,
            materials: &[ContactMaterial { elasticity: None, friction: Some(friction) }],
            constraints: &rope,
            substeps,
            integrator: method.integrator(),
            ..Scene::EMPTY
        };
        let mut system = started(&scene, start.len(), 0);
        let begun = Measures::of(&system, &scene).energy.total();
        let mut seen = Seen { moved: [0.0; 2], gained: 0.0, longer: 0.0, nearest: f32::INFINITY };
        for frame in 1..=frames {
            system.step_to(&scene, Time::frame(frame, 60));
            let all = system.particles().position;
            seen.gained = seen.gained.max(Measures::of(&system, &scene).energy.total() - begun);
            let off = all.windows(2).zip(&lengths).map(|(ends, long)| (ends[0].distance(ends[1]) / long - 1.0).abs());
            seen.longer = off.fold(seen.longer, f32::max);
            let far = |x: &Vec3| (*x - self.axis * x.dot(self.axis)).length();
            seen.nearest = all.iter().map(far).fold(seen.nearest, f32::min);
        }
        let all = system.particles().position;
        let fallen = |i: usize| (all[i] - start[i].position).dot(self.down);
        seen.moved = [-fallen(0), fallen(LINKS)];
        seen
    }
}

/// Loads move as capstan's law has it; no energy comes of it, and the rope neither stretches nor gets into the peg.
#[test]
fn loads_over_a_peg_go_as_capstans_law_has_it() {
    let (mut random, mut cases) = (Random::new(8), 0);
    let mut methods = [Method::Symplectic, Method::Implicit].into_iter().cycle();
    for (friction, loads) in [(0.0, [1.0, 2.0]), (0.0, [10.0, 20.0]), (0.2, [1.0, 3.0]), (0.1, [10.0, 20.0])] {
        for substeps in [4, 20, 60] {
            let down = random.direction();
            let axis = down.cross(random.direction()).normalize();
            let peg = Peg { down, axis, friction, loads };
            let method = methods.next().expect("there is always a next one");
            if !is_third(&mut cases) {
                continue;
            }
            let (frames, t) = (24, 0.4f32);
            let Seen { moved, gained, longer, nearest } = peg.run(method, substeps, frames);
            let should = 0.5 * peg.acceleration() * t * t;
            let what = format!("{method}, {substeps} sub-steps, friction {friction}, {loads:?}");
            for moved in moved {
                assert!((moved - should).abs() < 0.06 * should + 4e-3, "{what}: {moved} m, not {should} m");
            }
            assert!(gained < 3e-3 * f64::from(G * loads[1] * HANGS), "{what}: {gained} J gained");
            assert!(longer < 1e-3, "{what}: longer by a share of {longer}");
            assert!(nearest > RADIUS - 1e-4, "{what}: {nearest} m from the axis");
        }
    }
}
