//! State to files: one file a format. What is written shows only when it is complete.

mod ply;
mod table;
mod xyz;

use crate::formats::RecordFormat;
use crate::outcome::{Failure, Outcome};
use crate::schedule::nanoseconds;
use crate::whole::{WholeFile, Written, publish};
use pointmass::draw::appearance;
use pointmass::{Color, Columns, Heap, Scene, System};
use serde::Serialize;
use std::path::{Path, PathBuf};

/// A particle in a recording.
#[derive(Clone, Copy, Debug, Serialize)]
pub(crate) struct Row {
    step: u64,
    time: f64,
    id: u32,
    x: f32,
    y: f32,
    z: f32,
    vx: f32,
    vy: f32,
    vz: f32,
    mass: f32,
    age: f64,
    /// In recordings of balls only.
    #[serde(skip_serializing_if = "Option::is_none")]
    radius: Option<f32>,
}

/// The state after a step, by id.
pub(crate) struct Frame {
    step: u64,
    time: f64,
    rows: Vec<Row>,
    /// True if rows have radii.
    balls: bool,
    /// Names of columns of a user's own, and the values of each row in them.
    names: Vec<String>,
    custom: Vec<Vec<f32>>,
    /// Their colours at that instant.
    colors: Vec<Color>,
}

impl Frame {
    /// That of a system; of balls with their radii.
    pub(crate) fn of(step: u64, system: &System<Heap>, scene: &Scene<'_>, balls: bool) -> Self {
        let now = system.time();
        let time = nanoseconds(now.seconds_f64());
        let Columns { serial, position, velocity, mass, radius, born, .. } = system.particles();
        let mut order: Vec<usize> = (0..serial.len()).collect();
        order.sort_unstable_by_key(|&row| serial[row]);
        let row = |&i: &usize| {
            let ([x, y, z], [vx, vy, vz]) = (position[i].to_array(), velocity[i].to_array());
            let age = nanoseconds((now - born[i]).seconds_f64());
            let radius = balls.then(|| radius[i]);
            Row { step, time, id: serial[i], x, y, z, vx, vy, vz, mass: mass[i], age, radius }
        };
        let state = system.state(scene);
        let colors = order.iter().filter_map(|&i| appearance(&state, i)).map(|look| look.color).collect();
        let own = system.custom(scene);
        let numbers = 0..own.count();
        let names = numbers.clone().filter_map(|number| own.name(number)).map(str::to_string).collect();
        let custom = order.iter().map(|&i| numbers.clone().map(|number| own.column(number)[i]).collect()).collect();
        Self { step, time, rows: order.iter().map(row).collect(), balls, names, custom, colors }
    }
}

/// A recording in the making. Dropped, it is gone.
pub(crate) struct Recorder {
    path: PathBuf,
    writer: Box<dyn Writer>,
}

/// A writer of one format.
trait Writer {
    fn record(&mut self, frame: &Frame) -> std::io::Result<()>;

    /// The files that were recorded, to be put where they belong.
    fn close(self: Box<Self>) -> Outcome<Vec<Written>>;
}

impl Recorder {
    pub(crate) fn create(path: &Path, format: RecordFormat) -> Outcome<Self> {
        let writer: Box<dyn Writer> = match format {
            RecordFormat::Csv => Box::new(table::Csv::new(WholeFile::create(path)?)),
            RecordFormat::Jsonl => Box::new(table::Jsonl(WholeFile::create(path)?)),
            RecordFormat::Ply => Box::new(ply::Ply::new(path)?),
            RecordFormat::Xyz => Box::new(xyz::Xyz(WholeFile::create(path)?)),
        };
        Ok(Self { path: path.to_path_buf(), writer })
    }

    pub(crate) fn record(&mut self, frame: &Frame) -> Outcome {
        self.writer.record(frame).map_err(|error| Failure::io(&self.path, &error))
    }

    /// Puts all that was recorded where it belongs, or none of it.
    pub(crate) fn finish(recorders: Vec<Self>) -> Outcome {
        let written = recorders.into_iter().map(|recorder| recorder.writer.close()).collect::<Outcome<Vec<_>>>()?;
        publish(&written.into_iter().flatten().collect::<Vec<_>>())
    }
}
