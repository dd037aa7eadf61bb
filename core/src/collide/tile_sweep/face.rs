//! Rows past one flat face: who may touch it is told many at a time, and those who do go past it in packets.

use super::{TileSweep, Waiting, each_by_itself, lone_face, words};
use crate::collide::air::Air;
use crate::collide::near::{BLOCK, Near};
use crate::collide::tile::Tile;
use crate::collide::waiting::ones;
use crate::force::Ends;
use crate::lanes::{LANES, widest};
use crate::memory::Past;
use crate::observe::{Attention, Observer};
use crate::report::Report;
use crate::rows::Extents;
use crate::shape::{Face, Facing};
use core::ops::Range;
use glam::Vec3;

/// Rows that leap and are held against a face before the next ones leap: so few that they are in the cache meanwhile, with where they
/// began.
const LEAP: usize = 512;

/// Moves some rows of a tile, whose ends these are, and keeps in other columns where they were. Says how far they get.
pub(crate) type Leap<'l> = dyn FnMut(Range<usize>, Ends<'_>, Ends<'_>) -> Option<Extents> + 'l;

/// Sends all particles of a tile, none of them newborn, along the paths of a leap, as [`each_by_itself`] does after it.
pub(crate) fn leap_by_itself(
    tile: &mut Tile<'_>,
    leap: &mut Leap<'_>,
    report: &mut Report,
    observer: &mut dyn Observer,
) {
    let (work, len) = (core::mem::take(&mut tile.work), tile.position.len());
    match lone_face(tile) {
        Some(face) if observer.attention() == Attention::Nothing => leap_past(tile, work, leap, &face, report),
        _ => {
            tile.reached = leap_some(tile, work, leap, 0..len);
            tile.work = work;
            return each_by_itself(tile, report, observer);
        }
    }
    tile.work = work;
}

/// The same past a face, a few at a time.
fn leap_past(tile: &mut Tile<'_>, work: &mut [Vec3], leap: &mut Leap<'_>, face: &Face, report: &mut Report) {
    let (layout, len) = (tile.layout, tile.position.len());
    let (mut waiting, mut are_points) = (Waiting::before(*face), true);
    for first in (0..len).step_by(LEAP) {
        let rows = first..len.min(first + LEAP);
        let reached = leap_some(tile, work, leap, rows.clone());
        tile.reached = if first == 0 { reached } else { tile.reached.zip(reached).map(|(all, some)| all.and(some)) };
        let past = layout.past(work);
        let mut sweep = TileSweep::past_face(&mut *tile, past, first, face, &mut *report);
        sweep.are_points = are_points;
        sweep.go_some(rows.clone(), &mut waiting);
        if rows.end == len {
            sweep.go_on(&mut waiting);
        }
        are_points = sweep.are_points;
    }
}

/// Moves some rows, and keeps where they were in memory to work with, from its beginning on.
fn leap_some(tile: &mut Tile<'_>, work: &mut [Vec3], leap: &mut Leap<'_>, rows: Range<usize>) -> Option<Extents> {
    let ends = [&mut tile.position[rows.clone()], &mut tile.velocity[rows.clone()]];
    let start = tile.layout.shares(work).start.map(|column| &mut column[..rows.len()]);
    leap(rows, ends, start)
}

impl<'s, 'a> TileSweep<'s, 'a> {
    /// Rows past a face and nothing else, of which those from the first on have leapt last, with nobody looking on.
    fn past_face(tile: &'s mut Tile<'a>, past: Past<'s>, first: usize, face: &Face, report: &'s mut Report) -> Self {
        let has_materials = tile.obstacles.materials.count() > 0;
        let (facing, air) = (Facing::Face(*face), Air::around(&tile.obstacles));
        Self { tile, past, first, has_materials, facing, air, are_points: true, report, observer: None }
    }
}

impl TileSweep<'_, '_> {
    /// Follows all past a face, those who were there before the step in packets.
    pub(super) fn go_past(&mut self, face: &Face) {
        let old = self.tile.old;
        let mut waiting = Waiting::before(*face);
        self.are_points = true;
        for first in (0..old).step_by(BLOCK) {
            if !self.are_carried(first, BLOCK) {
                self.go_some(first..old.min(first + BLOCK), &mut waiting);
            }
        }
        self.go_on(&mut waiting);
        self.let_go_past(face);
    }

    /// Follows some who were there before, no more than a block.
    fn go_some(&mut self, rows: Range<usize>, waiting: &mut Waiting) {
        let block = self.balls().block(rows.start - self.first..rows.end - self.first, self.tile.reached);
        let (Near { touching, lying }, are_points) = (block.near(&waiting.face), block.are_points());
        self.are_points &= are_points;
        let marks = rows.step_by(u64::BITS as usize).zip(words(&touching).zip(words(&lying)));
        if !self.goes_in_packets() {
            return marks.for_each(|(row, (touching, _))| ones(touching).for_each(|i| self.follow(row + i)));
        }
        widest(
            #[inline(always)]
            || {
                for (row, (touching, lying)) in marks {
                    self.queue(row, [touching, lying], waiting);
                }
            },
        );
        self.go_listed(waiting);
    }

    /// Follows the newborn past a face. The control points of paths that take only part of the step lie between those that a whole one
    /// would have, and so do their boxes.
    fn let_go_past(&mut self, face: &Face) {
        let len = self.tile.position.len();
        for first in (self.tile.old..len).step_by(BLOCK) {
            let marks = self.balls().block(first..len.min(first + BLOCK), None).near(face);
            let eights = (first..len).step_by(LANES).zip(marks.touching);
            eights.for_each(|(row, marks)| ones(marks).for_each(|i| self.follow(row + i)));
        }
    }
}
