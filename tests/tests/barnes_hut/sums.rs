//! The sums and their errors.

use super::{BOTH, EPSILON, law, nested};
use pointmass::Vec3;
use pointmass::index::{BarnesHut, FieldError};
use pointmass_tests::fields::{Charges, Off, collect, used};
use pointmass_tests::points::Spread;
use pointmass_tests::{Random, f64s, gap, often, order};

#[test]
fn where_nothing_is_far_it_is_the_direct_sum() {
    for spread in Spread::ALL {
        for charges in [Charges::masses(spread, often(2000), 1), Charges::signed(spread, often(2000), 2)] {
            // The square of 1e-30 is zero; nothing here is as small for its distance as 1e-6, but for single points,
            // which are far as soon as they are near.
            for (theta, quadrupole) in [(0.0, false), (0.0, true), (1e-30, true), (1e-6, false), (1e-6, true)] {
                for softening in [0.0, 0.01] {
                    // Some ten roundings of each term, and those of the sum.
                    let Off { share, .. } = charges.off(law(theta, softening, quadrupole), 7);
                    assert!(share < 20.0 * EPSILON, "{spread:?}, {theta}, {quadrupole}, {softening}: {share:e}");
                }
            }
        }
    }
}

#[test]
fn a_theta_that_is_no_number_is_none() {
    let charges = Charges::masses(Spread::Cube, 500, 1);
    for theta in [f32::NAN, 0.0] {
        assert_eq!(charges.sums(law(theta, 0.0, true)), charges.sums(law(0.0, 0.0, true)));
    }
}

/// Errors at 0.3, 0.5 and 0.7, by weight alone and with the quadrupole, with some room.
type Bounds = [[f64; 2]; 3];

/// Holds the errors against bounds, and says that they fall with theta and by the quadrupole.
fn errors(what: &str, charges: &Charges, softening: f32, bounds: &Bounds, measure: fn(&Off) -> f64) {
    let mut last = [0.0; 2];
    for (theta, bounds) in [0.3, 0.5, 0.7].into_iter().zip(bounds) {
        let [alone, all] = BOTH.map(|all| measure(&charges.off(law(theta, softening, all), 5)));
        println!("{what}: {theta}: {alone:.2e} {all:.2e}");
        assert!(alone > last[0] && all > last[1], "{what}, {theta}: {alone:e}, {all:e} after {last:?}");
        assert!(alone <= bounds[0] && all <= bounds[1], "{what}, {theta}: {alone:e}, {all:e}: more than {bounds:?}");
        assert!(all < alone * 0.8, "{what}, {theta}: {alone:e}, {all:e}");
        last = [alone, all];
    }
}

#[test]
fn the_errors_of_masses() {
    // In the midst of the cube, in the clusters' and the lattice's middles and near the sphere's, forces nearly vanish,
    // and an error relative to them says little: there it is relative to the usual force.
    let plummer = [[4e-4, 1e-4], [1.5e-3, 4e-4], [4e-3, 1.5e-3]];
    let charges = Charges::masses(Spread::Plummer, 3000, 1);
    for softening in [0.01, 0.0].into_iter().take(often(2)) {
        errors("Plummer", &charges, softening, &plummer, |off| off.rms);
    }
    let volume = [[8e-4, 1e-4], [3e-3, 8e-4], [1e-2, 3e-3]];
    // A flat or thin spread has moments of the same sign everywhere, and those of a lattice's cubes almost vanish.
    let surface = [[6e-3, 1.5e-4], [2e-2, 1.2e-3], [5e-2, 4e-3]];
    let line = [[3e-2, 1.2e-3], [9e-2, 9e-3], [2e-1, 4e-2]];
    let lattice = [[2.5e-3, 3e-4], [7e-3, 2.5e-3], [3e-2, 2e-2]];
    for spread in Spread::ALL.into_iter().take(often(8)) {
        let bounds = match spread {
            Spread::Cube | Spread::Plummer | Spread::Clusters => volume,
            Spread::Sphere | Spread::Oblique | Spread::Flat => surface,
            Spread::Line => line,
            Spread::Lattice => lattice,
        };
        let charges = Charges::masses(spread, 3000, 1);
        errors(&format!("{spread:?}"), &charges, 0.01, &bounds, |off| off.overall);
    }
}

#[test]
fn the_errors_of_charges_of_both_signs() {
    let bounds = [[1e-1, 1e-2], [2e-1, 4e-2], [4e-1, 1e-1]];
    for spread in Spread::ALL.into_iter().take(often(8)) {
        let charges = Charges::signed(spread, 3000, 1);
        errors(&format!("signed {spread:?}"), &charges, 0.01, &bounds, |off| off.overall);
    }
}

/// The errors of a cluster's sum at places farther and farther away, and how they fall.
fn falls(charges: &Charges, quadrupole: bool, softening: f32) -> f64 {
    let mut random = Random::new(5);
    let directions: Vec<Vec3> = (0..40).map(|_| random.direction()).collect();
    // So near that single precision still shows the fifth power.
    let distances = [5.0, 6.0, 7.0, 8.0, 10.0];
    let errors = distances.map(|distance: f32| {
        let square = directions.iter().map(|&direction| {
            let mut all = charges.clone();
            all.points.push(direction * distance);
            all.weights.push(0.0);
            let row = charges.points.len();
            let sum = all.sums(law(0.5, softening, quadrupole))[row].expect("it is in the tree");
            gap(f64s(sum), all.exact(row, softening).sum).powi(2)
        });
        (square.sum::<f64>() / directions.len() as f64).sqrt()
    });
    println!("quadrupole {quadrupole}, softening {softening}: {errors:?}");
    order(&distances.map(f64::from), &errors)
}

#[test]
fn moments_leave_out_the_powers_they_should() {
    // A cluster 1.2 m long and not at all round, of more points than share their sums with the probe.
    let mut random = Random::new(3);
    let stretch = Vec3::new(0.6, 0.4, 0.1);
    let points: Vec<Vec3> =
        (0..100).map(|_| (random.vector(1.0) + Vec3::X * random.unit().powi(2)) * stretch).collect();
    let masses: Vec<f32> = (0..100).map(|_| random.magnitude(0.1, 10.0)).collect();
    let masses = Charges { points: points.clone(), weights: masses };
    let mut signed = masses.clone();
    signed.weights.iter_mut().step_by(3).for_each(|weight| *weight *= -1.3);
    for softening in [0.0, 0.5] {
        // Masses have no dipole about their centre, so that the quadrupole is left out first, at R⁻⁴; of charges the
        // dipole, at R⁻³; of both the octupole, at R⁻⁵. The next terms make them a little steeper or flatter.
        for (charges, quadrupole, power) in
            [(&masses, false, -4.0), (&signed, false, -3.0), (&masses, true, -5.0), (&signed, true, -5.0)]
        {
            let slope = falls(charges, quadrupole, softening);
            assert!((slope - power).abs() < 0.4, "{quadrupole}, {softening}: {slope}, not {power}");
        }
    }
}

#[test]
fn few_points() {
    let at = |points: &[Vec3]| Charges { points: points.to_vec(), weights: vec![3.0; points.len()] };
    for quadrupole in BOTH {
        for softening in [0.0, 0.5] {
            let law = law(0.5, softening, quadrupole);
            assert_eq!(at(&[Vec3::splat(2.0)]).sums(law), [Some(Vec3::ZERO)]);
            let sums = at(&[Vec3::X, Vec3::X * 3.0]).sums(law);
            let f = 3.0 * 2.0 / (4.0 + softening * softening).powf(1.5);
            for (sum, expected) in sums.iter().zip([Vec3::X * f, Vec3::NEG_X * f]) {
                assert!((sum.expect("it is in the tree") - expected).length() < 1e-6, "{sum:?} {expected}");
            }
        }
    }
}

#[test]
fn no_points() {
    for points in [vec![], vec![Vec3::NAN; 1], vec![Vec3::splat(f32::INFINITY); 200]] {
        let charges = Charges { weights: vec![1.0; points.len()], points };
        assert!(charges.sums(law(0.5, 0.0, true)).iter().all(Option::is_none));
        let mut memory = vec![];
        let tree = charges.tree(&mut memory);
        assert_eq!((tree.stats().points, tree.stats().skipped), (0, charges.points.len()));
        assert_eq!(tree.error(law(0.5, 0.0, true), 1), FieldError::default());
    }
}

#[test]
fn points_that_coincide_do_not_act_on_each_other() {
    for n in [2, 33, 65, 500] {
        for scale in [1e-30, 1.0, 1e30] {
            let charges = Charges { points: vec![Vec3::new(0.1, 0.2, 0.3) * scale; n], weights: vec![1.5; n] };
            for (softening, quadrupole) in [(0.0, false), (0.0, true), (0.01, false), (0.01, true)] {
                let sums = charges.sums(law(0.5, softening, quadrupole));
                assert!(sums.iter().all(|&sum| sum == Some(Vec3::ZERO)), "{n}, {scale:e}: {:?}", sums[0]);
            }
        }
    }
    // Among others, eight times each.
    let mut charges = Charges::masses(Spread::Plummer, often(3000), 1);
    for row in 0..charges.points.len() {
        charges.points[row] = charges.points[row / 8 * 8];
    }
    for softening in [0.0, 0.01] {
        let off = charges.off(law(0.0, softening, true), 7);
        assert!(off.share < 20.0 * EPSILON, "{off:?}");
        for quadrupole in BOTH {
            let off = charges.off(law(0.5, softening, quadrupole), 7);
            // Some leaves hold few places, so that single errors are larger than among as many points apart.
            assert!(off.rms < if quadrupole { 5e-3 } else { 2e-2 }, "{quadrupole}, {softening}: {off:?}");
        }
    }
}

#[test]
fn a_node_does_not_act_as_one_on_its_own_points() {
    // Two points close together in one corner of a cube, and all others in the opposite one.
    let mut random = Random::new(8);
    let mut points: Vec<Vec3> = (0..200).map(|_| random.vector(0.01)).collect();
    points.extend([Vec3::ONE, Vec3::new(0.99, 1.0, 1.0)]);
    let charges = Charges { weights: vec![1.0; points.len()], points };
    for theta in [0.5, 0.6, 0.7, 1.0] {
        for quadrupole in BOTH {
            let sums = charges.sums(law(theta, 0.0, quadrupole));
            for row in [200, 201] {
                let (sum, exact) = (f64s(sums[row].expect("it is there")), charges.exact(row, 0.0));
                let off = gap(sum, exact.sum) / exact.size;
                assert!(off < 1e-2, "{theta}, {quadrupole}, row {row}: {off}: {sum:?}, {:?}", exact.sum);
            }
        }
    }
}

#[test]
fn what_is_not_finite_does_not_act() {
    let sound = Charges::masses(Spread::Clusters, 700, 3);
    let none = [f32::NAN, f32::INFINITY, f32::NEG_INFINITY];
    for law in [law(0.0, 0.0, false), law(0.5, 0.0, false), law(0.5, 0.01, true)] {
        // Points without a place are left out.
        let (mut charges, expected) = (sound.clone(), sound.sums(law));
        for (i, &bad) in none.iter().cycle().take(30).enumerate() {
            let mut point = Vec3::splat(0.1);
            point[i % 3] = bad;
            charges.points.insert(i * 20, point);
            charges.weights.insert(i * 20, if i % 2 == 0 { 1.0 } else { bad });
        }
        let mut sums = charges.sums(law);
        assert!((0..30).all(|i| sums[i * 20].is_none()));
        for i in (0..30).rev() {
            sums.remove(i * 20);
        }
        assert_eq!(sums, expected);
        // Those without a weight are there, and do nothing.
        let (mut charges, mut weightless) = (sound.clone(), sound.clone());
        for (i, row) in (0..700).step_by(9).enumerate() {
            (charges.weights[row], weightless.weights[row]) = (none[i % 3], 0.0);
        }
        let sums = charges.sums(law);
        assert_eq!(sums, weightless.sums(law));
        assert!(weightless.off_by(&sums, law.softening, 1).share < 1e-2);
    }
}

#[test]
fn missing_weights_are_zero_and_others_are_not_read() {
    let charges = Charges::masses(Spread::Cube, 300, 3);
    let law = law(0.5, 0.0, true);
    for len in [0, 100, 299, 300, 400] {
        let mut memory = used(BarnesHut::words(308));
        let mut tree = BarnesHut::new(&mut memory);
        let weights: Vec<f32> = charges.weights.iter().copied().chain([1e3; 100]).take(len).collect();
        tree.build(&charges.points, &weights).expect("there is room");
        let mut sums = vec![None; 300];
        collect(&tree, law, 0..300, &mut sums);
        let weights = weights.into_iter().chain([0.0; 300]).take(300).collect();
        assert_eq!(sums, Charges { weights, ..charges.clone() }.sums(law));
    }
}

#[test]
fn without_weights_there_is_nothing() {
    for spread in [Spread::Cube, Spread::Plummer, Spread::Lattice] {
        for scale in [1e-30, 1.0, 1e30] {
            let mut charges = Charges::masses(spread, 500, 3).scaled(scale, 1.0);
            for weight in [0.0, -0.0] {
                charges.weights.fill(weight);
                for (softening, quadrupole) in [(0.0, false), (0.0, true), (0.1, false), (0.1, true)] {
                    let sums = charges.sums(law(0.5, softening, quadrupole));
                    assert!(sums.iter().all(|&sum| sum == Some(Vec3::ZERO)), "{spread:?}, {scale:e}, {softening}");
                }
            }
        }
    }
}

#[test]
fn sums_change_their_sign_with_the_weights_and_with_space() {
    let charges = Charges::signed(Spread::Plummer, 1000, 4);
    for law in [law(0.5, 0.0, false), law(0.7, 0.01, true)] {
        let (sums, turned) = (charges.sums(law), charges.scaled(1.0, -1.0).sums(law));
        assert!(sums.iter().zip(turned).all(|(a, b)| a.map(|a| -a) == b));
        // A mirror changes the order in which cells come, and so the rounding.
        let sums: Vec<_> = charges.scaled(-1.0, 1.0).sums(law).into_iter().map(|sum| sum.map(|sum| -sum)).collect();
        let [off, mirrored] = [charges.off(law, 3), charges.off_by(&sums, law.softening, 3)];
        assert!((off.overall / mirrored.overall - 1.0).abs() < 0.5, "{off:?} {mirrored:?}");
    }
}

#[test]
fn nested_points_are_summed_as_well() {
    for quadrupole in BOTH {
        let off = nested(1500).off(law(0.5, 1e-4, quadrupole), 3);
        assert!(off.share < 1e-2, "{off:?}");
    }
}
