//! Balls that push each other apart.

#[cfg(feature = "std")]
use super::near::sum_of_pairs;
use super::near::{add_up, in_order};
use super::{Force, Friction, Needs, Perturbation, State, Telling, Watched};
use crate::math::{length, max, min, sqrt};
use core::ops::Range;
use glam::Vec3;

/// Balls that overlap push each other apart by a spring and a dashpot: f = max(k δ − c ḋ, 0) along the line of centres,
/// with the overlap δ, the speed ḋ at which they part, and c = 2 ζ √(k m), m = m₁ m₂ / (m₁ + m₂). The push never becomes a
/// pull. Across that line friction brakes the slip, at most by its sliding share of the push.
///
/// A hit lasts about π √(m / k); steps should be a tenth of that and less. Two balls whose closing speed is v sink v √(m / k)
/// into each other: what goes farther than their radii in one step passes unhindered. Cundall and Strack, "A discrete
/// numerical model for granular assemblies", Géotechnique 29, 1979.
///
/// [`Observer`](crate::Observer)s are told of two that overlap at the end of a sub-step and did not at its beginning
/// ([`touched`](crate::Observer::touched)), so of each hit once, as it begins. What has bounced off within a sub-step, of a method that divides it, is not seen.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Penalty {
    /// k \[N/m\].
    pub stiffness: f32,
    /// ζ: zero bounces fully, 0.1 gives back 0.744 of the speed, 1 almost nothing.
    #[cfg_attr(feature = "serde", serde(default))]
    pub damping: f32,
    /// The friction between any two; what rests creeps, as there is no spring across.
    #[cfg_attr(feature = "serde", serde(default))]
    pub friction: Friction,
    /// The largest sum of two radii \[m\]; zero in a file: that of the scene.
    #[cfg_attr(feature = "serde", serde(default))]
    pub reach: f32,
}

/// Two balls that overlap.
struct Touch {
    /// From the other to this one.
    normal: Vec3,
    /// δ \[m\].
    overlap: f32,
    /// 2 √(k m), what would just not let it swing \[kg/s\].
    critical: f32,
    /// How this one moves against the other.
    relative: Vec3,
}

impl Penalty {
    /// Nothing.
    pub const NONE: Self = Self { stiffness: 0.0, damping: 0.0, friction: Friction::NONE, reach: 0.0 };

    /// The same with this reach, if it has none.
    #[must_use]
    pub fn reaching(self, reach: f32) -> Self {
        Self { reach: if self.reach > 0.0 { self.reach } else { reach }, ..self }
    }

    fn touch(&self, state: &State<'_>, [row, other]: [usize; 2]) -> Option<Touch> {
        let d = state.between(other, row);
        let distance = length(d);
        let overlap = state.radius[row] + state.radius[other] - distance;
        if !(overlap > 0.0) {
            return None;
        }
        // The one with the higher row goes up if two are in one place.
        let upward = if row > other { Vec3::Y } else { Vec3::NEG_Y };
        let normal = if distance > 0.0 { d / distance } else { upward };
        let (a, b) = (state.mass[row], state.mass[other]);
        let (light, heavy) = (min(a, b), max(a, b));
        // A fixed particle counts by the mass it has, and may have none.
        // The lighter one first: both see the same bits, and an infinite mass is as good as a wall.
        let reduced = if light > 0.0 { light / (light / heavy + 1.0) } else { heavy };
        let critical = 2.0 * sqrt(self.stiffness * reduced);
        Some(Touch { normal, overlap, critical, relative: state.velocity[row] - state.velocity[other] })
    }

    /// The push along the normal and the friction across it \[N\].
    fn answer(&self, touch: &Touch) -> (f32, Vec3) {
        let parting = touch.relative.dot(touch.normal);
        let push = max(self.stiffness * touch.overlap - self.damping * touch.critical * parting, 0.0);
        let slip = touch.relative - touch.normal * parting;
        let speed = length(slip);
        if !(speed > 0.0 && self.friction.kinetic > 0.0) {
            return (push, Vec3::ZERO);
        }
        // A slow slip meets a dashpot across instead, so that friction never drives.
        (push, slip * (-min(self.friction.kinetic * push / speed, touch.critical)))
    }
}

impl Force for Penalty {
    fn add_to(&self, state: &State<'_>, rows: Range<usize>, total: &mut [Vec3]) {
        add_up(state, self.reach, rows, total, |row, other| match self.touch(state, [row, other]) {
            Some(touch) => {
                let (push, friction) = self.answer(&touch);
                touch.normal * push + friction
            }
            None => Vec3::ZERO,
        });
    }

    fn needs(&self) -> Needs {
        let tell = (self.stiffness > 0.0).then_some(Telling::TOUCHES);
        Needs { tell, ..Needs::within(self.reach) }
    }

    fn tell(&self, watched: &mut Watched<'_>) {
        let Watched { before, now, .. } = *watched;
        let begins = |rows| self.touch(&now, rows).is_some() && self.touch(&before, rows).is_none();
        in_order(&now, self.reach, begins, |rows| {
            if let Some(touch) = self.touch(&now, rows) {
                watched.tell_pair(rows, touch.normal);
            }
        });
    }

    /// Along the line of centres; how the line turns, and friction, are left out.
    fn add_jacobian(&self, state: &State<'_>, change: &Perturbation<'_>, total: &mut [Vec3]) {
        let all = 0..total.len();
        add_up(state, self.reach, all, total, |row, other| {
            let Some(touch) = self.touch(state, [row, other]) else { return Vec3::ZERO };
            let along = (change.along[row] - change.along[other]).dot(touch.normal);
            let slope = self.stiffness * change.position + self.damping * touch.critical * change.velocity;
            if self.answer(&touch).0 > 0.0 { touch.normal * (-slope * along) } else { Vec3::ZERO }
        });
    }

    fn add_stiffness(&self, state: &State<'_>, [position, velocity]: [f32; 2], total: &mut [Vec3]) {
        let all = 0..total.len();
        add_up(state, self.reach, all, total, |row, other| match self.touch(state, [row, other]) {
            Some(touch) if self.answer(&touch).0 > 0.0 => {
                touch.normal * touch.normal * (self.stiffness * position + self.damping * touch.critical * velocity)
            }
            _ => Vec3::ZERO,
        });
    }

    #[cfg(feature = "std")]
    fn energy(&self, state: &State<'_>) -> f64 {
        sum_of_pairs(state, self.reach, |row, other| {
            let overlap = self.touch(state, [row, other]).map_or(0.0, |touch| f64::from(touch.overlap));
            0.5 * f64::from(self.stiffness) * overlap * overlap
        })
    }

    #[cfg(feature = "std")]
    fn power(&self, state: &State<'_>) -> f64 {
        sum_of_pairs(state, self.reach, |row, other| {
            let Some(touch) = self.touch(state, [row, other]) else { return 0.0 };
            let (push, friction) = self.answer(&touch);
            let parting = f64::from(touch.relative.dot(touch.normal));
            (f64::from(push) - f64::from(self.stiffness) * f64::from(touch.overlap)) * parting
                + f64::from(friction.dot(touch.relative))
        })
    }

    #[cfg(feature = "std")]
    fn name(&self) -> &'static str {
        "penalty"
    }
}
