//! Between the colours people write and the light that adds up.

use glam::Vec3;
use std::sync::LazyLock;

/// From an sRGB value, 0 to 1, to linear light. Values above 1 go on along the same curve, as
/// bright lamps need; what is not a number is black.
fn decode_channel(encoded: f32) -> f32 {
    let encoded = encoded.clamp(0.0, 100.0);
    if encoded <= 0.040_45 { encoded.max(0.0) / 12.92 } else { ((encoded + 0.055) / 1.055).powf(2.4) }
}

/// The inverse of [`decode_channel`].
fn encode_channel(linear: f32) -> f32 {
    if linear <= 0.003_130_8 { linear * 12.92 } else { 1.055 * linear.powf(1.0 / 2.4) - 0.055 }
}

/// From an sRGB colour to linear light.
pub(super) fn decode(encoded: Vec3) -> Vec3 {
    encoded.map(|channel| if channel.is_finite() { decode_channel(channel) } else { 0.0 })
}

/// How bright linear light looks.
pub(super) fn luminance(light: Vec3) -> f32 {
    light.dot(Vec3::new(0.2126, 0.7152, 0.0722))
}

/// Bends values that are too bright back under 1, and leaves those below the knee alone.
pub(super) fn soften(light: Vec3) -> Vec3 {
    const KNEE: f32 = 0.75;
    light.map(|channel| {
        let over = (channel - KNEE).max(0.0) / (1.0 - KNEE);
        channel.min(KNEE) + (1.0 - KNEE) * over / (1.0 + over)
    })
}

/// A fixed, even grain between 0 and 1. Added before rounding, it turns the steps of a faint
/// gradient into something the eye reads as smooth.
pub(super) fn grain(x: usize, y: usize) -> f32 {
    // Interleaved gradient noise, close to blue noise in small neighbourhoods: the fraction of
    // 52.98… times the fraction of 0.0671… x + 0.00583… y. Fractions are what is left when
    // integers overflow.
    let inner = (x as u32).wrapping_mul(288_237_660).wrapping_add((y as u32).wrapping_mul(25_070_368));
    let outer = u64::from(inner >> 8) * 52_982_918 / 1_000_000;
    (outer & 0xff_ffff) as f32 / 16_777_216.0
}

/// Looks up both directions, because each pixel of each frame needs them.
#[derive(Debug)]
pub(super) struct Codec {
    linear: Vec<f32>,
    encoded: Vec<f32>,
}

/// The one there is.
pub(super) static CODEC: LazyLock<Codec> = LazyLock::new(Codec::new);

impl Codec {
    /// Enough for steps well below one part in 255 even in the shadows.
    const STEPS: usize = 1 << 14;

    fn new() -> Self {
        let encoded = |step| 255.0 * encode_channel(step as f32 / Self::STEPS as f32);
        Self {
            linear: (0..=255).map(|byte| decode_channel(byte as f32 / 255.0)).collect(),
            encoded: (0..=Self::STEPS).map(encoded).collect(),
        }
    }

    /// From red, green, blue and opacity to linear light and opacity.
    pub(super) fn decode(&self, [red, green, blue, opacity]: [u8; 4]) -> (Vec3, f32) {
        let light = [red, green, blue].map(|byte| self.linear[usize::from(byte)]);
        (Vec3::from_array(light), f32::from(opacity) / 255.0)
    }

    /// From linear light to a pixel, with `grain` between 0 and 1 in place of rounding.
    pub(super) fn encode(&self, light: Vec3, grain: f32) -> [u8; 3] {
        light.to_array().map(|channel| {
            // The cast also sends what is negative or not a number to 0.
            let step = (channel * Self::STEPS as f32 + 0.5) as usize;
            // Slightly less than a whole step of grain, so that exact values stay exact.
            (self.encoded[step.min(Self::STEPS)] + 0.06 + 0.88 * grain) as u8
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_byte_survives_the_round_trip() {
        for byte in 0..=255 {
            let (light, opacity) = CODEC.decode([byte; 4]);
            assert_eq!(opacity, f32::from(byte) / 255.0);
            for grain in [0.0, 0.5, 0.999] {
                assert_eq!(CODEC.encode(light, grain), [byte; 3]);
            }
        }
    }

    #[test]
    fn nothing_is_too_bright_or_too_strange() {
        assert_eq!(CODEC.encode(Vec3::new(f32::NAN, -1.0, f32::INFINITY), 0.9), [0, 0, 255]);
        assert_eq!(decode(Vec3::new(f32::NAN, -1.0, f32::INFINITY)), Vec3::ZERO);
        assert!(soften(Vec3::splat(50.0)).max_element() < 1.0);
        assert_eq!(soften(Vec3::splat(0.5)), Vec3::splat(0.5));
    }
}
