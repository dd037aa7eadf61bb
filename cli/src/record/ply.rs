//! PLY point clouds, binary, one file a record.

use super::{Frame, Row, Writer};
use crate::outcome::Outcome;
use crate::whole::{Series, Written};
use ply_rs_bw::ply::{
    Addable, DefaultElement, ElementDef, Encoding, Ply as Cloud, Property, PropertyDef, PropertyType, ScalarType,
};
use ply_rs_bw::writer::Writer as CloudWriter;
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

pub(super) struct Ply {
    path: PathBuf,
    series: Series,
}

impl Ply {
    pub(super) fn new(path: &Path) -> Outcome<Self> {
        Ok(Self { path: path.to_path_buf(), series: Series::create(path, false)? })
    }

    /// What record number `i` will be called.
    fn numbered(&self, i: usize) -> PathBuf {
        let mut name = self.path.with_extension("").into_os_string();
        name.push(format!("_{i:06}.ply"));
        name.into()
    }
}

impl Writer for Ply {
    fn record(&mut self, frame: &Frame) -> io::Result<()> {
        let path = self.numbered(self.series.len());
        let mut out = BufWriter::new(self.series.next(path)?);
        let mut cloud = cloud(frame);
        CloudWriter::new().write_ply(&mut out, &mut cloud).map_err(io::Error::other)?;
        out.flush()
    }

    fn close(self: Box<Self>) -> Outcome<Vec<Written>> {
        self.series.close()
    }
}

fn cloud(frame: &Frame) -> Cloud<DefaultElement> {
    use ScalarType::{Double, Float, UChar, UInt};
    let columns = [
        ("x", Float),
        ("y", Float),
        ("z", Float),
        ("vx", Float),
        ("vy", Float),
        ("vz", Float),
        ("mass", Float),
        ("age", Double),
        ("id", UInt),
        ("red", UChar),
        ("green", UChar),
        ("blue", UChar),
        ("alpha", UChar),
        // In clouds of balls only.
        ("radius", Float),
    ];
    let columns = if frame.balls { &columns[..] } else { &columns[..columns.len() - 1] };
    let own = frame.names.iter().map(|name| (name.as_str(), Float));
    let columns: Vec<_> = columns.iter().cloned().chain(own).collect();
    let mut vertex = ElementDef::new("vertex".to_string());
    for (name, kind) in &columns {
        vertex.properties.add(PropertyDef::new(name.to_string(), PropertyType::Scalar(kind.clone())));
    }
    let point = |((row, color), custom): ((&Row, &[u8; 4]), &Vec<f32>)| {
        let Row { x, y, z, vx, vy, vz, mass, age, id, radius, .. } = *row;
        let floats = [x, y, z, vx, vy, vz, mass].into_iter().map(Property::Float);
        let rest = [Property::Double(age), Property::UInt(id)];
        let values =
            floats.chain(rest).chain(color.iter().map(|&c| Property::UChar(c))).chain(radius.map(Property::Float));
        let values = values.chain(custom.iter().copied().map(Property::Float));
        columns.iter().map(|(name, _)| name.to_string()).zip(values).collect()
    };
    let points = frame.rows.iter().zip(&frame.colors).zip(&frame.custom);
    let mut cloud = Cloud::new();
    cloud.header.encoding = Encoding::BinaryLittleEndian;
    cloud.header.comments.push(format!("time {} step {}", frame.time, frame.step));
    cloud.header.elements.add(vertex);
    cloud.payload.insert("vertex".to_string(), points.map(point).collect());
    cloud
}
