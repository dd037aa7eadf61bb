//! Tables: CSV and lines of JSON, with the same columns.

use super::{Frame, Out, Writer};
use serde::ser::{SerializeMap, SerializeSeq};
use serde::{Serialize, Serializer};
use std::io::{self, Write};

/// A table with a head line, one row a particle and record.
pub(super) struct Csv {
    writer: csv::Writer<Out>,
    begun: bool,
}

impl Csv {
    /// A table without its head.
    pub(super) fn new(out: Out) -> Self {
        // The head is written by hand, so that a recording of nothing has one.
        Self { writer: csv::WriterBuilder::new().has_headers(false).from_writer(out), begun: false }
    }
}

impl Writer for Csv {
    fn record(&mut self, frame: &Frame) -> io::Result<()> {
        if !self.begun {
            let names = frame.columns.iter().map(|column| column.name.as_str());
            self.writer.write_record(["step", "time"].into_iter().chain(names))?;
            self.begun = true;
        }
        let mut rows = 0..frame.len;
        rows.try_for_each(|row| self.writer.serialize(Cells(Row { frame, row }))).map_err(io::Error::from)
    }

    fn close(mut self: Box<Self>) -> io::Result<()> {
        self.writer.flush()
    }
}

/// A particle of a frame as an object: the names of columns with its values.
struct Row<'a> {
    frame: &'a Frame,
    row: usize,
}

/// The same as a list of values.
struct Cells<'a>(Row<'a>);

impl Serialize for Row<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let Self { frame, row } = *self;
        let mut map = serializer.serialize_map(None)?;
        map.serialize_entry("step", &frame.step)?;
        map.serialize_entry("time", &frame.time)?;
        frame.columns.iter().try_for_each(|column| map.serialize_entry(&column.name, &column.values.at(row)))?;
        map.end()
    }
}

impl Serialize for Cells<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let Row { frame, row } = self.0;
        let mut cells = serializer.serialize_seq(None)?;
        cells.serialize_element(&frame.step)?;
        cells.serialize_element(&frame.time)?;
        frame.columns.iter().try_for_each(|column| cells.serialize_element(&column.values.at(row)))?;
        cells.end()
    }
}

/// A frame as an object: the names of columns with lists of their values, and triangles and edges where the scene has any.
struct Whole<'a>(&'a Frame);

impl Serialize for Whole<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let Frame { step, time, columns, faces, edges, kinds, .. } = self.0;
        let mut map = serializer.serialize_map(None)?;
        map.serialize_entry("step", step)?;
        map.serialize_entry("time", time)?;
        columns.iter().try_for_each(|column| map.serialize_entry(&column.name, &column.values))?;
        if kinds.faces {
            map.serialize_entry("faces", faces)?;
        }
        if kinds.edges {
            map.serialize_entry("edges", edges)?;
        }
        map.end()
    }
}

/// Lines of JSON: one a particle and record, or one a record.
pub(super) struct Jsonl {
    pub(super) out: Out,
    /// True if a line is a whole record.
    pub(super) whole: bool,
}

impl Writer for Jsonl {
    fn record(&mut self, frame: &Frame) -> io::Result<()> {
        if self.whole {
            serde_json::to_writer(&mut self.out, &Whole(frame))?;
            return self.out.write_all(b"\n");
        }
        for row in 0..frame.len {
            serde_json::to_writer(&mut self.out, &Row { frame, row })?;
            self.out.write_all(b"\n")?;
        }
        Ok(())
    }

    fn close(mut self: Box<Self>) -> io::Result<()> {
        self.out.flush()
    }
}
