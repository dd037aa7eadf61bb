//! Rigid bodies: how far piles of them sink, and in which sub-steps they turn too far.

use super::hold::{Hold, Solving};
use super::part::place;
use super::words::{plain, time};
use crate::stall::gravity;
use glam::{Quat, Vec3};
use pointmass::constrain::RigidBox;
use pointmass::scene::Model;
use std::collections::HashMap;

/// The most boxes that make a pile if they come to lie on each other.
const PILE: usize = 10;
/// The turn of a box in a sub-step from which on it may be met too late \[rad\].
pub(super) const TURN: f64 = 0.5;

/// By how much a pile of so many boxes sinks where it does so most, for each m/s² of gravity and s² of a sub-step \[m\]: as measured
/// within a twentieth of what three to twenty do, and two.
fn sinks(pile: usize) -> f64 {
    (0.246 * pile as f64 - 0.59).max(0.03)
}

/// The number of boxes that stand on each other in the tallest pile to begin with, as far as gravity pulls.
fn tallest(model: &Model) -> usize {
    let Some(up) = (-gravity(model)).try_normalize() else { return 0 };
    let mut all: Vec<Standing> = model.constraints.1.boxes.iter().map(|of| Standing::of(model, of, up)).collect();
    all.sort_by(|a, b| a.height.total_cmp(&b.height));
    let (a, b) = up.any_orthonormal_pair();
    let wide = all.iter().map(|of| 2.0 * of.radius()).fold(f32::MIN_POSITIVE, f32::max);
    let cell = |of: &Standing| [a, b].map(|axis| (axis.dot(of.center) / wide).floor() as i64);
    let (mut below, mut most) = (HashMap::<[i64; 2], Vec<usize>>::new(), 0);
    for number in 0..all.len() {
        let [x, y] = cell(&all[number]);
        let near = (-1..=1).flat_map(|i| (-1..=1).map(move |j| [x.saturating_add(i), y.saturating_add(j)]));
        let others = near.filter_map(|cell| below.get(&cell)).flatten();
        let on = others.filter(|&&other| all[number].stands_on(&all[other], up)).map(|&other| all[other].above);
        let above = on.max().unwrap_or(0) + usize::from(!all[number].fixed);
        all[number].above = above;
        most = most.max(above);
        below.entry([x, y]).or_default().push(number);
    }
    most
}

/// A box where it begins.
struct Standing {
    center: Vec3,
    /// Half its sides \[m\], as vectors.
    half: [Vec3; 3],
    height: f32,
    fixed: bool,
    /// The number of boxes from it downward.
    above: usize,
}

impl Standing {
    fn of(model: &Model, of: &RigidBox, up: Vec3) -> Self {
        let turn = Quat::from_array(of.turn);
        let turn = if turn.length_squared() > 0.0 { turn.normalize() } else { Quat::IDENTITY };
        let half = [Vec3::X * of.half.x, Vec3::Y * of.half.y, Vec3::Z * of.half.z].map(|side| turn * side);
        let fixed = model.particles.get(of.first as usize).is_some_and(|particle| particle.fixed);
        Self { center: of.center, half, height: up.dot(of.center), fixed, above: 0 }
    }

    /// How far it reaches from its middle in any direction \[m\].
    fn radius(&self) -> f32 {
        self.half.iter().map(|side| side.length()).sum()
    }

    /// How far it reaches from its middle in a direction \[m\].
    fn reach(&self, way: Vec3) -> f32 {
        self.half.iter().map(|side| side.dot(way).abs()).sum()
    }

    /// Tells whether it lies on another, but for a tenth of its height.
    fn stands_on(&self, other: &Self, up: Vec3) -> bool {
        let (way, thick) = (self.center - other.center, self.reach(up) + other.reach(up));
        let above = up.dot(way);
        let aside = way - up * above;
        let is_over = aside.try_normalize().is_none_or(|way| aside.length() < self.reach(way) + other.reach(way));
        above > 0.5 * thick && above < 1.1 * thick && is_over
    }
}

impl Hold {
    /// Boxes of one size.
    pub(super) fn boxes(model: &Model, group: &[RigidBox]) -> Self {
        let half = f64::from(group[0].half.min_element());
        let weight = f64::from(gravity(model).length());
        let all = &model.constraints.1.boxes;
        let pile = Some(all.len().min(PILE).max(tallest(model))).filter(|&boxes| boxes > 1);
        Self {
            calm: f64::INFINITY,
            place: place(model, 0, group[0].first as usize),
            kind: "boxes",
            count: group.len(),
            particles: group.iter().map(|of| of.count as usize).sum(),
            stiffness: None,
            rate: None,
            gives: 0.0,
            owes: pile.map_or(0.0, sinks) * weight / (2.0 * half),
            estimated: false,
            fall: None,
            half: Some(half),
            tumbles: (4.0 * weight * half).sqrt() / half,
            pile,
            more: 0,
            leads: false,
            solving: Solving::default(),
        }
    }

    /// The warning about sub-steps of `h` \[s\] in which boxes that fall turn too far, and the sub-steps that are short enough for that \[s\]; or none.
    pub(crate) fn tumbling(&self, h: f64) -> Option<(String, f64)> {
        let (turn, enough) = (self.tumbles * h, TURN / self.tumbles);
        (turn > TURN * (1.0 + 1e-6)).then(|| {
            let (name, now) = (self.name(), time(h));
            let told = format!(
                "in sub-steps of {now} {name} that have fallen by their own size may turn by {} rad, and sink into what they strike by a \
                 twentieth of their size and more",
                plain(turn)
            );
            (told, enough)
        })
    }
}
