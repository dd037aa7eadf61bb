//! Memory, and structures by their names.

use super::INF;
use super::expected::{Expected, centers, compare};
use pointmass::Vec3;
use pointmass::index::{Neighbours, SpatialIndex, Structure, TooSmall};
use pointmass_tests::fields::used;
use pointmass_tests::points::{Oracle, Spread};

#[test]
fn an_index_that_was_not_built_is_empty() {
    let (oracle, points) = (Oracle::new(&[]), Spread::Cube.points(10, 0));
    for &structure in Structure::ALL {
        let mut memory = used(structure.words(10));
        let mut index = structure.index(&mut memory);
        compare(&index, &oracle, &[0.0, 1.0, INF], &centers(&points, 0), &structure);
        index.parts(&mut |places| assert!(places.is_empty(), "{structure}: {places:?}"));
        index.refit(&points).expect("the memory is made for so many");
        compare(&index, &Oracle::new(&points), &[0.3], &centers(&points, 0), &structure);
    }
}

/// Whatever the memory: it is too small and the index is empty, or every answer is right.
#[test]
fn memory_is_enough_or_said_to_be_too_small() {
    let mut points = Spread::Cube.points(24, 3);
    points[7] = Vec3::NAN;
    points.extend([points[3]; 6]);
    let (sound, centers) = (points.len() - 1, [points[0], Vec3::ZERO]);
    let [none, all] = [&[][..], &points].map(Oracle::new);
    let [none, all] = [&none, &all].map(|oracle| [0.2, INF].map(|radius| Expected::new(oracle, radius, &centers)));
    for &structure in Structure::ALL {
        let mut least = 0;
        for words in 0..structure.words(points.len()) + 20 {
            let mut memory = used(words);
            let mut index = structure.index(&mut memory);
            for reach in [0.2, 0.0] {
                let what = format!("{structure} in {words} words, reach {reach}");
                match index.build(&points, reach) {
                    Ok(()) => {
                        all.iter().for_each(|expected| expected.compare(&index, &what));
                        assert!(index.stats().bytes <= 4 * words, "{what}: {:?}", index.stats());
                    }
                    Err(TooSmall { points: wanted, room }) => {
                        assert_eq!(wanted, sound, "{what}");
                        assert!(
                            room < wanted && room >= least && words < structure.words(points.len()),
                            "{what}: {room}"
                        );
                        least = room;
                        none.iter().for_each(|expected| expected.compare(&index, &what));
                        assert_eq!(index.build(&points[..room], reach), Ok(()), "{what}: {room} points");
                        assert_eq!(index.refit(&points), Err(TooSmall { points: wanted, room }), "{what}");
                        none.iter().for_each(|expected| expected.compare(&index, &what));
                        index.parts(&mut |places| assert!(places.is_empty(), "{what}: {places:?}"));
                    }
                }
            }
        }
        // The next point takes a few words, not many.
        assert!(least >= sound / 2, "{structure}: room for {least} at the most");
    }
}

/// Points that an index has beyond those that are asked about are near nobody.
#[test]
fn an_index_of_more_points_finds_those_there_are() {
    let points = Spread::Cube.points(200, 4);
    for &structure in Structure::ALL {
        let mut memory = used(structure.words(points.len()));
        let mut index = structure.index(&mut memory);
        index.build(&points, 0.5).expect("there is room");
        for some in [0, 1, 7, 150, 200] {
            let pairs = |near: Neighbours<'_>| {
                let mut pairs = vec![];
                near.of(0..usize::MAX, 0.5, &mut |row, others| pairs.extend(others.rows().iter().map(|&o| (row, o))));
                pairs.sort_unstable();
                pairs
            };
            let of_some = &points[..some];
            let found = pairs(Neighbours::by(Some(&index), of_some));
            assert_eq!(found, pairs(Neighbours::among(of_some)), "{structure} of {some}");
        }
    }
}

#[test]
fn the_more_memory_the_more_points() {
    for &structure in Structure::ALL {
        assert_eq!([usize::MAX, usize::MAX / 4].map(|n| structure.words(n)), [usize::MAX; 2], "{structure}");
        for n in [0, 1, 2, 3, 7, 8, 9, 63, 64, 65, 100] {
            let words = structure.words(n);
            assert!(words <= structure.words(n + 1), "{structure}");
            let points = Spread::Clusters.points(n, 9);
            let mut memory = used(words);
            assert_eq!(structure.index(&mut memory).build(&points, 0.1), Ok(()), "{structure} of {n}");
        }
    }
}

#[test]
fn structures_go_by_their_names() {
    for &structure in Structure::ALL {
        assert_eq!(structure.to_string().parse(), Ok(structure));
        assert_eq!(structure.index(&mut []).stats().points, 0, "{structure}");
        assert_eq!(structure.index(&mut []).build(&[], 1.0), Ok(()), "{structure}");
    }
    let unknown = "kdtree".parse::<Structure>().expect_err("there is none").to_string();
    assert!(Structure::ALL.iter().all(|structure| unknown.contains(structure.name())), "{unknown}");
}

/// A few that are far off do not make a grid's cells so large that all others share one.
#[test]
fn a_few_far_off_do_not_crowd_a_grid() {
    let reach = 0.05;
    for strays in [1, 2, 7] {
        for far in [1e2f32, 1e6, 1e12] {
            let mut points = Spread::Cube.points(4_000, 5);
            let fullest = |points: &[Vec3]| {
                let mut memory = used(Structure::Grid.words(points.len()));
                let mut index = Structure::Grid.index(&mut memory);
                index.build(points, reach).expect("there is room");
                index.stats().fullest
            };
            for stray in 0..strays {
                points[500 * stray + 3] *= if stray % 2 == 0 { far } else { -far };
            }
            let most = fullest(&points);
            assert!(most < 64, "{strays} at {far} m: {most} in a cell");
        }
    }
}
