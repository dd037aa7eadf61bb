//! What springs ask of a hit: along the surface it leaves their method alone.
//!
//! After a hit a particle goes on along a parabola with the mean acceleration of its path. Under steady forces that is the motion. Of what
//! swings it is a method of its own, x' = x + h v + h² a / 2, v' = v + h a, whose determinant is 1 + (h ω)² / 2: whatever lies, slides or
//! bounces on a surface would gain energy in each step, in the directions along that, which the surface has no part in. So where there
//! are springs, a path keeps along the surface by how much its method led it beyond the parabola, and how fast it made it.

use crate::math::{along, aside, dot, is_zero, minus, plus, scaled};
use glam::Vec3;

/// By how much a method leads a particle beyond a parabola along a surface, in the rest of a path that has met that.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Lead {
    /// How far \[m\].
    way: Vec3,
    /// The acceleration in the rest beyond the mean of the whole path \[m/s²\].
    pub(super) acceleration: Vec3,
}

/// The functions that find it and use it: a program without springs does not carry them about.
#[derive(Clone, Copy, Debug)]
pub(crate) struct LeadCode {
    pub(super) of: fn(&Departure, f32, Vec3) -> Option<Lead>,
    pub(super) beyond: fn(&Lead, Vec3, Option<[Vec3; 2]>) -> Vec3,
}

/// How a path differs from a parabola.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Departure {
    /// How much farther it leads \[m\].
    pub(super) excess: Vec3,
    /// Half the change of velocity as a way \[m\].
    pub(super) bend: Vec3,
    /// How long it takes \[s\].
    pub(super) duration: f32,
}

impl LeadCode {
    pub(crate) const ALL: Self = Self { of: Lead::of, beyond: Lead::beyond };
}

impl Departure {
    /// Tells whether the cubic bends as the motion does: its derivative is the velocity.
    #[cfg_attr(target_os = "none", inline(never))]
    pub(super) fn is_smooth(&self) -> bool {
        let Self { excess, bend, .. } = *self;
        !is_zero(excess) && dot(excess, excess) < 0.0625 * dot(bend, bend)
    }

    /// Tells whether its end shows nothing yet of what its velocity has taken in, as with the explicit Euler method.
    pub(super) fn lags(&self) -> bool {
        dot(self.excess, self.bend) < -0.5 * dot(self.bend, self.bend)
    }
}

impl Lead {
    /// That of a path along the surface that it meets after a fraction of its time; none, where it is a parabola or lags behind one.
    fn of(path: &Departure, s: f32, normal: Vec3) -> Option<Self> {
        let Departure { excess, duration, .. } = *path;
        if is_zero(excess) || path.lags() {
            return None;
        }
        // Both cubics between the place of the hit and the end; the velocity of the one at the hit is its derivative.
        let (excess, left) = (aside(excess, normal), 1.0 - s);
        if path.is_smooth() {
            let acceleration = scaled(excess, -6.0 * s / (duration * duration));
            Some(Self { way: scaled(excess, left * left * left), acceleration })
        } else {
            Some(Self { way: scaled(excess, left * left * (1.0 + 2.0 * s)), acceleration: Vec3::ZERO })
        }
    }

    /// The end of a parabola, led beyond it. If it slides, the changes of its velocity without and with friction say how much of the lead
    /// friction leaves.
    fn beyond(&self, end: Vec3, slides: Option<[Vec3; 2]>) -> Vec3 {
        let Some([free, braked]) = slides else { return plus(end, self.way) };
        let square = dot(free, free);
        if is_zero(braked) || !(square > 0.0) {
            return end;
        }
        plus(end, along(self.way, minus(braked, free), dot(self.way, free) / square))
    }
}
