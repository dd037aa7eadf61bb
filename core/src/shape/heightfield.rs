//! Ground: heights over a grid of x and z, borrowed.

use super::{Aabb, Affine, Collider, Contact, Hit, Hulls, Mapped, Marks, Segment, Spot, Surface, Triangle};
use crate::math::{clamp, floor, largest, max, min, power_to_one};
use crate::rays::{Best, Closest, Pieces, Probe, square_to};
use crate::time::Time;
use core::ops::Range;
use glam::Vec3;

/// Heights over a grid, two triangles a cell, hit from both sides. Its normals point up.
///
/// Paths visit the cells below them only, so that a hit costs by the length of the path, not by the size of the grid.
/// It is watertight as a mesh is: neighbours share their corners to the bit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HeightField<'a> {
    pub(super) origin: Vec3,
    pub(super) spacing: f32,
    pub(super) columns: usize,
    pub(super) heights: &'a [f32],
    pub(super) bounds: Aabb,
    /// The area of its largest cell, of the field scaled so that its largest coordinate is about one.
    pub(super) largest: f32,
    /// Running sums of the cells' weights; empty, unless lent.
    pub(super) sums: &'a [u64],
    /// The lowest and the highest place of each block of cells, row by row \[m\]; empty, unless lent.
    pub(super) blocks: &'a [[f32; 2]],
}

/// Cells along each side of a block.
const BLOCK: usize = 16;

/// Why numbers do not make a height field.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BadHeights {
    /// There have to be two columns and two rows at least, and as many heights in each row as there are columns.
    Grid,
    /// The spacing has to be above zero, and all corners within the range of a 32-bit float.
    Spacing,
    /// This height is not finite.
    Height {
        /// Its place in the list.
        index: usize,
    },
}

impl core::fmt::Display for BadHeights {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            Self::Grid => write!(f, "a height field needs two columns and two rows at least, and full rows"),
            Self::Spacing => write!(f, "a height field needs a spacing above zero, and a finite extent"),
            Self::Height { index } => write!(f, "height {index} is not finite"),
        }
    }
}

impl core::error::Error for BadHeights {}

impl<'a> HeightField<'a> {
    /// A height field over borrowed heights \[m\]: that of column i and row j, at `heights[j * columns + i]`, is at
    /// `origin` + (i `spacing`, height, j `spacing`).
    ///
    /// # Errors
    /// If there are not two columns and two full rows, or a number is not finite.
    pub fn new(origin: Vec3, spacing: f32, columns: usize, heights: &'a [f32]) -> Result<Self, BadHeights> {
        let rows = heights.len().checked_div(columns).unwrap_or(0);
        if columns < 2 || rows < 2 || rows.checked_mul(columns) != Some(heights.len()) {
            return Err(BadHeights::Grid);
        }
        if let Some(index) = heights.iter().position(|h| !h.is_finite()) {
            return Err(BadHeights::Height { index });
        }
        let far = origin + Vec3::new((columns - 1) as f32, 0.0, (rows - 1) as f32) * spacing;
        let (least, most) = heights.iter().fold((f32::INFINITY, f32::NEG_INFINITY), |b, &h| (min(b.0, h), max(b.1, h)));
        let bounds = Aabb { min: origin + Vec3::Y * least, max: far + Vec3::Y * most };
        // As vertices are computed, two neighbours must not fall together.
        let apart = far.x - spacing < far.x && far.z - spacing < far.z && origin.x < origin.x + spacing;
        if !(spacing > 0.0 && apart && bounds.min.is_finite() && bounds.max.is_finite()) {
            return Err(BadHeights::Spacing);
        }
        let mut field = Self { origin, spacing, columns, heights, bounds, largest: 0.0, sums: &[], blocks: &[] };
        field.largest = field.cells().map(|(i, j)| field.cell_area(i, j)).fold(0.0, max);
        Ok(field)
    }

    /// The number of words that `with_sums` needs.
    #[must_use]
    pub fn cell_count(&self) -> usize {
        self.count() / 2
    }

    /// The number of pairs that `with_blocks` needs.
    #[must_use]
    pub fn block_count(&self) -> usize {
        let [across, along] = self.blocks_across();
        across * along
    }

    /// The same with memory for sums of areas, one word a cell, so that a birth no longer looks at every cell. Memory of
    /// another length is left alone.
    #[must_use]
    pub fn with_sums(self, sums: &'a mut [u64]) -> Self {
        if sums.len() != self.cell_count() {
            return self;
        }
        let mut sum = 0;
        for ((i, j), slot) in self.cells().zip(&mut *sums) {
            sum += self.weight(i, j);
            *slot = sum;
        }
        Self { sums, ..self }
    }

    /// The same with memory for the heights of blocks of 16 × 16 cells, so that the search for the nearest place passes over most
    /// of them. Memory of another length is left alone.
    #[must_use]
    pub fn with_blocks(self, blocks: &'a mut [[f32; 2]]) -> Self {
        if blocks.len() != self.block_count() {
            return self;
        }
        for (block, slot) in blocks.iter_mut().enumerate() {
            *slot = [f32::INFINITY, f32::NEG_INFINITY];
            let [columns, rows] = self.block(block);
            for row in rows.start..=rows.end {
                for column in columns.start..=columns.end {
                    let y = self.vertex(column, row).y;
                    *slot = [min(slot[0], y), max(slot[1], y)];
                }
            }
        }
        Self { blocks, ..self }
    }

    fn blocks_across(&self) -> [usize; 2] {
        self.size().map(|count| (count - 1).div_ceil(BLOCK))
    }

    /// The columns and rows of the cells of a block.
    fn block(&self, block: usize) -> [Range<usize>; 2] {
        let [across, _] = self.blocks_across();
        let [columns, rows] = self.size();
        let span = |n: usize, count: usize| n * BLOCK..((n + 1) * BLOCK).min(count - 1);
        [span(block % across, columns), span(block / across, rows)]
    }

    /// A box around some cells whose places are between two heights.
    fn box_around(&self, [columns, rows]: [Range<usize>; 2], [low, high]: [f32; 2]) -> Aabb {
        let (a, b) = (self.vertex(columns.start, rows.start), self.vertex(columns.end, rows.end));
        Aabb { min: Vec3::new(a.x, low, a.z), max: Vec3::new(b.x, high, b.z) }
    }

    /// Columns and rows of heights.
    #[must_use]
    pub fn size(&self) -> [usize; 2] {
        [self.columns, self.heights.len() / self.columns]
    }

    /// The place of a height \[m\], by its column and row.
    #[must_use]
    pub fn vertex(&self, column: usize, row: usize) -> Vec3 {
        let height = self.heights.get(row.saturating_mul(self.columns).saturating_add(column)).copied().unwrap_or(0.0);
        self.origin + Vec3::new(column as f32 * self.spacing, height, row as f32 * self.spacing)
    }

    /// The two triangles of a cell, by the column and row of its first corner.
    #[must_use]
    pub fn triangles(&self, column: usize, row: usize) -> [Triangle; 2] {
        let [right, below] = [column, row].map(|number| number.saturating_add(1));
        let [a, b] = [self.vertex(column, row), self.vertex(column, below)];
        let [c, d] = [self.vertex(right, row), self.vertex(right, below)];
        [Triangle { corners: [a, b, c] }, Triangle { corners: [c, b, d] }]
    }

    /// The triangle of a number.
    fn triangle(&self, number: usize) -> Triangle {
        let (cell, across) = (number / 2, self.columns - 1);
        self.triangles(cell % across, cell / across)[number % 2]
    }

    fn cells(&self) -> impl Iterator<Item = (usize, usize)> + use<> {
        let [columns, rows] = self.size();
        (0..rows - 1).flat_map(move |j| (0..columns - 1).map(move |i| (i, j)))
    }

    /// The area of a cell of the scaled field.
    fn cell_area(&self, column: usize, row: usize) -> f32 {
        self.halves(column, row).iter().sum()
    }

    /// The areas of a cell's triangles, of the scaled field: no area is beyond an `f32`, whatever the heights.
    fn halves(&self, column: usize, row: usize) -> [f32; 2] {
        let scale = power_to_one(self.reach());
        self.triangles(column, row).map(|triangle| triangle.scaled(scale).area())
    }

    /// The number of a triangle.
    fn face(&self, column: usize, row: usize, half: usize) -> u32 {
        (2 * (row * (self.columns - 1) + column) + half) as u32
    }

    /// Which columns of cells (axis 0) or rows of cells (axis 2) lie between two coordinates, and as much room around
    /// them as rounding may need.
    fn between(&self, axis: usize, from: f32, to: f32) -> Range<usize> {
        let [columns, rows] = self.size();
        let count = if axis == 0 { columns } else { rows } - 1;
        let room = 16.0 * f32::EPSILON * (max(from.abs(), to.abs()) + self.origin[axis].abs()) + 1e-3 * self.spacing;
        // The casts saturate, and send what is no number to zero.
        let first = floor((min(from, to) - room - self.origin[axis]) / self.spacing) as usize;
        let last = floor((max(from, to) + room - self.origin[axis]) / self.spacing);
        if last < 0.0 { 0..0 } else { first.min(count)..(last as usize).saturating_add(1).min(count) }
    }

    /// Tells whether a cell reaches into a span of heights.
    fn is_within(&self, column: usize, row: usize, [low, high]: [f32; 2]) -> bool {
        let corners = [(0, 0), (1, 0), (0, 1), (1, 1)].map(|(i, j)| self.vertex(column + i, row + j).y);
        corners.iter().any(|&y| y >= low) && corners.iter().any(|&y| y <= high)
    }

    /// Visits the triangles that may be near a box, with their numbers.
    fn near(&self, bounds: &Aabb, mut visit: impl FnMut(u32, &Triangle)) {
        let Aabb { min, max } = bounds.with_slack();
        for row in self.between(2, min.z, max.z) {
            for column in self.between(0, min.x, max.x) {
                if self.is_within(column, row, [min.y, max.y]) {
                    let [a, b] = self.triangles(column, row);
                    visit(self.face(column, row, 0), &a);
                    visit(self.face(column, row, 1), &b);
                }
            }
        }
    }

    /// Asks the triangles of a block that may be near enough.
    fn look<F: Fn(usize) -> Vec3>(&self, block: usize, closest: &mut Closest<'_, Self, F>) {
        let [columns, rows] = self.block(block);
        for row in rows {
            for column in columns.clone() {
                let corners = [(0, 0), (1, 0), (0, 1), (1, 1)].map(|(i, j)| self.vertex(column + i, row + j));
                if square_to(closest.point, &Aabb::around(corners)) <= closest.square {
                    closest.ask(self.face(column, row, 0) as usize);
                    closest.ask(self.face(column, row, 1) as usize);
                }
            }
        }
    }

    /// The share of the largest cell's area in units of 2⁻³².
    fn weight(&self, column: usize, row: usize) -> u64 {
        let share = self.cell_area(column, row) / self.largest;
        // Where no area can be told all cells count alike.
        if share.is_finite() { (share * 4_294_967_296.0) as u64 } else { 1 }
    }
}

impl Surface for HeightField<'_> {
    /// Looks at every cell.
    fn area(&self) -> f32 {
        self.cells().flat_map(|(i, j)| self.triangles(i, j)).map(|triangle| triangle.area()).sum()
    }

    /// Looks at every cell, twice, unless it has sums.
    fn sample(&self, u: [f32; 3]) -> Spot {
        let total = match self.sums.last() {
            Some(&total) => total,
            None => self.cells().map(|(i, j)| self.weight(i, j)).sum(),
        };
        let target = ((u128::from((u[0] * 16_777_216.0) as u32) * u128::from(total)) >> 24) as u64;
        // Whatever is before the cell that is found need not be added again.
        let first = self.sums.partition_point(|&sum| sum <= target);
        let mut sum = first.checked_sub(1).and_then(|before| self.sums.get(before)).copied().unwrap_or(0);
        let across = self.columns - 1;
        for (i, j) in (first..self.cell_count()).map(|cell| (cell % across, cell / across)) {
            let weight = self.weight(i, j);
            if target < sum + weight {
                // The rest of the number says which half.
                let [a, b] = self.triangles(i, j);
                let [first, second] = self.halves(i, j);
                let rest = (target - sum) as f32 / weight as f32 * (first + second);
                return if rest < first { a } else { b }.sample(u);
            }
            sum += weight;
        }
        Spot { point: self.vertex(0, 0), normal: Vec3::Y }
    }

    /// Looks first where the nearest block of cells is, then at all cells that may be as near.
    fn nearest(&self, point: Vec3) -> Vec3 {
        let mut closest = Closest::new(self, point, |piece| self.triangle(piece).nearest(point));
        let square = |block: usize| {
            let heights = self.blocks.get(block).copied().unwrap_or([self.bounds.min.y, self.bounds.max.y]);
            square_to(point, &self.box_around(self.block(block), heights))
        };
        let nearer = |best: (f32, usize), block| if square(block) < best.0 { (square(block), block) } else { best };
        let (_, first) = (0..self.block_count()).fold((f32::INFINITY, 0), nearer);
        self.look(first, &mut closest);
        for block in (0..self.block_count()).filter(|&block| block != first) {
            if square(block) <= closest.square {
                self.look(block, &mut closest);
            }
        }
        closest.found().0.unwrap_or(self.vertex(0, 0))
    }

    fn bounds(&self) -> Aabb {
        self.bounds
    }
}

impl Pieces for HeightField<'_> {
    fn count(&self) -> usize {
        let [columns, rows] = self.size();
        2 * (columns - 1) * (rows - 1)
    }

    fn box_of(&self, piece: usize) -> Aabb {
        self.triangle(piece).bounds()
    }

    fn hit(&self, piece: usize, segment: &Segment) -> Option<Hit> {
        Some(Hit { face: piece as u32, ..self.triangle(piece).first_hit(segment)? })
    }

    fn reach(&self) -> f32 {
        max(largest(self.bounds.min), largest(self.bounds.max))
    }
}

impl Collider for HeightField<'_> {
    fn moves(&self) -> bool {
        false
    }

    /// Walks strip by strip across the grid, along the axis on which the path goes farther, and in each only over the
    /// cells that the ball may touch there.
    fn first_hit(&self, segment: &Segment) -> Option<Hit> {
        if !self.may_touch(&segment.bounds()) {
            return None;
        }
        let (from, step) = (segment.from, segment.step());
        let (along, across) = if step.x.abs() > step.z.abs() { (0, 2) } else { (2, 0) };
        let rounding = segment.slack(max(self.bounds.min.abs().max_element(), self.bounds.max.abs().max_element()));
        let reach = max(segment.radius, 0.0) + rounding;
        let forth = step[along] >= 0.0;
        let way = if forth { reach } else { -reach };
        let strips = self.between(along, from[along] - way, segment.to[along] + way);
        let (first, count) = (strips.start, strips.len());
        let probe = Probe::new(segment, self.reach())?;
        let mut best = Best::NONE;
        for k in 0..count {
            let strip = if forth { first + k } else { first + count - 1 - k };
            // When the ball is over the strip, its neighbours' share of rounding included.
            let edge = |n: usize| self.origin[along] + n as f32 * self.spacing;
            let (near, far) = if forth { (edge(strip), edge(strip + 1)) } else { (edge(strip + 1), edge(strip)) };
            let share = |x: f32| if step[along] == 0.0 { 0.5 } else { (x - from[along]) / step[along] };
            let (enter, leave) = (clamp(share(near - way), 0.0, 1.0), clamp(share(far + way), 0.0, 1.0));
            let (enter, leave) = if step[along] == 0.0 { (0.0, 1.0) } else { (enter, leave) };
            if best.time < enter {
                break;
            }
            let (a, b) = (segment.at(enter), segment.at(leave));
            let heights = [min(a.y, b.y) - reach, max(a.y, b.y) + reach];
            for place in self.between(across, min(a[across], b[across]) - reach, max(a[across], b[across]) + reach) {
                let (column, row) = if along == 0 { (strip, place) } else { (place, strip) };
                if !self.is_within(column, row, heights) {
                    continue;
                }
                for half in 0..2 {
                    best.ask(self, &probe, self.face(column, row, half) as usize);
                }
            }
        }
        best.hit
    }

    fn may_touch(&self, bounds: &Aabb) -> bool {
        self.bounds.with_slack().overlaps(bounds)
    }

    fn mark_near(&self, hulls: &Hulls, marks: &mut Marks) {
        hulls.near_box(&self.bounds, marks);
    }

    /// One for each triangle within reach.
    fn contacts(&self, center: Vec3, reach: f32, _: Time, visit: &mut dyn FnMut(&Contact)) {
        let near = Aabb { min: center - reach, max: center + reach };
        if self.bounds.overlaps(&near) {
            self.near(&near, |face, triangle| triangle.contact(center, reach, face).iter().for_each(&mut *visit));
        }
    }

    fn contacts_of(&self, faces: &[u32], center: Vec3, reach: f32, _: Time, visit: &mut dyn FnMut(&Contact)) {
        let there = faces.iter().filter(|&&face| (face as usize) < self.count());
        let contact = |&face: &u32| self.triangle(face as usize).contact(center, reach, face);
        there.filter_map(contact).for_each(|contact| visit(&contact));
    }
}

impl Mapped for HeightField<'_> {
    /// Looks at every cell.
    fn image(&self, map: &Affine, bounds: &Aabb, visit: &mut dyn FnMut(u32, &dyn Collider)) {
        for (i, j) in self.cells() {
            for (half, triangle) in self.triangles(i, j).iter().enumerate() {
                let image = Triangle { corners: triangle.corners.map(|corner| map.point(corner)) };
                if image.bounds().overlaps(bounds) {
                    visit(self.face(i, j, half), &image);
                }
            }
        }
    }
}
