//! Errors in scenes.

use alloc::format;
use alloc::string::{String, ToString};

/// An error in a scene: what is wrong, where, and what was expected, in one line.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SceneError {
    /// The file's name.
    pub file: String,
    /// Where: `line:column`, or the path of a value such as `particles[3].mass`; empty if the whole file is meant.
    pub place: String,
    /// The message: what is wrong.
    pub message: String,
}

impl SceneError {
    /// About a whole file.
    pub fn file(file: &str, message: impl ToString) -> Self {
        Self { file: file.to_string(), place: String::new(), message: message.to_string() }
    }

    /// About a line and column.
    pub fn at(file: &str, line: usize, column: usize, message: impl ToString) -> Self {
        Self { place: format!("{line}:{column}"), ..Self::file(file, message) }
    }

    /// About a value of the declared scene.
    pub fn value(place: impl ToString, message: impl ToString) -> Self {
        Self { place: place.to_string(), ..Self::file("", message) }
    }

    /// The same error, in this file if it does not name one yet.
    #[must_use]
    pub fn in_file(mut self, file: &str) -> Self {
        if self.file.is_empty() {
            self.file = file.to_string();
        }
        self
    }
}

impl core::fmt::Display for SceneError {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        for part in [&self.file, &self.place] {
            if !part.is_empty() {
                let separator = if part == &self.place || self.place.is_empty() { ": " } else { ":" };
                write!(f, "{part}{separator}")?;
            }
        }
        f.write_str(&self.message)
    }
}

impl core::error::Error for SceneError {}
