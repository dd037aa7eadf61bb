//! Gas in a closed mesh.

use super::{Force, Perturbation, State};
use crate::math::{length, max, sqrt};
use core::ops::Range;
use glam::Vec3;

/// Gas that keeps its temperature in a closed mesh of particles: p = n R T / V − outside, which acts as p A n̂ / 3 on each
/// corner of every triangle, V being the volume inside.
///
/// All forces together are zero, and they are the slope of the energy −n R T ln V + outside V. A triangle that has lost
/// a corner is gone, and the gas acts on what is left as if cones to its middle closed the hole. A mesh that has
/// collapsed or turned inside out, with less than a thousandth of the volume of a ball of its surface, feels nothing.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Pressure<T> {
    /// The triangles: particles by their place in the scene's start, seen from outside anticlockwise.
    pub triangles: T,
    /// How much gas there is: n R T \[J\], which is pressure times volume.
    pub amount: f32,
    /// The pressure outside \[Pa\].
    #[cfg_attr(feature = "serde", serde(default))]
    pub outside: f32,
}

/// The measures of the mesh as it is now.
struct Inside {
    /// The middle of its triangles: places are taken from here, so that far from the origin nothing is lost.
    #[cfg(feature = "std")]
    middle: Vec3,
    /// Its volume \[m³\].
    volume: f32,
}

impl<T: AsRef<[[u32; 3]]>> Pressure<T> {
    /// The rows and places of the corners of each triangle whose corners all live, in the order of the triangles.
    fn living<'a>(&'a self, state: &'a State<'_>) -> impl Iterator<Item = ([usize; 3], [Vec3; 3])> + 'a {
        self.triangles.as_ref().iter().filter_map(|corners| {
            let [a, b, c] = corners.map(|corner| state.springs.row(corner));
            let rows = [a?, b?, c?];
            let places = rows.map(|row| state.position[row]);
            // A corner that is not finite goes at the end of the step, and goes alone.
            places.iter().all(|place| place.is_finite()).then_some((rows, places))
        })
    }

    /// None if it has collapsed.
    fn inside(&self, state: &State<'_>) -> Option<Inside> {
        let origin = self.living(state).next()?.1[0];
        let (mut sum, mut count) = (Vec3::ZERO, 0.0);
        for (_, places) in self.living(state) {
            sum += places.iter().fold(Vec3::ZERO, |sum, &place| sum + (place - origin));
            count += 3.0;
        }
        let middle = origin + sum / count;
        let (mut volume, mut area) = (0.0, 0.0);
        for (_, places) in self.living(state) {
            let [a, b, c] = places.map(|place| place - middle);
            volume += a.dot(b.cross(c));
            area += length((b - a).cross(c - a));
        }
        let (volume, area) = (volume / 6.0, area / 2.0);
        // A ball has V = A^{3/2} / 6√π, which is 0.094 A^{3/2}.
        (volume > 1e-4 * area * sqrt(area)).then_some(Inside {
            #[cfg(feature = "std")]
            middle,
            volume,
        })
    }

    /// Adds to the corners in `rows` the slope of the volume \[m²\], times `factor`.
    fn add_slope(&self, state: &State<'_>, rows: Range<usize>, factor: f32, total: &mut [Vec3]) {
        for (corners, places) in self.living(state) {
            let share = third_of_area(places) * factor;
            for row in corners.into_iter().filter(|row| rows.contains(row)) {
                if let Some(total) = total.get_mut(row - rows.start) {
                    *total += share;
                }
            }
        }
    }
}

/// A third of a triangle's area, along its normal.
fn third_of_area([a, b, c]: [Vec3; 3]) -> Vec3 {
    (b - a).cross(c - a) / 6.0
}

impl<T: AsRef<[[u32; 3]]> + Sync> Force for Pressure<T> {
    fn add_to(&self, state: &State<'_>, rows: Range<usize>, total: &mut [Vec3]) {
        let Some(inside) = self.inside(state) else { return };
        let factor = self.amount / inside.volume - self.outside;
        if factor.abs() < f32::INFINITY {
            self.add_slope(state, rows, factor, total);
        }
    }

    /// The resistance of the gas to being pressed: −n R T / V² times how much the volume changes. The turning of
    /// triangles is left out, since it may drive apart what is displaced.
    fn add_jacobian(&self, state: &State<'_>, change: &Perturbation<'_>, total: &mut [Vec3]) {
        let Some(inside) = self.inside(state) else { return };
        let mut grown = 0.0;
        for (corners, places) in self.living(state) {
            let moved = corners.iter().fold(Vec3::ZERO, |sum, &row| sum + change.along[row]);
            grown += third_of_area(places).dot(moved);
        }
        let factor = -max(self.amount, 0.0) / inside.volume * (grown / inside.volume) * change.position;
        if factor.abs() < f32::INFINITY {
            self.add_slope(state, 0..total.len(), factor, total);
        }
    }

    /// As if the six triangles at a corner lay in a plane.
    fn add_stiffness(&self, state: &State<'_>, [position, _]: [f32; 2], total: &mut [Vec3]) {
        let Some(inside) = self.inside(state) else { return };
        let factor = 6.0 * max(self.amount, 0.0) / inside.volume / inside.volume * position;
        for (corners, places) in self.living(state) {
            let share = third_of_area(places);
            for row in corners {
                if let Some(total) = total.get_mut(row) {
                    *total += share * share * factor;
                }
            }
        }
    }

    /// Zero at 1 m³ and no pressure outside; a mesh that has collapsed has none.
    #[cfg(feature = "std")]
    fn energy(&self, state: &State<'_>) -> f64 {
        let Some(inside) = self.inside(state) else { return 0.0 };
        let wide = |v: Vec3| v.to_array().map(f64::from);
        let middle = wide(inside.middle);
        let mut volume = 0.0;
        for (_, places) in self.living(state) {
            let [a, b, c] = places.map(|place| core::array::from_fn::<f64, 3, _>(|i| wide(place)[i] - middle[i]));
            let cross: [f64; 3] = core::array::from_fn(|i| {
                let (j, k) = ((i + 1) % 3, (i + 2) % 3);
                b[j] * c[k] - b[k] * c[j]
            });
            volume += a.iter().zip(cross).map(|(a, b)| a * b).sum::<f64>() / 6.0;
        }
        f64::from(self.outside) * volume - f64::from(self.amount) * libm::log(volume)
    }

    #[cfg(feature = "std")]
    fn name(&self) -> &'static str {
        "pressure"
    }
}
