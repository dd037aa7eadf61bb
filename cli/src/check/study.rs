//! Findings about a scene's step.

use super::body::extremes;
use super::bounds::Bounds;
use super::contact::Contact;
use super::hold::Hold;
use super::modes::{How, Spectrum};
use super::part::Part;
use super::pull::Pull;
use super::verdict::Verdict;
use super::words::typed;
use super::world::{Followed, Pair, fastest_pair, followed, judged_at_start, not_judged};
use pointmass::Method;
use pointmass::scene::{Model, Run};
use pointmass::stability::Limit;
use serde::Serialize;
use std::path::Path;

/// Findings about a scene's step. Times are in seconds, rates per second.
#[derive(Debug, Serialize)]
pub(crate) struct Study {
    /// The scene's file.
    pub(crate) scene: String,
    /// The step that is judged, and the parts that the scene cuts it into.
    pub(crate) dt: f64,
    pub(crate) substeps: u32,
    /// The method that is advised on.
    pub(crate) integrator: String,
    /// Particles at the start, and those of them that can move.
    pub(crate) particles: usize,
    pub(crate) free: usize,
    pub(crate) springs: usize,
    pub(crate) emitters: usize,
    /// The oscillations of the springs at rest.
    pub(crate) oscillations: Option<Oscillations>,
    /// The spring whose two ends alone would oscillate fastest.
    pub(crate) stiffest: Option<Part>,
    /// The body that drag slows down most.
    pub(crate) dragged: Option<Part>,
    /// That the step throws the newborn back, if it does.
    #[serde(skip)]
    pub(crate) born: Option<String>,
    /// The balls that push each other apart most abruptly, and how long a hit of them lasts.
    pub(crate) touching: Option<Part>,
    pub(crate) hit: Option<f64>,
    /// The goal that holds the most stiffly.
    pub(crate) led: Option<Part>,
    /// The gas that allows the shortest steps.
    pub(crate) filled: Option<Part>,
    /// The constraints.
    pub(crate) holds: Vec<Hold>,
    pub(crate) methods: Vec<Stand>,
    /// The length of paths that are followed with full accuracy to what they hit.
    pub(crate) followed: Option<Followed>,
    /// The two particles that attract each other into the quickest orbit.
    pub(crate) pair: Option<Pair>,
    /// The sinks whose pull changes from place to place.
    pub(crate) sinks: Vec<Pull>,
    /// Forces that bound the step as well, by a law that is not looked at.
    pub(crate) not_judged: Vec<&'static str>,
    /// Forces that bound the step by how fast and how near particles are, which is judged as they start.
    pub(crate) judged_at_start: Vec<&'static str>,
    pub(crate) advice: Vec<String>,
}

/// The oscillations of the springs at rest.
#[derive(Debug, Serialize)]
pub(crate) struct Oscillations {
    /// The number of those that move.
    pub(crate) count: usize,
    pub(crate) how: How,
    /// The largest rate |λ| \[1/s\].
    pub(crate) fastest: f64,
    /// Its damping ratio.
    pub(crate) damping_ratio: Option<f64>,
}

/// The steps that a method stands, where scenes cut theirs into parts the length of these.
#[derive(Debug, Serialize)]
pub(crate) struct Stand {
    pub(crate) method: String,
    /// It chooses its own steps: the limits are those of the steps within.
    pub(crate) chooses_steps: bool,
    /// The largest step stable for springs that are where they start, and at rest there.
    pub(crate) at_rest: Limit,
    /// True if it may be less than that, as there are too many oscillations to work out all; it is no more but for a few per cent.
    pub(crate) estimated: bool,
    /// The largest step stable in every pose.
    pub(crate) every_pose: Limit,
    /// The largest step that drag allows.
    pub(crate) drag: Limit,
    /// The largest step in which contacts by force add no energy.
    pub(crate) contact: Limit,
    /// The largest step that is stable for whoever goals hold, in every pose.
    pub(crate) goal: Limit,
    /// The largest step in which gas in meshes pushes nobody far, and makes nothing grow.
    pub(crate) gas: Limit,
    /// True if it stands the step that is judged, in every pose and as far as forces are looked at.
    pub(crate) stable: bool,
    /// How it stands that step.
    pub(crate) verdict: Verdict,
    /// The rate at which an oscillation across taut springs may grow at that step.
    pub(crate) growth_across: f64,
}

impl Study {
    /// The study of a scene, without advice, and the modes of its springs, at each of the extremes that lives come to.
    pub(crate) fn of(path: &Path, model: &Model, run: &Run) -> (Self, Vec<Spectrum>) {
        let (dt, substeps, bounds) = (run.dt, model.substeps, Bounds::of(model));
        let h = dt / f64::from(substeps);
        let born = bounds.birth_warning(h);
        let corners = extremes(&bounds.bodies[..model.particles.len()]);
        let spectra: Vec<_> = corners.iter().filter_map(|corner| Spectrum::of(corner, &model.springs)).collect();
        let is_whole = |method: Method| not_judged(model, method).is_empty();
        let methods =
            Method::ALL.iter().map(|&method| stand(method, &bounds, &spectra, (h, is_whole(method)))).collect();
        let study = Self {
            scene: crate::load::name(path).into_owned(),
            dt,
            substeps,
            integrator: model.integrator.method.to_string(),
            particles: model.particles.len(),
            free: model.particles.iter().filter(|particle| !particle.fixed).count(),
            springs: model.springs.len(),
            emitters: model.emitters.len(),
            oscillations: spectra.first().map(oscillations),
            stiffest: bounds.stiffest,
            dragged: bounds.dragged,
            born,
            hit: bounds.contact.as_ref().map(Contact::duration),
            touching: bounds.contact.map(|contact| contact.part),
            led: bounds.goals.map(|goals| goals.part),
            filled: bounds.gas.map(|gas| gas.part),
            holds: bounds.holds,
            methods,
            followed: followed(model),
            // An orbit that takes far longer than the run is none.
            pair: fastest_pair(model, &bounds.bodies).filter(|pair| pair.period < 10.0 * run.duration),
            sinks: Pull::all(model, &bounds.bodies),
            not_judged: not_judged(model, model.integrator.method),
            judged_at_start: judged_at_start(model, model.integrator.method),
            advice: Vec::new(),
        };
        (study, spectra)
    }

    /// The step that methods take: one of the parts that the scene cuts each into.
    pub(crate) fn h(&self) -> f64 {
        self.dt / f64::from(self.substeps)
    }

    /// The step to give a run, as one types it, so that methods take such a step \[s\].
    pub(crate) fn typed(&self, step: f64) -> String {
        typed(step * f64::from(self.substeps))
    }
}

fn stand(method: Method, bounds: &Bounds, spectra: &[Spectrum], (h, is_whole): (f64, bool)) -> Stand {
    let at_rest = spectra.iter().fold(Limit::Unconditional, |least, modes| least.and(modes.largest_step(method)));
    let (every_pose, drag) = (bounds.poses_step(method), bounds.drag_step(method));
    let is_estimate = spectra.iter().any(|spectrum| spectrum.is_estimate(method));
    let mut stand = Stand {
        method: method.to_string(),
        chooses_steps: method.chooses_steps(),
        at_rest,
        // What no step or any is good for stays so, however many oscillations there are.
        estimated: is_estimate && matches!(at_rest, Limit::Step(_)),
        every_pose,
        drag,
        contact: bounds.contact_step(method),
        goal: bounds.goal_step(method),
        gas: bounds.gas_step(method),
        stable: method.chooses_steps() || bounds.largest_step(method).admits(h),
        verdict: Verdict::Stable,
        growth_across: bounds.growth(method, h),
    };
    stand.verdict = Verdict::on(&stand, h, is_whole);
    stand
}

fn oscillations(spectrum: &Spectrum) -> Oscillations {
    let mode = spectrum.fastest();
    let fastest = mode.rates().iter().map(|[re, im]| re.hypot(*im)).fold(0.0, f64::max);
    let damping_ratio = (mode.omega2 > 0.0).then(|| 0.5 * mode.damping / mode.omega2.sqrt());
    Oscillations { count: spectrum.modes.len(), how: spectrum.how, fastest, damping_ratio }
}
