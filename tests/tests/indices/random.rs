//! Whatever the points are: built, refitted, in any order.

use super::expected::{centers, check, compare};
use super::sets::{radii, reaches, sets};
use pointmass::Vec3;
use pointmass::index::{Neighbour, SpatialIndex, Structure};
use pointmass_tests::fields::used;
use pointmass_tests::points::{Oracle, extent, shuffle};
use pointmass_tests::{Random, config};
use proptest::prelude::*;
use proptest::sample::select;

proptest! {
    #![proptest_config(config!(1000))]

    #[test]
    fn all_answer_like_brute_force(set in sets(200), radius in radii(), reach in reaches()) {
        let points = set.points();
        let radius = radius.of(&points);
        check(&points, &[reach * radius], &[radius]);
    }
}

proptest! {
    #![proptest_config(config!(400))]

    /// The same memory takes one set after another, and follows points wherever they go.
    #[test]
    fn the_past_leaves_no_trace(
        sets in prop::collection::vec((sets(120), any::<bool>()), 2..5), radius in radii(), reach in reaches()
    ) {
        let sets: Vec<_> = sets.into_iter().map(|(set, build)| (set.points(), build)).collect();
        for &structure in Structure::ALL {
            let most = sets.iter().map(|(points, _)| points.len()).max().unwrap_or(0);
            let mut memory = used(structure.words(most));
            let mut index = structure.index(&mut memory);
            for (i, (points, build)) in sets.iter().enumerate() {
                let radius = radius.of(points);
                let done = if *build { index.build(points, reach * radius) } else { index.refit(points) };
                prop_assert_eq!(done, Ok(()));
                let what = format!("{structure}, set {i}");
                compare(&index, &Oracle::new(points), &[radius], &centers(points, 2), &what);
            }
        }
    }

    /// Points that drift, jump, vanish and come back.
    #[test]
    fn refitting_is_as_good_as_building(
        set in sets(120),
        moves in prop::collection::vec((select(&Move::ALL[..]), any::<u64>()), 1..5),
        radius in radii(),
        reach in reaches(),
    ) {
        let start = set.points();
        for &structure in Structure::ALL {
            let mut memory = used(structure.words(start.len()));
            let mut index = structure.index(&mut memory);
            let mut points = start.clone();
            index.build(&points, reach * radius.of(&points)).expect("the memory is made for so many");
            for (by, seed) in &moves {
                by.apply(&mut points, &start, *seed);
                index.refit(&points).expect("the memory is made for so many");
                let what = format!("{structure} after {by:?}");
                compare(&index, &Oracle::new(&points), &[radius.of(&points)], &centers(&points, 3), &what);
            }
        }
    }

    /// The points found do not depend on the rows that points are in.
    #[test]
    fn rows_may_be_in_any_order(set in sets(150), radius in radii(), reach in reaches()) {
        let points = set.points();
        let radius = radius.of(&points);
        let mut row_of: Vec<usize> = (0..points.len()).collect();
        shuffle(&mut row_of, &mut Random::new(set.seed));
        let shuffled: Vec<Vec3> = row_of.iter().map(|&row| points[row]).collect();
        for &structure in Structure::ALL {
            let (mut pairs, gaps) = pairs_and_gaps(structure, &points, reach * radius, radius);
            let (mut others, other_gaps) = pairs_and_gaps(structure, &shuffled, reach * radius, radius);
            others.iter_mut().for_each(|pair| *pair = pair.map(|row| row_of[row]));
            for pairs in [&mut pairs, &mut others] {
                pairs.iter_mut().for_each(|pair| pair.sort_unstable());
                pairs.sort_unstable();
            }
            prop_assert_eq!(pairs, others, "{}", structure);
            for (gap, &row) in other_gaps.iter().zip(&row_of) {
                prop_assert_eq!(*gap, gaps[row], "{}", structure);
            }
        }
    }
}

/// All pairs, and for every row how far the nearest other is.
fn pairs_and_gaps(structure: Structure, points: &[Vec3], reach: f32, radius: f32) -> (Vec<[usize; 2]>, Vec<f32>) {
    let mut memory = used(structure.words(points.len()));
    let mut index = structure.index(&mut memory);
    index.build(points, reach).expect("the memory is made for so many");
    let (mut pairs, mut gaps) = (vec![], vec![-1.0; points.len()]);
    let _ = index.pairs(radius, &mut |row, others| {
        pairs.extend(others.iter().map(|&other| [row as usize, other as usize]));
    });
    let _ = index.all_nearest(radius, &mut [Neighbour::default()], &mut |row, found| {
        gaps[row as usize] = found[0].distance;
    });
    (pairs, gaps)
}

/// A change that may happen to points between two looks.
#[derive(Clone, Copy, Debug)]
enum Move {
    Nothing,
    Drift,
    Shuffle,
    Grow,
    Explode,
    Collapse,
    Spoil,
    Restore,
    Lose,
    Empty,
}

impl Move {
    const ALL: [Self; 10] = [
        Self::Nothing,
        Self::Drift,
        Self::Shuffle,
        Self::Grow,
        Self::Explode,
        Self::Collapse,
        Self::Spoil,
        Self::Restore,
        Self::Lose,
        Self::Empty,
    ];

    fn apply(self, points: &mut Vec<Vec3>, start: &[Vec3], seed: u64) {
        let mut random = Random::new(seed);
        let size = extent(points);
        match self {
            Self::Nothing => {}
            Self::Drift => points.iter_mut().for_each(|point| *point += random.vector(0.01 * size.min(1e37))),
            Self::Shuffle => shuffle(points, &mut random),
            Self::Grow => points.iter_mut().for_each(|point| *point *= 3.0),
            // As far as it stays finite.
            Self::Explode => points.iter_mut().for_each(|point| *point *= (1e37 / size).min(1e25)),
            Self::Collapse => {
                let one = points.first().copied().unwrap_or_default();
                points.fill(one);
            }
            Self::Spoil => points.iter_mut().step_by(7).for_each(|point| point.y = f32::NAN),
            Self::Restore => points.clone_from(&start.to_vec()),
            Self::Lose => points.truncate(points.len() / 2),
            Self::Empty => points.clear(),
        }
    }
}
