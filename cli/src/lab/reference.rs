//! References are what solutions are held against.

use super::problem::Problem;
use super::trial::{Outturn, Places, Trial, apart};
use crate::outcome::Outcome;
use pointmass::Method;
use pointmass::integrate::Tuned;

/// The best that is known of a problem's solution.
pub(crate) struct Reference {
    pub(crate) places: Places,
    /// How it was found.
    pub(crate) about: String,
    /// How far it may be off \[m\].
    pub(crate) error: f64,
    /// How far the rounding of places takes it, one step like another \[m\].
    pub(crate) rounding: f64,
    /// The largest coordinate \[m\].
    pub(crate) extent: f64,
    /// The energy that errors of energy are a share of \[J\], and what that is.
    pub(crate) energy: f64,
    pub(crate) energy_about: &'static str,
}

/// Gaps below this part of the motion are those of a method that converges.
const CLOSE: f64 = 0.01;

/// RK4 in steps that are halved until that brings nothing: there, rounding outweighs the error of the method.
pub(crate) fn reference(problem: &Problem) -> Outcome<Reference> {
    let mut dt = problem.dts[0];
    let least = (problem.dts[problem.dts.len() - 1] / 4.0).min(problem.duration / 4096.0);
    let mut last = solve(problem, dt)?;
    // The gap as a part of the motion: what blows up must not pass for a motion that is wide.
    let mut best = (f64::INFINITY, dt, last.clone());
    let mut failures = 0;
    while failures < 2 && dt > least {
        dt /= 2.0;
        let next = solve(problem, dt)?;
        let gap = match (last.blew_up_at, next.blew_up_at) {
            (None, None) => apart(&last.places, &next.places).0 / next.extent.max(f64::MIN_POSITIVE),
            _ => f64::INFINITY,
        };
        if gap < best.0 {
            best = (gap, dt, next.clone());
            failures = 0;
        } else if best.0 < CLOSE {
            failures += 1;
        }
        last = next;
    }
    best.0 *= best.2.extent;
    Ok(settled(problem, best))
}

fn solve(problem: &Problem, dt: f64) -> Outcome<Outturn> {
    let method = Tuned::from(Method::Rk4);
    Trial { problem, method, dt, duration: problem.duration, limit: f64::INFINITY }.watched()
}

fn settled(problem: &Problem, (gap, dt, outturn): (f64, f64, Outturn)) -> Reference {
    let Outturn { places, extent, track, .. } = outturn;
    let opening = track.opening.abs();
    let (energy, energy_about) = match opening > 0.01 * track.kinetic {
        true => (opening, "the energy at the start"),
        false => (track.kinetic, "the most kinetic energy, as there is next to none at the start"),
    };
    let (places, about, error) = match problem.exact {
        Some(exact) => {
            let scene = problem.scene();
            let places = exact(scene.start, scene.springs.list(), problem.duration);
            ((0..).zip(places).collect(), "the closed form".to_string(), 0.0)
        }
        None => (places, format!("RK4 in steps of {dt:.3e} s (steps twice as long end {gap:.1e} m from there)"), gap),
    };
    let energy = energy.max(f64::MIN_POSITIVE);
    let rounding = walk(extent, problem.duration / dt);
    Reference { places, about, error, rounding, extent, energy, energy_about }
}

/// How far the rounding of coordinates up to so large \[m\] takes them in so many steps: each rounds by half a unit in the last place, up or
/// down.
pub(super) fn walk(extent: f64, steps: f64) -> f64 {
    f64::from(f32::EPSILON) / 2.0 * extent * steps.sqrt()
}
