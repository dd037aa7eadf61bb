//! What is said about a file that isn't a mesh.

use std::error::Error;
use std::fmt;

/// Why there is no mesh; displays as one line, `file:line: what is wrong and what was expected`.
///
/// The line is left out where the format is binary or the fault has no place.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct MeshError {
    file: String,
    fault: Fault,
}

impl MeshError {
    pub(super) fn new(file: &str, fault: Fault) -> Self {
        Self { file: file.to_owned(), fault }
    }
}

impl fmt::Display for MeshError {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.fault.line {
            Some(line) => write!(out, "{}:{line}: {}", self.file, self.fault.message),
            None => write!(out, "{}: {}", self.file, self.fault.message),
        }
    }
}

impl Error for MeshError {}

/// A fault in a file whose name the reader doesn't know.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Fault {
    line: Option<usize>,
    message: String,
}

impl Fault {
    pub(super) fn new(message: impl Into<String>) -> Self {
        Self { line: None, message: message.into() }
    }

    /// The line, if there is one, and what is wrong with it.
    pub(crate) fn parts(self) -> (Option<usize>, String) {
        (self.line, self.message)
    }

    pub(super) fn at(line: usize, message: impl Into<String>) -> Self {
        Self { line: Some(line), message: message.into() }
    }
}

/// A piece of the file, or of a library's message, on one line and cut where it is long.
pub(crate) fn excerpt(piece: &str) -> String {
    const LONGEST: usize = 120;
    let mut line = String::new();
    for word in piece.split_whitespace() {
        if !line.is_empty() {
            line.push(' ');
        }
        // A file may be one endless word, or an endless line of them.
        line.extend(
            word.chars().take(LONGEST + 1).map(|c| if c.is_control() { char::REPLACEMENT_CHARACTER } else { c }),
        );
        if let Some((end, _)) = line.char_indices().nth(LONGEST) {
            line.truncate(end);
            line.push('…');
            break;
        }
    }
    line
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_error_names_file_and_line() {
        let error = MeshError::new("cube.off", Fault::at(3, "is odd"));
        assert_eq!(error.to_string(), "cube.off:3: is odd");
        assert_eq!(MeshError::new("cube.stl", Fault::new("is odd")).to_string(), "cube.stl: is odd");
    }

    #[test]
    fn an_excerpt_is_short_and_on_one_line() {
        assert_eq!(excerpt("one\n\ttwo \u{7}"), "one two \u{fffd}");
        assert_eq!(excerpt(&"ä".repeat(500)), format!("{}…", "ä".repeat(120)));
        assert_eq!(excerpt(&"a ".repeat(500)).chars().count(), 121);
    }
}
