//! How paths are held against scenery.

use super::straight;
use super::tile::Tile;
use super::tile_sweep;
use crate::observe::Observer;
use crate::report::Report;

/// How paths are held against scenery and sinks: [`Paths::CURVED`] or [`Paths::STRAIGHT`].
#[derive(Clone, Copy)]
pub struct Paths {
    name: &'static str,
    /// The function that does it. A program that does not name it does not carry it about.
    follow: fn(&mut Tile<'_>, &mut Report, &mut dyn Observer),
}

impl Paths {
    /// As the method moves particles: hits lie on a cubic through both ends and velocities, at their instants; what rests stays, slides, or
    /// rides along with what moves. Scenes do so unless they say otherwise.
    pub const CURVED: Self = Self { name: "Curved", follow: tile_sweep::each_by_itself };

    /// Along the straight line between both ends of a step, and from a hit on: for chips, of whose flash it takes six kilobytes less than
    /// [`CURVED`](Self::CURVED).
    ///
    /// Nothing comes to the other side of anything; what a curve would touch between two ends on this side goes unnoticed. In a step of h under an
    /// acceleration a hits lie within a h²/8 of where they would be, and speeds are as far off as that takes; for the rest of the step what brakes goes on as on the way to the hit. What rests stays (by the explicit
    /// Euler method, whose places lag behind, it hops), slides by Coulomb's law to the order of the step, and goes on as the surface moves where it
    /// meets that; a ledger finds the work of friction on it in its remainder. Springs feed energy into what they let swing along a surface. For balls
    /// that bounce off each other ([`Meetings::IMPULSE`](crate::Meetings::IMPULSE)) paths are curved whatever this says.
    pub const STRAIGHT: Self = Self { name: "Straight", follow: straight::follow };

    /// True if paths bend as the method moves particles.
    pub(crate) fn are_curved(&self) -> bool {
        *self == Self::CURVED
    }

    /// Sends every free particle of a tile along its path, past all others.
    pub(crate) fn follow(&self, tile: &mut Tile<'_>, report: &mut Report, observer: &mut dyn Observer) {
        (self.follow)(tile, report, observer);
    }
}

impl core::fmt::Debug for Paths {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.write_str(self.name)
    }
}

impl PartialEq for Paths {
    fn eq(&self, other: &Self) -> bool {
        self.name == other.name
    }
}
