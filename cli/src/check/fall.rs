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
use pointmass::scene::Model;
use pointmass::shape::{Aabb, Collider, Segment};
use pointmass::{ConstraintKind, Vec3};
use serde::Serialize;

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
    /// True if there is friction between it and scenery.
    pub(crate) rough: bool,
}

/// Tells whether a sheet does not slide freely on all of the scenery.
fn is_rough(model: &Model, sheet: &ConstraintKind) -> bool {
    let resting = |material: Option<u16>| {
        let contact = model.materials.get(usize::from(material?))?.contact;
        contact.friction.map(|friction| friction.static_)
    };
    let own = sheet.ends().next().and_then(|&end| resting(model.particles[end as usize].material));
    // Of two that touch the geometric mean counts, or what one of them says alone.
    model.scenery.iter().any(|solid| match (own, resting(solid.material)) {
        (Some(own), Some(other)) => own * other > 0.0,
        (own, other) => own.or(other).is_some_and(|share| share > 0.0),
    })
}

impl Fall {
    /// None where something holds it, or nothing is beneath it.
    pub(super) fn of(model: &Model, sheet: &ConstraintKind, held: &[bool]) -> Option<Self> {
        let place = |end: u32| model.particles[end as usize].position;
        let edges = sheet.triangles().flat_map(|[a, b, c]| [[a, b], [b, c], [c, a]]);
        let edge = edges.map(|[a, b]| place(a).distance(place(b))).reduce(f32::min)?;
        if sheet.ends().any(|&end| held[end as usize]) {
            return None;
        }
        let speed = sheet.ends().filter_map(|&end| speed(model, end as usize)).reduce(f64::max)?;
        // Hung in 1 m/s² from one end it is stretched by density × extent / stretch.
        let Aabb { min, max } = Aabb::around(sheet.ends().map(|&end| place(end)));
        let wave = (f64::from((max - min).max_element()) / sheet.hung(&model.particles, 1.0)?).sqrt();
        let rough = is_rough(model, sheet);
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

/// The particles of the start that do not move as what they are a part of does by itself: those that are fixed or led, and those that something binds
/// to what is no part of that.
pub(super) fn held(model: &Model) -> Vec<bool> {
    let mut owner = vec![usize::MAX; model.particles.len()];
    for (number, body) in model.constraints.0.iter().enumerate().filter(|(_, of)| of.is_body()) {
        body.ends().for_each(|&end| owner[end as usize] = number);
    }
    let mut held: Vec<bool> = model.particles.iter().map(|particle| particle.fixed).collect();
    let mut bind = |ends: &[u32], leads: bool| {
        let owned = |end: &u32| owner[*end as usize];
        if leads || ends.windows(2).any(|pair| owned(&pair[0]) != owned(&pair[1])) {
            ends.iter().for_each(|&end| held[end as usize] = true);
        }
    };
    for of in &model.constraints.0 {
        bind(&of.ends().copied().collect::<Vec<_>>(), of.leads());
    }
    model.springs.iter().for_each(|spring| bind(&spring.ends, false));
    held
}

/// The speed of a particle of the start where it meets the scenery beneath it \[m/s\]; beneath is where it goes, if there is no gravity.
fn speed(model: &Model, number: usize) -> Option<f64> {
    let (particle, gravity) = (&model.particles[number], gravity(model));
    let down = if gravity == Vec3::ZERO { particle.velocity } else { gravity }.normalize_or_zero();
    let deep = |far: f32| {
        let path = Segment::new(particle.position, particle.position + down * far);
        Some(model.colliders.first_hit(&path)?.time * far)
    };
    // Once more on a way hardly longer than that, of which rounding takes less.
    let far = deep(FAR)?;
    let deep = f64::from(deep(1.01 * far).unwrap_or(far));
    Some((f64::from(particle.velocity.length_squared()) + 2.0 * f64::from(gravity.length()) * deep).sqrt())
}
