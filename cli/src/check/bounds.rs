//! What bounds the step of a scene: its springs in every pose, and drag.

use super::contact::Contact;
use super::part::{Part, place};
use super::words::{plain, time};
use pointmass::scene::Model;
use pointmass::stability::{Limit, Mode, Poses};
use pointmass::{ForceKind, Method, Particle, Spring};

/// What bounds the step of a scene.
pub(crate) struct Bounds {
    pub(crate) poses: Poses,
    /// The spring whose two ends alone would oscillate fastest.
    pub(crate) stiffest: Option<Part>,
    /// What drag slows down most.
    pub(crate) dragged: Option<Part>,
    /// The balls that push each other apart most abruptly.
    pub(crate) contact: Option<Contact>,
}

impl Bounds {
    pub(crate) fn of(model: &Model) -> Self {
        let (particles, has_drag) = in_air(model);
        Self {
            poses: Poses::of(&particles, &model.springs, has_drag),
            stiffest: stiffest(model),
            dragged: if has_drag { dragged(model) } else { None },
            contact: Contact::of(model),
        }
    }

    /// The largest stable step, whatever the springs' pose and whoever is born.
    pub(crate) fn largest_step(&self, method: Method) -> Limit {
        self.lasting_step(method).and(self.contact_step(method))
    }

    /// That of springs and drag, which always act.
    fn lasting_step(&self, method: Method) -> Limit {
        self.poses.largest_step(method).and(self.drag_step(method))
    }

    /// The largest step that drag allows.
    pub(crate) fn drag_step(&self, method: Method) -> Limit {
        self.dragged.as_ref().map_or(Limit::Unconditional, |part| part.mode.largest_step(method))
    }

    /// The largest step that contacts by force allow.
    pub(crate) fn contact_step(&self, method: Method) -> Limit {
        self.contact.as_ref().map_or(Limit::Unconditional, |contact| contact.largest_step(method))
    }

    /// What to say of a run with this step \[s\] that takes this long \[s\].
    pub(crate) fn warnings(&self, method: Method, step: f64, duration: f64) -> Vec<String> {
        if method.chooses_steps() {
            return Vec::new();
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
            // What grows less than tenfold may go unseen.
            Limit::Never if growth * duration > 10f64.ln() => vec![format!(
                "with {method} what nothing damps grows at any step, here e-fold in {}, because of {}; try another \
                 --integrator, or see `pointmass check`",
                time(1.0 / growth),
                culprit()
            )],
            _ => Vec::new(),
        };
        warnings.extend(self.contact.as_ref().and_then(|contact| contact.warning(method, step)));
        warnings
    }

    /// How fast the fastest oscillation that nothing damps grows \[1/s\].
    pub(crate) fn growth(&self, method: Method, step: f64) -> f64 {
        self.poses.growth_across(method, step)
    }

    /// The part that bounds the step, in words.
    pub(crate) fn culprit(&self, method: Method) -> Option<String> {
        let strictest = |part: &&Part| match part.mode.largest_step(method) {
            Limit::Never => 0.0,
            Limit::Step(step) => step,
            Limit::Unconditional => f64::INFINITY,
        };
        let parts = [&self.stiffest, &self.dragged].into_iter().flatten();
        parts.min_by(|a, b| strictest(a).total_cmp(&strictest(b))).map(|part| format!("{} {}", part.place, part.about))
    }
}

/// What air does to a particle: so many times its own coefficient of drag, and a coefficient for all \[kg/s\].
fn air(model: &Model) -> [f32; 2] {
    model.forces.0.iter().fold([0.0, 0.0], |[own, all], force| match force {
        ForceKind::Drag(_) => [own + 1.0, all],
        ForceKind::Wind(wind) => wind.coefficient.map_or([own + 1.0, all], |k| [own, all + k]),
        _ => [own, all],
    })
}

/// The particles with the coefficients by which drag and wind together brake them, and whether these act.
pub(crate) fn in_air(model: &Model) -> (Vec<Particle>, bool) {
    let [own, all] = air(model);
    let braked = |particle: &Particle| Particle { drag: own * particle.drag + all, ..*particle };
    (model.particles.iter().map(braked).collect(), own != 0.0 || all != 0.0)
}

fn stiffest(model: &Model) -> Option<Part> {
    let (particles, springs) = (&model.particles, &model.springs);
    let pairs = springs.iter().map(|spring| spring.ends.map(|end| &particles[end as usize]));
    let modes = pairs.zip(springs).map(|(ends, spring)| {
        let inverse: f64 = ends.iter().filter(|end| !end.fixed).map(|end| 1.0 / f64::from(end.mass)).sum();
        Mode { omega2: f64::from(spring.ks) * inverse, damping: f64::from(spring.kd) * inverse }
    });
    let rate = |mode: &Mode| mode.omega2.max(0.0).sqrt().max(mode.damping);
    let moving = modes.enumerate().filter(|(_, mode)| rate(mode) > 0.0);
    let (i, mode) = moving.reduce(|a, b| if rate(&b.1) > rate(&a.1) { b } else { a })?;
    let Spring { ends: [a, b], ks, kd, .. } = springs[i];
    let [m, n] = [a, b].map(|end| match &particles[end as usize] {
        particle if particle.fixed => "fixed".to_string(),
        particle => format!("{} kg", particle.mass),
    });
    let about = format!("between particles {a} ({m}) and {b} ({n}): ks {ks}, kd {kd}");
    Some(Part { place: place(model, 1, i), spring: Some(i), about, mode })
}

/// The largest drag over mass of any particle, at the start or of an emitter's births.
fn dragged(model: &Model) -> Option<Part> {
    let [own, all] = air(model).map(f64::from);
    let start = model.particles.iter().enumerate().filter(|(_, particle)| !particle.fixed);
    let start = start.map(|(i, p)| ([0, i], own * f64::from(p.drag) + all, f64::from(p.mass)));
    let births = model.emitters.iter().enumerate().filter(|(_, emitter)| !emitter.fixed);
    let births = births.map(|(i, e)| {
        let most = own * (f64::from(e.drag.mean) + f64::from(e.drag.half_width.abs())) + all;
        ([1, i], most, f64::from(e.mass.mean) - f64::from(e.mass.half_width.abs()))
    });
    let rate = |part: &([usize; 2], f64, f64)| part.1 / part.2;
    let braked = start.chain(births).filter(|part| rate(part) > 0.0);
    let part = braked.reduce(|a, b| if rate(&b) > rate(&a) { b } else { a })?;
    let mode = Mode { omega2: 0.0, damping: rate(&part) };
    let ([kind, i], drag, mass) = part;
    let place = if kind == 0 { place(model, 0, i) } else { format!("emitters[{i}]") };
    Some(Part { place, spring: None, about: format!("of drag {} kg/s and mass {} kg", plain(drag), plain(mass)), mode })
}
