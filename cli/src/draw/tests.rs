//! What is in the pictures.

use super::*;
use glam::Vec3;
use image::RgbImage;

const WIDTH: u32 = 160;
const HEIGHT: u32 = 120;
const NAN: Vec3 = Vec3::splat(f32::NAN);

/// A stage that shows nothing but what a material sends out by itself.
fn stage(pieces: Vec<Piece>) -> Stage {
    Stage { pieces, ..Stage::default() }
}

fn glowing(emission: Vec3, opacity: f32) -> Material {
    Material { emission, opacity, ..Material::default() }
}

/// A wall across the view at a distance.
fn wall(distance: f32, material: Material) -> Piece {
    Piece { surface: shapes::plane(distance * Vec3::NEG_Z, Vec3::Z, 5.0), material, endless: false }
}

fn dot(position: Vec3, [red, green, blue]: [u8; 3]) -> Dot {
    Dot { position, previous: position, color: [red, green, blue, 255], size: 0.05, glow: 0.0, solid: false }
}

fn frame(stage: &Stage, dots: &[Dot], segments: &[Segment]) -> RgbImage {
    Renderer::new(stage, WIDTH, HEIGHT).frame(dots, segments)
}

fn middle(image: &RgbImage) -> [u8; 3] {
    image[(WIDTH / 2, HEIGHT / 2)].0
}

/// The mean place of all red in a picture, in pixels.
fn red_spot(image: &RgbImage) -> (f32, f32) {
    let (mut x_sum, mut y_sum, mut sum) = (0.0, 0.0, 0.0);
    for (x, y, pixel) in image.enumerate_pixels() {
        let red = f32::from(pixel[0].saturating_sub(pixel[1]));
        x_sum += red * (x as f32 + 0.5);
        y_sum += red * (y as f32 + 0.5);
        sum += red;
    }
    (x_sum / sum, y_sum / sum)
}

#[test]
fn dots_are_where_geometry_has_them() {
    let stage = stage(vec![]);
    let tangent = stage.camera.xfov.tan();
    let (width, height) = (WIDTH as f32, HEIGHT as f32);
    for (across, up) in [(0.0, 0.0), (0.9, 0.0), (-0.5, 0.4), (0.123, -0.456)] {
        let place = 3.0 * Vec3::new(across * tangent, up * tangent, -1.0);
        for glow in [0.0, 0.5, 1.0] {
            let (x, y) = red_spot(&frame(&stage, &[Dot { glow, ..dot(place, [255, 0, 0]) }], &[]));
            let (right_x, right_y) = (0.5 * width * (1.0 + across), 0.5 * (height - width * up));
            assert!((x - right_x).abs() < 0.2 && (y - right_y).abs() < 0.2, "{x} {y} for {right_x} {right_y}");
        }
    }
}

#[test]
fn what_is_nearer_hides_what_is_farther() {
    let (near, far) = (wall(2.0, glowing(0.5 * Vec3::X, 1.0)), wall(3.0, glowing(0.5 * Vec3::Y, 1.0)));
    for pieces in [vec![near.clone(), far.clone()], vec![far, near]] {
        let stage = stage(pieces);
        assert_eq!(middle(&frame(&stage, &[], &[]))[1], 0);
        for (distance, seen) in [(1.5, true), (2.5, false)] {
            let place = distance * Vec3::NEG_Z;
            let line = Segment { a: place - Vec3::X, b: place + Vec3::X, color: [0, 0, 255, 255] };
            for image in [frame(&stage, &[dot(place, [0, 0, 255])], &[]), frame(&stage, &[], &[line])] {
                assert_eq!(middle(&image)[2] > 100, seen, "at {distance}");
            }
        }
    }
    let (near, far) = (dot(1.0 * Vec3::NEG_Z, [255, 0, 0]), dot(2.0 * Vec3::NEG_Z, [0, 255, 0]));
    let images = [[near, far], [far, near]].map(|dots| frame(&stage(vec![]), &dots, &[]));
    assert_eq!(images[0], images[1]);
    assert!(middle(&images[0])[0] > 100);
}

#[test]
fn glass_shows_what_is_behind_it() {
    let stage = stage(vec![wall(2.0, glowing(0.5 * Vec3::X, 0.5)), wall(3.0, glowing(0.5 * Vec3::Y, 1.0))]);
    let [red, green, blue] = middle(&frame(&stage, &[], &[]));
    assert_eq!((red, blue), (green, 0));
    let behind = frame(&stage, &[dot(2.5 * Vec3::NEG_Z, [0, 0, 255])], &[]);
    assert!(middle(&behind)[2] > 100);
}

#[test]
fn ground_under_the_camera_reaches_the_edge_of_the_picture() {
    let surface = shapes::plane(0.3 * Vec3::NEG_Y, Vec3::Y, 1e4);
    let image = frame(&stage(vec![Piece { surface, material: glowing(Vec3::X, 1.0), endless: false }]), &[], &[]);
    for x in 0..WIDTH {
        assert!(image[(x, HEIGHT - 1)][0] > 200 && image[(x, 0)][0] < 50);
    }
}

#[test]
fn endless_ground_melts_into_the_background() {
    let surface = shapes::plane(0.3 * Vec3::NEG_Y, Vec3::Y, 1e4);
    let ground = Piece { surface, material: glowing(Vec3::X, 1.0), endless: true };
    let image = frame(&stage(vec![ground]), &[], &[]);
    let column: Vec<u8> = (0..HEIGHT).map(|y| image[(80, y)][0]).collect();
    assert!(column.windows(2).all(|pair| pair[1].abs_diff(pair[0]) < 40), "{column:?}");
    assert!(column[HEIGHT as usize - 1] > 200);
}

#[test]
fn balls_cast_shadows_on_the_ground() {
    let white = Material { ambient: Vec3::ZERO, ..Material::default() };
    let piece = |surface| Piece { surface, material: white, endless: false };
    let ground = piece(shapes::plane(Vec3::NEG_Y, Vec3::Y, 20.0));
    let ball = piece(shapes::sphere(Vec3::new(0.0, 2.0, -4.0), 0.5));
    let sun = Light::Directional { color: Vec3::ONE, direction: Vec3::NEG_Y };
    let lit = |pieces| Stage { lights: vec![sun], ..stage(pieces) };
    let below = |stage: &Stage| {
        let lens = camera::Lens::new(&stage.camera, WIDTH as usize, HEIGHT as usize);
        let at = lens.project(lens.view(Vec3::new(0.0, -1.0, -4.0)));
        frame(stage, &[], &[])[(at.x as u32, at.y as u32)][0]
    };
    let (open, shaded) = (below(&lit(vec![ground.clone()])), below(&lit(vec![ground, ball])));
    assert!(shaded < open / 2 + 20, "{shaded} in the shadow, {open} outside");
}

#[test]
fn streaks_and_shadows_follow_dots() {
    let head = Vec3::new(0.3, 0.0, -2.0);
    for glow in [0.0, 1.0] {
        let moving = Dot { previous: -head.with_z(2.0), glow, ..dot(head, [255, 0, 0]) };
        let image = frame(&stage(vec![]), &[moving], &[]);
        assert!(middle(&image)[0] > 10);
    }
    let ground =
        Piece { surface: shapes::plane(0.5 * Vec3::NEG_Y, Vec3::Y, 9.0), ..wall(1.0, glowing(Vec3::ONE, 1.0)) };
    let stage = stage(vec![ground]);
    let dark = |image: &RgbImage| image.pixels().map(|pixel| u64::from(pixel[2])).sum::<u64>();
    let low = frame(&stage, &[dot(Vec3::new(0.0, -0.4, -2.0), [0, 0, 255])], &[]);
    let high = frame(&stage, &[dot(Vec3::new(0.0, 0.2, -2.0), [0, 0, 255])], &[]);
    assert!(dark(&low) < dark(&high));
}

#[test]
fn nothing_that_is_not_finite_is_drawn() {
    let sound = stage(vec![wall(3.0, Material::default())]);
    let mut broken = sound.clone();
    broken.pieces.push(Piece { surface: shapes::sphere(NAN, 1.0), ..Piece::default() });
    broken.pieces.push(Piece { surface: shapes::sphere(Vec3::ZERO, f32::INFINITY), ..Piece::default() });
    broken.lines.push(Line { a: Vec3::NEG_Z, b: NAN, material: Material::default() });
    let (color, attenuation) = (Vec3::ONE, [1.0, 0.0, 0.0]);
    broken.lights.push(Light::Point { color, position: NAN, attenuation });
    broken.lights.push(Light::Directional { color: NAN, direction: Vec3::NEG_Z });
    let here = Vec3::NEG_Z;
    let dots = [
        dot(NAN, [255; 3]),
        dot(here * f32::INFINITY, [255; 3]),
        dot(Vec3::Z, [255; 3]),
        Dot { color: [255, 255, 255, 0], ..dot(here, [255; 3]) },
    ];
    let segments = [Segment { a: here, b: NAN, color: [255; 4] }];
    assert_eq!(frame(&broken, &dots, &segments), frame(&sound, &[], &[]));

    let plain = frame(&sound, &[Dot { size: 0.0, ..dot(here, [255; 3]) }], &[]);
    let odd = Dot { size: f32::NAN, glow: f32::NAN, previous: NAN, ..dot(here, [255; 3]) };
    assert_eq!(frame(&sound, &[odd], &[]), plain);
}

#[test]
fn a_solid_ball_is_hidden_by_what_is_before_its_face() {
    let stage = stage(vec![wall(3.0, Material::default())]);
    let ball = |distance: f32, solid| Dot { size: 0.4, solid, ..dot(distance * Vec3::NEG_Z, [255, 0, 0]) };
    let seen = |dot: Dot| {
        let [red, green, _] = middle(&frame(&stage, &[dot], &[]));
        red > green.saturating_add(50)
    };
    assert!(seen(ball(2.8, true)) && seen(ball(3.1, true)), "its face is before the wall");
    assert!(!seen(ball(3.25, true)), "all of it is behind the wall");
    assert!(seen(ball(3.25, false)), "others are forgiven");
}

#[test]
fn pictures_repeat_to_the_byte_and_have_any_size() {
    let stage = stage(vec![Piece { surface: shapes::cone(2.0 * Vec3::NEG_Z, 0.5, 1.0), ..Piece::default() }]);
    let dots = [Dot { glow: 0.7, ..dot(Vec3::NEG_Z, [200, 100, 50]) }];
    assert_eq!(frame(&stage, &dots, &[]), frame(&stage, &dots, &[]));
    for (width, height) in [(0, 0), (0, 5), (5, 0), (1, 1), (3, 500), (500, 3)] {
        let image = Renderer::new(&stage, width, height).frame(&dots, &[]);
        assert_eq!(image.dimensions(), (width, height));
    }
}
