//! Rows, memory, and what is told.

use super::{EPSILON, law};
use pointmass::Vec3;
use pointmass::index::{BarnesHut, FieldError};
use pointmass_tests::fields::{Charges, bits, collect, used};
use pointmass_tests::points::{Spread, shuffle};
use pointmass_tests::{Random, config, f64s, gap, often};
use proptest::prelude::*;

#[test]
fn any_division_of_the_rows_gives_the_same_bits() {
    for spread in [Spread::Plummer, Spread::Lattice].into_iter().take(often(2)) {
        let n = 1000;
        let mut charges = Charges::masses(spread, n, 1);
        (charges.points[77], charges.points[500]) = (Vec3::NAN, charges.points[501]);
        let mut memory = vec![];
        let tree = charges.tree(&mut memory);
        for law in [law(0.0, 0.0, false), law(0.5, 0.0, false), law(0.7, 0.01, true)] {
            let mut whole = vec![None; n];
            collect(&tree, law, 0..n, &mut whole);
            for cuts in [&[0, 1, 1000][..], &[0, 64, 128, 500, 501, 1000], &[0, 77, 78, 78, 999, 1000]] {
                let mut parts = vec![None; n];
                for cut in cuts.windows(2) {
                    collect(&tree, law, cut[0]..cut[1], &mut parts);
                }
                assert_eq!(parts, whole, "{spread:?}, {law:?}, {cuts:?}");
            }
            let mut single = vec![None; n];
            for row in (0..n).step_by(9) {
                collect(&tree, law, row..row + 1, &mut single);
            }
            assert!((0..n).step_by(9).all(|row| single[row] == whole[row]));
            // Rows that do not exist are not visited.
            let mut beyond = vec![None; n + 100];
            assert_eq!(collect(&tree, law, 990..n + 100, &mut beyond).found, 10);
            assert_eq!(collect(&tree, law, n..n + 100, &mut beyond).found, 0);
            assert_eq!(collect(&tree, law, 5..5, &mut beyond).found, 0);
            assert_eq!(beyond[990..n], whole[990..]);
        }
    }
}

#[test]
fn any_order_of_the_rows_gives_the_same_up_to_rounding() {
    for spread in Spread::ALL {
        let charges = Charges::masses(spread, often(2000), 1);
        let n = charges.points.len();
        let mut rows: Vec<usize> = (0..n).collect();
        shuffle(&mut rows, &mut Random::new(6));
        let points = rows.iter().map(|&row| charges.points[row]).collect();
        let weights = rows.iter().map(|&row| charges.weights[row]).collect();
        let shuffled = Charges { points, weights };
        for law in [law(0.0, 0.0, false), law(0.5, 0.0, false), law(0.5, 0.01, true)] {
            let (sums, others) = (charges.sums(law), shuffled.sums(law));
            let (mut apart, mut whole) = (0.0, 0.0);
            for (&row, other) in rows.iter().zip(&others) {
                let (a, b) = (f64s(sums[row].expect("it is there")), f64s(other.expect("it is there")));
                apart += gap(a, b).powi(2);
                whole += gap(a, [0.0; 3]).powi(2);
            }
            let off = (apart / whole).sqrt();
            assert!(off < 1e-5, "{spread:?}, {law:?}: {off:e}");
        }
    }
}

#[test]
fn building_anew_forgets_what_was_there() {
    let (many, few) = (Charges::masses(Spread::Plummer, 900, 1), Charges::signed(Spread::Clusters, 300, 2));
    let (far, law) = (many.scaled(1e12, 1.0), law(0.5, 0.01, true));
    let mut memory = used(BarnesHut::words(908));
    let mut tree = BarnesHut::new(&mut memory);
    for charges in [&many, &few, &far, &many, &far, &few, &few, &many] {
        tree.build(&charges.points, &charges.weights).expect("there is room");
        let mut sums = vec![None; charges.points.len()];
        collect(&tree, law, 0..sums.len(), &mut sums);
        let all_bits = |sums: &[Option<Vec3>]| sums.iter().map(|sum| sum.map(bits)).collect::<Vec<_>>();
        assert_eq!(all_bits(&sums), all_bits(&charges.sums(law)));
        // Points that do not fit leave nothing behind.
        let error = tree.build(&[Vec3::ONE; 2000], &[]).expect_err("there is no room");
        assert!(error.points == 2000 && (900..2000).contains(&error.room), "{error}");
        assert_eq!(collect(&tree, law, 0..2000, &mut vec![None; 2000]).found, 0);
    }
}

#[test]
fn it_says_its_own_error() {
    for (spread, seed) in [(Spread::Plummer, 1), (Spread::Cube, 2), (Spread::Clusters, 3)].into_iter().take(often(3)) {
        for scale in [1.0, 1e10, 1e4, 1e-10].into_iter().take(often(4).max(2)) {
            let charges = Charges::masses(spread, often(2000), seed).scaled(scale, 1.0);
            let mut memory = vec![];
            let tree = charges.tree(&mut memory);
            for (theta, softening, quadrupole) in
                [(0.0, 0.0, false), (0.5, 0.0, false), (0.5, 0.01, true), (0.3, 0.1, true)]
            {
                let law = law(theta, softening * scale, quadrupole);
                let (off, told) = (charges.off(law, 1), tree.error(law, 1));
                let FieldError { rms, largest } = told;
                // Where all is rounding, the test's own place is rounded otherwise.
                let near = |a: f64, b: f64| (a - b).abs() <= 0.01 * b + 1e-6;
                assert!(near(rms, off.rms) && near(largest, off.largest), "{law:?}: {rms:e} {largest:e}, {off:?}");
                assert_eq!(tree.error(law, 0), told);
                let some = tree.error(law, 5);
                assert!(some.largest <= largest && some.rms <= some.largest, "{some:?}");
                assert!(tree.error(law, 1_000_000).largest <= largest);
            }
        }
    }
}

#[test]
fn it_counts_what_it_does() {
    let charges = Charges::masses(Spread::Plummer, 2000, 1);
    let mut memory = vec![];
    let tree = charges.tree(&mut memory);
    let mut last = u64::MAX;
    for theta in [0.0, 0.3, 0.5, 0.7, 1.0] {
        let cost = collect(&tree, law(theta, 0.0, true), 0..2000, &mut vec![None; 2000]);
        assert!(cost.found == 2000 && cost.tests < last, "{theta}: {cost:?}");
        assert!(theta > 0.0 || cost.tests == 2000 * 2000, "{cost:?}");
        last = cost.tests;
    }
    let stats = tree.stats();
    assert!(stats.points == 2000 && stats.bytes <= 4 * BarnesHut::words(2000), "{stats:?}");
}

#[test]
fn its_words_are_enough() {
    let charges = Charges::masses(Spread::Cube, 400, 1);
    let mut wrong = vec![];
    for n in 1..=400 {
        let mut memory = used(BarnesHut::words(n));
        if let Err(error) = BarnesHut::new(&mut memory).build(&charges.points[..n], &charges.weights) {
            wrong.push(error.to_string());
        }
    }
    assert!(wrong.is_empty(), "{} of 400: {:#?}", wrong.len(), &wrong[..3]);
    assert_eq!([usize::MAX, usize::MAX / 4].map(BarnesHut::words), [usize::MAX; 2]);
}

#[test]
fn any_memory_gives_an_error_or_right_sums() {
    for spread in [Spread::Cube, Spread::Plummer, Spread::Line] {
        for n in [1, 5, 33, 100] {
            let charges = Charges::masses(spread, n, 1);
            let mut fitted = false;
            for words in 0..BarnesHut::words(n + 8) {
                let mut memory = used(words);
                let mut tree = BarnesHut::new(&mut memory);
                match tree.build(&charges.points, &charges.weights) {
                    Err(error) => assert!(error.points == n && error.room < n && !fitted, "{words}: {error}"),
                    Ok(()) => {
                        fitted = true;
                        let (mut sums, law) = (vec![None; n], law(0.5, 0.01, true));
                        collect(&tree, law, 0..n, &mut sums);
                        let off = charges.off_by(&sums, law.softening, 1);
                        assert!(off.share < 1e-2, "{n} in {words}: {off:?}");
                        assert!(tree.stats().bytes <= 4 * words, "{n} in {words}: {:?}", tree.stats());
                    }
                }
            }
            assert!(fitted);
        }
    }
    // Hundreds in no memory.
    for words in [0, 1, 31, 64, 119] {
        let mut memory = used(words);
        let error = BarnesHut::new(&mut memory).build(&[Vec3::ONE; 200], &[]).expect_err("there is no room");
        assert_eq!((error.points, error.room), (200, 0));
    }
}

/// Coordinates of many kinds: ordinary, tiny, exactly on a grid, none.
fn coordinate() -> impl Strategy<Value = f32> {
    prop_oneof![
        8 => -1.0f32..1.0,
        3 => (-4i32..4).prop_map(|i| i as f32 / 4.0),
        1 => (-10i32..0, any::<bool>()).prop_map(|(k, up)| if up { 10f32.powi(k) } else { -10f32.powi(k) }),
        1 => Just(0.0f32),
    ]
}

fn weight() -> impl Strategy<Value = f32> {
    prop_oneof![6 => 0.1f32..10.0, 2 => -10.0f32..0.0, 1 => Just(0.0f32), 1 => Just(f32::NAN)]
}

proptest! {
    #![proptest_config(config!(300))]

    /// Whatever the points are, each that is somewhere gets one sum, nearly that over all pairs.
    #[test]
    fn sums_of_anything(
        points in prop::collection::vec((prop::array::uniform3(coordinate()), weight()), 1..300),
        copies in prop::collection::vec((any::<prop::sample::Index>(), any::<prop::sample::Index>()), 0..50),
        lost in prop::option::of(any::<prop::sample::Index>()),
        theta in prop_oneof![0.0f32..0.5, Just(0.0f32)],
        softening in prop_oneof![Just(0.0f32), 1e-3f32..1.0, Just(-0.1f32)],
        quadrupole in any::<bool>(),
        cut in any::<prop::sample::Index>(),
    ) {
        let (points, weights): (Vec<_>, _) = points.into_iter().map(|(x, w)| (Vec3::from_array(x), w)).unzip();
        let mut charges = Charges { points, weights };
        let n = charges.points.len();
        for (from, to) in copies {
            charges.points[to.index(n)] = charges.points[from.index(n)];
        }
        // At least one stays, so that there is something to build.
        if let Some(lost) = lost.filter(|_| n > 1) {
            charges.points[lost.index(n)].y = f32::NAN;
        }
        let law = law(theta, softening, quadrupole);
        let sums = charges.sums(law);
        for (row, sum) in sums.iter().enumerate() {
            prop_assert_eq!(sum.is_some(), charges.points[row].is_finite());
            let Some(sum) = sum else { continue };
            let exact = charges.exact(row, softening);
            // A term that leaves out the dipole is wrong by 2 √3 θ or so at the most.
            let (off, most) = (gap(f64s(*sum), exact.sum), 20.0 * EPSILON + 4.0 * f64::from(theta));
            prop_assert!(off <= most * exact.size, "row {row}: {sum:?} {exact:?}");
        }
        let mut memory = vec![];
        let (tree, cut) = (charges.tree(&mut memory), cut.index(n));
        let mut parts = vec![None; n];
        collect(&tree, law, cut..n, &mut parts);
        collect(&tree, law, 0..cut, &mut parts);
        prop_assert_eq!(parts, sums);
    }
}
