//! Made-up points: clouds whose shapes favour different structures, the same for the same seed.

use clap::ValueEnum;
use pointmass::Vec3;
use pointmass::math::{frame, sin_cos_turns, sqrt, unit};
use pointmass::rng::Stream;

/// A way to make points up. The first points of a larger cloud are those of a smaller one.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum Distribution {
    /// Evenly in a cube of side 1
    Uniform,
    /// A star cluster: Plummer's sphere of scale length 1, its innermost 99.9 %
    Plummer,
    /// Evenly on a sphere's surface of radius 1
    Sphere,
    /// Evenly on a square of side 1 that no axis is parallel to
    Plane,
    /// Evenly on a segment of length 1 that no axis is parallel to
    Line,
    /// 32 Gaussian clusters of uneven number and width in a cube of side 1
    Clusters,
    /// Half uniform, half clusters, and every 16th point at the place of another
    Mixed,
}

/// How many clusters there are.
const CLUSTERS: f32 = 32.0;
/// Streams of the clusters' centres stand apart from those of points.
const CENTERS: u32 = 1 << 16;

impl Distribution {
    /// Its name.
    pub(crate) fn name(self) -> &'static str {
        self.told()[0]
    }

    /// Its description for those who read a report.
    pub(crate) fn describe(self) -> &'static str {
        self.told()[1]
    }

    fn told(self) -> [&'static str; 2] {
        match self {
            Self::Uniform => ["uniform", "evenly in a cube of side 1"],
            Self::Plummer => ["plummer", "Plummer's sphere of scale length 1, the innermost 99.9 % of its mass"],
            Self::Sphere => ["sphere", "evenly on the surface of a sphere of radius 1"],
            Self::Plane => ["plane", "evenly on a square of side 1 with the normal (1, 1, 1)"],
            Self::Line => ["line", "evenly on a segment of length 1 along (1, 1, 1)"],
            Self::Clusters => ["clusters", "32 Gaussian clusters of uneven number and width in a cube of side 1"],
            Self::Mixed => ["mixed", "half uniform, half clusters, every 16th point at the place of another"],
        }
    }

    /// So many points.
    pub(crate) fn points(self, n: usize, seed: u64) -> Vec<Vec3> {
        (0..n as u32).map(|serial| self.point(serial, seed)).collect()
    }

    fn point(self, serial: u32, seed: u64) -> Vec3 {
        let stream = Stream::new(seed, self as u32, serial);
        let along = unit(Vec3::ONE);
        match self {
            Self::Uniform => in_cube(&stream),
            Self::Plummer => plummer_radius(stream.units(1)[0]) * direction(stream.units(0)),
            Self::Sphere => direction(stream.units(0)),
            Self::Plane => {
                let ([u, v], (a, b)) = (stream.units(0), frame(along));
                (u - 0.5) * a + (v - 0.5) * b
            }
            Self::Line => (stream.units(0)[0] - 0.5) * along,
            Self::Clusters => in_cluster(&stream, seed),
            Self::Mixed => match serial % 16 {
                15 => self.point(serial - 8, seed),
                odd if odd % 2 == 1 => in_cluster(&stream, seed),
                _ => in_cube(&stream),
            },
        }
    }
}

fn in_cube(stream: &Stream) -> Vec3 {
    let ([x, y], [z, _]) = (stream.units(0), stream.units(1));
    Vec3::new(x, y, z)
}

/// Evenly on the unit sphere (Archimedes: the height is uniform).
pub(crate) fn direction([height, turns]: [f32; 2]) -> Vec3 {
    let y = 2.0 * height - 1.0;
    let (sin, cos) = sin_cos_turns(turns);
    let across = sqrt((1.0 - y * y).max(0.0));
    Vec3::new(across * cos, y, across * sin)
}

/// The radius within which a part of the mass lies: r = (m^(-2/3) - 1)^(-1/2)
/// (Aarseth, Henon, Wielen, Astronomy and Astrophysics 37, 183, 1974).
fn plummer_radius(part: f32) -> f32 {
    const KEPT: f64 = 0.999;
    let mass = (f64::from(part) * KEPT).max(1e-12);
    (1.0 / (mass.powf(-2.0 / 3.0) - 1.0).sqrt()) as f32
}

/// Three numbers of a Gaussian distribution of mean 0 and variance 1 (Box and Muller), from the pairs 2 and 3.
fn gaussian(stream: &Stream) -> Vec3 {
    let pair = |place| {
        let [u, v] = stream.units(place);
        let (sin, cos) = sin_cos_turns(v);
        let radius = sqrt(-2.0 * (1.0 - u).ln());
        [radius * cos, radius * sin]
    };
    let ([x, y], [z, _]) = (pair(2), pair(3));
    Vec3::new(x, y, z)
}

/// Low numbers of clusters are likelier; widths are from 0.005 to 0.05.
fn in_cluster(stream: &Stream, seed: u64) -> Vec3 {
    let u = stream.units(4)[0];
    let cluster = Stream::new(seed, CENTERS, (u * u * CLUSTERS) as u32);
    let width = 0.005 + 0.045 * cluster.units(1)[1];
    in_cube(&cluster) + width * gaussian(stream)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeSet;

    const N: usize = 20_000;

    fn mean(values: impl Iterator<Item = f32>) -> f64 {
        let (sum, n) = values.fold((0.0, 0.0), |(sum, n), x| (sum + f64::from(x), n + 1.0));
        sum / n
    }

    fn bits(points: &[Vec3]) -> Vec<[u32; 3]> {
        points.iter().map(|point| point.to_array().map(f32::to_bits)).collect()
    }

    #[test]
    fn clouds_are_finite_repeatable_and_grow_at_the_end() {
        for distribution in Distribution::value_variants() {
            let points = distribution.points(2000, 7);
            assert!(points.iter().all(|point| point.is_finite()), "{distribution:?}");
            assert_eq!(bits(&points[..500]), bits(&distribution.points(500, 7)), "{distribution:?}");
            assert_ne!(bits(&points), bits(&distribution.points(2000, 8)), "{distribution:?}");
            let name = distribution.to_possible_value().map(|value| value.get_name().to_string());
            assert_eq!(name.as_deref(), Some(distribution.name()));
        }
    }

    #[test]
    fn the_cube_is_filled_evenly() {
        let points = Distribution::Uniform.points(N, 1);
        let mut cells = [0u32; 64];
        for point in &points {
            assert!(point.cmpge(Vec3::ZERO).all() && point.cmplt(Vec3::ONE).all());
            let [x, y, z] = (*point * 4.0).to_array().map(|x| x as usize);
            cells[(z * 4 + y) * 4 + x] += 1;
        }
        let expected = N as f64 / 64.0;
        let chi2: f64 = cells.iter().map(|&n| (f64::from(n) - expected).powi(2) / expected).sum();
        assert!(chi2 < 103.4, "chi-squared of 63 degrees at 0.1 %: {chi2}");
    }

    #[test]
    fn half_of_plummers_mass_lies_within_1_3_scale_lengths() {
        let points = Distribution::Plummer.points(N, 1);
        // m(r) = r^3 / (1 + r^2)^(3/2), of which 99.9 % are kept; four standard deviations are 0.014.
        for radius in [0.5f64, 1.3048, 4.0] {
            let expected = radius.powi(3) / (1.0 + radius * radius).powf(1.5) / 0.999;
            let part = points.iter().filter(|p| f64::from(p.length()) < radius).count() as f64 / N as f64;
            assert!((part - expected).abs() < 0.014, "{part} of the mass within {radius}, expected {expected}");
        }
        assert!(points.iter().all(|point| point.length() < 38.8));
    }

    #[test]
    fn the_sphere_is_a_surface() {
        let points = Distribution::Sphere.points(N, 1);
        assert!(points.iter().all(|point| (point.length() - 1.0).abs() < 1e-5));
        for axis in 0..3 {
            // Four standard deviations of a mean of numbers uniform in -1 ..= 1.
            assert!(mean(points.iter().map(|point| point[axis])).abs() < 4.0 * (1.0 / 3.0 / N as f64).sqrt());
        }
    }

    #[test]
    fn plane_and_line_are_flat_and_oblique() {
        let along = unit(Vec3::ONE);
        let plane = Distribution::Plane.points(N, 1);
        assert!(plane.iter().all(|point| point.dot(along).abs() < 1e-6));
        // The mean square of a side 1 about its middle is 1/12, here of two.
        let square = mean(plane.iter().map(|point| point.length_squared()));
        assert!((square - 1.0 / 6.0).abs() < 0.005, "{square}");
        let line = Distribution::Line.points(N, 1);
        assert!(line.iter().all(|point| point.cross(along).length() < 1e-6));
        let square = mean(line.iter().map(|point| point.length_squared()));
        assert!((square - 1.0 / 12.0).abs() < 0.003, "{square}");
    }

    #[test]
    fn clusters_are_dense_and_mixed_has_duplicates() {
        let near = |points: &[Vec3]| {
            let some = points.iter().take(300);
            let counts = some.map(|a| points.iter().filter(|b| a.distance(**b) < 0.03).count() as f32);
            mean(counts)
        };
        let [even, dense] = [Distribution::Uniform, Distribution::Clusters].map(|d| near(&d.points(5000, 3)));
        assert!(dense > 20.0 * even, "{dense} neighbours in clusters, {even} in the cube");
        let mixed = Distribution::Mixed.points(1600, 3);
        let distinct: BTreeSet<_> = bits(&mixed).into_iter().collect();
        assert_eq!(distinct.len(), 1500);
    }
}
