//! Formats of files, by the end of their names.

use crate::{Failure, Outcome};
use serde::Serialize;
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

/// A format of points.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PointsFormat {
    /// A table, with or without a head line.
    Csv,
    /// Point clouds and meshes, text or binary.
    Ply,
    /// Atoms, or lines of three numbers.
    Xyz,
    /// An array as NumPy saves it.
    Npy,
}

/// A format of studies.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StudyFormat {
    /// A table, one row a measurement.
    Csv,
    /// Everything, for programs.
    Json,
    /// A page for people: tables, charts, advice.
    Html,
    /// The charts alone.
    Svg,
}

/// A format of plots.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PlotFormat {
    /// A page with what there is to say.
    Html,
    /// The picture alone.
    Svg,
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

impl PointsFormat {
    /// By the end of the file's name.
    #[must_use]
    pub fn of(path: &Path) -> Option<Self> {
        match extension(path).as_str() {
            "csv" => Some(Self::Csv),
            "ply" => Some(Self::Ply),
            "xyz" => Some(Self::Xyz),
            "npy" => Some(Self::Npy),
            _ => None,
        }
    }
}

impl StudyFormat {
    /// By the end of the file's name.
    #[must_use]
    pub fn of(path: &Path) -> Option<Self> {
        match extension(path).as_str() {
            "csv" => Some(Self::Csv),
            "json" => Some(Self::Json),
            "html" => Some(Self::Html),
            "svg" => Some(Self::Svg),
            _ => None,
        }
    }
}

impl PlotFormat {
    /// By the end of the file's name.
    #[must_use]
    pub fn of(path: &Path) -> Option<Self> {
        match extension(path).as_str() {
            "html" => Some(Self::Html),
            "svg" => Some(Self::Svg),
            _ => None,
        }
    }
}

/// A table for other programs: a head line, then a line a row.
///
/// # Errors
/// If it cannot be written.
pub(crate) fn sheet<R: Serialize>(rows: impl IntoIterator<Item = R>) -> Outcome<String> {
    let fail = |error: &dyn std::fmt::Display| Failure::new(error.to_string());
    let mut writer = csv::Writer::from_writer(Vec::new());
    rows.into_iter().try_for_each(|row| writer.serialize(row)).map_err(|error| fail(&error))?;
    let bytes = writer.into_inner().map_err(|error| fail(&error))?;
    String::from_utf8(bytes).map_err(|error| fail(&error))
}

/// Everything, for programs, in lines that people can read too.
///
/// # Errors
/// If it cannot be written.
pub(crate) fn json(value: &impl Serialize) -> Outcome<String> {
    let text = serde_json::to_string_pretty(value).map_err(|error| Failure::new(error.to_string()))?;
    Ok(text + "\n")
}

/// The lower-case end of a file's name.
pub(crate) fn extension(path: &Path) -> String {
    path.extension().unwrap_or_default().to_string_lossy().to_ascii_lowercase()
}
