//! Subsets at random, without replacement, in the order of the whole.

use pointmass::rng::Stream;

/// So many of `len` rows, ascending; all if there are not more.
///
/// Selection sampling: each row is taken with the probability that is left (Knuth, The Art of Computer Programming 2,
/// 3.4.2, Algorithm S).
#[must_use]
pub(crate) fn sample(len: usize, wanted: usize, seed: u64) -> Vec<usize> {
    /// Apart from the streams of made-up points.
    const EMITTER: u32 = 1 << 17;
    let mut rows = Vec::with_capacity(wanted.min(len));
    for row in 0..len {
        let left = wanted.saturating_sub(rows.len());
        if left == 0 {
            break;
        }
        let [high, low] = Stream::new(seed, EMITTER, row as u32).words(0);
        let unit = (u64::from(high) << 32 | u64::from(low)) as f64 / 2f64.powi(64);
        if unit * ((len - row) as f64) < left as f64 {
            rows.push(row);
        }
    }
    rows
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_sample_has_the_size_each_row_once_and_no_favourites() {
        assert_eq!(sample(5, 9, 1), [0, 1, 2, 3, 4]);
        assert_eq!(sample(0, 3, 1), [0usize; 0]);
        let mut taken = [0u32; 40];
        for seed in 0..2000 {
            let rows = sample(40, 10, seed);
            assert!(rows.len() == 10 && rows.is_sorted_by(|a, b| a < b));
            rows.iter().for_each(|&row| taken[row] += 1);
        }
        // 500 each, of standard deviation 19.4; five of them.
        assert!(taken.iter().all(|&n| n.abs_diff(500) < 97), "{taken:?}");
    }
}
