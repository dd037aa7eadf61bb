//! Boxes whose opposite faces are one.

use super::INF;
use super::expected::{Expected, centers, compare};
use super::sets::reaches;
use pointmass::Vec3;
use pointmass::index::{SpatialIndex, Structure};
use pointmass_tests::fields::used;
use pointmass_tests::points::{Oracle, Spread};
use pointmass_tests::{Random, config};
use proptest::prelude::*;
use proptest::sample::select;

/// A box whose opposite faces are one.
#[derive(Clone, Copy, Debug)]
struct Torus {
    low: Vec3,
    sides: Vec3,
    n: usize,
    seed: u64,
}

impl Torus {
    fn shortest(self) -> f32 {
        self.sides.to_array().into_iter().filter(|&side| side > 0.0).fold(INF, f32::min)
    }

    /// A third of the points close together, some on the faces and next to them, many outside.
    fn points(self) -> Vec<Vec3> {
        let mut random = Random::new(self.seed);
        let around = Vec3::select(self.sides.cmpgt(Vec3::ZERO), self.sides, Vec3::ONE);
        let mut point = |i: usize| match i % 6 {
            0 | 1 => self.low + random.vector(0.1) * around,
            2 => self.low + around * (random.vector(1.5) * 2.0).round(),
            3 => self.low + around * random.vector(1.5).round() * (1.0 + random.between(-3e-7, 3e-7)),
            4 => self.low + around * (random.vector(0.5) + 0.5),
            _ => self.low + around * random.vector(4.0),
        };
        (0..self.n).map(&mut point).collect()
    }

    /// Points at all distances from the faces, from a rounding on, on both of their sides.
    fn points_by_the_faces(self) -> Vec<Vec3> {
        let mut random = Random::new(self.seed);
        let around = Vec3::select(self.sides.cmpgt(Vec3::ZERO), self.sides, Vec3::ONE);
        let mut coordinate = |low: f32, side: f32| {
            let off = side * 10f32.powf(random.between(-9.0, 0.5));
            match random.word() % 8 {
                0 => low,
                1 => low + side,
                2 => low + side * 0.5,
                3 => (low + side).next_down(),
                4 => low + side * random.between(0.0, 1.0),
                5 => low + off,
                _ => low + side - off,
            }
        };
        (0..self.n).map(|_| Vec3::from_array([0, 1, 2].map(|axis| coordinate(self.low[axis], around[axis])))).collect()
    }

    fn check(self, parts: &[f32], reach: f32) {
        self.check_points(&self.points(), parts, reach);
    }

    fn check_points(self, points: &[Vec3], parts: &[f32], reach: f32) {
        let shortest = self.shortest();
        let radii: Vec<f32> = parts.iter().map(|part| if shortest < INF { part * shortest } else { *part }).collect();
        let oracle = Oracle::periodic(points, self.low, self.sides);
        let centers = [centers(points, 4), vec![self.low, self.low + self.sides, self.low + self.sides * 0.5]].concat();
        let expected: Vec<_> = radii.iter().map(|&radius| Expected::new(&oracle, radius, &centers)).collect();
        for &structure in Structure::ALL {
            let mut memory = used(structure.words(points.len()));
            let mut index = structure.periodic(&mut memory, self.low, self.sides);
            index.build(points, reach * radii[0]).expect("the memory is made for so many");
            expected.iter().for_each(|expected| expected.compare(&index, &format!("periodic {structure}")));
            let moved: Vec<Vec3> = points.iter().map(|point| *point + self.sides * 0.3).collect();
            index.refit(&moved).expect("the memory is made for so many");
            let oracle = Oracle::periodic(&moved, self.low, self.sides);
            compare(&index, &oracle, &radii[..1], &centers, &format!("periodic {structure}, moved"));
        }
    }
}

proptest! {
    #![proptest_config(config!(500))]

    #[test]
    fn opposite_faces_are_one(
        low in prop_oneof![Just(Vec3::ZERO), Just(Vec3::new(-0.3, 7.1, 0.01)), Just(Vec3::splat(1e3))],
        sides in prop::array::uniform3(select(&[0.0f32, 1.0, 1.0, 2.0, 0.25, 0.7, 3.3, 11.0][..])),
        size in prop_oneof![6 => Just(1.0f32), 1 => select(&[1e-30f32, 1e-12, 1e12, 1e30][..])],
        n in 0usize..120,
        seed in any::<u64>(),
        part in prop_oneof![4 => (-2.0f32..0.3).prop_map(|power| 10f32.powf(power)), 1 => select(&[0.0, 0.5, 0.499_999_97, INF][..])],
        reach in reaches(),
    ) {
        Torus { low: low * size, sides: Vec3::from(sides) * size, n, seed }.check(&[part], reach);
    }
}

proptest! {
    #![proptest_config(config!(600))]

    #[test]
    fn sides_may_be_of_any_length(
        low in prop_oneof![3 => Just(0.0f32), 1 => select(&[-0.5f32, 0.3, -7.0, 1e-5][..])],
        size in prop_oneof![Just(0.0f32), -30.0f32..30.0],
        spread in select(&[0.0f32, 1.0, 6.0, 20.0, 60.0][..]),
        powers in prop::array::uniform3(-0.5f32..0.5),
        open in select(&[7u8, 7, 7, 7, 6, 5, 3, 1][..]),
        n in 2usize..60,
        seed in any::<u64>(),
        part in prop_oneof![3 => (-9.0f32..0.5).prop_map(|power| 10f32.powf(power)), 1 => select(&[6e-8f32, 0.5, 0.499_999_97][..])],
        reach in reaches(),
    ) {
        let side = |axis: usize| 10f32.powf((size + spread * powers[axis]).clamp(-30.0, 30.0));
        let sides = Vec3::from_array([0, 1, 2].map(|axis| if open >> axis & 1 == 1 { side(axis) } else { 0.0 }));
        let torus = Torus { low: sides * low, sides, n, seed };
        torus.check_points(&torus.points_by_the_faces(), &[part], reach);
    }
}

/// Points that only rounding or underflow brings within the radius, in another image; and sides as long as no scale is
/// needed for.
#[test]
fn what_only_rounding_brings_near_is_near() {
    let ulp = f32::EPSILON / 2.0;
    for size in [1e-18f32, 1e-6, 1.0, 1e3, 1.8e18] {
        for stretch in [Vec3::ONE, Vec3::new(1.0, 1.0, 1e-6), Vec3::new(1e-5, 0.0, 1.0)] {
            let torus = Torus { low: Vec3::ZERO, sides: stretch * size, n: 0, seed: 0 };
            let by = |part: f32| torus.sides * part;
            let at_a_face = [0.0, 0.1 * ulp, 0.4 * ulp, 0.6 * ulp, 1.4 * ulp, 1.0 - ulp, 1.0 - 2.0 * ulp].map(by);
            let apart = [0.3, 0.55, 0.8].map(by);
            let points = [&at_a_face[..], &apart, &at_a_face.map(|point| Vec3 { y: 0.0, ..point })].concat();
            for reach in [1.0, 0.25] {
                torus.check_points(&points, &[ulp, 2.0 * ulp, 0.3, 0.45], reach);
            }
        }
    }
}

#[test]
fn boxes_may_be_open_and_flat() {
    for sides in [[1.0, 1.0, 1.0], [1.0, 0.0, 0.0], [0.0, 4.0, 0.5], [1e-3, 1.0, 1e3], [0.0; 3]] {
        let torus = Torus { low: Vec3::ZERO, sides: sides.into(), n: 80, seed: 6 };
        torus.check(&[0.1, 0.0, 0.49, 0.5, 0.51, 2.0, INF, f32::NAN, -1.0], 1.0);
    }
}

/// Sides that are not lengths are no sides.
#[test]
fn senseless_sides_are_open() {
    let points = Spread::Cube.points(40, 2);
    for (low, side) in [(0.0, 0.0), (0.0, -1.0), (0.0, f32::NAN), (0.0, INF), (f32::NAN, 1.0), (-INF, 1.0)] {
        for &structure in Structure::ALL {
            let mut memory = used(structure.words(points.len()));
            let mut index = structure.periodic(&mut memory, Vec3::splat(low), Vec3::splat(side));
            index.build(&points, 0.2).expect("the memory is made for so many");
            let what = format!("{structure}, a side of {side} from {low} on");
            compare(&index, &Oracle::new(&points), &[0.2, 2.0], &centers(&points, 5), &what);
        }
    }
}

/// Points in one place, in a room whose coordinates round: a detour by an image of theirs would part them.
#[test]
fn who_is_in_one_place_is_near_through_no_image() {
    let torus =
        Torus { low: Vec3::new(-0.3, 7.1, 0.01), sides: Vec3::new(0.0, 1.0, 0.0), n: 16, seed: 11546556184628893228 };
    torus.check(&[0.0], 0.0);
}
