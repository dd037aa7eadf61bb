//! The arguments of `compare`.

use super::distribution::Distribution;
use super::rays::Made;
use super::study::Subject;
use super::workload::Workload;
use crate::formats::{PointsFormat, StudyFormat, named};
use crate::load::Reading;
use crate::outcome::{Failure, Outcome};
use crate::parse::{chosen, natural, number, seconds, sorted, whole};
use pointmass::index::Structure;
use std::path::PathBuf;

/// Arguments of `compare`.
#[derive(Debug, clap::Args)]
pub(crate) struct Compare {
    /// Points from a file: .csv, .ply, .xyz or .npy. Tables may be parted by commas, semicolons, tabs or blanks; columns
    /// are found by a head that names x, y and z, else the first three with numbers are taken
    #[arg(long, value_name = "FILE", value_parser = named::<PointsFormat>, conflicts_with_all = ["scene", "distribution"])]
    pub(crate) points: Option<(PathBuf, PointsFormat)>,
    /// The particles of a scene: .json or .scn, run to the time --at
    #[arg(long, value_name = "SCENE", conflicts_with = "distribution")]
    pub(crate) scene: Option<PathBuf>,
    /// How the scene is read.
    #[command(flatten)]
    pub(crate) reading: Reading,
    /// When a scene's particles are taken, in seconds; by default at the end of its duration
    #[arg(long, value_name = "S", allow_hyphen_values = true, value_parser = seconds, requires = "scene")]
    pub(crate) at: Option<f64>,
    /// Made-up points, one or more; by default uniform
    #[arg(long, value_name = "NAME,...", value_enum, value_delimiter = ',')]
    pub(crate) distribution: Vec<Distribution>,
    /// How many points, such as 1e3,1e4; by default 1e3,1e4,1e5, or all that the file or the scene has, of which
    /// other numbers take a random subset
    #[arg(long, value_name = "N,...", allow_negative_numbers = true, value_delimiter = ',', value_parser = count)]
    pub(crate) n: Vec<usize>,
    /// The triangles of a mesh, which segments are held against: .off, .obj, .stl, .ply, or the ink of a .png
    #[arg(long, value_name = "FILE", conflicts_with_all = ["points", "scene", "distribution", "surface", "triangles"])]
    pub(crate) mesh: Option<PathBuf>,
    /// Made-up meshes, one or more; by default both. What is asked of a mesh is --queries ray
    #[arg(long, value_name = "NAME,...", value_enum, value_delimiter = ',')]
    pub(crate) surface: Vec<Made>,
    /// About how many triangles made-up meshes have, such as 1e4,1e5; by default 6e4
    #[arg(long, value_name = "N,...", allow_negative_numbers = true, value_delimiter = ',', value_parser = triangles)]
    pub(crate) triangles: Vec<usize>,
    /// How many segments of every kind are held against a mesh; by default 20000
    #[arg(long, value_name = "N", allow_negative_numbers = true, value_parser = segments)]
    pub(crate) segments: Option<usize>,
    /// The radius of queries, in the points' unit; of a mesh that of the balls, by default a thousandth of its diagonal
    #[arg(long, value_name = "R", allow_hyphen_values = true, value_parser = radius, conflicts_with = "neighbours")]
    pub(crate) radius: Option<f32>,
    /// Choose the radius so that a point has so many others within it on average; by default 30
    #[arg(long, value_name = "M", allow_hyphen_values = true, value_parser = neighbours)]
    pub(crate) neighbours: Option<f64>,
    /// How many nearest others `nearest` looks for; by default 8
    #[arg(long, value_name = "K", allow_negative_numbers = true, value_parser = clap::value_parser!(u8).range(1..=64))]
    pub(crate) k: Option<u8>,
    /// What is asked; building is always measured. By default all that points are asked, count,within,nearest,pairs,moving,
    /// or with a mesh ray, which stands alone
    #[arg(long, value_name = "NAME,...", value_enum, value_delimiter = ',')]
    pub(crate) queries: Vec<Workload>,
    /// Which structures, such as grid,kd; or all. Of triangles there are brute, grid, octree, kd, bsp and bvh
    #[arg(long, value_name = "NAME,...", default_value = "all", value_parser = structures)]
    pub(crate) structures: Structures,
    /// Measure other libraries as well, where the program has them (cargo run --release -p pointmass-peers -- ...)
    #[arg(long)]
    pub(crate) peers: bool,
    /// How many times everything is measured; by default as often as three seconds allow, from 7 to 31 times, or 3
    /// times where a round takes very long
    #[arg(long, value_name = "N", allow_negative_numbers = true, value_parser = clap::value_parser!(u32).range(1..=10_000))]
    pub(crate) repeat: Option<u32>,
    /// The seed of made-up points, subsets, segments and scenes; by default 1, or what the scene says
    #[arg(long, value_name = "N", allow_negative_numbers = true, value_parser = natural)]
    pub(crate) seed: Option<u64>,
    /// Write the comparison into FILE: .html, a page with charts; .svg, the charts; .csv or .json, all figures; may be
    /// given several times
    #[arg(long, value_name = "FILE", value_parser = named::<StudyFormat>)]
    pub(crate) out: Vec<(PathBuf, StudyFormat)>,
    /// Print spreads, minima and counters of every measurement as well
    #[arg(long)]
    pub(crate) detail: bool,
}

impl Compare {
    /// The subject of the arguments.
    pub(crate) fn subject(&self) -> Outcome<Subject> {
        let of_points = [
            ("--points", self.points.is_some()),
            ("--scene", self.scene.is_some()),
            ("--distribution", !self.distribution.is_empty()),
            ("--n", !self.n.is_empty()),
            ("--neighbours", self.neighbours.is_some()),
            ("--k", self.k.is_some()),
        ];
        let of_meshes = [
            ("--mesh", self.mesh.is_some()),
            ("--surface", !self.surface.is_empty()),
            ("--triangles", !self.triangles.is_empty()),
            ("--segments", self.segments.is_some()),
        ];
        let given = |options: &[(&'static str, bool)]| options.iter().find(|(_, given)| *given).map(|(name, _)| *name);
        let other = self.queries.iter().find(|query| **query != Workload::Ray).map(|query| query.name());
        let rays = self.queries.contains(&Workload::Ray);
        match (given(&of_points), given(&of_meshes), rays, other) {
            (_, _, true, Some(other)) => Err(Failure::new(format!(
                "--queries: ray is asked of a mesh, {other} of points; ask for one after the other"
            ))),
            (Some(option), _, true, _) => {
                Err(Failure::new(format!("{option} is about points: --queries ray is asked of a mesh, see --mesh")))
            }
            (_, Some(option), _, Some(other)) => Err(Failure::new(format!(
                "{option} is about a mesh: {other} is asked of points; expected --queries ray"
            ))),
            (Some(points), Some(mesh), ..) => {
                Err(Failure::new(format!("{points} is about points, {mesh} about a mesh; leave one of them out")))
            }
            (_, None, false, _) => Ok(Subject::Points),
            _ => Ok(Subject::Mesh),
        }
    }

    /// The queries of points, each once.
    pub(crate) fn queries(&self) -> Vec<Workload> {
        sorted(&self.queries, &Workload::OF_POINTS)
    }

    /// The seed of all randomness.
    pub(crate) fn seed(&self) -> u64 {
        self.seed.unwrap_or(1)
    }

    /// How many nearest others are looked for.
    pub(crate) fn k(&self) -> usize {
        usize::from(self.k.unwrap_or(8))
    }

    /// How many others a point shall have within the radius, on average.
    pub(crate) fn neighbours(&self) -> f64 {
        self.neighbours.unwrap_or(30.0)
    }

    /// How many segments of every kind are held against a mesh.
    pub(crate) fn segments(&self) -> usize {
        self.segments.unwrap_or(20_000)
    }
}

/// Structures to compare, each once.
#[derive(Clone, Debug)]
pub(crate) struct Structures(pub(crate) Vec<Structure>);

fn structures(text: &str) -> Result<Structures, String> {
    chosen(text, Structure::ALL).map(Structures)
}

fn count(text: &str) -> Result<usize, String> {
    whole(text, 2.0, 1e8, "a whole number of points, from 2 to 1e8")
}

fn triangles(text: &str) -> Result<usize, String> {
    whole(text, 12.0, 2e7, "a whole number of triangles, from 12 to 2e7")
}

fn segments(text: &str) -> Result<usize, String> {
    whole(text, 1.0, 1e7, "a whole number of segments, from 1 to 1e7")
}

fn radius(text: &str) -> Result<f32, String> {
    let value = number(text)? as f32;
    if value > 0.0 && value.is_finite() { Ok(value) } else { Err("expected a positive, finite radius".into()) }
}

fn neighbours(text: &str) -> Result<f64, String> {
    let value = number(text)?;
    if (1e-3..=1e6).contains(&value) { Ok(value) } else { Err("expected a number from 0.001 to 1e6".into()) }
}
