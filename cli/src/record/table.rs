//! Tables: CSV and lines of JSON, with the same columns.

use super::{Frame, Writer};
use crate::whole::{WholeFile, Written};
use crate::{Failure, Outcome};
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
            self.writer.write_record(head.into_iter().chain(frame.balls.then_some("radius")))?;
        }
        frame.rows.iter().try_for_each(|row| self.writer.serialize(row)).map_err(io::Error::from)
    }

    fn close(self: Box<Self>) -> Outcome<Vec<Written>> {
        let file = self.writer.into_inner();
        let file = file.map_err(|error| Failure::new(format!("the table cannot be written: {}", error.error())))?;
        Ok(vec![file.close()?])
    }
}

pub(super) struct Jsonl {
    file: WholeFile,
}

impl Jsonl {
    pub(super) fn new(file: WholeFile) -> Self {
        Self { file }
    }
}

impl Writer for Jsonl {
    fn record(&mut self, frame: &Frame) -> io::Result<()> {
        for row in &frame.rows {
            serde_json::to_writer(&mut self.file, row)?;
            self.file.write_all(b"\n")?;
        }
        Ok(())
    }

    fn close(self: Box<Self>) -> Outcome<Vec<Written>> {
        Ok(vec![self.file.close()?])
    }
}
