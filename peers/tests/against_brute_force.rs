//! Every library answers as a loop over all points does, up to rounding.

use pointmass_peers::{particular_barnes_hut, peers};

/// Points in the unit cube from a linear congruential generator.
fn points(n: usize) -> Vec<[f32; 3]> {
    let mut state = 1u64;
    let mut unit = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 40) as f32 / 16_777_216.0
    };
    (0..n).map(|_| [unit(), unit(), unit()]).collect()
}

fn distance(a: [f32; 3], b: [f32; 3]) -> f64 {
    let d: [f64; 3] = std::array::from_fn(|i| f64::from(a[i]) - f64::from(b[i]));
    (d[0] * d[0] + d[1] * d[1] + d[2] * d[2]).sqrt()
}

/// For every point how many others are nearer than each radius.
fn nearer(points: &[[f32; 3]], radius: f64) -> Vec<u32> {
    let count = |&a: &[f32; 3]| points.iter().filter(|&&b| distance(a, b) <= radius).count() as u32 - 1;
    points.iter().map(count).collect()
}

const RADIUS: f32 = 0.15;
const REACHES: [f32; 3] = [RADIUS, 0.05, 0.0];

#[test]
fn counts_and_lists_and_pairs_are_those_of_brute_force() {
    for n in [0, 1, 2, 3, 100, 2000] {
        let points = points(n);
        let [least, most] = [-1e-5, 1e-5].map(|off| nearer(&points, f64::from(RADIUS) * (1.0 + off)));
        let [fewest, greatest] = [&least, &most].map(|counts| counts.iter().map(|&c| u64::from(c)).sum::<u64>());
        for mut peer in peers() {
            for reach in REACHES {
                peer.build(&points, reach);
                let name = peer.name();
                let mut counts = vec![u32::MAX; n];
                if peer.counts(RADIUS, &mut counts) {
                    for (i, count) in counts.iter().enumerate() {
                        assert!((least[i]..=most[i]).contains(count), "{name}: {count} near point {i} of {n}");
                    }
                }
                if let Some(total) = peer.lists(RADIUS) {
                    assert!((fewest..=greatest).contains(&total), "{name}: {total} neighbours of {n}");
                }
                let mut found = Vec::new();
                if let Some(total) = peer.pairs(RADIUS, &mut |a, b| found.push((a.min(b), a.max(b)))) {
                    assert_eq!(total, found.len() as u64, "{name}");
                    assert!((fewest / 2..=greatest / 2).contains(&total), "{name}: {total} pairs of {n}");
                    found.sort_unstable();
                    found.dedup();
                    assert_eq!(total, found.len() as u64, "{name} visits pairs twice");
                    let most = f64::from(RADIUS) * (1.0 + 1e-5);
                    let near =
                        |&(a, b): &(u32, u32)| a != b && distance(points[a as usize], points[b as usize]) <= most;
                    assert!(found.iter().all(near), "{name}");
                }
            }
        }
    }
}

#[test]
fn the_nearest_are_those_of_brute_force() {
    for n in [0, 1, 2, 5, 2000] {
        let points = points(n);
        for mut peer in peers() {
            peer.build(&points, RADIUS);
            let mut found = vec![-1.0];
            if !peer.nearest(8, &mut found) {
                continue;
            }
            let k = n.saturating_sub(1).min(8);
            assert_eq!(found.len(), 1 + n * k, "{} of {n}", peer.name());
            for (i, found) in found[1..].chunks(k.max(1)).enumerate() {
                let others = points.iter().enumerate().filter(|&(j, _)| j != i);
                let mut expected: Vec<f64> = others.map(|(_, &other)| distance(points[i], other)).collect();
                expected.sort_by(f64::total_cmp);
                for (found, expected) in found.iter().zip(expected) {
                    assert!((f64::from(*found) - expected).abs() <= 1e-5 * expected, "{} of {n}", peer.name());
                }
            }
        }
    }
}

#[test]
fn points_in_one_place_are_neighbours() {
    for mut peer in peers() {
        peer.build(&[[0.5; 3]; 100], 0.1);
        let mut counts = [0; 100];
        if peer.counts(0.1, &mut counts) {
            assert_eq!(counts, [99; 100], "{}", peer.name());
        }
        let mut distances = Vec::new();
        if peer.nearest(8, &mut distances) {
            assert_eq!(distances, [0.0; 800], "{}", peer.name());
        }
        let mut pairs = 0;
        if let Some(total) = peer.pairs(0.1, &mut |_, _| pairs += 1) {
            assert_eq!((total, pairs), (4950, 4950), "{}", peer.name());
        }
    }
}

#[test]
fn bytes_are_about_those_of_the_points_and_more() {
    let points = points(2000);
    for mut peer in peers() {
        peer.build(&points, RADIUS);
        let bytes = peer.bytes().expect("all of them can be counted");
        assert!((2000 * 16..2000 * 120).contains(&bytes), "{}: {bytes}", peer.name());
    }
}

#[test]
fn barnes_hut_nears_the_direct_sum() {
    let (points, softening) = (points(1000), 0.01);
    let masses: Vec<f32> = (0..1000).map(|i| 1.0 + (i % 7) as f32).collect();
    let mut found = vec![[0.0; 3]; 1000];
    particular_barnes_hut(&points, &masses, 0.5, softening, &mut found);
    let (mut errors, mut squares) = (0.0, 0.0);
    for (&a, found) in points.iter().zip(found) {
        let mut exact = [0.0; 3];
        for (&b, &mass) in points.iter().zip(&masses) {
            let square = distance(a, b).powi(2) + f64::from(softening).powi(2);
            for axis in 0..3 {
                exact[axis] += f64::from(mass) * f64::from(b[axis] - a[axis]) / (square * square.sqrt());
            }
        }
        for axis in 0..3 {
            errors += (f64::from(found[axis]) - exact[axis]).powi(2);
            squares += exact[axis].powi(2);
        }
    }
    assert!((errors / squares).sqrt() < 0.02, "{}", (errors / squares).sqrt());
}
