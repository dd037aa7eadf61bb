//! An index, read from words.

use super::header::{Boxes, Header};
use super::near::{in_order, meets};
use super::nearest::Closest;
use super::probe::{Best, Probe};
use super::visit::{Visit, Visitor};
use super::{Cost, Pieces, Stats, Structure, grid, tree};
use crate::shape::{Aabb, Hit, Segment};
use glam::Vec3;

/// The words into which a structure sorted pieces, ready to be asked. Copying it copies a reference.
///
/// It answers for the pieces it was built from; asked with another number of pieces it looks at each of them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Index<'w> {
    words: &'w [u32],
}

/// Words are not those of an index, or not all of them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Unsound;

impl core::fmt::Display for Unsound {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.write_str("these words are no index of these pieces")
    }
}

impl core::error::Error for Unsound {}

impl<'w> Index<'w> {
    /// No structure: every piece is looked at.
    pub const BRUTE: Index<'static> = Index { words: &[] };

    /// The index that was built into these words, which may come from anywhere. Looks at each of them once.
    ///
    /// # Errors
    /// If they are not what was written: too few, changed, or of another version. No words at all are
    /// [`Index::BRUTE`].
    pub fn new(words: &'w [u32]) -> Result<Self, Unsound> {
        let index = Self { words };
        let Some(header) = Header::of(words) else {
            return if words.is_empty() { Ok(index) } else { Err(Unsound) };
        };
        let structure = header.structure().ok_or(Unsound)?;
        let sound = header.is_whole(words)
            && match structure {
                Structure::Brute => true,
                Structure::Grid => grid::is_sound(words),
                Structure::Octree | Structure::Kd | Structure::Bsp | Structure::Bvh => tree::is_sound(words),
            };
        if sound { Ok(index) } else { Err(Unsound) }
    }

    /// The same without the look.
    pub(crate) const fn trusted(words: &'w [u32]) -> Self {
        Self { words }
    }

    /// The words it is read from: as many as it needs, to be kept and read again.
    #[must_use]
    pub const fn words(&self) -> &'w [u32] {
        self.words
    }

    /// Which it is.
    #[must_use]
    pub fn structure(&self) -> Structure {
        Header::of(self.words).and_then(Header::structure).unwrap_or(Structure::Brute)
    }

    /// Tells how large the structure has become.
    #[must_use]
    pub fn stats(&self) -> Stats {
        Header::of(self.words).map_or(Stats::default(), Header::stats)
    }

    /// Tells whether it was built from pieces with these boxes. Looks at each of them once.
    #[must_use]
    pub fn is_of<P: Pieces + ?Sized>(&self, pieces: &P) -> bool {
        Header::of(self.words)
            .is_none_or(|header| header.pieces as usize == pieces.count() && header.boxes == Boxes::of(pieces))
    }

    /// Where a segment first meets a piece; of several hits at one time that of the lowest number.
    pub fn first_hit<P: Pieces + ?Sized>(&self, pieces: &P, segment: &Segment) -> Option<Hit> {
        Probe::new(segment, pieces.reach()).and_then(|probe| self.best(pieces, &probe).hit)
    }

    /// The same, with what it took.
    pub fn first_hit_counted<P: Pieces + ?Sized>(&self, pieces: &P, segment: &Segment) -> (Option<Hit>, Cost) {
        let best = Probe::new(segment, pieces.reach()).map_or(Best::NONE, |probe| self.best(pieces, &probe));
        (best.hit, best.cost)
    }

    #[inline]
    fn best<P: Pieces + ?Sized>(&self, pieces: &P, probe: &Probe<'_>) -> Best {
        let mut best = Best::NONE;
        match self.structure_for(pieces) {
            Structure::Brute => (0..pieces.count()).for_each(|piece| best.ask(pieces, probe, piece)),
            Structure::Grid => grid::first_hit(self.words, pieces, probe, &mut best),
            _ => tree::first_hit(self.words, pieces, probe, &mut best),
        }
        best
    }

    /// Visits every piece whose box shares a point with `bounds`, in the order of their numbers.
    pub fn near<P: Pieces + ?Sized>(&self, pieces: &P, bounds: &Aabb, visit: &mut dyn FnMut(usize)) -> Cost {
        match self.structure_for(pieces) {
            Structure::Brute => {
                let near = |piece: &usize| meets(&pieces.box_of(*piece), bounds);
                (0..pieces.count()).filter(near).for_each(visit);
                Cost { visits: 0, tests: pieces.count() as u64 }
            }
            Structure::Grid => in_order(|found| grid::near(self.words, pieces, bounds, found), visit),
            _ => in_order(|found| tree::near(self.words, pieces, bounds, found), visit),
        }
    }

    /// Shows a visitor every piece whose own box it enters, in an order of the structure's own, until it breaks off; cells may show a
    /// piece several times.
    pub fn visit<P: Pieces + ?Sized, V: Visitor>(&self, pieces: &P, visitor: &mut V) -> Cost {
        let mut visit = Visit { pieces, visitor, cost: Cost::default() };
        // Whether it broke off, it knows.
        let _ = match self.structure_for(pieces) {
            Structure::Brute => (0..pieces.count()).try_for_each(|piece| visit.ask(piece)),
            Structure::Grid => grid::visit(self.words, &mut visit),
            _ => tree::visit(self.words, &mut visit),
        };
        visit.cost
    }

    /// The place nearest to `point`, of those that `place` says each piece has nearest to it, held in the pieces' boxes;
    /// of several as near that of the lowest number. None, if there are none or all are so far away that the square of
    /// the distance is beyond an `f32`.
    pub fn nearest<P: Pieces + ?Sized>(
        &self,
        pieces: &P,
        point: Vec3,
        place: impl Fn(usize) -> Vec3,
    ) -> (Option<Vec3>, Cost) {
        let mut closest = Closest::new(pieces, point, place);
        match self.structure_for(pieces) {
            Structure::Brute => (0..pieces.count()).for_each(|piece| closest.ask(piece)),
            Structure::Grid => grid::nearest(self.words, &mut closest),
            _ => tree::nearest(self.words, &mut closest),
        }
        closest.found()
    }

    fn structure_for<P: Pieces + ?Sized>(&self, pieces: &P) -> Structure {
        let header = Header::of(self.words).filter(|header| header.pieces as usize == pieces.count());
        header.and_then(Header::structure).unwrap_or(Structure::Brute)
    }
}
