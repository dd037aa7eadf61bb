//! Arguments of `pointmass run`.

use crate::formats::{EventsFormat, Line, RecordFormat, Said, events, recording};
use crate::parse::{natural, positive};
use crate::world::Settings;
use std::path::PathBuf;

/// Arguments of `run`.
#[derive(Debug, clap::Args)]
pub(crate) struct Run {
    /// How the scene is run.
    #[command(flatten)]
    pub(crate) world: Settings,
    /// How many steps, instead of a duration
    #[arg(long, value_name = "N", allow_negative_numbers = true, conflicts_with = "duration", value_parser = natural)]
    pub(crate) steps: Option<u64>,
    /// Record every K-th step (step 0 and the last always)
    #[arg(long, value_name = "K", allow_negative_numbers = true, default_value_t = 1, value_parser = positive)]
    pub(crate) every: u64,
    /// Record into FILE: .csv, .jsonl, .xyz, .npz, .glb or .gltf; or .npy, .ply, .obj or .vtp for one file a record, as
    /// every name with a place for a number has it, such as DIR/%04d.csv. Or into -, standard output, at the end; what
    /// happened is told on standard error then. May be given several times
    #[arg(long, value_name = "FILE", value_parser = recording)]
    pub(crate) out: Vec<(PathBuf, Option<RecordFormat>)>,
    /// The format of --out -
    #[arg(long, value_enum, value_name = "FORMAT", default_value_t = RecordFormat::Csv)]
    pub(crate) format: RecordFormat,
    /// What a line of .jsonl holds
    #[arg(long, value_enum, value_name = "WHAT", default_value_t = Line::Particle)]
    pub(crate) line: Line,
    /// Record births, hits, touches and deaths, one a line, into FILE: .csv or .jsonl
    #[arg(long, value_name = "FILE", value_parser = events)]
    pub(crate) events: Option<(PathBuf, EventsFormat)>,
    /// Keep account of energy and say where it went
    #[arg(long)]
    pub(crate) ledger: bool,
    /// Hold forces that take far groups as one (by their theta) against the sums over all pairs, at the end and at about a
    /// thousand particles
    #[arg(long)]
    pub(crate) group_error: bool,
    /// How to say on standard output what happened
    #[arg(long, value_enum, default_value_t = Said::Text)]
    pub(crate) report: Said,
}
