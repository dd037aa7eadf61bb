//! Wavefront OBJ: particles as vertices with colours, cloths and rigid bodies as faces, other springs, ropes, rods and strands as lines, the rest as points.

use super::{Frame, Out, Writer};
use std::io::{self, Write};

/// One record.
pub(super) struct Obj(pub(super) Out);

impl Writer for Obj {
    fn record(&mut self, frame: &Frame) -> io::Result<()> {
        let frame = &*frame.with_surfaces();
        let out = &mut self.0;
        writeln!(out, "# time {} step {}", frame.time, frame.step)?;
        if let Some(remark) = frame.remark() {
            writeln!(out, "# {remark}")?;
        }
        for ([x, y, z], color) in frame.places().zip(&frame.colors) {
            let [red, green, blue, _] = color.map(|channel| f32::from(channel) / 255.0);
            writeln!(out, "v {x} {y} {z} {red} {green} {blue}")?;
        }
        // Vertices are counted from 1.
        for [a, b, c] in &frame.faces {
            writeln!(out, "f {} {} {}", a + 1, b + 1, c + 1)?;
        }
        for [a, b] in &frame.edges {
            writeln!(out, "l {} {}", a + 1, b + 1)?;
        }
        for row in frame.singletons() {
            writeln!(out, "p {}", row + 1)?;
        }
        Ok(())
    }

    fn close(mut self: Box<Self>) -> io::Result<()> {
        self.0.flush()
    }
}
