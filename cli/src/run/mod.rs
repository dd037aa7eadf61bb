//! `pointmass run`: steps a scene, records it, reports.

mod args;
mod groups;
mod recordings;
mod summary;

use crate::formats::{Said, line};
use crate::outcome::{Outcome, mention, print, warn};
use crate::progress::Progress;
use crate::schedule::Schedule;
use crate::stall;
use crate::world::World;
pub(crate) use args::Run;
use pointmass::Ledger;
use pointmass_files::whole::is_standard;
use recordings::Recordings;
use std::time::Instant;
use summary::{Effort, Summary};

/// Runs a scene as the arguments say. Files are written whole, at the end, or not at all.
pub(crate) fn run(args: &Run) -> Outcome {
    recordings::keep_apart(args)?;
    let mut world = World::load(&args.world)?;
    let schedule = match args.steps {
        Some(steps) => Schedule::steps_of(steps, world.dt),
        None => Schedule::new(world.duration, world.dt),
    };
    // A run shorter than a step is one step as long as itself.
    world.warn_of_steps(
        if schedule.steps() == 1 { schedule.last() } else { world.dt },
        schedule.end(schedule.steps()).seconds_f64(),
    );
    warn(&args.idle());
    if args.group_error && !groups::are_taken(&world) {
        warn(&["--group-error does nothing: no force takes far groups as one, by a theta above 0".into()]);
    }
    let mut recordings = Recordings::create(args, &world)?;
    // Of its own, since stepping borrows the world.
    let model = world.model.clone();
    let mut ledger = args.ledger.then(|| Ledger::new(&world.system, &model.scene()));
    let mut effort = Effort::default();
    recordings.record(0, &world)?;
    let every = args.every.unwrap_or(1);
    world.on_threads(|world| go(world, &schedule, every, &mut recordings, ledger.as_mut(), &mut effort))?;
    // How many sub-steps particles have made, those of each step being as many on average.
    let substeps = effort.particle_steps as f64 * world.pace.told().total as f64 / (effort.steps as f64).max(1.0);
    warn(stall::told(world.system.totals(), substeps).as_slice());

    let mut summary = Summary::of(&args.world.scene, &world, schedule.last(), effort);
    summary.group_errors = args.group_error.then(|| groups::errors(&world));
    summary.ledger = ledger.map(|ledger| ledger.books().clone());
    recordings.finish()?;
    let said = match args.report {
        Said::Text => summary.text(),
        Said::Json => line(&summary)?,
    };
    if args.out.iter().any(|(path, _)| is_standard(path)) {
        mention(&said);
        return Ok(());
    }
    print(&said)
}

/// Steps and records, to the end.
fn go(
    world: &mut World,
    schedule: &Schedule,
    every: u64,
    recordings: &mut Recordings,
    mut ledger: Option<&mut Ledger>,
    effort: &mut Effort,
) -> Outcome {
    let mut progress = Progress::new(schedule.steps());
    for step in 1..=schedule.steps() {
        let begun = Instant::now();
        let end = schedule.end(step);
        match (ledger.as_deref_mut(), recordings.notes()) {
            (Some(ledger), Some(notes)) => world.step_observed(end, &mut (ledger, notes)),
            (Some(ledger), None) => world.step_observed(end, ledger),
            (None, Some(notes)) => world.step_observed(end, notes),
            (None, None) => world.step_to(end),
        };
        effort.seconds += begun.elapsed().as_secs_f64();
        effort.steps = step;
        effort.particle_steps += world.system.len() as u64;
        if step % every == 0 || step == schedule.steps() {
            recordings.record(step, world)?;
        }
        recordings.happened(step)?;
        progress.step(world.system.len());
    }
    Ok(())
}
