//! Values of the command line, as more than one command takes them.

use std::fmt::Display;
use std::str::FromStr;

/// A number.
pub(crate) fn number(text: &str) -> Result<f64, String> {
    text.trim().parse().map_err(|_| format!("expected a number, found '{text}'"))
}

/// A whole number from 'least' to 'most', which may have an exponent; `expected` says so.
pub(crate) fn whole(text: &str, least: f64, most: f64, expected: &str) -> Result<usize, String> {
    let value = number(text).unwrap_or(f64::NAN);
    let fits = value.fract() == 0.0 && (least..=most).contains(&value);
    if fits { Ok(value as usize) } else { Err(format!("expected {expected}")) }
}

/// A whole number of 64 bits.
pub(crate) fn natural(text: &str) -> Result<u64, String> {
    text.trim().parse().map_err(|_| format!("expected a whole number from 0 to {}", u64::MAX))
}

/// The same, but for zero.
pub(crate) fn positive(text: &str) -> Result<u64, String> {
    let value = natural(text).ok().filter(|&value| value > 0);
    value.ok_or_else(|| format!("expected a whole number from 1 to {}", u64::MAX))
}

/// Seconds, which may be a fraction such as 1/60.
pub(crate) fn seconds(text: &str) -> Result<f64, String> {
    let longest = f64::from(1u32 << 31);
    let value = match text.split_once('/') {
        Some((over, under)) => number(over)? / number(under)?,
        None => number(text)?,
    };
    if (0.0..longest).contains(&value) { Ok(value) } else { Err("expected seconds, from 0 to 2147483647".into()) }
}

/// The length of a step \[s\].
pub(crate) fn step(text: &str) -> Result<f64, String> {
    let value = seconds(text)?;
    if value >= 1e-9 { Ok(value) } else { Err("expected a step of at least 1e-9 s".into()) }
}

/// The entries that a list names, or all, each once and in the order in which they are listed everywhere.
pub(crate) fn chosen<T>(text: &str, all: &[T]) -> Result<Vec<T>, String>
where
    T: Copy + PartialEq + FromStr<Err: Display>,
{
    let mut chosen = Vec::new();
    for name in text.split(',').map(str::trim) {
        match name {
            "all" => chosen.extend_from_slice(all),
            _ => chosen.push(name.parse().map_err(|unknown| format!("{unknown}, or all"))?),
        }
    }
    Ok(all.iter().copied().filter(|one| chosen.contains(one)).collect())
}

/// The entries that a list names, each once and in order; if it is empty, what is usual.
pub(crate) fn sorted<T: Clone + Ord>(list: &[T], usual: &[T]) -> Vec<T> {
    let mut sorted = if list.is_empty() { usual.to_vec() } else { list.to_vec() };
    sorted.sort_unstable();
    sorted.dedup();
    sorted
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn steps_may_be_fractions() {
        assert_eq!(step("1/60"), Ok(1.0 / 60.0));
        assert_eq!(step("0.001"), Ok(0.001));
        for bad in ["0", "-1", "nan", "inf", "1/0", "x", "1e-10", ""] {
            assert!(step(bad).is_err(), "{bad}");
        }
    }

    #[test]
    fn whole_numbers_may_have_exponents() {
        let count = |text| whole(text, 2.0, 1e8, "points");
        assert_eq!([count("1e3"), count("25"), count(" 5e6 ")], [Ok(1000), Ok(25), Ok(5_000_000)]);
        for bad in ["0", "1", "-5", "1.5", "1e9", "nan", "x", ""] {
            assert_eq!(count(bad), Err("expected points".into()), "{bad}");
        }
    }

    #[test]
    fn whole_numbers_keep_all_their_bits() {
        assert_eq!([natural("0"), natural("18446744073709551615")], [Ok(0), Ok(u64::MAX)]);
        assert_eq!([positive(" 1"), positive("18446744073709551615")], [Ok(1), Ok(u64::MAX)]);
        for bad in ["-1", "1.5", "1e3", "x", "", "18446744073709551616"] {
            assert!(natural(bad).is_err() && positive(bad).is_err(), "{bad}");
        }
        assert!(positive("0").is_err());
    }

    #[test]
    fn what_is_chosen_comes_once_and_in_order() {
        use pointmass::index::Structure;
        let chosen = |text| chosen(text, Structure::ALL);
        assert_eq!(chosen("all"), Ok(Structure::ALL.to_vec()));
        assert_eq!(chosen("grid, brute,grid"), Ok(vec![Structure::Brute, Structure::Grid]));
        assert!(chosen("grid,nonsense").is_err_and(|error| error.contains("brute") && error.contains("all")));
        assert_eq!((sorted(&[3, 1, 3], &[7]), sorted(&[], &[7])), (vec![1, 3], vec![7]));
    }
}
