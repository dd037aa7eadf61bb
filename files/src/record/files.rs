//! Recordings in one file, and in a file a record.

use super::{Frame, Sink, Writer, numpy, vtk, writer};
use crate::formats::RecordFormat;
use crate::outcome::{Failure, Outcome};
use crate::pattern::Pattern;
use crate::whole::{Series, WholeFile, Written, folder_of};
use std::io::{self, BufWriter};
use std::path::{Path, PathBuf};

/// All records in one file.
pub(super) struct Together {
    file: WholeFile,
    writer: Box<dyn Writer>,
}

impl Together {
    /// Begins the file.
    pub(super) fn create(path: &Path, format: RecordFormat) -> Outcome<Self> {
        let file = WholeFile::create(path)?;
        let out = file.reopen().map_err(|error| Failure::io(path, &error))?;
        Ok(Self { file, writer: writer(format, BufWriter::new(out)) })
    }
}

impl Sink for Together {
    fn record(&mut self, frame: &Frame) -> io::Result<()> {
        self.writer.record(frame)
    }

    fn close(self: Box<Self>) -> Outcome<Vec<Written>> {
        self.writer.close().map_err(|error| Failure::io(self.file.path(), &error))?;
        Ok(vec![self.file.close()?])
    }
}

/// Each record in a file of its own, or in several.
pub(super) struct Apart {
    path: PathBuf,
    format: RecordFormat,
    pattern: Pattern,
    series: Series,
    /// The index of them, where the format has one.
    index: Option<WholeFile>,
    /// The instant of each record \[s\], and what its file is called.
    records: Vec<(f64, String)>,
}

impl Apart {
    /// Begins the files; a folder for a pattern may be made.
    pub(super) fn create(path: &Path, pattern: Option<Pattern>, format: RecordFormat) -> Outcome<Self> {
        let series = Series::create(path, pattern.is_some())?;
        let pattern = pattern.unwrap_or_else(|| Pattern::numbered(path));
        let index = || WholeFile::create(&folder_of(path).join(pattern.common("pvd")));
        let index = matches!(format, RecordFormat::Vtp).then(index).transpose()?;
        Ok(Self { path: path.to_path_buf(), format, pattern, series, index, records: Vec::new() })
    }
}

impl Sink for Apart {
    fn record(&mut self, frame: &Frame) -> io::Result<()> {
        let name = self.pattern.name(self.records.len());
        let path = folder_of(&self.path).join(&name);
        self.records.push((frame.time, name));
        if let RecordFormat::Npy = self.format {
            let file = |array: &str| self.series.next(numpy::named(&path, array));
            return numpy::each(frame, file);
        }
        let mut writer = writer(self.format, BufWriter::new(self.series.next(path)?));
        writer.record(frame)?;
        writer.close()
    }

    fn close(self: Box<Self>) -> Outcome<Vec<Written>> {
        let mut written = self.series.close()?;
        if let Some(mut index) = self.index {
            vtk::index(&mut index, &self.records).map_err(|error| Failure::io(index.path(), &error))?;
            written.push(index.close()?);
        }
        Ok(written)
    }
}
