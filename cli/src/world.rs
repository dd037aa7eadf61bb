//! A scene in motion: the system, the scene it steps through, and the settings of the run.

use crate::args;
use crate::load::{self, Disk};
use crate::{Failure, Outcome};
use pointmass::scene::{Model, SceneFile};
use pointmass::{Heap, Method, Report, System, Time};

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
}

impl World {
    /// Loads the scene and puts in what it begins with.
    ///
    /// # Errors
    /// If the scene cannot be used.
    pub fn load(args: &args::World) -> Outcome<Self> {
        let mut file = load::scene(&args.scene)?;
        let run = &mut file.run;
        run.integrator = args.integrator.unwrap_or(run.integrator);
        run.seed = args.seed.unwrap_or(run.seed);
        let (duration, dt, seed) = (args.duration.unwrap_or(run.duration), args.dt.unwrap_or(run.dt), run.seed);
        let particles = file.particles.len();
        let capacity = args.capacity.map_or(particles.max(file.run.capacity as usize), |capacity| capacity as usize);
        let model = Model::load(&file, &args.scene.to_string_lossy(), &mut Disk)?;
        let memory = Heap::try_new(model.size(capacity)).map_err(|_| {
            Failure::new(format!("there is no memory for {capacity} particles; lower --capacity (or the scene's)"))
        })?;
        let mut system = System::with(memory);
        system.start(&model.scene(), seed).map_err(|unfit| Failure::new(unfit.to_string()))?;
        Ok(Self { file, model, system, duration, dt })
    }

    /// The method of the run.
    #[must_use]
    pub fn integrator(&self) -> Method {
        self.model.integrator.method
    }

    /// Steps to the instant `end`.
    pub fn step_to(&mut self, end: Time) -> Report {
        let dt = end - self.system.time();
        self.system.step(&self.model.scene(), dt)
    }
}
