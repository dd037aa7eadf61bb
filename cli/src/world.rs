//! A scene in motion: the system, the scene it steps through, and the settings of the run.

use crate::args;
use crate::check::Bounds;
use crate::load::{self, Disk};
use crate::stage::size;
use crate::stall;
use crate::substeps::{Pace, Substeps};
use crate::{Failure, Outcome, warn};
use pointmass::scene::{Model, SceneFile};
use pointmass::stability::Limit;
use pointmass::{Heap, Method, Observer, Report, Response, System, Time};
use rayon::ThreadPool;

/// The tolerance of sub-steps that nobody gave, in parts of the scene's size.
const TOLERANCE: f64 = 1e-4;

/// A scene made ready and the system it is done to.
#[derive(Debug)]
pub struct World {
    /// What the file says.
    pub file: SceneFile,
    /// The scene.
    pub model: Model,
    /// The state.
    pub system: System<Heap>,
    /// How it is run: the file's settings with those of the command line laid over.
    pub duration: f64,
    /// The step \[s\].
    pub dt: f64,
    /// How steps are divided.
    pub pace: Pace,
    /// The threads that steps run on, if there are more than this one.
    threads: Option<ThreadPool>,
}

/// Particles from which on more than one thread is of use.
const WORTH_THREADS: usize = 4096;

impl World {
    /// Loads the scene and puts in what it begins with.
    ///
    /// # Errors
    /// If the scene cannot be used.
    pub fn load(args: &args::World) -> Outcome<Self> {
        let mut file = load::scene_with(&args.scene, args.reading.unknown())?;
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
            file.contacts = respond(&file, name, dt);
        }
        let model = Model::load(&file, &args.scene.to_string_lossy(), &mut Disk)?;
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
        let memory = Heap::try_new(model.size(capacity)).map_err(|_| {
            Failure::new(format!("there is no memory for {capacity} particles; lower --capacity (or the scene's)"))
        })?;
        let mut system = System::with(memory);
        system
            .start(&model.scene(), seed)
            .map_err(|insufficient_memory| Failure::new(insufficient_memory.to_string()))?;
        let method = model.integrator.method;
        let chosen = args.substeps == Substeps::Auto && !method.chooses_steps();
        let limit = if chosen { Bounds::of(&model).largest_step(method) } else { Limit::Unconditional };
        let tolerance = args.tolerance.unwrap_or_else(|| TOLERANCE * size(&file, &model));
        let pace = Pace::new(args.substeps, limit, tolerance);
        let threads = threads(args.threads, capacity)?;
        Ok(Self { file, model, system, duration, dt, pace, threads })
    }

    /// The method of the run.
    #[must_use]
    pub fn integrator(&self) -> Method {
        self.model.integrator.method
    }

    /// Warns of steps \[s\] that are going to explode in a run of some duration \[s\], unless they are divided as need be.
    pub fn warn_of_steps(&self, step: f64, duration: f64) {
        if let Substeps::Fixed(n) = self.pace.substeps() {
            let step = step / f64::from(n);
            warn(&Bounds::of(&self.model).warnings(self.integrator(), step, duration));
            warn(stall::foreseen(&self.model, step, duration).as_slice());
        }
    }

    /// Steps to the instant `end`.
    pub fn step_to(&mut self, end: Time) -> Report {
        let Self { model, system, pace, threads, .. } = self;
        let scene = model.scene();
        match threads {
            Some(pool) => pool.install(|| pace.step(system, &scene, end, None)),
            None => pace.step(system, &scene, end, None),
        }
    }

    /// Steps to the instant `end` while somebody watches.
    pub fn step_observed(&mut self, end: Time, observer: &mut dyn Observer) -> Report {
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

/// The response of a name: the scene's own, if it is that, else one with settings that suit the scene.
fn respond(file: &SceneFile, name: &str, dt: f64) -> Option<Response> {
    let born = file.emitters.iter().map(|emitter| emitter.mass.mean - emitter.mass.half_width.abs());
    let masses = file.particles.iter().map(|particle| particle.mass).chain(born).filter(|&mass| mass > 0.0);
    let lightest = masses.fold(f32::INFINITY, f32::min);
    let lightest = if lightest.is_finite() { lightest } else { 1.0 };
    file.contacts.filter(|own| own.name() == name).or_else(|| Response::by_name(name, dt as f32, lightest))
}
