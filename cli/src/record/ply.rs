//! PLY point clouds, binary, one file a record.

use super::{Frame, Row, Writer};
use crate::whole::{PREFIX, existing_folder_of};
use crate::{Failure, Outcome};
use ply_rs_bw::ply::{
    Addable, DefaultElement, ElementDef, Encoding, Ply as Cloud, Property, PropertyDef, PropertyType, ScalarType,
};
use ply_rs_bw::writer::Writer as CloudWriter;
use std::fs::{self, File};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};
use tempfile::TempDir;

pub(super) struct Ply {
    path: PathBuf,
    /// Clouds wait in a folder of their own until all are complete.
    waiting: TempDir,
    count: u32,
}

impl Ply {
    pub(super) fn new(path: &Path) -> Outcome<Self> {
        let waiting = TempDir::with_prefix_in(PREFIX, existing_folder_of(path)?);
        let waiting = waiting.map_err(|error| Failure::io(path, &error))?;
        Ok(Self { path: path.to_path_buf(), waiting, count: 0 })
    }
}

impl Ply {
    /// What record number `i` will be called.
    fn numbered(&self, i: u32) -> PathBuf {
        PathBuf::from(format!("{}_{i:06}.ply", self.path.with_extension("").to_string_lossy()))
    }
}

impl Writer for Ply {
    fn record(&mut self, frame: &Frame) -> io::Result<()> {
        let mut out = BufWriter::new(File::create(self.waiting.path().join(self.count.to_string()))?);
        let mut cloud = cloud(frame);
        CloudWriter::new().write_ply(&mut out, &mut cloud).map_err(io::Error::other)?;
        self.count += 1;
        out.flush()
    }

    fn check(&self) -> Outcome {
        match (0..self.count).map(|i| self.numbered(i)).find(|path| path.is_dir()) {
            Some(path) => Err(Failure::new(format!("{}: is a directory, and in the way of a record", path.display()))),
            None => Ok(()),
        }
    }

    fn finish(self: Box<Self>) -> Outcome {
        for i in 0..self.count {
            let path = self.numbered(i);
            fs::rename(self.waiting.path().join(i.to_string()), &path).map_err(|error| Failure::io(&path, &error))?;
        }
        Ok(())
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
    let mut vertex = ElementDef::new("vertex".to_string());
    for (name, kind) in columns {
        vertex.properties.add(PropertyDef::new(name.to_string(), PropertyType::Scalar(kind.clone())));
    }
    let point = |(row, color): (&Row, &[u8; 4])| {
        let Row { x, y, z, vx, vy, vz, mass, age, id, radius, .. } = *row;
        let floats = [x, y, z, vx, vy, vz, mass].into_iter().map(Property::Float);
        let rest = [Property::Double(age), Property::UInt(id)];
        let values =
            floats.chain(rest).chain(color.iter().map(|&c| Property::UChar(c))).chain(radius.map(Property::Float));
        columns.iter().map(|(name, _)| name.to_string()).zip(values).collect()
    };
    let mut cloud = Cloud::new();
    cloud.header.encoding = Encoding::BinaryLittleEndian;
    cloud.header.comments.push(format!("time {} step {}", frame.time, frame.step));
    cloud.header.elements.add(vertex);
    cloud.payload.insert("vertex".to_string(), frame.rows.iter().zip(&frame.colors).map(point).collect());
    cloud
}
