//! Numbers and sentences as people read them.

use std::ops::Range;

/// Letters that a line of a terminal has room for.
pub(crate) const WIDTH: usize = 80;

/// A number of things, in words that agree.
pub(crate) fn counted(n: usize, what: &str) -> String {
    format!("{} {what}{}", thousands(n), if n == 1 { "" } else { "s" })
}

/// A number with so many digits that count; with an exponent beyond a range.
pub(crate) fn significant(x: f64, digits: i32, range: Range<f64>) -> String {
    // What rounds up to a power of ten has its digits.
    let rounded = x.abs() * (1.0 + 0.5 * 0.1f64.powi(digits));
    match x.abs() {
        0.0 => "0".into(),
        a if !range.contains(&a) => format!("{x:.*e}", digits as usize - 1),
        _ => format!("{x:.*}", (digits - 1 - rounded.log10().floor() as i32).max(0) as usize),
    }
}

/// A number with three digits that count.
pub(crate) fn digits(x: f64) -> String {
    if x.is_finite() { significant(x, 3, 1e-4..999_500.0) } else { "-".into() }
}

/// Digits without zeros that say nothing.
pub(crate) fn trimmed(text: String) -> String {
    match text.contains('.') && !text.contains('e') {
        true => text.trim_end_matches('0').trim_end_matches('.').to_string(),
        false => text,
    }
}

/// A number with three digits that count, without zeros that say nothing.
pub(crate) fn short(x: f64) -> String {
    trimmed(digits(x))
}

/// How many times the best; coarser where it is large.
pub(crate) fn ratio(ratio: f64) -> String {
    match ratio {
        ratio if ratio >= 99.5 => format!("{ratio:.0}"),
        ratio if ratio >= 9.95 => format!("{ratio:.1}"),
        _ => format!("{ratio:.2}"),
    }
}

/// A whole number in groups of three digits.
pub(crate) fn thousands(n: usize) -> String {
    let text = n.to_string();
    let mut grouped = String::new();
    for (i, digit) in text.chars().enumerate() {
        if i > 0 && (text.len() - i).is_multiple_of(3) {
            grouped.push(' ');
        }
        grouped.push(digit);
    }
    grouped
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_short() {
        let cases =
            [(0.0, "0"), (1.0, "1.00"), (12.345, "12.3"), (99.96, "100"), (1234.5, "1234"), (0.01234, "0.0123")];
        for (x, text) in cases {
            assert_eq!(digits(x), text);
        }
        assert_eq!(digits(f64::NAN), "-");
        assert_eq!([0.0, 1.0, 12.5, 100.0, 0.001].map(short), ["0", "1", "12.5", "100", "0.001"]);
        assert_eq!([thousands(7), thousands(1000), thousands(1_234_567)], ["7", "1 000", "1 234 567"]);
    }
}
