//! Pictures hold what the scene says.

mod air;
mod moving;

use super::*;
use glam::Vec3;
use image::RgbImage;
use pointmass::draw::Line;
use pointmass::material::Blend;

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
    Piece { surface: shapes::plane(distance * Vec3::NEG_Z, Vec3::Z, 5.0), material, endless: false, lift: 0.0 }
}

fn dot(position: Vec3, [red, green, blue]: [u8; 3]) -> Dot {
    Dot { position, previous: position, color: [red, green, blue, 255], size: 0.05, glow: 0.0, solid: false }
}

fn frame(stage: &Stage, dots: &[Dot], segments: &[Line]) -> RgbImage {
    Renderer::new(stage, WIDTH, HEIGHT).frame(&Moving { dots, segments, ..Moving::default() })
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
            let line = Line::plain([place - Vec3::X, place + Vec3::X], [0, 0, 255, 255]);
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
    let image =
        frame(&stage(vec![Piece { surface, material: glowing(Vec3::X, 1.0), endless: false, lift: 0.0 }]), &[], &[]);
    for x in 0..WIDTH {
        assert!(image[(x, HEIGHT - 1)][0] > 200 && image[(x, 0)][0] < 50);
    }
}

#[test]
fn endless_ground_melts_into_the_background() {
    let surface = shapes::plane(0.3 * Vec3::NEG_Y, Vec3::Y, 1e4);
    let ground = Piece { surface, material: glowing(Vec3::X, 1.0), endless: true, lift: 0.0 };
    let image = frame(&stage(vec![ground]), &[], &[]);
    let column: Vec<u8> = (0..HEIGHT).map(|y| image[(80, y)][0]).collect();
    assert!(column.windows(2).all(|pair| pair[1].abs_diff(pair[0]) < 40), "{column:?}");
    assert!(column[HEIGHT as usize - 1] > 200);
}

#[test]
fn balls_cast_shadows_on_the_ground() {
    let white = Material { ambient: Vec3::ZERO, ..Material::default() };
    let piece = |surface| Piece { surface, material: white, endless: false, lift: 0.0 };
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
fn a_straight_line_in_parallel_light_is_alike_all_along() {
    let tangent = Camera::default().xfov.tan();
    let colors = |direction: Vec3| {
        let end = |side: f32| 3.0 * Vec3::new(side * tangent, 0.0, -1.0);
        let material = Material { diffuse: Vec3::ONE, specular: 0.5 * Vec3::ONE, ..Material::default() };
        let lines = vec![super::Line { a: end(-1.0), b: end(1.0), material }];
        let lights = vec![Light::Directional { color: 0.5 * Vec3::ONE, direction }];
        let image = frame(&Stage { lines, lights, ..Stage::default() }, &[], &[]);
        let column = |x: u32| (0..HEIGHT).map(|y| image[(x, y)].0[0]).max().unwrap_or(0);
        (10..WIDTH - 10).map(column).collect::<Vec<_>>()
    };
    let first = colors(Vec3::NEG_Z)[0];
    assert!(first > 50, "{first}");
    for direction in [Vec3::NEG_Z, Vec3::X, Vec3::NEG_X, Vec3::Y, Vec3::new(1.0, -1.0, -0.2)] {
        let colors = colors(direction);
        assert!(colors.iter().all(|&color| color.abs_diff(first) <= 1), "{direction} {colors:?}");
    }
}

#[test]
fn nothing_that_is_not_finite_is_drawn() {
    let sound = stage(vec![wall(3.0, Material::default())]);
    let mut broken = sound.clone();
    broken.pieces.push(Piece { surface: shapes::sphere(NAN, 1.0), ..Piece::default() });
    broken.pieces.push(Piece { surface: shapes::sphere(Vec3::ZERO, f32::INFINITY), ..Piece::default() });
    broken.lines.push(super::Line { a: Vec3::NEG_Z, b: NAN, material: Material::default() });
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
    let segments = [Line::plain([here, NAN], [255; 4])];
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
        let image = Renderer::new(&stage, width, height).frame(&Moving { dots: &dots, ..Moving::default() });
        assert_eq!(image.dimensions(), (width, height));
    }
}

/// A stage whose only picture is one colour all over.
fn plain(color: [u8; 4]) -> Stage {
    let picture = image::RgbaImage::from_pixel(8, 8, image::Rgba(color));
    Stage { pictures: [Flipbook::new(&picture, [1, 1], false)].into(), ..stage(vec![]) }
}

fn board(center: Vec3, half: f32, color: [u8; 4], blend: Blend) -> Billboard {
    Billboard { center, right: Vec3::X * half, up: Vec3::Y * half, color, picture: 0, frame: 0, blend, sunk: 0.0 }
}

fn boards(stage: &Stage, billboards: &[Billboard]) -> RgbImage {
    Renderer::new(stage, WIDTH, HEIGHT).frame(&Moving { billboards, ..Moving::default() })
}

/// From a byte of a picture to linear light.
fn linear(byte: u8) -> f64 {
    f64::from(color::decode(Vec3::splat(f32::from(byte) / 255.0)).x)
}

/// The opposite.
fn encoded(light: f64) -> f64 {
    255.0 * if light <= 0.003_130_8 { light * 12.92 } else { 1.055 * light.powf(1.0 / 2.4) - 0.055 }
}

#[test]
fn billboards_cover_what_geometry_has_them_cover() {
    let stage = plain([255; 4]);
    let (focal, empty) = (0.5 * f64::from(WIDTH) / f64::from(stage.camera.xfov.tan()), boards(&stage, &[]));
    for (place, half, turn) in
        [(Vec3::NEG_Z * 4.0, 0.3, 0.0), (Vec3::new(0.2, -0.3, -5.0), 0.4, 0.6), (Vec3::new(-0.4, 0.1, -3.0), 0.15, 2.0)]
    {
        for blend in [Blend::Alpha, Blend::Premultiplied, Blend::Opaque] {
            let turned = glam::Mat3::from_rotation_z(turn);
            let one = Billboard {
                right: turned * Vec3::X * half,
                up: turned * Vec3::Y * half,
                ..board(place, half, [255, 0, 0, 255], blend)
            };
            let image = boards(&stage, &[one]);
            let seen = covered(&image, &empty);
            let exact = (2.0 * f64::from(half) * focal / f64::from(-place.z)).powi(2);
            assert!((seen / exact - 1.0).abs() < 0.01, "{place} {blend:?}: {seen} of {exact} pixels");
        }
    }
}

#[test]
fn a_thousand_layers_of_alpha_are_their_exact_composite() {
    let stage = Stage { background: Background::Plain(Vec3::new(0.0, 0.0, 0.5)), ..plain([255, 255, 255, 255]) };
    for opacity in [1u8, 3, 40] {
        let layers: Vec<_> = (0..1000)
            .map(|i| board(Vec3::NEG_Z * (9.0 - 0.005 * i as f32), 2.0, [255, 0, 0, opacity], Blend::Alpha))
            .collect();
        let empty = middle(&boards(&stage, &[]));
        let [red, _, blue] = middle(&boards(&stage, &layers));
        let left = (1.0 - f64::from(opacity) / 255.0).powi(1000);
        let exact = [1.0 - left * (1.0 - linear(empty[0])), left * linear(empty[2])].map(encoded);
        for (byte, exact) in [red, blue].into_iter().zip(exact) {
            assert!((f64::from(byte) - exact).abs() <= 1.0, "{opacity}: {byte}, not {exact}");
        }
    }
}

#[test]
fn light_adds_up_to_the_same_in_any_order() {
    let stage = plain([255, 255, 255, 200]);
    // All of one depth, so that the order in which they come is the order in which they are painted.
    let mut lights: Vec<_> = (0..500u32)
        .map(|i| {
            let place = Vec3::new((i % 7) as f32 * 0.03, (i % 11) as f32 * 0.02, -3.0);
            board(
                place,
                0.05 + (i % 13) as f32 * 0.01,
                [(i % 256) as u8, 30, (i * 7 % 256) as u8, (i % 90) as u8],
                Blend::Additive,
            )
        })
        .collect();
    let first = boards(&stage, &lights);
    lights.reverse();
    assert_eq!(boards(&stage, &lights), first);
    lights.sort_by_key(|light| light.color);
    assert_eq!(boards(&stage, &lights), first);
    assert!(middle(&first)[0] > 50);
}

#[test]
fn billboards_are_soft_where_they_stand_in_a_wall() {
    let wall = wall(3.0, glowing(Vec3::ZERO, 1.0));
    let stage = Stage { pieces: vec![wall], ..plain([255; 4]) };
    let seen = |distance: f32| {
        let half = 0.2;
        linear(middle(&boards(&stage, &[board(Vec3::NEG_Z * distance, half, [255, 0, 0, 255], Blend::Alpha)]))[0])
    };
    let all: Vec<f64> = (0..=40).map(|i| seen(2.5 + 0.025 * i as f32)).collect();
    assert!(all[0] > 0.99 && all[40] < 0.01 && (all[20] - 0.5).abs() < 0.05, "{all:?}");
    assert!(all.windows(2).all(|two| two[1] <= two[0] + 0.01 && two[0] - two[1] < 0.1), "{all:?}");
}

/// How much of a picture is covered with red, in pixels as red as the reddest, over what is there without.
fn covered(image: &RgbImage, empty: &RgbImage) -> f64 {
    let share = |(pixel, behind): (&image::Rgb<u8>, &image::Rgb<u8>)| {
        let (seen, behind) = (linear(pixel[0]), linear(behind[0]));
        (seen - behind) / (1.0 - behind)
    };
    let shares = || image.pixels().zip(empty.pixels()).map(share);
    shares().sum::<f64>() / shares().fold(f64::MIN_POSITIVE, f64::max)
}

#[test]
fn balls_boxes_and_ribbons_cover_what_geometry_has_them_cover() {
    let black = stage(vec![]);
    let lens = camera::Lens::new(&black.camera, WIDTH as usize, HEIGHT as usize);
    let scale = lens.pixels_per_metre(2.0);
    let empty = frame(&black, &[], &[]);
    let is_near = |image: &RgbImage, exact: f32| {
        let (area, exact) = (covered(image, &empty), f64::from(exact));
        assert!((area - exact).abs() < 0.01 * exact, "{area} pixels, not {exact}");
    };
    // A box whose front is two metres away, of its own light.
    let (width, height) = (0.7, 0.4);
    let surface = shapes::cuboid(Vec3::new(0.02, -0.01, -2.5), Vec3::new(width, height, 1.0));
    let piece = Piece { surface, material: glowing(Vec3::X, 1.0), endless: false, lift: 0.0 };
    let front = width * height * scale * scale;
    is_near(&frame(&stage(vec![piece.clone()]), &[], &[]), front);
    // The same ball as a piece and as a dot: its outline is that of the cone around it.
    let radius: f32 = 0.3;
    let surface = shapes::sphere(2.0 * Vec3::NEG_Z, radius);
    let seen = std::f32::consts::PI * (radius * scale).powi(2) / (1.0 - (radius / 2.0).powi(2));
    is_near(&frame(&stage(vec![Piece { surface, ..piece }]), &[], &[]), seen);
    // Ribbons of any width, whole or in parts, getting narrower or not.
    for (from, to) in [(0.1, 0.1), (0.1, 0.02), (0.03, 0.1)] {
        let ends = [Vec3::new(-0.5, -0.2, -2.0), Vec3::new(0.45, 0.31, -2.0)];
        let exact = 0.5 * (from + to) * ends[0].distance(ends[1]) * scale * scale;
        for parts in [1u16, 7, 40] {
            let at = |i: u16| f32::from(i) / f32::from(parts);
            let line = |i: u16| Line {
                ends: [at(i), at(i + 1)].map(|t| ends[0].lerp(ends[1], t)),
                widths: [at(i), at(i + 1)].map(|t| from + t * (to - from)),
                colors: [[255, 0, 0, 255]; 2],
            };
            let ribbons: Vec<_> = (0..parts).map(line).collect();
            let drawn = Renderer::new(&black, WIDTH, HEIGHT).frame(&Moving { ribbons: &ribbons, ..Moving::default() });
            is_near(&drawn, exact);
        }
    }
}

#[test]
fn a_ribbon_in_parts_looks_as_in_one_though_it_lets_light_through() {
    let black = stage(vec![]);
    let ends = [Vec3::new(-0.4, 0.3, -2.0), Vec3::new(0.5, -0.2, -3.0)];
    let drawn = |parts: u16| {
        let at = |i: u16| f32::from(i) / f32::from(parts);
        let alpha = |t: f32| [255, 0, 0, (200.0 * (1.0 - t)) as u8];
        let line = |i: u16| Line {
            ends: [at(i), at(i + 1)].map(|t| ends[0].lerp(ends[1], t)),
            widths: [0.2; 2],
            colors: [at(i), at(i + 1)].map(alpha),
        };
        let ribbons: Vec<_> = (0..parts).map(line).collect();
        Renderer::new(&black, WIDTH, HEIGHT).frame(&Moving { ribbons: &ribbons, ..Moving::default() })
    };
    let (whole, parts) = (drawn(1), drawn(50));
    // In the picture colours and widths of one line go evenly, which perspective does not.
    let differ = whole.pixels().zip(parts.pixels()).filter(|(a, b)| a[0].abs_diff(b[0]) > 24).count();
    let area = covered(&whole, &frame(&black, &[], &[]));
    assert!((differ * 100) as f64 <= area + 100.0, "{differ} pixels");
    // Nothing is painted twice: neither is more opaque than its own colour.
    let most = parts.pixels().map(|pixel| pixel[0]).max().unwrap_or(0);
    let own = whole.pixels().map(|pixel| pixel[0]).max().unwrap_or(0);
    assert!(most <= own.saturating_add(3), "{most} and {own}");
}

#[test]
fn what_is_lifted_shows_on_what_it_lies_behind_by_less() {
    let cloth = |lift| Piece { lift, ..wall(2.01, glowing(Vec3::X, 1.0)) };
    let ball = wall(2.0, glowing(Vec3::Z, 1.0));
    for (lift, shows) in [(0.0, false), (0.005, false), (0.02, true)] {
        let image = frame(&stage(vec![ball.clone(), cloth(lift)]), &[], &[]);
        assert_eq!(middle(&image)[0] > 200, shows, "{lift}");
    }
}

/// A wall in ambient light alone, red at its left, blue at its right: of both half as much in the middle, in linear light, in perspective too.
#[test]
fn a_surface_has_the_colors_of_its_corners_and_those_between() {
    for lean in [0.0, 1.0] {
        let corner = |x: f32, y: f32| Vec3::new(x, y, -3.0 - lean * x);
        let vertices = vec![corner(-2.0, -2.0), corner(2.0, -2.0), corner(2.0, 2.0), corner(-2.0, 2.0)];
        let tints = vec![Vec3::X, Vec3::Z, Vec3::Z, Vec3::X];
        let surface = Surface { vertices, tints, normals: vec![], triangles: vec![[0, 1, 2], [0, 2, 3]] };
        let material = Material { ambient: Vec3::ONE, ..Material::default() };
        let piece = Piece { surface, material, endless: false, lift: 0.0 };
        let light = |tints: bool| {
            let surface =
                Surface { tints: if tints { piece.surface.tints.clone() } else { vec![] }, ..piece.surface.clone() };
            let stage = Stage { ambient: Vec3::splat(0.5), ..stage(vec![Piece { surface, ..piece.clone() }]) };
            middle(&frame(&stage, &[], &[])).map(linear)
        };
        let ([red, green, blue], [white, ..]) = (light(true), light(false));
        assert!(green < 1e-3 && white > 0.05, "{green} of {white}");
        assert!((red / white - 0.5).abs() < 0.04 && (blue / white - 0.5).abs() < 0.04, "{red} {blue} of {white}");
    }
}
