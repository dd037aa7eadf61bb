//! Every library finds the first triangle that a loop over all triangles in double precision finds, up to rounding.

use pointmass_peers::{FirstHit, ray_peers};

type Point = [f32; 3];

/// A sphere of radius 1 with dents, its triangles between circles of latitude: 2 n².
fn dented(n: usize) -> (Vec<Point>, Vec<[u32; 3]>) {
    let vertex = |i: usize, j: usize| {
        let (polar, around) = (i as f32 / n as f32 * std::f32::consts::PI, j as f32 / n as f32 * std::f32::consts::TAU);
        let radius = 1.0 + 0.2 * (5.0 * polar).sin() * (3.0 * around).cos();
        [radius * polar.sin() * around.cos(), radius * polar.cos(), radius * polar.sin() * around.sin()]
    };
    let vertices = (0..=n).flat_map(|i| (0..n).map(move |j| vertex(i, j))).collect();
    let number = |i: usize, j: usize| (i * n + j % n) as u32;
    let cell = |i, j| {
        let [a, b, c, d] = [number(i, j), number(i, j + 1), number(i + 1, j), number(i + 1, j + 1)];
        [[a, b, c], [b, d, c]]
    };
    (vertices, (0..n).flat_map(|i| (0..n).flat_map(move |j| cell(i, j))).collect())
}

/// Segments between points of a cube around it, every third of them short.
fn segments(n: usize) -> Vec<[Point; 2]> {
    let mut state = 7u64;
    let mut unit = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 40) as f32 / 16_777_216.0
    };
    let mut point = |size: f32| [0; 3].map(|_| (unit() - 0.5) * size);
    let segment = |i: usize| {
        let (from, step) = (point(2.6), point(0.5));
        let to = if i.is_multiple_of(3) { [0, 1, 2].map(|axis| from[axis] + step[axis]) } else { point(4.0) };
        [from, to]
    };
    (0..n).map(segment).collect()
}

/// The first hit by all triangles, in double precision: fraction, triangle, and how far inside the triangle it is.
fn brute(vertices: &[Point], triangles: &[[u32; 3]], [from, to]: [Point; 2]) -> Option<(f64, u32, f64)> {
    let minus = |a: Point, b: Point| [0, 1, 2].map(|i| f64::from(a[i]) - f64::from(b[i]));
    let dot = |a: [f64; 3], b: [f64; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    let cross = |a: [f64; 3], b: [f64; 3]| [1, 2, 0].map(|i| a[i] * b[(i + 1) % 3] - a[(i + 1) % 3] * b[i]);
    let step = minus(to, from);
    let mut best: Option<(f64, u32, f64)> = None;
    for (triangle, number) in triangles.iter().zip(0..) {
        let [a, b, c] = triangle.map(|i| vertices[i as usize]);
        let (ab, ac, offset) = (minus(b, a), minus(c, a), minus(from, a));
        let normal = cross(ab, ac);
        let slope = -dot(step, normal);
        let time = dot(offset, normal) / slope;
        let across = cross(offset, step);
        let (v, w) = (dot(ac, across) / slope, -dot(ab, across) / slope);
        let inside = v.min(w).min(1.0 - v - w);
        if slope != 0.0 && inside >= 0.0 && (0.0..=1.0).contains(&time) && best.is_none_or(|best| time < best.0) {
            best = Some((time, number, inside));
        }
    }
    best
}

#[test]
fn first_hits_are_those_of_a_loop_over_all_triangles() {
    let (vertices, triangles) = dented(24);
    let segments = segments(2000);
    let expected: Vec<_> = segments.iter().map(|segment| brute(&vertices, &triangles, *segment)).collect();
    let hits = expected.iter().flatten().count();
    assert!(hits > 500 && hits < 1700, "{hits} of 2000 hit");
    for mut peer in ray_peers() {
        peer.build(&vertices, &triangles);
        let mut found = vec![Some((-1.0, 0)); segments.len()];
        peer.first_hits(&segments, &mut found);
        let mut unlike = 0;
        for (expected, found) in expected.iter().zip(&found) {
            match (expected, found) {
                (None, None) => {}
                (Some((time, triangle, inside)), Some((t, n))) if (time - f64::from(*t)).abs() < 1e-4 => {
                    // At an edge the other triangle is as good.
                    assert!(n == triangle || *inside < 1e-3, "{}: {n} for {triangle}", peer.name());
                }
                _ => unlike += 1,
            }
        }
        assert!(unlike <= 2, "{}: {unlike} of {} unlike", peer.name(), segments.len());
    }
}

#[test]
fn one_triangle_is_hit_from_both_sides_and_not_beyond_an_end() {
    let vertices = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
    let through = [[0.2, 0.2, 1.0], [0.2, 0.2, -3.0]];
    let [from, to] = through;
    let segments = [through, [to, from], [from, [0.2, 0.2, 0.5]], [[0.9, 0.9, 1.0], [0.9, 0.9, -1.0]]];
    for mut peer in ray_peers() {
        peer.build(&vertices, &[[0, 1, 2]]);
        let mut hits: [FirstHit; 4] = [Some((-1.0, 9)); 4];
        peer.first_hits(&segments, &mut hits);
        let near = |hit: FirstHit, time: f32| hit.is_some_and(|(t, n)| (t - time).abs() < 1e-6 && n == 0);
        let name = peer.name();
        assert!(near(hits[0], 0.25) && near(hits[1], 0.75) && hits[2..] == [None; 2], "{name}: {hits:?}");
        assert!((36..4000).contains(&peer.bytes()), "{name}: {} bytes", peer.bytes());
    }
}
