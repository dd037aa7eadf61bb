//! A sink: it pulls, and what touches it is gone.

use super::{Force, State};
use crate::math::sqrt;
use crate::shape::{Aabb, Collider, Hit, Hulls, Marks, Segment, Shape, Surface};
use core::ops::Range;
use glam::Vec3;

/// A surface that pulls every particle toward its nearest point, whatever the particle's mass, and that removes the
/// particles that touch it: f = intensity / (ca + la D + qa D²) d⃗ / D, d⃗ being the way to that point and D² = d² + s² with
/// the softening s.
///
/// It is left out of [`Force::add_jacobian`]: the pull grows toward the surface, which drives apart what is
/// displaced along it, and what it does to the side depends on how the surface is curved.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Sink<M> {
    /// Its surface.
    pub shape: Shape<M>,
    /// The group of a scene file whose transform applies to the surface; a `Model` has applied it.
    #[cfg_attr(feature = "serde", serde(default, skip_serializing_if = "Option::is_none"))]
    pub group: Option<u32>,
    /// Strength of the pull \[N, if `ca` has no unit\]; below zero it repels.
    pub intensity: f32,
    /// Constant term: it keeps the force finite at the surface.
    pub ca: f32,
    /// Linear term \[1/m\].
    pub la: f32,
    /// Quadratic term \[1/m²\].
    pub qa: f32,
    /// Softening length s \[m\]: within it the pull falls to zero at the surface, where it has no direction. Zero: it jumps
    /// there.
    #[cfg_attr(feature = "serde", serde(default))]
    pub softening: f32,
}

impl<M: Surface + Sync> Force for Sink<M> {
    fn is_local(&self) -> bool {
        true
    }

    // Apart on chips, so that its memory is off the stack while other forces of a tuple are asked.
    #[cfg_attr(one_by_one, inline(never))]
    fn add_to(&self, state: &State<'_>, rows: Range<usize>, total: &mut [Vec3]) {
        for (total, &x) in total.iter_mut().zip(&state.position[rows]) {
            let toward = self.shape.nearest(x) - x;
            let d = sqrt(toward.dot(toward) + self.softening * self.softening);
            let resistance = self.ca + d * (self.la + d * self.qa);
            // On the surface, if it is not softened, the pull has no direction.
            if d > 0.0 && resistance != 0.0 {
                *total += toward * (self.intensity / (resistance * d));
            }
        }
    }

    /// Zero at the surface.
    #[cfg(feature = "std")]
    fn energy(&self, state: &State<'_>) -> f64 {
        let square = |x: &Vec3| (self.shape.nearest(*x) - *x).to_array().map(|d| f64::from(d).powi(2)).iter().sum();
        state.position.iter().map(|x| self.potential(square(x))).sum()
    }

    #[cfg(feature = "std")]
    fn name(&self) -> &'static str {
        "sinks"
    }
}

impl<M: Collider> Collider for Sink<M> {
    fn moves(&self) -> bool {
        self.shape.moves()
    }

    fn first_hit(&self, segment: &Segment) -> Option<Hit> {
        self.shape.first_hit(segment)
    }

    fn may_touch(&self, bounds: &Aabb) -> bool {
        self.shape.may_touch(bounds)
    }

    fn mark_near(&self, hulls: &Hulls, marks: &mut Marks) {
        self.shape.mark_near(hulls, marks);
    }
}

#[cfg(feature = "std")]
impl<M> Sink<M> {
    /// The potential \[J\] at a squared distance. Softened, it is the pull's integral over D, since D dD = d dd.
    fn potential(&self, square: f64) -> f64 {
        let s = f64::from(self.softening).abs();
        self.work(s, libm::sqrt(square + s * s))
    }

    /// ∫ intensity / (ca + la s + qa s²) ds \[J\] from one distance to another, in closed form. Each part is a difference that
    /// is finite wherever the integral is, also where there is no constant term. Across a distance at which the denominator is zero it
    /// is the principal value, and there it is zero, as the pull is.
    fn work(&self, from: f64, to: f64) -> f64 {
        let [c, b, a] = [self.ca, self.la, self.qa].map(f64::from);
        if self.intensity == 0.0 || c + to * (b + to * a) == 0.0 {
            return 0.0;
        }
        let integral = if a == 0.0 && b == 0.0 {
            (to - from) / c
        } else if a == 0.0 {
            let growth = b * (to - from) / (c + b * from);
            let part = if growth > -1.0 { libm::log1p(growth) } else { libm::log(-1.0 - growth) };
            part / b
        } else {
            let discriminant = 4.0 * a * c - b * b;
            let slope = |s: f64| 2.0 * a * s + b;
            if discriminant > 0.0 {
                let root = libm::sqrt(discriminant);
                2.0 / root * (libm::atan(slope(to) / root) - libm::atan(slope(from) / root))
            } else if discriminant < 0.0 {
                let root = libm::sqrt(-discriminant);
                let part = |s: f64| libm::log(((slope(s) - root) / (slope(s) + root)).abs());
                (part(to) - part(from)) / root
            } else {
                2.0 / slope(from) - 2.0 / slope(to)
            }
        };
        f64::from(self.intensity) * integral
    }
}

#[cfg(all(test, feature = "std"))]
mod tests {
    use super::*;
    use crate::shape::{Mesh, Sphere};

    #[test]
    fn the_potential_is_the_integral_of_the_pull() {
        let terms = [(1.0, 0.5, 0.25), (1.0, 0.0, 0.0), (2.0, 0.5, 0.0), (1.0, 3.0, 0.5), (1.0, 2.0, 1.0)];
        // Without a constant term only what is softened has an energy at the surface.
        let bare = [(0.0, 0.0, 1.0), (0.0, 1.0, 0.0), (0.0, 1.0, 1.0)];
        for (ca, la, qa) in terms.into_iter().chain(bare) {
            let shape = Shape::<Mesh<'_>>::Sphere(Sphere { center: Vec3::ZERO, radius: 1.0 });
            for softening in [0.0f32, 0.25, 2.0].into_iter().filter(|&s| ca > 0.0 || s > 0.0) {
                let sink = Sink { shape: shape.clone(), group: None, intensity: 10.0, ca, la, qa, softening };
                let n = 100_000;
                let pull = |x: f64| {
                    let d = libm::hypot(x, f64::from(softening));
                    10.0 / (f64::from(ca) + f64::from(la) * d + f64::from(qa) * d * d) * x / d
                };
                let width = 3.0 / f64::from(n);
                let sum: f64 = (0..n).map(|i| pull((f64::from(i) + 0.5) * width) * width).sum();
                assert!((sink.potential(9.0) - sum).abs() < 1e-8 * (1.0 + sum), "{ca} {la} {qa}, {softening}");
            }
        }
    }

    #[test]
    fn the_potential_is_a_number_where_the_pull_is_none() {
        let sink = |intensity, ca, la, qa| {
            let shape = Shape::<Mesh<'_>>::Sphere(Sphere { center: Vec3::ZERO, radius: 1.0 });
            Sink { shape, group: None, intensity, ca, la, qa, softening: 0.0 }
        };
        for (intensity, ca, la, qa, square) in [
            (10.0, 0.0, 0.0, 0.0, 9.0),
            (0.0, 0.0, 0.0, 1.0, 9.0),
            (10.0, 0.0, 1.0, 0.0, 0.0),
            (10.0, 0.0, 0.0, 1.0, 0.0),
            // Where the denominator changes its sign.
            (10.0, 1.0, -1.0, 0.0, 1.0),
            (10.0, 1.0, 0.0, -1.0, 1.0),
        ] {
            assert_eq!(sink(intensity, ca, la, qa).potential(square), 0.0, "{intensity} {ca} {la} {qa}");
        }
        // On the far side of a pole differences are the integrals of the pull there, and both forms of them agree.
        let (linear, quadratic) = (sink(10.0, 1.0, -1.0, 0.0), sink(10.0, 1.0, -1.0, -1e-6));
        let far = |sink: &Sink<_>| sink.potential(9.0) - sink.potential(4.0);
        assert!((far(&linear) + 10.0 * libm::log(2.0)).abs() < 1e-12, "{}", far(&linear));
        assert!((linear.potential(9.0) - quadratic.potential(9.0)).abs() < 1e-3, "{}", quadratic.potential(9.0));
    }
}
