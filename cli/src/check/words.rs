//! Numbers in words.

use crate::report::words::{significant, trimmed};
use pointmass::stability::Limit;

/// Seconds, with four digits that count and a unit that suits.
pub(crate) fn time(seconds: f64) -> String {
    match seconds.abs() {
        s if s >= 999.95 || s == 0.0 => format!("{seconds:.0} s"),
        s if s >= 0.999_95 => format!("{} s", digits(seconds)),
        s if s >= 0.999_95e-3 => format!("{} ms", digits(seconds * 1e3)),
        s if s >= 0.999_95e-6 => format!("{} µs", digits(seconds * 1e6)),
        _ => format!("{seconds:.3e} s"),
    }
}

/// A number with four digits that count.
fn digits(x: f64) -> String {
    significant(x, 4, 1e-3..1e6)
}

/// The same without zeros at the end.
pub(crate) fn plain(x: f64) -> String {
    trimmed(digits(x))
}

/// A limit as a table has it.
pub(crate) fn limit(limit: Limit) -> String {
    match limit {
        Limit::Step(step) => time(step),
        Limit::Never => "none".into(),
        Limit::Unconditional => "any".into(),
    }
}

/// A step as one types it: rounded down to three digits.
pub(crate) fn typed(step: f64) -> String {
    let unit = 10f64.powi(step.log10().floor() as i32 - 2);
    // Rounding up first: what has three digits keeps them.
    let rounded = (step / unit + 1e-9).floor() * unit;
    let decimals = (2 - step.log10().floor() as i32).max(0) as usize;
    trimmed(format!("{rounded:.decimals$}"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_have_four_digits() {
        let said = [0.0, 0.026_974, 1.5, 12.0, 3e-6, 0.000_999_99, 1e-9, 86_400.0].map(time);
        assert_eq!(said, ["0 s", "26.97 ms", "1.500 s", "12.00 s", "3.000 µs", "1.000 ms", "1.000e-9 s", "86400 s"]);
        assert_eq!([limit(Limit::Never), limit(Limit::Unconditional)], ["none", "any"]);
    }

    #[test]
    fn steps_are_rounded_down() {
        assert_eq!(
            [0.026_974, 0.01, 0.005_5, 1.999, 123.456, 3.1e-7].map(typed),
            ["0.0269", "0.01", "0.0055", "1.99", "123", "0.00000031"]
        );
    }
}
