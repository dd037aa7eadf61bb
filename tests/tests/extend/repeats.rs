//! A constraint of a user's own that repeats: those of a list ask each other by turns until all are met.

use pointmass::constrain::{Bodies, Share};
use pointmass::{Constraint, Particle, Scene, Time, Vec3};
use pointmass_tests::started;
use std::sync::atomic::{AtomicU32, Ordering::Relaxed};

/// Keeps a particle halfway between another and a place, and counts how often it is asked again.
struct Halfway<'a> {
    particle: u32,
    other: u32,
    place: f32,
    /// How far it may be off \[m\].
    slack: f32,
    asked: &'a AtomicU32,
}

impl Halfway<'_> {
    fn open(&self, bodies: &Bodies<'_>) -> Option<(usize, f32)> {
        let [own, other] = [self.particle, self.other].map(|number| bodies.row_of_start(number));
        let (own, other) = (own?, other?);
        Some((own, 0.5 * (bodies.position[other].x + self.place) - bodies.position[own].x))
    }
}

impl Constraint for Halfway<'_> {
    fn project(&self, bodies: &mut Bodies<'_>, _: &mut Share<'_>) {
        if let Some((row, open)) = self.open(bodies) {
            bodies.shift(row, Vec3::X * open);
        }
    }

    fn repeats(&self) -> bool {
        true
    }

    fn project_again(&self, bodies: &mut Bodies<'_>, share: &mut Share<'_>) -> bool {
        self.asked.fetch_add(1, Relaxed);
        let is_off = self.open(bodies).is_some_and(|(_, open)| open.abs() > self.slack);
        if is_off {
            self.project(bodies, share);
        }
        is_off
    }
}

/// Where two are at last of which each is to be halfway between the other and a wall, how often they were asked, and how many sub-steps were cut off.
fn settled(slack: f32, is_list: bool) -> ([f32; 2], u32, u64) {
    let asked = AtomicU32::new(0);
    let halfway = |particle, other, place| Halfway { particle, other, place, slack, asked: &asked };
    let [one, two] = [halfway(0, 1, 0.0), halfway(1, 0, 1.0)];
    let at = |x: f32| Particle { position: Vec3::X * x, ..Particle::REST };
    let start = [at(0.9), at(0.8)];
    let (list, pair);
    let constraints: &dyn Constraint = if is_list {
        list = [one, two];
        &list
    } else {
        pair = (one, two);
        &pair
    };
    let scene = Scene { start: &start, constraints, ..Scene::EMPTY };
    let mut system = started(&scene, 2, 0);
    let report = system.step(&scene, Time::frame(1, 60));
    let x = system.particles().position;
    ([x[0].x, x[1].x], asked.load(Relaxed), report.effort.capped)
}

#[test]
fn constraints_of_a_list_repeat_until_all_are_met() {
    let (places, asked, capped) = settled(1e-5, true);
    let off = [places[0] - 1.0 / 3.0, places[1] - 2.0 / 3.0];
    assert!(off.iter().all(|off| off.abs() < 1e-4) && asked > 4 && capped == 0, "{places:?}, {asked}, {capped}");
    // What is never met is cut off, and counted.
    let (places, asked, capped) = settled(-1.0, true);
    assert!((places[0] - 1.0 / 3.0).abs() < 1e-6 && asked == 2 * 63 && capped == 1, "{places:?}, {asked}, {capped}");
    // Those of a tuple go one after the other.
    let (places, asked, capped) = settled(1e-5, false);
    let off = [places[0] - 0.4, places[1] - 0.7];
    assert!(off.iter().all(|off| off.abs() < 1e-6) && asked == 0 && capped == 0, "{places:?}, {asked}, {capped}");
}
