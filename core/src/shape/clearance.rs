//! How far the nearest of many boxes is at the least, by the cell of a grid that a point is in, and which are the nearest: most who ask are told
//! enough by one number, and nearly all others by these.

use super::Aabb;
use crate::lanes::{Eight, LANES, Lanes, PARTS, Vectors};
#[cfg(feature = "alloc")]
use crate::math::max;
#[cfg(feature = "alloc")]
use alloc::{vec, vec::Vec};

/// Cells for each box, at the most, and for a few of them.
#[cfg(feature = "alloc")]
const CELLS: usize = 32;
#[cfg(feature = "alloc")]
const FEW: usize = 1 << 14;

/// Cells that boxes are entered in, for each of them, at the most.
#[cfg(feature = "alloc")]
const ENTRIES: usize = 1024;

/// Cells in all, at the most: so few that their numbers are exact beside a power of two.
#[cfg(feature = "alloc")]
const MOST: usize = 1 << 22;

/// Sides of cells as far as which distances are told.
#[cfg(feature = "alloc")]
const SIDES: f32 = 3.0;

/// Boxes that are known by cells: with fewer, more who ask are not told all.
pub(crate) const NEAREST: usize = 3;

/// The corners of a box that nothing meets.
const NOWHERE: Corners = [[f32::INFINITY; 4], [f32::NEG_INFINITY; 4]];

/// What is added to numbers to have the nearest whole ones in their last bits.
const WHOLE: f32 = 8_388_608.0;

/// The distances of boxes from anywhere around them, or less.
#[derive(Clone, Copy, Debug)]
pub struct Clearance<'a> {
    grid: Grid,
    free: &'a [u8],
    nearest: &'a [Nearest],
    corners: &'a [Corners],
}

/// The lower and the upper corner of a box, each with some number behind it.
type Corners = [[f32; 4]; 2];

/// The boxes that are nearest to each of some places, and how far all others are at the least \[m\].
pub(crate) struct NearestBoxes<F> {
    pub(crate) numbers: [[[u32; NEAREST]; LANES]; PARTS],
    boxes: [[Vectors<F>; 2]; NEAREST],
    others: F,
}

/// The boxes that are nearest to a cell, the nearest first, how far they are, and how far all others are from anywhere in it at the least
/// \[units\].
#[derive(Clone, Copy, Debug)]
struct Nearest {
    numbers: [u32; NEAREST],
    #[cfg(feature = "alloc")]
    distances: [u8; NEAREST],
    others: u8,
}

/// The same with its own numbers.
#[cfg(feature = "alloc")]
#[derive(Clone, Debug)]
pub(super) struct ClearanceBuf {
    grid: Grid,
    /// The least distance along the axes from anywhere in each cell to a box, in units; the largest number stands for more as well.
    free: Vec<u8>,
    nearest: Vec<Nearest>,
    /// The boxes by their numbers.
    corners: Vec<Corners>,
}

/// Cells around boxes.
#[derive(Clone, Copy, Debug)]
struct Grid {
    around: Aabb,
    /// Cells to a metre, and along each axis.
    scale: f32,
    counts: [usize; 3],
    /// The unit of distances \[m\].
    unit: f32,
}

#[cfg(feature = "alloc")]
impl ClearanceBuf {
    /// That of boxes which are all in another. Takes time in proportion to their number.
    pub(super) fn new(boxes: &[(u32, &Aabb)], around: &Aabb) -> Self {
        let (most, entries) = ((CELLS * boxes.len()).clamp(FEW, MOST), ENTRIES * boxes.len());
        let mut side = (around.max - around.min).max_element();
        let mut grid = Grid::divided(around, side);
        // As fine as there is use for.
        for _ in 0..64 {
            side *= 0.75;
            let finer = Grid::divided(around, side);
            let all_entries = || boxes.iter().map(|(_, bounds)| finer.entries(bounds)).sum::<usize>();
            if finer.scale == 0.0 || finer.len() > most || all_entries() > entries {
                break;
            }
            grid = finer;
        }
        let cells = if grid.scale == 0.0 { 0 } else { grid.len() };
        let nobody = Nearest { numbers: [u32::MAX; NEAREST], distances: [u8::MAX; NEAREST], others: u8::MAX };
        let count = boxes.iter().map(|(number, _)| *number as usize + 1).max().unwrap_or(0);
        let corners = vec![NOWHERE; count];
        let mut all = Self { grid, free: vec![u8::MAX; cells], nearest: vec![nobody; cells], corners };
        for (number, bounds) in boxes {
            all.corners[*number as usize] = [bounds.min, bounds.max].map(|corner| corner.extend(0.0).to_array());
            if cells > 0 {
                all.enter(*number, bounds);
            }
        }
        all
    }

    pub(super) fn view(&self) -> Clearance<'_> {
        Clearance { grid: self.grid, free: &self.free, nearest: &self.nearest, corners: &self.corners }
    }
}

#[cfg(feature = "alloc")]
impl ClearanceBuf {
    fn enter(&mut self, number: u32, bounds: &Aabb) {
        let Grid { around, scale, counts: [columns, rows, _], unit } = self.grid;
        let side = 1.0 / scale;
        let gap = |axis: usize, cell: usize| {
            let [low, high] = [cell, cell + 1].map(|edge| around.min[axis] + side * edge as f32);
            max(max(low - bounds.max[axis], bounds.min[axis] - high), 0.0)
        };
        let [x, y, z] = self.grid.reached(bounds);
        for layer in z[0]..z[1] {
            for row in y[0]..y[1] {
                let (aside, line) = (max(gap(1, row), gap(2, layer)), columns * (rows * layer + row));
                let cells = line + x[0]..line + x[1];
                let places = self.free[cells.clone()].iter_mut().zip(&mut self.nearest[cells]);
                for (column, (free, nearest)) in (x[0]..x[1]).zip(places) {
                    // The cast rounds down and saturates.
                    let distance = (max(gap(0, column), aside) / unit) as u8;
                    *free = distance.min(*free);
                    nearest.enter(number, distance);
                }
            }
        }
    }
}

#[cfg(feature = "alloc")]
impl Nearest {
    /// Has one more box, at a distance, go among them.
    fn enter(&mut self, mut number: u32, mut distance: u8) {
        for (other, farther) in self.numbers.iter_mut().zip(&mut self.distances) {
            if distance < *farther {
                core::mem::swap(&mut number, other);
                core::mem::swap(&mut distance, farther);
            }
        }
        self.others = self.others.min(distance);
    }
}

#[cfg(feature = "alloc")]
impl Grid {
    fn divided(around: &Aabb, side: f32) -> Self {
        let extent = around.max - around.min;
        let is_divisible = extent.is_finite() && side > 0.0 && (1.0 / side).is_finite();
        let scale = if is_divisible { 1.0 / side } else { 0.0 };
        let counts = [0, 1, 2].map(|axis| ((extent[axis] * scale) as usize).min(MOST) + 1);
        Self { around: *around, scale, counts, unit: SIDES * side / f32::from(u8::MAX) }
    }

    fn len(&self) -> usize {
        self.counts.iter().fold(1, |all, &count| all.saturating_mul(count))
    }

    /// The cells along each axis that a box's distance is told in: from one to before another.
    fn reached(&self, bounds: &Aabb) -> [[usize; 2]; 3] {
        [0, 1, 2].map(|axis| {
            let cell = |x: f32, more: f32| ((x - self.around.min[axis]) * self.scale + more) as usize;
            let end = (cell(bounds.max[axis], SIDES + 1.0) + 1).min(self.counts[axis]);
            [cell(bounds.min[axis], -(SIDES + 1.0)).min(end), end]
        })
    }

    fn entries(&self, bounds: &Aabb) -> usize {
        self.reached(bounds).iter().fold(1, |all, [from, to]| all.saturating_mul(to - from))
    }
}

impl<'a> Clearance<'a> {
    /// Tells which cubes, so far from their middles to their sides, are surely free of boxes, and the cells of the middles; none of what is no
    /// number is. For rounding of places they have room themselves.
    #[inline(always)]
    pub(crate) fn are_free<F: Lanes>(&self, middle: Vectors<F>, half: F) -> (F, [[u32; LANES]; PARTS]) {
        let Grid { around: Aabb { min: least, max: most }, scale, counts, unit } = self.grid;
        let (all, zero) = (|x| half.all(x), half.all(0.0));
        let (mut beside, mut cells) = (zero, [zero; 3]);
        for axis in 0..3 {
            let x = middle.0[axis];
            beside = beside.most((all(least[axis]) - x).most(x - all(most[axis])));
            let cell = (x - all(least[axis])) * all(scale) - all(0.5);
            cells[axis] = (cell.most(zero).least(all((counts[axis] - 1) as f32)) + all(WHOLE)) - all(WHOLE);
        }
        let [columns, rows, _] = counts.map(|count| all(count as f32));
        let numbers = (cells[2] * rows + cells[1]) * columns + cells[0] + all(WHOLE);
        let mut cells = [[0; LANES]; PARTS];
        let [free] = half.of_parts(
            #[inline(always)]
            |like, nth| {
                let mut free = [0.0; LANES];
                for ((free, cell), number) in free.iter_mut().zip(&mut cells[nth]).zip(numbers.part(nth).to_array()) {
                    *cell = number.to_bits() & (WHOLE as u32 - 1);
                    *free = f32::from(self.free.get(*cell as usize).copied().unwrap_or(0));
                }
                [like.of(free)]
            },
        );
        // From beside all boxes they are no nearer than from the nearest place of what is around them.
        let is_far = half.simd_lt(beside) | half.simd_lt(free * all(unit));
        let [x, y, z] = (middle * zero).0;
        (is_far & (x + y + z).simd_eq(zero), cells)
    }

    /// Tells whether a box is surely free of boxes, as [`are_free`](Self::are_free) has it.
    #[inline]
    pub(crate) fn is_free(&self, bounds: &Aabb) -> bool {
        let Grid { around, scale, counts, unit } = self.grid;
        let (middle, half) = (bounds.center(), 0.5 * (bounds.max - bounds.min).max_element());
        // The casts round down and saturate.
        let cell = |axis: usize| (((middle[axis] - around.min[axis]) * scale) as usize).min(counts[axis] - 1);
        let free = self.free.get((cell(2) * counts[1] + cell(1)) * counts[0] + cell(0));
        around.min.cmple(middle).all()
            && around.max.cmpge(middle).all()
            && free.is_some_and(|free| half < f32::from(*free) * unit)
    }

    /// The boxes that are nearest to each of some cells.
    #[inline(always)]
    pub(crate) fn nearest<F: Lanes>(&self, like: F, cells: &[[u32; LANES]; PARTS]) -> NearestBoxes<F> {
        let mut numbers = [[[0; NEAREST]; LANES]; PARTS];
        let [others] = like.of_parts(
            #[inline(always)]
            |like, nth| {
                let mut distances = [0.0; LANES];
                for ((numbers, distance), &cell) in numbers[nth].iter_mut().zip(&mut distances).zip(&cells[nth]) {
                    if let Some(nearest) = self.nearest.get(cell as usize) {
                        (*numbers, *distance) = (nearest.numbers, f32::from(nearest.others));
                    }
                }
                [like.of(distances)]
            },
        );
        let mut boxes = [[Vectors([like; 3]); 2]; NEAREST];
        for (i, corners) in boxes.iter_mut().enumerate() {
            let [a, b, c, d, e, f] = like.of_parts(
                #[inline(always)]
                |like, nth| {
                    let (mut low, mut high) = ([[0.0; 4]; LANES], [[0.0; 4]; LANES]);
                    for (numbers, (low, high)) in numbers[nth].iter().zip(low.iter_mut().zip(&mut high)) {
                        [*low, *high] = *self.corners.get(numbers[i] as usize).unwrap_or(&NOWHERE);
                    }
                    let ([a, b, c], [d, e, f]) = (like.columns_of(low), like.columns_of(high));
                    [a, b, c, d, e, f]
                },
            );
            *corners = [Vectors([a, b, c]), Vectors([d, e, f])];
        }
        NearestBoxes { numbers, boxes, others: others * like.all(self.grid.unit) }
    }
}

impl<F: Lanes> NearestBoxes<F> {
    /// Tells which boxes around the middles of the cells, so far from the middles to their sides, meet each of them, and which surely meet no
    /// other.
    #[inline(always)]
    pub(crate) fn met(&self, middle: Vectors<F>, half: Vectors<F>) -> ([F; NEAREST], F) {
        let (low, high) = (middle - half, middle + half);
        let ([x, y, z], [u, v, w]) = (middle.0, half.0);
        let are_numbers = ((x + y + z) * x.all(0.0)).simd_eq(x.all(0.0));
        let mut met = [x; NEAREST];
        for (met, corners) in met.iter_mut().zip(&self.boxes) {
            *met = meets(*corners, [low, high]);
        }
        (met, u.most(v).most(w).simd_lt(self.others) & are_numbers)
    }
}

/// Tells which of some boxes, by their corners, meet others.
#[inline(always)]
fn meets<F: Lanes>([min, max]: [Vectors<F>; 2], [low, high]: [Vectors<F>; 2]) -> F {
    let ([a, b, c], [d, e, f], [x, y, z], [u, v, w]) = (min.0, max.0, low.0, high.0);
    (a.simd_le(u) & b.simd_le(v) & c.simd_le(w)) & (d.simd_ge(x) & e.simd_ge(y) & f.simd_ge(z))
}

#[cfg(all(test, feature = "alloc"))]
mod tests {
    use super::*;
    use crate::lanes::{Kernel, run};
    use crate::shape::cells::tests::{SPREADS, spread, vector};

    struct Free<'a>(Clearance<'a>, [[f32; LANES]; 3], [f32; LANES]);

    impl Kernel for Free<'_> {
        type Output = (u32, Option<Vec<u32>>);
        #[inline(always)]
        fn run<F: Eight>(self, like: F) -> (u32, Option<Vec<u32>>) {
            let ([x, y, z], half) = (self.1.map(|lanes| like.of(lanes)), like.of(self.2));
            let (are_free, cells) = self.0.are_free(Vectors([x, y, z]), half);
            let nearest = self.0.nearest(like, &cells);
            let (met, are_known) = nearest.met(Vectors([x, y, z]), Vectors([half; 3]));
            let met = nearest.numbers[0][0].into_iter().zip(met).filter(|(_, met)| met.any()).map(|(number, _)| number);
            (are_free.to_bitmask(), are_known.any().then(|| met.collect()))
        }
    }

    #[test]
    fn nothing_is_in_what_is_free() {
        for (count, size, shape) in SPREADS {
            let (boxes, all) = spread((count, size, shape));
            let clearance = ClearanceBuf::new(&(0..).zip(&boxes).collect::<Vec<_>>(), &all);
            let (mut told, mut apart, mut known, mut alone) = (0, 0, [0; NEAREST + 1], 0);
            for i in 0..4000 {
                // One half of them are anywhere around, the others where the boxes are; most are small.
                let anywhere = vector(i, 3) * shape * 1.5 + 30.0;
                let among = all.min + (all.max - all.min) * (vector(i, 3) + 0.5);
                let middle = if i.is_multiple_of(2) { anywhere } else { among };
                let half = 1.6 * vector(i, 4).x.abs().powi(4);
                let free = Free(clearance.view(), middle.to_array().map(|x| [x; LANES]), [half + 1e-4; LANES]);
                let meets = |one: &Aabb| one.min.cmple(middle + half).all() && one.max.cmpge(middle - half).all();
                let is_free = !boxes.iter().any(meets);
                let bounds = Aabb { min: middle - half, max: middle + half };
                assert!(is_free || !clearance.view().is_free(&bounds), "{count}: {middle} {half}");
                alone += usize::from(clearance.view().is_free(&bounds));
                let (are_free, met) = run(free);
                let is_told = are_free != 0;
                if let Some(mut met) = met {
                    met.sort_unstable();
                    let around = |one: &Aabb| {
                        let half = half + 1e-4;
                        one.min.cmple(middle + half).all() && one.max.cmpge(middle - half).all()
                    };
                    let all = (0..).zip(&boxes).filter(|(_, one)| around(one)).map(|(number, _)| number);
                    assert!(all.eq(met.iter().copied()), "{count}: {middle} {half}");
                    known[met.len()] += 1;
                }
                assert!(is_free || !is_told, "{count}: {middle} {half}");
                (told, apart) = (told + usize::from(is_told), apart + usize::from(is_free));
            }
            // Most of what is free is told to be so.
            assert!(count == 1 || alone > 20, "{count}: {alone} of {told}");
            assert!(told > apart / 2 && apart > 100, "{count}: {told} of {apart}");
            // Of those that overlap, many are met two at a time.
            assert!(known[1] > 20 && (count != 40 || known[2] > 20), "{count}: {known:?}");
            for number in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
                assert_eq!(run(Free(clearance.view(), [[number; LANES]; 3], [0.1; LANES])).0, 0);
                assert_eq!(run(Free(clearance.view(), [[50.0; LANES]; 3], [f32::NAN; LANES])).0, 0);
            }
        }
    }
}
