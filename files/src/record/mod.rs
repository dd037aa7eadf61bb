//! State to files: one file a format. What is written shows only when it is complete.

mod events;
mod files;
mod frame;
mod gltf;
mod numpy;
mod obj;
mod plan;
mod ply;
mod solids;
mod table;
mod vtk;
mod xyz;

pub use events::{Chronicle, Notes};
pub use frame::Frame;
pub use plan::Plan;

use crate::formats::RecordFormat;
use crate::outcome::{Failure, Outcome};
use crate::pattern::Pattern;
use crate::whole::{Written, is_standard};
use files::{Apart, Together};
use std::fs::File;
use std::io::{self, BufWriter};
use std::path::{Path, PathBuf};

/// A recording in the making. Dropped, it is gone.
pub struct Recorder {
    path: PathBuf,
    sink: Box<dyn Sink>,
}

/// Where records go: one file or many.
trait Sink: Send {
    /// Takes a record.
    fn record(&mut self, frame: &Frame) -> io::Result<()>;

    /// The files that were recorded, to be put where they belong.
    fn close(self: Box<Self>) -> Outcome<Vec<Written>>;
}

/// A writer of one file in one format.
trait Writer: Send {
    /// Writes a record.
    fn record(&mut self, frame: &Frame) -> io::Result<()>;

    /// Writes what comes last.
    fn close(self: Box<Self>) -> io::Result<()>;
}

/// The file that a writer owns.
type Out = BufWriter<File>;

impl Recorder {
    /// Begins a recording: in one file if the format can hold many records and the name has no place for a number.
    pub fn create(path: &Path, format: RecordFormat) -> Outcome<Self> {
        let pattern = Pattern::parse(path).map_err(|error| Failure::new(format!("{}: {error}", path.display())))?;
        let sink: Box<dyn Sink> = match pattern {
            None if format.holds_many() => Box::new(Together::create(path, format)?),
            None if is_standard(path) => return Err(one_stream(format)),
            pattern => Box::new(Apart::create(path, pattern, format)?),
        };
        Ok(Self { path: path.to_path_buf(), sink })
    }

    /// The first of the files that it would make.
    #[must_use]
    pub fn first(path: &Path, format: RecordFormat) -> PathBuf {
        let pattern = Pattern::parse(path).ok().flatten();
        if is_standard(path) || pattern.is_none() && format.holds_many() {
            return path.to_path_buf();
        }
        path.with_file_name(pattern.unwrap_or_else(|| Pattern::numbered(path)).name(0))
    }

    /// Takes a record.
    pub fn record(&mut self, frame: &Frame) -> Outcome {
        self.sink.record(frame).map_err(|error| Failure::io(&self.path, &error))
    }

    /// The files that were recorded, to be put where they belong.
    pub fn close(self) -> Outcome<Vec<Written>> {
        self.sink.close()
    }
}

/// The failure to write many files to standard output.
fn one_stream(format: RecordFormat) -> Failure {
    let many: Vec<_> =
        RecordFormat::ALL.into_iter().filter(|other| other.holds_many()).map(RecordFormat::name).collect();
    let (name, many) = (format.name(), many.join(", "));
    Failure::new(format!("standard output: {name} is one file a record; choose --format {many}, or name a file"))
}

/// A writer of a format to a file that is going to be complete when the writer is closed.
fn writer(format: RecordFormat, out: Out) -> Box<dyn Writer> {
    match format {
        RecordFormat::Csv => Box::new(table::Csv::new(out)),
        RecordFormat::Jsonl => Box::new(table::Jsonl { out, whole: false }),
        RecordFormat::Frames => Box::new(table::Jsonl { out, whole: true }),
        RecordFormat::Xyz => Box::new(xyz::Xyz(out)),
        RecordFormat::Npz | RecordFormat::Npy => Box::new(numpy::Npz::new(out)),
        RecordFormat::Ply => Box::new(ply::Ply(out)),
        RecordFormat::Obj => Box::new(obj::Obj(out)),
        RecordFormat::Vtp => Box::new(vtk::Vtp(out)),
        RecordFormat::Glb => Box::new(gltf::Gltf::new(out, true)),
        RecordFormat::Gltf => Box::new(gltf::Gltf::new(out, false)),
    }
}
