//! Lift and drag of surfaces in moving air.

use super::{Flow, Force, Perturbation, State};
use crate::math::{dot, length};
use core::ops::Range;
use glam::Vec3;

/// The air's push on the triangles of a surface, by the angle of attack α between the relative wind u and the triangle's plane:
/// F = ½ ρ A |u|² (C_D û + C_L l), with C_D = drag sin²α + friction cos²α, C_L = lift sin α cos α, and l upright on u, to the side to which
/// the wind presses the plane.
///
/// A flat plate has a drag of about 1.2 to 2, a friction of about 0.01, and as much lift as drag if the air presses it along its normal alone
/// (Hoerner, "Fluid-Dynamic Drag", 1965; with triangles Wejchert and Haumann, "Animation Aerodynamics", SIGGRAPH 1991, and Keckeisen,
/// Kimmerle, Thomaszewski and Wacker, "Modelling Effects of Wind Fields in Cloth Animations", WSCG 2004). Both sides are alike, and no
/// triangle is in the lee of another.
///
/// The wind is that at the triangle's middle, less the mean velocity of its corners, of which each bears a third. Still air takes
/// energy, and gives none. A triangle that has lost a corner is gone.
///
/// ```
/// use pointmass::force::{Aerodynamics, Gusts};
/// use pointmass::{Sheet, Vec3};
///
/// let sail = Sheet { corner: Vec3::ZERO, sides: [Vec3::X, Vec3::Y], cells: [8, 8] };
/// let breeze = Gusts { velocity: Vec3::Z * 6.0, amplitude: 0.4, frequency: 0.5 };
/// let air = Aerodynamics { friction: 0.01, ..Aerodynamics::still(sail.triangles().collect::<Vec<_>>()) };
/// let scene = pointmass::Scene { forces: &air.within(breeze), ..pointmass::Scene::EMPTY };
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Aerodynamics<T, F> {
    /// The triangles: particles by their place in the scene's start.
    pub triangles: T,
    /// How the air moves; a list is the sum of its flows.
    pub field: F,
    /// Density ρ of the air \[kg/m³\].
    #[cfg_attr(feature = "serde", serde(default = "usual_density"))]
    pub density: f32,
    /// The coefficient of drag of a plate across the wind.
    pub drag: f32,
    /// The coefficient of lift, at 45° twice what it lifts by.
    #[cfg_attr(feature = "serde", serde(default))]
    pub lift: f32,
    /// The coefficient of drag of a plate along the wind.
    #[cfg_attr(feature = "serde", serde(default))]
    pub friction: f32,
}

/// That of air at 20 °C \[kg/m³\].
const DENSITY: f32 = 1.2;

#[cfg(feature = "serde")]
const fn usual_density() -> f32 {
    DENSITY
}

impl<T> Aerodynamics<T, ()> {
    /// Triangles that are pressed along their normals, in still air of 1.2 kg/m³, with a coefficient of 1.2.
    #[must_use]
    pub const fn still(triangles: T) -> Self {
        Self { triangles, field: (), density: DENSITY, drag: 1.2, lift: 1.2, friction: 0.0 }
    }
}

impl<T, F> Aerodynamics<T, F> {
    /// The same in other air.
    #[must_use]
    pub fn within<G>(self, field: G) -> Aerodynamics<T, G> {
        let Self { triangles, density, drag, lift, friction, .. } = self;
        Aerodynamics { triangles, field, density, drag, lift, friction }
    }
}

/// A triangle in the wind.
struct Sail {
    rows: [usize; 3],
    /// The force on it \[N\], and ½ ρ A |u| (C_D + lift) \[kg/s\].
    force: Vec3,
    brake: f32,
}

impl<T: AsRef<[[u32; 3]]>, F: Flow> Aerodynamics<T, F> {
    /// Visits all triangles that have a corner in `rows`.
    fn each(&self, state: &State<'_>, rows: &Range<usize>, mut visit: impl FnMut(Sail)) {
        let steady = self.field.everywhere(state.time);
        for corners in self.triangles.as_ref() {
            let [Some(a), Some(b), Some(c)] = corners.map(|corner| state.springs.row(corner)) else { continue };
            if ![a, b, c].iter().any(|row| rows.contains(row)) {
                continue;
            }
            let [x, y, z] = [a, b, c].map(|row| state.position[row]);
            let air = steady.unwrap_or_else(|| self.field.velocity(x + ((y - x) + (z - x)) / 3.0, state.time));
            let own = (state.velocity[a] + state.velocity[b] + state.velocity[c]) / 3.0;
            let (force, brake) = self.push((y - x).cross(z - x), air - own);
            // A corner that is not finite goes at the end of the step, and goes alone.
            if force.is_finite() {
                visit(Sail { rows: [a, b, c], force, brake });
            }
        }
    }

    /// The force on a triangle, `double` being twice its area along its normal, and how it brakes.
    fn push(&self, double: Vec3, wind: Vec3) -> (Vec3, f32) {
        let (area, speed) = (length(double), length(wind));
        if !(area > 0.0 && speed > 0.0) {
            return (Vec3::ZERO, 0.0);
        }
        let (normal, along) = (double / area, wind / speed);
        let sine = dot(normal, along);
        let pressure = 0.25 * self.density * area * speed;
        let brake = pressure * (self.drag * (sine * sine) + self.friction * (1.0 - sine * sine));
        let lift = (normal - along * sine) * (pressure * self.lift * sine * speed);
        (wind * brake + lift, brake + pressure * self.lift.abs())
    }
}

impl<T: AsRef<[[u32; 3]]> + Sync, F: Flow> Force for Aerodynamics<T, F> {
    fn add_to(&self, state: &State<'_>, rows: Range<usize>, total: &mut [Vec3]) {
        self.each(state, &rows, |sail| {
            for row in sail.rows.into_iter().filter(|row| rows.contains(row)) {
                if let Some(total) = total.get_mut(row - rows.start) {
                    *total += sail.force / 3.0;
                }
            }
        });
    }

    /// The drag as if it grew with the speed alone. How lift and attack change is left out, since it may drive, and the most that lift grows by with the
    /// speed across is taken for drag: lift that is not damped so throws back what is light, at any angle, in steps of 4 m / ρ A |u| lift.
    fn add_jacobian(&self, state: &State<'_>, change: &Perturbation<'_>, total: &mut [Vec3]) {
        self.each(state, &(0..total.len()), |sail| {
            let sum = sail.rows.iter().fold(Vec3::ZERO, |sum, &row| sum + change.along[row]);
            for row in sail.rows {
                total[row] -= sum * (sail.brake * change.velocity / 9.0);
            }
        });
    }

    fn add_stiffness(&self, state: &State<'_>, [_, velocity]: [f32; 2], total: &mut [Vec3]) {
        self.each(state, &(0..total.len()), |sail| {
            for row in sail.rows {
                total[row] += Vec3::splat(sail.brake * velocity / 9.0);
            }
        });
    }

    #[cfg(feature = "std")]
    fn power(&self, state: &State<'_>) -> f64 {
        let mut sum = 0.0;
        self.each(state, &(0..state.position.len()), |sail| {
            let force = sail.force.to_array().map(f64::from);
            for row in sail.rows {
                let v = state.velocity[row].to_array().map(f64::from);
                sum += force.iter().zip(v).map(|(f, v)| f * v).sum::<f64>() / 3.0;
            }
        });
        sum
    }

    #[cfg(feature = "std")]
    fn name(&self) -> &'static str {
        "aerodynamics"
    }
}
