//! Sums by the inverse square of the distance, for masses and charges alike.

use crate::index::{BarnesHut, Opening};
use crate::lanes::{LANES, NOWHERE, Pull, splat};
use core::ops::Range;
use glam::Vec3;
use wide::f32x8;

/// Visits the rows with Σ w d⃗ / (d² + s²)^{3/2} over all others: by the tree if there is one and the law opens nodes, else
/// pair by pair.
pub(super) fn field(
    law: Opening,
    tree: Option<&BarnesHut<'_>>,
    (position, weight): (&[Vec3], &[f32]),
    rows: Range<usize>,
    visit: &mut dyn FnMut(usize, Vec3),
) {
    match tree.filter(|_| law.theta > 0.0) {
        Some(tree) => {
            tree.field(law, rows, visit);
        }
        None => direct(position, weight, law.softening * law.softening, rows, visit),
    }
}

/// Particles for which the sums go on side by side, so that each block of sources is turned into lanes once for all. Their
/// number changes no sum: one on a chip, whose stack is small, many on a host.
const PLACES: usize = if cfg!(one_by_one) { 1 } else { 32 };

/// Visits the rows with Σ w d⃗ / (d² + `square`)^{3/2} over all others, summed pair by pair.
///
/// Rows that are not finite are left out: they would spoil all others in one step.
pub(super) fn direct(
    position: &[Vec3],
    weight: &[f32],
    square: f32,
    rows: Range<usize>,
    visit: &mut dyn FnMut(usize, Vec3),
) {
    let sound = position.iter().all(|x| x.is_finite()) && weight.iter().all(|w| w.is_finite());
    let square = f32x8::splat(square);
    for first in rows.clone().step_by(PLACES) {
        let places = &position[first..rows.end.min(first + PLACES)];
        let mut pulls = [Pull::default(); PLACES];
        for (x, w) in position.chunks(LANES).zip(weight.chunks(LANES)) {
            let (x, w) = sources(x, w, sound);
            for (pull, place) in pulls.iter_mut().zip(places) {
                pull.add(splat(*place), x, w, square);
            }
        }
        for ((row, _), pull) in (first..).zip(places).zip(pulls) {
            visit(row, pull.total());
        }
    }
}

/// Some sources in lanes; those beyond the end, and unless all are `sound` those that are not finite, have no weight.
#[inline(always)]
fn sources(position: &[Vec3], weight: &[f32], sound: bool) -> ([f32x8; 3], f32x8) {
    let (mut x, mut w) = ([[NOWHERE; LANES]; 3], [0.0; LANES]);
    for (lane, (position, weight)) in position.iter().zip(weight).enumerate().take(LANES) {
        if sound || (position.is_finite() && weight.is_finite()) {
            (x[0][lane], x[1][lane], x[2][lane]) = (*position).into();
            w[lane] = *weight;
        }
    }
    (x.map(f32x8::new), f32x8::new(w))
}

/// Σ w₁ w₂ / √(d² + s²) over all pairs, in double precision; two that coincide do nothing to each other unless softened.
#[cfg(feature = "std")]
pub(super) fn potential(position: &[Vec3], weight: &[f32], softening: f32) -> f64 {
    let square = f64::from(softening * softening);
    let bodies = || position.iter().zip(weight);
    let mut sum = 0.0;
    for (i, (x, &w)) in bodies().enumerate() {
        for (y, &other) in bodies().skip(i + 1) {
            let d = (*x - *y).to_array().map(f64::from);
            let r2 = d.iter().map(|d| d * d).sum::<f64>() + square;
            if r2 > 0.0 {
                sum += f64::from(w) * f64::from(other) / libm::sqrt(r2);
            }
        }
    }
    sum
}
