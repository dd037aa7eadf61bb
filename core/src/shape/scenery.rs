//! Many things to run into, behind an index of their boxes.

use super::cells::{Cells, Found, insert};
use super::clearance::{Clearance, ClearanceBuf};
use super::{Aabb, Collider, Contact, Face, Facing, Few, Hit, Hulls, Many, Marks, Ride, Segment, Solid, earlier};
use crate::math::{largest, max};
use crate::rays::{IndexBuf, Pieces, Structure};
use crate::time::Time;
use alloc::vec::Vec;
use core::ops::Deref;
use glam::Vec3;

/// Fewer things than this are looked at one by one.
const WORTH_AN_INDEX: usize = 8;

/// Everything.
const EVERYWHERE: Aabb = Aabb { min: Vec3::NEG_INFINITY, max: Vec3::INFINITY };

/// A list of colliders of which only those are asked whose boxes are near: what a hundred things cost is little more than what one
/// costs that a particle is near.
///
/// It answers what the list of them answers, to the bit, in the same order.
#[derive(Clone, Debug)]
pub struct Scenery<C> {
    things: Vec<C>,
    boxes: Boxes,
    /// A box around those that have one.
    all: Aabb,
    /// Those whose boxes have no end, and which are therefore always near.
    endless: Vec<usize>,
    /// The other boxes by the cells of a grid, for whoever is asked about a small place.
    cells: Cells,
    /// How far they are from anywhere.
    clearance: ClearanceBuf,
    /// Those that are solids.
    solids: Vec<Option<Solid>>,
    /// An index of them for all others; none, if there are few.
    index: IndexBuf,
    /// True if any of them may move.
    moves: bool,
}

/// Those things of many that are near a place.
struct Nearby<'s, C> {
    of: &'s Scenery<C>,
    /// Their numbers, and where no other is; none, if they are too many.
    known: Option<(&'s Found, Aabb)>,
}

/// Boxes as an index sees them.
#[derive(Clone, Debug)]
struct Boxes(Vec<Aabb>);

impl Pieces for Boxes {
    fn count(&self) -> usize {
        self.0.len()
    }
    fn box_of(&self, piece: usize) -> Aabb {
        self.0.get(piece).copied().unwrap_or(Aabb::EMPTY)
    }
    fn hit(&self, _: usize, _: &Segment) -> Option<Hit> {
        None
    }
}

impl<C: Collider> Scenery<C> {
    /// Things, each with a box around all that it ever reaches. Takes n log n time.
    #[must_use]
    pub fn new(things: Vec<(C, Aabb)>) -> Self {
        let (things, boxes): (Vec<C>, Vec<Aabb>) = things.into_iter().unzip();
        let boxes = Boxes(boxes.iter().map(with_room).collect());
        let is_endless = |bounds: &Aabb| !(bounds.min.is_finite() && bounds.max.is_finite());
        let endless = (0..things.len()).filter(|&number| is_endless(&boxes.0[number])).collect();
        let all = boxes.0.iter().filter(|bounds| !is_endless(bounds)).fold(Aabb::EMPTY, |all, one| all.join(*one));
        let is_few = things.len() < WORTH_AN_INDEX;
        let index = if is_few { IndexBuf::default() } else { IndexBuf::new(Structure::Bvh, &boxes) };
        let cells = Cells::new(&boxes.0, &all, &|number| !is_endless(&boxes.0[number]));
        let ends: Vec<(u32, &Aabb)> = (0..).zip(&boxes.0).filter(|(_, bounds)| !is_endless(bounds)).collect();
        let clearance = ClearanceBuf::new(&ends, &all);
        let solids = things.iter().map(Collider::solid).collect();
        let moves = things.moves();
        Self { things, boxes, all, endless, cells, clearance, solids, index, moves }
    }

    /// Finds those that a box may share a point with; false, if they may be too many.
    #[inline]
    fn find(&self, bounds: &Aabb, found: &mut Found) -> bool {
        let has_room = self.endless.iter().all(|&number| insert(found, number as u32));
        has_room && self.cells.near(&self.boxes.0, bounds, found)
    }

    /// Visits those that a box may share a point with, in their order.
    fn near(&self, bounds: &Aabb, visit: &mut dyn FnMut(&C)) {
        let mut found = Found::new();
        if self.find(bounds, &mut found) {
            self.visit(&found, bounds, visit);
        } else {
            self.visit_many(bounds, visit);
        }
    }

    /// Visits those of some that a box may share a point with.
    #[inline]
    fn visit(&self, numbers: &[u32], bounds: &Aabb, visit: &mut dyn FnMut(&C)) {
        numbers
            .iter()
            .map(|&number| &self.things[number as usize])
            .filter(|thing| thing.may_touch(bounds))
            .for_each(visit);
    }

    #[inline(never)]
    fn visit_many(&self, bounds: &Aabb, visit: &mut dyn FnMut(&C)) {
        let mut ask = |thing: &C| {
            if thing.may_touch(bounds) {
                visit(thing);
            }
        };
        if self.index.view().words().is_empty() {
            return self.things.iter().for_each(ask);
        }
        let mut endless = self.endless.iter().copied().peekable();
        self.index.view().near(&self.boxes, bounds, &mut |number| {
            while let Some(before) = endless.next_if(|&before| before < number) {
                ask(&self.things[before]);
            }
            ask(&self.things[number]);
        });
        endless.for_each(|number| ask(&self.things[number]));
    }

    /// All of them.
    fn anywhere(&self) -> Nearby<'_, C> {
        Nearby { of: self, known: None }
    }
}

impl<C: Collider> Nearby<'_, C> {
    /// Visits those that a box may share a point with, in their order.
    #[inline]
    fn near(&self, bounds: &Aabb, mut visit: impl FnMut(&C)) {
        match self.known {
            Some((numbers, within)) if holds(&within, bounds) => self.of.visit(numbers, bounds, &mut visit),
            _ => self.of.near(bounds, &mut visit),
        }
    }
}

/// Tells whether a box holds another.
#[inline]
fn holds(outer: &Aabb, inner: &Aabb) -> bool {
    let holds = |axis: usize| (inner.min[axis] >= outer.min[axis]) & (inner.max[axis] <= outer.max[axis]);
    holds(0) & holds(1) & holds(2)
}

/// A box with room for what rounding may do to whoever is held against it, and for what lines touch beside themselves.
fn with_room(bounds: &Aabb) -> Aabb {
    let room = 128.0 * f32::EPSILON * max(largest(bounds.min), largest(bounds.max)) + 2e-5;
    Aabb { min: bounds.min - room, max: bounds.max + room }
}

impl<C> Deref for Scenery<C> {
    type Target = [C];
    fn deref(&self) -> &[C] {
        &self.things
    }
}

impl<C: Collider> Many for Scenery<C> {
    fn outskirts(&self) -> Option<(Option<Face>, Aabb)> {
        match *self.endless {
            [] => Some((None, self.all)),
            [number] => match self.things[number].facing(&EVERYWHERE) {
                Facing::Face(face) => Some((Some(face), self.all)),
                Facing::Nothing => Some((None, self.all)),
                Facing::Several => None,
            },
            _ => None,
        }
    }

    fn near(&self, bounds: &Aabb, then: &mut dyn FnMut(&dyn Collider)) -> bool {
        let mut found = Found::new();
        let is_known = self.find(bounds, &mut found);
        let is_anything = !is_known || found.len() > self.endless.len();
        if is_anything {
            then(&Nearby { of: self, known: is_known.then_some((&found, *bounds)) });
        }
        is_anything
    }

    fn clearance(&self) -> Option<Clearance<'_>> {
        Some(self.clearance.view())
    }

    fn solid(&self, number: usize) -> Option<(Solid, bool)> {
        let solid = (*self.solids.get(number)?)?;
        Some((solid, self.endless.first().is_some_and(|&face| face < number)))
    }

    fn few(&self, bounds: &Aabb) -> Few {
        self.cells.few(&self.boxes.0, bounds)
    }
}

impl<C: Collider> Collider for Nearby<'_, C> {
    fn moves(&self) -> bool {
        self.of.moves
    }

    fn first_hit(&self, segment: &Segment) -> Option<Hit> {
        let mut best = None;
        self.near(&segment.bounds(), |thing| best = earlier(best, thing.first_hit(segment)));
        best
    }

    fn may_touch(&self, bounds: &Aabb) -> bool {
        let mut may = false;
        self.near(bounds, |_| may = true);
        may
    }

    fn facing(&self, bounds: &Aabb) -> Facing {
        match self.known {
            Some((numbers, within)) if holds(&within, bounds) => {
                numbers.iter().fold(Facing::Nothing, |facing, &number| match facing {
                    Facing::Several => facing,
                    one => one.and(self.of.things[number as usize].facing(bounds)),
                })
            }
            _ => self.of.facing(bounds),
        }
    }

    fn contacts(&self, center: Vec3, reach: f32, at: Time, visit: &mut dyn FnMut(&Contact)) {
        let bounds = Aabb { min: center - reach, max: center + reach };
        self.near(&bounds, |thing| thing.contacts(center, reach, at, visit));
    }

    fn contacts_of(&self, faces: &[u32], center: Vec3, reach: f32, at: Time, visit: &mut dyn FnMut(&Contact)) {
        let bounds = Aabb { min: center - reach, max: center + reach };
        self.near(&bounds, |thing| thing.contacts_of(faces, center, reach, at, visit));
    }

    fn carry(&self, point: Vec3, radius: f32, during: [Time; 2]) -> Vec3 {
        self.of.things.carry(point, radius, during)
    }

    fn carry_on(&self, way: &Segment) -> Option<Vec3> {
        self.of.things.carry_on(way)
    }

    fn ride(&self, seat: &Segment) -> Option<Ride> {
        let mut ride = None;
        self.near(&seat.bounds(), |thing| ride = ride.or_else(|| thing.ride(seat)));
        ride
    }

    fn is_empty(&self) -> bool {
        Collider::is_empty(&self.of.things[..])
    }
}

impl<C: Collider> Collider for Scenery<C> {
    fn moves(&self) -> bool {
        self.moves
    }

    fn first_hit(&self, segment: &Segment) -> Option<Hit> {
        self.anywhere().first_hit(segment)
    }

    fn may_touch(&self, bounds: &Aabb) -> bool {
        self.anywhere().may_touch(bounds)
    }

    fn mark_near(&self, hulls: &Hulls, marks: &mut Marks) {
        if self.index.view().words().is_empty() {
            return self.things.mark_near(hulls, marks);
        }
        self.endless.iter().for_each(|&number| self.things[number].mark_near(hulls, marks));
        let mut near_any = [0; Hulls::MANY];
        hulls.near_box(&self.all, &mut near_any);
        // Each thing marks as it would in a list, all rows at once; who is near it is only asked to find the things.
        let mut asked = heapless::Vec::<usize, 16>::new();
        for i in (0..Hulls::MANY).filter(|&i| near_any[i] != 0) {
            if marks[i] != 0 {
                continue;
            }
            self.index.view().near(&self.boxes, &hulls.get(i), &mut |number| {
                if !asked.contains(&number) {
                    self.things[number].mark_near(hulls, marks);
                    // Whoever finds no room here is asked again, to no other answer.
                    let _ = asked.push(number);
                }
            });
        }
    }

    fn facing(&self, bounds: &Aabb) -> Facing {
        let mut facing = Facing::Nothing;
        self.near(bounds, &mut |thing| {
            if facing != Facing::Several {
                facing = facing.and(thing.facing(bounds));
            }
        });
        facing
    }

    fn many(&self) -> Option<&dyn Many> {
        Some(self)
    }

    fn contacts(&self, center: Vec3, reach: f32, at: Time, visit: &mut dyn FnMut(&Contact)) {
        self.anywhere().contacts(center, reach, at, visit);
    }

    fn contacts_of(&self, faces: &[u32], center: Vec3, reach: f32, at: Time, visit: &mut dyn FnMut(&Contact)) {
        self.anywhere().contacts_of(faces, center, reach, at, visit);
    }

    fn carry(&self, point: Vec3, radius: f32, during: [Time; 2]) -> Vec3 {
        self.anywhere().carry(point, radius, during)
    }

    fn carry_on(&self, way: &Segment) -> Option<Vec3> {
        self.anywhere().carry_on(way)
    }

    fn ride(&self, seat: &Segment) -> Option<Ride> {
        self.anywhere().ride(seat)
    }

    fn is_empty(&self) -> bool {
        self.anywhere().is_empty()
    }
}
