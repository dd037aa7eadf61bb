//! Rows among many things: who may be near any of them is told many at a time, and only those look for what they are near.

use super::beside::{Beside, PastThings};
use super::packets::{ALL, Unsettled};
use super::seek::{Asking, Seek, Sought, Tell, Told};
use super::ways::Room;
use super::{Bits, TileSweep, Waiting, words};
use crate::collide::near::{BLOCK, Near};
use crate::collide::packet::{BOXES, EITHER, SPHERES};
use crate::collide::sweep::surroundings;
use crate::collide::tile::Tile;
use crate::collide::waiting::ones;
use crate::force::Attributes;
use crate::lanes::{LANES, run_broad, widest};
use crate::math::{largest, max};
use crate::shape::{Aabb, Clearance, Face, Facing, Few, Many, Solid};
use core::ops::Range;
use core::slice;

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
    /// Rows that wait to go past a sphere, past a box, and past two things.
    spheres: Beside<1>,
    boxes: Beside<1>,
    twos: Beside<2>,
}

impl Among<'_> {
    /// The solids that rows go past in packets, of these numbers and in their order; none, if one is something else.
    fn solids<const MANY: usize>(&self, numbers: [usize; MANY]) -> Option<[(Solid, bool); MANY]> {
        let mut solids = [(Solid::NONE, false); MANY];
        for (solid, number) in solids.iter_mut().zip(numbers) {
            *solid = self.many.solid(number)?;
        }
        Some(solids)
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
            spheres: Beside::NOBODY,
            boxes: Beside::NOBODY,
            twos: Beside::NOBODY,
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
        self.past_spheres(&mut among);
        self.past_boxes(&mut among);
        self.past_two(&mut among);
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
        let Attributes { elasticity, common, .. } = self.tile.attributes;
        if !never_gain(common.elasticity().as_ref().map_or(&elasticity[rows], slice::from_ref)) {
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
        let Asking { list, sought, near, told } = asking;
        let ((eights, len), clearance) = (list.take_eights(), among.clearance);
        run_broad(Seek { of: self, eights, len, face: among.face, clearance, room, sought });
        for (nth, some) in sought.chunks(LANES).enumerate() {
            let word = some.iter().rev().fold(0, |word, sought| word << LANES | u64::from(sought.near));
            let are_there = u64::MAX.checked_shl(len.saturating_sub(64 * nth) as u32).map_or(u64::MAX, |none| !none);
            near.add((64 * nth) as u32, word & are_there);
        }
        let (places, len) = near.take_eights();
        run_broad(Tell { places, len, sought, clearance, told });
        for (nth, (places, told)) in places.iter().zip(&*told).enumerate() {
            let are_there = if len < LANES * (nth + 1) { (1 << (len % LANES)) - 1 } else { ALL };
            for i in ones(told.may_meet() & are_there) {
                let place = places[i] as usize;
                let (row, sought) = (eights.as_flattened()[place] as usize, &sought[place / LANES]);
                if self.go_near(row, (told, i), (sought, place % LANES), among) {
                    gone[(row - first) / LANES] |= 1 << ((row - first) % LANES);
                }
            }
        }
    }

    /// Follows a row that may be near things, or has it wait for others; false, if it is not near any.
    #[inline]
    fn go_near(
        &mut self,
        row: usize,
        (told, nth): (&Told, usize),
        (sought, lane): (&Sought, usize),
        among: &mut Among<'_>,
    ) -> bool {
        let around = |beyond: f32| {
            let bounds = sought.around(lane, beyond);
            let is_finite = bounds.min.is_finite() && bounds.max.is_finite();
            if is_finite { among.many.few(&bounds) } else { Few::Several }
        };
        let few = told.few(nth).unwrap_or_else(|| around(0.0));
        if few == Few::Nothing {
            return false;
        }
        let [.., beyond] = sought.half[lane];
        let may_wait = among.has_packets && self.tile.attributes.lives.radius[row] == 0.0;
        let is_alone = may_wait && told.is_alone(nth).unwrap_or_else(|| around(beyond) == few);
        let number = row as u32;
        match few {
            Few::One(one) if may_wait => {
                let Some([solid]) = among.solids([one]) else { return self.go_between(row, among) };
                if matches!(solid.0, Solid::Box(_)) {
                    if among.boxes.push(number, [solid], is_alone) {
                        self.past_boxes(among);
                    }
                } else if among.spheres.push(number, [solid], is_alone) {
                    self.past_spheres(among);
                }
            }
            Few::Two(two) if may_wait => {
                let Some(solids) = among.solids(two) else { return self.go_between(row, among) };
                if among.twos.push(number, solids, is_alone) {
                    self.past_two(among);
                }
            }
            _ => return self.go_between(row, among),
        }
        true
    }

    /// Lets those go who wait to go past a sphere.
    #[inline(never)]
    fn past_spheres(&mut self, among: &mut Among<'_>) {
        let Some((len, waiting)) = among.spheres.take() else { return };
        let unsettled = run_broad(PastThings::<1, SPHERES> { of: self, len, waiting: &waiting, face: among.face });
        self.go_alone(&waiting, &unsettled, among);
    }

    /// The same past a box.
    #[inline(never)]
    fn past_boxes(&mut self, among: &mut Among<'_>) {
        let Some((len, waiting)) = among.boxes.take() else { return };
        let unsettled = run_broad(PastThings::<1, BOXES> { of: self, len, waiting: &waiting, face: among.face });
        self.go_alone(&waiting, &unsettled, among);
    }

    /// The same past two things.
    #[inline(never)]
    fn past_two(&mut self, among: &mut Among<'_>) {
        let Some((len, waiting)) = among.twos.take() else { return };
        let unsettled = run_broad(PastThings::<2, EITHER> { of: self, len, waiting: &waiting, face: among.face });
        self.go_alone(&waiting, &unsettled, among);
    }

    /// Follows those by themselves who have waited and have not come to the end of the step with others.
    fn go_alone<const MANY: usize>(&mut self, waiting: &Beside<MANY>, unsettled: &Unsettled, among: &Among<'_>) {
        for i in ones(unsettled.left | unsettled.others) {
            let row = waiting.rows.as_flattened()[i] as usize;
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
        let Among { many, clearance, things, .. } = *among;
        let is_near = things.overlaps(&bounds) && !clearance.is_some_and(|clearance| clearance.is_free(&bounds));
        is_near && many.near(&bounds, &mut |walls| self.follow_past(row, walls, Some(Facing::Several)))
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
