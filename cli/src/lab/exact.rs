//! Where particles are by closed forms, in double precision.

use pointmass::{Particle, Spring};

/// Where all are at an instant, from where they start.
pub(crate) type Exact = fn(&[Particle], &[Spring], f64) -> Vec<[f64; 3]>;

/// Place and speed along x.
fn state(particle: &Particle) -> [f64; 2] {
    [particle.position.x, particle.velocity.x].map(f64::from)
}

/// x'' = −4 x.
pub(crate) fn oscillator(start: &[Particle], _: &[Spring], t: f64) -> Vec<[f64; 3]> {
    let (sin, cos) = (2.0 * t).sin_cos();
    start.iter().map(state).map(|[x, v]| [x * cos + v / 2.0 * sin, 0.0, 0.0]).collect()
}

/// x'' = −4 x + 2 cos t: the free oscillation and ⅔ cos t.
pub(crate) fn driven(start: &[Particle], _: &[Spring], t: f64) -> Vec<[f64; 3]> {
    let (sin, cos) = (2.0 * t).sin_cos();
    let driven = 2.0 / 3.0 * t.cos();
    start.iter().map(state).map(|[x, v]| [(x - 2.0 / 3.0) * cos + v / 2.0 * sin + driven, 0.0, 0.0]).collect()
}

/// θ'' = −sin θ, let go at rest: sin θ/2 = k cd(t, k) with k = sin θ₀/2.
pub(crate) fn pendulum(start: &[Particle], _: &[Spring], t: f64) -> Vec<[f64; 3]> {
    let angle = |[x, _]: [f64; 2]| {
        let k = (x / 2.0).sin();
        let [_, cn, dn] = jacobi(t, k);
        2.0 * (k * cn / dn).asin()
    };
    start.iter().map(|particle| [angle(state(particle)), 0.0, 0.0]).collect()
}

/// Jacobi's sn, cn and dn of `u` to the modulus `k`, below 1, by arithmetic and geometric means (Abramowitz and Stegun,
/// "Handbook of Mathematical Functions", 16.4).
fn jacobi(u: f64, k: f64) -> [f64; 3] {
    let (mut a, mut b) = (1.0, (1.0 - k * k).sqrt());
    let mut shares = Vec::new();
    while shares.len() < 8 {
        let (mean, c) = ((a + b) / 2.0, (a - b) / 2.0);
        b = (a * b).sqrt();
        a = mean;
        shares.push(c / a);
    }
    let last = a * u * f64::from(1 << shares.len());
    let angle = shares.iter().rev().fold(last, |angle, share| (angle + (share * angle.sin()).asin()) / 2.0);
    let (sn, cn) = angle.sin_cos();
    [sn, cn, (1.0 - k * k * sn * sn).sqrt()]
}

/// Two bodies under a constant of gravitation of 1, started across their line at the least distance: Kepler's equation.
pub(crate) fn kepler(start: &[Particle], _: &[Spring], t: f64) -> Vec<[f64; 3]> {
    let [a, b] = start else { return Vec::new() };
    let masses = [f64::from(a.mass), f64::from(b.mass)];
    let total = masses[0] + masses[1];
    let (distance, speed) = ((a.position - b.position).x, (a.velocity - b.velocity).y);
    let (distance, speed) = (f64::from(distance), f64::from(speed));
    let eccentricity = distance * speed * speed / total - 1.0;
    let axis = distance / (1.0 - eccentricity);
    let mean = (total / axis.powi(3)).sqrt() * t;
    // Newton's method; the start is good for every eccentricity below 0.8.
    let mut anomaly = mean + eccentricity * mean.sin();
    for _ in 0..20 {
        let (sin, cos) = anomaly.sin_cos();
        anomaly -= (anomaly - eccentricity * sin - mean) / (1.0 - eccentricity * cos);
    }
    let (sin, cos) = anomaly.sin_cos();
    let apart = [axis * (cos - eccentricity), axis * (1.0 - eccentricity * eccentricity).sqrt() * sin];
    let shares = [masses[1] / total, -masses[0] / total];
    shares.iter().map(|share| [share * apart[0], share * apart[1], 0.0]).collect()
}

/// Masses on the x axis, each let go at rest on an overdamped spring of its own, toward number 0, which is fixed in the
/// origin.
pub(crate) fn stiff(start: &[Particle], springs: &[Spring], t: f64) -> Vec<[f64; 3]> {
    let mut places = vec![[0.0; 3]; start.len()];
    for spring in springs {
        let end = spring.ends[1] as usize;
        let [x, _] = state(&start[end]);
        let [rest, k, damping, mass] = [spring.rest_length, spring.ks, spring.kd, start[end].mass].map(f64::from);
        let half = damping / mass / 2.0;
        let root = (half * half - k / mass).sqrt();
        let (fast, slow) = (-half - root, -k / mass / (half + root));
        let stretch = (x - rest) * (fast * (slow * t).exp() - slow * (fast * t).exp()) / (fast - slow);
        places[end][0] = rest + stretch;
    }
    places
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lab::law::on_the_axis;

    #[test]
    fn the_elliptic_functions_are_those_of_the_tables() {
        // Abramowitz and Stegun, 16.1: sn(K) = 1; K(k² = 0.5) = 1.854 074 677 301 37.
        let [sn, cn, dn] = jacobi(1.854_074_677_301_37, 0.5f64.sqrt());
        assert!((sn - 1.0).abs() < 1e-13 && cn.abs() < 1e-13 && (dn - 0.5f64.sqrt()).abs() < 1e-13);
        let [sn, cn, dn] = jacobi(0.7, 1e-9);
        assert!((sn - 0.7f64.sin()).abs() < 1e-12 && (cn - 0.7f64.cos()).abs() < 1e-12 && (dn - 1.0).abs() < 1e-12);
    }

    #[test]
    fn closed_forms_begin_where_particles_do_and_obey_their_laws() {
        let start = on_the_axis([[0.5, 0.0], [-1.5, 0.0]]);
        type Law = fn(f64, f64) -> f64;
        let laws: [(Exact, Law); 3] =
            [(oscillator, |x, _| -4.0 * x), (driven, |x, t| -4.0 * x + 2.0 * t.cos()), (pendulum, |x, _| -x.sin())];
        for (exact, law) in laws {
            for (i, particle) in start.iter().enumerate() {
                let at = |t: f64| exact(&start, &[], t)[i][0];
                assert!((at(0.0) - f64::from(particle.position.x)).abs() < 1e-12);
                for t in [0.3, 1.7, 4.0] {
                    let h = 1e-3;
                    let second = (at(t + h) - 2.0 * at(t) + at(t - h)) / (h * h);
                    assert!((second - law(at(t), t)).abs() < 1e-5, "{t}: {second}");
                }
            }
        }
    }
}
