//! Falls of sheets: how fast they come to what stops them, how far that stretches them, and what sub-steps leave beyond that.
//!
//! A part that is stopped at a speed v sends a wave of stretch through the sheet, of v / c as in a rod that is struck at its end (Timoshenko and
//! Goodier, "Theory of Elasticity"), where c² = stretch / density. A sub-step solves stretches along the directions of its beginning, so what goes far
//! in one, beside how long an edge is, leaves edges longer than that.
//!
//! The factors here are measured, of squares of 0.3 to 1 m, 12² to 40² cells, 100 to 2000 N/m and 0.1 and 0.2 kg/m², that fall on a ball of a tenth of
//! their side and the floor, or on a rim, at 2 to 8 m/s, in 1 to 20 sub-steps a frame beside 40 or 60: by the largest strain of an edge in 24 frames, with
//! contacts of their own and without. In many sub-steps it was 1.0 to 1.5 times v / c (0.1 to 0.7 where they fall on a rim, none where all meets the floor
//! at once); in few it was more by up to 0.05 for each edge's length that what falls goes in a sub-step, up to three of these, and with friction of 0.2 to
//! 1 by up to 0.2, as single edges hang on where they hit. Beyond three it was up to 0.7 more.

use crate::stall::gravity;
use pointmass::scene::{Material, Model};
use pointmass::shape::{Aabb, Collider, Segment};
use pointmass::{ConstraintKind, Vec3};
use serde::Serialize;
use std::collections::HashSet;

/// The largest strain of what is stopped, for each share of the speed of its waves that it had.
const STRUCK: f64 = 1.5;
/// The strain beyond that at the most, for each edge's length that it goes in a sub-step: on what is smooth, and with friction.
const LEFT: [f64; 2] = [0.05, 0.2];
/// Up to so many edges' lengths that is known.
const KNOWN: f64 = 3.0;
/// How far down scenery is looked for \[m\].
const FAR: f32 = 1e3;

/// The fall of a sheet that nothing holds.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub(crate) struct Fall {
    /// Its speed at the most where it meets the scenery beneath it, by gravity alone \[m/s\].
    pub(crate) speed: f64,
    /// The share by which it is stretched there at the most, by its material alone.
    pub(crate) gives: f64,
    /// The length of its shortest edge \[m\].
    pub(crate) edge: f64,
    /// True if there is friction.
    pub(crate) rough: bool,
}

impl Fall {
    /// None where something holds it, or nothing is beneath it.
    pub(super) fn of(model: &Model, sheet: &ConstraintKind) -> Option<Self> {
        let place = |end: u32| model.particles[end as usize].position;
        let edges = sheet.triangles().flat_map(|[a, b, c]| [[a, b], [b, c], [c, a]]);
        let edge = edges.map(|[a, b]| place(a).distance(place(b))).reduce(f32::min)?;
        if is_held(model, sheet) {
            return None;
        }
        let speed = sheet.ends().filter_map(|&end| speed(model, end as usize)).reduce(f64::max)?;
        // Hung in 1 m/s² from one end it is stretched by density × extent / stretch.
        let Aabb { min, max } = Aabb::around(sheet.ends().map(|&end| place(end)));
        let wave = (f64::from((max - min).max_element()) / sheet.hung(&model.particles, 1.0)?).sqrt();
        let rough = |of: &Material| of.contact.friction.is_some_and(|friction| friction.static_ > 0.0);
        let rough = model.materials.iter().any(rough);
        let (gives, edge) = (STRUCK * speed / wave, f64::from(edge));
        (gives > 0.0 && gives.is_finite() && edge > 0.0).then_some(Self { speed, gives, edge, rough })
    }

    /// The share by which sub-steps of `h` \[s\] may stretch it beyond that; none where that is not known, as it goes so far in one.
    pub(crate) fn fault(&self, h: f64) -> Option<f64> {
        let edges = self.speed * h / self.edge;
        (edges <= KNOWN).then_some(LEFT[usize::from(self.rough)] * edges)
    }

    /// The longest sub-step that leaves no more than such a share \[s\].
    pub(crate) fn step(&self, share: f64) -> f64 {
        share / LEFT[usize::from(self.rough)] * self.edge / self.speed
    }
}

/// Tells whether something is bound to a sheet that is no part of it, or a particle of it does not move by itself.
fn is_held(model: &Model, sheet: &ConstraintKind) -> bool {
    let own: HashSet<u32> = sheet.ends().copied().collect();
    let reaches = |ends: &mut dyn Iterator<Item = u32>| {
        let [mut inside, mut outside] = [false; 2];
        ends.for_each(|end| *if own.contains(&end) { &mut inside } else { &mut outside } = true);
        [inside, inside && outside]
    };
    let bound = |other: &ConstraintKind| {
        let [inside, across] = reaches(&mut other.ends().copied());
        across || inside && other.leads()
    };
    own.iter().any(|&end| model.particles[end as usize].fixed)
        || model.constraints.0.iter().any(bound)
        || model.springs.iter().any(|spring| reaches(&mut spring.ends.into_iter())[1])
}

/// The speed of a particle of the start where it meets the scenery beneath it \[m/s\]; beneath is where it goes, if there is no gravity.
fn speed(model: &Model, number: usize) -> Option<f64> {
    let (particle, gravity) = (&model.particles[number], gravity(model));
    let down = if gravity == Vec3::ZERO { particle.velocity } else { gravity }.normalize_or_zero();
    let path = Segment::new(particle.position, particle.position + down * FAR);
    let deep = f64::from(model.colliders.first_hit(&path)?.time * FAR);
    Some((f64::from(particle.velocity.length_squared()) + 2.0 * f64::from(gravity.length()) * deep).sqrt())
}
