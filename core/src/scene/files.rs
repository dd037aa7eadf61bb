//! Where scenes and meshes come from.

use crate::shape::MeshBuf;
use alloc::format;
use alloc::string::{String, ToString};
use alloc::vec::Vec;

/// Where scenes and meshes come from; errors are one line of text that names the file.
pub trait Files {
    /// The text of a file.
    ///
    /// # Errors
    /// If it cannot be read.
    fn text(&mut self, path: &str) -> Result<String, String>;

    /// A mesh.
    ///
    /// # Errors
    /// If it cannot be read or is no mesh.
    fn mesh(&mut self, path: &str) -> Result<MeshBuf, String>;

    /// Tells whether there is such a file.
    fn exists(&mut self, path: &str) -> bool;

    /// The name of a file that differs from this in capitals alone, where there is one.
    fn alike(&mut self, path: &str) -> Option<String> {
        let _ = path;
        None
    }
}

/// No files at all: for scenes that name none.
impl Files for () {
    fn text(&mut self, path: &str) -> Result<String, String> {
        Err(format!("there is no file '{path}'"))
    }

    fn mesh(&mut self, path: &str) -> Result<MeshBuf, String> {
        Err(format!("there is no file '{path}'"))
    }

    fn exists(&mut self, _: &str) -> bool {
        false
    }
}

/// The path of `name`, which the file at `path` names: relative to its folder, with `.` and `..` resolved.
#[must_use]
pub fn beside(path: &str, name: &str) -> String {
    if name.starts_with('/') {
        return name.to_string();
    }
    let folder = path.rsplit_once('/').map_or("", |(folder, _)| folder);
    let rooted = path.starts_with('/');
    let mut parts: Vec<&str> = Vec::new();
    for part in folder.split('/').chain(name.split('/')) {
        match part {
            "" | "." => {}
            ".." if parts.last().is_some_and(|&last| last != "..") => {
                parts.pop();
            }
            part => parts.push(part),
        }
    }
    let joined = parts.join("/");
    if rooted { format!("/{joined}") } else { joined }
}
