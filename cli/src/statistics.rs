//! Figures from samples: medians, spreads, growth, crossings.

/// The statistics of samples.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Summary {
    pub(crate) median: f64,
    pub(crate) min: f64,
    /// The interquartile range over the median.
    pub(crate) spread: f64,
}

impl Summary {
    /// The statistics of samples in any order; zero of none.
    pub(crate) fn of(samples: &[f64]) -> Self {
        let mut sorted = samples.to_vec();
        sorted.sort_by(f64::total_cmp);
        let Some(&min) = sorted.first() else { return Self::default() };
        let median = quantile(&sorted, 0.5);
        let range = quantile(&sorted, 0.75) - quantile(&sorted, 0.25);
        Self { median, min, spread: if median > 0.0 { range / median } else { 0.0 } }
    }
}

/// Between the two samples next to it, linearly.
fn quantile(sorted: &[f64], part: f64) -> f64 {
    let at = part * (sorted.len() - 1) as f64;
    let (low, high) = (sorted[at.floor() as usize], sorted[at.ceil() as usize]);
    low + (high - low) * at.fract()
}

/// The exponent p of y = c xᵖ that fits best: the slope of log y against log x by least squares.
///
/// None of fewer than two different positive x.
pub(crate) fn growth(points: &[(f64, f64)]) -> Option<f64> {
    let logs: Vec<_> = points.iter().filter(|(x, y)| *x > 0.0 && *y > 0.0).map(|(x, y)| (x.ln(), y.ln())).collect();
    let n = logs.len() as f64;
    let (mean_x, mean_y) = logs.iter().fold((0.0, 0.0), |(sx, sy), (x, y)| (sx + x / n, sy + y / n));
    let square: f64 = logs.iter().map(|(x, _)| (x - mean_x).powi(2)).sum();
    let product: f64 = logs.iter().map(|(x, y)| (x - mean_x) * (y - mean_y)).sum();
    (square > 1e-12).then(|| product / square)
}

/// Where the straight lines through (x, a) and (x, b) on paper of two logarithmic scales cross, if between the ends.
pub(crate) fn crossing([x0, x1]: [f64; 2], a: [f64; 2], b: [f64; 2]) -> Option<f64> {
    let [d0, d1] = [0, 1].map(|i| (a[i] / b[i]).ln());
    let crosses = d0.is_finite() && d1.is_finite() && d0 * d1 < 0.0;
    crosses.then(|| (x0.ln() + (x1.ln() - x0.ln()) * d0 / (d0 - d1)).exp())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quartiles_are_those_of_the_textbook() {
        let summary = Summary::of(&[5.0, 1.0, 3.0, 2.0, 4.0]);
        assert_eq!(summary, Summary { median: 3.0, min: 1.0, spread: 2.0 / 3.0 });
        assert_eq!(Summary::of(&[7.0]), Summary { median: 7.0, min: 7.0, spread: 0.0 });
        assert_eq!(Summary::of(&[1.0, 2.0]).median, 1.5);
        assert_eq!(Summary::of(&[]), Summary::default());
    }

    #[test]
    fn powers_have_their_exponent() {
        for power in [0.0, 1.0, 1.5, 2.0] {
            let points: Vec<_> = [10.0f64, 100.0, 1e3, 1e5].iter().map(|x| (*x, 3.0 * x.powf(power))).collect();
            assert!(growth(&points).is_some_and(|p| (p - power).abs() < 1e-12), "{power}");
        }
        // n log n between 1e3 and 1e5 looks like a power of 1.11.
        let points: Vec<_> = [1e3f64, 1e4, 1e5].iter().map(|n| (*n, n * n.log2())).collect();
        assert!(growth(&points).is_some_and(|p| (p - 1.11).abs() < 0.005));
        assert_eq!(growth(&[(10.0, 3.0)]), None);
        assert_eq!(growth(&[(10.0, 3.0), (10.0, 4.0)]), None);
        assert_eq!(growth(&[]), None);
    }

    #[test]
    fn powers_cross_where_they_are_equal() {
        let (a, b) = (|n: f64| 100.0 * n, |n: f64| n * n);
        let at = crossing([10.0, 1e4], [a(10.0), a(1e4)], [b(10.0), b(1e4)]);
        assert!(at.is_some_and(|n| (n - 100.0).abs() < 1e-9), "{at:?}");
        assert_eq!(crossing([10.0, 50.0], [a(10.0), a(50.0)], [b(10.0), b(50.0)]), None, "beyond the ends");
        assert_eq!(crossing([1.0, 2.0], [1.0, 1.0], [1.0, 1.0]), None, "the same line");
        assert_eq!(crossing([1.0, 2.0], [0.0, 1.0], [1.0, 0.5]), None, "zero has no logarithm");
    }
}
