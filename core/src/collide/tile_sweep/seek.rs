//! Rows that wait until there are some, and are held against things eight at a time.

use super::TileSweep;
use super::ways::{Room, Ways, straight_ways, ways};
use crate::collide::waiting::List;
use crate::lanes::{Eight, Kernel, LANES, not};
use crate::shape::{Aabb, Clearance, Face};
use glam::Vec3;

/// Places for rows that wait: for a word of marks besides some of before.
const PLACES: usize = 2 * u64::BITS as usize;

/// Eights that are looked at at once.
const EIGHTS: usize = PLACES / LANES;

/// Rows that wait to be held against things, and what comes of that.
pub(super) struct Asking {
    pub(super) list: List<PLACES>,
    pub(super) sought: [Sought; EIGHTS],
}

/// Rows of a tile eight by eight, none of which is its last, that may be near things.
pub(super) struct Seek<'t, 's, 'a> {
    pub(super) of: &'t TileSweep<'s, 'a>,
    pub(super) rows: &'t [[u32; LANES]],
    pub(super) face: Option<Face>,
    pub(super) clearance: Option<Clearance<'t>>,
    pub(super) room: Room,
    pub(super) sought: &'t mut [Sought; EIGHTS],
}

/// The rows among eight that may be near things, a bit for each, and more about them, if there are any.
#[derive(Clone, Copy)]
pub(super) struct Sought {
    pub(super) near: u32,
    /// The middles of boxes around their ways, and how far these are from the sides of cubes around the boxes \[m\].
    pub(super) middle: [[f32; 4]; LANES],
    /// How far the middles are from the sides of the boxes, and how far beyond that rows may get when they are followed on after hits among
    /// things \[m\].
    pub(super) half: [[f32; 4]; LANES],
    /// The cells of the middles.
    pub(super) cells: [u32; LANES],
}

impl Sought {
    const NOTHING: Self = Self { near: 0, middle: [[0.0; 4]; LANES], half: [[0.0; 4]; LANES], cells: [0; LANES] };

    /// The box around the ways of one of them, and farther on all sides by so much.
    pub(super) fn around(&self, i: usize, beyond: f32) -> Aabb {
        let ([x, y, z, _], [u, v, w, _]) = (self.middle[i], self.half[i]);
        let (middle, half) = (Vec3::new(x, y, z), Vec3::new(u, v, w) + beyond);
        Aabb { min: middle - half, max: middle + half }
    }

    /// Sees who of eight may be near things, and more about them if any are.
    #[inline(always)]
    fn see<F: Eight>(&mut self, ways: Ways<F>, clearance: Option<Clearance<'_>>) {
        let Ways { middle, half, beyond } = ways;
        let ([x, y, z], [u, v, w]) = (middle.0, half.0);
        let widest = u.most(v).most(w);
        self.near = match clearance {
            Some(clearance) => {
                let (are_free, cells) = clearance.are_free(middle, widest);
                self.cells = cells;
                not(are_free).to_bitmask()
            }
            None => u32::MAX,
        };
        if self.near != 0 {
            self.middle = F::rows_of([x, y, z, widest]);
            self.half = F::rows_of([u, v, w, beyond]);
        }
    }
}

impl Kernel for Seek<'_, '_, '_> {
    type Output = ();

    #[inline(always)]
    fn run<F: Eight>(self, like: F) {
        let Self { of, rows, face, clearance, room, sought } = self;
        let (rows, sought) = (rows.iter(), sought.iter_mut());
        // The loop is for either case by itself, so that what is the same all along is worked out before it.
        match room.change {
            Some(change) if !room.swing => {
                for (rows, sought) in rows.zip(sought) {
                    sought.see(straight_ways(like, of, rows, face, room.rounding, change), clearance);
                }
            }
            _ => {
                for (rows, sought) in rows.zip(sought) {
                    sought.see(ways(like, of, rows, face, room), clearance);
                }
            }
        }
    }
}

impl Asking {
    pub(super) fn nobody() -> Self {
        Self { list: List::empty(), sought: [Sought::NOTHING; EIGHTS] }
    }
}
