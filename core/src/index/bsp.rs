//! The binary space partition: planes of any orientation, chosen from the data.

use super::domain::around;
use super::frames::Frames;
use super::kd::{halve, longest};
use super::sorted::Entry;
use super::split::{CHILDREN, Split};
use super::tree::Tree;
use crate::math::sqrt;
use glam::{Mat3, Vec3};

/// A binary space partition (Fuchs, Kedem and Naylor 1980) over points.
///
/// Every node may turn to the principal axes of its points (Pearson 1901), and does so where they lie much closer
/// together there: sheets and fibres that are oblique to the coordinates. Else it divides as the kd-tree.
pub type Bsp<'m> = Tree<'m, Planes>;

/// Splits at a median along the longest side of a box that may be turned.
#[derive(Clone, Copy, Debug, Default)]
pub struct Planes;

/// Nodes with fewer points than this keep the frame they have, so that one serves many leaves: whoever goes from leaf to
/// leaf has to turn with the frames. The root turns with as few as are looked at.
const FEWEST: usize = 1024;
/// Points that are looked at to find the axes.
const SAMPLE: usize = 32;
/// A turned box has to have less surface than the present one by this factor.
const GAIN: f32 = 0.6;

impl Split for Planes {
    const LEAF: usize = 32;
    const BYTES: usize = 4;
    const TURNS: bool = true;
    /// The frame's number; none at the root.
    type Cell = Option<u32>;

    fn root(&mut self, _: Vec3, _: Vec3) -> Option<u32> {
        None
    }

    fn frame(&self, cell: &mut Option<u32>, entries: &[Entry], frames: &mut Frames<'_>) -> u32 {
        let mut frame = cell.unwrap_or(0);
        if entries.len() >= if cell.is_none() { SAMPLE } else { FEWEST } {
            let sample = || entries.iter().step_by(entries.len() / SAMPLE).map(|entry| Vec3::from_array(entry.x));
            let axes = principal_axes(sample);
            let (now, turned) = (frames.bounds(frame, sample()), axes.transpose());
            if surface(around(sample().map(|point| turned * point))) < GAIN * surface(now) {
                frame = frames.add(axes).unwrap_or(frame);
            }
        }
        *cell = Some(frame);
        frame
    }

    fn split(
        &self,
        cell: Option<u32>,
        [low, high]: [Vec3; 2],
        entries: &mut [Entry],
        frames: &Frames<'_>,
        children: &mut heapless::Vec<(usize, Option<u32>), CHILDREN>,
    ) {
        let axis = longest(high - low);
        let normal = frames.axis(cell.unwrap_or(0), axis);
        let height = |entry: &Entry| normal.dot(Vec3::from_array(entry.x));
        let n = halve(entries, height);
        if n < entries.len() {
            let _ = children.push((n, cell));
            let _ = children.push((entries.len(), cell));
        }
    }
}

/// Half of a box's surface.
fn surface([low, high]: [Vec3; 2]) -> f32 {
    let side = high - low;
    side.x * side.y + side.y * side.z + side.z * side.x
}

/// The axes along which points are uncorrelated: the eigenvectors of their covariance, by Jacobi's rotations.
pub(crate) fn principal_axes<I: Iterator<Item = Vec3>>(points: impl Fn() -> I) -> Mat3 {
    let (sum, count) = points().fold((Vec3::ZERO, 0.0), |(sum, count), point| (sum + point, count + 1.0));
    let mean = sum / count;
    let mut covariance = [[0.0f32; 3]; 3];
    for point in points() {
        let d = (point - mean).to_array();
        for i in 0..3 {
            for j in 0..3 {
                covariance[i][j] += d[i] * d[j];
            }
        }
    }
    let mut axes = Mat3::IDENTITY.to_cols_array_2d();
    for _ in 0..SWEEPS {
        for (p, q) in [(0, 1), (0, 2), (1, 2)] {
            rotate(&mut covariance, &mut axes, p, q);
        }
    }
    // Rounding has bent them a little.
    let x = crate::math::unit(Vec3::from_array(axes[0]));
    let y = Vec3::from_array(axes[1]);
    let y = crate::math::unit(y - x * x.dot(y));
    Mat3::from_cols(x, y, x.cross(y))
}

/// Jacobi's method converges quadratically: this is enough for `f32`.
const SWEEPS: usize = 5;

/// Turns the axes p and q so that they become uncorrelated (Golub and Van Loan, "Matrix Computations", section 8.5).
fn rotate(covariance: &mut [[f32; 3]; 3], axes: &mut [[f32; 3]; 3], p: usize, q: usize) {
    let off = covariance[p][q];
    if !(off.abs() > 1e-9 * (covariance[p][p] + covariance[q][q])) {
        return;
    }
    let tau = (covariance[q][q] - covariance[p][p]) / (2.0 * off);
    let sign = if tau < 0.0 { -1.0 } else { 1.0 };
    let t = sign / (tau.abs() + sqrt(1.0 + tau * tau));
    let c = 1.0 / sqrt(1.0 + t * t);
    let s = t * c;
    let turn = |a: f32, b: f32| (c * a - s * b, s * a + c * b);
    for row in covariance.iter_mut() {
        (row[p], row[q]) = turn(row[p], row[q]);
    }
    let (upper, lower) = (covariance[p], covariance[q]);
    for (k, (a, b)) in upper.into_iter().zip(lower).enumerate() {
        (covariance[p][k], covariance[q][k]) = turn(a, b);
    }
    let (upper, lower) = (axes[p], axes[q]);
    for (k, (a, b)) in upper.into_iter().zip(lower).enumerate() {
        (axes[p][k], axes[q][k]) = turn(a, b);
    }
}
