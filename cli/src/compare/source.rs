//! Sources of points: made up, a file, or a scene that was run.

use super::args::Compare;
use super::distribution::Distribution;
use super::sample::sample;
use crate::outcome::{Failure, Outcome};
use crate::parse::sorted;
use crate::progress::Progress;
use crate::report::words::thousands;
use crate::schedule::Schedule;
use crate::world::{Settings, World};
use pointmass::Vec3;
use pointmass_files::instant::nanoseconds;
use pointmass_files::outcome::excerpt;
use pointmass_files::points;

/// The numbers of points that are made up if nobody says.
const SIZES: [usize; 3] = [1000, 10_000, 100_000];

/// Points that are to be compared on, in one or more sizes.
pub(crate) enum Source {
    Made(Distribution, u64),
    Given { name: String, about: String, points: Vec<Vec3>, seed: u64 },
}

/// All that the arguments name, and the numbers of points, ascending.
pub(crate) fn sources(args: &Compare) -> Outcome<(Vec<Source>, Vec<usize>)> {
    let seed = args.seed();
    let given = match (&args.points, &args.scene) {
        (Some((path, format)), _) => from_file(path, *format, seed)?,
        (None, Some(scene)) => from_scene(scene, args, seed)?,
        (None, None) => {
            let made = args.distribution.iter().enumerate();
            let mut made: Vec<_> =
                made.filter(|(i, one)| !args.distribution[..*i].contains(one)).map(|(_, one)| *one).collect();
            if made.is_empty() {
                made.push(Distribution::Uniform);
            }
            return Ok((made.into_iter().map(|one| Source::Made(one, seed)).collect(), sorted(&args.n, &SIZES)));
        }
    };
    let len = given.len();
    if let Some(n) = args.n.iter().find(|n| **n > len) {
        let name = given.name();
        return Err(Failure::new(format!("{name}: has {len} points, --n asks for {n}: lower --n")));
    }
    Ok((vec![given], sorted(&args.n, &[len])))
}

fn from_file(path: &std::path::Path, format: crate::formats::PointsFormat, seed: u64) -> Outcome<Source> {
    let cloud = points::load(path, format)?;
    let mut about = format!("{} points of {}", thousands(cloud.points.len()), excerpt(&path.to_string_lossy()));
    if !cloud.columns.is_empty() {
        let columns: Vec<_> = cloud.columns.iter().map(usize::to_string).collect();
        let axes = if columns.len() == 2 { "x and y" } else { "x, y and z" };
        about.push_str(&format!("; no head names {axes}, columns {} were taken", columns.join(", ")));
    }
    if cloud.origin != [0.0; 3] {
        let [x, y, z] = cloud.origin;
        about.push_str(&format!("; ({x}, {y}, {z}) was subtracted before rounding to single precision"));
    }
    if cloud.skipped > 0 {
        let rows = if cloud.skipped == 1 { "row" } else { "rows" };
        about.push_str(&format!("; {} {rows} skipped, not finite", thousands(cloud.skipped)));
    }
    if cloud.earlier > 0 {
        about.push_str(&format!("; the last of {} records", cloud.earlier + 1));
    }
    let name = excerpt(&path.file_name().unwrap_or_default().to_string_lossy());
    Ok(Source::Given { name, about, points: cloud.points, seed })
}

fn from_scene(scene: &std::path::Path, args: &Compare, seed: u64) -> Outcome<Source> {
    let settings = Settings { duration: args.at, seed: args.seed, ..Settings::of(scene, args.reading) };
    let mut world = World::load(&settings)?;
    let schedule = Schedule::new(world.duration, world.dt);
    let mut progress = Progress::new(schedule.steps());
    world.on_threads(|world| {
        for step in 1..=schedule.steps() {
            world.step_to(schedule.end(step));
            progress.step(world.system.len());
        }
    });
    let points = world.system.particles().position.to_vec();
    let (len, at, path) = (points.len(), nanoseconds(world.system.time().seconds_f64()), scene.display());
    if len < 2 {
        return Err(Failure::new(format!(
            "{path}: {len} particles live at {at} s: expected two or more; try another --at"
        )));
    }
    let name = format!("{} at {at} s", scene.file_name().unwrap_or_default().to_string_lossy());
    Ok(Source::Given { name, about: format!("the {} particles of {path} at {at} s", thousands(len)), points, seed })
}

impl Source {
    pub(crate) fn name(&self) -> &str {
        match self {
            Self::Made(distribution, _) => distribution.name(),
            Self::Given { name, .. } => name,
        }
    }

    /// The number of points.
    fn len(&self) -> usize {
        match self {
            Self::Made(..) => usize::MAX,
            Self::Given { points, .. } => points.len(),
        }
    }

    /// So many of its points in words.
    pub(crate) fn about(&self, n: usize) -> String {
        match self {
            Self::Made(distribution, seed) => format!("{}; seed {seed}", distribution.describe()),
            Self::Given { about, points, seed, .. } if n < points.len() => {
                format!("{about}; {} of them at random, seed {seed}", thousands(n))
            }
            Self::Given { about, .. } => about.clone(),
        }
    }

    /// So many points: made up, or a random subset in the order of the whole.
    pub(crate) fn points(&self, n: usize) -> Vec<Vec3> {
        match self {
            Self::Made(distribution, seed) => distribution.points(n, *seed),
            Self::Given { points, seed, .. } => {
                sample(points.len(), n, *seed).into_iter().map(|row| points[row]).collect()
            }
        }
    }
}
