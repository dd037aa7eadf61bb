//! `pointmass render`: steps a scene and draws it.

use crate::cast::{Cast, Memory, Seen};
use crate::formats::{PictureFormat, pictures as format};
use crate::load::name;
use crate::outcome::{Failure, Outcome, print, tell, warn};
use crate::parse::number;
use crate::progress::Progress;
use crate::show::{Blows, Show};
use crate::sight::Sight;
use crate::stage::{boxes, moves, pictures, stage, viewpoint};
use crate::style::Style;
use crate::viewpoint::{Crowd, Looking, Viewpoint};
use crate::world::{Settings, World};
use image::RgbImage;
use indicatif::DecimalBytes;
use pointmass::Time;
use pointmass::scene::{Model, SceneFile};
use pointmass_draw::{Camera, Exposure, Flipbook, Moving, Piece, Renderer, Stage, develop};
use pointmass_files::film::Sink;
use rayon::ThreadPool;
use rayon::prelude::*;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Arguments of `render`.
#[derive(Debug, clap::Args)]
pub(crate) struct Render {
    /// How the scene is run.
    #[command(flatten)]
    pub(crate) world: Settings,
    /// FILE.gif, .apng, .mp4 or .webm (these two by ffmpeg), a film; .y4m or `-`, one for other programs; FILE.png, the last
    /// picture; or DIR/%04d.png, all pictures
    #[arg(long, value_name = "FILE", value_parser = format)]
    pub(crate) out: (PathBuf, PictureFormat),
    /// Width and height in pixels, each up to 8192
    #[arg(long, value_name = "WxH", allow_hyphen_values = true, default_value = "640x480", value_parser = size)]
    pub(crate) size: (u32, u32),
    /// Pictures per second of the scene's time
    #[arg(long, value_name = "N", allow_negative_numbers = true, default_value_t = 25, value_parser = clap::value_parser!(u32).range(1..=1000))]
    pub(crate) fps: u32,
    /// From where it is seen.
    #[command(flatten)]
    pub(crate) looking: Looking,
    /// Draw particles in one of the lecture's styles, not as the scene says
    #[arg(long, value_name = "NAME")]
    pub(crate) style: Option<Style>,
    /// Draw what moves along its way of the last SECONDS before each picture, as a camera does whose shutter is open so long, at most from
    /// picture to picture; without it as the scene's camera says. Points take no longer for it; all else is drawn up to 32 times
    #[arg(long, value_name = "SECONDS", allow_hyphen_values = true, value_parser = shutter)]
    pub(crate) shutter: Option<f64>,
    /// Draw on top how it works
    #[arg(long, value_name = "WHAT,...", value_delimiter = ',')]
    pub(crate) show: Vec<Show>,
}

/// Draws a scene as the arguments say. Files are written whole, at the end, or not at all.
pub(crate) fn render(args: &Render) -> Outcome {
    let mut world = World::load(&args.world)?;
    let timing = Timing::new(&world, args.fps);
    let frames = u32::try_from(timing.frames + 1).unwrap_or(u32::MAX);
    let mut sink = Sink::create(&args.out.0, f64::from(args.fps), frames)?;
    world.warn_of_steps(timing.step(), world.duration);
    // More threads than one are the world's.
    let one = args.world.threads.filter(|&threads| threads == 1).map(pool).transpose()?;

    let fits = args.looking.needs_run(world.file.camera.is_some());
    let drawn = if sink.keeps_only_last() { 1 } else { timing.frames + 1 };
    let passes = if fits { 2 } else { 1 };
    let mut progress = Progress::of_work(passes * timing.frames * timing.substeps + drawn * timing.substeps);
    let from = world.on_threads(|world| look(args, world, &timing, &mut progress));
    let mut draw = |world: &mut World| film(args, world, &timing, &from, &mut sink, &mut progress);
    match &one {
        Some(pool) => pool.install(|| draw(&mut world))?,
        None => world.on_threads(draw)?,
    }
    let (is_read, left_out) = (!sink.is_abandoned(), sink.left_out());
    sink.finish()?;
    drop(progress);
    if !is_read {
        return Ok(());
    }
    if left_out > 0 {
        let all = "of a GIF shows at most 50; .apng, .mp4 and numbered pictures have all of them";
        warn(&[format!("--fps {}: {left_out} of {drawn} pictures are left out: a second {all}", args.fps)]);
    }
    say(args, drawn, drawn - left_out)
}

/// When there are pictures.
#[derive(Clone, Copy, Debug)]
struct Timing {
    /// Seconds between two pictures.
    frame_time: f64,
    /// How many there are after the first.
    frames: u64,
    /// Between two pictures lie equal steps, none longer than the step of the run.
    substeps: u64,
}

impl Timing {
    fn new(world: &World, fps: u32) -> Self {
        let frame_time = 1.0 / f64::from(fps);
        let frames = (world.duration / frame_time + 1e-6) as u64;
        let substeps = ((frame_time / world.dt - 1e-6).ceil() as u64).max(1);
        Self { frame_time, frames, substeps }
    }

    /// The length of a step \[s\].
    fn step(&self) -> f64 {
        self.frame_time / self.substeps as f64
    }

    /// Steps from the picture before to picture `frame`, if there is one before, and notes the blows if they are to be shown.
    fn step_to(
        &self,
        frame: u64,
        world: &mut World,
        progress: &mut Progress,
        mut blows: Option<&mut Blows>,
        mut look_on: impl FnMut(&World),
    ) {
        for substep in 1..=self.substeps {
            if frame > 0 {
                let elapsed = (frame - 1) as f64 + substep as f64 / self.substeps as f64;
                let end = Time::from_seconds_f64(elapsed * self.frame_time);
                match &mut blows {
                    Some(blows) => world.step_observed(end, *blows),
                    None => world.step_to(end),
                };
                look_on(world);
                progress.step(world.system.len());
            }
        }
    }

    /// How long the shutter is open \[s\], if there is one.
    fn shutter(&self, args: &Render, world: &World) -> Option<f64> {
        let own = || world.file.camera.as_ref().and_then(|camera| camera.shutter).map(f64::from);
        let asked = args.shutter.or_else(own)?;
        // A scene's own is as long as the film lets it be.
        if asked > self.frame_time && args.shutter.is_some() {
            let frame_time = self.frame_time;
            let open = format!("pictures lie {frame_time} s apart, and it is open so long for each");
            warn(&[format!("the shutter of {asked} s: {open}")]);
        }
        Some(asked.min(self.frame_time))
    }

    /// The part of the film that is over at a picture.
    fn part(&self, frame: u64) -> f64 {
        frame as f64 / self.frames.max(1) as f64
    }
}

/// From where the film is seen; where that depends on the run, runs it.
fn look(args: &Render, world: &mut World, timing: &Timing, progress: &mut Progress) -> Viewpoint {
    let from = viewpoint(&world.file, &world.model);
    if let Some(seat) = args.looking.camera {
        return from.from(seat);
    }
    if !args.looking.needs_run(world.file.camera.is_some()) {
        return from;
    }
    let begin = (world.system.clone(), world.pace.clone());
    let mut crowd = Crowd::new();
    for frame in 0..=timing.frames {
        timing.step_to(frame, world, progress, None, |_| ());
        crowd.meet(&world.system, &world.model.particles, world.file.particles.len());
    }
    (world.system, world.pace) = begin;
    let aspect = args.size.0 as f32 / args.size.1 as f32;
    crowd.view(from.camera, &boxes(&world.model), aspect, args.looking.orbit.is_some())
}

/// Runs and draws the whole film. While some pictures are drawn, those before are written.
fn film(
    args: &Render,
    world: &mut World,
    timing: &Timing,
    from: &Viewpoint,
    sink: &mut Sink,
    progress: &mut Progress,
) -> Outcome {
    let mut memory = Memory::new(&world.file, args.style, world.system.capacity());
    let shutter = timing.shutter(args, world);
    let mut cast = Cast::new(&world.model, args.style, &args.show, shutter, from, &mut memory);
    ensure(args.size, 1, 1)?;
    let studio = Studio::new(args, world, from, &cast)?;
    let mut sight = Sight::new(args.size);
    let mut blows = args.show.contains(&Show::Contacts).then(Blows::default);
    let (mut shots, mut drawn) = (Vec::new(), Vec::new());
    for frame in 0..=timing.frames {
        cast.wait_for(frame as f64 * timing.frame_time);
        let remember = |world: &World| cast.remember(&world.system, &world.model);
        timing.step_to(frame, world, progress, blows.as_mut(), remember);
        let camera = from.turned(args.looking.orbit.unwrap_or(0.0) * timing.part(frame));
        cast.look(&camera);
        // Every picture remembers where things were in the one before, drawn or not.
        let mut seen = cast.see(&world.system, &world.file, &world.model, args.size.0);
        if let Some(blows) = &mut blows {
            let lines = blows.lines(&world.system, &world.model, cast.arrow(), timing.frame_time as f32);
            seen.iter_mut().for_each(|seen| seen.segments.extend_from_slice(&lines));
        }
        if frame < timing.frames && sink.keeps_only_last() {
            continue;
        }
        sight.note(&camera, &seen);
        shots.push(Shot { camera, seen });
        if shots.len() == studio.batch || frame == timing.frames {
            ensure(args.size, shots.len(), shots.iter().map(|shot| shot.seen.len()).sum())?;
            let draw = || shots.par_iter().map(|shot| studio.draw(shot)).collect();
            let (next, written) = rayon::join(draw, || write(&drawn, sink));
            written?;
            if sink.is_abandoned() {
                return Ok(());
            }
            progress.advance(shots.len() as u64 * timing.substeps, || format!("{} particles", world.system.len()));
            drawn = next;
            shots.clear();
        }
    }
    let beyond = sight.warning(&from.camera, || stage(&world.file, &world.model, &args.show, world.system.time()));
    warn(beyond.map(|text| format!("{}:{text}", name(&args.world.scene))).as_slice());
    write(&drawn, sink)
}

/// Makes sure that there is memory for some pictures, which are the means of some exposures.
fn ensure((width, height): (u32, u32), pictures: usize, exposures: usize) -> Outcome {
    /// The bytes that a pixel takes of a picture, of an exposure that is kept, and of one in the making with what is behind it.
    const PICTURE: usize = 24;
    const KEPT: usize = 12;
    const MAKING: usize = 80;
    let making = MAKING * exposures.min(rayon::current_num_threads());
    let bytes = (PICTURE * pictures + KEPT * exposures + making) * width as usize * height as usize;
    match Vec::<u8>::new().try_reserve_exact(bytes) {
        Ok(()) => Ok(()),
        Err(_) => {
            let needed = DecimalBytes(bytes as u64);
            Err(Failure::new(format!("--size {width}x{height}: there is no memory for such pictures, about {needed}")))
        }
    }
}

fn write(pictures: &[RgbImage], sink: &mut Sink) -> Outcome {
    pictures.iter().try_for_each(|picture| sink.push(picture))
}

/// The moving things at the instants that a picture is the mean of, and from where they are seen.
struct Shot {
    camera: Camera,
    seen: Vec<Seen>,
}

/// Everything that pictures have in common.
struct Studio {
    file: SceneFile,
    model: Model,
    pictures: Arc<[Flipbook]>,
    size: (u32, u32),
    show: Vec<Show>,
    /// True if particles are drawn along their ways.
    exposed: bool,
    /// The scenery, brought before the lens but once, if that stands still as well.
    still: Option<Renderer>,
    /// How many pictures are drawn side by side.
    batch: usize,
}

impl Studio {
    fn new(args: &Render, world: &World, from: &Viewpoint, cast: &Cast<'_>) -> Outcome<Self> {
        /// How many pixels are in the making at once, so that large pictures do not need all memory.
        const PIXELS: usize = 1 << 24;
        let World { file, model, .. } = world;
        let batch = (PIXELS / (args.size.0 as usize * args.size.1 as usize)).clamp(1, rayon::current_num_threads());
        let mut studio = Self {
            pictures: pictures(file, &args.world.scene, args.style)?,
            file: file.clone(),
            model: model.clone(),
            size: args.size,
            show: args.show.clone(),
            exposed: cast.is_exposed(),
            still: None,
            batch,
        };
        if !moves(model) && !cast.has_pieces(model) && args.looking.orbit.is_none() {
            studio.still = Some(studio.renderer(world.system.time(), from.camera, &[]));
        }
        Ok(studio)
    }

    /// The scenery at an instant, with what else is solid, seen by a camera.
    fn renderer(&self, instant: Time, camera: Camera, pieces: &[Piece]) -> Renderer {
        let mut stage = stage(&self.file, &self.model, &self.show, instant);
        stage.pieces.extend_from_slice(pieces);
        let stage = Stage { camera, pictures: self.pictures.clone(), ..stage };
        Renderer::new(&stage, self.size.0, self.size.1)
    }

    fn draw(&self, shot: &Shot) -> RgbImage {
        let exposures: Vec<_> = shot.seen.par_iter().map(|seen| self.expose(seen, shot.camera)).collect();
        develop(&exposures)
    }

    fn expose(&self, seen: &Seen, camera: Camera) -> Exposure {
        let Seen { instant, dots, billboards, segments, ribbons, pieces } = seen;
        let moving = Moving { exposed: self.exposed, dots, billboards, segments, ribbons };
        match &self.still {
            Some(renderer) => renderer.expose(&moving),
            None => self.renderer(*instant, camera, pieces).expose(&moving),
        }
    }
}

/// As many threads as were asked for.
fn pool(threads: u16) -> Outcome<ThreadPool> {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads.into()).build();
    pool.map_err(|error| Failure::new(format!("--threads {threads}: {error}")))
}

/// Says what was written, on standard output unless that is where the film went.
fn say(args: &Render, drawn: u64, pictures: u64) -> Outcome {
    let ((path, _), (width, height)) = (&args.out, args.size);
    let what = match pictures {
        1 => format!("one picture of {width} x {height} pixels"),
        _ => {
            let seconds = drawn as f64 / f64::from(args.fps);
            format!("{pictures} pictures of {width} x {height} pixels, {seconds:.2} s")
        }
    };
    if path == Path::new("-") {
        tell("written", &what);
        return Ok(());
    }
    let bytes = fs::metadata(path).ok().filter(fs::Metadata::is_file);
    let bytes = bytes.map_or(String::new(), |facts| format!(", {}", DecimalBytes(facts.len())));
    print(&format!("{}: {what}{bytes}\n", path.display()))
}

fn shutter(text: &str) -> Result<f64, String> {
    let seconds = number(text)?;
    if seconds >= 0.0 && seconds.is_finite() { Ok(seconds) } else { Err("expected seconds, zero or more".into()) }
}

fn size(text: &str) -> Result<(u32, u32), String> {
    let sides = text.split_once(['x', 'X']).and_then(|(w, h)| Some((w.parse().ok()?, h.parse().ok()?)));
    match sides {
        Some((w, h)) if (1..=8192).contains(&w) && (1..=8192).contains(&h) => Ok((w, h)),
        _ => Err("expected WIDTHxHEIGHT, such as 640x480, each from 1 to 8192".into()),
    }
}
