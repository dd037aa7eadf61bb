//! How particles that have a radius meet each other on their way through a step.

use super::impulse;
use super::swept::Swept;

/// The answer of particles that have a radius where their paths meet.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Meetings {
    /// They pass through each other, or are kept apart by a force ([`Penalty`](crate::Penalty)) or a constraint
    /// ([`Contacts`](crate::Contacts)).
    #[default]
    Through,
    /// They bounce off each other as hard balls do: [`Meetings::IMPULSE`].
    Impulse(Impulse),
}

/// Hard balls: whoever meets, another particle or a collider, is answered by an impulse at that instant, in the order of
/// time, and goes on from there.
///
/// Nothing passes through anything however fast, momentum is exact to rounding, and with elasticities of one so is energy.
/// A particle that has met half as often as [`Scene::max_bounces`](crate::Scene::max_bounces) says waits where it is for
/// the sub-step's end (counted in `caps.bounces`), as does one that finds others near it some ten thousand times: that is what
/// happens in a dense heap, where every touch is a meeting; for heaps use [`Contacts`](crate::Contacts).
/// Who waits keeps its velocity: what forces would have given it meanwhile is lost, and the momentum of that.
/// Whichever index the scene has, the answer is the same to the bit.
///
/// Where walls bear one that meets another, what that pushes it into them by they take up in the same instant, without a bounce; two that stay in touch
/// go on along their walls.
///
/// There is but one, [`Meetings::IMPULSE`], which its default is as well.
#[derive(Clone, Copy)]
pub struct Impulse {
    /// The function that does it. A program that does not name it does not carry it about.
    follow: fn(Swept<'_, '_>),
}

impl PartialEq for Impulse {
    fn eq(&self, _: &Self) -> bool {
        true
    }
}

impl core::fmt::Debug for Impulse {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.write_str("Impulse")
    }
}

impl Default for Impulse {
    fn default() -> Self {
        Self { follow: impulse::follow }
    }
}

impl Meetings {
    /// By impulses, in the order of time.
    pub const IMPULSE: Self = Self::Impulse(Impulse { follow: impulse::follow });

    /// Tells whether all pass through each other.
    pub(crate) fn is_through(&self) -> bool {
        matches!(self, Self::Through)
    }

    /// Vectors for each particle to work with, an index not counted.
    pub(crate) fn columns(&self) -> usize {
        if self.is_through() { 0 } else { impulse::COLUMNS }
    }

    /// Sends every free particle along its path.
    pub(crate) fn follow(&self, swept: Swept<'_, '_>) {
        match self {
            Self::Through => swept.each_by_itself(),
            Self::Impulse(Impulse { follow }) => follow(swept),
        }
    }
}
