//! Files that appear under their name only once they are complete.
//!
//! Each is written under a passing name in the folder where it is going to be, and waits until all of a command are
//! complete. What is no plain file, such as a pipe, gets all at once then.

use crate::outcome::{Failure, Outcome};
use crate::temporary::{PREFIX, Temporary, uninterrupted};
use std::collections::HashSet;
use std::fs::{self, File};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

/// The name by which standard output goes.
pub const STANDARD: &str = "-";

/// Whether a path is standard output, or standard input.
pub fn is_standard(path: &Path) -> bool {
    path == Path::new(STANDARD)
}

/// A file in the making. Dropped, it is gone.
#[derive(Debug)]
pub struct WholeFile {
    path: PathBuf,
    file: BufWriter<File>,
    temporary: Temporary,
    target: PathBuf,
}

impl WholeFile {
    /// Begins a file under a passing name in the folder of `path`, or of what that links to.
    pub fn create(path: &Path) -> Outcome<Self> {
        let target = target_of(path)?;
        let path = if is_standard(path) { Path::new("standard output") } else { path };
        // Nothing can lie beside a pipe in /dev.
        let folder = if is_special(&target) { std::env::temp_dir() } else { folder_of(&target).to_path_buf() };
        let mut builder = tempfile::Builder::new();
        builder.prefix(PREFIX);
        // Temporary files are for their owner's eyes only, but this one is going to stay.
        #[cfg(unix)]
        builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
        let made = Temporary::new(|| builder.tempfile_in(&folder)?.keep().map_err(|error| error.error));
        let (file, temporary) = made.map_err(|error| cannot_begin(path, &folder, &error))?;
        Ok(Self { path: path.to_path_buf(), file: BufWriter::new(file), temporary, target })
    }

    /// The name that the file will have.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// The name that it has until it is complete, for programs that write it.
    pub fn passing(&self) -> &Path {
        self.temporary.path()
    }

    /// Opens the file once more, for those who have to own what they write to.
    pub fn reopen(&self) -> io::Result<File> {
        self.file.get_ref().try_clone()
    }

    /// Nothing more is going to be written.
    pub fn close(self) -> Outcome<Written> {
        let Self { path, file, temporary, target } = self;
        file.into_inner().map_err(|error| Failure::io(&path, error.error()))?;
        Ok(Written { passing: temporary.path().to_path_buf(), target, path, _kept: vec![temporary] })
    }

    /// Gives the file its name, in place of any older file that has it.
    pub fn complete(self) -> Outcome {
        publish(&[self.close()?])
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

/// A file that is complete and waits for its name. Dropped, it is gone.
#[derive(Debug)]
pub struct Written {
    /// Its passing name.
    passing: PathBuf,
    /// Where it will be.
    target: PathBuf,
    /// The name that it has in messages.
    path: PathBuf,
    _kept: Vec<Temporary>,
}

/// Files that are numbered as they come, in a folder of their own until all are complete.
#[derive(Debug)]
pub(crate) struct Series {
    waiting: Temporary,
    /// The folder they will be in, if it was made for them.
    _made: Option<Temporary>,
    paths: Vec<PathBuf>,
}

impl Series {
    /// Begins beside `path`.
    pub(crate) fn create(path: &Path, may_make_folder: bool) -> Outcome<Self> {
        let folder = folder_of(path);
        let mut made = None;
        if may_make_folder && !folder.is_dir() {
            let make = || fs::create_dir(folder).map(|()| ((), folder.to_path_buf()));
            made = Some(Temporary::new(make).map_err(|error| {
                let (path, folder) = (path.display(), folder.display());
                Failure::new(format!("cannot write {path}: the folder {folder} cannot be created: {error}"))
            })?);
        }
        let folder = existing_folder_of(path)?;
        let make = || Ok(((), tempfile::Builder::new().prefix(PREFIX).tempdir_in(folder)?.keep()));
        let ((), waiting) = Temporary::new(make).map_err(|error| cannot_begin(path, folder, &error))?;
        Ok(Self { waiting, _made: made.map(|(_, made)| made), paths: Vec::new() })
    }

    /// A new file, which will be called `path`.
    pub(crate) fn next(&mut self, path: PathBuf) -> io::Result<File> {
        // Who cleans up has to find all that there is.
        let _uninterrupted = uninterrupted();
        let file = File::create(self.waiting.path().join(self.paths.len().to_string()))?;
        self.paths.push(path);
        Ok(file)
    }

    pub(crate) fn len(&self) -> usize {
        self.paths.len()
    }

    /// Nothing more is going to be written.
    pub(crate) fn close(self) -> Outcome<Vec<Written>> {
        let Self { waiting, _made, paths } = self;
        let number = |(i, path): (usize, PathBuf)| {
            let (passing, target) = (waiting.path().join(i.to_string()), target_of(&path)?);
            Ok(Written { passing, target, path, _kept: Vec::new() })
        };
        let mut written = paths.into_iter().enumerate().map(number).collect::<Outcome<Vec<_>>>()?;
        // The folders stay for as long as the first of them waits.
        if let Some(first) = written.first_mut() {
            first._kept.extend([Some(waiting), _made].into_iter().flatten());
        }
        Ok(written)
    }
}

/// Refuses to begin files of which two would be one, each given with the option that asks for it: the later would take the place of the earlier.
pub fn keep_apart<'a>(outs: impl IntoIterator<Item = (&'a str, PathBuf)>) -> Outcome {
    let mut begun: Vec<(PathBuf, &str)> = Vec::new();
    for (option, path) in outs {
        let place = place_of(&path);
        if let Some((_, other)) = begun.iter().find(|(taken, _)| *taken == place) {
            let both = if *other == option { format!("two {option}") } else { format!("{other} and {option}") };
            let path = if is_standard(&path) { "standard output".into() } else { path.display().to_string() };
            return Err(Failure::new(format!("{both} would write {path}; name another file for one of them")));
        }
        begun.push((place, option));
    }
    Ok(())
}

/// The place that a path stands for, however it is written.
fn place_of(path: &Path) -> PathBuf {
    // What cannot be written is refused by who begins it.
    let target = target_of(path).unwrap_or_else(|_| path.to_path_buf());
    if is_standard(&target) {
        return target;
    }
    let beside = || Some(folder_of(&target).canonicalize().ok()?.join(target.file_name()?));
    target.canonicalize().ok().or_else(beside).unwrap_or(target)
}

/// Gives all of them their names, or none of them if one cannot be written, something is in its way, or two have one name.
pub fn publish(files: &[Written]) -> Outcome {
    let fail = |file: &Written, error: &io::Error| Failure::io(&file.path, error);
    let mut places = HashSet::new();
    if let Some(twice) = files.iter().find(|file| !places.insert(place_of(&file.target))) {
        let path = twice.path.display();
        return Err(Failure::new(format!(
            "{path}: two outputs would be this file, so none is written; name one otherwise"
        )));
    }
    for file in files {
        file.prepare().map_err(|error| fail(file, &error))?;
    }
    let (special, plain): (Vec<_>, Vec<_>) = files.iter().partition(|file| is_special(&file.target));
    // They may keep us waiting, so that one has to be able to interrupt them.
    for file in special {
        file.pour().map_err(|error| fail(file, &error))?;
    }
    let _uninterrupted = uninterrupted();
    for (i, file) in plain.iter().enumerate() {
        if let Err(error) = fs::rename(&file.passing, &file.target) {
            let nothing = if i == 0 { "" } else { "; the files before it are there" };
            return Err(Failure::new(format!("{}: {error}{nothing}", file.path.display())));
        }
    }
    Ok(())
}

impl Written {
    /// Brings it to the disk, with the mode of what it replaces.
    fn prepare(&self) -> io::Result<()> {
        if is_standard(&self.target) {
            return Ok(());
        }
        if self.target.is_dir() {
            return Err(io::Error::other("is a directory, and in the way of a file"));
        }
        let old = fs::metadata(&self.target).ok().filter(fs::Metadata::is_file);
        old.map_or(Ok(()), |old| fs::set_permissions(&self.passing, old.permissions()))?;
        File::open(&self.passing)?.sync_all()
    }

    /// Copies it into what is no plain file. That its reader has gone away is no error.
    fn pour(&self) -> io::Result<()> {
        let mut source = File::open(&self.passing)?;
        let poured = if is_standard(&self.target) {
            let mut out = io::stdout().lock();
            io::copy(&mut source, &mut out).and_then(|_| out.flush())
        } else {
            let mut target = fs::OpenOptions::new().write(true).open(&self.target)?;
            io::copy(&mut source, &mut target).map(|_| ())
        };
        match poured {
            Err(error) if error.kind() != io::ErrorKind::BrokenPipe => Err(error),
            _ => Ok(()),
        }
    }
}

/// The files that a command was asked to write, each in a format.
#[derive(Debug)]
pub struct Outs<F>(Vec<(WholeFile, F)>);

impl<F: Copy> Outs<F> {
    /// Begins all of them, but none in place of what is `read`.
    pub fn create<'a>(outs: &[(PathBuf, F)], read: impl IntoIterator<Item = &'a PathBuf>) -> Outcome<Self> {
        let read: Vec<_> = read.into_iter().filter_map(|path| path.canonicalize().ok()).collect();
        let is_read = |path: &Path| path.canonicalize().is_ok_and(|path| read.contains(&path));
        if let Some((path, _)) = outs.iter().find(|(path, _)| is_read(path)) {
            let path = path.display();
            return Err(Failure::new(format!("{path}: is read, so it cannot be written; choose another --out")));
        }
        keep_apart(outs.iter().map(|(path, _)| ("--out", path.clone())))?;
        outs.iter().map(|(path, format)| Ok((WholeFile::create(path)?, *format))).collect::<Outcome<_>>().map(Self)
    }

    /// Writes all of them, and then gives them their names.
    pub fn write(self, text: impl Fn(F) -> Outcome<String>) -> Outcome {
        let write = |(mut file, format): (WholeFile, F)| {
            let written = file.write_all(text(format)?.as_bytes());
            written.map_err(|error| Failure::io(file.path(), &error))?;
            file.close()
        };
        publish(&self.0.into_iter().map(write).collect::<Outcome<Vec<_>>>()?)
    }
}

/// The failure to begin a file in a folder. What the system says names the passing file, which is nobody's business, so that only the
/// kind of the failure is told.
fn cannot_begin(path: &Path, folder: &Path, error: &io::Error) -> Failure {
    let (path, folder) = (path.display(), folder.display());
    Failure::new(format!("{path}: no file can be made in {folder}: {}", io::Error::from(error.kind())))
}

/// Where what is written to `path` goes: links are followed, also those to what is not there yet.
fn target_of(path: &Path) -> Outcome<PathBuf> {
    /// Links that are followed; more are taken for a circle.
    const MOST: usize = 40;
    if is_standard(path) {
        return Ok(path.to_path_buf());
    }
    if path.is_dir() {
        return Err(Failure::new(format!("{}: is a directory, expected the name of a file", path.display())));
    }
    let mut target = path.to_path_buf();
    for _ in 0..MOST {
        match fs::read_link(&target) {
            // What a process has open is a link that leads nowhere.
            Ok(_) if is_special(&target) => return Ok(target),
            Ok(next) => target = folder_of(&target).join(next),
            Err(_) => {
                existing_folder_of(path)?;
                return existing_folder_of(&target).map(|_| target.clone());
            }
        }
    }
    Err(Failure::new(format!("{}: links to itself", path.display())))
}

/// Whether it is there and no plain file: standard output, a pipe, a terminal, a device.
fn is_special(path: &Path) -> bool {
    is_standard(path) || fs::metadata(path).is_ok_and(|facts| !facts.is_file() && !facts.is_dir())
}

/// The folder a path is in, as it is named.
pub fn folder_of(path: &Path) -> &Path {
    path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."))
}

/// The folder a path is in, which has to exist.
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
