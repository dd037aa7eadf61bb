//! Who may be measured: our structures, and other libraries where the program has them.

use super::contender::{Contender, Own};
use super::foreign::Foreign;
use pointmass::index::Structure;

/// Who may take part.
pub(crate) enum Entrant {
    Own(Structure),
    Peer(Foreign),
}

impl Entrant {
    pub(crate) fn name(&self) -> &str {
        match self {
            Self::Own(structure) => structure.name(),
            Self::Peer(peer) => peer.name(),
        }
    }

    /// Whether it is one of our structures.
    pub(crate) fn is_own(&self) -> bool {
        matches!(self, Self::Own(_))
    }

    /// Words of memory it has to be lent.
    pub(crate) fn words(&self, points: usize) -> usize {
        match self {
            Self::Own(structure) => structure.words(points),
            Self::Peer(_) => 0,
        }
    }

    /// Takes its place in the memory.
    pub(crate) fn enter<'a>(&'a mut self, points: usize, memory: &'a mut [u32]) -> Box<dyn Contender + 'a> {
        match self {
            Self::Own(structure) => Box::new(Own::new(*structure, points, memory)),
            Self::Peer(peer) => Box::new(peer),
        }
    }
}
