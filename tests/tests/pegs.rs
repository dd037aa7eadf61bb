//! Loaded ropes over pegs, against Atwood's machine, capstan's law and Galileo's pendulum: how far the loads go, and what they keep.

use pointmass::constrain::{Constraint, ShapeMatching, Tie, TiedRope};
use pointmass::force::Friction;
use pointmass::shape::Capsule;
use pointmass::{ContactMaterial, Gravity, Measures, Method, Particle, Rope, Scene, Time, Vec3};
use pointmass_tests::{Random, is_run, started};
use std::f32::consts::PI;

const G: f32 = 9.81;
const RADIUS: f32 = 0.2;
const HANGS: f32 = 0.8;
const LINKS: usize = 60;
/// The rope's mass for each metre \[kg/m\].
const DENSITY: f32 = 0.02;
/// The side of a box that hangs from an end \[m\].
const SIDE: f32 = 0.15;

/// A rope over a peg, with a load at each end.
struct Peg {
    down: Vec3,
    axis: Vec3,
    friction: f32,
    loads: [f32; 2],
    /// The rope's mass for each metre \[kg/m\], and how far off the peg it begins \[m\].
    density: f32,
    gap: f32,
    /// True if the loads are boxes that are tied to the ends, and if the first end is held.
    boxes: bool,
    held: bool,
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
    /// One of so many random ones: smooth, of a rope that lies on the peg, and with loads that are its ends.
    fn any(random: &mut Random, friction: f32, loads: [f32; 2]) -> Self {
        let down = random.direction();
        let axis = down.cross(random.direction()).normalize();
        Self { down, axis, friction, loads, density: DENSITY, gap: 1e-4, boxes: false, held: false }
    }

    fn place(&self, along: f32) -> Vec3 {
        let (side, arc, radius) = (self.axis.cross(self.down), PI * RADIUS, RADIUS + self.gap);
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
            0 if !self.boxes => self.loads[0],
            LINKS if !self.boxes => self.loads[1],
            _ => self.density * edge,
        };
        let point = |i| Particle {
            position: self.place(edge * i as f32),
            mass: mass(i),
            elasticity: 0.0,
            material: Some(0),
            fixed: self.held && i == 0,
            ..Particle::REST
        };
        let mut start: Vec<Particle> = (0..=LINKS).map(point).collect();
        for end in if self.boxes { &[0, LINKS][..] } else { &[] } {
            let (side, load) = (self.axis.cross(self.down), self.loads[usize::from(*end > 0)]);
            let middle = start[*end].position + self.down * (0.5 * SIDE);
            start.extend((0..8).map(|i| {
                let sign = |bit: usize| if i >> bit & 1 == 0 { -SIDE } else { SIDE } / 12.0f32.sqrt();
                let position = middle + side * sign(0) + self.down * sign(1) + self.axis * sign(2);
                Particle { position, mass: load / 8.0, elasticity: 0.0, ..Particle::REST }
            }));
        }
        start
    }

    /// The rope, and the boxes that its ends are tied to.
    fn bonds(&self, lengths: Vec<f32>) -> impl Constraint + use<> {
        let rope = Rope::rigid((0..=LINKS as u32).collect::<Vec<_>>(), lengths);
        let corners = if self.boxes { 8 } else { 0 };
        let boxes = [0, 1].map(|end| LINKS as u32 + 1 + corners * end);
        let boxes = boxes.map(|first| (first..first + corners).collect::<Vec<u32>>());
        let is_tied = |end: usize| self.boxes && !(self.held && end == 0);
        let tie = |end: usize| is_tied(end).then(|| Tie::rigid((end * LINKS) as u32, boxes[end].clone()));
        let tied = TiedRope::<_, _, _> { rope, ends: [tie(0), tie(1)] };
        let [one, other] = boxes;
        (tied, ShapeMatching::rigid(one), ShapeMatching::rigid(other))
    }

    /// How fast the loads are to get \[m/s²\], by T₂ / T₁ = exp(μ π).
    fn acceleration(&self) -> f32 {
        let times = (self.friction * PI).exp();
        let [light, heavy] = self.loads.map(|load| load + self.density * HANGS);
        let driving = (heavy - times * light).max(0.0);
        G * driving / (heavy + times * light + self.density * PI * RADIUS)
    }

    fn run(&self, method: Method, substeps: u32, frames: u64) -> Seen {
        let start = self.start();
        let rope = &start[..=LINKS];
        let lengths: Vec<f32> = rope.windows(2).map(|ends| ends[0].position.distance(ends[1].position)).collect();
        let bonds = self.bonds(lengths.clone());
        let peg = Capsule { from: -self.axis, to: self.axis, radius: RADIUS };
        let friction = Friction { static_: self.friction, kinetic: self.friction };
        let scene = Scene {
            start: &start,
            forces: &Gravity { acceleration: self.down * G },
            colliders: &peg,
            materials: &[ContactMaterial { elasticity: None, friction: Some(friction) }],
            constraints: &bonds,
            substeps,
            integrator: method.integrator(),
            ..Scene::EMPTY
        };
        let mut system = started(&scene, start.len(), 0);
        let begun = Measures::of(&system, &scene).energy.total();
        let mut seen = Seen { moved: [0.0; 2], gained: 0.0, longer: 0.0, nearest: f32::INFINITY };
        for frame in 1..=frames {
            system.step_to(&scene, Time::frame(frame, 60));
            let all = &system.particles().position[..=LINKS];
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

/// Loads move as capstan's law has it, whatever the method and the sub-steps, and those that friction holds stay; no energy comes of it, and the rope neither
/// stretches nor gets into the peg.
#[test]
fn loads_over_a_peg_go_as_capstans_law_has_it() {
    let (mut random, mut cases) = (Random::new(8), 0);
    let mut methods = Method::ALL.iter().copied().cycle();
    let smooth = [(0.0, [1.0, 2.0]), (0.0, [10.0, 20.0])];
    let rough = [(0.2, [1.0, 3.0]), (0.1, [10.0, 20.0]), (0.1, [20.0, 60.0]), (0.3, [0.1, 1.0]), (0.5, [10.0, 20.0])];
    for (friction, loads) in smooth.into_iter().chain(rough) {
        for substeps in [1, 4, 7, 20, 60] {
            for boxes in [false, true] {
                let peg = Peg { boxes, ..Peg::any(&mut random, friction, loads) };
                let (down, axis) = (peg.down, peg.axis);
                let method = methods.next().expect("there is always a next one");
                if !is_run(&mut cases) {
                    continue;
                }
                let (frames, t) = (24, 0.4f32);
                let Seen { moved, gained, longer, nearest } = peg.run(method, substeps, frames);
                let should = 0.5 * peg.acceleration() * t * t;
                let what = format!("{method}, {substeps} sub-steps, friction {friction}, {loads:?}, {down} {axis}");
                let share = if substeps < 20 { 0.2 } else { 0.04 };
                for moved in moved {
                    let room = share * should + if substeps < 20 { 8e-3 } else { 4e-3 };
                    assert!((moved - should).abs() < room, "{what}: {moved} m, not {should} m");
                }
                let most = match method {
                    Method::Euler => 2e-2,
                    _ if loads[0] > 15.0 => 1e-2,
                    _ => 3e-3,
                };
                assert!(gained < most * f64::from(G * loads[1] * HANGS), "{what}: {gained} J gained");
                let most = if substeps == 1 { 3e-3 } else { 1e-3 };
                assert!(longer < most, "{what}: longer by a share of {longer}");
                assert!(nearest > RADIUS - 1e-5, "{what}: {nearest} m from the axis");
            }
        }
    }
}

/// A load that hangs over a peg from an end that is held falls by the slack that the rope begins with, and stays there: it is not thrown up again, though it is up to
/// some ten thousand times as heavy as the rope.
#[test]
fn what_hangs_over_a_peg_from_a_held_end_stays() {
    let (mut random, mut cases) = (Random::new(5), 0);
    let mut methods = Method::ALL.iter().copied().filter(|&method| method != Method::Euler).cycle();
    for density in [2e-2, 2e-3, 2e-4] {
        for substeps in [1, 4, 7, 20, 60] {
            for boxes in [false, true] {
                let (friction, load) = (random.between(-0.1, 0.2).max(0.0), random.between(1.0, 4.0));
                let peg = Peg { density, gap: 2e-3, boxes, held: true, ..Peg::any(&mut random, friction, [load; 2]) };
                let method = methods.next().expect("there is always a next one");
                if !is_run(&mut cases) {
                    continue;
                }
                let Seen { moved: [_, fallen], gained, longer, nearest } = peg.run(method, substeps, 24);
                let what = format!(
                    "{method}, {substeps} sub-steps, friction {friction}, {load} kg on {density} kg/m, {boxes}"
                );
                let slack = PI * peg.gap;
                assert!(fallen > -0.3 * slack && fallen < slack + 2e-3, "{what}: fallen by {fallen} m");
                assert!(gained < f64::from(0.3 * G * load * slack), "{what}: {gained} J gained");
                assert!(longer < 2e-3, "{what}: longer by a share of {longer}");
                assert!(nearest > RADIUS - 1e-5, "{what}: {nearest} m from the axis");
            }
        }
    }
}

/// A pendulum whose rope a peg catches halfway, and how high its bob rises beyond that \[m\] by turns on either side, in shares of its height at the start.
fn interrupted(down: Vec3, side: Vec3, bob: f32, method: Method, substeps: u32, frames: u64) -> Vec<f32> {
    let (long, links, angle, thick) = (1.0f32, 40, 0.7f32, 0.02);
    let along = down * angle.cos() - side * angle.sin();
    let point = |i: usize| Particle {
        position: along * (long * i as f32 / links as f32),
        mass: if i == links { bob } else { DENSITY * long / links as f32 },
        elasticity: 0.0,
        fixed: i == 0,
        ..Particle::REST
    };
    let start: Vec<Particle> = (0..=links).map(point).collect();
    let rope = Rope::rigid((0..start.len() as u32).collect::<Vec<_>>(), vec![long / links as f32]);
    let axis = down.cross(side);
    // It stands just beyond the rope that hangs straight down.
    let middle = down * (0.5 * long) + side * (thick + 1e-4);
    let peg = Capsule { from: middle - axis, to: middle + axis, radius: thick };
    let scene = Scene {
        start: &start,
        forces: &Gravity { acceleration: down * G },
        colliders: &peg,
        constraints: &rope,
        substeps,
        integrator: method.integrator(),
        ..Scene::EMPTY
    };
    let mut system = started(&scene, start.len(), 0);
    let height = |x: Vec3| (long - x.dot(down)) / (long * (1.0 - angle.cos()));
    let (mut heights, mut last) = (vec![], 0.0f32);
    let mut highest = 0.0f32;
    for frame in 1..=frames {
        system.step_to(&scene, Time::frame(frame, 60));
        let x = system.particles().position[links];
        let on = x.dot(side);
        if last * on < 0.0 {
            heights.push(highest);
            highest = 0.0;
        }
        (last, highest) = (on, highest.max(height(x)));
    }
    heights
}

/// The bob of a pendulum rises as high on the side where a peg catches its rope as on the other, as Galileo has it; a light one shares what it has with
/// its rope.
#[test]
fn what_a_peg_interrupts_swings_as_high() {
    let (mut random, mut cases) = (Random::new(3), 0);
    for bob in [0.1, 1.0, 10.0] {
        for substeps in [1, 4, 20] {
            for &method in Method::ALL.iter().filter(|&&method| method != Method::Euler) {
                let down = random.direction();
                let side = down.cross(random.direction()).normalize();
                if !is_run(&mut cases) {
                    continue;
                }
                let heights = interrupted(down, side, bob, method, substeps, 240);
                let room = if bob < 1.0 {
                    0.1
                } else if substeps < 4 {
                    0.04
                } else {
                    0.02
                };
                let what = format!("{bob} kg, {method}, {substeps} sub-steps");
                assert!(heights.len() > 3, "{what}: {heights:?}");
                assert!(heights.iter().all(|height| (height - 1.0).abs() < room), "{what}: {heights:?}");
            }
        }
    }
}
