//! Ground: heights over a grid of x and z, borrowed (`HeightField`) or owned (`HeightFieldBuf`).

use super::{Aabb, Affine, Collider, Contact, Hit, Segment, Spot, Surface, Triangle};
use crate::math::{clamp, floor, largest, length, max, min};
use crate::rays::{Best, Pieces, Probe};
use crate::time::Time;
use core::ops::Range;
use glam::Vec3;

/// Heights over a grid, two triangles a cell, hit from both sides. Its normals point up.
///
/// Paths visit the cells below them only, so that a hit costs by the length of the path, not by the size of the grid.
/// It is watertight as a mesh is: neighbours share their corners to the bit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HeightField<'a> {
    origin: Vec3,
    spacing: f32,
    columns: usize,
    heights: &'a [f32],
    bounds: Aabb,
    /// The area of its largest cell \[m²\].
    largest: f32,
}

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
        let mut field = Self { origin, spacing, columns, heights, bounds, largest: 0.0 };
        field.largest = field.cells().map(|(i, j)| field.cell_area(i, j)).fold(0.0, max);
        Ok(field)
    }

    /// Columns and rows of heights.
    #[must_use]
    pub fn size(&self) -> [usize; 2] {
        [self.columns, self.heights.len() / self.columns]
    }

    /// The place of a height \[m\], by its column and row.
    #[must_use]
    pub fn vertex(&self, column: usize, row: usize) -> Vec3 {
        let height = self.heights.get(row * self.columns + column).copied().unwrap_or(0.0);
        self.origin + Vec3::new(column as f32 * self.spacing, height, row as f32 * self.spacing)
    }

    /// The two triangles of a cell, by the column and row of its first corner.
    #[must_use]
    pub fn triangles(&self, column: usize, row: usize) -> [Triangle; 2] {
        let [a, b] = [self.vertex(column, row), self.vertex(column, row + 1)];
        let [c, d] = [self.vertex(column + 1, row), self.vertex(column + 1, row + 1)];
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

    fn cell_area(&self, column: usize, row: usize) -> f32 {
        self.triangles(column, row).iter().map(Surface::area).sum()
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

    /// Whether a cell reaches into a span of heights.
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
        self.cells().map(|(i, j)| self.cell_area(i, j)).sum()
    }

    /// Looks at every cell, twice.
    fn sample(&self, u: [f32; 3]) -> Spot {
        let total: u64 = self.cells().map(|(i, j)| self.weight(i, j)).sum();
        let target = ((u128::from((u[0] * 16_777_216.0) as u32) * u128::from(total)) >> 24) as u64;
        let mut sum = 0;
        for (i, j) in self.cells() {
            let weight = self.weight(i, j);
            if target < sum + weight {
                // What is left of the number says which half.
                let [a, b] = self.triangles(i, j);
                let rest = (target - sum) as f32 / weight as f32 * (a.area() + b.area());
                return if rest < a.area() { a } else { b }.sample(u);
            }
            sum += weight;
        }
        Spot { point: self.vertex(0, 0), normal: Vec3::Y }
    }

    /// Looks at rings of cells around the point until the next are too far away.
    fn nearest(&self, point: Vec3) -> Vec3 {
        let [columns, rows] = self.size();
        let own = |axis: usize, count: usize| {
            let cell = floor((point[axis] - self.origin[axis]) / self.spacing);
            clamp(cell, 0.0, (count - 2) as f32) as usize
        };
        let (column, row) = (own(0, columns), own(2, rows));
        let mut best = (f32::INFINITY, self.vertex(column, row));
        for ring in 0..columns.max(rows) {
            // Whatever is in the ring is beyond all cells within it.
            if (ring as f32 - 1.0) * self.spacing > best.0 {
                break;
            }
            let (low, high) = (row.saturating_sub(ring), (row + ring).min(rows - 2));
            for j in low..=high {
                let (left, right) = (column.saturating_sub(ring), (column + ring).min(columns - 2));
                // Of the rows between the first and the last only both ends are new.
                let is_edge = j + ring == row || j == row + ring;
                let stride = if is_edge || right <= left { 1 } else { right - left };
                for i in (left..=right).step_by(stride) {
                    for triangle in self.triangles(i, j) {
                        let candidate = triangle.nearest(point);
                        let distance = length(candidate - point);
                        if distance < best.0 {
                            best = (distance, candidate);
                        }
                    }
                }
            }
        }
        best.1
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
        self.bounds.overlaps(bounds)
    }

    /// One for each triangle within reach.
    fn contacts(&self, center: Vec3, reach: f32, at: Time, visit: &mut dyn FnMut(&Contact)) {
        let near = Aabb { min: center - reach, max: center + reach };
        if self.bounds.overlaps(&near) {
            self.near(&near, |_, triangle| triangle.contacts(center, reach, at, visit));
        }
    }

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

/// A height field on the heap.
#[cfg(feature = "alloc")]
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(try_from = "Heights", into = "Heights"))]
pub struct HeightFieldBuf {
    heights: alloc::sync::Arc<[f32]>,
    /// The same with no heights of its own.
    grid: HeightField<'static>,
}

/// A height field as files have it.
#[cfg(feature = "alloc")]
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Heights {
    /// The place of height zero in the first column and row \[m\].
    #[cfg_attr(feature = "schema", schemars(with = "[f32; 3]"))]
    pub origin: Vec3,
    /// How far apart neighbouring columns are in x, and rows in z \[m\].
    pub spacing: f32,
    /// How many heights a row has.
    pub columns: u32,
    /// Heights over the origin, row by row \[m\].
    pub heights: alloc::vec::Vec<f32>,
}

#[cfg(feature = "alloc")]
impl HeightFieldBuf {
    /// The same, borrowed.
    #[must_use]
    pub fn view(&self) -> HeightField<'_> {
        HeightField { heights: &self.heights, ..self.grid }
    }
}

#[cfg(feature = "alloc")]
impl TryFrom<Heights> for HeightFieldBuf {
    type Error = BadHeights;

    /// # Errors
    /// As `HeightField::new`.
    fn try_from(file: Heights) -> Result<Self, BadHeights> {
        let field = HeightField::new(file.origin, file.spacing, file.columns as usize, &file.heights)?;
        let grid = HeightField { heights: &[], ..field };
        Ok(Self { grid, heights: file.heights.into() })
    }
}

#[cfg(feature = "alloc")]
impl From<HeightFieldBuf> for Heights {
    fn from(field: HeightFieldBuf) -> Self {
        let HeightField { origin, spacing, columns, .. } = field.grid;
        Self { origin, spacing, columns: columns as u32, heights: field.heights.to_vec() }
    }
}

#[cfg(feature = "schema")]
impl schemars::JsonSchema for HeightFieldBuf {
    fn schema_name() -> alloc::borrow::Cow<'static, str> {
        Heights::schema_name()
    }
    fn json_schema(generator: &mut schemars::SchemaGenerator) -> schemars::Schema {
        Heights::json_schema(generator)
    }
}
