//! How hard particles are to turn about their middle.

use super::turn::Turn;
use crate::math::{dot, frame, max, unit};
use glam::{Mat3, Vec3};

/// The least moment about the first axis, a share of all: what turns faster about that with some angular momentum loses it in rounding of how its ends
/// then move.
const THIN: f32 = 1e-6;

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
}

impl Inertia {
    /// That of masses and the ways to them from their middle, of which one of the longest is given. `coarse` is the moment that rounding of their places
    /// may show of a line \[kg m²\].
    pub(super) fn of(all: impl Iterator<Item = (f32, Vec3)>, longest: Vec3, coarse: f32) -> Self {
        let along = unit(longest);
        let (second, third) = frame(along);
        let axes = Mat3::from_cols(along, second, third);
        let (mut squares, mut products) = (Vec3::ZERO, Vec3::ZERO);
        for (mass, arm) in all {
            let own = in_frame(axes, arm);
            squares += own * own * mass;
            products -= Vec3::new(own.y * own.z, own.z * own.x, own.x * own.y) * mass;
        }
        let Vec3 { x, y, z } = squares;
        Self { axes, moments: Vec3::new(y + z, z + x, x + y), products, thin: THIN * (x + y + z) + coarse }
    }

    /// How fast they turn where they have so much angular momentum \[rad/s\]: not about a line on which all lie.
    pub(super) fn turning(&self, spin: Vec3) -> Vec3 {
        let Eliminated { pivots, left, factors: [xy, xz, yz] } = self.eliminated(spin);
        let Vec3 { x, y, z } = left / pivots;
        let x = if pivots.x > self.thin { x } else { 0.0 };
        let y = y - xy * x;
        let omega = self.axes * Vec3::new(x, y, z - xz * x - yz * y);
        if omega.is_finite() { omega } else { Vec3::ZERO }
    }

    /// The energy of that \[J\]. To turn about a line takes what it takes about the thickest thing that is no more than a line.
    pub(super) fn energy(&self, spin: Vec3) -> f32 {
        let Eliminated { pivots, left, .. } = self.eliminated(spin);
        let energy = 0.5 * dot(left, left / pivots.with_x(max(pivots.x, self.thin)));
        if energy.is_finite() { energy } else { 0.0 }
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

/// A vector by the axes of a frame.
fn in_frame(axes: Mat3, v: Vec3) -> Vec3 {
    Vec3::new(dot(axes.x_axis, v), dot(axes.y_axis, v), dot(axes.z_axis, v))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::length;
    use crate::rng::Stream;

    /// However thin it is, and wherever it points: who turns so has the angular momentum that was asked for, and its energy is half of what both have in
    /// common. A line does not turn about itself.
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
            let omega = inertia.turning(spin);
            let left = length(of(omega) - spin) / (size * size);
            let is_line = thick < 1e-3;
            assert!(left < 3e-6 + if is_line { 1e-3 * thick } else { 3e-7 / thick }, "{serial}: {left:e} of {spin}");
            let energy = 0.5 * dot(omega, spin);
            assert!((inertia.energy(spin) / energy - 1.0).abs() < 1e-4, "{serial}: {energy}");
            if is_line {
                assert!(dot(omega, along).abs() < 1e-3 * length(omega), "{serial}: {omega} about {along}");
            }
        }
    }
}
