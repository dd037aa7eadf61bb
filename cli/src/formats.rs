//! Formats of files, by the end of their names, and of what is said on standard output.

use crate::outcome::{Failure, Outcome};
use clap::ValueEnum;
pub(crate) use pointmass_files::formats::{EventsFormat, PointsFormat, RecordFormat};
use pointmass_files::pattern::Pattern;
use pointmass_files::whole::STANDARD;
use serde::Serialize;
use std::path::{Path, PathBuf};

/// A format of scenes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum SceneFormat {
    /// The course's.
    Scn,
    /// Ours.
    Json,
}

/// The unit that a line of `.jsonl` holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum Line {
    /// A particle in a record
    Particle,
    /// A record, with a list for each column
    Record,
}

/// A format of pictures.
#[derive(Clone, Copy, Debug, ValueEnum)]
pub(crate) enum PictureFormat {
    /// An animation in few colours.
    Gif,
    /// An animation in all colours.
    Apng,
    /// A video, by ffmpeg.
    Mp4,
    /// Another, by ffmpeg.
    Webm,
    /// A film for other programs.
    Y4m,
    /// A picture, or one of many.
    Png,
}

/// A format of studies.
#[derive(Clone, Copy, Debug, ValueEnum)]
pub(crate) enum StudyFormat {
    /// A page for people: tables, charts, advice.
    Html,
    /// The charts alone.
    Svg,
    /// A table, one row a measurement.
    Csv,
    /// Everything, for programs.
    Json,
}

/// How to say on standard output what there is to say.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum Said {
    /// For people
    Text,
    /// One JSON object
    Json,
}

/// A format by the end of a file's name.
pub(crate) fn format_of<F: ValueEnum>(path: &Path) -> Option<F> {
    F::from_str(&path.extension()?.to_string_lossy(), true).ok()
}

/// A file of the command line with the format that its name ends in.
pub(crate) fn named<F: ValueEnum>(text: &str) -> Result<(PathBuf, F), String> {
    let path = PathBuf::from(text);
    match format_of(&path) {
        Some(format) => Ok((path, format)),
        None => {
            let known = F::value_variants().iter().filter_map(ValueEnum::to_possible_value);
            let known: Vec<_> = known.map(|value| format!(".{}", value.get_name())).collect();
            let (last, others) = known.split_last().ok_or("no format is known")?;
            Err(format!("expected a name that ends in {} or {last}", others.join(", ")))
        }
    }
}

/// A file for pictures, or `-` for standard output.
pub(crate) fn pictures(text: &str) -> Result<(PathBuf, PictureFormat), String> {
    if text == STANDARD {
        return Ok((PathBuf::from(text), PictureFormat::Y4m));
    }
    let (path, format) = named(text)?;
    match Pattern::parse(&path)? {
        Some(_) if !matches!(format, PictureFormat::Png) => Err("numbered pictures end in .png".into()),
        _ => Ok((path, format)),
    }
}

/// A recording's file with the format that its name ends in; `-` is standard output, in a format of its own.
pub(crate) fn recording(text: &str) -> Result<(PathBuf, Option<RecordFormat>), String> {
    if text == STANDARD {
        return Ok((text.into(), None));
    }
    let (path, format) = named(text)?;
    Pattern::parse(&path)?;
    Ok((path, Some(format)))
}

/// A file of events, which is one.
pub(crate) fn events(text: &str) -> Result<(PathBuf, EventsFormat), String> {
    let (path, format) = named(text)?;
    match Pattern::parse(&path)? {
        Some(_) => Err("events are one file; name it without a place for a number".into()),
        None => Ok((path, format)),
    }
}

/// Everything as one line of JSON, in which numbers that are not finite are null.
pub(crate) fn line(value: &impl Serialize) -> Outcome<String> {
    written(serde_json::to_string(value))
}

/// The same in lines that people can read too.
pub(crate) fn json(value: &impl Serialize) -> Outcome<String> {
    written(serde_json::to_string_pretty(value))
}

fn written(text: serde_json::Result<String>) -> Outcome<String> {
    text.map(|text| text + "\n").map_err(|error| Failure::new(error.to_string()))
}
