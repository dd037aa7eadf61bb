//! The parts that both grids share: their memory, and points sorted by cell.

use super::domain::Domain;
use super::sorted::{LANES, Sorted};
use glam::Vec3;

/// Words for so many points and as many cells; `usize::MAX` where it takes more.
pub(super) const fn words(points: usize) -> usize {
    points.saturating_mul(8).saturating_add(4 * LANES + 4)
}

/// Divides memory into room for points, and for where each cell begins.
pub(super) fn divide(memory: &mut [u32], domain: Domain) -> (Sorted<'_>, &mut [u32]) {
    let capacity = memory.len().saturating_sub(words(0)) / 8;
    Sorted::new(memory, capacity, domain)
}

/// Sorts the points by cell: counts what each gets, then deals them out. `starts` has two entries more than cells.
pub(super) fn sort_by_cell(
    sorted: &mut Sorted<'_>,
    starts: &mut [u32],
    points: &[Vec3],
    cell_of: impl Fn(Vec3) -> usize,
) {
    let domain = sorted.domain;
    let sound = || points.iter().enumerate().filter(|(_, point)| point.is_finite());
    starts.fill(0);
    let (_, cells) = sorted.rows_and_scratch();
    for ((_, point), cell) in sound().zip(cells) {
        *cell = cell_of(domain.place(*point)) as u32;
        starts[*cell as usize + 2] += 1;
    }
    let mut sum = 0;
    for start in starts.iter_mut() {
        sum += *start;
        *start = sum;
    }
    // The next free slot of a cell is kept one further on, where in the end the following cell's start has to be.
    for (i, (row, point)) in sound().enumerate() {
        let next = &mut starts[sorted.scratch(i) as usize + 1];
        sorted.put(*next as usize, domain.place(*point), row as u32);
        *next += 1;
    }
}
