//! Meshes that are made up, the same everywhere: what benches, comparisons and tests use where no file is given.

use clap::ValueEnum;
use pointmass::Vec3;
use pointmass::math::{sin_cos_turns, unit};
use pointmass::rng::Stream;
use pointmass_files::meshes::MeshData;

/// A surface to be made of triangles.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, ValueEnum)]
pub enum Made {
    /// A tube with bumps around a trefoil knot: closed, curved, and behind itself from most sides
    Knot,
    /// Hills over a square: open, flat and wide, as landscapes are
    Terrain,
}

impl Made {
    /// Its name.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Knot => "knot",
            Self::Terrain => "terrain",
        }
    }

    /// Its description for those who read a report.
    #[must_use]
    pub fn describe(self) -> &'static str {
        match self {
            Self::Knot => {
                "a tube with bumps around a trefoil knot, about 2 m wide, closed, of triangles about as long as wide"
            }
            Self::Terrain => "hills of six sizes over a square of side 2 m, of right triangles",
        }
    }

    /// It, of about so many triangles \[m\]: as near as rows of equal numbers come to it, 12 at the least.
    #[must_use]
    pub fn mesh(self, triangles: usize) -> MeshData {
        match self {
            Self::Knot => knot(triangles),
            Self::Terrain => terrain(triangles),
        }
    }
}

/// A grid of `u` by `v` cells, its ends joined or not, each of two triangles.
fn sheet(u: usize, v: usize, joined: bool, point: impl Fn(f32, f32) -> Vec3) -> MeshData {
    let (columns, rows) = if joined { (u, v) } else { (u + 1, v + 1) };
    let place = |i: usize, j: usize| point(i as f32 / u as f32, j as f32 / v as f32).to_array();
    let vertices = (0..columns).flat_map(|i| (0..rows).map(move |j| place(i, j))).collect();
    let number = |i: usize, j: usize| ((i % columns) * rows + j % rows) as u32;
    let cell = |i: usize, j: usize| {
        let [a, b, c, d] = [number(i, j), number(i + 1, j), number(i + 1, j + 1), number(i, j + 1)];
        [[a, b, c], [a, c, d]]
    };
    let triangles = (0..u).flat_map(|i| (0..v).flat_map(move |j| cell(i, j))).collect();
    MeshData { vertices, triangles }
}

/// Cells for so many triangles, `ratio` times as many along the one side as along the other.
fn cells(triangles: usize, ratio: f64, fewest: usize) -> [usize; 2] {
    let all = triangles as f64 / 2.0;
    let v = ((all / ratio).sqrt().round() as usize).max(fewest);
    [((all / v as f64).round() as usize).max(fewest), v]
}

/// The trefoil knot (sin t + 2 sin 2t, −sin 3t, cos t − 2 cos 2t) / 3 with a tube around it.
fn knot(triangles: usize) -> MeshData {
    // The knot is 12 times as long as the tube is around.
    let [u, v] = cells(triangles, 12.0, 3);
    sheet(u, v, true, |along, around| {
        let [(s1, c1), (s2, c2), (s3, c3)] = [1.0, 2.0, 3.0].map(|k| sin_cos_turns(k * along));
        let center = Vec3::new(s1 + 2.0 * s2, -s3, c1 - 2.0 * c2);
        let forward = unit(Vec3::new(c1 + 4.0 * c2, -3.0 * c3, 4.0 * s2 - s1));
        // It nowhere runs straight up.
        let aside = unit(forward.cross(Vec3::Y));
        let (sin, cos) = sin_cos_turns(around);
        let bumps = sin_cos_turns(40.0 * along).0 * sin_cos_turns(5.0 * around).0;
        let radius = 0.5 + 0.04 * bumps;
        (center + radius * (cos * aside + sin * aside.cross(forward))) / 3.0
    })
}

/// Waves of six lengths in different directions, each half as long and about half as high as the one before.
fn terrain(triangles: usize) -> MeshData {
    let [u, v] = cells(triangles, 1.0, 2);
    let waves: [_; 6] = std::array::from_fn(|octave| {
        let ([turn, phase], scale) = (Stream::new(7, 0, octave as u32).units(0), (1 << octave) as f32);
        let (sin, cos) = sin_cos_turns(turn);
        (cos * scale, sin * scale, phase, 0.12 / scale)
    });
    sheet(u, v, false, |x, z| {
        let wave = |(a, b, phase, high): &(f32, f32, f32, f32)| high * sin_cos_turns(a * x + b * z + phase).0;
        let height = waves.iter().map(wave).sum();
        Vec3::new(2.0 * x - 1.0, height, 1.0 - 2.0 * z)
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeMap;

    fn volume(mesh: &MeshData) -> f64 {
        let corner = |i: u32| mesh.vertices[i as usize].map(f64::from);
        let six = |[a, b, c]: [[f64; 3]; 3]| -> f64 {
            (0..3).map(|i| a[i] * (b[(i + 1) % 3] * c[(i + 2) % 3] - b[(i + 2) % 3] * c[(i + 1) % 3])).sum()
        };
        mesh.triangles.iter().map(|triangle| six(triangle.map(corner))).sum::<f64>() / 6.0
    }

    #[test]
    fn there_are_about_as_many_triangles_as_were_asked_for() {
        for made in [Made::Knot, Made::Terrain] {
            for n in [200, 1000, 60_000] {
                let found = made.mesh(n).triangles.len();
                assert!(found.abs_diff(n) * 10 <= n, "{found} for {n}");
            }
            assert!((8..=18).contains(&made.mesh(0).triangles.len()));
        }
        assert_eq!(Made::Knot.mesh(60_000).triangles.len(), 60_000);
    }

    #[test]
    fn the_knot_is_closed_and_looks_outward() {
        let mesh = Made::Knot.mesh(6000);
        let mut edges = BTreeMap::new();
        for [a, b, c] in &mesh.triangles {
            for (from, to) in [(a, b), (b, c), (c, a)] {
                *edges.entry((from, to)).or_insert(0) += 1;
            }
        }
        assert!(edges.iter().all(|((from, to), n)| *n == 1 && edges.contains_key(&(*to, *from))));
        // The tube's section times the knot's length: π 0.5² · 29.4 / 27, up to the bumps.
        let volume = volume(&mesh);
        assert!((0.7..1.0).contains(&volume), "{volume} m³");
    }

    #[test]
    fn the_terrain_looks_up_and_covers_its_square() {
        let mesh = Made::Terrain.mesh(2000);
        let corner = |i: u32| Vec3::from(mesh.vertices[i as usize]);
        let areas =
            mesh.triangles.iter().map(|&[a, b, c]| (corner(b) - corner(a)).cross(corner(c) - corner(a)).y * 0.5);
        let areas: Vec<_> = areas.collect();
        assert!(areas.iter().all(|area| *area > 0.0));
        assert!((areas.iter().sum::<f32>() - 4.0).abs() < 1e-3);
        let heights = mesh.vertices.iter().map(|vertex| vertex[1].abs());
        assert!((0.1..0.24).contains(&heights.fold(0.0, f32::max)));
    }
}
