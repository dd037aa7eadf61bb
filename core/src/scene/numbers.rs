//! Checks of numbers in files, the errors that tell what they have to be, and what several of them are where nothing is said.

use super::SceneError;
use crate::math::unit;
use alloc::format;
use glam::Vec3;

pub(super) type Checked = Result<(), SceneError>;

/// Poisson's ratio of most plastics, and of hair.
#[cfg(feature = "serde")]
pub(super) const fn usual_poisson() -> f32 {
    0.35
}

pub(super) fn finite(at: &str, numbers: &[f32]) -> Checked {
    match numbers.iter().find(|x| !x.is_finite()) {
        Some(x) => {
            Err(SceneError::value(at, format!("has to be finite and within the range of a 32-bit float, not {x}")))
        }
        None => Ok(()),
    }
}

/// Checks the ratio of lengths at which a spring breaks.
pub(super) fn check_breaking(at: &str, ratio: Option<f32>) -> Checked {
    let Some(ratio) = ratio else { return Ok(()) };
    finite(at, &[ratio])?;
    if ratio > 1.0 {
        return Ok(());
    }
    Err(SceneError::value(at, format!("has to be above one, a length over that at rest, not {ratio}")))
}

/// A number from zero on.
pub(super) fn zero_or_more(at: &str, number: f32) -> Checked {
    finite(at, &[number])?;
    if number >= 0.0 { Ok(()) } else { Err(SceneError::value(at, format!("has to be zero or more, not {number}"))) }
}

/// A number above zero.
pub(super) fn above_zero(at: &str, number: f32) -> Checked {
    finite(at, &[number])?;
    if number > 0.0 { Ok(()) } else { Err(SceneError::value(at, format!("has to be above zero, not {number}"))) }
}

pub(super) fn check_direction(at: &str, direction: Vec3) -> Checked {
    finite(at, &direction.to_array())?;
    if unit(direction) == Vec3::ZERO { Err(SceneError::value(at, "has to have a direction")) } else { Ok(()) }
}
