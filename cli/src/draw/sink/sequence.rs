//! A numbered sequence of pictures.

use super::common::{Size, cannot_write, no_frames, write_png};
use super::pattern::Pattern;
use crate::whole::{PREFIX, folder_of};
use image::RgbImage;
use std::fs;
use std::path::{Path, PathBuf};
use tempfile::TempDir;

/// A sequence in the making.
#[derive(Debug)]
pub(super) struct Sequence {
    path: PathBuf,
    pattern: Pattern,
    count: usize,
    size: Size,
    staged: TempDir,
    /// After `staged`, which has to be gone before this folder can go.
    _created: Created,
}

/// A folder that did not exist before, or `None`. Dropped, it is removed if it is empty.
#[derive(Debug)]
struct Created(Option<PathBuf>);

impl Drop for Created {
    fn drop(&mut self) {
        // Nothing to report: a folder with pictures in it is meant to stay.
        let _ = self.0.take().map(fs::remove_dir);
    }
}

impl Sequence {
    pub(super) fn create(path: &Path, pattern: Pattern) -> Result<Self, String> {
        let folder = folder_of(path);
        let mut created = Created(None);
        if !folder.is_dir() {
            fs::create_dir(folder).map_err(|error| {
                let (path, folder) = (path.display(), folder.display());
                format!("cannot write {path}: the folder {folder} cannot be created: {error}")
            })?;
            created = Created(Some(folder.to_owned()));
        }
        let staged = tempfile::Builder::new().prefix(PREFIX).tempdir_in(folder);
        let staged = staged.map_err(|error| cannot_write(path, &error))?;
        Ok(Self { path: path.to_owned(), pattern, count: 0, size: Size::default(), staged, _created: created })
    }

    pub(super) fn push(&mut self, frame: &RgbImage) -> Result<(), String> {
        self.size.check(frame, &self.path)?;
        let name = self.pattern.name(self.count);
        let file = fs::File::create(self.staged.path().join(name)).map_err(|error| cannot_write(&self.path, &error))?;
        write_png(frame, file).map_err(|error| cannot_write(&self.path, &error))?;
        self.count += 1;
        Ok(())
    }

    pub(super) fn finish(self) -> Result<(), String> {
        if self.count == 0 {
            return Err(no_frames(&self.path));
        }
        for number in 0..self.count {
            let name = self.pattern.name(number);
            let to = folder_of(&self.path).join(&name);
            fs::rename(self.staged.path().join(&name), &to).map_err(|error| cannot_write(&to, &error))?;
        }
        Ok(())
    }
}
