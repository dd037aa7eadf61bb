//! Deletion: who has to go at the end of a step, and why. One file a rule.
//!
//! Age and numbers that are no longer finite end everybody; sinks end whoever touches them, which collisions find out; a
//! scene's reapers end whom they choose. All judge the same state before anyone goes.

mod chance;
mod dense;
mod kind;
mod lifetime;
mod nonfinite;

pub use chance::Chance;
pub use dense::Dense;
pub use kind::ReaperKind;

use crate::custom::CustomColumns;
use crate::force::State;
use crate::math::max;
use crate::memory::Layout;
use crate::observe::{Observer, Passing};
use crate::particles::Id;
use crate::report::Report;
use crate::scene::Scene;
use crate::step::View;
use crate::time::Time;
use core::ops::Range;
use glam::Vec3;
pub(crate) use lifetime::Lifetime;
pub(crate) use nonfinite::Nonfinite;

/// Rows that are looked at together.
const CHUNK: usize = 64;

/// A rule by which particles die.
///
/// A tuple, slice or reference of reapers is a reaper: whoever any of them takes goes.
pub trait Reaper: Sync {
    /// Says who of `rows` has to go by `state.time`, the end of the step.
    ///
    /// Rows are independent of each other, so that any division of the work gives the same bits. Of some a number may no
    /// longer be finite; they go in any case. For a reaper that asks who is near, those who die of age or at a sink are nowhere
    /// as well: they crowd nobody.
    fn judge(&self, state: &State<'_>, rows: Range<usize>, verdicts: &mut Verdicts<'_>);

    /// How far it asks who is near, by [`State::count_within`] \[m\]; zero: it does not.
    fn reach(&self) -> f32 {
        0.0
    }

    /// Whether it takes nobody, whatever the state: no row is looked at then.
    fn is_empty(&self) -> bool {
        false
    }
}

/// Why a particle died. Of several causes in one step the last in this list counts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize), serde(rename_all = "snake_case"))]
pub enum Cause {
    /// Of age.
    Lifetime,
    /// By a rule of the program's own.
    Other,
    /// Where too many were.
    Density,
    /// By chance.
    Chance,
    /// It touched a sink.
    Sink,
    /// A number of its was no longer finite.
    Nonfinite,
}

/// What becomes of a particle at the end of the step.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub enum Fate {
    /// It lives on.
    #[default]
    Lives,
    /// It dies of age.
    Lifetime,
    /// It dies by a rule of the program's own.
    Other,
    /// It dies where too many are.
    Density,
    /// It dies by chance.
    Chance,
    /// It touched a sink.
    Sink,
    /// A number of its is no longer finite.
    Nonfinite,
}

impl Fate {
    /// Why it has to go, if it has.
    #[must_use]
    pub const fn cause(self) -> Option<Cause> {
        match self {
            Self::Lives => None,
            Self::Lifetime => Some(Cause::Lifetime),
            Self::Other => Some(Cause::Other),
            Self::Density => Some(Cause::Density),
            Self::Chance => Some(Cause::Chance),
            Self::Sink => Some(Cause::Sink),
            Self::Nonfinite => Some(Cause::Nonfinite),
        }
    }
}

impl From<Cause> for Fate {
    fn from(cause: Cause) -> Self {
        match cause {
            Cause::Lifetime => Self::Lifetime,
            Cause::Other => Self::Other,
            Cause::Density => Self::Density,
            Cause::Chance => Self::Chance,
            Cause::Sink => Self::Sink,
            Cause::Nonfinite => Self::Nonfinite,
        }
    }
}

/// What reapers say of the rows they are asked about.
#[derive(Debug)]
pub struct Verdicts<'a> {
    fates: &'a mut [Fate],
    claimed: u32,
}

impl<'a> Verdicts<'a> {
    /// On rows whose fates so far these are.
    pub fn on(fates: &'a mut [Fate]) -> Self {
        Self { fates, claimed: 0 }
    }

    /// A number that no other reaper of the list has, and this one in every step: the place of the word that it draws of each
    /// particle's own ([`State::word`]), so that the choices of two reapers have nothing to do with each other. To be claimed
    /// whoever is judged.
    pub fn claim(&mut self) -> u32 {
        self.claimed += 1;
        self.claimed - 1
    }

    /// The particle in the `nth` of the rows has to go.
    #[inline]
    pub fn end(&mut self, nth: usize, cause: Cause) {
        if let Some(fate) = self.fates.get_mut(nth) {
            *fate = (*fate).max(cause.into());
        }
    }
}

/// Removes those whom the step has ended by `now`.
pub(crate) fn reap(
    view: &mut View<'_>,
    scene: &Scene<'_>,
    now: Time,
    report: &mut Report,
    observer: &mut dyn Observer,
) {
    if !scene.reapers.is_empty() {
        judge(view, scene);
    }
    // From the back, so that the row that fills a gap has been looked at already.
    let mut end = view.len();
    while let Some((row, cause)) = last_doomed(&view.memory.fate[..end]) {
        report.died.count(cause);
        let m = &view.memory;
        let id = Id { slot: m.slot[row], serial: m.serial[row] };
        observer.died(&Passing { id, place: m.position[row], velocity: m.velocity[row], time: now }, cause);
        view.remove(row, scene.springs, report);
        end = row;
    }
}

/// Lets the scene's reapers choose.
fn judge(view: &mut View<'_>, scene: &Scene<'_>) {
    let (rows, reapers) = (0..view.len(), scene.reapers);
    let capacity = view.capacity();
    let layout = Layout::of(scene.plan(), capacity);
    // Reapers see everything but the fates and the memory of the index.
    let (fates, work) = (core::mem::take(&mut view.memory.fate), core::mem::take(&mut view.memory.work));
    let custom = CustomColumns::kept(scene.custom, view.memory.kept, capacity, rows.len());
    let state = State { custom, ..view.state(scene) };
    let mut verdicts = Verdicts::on(&mut fates[rows.clone()]);
    if reapers.reach() > 0.0 {
        let (position, words) = layout.crowd(work, rows.len());
        for ((place, &x), &fate) in position.iter_mut().zip(state.position).zip(&*verdicts.fates) {
            *place = if fate == Fate::Lives { x } else { Vec3::NAN };
        }
        scene.index.arrange(words, position, reapers.reach(), &mut |near| {
            reapers.judge(&State { position, near, ..state }, rows.clone(), &mut verdicts);
        });
    } else {
        reapers.judge(&state, rows, &mut verdicts);
    }
    (view.memory.fate, view.memory.work) = (fates, work);
}

/// The last row that has to go. Hardly any has, so whole chunks are passed over.
fn last_doomed(fates: &[Fate]) -> Option<(usize, Cause)> {
    let has_doomed = |chunk: &[Fate]| chunk.iter().fold(0, |any, &fate| any | fate as u8) != 0;
    let behind = fates.rchunks(CHUNK).position(has_doomed)?;
    let row = fates[..fates.len() - CHUNK * behind].iter().rposition(|&fate| fate != Fate::Lives)?;
    Some((row, fates[row].cause()?))
}

impl Reaper for () {
    fn judge(&self, _: &State<'_>, _: Range<usize>, _: &mut Verdicts<'_>) {}
    fn is_empty(&self) -> bool {
        true
    }
}

/// What has parts is any of them.
macro_rules! any_of {
    ($this:ident => $parts:expr) => {
        fn judge(&self, state: &State<'_>, rows: Range<usize>, verdicts: &mut Verdicts<'_>) {
            let $this = self;
            for part in $parts {
                part.judge(state, rows.clone(), verdicts);
            }
        }
        fn reach(&self) -> f32 {
            let $this = self;
            let mut most = 0.0;
            for part in $parts {
                most = max(part.reach(), most);
            }
            most
        }
        fn is_empty(&self) -> bool {
            let $this = self;
            $parts.into_iter().all(|part| part.is_empty())
        }
    };
}

/// What stands for another reaper is that reaper.
macro_rules! same_as {
    ($this:ident => $reaper:expr) => {
        fn judge(&self, state: &State<'_>, rows: Range<usize>, verdicts: &mut Verdicts<'_>) {
            let $this = self;
            $reaper.judge(state, rows, verdicts);
        }
        fn reach(&self) -> f32 {
            let $this = self;
            $reaper.reach()
        }
        fn is_empty(&self) -> bool {
            let $this = self;
            $reaper.is_empty()
        }
    };
}

impl<T: Reaper + ?Sized> Reaper for &T {
    same_as!(this => **this);
}

impl Reaper for ReaperKind {
    same_as!(this => this.get());
}

impl<T: Reaper> Reaper for [T] {
    any_of!(this => this);
}

impl<T: Reaper, const N: usize> Reaper for [T; N] {
    any_of!(this => this);
}

impl<T: Reaper, const N: usize> Reaper for heapless::Vec<T, N> {
    any_of!(this => this);
}

#[cfg(feature = "alloc")]
impl<T: Reaper> Reaper for alloc::vec::Vec<T> {
    any_of!(this => this);
}

macro_rules! tuples {
    ($($name:ident)+) => {
        impl<$($name: Reaper),+> Reaper for ($($name,)+) {
            any_of!(this => {
                #[allow(non_snake_case)]
                let ($($name,)+) = this;
                [$($name as &dyn Reaper),+]
            });
        }
    };
}
tuples!(A);
tuples!(A B);
tuples!(A B C);
tuples!(A B C D);
