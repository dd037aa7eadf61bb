//! Problems that are solved: reference problems, and scenes from files.

use super::args::{Lab, Named};
use super::exact::{self, Exact};
use super::law::{self, on_the_axis};
use crate::outcome::{Failure, Outcome};
use crate::parse::sorted;
use crate::world::{Settings, World};
use clap::ValueEnum;
use pointmass::integrate::{Method, Tuning};
use pointmass::scene::Model;
use pointmass::{Force, Gravity, Heap, MutualGravity, Particle, Scene, Spring, System, Vec3};
use std::path::Path;

/// Something to be solved from its start to an end.
pub(crate) struct Problem {
    pub(crate) name: String,
    pub(crate) about: String,
    world: Made,
    /// How many particles may live at once.
    capacity: usize,
    seed: u64,
    /// The settings of methods that have some.
    pub(crate) tuning: Tuning,
    /// When errors are taken \[s\].
    pub(crate) duration: f64,
    /// How long energies are followed \[s\].
    pub(crate) long: f64,
    /// Steps \[s\], from the longest down.
    pub(crate) dts: Vec<f64>,
    /// The step within which methods that choose their own are held to a tolerance \[s\].
    pub(crate) frame: f64,
    pub(crate) exact: Option<Exact>,
    /// Whether forces depend on time.
    pub(crate) is_driven: bool,
}

enum Made {
    Here { start: Vec<Particle>, springs: Vec<Spring>, forces: Box<dyn Force> },
    File(Box<Model>),
}

/// All that the arguments name.
pub(crate) fn problems(args: &Lab) -> Outcome<Vec<Problem>> {
    let mut problems = match &args.scene {
        Some(path) => vec![from_file(path, args)?],
        None => sorted(&args.problems, Named::value_variants()).into_iter().map(Named::problem).collect(),
    };
    for problem in &mut problems {
        if let Some(duration) = args.duration {
            problem.long *= duration / problem.duration;
            problem.duration = duration;
            problem.frame = duration / 4.0;
        }
        if !args.dt.is_empty() {
            problem.dts.clone_from(&args.dt);
            problem.dts.sort_by(|a, b| b.total_cmp(a));
            problem.dts.dedup();
        }
        if args.scene.is_some() {
            problem.frame = problem.dts[0];
        }
    }
    Ok(problems)
}

/// The inverse powers of two between two exponents \[s\].
fn halvings(from: i32, to: i32) -> Vec<f64> {
    (from..=to).map(|power| 0.5f64.powi(power)).collect()
}

impl Named {
    /// The problem itself.
    fn problem(self) -> Problem {
        match self {
            Self::Oscillator => Problem { exact: Some(exact::oscillator), ..self.along_x(law::OSCILLATOR, phases()) },
            Self::Driven => {
                Problem { exact: Some(exact::driven), is_driven: true, ..self.along_x(law::DRIVEN, phases()) }
            }
            Self::Pendulum => {
                let start = on_the_axis((1..=8).map(|i| [i as f32 / 4.0, 0.0]));
                let exact: Option<Exact> = Some(exact::pendulum);
                Problem {
                    exact,
                    duration: 8.0,
                    long: 80.0,
                    frame: 2.0,
                    dts: halvings(0, 9),
                    ..self.along_x(law::PENDULUM, start)
                }
            }
            Self::Kepler => self.kepler(),
            Self::Stiff => self.stiff(),
            Self::Rope => self.rope(),
        }
    }

    /// Four seconds, and energies over ten times as many.
    fn base(self, start: Vec<Particle>, springs: Vec<Spring>, forces: Box<dyn Force>) -> Problem {
        let value = self.to_possible_value();
        let help = value.as_ref().and_then(|value| value.get_help()).map(ToString::to_string);
        Problem {
            name: value.as_ref().map_or("", |value| value.get_name()).into(),
            about: help.unwrap_or_default(),
            capacity: start.len(),
            world: Made::Here { start, springs, forces },
            seed: 1,
            tuning: Tuning::DEFAULT,
            duration: 4.0,
            long: 40.0,
            dts: halvings(1, 10),
            frame: 1.0,
            exact: None,
            is_driven: false,
        }
    }

    fn along_x(self, law: law::Law, start: Vec<Particle>) -> Problem {
        self.base(start, Vec::new(), Box::new(law))
    }

    /// Numbers that an `f32` holds exactly; the centre of mass rests in the origin.
    fn kepler(self) -> Problem {
        let body = |mass, x, v| Particle { mass, position: Vec3::X * x, velocity: Vec3::Y * v, ..Particle::REST };
        let start = vec![body(1.0, 0.75, 1.78125), body(3.0, -0.25, -0.59375)];
        let gravity = MutualGravity { constant: 1.0, ..MutualGravity::NEWTON };
        Problem {
            long: 70.0,
            dts: halvings(3, 11),
            exact: Some(exact::kepler),
            ..self.base(start, Vec::new(), Box::new(gravity))
        }
    }

    fn stiff(self) -> Problem {
        let anchor = Particle { fixed: true, ..Particle::REST };
        let mut start = on_the_axis([[1.5, 0.0], [0.75, 0.0]]);
        start.insert(0, anchor);
        let springs = (1..=2).map(|end| Spring::new([0, end], 1.0, 100.0).damped(100.0)).collect();
        Problem {
            duration: 2.0,
            long: 2.0,
            frame: 0.5,
            exact: Some(exact::stiff),
            ..self.base(start, springs, Box::new(()))
        }
    }

    fn rope(self) -> Problem {
        let place = |i: u8| Vec3::new(0.12, -0.16, 0.0) * f32::from(i);
        let start =
            (0..=10).map(|i| Particle { position: place(i), mass: 0.1, fixed: i == 0, ..Particle::REST }).collect();
        let springs = (0..10).map(|i| Spring::new([i, i + 1], 0.2, 100.0).damped(1.0)).collect();
        Problem {
            duration: 2.0,
            long: 20.0,
            frame: 0.5,
            dts: halvings(5, 12),
            ..self.base(start, springs, Box::new(Gravity::EARTH))
        }
    }
}

/// Starts at several phases, so that errors do not depend on the end's, but unevenly, so that their energies do not
/// cancel.
fn phases() -> Vec<Particle> {
    on_the_axis([[1.0, 0.0], [0.0, 1.0], [0.5, 0.5]])
}

/// A scene, in its own step and down to a sixteenth of it.
fn from_file(path: &Path, args: &Lab) -> Outcome<Problem> {
    let world = World::load(&Settings { duration: args.duration, ..Settings::of(path, args.reading) })?;
    let World { file, model, system, duration, dt, .. } = world;
    if !(duration > 0.0) {
        return Err(Failure::new(format!("{}: runs for 0 s; choose a --duration", path.display())));
    }
    Ok(Problem {
        name: path.file_name().unwrap_or_default().to_string_lossy().into_owned(),
        about: file.about,
        // Each step and method has a system of its own: where nobody is born, more room would be filled for nothing.
        capacity: if file.emitters.is_empty() { model.particles.len() } else { system.capacity() },
        seed: system.seed(),
        tuning: model.integrator.tuning,
        duration,
        long: duration,
        dts: (0..5).map(|power| dt * 0.5f64.powi(power)).collect(),
        frame: dt,
        exact: None,
        is_driven: model.springs.iter().any(|spring| spring.drive.is_some()),
        world: Made::File(Box::new(model)),
    })
}

impl Problem {
    /// The scene; its method is to be chosen.
    pub(crate) fn scene(&self) -> Scene<'_> {
        match &self.world {
            Made::Here { start, springs, forces } => Scene { start, springs, forces: forces.as_ref(), ..Scene::EMPTY },
            Made::File(model) => model.scene(),
        }
    }

    /// A system that has started a scene of this problem.
    pub(crate) fn system(&self, scene: &Scene<'_>) -> Outcome<System<Heap>> {
        let size = pointmass::Size { particles: self.capacity, ..scene.size() };
        let memory = Heap::try_new(size);
        let memory = memory
            .map_err(|_| Failure::new(format!("{}: there is no memory for {} particles", self.name, self.capacity)))?;
        let mut system = System::with(memory);
        system.start(scene, self.seed)?;
        Ok(system)
    }

    /// The order of a method's error by its theory, at fixed steps.
    pub(crate) fn expected(&self, method: Method) -> f64 {
        match method {
            Method::Euler | Method::Symplectic | Method::Implicit => 1.0,
            Method::LectureMidpoint if self.is_driven => 1.0,
            Method::Midpoint | Method::LectureMidpoint | Method::Verlet => 2.0,
            Method::Embedded => 3.0,
            Method::Rk4 => 4.0,
            Method::Adaptive if self.tuning.inner.chooses_steps() => 4.0,
            Method::Adaptive => self.expected(self.tuning.inner),
        }
    }

    /// The step of those on trial that energies are followed with \[s\]: the nearest to a sixtieth of a second.
    pub(crate) fn usual(&self) -> f64 {
        let far = |dt: f64| (dt * 60.0).ln().abs();
        self.dts.iter().copied().min_by(|a, b| far(*a).total_cmp(&far(*b))).unwrap_or(1.0 / 60.0)
    }
}
