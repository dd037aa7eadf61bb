//! Points and lengths as they should not be, and many of them.

use super::INF;
use super::expected::check;
use pointmass::Vec3;
use pointmass_tests::points::{Spread, extent};
use pointmass_tests::{Random, every};

/// Numbers that no square of an `f32` can hold, equal points, points in a line, none at all, and the like.
fn awkward() -> Vec<(&'static str, Vec<Vec3>)> {
    let cube = |n: usize, half: f32, seed: u64| -> Vec<Vec3> {
        let mut random = Random::new(seed);
        (0..n).map(|_| random.vector(half)).collect()
    };
    let with = |points: Vec<Vec3>, more: &[Vec3]| [&points[..20], more, &points[20..]].concat();
    let powers = || (-126..=126).step_by(6).map(|power| 2f32.powi(power));
    let extremes = [Vec3::splat(f32::MAX), Vec3::splat(f32::MIN), Vec3::X * f32::MAX, Vec3::ZERO];
    vec![
        ("none", vec![]),
        ("one", vec![Vec3::new(1.0, -2.0, 3.0)]),
        ("nothing sound", vec![Vec3::NAN, Vec3::X * INF, Vec3::new(0.0, 0.0, -INF)]),
        ("one sound", vec![Vec3::NAN, Vec3::ONE, Vec3::NAN]),
        ("two equal", vec![Vec3::ONE; 2]),
        ("all at the origin", vec![Vec3::ZERO; 50]),
        ("all equal", vec![Vec3::new(0.1, 0.2, 0.3); 150]),
        ("all equal and huge", vec![Vec3::new(1e30, -3e38, 0.3); 50]),
        ("all equal and tiny", vec![Vec3::new(1e-40, 0.0, 1e-45); 50]),
        ("two places", [[Vec3::ZERO; 60], [Vec3::X; 60]].concat()),
        ("neighbours in the last place", [[Vec3::ONE; 40], [Vec3::new(1.0, 1.0, 1.000_000_1); 40]].concat()),
        ("most equal", with(cube(40, 1.0, 1), &[Vec3::splat(0.25); 60])),
        ("five times each", cube(14, 1.0, 2).repeat(5)),
        ("zeros of both signs", [Vec3::ZERO, -Vec3::ZERO, Vec3::X, Vec3::new(-0.0, 1.0, 0.0)].repeat(6)),
        ("on an axis", cube(60, 1.0, 3).iter().map(|point| Vec3::Z * point.z).collect()),
        ("on a diagonal", cube(60, 1.0, 4).iter().map(|point| Vec3::splat(point.z)).collect()),
        ("on a plane", cube(60, 1.0, 5).iter().map(|point| Vec3 { x: 0.7, ..*point }).collect()),
        ("huge", cube(60, 1e30, 6)),
        ("as huge as can be", cube(60, 3.4e38, 7)),
        ("tiny", cube(60, 1e-30, 8)),
        ("subnormal", cube(60, 1e-40, 9)),
        ("hardly there", cube(60, 1e-44, 10)),
        ("far from the origin", cube(60, 1.0, 11).iter().map(|point| *point + Vec3::splat(3e5)).collect()),
        ("close but for one", with(cube(60, 1.0, 12), &[Vec3::splat(1e3)])),
        ("close but for some", with(cube(60, 1.0, 13), &[Vec3::X * 1e9, Vec3::Y * -1e8, Vec3::ONE * 1e7])),
        ("close but for a huge one", with(cube(60, 1.0, 14), &[Vec3::X * 1e30])),
        ("close but for the hugest", with(cube(60, 1.0, 15), &extremes)),
        ("beside what is not finite", with(cube(60, 1.0, 16), &[Vec3::NAN, Vec3::X * INF, Vec3::Y * -INF])),
        ("closer than a square can tell", with(cube(40, 1e-22, 17), &[Vec3::X, Vec3::Y])),
        ("powers of two", powers().map(|x| Vec3::new(x, 0.0, 0.0)).collect()),
        ("powers of two on a diagonal", powers().flat_map(|x| [Vec3::splat(x), Vec3::splat(-x)]).collect()),
        ("ever closer", (0..100).map(|i| Vec3::new(0.7f32.powi(i), 1.0, 0.9f32.powi(i))).collect()),
    ]
}

#[test]
fn awkward_points_are_points() {
    for (i, (name, points)) in awkward().into_iter().enumerate() {
        println!("{name}");
        let size = extent(&points).min(1e38);
        let spacing = size / (points.len().max(1) as f32).cbrt();
        let lengths =
            [([0.0, 0.1 * spacing], [0.0, spacing, INF]), ([spacing, 1e-6 * spacing], [1e-30, 0.3 * spacing, size])];
        for (reaches, radii) in lengths.iter().skip(i % every(2)).step_by(every(2)) {
            check(&points, reaches, radii);
        }
    }
}

#[test]
fn senseless_lengths_find_nothing_and_harm_nobody() {
    let points = Spread::Cube.points(50, 1);
    check(&points, &[f32::NAN, -1.0, INF, -INF, f32::MAX, f32::MIN_POSITIVE, 1e-45, -0.0], &[0.3]);
    check(&points, &[0.3], &[f32::NAN, -0.1, -INF, -0.0, -1e-45, f32::MAX, 1e-45]);
}

/// Enough points for whatever only happens in large sets.
#[test]
fn many_points_are_found_too() {
    let n = if cfg!(debug_assertions) { 150 } else { 2000 };
    for spread in Spread::ALL {
        println!("{spread:?}");
        let points = spread.points(n, 5);
        let spacing = extent(&points) / (n as f32).cbrt();
        check(&points, &[spacing], &[spacing, 0.2]);
        check(&points, &[0.1 * spacing], &[2.0 * spacing]);
        check(&points, &[0.0], &[0.01]);
    }
}
