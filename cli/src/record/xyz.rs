//! XYZ, as molecule viewers read it: all records one behind the other, in the extended form that names its columns.

use super::{Frame, Row, Writer};
use crate::outcome::Outcome;
use crate::whole::{WholeFile, Written};
use std::io::{self, Write};

pub(super) struct Xyz(pub(super) WholeFile);

impl Writer for Xyz {
    fn record(&mut self, frame: &Frame) -> io::Result<()> {
        let out = &mut self.0;
        writeln!(out, "{}", frame.rows.len())?;
        let radius = if frame.balls { ":radius:R:1" } else { "" };
        let own: String = frame.names.iter().map(|name| format!(":{name}:R:1")).collect();
        let columns = format!("species:S:1:pos:R:3:velo:R:3:mass:R:1:id:I:1{radius}{own}");
        writeln!(out, "Properties={columns} Time={} Step={}", frame.time, frame.step)?;
        for (Row { id, x, y, z, vx, vy, vz, mass, radius, .. }, custom) in frame.rows.iter().zip(&frame.custom) {
            write!(out, "X {x} {y} {z} {vx} {vy} {vz} {mass} {id}")?;
            radius.map_or(Ok(()), |radius| write!(out, " {radius}"))?;
            custom.iter().try_for_each(|value| write!(out, " {value}"))?;
            writeln!(out)?;
        }
        Ok(())
    }

    fn close(self: Box<Self>) -> Outcome<Vec<Written>> {
        Ok(vec![self.0.close()?])
    }
}
