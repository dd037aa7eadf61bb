//! The grid: cells of one size in the box around all pieces, each with the numbers of those that reach into it.

use super::header::{Boxes, HEADER, Header, UNIT};
use super::near::Gathered;
use super::nearest::{Closest, square_to};
use super::probe::{Best, Probe};
use super::tree::MOST;
use super::visit::{Visit, Visitor};
use super::{Pieces, Structure, TooSmall};
use crate::math::{largest, max, min};
use crate::shape::Aabb;
use core::ops::ControlFlow;
use glam::Vec3;

/// Cells for every piece: meshes are surfaces, and leave most of them empty.
const CELLS: usize = 8;
/// Cells along an axis, at most.
const LONGEST: f32 = 1024.0;
/// Words before the cells.
const FRAME: usize = 2 * UNIT;

/// Words of memory for so many pieces.
pub(super) const fn words(pieces: usize) -> usize {
    pieces.saturating_mul(CELLS + 8).saturating_add(HEADER + FRAME + 2 * UNIT)
}

/// Where the cells are.
#[derive(Clone, Copy, Debug, Default, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
struct Frame {
    cells: [u32; 3],
    low: [f32; 3],
    /// The side of a cell \[m\], and one over it.
    side: f32,
    inverse: f32,
    /// By how much a cell's planes may be off \[m\].
    off: f32,
    spare: [u32; 7],
}

impl Frame {
    fn new(bounds: &Aabb, side: f32) -> Self {
        let extent = bounds.max - bounds.min;
        let count = |extent: f32| ((extent / side) as u32).min(LONGEST as u32 - 1) + 1;
        // A box longer than any number is one cell.
        let cells = if extent.is_finite() { extent.to_array().map(count) } else { [1; 3] };
        let off = 4.0 * f32::EPSILON * max(largest(bounds.min), largest(bounds.max)) + side * (1.0 / 64.0);
        Self { cells, low: bounds.min.to_array(), side, inverse: 1.0 / side, off, spare: [0; 7] }
    }

    fn count(&self) -> usize {
        self.cells.iter().fold(1_usize, |product, &cells| product.saturating_mul(cells as usize))
    }

    /// The cell of a coordinate: the same or a later one for a larger coordinate, whatever it is.
    #[inline(always)]
    fn cell(&self, axis: usize, x: f32) -> usize {
        (((x - self.low[axis]) * self.inverse) as u32).min(self.cells[axis] - 1) as usize
    }

    /// The first and the last cells that a box reaches into.
    fn range(&self, bounds: &Aabb) -> [[usize; 3]; 2] {
        [bounds.min, bounds.max].map(|corner| core::array::from_fn(|axis| self.cell(axis, corner[axis])))
    }

    /// Two planes between which all lies that has coordinates in a slice of cells.
    fn planes(&self, axis: usize, slice: usize) -> (f32, f32) {
        let low = self.low[axis] + slice as f32 * self.side;
        (low - self.off, low + self.side + self.off)
    }

    fn number(&self, [x, y, z]: [usize; 3]) -> usize {
        (z * self.cells[1] as usize + y) * self.cells[0] as usize + x
    }
}

/// Visits the numbers of all cells in a range.
fn each_cell(frame: &Frame, [first, last]: [[usize; 3]; 2], mut visit: impl FnMut(usize)) {
    for z in first[2]..=last[2] {
        for y in first[1]..=last[1] {
            for x in first[0]..=last[0] {
                visit(frame.number([x, y, z]));
            }
        }
    }
}

/// A grid, read from words.
struct Grid<'w> {
    frame: &'w Frame,
    /// Where each cell's pieces begin, and where the last one's end.
    starts: &'w [u32],
    listed: &'w [u32],
}

impl<'w> Grid<'w> {
    fn of(words: &'w [u32]) -> Option<Self> {
        let (frame, rest) = words.get(HEADER..)?.split_first_chunk::<FRAME>()?;
        let frame: &Frame = bytemuck::cast_ref(frame);
        let (starts, listed) = rest.split_at_checked(frame.count().checked_add(1)?)?;
        frame.cells.iter().all(|&cells| cells > 0).then_some(Self { frame, starts, listed })
    }

    #[inline(always)]
    fn pieces(&self, cell: usize) -> &'w [u32] {
        match self.starts.get(cell..cell + 2) {
            Some(&[start, end]) => self.listed.get(start as usize..end as usize).unwrap_or_default(),
            _ => &[],
        }
    }
}

/// Tells whether the words after a sound header are a grid whose every number leads somewhere.
pub(super) fn is_sound(words: &[u32]) -> bool {
    let (Some(header), Some(grid)) = (Header::of(words), Grid::of(words)) else {
        return false;
    };
    let references = header.references as usize;
    grid.starts.first() == Some(&0)
        && grid.starts.is_sorted()
        && grid.starts.last() == Some(&header.references)
        && grid.listed.get(..references).is_some_and(|listed| listed.iter().all(|&piece| piece < header.pieces))
}

/// The boxes that count: of pieces with finite ones.
fn boxes<P: Pieces + ?Sized>(pieces: &P) -> impl Iterator<Item = (usize, Aabb)> + '_ {
    let all = (0..pieces.count()).map(|piece| (piece, pieces.box_of(piece)));
    all.filter(|(_, bounds)| bounds.min.is_finite() && bounds.max.is_finite())
}

/// Sorts pieces into cells, and returns the words that it needs from then on.
pub(super) fn build<'m, P: Pieces + ?Sized>(pieces: &P, memory: &'m mut [u32]) -> Result<&'m [u32], TooSmall> {
    let (len, words) = (pieces.count(), memory.len());
    let needed = HEADER + FRAME + 2 + len + UNIT;
    if words < needed || len > MOST {
        return Err(TooSmall { words, needed });
    }
    let bounds = boxes(pieces).fold(Aabb::EMPTY, |all, (_, bounds)| all.join(bounds));
    let bounds = if bounds.min.is_finite() { bounds } else { Aabb { min: Vec3::ZERO, max: Vec3::ZERO } };
    let room = words - (HEADER + FRAME + 1 + UNIT);
    let (frame, crowded) = choose(pieces, &bounds, room);
    let body = &mut memory[HEADER..];
    body[..FRAME].copy_from_slice(bytemuck::cast_ref::<Frame, [u32; FRAME]>(&frame));
    let (starts, listed) = body[FRAME..].split_at_mut(frame.count() + 1);
    let mut header = Header::new(Structure::Grid);
    (header.fullest, header.references) = list(pieces, &frame, starts, listed);
    let used = starts.len() + header.references as usize;
    let end = used.next_multiple_of(UNIT);
    body[FRAME + used..FRAME + end].fill(0);
    header.words = (HEADER + FRAME + end) as u32;
    header.pieces = len as u32;
    header.skipped = (len - boxes(pieces).count()) as u32;
    header.nodes = frame.count() as u32;
    header.crowded = crowded;
    header.boxes = Boxes::of(pieces);
    Ok(header.write(memory))
}

/// The smallest cells for which there is room, and how many times they had to grow by a quarter.
fn choose<P: Pieces + ?Sized>(pieces: &P, bounds: &Aabb, room: usize) -> (Frame, u32) {
    let extent = bounds.max * 0.5 - bounds.min * 0.5;
    let longest = max(extent.x, max(extent.y, extent.z));
    // A side beyond all numbers makes one cell of everything.
    let mut side = longest * (2.0 / LONGEST);
    let cells = CELLS.saturating_mul(pieces.count()).max(1);
    if !(side > f32::MIN_POSITIVE && side < f32::INFINITY) {
        side = max(longest, 1.0);
    }
    let mut frame = Frame::new(bounds, side);
    let grow = |frame: &Frame| Frame::new(bounds, min(frame.side * 1.25, f32::MAX));
    // A side that cannot grow any more has to do.
    while frame.count() > cells && frame.side < f32::MAX {
        frame = grow(&frame);
    }
    let mut crowded = 0;
    let fits = |frame: &Frame| {
        let places = |bounds: &Aabb| {
            let [first, last] = frame.range(bounds);
            (0..3).map(|axis| last[axis] - first[axis] + 1).product::<usize>()
        };
        frame.count() + boxes(pieces).map(|(_, bounds)| places(&bounds)).sum::<usize>() <= room
    };
    while frame.count() > 1 && !fits(&frame) {
        frame = if frame.side < f32::MAX { grow(&frame) } else { Frame { cells: [1; 3], ..frame } };
        crowded += 1;
    }
    (frame, crowded)
}

/// Lists the pieces by cells (a counting sort); returns how many the fullest has, and how many there are in all.
fn list<P: Pieces + ?Sized>(pieces: &P, frame: &Frame, starts: &mut [u32], listed: &mut [u32]) -> (u32, u32) {
    starts.fill(0);
    for (_, bounds) in boxes(pieces) {
        each_cell(frame, frame.range(&bounds), |cell| starts[cell] += 1);
    }
    let (mut fullest, mut sum) = (0, 0);
    for start in starts.iter_mut() {
        fullest = fullest.max(*start);
        sum += *start;
        *start = sum;
    }
    // Backwards, so that each cell has them in order.
    for piece in (0..pieces.count()).rev() {
        let bounds = pieces.box_of(piece);
        if bounds.min.is_finite() && bounds.max.is_finite() {
            each_cell(frame, frame.range(&bounds), |cell| {
                // There is a place for each, if boxes are what they were.
                starts[cell] = starts[cell].saturating_sub(1);
                if let Some(place) = listed.get_mut(starts[cell] as usize) {
                    *place = piece as u32;
                }
            });
        }
    }
    (fullest, sum)
}

/// Goes along the axis on which the segment crosses most cells, slice by slice; in each, through all cells that it may
/// come near while it is in the slice. (Amanatides and Woo 1987 step from cell to cell: a ball is in several.)
pub(super) fn first_hit<P: Pieces + ?Sized>(words: &[u32], pieces: &P, probe: &Probe<'_>, best: &mut Best) {
    let Some(grid) = Grid::of(words) else {
        return;
    };
    let (frame, step) = (grid.frame, probe.segment.step());
    if frame.count() == 1 {
        return grid.pieces(0).iter().for_each(|&piece| best.ask(pieces, probe, piece as usize));
    }
    let size = step.abs();
    let axis = if size.y > size.x { 1 } else { 0 };
    let axis = if size.z > size[axis] { 2 } else { axis };
    let [first, last] = frame.range(&probe.bounds());
    let slices = first[axis]..last[axis] + 1;
    let len = slices.len();
    for i in 0..len {
        let slice = if probe.down[axis] { slices.end - 1 - i } else { slices.start + i };
        let (low, high) = frame.planes(axis, slice);
        let (near, far) = probe.slab(axis, low, high);
        let (enter, leave) = (max(near, 0.0), min(far, 1.0));
        if enter > best.time {
            break;
        }
        if enter > leave {
            continue;
        }
        let reach = probe.between(enter, leave);
        let mut cells = frame.range(&reach);
        (cells[0][axis], cells[1][axis]) = (slice, slice);
        each_cell(frame, cells, |cell| {
            best.cost.visits += 1;
            grid.pieces(cell).iter().for_each(|&piece| best.ask(pieces, probe, piece as usize));
        });
    }
}

/// Gathers the pieces whose boxes meet another.
pub(super) fn near<P: Pieces + ?Sized>(words: &[u32], pieces: &P, bounds: &Aabb, found: &mut Gathered) {
    let Some(grid) = Grid::of(words) else {
        return;
    };
    each_cell(grid.frame, grid.frame.range(bounds), |cell| {
        found.cost.visits += 1;
        grid.pieces(cell).iter().for_each(|&piece| found.ask(pieces, bounds, piece as usize));
    });
}

/// Goes through the slices, rows and cells that a visitor enters, until it breaks off.
pub(super) fn visit<P: Pieces + ?Sized, V: Visitor>(words: &[u32], visit: &mut Visit<'_, P, V>) -> ControlFlow<()> {
    let Some(grid) = Grid::of(words) else {
        return ControlFlow::Continue(());
    };
    let frame = grid.frame;
    if frame.count() == 1 {
        return grid.pieces(0).iter().try_for_each(|&piece| visit.ask(piece as usize));
    }
    let last = frame.cells.map(|cells| cells as usize - 1);
    let between = |first: [usize; 3], last: [usize; 3]| {
        let corner = |cells: [usize; 3], high: bool| {
            Vec3::from([0, 1, 2].map(|axis| {
                let (low_plane, high_plane) = frame.planes(axis, cells[axis]);
                if high { high_plane } else { low_plane }
            }))
        };
        Aabb { min: corner(first, false), max: corner(last, true) }
    };
    for z in 0..=last[2] {
        if !visit.visitor.enters(&between([0, 0, z], [last[0], last[1], z])) {
            continue;
        }
        for y in 0..=last[1] {
            if !visit.visitor.enters(&between([0, y, z], [last[0], y, z])) {
                continue;
            }
            for x in 0..=last[0] {
                let pieces = grid.pieces(frame.number([x, y, z]));
                if !pieces.is_empty() && visit.visitor.enters(&between([x, y, z], [x, y, z])) {
                    visit.cost.visits += 1;
                    pieces.iter().try_for_each(|&piece| visit.ask(piece as usize))?;
                }
            }
        }
    }
    ControlFlow::Continue(())
}

/// Goes outward from the point's own cell along each axis, and leaves out slices, rows and cells that are too far away.
pub(super) fn nearest<P: Pieces + ?Sized, F: Fn(usize) -> Vec3>(words: &[u32], closest: &mut Closest<'_, P, F>) {
    let Some(grid) = Grid::of(words) else {
        return;
    };
    let (frame, point) = (grid.frame, closest.point);
    if frame.count() == 1 {
        return grid.pieces(0).iter().for_each(|&piece| closest.ask(piece as usize));
    }
    let mut bounds = Aabb { min: glam::Vec3::NEG_INFINITY, max: glam::Vec3::INFINITY };
    let own: [usize; 3] = core::array::from_fn(|axis| frame.cell(axis, point[axis]));
    let outward = |axis: usize| {
        let count = frame.cells[axis] as usize;
        (0..count)
            .flat_map(move |i| [own[axis].checked_add(i), own[axis].checked_sub(i + 1)])
            .flatten()
            .filter(move |&i| i < count)
    };
    for z in outward(2) {
        (bounds.min.z, bounds.max.z) = frame.planes(2, z);
        (bounds.min.y, bounds.max.y) = (f32::NEG_INFINITY, f32::INFINITY);
        (bounds.min.x, bounds.max.x) = (f32::NEG_INFINITY, f32::INFINITY);
        if square_to(point, &bounds) > closest.square {
            continue;
        }
        for y in outward(1) {
            (bounds.min.y, bounds.max.y) = frame.planes(1, y);
            (bounds.min.x, bounds.max.x) = (f32::NEG_INFINITY, f32::INFINITY);
            if square_to(point, &bounds) > closest.square {
                continue;
            }
            for x in outward(0) {
                (bounds.min.x, bounds.max.x) = frame.planes(0, x);
                if square_to(point, &bounds) > closest.square {
                    continue;
                }
                closest.cost.visits += 1;
                grid.pieces(frame.number([x, y, z])).iter().for_each(|&piece| closest.ask(piece as usize));
            }
        }
    }
}
