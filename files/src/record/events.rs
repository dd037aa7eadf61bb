//! The events in the lives of particles, one line an event: births, hits, touches, deaths.

use crate::formats::EventsFormat;
use crate::instant::nanoseconds;
use crate::outcome::{Failure, Outcome};
use crate::whole::{WholeFile, Written};
use pointmass::{Attention, Cause, Impact, LifeEvent, Observer, Time, Vec3};
use serde::Serialize;
use std::io::{self, Write};
use std::path::Path;

/// A file of events in the making. Dropped, it is gone.
pub struct Chronicle {
    lines: Lines,
    path: std::path::PathBuf,
    /// The events of a step, in the order in which they were found.
    pub notes: Notes,
}

/// The lines of a table, or of objects.
enum Lines {
    Csv(Box<csv::Writer<WholeFile>>),
    Jsonl(WholeFile),
}

/// The events of a step; watches it.
#[derive(Debug, Default)]
pub struct Notes(Vec<Line>);

/// An event.
#[derive(Clone, Copy, Debug, Default, Serialize)]
struct Line {
    /// The step in which it happened.
    step: u64,
    /// The instant \[s\]; of a death the end of its step.
    time: f64,
    event: &'static str,
    /// The particle; of births that found no room, none.
    id: Option<u32>,
    /// The particle it met, if it was one.
    other: Option<u32>,
    /// Where its middle was \[m\].
    x: f32,
    y: f32,
    z: f32,
    /// Its velocity \[m/s\]; after a hit.
    vx: f32,
    vy: f32,
    vz: f32,
    /// The normal of what it met, toward it.
    nx: f32,
    ny: f32,
    nz: f32,
    /// The speed at which the two came together along it \[m/s\].
    speed: Option<f32>,
    /// Why it died.
    cause: Option<Cause>,
    /// How many births found no room.
    count: Option<u64>,
}

/// The head of the table.
const HEAD: [&str; 17] = [
    "step", "time", "event", "id", "other", "x", "y", "z", "vx", "vy", "vz", "nx", "ny", "nz", "speed", "cause",
    "count",
];

impl Chronicle {
    /// Begins a file.
    pub fn create(path: &Path, format: EventsFormat) -> Outcome<Self> {
        let file = WholeFile::create(path)?;
        let mut lines = match format {
            EventsFormat::Csv => Lines::Csv(Box::new(csv::WriterBuilder::new().has_headers(false).from_writer(file))),
            EventsFormat::Jsonl => Lines::Jsonl(file),
        };
        if let Lines::Csv(table) = &mut lines {
            table.write_record(HEAD)?;
        }
        Ok(Self { lines, path: path.to_path_buf(), notes: Notes::default() })
    }

    /// Writes what happened in a step, in the order of instants.
    pub fn write(&mut self, step: u64) -> Outcome {
        let Notes(notes) = &mut self.notes;
        notes.sort_by(|a, b| a.time.total_cmp(&b.time));
        for line in notes.drain(..).map(|line| Line { step, ..line }) {
            self.lines.write(&line).map_err(|error| Failure::io(&self.path, &error))?;
        }
        Ok(())
    }

    /// Nothing more is going to be written.
    pub fn close(self) -> Outcome<Written> {
        match self.lines {
            Lines::Csv(table) => table.into_inner().map_err(|error| Failure::io(&self.path, error.error()))?.close(),
            Lines::Jsonl(file) => file.close(),
        }
    }
}

impl Lines {
    /// Writes an event.
    fn write(&mut self, line: &Line) -> io::Result<()> {
        match self {
            Self::Csv(table) => Ok(table.serialize(line)?),
            Self::Jsonl(file) => {
                serde_json::to_writer(&mut *file, line)?;
                file.write_all(b"\n")
            }
        }
    }
}

impl Line {
    /// An event of a kind at an instant, at a place \[m\] and with a velocity \[m/s\].
    fn new(event: &'static str, time: Time, place: Vec3, velocity: Vec3) -> Self {
        let ([x, y, z], [vx, vy, vz]) = (place.to_array(), velocity.to_array());
        Self { time: nanoseconds(time.seconds_f64()), event, x, y, z, vx, vy, vz, ..Self::default() }
    }

    /// The meeting of a particle with a collider or another particle.
    fn met(event: &'static str, impact: &Impact) -> Self {
        let [nx, ny, nz] = impact.normal.to_array();
        let (id, other) = (Some(impact.id.serial()), impact.other.map(pointmass::Id::serial));
        let at = Self::new(event, impact.time, impact.place, impact.after);
        Self { id, other, nx, ny, nz, speed: Some(impact.closing), ..at }
    }

    /// A birth or a death.
    fn life(event: &'static str, life: &LifeEvent) -> Self {
        Self { id: Some(life.id.serial()), ..Self::new(event, life.time, life.place, life.velocity) }
    }
}

impl Observer for Notes {
    fn attention(&self) -> Attention {
        Attention::Events
    }

    fn hit(&mut self, hit: &Impact) {
        self.0.push(Line::met("hit", hit));
    }

    fn touched(&mut self, touch: &Impact) {
        self.0.push(Line::met("touch", touch));
    }

    fn born(&mut self, birth: &LifeEvent) {
        self.0.push(Line::life("birth", birth));
    }

    fn died(&mut self, death: &LifeEvent, cause: Cause) {
        self.0.push(Line { cause: Some(cause), ..Line::life("death", death) });
    }

    fn refused(&mut self, count: u64, time: Time) {
        self.0.push(Line { count: Some(count), ..Line::new("refused", time, Vec3::ZERO, Vec3::ZERO) });
    }
}
