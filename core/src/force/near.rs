//! Sums over neighbours.

use super::State;
use core::ops::Range;
use glam::Vec3;

/// Adds to each of `rows` the sum of something over its neighbours; what is not finite is left out, so that it harms
/// nobody else.
#[inline(always)]
pub(super) fn add_up(
    state: &State<'_>,
    reach: f32,
    rows: Range<usize>,
    total: &mut [Vec3],
    term: impl Fn(usize, usize) -> Vec3,
) {
    let first = rows.start;
    state.near.of(rows, reach, &mut |row, nearby| {
        let mut sum = Vec3::ZERO;
        for &other in nearby.rows() {
            let term = term(row, other as usize);
            if term.is_finite() {
                sum += term;
            }
        }
        if let Some(total) = total.get_mut(row - first) {
            *total += sum;
        }
    });
}

/// Pairs that are put in order at a time.
const IN_ORDER: usize = if cfg!(target_os = "none") { 16 } else { 2048 };

/// Visits those pairs of neighbours that are wanted, each once, in ascending order of their rows, whatever order the index has: by going over all of them as
/// often as there are more than can be put in order at a time.
pub(super) fn in_order(
    state: &State<'_>,
    reach: f32,
    is_wanted: impl Fn([usize; 2]) -> bool,
    mut visit: impl FnMut([usize; 2]),
) {
    let mut done = None;
    loop {
        let (mut first, mut len) = ([[0; 2]; IN_ORDER], 0);
        state.near.of(0..state.position.len(), reach, &mut |row, nearby| {
            for &other in nearby.rows() {
                let pair = [row as u32, other];
                if pair[0] < other && Some(pair) > done && is_wanted(pair.map(|row| row as usize)) {
                    let place = first[..len].partition_point(|before| *before < pair);
                    len = (len + 1).min(IN_ORDER);
                    // The last one makes room.
                    if let [place, behind @ ..] = &mut first[place..len] {
                        let mut moved = core::mem::replace(place, pair);
                        behind.iter_mut().for_each(|next| core::mem::swap(next, &mut moved));
                    }
                }
            }
        });
        first[..len].iter().for_each(|&pair| visit(pair.map(|row| row as usize)));
        if len < IN_ORDER {
            return;
        }
        done = Some(first[len - 1]);
    }
}

/// The way from one row to another, in double precision \[m\].
#[cfg(feature = "std")]
pub(super) fn wide_between(state: &State<'_>, from: usize, to: usize) -> [f64; 3] {
    if state.near.room().is_some() {
        return state.between(from, to).to_array().map(f64::from);
    }
    let [from, to] = [from, to].map(|row| state.position[row].to_array().map(f64::from));
    core::array::from_fn(|axis| to[axis] - from[axis])
}

/// Σ of something over all pairs of neighbours, each counted once.
#[cfg(feature = "std")]
pub(super) fn sum_of_pairs(state: &State<'_>, reach: f32, mut term: impl FnMut(usize, usize) -> f64) -> f64 {
    let mut sum = 0.0;
    state.near.of(0..state.position.len(), reach, &mut |row, nearby| {
        let later = nearby.rows().iter().map(|&other| other as usize).filter(|&other| other > row);
        sum += later.map(|other| term(row, other)).sum::<f64>();
    });
    sum
}
