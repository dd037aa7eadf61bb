//! Drag of what is long and thin in moving air: hair, wires, ropes.

use super::{Flow, Force, Perturbation, State};
use crate::math::{dot, length, sqrt};
use core::ops::Range;
use glam::Vec3;

/// The air's push on the segments of a chain, each a round cylinder, by the angle of attack: across and along a segment the wind acts as if the
/// other part of it were not there (the cross-flow principle: Hoerner, "Fluid-Dynamic Drag", 1965; Taylor, "Analysis of the swimming of long
/// and narrow animals", Proc. R. Soc. A 214, 1952).
///
/// A segment of length l and diameter d feels ½ ρ d l C_D |u_n| u_n across itself, where u_n is that part of the relative wind. C_D is the
/// coefficient of a long cylinder at its Reynolds number Re = ρ d |u_n| / μ: Re C_D = 3.4 + 5.8 √Re / (1 + 0.04 Re) + 1.2 Re (1 − 0.42 / (x +
/// 1/x)), x = Re / 2000. That is within 8 % of the theory of slow flow (Kaplun, J. Math. Mech. 6, 1957) from Re 0.01 to 0.3, of computed flows
/// (Dennis and Chang, J. Fluid Mech. 42, 1970; Park, Kwon and Choi, KSME Int. J. 12, 1998) up to 160, and of measured ones (Wieselsberger, Phys.
/// Z. 22, 1921) from there to 10⁵; beyond 2·10⁵, where drag falls to a third, it is too large. Far below 0.01 drag becomes linear in the wind, as that
/// of a rod of finite length is: so much as of one 700 times as long as thick.
///
/// Along itself it feels 0.85 μ l u_t + ½ ρ π d l C_f |u_t| u_t. The first is half of what slow flow does across, as resistive-force theory
/// has it of slender rods (Cox, J. Fluid Mech. 44, 1970): such a rod sinks upright twice as fast as level. The second is the friction of fast flow;
/// C_f is 0.003 to 0.01 of what is smooth, 0.02 of ropes.
///
/// Hair of 80 µm in a breeze of 1 m/s has a Reynolds number of 5: it feels six times as much for the speed as in the slowest one. The number of
/// segments does not matter. No segment is in the lee of another, and there is no lift but the one that comes of the angle.
///
/// Half of a segment goes with each of its ends: the wind is that at the end, less the end's velocity, and the end bears the half's force.
/// Still air takes energy from every motion, and gives none. A segment that has lost an end is gone. Explicit methods need steps
/// shorter than 2 m / k, m being a particle's mass and k how much the force on a segment grows with its speed: 0.047 s for hair in a breeze of
/// 1 m/s. The implicit one takes any.
///
/// ```
/// use pointmass::force::{CylinderDrag, Gusts};
/// use pointmass::Vec3;
///
/// // A strand of ten points, of hair.
/// let segments: Vec<[u32; 2]> = (0..9).map(|i| [i, i + 1]).collect();
/// let breeze = Gusts { velocity: Vec3::X * 2.0, amplitude: 0.4, frequency: 0.5 };
/// let air = CylinderDrag::still(segments, 8e-5).within(breeze);
/// let scene = pointmass::Scene { forces: &air, ..pointmass::Scene::EMPTY };
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct CylinderDrag<S, F> {
    /// The segments: the particles at both ends, by their place in the scene's start.
    pub segments: S,
    /// How the air moves; a list is the sum of its flows.
    pub field: F,
    /// How thick they are \[m\].
    pub diameter: f32,
    /// Density ρ of the air \[kg/m³\].
    #[cfg_attr(feature = "serde", serde(default = "usual_density"))]
    pub density: f32,
    /// Dynamic viscosity μ of the air \[Pa s\].
    #[cfg_attr(feature = "serde", serde(default = "usual_viscosity"))]
    pub viscosity: f32,
    /// The coefficient of friction C_f of fast flow along them.
    #[cfg_attr(feature = "serde", serde(default = "usual_friction"))]
    pub friction: f32,
}

/// Those of air at 20 °C \[kg/m³, Pa s\], and of a smooth cylinder.
const DENSITY: f32 = 1.2;
const VISCOSITY: f32 = 1.81e-5;
const FRICTION: f32 = 0.005;

#[cfg(feature = "serde")]
const fn usual_density() -> f32 {
    DENSITY
}

#[cfg(feature = "serde")]
const fn usual_viscosity() -> f32 {
    VISCOSITY
}

#[cfg(feature = "serde")]
const fn usual_friction() -> f32 {
    FRICTION
}

impl<S> CylinderDrag<S, ()> {
    /// Smooth segments of a diameter \[m\] in still air of 20 °C.
    #[must_use]
    pub const fn still(segments: S, diameter: f32) -> Self {
        Self { segments, field: (), diameter, density: DENSITY, viscosity: VISCOSITY, friction: FRICTION }
    }
}

impl<S, F> CylinderDrag<S, F> {
    /// The same in other air.
    #[must_use]
    pub fn within<G>(self, field: G) -> CylinderDrag<S, G> {
        let Self { segments, diameter, density, viscosity, friction, .. } = self;
        CylinderDrag { segments, field, diameter, density, viscosity, friction }
    }

    /// What each metre across a wind of some speed \[m/s\] feels for its speed \[kg/(m s)\]: ½ μ Re C_D.
    #[must_use]
    pub fn across(&self, speed: f32) -> f32 {
        let viscosity = self.viscosity;
        // μ Re, so that air without viscosity is no exception.
        let flow = self.density * self.diameter * speed;
        if !(flow > 0.0) {
            return 1.7 * viscosity;
        }
        let reynolds = flow / viscosity;
        let dip = reynolds / 2000.0;
        let laminar = 5.8 * sqrt(viscosity) * sqrt(flow) / (1.0 + 0.04 * reynolds);
        0.5 * (3.4 * viscosity + laminar + 1.2 * flow * (1.0 - 0.42 / (dip + 1.0 / dip)))
    }

    /// What each metre along a wind feels for its speed \[kg/(m s)\].
    fn along(&self, speed: f32) -> f32 {
        const HALF_PI: f32 = core::f32::consts::FRAC_PI_2;
        0.85 * self.viscosity + HALF_PI * self.density * self.diameter * self.friction * speed
    }
}

/// Half of a segment in the wind: the half at one of its ends.
struct Half {
    row: usize,
    /// The force on it \[N\].
    force: Vec3,
    /// The segment's direction, and what the half feels across and along it for the wind's speed \[kg/s\].
    direction: Vec3,
    brakes: [f32; 2],
}

impl Half {
    /// What it feels in a wind.
    fn feel(&self, wind: Vec3) -> Vec3 {
        let along = self.direction * dot(self.direction, wind);
        (wind - along) * self.brakes[0] + along * self.brakes[1]
    }
}

impl<S: AsRef<[[u32; 2]]>, F: Flow> CylinderDrag<S, F> {
    /// Visits the halves of all segments whose end is in `rows`.
    fn each(&self, state: &State<'_>, rows: &Range<usize>, mut visit: impl FnMut(Half)) {
        let steady = self.field.everywhere(state.time);
        for ends in self.segments.as_ref() {
            let [Some(a), Some(b)] = ends.map(|end| state.springs.row(end)) else { continue };
            if !rows.contains(&a) && !rows.contains(&b) {
                continue;
            }
            let way = state.position[b] - state.position[a];
            let far = length(way);
            let direction = way / far;
            if !(far > 0.0 && direction.is_finite()) {
                continue;
            }
            for row in [a, b].into_iter().filter(|row| rows.contains(row)) {
                let air = steady.unwrap_or_else(|| self.field.velocity(state.position[row], state.time));
                let wind = air - state.velocity[row];
                let along = dot(direction, wind);
                let brakes = [self.across(length(wind - direction * along)), self.along(along.abs())];
                let mut half =
                    Half { row, force: Vec3::ZERO, direction, brakes: brakes.map(|brake| brake * (0.5 * far)) };
                half.force = half.feel(wind);
                // An end that is not finite goes at the end of the step, and goes alone.
                if half.force.is_finite() {
                    visit(half);
                }
            }
        }
    }
}

impl<S: AsRef<[[u32; 2]]> + Sync, F: Flow> Force for CylinderDrag<S, F> {
    fn add_to(&self, state: &State<'_>, rows: Range<usize>, total: &mut [Vec3]) {
        self.each(state, &rows, |half| {
            if let Some(total) = total.get_mut(half.row - rows.start) {
                *total += half.force;
            }
        });
    }

    /// The drag as if it grew with the speed alone. How directions and attack change is left out, since it may drive.
    fn add_jacobian(&self, state: &State<'_>, change: &Perturbation<'_>, total: &mut [Vec3]) {
        self.each(state, &(0..total.len()), |half| {
            total[half.row] -= half.feel(change.along[half.row] * change.velocity);
        });
    }

    fn add_stiffness(&self, state: &State<'_>, [_, velocity]: [f32; 2], total: &mut [Vec3]) {
        self.each(state, &(0..total.len()), |half| {
            let (along, [across, lengthways]) = (half.direction * half.direction, half.brakes);
            total[half.row] += ((Vec3::ONE - along) * across + along * lengthways) * velocity;
        });
    }

    #[cfg(feature = "std")]
    fn power(&self, state: &State<'_>) -> f64 {
        let mut sum = 0.0;
        self.each(state, &(0..state.position.len()), |half| {
            let [force, velocity] = [half.force, state.velocity[half.row]].map(|v| v.to_array().map(f64::from));
            sum += force.iter().zip(velocity).map(|(f, v)| f * v).sum::<f64>();
        });
        sum
    }

    #[cfg(feature = "std")]
    fn name(&self) -> &'static str {
        "cylinder drag"
    }
}
