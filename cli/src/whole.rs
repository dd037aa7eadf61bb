//! Files that appear under their name only once they are complete.

use crate::{Failure, Outcome};
use std::fs::File;
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};
use tempfile::NamedTempFile;

/// A file in the making. Dropped, it is gone.
#[derive(Debug)]
pub struct WholeFile {
    path: PathBuf,
    file: BufWriter<NamedTempFile>,
}

impl WholeFile {
    /// Begins a file under a passing name in the folder of `path`.
    ///
    /// # Errors
    /// If that folder does not exist, cannot be written to, or has a folder of that name.
    pub fn create(path: &Path) -> Outcome<Self> {
        if path.is_dir() {
            return Err(Failure::new(format!("{}: is a directory, expected the name of a file", path.display())));
        }
        let mut builder = tempfile::Builder::new();
        builder.prefix(PREFIX);
        // Temporary files are for their owner's eyes only, but this one is going to stay.
        #[cfg(unix)]
        builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
        let file = builder.tempfile_in(existing_folder_of(path)?).map_err(|error| Failure::io(path, &error))?;
        Ok(Self { path: path.to_path_buf(), file: BufWriter::new(file) })
    }

    /// What the file will be called.
    #[must_use]
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Opens the file once more, for those who have to own what they write to.
    ///
    /// # Errors
    /// If the system has no more handles.
    pub fn reopen(&self) -> io::Result<File> {
        self.file.get_ref().as_file().try_clone()
    }

    /// Gives the file its name, in place of any older file that has it.
    ///
    /// # Errors
    /// If what is left in the buffer cannot be written, or the file not be named.
    pub fn complete(self) -> Outcome {
        let fail = |error: &io::Error| Failure::io(&self.path, error);
        let file = self.file.into_inner().map_err(|error| fail(error.error()))?;
        file.persist(&self.path).map(drop).map_err(|error| fail(&error.error))
    }
}

impl Write for WholeFile {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.file.write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.file.flush()
    }
}

/// The files that a command was asked to write, each in a format.
#[derive(Debug)]
pub struct Outs<F>(Vec<(WholeFile, F)>);

impl<F: Copy> Outs<F> {
    /// Begins all of them, but none in place of what is `read`.
    ///
    /// # Errors
    /// If one of them cannot be written.
    pub fn create<'a>(outs: &[(PathBuf, F)], read: impl IntoIterator<Item = &'a PathBuf>) -> Outcome<Self> {
        let read: Vec<_> = read.into_iter().filter_map(|path| path.canonicalize().ok()).collect();
        let is_read = |path: &Path| path.canonicalize().is_ok_and(|path| read.contains(&path));
        if let Some((path, _)) = outs.iter().find(|(path, _)| is_read(path)) {
            let path = path.display();
            return Err(Failure::new(format!("{path}: is read, so it cannot be written; choose another --out")));
        }
        outs.iter().map(|(path, format)| Ok((WholeFile::create(path)?, *format))).collect::<Outcome<_>>().map(Self)
    }

    /// Writes all of them, and then gives them their names.
    ///
    /// # Errors
    /// If a text cannot be made or a file not be written.
    pub fn write(mut self, text: impl Fn(F) -> Outcome<String>) -> Outcome {
        for (file, format) in &mut self.0 {
            let written = file.write_all(text(*format)?.as_bytes());
            written.map_err(|error| Failure::io(file.path(), &error))?;
        }
        self.0.into_iter().try_for_each(|(file, _)| file.complete())
    }
}

/// How passing names begin.
pub(crate) const PREFIX: &str = ".pointmass-";

/// The folder a path is in, as it is named.
#[must_use]
pub fn folder_of(path: &Path) -> &Path {
    path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."))
}

/// The folder a path is in, which has to exist.
///
/// # Errors
/// If it does not.
pub fn existing_folder_of(path: &Path) -> Outcome<&Path> {
    let folder = folder_of(path);
    if folder.is_dir() {
        return Ok(folder);
    }
    let (path, folder) = (path.display(), folder.display());
    Err(Failure::new(format!("cannot write {path}: there is no folder {folder}; create it first")))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_appears_whole_or_not_at_all() -> Outcome {
        let folder = tempfile::tempdir().map_err(|error| Failure::new(error.to_string()))?;
        let path = folder.path().join("a.txt");
        let mut dropped = WholeFile::create(&path)?;
        assert!(dropped.write_all(b"half").is_ok());
        drop(dropped);
        assert!(folder.path().read_dir().is_ok_and(|mut files| files.next().is_none()));
        let mut kept = WholeFile::create(&path)?;
        assert!(kept.write_all(b"all").is_ok() && !path.exists());
        kept.complete()?;
        assert_eq!(std::fs::read(&path).ok().as_deref(), Some(&b"all"[..]));
        assert!(WholeFile::create(folder.path()).is_err());
        assert!(WholeFile::create(&folder.path().join("no/a.txt")).is_err());
        Ok(())
    }
}
