//! Numbers and sentences as people read them.

use std::fmt::Write;

/// What was typed, as a shell takes it.
pub(crate) fn command(args: impl Iterator<Item = String>) -> String {
    let plain =
        |word: &str| !word.is_empty() && word.chars().all(|c| c.is_ascii_alphanumeric() || "-_=.,/:+%@".contains(c));
    let quoted =
        args.skip(1).map(|word| if plain(&word) { word } else { format!("'{}'", word.replace('\'', r"'\''")) });
    std::iter::once("pointmass".to_string()).chain(quoted).collect::<Vec<_>>().join(" ")
}

/// Writing to a string cannot fail.
pub(crate) fn say(text: &mut String, line: &str) {
    let _ = writeln!(text, "{}", line.trim_end());
}

/// Letters that a line of a terminal has room for.
pub(crate) const WIDTH: usize = 80;

/// Words in lines that fit a terminal, behind a mark; what follows the first line stands further in.
pub(crate) fn paragraph(text: &mut String, mark: &str, words: &str) {
    let mut line = mark.to_string();
    for word in words.split_whitespace().flat_map(|word| pieces(word, WIDTH - 4)) {
        if line.chars().count() + 1 + word.chars().count() > WIDTH {
            say(text, &line);
            line = "   ".into();
        }
        line.push(' ');
        line.push_str(word);
    }
    say(text, &line);
}

/// A word in pieces of so many letters at the most.
fn pieces(word: &str, most: usize) -> impl Iterator<Item = &str> {
    let mut rest = word;
    std::iter::from_fn(move || {
        let end = rest.char_indices().nth(most).map_or(rest.len(), |(end, _)| end);
        let (piece, after) = rest.split_at(end);
        rest = after;
        (!piece.is_empty()).then_some(piece)
    })
}

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
