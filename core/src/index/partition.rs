//! The answer that each structure gives to the queries: where points may be.

use super::Cost;
use super::domain::Image;
use super::nearest::Nearest;
use super::region::{Region, Run};
use super::sorted::{Probe, Sorted};
use core::ops::Range;
use glam::Vec3;

/// Space divided: what a structure adds to what all share.
pub(super) trait Partition {
    /// True if the boxes of runs are worth a look for each point.
    const BOXED: bool = true;
    /// True if boxes may be turned.
    const TURNS: bool = false;

    fn sorted(&self) -> &Sorted<'_>;

    /// Visits runs of slots that lie close together, all of them, in order, with the frame that suits them.
    fn groups(&self, visit: &mut impl FnMut(Range<usize>, u32));

    /// Visits runs, each once, that hold every point of `image` within `radius` of the region; returns how many nodes
    /// were looked at. Stops when `visit` says false.
    fn near(&self, region: &Region, image: Image, radius: f32, visit: &mut impl FnMut(Run) -> bool) -> u64;

    /// A point in the frame of a box.
    fn turn(&self, frame: u32, point: Vec3) -> Vec3 {
        let _ = frame;
        point
    }

    /// The radius to begin a search for the nearest with; infinite: one go will do.
    fn stride(&self) -> f32;

    /// Offers to `nearest` every point of `image` within `radius` that it may want.
    fn seek(&self, center: Vec3, image: Image, radius: f32, nearest: &mut Nearest<'_>) -> Cost {
        let mut tests = 0;
        let probe = Probe::new(center, image, 0.0);
        let visits = self.near(&Region::point(center), image, radius, &mut |run| {
            tests += run.slots.len() as u64;
            self.sorted().offer(&run.slots, &probe, nearest);
            true
        });
        Cost { visits, tests, found: 0 }
    }
}
