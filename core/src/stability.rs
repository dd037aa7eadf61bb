//! Which steps a method takes without making an oscillation grow.
//!
//! All of it is linear: a system near rest falls apart into modes x'' = −ω² x − c x', and a method turns each mode's
//! (x, v) into M (x, v) by a matrix of two rows. A step is stable while no eigenvalue of M lies outside the unit circle
//! (Hairer, Nørsett, Wanner, "Solving Ordinary Differential Equations" I and II). A stable step is not yet an accurate one.

use crate::collide::{CHORD_ERROR, MAX_CHORDS};
use crate::force::Spring;
use crate::integrate::Method;
use crate::particles::Particle;
use libm::{fabs, log, log1p, sqrt};
use std::vec::Vec;

/// One oscillation: x'' = −ω² x − c x'.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Mode {
    /// ω² \[1/s²\].
    pub omega2: f64,
    /// c \[1/s\]; the damping ratio is c / 2ω.
    pub damping: f64,
}

/// The largest step that a method may take.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize), serde(rename_all = "snake_case"))]
pub enum Limit {
    /// Up to this \[s\].
    Step(f64),
    /// None: whatever the step, it grows, see [`Mode::growth_rate`].
    Never,
    /// Any.
    Unconditional,
}

/// The effect of a method on a linear system y' = A y in a step h.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Scheme {
    /// y becomes R(hA) y, R being the polynomial with these coefficients, that of the power 0 first: explicit Runge-Kutta.
    Polynomial(&'static [f64]),
    /// v += h a, then x += h v.
    Symplectic,
    /// Velocity Verlet, whose second evaluation is given v + h a.
    Verlet,
    /// (1 − hA) y' = y: implicit Euler.
    Implicit,
}

impl Method {
    /// Its effect on a linear system; for a method that chooses its own steps, the effect of each of those.
    #[must_use]
    pub const fn scheme(self) -> Scheme {
        match self {
            Self::Euler => Scheme::EULER,
            Self::Symplectic => Scheme::Symplectic,
            // The lecture's differs only where forces depend on time.
            Self::Midpoint | Self::LectureMidpoint => Scheme::MIDPOINT,
            Self::Verlet => Scheme::Verlet,
            Self::Rk4 | Self::Adaptive => Scheme::RK4,
            Self::Embedded => Scheme::RK3,
            Self::Implicit => Scheme::Implicit,
        }
    }
}

/// Growth within a step that rounding alone may show.
const GROWTH_ROUNDING: f64 = 1e-12;

/// A 2×2 matrix by rows.
type Matrix = [[f64; 2]; 2];

impl Scheme {
    /// Explicit Euler.
    pub const EULER: Self = Self::Polynomial(&[1.0, 1.0]);
    /// The midpoint method, and every other of two stages and order 2.
    pub const MIDPOINT: Self = Self::Polynomial(&[1.0, 1.0, 0.5]);
    /// Every method of three stages and order 3.
    pub const RK3: Self = Self::Polynomial(&[1.0, 1.0, 0.5, 1.0 / 6.0]);
    /// Every method of four stages and order 4.
    pub const RK4: Self = Self::Polynomial(&[1.0, 1.0, 0.5, 1.0 / 6.0, 1.0 / 24.0]);

    /// The matrix M by which a step `h` \[s\] multiplies (x, v) of a mode.
    #[must_use]
    pub fn amplification(self, mode: Mode, h: f64) -> [[f64; 2]; 2] {
        let [[a, b], [c, d]] = self.change(mode, h);
        [[1.0 + a, b], [c, 1.0 + d]]
    }

    /// |R(z)|, the factor by which a step multiplies a solution of y' = λy, for z = hλ = `re` + i `im`. None for methods
    /// that treat place and velocity differently, which have no such factor.
    #[must_use]
    pub fn factor(self, [re, im]: [f64; 2]) -> Option<f64> {
        match self {
            Self::Polynomial(coefficients) => {
                let horner = |[a, b]: [f64; 2], k: &f64| [a * re - b * im + k, a * im + b * re];
                let [a, b] = coefficients.iter().rev().fold([0.0; 2], horner);
                Some(sqrt(a * a + b * b))
            }
            Self::Implicit => Some(1.0 / sqrt((1.0 - re) * (1.0 - re) + im * im)),
            Self::Symplectic | Self::Verlet => None,
        }
    }

    /// The largest stable step for one mode, by bisection.
    ///
    /// A mode that grows by itself, or one without damping under a method that adds energy, has none.
    #[must_use]
    pub fn largest_step(self, mode: Mode) -> Limit {
        let Mode { omega2, damping } = mode;
        if !(omega2 >= 0.0 && damping >= 0.0) {
            return Limit::Never;
        }
        if self == Self::Implicit || (omega2 == 0.0 && damping == 0.0) {
            return Limit::Unconditional;
        }
        // The fastest of both rates of the mode is this at least and twice as much at the most.
        let rate = sqrt(omega2).max(damping);
        // An undamped one is stable at a tenth of its time or never.
        if damping == 0.0 && !self.is_stable(mode, 0.1 / rate) {
            return Limit::Never;
        }
        // No explicit method here stands eight times its fastest time.
        let (mut stable, mut grows) = (0.0, 16.0 / rate);
        for _ in 0..80 {
            let middle = 0.5 * (stable + grows);
            *(if self.is_stable(mode, middle) { &mut stable } else { &mut grows }) = middle;
        }
        Limit::Step(stable)
    }

    /// How fast a mode grows \[1/s\] when stepped by `h` \[s\]: ln ρ / h, ρ being the largest modulus of M's eigenvalues.
    /// Below zero it decays.
    #[must_use]
    pub fn growth_rate(self, mode: Mode, h: f64) -> f64 {
        let (half, det) = invariants(self.change(mode, h));
        let discriminant = half * half - det;
        if discriminant < 0.0 {
            return 0.5 * log1p(2.0 * half + det) / h;
        }
        let root = sqrt(discriminant);
        log(fabs(1.0 + half + root).max(fabs(1.0 + half - root))) / h
    }

    /// Jury's conditions for the polynomial of M = 1 + N, written in the trace and determinant of N, so that small steps
    /// keep their digits; up to rounding.
    fn is_stable(self, mode: Mode, h: f64) -> bool {
        const ROUNDING: f64 = 16.0 * f64::EPSILON;
        let n = self.change(mode, h);
        let (half, det) = invariants(n);
        let size = fabs(n[0][0]) + fabs(n[1][1]) + fabs(n[0][0] * n[1][1]) + fabs(n[0][1] * n[1][0]);
        let at_least = |value: f64, scale: f64| value >= -ROUNDING * scale;
        at_least(-(2.0 * half + det), size) && at_least(4.0 + 4.0 * half + det, 4.0 + 2.0 * size) && at_least(det, size)
    }

    /// N = M − 1.
    fn change(self, Mode { omega2: w, damping: c }: Mode, h: f64) -> Matrix {
        match self {
            Self::Polynomial(coefficients) => {
                let a = [[0.0, h], [-h * w, -h * c]];
                let (_, rest) = coefficients.split_first().unwrap_or((&1.0, &[]));
                let plus = |m: Matrix, k: f64| [[m[0][0] + k, m[0][1]], [m[1][0], m[1][1] + k]];
                rest.iter().rev().fold([[0.0; 2]; 2], |sum, &k| product(a, plus(sum, k)))
            }
            Self::Symplectic => [[-h * h * w, h * (1.0 - h * c)], [-h * w, -h * c]],
            Self::Verlet => {
                let (y2, d) = (h * h * w, h * c);
                [
                    [-0.5 * y2, h * (1.0 - 0.5 * d)],
                    [-h * w * (1.0 - 0.25 * y2 - 0.5 * d), -d + 0.5 * d * d - 0.5 * y2 + 0.25 * y2 * d],
                ]
            }
            Self::Implicit => {
                let det = 1.0 + h * c + h * h * w;
                [[-h * h * w / det, h / det], [-h * w / det, -(h * c + h * h * w) / det]]
            }
        }
    }
}

/// Half the trace, and the determinant.
fn invariants([[a, b], [c, d]]: Matrix) -> (f64, f64) {
    (0.5 * (a + d), a * d - b * c)
}

fn product(a: Matrix, b: Matrix) -> Matrix {
    let entry = |i: usize, j: usize| a[i][0] * b[0][j] + a[i][1] * b[1][j];
    [[entry(0, 0), entry(0, 1)], [entry(1, 0), entry(1, 1)]]
}

impl Mode {
    /// The largest stable step of a method; see [`Scheme::largest_step`].
    #[must_use]
    pub fn largest_step(self, method: Method) -> Limit {
        method.scheme().largest_step(self)
    }

    /// How fast it grows \[1/s\] when a method steps it by `h` \[s\]; see [`Scheme::growth_rate`].
    #[must_use]
    pub fn growth_rate(self, method: Method, h: f64) -> f64 {
        method.scheme().growth_rate(self, h)
    }

    /// The two rates λ of its solutions e^{λt} \[1/s\], each a real and an imaginary part.
    #[must_use]
    pub fn rates(self) -> [[f64; 2]; 2] {
        let half = 0.5 * self.damping;
        let discriminant = half * half - self.omega2;
        let root = sqrt(fabs(discriminant));
        if discriminant < 0.0 {
            return [[-half, root], [-half, -root]];
        }
        // The slow one as a quotient, since the difference would cancel.
        let fast = half + root;
        [[if fast > 0.0 { -self.omega2 / fast } else { 0.0 }, 0.0], [-fast, 0.0]]
    }
}

impl Limit {
    /// The stricter of two.
    #[must_use]
    pub fn and(self, other: Self) -> Self {
        match (self, other) {
            (Self::Never, _) | (_, Self::Never) => Self::Never,
            (Self::Unconditional, limit) | (limit, Self::Unconditional) => limit,
            (Self::Step(a), Self::Step(b)) => Self::Step(a.min(b)),
        }
    }

    /// Tells whether it admits a step \[s\].
    #[must_use]
    pub fn admits(self, step: f64) -> bool {
        match self {
            Self::Step(limit) => step <= limit,
            Self::Never => false,
            Self::Unconditional => true,
        }
    }
}

/// Bounds on the modes of a scene's springs, whichever way they are turned: sums at each free particle, no eigenvalues.
///
/// In coordinates scaled by the roots of the masses, the matrix of the stiffnesses has at particle i the row sum
/// Σ k (1/mᵢ + 1/√(mᵢ mⱼ)) over its springs at most, a fixed end counting as 1/mⱼ = 0, and no eigenvalue is larger than the
/// largest row sum (Gershgorin, 1931); so with the damping. For symplectic Euler that is a proof, also where springs are
/// damped unequally; for other methods the bound takes the worst mode that each particle's sums allow.
///
/// It holds for springs near their rest length. Under tension a spring also pulls across itself, undamped; see
/// [`Poses::growth_across`].
#[derive(Clone, Debug, Default)]
pub struct Poses {
    nodes: Vec<Node>,
}

/// The sums at one particle.
#[derive(Clone, Copy, Debug)]
struct Node {
    /// Σ k (1/mᵢ + 1/√(mᵢ mⱼ)) \[1/s²\].
    stiffness: f64,
    /// The same of the damping \[1/s\].
    damping: f64,
    /// The least and the largest kd/ks \[s\] among its springs.
    ratios: [f64; 2],
    /// Drag over mass \[1/s\].
    drag: f64,
}

impl Poses {
    /// Those of a scene's start; `drag` says whether linear drag acts.
    #[must_use]
    pub fn of(particles: &[Particle], springs: &[Spring], drag: bool) -> Self {
        let inverse = |p: &Particle| if p.fixed { 0.0 } else { 1.0 / f64::from(p.mass) };
        let node = |p: &Particle| {
            let drag = if drag { f64::from(p.drag) * inverse(p) } else { 0.0 };
            Node { stiffness: 0.0, damping: 0.0, ratios: [f64::INFINITY, 0.0], drag }
        };
        let mut nodes: Vec<_> = particles.iter().map(node).collect();
        for spring in springs {
            let [a, b] = spring.ends.map(|end| end as usize);
            let (Some(first), Some(second)) = (particles.get(a), particles.get(b)) else { continue };
            if a == b {
                continue;
            }
            let (first, second) = (inverse(first), inverse(second));
            let across = sqrt(first * second);
            nodes[a].add(spring, first + across);
            nodes[b].add(spring, second + across);
        }
        // A fixed particle has no row.
        let free = nodes.into_iter().zip(particles).filter(|(_, particle)| !particle.fixed);
        Self { nodes: free.map(|(node, _)| node).collect() }
    }

    /// The largest step of a method that is stable in every pose.
    #[must_use]
    pub fn largest_step(&self, method: Method) -> Limit {
        let modes = self.nodes.iter().flat_map(Node::modes);
        modes.fold(Limit::Unconditional, |least, mode| least.and(mode.largest_step(method)))
    }

    /// How fast an oscillation across a taut spring may grow \[1/s\], zero if it does not: nothing but drag damps it, and
    /// its stiffness is that of the springs times the share by which they are longer than at rest.
    ///
    /// Explicit Euler and the midpoint method make such oscillations grow at any step `h` \[s\].
    #[must_use]
    pub fn growth_across(&self, method: Method, h: f64) -> f64 {
        let across = self.nodes.iter().map(|node| Mode { omega2: node.stiffness, damping: node.drag });
        let growth = across.map(|mode| mode.growth_rate(method, h)).fold(0.0, f64::max);
        if growth * h > GROWTH_ROUNDING { growth } else { 0.0 }
    }

    /// The largest ω \[1/s\] of any mode in any pose.
    #[must_use]
    pub fn fastest(&self) -> f64 {
        sqrt(self.nodes.iter().fold(0.0, |most, node| node.stiffness.max(most)))
    }
}

impl Node {
    fn add(&mut self, spring: &Spring, inverse: f64) {
        let (ks, kd) = (f64::from(spring.ks), f64::from(spring.kd));
        // A spring that pushes away or adds energy bounds nothing, whatever else is there.
        self.stiffness += if ks >= 0.0 { ks * inverse } else { f64::NAN };
        self.damping += if kd >= 0.0 { kd * inverse } else { f64::NAN };
        if ks != 0.0 || kd != 0.0 {
            self.ratios = [self.ratios[0].min(kd / ks), self.ratios[1].max(kd / ks)];
        }
    }

    /// The corners of what its sums allow: as stiff as can be with the least and with the most damping, and as damped as
    /// can be with the least stiffness. They coincide where all springs are damped alike.
    fn modes(&self) -> [Mode; 3] {
        let Self { stiffness, damping, ratios: [least, most], drag } = *self;
        let mild = if stiffness > 0.0 { (stiffness * least).min(damping) } else { damping };
        let soft = if most > 0.0 { (damping / most).min(stiffness) } else { stiffness };
        [(stiffness, mild), (stiffness, damping), (soft, damping)]
            .map(|(omega2, damping)| Mode { omega2, damping: damping + drag })
    }
}

/// The longest step \[s\] in which a path bent by this acceleration \[m/s²\] is followed to its collisions with the
/// accuracy of a tenth of a millimetre: the chords it is followed along are bounded in number.
///
/// A chord of the n-th part of a step strays by a h² / 8n².
#[must_use]
pub fn longest_followed_step(acceleration: f64) -> f64 {
    f64::from(MAX_CHORDS) * sqrt(8.0 * f64::from(CHORD_ERROR) / acceleration)
}

#[cfg(test)]
mod tests;
