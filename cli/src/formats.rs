//! Formats of files, by the end of their names.

use std::path::Path;

/// A format of scenes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SceneFormat {
    /// The course's.
    Scn,
    /// Ours.
    Json,
}

/// A format of recordings.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RecordFormat {
    /// A table with a head line.
    Csv,
    /// The same, each line a JSON object.
    Jsonl,
    /// Point clouds, one file a record.
    Ply,
    /// Atoms, all records in one file.
    Xyz,
}

impl SceneFormat {
    /// By the end of the file's name.
    #[must_use]
    pub fn of(path: &Path) -> Option<Self> {
        match extension(path).as_str() {
            "scn" => Some(Self::Scn),
            "json" => Some(Self::Json),
            _ => None,
        }
    }
}

impl RecordFormat {
    /// By the end of the file's name.
    #[must_use]
    pub fn of(path: &Path) -> Option<Self> {
        match extension(path).as_str() {
            "csv" => Some(Self::Csv),
            "jsonl" => Some(Self::Jsonl),
            "ply" => Some(Self::Ply),
            "xyz" => Some(Self::Xyz),
            _ => None,
        }
    }
}

/// The lower-case end of a file's name.
pub(crate) fn extension(path: &Path) -> String {
    path.extension().unwrap_or_default().to_string_lossy().to_ascii_lowercase()
}
