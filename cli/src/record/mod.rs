//! State to files: one file a format. What is written shows only when it is complete.

mod ply;
mod table;
mod xyz;

use crate::args::extension;
use crate::report::nanoseconds;
use crate::whole::WholeFile;
use crate::{Failure, Outcome};
use pointmass::{Columns, Heap, System};
use serde::Serialize;
use std::path::{Path, PathBuf};

/// A format of recordings.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// A table with a head line.
    Csv,
    /// The same, each line a JSON object.
    Jsonl,
    /// Point clouds, one file a record.
    Ply,
    /// Atoms, all records in one file.
    Xyz,
}

impl Format {
    /// By the end of the file's name.
    pub(crate) fn of(path: &Path) -> Option<Self> {
        match extension(path).as_str() {
            "csv" => Some(Self::Csv),
            "jsonl" => Some(Self::Jsonl),
            "ply" => Some(Self::Ply),
            "xyz" => Some(Self::Xyz),
            _ => None,
        }
    }
}

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
}

/// The state after a step, by id.
pub(crate) struct Frame {
    step: u64,
    time: f64,
    rows: Vec<Row>,
    colors: Vec<[u8; 4]>,
}

impl Frame {
    pub(crate) fn of(step: u64, system: &System<Heap>) -> Self {
        let now = system.time();
        let time = nanoseconds(now.seconds_f64());
        let Columns { serial, position, velocity, mass, born, color, .. } = system.particles();
        let mut order: Vec<usize> = (0..serial.len()).collect();
        order.sort_unstable_by_key(|&row| serial[row]);
        let row = |&i: &usize| {
            let ([x, y, z], [vx, vy, vz]) = (position[i].to_array(), velocity[i].to_array());
            let age = nanoseconds((now - born[i]).seconds_f64());
            Row { step, time, id: serial[i], x, y, z, vx, vy, vz, mass: mass[i], age }
        };
        Self { step, time, rows: order.iter().map(row).collect(), colors: order.iter().map(|&i| color[i]).collect() }
    }
}

/// A recording in the making.
pub(crate) struct Recorder {
    path: PathBuf,
    writer: Writer,
}

enum Writer {
    Csv(table::Csv),
    Jsonl(table::Jsonl),
    Ply(ply::Ply),
    Xyz(xyz::Xyz),
}

impl Recorder {
    pub(crate) fn create(path: &Path, format: Format) -> Outcome<Self> {
        let writer = match format {
            Format::Csv => Writer::Csv(table::Csv::new(WholeFile::create(path)?)),
            Format::Jsonl => Writer::Jsonl(table::Jsonl::new(WholeFile::create(path)?)),
            Format::Ply => Writer::Ply(ply::Ply::new(path)?),
            Format::Xyz => Writer::Xyz(xyz::Xyz::new(WholeFile::create(path)?)),
        };
        Ok(Self { path: path.to_path_buf(), writer })
    }

    pub(crate) fn record(&mut self, frame: &Frame) -> Outcome {
        let outcome = match &mut self.writer {
            Writer::Csv(writer) => writer.record(frame),
            Writer::Jsonl(writer) => writer.record(frame),
            Writer::Ply(writer) => writer.record(frame),
            Writer::Xyz(writer) => writer.record(frame),
        };
        outcome.map_err(|error| Failure::io(&self.path, &error))
    }

    /// Puts what was recorded where it belongs.
    pub(crate) fn finish(self) -> Outcome {
        match self.writer {
            Writer::Csv(writer) => writer.finish(),
            Writer::Jsonl(writer) => writer.finish(),
            Writer::Xyz(writer) => writer.finish(),
            Writer::Ply(writer) => writer.finish(),
        }
    }
}
