//! Glows and ribbons on their way, and what comes between.

use super::super::*;
use super::air::foggy;
use super::{HEIGHT, WIDTH, board, boards, dot, frame, glowing, linear, middle, plain, stage, wall};
use glam::Vec3;
use image::RgbImage;
use pointmass::draw::Line;
use pointmass::material::Blend;

#[test]
fn a_glow_on_its_way_is_whole_where_it_is_and_its_trace_is_behind() {
    let glow = Dot { glow: 1.0, size: 0.3, ..dot(Vec3::NEG_Z * 3.0, [255, 60, 0]) };
    let seen = |way: f32| {
        let image = frame(&stage(vec![]), &[Dot { previous: glow.position - Vec3::X * way, ..glow }], &[]);
        (0..WIDTH).map(|x| image[(x, HEIGHT / 2)].0[0]).collect::<Vec<_>>()
    };
    let lens = camera::Lens::new(&Camera::default(), WIDTH as usize, HEIGHT as usize);
    for way in [0.03, 0.1, 0.3, 0.8] {
        let row = seen(way);
        // Of two pixels as far before and behind it, the one behind is no darker.
        let (behind, before) = row.split_at(row.len() / 2);
        let darker = behind.iter().rev().zip(before).filter(|(behind, before)| *behind + 1 < **before);
        assert_eq!(darker.count(), 0, "{way}: {row:?}");
        let back = (0.6 * way * lens.pixels_per_metre(3.0)) as usize;
        assert!(before[0] > 150 && behind[behind.len() - 1 - back] > 50, "{way}: {row:?}");
    }
}

#[test]
fn a_glow_fades_in_fog_and_darkens_nothing() {
    let white = Vec3::splat(0.9);
    let bright = Stage { background: Background::Plain(white), ..stage(vec![]) };
    let place = Vec3::NEG_Z * 4.0;
    let empty = middle(&frame(&bright, &[], &[])).map(linear);
    for way in [Vec3::ZERO, Vec3::X * 0.3] {
        for exposed in [false, true] {
            let glow = Dot { glow: 1.0, size: 0.8, previous: place - way, ..dot(place, [255, 120, 40]) };
            let seen = |stage: &Stage| {
                let moving = Moving { exposed, dots: &[glow], ..Moving::default() };
                middle(&Renderer::new(stage, WIDTH, HEIGHT).frame(&moving)).map(linear)
            };
            let clear = seen(&bright);
            let taken = |light: [f64; 3], channel: usize| (empty[channel] - light[channel]).abs();
            for density in [0.1, 0.5, 1.0, 2.0] {
                let foggy = seen(&foggy(bright.clone(), Fog { color: Some(white), density, from: 0.0 }));
                for channel in 0..3 {
                    let most = if density < 2.0 { taken(clear, channel) } else { 0.0 };
                    let is_between = taken(foggy, channel) <= most + 0.02;
                    assert!(is_between, "{density}: {foggy:?}, {clear:?} in clear air, {empty:?} alone");
                }
            }
        }
    }
}

/// What is seen through a pane is its colour times what that lets through, and the pane's own over it; before it, it is itself.
#[test]
fn a_pane_tints_what_is_behind_it_whatever_that_is() {
    let pane = wall(2.0, glowing(Vec3::new(0.0, 0.0, 0.6), 0.6));
    let (clear, glass) = (Stage { background: Background::Plain(Vec3::ZERO), ..plain([255; 4]) }, vec![pane]);
    let glazed = Stage { pieces: glass, ..clear.clone() };
    let alone = middle(&frame(&glazed, &[], &[])).map(linear);
    let ways = |distance: f32, stage: &Stage| {
        let place = Vec3::NEG_Z * distance;
        let red = [230, 30, 0];
        let ends = [place - Vec3::X * 0.2, place + Vec3::X * 0.2];
        let line = Line { ends, widths: [0.2; 2], colors: [[230, 30, 0, 255]; 2] };
        let ribbons = Moving { ribbons: &[line], ..Moving::default() };
        let moved = Dot { previous: place - Vec3::X * 0.4, size: 0.3, ..dot(place, red) };
        let exposed = Moving { exposed: true, dots: &[moved], ..Moving::default() };
        [
            ("ball", frame(stage, &[Dot { size: 0.3, solid: true, ..dot(place, red) }], &[])),
            ("point", frame(stage, &[dot(place, red)], &[])),
            ("line", frame(stage, &[], &[line])),
            ("ribbon", Renderer::new(stage, WIDTH, HEIGHT).frame(&ribbons)),
            ("sprite", boards(stage, &[board(place, 0.3, [230, 30, 0, 255], Blend::Alpha)])),
            ("light", boards(stage, &[board(place, 0.3, [40, 30, 0, 255], Blend::Additive)])),
            ("way", Renderer::new(stage, WIDTH, HEIGHT).frame(&exposed)),
            ("glow", frame(stage, &[Dot { glow: 1.0, size: 0.3, color: [230, 30, 0, 30], ..dot(place, red) }], &[])),
        ]
    };
    for (distance, is_behind) in [(3.0, true), (1.5, false)] {
        for ((kind, bare), (_, seen)) in ways(distance, &clear).into_iter().zip(ways(distance, &glazed)) {
            let (bare, seen) = (middle(&bare).map(linear), middle(&seen).map(linear));
            let through = if is_behind { 0.4 } else { 1.0 };
            // Light of a ratio is bent a little where it adds up.
            let tolerance = if matches!(kind, "light" | "glow") { 0.12 } else { 0.02 };
            assert!((seen[0] - through * bare[0]).abs() <= tolerance * bare[0], "{kind}: {seen:?}, {bare:?} without");
            if is_behind {
                assert!((seen[2] - alone[2]).abs() < 0.05, "{kind}: {seen:?} and {alone:?}");
            }
        }
    }
}

/// Both triangles of a pane, and the edge between them, let through as much.
#[test]
fn a_pane_is_one_layer_where_its_triangles_meet() {
    let surface = shapes::plane(2.0 * Vec3::NEG_Z, Vec3::Z, 0.9);
    let pane = Piece { surface, ..wall(2.0, glowing(Vec3::ZERO, 0.5)) };
    let image = boards(
        &Stage { pieces: vec![pane], ..plain([255; 4]) },
        &[board(Vec3::NEG_Z * 4.0, 9.0, [200, 200, 200, 255], Blend::Alpha)],
    );
    let lens = camera::Lens::new(&Camera::default(), WIDTH as usize, HEIGHT as usize);
    let (first, half) = (middle(&image), (0.85 * lens.pixels_per_metre(2.0)) as u32);
    for (x, y, pixel) in image.enumerate_pixels() {
        if x.abs_diff(WIDTH / 2) < half && y.abs_diff(HEIGHT / 2) < half {
            assert!(pixel.0[0].abs_diff(first[0]) <= 1, "{pixel:?} at {x}, {y}, and {first:?}");
        }
    }
}

/// The ribbon through some places, of one width and opacity.
fn ribbon(places: &[Vec3], width: f32, opacity: u8) -> RgbImage {
    let line = |ends: &[Vec3]| Line { ends: [ends[0], ends[1]], widths: [width; 2], colors: [[255, 0, 0, opacity]; 2] };
    let ribbons: Vec<_> = places.windows(2).map(line).collect();
    let black = Stage { background: Background::Plain(Vec3::ZERO), ..stage(vec![]) };
    Renderer::new(&black, WIDTH, HEIGHT).frame(&Moving { ribbons: &ribbons, ..Moving::default() })
}

#[test]
fn a_ribbon_has_neither_cracks_nor_seams_where_it_bends() {
    let arc = |parts: u16, turn: f32, radius: f32| {
        let place = |i: u16| {
            let (sin, cos) = (turn * f32::from(i) / f32::from(parts)).sin_cos();
            Vec3::new(radius * cos, radius * sin - 0.2, -3.0)
        };
        (0..=parts).map(place).collect::<Vec<_>>()
    };
    let corner = |x: f32, y: f32| vec![Vec3::new(-0.5, 0.0, -3.0), Vec3::new(0.0, 0.0, -3.0), Vec3::new(x, y, -3.0)];
    let stage = Stage { background: Background::Plain(Vec3::ZERO), ..stage(vec![]) };
    let lens = camera::Lens::new(&stage.camera, WIDTH as usize, HEIGHT as usize);
    let scale = lens.pixels_per_metre(3.0);
    for (places, width) in [
        (arc(4, 2.0, 0.4), 0.2),
        (arc(9, 3.0, 0.4), 0.2),
        (arc(40, 3.0, 0.4), 0.3),
        (corner(0.0, 0.5), 0.2),
        (corner(-0.4, 0.3), 0.2),
        (corner(-0.5, 0.05), 0.15),
    ] {
        let image = ribbon(&places, width, 128);
        let seen = |pixel: &image::Rgb<u8>| linear(pixel[0]);
        let whole = 128.0 / 255.0;
        for (x, y, pixel) in image.enumerate_pixels() {
            // Where the middle of the pixel is, and how far that is from the middle of the ribbon.
            let at = glam::Vec2::new(x as f32 + 0.5 - 0.5 * WIDTH as f32, 0.5 * HEIGHT as f32 - y as f32 - 0.5) / scale;
            let part = |ends: &[Vec3]| {
                let [a, b] = [ends[0].truncate(), ends[1].truncate()];
                let along = ((at - a).dot(b - a) / (b - a).length_squared()).clamp(0.0, 1.0);
                (at.distance(a + along * (b - a)), along)
            };
            let parts: Vec<_> = places.windows(2).map(part).collect();
            let nearest = parts.iter().map(|part| part.0).fold(f32::INFINITY, f32::min);
            // The ends of the whole are cut off straight.
            let is_end = parts.first().is_some_and(|&(apart, along)| apart == nearest && along == 0.0)
                || parts.last().is_some_and(|&(apart, along)| apart == nearest && along == 1.0);
            if nearest < 0.5 * width - 1.0 / scale && !is_end {
                assert!((seen(pixel) - whole).abs() < 0.03, "{} at {at}, {nearest} of {width} off", seen(pixel));
            }
            assert!(seen(pixel) < whole + 0.03, "painted twice at {at}: {}", seen(pixel));
        }
    }
}

/// A white ball has the colour of the lights, as far as their light is not white.
#[test]
fn a_ball_is_lit_in_the_color_of_the_lights_and_is_seen_without() {
    let lit = |color: Vec3, ball: [u8; 3]| {
        let lights = vec![Light::Directional { color, direction: Vec3::NEG_Z }];
        let stage = Stage { lights, ..stage(vec![]) };
        middle(&frame(&stage, &[Dot { size: 0.6, solid: true, ..dot(Vec3::NEG_Z * 3.0, ball) }], &[]))
    };
    let white = lit(Vec3::ONE, [255; 3]);
    assert_eq!(white, lit(Vec3::splat(0.3), [255; 3]), "light of any strength");
    let [red, green, blue] = lit(Vec3::ZERO, [255; 3]);
    assert!(red == green && green == blue && red > 100, "and none: {red} {green} {blue}");
    let [red, green, blue] = lit(Vec3::X, [255; 3]);
    assert!(red == white[0] && green == blue && green < red - 60, "{red} {green} {blue}");
    assert!(lit(Vec3::X, [0, 255, 0])[1] > 80, "a ball is there to be seen");
}

#[test]
fn what_has_an_edge_casts_shadows_from_both_sides() {
    let white = Material { ambient: Vec3::ZERO, ..Material::default() };
    let piece = |surface| Piece { surface, material: white, endless: false, lift: 0.0 };
    let ground = piece(shapes::plane(Vec3::NEG_Y, Vec3::Y, 20.0));
    let sun = Light::Directional { color: Vec3::ONE, direction: Vec3::NEG_Y };
    let lit = |more: Option<Surface>| {
        let pieces = std::iter::once(ground.clone()).chain(more.map(piece)).collect();
        let stage = Stage { lights: vec![sun], ..stage(pieces) };
        let lens = camera::Lens::new(&stage.camera, WIDTH as usize, HEIGHT as usize);
        let at = lens.project(lens.view(Vec3::new(0.0, -1.0, -4.0)));
        frame(&stage, &[], &[])[(at.x as u32, at.y as u32)].0[0]
    };
    let corner = |x: f32, z: f32| Vec3::new(x, 2.0, -4.0 + z);
    let triangle = |order: [u32; 3]| shapes::mesh(&[corner(-1.0, 1.0), corner(1.0, 1.0), corner(0.0, -1.0)], &[order]);
    let open = lit(None);
    for (name, surface) in [
        ("a disc from above", shapes::disc(corner(0.0, 0.0), Vec3::Y, 0.6)),
        ("a disc from below", shapes::disc(corner(0.0, 0.0), Vec3::NEG_Y, 0.6)),
        ("a triangle", triangle([0, 1, 2])),
        ("the same from below", triangle([0, 2, 1])),
        ("a box", shapes::cuboid(corner(0.0, 0.0), Vec3::splat(0.8))),
    ] {
        let shaded = lit(Some(surface));
        assert!(shaded < open / 2 + 20, "{name}: {shaded}, {open} in the open");
    }
    // A room is lit from outside.
    assert_eq!(lit(Some(shapes::cuboid(Vec3::new(0.0, 0.0, -4.0), Vec3::splat(9.0)))), open);
    assert!(
        [shapes::cylinder(Vec3::ONE, 0.3, 2.0), shapes::cone(Vec3::ONE, 0.3, 2.0), shapes::sphere(Vec3::ONE, 0.1)]
            .iter()
            .all(Surface::is_closed)
    );
}
