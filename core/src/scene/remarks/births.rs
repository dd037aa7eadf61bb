//! Remarks on emitters that give birth to nobody, or not as they seem to say.

use super::odd_elasticity;
use crate::emit::{Emitter, Spread, Varied, WhereSparse};
use crate::scene::SceneFile;
use crate::scene::check::varied;
use crate::shape::Shape;
use alloc::format;
use alloc::string::String;
use core::fmt::Arguments;

/// All directions \[rad\]: π, also as files round it.
const HALF_TURN: f32 = core::f32::consts::PI * 1.0002;

impl SceneFile {
    /// Remarks on births.
    pub(super) fn add_emitters(&self, add: &mut dyn FnMut(Arguments<'_>, Option<String>)) {
        for (i, emitter) in self.emitters.iter().enumerate() {
            add(
                format_args!("emitters[{i}].elasticity"),
                odd_elasticity(emitter.elasticity).filter(|_| !emitter.fixed),
            );
            add(format_args!("emitters[{i}].spread"), odd_spread(emitter.spread));
            add(format_args!("emitters[{i}].lifetime"), odd_lifetime(emitter.lifetime));
            let never = emitter.rate == 0.0 && emitter.burst.is_none_or(|burst| burst.count == 0);
            let barren = || "neither this nor a burst says how many, so nothing is born".into();
            add(format_args!("emitters[{i}].rate"), never.then(barren));
            let ended = emitter.stop.filter(|&stop| stop <= emitter.start);
            let nothing = |stop| format!("{stop} s is not after start, {} s, so nothing is born", emitter.start);
            add(format_args!("emitters[{i}].stop"), ended.map(nothing));
            add(format_args!("emitters[{i}].start"), self.too_late(emitter.start, "nothing is born"));
            let burst = emitter.burst.filter(|burst| burst.count > 0);
            let burst = burst.and_then(|burst| self.too_late(burst.at, "it does not come"));
            add(format_args!("emitters[{i}].burst.at"), burst);
            let crowded = emitter.where_sparse.is_some_and(|WhereSparse { fewest, .. }| fewest == 0);
            let nowhere = || "fewer than 0 are nowhere, so nothing is born; take 1 for places where nobody is".into();
            add(format_args!("emitters[{i}].where_sparse.fewest"), crowded.then(nowhere));
            let blind = emitter.where_sparse.is_some_and(|WhereSparse { radius, .. }| radius == 0.0);
            let anywhere = || "nobody is within 0 m, so that it is sparse everywhere".into();
            add(format_args!("emitters[{i}].where_sparse.radius"), blind.then(anywhere));
            add(format_args!("emitters[{i}].shape.cone"), pointed(emitter));
            for (name, Varied { mean, half_width }) in varied(emitter) {
                let counts = || format!("{half_width} counts as {}, as far to both sides", -half_width);
                add(
                    format_args!("emitters[{i}].{name}.half_width"),
                    (half_width < 0.0 && (mean.abs() - half_width).is_finite()).then(counts),
                );
            }
        }
    }

    /// A remark on what begins at an instant \[s\] at which the run is over.
    pub(super) fn too_late(&self, start: f32, so: &str) -> Option<String> {
        let duration = self.run.duration;
        let late = || {
            format!(
                "{start} s is not before the run's end, at run.duration of {duration} s, so {so} unless it is run for longer"
            )
        };
        (duration > 0.0 && f64::from(start) >= duration).then(late)
    }
}

/// A remark on a cone that is but a point, and so has no way for births to leave.
fn pointed<M>(emitter: &Emitter<Shape<String>, M>) -> Option<String> {
    let Shape::Cone(cone) = emitter.shape else { return None };
    let is_lost = [cone.radius, cone.height] == [0.0; 2] && emitter.direction.is_none() && !emitter.inside;
    let point = || {
        "without a radius and a height it is a point without a normal, along which nobody leaves; a sphere of radius 0 sends births all ways, a direction one"
            .into()
    };
    is_lost.then(point)
}

/// A remark on an odd angle within which births leave.
fn odd_spread(spread: Spread) -> Option<String> {
    let (cutoff, most, why) = match spread {
        Spread::Uniform(cutoff) => (cutoff, HALF_TURN, "π, which is all directions"),
        Spread::Lecture(cutoff) => {
            (cutoff, 0.5 * HALF_TURN, "π/2: the lecture's recipe takes its sine, which is less again beyond")
        }
    };
    // No angle is as large, and many are as large in degrees.
    let degrees = if cutoff > 7.0 { format!("; of degrees take {:.4}", cutoff.to_radians()) } else { String::new() };
    (!(0.0..=most).contains(&cutoff)).then(|| format!("{cutoff} rad is not from 0 to {why}{degrees}"))
}

/// A remark on a lifetime that some are born without.
fn odd_lifetime(Varied { mean, half_width }: Varied) -> Option<String> {
    let least = mean - half_width.abs();
    let some =
        || format!("{least} s is the least of it: who is born with no more than 0 s lives on, as without a lifetime");
    (half_width != 0.0 && least < 0.0 && least.is_finite()).then(some)
}
