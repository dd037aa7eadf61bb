//! Rows that wait until there are some, and are held against things side by side.

use super::TileSweep;
use super::packets::ALL;
use super::ways::{Room, Ways, straight_ways, ways};
use crate::collide::waiting::{List, Packet};
use crate::lanes::{BroadKernel, Eight, LANES, Lanes, PARTS, not};
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
    pub(super) eights: &'t [[u32; LANES]],
    pub(super) len: usize,
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
}

impl Seek<'_, '_, '_> {
    /// Sees who of some eights, the first of which has this number, may be near things, and more about them if any are.
    #[inline(always)]
    fn see<F: Lanes>(&mut self, nth: usize, ways: Ways<F>) {
        let Ways { middle, half, beyond } = ways;
        let ([x, y, z], [u, v, w]) = (middle.0, half.0);
        let widest = u.most(v).most(w);
        let (are_free, cells) = match self.clearance {
            Some(clearance) => clearance.are_free(middle, widest),
            None => (widest & widest.all(0.0), [[0; LANES]; PARTS]),
        };
        let near = not(are_free).to_bitmask();
        for (part, sought) in self.sought[nth..].iter_mut().enumerate().take(F::PARTS) {
            sought.near = near >> (LANES * part) & ALL;
            if sought.near != 0 {
                sought.cells = cells[part];
                sought.middle = F::Part::rows_of([x, y, z, widest].map(|column| column.part(part)));
                sought.half = F::Part::rows_of([u, v, w, beyond].map(|column| column.part(part)));
            }
        }
    }
}

impl BroadKernel for Seek<'_, '_, '_> {
    type Output = ();

    #[inline(always)]
    fn run<F: Lanes>(mut self, like: F) {
        let Self { of, eights, len, face, room, .. } = self;
        let packets = Packet::all::<F>(eights, len);
        // The loop is for either case by itself, so that what is the same all along is worked out before it.
        match room.change {
            Some(change) if !room.swing => {
                for (nth, packet) in packets {
                    self.see(nth, straight_ways(like, of, &packet, face, room.rounding, change));
                }
            }
            _ => {
                for (nth, packet) in packets {
                    self.see(nth, ways(like, of, &packet, face, room));
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
