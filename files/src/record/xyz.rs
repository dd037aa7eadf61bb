//! XYZ, as molecule viewers read it: all records one behind the other, in the extended form that names its columns.

use super::frame::{Column, Values};
use super::{Frame, Out, Writer};
use pointmass::index::Room;
use std::io::{self, Write};

/// Atoms; their colours are numbers from 0 to 1, as viewers of the format take them.
pub(super) struct Xyz(pub(super) Out);

/// The columns that the format has names of its own for, or has in another order.
const OWN: [&str; 12] = ["id", "x", "y", "z", "vx", "vy", "vz", "mass", "red", "green", "blue", "alpha"];

impl Writer for Xyz {
    fn record(&mut self, frame: &Frame) -> io::Result<()> {
        let out = &mut self.0;
        let is_colored = frame.columns.iter().any(|column| column.name == "alpha");
        let ids = frame.columns.iter().find(|column| column.name == "id");
        let mut others: Vec<&Column> = frame.others(&OWN).collect();
        // Last, since it once was not told here.
        others.sort_by_key(|column| column.name == "age");
        let names: String =
            others.iter().map(|column| format!(":{}:{}:1", column.name, kind(&column.values))).collect();
        let color = if is_colored { ":color:R:3:transparency:R:1" } else { "" };
        let columns = format!("species:S:1:pos:R:3:velo:R:3:mass:R:1:id:I:1{names}{color}");
        writeln!(out, "{}", frame.len)?;
        let cell = frame.room.as_ref().map_or(String::new(), |room| cell(room, frame));
        writeln!(out, "Properties={columns} Time={} Step={}{cell}", frame.time, frame.step)?;
        let numbers = frame.singles(["x", "y", "z", "vx", "vy", "vz", "mass"]);
        for row in 0..frame.len {
            write!(out, "X")?;
            numbers.iter().try_for_each(|column| write!(out, " {}", column[row]))?;
            let others = ids.into_iter().chain(others.iter().copied());
            others.into_iter().try_for_each(|column| write!(out, " {}", column.values.at(row)))?;
            if is_colored {
                let [red, green, blue, alpha] = frame.colors[row].map(|channel| f32::from(channel) / 255.0);
                write!(out, " {red} {green} {blue} {}", 1.0 - alpha)?;
            }
            writeln!(out)?;
        }
        Ok(())
    }

    fn close(mut self: Box<Self>) -> io::Result<()> {
        self.0.flush()
    }
}

/// The cell of a room whose opposite faces are one, as viewers draw it and go on beyond it. Where space goes on it reaches from the
/// first of the particles to the last, since they take cells without volume for faults.
fn cell(room: &Room, frame: &Frame) -> String {
    let (mut low, mut sides) = (room.low().to_array(), room.sides().to_array());
    let periodic = sides.map(|side| if side > 0.0 { 'T' } else { 'F' });
    for (axis, name) in ["x", "y", "z"].into_iter().enumerate().filter(|(axis, _)| periodic[*axis] == 'F') {
        let [places] = frame.singles([name]);
        let ends = |[low, high]: [f32; 2], x: &f32| [low.min(*x), high.max(*x)];
        let [first, last] = places.iter().fold([f32::INFINITY, f32::NEG_INFINITY], ends);
        let is_wide = last > first && (last - first).is_finite();
        low[axis] = if first.is_finite() { first } else { 0.0 };
        sides[axis] = if is_wide { last - first } else { 1.0 };
    }
    let ([x, y, z], [a, b, c], [p, q, r]) = (low, sides, periodic);
    format!(" Lattice=\"{a} 0 0 0 {b} 0 0 0 {c}\" Origin=\"{x} {y} {z}\" pbc=\"{p} {q} {r}\"")
}

/// The letter of a column's kind: a real number or an integer.
fn kind(values: &Values) -> char {
    if matches!(values, Values::Single(_) | Values::Double(_)) { 'R' } else { 'I' }
}
