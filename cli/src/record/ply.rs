//! PLY point clouds, binary, one file a record.

use super::{Frame, Row, Writer};
use crate::outcome::Outcome;
use crate::whole::{Series, Written};
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

    /// The name of record number `i`.
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
        write(&mut out, frame)?;
        out.flush()
    }

    fn close(self: Box<Self>) -> Outcome<Vec<Written>> {
        self.series.close()
    }
}

fn write(out: &mut impl Write, frame: &Frame) -> io::Result<()> {
    let floats = ["x", "y", "z", "vx", "vy", "vz", "mass"].map(|name| ("float", name));
    let rest = [("double", "age"), ("uint", "id")];
    let color = ["red", "green", "blue", "alpha"].map(|name| ("uchar", name));
    let radius = frame.balls.then_some(("float", "radius"));
    let own = frame.names.iter().map(|name| ("float", name.as_str()));
    writeln!(out, "ply\nformat binary_little_endian 1.0\ncomment time {} step {}", frame.time, frame.step)?;
    writeln!(out, "element vertex {}", frame.rows.len())?;
    for (kind, name) in floats.into_iter().chain(rest).chain(color).chain(radius).chain(own) {
        writeln!(out, "property {kind} {name}")?;
    }
    writeln!(out, "end_header")?;
    for ((row, color), custom) in frame.rows.iter().zip(&frame.colors).zip(&frame.custom) {
        let Row { x, y, z, vx, vy, vz, mass, age, id, radius, .. } = *row;
        out.write_all([x, y, z, vx, vy, vz, mass].map(f32::to_le_bytes).as_flattened())?;
        out.write_all(&age.to_le_bytes())?;
        out.write_all(&id.to_le_bytes())?;
        out.write_all(color)?;
        radius.iter().chain(custom).try_for_each(|number| out.write_all(&number.to_le_bytes()))?;
    }
    Ok(())
}
