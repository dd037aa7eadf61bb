//! Skies, fog and open shutters.

use super::super::*;
use super::{HEIGHT, WIDTH, board, boards, dot, encoded, frame, glowing, linear, middle, plain, stage, wall};
use crate::eye::Eye;
use glam::{Vec2, Vec3};
use image::RgbImage;
use pointmass::draw::Line;
use pointmass::material::Blend;

const SKY: Background = Background::Gradient {
    zenith: Vec3::new(0.1, 0.3, 0.8),
    horizon: Vec3::new(0.9, 0.8, 0.6),
    ground: Vec3::new(0.2, 0.15, 0.1),
};

pub(super) fn foggy(stage: Stage, fog: Fog) -> Stage {
    Stage { fog: Some(fog), ..stage }
}

/// The bytes of linear light, and how far those of a pixel are from them at most.
fn off(pixel: [u8; 3], exact: Vec3) -> f64 {
    let off = |(byte, light): (u8, f32)| (f64::from(byte) - encoded(f64::from(light))).abs();
    pixel.into_iter().zip(exact.to_array()).map(off).fold(0.0, f64::max)
}

#[test]
fn the_sky_follows_the_elevation_of_the_line_of_sight_however_the_camera_leans() {
    let decoded = |color: [f32; 3]| color::decode(color.into());
    let [zenith, horizon, ground] = [[0.1, 0.3, 0.8], [0.9, 0.8, 0.6], [0.2, 0.15, 0.1]].map(decoded);
    for (towards, up) in [
        (Vec3::NEG_Z, Vec3::Y),
        (Vec3::new(0.3, 1.0, -0.5), Vec3::Y),
        (Vec3::new(1.0, -0.6, 0.2), Vec3::X),
        (Vec3::Y, Vec3::Z),
    ] {
        let camera = Camera { towards, up, xfov: 0.7, ..Camera::default() };
        let stage = Stage { camera, background: SKY, ..Stage::default() };
        let image = frame(&stage, &[], &[]);
        let eye = Eye::new(&stage, WIDTH, HEIGHT);
        for (x, y, pixel) in image.enumerate_pixels().step_by(37) {
            let way = eye.lens.turn.transpose() * eye.lens.ray(Vec2::new(x as f32, y as f32) + 0.5);
            let sine = way.normalize().y;
            let share = 1.0 - (1.0 - sine.abs()).powi(3);
            let exact = horizon.lerp(if sine > 0.0 { zenith } else { ground }, share);
            assert!(off(pixel.0, exact) <= 1.0, "{pixel:?} at {x}, {y}, not {exact}");
        }
    }
}

#[test]
fn fog_lets_through_what_the_law_says_of_walls_dots_sprites_and_lines() {
    let red = color::decode(Vec3::new(0.7, 0.0, 0.0));
    let red = color::soften(red);
    let own = Vec3::new(0.3, 0.5, 0.6);
    for (density, from, distance) in
        [(0.0f32, 0.0f32, 3.0f32), (0.1, 0.0, 3.0), (0.5, 1.5, 4.0), (2.0, 5.0, 4.0), (9.0, 0.0, 4.0)]
    {
        let clear = (-density * (distance - from).max(0.0)).exp();
        let fog = Fog { color: Some(own), density, from };
        let exact = clear * red + (1.0 - clear) * color::decode(own);
        let place = Vec3::NEG_Z * distance;
        let of_wall = frame(&foggy(stage(vec![wall(distance, glowing(Vec3::new(0.7, 0.0, 0.0), 1.0))]), fog), &[], &[]);
        let colors = [[179, 0, 0, 255]; 2];
        // A disc of 0.9 pixels' radius, too small for light and shade.
        let point = Dot { size: 1.8 * distance / 147.4, ..dot(place, [179, 0, 0]) };
        let line = Line { ends: [place - Vec3::X * 0.1, place + Vec3::X * 0.1], widths: [0.2; 2], colors };
        let lens = Lens { width: WIDTH + 1, height: HEIGHT + 1 };
        for (kind, pixel) in [
            ("wall", middle(&of_wall)),
            ("dot", lens.middle(&foggy(stage(vec![]), fog), &[point], &[])),
            ("line", lens.middle(&foggy(stage(vec![]), fog), &[], &[line])),
            (
                "board",
                middle(&boards(&foggy(plain([255; 4]), fog), &[board(place, 1.0, [179, 0, 0, 255], Blend::Alpha)])),
            ),
        ] {
            assert!(off(pixel, exact) <= 1.5, "{kind}: {pixel:?}, not {exact}, {fog:?} at {distance}");
        }
        // Light only gets less: no fog of its own comes with it.
        let light =
            middle(&boards(&foggy(plain([255; 4]), fog), &[board(place, 1.0, [20, 20, 20, 255], Blend::Additive)]));
        let (behind, sum) = (linear(middle(&boards(&stage(vec![]), &[]))[0]), f64::from(clear) * linear(20));
        let exact = encoded(1.0 - (1.0 - behind) / (1.0 + sum));
        assert!((f64::from(light[0]) - exact).abs() <= 1.5, "{light:?}, {fog:?} at {distance}");
    }
}

/// The size of a picture whose middle is in the middle of a pixel.
struct Lens {
    width: u32,
    height: u32,
}

impl Lens {
    fn middle(&self, stage: &Stage, dots: &[Dot], segments: &[Line]) -> [u8; 3] {
        let image =
            Renderer::new(stage, self.width, self.height).frame(&Moving { dots, segments, ..Moving::default() });
        image[(self.width / 2, self.height / 2)].0
    }
}

#[test]
fn things_fade_into_the_sky_behind_them_in_fog_without_a_color() {
    let fog = Fog { color: None, density: 40.0, from: 0.0 };
    let bare = Stage { background: SKY, ..stage(vec![]) };
    let pieces = vec![wall(3.0, glowing(Vec3::ONE, 1.0))];
    let empty = frame(&bare, &[], &[]);
    // The middle of the samples of a pixel need not be its own.
    let most = |image: &RgbImage| image.iter().zip(empty.iter()).map(|(a, b)| a.abs_diff(*b)).max();
    let hidden = frame(&foggy(Stage { background: SKY, ..stage(pieces) }, fog), &[], &[]);
    assert!(most(&hidden) <= Some(1), "{:?}", most(&hidden));
    let hidden = frame(&foggy(bare, fog), &[dot(Vec3::NEG_Z * 4.0, [255, 0, 0])], &[]);
    assert!(most(&hidden) <= Some(2), "{:?}", most(&hidden));
}

/// A dot seen with an open shutter, or standing still.
fn exposed(stage: &Stage, dot: Dot) -> RgbImage {
    Renderer::new(stage, WIDTH, HEIGHT).frame(&Moving { exposed: true, dots: &[dot], ..Moving::default() })
}

/// All the red light in a picture.
fn red(image: &RgbImage) -> f64 {
    image.pixels().map(|pixel| linear(pixel[0])).sum()
}

#[test]
fn an_open_shutter_spreads_a_dot_along_its_way_and_keeps_its_light() {
    let black = stage(vec![]);
    let nothing = red(&frame(&black, &[], &[]));
    for (size, glow, alpha) in [(0.05, 0.0, 255), (0.3, 0.0, 255), (0.011, 0.0, 255), (0.1, 1.0, 12), (0.03, 1.0, 12)] {
        let color = [255, 0, 0, alpha];
        let still = Dot { size, glow, color, ..dot(Vec3::new(0.2, 0.1, -3.0), [255, 0, 0]) };
        let light = red(&exposed(&black, still)) - nothing;
        assert!(light > 0.1, "{light}");
        for way in [Vec3::X * 0.01, Vec3::X * 0.5, Vec3::new(-0.4, 0.3, 0.0), Vec3::new(0.01, -0.7, 0.0)] {
            let moved = Dot { previous: still.position - way, ..still };
            let seen = red(&exposed(&black, moved)) - nothing;
            // A ball's face is lit from one side, and of a long way each pixel is covered but a little.
            let tolerance = if size > 0.2 { 0.12 } else { 0.06 };
            assert!((seen / light - 1.0).abs() < tolerance, "{size} {glow} {way}: {seen}, not {light}");
        }
    }
}

#[test]
fn a_way_is_even_all_along_and_what_is_out_of_sight_takes_its_share_along() {
    let black = stage(vec![]);
    let nothing = frame(&black, &[], &[]);
    let at = |image: &RgbImage, x: u32| {
        (0..HEIGHT).map(|y| linear(image[(x, y)].0[0]) - linear(nothing[(x, y)].0[0])).sum::<f64>()
    };
    let half = black.camera.xfov.tan() * 3.0;
    let line = |from: f32, to: f32| {
        let end = |share: f32| Vec3::new(share * half, 0.0, -3.0);
        exposed(&black, Dot { previous: end(from), ..dot(end(to), [255, 0, 0]) })
    };
    let whole = line(-0.5, 0.5);
    let columns: Vec<f64> = (50..110).map(|x| at(&whole, x)).collect();
    let mean = columns.iter().sum::<f64>() / columns.len() as f64;
    assert!(columns.iter().all(|light| (light / mean - 1.0).abs() < 0.03), "{columns:?}");
    // Twice as long a way, half of it out of sight, is half as bright where it is seen.
    let left = line(-2.5, -0.5);
    let seen = (4..36).map(|x| at(&left, x)).sum::<f64>() / 32.0;
    assert!((seen / mean - 0.5).abs() < 0.02, "{seen} and {mean}");
}

#[test]
fn what_stands_for_a_point_shows_whole_where_it_lies_on_a_wall() {
    let stage = Stage { pieces: vec![wall(3.0, glowing(Vec3::ZERO, 1.0))], ..plain([255; 4]) };
    let seen = |distance: f32, sunk: f32| {
        let one = board(Vec3::NEG_Z * distance, 0.2, [255, 0, 0, 255], Blend::Alpha);
        linear(middle(&boards(&stage, &[Billboard { sunk, ..one }]))[0])
    };
    assert!(seen(3.0, 2.5) > 0.99 && seen(3.25, 2.5) > 0.99 && seen(3.75, 2.5) < 0.01);
    assert!((seen(3.0, 0.0) - 0.5).abs() < 0.05);
}

#[test]
fn a_clear_ball_takes_less_light_the_farther_out_it_is_looked_through() {
    let stage = Stage { background: Background::Plain(Vec3::ONE), ..stage(vec![]) };
    let ball = Dot { size: 0.8, color: [0, 0, 0, 200], ..dot(Vec3::NEG_Z * 2.0, [0; 3]) };
    let image = frame(&stage, &[ball], &[]);
    let eye = Eye::new(&stage, WIDTH, HEIGHT);
    let radius = 0.4 * eye.lens.pixels_per_metre(2.0);
    let left = 1.0 - 200.0 / 255.0f64;
    for x in WIDTH / 2..WIDTH {
        let out = f64::from((x as f32 + 0.5 - 0.5 * WIDTH as f32).hypot(0.5) / radius);
        if out < 0.9 {
            // No light is left but what passes along the chord, and a little of the ball's own shine.
            let exact = left.powf((1.0 - out * out).sqrt());
            let seen = linear(image[(x, HEIGHT / 2)].0[2]);
            assert!(seen > exact - 0.02 && seen < exact + 0.25, "{seen} at {out}, not {exact}");
        } else if out > 1.1 {
            assert_eq!(image[(x, HEIGHT / 2)].0, [255; 3]);
        }
    }
}
