//! XYZ, as molecule viewers read it: all records one behind the other, in the extended form that names its columns.

use super::{Frame, Row, Writer};
use crate::Outcome;
use crate::whole::WholeFile;
use std::io::{self, Write};

pub(super) struct Xyz {
    file: WholeFile,
}

impl Xyz {
    pub(super) fn new(file: WholeFile) -> Self {
        Self { file }
    }
}

impl Writer for Xyz {
    fn record(&mut self, frame: &Frame) -> io::Result<()> {
        let out = &mut self.file;
        writeln!(out, "{}", frame.rows.len())?;
        let columns = "species:S:1:pos:R:3:velo:R:3:mass:R:1:id:I:1";
        writeln!(out, "Properties={columns} Time={} Step={}", frame.time, frame.step)?;
        for Row { id, x, y, z, vx, vy, vz, mass, .. } in &frame.rows {
            writeln!(out, "X {x} {y} {z} {vx} {vy} {vz} {mass} {id}")?;
        }
        Ok(())
    }

    fn finish(self: Box<Self>) -> Outcome {
        self.file.complete()
    }
}
