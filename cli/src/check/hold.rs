//! Constraints: how stiff each is, how it is solved, how far its own weight stretches it, and what sub-steps buy.

use super::bodies;
use super::fall::{self, Fall};
use super::part::place;
use super::statics::Hanging;
use super::words::{plain, time};
use crate::report::words::short;
use crate::stall::gravity;
use pointmass::ConstraintKind;
use pointmass::scene::Model;
use pointmass::stability::Limit;
use serde::Serialize;
use std::collections::BTreeSet;
use std::fmt::Write;

/// The share by which a constraint may be off.
pub(crate) const FAULT: f64 = 0.01;

/// The share of a box that a pile sinks by from which on it has been seen to fall through itself without friction; with friction from three times
/// that on.
const FALLS: f64 = 0.055;
/// The share of a link by which gravity takes a rope's particles on in a sub-step, from which on slack ropes may tremble for ever. Which of them do hangs on
/// their drag: some at 0.1, most at 0.14.
const TREMBLES: f64 = 0.08;

/// Constraints of one kind that follow each other in a scene, or a sheet; with the worst of each figure.
#[derive(Debug, Serialize)]
pub(crate) struct Hold {
    /// Where the first stands in the file.
    pub(crate) place: String,
    pub(crate) kind: &'static str,
    /// Their number, and that of their particles.
    pub(crate) count: usize,
    pub(crate) particles: usize,
    /// The stiffness of the stiffest \[N/m\]; none: rigid.
    pub(crate) stiffness: Option<f64>,
    /// The rate of the fastest oscillation, were it alone \[1/s\]; none where it is rigid.
    pub(crate) rate: Option<f64>,
    /// The share by which its own weight stretches it, were it hung from what is fixed: by its stiffness alone.
    pub(crate) gives: f64,
    /// The share by which it is off beyond that, for each s² of a sub-step \[1/s²\], as long as that does not change how it hangs.
    pub(crate) owes: f64,
    /// True if both are estimates, since what hangs did not come to rest in time.
    pub(crate) estimated: bool,
    /// The fall of a sheet.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) fall: Option<Fall>,
    /// Half the least side of boxes \[m\].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) half: Option<f64>,
    /// How fast boxes may turn that strike something with a corner when they have fallen by their own size \[rad/s\].
    #[serde(skip)]
    pub(super) tumbles: f64,
    /// The longest sub-step in which slack ropes come to rest \[s\].
    #[serde(skip)]
    pub(super) calm: f64,
    /// The number of boxes in the pile that `owes` is told of: the tallest to begin with, and all there are up to ten; none: there is but one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) pile: Option<usize>,
    /// The number of constraints of that kind that follow the first.
    #[serde(skip)]
    pub(super) more: usize,
    /// True if they go where a script says, whatever pulls at them.
    #[serde(skip)]
    pub(crate) leads: bool,
    #[serde(skip)]
    pub(super) solving: Solving,
}

/// How a sub-step solves constraints.
#[derive(Debug, Default)]
pub(super) struct Solving {
    /// The words for that; none for boxes.
    words: &'static str,
    /// True if they are links of known lengths.
    links: bool,
    /// True if it takes iterations until little is left.
    iterates: bool,
}

impl Hold {
    /// All of a scene, as its particles begin.
    pub(crate) fn all(model: &Model) -> Vec<Self> {
        let hanging = Hanging::of(model);
        let owed = hanging.owed(model);
        // What knows by itself how its weight stretches it has a row of its own.
        let weighs = |of: &ConstraintKind| of.hung(&model.particles, 0.0).is_some();
        let alike = |a: &ConstraintKind, b: &ConstraintKind| a.name() == b.name() && !weighs(a);
        let held = fall::held(model);
        let mut first = 0;
        let mut all: Vec<_> = model
            .constraints
            .0
            .chunk_by(alike)
            .map(|group| {
                let of = first..first + group.len();
                let links = hanging.links.iter().zip(&hanging.pull).zip(&owed);
                let links = links.filter(|((link, _), _)| link.of.is_some_and(|number| of.contains(&number)));
                let shares = links
                    .filter(|((link, _), _)| link.length > 0.0)
                    .map(|((link, pull), owed)| [link.compliance * pull / link.length, owed / link.length]);
                let [gives, owes] = shares.fold([0.0; 2], |[a, b], [x, y]| [f64::max(a, x), f64::max(b, y)]);
                let estimated = !hanging.is_at_rest && owes + gives > 0.0;
                let of_group = Self::of(model, group, first, &held);
                let hold = Self { gives: of_group.gives.max(gives), owes, estimated, ..of_group };
                first = of.end;
                hold
            })
            .collect();
        all.extend(model.constraints.1.boxes.chunk_by(|a, b| a.half == b.half).map(|group| Self::boxes(model, group)));
        all
    }

    /// Constraints of one kind, without what links are known for.
    fn of(model: &Model, group: &[ConstraintKind], first: usize, held: &[bool]) -> Self {
        let (start, kind) = (&model.particles[..], &group[0]);
        let ends: BTreeSet<u32> = group.iter().flat_map(ConstraintKind::ends).copied().collect();
        let stiffness = |of: &ConstraintKind| of.stiffness(start).map(|k| [k, (k * of.inverse_mass(start)).sqrt()]);
        let stiffest = |a: Option<[f64; 2]>, b: Option<[f64; 2]>| Some([a?[0].max(b?[0]), a?[1].max(b?[1])]);
        let stiffest = group.iter().map(stiffness).reduce(stiffest).flatten();
        let gravity = gravity(model).length();
        let ropes = group.iter().filter(|of| of.name() == "rope");
        let links = ropes.flat_map(|of| of.links().zip(of.lengths())).map(|(_, length)| f64::from(length));
        let shortest = links.filter(|&length| length > 0.0).fold(f64::INFINITY, f64::min);
        Self {
            calm: (TREMBLES * shortest / f64::from(gravity)).sqrt(),
            place: match kind.ends().next() {
                Some(&end) if first >= model.listed_constraints => place(model, 0, end as usize),
                _ => format!("constraints[{first}]"),
            },
            kind: kind.name(),
            count: group.iter().map(ConstraintKind::count).sum(),
            particles: ends.len(),
            stiffness: stiffest.map(|[stiffness, _]| stiffness),
            rate: stiffest.map(|[_, rate]| rate),
            gives: group.iter().filter_map(|of| of.hung(start, gravity)).fold(0.0, f64::max),
            owes: 0.0,
            estimated: false,
            fall: Fall::of(model, kind, held),
            half: None,
            tumbles: 0.0,
            pile: None,
            more: group.len() - 1,
            leads: kind.leads(),
            solving: Solving {
                words: kind.solved(),
                links: kind.lengths().next().is_some(),
                iterates: kind.iterates(),
            },
        }
    }

    /// The share by which it is off in sub-steps of `h` \[s\], beyond what it gives way.
    pub(crate) fn fault(&self, h: f64) -> f64 {
        self.owes * h * h
    }

    /// The longest sub-step that leaves it off by one per cent at the most.
    pub(crate) fn largest_step(&self) -> Limit {
        if self.owes > 0.0 { Limit::Step((FAULT / self.owes).sqrt()) } else { Limit::Unconditional }
    }

    /// The longest sub-step that leaves it off by one per cent at the most, at rest and where it falls.
    pub(crate) fn enough(&self) -> Limit {
        let falling = self.fall.map_or(Limit::Unconditional, |fall| Limit::Step(fall.step(FAULT)));
        self.largest_step().and(falling)
    }

    /// Its name: the first of it, and how many follow.
    pub(crate) fn name(&self) -> String {
        match self.more {
            0 => self.place.clone(),
            more => format!("{} and {more} more", self.place),
        }
    }

    /// The words for what it does in sub-steps of `h` \[s\].
    pub(crate) fn told(&self, h: f64) -> String {
        let about = if self.estimated { "about " } else { "" };
        let off = format!("{about}{} %", short(100.0 * self.fault(h)));
        if let Some(half) = self.half {
            let (speed, turn) = (plain(half / h), plain(bodies::TURN / h));
            let pile = self.pile.map_or(String::new(), |pile| format!("a pile of {pile} sinks by {off} of a box; "));
            return format!("{pile}{speed} m/s go half through, {turn} rad/s are too fast");
        }
        let Solving { words, links, iterates } = self.solving;
        let mut told = words.to_owned();
        if iterates {
            let _ = write!(told, ", in {} iterations at most", self.iterations(h));
        }
        if links {
            told += &if self.owes > 0.0 { format!(": {off} too long at rest") } else { ": exact".into() };
        }
        told.extend(self.fall.map(|fall| {
            let (speed, gives) = (plain(fall.speed), short(100.0 * fall.gives));
            let more = match fall.fault(h) {
                Some(share) => format!("by up to {} % beyond that", short(100.0 * share)),
                None => format!("by far more, as it goes {} edges in each", plain(fall.speed * h / fall.edge)),
            };
            format!("; a hit at {speed} m/s stretches it by up to {gives} %, and sub-steps {more}")
        }));
        if self.rate.is_some_and(|rate| h * rate > 1.0) {
            let _ = write!(told, "; swings below {} fade", time(std::f64::consts::TAU * h));
        }
        told.extend(self.fades(h));
        told
    }

    /// What a second of sub-steps of `h` \[s\] takes of the swing of a cluster, which has one frequency, in words: (1 + h² ω²)^(-1/2) is
    /// left by each, as by implicit Euler.
    fn fades(&self, h: f64) -> Option<String> {
        let rate = self.rate.filter(|_| self.kind == "cluster")?;
        let share = 1.0 - (-0.5 / h * (h * rate).powi(2).ln_1p()).exp();
        (share > FAULT).then(|| format!("; a second takes {} % of its swing", short(100.0 * share)))
    }

    /// The number of iterations of conjugate gradients that take the error to 1e-4 in sub-steps of `h` \[s\]: ½ √κ ln(2/ε) at the
    /// most (Shewchuk, "An Introduction to the Conjugate Gradient Method Without the Agonizing Pain", 1994, section 9), with κ = 1 + h² ω².
    pub(crate) fn iterations(&self, h: f64) -> u64 {
        let rate = h * self.rate.unwrap_or(0.0);
        (0.5 * rate.hypot(1.0) * 2e4f64.ln()).ceil() as u64
    }

    /// The warning about sub-steps of `h` \[s\] in which slack ropes do not come to rest, and the sub-steps that are short enough for that \[s\]; or none.
    pub(crate) fn trembling(&self, h: f64) -> Option<(String, f64)> {
        let (name, now, enough) = (self.name(), time(h), time(self.calm));
        let told = || {
            format!(
                "in sub-steps of {now} {name} may tremble for ever where slack, as gravity moves its particles by more than {TREMBLES} of a link in each; \
                 {enough} are short enough"
            )
        };
        (h > self.calm * (1.0 + 1e-6)).then(|| (told(), self.calm))
    }

    /// The warning about sub-steps of `h` \[s\] that leave it too far off, or none.
    pub(crate) fn warning(&self, h: f64) -> Option<String> {
        let Limit::Step(enough) = self.largest_step() else { return None };
        let (name, off, now, enough_for) = (self.name(), short(100.0 * self.fault(h)), time(h), time(enough));
        (h > enough * (1.0 + 1e-6)).then(|| match self.pile {
            Some(pile) => {
                let falls = if self.fault(h) > FALLS { ", and may fall through itself, without friction first" } else { "" };
                format!(
                    "in sub-steps of {now} a pile of {pile} of {name} sinks by {off} % of a box{falls}; {enough_for} leave 1 %"
                )
            }
            None => format!(
                "in sub-steps of {now} {name} hang up to {off} % longer than they are, since each is met once; {enough_for} leave \
                 1 %, and a rope does in any, unless a run says that it was cut short"
            ),
        })
    }
}
