//! Remarks on what weighs too much for what bears it, and on what begins in one place.

use super::MOST_SUBSTEPS;
use crate::emit::Varied;
use crate::force::ForceKind;
use crate::math::{length, sqrt};
use crate::scene::{Boxes, Cloth, Response, SceneFile};
use alloc::format;
use alloc::string::String;
use alloc::vec::Vec;
use core::fmt::Arguments;
use glam::Vec3;

/// Balls may be so many times as heavy as others that bear them in the sub-steps that contacts by position usually take: two and three on top of
/// each other of which the upper one weighs 40 times as much lie still, with 100 times in steps of 1/24 s they do not.
const UNEVEN: f32 = 50.0;

impl SceneFile {
    /// A remark on balls that weigh too much for others that they may come to lie on: what bears a heavy one comes through light ones only bit by bit.
    pub(super) fn uneven_balls(&self) -> Option<String> {
        let Some(Response::Position(_)) = self.contacts else { return None };
        let balls = self.particles.iter().filter(|ball| ball.radius > 0.0 && !ball.fixed).map(|ball| [ball.mass; 2]);
        let born = self.emitters.iter().filter(|emitter| emitter.radius.mean > 0.0 && !emitter.fixed).map(|emitter| {
            let Varied { mean, half_width } = emitter.mass;
            [mean - half_width.abs(), mean + half_width.abs()]
        });
        let all = balls.chain(born).filter(|[least, _]| *least > 0.0);
        let [least, most] = all.fold([f32::INFINITY, 0.0], |[a, b], [c, d]| [a.min(c), b.max(d)]);
        let uneven = || {
            format!(
                "balls of {most} kg weigh more than {UNEVEN} times as much as those of {least} kg, into which they may sink, and which they may throw about; smaller steps help, `impulse` does not sink"
            )
        };
        (most > UNEVEN * least).then(uneven)
    }

    /// A remark on balls so small that gravity moves them by a good part of their radius in a sub-step: in a heap of n layers each is in the next by some 0.14 n g h² / r of its
    /// diameter, as measured with 4 and 20.
    pub(super) fn fine_balls(&self) -> Option<String> {
        /// The share of a radius that is too much, and one that leaves ten layers 3 % of a diameter.
        const MOST: f32 = 0.05;
        const FINE: f32 = 0.02;
        let Some(Response::Position(_)) = self.contacts else { return None };
        let begun = self.particles.iter().filter(|ball| !ball.fixed).map(|ball| ball.radius);
        let born = self.emitters.iter().filter(|emitter| !emitter.fixed).map(|emitter| emitter.radius.mean);
        let least = begun.chain(born).filter(|radius| *radius > 0.0).fold(f32::INFINITY, f32::min);
        let taken = self.substeps();
        let h = self.run.dt as f32 / taken as f32;
        let share = length(self.pull()) * h * h / least;
        let needed = (taken as f32 * sqrt(share / FINE)) as u32;
        let sinks = || {
            format!(
                "gravity moves balls of {least} m by {share:.2} of their radius in a sub-step: in heaps they sink into each other, and wander; {}",
                enough(needed.saturating_add(1))
            )
        };
        (share > MOST).then(sinks)
    }

    /// A remark on balls that meet by impulse above rigid bodies, which are met after them: those that lie on each other are pressed into what bears them, whatever the steps.
    pub(super) fn pressed_in(&self) -> Option<String> {
        let Some(Response::Impulse {}) = self.contacts else { return None };
        let balls = self.particles.iter().filter(|ball| ball.radius > 0.0 && !ball.fixed).count();
        let born = self.emitters.iter().filter(|emitter| emitter.radius.mean > 0.0 && !emitter.fixed).count();
        let press = "balls that lie on each other are pressed into the boxes that bear them, and through them; `position` keeps them out";
        (!self.boxes.is_empty() && balls + 2 * born > 1).then(|| press.into())
    }

    /// A remark on bodies that weigh too much for others that they may come to lie on: in a sub-step of h a body sinks into what bears it by the ratio of
    /// their masses times g h² / 4, as measured, and from a few hundredths of its size on through it.
    pub(super) fn uneven_boxes(&self) -> Option<String> {
        /// The share of the smallest side that one may sink in.
        const SHARE: f32 = 0.01;
        let free = self.boxes.iter().filter(|boxes| !boxes.fixed);
        let known: Vec<_> = free.filter_map(|boxes| Some((boxes.weight()?, boxes.size(None)?.min_element()))).collect();
        let &(heaviest, _) = known.iter().max_by(|a, b| a.0.total_cmp(&b.0))?;
        let &(lightest, side) = known.iter().min_by(|a, b| a.0.total_cmp(&b.0))?;
        let (taken, pull) = (self.substeps() as f32, length(self.pull()));
        let h = self.run.dt as f32 / taken;
        let depth = 0.25 * (heaviest / lightest) * pull * h * h;
        let room = SHARE * side;
        let sinks = || {
            let needed = (taken * sqrt(depth / room)) as u32;
            let needed = needed.saturating_add(1);
            format!(
                "bodies of {heaviest} kg sink into those of {lightest} kg that bear them, and through them at last; {}",
                enough(needed)
            )
        };
        (depth > room && heaviest > lightest).then(sinks)
    }

    /// Remarks on bodies that begin in one place.
    pub(super) fn add_heaps(&self, add: &mut impl FnMut(Arguments<'_>, Option<String>)) {
        let is_scattered = |boxes: &Boxes| boxes.scatter.is_some_and(|scatter| scatter.position > 0.0);
        let free = self.boxes.iter().enumerate().filter(|(_, boxes)| !boxes.fixed && !is_scattered(boxes));
        let mut places = Vec::new();
        for (i, boxes) in free {
            let spacing = boxes.spacing.unwrap_or(Vec3::ONE).to_array();
            let axes = ["x", "y", "z"].into_iter().zip(boxes.count.into_iter().zip(spacing));
            let heap = axes.filter(|(_, (count, spacing))| *count > 1 && *spacing == 0.0).map(|(name, _)| name).next();
            let all =
                |name| format!("0 along {name} puts them into each other, and what begins so need not come apart");
            add(format_args!("boxes[{i}].spacing"), heap.map(all));
            // Zero has two signs.
            places.push(((boxes.position + Vec3::ZERO).to_array().map(f32::to_bits), i));
        }
        places.sort_unstable();
        for pair in places.windows(2).filter(|pair| pair[0].0 == pair[1].0) {
            let [before, i] = [pair[0].1, pair[1].1];
            let same = format!("it is that of boxes[{before}], and what begins in each other need not come apart");
            add(format_args!("boxes[{i}].position"), Some(same));
        }
    }

    /// A remark on what weighs too much for a sheet with thickness that hangs by some of its points and that it may come to lie on: in sub-steps of h it sinks
    /// into it by its mass over that of a point times g h² / 4, as measured within a factor of two, a body through it from the thickness on, the points of
    /// another sheet, which find the way between its own, from a 32nd of that.
    pub(super) fn heavy_on_cloth(&self, cloth: &Cloth) -> Option<String> {
        if cloth.fixed.is_empty() {
            return None;
        }
        let (thickness, point) = (cloth.thickness.filter(|&thickness| thickness > 0.0)?, cloth.point_mass()?);
        let boxes = self.boxes.iter().filter(|boxes| !boxes.fixed).filter_map(Boxes::weight);
        let balls = self.particles.iter().filter(|ball| !ball.fixed && ball.radius > 0.0).map(|ball| ball.mass);
        let others = self.cloths.iter().filter(|other| other.fixed.is_empty() && other.thickness.is_some());
        let points = others.filter_map(Cloth::point_mass).filter(|&other| other > point);
        let [body, sheet] = [boxes.chain(balls).fold(0.0, f32::max), points.fold(0.0, f32::max)];
        let pull = length(self.pull());
        let depth = |load: f32, substeps: u32| {
            let h = self.run.dt as f32 / substeps as f32;
            0.25 * (load / point) * pull * h * h
        };
        let taken = self.substeps();
        let mut sinks = [(body, 1.0, "what weighs"), (sheet, 1.0 / 32.0, "a sheet whose points weigh")].into_iter();
        sinks.find_map(|(load, share, what)| {
            let least = (taken..=MOST_SUBSTEPS).find(|&substeps| !(depth(load, substeps) > share * thickness));
            let says = || {
                let helps = least.map_or("it is far too much".into(), enough);
                format!("{what} {load} kg sinks into it, whose points weigh {point} kg each, or falls through; {helps}")
            };
            (least != Some(taken)).then(says)
        })
    }

    /// A remark on a plate: a sheet that is held by some of its points and that stands by its stiffness against bending. A sub-step solves what is linear
    /// in its way, and a cell of length ℓ that turns through g h² is longer by (g h² / ℓ)² / 2 of itself then; where what that pulls with is more than its
    /// weight it sags too far, or shakes.
    pub(super) fn long_for_plate(&self, cloth: &Cloth) -> Option<String> {
        /// The share of its weight that it pulls with from which on it shows, as measured.
        const SHOWS: f32 = 2.0;
        /// The share of its longer side that bending bears by itself.
        const STANDS: f32 = 0.25;
        let (params, sheet) = (cloth.shell_params()?, cloth.sheet()?);
        let [a, b] = sheet.sides;
        let density = cloth.by_area().unwrap_or(cloth.mass / length(a.cross(b)));
        let (pull, taken) = (length(self.pull()), self.substeps() as f32);
        let longest = sheet.sides.map(length).into_iter().fold(0.0, f32::max);
        let (weight, share) = (density * pull, STANDS * longest);
        if cloth.fixed.is_empty() || !(params.bending > weight * share * share * share) {
            return None;
        }
        let cells = sheet.sides.into_iter().zip(sheet.cells).map(|(side, cells)| length(side) / cells as f32);
        let h = self.run.dt as f32 / taken;
        let turns = pull * h * h / cells.fold(f32::INFINITY, f32::min);
        let stretch = params.stretch.into_iter().fold(0.0, f32::max);
        let excess = 0.5 * turns * turns * stretch / (SHOWS * weight * longest);
        let shakes = || {
            let needed = (taken * sqrt(sqrt(excess))) as u32;
            let needed = needed.saturating_add(1);
            format!(
                "it is so stiff that what it stretches by as it bends in a sub-step outweighs it: it hangs too far, or shakes; {}",
                enough(needed)
            )
        };
        (excess > 1.0 && excess < f32::INFINITY).then(shakes)
    }

    /// The sum of all gravity \[m/s²\].
    pub(in crate::scene) fn pull(&self) -> Vec3 {
        self.forces.iter().fold(Vec3::ZERO, |sum, force| match force {
            ForceKind::Gravity(gravity) => sum + gravity.acceleration,
            _ => sum,
        })
    }
}

/// Words for what helps where a remark asks for so many sub-steps.
pub(in crate::scene) fn enough(needed: u32) -> String {
    match needed {
        ..=MOST_SUBSTEPS => format!("run.substeps of {needed} are enough"),
        _ => format!("no number of sub-steps is enough, of which run.substeps may say {MOST_SUBSTEPS}"),
    }
}
