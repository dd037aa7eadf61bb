//! The files that a run was asked for: its states, and what happened in it.

use super::args::Run;
use crate::formats::{Line, RecordFormat};
use crate::load::{Disk, name};
use crate::outcome::Outcome;
use crate::world::World;
use pointmass_files::record::{Chronicle, Frame, Notes, Plan, Recorder};
use pointmass_files::whole::{self, publish};
use std::path::PathBuf;

/// The recordings of a run, in the making. Dropped, they are gone.
pub(super) struct Recordings {
    /// The contents of states, if they are asked for.
    plan: Option<Plan>,
    recorders: Vec<Recorder>,
    chronicle: Option<Chronicle>,
}

/// Refuses recordings that would take each other's place.
pub(super) fn keep_apart(args: &Run) -> Outcome {
    let outs = args.out.iter().map(|out| ("--out", Recorder::first(&out.0, args.format(out))));
    whole::keep_apart(outs.chain(args.events.iter().map(|(path, _)| ("--events", path.clone()))))
}

impl Recordings {
    /// Begins all of them.
    pub(super) fn create(args: &Run, world: &World) -> Outcome<Self> {
        let recorder = |out: &(PathBuf, Option<RecordFormat>)| match args.format(out) {
            RecordFormat::Jsonl if args.line == Some(Line::Record) => Recorder::create(&out.0, RecordFormat::Frames),
            format => Recorder::create(&out.0, format),
        };
        let plan = || Plan::of(&world.file, &world.model, &name(&args.world.scene), &mut Disk);
        let plan = (!args.out.is_empty()).then(plan).transpose()?;
        let chronicle = args.events.as_ref().map(|(path, format)| Chronicle::create(path, *format)).transpose()?;
        Ok(Self { plan, recorders: args.out.iter().map(recorder).collect::<Outcome<_>>()?, chronicle })
    }

    /// Takes the state after a step.
    pub(super) fn record(&mut self, step: u64, world: &World) -> Outcome {
        let Some(plan) = &self.plan else { return Ok(()) };
        let frame = Frame::of(step, &world.system, &world.model.scene(), plan);
        self.recorders.iter_mut().try_for_each(|recorder| recorder.record(&frame))
    }

    /// Who notes what happens in a step, if that was asked.
    pub(super) fn notes(&mut self) -> Option<&mut Notes> {
        self.chronicle.as_mut().map(|chronicle| &mut chronicle.notes)
    }

    /// Takes what was noted in a step.
    pub(super) fn happened(&mut self, step: u64) -> Outcome {
        self.chronicle.as_mut().map_or(Ok(()), |chronicle| chronicle.write(step))
    }

    /// Puts all files where they belong, or none of them.
    pub(super) fn finish(self) -> Outcome {
        let states = self.recorders.into_iter().map(Recorder::close).collect::<Outcome<Vec<_>>>()?;
        let events = self.chronicle.map(Chronicle::close).transpose()?;
        publish(&states.into_iter().flatten().chain(events).collect::<Vec<_>>())
    }
}
