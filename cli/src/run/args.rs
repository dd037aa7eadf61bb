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
    /// Record every K-th step (step 0 and the last always); by default every one
    #[arg(long, value_name = "K", allow_negative_numbers = true, value_parser = positive)]
    pub(crate) every: Option<u64>,
    /// Record into FILE: .csv, .jsonl, .xyz, .npz, .glb or .gltf; or .npy, .ply, .obj or .vtp for one file a record, as
    /// every name with a place for a number has it, such as DIR/%04d.csv. Or into -, standard output, at the end; what
    /// happened is told on standard error then. May be given several times
    #[arg(long, value_name = "FILE", value_parser = recording)]
    pub(crate) out: Vec<(PathBuf, Option<RecordFormat>)>,
    /// The format of --out -; by default csv
    #[arg(long, value_enum, value_name = "FORMAT")]
    pub(crate) format: Option<RecordFormat>,
    /// What a line of .jsonl holds; by default a particle
    #[arg(long, value_enum, value_name = "WHAT")]
    pub(crate) line: Option<Line>,
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

impl Run {
    /// The format of a recording; standard output has one of its own.
    pub(super) fn format(&self, out: &(PathBuf, Option<RecordFormat>)) -> RecordFormat {
        out.1.or(self.format).unwrap_or(RecordFormat::Csv)
    }

    /// Options on recording that it was given and has no use for, each in words.
    pub(super) fn idle(&self) -> Vec<String> {
        let is_standard = |(_, format): &(PathBuf, Option<RecordFormat>)| format.is_none();
        let has_lines = |out: &(PathBuf, Option<RecordFormat>)| matches!(self.format(out), RecordFormat::Jsonl);
        let options = [
            ("--every", self.every.is_none() || !self.out.is_empty(), "add --out FILE"),
            ("--format", self.format.is_none() || self.out.iter().any(is_standard), "it is that of --out -"),
            ("--line", self.line.is_none() || self.out.iter().any(has_lines), "it is for an --out of .jsonl"),
        ];
        let idle = options.into_iter().filter(|(_, is_used, _)| !is_used);
        idle.map(|(option, _, why)| format!("{option} does nothing: {why}")).collect()
    }
}
