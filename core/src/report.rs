//! What a step did, counted: nothing that is bounded is bounded silently.

/// What happened in a step, or in all of them so far.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Report {
    /// Particles put in by the scene's start.
    pub initial: u64,
    /// Particles that emitters brought into the world.
    pub born: u64,
    /// Particles removed, by cause.
    pub died: Died,
    /// Particles that found no room.
    pub refused: u64,
    /// Times that a particle met a collider.
    pub hits: u64,
    /// Times that a bound cut work short.
    pub caps: Caps,
}

/// Particles removed, by cause.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Died {
    /// Of age.
    pub lifetime: u64,
    /// By touching a sink.
    pub sink: u64,
    /// Where too many were.
    pub density: u64,
    /// By chance, or by the program's own hand.
    pub chance: u64,
    /// Because a number of theirs was no longer finite.
    pub nonfinite: u64,
}

/// Times that a bound cut work short.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Caps {
    /// A particle hit as often in one step as it may, and waited at the surface for the step's end.
    pub bounces: u64,
    /// A path was so curved that its collisions were sought along fewer chords than its accuracy asks.
    pub chords: u64,
    /// A spring lost an end.
    pub springs: u64,
    /// A step could not be made since the scene needs more emitters, springs or work columns than the system has.
    pub unfit: u64,
}

/// Adds up every field of two counters; the sum of plain numbers saturates.
macro_rules! add_fields {
    ($($counter:ident { $($field:ident)+ })+) => {$(
        impl core::ops::AddAssign for $counter {
            fn add_assign(&mut self, other: Self) {
                $(self.$field = self.$field.saturating_add(other.$field);)+
            }
        }
    )+};
}
add_fields! {
    Died { lifetime sink density chance nonfinite }
    Caps { bounces chords springs unfit }
}

impl core::ops::AddAssign for Report {
    fn add_assign(&mut self, other: Self) {
        for (sum, more) in [
            (&mut self.initial, other.initial),
            (&mut self.born, other.born),
            (&mut self.refused, other.refused),
            (&mut self.hits, other.hits),
        ] {
            *sum = sum.saturating_add(more);
        }
        self.died += other.died;
        self.caps += other.caps;
    }
}

impl Died {
    /// From whatever cause.
    #[must_use]
    pub const fn total(&self) -> u64 {
        self.lifetime + self.sink + self.density + self.chance + self.nonfinite
    }
}

impl Report {
    /// Nothing happened.
    pub const NOTHING: Self = Self {
        initial: 0,
        born: 0,
        died: Died { lifetime: 0, sink: 0, density: 0, chance: 0, nonfinite: 0 },
        refused: 0,
        hits: 0,
        caps: Caps { bounces: 0, chords: 0, springs: 0, unfit: 0 },
    };

    /// Every counter, in a fixed order.
    pub(crate) fn counters(&self) -> [u64; 13] {
        let Self { initial, born, died, refused, hits, caps } = *self;
        let Died { lifetime, sink, density, chance, nonfinite } = died;
        let Caps { bounces, chords, springs, unfit } = caps;
        [initial, born, lifetime, sink, density, chance, nonfinite, refused, hits, bounces, chords, springs, unfit]
    }
}
