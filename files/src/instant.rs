//! Instants as files say them.

/// Seconds rounded to the nanosecond: a tick of the clock is a quarter of that, and 0.001 shall read 0.001.
pub fn nanoseconds(seconds: f64) -> f64 {
    (seconds * 1e9).round() / 1e9
}
