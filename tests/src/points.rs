//! Sets of points, and what is near in them by looking at every pair: what every index is held against.

use crate::Random;
use pointmass::Vec3;
use pointmass::index::Neighbour;

/// How points are spread, about a metre wide around the origin.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Spread {
    /// Uniform in a cube.
    Cube,
    /// Dense in the middle, without an end: Plummer's model of a star cluster.
    Plummer,
    /// Uniform on a sphere.
    Sphere,
    /// Uniform on a plane that no axis is parallel to.
    Oblique,
    /// Uniform on a plane with exactly the same y.
    Flat,
    /// Uniform on a line that no axis is parallel to.
    Line,
    /// Five normal distributions of different widths.
    Clusters,
    /// Every eighth of a metre, in random order: many distances are exactly equal.
    Lattice,
}

impl Spread {
    /// All of them.
    pub const ALL: [Self; 8] =
        [Self::Cube, Self::Plummer, Self::Sphere, Self::Oblique, Self::Flat, Self::Line, Self::Clusters, Self::Lattice];

    /// So many points.
    #[must_use]
    pub fn points(self, n: usize, seed: u64) -> Vec<Vec3> {
        let mut random = Random::new(seed);
        if self == Self::Lattice {
            let side = (1..).find(|side| side * side * side >= n).unwrap_or(1);
            let at = |i: usize| [i % side, i / side % side, i / side / side].map(|i| i as f32 / 8.0);
            let mut points: Vec<_> = (0..n).map(|i| Vec3::from_array(at(i))).collect();
            shuffle(&mut points, &mut random);
            return points;
        }
        let middles: [_; 5] = core::array::from_fn(|_| random.vector(0.5));
        (0..n).map(|i| self.point(middles[i % 5], 0.1 / (i % 5 + 1) as f32, &mut random)).collect()
    }

    fn point(self, middle: Vec3, width: f32, random: &mut Random) -> Vec3 {
        let (u, v) = (Vec3::new(0.6, 0.64, 0.48), Vec3::new(-0.3, 0.7, 0.2));
        match self {
            Self::Cube | Self::Lattice => random.vector(0.5),
            Self::Plummer => {
                let mass = random.between(1e-3, 0.999);
                random.direction() * (0.1 / (mass.powf(-2.0 / 3.0) - 1.0).sqrt())
            }
            Self::Sphere => random.direction() * 0.5,
            Self::Oblique => u * random.between(-0.5, 0.5) + v * random.between(-0.5, 0.5),
            Self::Flat => Vec3 { y: 0.1, ..random.vector(0.5) },
            Self::Line => u * random.between(-0.5, 0.5) + v,
            Self::Clusters => {
                // The sum of twelve uniform numbers is close to normal.
                let side = |random: &mut Random| (0..12).map(|_| random.between(-0.5, 0.5)).sum::<f32>() * width;
                middle + Vec3::new(side(random), side(random), side(random))
            }
        }
    }
}

/// The settings of a property that is tried on so many sets: a tenth of that in debug builds, and no file of failures.
#[macro_export]
macro_rules! config {
    ($cases:expr) => {
        ::proptest::test_runner::Config {
            cases: $crate::often($cases) as u32,
            failure_persistence: None,
            ..::proptest::test_runner::Config::default()
        }
    };
}

/// Puts `items` into a random order (Fisher and Yates).
pub fn shuffle<T>(items: &mut [T], random: &mut Random) {
    for last in (1..items.len()).rev() {
        items.swap(last, random.word() as usize % (last + 1));
    }
}

/// The side of the box around all finite points \[m\].
#[must_use]
pub fn extent(points: &[Vec3]) -> f32 {
    let sound = || points.iter().filter(|point| point.is_finite());
    let [low, high] =
        [sound().copied().reduce(Vec3::min), sound().copied().reduce(Vec3::max)].map(Option::unwrap_or_default);
    (high * 0.5 - low * 0.5).max_element() * 2.0
}

/// Points as an index is to see them, by row, and the space they are in.
#[derive(Clone, Debug)]
pub struct Oracle {
    rows: Vec<Option<Vec3>>,
    low: Vec3,
    sides: Vec3,
    scale: f32,
}

impl Oracle {
    /// Points in open space.
    #[must_use]
    pub fn new(points: &[Vec3]) -> Self {
        Self::periodic(points, Vec3::ZERO, Vec3::ZERO)
    }

    /// Points in a box whose opposite faces are one, along the axes where its side is not zero.
    #[must_use]
    pub fn periodic(points: &[Vec3], low: Vec3, sides: Vec3) -> Self {
        let mut oracle = Self { rows: vec![], low, sides, scale: 1.0 };
        let wrapped = points.iter().filter(|point| point.is_finite()).map(|&point| oracle.place(point));
        let largest = wrapped.chain([sides]).map(|point| point.abs().max_element()).fold(0.0, f32::max);
        oracle.scale = scale(largest);
        oracle.rows = points.iter().map(|&point| point.is_finite().then(|| oracle.place(point))).collect();
        oracle
    }

    /// Rows of the points that are finite.
    pub fn sound(&self) -> impl Iterator<Item = u32> {
        self.sites().map(|(row, _)| row)
    }

    /// The number of rows, finite or not.
    #[must_use]
    pub fn rows(&self) -> usize {
        self.rows.len()
    }

    /// All points within `radius` of `center`, the nearest first, of equally near ones the lower row.
    #[must_use]
    pub fn near(&self, center: Vec3, radius: f32) -> Vec<Neighbour> {
        if center.is_finite() { self.near_place(self.place(center), radius, None) } else { vec![] }
    }

    /// The same for every row, without itself; none where a row has no sound point.
    #[must_use]
    pub fn all_near(&self, radius: f32) -> Vec<Vec<Neighbour>> {
        let others = |(row, place): (usize, &Option<Vec3>)| {
            place.map_or(vec![], |place| self.near_place(place, radius, Some(row as u32)))
        };
        self.rows.iter().enumerate().map(others).collect()
    }

    fn sites(&self) -> impl Iterator<Item = (u32, Vec3)> {
        self.rows.iter().enumerate().filter_map(|(row, place)| place.map(|place| (row as u32, place)))
    }

    fn near_place(&self, from: Vec3, radius: f32, without: Option<u32>) -> Vec<Neighbour> {
        if radius.is_nan() || radius < 0.0 {
            return vec![];
        }
        let limit = (radius * self.scale) * (radius * self.scale);
        let all = self.sites().filter(|(row, _)| Some(*row) != without);
        let squares = all.map(|(row, place)| Neighbour { row, distance: self.square(from, place) });
        let mut found: Vec<_> = squares.filter(|found| found.distance <= limit).collect();
        found.sort_by(|a, b| a.distance.total_cmp(&b.distance).then(a.row.cmp(&b.row)));
        found.iter_mut().for_each(|found| found.distance = found.distance.sqrt() / self.scale);
        found
    }

    fn square(&self, a: Vec3, b: Vec3) -> f32 {
        let side = |axis: usize| {
            let (d, whole) = (b[axis] - a[axis], self.sides[axis] * self.scale);
            match whole {
                0.0 => d,
                _ if d > whole * 0.5 => d - whole,
                _ if d <= whole * -0.5 => d + whole,
                _ => d,
            }
        };
        let [x, y, z] = [side(0), side(1), side(2)];
        (x * x + y * y) + z * z
    }

    fn place(&self, point: Vec3) -> Vec3 {
        let wrapped = |axis: usize| {
            let (x, low, side) = (point[axis], self.low[axis], self.sides[axis]);
            if side == 0.0 {
                return x;
            }
            let x = x - low;
            let x = x - side * (x / side).floor();
            if (0.0..side).contains(&x) { x } else { 0.0 }
        };
        Vec3::new(wrapped(0), wrapped(1), wrapped(2)) * self.scale
    }
}

/// The power of two that coordinates are multiplied by before they are squared: one, unless the largest is above 2⁶¹ or
/// below 2⁻³⁰, which is brought to between 1 and 2 as far as factors between 2⁻¹²⁶ and 2¹²⁶ can.
fn scale(largest: f32) -> f32 {
    if largest == 0.0 {
        return 1.0;
    }
    // Exact, since doubles hold every f32 as a normal number.
    let exponent = ((f64::from(largest).to_bits() >> 52) as i32 - 1023).clamp(-126, 126);
    if (-30..=60).contains(&exponent) { 1.0 } else { 2f32.powi(-exponent) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_oracle_knows_what_is_near() {
        let points = [Vec3::ZERO, Vec3::X * 5.0, Vec3::NAN, Vec3::new(3.0, 0.0, 4.0), Vec3::ZERO];
        let oracle = Oracle::new(&points);
        let found = |row, distance| Neighbour { row, distance };
        assert_eq!(oracle.sound().collect::<Vec<_>>(), [0, 1, 3, 4]);
        assert_eq!(oracle.near(Vec3::ZERO, 5.0), [found(0, 0.0), found(4, 0.0), found(1, 5.0), found(3, 5.0)]);
        assert_eq!(oracle.near(Vec3::ZERO, 4.999), [found(0, 0.0), found(4, 0.0)]);
        assert_eq!(oracle.all_near(0.0), [vec![found(4, 0.0)], vec![], vec![], vec![], vec![found(0, 0.0)]]);
        let oracle = Oracle::periodic(&points, Vec3::ZERO, Vec3::new(8.0, 0.0, 4.0));
        assert_eq!(oracle.near(Vec3::X * -3.0, 2.0), [found(1, 0.0), found(3, 2.0)]);
    }

    #[test]
    fn scales_bring_the_largest_near_one() {
        for (largest, expected) in [(0.0, 1.0), (1e9, 1.0), (1e-9, 1.0), (1e18, 1.0), (2f32.powi(62), 2f32.powi(-62))] {
            assert_eq!(scale(largest), expected);
        }
        for largest in [1e30, 1e-30, 1e20, f32::MIN_POSITIVE] {
            assert!((1.0..2.0).contains(&(largest * scale(largest))), "{largest}");
        }
        assert_eq!((scale(f32::MAX), scale(1e-40)), (2f32.powi(-126), 2f32.powi(126)));
    }
}
