//! How hard particles are to turn about their middle.

use super::turn::Turn;
use crate::math::{clamp, dot, frame, length, max, min, sqrt, unit};
use glam::{Mat3, Vec3};

/// The least moment about the first axis, a share of all: what turns faster about that with some angular momentum loses it in rounding of how its ends
/// then move.
const THIN: f32 = 1e-6;

/// The share of an angular momentum that may be owed to what is too thin to carry it about the line along which it is.
const OWED: f32 = 2e-5;

/// How hard some particles are to turn about their middle, told in a frame of their own, the first of whose axes goes along them.
#[derive(Clone, Copy)]
pub(super) struct Inertia {
    /// The frame's axes.
    axes: Mat3,
    /// The moments of inertia about these \[kg m²\].
    moments: Vec3,
    /// −Σ m y z, −Σ m z x and −Σ m x y, by what is left out of them \[kg m²\].
    products: Vec3,
    /// What the moment about the first axis has to be beyond, so that they turn about that \[kg m²\].
    thin: f32,
    /// The share of their angular momentum that may be owed to them.
    owed: f32,
}

impl Inertia {
    /// That of masses and the ways to them from their middle, of which one of the longest is given. By `coarse` rounding of their places may show them
    /// off a line \[m\].
    pub(super) fn of(all: impl Iterator<Item = (f32, Vec3)>, longest: Vec3, coarse: f32) -> Self {
        let along = unit(longest);
        let (second, third) = frame(along);
        let axes = Mat3::from_cols(along, second, third);
        let (mut squares, mut products, mut sum) = (Vec3::ZERO, Vec3::ZERO, 0.0);
        for (mass, arm) in all {
            sum += mass;
            let own = in_frame(axes, arm);
            squares += own * own * mass;
            products -= Vec3::new(own.y * own.z, own.z * own.x, own.x * own.y) * mass;
        }
        let Vec3 { x, y, z } = squares;
        let (thin, owed) = (THIN * (x + y + z) + sum * (coarse * coarse), OWED + coarse / length(longest));
        Self { axes, moments: Vec3::new(y + z, z + x, x + y), products, thin, owed }
    }

    /// How fast they turn where they have so much angular momentum \[rad/s\], but as much of that as takes no more than `most` \[J\]: less about the line along
    /// which they are first, and nothing about a line on which all lie. Tells the energy of that as well \[J\].
    pub(super) fn turning(&self, spin: Vec3, most: f32) -> (Vec3, f32) {
        let Eliminated { pivots, left, factors: [xy, xz, yz] } = self.eliminated(spin);
        let across = across(left, pivots);
        let share = if across > most { sqrt(most / across) } else { 1.0 };
        let Vec3 { x, y, z } = left / pivots;
        let fastest = sqrt(2.0 * max(most - across, 0.0) / pivots.x);
        let x = if pivots.x > self.thin { clamp(x, -fastest, fastest) } else { 0.0 };
        let energy = min(across, most) + 0.5 * pivots.x * x * x;
        let (y, z) = (y * share - xy * x, z * share);
        let omega = self.axes * Vec3::new(x, y, z - xz * x - yz * y);
        if omega.is_finite() && energy.is_finite() { (omega, energy) } else { (Vec3::ZERO, 0.0) }
    }

    /// The least energy that they have with that \[J\], but for what may be owed to them about the line along which they are. To turn about a line takes
    /// what it takes about the thickest thing that is no more than a line.
    pub(super) fn energy(&self, spin: Vec3) -> f32 {
        let Eliminated { pivots, left, .. } = self.eliminated(spin);
        let along = max(left.x.abs() - self.owed * length(spin), 0.0);
        let energy = across(left, pivots) + 0.5 * along * along / max(pivots.x, self.thin);
        if energy.is_finite() { energy } else { 0.0 }
    }

    /// By how much those who lie on a line are to be turned, so that it lies across their angular momentum: there is no other way to carry that. By no more
    /// than may be owed to them \[rad\].
    pub(super) fn aslant(&self, spin: Vec3) -> Option<Vec3> {
        let (line, axis) = (self.axes.x_axis, unit(spin));
        let by = clamp(dot(line, axis), -self.owed, self.owed);
        (self.eliminated(spin).pivots.x <= self.thin).then(|| axis.cross(line) * by)
    }

    /// The same where they are turned so.
    pub(super) fn turned(self, turn: Turn) -> Self {
        Self { axes: turn.matrix() * self.axes, ..self }
    }

    /// Eliminates the third axis and the second, about which there is most, before the first.
    fn eliminated(&self, spin: Vec3) -> Eliminated {
        let (moments, products, own) = (self.moments, self.products, in_frame(self.axes, spin));
        let [xz, yz] = [products.y / moments.z, products.x / moments.z];
        let second = moments.y - yz * products.x;
        let beside = products.z - yz * products.y;
        let xy = beside / second;
        let y = own.y - yz * own.z;
        Eliminated {
            pivots: Vec3::new(moments.x - xz * products.y - xy * beside, second, moments.z),
            left: Vec3::new(own.x - xz * own.z - xy * y, y, own.z),
            factors: [xy, xz, yz],
        }
    }
}

/// What elimination leaves of the moments of inertia, and of an angular momentum; and by what each axis goes into those before it.
struct Eliminated {
    pivots: Vec3,
    left: Vec3,
    factors: [f32; 3],
}

/// The energy of what elimination leaves about the second axis and the third \[J\].
fn across(left: Vec3, pivots: Vec3) -> f32 {
    0.5 * (left.y * left.y / pivots.y + left.z * left.z / pivots.z)
}

/// A vector by the axes of a frame.
fn in_frame(axes: Mat3, v: Vec3) -> Vec3 {
    Vec3::new(dot(axes.x_axis, v), dot(axes.y_axis, v), dot(axes.z_axis, v))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rng::Stream;

    /// However thin it is, and wherever it points: who turns so has the angular momentum that was asked for, and the energy that is told of that; with less
    /// energy than that takes, he has what there is. A line does not turn about itself.
    #[test]
    fn what_is_thin_turns_by_its_angular_momentum() {
        for serial in 0..2000 {
            let stream = Stream::new(3, 1, serial);
            let vector = |place| {
                let ([x, y], [z, _]) = (stream.units(place), stream.units(place + 1));
                Vec3::new(x, y, z) - 0.5
            };
            let thick = [0.0, 1e-5, 1e-2, 0.1, 1.0][serial as usize % 5];
            let size = [1e-4, 1.0, 1e4][serial as usize / 5 % 3];
            let along = unit(vector(0));
            let arms: [Vec3; 6] = core::array::from_fn(|i| {
                let far = [1.0, -1.0, 0.5, -0.5, 0.2, -0.2][i];
                (along * far + vector(4 + 2 * i as u32) * thick) * size
            });
            let of = |omega: Vec3| arms.iter().map(|&arm| arm.cross(omega.cross(arm))).sum::<Vec3>();
            let inertia = Inertia::of(arms.iter().map(|&arm| (1.0, arm)), arms[0], 0.0);
            let spin = of(vector(2));
            let (omega, turning) = inertia.turning(spin, f32::INFINITY);
            // Some tens of roundings; what a line cannot carry, which is as thin as that against what it is across; and as much as rounding of moments
            // turns the thin axis, which is turned about the faster the thinner it is.
            let (left, is_line) = (length(of(omega) - spin) / (size * size), thick < 1e-3);
            assert!(left < 3e-6 + if is_line { 1e-3 * thick } else { 3e-7 / thick }, "{serial}: {left:e} of {spin}");
            // Half of what both have in common, whose roundings are shared out alike.
            let energy = 0.5 * dot(omega, spin);
            assert!((turning / energy - 1.0).abs() < 1e-4, "{serial}: {turning}, not {energy}");
            assert!(inertia.energy(spin) < energy * (1.0 + 1e-4), "{serial}: {energy}");
            for share in [0.0, 0.3, 0.99] {
                let (omega, turning) = inertia.turning(spin, share * energy);
                let has = 0.5 * dot(omega, of(omega));
                assert!((turning / energy - share).abs() < 1e-4, "{serial}: {turning} of {energy}");
                assert!((has / energy - share).abs() < 1e-4, "{serial}: {has} of {energy}");
            }
            if is_line {
                assert!(dot(omega, along).abs() < 1e-3 * length(omega), "{serial}: {omega} about {along}");
            }
        }
    }
}
