//! Bodies that hang from others, as a file declares them: how fast ropes turn them to and fro, and how far they let sheets sink.

use super::remarks::load::enough;
use super::{Body, BodyTie, Boxes, Cord, SceneFile};
use crate::constrain::{root, unite};
use crate::math::{length, max, sqrt};
use alloc::format;
use alloc::string::String;
use alloc::vec;
use alloc::vec::Vec;
use glam::Vec3;

/// Radians that a body may turn by in a sub-step, as measured for up to eight below each other, and for some of a hundred times the weight of what bears them.
const TURNS: f32 = 0.8;

/// The numbers of the bodies that a rope is tied to.
fn bodies(cord: &Cord) -> impl Iterator<Item = u32> {
    let body = |end| if let Body::Box(number) = end { Some(number) } else { None };
    cord.ends.into_iter().flatten().filter_map(body)
}

impl SceneFile {
    /// A remark on bodies that more than one rope pulls at, with the number of the rope that turns one fastest: of mass m and with d as the smallest diagonal of its sides, between ropes of
    /// length L that pull with T, it turns by ω² = T a (1 + a / L) / I, with a = d / 2 and I = m d² / 12. T is at most the weight of all that hangs together.
    pub(super) fn hung_in_turn(&self) -> Option<(usize, String)> {
        let mut names: Vec<u32> = self.ropes.iter().flat_map(bodies).collect();
        names.sort_unstable();
        names.dedup();
        let free: Vec<_> = names.iter().map(|&name| self.boxes_of(name).filter(|boxes| !boxes.fixed)).collect();
        let places = |cord| {
            let place = |name| names.binary_search(&name).ok().filter(|&place| free[place].is_some());
            bodies(cord).filter_map(place)
        };
        let (mut ropes, mut bound) = (vec![0u32; names.len()], Vec::from_iter(0..names.len() as u32));
        for cord in &self.ropes {
            places(cord).for_each(|place| ropes[place] += 1);
            if let (Some(one), Some(other)) = (places(cord).next(), places(cord).nth(1)) {
                unite(&mut bound, one as u32, other as u32);
            }
        }
        let mut loads = vec![0.0; names.len()];
        for (place, boxes) in free.iter().enumerate() {
            loads[root(&mut bound, place as u32) as usize] += boxes.and_then(Boxes::weight).unwrap_or(0.0);
        }
        let mut fastest = (0, 0.0);
        for (number, cord) in self.ropes.iter().enumerate() {
            let long = cord.curve.windows(2).map(|ends| length(ends[1] - ends[0])).sum();
            for place in places(cord).filter(|&place| ropes[place] > 1) {
                let load = loads[root(&mut bound, place as u32) as usize] * length(self.pull());
                let turn = free[place].and_then(|boxes| turn(boxes, load, long)).unwrap_or(0.0);
                fastest = if turn > fastest.1 && turn < f32::INFINITY { (number, turn) } else { fastest };
            }
        }
        let (number, turn) = fastest;
        let needed = ((self.run.dt as f32 * turn / TURNS) as u32).saturating_add(1);
        let says = || {
            format!(
                "it pulls at a body that another rope pulls at too: they turn it to and fro by {turn:.0} rad/s, and throw it about in few sub-steps; {}",
                enough(needed)
            )
        };
        (needed > self.substeps()).then(|| (number, says()))
    }

    /// A remark on a rope from a point of a sheet, with what hangs from it: a sheet does not feel what ropes pull at it until they have. A load of n times the point's mass, or a sheet
    /// that ropes hold, sinks by about 8 n g h² beyond what it gives, as measured with n from 100 to 700; a hundredth of the sheet is too much.
    pub(super) fn hung_on_sheet(&self, cord: &Cord) -> Option<String> {
        const SINKS: f32 = 8.0;
        const MOST: f32 = 0.01;
        let number = |end: Option<Body>| if let Some(Body::Cloth(number)) = end { Some(number) } else { None };
        let side = cord.ends.into_iter().position(|end| number(end).is_some())?;
        let (number, far) = (number(cord.ends[side])?, if side == 0 { cord.segments } else { 0 });
        let cloth = self.cloths.get(number as usize)?;
        let (sheet, _) = cloth.sheet().zip(cloth.shell_params())?;
        let (point, long) = (cloth.point_mass()?, sheet.sides.map(length).into_iter().fold(0.0, max));
        let boxes = match cord.ends[1 - side] {
            Some(Body::Box(number)) => self.boxes_of(number),
            Some(_) => return None,
            None => None,
        };
        let holds = boxes.map_or(cord.fixed.contains(&far), |boxes| boxes.fixed);
        // Only who asks goes over all of them.
        let ropes =
            || self.ropes.iter().flat_map(|cord| cord.ends).filter(|&end| end == Some(Body::Cloth(number))).count();
        let load = if !holds {
            boxes.and_then(Boxes::weight).unwrap_or(0.0) + cord.mass()
        } else if cloth.fixed.is_empty() {
            point * cloth.count()? as f32 / ropes() as f32
        } else {
            return None;
        };
        let times = sqrt(SINKS * (load / point) * length(self.pull()) / (MOST * long));
        let needed = ((self.run.dt as f32 * times) as u32).saturating_add(1);
        let is_told = times < f32::INFINITY && needed > self.substeps();
        is_told.then(|| {
            format!(
                "it bears {load} kg at a point of a sheet that weighs {point} kg, and gives way far more than both do; {} for a hundredth of the sheet",
                enough(needed)
            )
        })
    }

    /// A remark on a rope that is sewn to a sheet: both are solved apart, and what each does to the points of the other that lie between its own drives them.
    pub(super) fn sewn_to_sheet(&self, tie: &BodyTie) -> Option<String> {
        let (Some(Body::Rope(_)), Body::Cloth(number)) = (tie.of, tie.to) else { return None };
        let is_shell = self.cloths.get(number as usize)?.shell_params().is_some();
        let is_sewn = is_shell && tie.points.len() > 1 && tie.compliance == 0.0;
        is_sewn.then(|| {
            String::from(
                "a rope that is sewn to a sheet between points of that may drive it ever faster; give it points where the sheet has them, or take a strand",
            )
        })
    }

    /// The boxes that a body with such a number is one of.
    fn boxes_of(&self, number: u32) -> Option<&Boxes> {
        let mut left = u64::from(number);
        self.boxes.iter().find(|boxes| {
            let is_here = left < boxes.number();
            left = left.saturating_sub(boxes.number());
            is_here
        })
    }
}

/// How fast ropes so long \[m\] turn a body to and fro under such a load \[N\], at the most \[rad/s\]; none, if that takes its mesh to know.
fn turn(boxes: &Boxes, load: f32, long: f32) -> Option<f32> {
    let (sides, mass) = boxes.size(None).zip(boxes.weight())?;
    let Vec3 { x, y, z } = sides * sides;
    let across = sqrt(x + y + z - max(max(x, y), z));
    Some(sqrt(load / mass * (6.0 / across + 3.0 / long)))
}
