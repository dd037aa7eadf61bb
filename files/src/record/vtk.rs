//! VTK's XML for ParaView: particles as points, cloths and rigid bodies as polygons, other springs, ropes, rods and strands as lines, and an index of records.
//!
//! Numbers are in base 64, each array behind its length in bytes, as the format has it.

use super::frame::{Column, Values};
use super::{Frame, Out, Writer};
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use quick_xml::Writer as Xml;
use quick_xml::events::{BytesDecl, BytesText, Event};
use std::io::{self, Write};

/// One record.
pub(super) struct Vtp(pub(super) Out);

/// The columns that are parts of vectors.
const PARTS: [&str; 10] = ["x", "y", "z", "vx", "vy", "vz", "red", "green", "blue", "alpha"];

/// An array with the name of its numbers' type and how many belong together.
struct Array<'a> {
    name: &'a str,
    kind: &'static str,
    components: usize,
    bytes: Vec<u8>,
}

impl Writer for Vtp {
    fn record(&mut self, frame: &Frame) -> io::Result<()> {
        let frame = &*frame.with_surfaces();
        let mut xml = Xml::new_with_indent(&mut self.0, b' ', 1);
        file(&mut xml, "PolyData", |xml| {
            xml.create_element("PolyData").write_inner_content(|xml| {
                xml.create_element("FieldData").write_inner_content(|xml| {
                    let time = frame.time.to_le_bytes().to_vec();
                    tuples(xml, &Array { name: "TimeValue", kind: "Float64", components: 1, bytes: time }, Some(1))?;
                    // Points behind these are corners of bodies.
                    let bytes = (frame.particles() as i64).to_le_bytes().to_vec();
                    tuples(xml, &Array { name: "particles", kind: "Int64", components: 1, bytes }, Some(1))
                })?;
                piece(xml, frame)
            })?;
            Ok(())
        })
    }

    fn close(mut self: Box<Self>) -> io::Result<()> {
        self.0.flush()
    }
}

/// Writes the points, their columns, and what joins them.
fn piece<W: Write>(xml: &mut Xml<W>, frame: &Frame) -> io::Result<()> {
    let points: Vec<[u32; 1]> = frame.singletons().map(|row| [row]).collect();
    let counts = [
        ("NumberOfPoints", frame.len),
        ("NumberOfVerts", points.len()),
        ("NumberOfLines", frame.edges.len()),
        ("NumberOfStrips", 0),
        ("NumberOfPolys", frame.faces.len()),
    ];
    let counts = counts.map(|(name, count)| (name, count.to_string()));
    let counts = counts.iter().map(|(name, count)| (*name, count.as_str()));
    xml.create_element("Piece").with_attributes(counts).write_inner_content(|xml| {
        xml.create_element("PointData").write_inner_content(|xml| {
            let color = frame.columns.iter().any(|column| column.name == "alpha").then(|| color(frame));
            let others = frame.others(&PARTS).map(of_column);
            [vector(frame, "velocity", ["vx", "vy", "vz"])]
                .into_iter()
                .chain(others)
                .chain(color)
                .try_for_each(|array| tuples(xml, &array, None))
        })?;
        xml.create_element("Points")
            .write_inner_content(|xml| tuples(xml, &vector(frame, "Points", ["x", "y", "z"]), None))?;
        cells(xml, "Verts", &points)?;
        cells(xml, "Lines", &frame.edges)?;
        cells(xml, "Polys", &frame.faces)
    })?;
    Ok(())
}

/// The array of a column.
fn of_column(column: &Column) -> Array<'_> {
    let kind = match column.values {
        Values::Single(_) => "Float32",
        Values::Double(_) => "Float64",
        Values::Unsigned(_) => "UInt32",
        Values::Signed(_) => "Int32",
        Values::Byte(_) => "UInt8",
    };
    Array { name: &column.name, kind, components: 1, bytes: column.values.bytes() }
}

/// The array of three columns together.
fn vector<'a>(frame: &Frame, name: &'a str, axes: [&str; 3]) -> Array<'a> {
    let axes = frame.singles(axes);
    let bytes = (0..frame.len).flat_map(|row| axes.map(|axis| axis[row])).flat_map(f32::to_le_bytes).collect();
    Array { name, kind: "Float32", components: 3, bytes }
}

/// The array of colours.
fn color(frame: &Frame) -> Array<'static> {
    Array { name: "color", kind: "UInt8", components: 4, bytes: frame.colors.as_flattened().to_vec() }
}

/// Lists of the points of cells, and where each ends.
fn cells<W: Write, const N: usize>(xml: &mut Xml<W>, name: &str, cells: &[[u32; N]]) -> io::Result<()> {
    let numbers = |numbers: &mut dyn Iterator<Item = i64>| numbers.flat_map(i64::to_le_bytes).collect();
    let points = numbers(&mut cells.as_flattened().iter().map(|&point| i64::from(point)));
    let ends = numbers(&mut (1..=cells.len()).map(|cell| (cell * N) as i64));
    xml.create_element(name).write_inner_content(|xml| {
        tuples(xml, &Array { name: "connectivity", kind: "Int64", components: 1, bytes: points }, None)?;
        tuples(xml, &Array { name: "offsets", kind: "Int64", components: 1, bytes: ends }, None)
    })?;
    Ok(())
}

/// Writes an array; how many numbers it has only where nothing else says so.
fn tuples<W: Write>(xml: &mut Xml<W>, array: &Array<'_>, count: Option<usize>) -> io::Result<()> {
    let Array { name, kind, components, bytes } = array;
    let content = [&(bytes.len() as u64).to_le_bytes(), bytes.as_slice()].concat();
    let (components, count) = (components.to_string(), count.map(|count| count.to_string()));
    let element = xml.create_element("DataArray").with_attributes([("type", *kind), ("Name", name)]);
    let element = element.with_attributes([("NumberOfComponents", components.as_str()), ("format", "binary")]);
    let element = element.with_attributes(count.iter().map(|count| ("NumberOfTuples", count.as_str())));
    element.write_text_content(BytesText::new(&STANDARD.encode(content)))?;
    Ok(())
}

/// Writes a file of VTK's around its content.
fn file<W: Write>(xml: &mut Xml<W>, kind: &str, content: impl FnOnce(&mut Xml<W>) -> io::Result<()>) -> io::Result<()> {
    xml.write_event(Event::Decl(BytesDecl::new("1.0", None, None)))?;
    let attributes = [("type", kind), ("version", "1.0"), ("byte_order", "LittleEndian"), ("header_type", "UInt64")];
    xml.create_element("VTKFile").with_attributes(attributes).write_inner_content(content)?;
    xml.get_mut().write_all(b"\n")
}

/// The index of records: their instants \[s\], and what their files are called.
pub(super) fn index(out: &mut impl Write, records: &[(f64, String)]) -> io::Result<()> {
    file(&mut Xml::new_with_indent(out, b' ', 1), "Collection", |xml| {
        xml.create_element("Collection").write_inner_content(|xml| {
            for (time, name) in records {
                let time = time.to_string();
                let attributes = [("timestep", time.as_str()), ("part", "0"), ("file", name.as_str())];
                xml.create_element("DataSet").with_attributes(attributes).write_empty()?;
            }
            Ok(())
        })?;
        Ok(())
    })
}
