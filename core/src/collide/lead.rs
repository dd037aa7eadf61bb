//! Springs ask of a hit that it leave their method alone along the surface.
//!
//! After a hit a particle goes on along a parabola with the mean acceleration of its path, but for what the air brakes otherwise then. Under steady forces that is the motion. Of what
//! swings it is a method of its own, x' = x + h v + h² a / 2, v' = v + h a, whose determinant is 1 + (h ω)² / 2: whatever lies, slides or
//! bounces on a surface would gain energy in each step, in the directions along that, which the surface has no part in. So where there
//! are springs, a path keeps along the surface by how much its method led it beyond the parabola, and how fast it made it.

use super::path::Path;
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
    pub(super) of: fn(&Path, f32, Vec3) -> Option<Lead>,
    pub(super) beyond: fn(&Lead, &Path, Option<&[Vec3; 4]>) -> Vec3,
}

impl LeadCode {
    pub(crate) const ALL: Self = Self { of: Lead::of, beyond: Lead::beyond };
}

impl Lead {
    /// That of a path along the surface that it meets after a fraction of its time; none, where it is a parabola or lags behind one.
    fn of(path: &Path, s: f32, normal: Vec3) -> Option<Self> {
        let (excess, duration) = (path.excess(), path.duration());
        if is_zero(excess) || path.lags() {
            return None;
        }
        // Both cubics between the place of the hit and the end; the velocity of the one at the hit is its derivative.
        let (is_smooth, excess, left) = (path.is_smooth(excess), aside(excess, normal), 1.0 - s);
        if is_smooth {
            let acceleration = scaled(excess, -6.0 * s / (duration * duration));
            Some(Self { way: scaled(excess, left * left * left), acceleration })
        } else {
            Some(Self { way: scaled(excess, left * left * (1.0 + 2.0 * s)), acceleration: Vec3::ZERO })
        }
    }

    /// The end of a path that goes on as a parabola, led beyond it. If it slides along the surface, its drive there and its velocities at the
    /// beginning and the end say how much of the lead friction leaves.
    fn beyond(&self, onward: &Path, slides: Option<&[Vec3; 4]>) -> Vec3 {
        let end = onward.x1;
        let Some(&[drive, _, slip, last]) = slides else { return plus(end, self.way) };
        let (free, braked) = (scaled(drive, onward.duration()), minus(last, slip));
        let square = dot(free, free);
        if is_zero(braked) || !(square > 0.0) {
            return end;
        }
        plus(end, along(self.way, minus(braked, free), dot(self.way, free) / square))
    }
}
