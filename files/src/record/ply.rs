//! PLY, binary: particles as vertices, cloths and rigid bodies as faces, other springs, ropes, rods and strands as edges.

use super::frame::{Column, Value, Values};
use super::{Frame, Out, Writer};
use ply_rs_bw::ply::{Addable, DefaultElement, ElementDef, Encoding, Header, PropertyDef, PropertyType, ScalarType};
use std::io::{self, Write};

/// One record.
pub(super) struct Ply(pub(super) Out);

/// The columns that come first, in this order; then colours.
const FIRST: [&str; 9] = ["x", "y", "z", "vx", "vy", "vz", "mass", "age", "id"];
/// The channels of colours.
const CHANNELS: [&str; 4] = ["red", "green", "blue", "alpha"];

impl Writer for Ply {
    fn record(&mut self, frame: &Frame) -> io::Result<()> {
        let frame = &*frame.with_surfaces();
        let first: Vec<&Column> =
            FIRST.iter().filter_map(|name| frame.columns.iter().find(|column| column.name == *name)).collect();
        let rest: Vec<&Column> = frame.others(&[FIRST.as_slice(), &CHANNELS].concat()).collect();
        ply_rs_bw::writer::Writer::<DefaultElement>::new().write_header(&mut self.0, &header(frame, &first, &rest))?;
        for row in 0..frame.len {
            first.iter().try_for_each(|column| column.values.at(row).write(&mut self.0))?;
            self.0.write_all(&frame.colors[row])?;
            rest.iter().try_for_each(|column| column.values.at(row).write(&mut self.0))?;
        }
        for corners in &frame.faces {
            self.0.write_all(&[3])?;
            corners.iter().try_for_each(|&corner| Value::Unsigned(corner).write(&mut self.0))?;
        }
        frame.edges.as_flattened().iter().try_for_each(|&end| Value::Unsigned(end).write(&mut self.0))
    }

    fn close(mut self: Box<Self>) -> io::Result<()> {
        self.0.flush()
    }
}

/// The header of a record, whose columns come first and behind the colours.
fn header(frame: &Frame, first: &[&Column], rest: &[&Column]) -> Header {
    let column = |column: &&Column| scalar(&column.name, kind(&column.values));
    let color = CHANNELS.iter().map(|name| scalar(name, ScalarType::UChar));
    let vertex = first.iter().map(column).chain(color).chain(rest.iter().map(column));
    let mut header = Header { encoding: Encoding::BinaryLittleEndian, ..Header::new() };
    header.comments.push(format!("time {} step {}", frame.time, frame.step));
    header.comments.extend(frame.remark());
    header.elements.add(element("vertex", frame.len, vertex));
    if !frame.faces.is_empty() {
        let corners = PropertyType::List(ScalarType::UChar, ScalarType::Int);
        let corners = PropertyDef::new("vertex_indices".into(), corners);
        header.elements.add(element("face", frame.faces.len(), [corners]));
    }
    if !frame.edges.is_empty() {
        let ends = ["vertex1", "vertex2"].map(|name| scalar(name, ScalarType::Int));
        header.elements.add(element("edge", frame.edges.len(), ends));
    }
    header
}

/// A list of so many things with these properties.
fn element(name: &str, count: usize, properties: impl IntoIterator<Item = PropertyDef>) -> ElementDef {
    let mut element = ElementDef::new(name.into());
    element.count = count;
    properties.into_iter().for_each(|property| element.properties.add(property));
    element
}

/// A property that is one number.
fn scalar(name: &str, kind: ScalarType) -> PropertyDef {
    PropertyDef::new(name.into(), PropertyType::Scalar(kind))
}

/// The kind of a column's numbers.
fn kind(values: &Values) -> ScalarType {
    match values {
        Values::Single(_) => ScalarType::Float,
        Values::Double(_) => ScalarType::Double,
        Values::Unsigned(_) => ScalarType::UInt,
        Values::Signed(_) => ScalarType::Int,
        Values::Byte(_) => ScalarType::UChar,
    }
}
