//! Deletion: who has to go at the end of a step, and why. One file a rule.
//!
//! Age and numbers that are no longer finite end everybody; sinks end whoever touches them, which collisions find out; a
//! scene's reapers end whom they choose. All judge the same state before anyone goes.

mod cause;
mod chance;
mod dense;
mod kind;
mod lifetime;
mod nonfinite;

pub use cause::{Cause, PendingDeath};
pub use chance::Chance;
pub use dense::Dense;
pub use kind::ReaperKind;

use crate::composed::{composed, each, stands_for};
use crate::force::State;
use crate::index::{Neighbours, StateIndex};
use crate::math::max;
use core::ops::Range;
use glam::Vec3;
pub(crate) use lifetime::end_old;
pub(crate) use nonfinite::end_lost;

/// Rows whose fates are passed over together: two registers of bytes.
pub(crate) const CHUNK: usize = 64;

/// A rule by which particles die.
///
/// A tuple, slice, option, reference or box of reapers is a reaper: whoever any of them takes goes.
///
/// ```
/// use core::ops::Range;
/// use pointmass::force::State;
/// use pointmass::reap::Verdicts;
/// use pointmass::{Cause, Chance, Gravity, Heap, Particle, Reaper, Scene, System, Time, Vec3};
///
/// /// Takes whoever has fallen below the floor of the world.
/// struct Abyss;
///
/// impl Reaper for Abyss {
///     fn judge(&self, state: &State<'_>, rows: Range<usize>, verdicts: &mut Verdicts<'_>) {
///         for (nth, x) in state.position[rows].iter().enumerate().filter(|(_, x)| x.y < -10.0) {
///             verdicts.end(nth, Cause::Other);
///         }
///     }
/// }
///
/// let start = [Particle::REST, Particle { position: Vec3::Y * 90.0, ..Particle::REST }];
/// let reapers = (Abyss, Chance { rate: 1e-9 });
/// let scene = Scene { start: &start, forces: &Gravity::EARTH, reapers: &reapers, ..Scene::EMPTY };
/// let mut system = System::with(Heap::new(scene.size()));
/// system.start(&scene, 1)?;
/// (1..=120).for_each(|frame| drop(system.step_to(&scene, Time::frame(frame, 60))));
/// assert_eq!((system.len(), system.totals().died.other), (1, 1));
/// # Ok::<(), pointmass::InsufficientMemory>(())
/// ```
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

    /// Tells whether it takes nobody, whatever the state: no row is looked at then.
    fn is_empty(&self) -> bool {
        false
    }

    /// The function that a step calls to have all judged; none, where it is known that nobody ever is.
    fn code(&self) -> Option<ReaperCode> {
        Some(ReaperCode::ALL)
    }
}

/// The function that reapers call for in a step. A program without reapers does not carry it about.
#[derive(Clone, Copy, Debug)]
pub struct ReaperCode(pub(crate) fn(&dyn Reaper, Judged<'_>));

impl ReaperCode {
    /// All of it.
    pub const ALL: Self = Self(judge_all);
}

/// All rows, as they are to be judged.
pub(crate) struct Judged<'a> {
    pub(crate) state: State<'a>,
    /// The fates of all so far.
    pub(crate) pending_deaths: &'a mut [PendingDeath],
    /// The index by which to find who is near.
    pub(crate) index: StateIndex<'a>,
    /// Counts searches that looked at all pairs.
    pub(crate) all_pairs: &'a mut u64,
    /// Room for the places of those who live.
    pub(crate) places: &'a mut [Vec3],
}

fn judge_all(reapers: &dyn Reaper, judged: Judged<'_>) {
    let Judged { state, pending_deaths, mut index, all_pairs, places } = judged;
    let (rows, reach) = (0..pending_deaths.len(), reapers.reach());
    if reach <= 0.0 {
        return reapers.judge(&state, rows, &mut Verdicts::on(pending_deaths));
    }
    for ((place, &x), &pending_death) in places.iter_mut().zip(state.position).zip(&*pending_deaths) {
        *place = if pending_death == PendingDeath::Lives { x } else { Vec3::NAN };
    }
    let (position, mut verdicts) = (&*places, Verdicts::on(pending_deaths));
    let room = index.choice().room();
    index.with(position, reach, &mut |near| {
        *all_pairs += u64::from(near.is_none() && !position.is_empty());
        let near = Neighbours::by(near, position).in_room(room);
        reapers.judge(&State { position, near, ..state }, rows.clone(), &mut verdicts);
    });
}

/// The verdicts of reapers on the rows they are asked about.
#[derive(Debug)]
pub struct Verdicts<'a> {
    pending_deaths: &'a mut [PendingDeath],
    claimed: u32,
}

impl<'a> Verdicts<'a> {
    /// On rows whose pending deaths so far these are.
    pub fn on(pending_deaths: &'a mut [PendingDeath]) -> Self {
        Self { pending_deaths, claimed: 0 }
    }

    /// A number that no other reaper of the list has, and this one in every step: the place of the word that it draws of each
    /// particle's own ([`State::word`]), so that the choices of two reapers have nothing to do with each other. To be claimed
    /// whoever is judged.
    pub fn claim(&mut self) -> u32 {
        self.claimed += 1;
        self.claimed - 1
    }

    /// The particle in the `nth` of the rows that were asked about, from 0, has to go.
    #[inline]
    pub fn end(&mut self, nth: usize, cause: Cause) {
        if let Some(pending_death) = self.pending_deaths.get_mut(nth) {
            *pending_death = (*pending_death).max(cause.into());
        }
    }
}

impl Reaper for () {
    fn judge(&self, _: &State<'_>, _: Range<usize>, _: &mut Verdicts<'_>) {}
    fn is_empty(&self) -> bool {
        true
    }
    fn code(&self) -> Option<ReaperCode> {
        None
    }
}

/// The methods of a reaper that has parts: it takes whomever one of them takes.
macro_rules! any_of {
    ($parts:tt) => {
        fn judge(&self, state: &State<'_>, rows: Range<usize>, verdicts: &mut Verdicts<'_>) {
            each!(self, $parts, part => {
                part.judge(state, rows.clone(), verdicts);
            });
        }
        fn reach(&self) -> f32 {
            let mut most = 0.0;
            each!(self, $parts, part => {
                most = max(part.reach(), most);
            });
            most
        }
        fn is_empty(&self) -> bool {
            each!(self, $parts, part => {
                if !part.is_empty() {
                    return false;
                }
            });
            true
        }
    };
}

/// The methods of a reaper that stands for another reaper.
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
        fn code(&self) -> Option<ReaperCode> {
            let $this = self;
            $reaper.code()
        }
    };
}

use same_as;

stands_for! {
    Reaper {
        same_as!(this => **this);
    }
}

composed!(Reaper by any_of);
