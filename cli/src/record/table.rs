//! Tables: CSV and lines of JSON, with the same columns.

use super::{Frame, Row, Writer};
use crate::outcome::{Failure, Outcome};
use crate::whole::{WholeFile, Written};
use serde::{Serialize, Serializer};
use std::io::{self, Write};

pub(super) struct Csv {
    writer: csv::Writer<WholeFile>,
}

impl Csv {
    pub(super) fn new(file: WholeFile) -> Self {
        // The head is written by hand, so that a recording of nothing has one.
        Self { writer: csv::WriterBuilder::new().has_headers(false).from_writer(file) }
    }
}

impl Writer for Csv {
    fn record(&mut self, frame: &Frame) -> io::Result<()> {
        if frame.step == 0 {
            let head = ["step", "time", "id", "x", "y", "z", "vx", "vy", "vz", "mass", "age"];
            let head = head.into_iter().chain(frame.balls.then_some("radius"));
            self.writer.write_record(head.chain(frame.names.iter().map(String::as_str)))?;
        }
        let mut rows = frame.rows.iter().zip(&frame.custom);
        rows.try_for_each(|row| self.writer.serialize(row)).map_err(io::Error::from)
    }

    fn close(self: Box<Self>) -> Outcome<Vec<Written>> {
        let file = self.writer.into_inner();
        let file = file.map_err(|error| Failure::new(format!("the table cannot be written: {}", error.error())))?;
        Ok(vec![file.close()?])
    }
}

/// A particle with what columns of a user's own are called.
#[derive(Serialize)]
struct Line<'a> {
    #[serde(flatten)]
    row: &'a Row,
    #[serde(flatten, serialize_with = "as_map")]
    custom: Vec<(&'a String, &'a f32)>,
}

fn as_map<S: Serializer>(pairs: &[(&String, &f32)], serializer: S) -> Result<S::Ok, S::Error> {
    serializer.collect_map(pairs.iter().copied())
}

pub(super) struct Jsonl(pub(super) WholeFile);

impl Writer for Jsonl {
    fn record(&mut self, frame: &Frame) -> io::Result<()> {
        for (row, custom) in frame.rows.iter().zip(&frame.custom) {
            let custom = frame.names.iter().zip(custom).collect();
            serde_json::to_writer(&mut self.0, &Line { row, custom })?;
            self.0.write_all(b"\n")?;
        }
        Ok(())
    }

    fn close(self: Box<Self>) -> Outcome<Vec<Written>> {
        Ok(vec![self.0.close()?])
    }
}
