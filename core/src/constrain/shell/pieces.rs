//! The pieces of a shell: who hangs together by triangles and folds.

use super::mesh::sorted;
use super::plate::Shape;
use super::solver::{NOBODY, Vectors};
use crate::constrain::Bodies;
use crate::constrain::budget::{self, Budget};
use crate::constrain::union::unite;
use crate::memory::take;

/// Words kept for each particle.
pub(super) const KEPT: usize = 1 + budget::WORDS;
/// Whoever is not there.
const GONE: u32 = 0;

/// Words to work with.
pub(super) fn words([particles, triangles, hinges]: [usize; 3]) -> usize {
    let all = [particles.saturating_mul(5), triangles, hinges, 6];
    all.iter().copied().fold(0, usize::saturating_add)
}

/// What is kept of the pieces: of each particle the lowest number in its piece plus one, and the energy that the piece may have, by that number.
pub(super) struct Roll<'m> {
    of: &'m mut [u32],
    budgets: &'m mut [u32],
}

impl<'m> Roll<'m> {
    pub(super) fn of(words: &'m mut [u32], particles: usize) -> Self {
        let (of, budgets) = words.split_at_mut(particles.min(words.len()));
        Self { of, budgets }
    }

    /// Finds the pieces, if other particles are there than when they were found.
    pub(super) fn update(&mut self, rows: &[u32], shape: &Shape<'_>) {
        if self.of.iter().zip(rows).all(|(&of, &row)| (of == GONE) == (row == NOBODY)) {
            return;
        }
        self.budgets.fill(0);
        let of = &mut *self.of;
        of.iter_mut().enumerate().for_each(|(number, of)| *of = number as u32);
        let is_there = |&corner: &u32| rows.get(corner as usize).is_some_and(|&row| row != NOBODY);
        let mut bind = |corners: &[u32]| {
            if corners.iter().all(is_there) {
                corners.windows(2).for_each(|pair| unite(of, pair[0], pair[1]));
            }
        };
        for (corners, _) in shape.triangles.iter().zip(shape.cells).filter(|(_, cell)| cell.area > 0.0) {
            bind(corners);
        }
        for (hinge, _) in shape.hinges.iter().zip(shape.bends).filter(|(_, bend)| bend.acts()) {
            bind(&hinge.corners());
        }
        // All lead to what is lower, and of that it is told first.
        for number in 0..of.len() {
            let lower = of[number] as usize;
            of[number] = if lower == number { number as u32 + 1 } else { of[lower] };
        }
        for (of, &row) in of.iter_mut().zip(rows) {
            *of = if row == NOBODY { GONE } else { *of };
        }
    }

    /// Tells whether all hang together.
    pub(super) fn is_one(&self) -> bool {
        let mut all = self.of.iter().filter(|&&of| of != GONE);
        let first = all.next();
        all.all(|of| Some(of) == first)
    }

    /// Forgets what pieces may have.
    pub(super) fn forget(&mut self) {
        self.budgets.fill(0);
    }

    /// Lets the particles of pieces of which some are fixed go on to where their velocities lead.
    pub(super) fn catch_up(&self, bodies: &mut Bodies<'_>, vectors: &Vectors<'_>, work: &mut [u32]) {
        let all = || vectors.rows.iter().zip(&*vectors.weight).zip(&*self.of).filter(|&(_, &of)| of != GONE);
        let fixed = || all().filter(|&((_, &weight), _)| weight == 0.0);
        if fixed().next().is_none() {
            return;
        }
        let held = &mut work[..self.of.len()];
        held.fill(0);
        fixed().for_each(|(_, &of)| held[of as usize - 1] = 1);
        let hang = all().filter(|&(_, &of)| held[of as usize - 1] == 1);
        hang.for_each(|((&row, _), _)| bodies.catch_up(row as usize));
    }

    /// What a piece may have.
    pub(super) fn budget(&mut self, piece: &Piece<'_>) -> Budget<'_> {
        let from = (piece.number * budget::WORDS).min(self.budgets.len());
        let to = (from + budget::WORDS).min(self.budgets.len());
        Budget(&mut self.budgets[from..to])
    }

    /// All particles, triangles and folds, piece by piece.
    pub(super) fn sorted<'w>(&self, rows: &[u32], shape: &Shape<'_>, work: &'w mut [u32]) -> Option<Pieces<'w>> {
        let count = self.of.len();
        let of = |corner: u32| self.of.get(corner as usize).copied().unwrap_or(GONE);
        let piece = move |corners: &[u32]| {
            let all_there = corners.iter().all(|&corner| of(corner) != GONE);
            all_there.then(|| of(corners[0]) as usize - 1)
        };
        let mut rest = work;
        let mut room = |items: usize| take(&mut rest, count + 2 + items);
        let [own, faces, folds] = [room(count), room(shape.triangles.len()), room(shape.hinges.len())];
        let members = self.of.iter().enumerate().filter(|&(_, &of)| of != GONE);
        let members = sorted(count, members.map(|(number, &of)| (of as usize - 1, number as u32)), own)?;
        let numbered = |(number, piece): (usize, Option<usize>)| Some((piece?, number as u32));
        let triangles = shape
            .triangles
            .iter()
            .zip(shape.cells)
            .map(|(corners, cell)| if cell.area > 0.0 { piece(corners) } else { None });
        let triangles = sorted(count, triangles.enumerate().filter_map(numbered), faces)?;
        let hinges = shape
            .hinges
            .iter()
            .zip(shape.bends)
            .map(|(hinge, bend)| if bend.acts() { piece(&hinge.corners()) } else { None });
        let hinges = sorted(count, hinges.enumerate().filter_map(numbered), folds)?;
        let own = take(&mut rest, count);
        for (own, &number) in own.iter_mut().zip(members.1) {
            *own = rows.get(number as usize).copied().unwrap_or(NOBODY);
        }
        Some(Pieces { members, triangles, hinges, rows: own })
    }
}

/// All of a shell, piece by piece.
pub(super) struct Pieces<'w> {
    members: (&'w [u32], &'w [u32]),
    triangles: (&'w [u32], &'w [u32]),
    hinges: (&'w [u32], &'w [u32]),
    rows: &'w [u32],
}

impl<'w> Pieces<'w> {
    /// Each of them, in the order of the lowest numbers.
    pub(super) fn each(&self) -> impl Iterator<Item = Piece<'w>> {
        let Self { members, triangles, hinges, rows } = *self;
        let own = |(starts, items): (&'w [u32], &'w [u32]), piece: usize| {
            &items[starts[piece] as usize..starts[piece + 1] as usize]
        };
        let pieces = (0..rows.len()).filter(move |&piece| members.0[piece] < members.0[piece + 1]);
        pieces.map(move |number| Piece {
            number,
            members: own(members, number),
            rows: own((members.0, rows), number),
            triangles: own(triangles, number),
            hinges: own(hinges, number),
        })
    }
}

/// A piece: the lowest number of its particles, all of these, their rows, and the numbers of its triangles and folds.
#[derive(Clone, Copy)]
pub(super) struct Piece<'w> {
    number: usize,
    pub(super) members: &'w [u32],
    pub(super) rows: &'w [u32],
    pub(super) triangles: &'w [u32],
    pub(super) hinges: &'w [u32],
}
