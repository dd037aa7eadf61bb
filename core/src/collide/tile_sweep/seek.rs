//! Rows that wait until there are some, and are held against things side by side.

use super::TileSweep;
use super::packets::ALL;
use super::ways::{Room, Ways, straight_ways, ways};
use crate::collide::waiting::{List, Packet};
use crate::lanes::{BroadKernel, Eight, LANES, Lanes, PARTS, Vectors, not};
use crate::shape::{Aabb, Clearance, Face, Few, NEAREST};
use glam::Vec3;

/// Places for rows that wait: for a word of marks besides some of before.
const PLACES: usize = 2 * u64::BITS as usize;

/// Eights that are looked at at once.
const SOUGHT: usize = PLACES / LANES;

/// Rows that wait to be held against things, and what comes of that.
pub(super) struct Asking {
    pub(super) list: List<PLACES>,
    pub(super) sought: [Sought; SOUGHT],
    /// The places in there of those that may be near things, and what comes of a closer look at them.
    pub(super) near: List<{ PLACES + LANES }>,
    pub(super) told: [Told; SOUGHT + 1],
}

/// Rows of a tile eight by eight, none of which is its last, that may be near things.
pub(super) struct Seek<'t, 's, 'a> {
    pub(super) of: &'t TileSweep<'s, 'a>,
    pub(super) eights: &'t [[u32; LANES]],
    pub(super) len: usize,
    pub(super) face: Option<Face>,
    pub(super) clearance: Option<Clearance<'t>>,
    pub(super) room: Room,
    pub(super) sought: &'t mut [Sought; SOUGHT],
}

/// The rows among eight that may be near things, a bit for each, and more about them, if there are any.
#[derive(Clone, Copy)]
pub(super) struct Sought {
    pub(super) near: u32,
    /// The middles of boxes around their ways, each with some number behind it \[m\].
    pub(super) middle: [[f32; 4]; LANES],
    /// How far the middles are from the sides of the boxes, and how far beyond that rows may get when they are followed on after hits among
    /// things \[m\].
    pub(super) half: [[f32; 4]; LANES],
    /// The cells of the middles.
    pub(super) cells: [u32; LANES],
}

/// Eight rows held against the things that are nearest to them: a bit for each.
#[derive(Clone, Copy)]
pub(super) struct Told {
    numbers: [[u32; NEAREST]; LANES],
    /// Those that are near each of these.
    met: [u32; NEAREST],
    /// Those that are surely not near any others.
    known: u32,
    /// The same wherever they may get when they are followed on after hits, and those that get near no more of these there.
    sure: u32,
    alone: u32,
}

/// Rows that may be near things, the places of which in what is `sought` these are.
pub(super) struct Tell<'t> {
    pub(super) places: &'t [[u32; LANES]],
    pub(super) len: usize,
    pub(super) sought: &'t [Sought; SOUGHT],
    pub(super) clearance: Option<Clearance<'t>>,
    pub(super) told: &'t mut [Told; SOUGHT + 1],
}

impl Told {
    const NOTHING: Self = Self { numbers: [[0; NEAREST]; LANES], met: [0; NEAREST], known: 0, sure: 0, alone: 0 };

    /// Those that are near things, or may be.
    pub(super) fn may_meet(&self) -> u32 {
        self.met.iter().fold(!self.known, |all, met| all | met)
    }

    /// What one of them is near, if that is known.
    pub(super) fn few(&self, i: usize) -> Option<Few> {
        let is = |bits: u32| bits >> i & 1 != 0;
        let met = self.numbers[i].iter().zip(self.met).filter(|(_, met)| is(*met));
        is(self.known).then(|| met.fold(Few::Nothing, |few, (number, _)| few.and(*number as usize)))
    }

    /// Tells whether one of them gets near nothing else, if that is known.
    pub(super) fn is_alone(&self, i: usize) -> Option<bool> {
        (self.sure >> i & 1 != 0).then_some(self.alone >> i & 1 != 0)
    }
}

impl BroadKernel for Tell<'_> {
    type Output = ();

    #[inline(always)]
    fn run<F: Lanes>(self, like: F) {
        let Self { places, len, sought, clearance, told } = self;
        let Some(clearance) = clearance else { return told.fill(Told::NOTHING) };
        for (nth, packet) in Packet::all::<F>(places, len) {
            let of = |place: u32| (&sought[place as usize / LANES % SOUGHT], place as usize % LANES);
            let [x, y, z, u, v, w, beyond] = like.of_parts(
                #[inline(always)]
                |like, nth| {
                    let (mut middle, mut half) = ([[0.0; 4]; LANES], [[0.0; 4]; LANES]);
                    for (i, &place) in packet.rows[nth].iter().enumerate() {
                        let (sought, lane) = of(place);
                        (middle[i], half[i]) = (sought.middle[lane], sought.half[lane]);
                    }
                    let ([x, y, z], [u, v, w, beyond]) = (like.columns_of(middle), like.quads_of(half));
                    [x, y, z, u, v, w, beyond]
                },
            );
            let mut cells = [[0; LANES]; PARTS];
            for (cell, &place) in cells.as_flattened_mut().iter_mut().zip(packet.rows.into_iter().flatten()) {
                let (sought, lane) = of(place);
                *cell = sought.cells[lane];
            }
            let nearest = clearance.nearest(like, &cells);
            let (middle, half) = (Vectors([x, y, z]), Vectors([u, v, w]));
            let (met, known) = nearest.met(middle, half);
            let (beyond, sure) = nearest.met(middle, half + Vectors([beyond; 3]));
            let (mut bits, mut more) = ([0; NEAREST], like.all(0.0));
            for (bits, (met, beyond)) in bits.iter_mut().zip(met.into_iter().zip(beyond)) {
                (*bits, more) = (met.to_bitmask(), more | (met ^ beyond));
            }
            let [known, sure, more] = [known.to_bitmask(), sure.to_bitmask(), more.to_bitmask()];
            for (part, told) in told[nth..].iter_mut().enumerate().take(F::PARTS) {
                let of = |bits: u32| bits >> (LANES * part) & ALL;
                let met = bits.map(of);
                *told =
                    Told { numbers: nearest.numbers[part], met, known: of(known), sure: of(sure), alone: of(!more) };
            }
        }
    }
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
        let (sought, told) = ([Sought::NOTHING; SOUGHT], [Told::NOTHING; SOUGHT + 1]);
        Self { list: List::empty(), sought, near: List::empty(), told }
    }
}
