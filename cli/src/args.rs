//! The command line, parsed and nothing more.

use crate::compare::{Distribution, Workload};
use crate::formats::{PlotFormat, PointsFormat, RecordFormat, SceneFormat, StudyFormat, extension};
use crate::lab::Named;
use crate::meshes::Made;
use crate::substeps::Substeps;
use clap::{Args as ClapArgs, Parser, Subcommand, ValueEnum};
use pointmass::index::Structure;
use pointmass::scene::Unknown;
use pointmass::{Method, Response, rays};
use std::fmt::Display;
use std::path::{Path, PathBuf};
use std::str::FromStr;

/// Particle systems that are exact, bounded and the same everywhere.
#[derive(Debug, Parser)]
#[command(
    name = "pointmass",
    version,
    max_term_width = 100,
    after_help = "\
Examples:
  pointmass render scenes/fountain.json --out fountain.gif
  pointmass run scenes/rope.scn --duration 10 --dt 0.001 --out rope.csv
  pointmass run scenes/fountain.json --report json | jq .died
  pointmass check scenes/rope.scn --dt 1/30
  pointmass convert lab.scn lab.json
  pointmass compare --distribution uniform,plummer --n 1e3,1e4,1e5 --out study.html
  pointmass compare --mesh bunny.ply --out rays.html
  pointmass lab --problems oscillator,kepler --out lab.html
  pointmass lab scenes/rope.scn --duration 2 --dt 1/60,1/120,1/240,1/480"
)]
pub struct Args {
    /// What to do.
    #[command(subcommand)]
    pub command: Command,
}

/// What to do.
#[derive(Debug, Subcommand)]
pub enum Command {
    /// Run a scene and report what happened
    Run(Run),
    /// Draw a scene as an animation or pictures
    Render(Render),
    /// Translate a scene between .scn and .json
    Convert(Convert),
    /// Say which steps a scene stands with every integrator, what limits them and what to change
    Check(Check),
    /// Measure which spatial partition suits which points and queries, or which mesh and rays
    Compare(Compare),
    /// Measure how exact the integrators are, and how well they keep energy
    Lab(Lab),
    /// Print the JSON Schema of .json scenes
    Schema,
}

/// How a scene is read.
#[derive(Clone, Copy, Debug, Default, ClapArgs)]
pub struct Reading {
    /// Pass over commands that .scn does not have, up to the next line that begins with one it has, with a warning each
    #[arg(long)]
    pub skip_unknown: bool,
}

/// How a scene is run.
#[derive(Debug, ClapArgs)]
pub struct World {
    /// The scene: .json or .scn
    pub scene: PathBuf,
    /// How the scene is read.
    #[command(flatten)]
    pub reading: Reading,
    /// How many seconds; by default what the scene says, 10 for .scn
    #[arg(long, value_name = "S", value_parser = seconds)]
    pub duration: Option<f64>,
    /// The step in seconds, such as 0.001 or 1/60; by default what the scene says, 1/60 for .scn
    #[arg(long, value_name = "S", value_parser = step)]
    pub dt: Option<f64>,
    /// The method: euler, symplectic, midpoint, lecture_midpoint, verlet, rk4, adaptive, embedded or implicit; by default
    /// what the scene says, rk4 for .scn
    #[arg(long, value_name = "NAME")]
    pub integrator: Option<Method>,
    /// How forces between neighbours find them: brute, grid, hash, quadtree, octree, kd, bsp or bvh; by default what the
    /// scene says, else grid. They end in the same bits by all of them
    #[arg(long, value_name = "NAME")]
    pub index: Option<Structure>,
    /// How particles that have a radius answer each other: impulse, force or position; by default what the scene says,
    /// else they pass through each other
    #[arg(long, value_name = "NAME", value_parser = clap::builder::PossibleValuesParser::new(Response::NAMES))]
    pub response: Option<String>,
    /// How paths find what they run into among the triangles of a mesh: brute, grid, octree, kd, bsp or bvh, all to the
    /// same end; by default what the scene says, else bvh
    #[arg(long, value_name = "NAME")]
    pub collision_index: Option<rays::Structure>,
    /// The seed of all randomness; by default what the scene says, else 1
    #[arg(long, value_name = "N")]
    pub seed: Option<u64>,
    /// How many particles may live at once, what finds no room is refused and counted; by default what the scene says
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(..=500_000_000))]
    pub capacity: Option<u32>,
    /// Divide every step into N sub-steps, or `auto`: into as few as springs, drag and contacts need to be stable and
    /// --tolerance asks, at most 1024
    #[arg(long, value_name = "N|auto", default_value = "1", value_parser = substeps)]
    pub substeps: Substeps,
    /// With --substeps auto, how far a step may end, in metres and at any particle, from where half as many sub-steps
    /// would take it; by default 1e-4 of the radius of what is there at the start. With adaptive and embedded, how far an
    /// inner step may err; by default what the scene says, 1e-4
    #[arg(long, value_name = "M", value_parser = tolerance)]
    pub tolerance: Option<f64>,
    /// On how many threads many particles are stepped, to the same bits: whole steps where they have nothing to do with each
    /// other, else the sums of their forces; by default as many as the machine has
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub threads: Option<u16>,
}

/// Arguments of `run`.
#[derive(Debug, ClapArgs)]
pub struct Run {
    /// How the scene is run.
    #[command(flatten)]
    pub world: World,
    /// How many steps, instead of a duration
    #[arg(long, value_name = "N", conflicts_with = "duration")]
    pub steps: Option<u64>,
    /// Record every K-th step (step 0 and the last always)
    #[arg(long, value_name = "K", default_value_t = 1, value_parser = clap::value_parser!(u64).range(1..))]
    pub every: u64,
    /// Record into FILE: .csv, .jsonl, .xyz, or .ply for one file a record; may be given several times
    #[arg(long, value_name = "FILE", value_parser = recorded)]
    pub out: Vec<(PathBuf, RecordFormat)>,
    /// Keep account of energy and say where it went
    #[arg(long)]
    pub ledger: bool,
    /// Hold forces that take far groups as one (by their theta) against the sums over all pairs, at the end and at about a
    /// thousand particles
    #[arg(long)]
    pub group_error: bool,
    /// How to say on standard output what happened
    #[arg(long, value_enum, default_value_t = Report::Text)]
    pub report: Report,
}

/// How to say what happened.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Report {
    /// For people
    Text,
    /// One JSON object
    Json,
}

/// Arguments of `render`.
#[derive(Debug, ClapArgs)]
pub struct Render {
    /// How the scene is run.
    #[command(flatten)]
    pub world: World,
    /// FILE.gif, an animation; FILE.png, the last picture; or DIR/%04d.png, all pictures
    #[arg(long, value_name = "FILE", value_parser = drawn)]
    pub out: PathBuf,
    /// Width and height in pixels
    #[arg(long, value_name = "WxH", default_value = "640x480", value_parser = size)]
    pub size: (u32, u32),
    /// Pictures per second of the scene's time
    #[arg(long, value_name = "N", default_value_t = 25, value_parser = clap::value_parser!(u32).range(1..=1000))]
    pub fps: u32,
    /// Draw the surfaces that particles come from and vanish at as well
    #[arg(long)]
    pub show_sources: bool,
}

/// Arguments of `convert`.
#[derive(Debug, ClapArgs)]
pub struct Convert {
    /// The scene to read: .scn or .json
    pub from: PathBuf,
    /// How the scene is read.
    #[command(flatten)]
    pub reading: Reading,
    /// The scene to write: .scn or .json
    #[arg(value_parser = scene_format)]
    pub to: (PathBuf, SceneFormat),
}

/// Arguments of `check`.
#[derive(Debug, ClapArgs)]
pub struct Check {
    /// The scene: .json or .scn
    pub scene: PathBuf,
    /// How the scene is read.
    #[command(flatten)]
    pub reading: Reading,
    /// The step in seconds that is judged, such as 0.001 or 1/60; by default what the scene says, 1/60 for .scn
    #[arg(long, value_name = "S", value_parser = step)]
    pub dt: Option<f64>,
    /// The method that is advised on, any that `run` knows; by default what the scene says, rk4 for .scn
    #[arg(long, value_name = "NAME")]
    pub integrator: Option<Method>,
    /// Draw where methods are stable, and where the scene's oscillations lie: FILE.svg, or .html for a page with the report
    #[arg(long, value_name = "FILE", value_parser = plotted)]
    pub plot: Option<(PathBuf, PlotFormat)>,
    /// How to say it on standard output
    #[arg(long, value_enum, default_value_t = Report::Text)]
    pub report: Report,
}

/// Arguments of `compare`.
#[derive(Debug, ClapArgs)]
pub struct Compare {
    /// Points from a file: .csv, .ply, .xyz or .npy. Tables may be parted by commas, semicolons, tabs or blanks; columns
    /// are found by a head that names x, y and z, else the first three with numbers are taken
    #[arg(long, value_name = "FILE", value_parser = pointed, conflicts_with_all = ["scene", "distribution"])]
    pub points: Option<(PathBuf, PointsFormat)>,
    /// The particles of a scene: .json or .scn, run to the time --at
    #[arg(long, value_name = "SCENE", conflicts_with = "distribution")]
    pub scene: Option<PathBuf>,
    /// How the scene is read.
    #[command(flatten)]
    pub reading: Reading,
    /// When a scene's particles are taken, in seconds; by default at the end of its duration
    #[arg(long, value_name = "S", value_parser = seconds, requires = "scene")]
    pub at: Option<f64>,
    /// Made-up points, one or more; by default uniform
    #[arg(long, value_name = "NAME,...", value_enum, value_delimiter = ',')]
    pub distribution: Vec<Distribution>,
    /// How many points, such as 1e3,1e4; by default 1e3,1e4,1e5, or all that the file or the scene has, of which
    /// other numbers take a random subset
    #[arg(long, value_name = "N,...", value_delimiter = ',', value_parser = count)]
    pub n: Vec<usize>,
    /// The triangles of a mesh, which segments are held against: .off, .obj, .stl or .ply
    #[arg(long, value_name = "FILE", conflicts_with_all = ["points", "scene", "distribution", "surface", "triangles"])]
    pub mesh: Option<PathBuf>,
    /// Made-up meshes, one or more; by default both. What is asked of a mesh is --queries ray
    #[arg(long, value_name = "NAME,...", value_enum, value_delimiter = ',')]
    pub surface: Vec<Made>,
    /// About how many triangles made-up meshes have, such as 1e4,1e5; by default 6e4
    #[arg(long, value_name = "N,...", value_delimiter = ',', value_parser = triangles)]
    pub triangles: Vec<usize>,
    /// How many segments of every kind are held against a mesh; by default 20000
    #[arg(long, value_name = "N", value_parser = segments)]
    pub segments: Option<usize>,
    /// The radius of queries, in the points' unit; of a mesh that of the balls, by default a thousandth of its diagonal
    #[arg(long, value_name = "R", value_parser = radius, conflicts_with = "neighbours")]
    pub radius: Option<f32>,
    /// Choose the radius so that a point has so many others within it on average; by default 30
    #[arg(long, value_name = "M", value_parser = neighbours)]
    pub neighbours: Option<f64>,
    /// How many nearest others `nearest` looks for; by default 8
    #[arg(long, value_name = "K", value_parser = clap::value_parser!(u8).range(1..=64))]
    pub k: Option<u8>,
    /// What is asked; building is always measured. By default all that points are asked, count,within,nearest,pairs,moving,
    /// or with a mesh ray, which stands alone
    #[arg(long, value_name = "NAME,...", value_enum, value_delimiter = ',')]
    pub queries: Vec<Workload>,
    /// Which structures, such as grid,kd; or all. Of triangles there are brute, grid, octree, kd, bsp and bvh
    #[arg(long, value_name = "NAME,...", default_value = "all", value_parser = structures)]
    pub structures: Structures,
    /// Measure other libraries as well, where the program has them (cargo run --release -p pointmass-peers -- ...)
    #[arg(long)]
    pub peers: bool,
    /// How many times everything is measured; by default as often as three seconds allow, from 7 to 31 times, or 3
    /// times where a round takes very long
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=10_000))]
    pub repeat: Option<u32>,
    /// The seed of made-up points, subsets, segments and scenes; by default 1, or what the scene says
    #[arg(long, value_name = "N")]
    pub seed: Option<u64>,
    /// Write the comparison into FILE: .html, a page with charts; .svg, the charts; .csv or .json, all figures; may be
    /// given several times
    #[arg(long, value_name = "FILE", value_parser = studied)]
    pub out: Vec<(PathBuf, StudyFormat)>,
    /// Print spreads, minima and counters of every measurement as well
    #[arg(long)]
    pub detail: bool,
}

/// Arguments of `lab`.
#[derive(Debug, ClapArgs)]
pub struct Lab {
    /// A scene instead of the reference problems: .json or .scn
    #[arg(conflicts_with = "problems")]
    pub scene: Option<PathBuf>,
    /// How the scene is read.
    #[command(flatten)]
    pub reading: Reading,
    /// Which reference problems
    #[arg(
        long,
        value_name = "NAME,...",
        value_enum,
        value_delimiter = ',',
        default_value = "oscillator,pendulum,driven,kepler,stiff,rope"
    )]
    pub problems: Vec<Named>,
    /// Which methods, such as verlet,rk4; or all
    #[arg(long, value_name = "NAME,...", default_value = "all", value_parser = methods)]
    pub integrators: Methods,
    /// The steps in seconds, such as 1/60,1/120,1/240; by default powers of two that suit the problem, or the scene's step
    /// and its half, down to a sixteenth
    #[arg(long, value_name = "S,...", value_delimiter = ',', value_parser = step)]
    pub dt: Vec<f64>,
    /// When errors are taken, in seconds; by default what suits the problem, or what the scene says
    #[arg(long, value_name = "S", value_parser = span)]
    pub duration: Option<f64>,
    /// Write the findings into FILE: .html, a page with charts; .svg, the charts; .csv or .json, all figures; may be
    /// given several times
    #[arg(long, value_name = "FILE", value_parser = studied)]
    pub out: Vec<(PathBuf, StudyFormat)>,
    /// How to say on standard output what was found
    #[arg(long, value_enum, default_value_t = Report::Text)]
    pub report: Report,
    /// Print the errors of every step
    #[arg(long)]
    pub detail: bool,
}

impl Reading {
    /// What becomes of a command that `.scn` does not have.
    #[must_use]
    pub fn unknown(self) -> Unknown {
        if self.skip_unknown { Unknown::Skip } else { Unknown::Refuse }
    }
}

/// Integrators to try, each once.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Methods(pub Vec<Method>);

fn methods(text: &str) -> Result<Methods, String> {
    chosen(text, Method::ALL).map(Methods)
}

/// Structures to compare, each once.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Structures(pub Vec<Structure>);

fn structures(text: &str) -> Result<Structures, String> {
    chosen(text, Structure::ALL).map(Structures)
}

/// Those that a list names, each once, in the order in which they are listed everywhere.
fn chosen<T>(text: &str, all: &[T]) -> Result<Vec<T>, String>
where
    T: Copy + PartialEq + FromStr<Err: Display>,
{
    let mut chosen = Vec::new();
    for name in text.split(',').map(str::trim) {
        match name {
            "all" => chosen.extend_from_slice(all),
            _ => chosen.push(name.parse().map_err(|unknown| format!("{unknown}, or all"))?),
        }
    }
    Ok(all.iter().copied().filter(|one| chosen.contains(one)).collect())
}

fn count(text: &str) -> Result<usize, String> {
    whole(text, 2.0, 1e8).ok_or("expected a whole number of points, from 2 to 1e8".into())
}

fn triangles(text: &str) -> Result<usize, String> {
    whole(text, 12.0, 2e7).ok_or("expected a whole number of triangles, from 12 to 2e7".into())
}

fn segments(text: &str) -> Result<usize, String> {
    whole(text, 1.0, 1e7).ok_or("expected a whole number of segments, from 1 to 1e7".into())
}

/// A whole number, which may have an exponent.
fn whole(text: &str, least: f64, most: f64) -> Option<usize> {
    let value = number(text).ok()?;
    (value.fract() == 0.0 && (least..=most).contains(&value)).then_some(value as usize)
}

fn radius(text: &str) -> Result<f32, String> {
    let value = number(text)? as f32;
    if value > 0.0 && value.is_finite() { Ok(value) } else { Err("expected a positive, finite radius".into()) }
}

fn neighbours(text: &str) -> Result<f64, String> {
    let value = number(text)?;
    if (1e-3..=1e6).contains(&value) { Ok(value) } else { Err("expected a number from 0.001 to 1e6".into()) }
}

fn seconds(text: &str) -> Result<f64, String> {
    let longest = f64::from(1u32 << 31);
    let value = match text.split_once('/') {
        Some((over, under)) => number(over)? / number(under)?,
        None => number(text)?,
    };
    if (0.0..longest).contains(&value) { Ok(value) } else { Err("expected seconds, from 0 to 2147483647".into()) }
}

fn span(text: &str) -> Result<f64, String> {
    let value = seconds(text)?;
    if value > 0.0 { Ok(value) } else { Err("expected more than 0 s".into()) }
}

fn step(text: &str) -> Result<f64, String> {
    let value = seconds(text)?;
    if value >= 1e-9 { Ok(value) } else { Err("expected a step of at least 1e-9 s".into()) }
}

fn substeps(text: &str) -> Result<Substeps, String> {
    match text.trim() {
        "auto" => Ok(Substeps::Auto),
        text => match text.parse() {
            Ok(n) if (1..=1_000_000).contains(&n) => Ok(Substeps::Fixed(n)),
            _ => Err("expected a whole number from 1 to 1000000, or auto".into()),
        },
    }
}

fn tolerance(text: &str) -> Result<f64, String> {
    let value = number(text)?;
    // Integrators keep it as a 32-bit float.
    if (1e-30..=1e30).contains(&value) { Ok(value) } else { Err("expected metres, from 1e-30 to 1e30".into()) }
}

fn number(text: &str) -> Result<f64, String> {
    text.trim().parse().map_err(|_| format!("expected a number, found '{text}'"))
}

fn size(text: &str) -> Result<(u32, u32), String> {
    let sides = text.split_once(['x', 'X']).and_then(|(w, h)| Some((w.parse().ok()?, h.parse().ok()?)));
    match sides {
        Some((w, h)) if (1..=8192).contains(&w) && (1..=8192).contains(&h) => Ok((w, h)),
        _ => Err("expected WIDTHxHEIGHT, such as 640x480, each from 1 to 8192".into()),
    }
}

fn recorded(text: &str) -> Result<(PathBuf, RecordFormat), String> {
    ending(text, RecordFormat::of, ".csv, .jsonl, .ply or .xyz")
}

fn pointed(text: &str) -> Result<(PathBuf, PointsFormat), String> {
    ending(text, PointsFormat::of, ".csv, .ply, .xyz or .npy")
}

fn studied(text: &str) -> Result<(PathBuf, StudyFormat), String> {
    ending(text, StudyFormat::of, ".html, .svg, .csv or .json")
}

fn plotted(text: &str) -> Result<(PathBuf, PlotFormat), String> {
    ending(text, PlotFormat::of, ".svg or .html")
}

fn scene_format(text: &str) -> Result<(PathBuf, SceneFormat), String> {
    ending(text, SceneFormat::of, ".scn or .json")
}

fn ending<F>(text: &str, format: fn(&Path) -> Option<F>, known: &str) -> Result<(PathBuf, F), String> {
    let path = PathBuf::from(text);
    match format(&path) {
        Some(format) => Ok((path, format)),
        None => Err(format!("expected a name that ends in {known}")),
    }
}

fn drawn(text: &str) -> Result<PathBuf, String> {
    let path = PathBuf::from(text);
    match extension(&path).as_str() {
        "gif" | "png" => Ok(path),
        _ => Err("expected a name that ends in .gif or .png".into()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_command_line_is_sound() {
        use clap::CommandFactory;
        Args::command().debug_assert();
    }

    #[test]
    fn sizes_may_have_exponents() {
        assert_eq!([count("1e3"), count("25"), count(" 5e6 ")], [Ok(1000), Ok(25), Ok(5_000_000)]);
        for bad in ["0", "1", "-5", "1.5", "1e9", "nan", "x", ""] {
            assert!(count(bad).is_err(), "{bad}");
        }
    }

    #[test]
    fn structures_come_once_and_in_order() {
        assert_eq!(structures("all"), Ok(Structures(Structure::ALL.to_vec())));
        assert_eq!(structures("grid, brute,grid"), Ok(Structures(vec![Structure::Brute, Structure::Grid])));
        assert!(structures("grid,nonsense").is_err_and(|error| error.contains("brute") && error.contains("all")));
    }

    #[test]
    fn steps_may_be_fractions() {
        assert_eq!(step("1/60"), Ok(1.0 / 60.0));
        assert_eq!(step("0.001"), Ok(0.001));
        for bad in ["0", "-1", "nan", "inf", "1/0", "x", "1e-10", ""] {
            assert!(step(bad).is_err(), "{bad}");
        }
    }
}
