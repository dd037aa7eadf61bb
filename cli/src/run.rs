//! `pointmass run`: steps a scene, records it, reports.

use crate::args::{self, Report};
use crate::groups;
use crate::progress::Progress;
use crate::record::{Frame, Recorder};
use crate::report::{Effort, Summary};
use crate::schedule::Schedule;
use crate::world::World;
use crate::{Outcome, print, stall, warn};
use pointmass::Ledger;
use std::time::Instant;

/// Runs a scene as the arguments say. Files are written whole, at the end, or not at all.
///
/// # Errors
/// If the scene cannot be used or a file cannot be written.
pub fn run(args: &args::Run) -> Outcome {
    let mut world = World::load(&args.world)?;
    let schedule = match args.steps {
        Some(steps) => Schedule::steps_of(steps, world.dt),
        None => Schedule::new(world.duration, world.dt),
    };
    world.warn_of_steps(world.dt, schedule.end(schedule.steps()).seconds_f64());
    let mut recorders =
        args.out.iter().map(|(path, format)| Recorder::create(path, *format)).collect::<Outcome<Vec<_>>>()?;
    let mut record = |step: u64, world: &World| {
        if recorders.is_empty() {
            return Ok(());
        }
        let frame = Frame::of(step, &world.system, &world.model.scene(), world.model.has_balls());
        recorders.iter_mut().try_for_each(|recorder| recorder.record(&frame))
    };

    // Of its own, since stepping borrows the world.
    let model = world.model.clone();
    let mut ledger = args.ledger.then(|| Ledger::new(&world.system, &model.scene()));
    let mut effort = Effort::default();
    let mut progress = Progress::new(schedule.steps());
    record(0, &world)?;
    for step in 1..=schedule.steps() {
        let begun = Instant::now();
        match &mut ledger {
            Some(ledger) => world.step_observed(schedule.end(step), ledger),
            None => world.step_to(schedule.end(step)),
        };
        effort.seconds += begun.elapsed().as_secs_f64();
        effort.steps = step;
        effort.particle_steps += world.system.len() as u64;
        if step % args.every == 0 || step == schedule.steps() {
            record(step, &world)?;
        }
        progress.step(world.system.len());
    }
    progress.finish();
    // How many sub-steps particles have made, those of each step being as many on average.
    let substeps = effort.particle_steps as f64 * world.pace.told().total as f64 / (effort.steps as f64).max(1.0);
    warn(stall::told(world.system.totals(), substeps).as_slice());

    let mut summary = Summary::of(&args.world.scene, &world, effort);
    summary.group_errors = args.group_error.then(|| groups::errors(&world));
    summary.ledger = ledger.map(|ledger| ledger.books().clone());
    Recorder::finish(recorders)?;
    match args.report {
        Report::Text => print(&summary.text()),
        Report::Json => print(&summary.json()),
    }
}
