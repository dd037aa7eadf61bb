//! Moments of the weights in a node, by which it acts.

use glam::Vec3;

/// The rule by which nodes count as far, and the way in which far nodes act.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Opening {
    /// A node acts as one if its longest side is less than this times its distance.
    pub theta: f32,
    /// Softening length s \[m\].
    pub softening: f32,
    /// True if nodes act by their dipole and quadrupole as well; else they act by their weight alone.
    pub quadrupole: bool,
}

/// The moments of a node's weights about their centre c, with d⃗ = x⃗ − c⃗.
#[derive(Clone, Copy, Debug, Default, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
pub(super) struct Moments {
    /// c = Σ |w| x / Σ |w|.
    pub(super) center: [f32; 3],
    /// Σ w.
    pub(super) weight: f32,
    /// Σ |w|.
    pub(super) absolute: f32,
    /// Σ w d.
    pub(super) dipole: [f32; 3],
    /// Σ w d dᵀ: xx, yy, zz, xy, yz, zx.
    pub(super) second: [f32; 6],
    /// The longest side of the node's box.
    pub(super) side: f32,
}

impl Moments {
    /// The moments of parts, or of points, together.
    pub(super) fn of(parts: impl Iterator<Item = Self> + Clone) -> Self {
        let (mut sum, mut absolute, mut weight) = (Vec3::ZERO, 0.0, 0.0);
        for part in parts.clone() {
            sum += Vec3::from_array(part.center) * part.absolute;
            absolute += part.absolute;
            weight += part.weight;
        }
        let Some(first) = parts.clone().next() else { return Self::default() };
        let center = if absolute > 0.0 { sum / absolute } else { Vec3::from_array(first.center) };
        let (mut dipole, mut second) = (Vec3::ZERO, [0.0; 6]);
        for part in parts {
            let (e, d, w) = (Vec3::from_array(part.center) - center, Vec3::from_array(part.dipole), part.weight);
            dipole += d + e * w;
            for (k, (i, j)) in PAIRS.into_iter().enumerate() {
                second[k] += part.second[k] + d[i] * e[j] + d[j] * e[i] + w * e[i] * e[j];
            }
        }
        Self { center: center.to_array(), weight, absolute, dipole: dipole.to_array(), second, side: 0.0 }
    }
}

/// The axes of the six second moments.
const PAIRS: [(usize, usize); 6] = [(0, 0), (1, 1), (2, 2), (0, 1), (1, 2), (2, 0)];
