//! Sums where an `f32` ends.

use super::{BOTH, law};
use pointmass::Vec3;
use pointmass_tests::fields::Charges;
use pointmass_tests::points::Spread;
use pointmass_tests::{Random, f64s, gap, often};

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
            for length in (-12..=12).take(often(25)) {
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
                // Sums that are far softer than the world is wide may vanish.
                let most = if softening > length * 1e10 { 1.0 } else { 1e-2 };
                assert!(off.share <= most, "{length:e}, {softening:e}, {theta}, {quadrupole}: {off:?}");
            }
        }
    }
}

#[test]
fn places_near_the_origin_are_like_others() {
    // The values that lanes without a point hold must not come near any place.
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
