//! Cells of one size in a bounded box.

use super::cells::{self, sort_by_cell};
use super::domain::{Domain, Image, constructors};
use super::partition::Partition;
use super::region::{Region, Run, widened};
use super::search::{Search, answers};
use super::sorted::Sorted;
use super::{Cost, Facts, Neighbour, SpatialIndex, Stats, TooSmall};
use crate::math::{max, min};
use core::ops::Range;
use glam::Vec3;

/// A uniform grid over the box around the points, each cell's points one behind the other, the cells along x first, so
/// that three neighbouring cells are one run.
///
/// The fastest where points are spread evenly and the radius is known: cells are as large as the reach. If there were
/// more cells than memory, they are made larger, which [`Stats::crowded`] counts.
#[derive(Debug)]
pub struct Grid<'m> {
    sorted: Sorted<'m>,
    /// Where each cell begins, and one more: where the last ends.
    starts: &'m mut [u32],
    reach: f32,
    layout: Layout,
    enlarged: usize,
}

/// Where cells are.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Layout {
    low: Vec3,
    pub(super) cell: f32,
    inverse: f32,
    /// Cells along each axis.
    cells: [usize; 3],
}

impl Layout {
    /// Cells of a given size over a box; none if there were more than `most`.
    fn new([low, high]: [Vec3; 2], cell: f32, most: usize) -> Option<Self> {
        let mut layout = Self { low, cell, inverse: 1.0 / cell, cells: [usize::MAX; 3] };
        let count = (high - low).to_array().map(|side| side * layout.inverse);
        if !count.iter().all(|&count| count < most as f32) {
            return None;
        }
        layout.cells = [0, 1, 2].map(|axis| layout.along(axis, high[axis]) + 1);
        let [x, y, z] = layout.cells;
        (x.saturating_mul(y).saturating_mul(z) <= most).then_some(layout)
    }

    /// Cells at least so large over a box, at most so many; and how often they had to grow.
    fn enlarged(bounds: [Vec3; 2], cell: f32, most: usize) -> (Self, usize) {
        let extent = crate::math::largest(bounds[1] - bounds[0]);
        let mut cell = max(cell, max(extent * 1e-9, f32::MIN_POSITIVE));
        let mut times = 0;
        loop {
            if let Some(layout) = Self::new(bounds, cell, most.max(1)) {
                return (layout, times);
            }
            cell *= GROWTH;
            times += 1;
        }
    }

    /// About eight points in each cell, if they were spread evenly over the box.
    pub(super) fn by_density(bounds: [Vec3; 2], points: usize, most: usize) -> Self {
        Self::enlarged(bounds, 0.0, (points / 8).clamp(1, most.max(1))).0
    }

    /// Which cell along an axis: never falls as the coordinate grows.
    #[inline(always)]
    fn along(&self, axis: usize, x: f32) -> usize {
        let cell = ((x - self.low[axis]) * self.inverse) as u32 as usize;
        cell.min(self.cells[axis] - 1)
    }

    #[inline(always)]
    fn cell(&self, point: Vec3) -> usize {
        let [nx, ny, _] = self.cells;
        (self.along(2, point.z) * ny + self.along(1, point.y)) * nx + self.along(0, point.x)
    }

    fn count(&self) -> usize {
        self.cells.iter().product()
    }
}

/// Tells its facts from those of other structures.
const NAME: u32 = u32::from_le_bytes(*b"grid");

/// Points by which a box around most of them is found, about.
const SOME: usize = 64;

/// Cells grow by this factor until there is memory for all.
const GROWTH: f32 = 1.25;

impl<'m> Grid<'m> {
    constructors!();

    fn in_domain(memory: &'m mut [u32], domain: Domain) -> Self {
        let (sorted, starts) = cells::divide(memory, domain);
        Self { sorted, starts, reach: 0.0, layout: Layout::default(), enlarged: 0 }
    }

    /// Cells as large as the reach, or as memory demands; without a reach by the density.
    fn lay_out(&mut self, points: &[Vec3]) {
        let bounds = [self.sorted.low, self.sorted.high];
        let most = self.starts.len().saturating_sub(2);
        let reach = self.sorted.domain.length(self.reach);
        (self.layout, self.enlarged) = if reach > 0.0 {
            // Just over the reach, so that rounding does not bring in a cell more.
            Layout::enlarged(bounds, reach * 1.000_01, most)
        } else {
            (Layout::by_density(bounds, self.sorted.len, most), 0)
        };
        if self.enlarged > 0 && reach > 0.0 {
            // A few that are far off would make all cells too large. Outside of the box around most of them the cells at its sides have everything.
            let (layout, enlarged) = Layout::enlarged(self.middle(points), reach * 1.000_01, most);
            if layout.cell * GROWTH < self.layout.cell
                && self.crowding(layout, points) < self.crowding(self.layout, points)
            {
                (self.layout, self.enlarged) = (layout, enlarged);
            }
        }
    }

    /// A box around most of the points, as some of them tell: from a few of the lowest of these to a few of the highest, and as far again as that is wide.
    fn middle(&self, points: &[Vec3]) -> [Vec3; 2] {
        let (domain, every) = (self.sorted.domain, (points.len() / SOME).max(1));
        let some = points.iter().step_by(every).filter(|point| point.is_finite()).map(|&point| domain.place(point));
        let some = heapless::Vec::<Vec3, { 2 * SOME }>::from_iter(some.take(2 * SOME));
        let (mut low, mut high) = (self.sorted.low, self.sorted.high);
        for axis in 0..3 {
            let mut along = heapless::Vec::<f32, { 2 * SOME }>::from_iter(some.iter().map(|point| point[axis]));
            along.sort_unstable_by(f32::total_cmp);
            let few = along.len() / 16;
            if let Some((&from, &to)) = along.get(few).zip(along.get(along.len().saturating_sub(1 + few))) {
                (low[axis], high[axis]) = (max(low[axis], from - (to - from)), min(high[axis], to + (to - from)));
            }
        }
        [low, high]
    }

    /// The pairs of points that have a cell in common, each counted from both sides.
    fn crowding(&mut self, layout: Layout, points: &[Vec3]) -> u64 {
        let domain = self.sorted.domain;
        let Some(counts) = self.starts.get_mut(..layout.count()) else { return u64::MAX };
        counts.fill(0);
        for point in points.iter().filter(|point| point.is_finite()) {
            counts[layout.cell(domain.place(*point))] += 1;
        }
        counts.iter().map(|&count| u64::from(count) * u64::from(count)).fold(0, u64::saturating_add)
    }
}

impl Partition for Grid<'_> {
    const BOXED: bool = false;

    fn sorted(&self) -> &Sorted<'_> {
        &self.sorted
    }

    #[inline(always)]
    fn groups(&self, visit: &mut impl FnMut(Range<usize>, u32)) {
        let starts = self.starts.get(..=self.layout.count()).unwrap_or_default();
        for cell in starts.windows(2) {
            if cell[0] < cell[1] {
                visit(cell[0] as usize..cell[1] as usize, 0);
            }
        }
    }

    #[inline(always)]
    fn near(&self, region: &Region, image: Image, radius: f32, visit: &mut impl FnMut(Run) -> bool) -> u64 {
        let (layout, moved) = (&self.layout, image.moved());
        let mut cells = [[0; 2]; 3];
        for axis in 0..3 {
            let (low, high) = (region.low[axis] - moved[axis], region.high[axis] - moved[axis]);
            let reach = widened(radius, low, high, moved[axis]);
            if low - reach > self.sorted.high[axis] || high + reach < self.sorted.low[axis] {
                return 0;
            }
            cells[axis] = [layout.along(axis, low - reach), layout.along(axis, high + reach)];
        }
        let [[x0, x1], [y0, y1], [z0, z1]] = cells;
        let mut visits = 0;
        for z in z0..=z1 {
            for y in y0..=y1 {
                let row = (z * layout.cells[1] + y) * layout.cells[0];
                let slots = self.starts[row + x0] as usize..self.starts[row + x1 + 1] as usize;
                visits += 1;
                let run = Run { slots, low: self.sorted.low, high: self.sorted.high, frame: 0 };
                if !run.slots.is_empty() && !visit(run) {
                    return visits;
                }
            }
        }
        visits
    }

    fn stride(&self) -> f32 {
        self.layout.cell
    }
}

impl SpatialIndex for Grid<'_> {
    fn build(&mut self, points: &[Vec3], reach: f32) -> Result<(), TooSmall> {
        self.reach = reach;
        self.layout = Layout::default();
        self.sorted.survey(points)?;
        if self.sorted.len == 0 {
            return Ok(());
        }
        self.lay_out(points);
        let layout = self.layout;
        sort_by_cell(&mut self.sorted, &mut self.starts[..layout.count() + 2], points, |point| layout.cell(point));
        Ok(())
    }

    fn refit(&mut self, points: &[Vec3]) -> Result<(), TooSmall> {
        self.build(points, self.reach)
    }

    fn facts(&self) -> Option<Facts> {
        let Layout { low, cell, cells: [x, y, z], .. } = self.layout;
        let [reach, cell, a, b, c] = [self.reach, cell, low.x, low.y, low.z].map(f32::to_bits);
        let [x, y, z, enlarged] = [x, y, z, self.enlarged].map(|count| count as u32);
        self.sorted.facts(NAME, [reach, cell, a, b, c, x, y, z, enlarged])
    }

    fn take_up(&mut self, facts: &Facts, points: &[Vec3], row_of: &mut dyn FnMut(u32) -> Option<u32>) -> bool {
        let Some([reach, cell, a, b, c, x, y, z, enlarged]) = self.sorted.restore(NAME, facts) else {
            return false;
        };
        let [reach, cell, a, b, c] = [reach, cell, a, b, c].map(f32::from_bits);
        (self.reach, self.enlarged) = (reach, enlarged as usize);
        let cells = [x, y, z].map(|count| count as usize);
        self.layout = Layout { low: Vec3::new(a, b, c), cell, inverse: 1.0 / cell, cells };
        let starts = self.starts.get_mut(..=self.layout.count()).unwrap_or_default();
        self.sorted.renumber(points, row_of, starts.iter_mut())
    }

    fn stats(&self) -> Stats {
        let nodes = self.layout.count();
        let fullest = self.starts.get(..nodes + 1).map_or(0, |s| s.windows(2).map(|c| c[1] - c[0]).max().unwrap_or(0));
        let stats = self.sorted.stats();
        // One of the words that each point has to be sorted in goes unused.
        let bytes = stats.bytes - 8 * stats.points + 4 * nodes;
        Stats { nodes, fullest: fullest as usize, crowded: self.enlarged, bytes, ..stats }
    }

    answers!();
}
