//! `pointmass render`: steps a scene and draws it.

use crate::cast::{Cast, Memory, Seen};
use crate::draw::{Moving, Piece, Renderer, Sink};
use crate::formats::{PictureFormat, named};
use crate::outcome::{Failure, Outcome};
use crate::progress::Progress;
use crate::stage::{moves, pictures, stage, view};
use crate::style::Style;
use crate::world::{Settings, World};
use pointmass::Time;
use std::path::PathBuf;

/// Arguments of `render`.
#[derive(Debug, clap::Args)]
pub(crate) struct Render {
    /// How the scene is run.
    #[command(flatten)]
    pub(crate) world: Settings,
    /// FILE.gif, an animation; FILE.png, the last picture; or DIR/%04d.png, all pictures
    #[arg(long, value_name = "FILE", value_parser = named::<PictureFormat>)]
    pub(crate) out: (PathBuf, PictureFormat),
    /// Width and height in pixels
    #[arg(long, value_name = "WxH", default_value = "640x480", value_parser = size)]
    pub(crate) size: (u32, u32),
    /// Pictures per second of the scene's time
    #[arg(long, value_name = "N", default_value_t = 25, value_parser = clap::value_parser!(u32).range(1..=1000))]
    pub(crate) fps: u32,
    /// Draw particles in one of the lecture's styles, not as the scene says
    #[arg(long, value_name = "NAME")]
    pub(crate) style: Option<Style>,
    /// Draw the surfaces that particles come from and vanish at as well
    #[arg(long)]
    pub(crate) show_sources: bool,
}

/// Draws a scene as the arguments say. Files are written whole, at the end, or not at all.
pub(crate) fn render(args: &Render) -> Outcome {
    let mut world = World::load(&args.world)?;
    let mut sink = Sink::create(&args.out.0, f64::from(args.fps)).map_err(Failure::new)?;
    let frame_time = 1.0 / f64::from(args.fps);
    let frames = (world.duration / frame_time + 1e-6) as u64;
    // Between two pictures lie equal steps, none longer than the step of the run.
    let substeps = ((frame_time / world.dt - 1e-6).ceil() as u64).max(1);

    world.warn_of_steps(frame_time / substeps as f64, world.duration);

    let pictures = pictures(&world.file, &args.world.scene, args.style)?;
    let renderer = |world: &World, pieces: Vec<Piece>| {
        let mut stage = stage(&world.file, &world.model, args.show_sources, world.system.time());
        stage.pictures = pictures.clone();
        stage.pieces.extend(pieces);
        Renderer::new(&stage, args.size.0, args.size.1)
    };
    let (view, dot) = view(&world.file, &world.model);
    let mut memory = Memory::new(&world.file, args.style, world.system.capacity());
    let mut cast = Cast::new(&world.model, args.style, view, dot, &mut memory);
    // What stands still is brought before the lens but once.
    let changes = moves(&world.model) || cast.has_pieces(&world.model);
    let mut still = renderer(&world, Vec::new());
    let mut progress = Progress::new(frames * substeps);
    for frame in 0..=frames {
        if frame > 0 {
            for substep in 1..=substeps {
                let elapsed = (frame - 1) as f64 + substep as f64 / substeps as f64;
                world.step_to(Time::from_seconds_f64(elapsed * frame_time));
                cast.look(&world.system, &world.model);
                progress.step(world.system.len());
            }
        }
        // Every picture remembers where things were in the one before, drawn or not.
        let Seen { dots, billboards, segments, ribbons, pieces } = cast.see(&world.system, &world.file, &world.model);
        if frame == frames || !sink.keeps_only_last() {
            if changes {
                still = renderer(&world, pieces);
            }
            let moving = Moving { dots: &dots, billboards: &billboards, segments: &segments, ribbons: &ribbons };
            sink.push(&still.frame(&moving)).map_err(Failure::new)?;
        }
    }
    sink.finish().map_err(Failure::new)
}

fn size(text: &str) -> Result<(u32, u32), String> {
    let sides = text.split_once(['x', 'X']).and_then(|(w, h)| Some((w.parse().ok()?, h.parse().ok()?)));
    match sides {
        Some((w, h)) if (1..=8192).contains(&w) && (1..=8192).contains(&h) => Ok((w, h)),
        _ => Err("expected WIDTHxHEIGHT, such as 640x480, each from 1 to 8192".into()),
    }
}
