//! zelll's `CellGrid`, cells as large as the reach: asked cell by cell, so that a cell's neighbours are looked up in the
//! hash map once for all its points. Pairs go over its half neighbourhoods in the same way, which is as fast as its
//! iterator of pairs or faster.

use crate::{Peer, square_distance};
use std::hint::black_box;
use zelll::CellGrid;
use zelll::cellgrid::GridCell;
use zelll::cellgrid::neighborhood::{Full, Half};

type Point = (u32, [f32; 3]);
type Grid = CellGrid<Point, 3, f32>;

#[derive(Default)]
pub(crate) struct Zelll {
    grid: Grid,
    points: Vec<[f32; 3]>,
    list: Vec<u32>,
}

impl Zelll {
    /// The grid, built again if its cells are too small for a radius.
    fn grid_for(&mut self, radius: f32) {
        if self.grid.info().cutoff() < radius {
            self.grid = grid(&self.points, radius);
        }
    }
}

/// The grid of cells of this size, but at most about a thousand along each axis: it numbers its cells in 32 bits.
fn grid(points: &[[f32; 3]], reach: f32) -> Grid {
    let extent = |axis: usize| {
        let ends = points.iter().map(|place| place[axis]);
        let (low, high) = ends.fold((f32::MAX, f32::MIN), |(low, high), x| (low.min(x), high.max(x)));
        high - low
    };
    let longest = extent(0).max(extent(1)).max(extent(2));
    let size = reach.max(longest / 1000.0).max(f32::MIN_POSITIVE);
    CellGrid::new(points.iter().zip(0..).map(|(&place, row)| (row, place)), size)
}

impl Peer for Zelll {
    fn name(&self) -> &'static str {
        "zelll"
    }

    fn build(&mut self, points: &[[f32; 3]], reach: f32) {
        self.points.clear();
        self.points.extend_from_slice(points);
        self.grid = grid(points, reach);
    }

    fn bytes(&self) -> Option<usize> {
        // The points in cells, each point's cell, and a hash map that is at most seven eighths full.
        let buckets = (self.grid.iter().count() * 8 / 7).next_power_of_two();
        let bucket = size_of::<(i32, [usize; 3])>() + 1;
        Some(self.points.len() * (size_of::<Point>() + size_of::<i32>()) + buckets * bucket)
    }

    fn counts(&mut self, radius: f32, counts: &mut [u32]) -> bool {
        self.grid_for(radius);
        let square = radius * radius;
        let mut near = Vec::new();
        for cell in self.grid.iter() {
            around(cell, &mut near);
            for &(row, place) in cell.iter() {
                let mut count = 0;
                for points in &near {
                    for point in *points {
                        count += u32::from(square_distance(place, point.1) <= square);
                    }
                }
                counts[row as usize] = u32::saturating_sub(count, 1);
            }
        }
        true
    }

    fn lists(&mut self, radius: f32) -> Option<u64> {
        self.grid_for(radius);
        let square = radius * radius;
        let mut near = Vec::new();
        let mut total = 0;
        for cell in self.grid.iter() {
            around(cell, &mut near);
            for &(row, place) in cell.iter() {
                self.list.clear();
                for points in &near {
                    for point in *points {
                        if square_distance(place, point.1) <= square && point.0 != row {
                            self.list.push(point.0);
                        }
                    }
                }
                total += black_box(&self.list).len() as u64;
            }
        }
        Some(total)
    }

    fn pairs(&mut self, radius: f32, visit: &mut dyn FnMut(u32, u32)) -> Option<u64> {
        self.grid_for(radius);
        let square = radius * radius;
        let mut total = 0;
        let mut test = |a: &Point, b: &Point| {
            if square_distance(a.1, b.1) <= square {
                total += 1;
                visit(a.0, b.0);
            }
        };
        for cell in self.grid.iter() {
            let own = cell.iter().as_slice();
            for (i, a) in own.iter().enumerate() {
                own[i + 1..].iter().for_each(|b| test(a, b));
            }
            for other in cell.neighbors::<Half>() {
                let other = other.iter().as_slice();
                for a in own {
                    other.iter().for_each(|b| test(a, b));
                }
            }
        }
        Some(total)
    }

    fn nearest(&mut self, _: usize, _: &mut Vec<f32>) -> bool {
        false
    }
}

/// The points of a cell and of those around it.
fn around<'g>(cell: GridCell<'g, Point, 3, f32>, near: &mut Vec<&'g [Point]>) {
    near.clear();
    near.push(cell.iter().as_slice());
    near.extend(cell.neighbors::<Full>().map(|cell| cell.iter().as_slice()));
}
