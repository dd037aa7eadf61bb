//! A numbered sequence of pictures.

use super::common::{Size, cannot_write, no_frames, write_png};
use super::pattern::Pattern;
use crate::whole::{Series, folder_of, publish};
use image::RgbImage;
use std::path::{Path, PathBuf};

/// A sequence in the making.
#[derive(Debug)]
pub(super) struct Sequence {
    path: PathBuf,
    pattern: Pattern,
    size: Size,
    series: Series,
}

impl Sequence {
    pub(super) fn create(path: &Path, pattern: Pattern) -> Result<Self, String> {
        let series = Series::create(path, true).map_err(|failure| failure.to_string())?;
        Ok(Self { path: path.to_owned(), pattern, size: Size::default(), series })
    }

    pub(super) fn push(&mut self, frame: &RgbImage) -> Result<(), String> {
        self.size.check(frame, &self.path)?;
        let path = folder_of(&self.path).join(self.pattern.name(self.series.len()));
        let file = self.series.next(path).map_err(|error| cannot_write(&self.path, &error))?;
        write_png(frame, file).map_err(|error| cannot_write(&self.path, &error))
    }

    pub(super) fn finish(self) -> Result<(), String> {
        if self.series.len() == 0 {
            return Err(no_frames(&self.path));
        }
        self.series.close().and_then(|pictures| publish(&pictures)).map_err(|failure| failure.to_string())
    }
}
