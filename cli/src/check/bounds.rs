//! The bounds on the step of a scene: its springs in every pose, drag, contacts, goals and gas, over whole lives; and constraints.
//!
//! They are bounds on the steps that a method takes: those of a scene, or what it cuts them into.

use super::body::{Body, extremes};
use super::contact::Contact;
use super::gas::Gas;
use super::goal::Goals;
use super::hold::Hold;
use super::onset::Onset;
use super::part::{Part, place};
use super::words::time;
use pointmass::scene::Model;
use pointmass::stability::{Limit, Mode, Poses};
use pointmass::{Method, Spring};

/// The bounds on the step of a scene.
pub(crate) struct Bounds {
    /// All particles that there may be.
    pub(crate) bodies: Vec<Body>,
    /// The springs in every pose, for each of the extremes that lives come to.
    poses: Vec<Poses>,
    /// The spring whose two ends alone would oscillate fastest.
    pub(crate) stiffest: Option<Part>,
    /// The body that drag slows down most.
    pub(crate) dragged: Option<Part>,
    /// The balls that push each other apart most abruptly.
    pub(crate) contact: Option<Contact>,
    /// The goals that particles are led to.
    pub(crate) goals: Option<Goals>,
    /// The gas in meshes.
    pub(crate) gas: Option<Gas>,
    /// The constraints.
    pub(crate) holds: Vec<Hold>,
    /// The newborn that drag slows down most.
    born: Option<Part>,
    /// What is odd about the first particle that drag pushes.
    pushed: Option<String>,
    /// Parts that the scene cuts each step into.
    substeps: f64,
}

impl Bounds {
    /// Those of a scene, with what brakes particles as they start.
    pub(crate) fn of(model: &Model) -> Self {
        Self::with(model, &Onset::of(model))
    }

    /// Those that hold as long as a scene runs, however fast or near to each other particles are.
    pub(crate) fn lasting(model: &Model) -> Self {
        Self::with(model, &Onset::none())
    }

    fn with(model: &Model, onset: &Onset) -> Self {
        let bodies = Body::all(model, onset);
        let corners = extremes(&bodies[..model.particles.len()]);
        Self {
            poses: corners.iter().map(|corner| Poses::of(corner, &model.springs, true)).collect(),
            stiffest: stiffest(model, &bodies),
            dragged: dragged(model, bodies.iter()),
            born: dragged(model, bodies.iter().filter(|body| body.is_born())),
            contact: Contact::of(model, &bodies),
            goals: Goals::of(model, &bodies),
            gas: Gas::of(model, &bodies),
            holds: Hold::all(model),
            pushed: bodies.iter().find_map(|body| body.push(model)),
            substeps: f64::from(model.substeps),
            bodies,
        }
    }

    /// The largest stable step, whatever the springs' pose and whoever is born.
    pub(crate) fn largest_step(&self, method: Method) -> Limit {
        self.lasting_step(method).and(self.contact_step(method))
    }

    /// The longest step of a run, which the scene may cut into parts, that is stable and leaves constraints off by little.
    pub(crate) fn whole_step(&self, method: Method) -> Limit {
        let stable = if method.chooses_steps() { Limit::Unconditional } else { self.largest_step(method) };
        let enough = self.holds.iter().fold(stable, |least, hold| least.and(hold.largest_step()));
        match enough {
            Limit::Step(step) => Limit::Step(step * self.substeps),
            other => other,
        }
    }

    /// The bound of springs, drag, goals and gas, which act for long.
    fn lasting_step(&self, method: Method) -> Limit {
        self.poses_step(method).and(self.drag_step(method)).and(self.goal_step(method)).and(self.gas_step(method))
    }

    /// The largest step that springs allow in every pose.
    pub(crate) fn poses_step(&self, method: Method) -> Limit {
        self.poses.iter().fold(Limit::Unconditional, |least, poses| least.and(poses.largest_step(method)))
    }

    /// The largest step that goals allow.
    pub(crate) fn goal_step(&self, method: Method) -> Limit {
        self.goals.as_ref().map_or(Limit::Unconditional, |goals| goals.largest_step(method))
    }

    /// The largest step that gas in meshes allows.
    pub(crate) fn gas_step(&self, method: Method) -> Limit {
        self.gas.as_ref().map_or(Limit::Unconditional, |gas| gas.largest_step(method))
    }

    /// The largest step that drag allows.
    pub(crate) fn drag_step(&self, method: Method) -> Limit {
        self.dragged.as_ref().map_or(Limit::Unconditional, |part| part.mode.largest_step(method))
    }

    /// The largest step that contacts by force allow.
    pub(crate) fn contact_step(&self, method: Method) -> Limit {
        self.contact.as_ref().map_or(Limit::Unconditional, |contact| contact.largest_step(method))
    }

    /// The warning that the newborn are thrown back in sub-steps of so long \[s\], whatever the method.
    pub(crate) fn birth_warning(&self, h: f64) -> Option<String> {
        let born = self.born.as_ref().filter(|born| h * born.mode.damping > 2.0)?;
        let (Part { place, about, mode, .. }, now) = (born, time(h));
        let parts = (self.substeps * h * mode.damping).ceil();
        Some(format!(
            "{place} {about}: the newborn fly to the end of their sub-step with the acceleration of their birth, and in {now} drag \
             throws them back; take --substeps {parts}, whatever the method"
        ))
    }

    /// Warnings of a run of the scene of a name with this step \[s\], which the scene may cut into parts, that takes this long \[s\].
    pub(crate) fn warnings(&self, scene: &str, method: Method, step: f64, duration: f64) -> Vec<String> {
        let step = step / self.substeps;
        let placed = |warning: String| format!("{scene}:{warning}");
        let held = self.pushed.clone().map(placed).into_iter();
        let held = held.chain(self.holds.iter().filter_map(|hold| hold.warning(step)));
        let held = held.chain(self.holds.iter().filter_map(|hold| Some(hold.tumbling(step)?.0)));
        let held = held.chain(self.holds.iter().filter_map(|hold| Some(hold.trembling(step)?.0)));
        let is_alone = method.chooses_steps() || self.drag_step(method).admits(step);
        let held = held.chain(self.birth_warning(step).filter(|_| is_alone).map(placed));
        if method.chooses_steps() {
            return held.collect();
        }
        let culprit = || self.culprit(method).unwrap_or_default();
        let growth = self.growth(method, step);
        let mut warnings = match self.lasting_step(method) {
            Limit::Step(limit) if step > limit => vec![format!(
                "steps of {} are beyond what {method} stands in every pose, {}, because of {}; try --substeps auto, or see \
                 `pointmass check`",
                time(step),
                time(limit),
                culprit()
            )],
            // What grows less than tenfold may go unseen. Where drag pushes, that is told, and nothing else makes it grow.
            Limit::Never if self.pushed.is_none() && growth * duration > 10f64.ln() => vec![format!(
                "with {method} what nothing damps grows at any step, here e-fold in {}, because of {}; try another \
                 --integrator, or see `pointmass check`",
                time(1.0 / growth),
                culprit()
            )],
            _ => Vec::new(),
        };
        warnings.extend(self.contact.as_ref().and_then(|contact| contact.warning(method, step, self.substeps)));
        warnings.extend(held);
        warnings
    }

    /// The growth of the fastest oscillation that nothing damps \[1/s\].
    pub(crate) fn growth(&self, method: Method, step: f64) -> f64 {
        self.poses.iter().map(|poses| poses.growth_across(method, step)).fold(0.0, f64::max)
    }

    /// The part that bounds the step, in words.
    pub(crate) fn culprit(&self, method: Method) -> Option<String> {
        let length = |limit: Limit| match limit {
            Limit::Never => 0.0,
            Limit::Step(step) => step,
            Limit::Unconditional => f64::INFINITY,
        };
        let goal = self.goals.as_ref().map(|goals| &goals.part);
        let parts = [self.stiffest.as_ref(), self.dragged.as_ref(), goal].into_iter().flatten();
        let parts = parts.map(|part| (part, part.mode.largest_step(method)));
        let gas = self.gas.as_ref().map(|gas| (&gas.part, gas.largest_step(method)));
        let strictest = parts.chain(gas).min_by(|a, b| length(a.1).total_cmp(&length(b.1)));
        strictest.map(|(part, _)| format!("{} {}", part.place, part.about))
    }
}

fn stiffest(model: &Model, bodies: &[Body]) -> Option<Part> {
    let pairs = model.springs.iter().map(|spring| spring.ends.map(|end| &bodies[end as usize]));
    let modes = pairs.zip(&model.springs).map(|(ends, spring)| {
        let inverse: f64 = ends.iter().filter(|end| end.is_free()).map(|end| 1.0 / end.mass[0]).sum();
        Mode { omega2: f64::from(spring.ks) * inverse, damping: f64::from(spring.kd) * inverse }
    });
    let rate = |mode: &Mode| mode.omega2.max(0.0).sqrt().max(mode.damping);
    let moving = modes.enumerate().filter(|(_, mode)| rate(mode) > 0.0);
    let (i, mode) = moving.reduce(|a, b| if rate(&b.1) > rate(&a.1) { b } else { a })?;
    let Spring { ends: [a, b], ks, kd, .. } = model.springs[i];
    let [m, n] = [a, b].map(|end| bodies[end as usize].weight());
    let about = format!("between particles {a} ({m}) and {b} ({n}): ks {ks}, kd {kd}");
    Some(Part { place: place(model, 1, i), spring: Some(i), about, mode })
}

/// The body that is braked most.
fn dragged<'a>(model: &Model, bodies: impl Iterator<Item = &'a Body>) -> Option<Part> {
    let braked = bodies.filter(|body| body.is_free() && body.rate() > 0.0);
    let body = braked.reduce(|a, b| if b.rate() > a.rate() { b } else { a })?;
    let mode = Mode { omega2: 0.0, damping: body.rate() };
    Some(Part { place: body.place(model), spring: None, about: body.brake(), mode })
}
