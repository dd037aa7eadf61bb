//! Who is near whom, for forces between neighbours.

use super::State;
use core::ops::Range;

/// Neighbours that are handed over at once where there is no index.
const RUN: usize = 32;

/// Visits each of `rows` that has neighbours with the others within `reach`, in runs: from the index if there is one, else
/// by looking at all others. What is near is the same either way, see [`index`](crate::index); rows that are not finite
/// are near nobody.
///
/// The runs of a row and their order do not depend on which rows are asked for, so neither do sums over them.
pub(super) fn neighbours(state: &State<'_>, reach: f32, rows: Range<usize>, visit: &mut dyn FnMut(usize, &[u32])) {
    match state.near {
        Some(index) => {
            index.neighbours(reach, &mut |row, others| {
                if rows.contains(&(row as usize)) {
                    visit(row as usize, others);
                }
            });
        }
        None if reach > 0.0 => rows.for_each(|row| look_at_all(state, reach, row, visit)),
        None => {}
    }
}

/// The neighbours of one row, found by looking at all others.
fn look_at_all(state: &State<'_>, reach: f32, row: usize, visit: &mut dyn FnMut(usize, &[u32])) {
    let (mut run, mut len) = ([0; RUN], 0);
    let square = reach * reach;
    for (other, &place) in state.position.iter().enumerate() {
        let d = place - state.position[row];
        if d.x * d.x + d.y * d.y + d.z * d.z <= square && other != row {
            run[len] = other as u32;
            len += 1;
            if len == RUN {
                visit(row, &run);
                len = 0;
            }
        }
    }
    if len > 0 {
        visit(row, &run[..len]);
    }
}

/// Σ of something over all pairs of neighbours, each counted once.
#[cfg(feature = "std")]
pub(super) fn sum_of_pairs(state: &State<'_>, reach: f32, mut term: impl FnMut(usize, usize) -> f64) -> f64 {
    let mut sum = 0.0;
    neighbours(state, reach, 0..state.position.len(), &mut |row, others| {
        let later = others.iter().map(|&other| other as usize).filter(|&other| other > row);
        sum += later.map(|other| term(row, other)).sum::<f64>();
    });
    sum
}
