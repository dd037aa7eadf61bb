//! A scene in motion: the system, the scene it steps through, and the settings of the run.

use crate::check::Bounds;
use crate::load::{self, Reading};
use crate::outcome::{Failure, Outcome, warn};
use crate::parse::{natural, number, seconds, step};
use crate::stage::size;
use crate::stall;
use crate::substeps::{Pace, Substeps};
use pointmass::scene::{Model, SceneFile};
use pointmass::stability::Limit;
use pointmass::{Heap, Method, Observer, Report, Response, System, Time, index, rays};
use rayon::ThreadPool;
use std::path::{Path, PathBuf};

/// The tolerance of sub-steps that nobody gave, in parts of the scene's size.
const TOLERANCE: f64 = 1e-4;

/// The arguments of a command that runs a scene.
#[derive(Debug, Default, clap::Args)]
pub(crate) struct Settings {
    /// The scene: .json or .scn, or - for standard input
    pub(crate) scene: PathBuf,
    /// How the scene is read.
    #[command(flatten)]
    pub(crate) reading: Reading,
    /// How many seconds; by default what the scene says, 10 for .scn
    #[arg(long, value_name = "S", allow_hyphen_values = true, value_parser = seconds)]
    pub(crate) duration: Option<f64>,
    /// The step in seconds, such as 0.001 or 1/60; by default what the scene says, 1/60 for .scn
    #[arg(long, value_name = "S", allow_hyphen_values = true, value_parser = step)]
    pub(crate) dt: Option<f64>,
    /// The method: euler, symplectic, midpoint, lecture_midpoint, verlet, rk4, adaptive, embedded or implicit; by default
    /// what the scene says, rk4 for .scn
    #[arg(long, value_name = "NAME")]
    pub(crate) integrator: Option<Method>,
    /// How forces between neighbours find them: brute, grid, hash, quadtree, octree, kd, bsp or bvh; by default what the
    /// scene says, else grid. They end in the same bits by all of them
    #[arg(long, value_name = "NAME")]
    pub(crate) index: Option<index::Structure>,
    /// How particles that have a radius answer each other: impulse, force or position; by default what the scene says,
    /// else they pass through each other
    #[arg(long, value_name = "NAME", value_parser = clap::builder::PossibleValuesParser::new(Response::NAMES))]
    pub(crate) response: Option<String>,
    /// How paths find what they run into among the triangles of a mesh: brute, grid, octree, kd, bsp or bvh, all to the
    /// same end; by default what the scene says, else bvh
    #[arg(long, value_name = "NAME")]
    pub(crate) collision_index: Option<rays::Structure>,
    /// The seed of all randomness; by default what the scene says, else 1
    #[arg(long, value_name = "N", allow_negative_numbers = true, value_parser = natural)]
    pub(crate) seed: Option<u64>,
    /// How many particles may live at once, what finds no room is refused and counted; by default what the scene says
    #[arg(long, value_name = "N", allow_negative_numbers = true, value_parser = clap::value_parser!(u32).range(..=500_000_000))]
    pub(crate) capacity: Option<u32>,
    /// Divide every step into N, each of which is cut into the sub-steps that the scene has of its own as well (`run.substeps`, or those of contacts by
    /// position): with 4 here and 12 there it has 48. Or `auto`: into as few as springs, drag and contacts need to be stable, constraints to be met
    /// within 1 % and --tolerance asks, at most 1024
    #[arg(long, value_name = "N|auto", allow_negative_numbers = true, default_value = "1")]
    pub(crate) substeps: Substeps,
    /// With --substeps auto, how far a step may end, in metres and at any particle, from where half as many sub-steps
    /// would take it; by default 1e-4 of the radius of what is there at the start. With adaptive and embedded, how far an
    /// inner step may err; by default what the scene says, 1e-4
    #[arg(long, value_name = "M", allow_hyphen_values = true, value_parser = tolerance)]
    pub(crate) tolerance: Option<f64>,
    /// On how many threads many particles are stepped, to the same bits: whole steps where they have nothing to do with each
    /// other, else the sums of their forces; and pictures drawn, to the same bits too; by default as many as the machine has
    #[arg(long, value_name = "N", allow_negative_numbers = true, value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub(crate) threads: Option<u16>,
}

impl Settings {
    /// A scene as it says itself, in steps that are not divided and on one thread.
    pub(crate) fn of(scene: &Path, reading: Reading) -> Self {
        Self { scene: scene.to_path_buf(), reading, threads: Some(1), ..Self::default() }
    }

    /// The step that is made of the scene's own: what is said of it, divided as is said \[s\].
    fn step(&self, declared: f64) -> f64 {
        let parts = if let Substeps::Fixed(parts) = self.substeps { f64::from(parts) } else { 1.0 };
        self.dt.unwrap_or(declared) / parts
    }
}

fn tolerance(text: &str) -> Result<f64, String> {
    let value = number(text)?;
    // Integrators keep it as a 32-bit float.
    if (1e-30..=1e30).contains(&value) { Ok(value) } else { Err("expected metres, from 1e-30 to 1e30".into()) }
}

/// A scene made ready and the system it is done to.
#[derive(Debug)]
pub(crate) struct World {
    /// The name of the scene's file.
    name: String,
    /// The scene as the file says it.
    pub(crate) file: SceneFile,
    /// The scene.
    pub(crate) model: Model,
    /// The state.
    pub(crate) system: System<Heap>,
    /// How it is run: the file's settings with those of the command line laid over.
    pub(crate) duration: f64,
    /// The step \[s\].
    pub(crate) dt: f64,
    /// How steps are divided.
    pub(crate) pace: Pace,
    /// The threads that steps run on, if there are more than this one.
    threads: Option<ThreadPool>,
}

/// Particles from which on more than one thread is of use.
const WORTH_THREADS: usize = 4096;

impl World {
    /// Loads the scene and puts in what it begins with.
    pub(crate) fn load(args: &Settings) -> Outcome<Self> {
        let (mut file, source) = load::scene_with(&args.scene, args.reading.unknown(), |dt| args.step(dt))?;
        let run = &mut file.run;
        run.integrator = args.integrator.unwrap_or(run.integrator);
        if let Some(tolerance) = args.tolerance.filter(|_| run.integrator.chooses_steps()) {
            run.tuning.tolerance = tolerance as f32;
        }
        if args.tolerance.is_some() && !run.integrator.chooses_steps() && args.substeps != Substeps::Auto {
            let method = run.integrator;
            warn(&[format!("--tolerance does nothing with {method} in steps that are given: add --substeps auto")]);
        }
        run.index = args.index.unwrap_or(run.index);
        run.collision_index = args.collision_index.unwrap_or(run.collision_index);
        run.seed = args.seed.unwrap_or(run.seed);
        let (duration, dt, seed) = (args.duration.unwrap_or(run.duration), args.dt.unwrap_or(run.dt), run.seed);
        if let Some(name) = args.response.as_deref() {
            answer(&mut file, name, dt);
        }
        let model = source.model(&file)?;
        if !model.has_balls() && file.contacts.is_some() {
            let said = if args.response.is_some() { "--response" } else { "contacts" };
            warn(&[format!("{said} does nothing: no particle of the scene has a radius")]);
        }
        let particles = model.particles.len();
        let capacity = match args.capacity {
            Some(capacity) => capacity as usize,
            // Where nobody is born, more room would lie empty, and be copied about by sub-steps.
            None if file.emitters.is_empty() && args.substeps == Substeps::Auto => particles,
            None => particles.max(file.run.capacity as usize),
        };
        // Nobody is put in here but by the scene.
        let memory = Heap::alike(model.size(capacity), &model.scene().likeness()).map_err(|_| {
            Failure::new(format!("there is no memory for {capacity} particles; lower --capacity (or the scene's)"))
        })?;
        let mut system = System::with(memory);
        system.start(&model.scene(), seed)?;
        let method = model.integrator.method;
        let is_auto = args.substeps == Substeps::Auto;
        let limit = if is_auto { Bounds::lasting(&model).whole_step(method) } else { Limit::Unconditional };
        let tolerance = args.tolerance.unwrap_or_else(|| TOLERANCE * size(&file, &model));
        let pace = Pace::new(args.substeps, limit, tolerance);
        let threads = threads(args.threads, capacity)?;
        let name = load::name(&args.scene).into_owned();
        Ok(Self { name, file, model, system, duration, dt, pace, threads })
    }

    /// The method of the run.
    pub(crate) fn integrator(&self) -> Method {
        self.model.integrator.method
    }

    /// Warns of steps \[s\] that are going to explode in a run of some duration \[s\], unless they are divided as need be.
    pub(crate) fn warn_of_steps(&self, step: f64, duration: f64) {
        if let Substeps::Fixed(n) = self.pace.substeps() {
            let step = step / f64::from(n);
            warn(&Bounds::of(&self.model).warnings(&self.name, self.integrator(), step, duration));
            warn(stall::foreseen(&self.model, step, duration).as_slice());
        }
    }

    /// Does something with it on its threads, if there are several. They are entered once for all steps: to hand a step over to a thread takes
    /// as long as a small one.
    pub(crate) fn on_threads<T: Send>(&mut self, work: impl FnOnce(&mut Self) -> T + Send) -> T {
        let Some(pool) = self.threads.take() else { return work(self) };
        let done = pool.install(|| work(self));
        self.threads = Some(pool);
        done
    }

    /// Steps to the instant `end`.
    pub(crate) fn step_to(&mut self, end: Time) -> Report {
        self.pace.step(&mut self.system, &self.model.scene(), end, None)
    }

    /// Steps to the instant `end` while somebody watches.
    pub(crate) fn step_observed(&mut self, end: Time, observer: &mut dyn Observer) -> Report {
        self.pace.step(&mut self.system, &self.model.scene(), end, Some(observer))
    }
}

/// As many threads as asked for, or as the machine has, where there may be particles enough for more than one.
fn threads(asked: Option<u16>, capacity: usize) -> Outcome<Option<ThreadPool>> {
    let count = match asked {
        Some(count) => usize::from(count),
        None if capacity < WORTH_THREADS => 1,
        None => std::thread::available_parallelism().map_or(1, usize::from),
    };
    if count == 1 {
        return Ok(None);
    }
    match rayon::ThreadPoolBuilder::new().num_threads(count).build() {
        Ok(pool) => Ok(Some(pool)),
        Err(error) if asked.is_some() => Err(Failure::new(format!("--threads {count}: {error}"))),
        // One thread does it as well.
        Err(_) => Ok(None),
    }
}

/// Lets balls answer each other by the response of a name, and warns of what they do not do by it.
fn answer(file: &mut SceneFile, name: &str, dt: f64) {
    let said = file.contacts;
    file.contacts = respond(file, name, dt);
    // What the file says of contacts of its own was remarked on as it was read.
    let remark = file.unasked_elasticity().filter(|_| said != file.contacts);
    warn(
        remark.map(|remark| format!("--response {name}: a damping of {remark} in the scene's own contacts")).as_slice(),
    );
}

/// The response of a name: the scene's own, if it is that, else one with settings that suit the scene.
fn respond(file: &SceneFile, name: &str, dt: f64) -> Option<Response> {
    let born = file.emitters.iter().map(|emitter| emitter.mass.mean - emitter.mass.half_width.abs());
    let masses = file.particles.iter().map(|particle| particle.mass).chain(born).filter(|&mass| mass > 0.0);
    let lightest = masses.fold(f32::INFINITY, f32::min);
    let lightest = if lightest.is_finite() { lightest } else { 1.0 };
    file.contacts.filter(|own| own.name() == name).or_else(|| Response::by_name(name, dt as f32, lightest))
}
