//! Numbers and sentences as people read them.

/// Letters that a line of a terminal has room for.
pub(crate) const WIDTH: usize = 80;

/// A number of things, in words that agree.
pub(crate) fn counted(n: usize, what: &str) -> String {
    format!("{} {what}{}", thousands(n), if n == 1 { "" } else { "s" })
}

/// A number with three digits that count.
pub(crate) fn digits(x: f64) -> String {
    match x.abs() {
        x if !x.is_finite() => "-".into(),
        a if a >= 999_500.0 => format!("{x:.2e}"),
        a if a >= 99.95 => format!("{x:.0}"),
        a if a >= 9.995 => format!("{x:.1}"),
        a if a >= 0.9995 => format!("{x:.2}"),
        0.0 => "0".into(),
        a if a >= 1e-4 => format!("{x:.*}", (2 - a.log10().floor() as i32).clamp(3, 7) as usize),
        _ => format!("{x:.2e}"),
    }
}

/// How many times the best; coarser where it is large.
pub(crate) fn ratio(ratio: f64) -> String {
    match ratio {
        ratio if ratio >= 99.5 => format!("{ratio:.0}"),
        ratio if ratio >= 9.95 => format!("{ratio:.1}"),
        _ => format!("{ratio:.2}"),
    }
}

/// The same without zeros that say nothing.
pub(crate) fn short(x: f64) -> String {
    let text = digits(x);
    match text.contains('.') && !text.contains('e') {
        true => text.trim_end_matches('0').trim_end_matches('.').to_string(),
        false => text,
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
