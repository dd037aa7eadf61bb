//! The kd-tree: every node is halved across its longest side.

use super::frames::Frames;
use super::sorted::{Entry, LANES};
use super::split::{CHILDREN, Split, partition};
use super::tree::Tree;
use glam::Vec3;

/// A kd-tree (Bentley 1975), balanced: good for every spread of points and every radius, and best for the nearest.
pub type Kd<'m> = Tree<'m, Halves>;

/// Splits at a median along the longest side.
#[derive(Clone, Copy, Debug, Default)]
pub struct Halves;

impl Split for Halves {
    const LEAF: usize = 32;
    const BYTES: usize = 4;
    type Cell = ();

    fn root(&mut self, _: Vec3, _: Vec3) {}

    fn split(
        &self,
        (): (),
        [low, high]: [Vec3; 2],
        entries: &mut [Entry],
        _: &Frames<'_>,
        children: &mut heapless::Vec<(usize, ()), CHILDREN>,
    ) {
        let axis = longest(high - low);
        if !(low[axis] < high[axis]) {
            return;
        }
        let n = halve(entries, |entry| entry.x[axis]);
        if n < entries.len() {
            let _ = children.push((n, ()));
            let _ = children.push((entries.len(), ()));
        }
    }
}

/// Sorts entries into a lower and an upper half, and returns how many are in the lower; none is empty unless all are
/// equal.
///
/// Many are halved at the median of a sample; few exactly, so that leaves fill whole blocks of lanes.
#[inline(always)]
pub(super) fn halve(entries: &mut [Entry], height: impl Fn(&Entry) -> f32) -> usize {
    if entries.len() <= FEW {
        let half = (entries.len() / 2).next_multiple_of(LANES).min(entries.len() - 1);
        select(entries, half, height);
        return half;
    }
    let pivot = median(entries, &height);
    match partition(entries, |entry| height(entry) < pivot) {
        // The lowest itself has nothing below it.
        0 => partition(entries, |entry| height(entry) <= pivot),
        n => n,
    }
}

/// Brings the `n` lowest entries to the front (Hoare's quickselect). The order is ours, not that of a library's version.
fn select(mut entries: &mut [Entry], mut n: usize, height: impl Fn(&Entry) -> f32) {
    while n > 0 && n < entries.len() {
        let pivot = median(entries, &height);
        let mut below = partition(entries, |entry| height(entry) < pivot);
        if below == 0 {
            // Those that are equal to the pivot are in order already.
            below = partition(entries, |entry| height(entry) <= pivot);
            if n <= below {
                return;
            }
        }
        if n < below {
            entries = &mut entries[..below];
        } else {
            entries = &mut entries[below..];
            n -= below;
        }
    }
}

/// So many are halved exactly.
const FEW: usize = 128;

/// The axis along which a box is longest.
pub(super) fn longest(sides: Vec3) -> usize {
    let axis = if sides.y > sides.x { 1 } else { 0 };
    if sides.z > sides[axis] { 2 } else { axis }
}

/// Entries that are looked at to guess the median.
const SAMPLE: usize = 31;

/// A number that is about as often exceeded as not: the median of a sample.
pub(super) fn median(entries: &[Entry], x: impl Fn(&Entry) -> f32) -> f32 {
    let mut sample = [0.0; SAMPLE];
    let n = SAMPLE.min(entries.len());
    let step = entries.len() / n;
    for (i, sample) in sample[..n].iter_mut().enumerate() {
        *sample = x(&entries[i * step + step / 2]);
    }
    *sample[..n].select_nth_unstable_by(n / 2, f32::total_cmp).1
}
