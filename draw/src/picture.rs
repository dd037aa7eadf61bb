//! Pictures of sprites: flipbooks in several sizes, from files or drawn here.

use super::color::decode;
use glam::{Vec2, Vec3, Vec4};
use image::RgbaImage;
use std::f32::consts::{PI, TAU};

/// The frames of a picture, in linear light: red, green and blue, multiplied by the opacity unless they were before, and opacity.
#[derive(Clone, Debug, Default)]
pub struct Flipbook {
    frames: Vec<Vec<Level>>,
}

/// A frame in one size.
#[derive(Clone, Debug)]
struct Level {
    width: usize,
    height: usize,
    /// Row by row, with a copy of what is at the edges all around, so that each place lies between four texels.
    texels: Vec<Vec4>,
}

/// The side of the pictures that are drawn here, and the places in each of their texels that are looked at along a side.
const SIDE: usize = 96;
const LOOKS: usize = 3;

impl Flipbook {
    /// A picture that is cut into columns and rows of frames, read line by line. `multiplied`: its colours have been multiplied by its
    /// opacity already.
    pub fn new(picture: &RgbaImage, [columns, rows]: [u8; 2], multiplied: bool) -> Self {
        let (columns, rows) = (u32::from(columns).max(1), u32::from(rows).max(1));
        let (width, height) = (picture.width() / columns, picture.height() / rows);
        let texel = |x: u32, y: u32| {
            let [red, green, blue, opacity] = picture[(x, y)].0.map(|byte| f32::from(byte) / 255.0);
            let color = decode(Vec3::new(red, green, blue));
            (if multiplied { color } else { color * opacity }).extend(opacity)
        };
        let frame = |column: u32, row: u32| {
            let places = (0..height).flat_map(|y| (0..width).map(move |x| (column * width + x, row * height + y)));
            let texels: Vec<_> = places.map(|(x, y)| texel(x, y)).collect();
            Level::new(width as usize, height as usize, texels).sizes()
        };
        Self {
            frames: (0..rows)
                .flat_map(|row| (0..columns).map(move |column| (column, row)))
                .map(|(c, r)| frame(c, r))
                .collect(),
        }
    }

    /// One of the pictures that need no file, by its name.
    pub fn named(name: &str) -> Option<Self> {
        let draw: fn(Vec2) -> Vec4 = match name {
            "puff" => puff,
            "flame" => flame,
            "spark" => |at| Vec4::splat((-9.0 * at.length_squared()).exp() * rim(at)),
            "leaf" => leaf,
            "petal" => petal,
            "drop" => drop,
            "snowflake" => snowflake,
            "ring" => |at| Vec4::splat(edge(0.12 - (at.length() - 0.8).abs(), 0.06)),
            _ => return None,
        };
        let step = 2.0 / (SIDE * LOOKS) as f32;
        let texel = |x: usize, y: usize| {
            let looks = (0..LOOKS * LOOKS).map(|look| {
                let (i, j) = (x * LOOKS + look % LOOKS, y * LOOKS + look / LOOKS);
                draw(Vec2::new((i as f32 + 0.5) * step - 1.0, 1.0 - (j as f32 + 0.5) * step))
            });
            looks.sum::<Vec4>() / (LOOKS * LOOKS) as f32
        };
        let texels: Vec<_> = (0..SIDE * SIDE).map(|at| texel(at % SIDE, at / SIDE)).collect();
        Some(Self { frames: vec![Level::new(SIDE, SIDE, texels).sizes()] })
    }

    /// A frame, to be looked at in so many texels of the largest size a pixel.
    pub(super) fn frame(&self, number: u16) -> Option<Frame<'_>> {
        let sizes = self.frames.get(usize::from(number)).or(self.frames.last())?;
        sizes.first().filter(|largest| !largest.texels.is_empty()).map(|_| Frame { sizes })
    }
}

/// A frame in all its sizes.
#[derive(Clone, Copy)]
pub(super) struct Frame<'a> {
    sizes: &'a [Level],
}

impl<'a> Frame<'a> {
    /// The size that has about a texel a pixel where the whole frame is drawn so many pixels wide.
    pub(super) fn at_width(self, pixels: f32) -> impl Fn(Vec2) -> Vec4 + 'a {
        let width = self.sizes[0].width as f32;
        // The casts send what is below zero, or not a number, to zero.
        let level = ((width / pixels.max(1.0)).log2() + 0.5) as usize;
        let level = &self.sizes[level.min(self.sizes.len() - 1)];
        move |at| level.look(at)
    }
}

impl Level {
    /// A frame of texels row by row; none at all of one without any.
    fn new(width: usize, height: usize, texels: Vec<Vec4>) -> Self {
        if texels.is_empty() {
            return Self { width, height, texels };
        }
        let inner = |at: usize, count: usize| at.saturating_sub(1).min(count - 1);
        let places = (0..height + 2).flat_map(|y| (0..width + 2).map(move |x| (x, y)));
        let texels = places.map(|(x, y)| texels[inner(y, height) * width + inner(x, width)]).collect();
        Self { width, height, texels }
    }

    /// This one, and each half as large until one has a single texel in a direction.
    fn sizes(self) -> Vec<Self> {
        let mut sizes = vec![self];
        while let Some(last) = sizes.last().filter(|last| last.width > 1 && last.height > 1) {
            let (width, height) = (last.width / 2, last.height / 2);
            let texel = |x: usize, y: usize| {
                let at = (2 * y + 1) * (last.width + 2) + 2 * x + 1;
                let four = [at, at + 1, at + last.width + 2, at + last.width + 3];
                four.iter().map(|&at| last.texels[at]).sum::<Vec4>() * 0.25
            };
            let texels = (0..width * height).map(|at| texel(at % width, at / width)).collect();
            sizes.push(Self::new(width, height, texels));
        }
        sizes
    }

    /// Its colour at a place from −1 to 1 to the right and to the top, between four texels; beyond its edges what is there.
    fn look(&self, at: Vec2) -> Vec4 {
        let size = Vec2::new(self.width as f32, self.height as f32);
        let place = (Vec2::new(1.0 + at.x, 1.0 - at.y) * (0.5 * size) + 0.5).clamp(Vec2::ZERO, size + 0.999);
        // It is no less than zero, so that casts round down.
        let (left, top) = (place.x as i32, place.y as i32);
        let (right, down) = (place.x - left as f32, place.y - top as f32);
        let stride = self.width + 2;
        let first = top as usize * stride + left as usize;
        let row = |at: usize| match self.texels.get(at..at + 2) {
            Some([a, b]) => a.lerp(*b, right),
            _ => Vec4::ZERO,
        };
        row(first).lerp(row(first + stride), down)
    }
}

/// White of this opacity.
fn white(opacity: f32) -> Vec4 {
    Vec4::splat(opacity)
}

/// From 0 to 1 where a distance inside grows from 0 to a width.
fn edge(inside: f32, width: f32) -> f32 {
    let share = (inside / width).clamp(0.0, 1.0);
    share * share * (3.0 - 2.0 * share)
}

/// 1 inside the unit circle, falling to 0 at its edge.
fn rim(at: Vec2) -> f32 {
    edge(1.0 - at.length(), 0.25)
}

/// Smooth random heights from 0 to 1, about four to a unit.
fn noise(at: Vec2) -> f32 {
    let corner = at.floor();
    let share = at - corner;
    let height = |x: f32, y: f32| {
        let mixed = (corner.x + x) as i32 as u32;
        let mixed = mixed.wrapping_mul(0x9e37_79b9) ^ ((corner.y + y) as i32 as u32).wrapping_mul(0x85eb_ca6b);
        let mixed = (mixed ^ mixed >> 15).wrapping_mul(0x2c1b_3c6d);
        ((mixed ^ mixed >> 13) >> 8) as f32 / 16_777_216.0
    };
    let ease = share * share * (Vec2::splat(3.0) - 2.0 * share);
    let row = |y: f32| height(0.0, y) + (height(1.0, y) - height(0.0, y)) * ease.x;
    row(0.0) + (row(1.0) - row(0.0)) * ease.y
}

/// Heaps of smaller and smaller clouds.
fn clouds(at: Vec2) -> f32 {
    let octave = |factor: f32| noise(at * factor + 17.0 * factor) / factor;
    (octave(2.0) + octave(4.0) + octave(8.0) + octave(16.0)) / (1.0 / 2.0 + 1.0 / 4.0 + 1.0 / 8.0 + 1.0 / 16.0)
}

/// A soft ball of smoke with a ragged edge, lighter at its top.
fn puff(at: Vec2) -> Vec4 {
    let ragged = at.length() + 0.55 * (clouds(at * 1.6) - 0.5);
    let opacity = edge(0.92 - ragged, 0.85) * rim(at) * (0.55 + 0.45 * clouds(at * 2.3 + 5.0));
    let light = 0.78 + 0.22 * (0.6 * at.y + 0.4 * (2.0 * clouds(at * 1.9 + 9.0) - 1.0));
    (Vec3::splat(light) * opacity).extend(opacity)
}

/// A tongue of fire, its top ragged.
fn flame(at: Vec2) -> Vec4 {
    let height = 0.5 * (at.y + 1.0);
    let sway = 0.22 * (noise(Vec2::new(3.0, 2.5 * at.y + 8.0)) - 0.5) * height;
    let width = 0.62 * (1.0 - height).sqrt() * (0.25 + height).min(0.8).sqrt();
    let inside = 1.0 - (at.x + sway).abs() / width.max(1e-3);
    white(edge(inside, 0.9) * edge(1.0 - height, 0.5) * edge(height, 0.12) * (0.75 + 0.5 * (clouds(at * 2.0) - 0.5)))
}

/// A leaf with its ribs, the stalk at its bottom.
fn leaf(at: Vec2) -> Vec4 {
    let along = (0.5 * (at.y + 0.92) / 0.92).clamp(0.0, 1.0);
    let width = 0.52 * (PI * along.powf(0.8)).sin().max(0.0).powf(0.85);
    let stalk = edge(0.045 - at.x.abs(), 0.02) * edge(0.98 - at.y.abs(), 0.02) * f32::from(u8::from(at.y < 0.3));
    let opacity = edge(width - at.x.abs(), 0.03).max(stalk);
    let middle = edge(0.035 - at.x.abs(), 0.02);
    let rib = ((at.y * 5.5 - at.x.abs() * 4.0) * PI).sin().abs();
    let light = 0.72 + 0.16 * edge(rib - 0.12, 0.2) + 0.1 * at.x.signum() * (1.0 - middle) - 0.14 * middle;
    (Vec3::splat(light) * opacity).extend(opacity)
}

/// A petal, notched at its top and darker at its foot.
fn petal(at: Vec2) -> Vec4 {
    let along = 0.5 * (at.y + 1.0);
    let notch = 0.1 * (1.0 - (at.x / 0.3).abs()).max(0.0);
    let width = 0.66 * (1.0 - (1.0 - along * 1.25).powi(2)).max(0.0).sqrt();
    let opacity = edge(width - at.x.abs(), 0.04) * edge(0.92 - notch - at.y, 0.06) * edge(at.y + 0.97, 0.1);
    let light = 0.7 + 0.3 * along - 0.08 * (at.x * 18.0).cos().abs();
    (Vec3::splat(light) * opacity).extend(opacity)
}

/// A falling drop, its top pointed, with a light in it.
fn drop(at: Vec2) -> Vec4 {
    let up = at.y + 0.35;
    let width = if up < 0.0 { (0.36 - up * up).max(0.0).sqrt() } else { 0.6 * (1.0 - up / 1.3).max(0.0).powf(1.6) };
    let opacity = edge(width - at.x.abs(), 0.06) * edge(0.93 - at.y.abs(), 0.03);
    let shine = (-14.0 * (at - Vec2::new(-0.2, -0.25)).length_squared()).exp();
    (Vec3::splat(0.62 + 0.38 * shine) * opacity).extend(opacity * (0.7 + 0.3 * shine))
}

/// A star of six arms with twigs.
fn snowflake(at: Vec2) -> Vec4 {
    let angle = at.y.atan2(at.x).rem_euclid(TAU / 6.0) - TAU / 12.0;
    let arm = at.length() * Vec2::new(angle.cos(), angle.sin().abs());
    let twig = [0.35f32, 0.58, 0.78].into_iter().map(|from| {
        let out = arm - Vec2::new(from, 0.0);
        let along = out.dot(Vec2::new(0.5, 0.866)).clamp(0.0, 0.3 * (1.05 - from));
        0.035 - out.distance(along * Vec2::new(0.5, 0.866))
    });
    let inside = twig.fold((0.045 - arm.y).min(0.93 - arm.x), f32::max);
    white(edge(inside, 0.03))
}

#[cfg(test)]
mod tests {
    use super::*;
    use pointmass::scene::Sprite;

    #[test]
    fn all_pictures_are_there_and_end_at_their_edges() {
        for name in Sprite::PICTURES {
            let book = Flipbook::named(name).expect(name);
            let look = book.frame(0).expect("one frame").at_width(200.0);
            let all = (0..40 * 40).map(|i| Vec2::new((i % 40) as f32, (i / 40) as f32) / 20.0 - 0.975);
            let looks: Vec<Vec4> = all.map(&look).collect();
            assert!(looks.iter().all(|c| c.is_finite() && c.min_element() >= 0.0 && c.max_element() <= 1.0), "{name}");
            let cover = looks.iter().map(|c| c.w).sum::<f32>() / 1600.0;
            assert!((0.05..0.7).contains(&cover), "{name} covers {cover}");
            for i in 0..50 {
                let along = i as f32 / 25.0 - 1.0;
                for at in [(along, 1.0), (along, -1.0), (1.0, along), (-1.0, along)] {
                    assert!(look(at.into()).max_element() < 0.25, "{name} is cut off at {at:?}");
                }
            }
        }
        assert!(Flipbook::named("none").is_none());
    }

    #[test]
    fn frames_are_read_line_by_line_and_colors_in_linear_light() {
        let picture = RgbaImage::from_fn(6, 4, |x, y| image::Rgba([(x / 2 * 100) as u8, (y / 2 * 255) as u8, 0, 128]));
        let book = Flipbook::new(&picture, [3, 2], false);
        for number in 0..6u16 {
            let color = book.frame(number).expect("six").at_width(2.0)(Vec2::new(0.0, 0.0));
            let (x, y) = (f32::from(number % 3), f32::from(number / 3));
            let straight = color.truncate() / color.w;
            let exact = decode(Vec3::new(x * 100.0 / 255.0, y, 0.0));
            assert!((straight - exact).length() < 1e-5 && (color.w - 128.0 / 255.0).abs() < 1e-6, "{number}: {color}");
        }
        assert_eq!(book.frame(9).expect("the last").sizes[0].texels, book.frames[5][0].texels);
        assert!(Flipbook::new(&RgbaImage::new(1, 1), [3, 2], false).frame(0).is_none());
    }
}
