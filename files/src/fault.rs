//! Faults of a file of points or triangles.

use crate::outcome::Failure;

/// A fault in a file whose name the reader does not know: `:line: what is wrong and what was expected`. The line is left
/// out where the format is binary or the fault has no place.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Fault {
    line: Option<u64>,
    message: String,
}

impl Fault {
    pub(crate) fn new(message: impl Into<String>) -> Self {
        Self { line: None, message: message.into() }
    }

    pub(crate) fn at(line: impl TryInto<u64>, message: impl Into<String>) -> Self {
        Self { line: line.try_into().ok(), message: message.into() }
    }

    /// The fault of a file that has a name.
    pub(crate) fn of(self, file: impl std::fmt::Display) -> Failure {
        Failure::new(format!("{file}{self}"))
    }
}

impl std::fmt::Display for Fault {
    fn fmt(&self, out: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self.line {
            Some(line) => write!(out, ":{line}: {}", self.message),
            None => write!(out, ": {}", self.message),
        }
    }
}

impl From<std::io::Error> for Fault {
    fn from(error: std::io::Error) -> Self {
        Self::new(format!("can't be read: {error}"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_fault_names_file_and_line() {
        assert_eq!(Fault::at(3, "is odd").of("cube.off").to_string(), "cube.off:3: is odd");
        assert_eq!(Fault::new("is odd").of("cube.stl").to_string(), "cube.stl: is odd");
    }
}
