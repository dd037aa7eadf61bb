//! Rows among many things: who may be near any of them is told many at a time, and only those look for what they are near.

use super::pairs::{Pairs, PastThings};
use super::seek::{Asking, Seek, Sought};
use super::ways::Room;
use super::{Bits, TileSweep, Waiting, words};
use crate::collide::near::{BLOCK, Near};
use crate::collide::sweep::surroundings;
use crate::collide::tile::Tile;
use crate::collide::waiting::ones;
use crate::lanes::{LANES, run_broad, widest};
use crate::math::{largest, max};
use crate::shape::{Aabb, Clearance, Face, Facing, Few, Many, Solid};
use core::ops::Range;

/// Things that rows go among, the box around all of them, and the face outside it.
struct Among<'m> {
    many: &'m dyn Many,
    clearance: Option<Clearance<'m>>,
    face: Option<Face>,
    things: Aabb,
    /// How far from the origin they are at the most \[m\].
    size: f32,
    /// True if points may go past solids in packets.
    has_packets: bool,
    /// Rows that wait to go past spheres, and past boxes.
    pairs: [Pairs; 2],
}

impl Among<'_> {
    /// Those of the things that may be near the ways of a row, and so much farther away on all sides.
    #[inline]
    fn few(&self, sought: &Sought, i: usize, beyond: f32) -> Few {
        let (bounds, [.., widest]) = (sought.around(i, beyond), sought.middle[i]);
        let nearest = self.clearance.and_then(|clearance| clearance.nearest(sought.cells[i], widest + beyond));
        nearest.map_or_else(|| self.many.few(&bounds), |numbers| self.many.few_of(numbers, &bounds))
    }
}

impl TileSweep<'_, '_> {
    /// Follows all past many things, those in packets that meet nothing but a flat face, `face`, or besides one solid.
    #[inline(never)]
    pub(super) fn go_among(&mut self, many: &dyn Many, face: Option<Face>, things: &Aabb) {
        let (len, old) = (self.tile.position.len(), self.tile.old);
        self.are_points = true;
        let mut waiting = face.map(Waiting::before);
        let size = max(max(largest(things.min), largest(things.max)), face.map_or(0.0, |face| face.size()));
        let has_packets = !self.has_materials;
        let mut among = Among {
            many,
            clearance: many.clearance(),
            face,
            things: *things,
            size,
            has_packets,
            pairs: [Pairs::EMPTY; 2],
        };
        let mut asking = Asking::nobody();
        for first in (0..old).step_by(BLOCK) {
            let rows = first..old.min(first + BLOCK);
            let past_face = self.near_face(rows.clone(), &mut among, &mut asking);
            if let Some(waiting) = &mut waiting {
                let marks = words(&past_face.touching).zip(words(&past_face.lying));
                for (row, (touching, lying)) in rows.step_by(u64::BITS as usize).zip(marks) {
                    self.queue(row, [touching, lying], waiting);
                }
            }
        }
        if let Some(waiting) = &mut waiting {
            self.go_on(waiting);
        }
        self.past_things::<false>(&mut among);
        self.past_things::<true>(&mut among);
        let known = face.map_or(Facing::Nothing, Facing::Face);
        for row in old..len {
            if !self.go_between(row, &among) {
                self.follow_past(row, self.tile.obstacles.colliders, Some(known));
            }
        }
    }

    /// Follows those of a block's rows that may be near things, and says which others may be near the face.
    fn near_face(&mut self, rows: Range<usize>, among: &mut Among<'_>, asking: &mut Asking) -> Near {
        let (first, nobody) = (rows.start, [0; BLOCK / LANES]);
        let block = self.balls().block(rows.clone(), self.tile.reached);
        let are_points = block.are_points();
        let nowhere = Near { touching: nobody, lying: nobody };
        let mut past_face = among.face.map_or(nowhere, |face| block.near(&face));
        let by_things = block.near_box(&among.things);
        let (change, rounding) = block.limits(among.size);
        let room = Room { change, rounding, swing: self.tile.obstacles.lead.is_some() };
        self.are_points &= are_points;
        let asked = either(&past_face.touching, &by_things);
        // Who gains speed by hits may get anywhere.
        if !never_gain(&self.tile.attributes.elasticity[rows]) {
            for (i, marks) in asked.iter().enumerate() {
                for k in ones(*marks) {
                    if self.go_between(first + LANES * i + k, among) {
                        past_face.touching[i] &= !(1 << k);
                    }
                }
            }
        } else {
            let gone = self.seek(first, &asked, among, room, asking);
            past_face.touching.iter_mut().zip(&gone).for_each(|(touching, gone)| *touching &= !gone);
        }
        past_face.lying.iter_mut().zip(&past_face.touching).for_each(|(lying, touching)| *lying &= touching);
        past_face
    }

    /// Follows those of a block's rows from the first on that are asked about and may be near things, at once or when there are enough of
    /// them, and says which these are.
    fn seek(&mut self, first: usize, asked: &Bits, among: &mut Among<'_>, room: Room, asking: &mut Asking) -> Bits {
        let last = self.tile.position.len() - 1;
        let mut gone = [0; BLOCK / LANES];
        for (row, mut marks) in (first..).step_by(u64::BITS as usize).zip(words(asked)) {
            if let Some(bit) = 1_u64.checked_shl((last - row.min(last)) as u32).filter(|bit| marks & bit != 0) {
                // A tile's last row has none behind it to be read with it.
                marks ^= bit;
                if self.go_between(last, among) {
                    gone[(last - first) / LANES] |= 1 << ((last - first) % LANES);
                }
            }
            // There are fewer than 2³² slots, and so fewer rows.
            asking.list.add(row as u32, marks);
            if asking.list.is_full() {
                self.seek_for(asking, first, among, room, &mut gone);
            }
        }
        self.seek_for(asking, first, among, room, &mut gone);
        gone
    }

    /// The same of those who have been asked about so far.
    #[inline(never)]
    fn seek_for(&mut self, asking: &mut Asking, first: usize, among: &mut Among<'_>, room: Room, gone: &mut Bits) {
        let Asking { list, sought } = asking;
        let (eights, len) = list.take_eights();
        run_broad(Seek { of: self, eights, len, face: among.face, clearance: among.clearance, room, sought });
        for (nth, (rows, sought)) in eights.iter().zip(sought).enumerate() {
            let are_there = if len < LANES * (nth + 1) { (1 << (len % LANES)) - 1 } else { u32::MAX };
            for i in ones(sought.near & are_there) {
                let row = rows[i % LANES] as usize;
                if self.go_near(row, sought, i % LANES, among) {
                    gone[(row - first) / LANES] |= 1 << ((row - first) % LANES);
                }
            }
        }
    }

    /// Follows a row that may be near things, or has it wait for others; false, if it is not near any.
    #[inline]
    fn go_near(&mut self, row: usize, sought: &Sought, i: usize, among: &mut Among<'_>) -> bool {
        let [x, y, z, widest] = sought.middle[i];
        if !(x + y + z + widest).is_finite() {
            return self.go_between(row, among);
        }
        let number = match among.few(sought, i, 0.0) {
            Few::Nothing => return false,
            Few::One(number) => number,
            Few::Several => return self.go_between(row, among),
        };
        let may_wait = among.has_packets && self.tile.attributes.lives.radius[row] == 0.0;
        let Some(solid) = among.many.solid(number).filter(|_| may_wait) else {
            return self.go_between(row, among);
        };
        let [.., beyond] = sought.half[i];
        let is_alone = matches!(among.few(sought, i, beyond), Few::One(_));
        let is_box = matches!(solid.0, Solid::Box(_));
        if among.pairs[usize::from(is_box)].push(row as u32, solid, is_alone) {
            if is_box { self.past_things::<true>(among) } else { self.past_things::<false>(among) }
        }
        true
    }

    /// Lets those go who wait to go past solids.
    #[inline(never)]
    fn past_things<const BOXES: bool>(&mut self, among: &mut Among<'_>) {
        let Some((len, pairs)) = among.pairs[usize::from(BOXES)].take() else { return };
        let unsettled = run_broad(PastThings::<BOXES> { of: self, len, pairs: &pairs, face: among.face });
        for i in ones(unsettled.left | unsettled.others) {
            let row = pairs.rows.as_flattened()[i] as usize;
            if !self.go_between(row, among) {
                self.follow(row);
            }
        }
    }

    /// Follows the particle in a row past the things that it is near; false, if there is nothing near but the face outside their box.
    fn go_between(&mut self, row: usize, among: &Among<'_>) -> bool {
        let Tile { dt, attributes: ref m, .. } = *self.tile;
        let own = [m.lives.radius[row], m.elasticity[row]];
        let Some(bounds) = surroundings(&self.path(row), own, dt.seconds(), among.size) else {
            self.follow(row);
            return true;
        };
        let Among { many, things, .. } = *among;
        things.overlaps(&bounds) && many.near(&bounds, &mut |walls| self.follow_past(row, walls, Some(Facing::Several)))
    }
}

/// The marks of both.
fn either(a: &Bits, b: &Bits) -> Bits {
    let mut both = *a;
    both.iter_mut().zip(b).for_each(|(both, other)| *both |= other);
    both
}

/// Tells whether all elasticities are between zero and one: the bits of such numbers are in the same order, and below those of all others.
fn never_gain(elasticities: &[f32]) -> bool {
    let most = widest(
        #[inline(always)]
        || elasticities.iter().fold(0, |most: u32, elasticity| most.max(elasticity.to_bits())),
    );
    most <= 1.0_f32.to_bits()
}
