//! The longest step in which a hit of two balls that push each other apart adds no energy.
//!
//! A contact is a spring on one side only: x'' = −(ω² x + c x') while they overlap by x and the push is no pull, else zero.
//! Where the steps fall within a hit decides how much speed it gives back. On average over all ways in which they fall, no
//! more may come out than went in; that is stricter than the stability of a spring that lasts.

use pointmass::Method;
use pointmass::stability::{Limit, Mode};

/// How much energy a hit may add on average: what rounding to so few phases and to a bisection leaves.
const GAIN: f64 = 1.02;
/// Ways in which the steps fall, evenly over one step.
const PHASES: u32 = 24;

/// The longest step of a method for hits whose contact swings like this, were it to last.
pub(super) fn largest_step(method: Method, mode: Mode) -> Limit {
    if method == Method::Implicit {
        return Limit::Unconditional;
    }
    let omega = mode.omega2.sqrt();
    let hit = Hit { method, damping: mode.damping / omega };
    // In the time of the faster of both rates, no explicit method stands a step of four.
    let rate = hit.damping.max(1.0);
    let (mut fine, mut gains) = (1e-4 / rate, 0.05 / rate);
    while gains * rate < 4.0 && !hit.gains(gains) {
        (fine, gains) = (gains, 1.15 * gains);
    }
    for _ in 0..12 {
        let middle = (fine * gains).sqrt();
        *(if hit.gains(middle) { &mut gains } else { &mut fine }) = middle;
    }
    match mode.largest_step(method) {
        Limit::Step(lasting) => Limit::Step(lasting.min(fine / omega)),
        _ => Limit::Step(fine / omega),
    }
}

/// A hit in units in which ω is one.
struct Hit {
    method: Method,
    /// c/ω.
    damping: f64,
}

/// Overlap and the speed at which it grows.
type State = [f64; 2];

impl Hit {
    /// True if hits in steps of `h` give back more energy than they take.
    fn gains(&self, h: f64) -> bool {
        /// Steps after which what still touches is taken to come to rest.
        const MOST: u32 = 20_000;
        let phase = |i: u32| {
            let mut state = [-h * (f64::from(i) + 0.5) / f64::from(PHASES), 1.0];
            for _ in 0..MOST {
                state = self.step(state, h);
                // Apart for good; or so fast that it does not matter where.
                if (state[0] <= 0.0 && state[1] <= 0.0) || state[1].abs() > 1e3 {
                    break;
                }
            }
            state[1] * state[1]
        };
        (0..PHASES).map(phase).sum::<f64>() > GAIN * f64::from(PHASES)
    }

    fn acceleration(&self, [x, v]: State) -> f64 {
        if x > 0.0 { -(x + self.damping * v).max(0.0) } else { 0.0 }
    }

    fn step(&self, state: State, h: f64) -> State {
        let [x, v] = state;
        match self.method {
            Method::Symplectic => {
                let v = v + h * self.acceleration(state);
                [x + h * v, v]
            }
            Method::Verlet => {
                let a = self.acceleration(state);
                let end = [x + h * (v + 0.5 * h * a), v + h * a];
                [end[0], v + 0.5 * h * (a + self.acceleration(end))]
            }
            Method::Euler => self.explicit(state, h, &[&[]], &[1.0]),
            Method::Midpoint | Method::LectureMidpoint => self.explicit(state, h, &[&[], &[0.5]], &[0.0, 1.0]),
            Method::Embedded => {
                let weights = [2.0 / 9.0, 1.0 / 3.0, 4.0 / 9.0];
                self.explicit(state, h, &[&[], &[0.5], &[0.0, 0.75]], &weights)
            }
            Method::Rk4 | Method::Adaptive | Method::Implicit => {
                let weights = [1.0 / 6.0, 1.0 / 3.0, 1.0 / 3.0, 1.0 / 6.0];
                self.explicit(state, h, &[&[], &[0.5], &[0.0, 0.5], &[0.0, 0.0, 1.0]], &weights)
            }
        }
    }

    /// An explicit Runge-Kutta method by its table.
    fn explicit(&self, [x, v]: State, h: f64, table: &[&[f64]], weights: &[f64]) -> State {
        let mut slopes = [[0.0; 2]; 4];
        let moved = |slopes: &[State; 4], weights: &[f64]| {
            let sum = |i: usize| weights.iter().zip(slopes).map(|(weight, slope)| weight * slope[i]).sum::<f64>();
            [x + h * sum(0), v + h * sum(1)]
        };
        for (i, row) in table.iter().enumerate() {
            let stage = moved(&slopes, row);
            slopes[i] = [stage[1], self.acceleration(stage)];
        }
        moved(&slopes, weights)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn limits_are_those_of_theory() {
        let limit =
            |method: Method, damping: f64| match largest_step(method, Mode { omega2: 4.0, damping: 2.0 * damping }) {
                Limit::Step(step) => 2.0 * step,
                other => panic!("{method}: {other:?}"),
            };
        // Explicit Euler multiplies the energy of what nothing damps by 1 + h² a step, exp(πh) in half a swing.
        assert!((limit(Method::Euler, 0.0) / (GAIN.ln() / std::f64::consts::PI) - 1.0).abs() < 0.1);
        // The midpoint method by 1 + h⁴/4.
        let midpoint = (4.0 * GAIN.ln() / std::f64::consts::PI).cbrt();
        assert!((limit(Method::Midpoint, 0.0) / midpoint - 1.0).abs() < 0.1, "{}", limit(Method::Midpoint, 0.0));
        // Others stand less than what a lasting spring allows, and more than a quarter of a hit.
        for method in [Method::Symplectic, Method::Verlet, Method::Rk4] {
            for damping in [0.0, 0.1, 0.4] {
                let lasting = Mode { omega2: 1.0, damping }.largest_step(method);
                assert!(limit(method, damping) > 0.8 && lasting.admits(limit(method, damping)), "{method} {damping}");
            }
        }
        assert_eq!(largest_step(Method::Implicit, Mode { omega2: 4.0, damping: 0.0 }), Limit::Unconditional);
    }
}
