//! Animated GIFs: the pixels of a frame.
//!
//! A frame only holds the pixels that changed, with colours chosen for just those; the rest shows
//! through from the frames before. So what stands still is drawn once, does not flicker and costs
//! nothing, and what moves has a whole palette to itself. Where much changes from one frame to the
//! next the eye does not see small differences, and of colours that look alike the one that packs
//! well is taken; what comes to rest is drawn once more, with care.

use super::palette::Palette;
use super::thrift::{Wish, fulfil};
use gif::{DisposalMethod, Frame};
use image::{Rgb, RgbImage};
use std::borrow::Cow;

/// How far a channel may be from what it should be where nothing moves.
const TOLERANCE: u8 = 2;

/// How much farther it may be for each step that it has changed since the frame before, and how
/// far at most.
const FORGIVENESS: f32 = 0.4;
const MOST: u8 = 20;

/// The picture that someone who watches the animation sees.
#[derive(Debug)]
pub(super) struct Screen {
    /// The colour that each pixel should have had when it was last drawn with care, else what was drawn; `None`
    /// before the first frame.
    meant: Option<RgbImage>,
    /// The picture that was drawn, with the palette's colours.
    drawn: RgbImage,
    /// How far each pixel's channels may be off now.
    slack: Vec<u8>,
    /// The picture before.
    before: Option<RgbImage>,
}

/// The part of a frame that holds all changes.
#[derive(Clone, Copy, Debug)]
struct Window {
    left: u32,
    top: u32,
    width: u32,
    height: u32,
}

impl Screen {
    pub(super) fn new(width: u32, height: u32) -> Self {
        Self { meant: None, drawn: RgbImage::new(width, height), slack: Vec::new(), before: None }
    }

    /// The frame that has to be drawn to show a picture. The frame's duration is left open.
    pub(super) fn show(&mut self, picture: &RgbImage) -> Frame<'static> {
        self.slack = slack(self.before.as_ref(), picture);
        let window = self.changes(picture);
        let changed = window.pixels().filter(|&(x, y)| self.is_changed(picture, x, y));
        let mut palette = Palette::new(changed.map(|(x, y)| picture.get_pixel(x, y).0));
        let wishes: Vec<Wish> = window.pixels().map(|(x, y)| self.wish(picture, x, y, &mut palette)).collect();
        let indices = fulfil(&wishes, &palette);

        let meant = self.meant.get_or_insert_with(|| picture.clone());
        for (((x, y), &index), wish) in window.pixels().zip(&indices).zip(wishes) {
            // What shows through has no colour.
            let Some(&color) = palette.colors().get(usize::from(index)) else { continue };
            self.drawn.put_pixel(x, y, Rgb(color));
            let careful = matches!(wish, Wish::Exactly(_));
            meant.put_pixel(x, y, if careful { *picture.get_pixel(x, y) } else { Rgb(color) });
        }
        self.before = Some(picture.clone());

        let mut colors = palette.colors().concat();
        colors.extend([0; 3]);
        Frame {
            dispose: DisposalMethod::Keep,
            transparent: Some(palette.colors().len() as u8),
            left: window.left as u16,
            top: window.top as u16,
            width: window.width as u16,
            height: window.height as u16,
            palette: Some(colors),
            buffer: Cow::Owned(indices),
            ..Frame::default()
        }
    }

    /// The colours that may stand for a pixel.
    fn wish(&self, picture: &RgbImage, x: u32, y: u32, palette: &mut Palette) -> Wish {
        let color = picture.get_pixel(x, y);
        let slack = i32::from(self.slack[(y * picture.width() + x) as usize]);
        if !self.is_changed(picture, x, y) {
            Wish::Exactly(palette.colors().len() as u8)
        } else if slack >= 2 * i32::from(TOLERANCE) {
            Wish::About(color.0, 10 * slack * slack)
        } else {
            let roughness = palette.roughness(color.0);
            Wish::Exactly(palette.nearest(dither(color, x, y, roughness)))
        }
    }

    fn is_changed(&self, picture: &RgbImage, x: u32, y: u32) -> bool {
        let wanted = picture.get_pixel(x, y);
        let slack = self.slack[(y * picture.width() + x) as usize];
        let differs = |other: &Rgb<u8>| difference(wanted, other) > slack;
        self.meant.as_ref().is_none_or(|meant| differs(meant.get_pixel(x, y)) && differs(self.drawn.get_pixel(x, y)))
    }

    /// The smallest window around all changes. A frame must have a pixel even if nothing changed.
    fn changes(&self, picture: &RgbImage) -> Window {
        let (width, height) = picture.dimensions();
        let whole = Window { left: 0, top: 0, width, height };
        let (mut low, mut high) = ((width, height), (0, 0));
        for (x, y) in whole.pixels().filter(|&(x, y)| self.is_changed(picture, x, y)) {
            low = (low.0.min(x), low.1.min(y));
            high = (high.0.max(x + 1), high.1.max(y + 1));
        }
        if high == (0, 0) {
            return Window { left: 0, top: 0, width: width.min(1), height: height.min(1) };
        }
        Window { left: low.0, top: low.1, width: high.0 - low.0, height: high.1 - low.1 }
    }
}

impl Window {
    fn pixels(self) -> impl Iterator<Item = (u32, u32)> {
        let columns = self.left..self.left + self.width;
        (self.top..self.top + self.height).flat_map(move |y| columns.clone().map(move |x| (x, y)))
    }
}

/// How far each pixel's channels may be off after the picture before: the farther the more has changed.
fn slack(before: Option<&RgbImage>, picture: &RgbImage) -> Vec<u8> {
    let Some(before) = before else { return vec![0; picture.pixels().len()] };
    let changes = before.pixels().zip(picture.pixels()).map(|(before, now)| difference(before, now));
    changes.map(|change| (TOLERANCE + (FORGIVENESS * f32::from(change)) as u8).min(MOST)).collect()
}

/// By how much the channel differs that differs most.
fn difference(a: &Rgb<u8>, b: &Rgb<u8>) -> u8 {
    let [red, green, blue] = [0, 1, 2].map(|at| a.0[at].abs_diff(b.0[at]));
    red.max(green).max(blue)
}

/// Makes a colour a little lighter or darker in a fixed pattern, so that a mixture of the two
/// nearest colours stands for those between them. Fixed, because a pattern that changed from frame
/// to frame would flicker.
fn dither(color: &Rgb<u8>, x: u32, y: u32, roughness: f32) -> [u8; 3] {
    let shift = roughness * (threshold(x, y) - 0.5);
    color.0.map(|channel| (f32::from(channel) + shift + 0.5) as u8)
}

/// Bayer's pattern, eight by eight, from 0 to 1: numbers as far apart as can be lie side by side.
fn threshold(x: u32, y: u32) -> f32 {
    let bits = (0..3).map(|bit| (x >> bit ^ y >> bit) & 1 | (y >> bit & 1) << 1);
    let value = bits.enumerate().map(|(bit, value)| value << (4 - 2 * bit)).sum::<u32>();
    (value as f32 + 0.5) / 64.0
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A soft gradient, and a bright square somewhere.
    fn picture(at: u32) -> RgbImage {
        RgbImage::from_fn(64, 32, |x, y| {
            if (at..at + 4).contains(&x) && (10..14).contains(&y) {
                Rgb([255, 240, 200])
            } else {
                Rgb([x as u8 / 2, y as u8, 40])
            }
        })
    }

    #[test]
    fn only_changes_are_drawn() {
        let mut screen = Screen::new(64, 32);
        let first = screen.show(&picture(20));
        assert_eq!((first.left, first.top, first.width, first.height), (0, 0, 64, 32));
        let next = screen.show(&picture(22));
        assert_eq!((next.left, next.top, next.width, next.height), (20, 10, 6, 4));
        let kept = next.buffer.iter().filter(|&&index| Some(index) == next.transparent);
        assert_eq!(kept.count(), 2 * 4);
        // What has come to rest is drawn with care, and then no more.
        screen.show(&picture(22));
        let same = screen.show(&picture(22));
        assert_eq!((same.width, same.height, same.buffer.to_vec()), (1, 1, vec![0]));
    }

    #[test]
    fn what_is_seen_is_what_was_meant() {
        let mut screen = Screen::new(64, 32);
        for at in 0..40 {
            screen.show(&picture(at));
            for (seen, meant) in screen.drawn.pixels().zip(picture(at).pixels()) {
                let error = seen.0.iter().zip(meant.0).map(|(a, b)| a.abs_diff(b)).max();
                assert!(error < Some(16), "{seen:?} for {meant:?}");
            }
        }
    }

    #[test]
    fn thresholds_are_all_different() {
        let mut all: Vec<_> = (0..64).map(|at| (64.0 * threshold(at % 8, at / 8)) as u32).collect();
        all.sort_unstable();
        assert!(all.into_iter().eq(0..64));
    }
}
