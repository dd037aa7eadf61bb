//! `pointmass render`: steps a scene and draws it.

use crate::draw::{Renderer, Sink};
use crate::progress::Progress;
use crate::stage::{Cast, moves, stage};
use crate::world::World;
use crate::{Failure, Outcome, args};
use pointmass::Time;

/// Draws a scene as the arguments say. Files are written whole, at the end, or not at all.
///
/// # Errors
/// If the scene cannot be used or a file cannot be written.
pub fn render(args: &args::Render) -> Outcome {
    let mut world = World::load(&args.world)?;
    let mut sink = Sink::create(&args.out, f64::from(args.fps)).map_err(Failure::new)?;
    let frame_time = 1.0 / f64::from(args.fps);
    let frames = (world.duration / frame_time + 1e-6) as u64;
    // Between two pictures lie equal steps, none longer than the step of the run.
    let substeps = ((frame_time / world.dt - 1e-6).ceil() as u64).max(1);

    world.warn_of_steps(frame_time / substeps as f64, world.duration);

    let renderer = |world: &World| {
        let stage = stage(&world.file, &world.model, args.show_sources, world.system.time());
        Renderer::new(&stage, args.size.0, args.size.1)
    };
    // What stands still is brought before the lens but once.
    let (moves, mut seen) = (moves(&world.model), renderer(&world));
    let mut cast = Cast::new(&world.file, &world.model);
    let mut progress = Progress::new(frames * substeps);
    for frame in 0..=frames {
        if frame > 0 {
            for substep in 1..=substeps {
                let elapsed = (frame - 1) as f64 + substep as f64 / substeps as f64;
                world.step_to(Time::from_seconds_f64(elapsed * frame_time));
                progress.step(world.system.len());
            }
        }
        // Every picture remembers where things were in the one before, drawn or not.
        let dots = cast.dots(&world);
        if frame == frames || !sink.keeps_only_last() {
            if moves {
                seen = renderer(&world);
            }
            sink.push(&seen.frame(&dots, &Cast::segments(&world))).map_err(Failure::new)?;
        }
    }
    progress.finish();
    sink.finish().map_err(Failure::new)
}
