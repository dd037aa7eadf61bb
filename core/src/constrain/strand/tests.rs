//! How twist lies along wires whose ends are turned, and what it takes to turn them.

extern crate std;

use super::joint::Joint;
use super::{Bodies, Constraint, Demand, Share, StrandParams, Strands, frame};
use crate::constrain::turn::Turn;
use crate::integrate::Method;
use crate::memory::Heap;
use crate::particles::Particle;
use crate::scene::Scene;
use crate::system::System;
use crate::time::Time;
use alloc::vec::Vec;
use glam::Vec3;
use std::sync::Mutex;

const EDGES: u32 = 16;
const EDGE: f32 = 0.05;
const TWISTING: f32 = 0.2;

type Wire = Strands<Vec<u32>, [u32; 1]>;

/// The twist at each joint of a wire \[rad/m\], from the tip on, and the work that has been done at its ends \[J\].
#[derive(Default)]
struct Seen {
    twist: Vec<f32>,
    work: f32,
    /// The frame of the edge at the tip, when it was first seen and last.
    frames: Option<[[f32; 4]; 2]>,
}

impl Seen {
    /// How far the edge at the tip has been turned \[rad\], up to half a turn.
    fn turned(&self) -> f32 {
        let [a, b] = self.frames.unwrap();
        let dot = |a: [f32; 4], b: [f32; 4]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f32>();
        2.0 * (dot(a, b).abs() / (dot(a, a) * dot(b, b)).sqrt()).min(1.0).acos()
    }
}

/// A wire that is watched as it is solved; its end edges are clamped, or held.
struct Watched<'a> {
    wire: &'a Wire,
    seen: &'a Mutex<Seen>,
}

impl Watched<'_> {
    /// The twist at each joint; half of each edge beside it counts, of clamped ones nothing.
    fn twist(&self, joints: &[Joint]) -> Vec<f32> {
        let clamped = !self.wire.held[0];
        let half = |edge: usize| {
            let is_end = edge == 0 || edge + 1 == EDGES as usize;
            if clamped && is_end { 0.0 } else { 0.5 * joints[edge].length }
        };
        let strain = |i: usize| frame::strain(Turn(joints[i - 1].turn), Turn(joints[i].turn)).z - joints[i].rest.z;
        (1..EDGES as usize).map(|i| strain(i) / (half(i - 1) + half(i))).collect()
    }
}

impl Constraint for Watched<'_> {
    fn demand(&self) -> Demand {
        self.wire.demand()
    }
    fn prepare(&self, bodies: &mut Bodies<'_>, share: &mut Share<'_>) {
        self.wire.prepare(bodies, share);
    }
    fn project(&self, bodies: &mut Bodies<'_>, share: &mut Share<'_>) {
        self.wire.project(bodies, share);
        let mut seen = self.seen.lock().unwrap();
        let joints = self.wire.kept(share.kept.fixed).0;
        let (own, now, h) = (joints[0].turn, self.twist(joints), bodies.substep.seconds());
        let torque = |i: usize| TWISTING * 0.5 * (now[i] + seen.twist.get(i).unwrap_or(&0.0));
        let [root, tip] = self.wire.turning;
        // What turns the tip goes against the root.
        let work = (torque(0) * tip - torque(now.len() - 1) * root) * h;
        let frames = Some([seen.frames.map_or(own, |[first, _]| first), own]);
        *seen = Seen { work: seen.work + work, twist: now, frames };
    }
}

/// Turns the ends of a straight wire at these rates for a second, and then lets it be: what is seen then, and how far it has got from where it was.
fn turned(turning: [f32; 2], held: bool, (method, substeps): (Method, u32)) -> (Seen, f32) {
    let is_fixed = |i: u32| !held && (i < 2 || i + 2 > EDGES);
    let point =
        |i| Particle { position: Vec3::X * (EDGE * i as f32), mass: 0.01, fixed: is_fixed(i), ..Particle::REST };
    let start: Vec<_> = (0..=EDGES).map(point).collect();
    let params = StrandParams { stretch: Some(1e4), bending: [1.0; 2], twisting: TWISTING, damping: 0.0 };
    let plain = Strands { held: [held; 2], ..Strands::of((0..=EDGES).collect(), [EDGES + 1], params) };
    let driven = Strands { turning, ..plain.clone() };
    let seen = Mutex::new(Seen::default());
    let [first, then] = [&driven, &plain].map(|wire| Watched { wire, seen: &seen });
    let integrator = method.integrator();
    let [first, then] =
        [&first, &then].map(|constraints| Scene { start: &start, constraints, substeps, integrator, ..Scene::EMPTY });
    let mut system = System::with(Heap::new(first.size()));
    system.start(&first, 0).unwrap();
    for frame in 1..=90 {
        system.step_to(if frame > 60 { &then } else { &first }, Time::frame(frame, 60));
    }
    let places = start.iter().zip(system.particles().position);
    let far = places.map(|(start, now)| start.position.distance(*now)).fold(0.0, f32::max);
    (seen.into_inner().unwrap(), far)
}

/// A straight wire that is turned by an angle φ over its length L is twisted by φ / L everywhere, and it takes the work ½ G J φ² / L that it holds then.
#[test]
fn twist_is_even_and_holds_the_work_that_it_took() {
    for (turning, way) in [
        ([0.0, 0.8], (Method::Symplectic, 4)),
        ([-0.5, 0.0], (Method::Verlet, 1)),
        ([0.3, -0.6], (Method::Rk4, 10)),
        ([2.0, 1.2], (Method::Euler, 20)),
    ] {
        for held in [false, true] {
            let (Seen { twist, work, .. }, far) = turned(turning, held, way);
            // Ends that are held are turned from their middle on.
            let long = EDGE * (EDGES as f32 - if held { 1.0 } else { 2.0 });
            let angle = turning[1] - turning[0];
            let should = angle / long;
            let worst = twist.iter().map(|twist| (twist / should - 1.0).abs()).fold(0.0, f32::max);
            assert!(worst < 2e-3, "{turning:?}, held: {held}, {way:?}: {twist:?}, not {should}");
            let stored = 0.5 * TWISTING * angle * angle / long;
            assert!((work / stored - 1.0).abs() < 2e-3, "{turning:?}, held: {held}, {way:?}: {work}, not {stored}");
            assert!(far < 1e-5, "{turning:?}, held: {held}, {way:?}: {far}");
        }
    }
}

#[test]
fn what_is_turned_at_both_ends_alike_is_not_twisted() {
    for held in [false, true] {
        let (seen, _) = turned([1.5; 2], held, (Method::Symplectic, 5));
        let (Seen { twist, work, .. }, angle) = (&seen, seen.turned());
        // It is seen first when the first sub-step has turned it.
        assert!((angle - 1.5 * (1.0 - 1.0 / 300.0)).abs() < 2e-3, "held: {held}: turned by {angle} rad");
        let worst = twist.iter().fold(0.0f32, |worst, twist| worst.max(twist.abs()));
        // A radian of twist would take 0.14 J; the material's turns are held a little as they are solved for.
        assert!(worst < 1e-3 && work.abs() < 3e-4, "held: {held}: {worst} {work}");
    }
}
