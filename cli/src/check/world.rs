//! Processes other than springs and drag that have a time of their own: collisions and orbits.

use super::body::Body;
use super::net::wide;
use crate::stall::gravity;
use pointmass::scene::Model;
use pointmass::stability::longest_followed_step;
use pointmass::{Force, ForceKind, Method};
use serde::Serialize;

/// Particles that are looked at for the quickest pair, and for who is around whom.
pub(crate) const MOST: usize = 4096;

/// The length of paths that are followed with full accuracy to what they hit.
#[derive(Debug, Serialize)]
pub(crate) struct Followed {
    /// Acceleration \[m/s²\] of the scene's gravity.
    pub(crate) acceleration: f64,
    /// The longest step \[s\].
    pub(crate) step: f64,
    /// The most bounces that a particle has in a step.
    pub(crate) max_bounces: u32,
}

/// Two particles that attract each other.
#[derive(Debug, Serialize)]
pub(crate) struct Pair {
    /// Their places in the start.
    pub(crate) particles: [usize; 2],
    /// The distance between them \[m\].
    pub(crate) distance: f64,
    /// √(G (m₁ + m₂) / d³) \[1/s\], with softening.
    pub(crate) rate: f64,
    /// The time of an orbit \[s\].
    pub(crate) period: f64,
}

/// Forces that may be as stiff as springs, depending on how near particles come or how fast they are.
pub(crate) fn not_judged(model: &Model, method: Method) -> Vec<&'static str> {
    names(model, |force| !is_judged(force) && !is_judged_at_start(model, method, force))
}

/// Forces that are as stiff as particles are fast or near, and are taken as stiff as they start.
pub(crate) fn judged_at_start(model: &Model, method: Method) -> Vec<&'static str> {
    names(model, |force| is_judged_at_start(model, method, force))
}

fn is_judged(force: &ForceKind) -> bool {
    matches!(force, ForceKind::Gravity(_) | ForceKind::Drag(_) | ForceKind::Wind(_) | ForceKind::MutualGravity(_))
}

/// Neighbours of the newborn nobody knows, nor are those of more than a few thousand worked out. How lift turns with its surface the implicit method does
/// not know of.
fn is_judged_at_start(model: &Model, method: Method, force: &ForceKind) -> bool {
    match force {
        ForceKind::QuadraticDrag(_) | ForceKind::CylinderDrag(_) => true,
        ForceKind::Aerodynamics(air) => method != Method::Implicit || air.lift == 0.0,
        ForceKind::Viscosity(_) => model.emitters.is_empty() && model.particles.len() <= MOST,
        _ => false,
    }
}

fn names(model: &Model, is_meant: impl Fn(&ForceKind) -> bool) -> Vec<&'static str> {
    let mut names: Vec<_> = model.forces.0.iter().filter(|force| is_meant(force)).map(Force::name).collect();
    names.sort_unstable();
    names.dedup();
    names
}

/// None where nothing is hit or nothing falls.
pub(crate) fn followed(model: &Model) -> Option<Followed> {
    let acceleration = wide(gravity(model)).norm();
    let is_hit = !model.colliders.is_empty() || !model.forces.1.is_empty();
    let (step, max_bounces) = (longest_followed_step(acceleration), model.max_bounces);
    (is_hit && acceleration > 0.0).then_some(Followed { acceleration, step, max_bounces })
}

/// The quickest among the first few thousand particles, at the greatest masses of their lives.
pub(crate) fn fastest_pair(model: &Model, bodies: &[Body]) -> Option<Pair> {
    let gravity = model.forces.0.iter().find_map(|force| match force {
        ForceKind::MutualGravity(gravity) => Some(gravity),
        _ => None,
    })?;
    let softening = f64::from(gravity.softening).powi(2);
    let bodies = &bodies[..model.particles.len().min(MOST)];
    let mut fastest: Option<Pair> = None;
    for (j, b) in bodies.iter().enumerate() {
        for (i, a) in bodies[..j].iter().enumerate() {
            let distance = (wide(a.particle.position) - wide(b.particle.position)).norm();
            // What is fixed pulls and is not pulled.
            let pulling = [(a, b), (b, a)].into_iter().filter(|(_, pulled)| pulled.is_free());
            let mass: f64 = pulling.map(|(by, _)| by.mass[1]).sum();
            let cube = (distance * distance + softening).powf(1.5);
            let rate = (f64::from(gravity.constant) * mass / cube).sqrt();
            if rate.is_finite() && rate > fastest.as_ref().map_or(0.0, |pair| pair.rate) {
                fastest = Some(Pair { particles: [i, j], distance, rate, period: std::f64::consts::TAU / rate });
            }
        }
    }
    fastest
}
