//! The queries, written once: a structure only says where points may be.

use super::domain::{Domain, FAR, Image, around};
use super::near::{Near, chunks};
use super::nearest::Nearest;
use super::partition::Partition;
use super::region::{Region, Run};
use super::sorted::{Counter, Found, Probe, Sorted};
use super::{Cost, Neighbour};
use crate::math::{self, max, min, sqrt};
use core::ops::Range;
use glam::Vec3;

/// A query's radius, in the index.
#[derive(Clone, Copy)]
pub(super) struct Reach {
    pub(super) radius: f32,
    pub(super) square: f32,
    /// True if points could be met in two images: then all of them are looked at, each in its nearest image.
    wraps: bool,
}

impl Reach {
    fn new(radius: f32, domain: &Domain) -> Self {
        Self { radius, square: radius * radius, wraps: domain.half() <= radius }
    }
}

/// Tells whether squares of distances from here may be beyond an `f32`: then all points are looked at. No point of an
/// index is so far out itself.
fn is_far(center: Vec3) -> bool {
    !(math::largest(center) < FAR)
}

/// A task at each point on the way through all.
trait Sweep {
    /// True if only runs that go on behind a slot are of interest to it.
    const FORWARD: bool = false;
    fn begin(&mut self, slot: usize);
    /// Looks at the slots of a run; returns how many distances that took.
    fn scan(&mut self, slot: usize, run: Range<usize>, probe: &Probe) -> u64;
    fn end(&mut self, slot: usize);
}

/// A partition's queries.
pub(super) struct Search<'a, P>(pub(super) &'a P);

impl<P: Partition> Search<'_, P> {
    /// None where nothing can be found: the radius is negative or undefined, or there are no points.
    pub(super) fn reach(&self, radius: f32) -> Option<Reach> {
        let sorted = self.0.sorted();
        (radius >= 0.0 && sorted.len > 0).then(|| Reach::new(sorted.domain.length(radius), &sorted.domain))
    }

    /// Visits the runs that may hold points within reach of a region, in every image; returns the nodes visited.
    #[inline(always)]
    fn runs(&self, region: &Region, reach: Reach, mut visit: impl FnMut(Run, Image) -> bool) -> u64 {
        let sorted = self.0.sorted();
        if reach.wraps || is_far(region.low) || is_far(region.high) {
            let everywhere = Vec3::splat(f32::INFINITY);
            visit(
                Run { slots: 0..sorted.len, low: -everywhere, high: everywhere, frame: 0 },
                sorted.domain.image_of_all(),
            );
            return 1;
        }
        let mut visits = 0;
        sorted.domain.images(region.low, region.high, reach.radius, |image| {
            visits += self.0.near(region, image, reach.radius, &mut |run| visit(run, image));
        });
        visits
    }

    /// Scans everything that may be within reach of one place.
    #[inline(always)]
    fn scan(&self, center: Vec3, reach: Reach, mut scan: impl FnMut(&Range<usize>, &Probe)) -> Cost {
        let mut tests = 0;
        let visits = self.runs(&Region::point(center), reach, |run, image| {
            tests += run.slots.len() as u64;
            scan(&run.slots, &Probe::new(center, image, reach.square));
            true
        });
        Cost { visits, tests, found: 0 }
    }

    /// Scans for every slot everything that may be within reach of it, near slots together.
    fn sweep<W: Sweep>(&self, reach: Reach, sweep: &mut W) -> Cost {
        let (sorted, mut cost, mut near) = (self.0.sorted(), Cost::default(), Near::new());
        self.0.groups(&mut |slots, frame| {
            for group in chunks(slots) {
                let from = if W::FORWARD { group.start + 1 } else { 0 };
                cost.visits += self.gather(&group, frame, from, reach, &mut near);
                for slot in group {
                    let center = sorted.point(slot);
                    sweep.begin(slot);
                    if near.full {
                        cost.visits += self.runs(&Region::point(center), reach, |run, image| {
                            cost.tests += sweep.scan(slot, run.slots, &Probe::new(center, image, reach.square));
                            true
                        });
                    } else {
                        let probe = Probe::new(center, Image::Itself, reach.square);
                        near.each(self.0, P::BOXED, (slot, center), reach.square, |_, run, image| {
                            cost.tests += sweep.scan(slot, run, &probe.of(image));
                        });
                    }
                    sweep.end(slot);
                }
            }
        });
        cost
    }

    /// Remembers what of the slots `from` some on is near a group; returns the nodes visited.
    pub(super) fn gather(&self, group: &Range<usize>, frame: u32, from: usize, reach: Reach, near: &mut Near) -> u64 {
        let sorted = self.0.sorted();
        let mut region = Region::new(sorted.bounds(group.clone()));
        if P::TURNS && frame != 0 {
            for (turned, slot) in near.turned.iter_mut().zip(group.clone()) {
                *turned = self.0.turn(frame, sorted.point(slot));
            }
            region.home = (frame, around(near.turned[..group.len()].iter().copied()));
        }
        near.begin(group.clone(), frame, reach.square);
        self.runs(&region, reach, |run, image| run.slots.end <= from || near.push(run, image))
    }

    pub(super) fn count(&self, center: Vec3, radius: f32) -> Cost {
        let Some((center, reach)) = self.place(center).zip(self.reach(radius)) else { return Cost::default() };
        let mut counter = Counter::default();
        let cost = self.scan(center, reach, |run, probe| self.0.sorted().count(run, probe, &mut counter));
        Cost { found: counter.total().into(), ..cost }
    }

    pub(super) fn within(&self, center: Vec3, radius: f32, visit: &mut dyn FnMut(&[u32])) -> Cost {
        let Some((center, reach)) = self.place(center).zip(self.reach(radius)) else { return Cost::default() };
        let mut found = Found::default();
        let cost = self.scan(center, reach, |run, probe| {
            self.0.sorted().gather(run, probe, usize::MAX, &mut found, &mut *visit);
        });
        found.flush(visit);
        Cost { found: found.total, ..cost }
    }

    pub(super) fn counts(&self, radius: f32, counts: &mut [u32]) -> Cost {
        counts.fill(0);
        let Some(reach) = self.reach(radius) else { return Cost::default() };
        let mut sweep = Counts { sorted: self.0.sorted(), counts, counter: Counter::default(), total: 0 };
        let cost = self.sweep(reach, &mut sweep);
        Cost { found: sweep.total, ..cost }
    }

    pub(super) fn neighbours(&self, radius: f32, visit: &mut dyn FnMut(u32, &[u32])) -> Cost {
        self.lists::<true>(radius, visit)
    }

    pub(super) fn pairs(&self, radius: f32, visit: &mut dyn FnMut(u32, &[u32])) -> Cost {
        self.lists::<false>(radius, visit)
    }

    fn lists<const BOTH: bool>(&self, radius: f32, visit: &mut dyn FnMut(u32, &[u32])) -> Cost {
        let Some(reach) = self.reach(radius) else { return Cost::default() };
        let mut sweep = Lists::<BOTH> { sorted: self.0.sorted(), found: Found::default(), visit };
        let cost = self.sweep(reach, &mut sweep);
        Cost { found: sweep.found.total, ..cost }
    }

    pub(super) fn nearest(&self, center: Vec3, radius: f32, found: &mut [Neighbour]) -> Cost {
        let Some((center, reach)) = self.place(center).zip(self.reach(radius)) else { return Cost::default() };
        let mut nearest = Nearest::new(found);
        let cost = self.seek(center, reach.radius, self.0.stride(), &mut nearest);
        Cost { found: nearest.finish(|length| self.0.sorted().domain.unscaled(length)) as u64, ..cost }
    }

    pub(super) fn all_nearest(
        &self,
        radius: f32,
        found: &mut [Neighbour],
        visit: &mut dyn FnMut(u32, &[Neighbour]),
    ) -> Cost {
        let Some(reach) = self.reach(radius).filter(|_| !found.is_empty()) else { return Cost::default() };
        let (sorted, mut cost, mut near) = (self.0.sorted(), Cost::default(), Near::new());
        let mut stride = self.0.stride();
        self.0.groups(&mut |slots, frame| {
            for group in chunks(slots) {
                near.square = -1.0;
                for slot in group.clone() {
                    let (center, row) = (sorted.point(slot), sorted.order()[slot]);
                    let mut nearest = Nearest::new(found);
                    nearest.skip = row;
                    if !self.seek_near(slot, reach, &near, &mut nearest, &mut cost) {
                        cost += self.seek(center, reach.radius, stride, &mut nearest);
                    }
                    if P::BOXED && slot == group.start && nearest.is_full() {
                        // The others will hardly have to go twice as far as the first.
                        let twice = Reach::new(min(2.0 * sqrt(nearest.bound()), reach.radius), &sorted.domain);
                        if !twice.wraps {
                            cost.visits += self.gather(&group, frame, 0, twice, &mut near);
                        }
                    }
                    if !P::BOXED && nearest.is_full() {
                        stride = max(sqrt(nearest.bound()) * 1.1, self.0.stride() * 0.1);
                    }
                    let n = nearest.finish(|length| sorted.domain.unscaled(length));
                    cost.found += n as u64;
                    if n > 0 {
                        visit(row, &found[..n]);
                    }
                }
            }
        });
        cost
    }

    /// The nearest to one point of a group: first among the group itself, which tells how far to look, then among what
    /// is near the group. False if that is not far enough.
    #[inline]
    fn seek_near(&self, slot: usize, reach: Reach, near: &Near, nearest: &mut Nearest<'_>, cost: &mut Cost) -> bool {
        if near.full || near.square < 0.0 {
            return false;
        }
        let (sorted, center) = (self.0.sorted(), self.0.sorted().point(slot));
        let probe = Probe::new(center, Image::Itself, 0.0);
        nearest.restart(reach.square);
        sorted.offer(&near.group, &probe, nearest);
        cost.tests += near.group.len() as u64;
        if !(nearest.bound() <= near.square) {
            return false;
        }
        near.each(self.0, true, (slot, center), nearest.bound(), |square, run, image| {
            if !(square <= nearest.bound()) {
                return;
            }
            let rest = if image.moved() == Vec3::ZERO { without(run, &near.group) } else { [run, 0..0] };
            for part in rest {
                cost.tests += part.len() as u64;
                sorted.offer(&part, &probe.of(image), nearest);
            }
        });
        true
    }

    /// The nearest to any place: with a larger and larger radius where the structure needs one.
    fn seek(&self, center: Vec3, limit: f32, stride: f32, nearest: &mut Nearest<'_>) -> Cost {
        let (sorted, mut cost, mut radius) = (self.0.sorted(), Cost::default(), stride);
        let (domain, half) = (&sorted.domain, sorted.domain.half());
        let farthest = sqrt(Region::point(center).farthest_square(sorted.low, sorted.high)) * 1.000_001;
        while !is_far(center) && half > 0.0 {
            // Whatever is nearer than half a side is met in one image only.
            let reach = min(min(radius, limit), half * 0.999_999);
            nearest.restart(reach * reach);
            let before = cost.tests;
            domain.images(center, center, reach, |image| cost += self.0.seek(center, image, reach, nearest));
            let all = half == f32::INFINITY && radius > farthest;
            if nearest.is_full() || limit <= reach || all {
                return cost;
            }
            // Once all points had to be looked at, looking at all without a limit ends the search.
            if radius >= half || cost.tests - before >= sorted.len as u64 {
                break;
            }
            radius *= 1.5;
        }
        nearest.restart(limit * limit);
        sorted.offer(&(0..sorted.len), &Probe::new(center, domain.image_of_all(), 0.0), nearest);
        cost.tests += sorted.len as u64;
        cost
    }

    fn place(&self, center: Vec3) -> Option<Vec3> {
        center.is_finite().then(|| self.0.sorted().domain.place(center))
    }
}

struct Counts<'a> {
    sorted: &'a Sorted<'a>,
    counts: &'a mut [u32],
    counter: Counter,
    total: u64,
}

impl Sweep for Counts<'_> {
    #[inline(always)]
    fn begin(&mut self, _: usize) {
        self.counter = Counter::default();
    }
    #[inline(always)]
    fn scan(&mut self, _: usize, run: Range<usize>, probe: &Probe) -> u64 {
        self.sorted.count(&run, probe, &mut self.counter);
        run.len() as u64
    }
    #[inline(always)]
    fn end(&mut self, slot: usize) {
        // It has found itself as well.
        let others = self.counter.total().saturating_sub(1);
        self.total += u64::from(others);
        if let Some(count) = self.counts.get_mut(self.sorted.order()[slot] as usize) {
            *count = others;
        }
    }
}

/// Lists of neighbours: of all others, or of those in higher slots only, so that every pair comes once.
struct Lists<'a, const BOTH: bool> {
    sorted: &'a Sorted<'a>,
    found: Found,
    visit: &'a mut dyn FnMut(u32, &[u32]),
}

impl<const BOTH: bool> Sweep for Lists<'_, BOTH> {
    const FORWARD: bool = !BOTH;
    #[inline(always)]
    fn begin(&mut self, _: usize) {}
    #[inline(always)]
    fn scan(&mut self, slot: usize, run: Range<usize>, probe: &Probe) -> u64 {
        let row = self.sorted.order()[slot];
        let run = if BOTH { run } else { run.start.max(slot + 1).min(run.end)..run.end };
        self.sorted.gather(&run, probe, slot, &mut self.found, |rows| (self.visit)(row, rows));
        run.len() as u64
    }
    #[inline(always)]
    fn end(&mut self, slot: usize) {
        let row = self.sorted.order()[slot];
        let visit = &mut self.visit;
        self.found.flush(|rows| visit(row, rows));
    }
}

/// The parts of a run that lie before and behind some slots.
#[inline(always)]
fn without(run: Range<usize>, slots: &Range<usize>) -> [Range<usize>; 2] {
    [run.start..run.end.min(slots.start).max(run.start), run.start.max(slots.end).min(run.end)..run.end]
}

/// Answers a trait's queries by a partition.
macro_rules! answers {
    () => {
        fn order(&self) -> &[u32] {
            self.sorted().order()
        }
        fn parts(&self, visit: &mut dyn FnMut(core::ops::Range<usize>)) {
            self.groups(&mut |slots: core::ops::Range<usize>, _| visit(slots));
        }
        fn count(&self, center: Vec3, radius: f32) -> Cost {
            Search(self).count(center, radius)
        }
        fn within(&self, center: Vec3, radius: f32, visit: &mut dyn FnMut(&[u32])) -> Cost {
            Search(self).within(center, radius, visit)
        }
        fn nearest(&self, center: Vec3, radius: f32, found: &mut [Neighbour]) -> Cost {
            Search(self).nearest(center, radius, found)
        }
        fn counts(&self, radius: f32, counts: &mut [u32]) -> Cost {
            Search(self).counts(radius, counts)
        }
        fn neighbours(&self, radius: f32, visit: &mut dyn FnMut(u32, &[u32])) -> Cost {
            Search(self).neighbours(radius, visit)
        }
        fn in_order(&self, places: core::ops::Range<usize>, radius: f32, visit: &mut dyn FnMut(usize, &[u32])) -> bool {
            // A chip has no room for lists, nor on its stack for what it takes to make them.
            !cfg!(target_os = "none") && Search(self).in_order(places, radius, visit)
        }
        fn pairs(&self, radius: f32, visit: &mut dyn FnMut(u32, &[u32])) -> Cost {
            Search(self).pairs(radius, visit)
        }
        fn all_nearest(&self, radius: f32, found: &mut [Neighbour], visit: &mut dyn FnMut(u32, &[Neighbour])) -> Cost {
            Search(self).all_nearest(radius, found, visit)
        }
    };
}
pub(super) use answers;
