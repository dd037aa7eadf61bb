//! How much fits where only trying tells.

/// How often what may fit is halved.
const HALVINGS: u32 = 6;

/// The largest share between 0 and 1 that fits, as far as halving tells. It is the last that is tried, whatever that tells.
pub(super) fn bisect(mut fits: impl FnMut(f32) -> bool) -> f32 {
    let (mut least, mut most) = (0.0, 1.0);
    for _ in 0..HALVINGS {
        let middle = 0.5 * (least + most);
        *if fits(middle) { &mut least } else { &mut most } = middle;
    }
    let _ = fits(least);
    least
}

#[cfg(test)]
mod tests {
    use super::bisect;

    #[test]
    fn the_largest_share_that_fits_is_found_and_tried_last() {
        for due in [0.0, 0.001, 0.3, 0.5, 0.77, 1.0] {
            let mut last = f32::NAN;
            let share = bisect(|share| {
                last = share;
                share <= due
            });
            assert!(share <= due && due - share <= 1.0 / 64.0, "{share} of {due}");
            assert_eq!(share, last);
        }
    }
}
