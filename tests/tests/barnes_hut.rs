//! Barnes and Hut's sums against those over all pairs in double precision, by themselves and as a force.

use pointmass::emit::Burst;
use pointmass::index::{BarnesHut, FieldError, Opening};
use pointmass::scene::{Files, Model, SceneFile};
use pointmass::shape::{MeshBuf, Sphere};
use pointmass::{
    Drag, Emitter, Force, ForceKind, Gravity, Heap, Inline, Measures, Method, MutualGravity, Particle, Scene, Size,
    System, Time, Varied, Vec3,
};
use pointmass_tests::fields::{Charges, Off, bits, collect, used};
use pointmass_tests::points::{Spread, shuffle};
use pointmass_tests::{Form, Random, f64s, gap, often, order, run, started};
use proptest::prelude::*;

/// Half of the distance between neighbouring numbers about one.
const EPSILON: f64 = 6e-8;

const fn law(theta: f32, softening: f32, quadrupole: bool) -> Opening {
    Opening { theta, softening, quadrupole }
}

/// Both kinds of moments.
const BOTH: [bool; 2] = [false, true];

// The sums and their errors.

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
        let [alone, all] = BOTH.map(|all| measure(&charges.off(law(theta, softening, all), often(50).div_ceil(10))));
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
    // What is flat or thin has moments of the same sign everywhere, and those of a lattice's cubes almost vanish.
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

// Where an f32 ends.

#[test]
fn powers_of_two_go_through_sums_to_the_bit() {
    // As long as nothing leaves the range of an f32, all roundings are the same.
    let charges = Charges::signed(Spread::Clusters, 600, 9);
    for softening in [0.0, 0.01] {
        for quadrupole in BOTH {
            let at = |length: i32, weight: i32| {
                let softening = softening * 2f32.powi(length);
                charges.scaled(2f32.powi(length), 2f32.powi(weight)).sums(law(0.5, softening, quadrupole))
            };
            let plain = at(0, 0);
            for length in -12..=12 {
                for weight in [-20, 0, 20] {
                    let back = 2f32.powi(2 * length - weight);
                    let sums: Vec<_> = at(length, weight).iter().map(|sum| sum.map(|sum| sum * back)).collect();
                    assert_eq!(sums, plain, "2^{length}, weights 2^{weight}");
                }
            }
        }
    }
}

/// Multiplies coordinates, softening and weights, and says where sums that ordinary numbers can hold are not right.
fn scales(charges: &Charges, softening: f32, scales: &[[f32; 2]]) {
    let mut wrong = vec![];
    for quadrupole in BOTH {
        let plain = charges.off(law(0.5, softening, quadrupole), 5);
        for &[length, weight] in scales {
            let scaled = charges.scaled(length, weight);
            let size = scaled.exact(0, softening * length).size;
            assert!((1e-36..1e36).contains(&size), "not a good example: {length:e}, {weight:e}: {size:e}");
            let off = scaled.off(law(0.5, softening * length, quadrupole), 5);
            if !(off.overall < plain.overall * 1.1 + 1e-6) {
                wrong.push(format!(
                    "quadrupole {quadrupole}, coordinates ×{length:e}, weights ×{weight:e}: off by {:.1e}, not {:.1e}",
                    off.overall, plain.overall
                ));
            }
        }
    }
    assert!(wrong.is_empty(), "softening {softening}:\n{}", wrong.join("\n"));
}

#[test]
fn coordinates_may_be_huge_or_tiny() {
    let charges = Charges::masses(Spread::Plummer, 400, 9);
    let lengths = [1e-6, 1e-8, 1e-9, 1e-10, 1e-12, 1e-14, 1e6, 1e8, 1e9, 1e10, 1e12, 1e14];
    for softening in [0.0, 0.1] {
        scales(&charges, softening, &lengths.map(|length| [length, 1.0]));
    }
}

#[test]
fn coordinates_may_be_as_huge_or_tiny_as_they_can() {
    let charges = Charges::masses(Spread::Plummer, 400, 9);
    let pairs =
        [[1e-20, 1e-10], [1e-25, 1e-20], [1e-30, 1e-30], [1e-34, 1e-36], [1e20, 1e10], [1e25, 1e20], [1e30, 1e30]];
    for softening in [0.0, 0.1] {
        scales(&charges, softening, &pairs);
    }
}

#[test]
fn weights_may_be_huge_or_tiny() {
    let charges = Charges::masses(Spread::Plummer, 400, 9);
    let pairs = [
        // Electrons; small planets within a million kilometres; suns within as much.
        [1e-9, 1e-30],
        [1e-9, 1e-36],
        [1e-3, 1e-36],
        [1e9, 1e21],
        [1e9, 1e24],
        [1e9, 1e30],
        [1e9, 1e34],
        [1.0, 1e-30],
        [1.0, 1e30],
    ];
    for softening in [0.0, 0.1] {
        scales(&charges, softening, &pairs);
    }
}

#[test]
fn a_softening_may_be_far_larger_or_smaller_than_the_world() {
    for (length, softening) in [
        (1.0f32, 1e-4f32),
        (1.0, 1e-8),
        (1.0, 1e-12),
        (1.0, 1e-13),
        (1.0, 1e-15),
        (1.0, 1e-20),
        (1.0, 1e-30),
        (1.0, 1e6),
        (1.0, 1e9),
        (1e9, 1e-9),
        (1e12, 1e-3),
        (1e-12, 1.0),
        (1e-20, 0.1),
        (1e-30, 1.0),
        (1e30, 1.0),
        (1e30, 1e-30),
    ] {
        let weight = if length > 1e10 { 1e30 } else { 1.0 };
        let charges = Charges::masses(Spread::Plummer, 400, 9).scaled(length, weight);
        for theta in [0.0, 0.5] {
            for quadrupole in BOTH {
                let off = charges.off(law(theta, softening, quadrupole), 5);
                // What is far softer than the world is wide may vanish.
                let most = if softening > length * 1e10 { 1.0 } else { 1e-2 };
                assert!(off.share <= most, "{length:e}, {softening:e}, {theta}, {quadrupole}: {off:?}");
            }
        }
    }
}

#[test]
fn places_near_the_origin_are_like_others() {
    // What lanes without a point hold must not come near any place.
    for near in [0.0, 1e-45, 1e-38, 1e-30, 1e-20, 1e-16, 1e-10] {
        for n in [2, 3, 9, 40, 200] {
            let mut charges = Charges::masses(Spread::Sphere, n, 2);
            charges.points[n / 2] = Vec3::new(near, -near, near);
            for (theta, quadrupole) in [(0.0, false), (0.5, false), (0.5, true)] {
                let off = charges.off(law(theta, 0.0, quadrupole), 1);
                assert!(off.share < 1e-2, "{near:e}, {n}, {theta}, {quadrupole}: {off:?}");
            }
        }
    }
}

#[test]
fn a_close_pair_in_a_wide_world() {
    // The root is cut at the origin; two points on both sides of it are alone in their octants.
    let mut random = Random::new(12);
    for distance in [1e-3, 1e-6, 1e-9, 1e-10, 1e-11, 1e-12] {
        let mut points =
            vec![Vec3::ONE, Vec3::NEG_ONE + Vec3::X * 2.0, Vec3::new(1.0, 1.0, -1.0), Vec3::new(1.0, -1.0, 1.0)];
        points.extend([Vec3::new(-1.0, 1.0, 1.0), Vec3::new(-1.0, 1.0, -1.0), Vec3::new(-1.0, -1.0, 1.0)]);
        points.extend((0..200).map(|_| random.vector(0.4) + Vec3::new(0.5, 0.5, -0.5)));
        let first = points.len();
        points.extend([Vec3::splat(distance), Vec3::splat(-distance)]);
        let charges = Charges { weights: vec![1.0; points.len()], points };
        for theta in [0.0, 0.5] {
            for quadrupole in BOTH {
                let sums = charges.sums(law(theta, 0.0, quadrupole));
                for row in [first, first + 1] {
                    let (sum, exact) = (f64s(sums[row].expect("it is there")), charges.exact(row, 0.0));
                    let off = gap(sum, exact.sum) / exact.size;
                    assert!(off < 1e-3, "{distance:e}, {theta}, {quadrupole}: {off}: {sum:?}, {:?}", exact.sum);
                }
            }
        }
    }
}

#[test]
fn what_has_no_weight_does_nothing_however_near() {
    for distance in [1e-10, 1e-14, 1e-16, 1e-18, 1e-20, 1e-22, 1e-24, 1e-40] {
        let mut charges = Charges::masses(Spread::Sphere, 200, 2);
        charges.points.extend([Vec3::ZERO, Vec3::X * distance]);
        for weight in [0.0, f32::NAN] {
            charges.weights.truncate(200);
            charges.weights.extend([1.0, weight]);
            for (theta, quadrupole) in [(0.0, false), (0.5, false), (0.5, true)] {
                let sum = charges.sums(law(theta, 0.0, quadrupole))[200].expect("it is there");
                let off = gap(f64s(sum), charges.exact(200, 0.0).sum);
                assert!(off < 1.0, "{distance:e}, weight {weight}, {theta}, {quadrupole}: {sum}");
            }
        }
    }
}

#[test]
fn the_solar_system_in_metres_and_kilograms() {
    let mut random = Random::new(2);
    let (sun, earth) = ((Vec3::ZERO, 1.989e30), (Vec3::X * 1.496e11, 5.972e24));
    let (moon, satellite) = ((earth.0 + Vec3::Y * 3.844e8, 7.35e22), (earth.0 + Vec3::Z * 4.2e7, 1e3));
    let neptune = (Vec3::NEG_Y * 4.5e12, 1.02e26);
    let asteroid = |_| (random.direction() * random.between(3.2e11, 5e11), random.magnitude(1e12, 1e20));
    let bodies = [sun, earth, moon, satellite, neptune].into_iter().chain((0..300).map(asteroid).collect::<Vec<_>>());
    let (points, weights) = bodies.unzip();
    let charges = Charges { points, weights };
    for softening in [0.0, 1e3, 1e6] {
        for (theta, quadrupole) in [(0.0, false), (0.5, false), (0.5, true)] {
            let off = charges.off(law(theta, softening, quadrupole), 1);
            assert!(off.largest < 1e-3, "{softening:e}, {theta}, {quadrupole}: {off:?}");
        }
    }
}

#[test]
fn outsiders_do_not_act_on_themselves() {
    // Alone in their leaves, on the faces of their groups: their own centre must not be beside them.
    for n in [1, 2, 20, 100, 400] {
        let mut charges = Charges::masses(Spread::Plummer, n, 6);
        for (point, stretch) in charges.points.iter_mut().zip([1.0, 3.0, 10.0, 30.0].into_iter().cycle()) {
            *point *= stretch;
        }
        for softening in [0.0, 1e-6, 1e-3] {
            for quadrupole in BOTH {
                let off = charges.off(law(0.3, softening, quadrupole), 1);
                assert!(off.share < 1e-2, "{n}, {softening:e}, {quadrupole}: {off:?}");
            }
        }
    }
}

// Rows, memory, and what is told.

#[test]
fn any_division_of_the_rows_gives_the_same_bits() {
    for spread in [Spread::Plummer, Spread::Lattice] {
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
        // What does not fit leaves nothing behind.
        let error = tree.build(&[Vec3::ONE; 2000], &[]).expect_err("there is no room");
        assert!(error.points == 2000 && (900..2000).contains(&error.room), "{error}");
        assert_eq!(collect(&tree, law, 0..2000, &mut vec![None; 2000]).found, 0);
    }
}

#[test]
fn it_says_its_own_error() {
    for (spread, seed) in [(Spread::Plummer, 1), (Spread::Cube, 2), (Spread::Clusters, 3)] {
        for scale in [1.0, 1e10, 1e4, 1e-10].into_iter().take(often(4).max(2)) {
            let charges = Charges::masses(spread, often(2000), seed).scaled(scale, 1.0);
            let mut memory = vec![];
            let tree = charges.tree(&mut memory);
            for (theta, softening, quadrupole) in
                [(0.0, 0.0, false), (0.5, 0.0, false), (0.5, 0.01, true), (0.3, 0.1, true)]
            {
                let law = law(theta, softening * scale, quadrupole);
                let (off, FieldError { rms, largest }) = (charges.off(law, 1), tree.error(law, 1));
                // Where all is rounding, the test's own place is rounded otherwise.
                let near = |a: f64, b: f64| (a - b).abs() <= 0.01 * b + 1e-6;
                assert!(near(rms, off.rms) && near(largest, off.largest), "{law:?}: {rms:e} {largest:e}, {off:?}");
                assert_eq!(tree.error(law, 0), tree.error(law, 1));
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

/// Points that come closer and closer to one place: whoever divides space needs a node or two for each of them.
fn nested(n: usize) -> Charges {
    let mut random = Random::new(1);
    let place = |i: usize| Vec3::splat(0.5) + random.direction() * 0.8f32.powi((i % 80) as i32);
    Charges { points: (0..n).map(place).collect(), weights: vec![1.0; n] }
}

#[test]
fn nested_points_are_summed_as_well() {
    for quadrupole in BOTH {
        let off = nested(1500).off(law(0.5, 1e-4, quadrupole), 3);
        assert!(off.share < 1e-2, "{off:?}");
    }
}

// The force.

const UNIT: MutualGravity = MutualGravity { constant: 1.0, softening: 0.01, theta: 0.5, quadrupole: false };

/// Particles at some points, with their weights as masses.
fn particles(charges: &Charges) -> Vec<Particle> {
    let particle = |(&position, &mass): (&Vec3, &f32)| Particle { position, mass, ..Particle::REST };
    charges.points.iter().zip(&charges.weights).map(particle).collect()
}

/// The accelerations in a system, from the change of velocities in a step so short that nothing moves.
fn accelerations(start: &[Particle], force: &MutualGravity, capacity: usize) -> Vec<Vec3> {
    let scene = Scene { start, forces: force, ..Scene::EMPTY };
    let mut system = started(&scene, capacity, 0);
    let dt = Time::from_ticks(1 << 12);
    system.step(&scene, dt);
    system.particles().velocity.iter().map(|&v| v / dt.seconds()).collect()
}

#[test]
fn a_system_feels_what_the_tree_says() {
    let charges = Charges::masses(Spread::Plummer, 1000, 1);
    let start = particles(&charges);
    for theta in [0.3, 0.5, 0.7] {
        for quadrupole in BOTH {
            let force = MutualGravity { theta, quadrupole, ..UNIT };
            let found: Vec<_> = accelerations(&start, &force, 1000).into_iter().map(Some).collect();
            let sums = charges.sums(law(theta, 0.01, quadrupole));
            let apart = found.iter().zip(&sums).map(|(a, b)| {
                let [a, b] = [a, b].map(|sum| f64s(sum.expect("it is there")));
                gap(a, b) / gap(b, [0.0; 3])
            });
            // The force is multiplied by the mass and divided by it.
            let apart = apart.fold(0.0, f64::max);
            assert!(apart < 1e-6, "{theta}, {quadrupole}: {apart:e}");
            let twice = MutualGravity { constant: 2.0, ..force };
            let twice: Vec<_> = accelerations(&start, &twice, 1000).into_iter().map(|a| Some(a * 0.5)).collect();
            assert_eq!(twice, found);
        }
    }
    // The force by itself, over a state without a tree, is that over all pairs.
    let scene = Scene { start: &start, ..Scene::EMPTY };
    let system = started(&scene, 1000, 0);
    let mut totals = [vec![Vec3::ZERO; 1000], vec![Vec3::ZERO; 1000]];
    UNIT.add_to(&system.state(&scene), 0..1000, &mut totals[0]);
    MutualGravity { theta: 0.0, ..UNIT }.add_to(&system.state(&scene), 0..1000, &mut totals[1]);
    assert_eq!(totals[0], totals[1]);
}

#[test]
fn a_force_that_needs_a_tree_needs_columns() {
    let (far, near, plain) = (UNIT, MutualGravity { theta: 0.0, ..UNIT }, (Gravity::EARTH, Drag {}));
    let columns = |force: &dyn Force| Scene { forces: force, ..Scene::EMPTY }.columns();
    let kind = ForceKind::MutualGravity(far);
    let without: [&dyn Force; 6] = [&(), &plain, &near, &[near], &vec![near], &ForceKind::MutualGravity(near)];
    for force in without {
        assert_eq!(columns(force), 1);
    }
    let dynamic: [&dyn Force; 2] = [&near, &far];
    let with: [&dyn Force; 13] = [
        &far,
        &&far,
        &kind,
        &(far,),
        &(plain, far),
        &(far, plain, near),
        &(near, plain, near, far),
        &(plain, near, far, plain, near),
        &(plain, near, plain, plain, near, (near, far)),
        &[near, far],
        &&[near, far][..],
        &vec![ForceKind::MutualGravity(near), kind.clone()],
        &dynamic,
    ];
    for (i, force) in with.iter().enumerate() {
        assert_eq!(columns(*force), 6, "{i}");
    }
    assert_eq!(columns(&(far, far, [far])), 6, "one tree does for all");
    for &method in Method::ALL {
        let scene = |forces| Scene { forces, integrator: method.integrator(), ..Scene::EMPTY };
        assert_eq!(scene(&far).columns(), scene(&near).columns() + 5);
        assert_eq!(scene(&far).size().columns, scene(&far).columns());
    }
    assert!(MutualGravity { theta: f32::NAN, ..UNIT }.needs().tree.is_none());
}

#[test]
fn a_system_without_those_columns_is_unfit() {
    let start = particles(&Charges::masses(Spread::Cube, 200, 1));
    for &method in Method::ALL {
        let integrator = method.integrator();
        let plain = Scene { start: &start, integrator, ..Scene::EMPTY };
        let scene = Scene { forces: &UNIT, ..plain };
        for columns in plain.columns()..scene.columns() {
            let mut system = System::with(Heap::new(Size { columns, ..scene.size() }));
            let error = system.start(&scene, 0).expect_err("it does not fit");
            assert_eq!((error.need, error.have.columns), (scene.size(), columns));
            system.start(&plain, 0).expect("it fits");
            let report = system.step(&scene, Time::SECOND);
            assert_eq!((report.caps.unfit, system.time()), (1, Time::ZERO));
        }
        let mut system = System::with(Heap::new(scene.size()));
        system.start(&scene, 0).expect("it fits");
        assert_eq!(system.step(&scene, Time::from_seconds(0.01)).caps.unfit, 0);
    }
}

/// The hash after some steps with so much room.
fn hash(start: &[Particle], force: &MutualGravity, method: Method, capacity: usize) -> u64 {
    let scene = Scene { start, forces: force, integrator: method.integrator(), ..Scene::EMPTY };
    let mut system = started(&scene, capacity, 0);
    run(&mut system, &scene, 1e-3, 5);
    assert_eq!(system.len(), start.len());
    system.hash()
}

#[test]
fn the_capacity_makes_no_difference() {
    let numbers = [1, 100, 126, 127, 128, 129, 130, 133, 150, 175, 200, 1000];
    for spread in [Spread::Plummer, Spread::Cube, Spread::Clusters, Spread::Lattice].into_iter().take(often(4)) {
        for n in numbers.into_iter().filter(|&n| n <= often(1500)) {
            let start = particles(&Charges::masses(spread, n, 1));
            for quadrupole in BOTH {
                let force = MutualGravity { quadrupole, ..UNIT };
                let expected = hash(&start, &force, Method::Rk4, n);
                for capacity in [n + 1, 3 * n, 10 * n] {
                    assert_eq!(hash(&start, &force, Method::Rk4, capacity), expected, "{spread:?}, {n} of {capacity}");
                }
            }
        }
    }
}

#[test]
fn the_capacity_makes_no_difference_to_nested_points() {
    for n in [128, 200, 500, 1000].into_iter().take(often(4).max(2)) {
        let start = particles(&nested(n));
        let expected = hash(&start, &UNIT, Method::Verlet, n);
        for capacity in [n + 1, 3 * n, 10 * n] {
            assert_eq!(hash(&start, &UNIT, Method::Verlet, capacity), expected, "{n} of {capacity}");
        }
    }
}

#[test]
fn it_does_not_matter_who_owns_the_memory() {
    let start = particles(&Charges::masses(Spread::Plummer, 150, 1));
    let scene = Scene { start: &start, forces: &UNIT, integrator: Method::Rk4.integrator(), ..Scene::EMPTY };
    assert!(scene.columns() <= 10);
    let mut inline = Box::new(System::with(Inline::<200, 0, 0, 10>::new()));
    inline.start(&scene, 0).expect("it fits");
    for i in 1..=5 {
        inline.step(&scene, Time::from_seconds_f64(1e-3 * f64::from(i)) - inline.time());
    }
    assert_eq!(inline.hash(), hash(&start, &UNIT, Method::Rk4, 150));
}

#[test]
fn fewer_than_128_are_summed_pair_by_pair() {
    let direct = MutualGravity { theta: 0.0, ..UNIT };
    for n in 100..200 {
        let start = particles(&Charges::masses(Spread::Plummer, n, 1));
        let equal = accelerations(&start, &UNIT, 200) == accelerations(&start, &direct, n);
        assert_eq!(equal, n < 128, "{n}");
    }
}

#[test]
fn it_nearly_conserves_momentum() {
    let mut random = Random::new(20);
    let n = often(1000).max(200);
    let mut start = particles(&Charges::masses(Spread::Plummer, n, 1));
    start.iter_mut().for_each(|particle| particle.velocity = random.vector(60.0));
    for quadrupole in BOTH {
        let force = MutualGravity { quadrupole, ..UNIT };
        let integrator = Method::Verlet.integrator();
        let scene = Scene { start: &start, forces: &force, integrator, ..Scene::EMPTY };
        let mut system = started(&scene, n, 0);
        let before = Measures::of(&system, &scene);
        run(&mut system, &scene, 2e-5, 50);
        let after = Measures::of(&system, &scene);
        let p = system.particles();
        let size: f64 = p.mass.iter().zip(p.velocity).map(|(&m, v)| f64::from(m) * f64::from(v.length())).sum();
        let off = gap(before.momentum, after.momentum) / size;
        let energy = (after.energy.total() / before.energy.total() - 1.0).abs();
        println!("quadrupole {quadrupole}: {off:e} of all momentum, {energy:e} of all energy");
        assert!(off < 1e-4, "{off:e} of all momentum");
        assert!(energy < 1e-3, "{energy:e} of all energy");
    }
}

#[test]
fn newborn_particles_feel_it_too() {
    // A hundred and fifty, or with the newborn, are pulled by a heavy cluster that is fixed.
    let births = Form::Sphere(Sphere { center: Vec3::X * 3.0, radius: 0.5 });
    let burst = Some(Burst { count: 100, at: 0.005, every: 0.0 });
    let emitter = Emitter { burst, mass: Varied::exactly(1e-3), ..Emitter::new(births, 0.0) };
    for n in [50, 150] {
        let mut start = particles(&Charges::masses(Spread::Plummer, n, 1));
        start.iter_mut().for_each(|particle| particle.fixed = true);
        let end = |force: &MutualGravity, steps: u32| {
            let scene = Scene { start: &start, emitters: &emitter, forces: force, ..Scene::EMPTY };
            let mut system = started(&scene, 300, 3);
            run(&mut system, &scene, 0.01, steps);
            assert_eq!(system.len(), n + 100);
            let p = system.particles();
            p.position[n..].iter().zip(&p.velocity[n..]).map(|(x, v)| (*x, *v)).collect::<Vec<_>>()
        };
        // At the end of the step in which they are born, and later.
        for steps in [1, 20] {
            let (near, far) = (end(&MutualGravity { theta: 0.0, ..UNIT }, steps), end(&UNIT, steps));
            assert_ne!(near, far, "{n}, {steps}");
            for ((x, v), (y, w)) in near.iter().zip(&far) {
                assert!(v.x < -0.01 && (*v - *w).length() < 5e-3 * v.length(), "{n}, {steps}: {v} {w}");
                assert!((*x - *y).length() < 1e-3, "{n}, {steps}: {x} {y}");
            }
        }
    }
}

#[test]
fn those_who_are_gone_do_not_act() {
    let mut start = particles(&Charges::masses(Spread::Cube, 300, 1));
    let without = start.clone();
    // One removed, one too old, one that is no number, all of them heavier than all others together.
    let heavy = Particle { position: Vec3::splat(0.6), mass: 1e4, ..Particle::REST };
    start.push(heavy);
    start.push(Particle { lifetime: 1e-3, ..heavy });
    start.push(Particle { velocity: Vec3::splat(f32::NAN), ..heavy });
    start.push(Particle { position: Vec3::splat(f32::INFINITY), ..heavy });
    let force = MutualGravity { quadrupole: true, ..UNIT };
    let forces = &force;
    let scene = Scene { start: &start, ..Scene::EMPTY };
    let mut system = started(&Scene { forces, ..scene }, 320, 0);
    let id = system.id(300).expect("it is there");
    assert!(system.remove(&scene, id));
    // Nothing acts while the others go.
    system.step(&scene, Time::from_seconds(0.01));
    assert_eq!(system.len(), 300);
    system.step(&Scene { forces, ..scene }, Time::from_seconds(0.01));
    let scene = Scene { start: &without, forces, ..Scene::EMPTY };
    let mut expected = started(&scene, 300, 0);
    expected.step(&scene, Time::from_seconds(0.01));
    let all = |system: &System<Heap>| {
        let p = system.particles();
        let mut all: Vec<_> =
            (0..300).map(|row| (p.serial[row], bits(p.position[row]), bits(p.velocity[row]))).collect();
        all.sort_unstable();
        all
    };
    assert_eq!(all(&system), all(&expected));
}

#[test]
fn what_is_not_a_number_harms_nobody() {
    let (nan, inf) = (f32::NAN, f32::INFINITY);
    let sound = particles(&Charges::masses(Spread::Plummer, 200, 1));
    let bad = [
        Particle { position: Vec3::new(0.0, nan, 0.0), ..Particle::REST },
        Particle { position: Vec3::new(inf, 0.0, 0.0), ..Particle::REST },
        Particle { mass: nan, ..Particle::REST },
        Particle { mass: inf, ..Particle::REST },
        Particle { velocity: Vec3::splat(nan), mass: 1e-9, ..Particle::REST },
    ];
    for &method in Method::ALL {
        for quadrupole in BOTH {
            let force = MutualGravity { quadrupole, ..UNIT };
            for bad in bad {
                let mut start = sound.clone();
                start.insert(100, bad);
                let scene = Scene { start: &start, forces: &force, integrator: method.integrator(), ..Scene::EMPTY };
                let mut system = started(&scene, 201, 0);
                run(&mut system, &scene, 1e-3, 10);
                assert!(system.len() >= 200, "{method}, {quadrupole}, beside {bad:?}: {:?}", system.totals().died);
            }
        }
    }
    // Not even if nothing else is there.
    let start = [Particle { position: Vec3::NAN, ..Particle::REST }; 200];
    let scene = Scene { start: &start, forces: &UNIT, ..Scene::EMPTY };
    let mut system = started(&scene, 200, 0);
    assert_eq!(system.step(&scene, Time::from_seconds(0.01)).died.nonfinite, 200);
}

#[test]
fn planets_and_a_moon_stay_on_their_ways() {
    let g = MutualGravity::NEWTON.constant;
    let (sun, planet, radius, way) = (1.989e30f32, 5.972e24f32, 1.496e11f32, 3.844e8f32);
    let (around_sun, around_planet) = ((g * sun / radius).sqrt(), (g * planet / way).sqrt());
    let at = |position, velocity, mass| Particle { position, velocity, mass, ..Particle::REST };
    let mut start = vec![
        at(Vec3::ZERO, Vec3::ZERO, sun),
        at(Vec3::X * radius, Vec3::Y * around_sun, planet),
        at(Vec3::X * (radius + way), Vec3::Y * (around_sun + around_planet), 7.35e22),
    ];
    let mut random = Random::new(2);
    start.extend((0..200).map(|_| at(random.direction() * random.between(3e11, 5e11), Vec3::ZERO, 1e15)));
    for (softening, quadrupole) in [(0.0, false), (0.0, true), (1e6, false), (1e6, true)] {
        let near = MutualGravity { softening, ..MutualGravity::NEWTON };
        let far = MutualGravity { theta: 0.5, quadrupole, ..near };
        let [near, far] = [near, far].map(|force| {
            let integrator = Method::Verlet.integrator();
            let scene = Scene { start: &start, forces: &force, integrator, ..Scene::EMPTY };
            let mut system = started(&scene, start.len(), 0);
            run(&mut system, &scene, 3600.0, 24);
            assert_eq!(system.totals().died.nonfinite, 0, "{force:?}");
            [1, 2].map(|row| f64s(system.particles().position[row]))
        });
        // In a day, the planet goes 2.6e9 m, and the moon 8.8e7 m around it.
        assert!(gap(near[0], far[0]) < 1e6 && gap(near[1], far[1]) < 1e6, "{near:?} {far:?}");
    }
}

#[test]
fn what_is_fixed_stays_and_acts() {
    let mut start = particles(&Charges::masses(Spread::Plummer, 200, 1));
    start.iter_mut().for_each(|particle| particle.fixed = true);
    start.push(Particle { position: Vec3::X * 2.0, ..Particle::REST });
    let a = accelerations(&start, &UNIT, 201);
    assert!(a[..200].iter().all(|&a| a == Vec3::ZERO));
    let pull: f32 = start[..200].iter().map(|p| p.mass).sum::<f32>() / 4.0;
    assert!((a[200].x + pull).abs() < 0.1 * pull, "{} {pull}", a[200]);
}

// Files.

/// A disk without a file.
struct NoFiles;

impl Files for NoFiles {
    fn text(&mut self, path: &str) -> Result<String, String> {
        Err(format!("no {path}"))
    }
    fn mesh(&mut self, path: &str) -> Result<MeshBuf, String> {
        Err(format!("no {path}"))
    }
    fn exists(&mut self, _: &str) -> bool {
        false
    }
}

#[test]
fn a_file_says_theta() {
    let text = r#"{"forces": [{"mutual_gravity": {"constant": 2.5, "theta": 0.5, "quadrupole": true}},
        {"gravity": {"acceleration": [0, -1, 0]}}, {"mutual_gravity": {"softening": 0.1}}, {"mutual_gravity": {}}]}"#;
    let file = SceneFile::from_json("a.json", text).expect("it is sound");
    let far = MutualGravity { constant: 2.5, softening: 0.0, theta: 0.5, quadrupole: true };
    // Files of before say nothing about it.
    let near = MutualGravity { softening: 0.1, ..MutualGravity::NEWTON };
    let kinds = [far, near, MutualGravity::NEWTON].map(ForceKind::MutualGravity);
    assert_eq!([&file.forces[0], &file.forces[2], &file.forces[3]], [&kinds[0], &kinds[1], &kinds[2]]);
    file.check().expect("it is sound");
    let written = file.to_json();
    assert_eq!(SceneFile::from_json("b.json", &written), Ok(file.clone()));
    assert!(written.contains("\"theta\": 0.5") && written.contains("\"quadrupole\": true"), "{written}");
    let model = Model::load(&file, "a.json", &mut NoFiles).expect("it is sound");
    let without = SceneFile { forces: file.forces[1..].to_vec(), ..file };
    let without = Model::load(&without, "a.json", &mut NoFiles).expect("it is sound");
    assert_eq!(model.scene().columns(), without.scene().columns() + 5);
    assert_eq!(model.size(10).columns, model.scene().columns());
}

#[test]
fn a_theta_that_cannot_be_is_refused() {
    for (theta, sound) in
        [("0", true), ("-0.0", true), ("1e-30", true), ("2", true), ("-0.1", false), ("-1e-30", false)]
    {
        let text = format!(r#"{{"forces": [{{"drag": {{}}}}, {{"mutual_gravity": {{"theta": {theta}}}}}]}}"#);
        let file = SceneFile::from_json("a.json", &text).expect("it is well-formed");
        match file.check() {
            Ok(()) => assert!(sound, "{theta}"),
            Err(error) => {
                let error = error.to_string();
                assert!(!sound && error.contains("forces[1].theta") && error.contains("zero or more"), "{error}");
            }
        }
        assert_eq!(Model::load(&file, "a.json", &mut NoFiles).is_ok(), sound);
    }
    for theta in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
        let forces = vec![ForceKind::MutualGravity(MutualGravity { theta, ..UNIT })];
        let error = SceneFile { forces, ..SceneFile::new() }.check().expect_err("it is no number");
        assert!(error.to_string().contains("forces[0]"), "{error}");
    }
    for wrong in [r#""theta": "much""#, r#""theta": null"#, r#""quadrupole": 1"#, r#""Theta": 0.5"#] {
        let text = format!(r#"{{"forces": [{{"mutual_gravity": {{{wrong}}}}}]}}"#);
        assert!(SceneFile::from_json("a.json", &text).is_err(), "{wrong}");
    }
    let schema = pointmass::scene::schema();
    assert!(schema.contains("\"theta\"") && schema.contains("\"quadrupole\""));
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
    #![proptest_config(ProptestConfig {
        cases: often(300) as u32,
        failure_persistence: None,
        ..ProptestConfig::default()
    })]

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
