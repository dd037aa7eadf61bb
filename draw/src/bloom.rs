//! The soft shine around bright things, as in a lens or an eye.

use glam::{Vec2, Vec3};

/// How many cells of light there are across the picture, whatever its size.
const COLUMNS: usize = 160;

/// How far light spreads, in cells, and how often: three times makes a box nearly a bell.
const SPREAD: usize = 2;
const TIMES: usize = 3;

/// Light on a coarse grid.
#[derive(Debug)]
pub(super) struct Bloom {
    /// Pixels to a cell.
    cell: f32,
    columns: usize,
    rows: usize,
    cells: Vec<Vec3>,
    is_dark: bool,
}

impl Bloom {
    pub(super) fn new(width: usize, height: usize) -> Self {
        let cell = (width as f32 / COLUMNS as f32).max(1.0);
        // One more than fit, so that each pixel lies between four cells.
        let count = |pixels: usize| (pixels as f32 / cell).ceil() as usize + 2;
        let (columns, rows) = (count(width), count(height));
        Self { cell, columns, rows, cells: vec![Vec3::ZERO; columns * rows], is_dark: true }
    }

    /// Sheds light, given in pixels' worth of it.
    pub(super) fn shine(&mut self, at: Vec2, light: Vec3) {
        let light = light / (self.cell * self.cell);
        for (cell, share) in self.around(at) {
            self.cells[cell] += share * light;
        }
        self.is_dark = false;
    }

    /// Spreads the light.
    pub(super) fn spread(&mut self) {
        if self.is_dark {
            return;
        }
        let mut row = vec![Vec3::ZERO; self.columns.max(self.rows)];
        for _ in 0..TIMES {
            for y in 0..self.rows {
                blur(&mut self.cells[y * self.columns..][..self.columns], 1, &mut row);
            }
            for x in 0..self.columns {
                blur(&mut self.cells[x..], self.columns, &mut row);
            }
        }
    }

    /// The light on a row of pixels, one after the other; nothing if there is none at all.
    pub(super) fn row(&self, y: usize) -> Option<impl Fn(usize) -> Vec3> {
        if self.is_dark {
            return None;
        }
        let (above, down) = self.before(y);
        let upper = &self.cells[above * self.columns..][..self.columns];
        let lower = &self.cells[(above + 1) * self.columns..][..self.columns];
        let row: Vec<Vec3> = upper.iter().zip(lower).map(|(a, b)| a.lerp(*b, down)).collect();
        Some(move |x| {
            let (left, right) = self.before(x);
            row[left].lerp(row[left + 1], right)
        })
    }

    /// The last cell before the middle of a pixel, and how far on the middle of the pixel is.
    fn before(&self, pixel: usize) -> (usize, f32) {
        let at = (pixel as f32 + 0.5) / self.cell + 0.5;
        (at as usize, at - (at as usize) as f32)
    }

    /// The four cells around a place and the place's share in each.
    fn around(&self, at: Vec2) -> [(usize, f32); 4] {
        let last = Vec2::new(self.columns as f32 - 1.001, self.rows as f32 - 1.001);
        let at = (at / self.cell + 0.5).clamp(Vec2::ZERO, last);
        let (x, y) = (at.x as usize, at.y as usize);
        let (right, down) = (at.x - x as f32, at.y - y as f32);
        let cell = y * self.columns + x;
        [
            (cell, (1.0 - right) * (1.0 - down)),
            (cell + 1, right * (1.0 - down)),
            (cell + self.columns, (1.0 - right) * down),
            (cell + self.columns + 1, right * down),
        ]
    }
}

/// Replaces each cell of a line by the mean of its neighbourhood.
fn blur(cells: &mut [Vec3], stride: usize, copy: &mut [Vec3]) {
    let count = cells.len().div_ceil(stride);
    for (copy, cell) in copy.iter_mut().zip(cells.iter().step_by(stride)) {
        *copy = *cell;
    }
    for (at, cell) in cells.iter_mut().step_by(stride).enumerate() {
        let near = &copy[at.saturating_sub(SPREAD)..(at + SPREAD + 1).min(count)];
        *cell = near.iter().sum::<Vec3>() / (2 * SPREAD + 1) as f32;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn light_spreads_without_getting_more() {
        let (width, height) = (640, 480);
        let mut bloom = Bloom::new(width, height);
        bloom.shine(Vec2::new(300.3, 200.7), 1000.0 * Vec3::ONE);
        bloom.spread();
        let rows = (0..height).filter_map(|y| bloom.row(y));
        let sum: f32 = rows.map(|row| (0..width).map(|x| row(x).x).sum::<f32>()).sum();
        assert!((sum - 1000.0).abs() < 1.0, "{sum}");
        let row = bloom.row(200).unwrap();
        assert!(row(300).x > row(320).x);
        assert_eq!(row(600), Vec3::ZERO);
    }

    #[test]
    fn the_smallest_picture_has_bloom_too() {
        let mut bloom = Bloom::new(1, 1);
        bloom.shine(Vec2::new(-7.0, 1e9), Vec3::ONE);
        bloom.spread();
        assert!(bloom.row(0).unwrap()(0).is_finite());
    }
}
