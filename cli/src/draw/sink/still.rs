//! A single picture.

use super::common::{Size, cannot_write, no_frames, write_png};
use crate::whole::WholeFile;
use image::RgbImage;
use std::path::Path;

/// A picture in the making.
#[derive(Debug)]
pub(super) struct Still {
    file: WholeFile,
    size: Size,
    last: Option<RgbImage>,
}

impl Still {
    pub(super) fn create(path: &Path) -> Result<Self, String> {
        Ok(Self {
            file: WholeFile::create(path).map_err(|failure| failure.to_string())?,
            size: Size::default(),
            last: None,
        })
    }

    pub(super) fn push(&mut self, frame: &RgbImage) -> Result<(), String> {
        self.size.check(frame, self.file.path())?;
        self.last = Some(frame.clone());
        Ok(())
    }

    pub(super) fn finish(self) -> Result<(), String> {
        let Some(frame) = self.last else { return Err(no_frames(self.file.path())) };
        let written = self.file.reopen().map_err(Into::into).and_then(|file| write_png(&frame, file));
        written.map_err(|error| cannot_write(self.file.path(), &error))?;
        self.file.complete().map_err(|failure| failure.to_string())
    }
}
