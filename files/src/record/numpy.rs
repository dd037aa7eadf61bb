//! Arrays as NumPy reads them, one a column: in a `.npz` of a record or of all, or each in a `.npy`.

use super::frame::{Values, whatever};
use super::{Frame, Out, Writer};
use npyz::{AutoSerialize, WriteOptions, WriterBuilder};
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use zip::ZipWriter;
use zip::write::SimpleFileOptions;

/// Archives of arrays. That of column `x` after step 40 is called `40/x`; `steps` and `times` are those of the records.
pub(super) struct Npz {
    archive: ZipWriter<Out>,
    steps: Vec<u64>,
    times: Vec<f64>,
}

impl Npz {
    /// An archive with nothing in it.
    pub(super) fn new(out: Out) -> Self {
        Self { archive: ZipWriter::new(out), steps: Vec::new(), times: Vec::new() }
    }
}

/// Begins the array of a name in an archive.
fn begin<'a>(archive: &'a mut ZipWriter<Out>, name: &str, large: bool) -> io::Result<&'a mut ZipWriter<Out>> {
    let options = SimpleFileOptions::default().compression_method(zip::CompressionMethod::Stored).large_file(large);
    archive.start_file(format!("{name}.npy"), options)?;
    Ok(archive)
}

impl Writer for Npz {
    fn record(&mut self, frame: &Frame) -> io::Result<()> {
        self.steps.push(frame.step);
        self.times.push(frame.time);
        // More than 4 GB take another form of entry.
        let large = frame.len >= 1 << 28;
        for (name, array) in arrays(frame) {
            array.write(begin(&mut self.archive, &format!("{}/{name}", frame.step), large)?)?;
        }
        Ok(())
    }

    fn close(mut self: Box<Self>) -> io::Result<()> {
        let len = [self.steps.len() as u64];
        write(begin(&mut self.archive, "steps", false)?, &len, self.steps.iter().copied())?;
        write(begin(&mut self.archive, "times", false)?, &len, self.times.iter().copied())?;
        self.archive.finish()?.flush()
    }
}

/// The arrays of a frame with their names.
fn arrays(frame: &Frame) -> impl Iterator<Item = (&str, Array<'_>)> {
    let columns = frame.columns.iter().map(|column| (column.name.as_str(), Array::Column(&column.values)));
    let faces = frame.kinds.faces.then_some(("faces", Array::Faces(&frame.faces)));
    let edges = frame.kinds.edges.then_some(("edges", Array::Edges(&frame.edges)));
    columns.chain(faces).chain(edges)
}

/// An array of a record.
enum Array<'a> {
    Column(&'a Values),
    Faces(&'a [[u32; 3]]),
    Edges(&'a [[u32; 2]]),
}

impl Array<'_> {
    /// Writes it as an array of one column, three or two.
    fn write(&self, out: impl Write) -> io::Result<()> {
        match self {
            Self::Faces(faces) => write(out, &[faces.len() as u64, 3], faces.as_flattened().iter().copied()),
            Self::Edges(edges) => write(out, &[edges.len() as u64, 2], edges.as_flattened().iter().copied()),
            Self::Column(all) => {
                whatever!(Values all, values => write(out, &[values.len() as u64], values.iter().copied()))
            }
        }
    }
}

/// Writes an array of a shape, row by row.
fn write<T: AutoSerialize>(mut out: impl Write, shape: &[u64], values: impl Iterator<Item = T>) -> io::Result<()> {
    let mut array = WriteOptions::new().default_dtype().shape(shape).writer(&mut out).begin_nd()?;
    array.extend(values)?;
    array.finish()
}

/// Writes each array of a frame, and its step and time, to the file that is made for its name.
pub(super) fn each(frame: &Frame, mut file: impl FnMut(&str) -> io::Result<std::fs::File>) -> io::Result<()> {
    let mut begin = |name: &str| file(name).map(io::BufWriter::new);
    let mut out = begin("step")?;
    write(&mut out, &[], [frame.step].into_iter())?;
    out.flush()?;
    let mut out = begin("time")?;
    write(&mut out, &[], [frame.time].into_iter())?;
    out.flush()?;
    for (name, array) in arrays(frame) {
        let mut out = begin(name)?;
        array.write(&mut out)?;
        out.flush()?;
    }
    Ok(())
}

/// The file of an array, from that of its record: `a_000000.npy` becomes `a_000000_x.npy`.
pub(super) fn named(path: &Path, array: &str) -> PathBuf {
    let stem = path.file_stem().unwrap_or_default().to_string_lossy();
    path.with_file_name(format!("{stem}_{array}.npy"))
}
