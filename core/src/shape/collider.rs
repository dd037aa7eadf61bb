//! Things that a moving point can run into, one by one or in lists.

use super::crease::Leans;
use super::hit::earlier;
use super::{Aabb, Affine, Clearance, Contact, Crease, Face, Facing, Hit, Hulls, Marks, Ride, Segment, Solid};
use crate::composed::stands_for;
use crate::math::{along, dot, minus};
use crate::time::Time;
use glam::Vec3;

/// Something that a moving point or ball can run into.
///
/// A tuple, slice, option, reference or box of colliders is a collider: the earliest hit is its hit, of several at once that of the
/// collider listed first.
///
/// ```
/// use pointmass::shape::{Collider, Hit, Segment};
/// use pointmass::{Gravity, Heap, Particle, Scene, System, Time, Vec3};
///
/// /// Ground that waves along x.
/// struct Dunes;
///
/// impl Dunes {
///     fn height(p: Vec3) -> f32 {
///         p.y - 0.1 * p.x.sin()
///     }
/// }
///
/// impl Collider for Dunes {
///     fn first_hit(&self, segment: &Segment) -> Option<Hit> {
///         if !(Self::height(segment.from) > 0.0 && Self::height(segment.to) <= 0.0) {
///             return None;
///         }
///         let (mut above, mut below) = (0.0, 1.0);
///         for _ in 0..30 {
///             let middle = 0.5 * (above + below);
///             if Self::height(segment.at(middle)) > 0.0 { above = middle } else { below = middle }
///         }
///         let normal = Vec3::new(-0.1 * segment.at(above).x.cos(), 1.0, 0.0).normalize();
///         Some(Hit::new(above, normal, 1e-6)) // The last: how far the place may be off by rounding [m].
///     }
/// }
///
/// let start = [Particle { position: Vec3::new(0.5, 1.0, 0.0), ..Particle::REST }];
/// let scene = Scene { start: &start, forces: &Gravity::EARTH, colliders: &Dunes, ..Scene::EMPTY };
/// let mut system = System::with(Heap::new(scene.size()));
/// system.start(&scene, 1)?;
/// (1..=60).for_each(|frame| drop(system.step_to(&scene, Time::frame(frame, 60))));
/// assert!(system.totals().hits > 0 && Dunes::height(system.particles().position[0]) > 0.0);
/// # Ok::<(), pointmass::InsufficientMemory>(())
/// ```
pub trait Collider: Sync {
    /// Where `segment` first meets it, if it does.
    ///
    /// A point that starts on the surface and leaves it does not hit it: the surface of a closed solid belongs to the outside, an open surface to
    /// the side that its normal points to. A ball (`segment.radius`) hits when it first touches; a collider that takes balls for points lets them
    /// sink in by their radius. The engine sets what hit off the surface, by twice the hit's slack: one that is less than what rounding may do
    /// lets it pass. No path whose two ends lie on different sides goes unnoticed, however the arithmetic rounds.
    fn first_hit(&self, segment: &Segment) -> Option<Hit>;

    /// Tells whether a path inside `bounds` might meet it. May say yes too often, never no wrongly: it spares the
    /// search.
    fn may_touch(&self, bounds: &Aabb) -> bool {
        let _ = bounds;
        true
    }

    /// Marks those of many paths that might meet it, each inside a hull of its own: as [`Collider::may_touch`] says by default. Chips without an
    /// operating system do not ask.
    fn mark_near(&self, hulls: &Hulls, marks: &mut Marks) {
        if cfg!(target_os = "none") {
            return;
        }
        for (i, mark) in marks.iter_mut().enumerate() {
            if *mark == 0 && self.may_touch(&hulls.get(i)) {
                *mark = u32::MAX;
            }
        }
    }

    /// The part of it that a path inside `bounds` can meet: where that is one flat face, the path is followed there the
    /// short way, to the same bits. By default anything, unless the path may not touch it at all. Chips without an
    /// operating system do not ask.
    fn facing(&self, bounds: &Aabb) -> Facing {
        if cfg!(target_os = "none") || self.may_touch(bounds) { Facing::Several } else { Facing::Nothing }
    }

    /// It as many things, of which those that are near a place are found at once. By default it is one. Chips without an operating
    /// system do not ask.
    fn many(&self) -> Option<&dyn Many> {
        None
    }

    /// It as a solid that goes side by side with others, if that is all that it is.
    #[cfg(feature = "alloc")]
    fn solid(&self) -> Option<Solid> {
        None
    }

    /// Visits the places of it that are nearest to `center` and within `reach` \[m\] of it at an instant, one for each
    /// of its faces: what a ball there leans on, or is about to. None by default, which leaves all to `first_hit`.
    fn contacts(&self, center: Vec3, reach: f32, at: Time, visit: &mut dyn FnMut(&Contact)) {
        let _ = (center, reach, at, visit);
    }

    /// The same of the triangles of meshes with these numbers, and of what has but one part if zero is among them. By default it is sought among all.
    fn contacts_of(&self, faces: &[u32], center: Vec3, reach: f32, at: Time, visit: &mut dyn FnMut(&Contact)) {
        self.contacts(center, reach, at, &mut |contact| {
            if faces.contains(&contact.face) {
                visit(contact);
            }
        });
    }

    /// The crease that an acceleration presses what leans on all within `reach` \[m\] of `center` into at an instant: where two of them meet, or more; the sharpest, if
    /// that is not known. None, where any of those moves. By default it is sought among the contacts; what has no two surfaces that meet need not look.
    fn crease(&self, center: Vec3, reach: f32, at: Time, acceleration: Option<Vec3>) -> Option<Crease> {
        let mut leans = Leans::NONE;
        self.contacts(center, reach, at, &mut |contact| leans.add(contact));
        leans.crease(acceleration)
    }

    /// Where a ball that waits at `point` is by the end of a span, if what moves would run over it and takes it along.
    fn carry(&self, point: Vec3, radius: f32, during: [Time; 2]) -> Vec3 {
        let _ = (radius, during);
        point
    }

    /// The same of a ball that waits at the beginning of `way` and that other things have taken to its end meanwhile: there, or as far beside it as this would run over
    /// it. None, as by default, of what stands still: nobody is taken through that.
    fn carry_on(&self, way: &Segment) -> Option<Vec3> {
        let _ = way;
        None
    }

    /// Where a particle that rests is taken by what moves: `seat` leads from it into what it rests on, as that is at its
    /// first instant, and lasts for as long as it rides. None by default, and where the seat meets nothing that moves.
    fn ride(&self, seat: &Segment) -> Option<Ride> {
        let _ = seat;
        None
    }

    /// Tells whether it is known that nothing can ever hit it.
    fn is_empty(&self) -> bool {
        false
    }

    /// Tells whether any of it may move. By default it says so, which is always right; no is for speed: what lies still then is held against it once a
    /// step, not in each sub-step.
    fn moves(&self) -> bool {
        true
    }
}

/// A collider that maps of space may turn into another: what [`Placed`](super::Placed) puts somewhere.
pub trait Mapped: Collider {
    /// Visits colliders that together are its image under a map that is no similarity, as far as they may be near
    /// `bounds`, each with the number of its face. Balls ask for them, which such a map would make other than round.
    ///
    /// None by default: a ball meets the image of what says so as its centre alone does.
    fn image(&self, map: &Affine, bounds: &Aabb, visit: &mut dyn FnMut(u32, &dyn Collider)) {
        let _ = (map, bounds, visit);
    }
}

impl<T: Mapped + ?Sized> Mapped for &T {
    fn image(&self, map: &Affine, bounds: &Aabb, visit: &mut dyn FnMut(u32, &dyn Collider)) {
        (**self).image(map, bounds, visit);
    }
}

/// Many things, of which few are near any place.
pub trait Many: Sync {
    /// The box outside which there is nothing but one flat face, or nothing at all; none, if that is not known.
    fn outskirts(&self) -> Option<(Option<Face>, Aabb)>;

    /// Calls `then` with what answers as it does itself, and sooner where no question leads out of `bounds`: the few things there.
    /// Where there is nothing but the flat face it does not, and says so by false.
    fn near(&self, bounds: &Aabb, then: &mut dyn FnMut(&dyn Collider)) -> bool;

    /// How far more than the flat face is from anywhere, if that is known.
    fn clearance(&self) -> Option<Clearance<'_>> {
        None
    }

    /// One of them by the number that the clearance knows it by, if it is a solid, and whether it comes after the flat face in their order.
    fn solid(&self, number: usize) -> Option<(Solid, bool)> {
        let _ = number;
        None
    }

    /// Those of them that may share a point with a box.
    fn few(&self, bounds: &Aabb) -> Few {
        let _ = bounds;
        Few::Several
    }
}

/// How many of many things there may be in a place.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Few {
    /// None.
    Nothing,
    /// One, by its number.
    One(usize),
    /// Two, by their numbers in ascending order.
    Two([usize; 2]),
    /// One or more.
    Several,
}

impl Few {
    /// The same and one more, if it is not among them.
    pub(crate) fn and(self, number: usize) -> Self {
        match self {
            Self::Nothing => Self::One(number),
            Self::One(one) if one < number => Self::Two([one, number]),
            Self::One(one) if one > number => Self::Two([number, one]),
            Self::Two(two) if !two.contains(&number) => Self::Several,
            _ => self,
        }
    }
}

impl Collider for () {
    fn first_hit(&self, _: &Segment) -> Option<Hit> {
        None
    }
    fn may_touch(&self, _: &Aabb) -> bool {
        false
    }
    fn mark_near(&self, _: &Hulls, _: &mut Marks) {}
    fn facing(&self, _: &Aabb) -> Facing {
        Facing::Nothing
    }
    fn crease(&self, _: Vec3, _: f32, _: Time, _: Option<Vec3>) -> Option<Crease> {
        None
    }
    fn is_empty(&self) -> bool {
        true
    }
    fn moves(&self) -> bool {
        false
    }
}

stands_for! {
    Collider {
        fn first_hit(&self, segment: &Segment) -> Option<Hit> {
            (**self).first_hit(segment)
        }
        fn may_touch(&self, bounds: &Aabb) -> bool {
            (**self).may_touch(bounds)
        }
        fn mark_near(&self, hulls: &Hulls, marks: &mut Marks) {
            (**self).mark_near(hulls, marks);
        }
        fn facing(&self, bounds: &Aabb) -> Facing {
            (**self).facing(bounds)
        }
        fn many(&self) -> Option<&dyn Many> {
            (**self).many()
        }
        #[cfg(feature = "alloc")]
        fn solid(&self) -> Option<Solid> {
            (**self).solid()
        }
        fn contacts(&self, center: Vec3, reach: f32, at: Time, visit: &mut dyn FnMut(&Contact)) {
            (**self).contacts(center, reach, at, visit);
        }
        fn contacts_of(&self, faces: &[u32], center: Vec3, reach: f32, at: Time, visit: &mut dyn FnMut(&Contact)) {
            (**self).contacts_of(faces, center, reach, at, visit);
        }
        fn crease(&self, center: Vec3, reach: f32, at: Time, acceleration: Option<Vec3>) -> Option<Crease> {
            (**self).crease(center, reach, at, acceleration)
        }
        fn carry(&self, point: Vec3, radius: f32, during: [Time; 2]) -> Vec3 {
            (**self).carry(point, radius, during)
        }
        fn carry_on(&self, way: &Segment) -> Option<Vec3> {
            (**self).carry_on(way)
        }
        fn ride(&self, seat: &Segment) -> Option<Ride> {
            (**self).ride(seat)
        }
        fn is_empty(&self) -> bool {
            (**self).is_empty()
        }
        fn moves(&self) -> bool {
            (**self).moves()
        }
    }
}

/// The largest number of times that things take a ball along by turns. Those that need more squeeze it.
const MAX_TURNS: u32 = 4;

/// Where a ball is in the end that things take along in turns, until none of them takes it farther.
fn carried(way: &Segment, take: impl Fn(&mut Segment)) -> Vec3 {
    let mut way = *way;
    for _ in 0..MAX_TURNS {
        let to = way.to;
        take(&mut way);
        if way.to == to {
            break;
        }
    }
    way.to
}

/// Where one of several things takes a ball along, or lets others take it.
fn taken(thing: &(impl Collider + ?Sized), way: &Segment) -> Vec3 {
    let Segment { from, to, radius, during } = *way;
    if from == to {
        return thing.carry(from, radius, during);
    }
    // What stands still leaves it what leads along the surface.
    let held = || {
        thing.first_hit(way).map_or(to, |hit| {
            let across = dot(minus(way.at(hit.time), to), hit.normal);
            along(to, hit.normal, across + 2.0 * hit.slack)
        })
    };
    thing.carry_on(way).unwrap_or_else(held)
}

/// Visits the contacts of all faces of a collider with a ball, or of some.
pub(super) fn contacts_among(
    of: &impl Collider,
    faces: Option<&[u32]>,
    (center, reach): (Vec3, f32),
    at: Time,
    visit: &mut dyn FnMut(&Contact),
) {
    match faces {
        Some(faces) => of.contacts_of(faces, center, reach, at, visit),
        None => of.contacts(center, reach, at, visit),
    }
}

impl<T: Collider> Collider for [T] {
    fn first_hit(&self, segment: &Segment) -> Option<Hit> {
        let bounds = segment.bounds();
        let near = self.iter().filter(|c| c.may_touch(&bounds));
        near.fold(None, |best, c| earlier(best, c.first_hit(segment)))
    }
    fn may_touch(&self, bounds: &Aabb) -> bool {
        self.iter().any(|c| c.may_touch(bounds))
    }
    fn mark_near(&self, hulls: &Hulls, marks: &mut Marks) {
        self.iter().for_each(|c| c.mark_near(hulls, marks));
    }
    fn facing(&self, bounds: &Aabb) -> Facing {
        self.iter().fold(Facing::Nothing, |facing, c| match facing {
            Facing::Several => facing,
            one => one.and(c.facing(bounds)),
        })
    }
    fn contacts(&self, center: Vec3, reach: f32, at: Time, visit: &mut dyn FnMut(&Contact)) {
        let bounds = Aabb { min: center - reach, max: center + reach };
        self.iter().filter(|c| c.may_touch(&bounds)).for_each(|c| c.contacts(center, reach, at, visit));
    }
    fn contacts_of(&self, faces: &[u32], center: Vec3, reach: f32, at: Time, visit: &mut dyn FnMut(&Contact)) {
        let bounds = Aabb { min: center - reach, max: center + reach };
        self.iter().filter(|c| c.may_touch(&bounds)).for_each(|c| c.contacts_of(faces, center, reach, at, visit));
    }
    fn carry(&self, point: Vec3, radius: f32, during: [Time; 2]) -> Vec3 {
        self.carry_on(&Segment::waiting(point, radius, during)).unwrap_or(point)
    }
    fn carry_on(&self, way: &Segment) -> Option<Vec3> {
        Some(carried(way, |way| {
            for c in self {
                if c.may_touch(&way.bounds()) {
                    way.to = taken(c, way);
                }
            }
        }))
    }
    fn ride(&self, seat: &Segment) -> Option<Ride> {
        let bounds = seat.bounds();
        self.iter().filter(|c| c.may_touch(&bounds)).find_map(|c| c.ride(seat))
    }
    fn is_empty(&self) -> bool {
        self.iter().all(Collider::is_empty)
    }
    fn moves(&self) -> bool {
        self.iter().any(Collider::moves)
    }
}

/// Everything that holds a slice is what the slice is.
macro_rules! lists {
    ($($(#[$when:meta])* [$($generics:tt)*] $list:ty;)+) => {$(
        $(#[$when])*
        impl<$($generics)*> Collider for $list {
            fn first_hit(&self, segment: &Segment) -> Option<Hit> {
                self.as_slice().first_hit(segment)
            }
            fn may_touch(&self, bounds: &Aabb) -> bool {
                self.as_slice().may_touch(bounds)
            }
            fn mark_near(&self, hulls: &Hulls, marks: &mut Marks) {
                self.as_slice().mark_near(hulls, marks);
            }
            fn facing(&self, bounds: &Aabb) -> Facing {
                self.as_slice().facing(bounds)
            }
            fn contacts(&self, center: Vec3, reach: f32, at: Time, visit: &mut dyn FnMut(&Contact)) {
                self.as_slice().contacts(center, reach, at, visit);
            }
            fn contacts_of(&self, faces: &[u32], center: Vec3, reach: f32, at: Time, visit: &mut dyn FnMut(&Contact)) {
                self.as_slice().contacts_of(faces, center, reach, at, visit);
            }
            fn carry(&self, point: Vec3, radius: f32, during: [Time; 2]) -> Vec3 {
                self.as_slice().carry(point, radius, during)
            }
            fn carry_on(&self, way: &Segment) -> Option<Vec3> {
                self.as_slice().carry_on(way)
            }
            fn ride(&self, seat: &Segment) -> Option<Ride> {
                self.as_slice().ride(seat)
            }
            fn is_empty(&self) -> bool {
                self.iter().all(Collider::is_empty)
            }
            fn moves(&self) -> bool {
                self.iter().any(Collider::moves)
            }
        }
    )+};
}
lists! {
    [T: Collider, const N: usize] [T; N];
    [T: Collider, const N: usize] heapless::Vec<T, N>;
    [T: Collider] Option<T>;
    #[cfg(feature = "alloc")]
    [T: Collider] alloc::vec::Vec<T>;
}

macro_rules! tuples {
    ($($name:ident)+) => {
        impl<$($name: Collider),+> Collider for ($($name,)+) {
            fn first_hit(&self, segment: &Segment) -> Option<Hit> {
                #[allow(non_snake_case)]
                let ($($name,)+) = self;
                let (mut best, bounds) = (None, segment.bounds());
                $(if $name.may_touch(&bounds) {
                    best = earlier(best, $name.first_hit(segment));
                })+
                best
            }
            fn may_touch(&self, bounds: &Aabb) -> bool {
                #[allow(non_snake_case)]
                let ($($name,)+) = self;
                $($name.may_touch(bounds))||+
            }
            fn mark_near(&self, hulls: &Hulls, marks: &mut Marks) {
                #[allow(non_snake_case)]
                let ($($name,)+) = self;
                $($name.mark_near(hulls, marks);)+
            }
            fn facing(&self, bounds: &Aabb) -> Facing {
                #[allow(non_snake_case)]
                let ($($name,)+) = self;
                Facing::Nothing$(.and($name.facing(bounds)))+
            }
            fn contacts(&self, center: Vec3, reach: f32, at: Time, visit: &mut dyn FnMut(&Contact)) {
                #[allow(non_snake_case)]
                let ($($name,)+) = self;
                let bounds = Aabb { min: center - reach, max: center + reach };
                $(if $name.may_touch(&bounds) {
                    $name.contacts(center, reach, at, visit);
                })+
            }
            fn contacts_of(&self, faces: &[u32], center: Vec3, reach: f32, at: Time, visit: &mut dyn FnMut(&Contact)) {
                #[allow(non_snake_case)]
                let ($($name,)+) = self;
                let bounds = Aabb { min: center - reach, max: center + reach };
                $(if $name.may_touch(&bounds) {
                    $name.contacts_of(faces, center, reach, at, visit);
                })+
            }
            fn carry(&self, point: Vec3, radius: f32, during: [Time; 2]) -> Vec3 {
                self.carry_on(&Segment::waiting(point, radius, during)).unwrap_or(point)
            }
            fn carry_on(&self, way: &Segment) -> Option<Vec3> {
                #[allow(non_snake_case)]
                let ($($name,)+) = self;
                Some(carried(way, |way| {
                    $(way.to = taken($name, way);)+
                }))
            }
            fn ride(&self, seat: &Segment) -> Option<Ride> {
                #[allow(non_snake_case)]
                let ($($name,)+) = self;
                None$(.or_else(|| $name.ride(seat)))+
            }
            fn moves(&self) -> bool {
                #[allow(non_snake_case)]
                let ($($name,)+) = self;
                $($name.moves())||+
            }
            fn is_empty(&self) -> bool {
                #[allow(non_snake_case)]
                let ($($name,)+) = self;
                $($name.is_empty())&&+
            }
        }
    };
}
tuples!(A);
tuples!(A B);
tuples!(A B C);
tuples!(A B C D);
tuples!(A B C D E);
tuples!(A B C D E F);
