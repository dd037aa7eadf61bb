//! Bounds that contacts by force put on the step: springs between balls that touch.

use super::body::Body;
use super::hit;
use super::part::Part;
use super::words::{time, typed};
use pointmass::Method;
use pointmass::force::Penalty;
use pointmass::scene::Model;
use pointmass::stability::{Limit, Mode};

/// The largest Σ cos² of the angles between a line and the ways to all that touch a ball of their size: two before and
/// behind it, and five at 60° around each.
const CROWD: f64 = 4.5;

/// Steps that a hit should have at least.
pub(crate) const STEPS: f64 = 7.5;

/// The contact of a scene that bounds the step most.
pub(crate) struct Contact {
    pub(crate) part: Part,
    /// The oscillations of contacts: of two balls, and of one among as many as may touch it.
    swings: Vec<Mode>,
    /// The decay by which friction stops the slip of two.
    slip: Option<Mode>,
}

impl Contact {
    /// None where no balls push each other apart.
    pub(crate) fn of(model: &Model, bodies: &[Body]) -> Option<Self> {
        let penalty = model.forces.2.first()?;
        // Of an emitter's balls one may touch the next.
        let count = |body: &Body| if body.is_born() { 2 } else { 1 };
        let is_ball = |body: &&Body| body.particle.radius > 0.0;
        let balls: Vec<_> = bodies.iter().filter(is_ball).flat_map(|body| vec![body; count(body)]).collect();
        let (mut free, fixed): (Vec<&Body>, Vec<&Body>) = balls.iter().partition(|ball| ball.is_free());
        free.sort_by(|a, b| a.mass[0].total_cmp(&b.mass[0]));
        let lightest = *free.first()?;
        let wall = fixed.into_iter().min_by(|a, b| a.mass[0].total_cmp(&b.mass[0]));
        let others: Vec<_> = free.get(1).copied().into_iter().chain(wall).collect();
        let crowd = if balls.iter().any(|ball| ball.is_born()) { CROWD } else { CROWD.min(balls.len() as f64 - 1.0) };
        let pairs = others.iter().map(|other| swing(penalty, lightest, other));
        let mode = pairs.clone().max_by(|a, b| a.omega2.total_cmp(&b.omega2))?;
        let most = |mode: Mode| Mode { omega2: crowd * mode.omega2, damping: crowd * mode.damping };
        let crowded = pairs.clone().map(most).filter(|_| crowd > 1.0);
        let swings = pairs.chain(crowded).collect();
        let slips = penalty.friction.kinetic > 0.0;
        // Slowly, friction brakes as what would just not let the contact swing.
        let slip = slips.then(|| Mode { omega2: 0.0, damping: 2.0 * mode.omega2.sqrt() });
        let Penalty { stiffness, damping, .. } = *penalty;
        let about = format!(
            "({}) touching {} ({}): stiffness {stiffness}, damping {damping}",
            lightest.weight(),
            others[0].place(model),
            others[0].weight()
        );
        Some(Self { part: Part { place: lightest.place(model), spring: None, about, mode }, swings, slip })
    }

    /// The largest step in which hits add no energy, and lasting contacts do not grow.
    pub(crate) fn largest_step(&self, method: Method) -> Limit {
        let swings = self.swings.iter().map(|&mode| hit::largest_step(method, mode));
        let slip = self.slip.iter().map(|mode| mode.largest_step(method));
        swings.chain(slip).fold(Limit::Unconditional, Limit::and)
    }

    /// The warning about steps \[s\] that do hits no justice, so many of which are one of the run's.
    pub(crate) fn warning(&self, method: Method, step: f64, substeps: f64) -> Option<String> {
        let (steps, hit) = (time(step), self.duration());
        let Part { place, about, .. } = &self.part;
        match self.largest_step(method) {
            Limit::Step(limit) if step > limit => Some(format!(
                "steps of {steps} are too long for contacts by force: beyond {} hits by {method} add energy, because of \
                 {place} {about}; try --substeps auto, or see `pointmass check`",
                time(limit)
            )),
            _ if step * STEPS > hit => Some(format!(
                "steps of {steps} are coarse for contacts by force: a hit lasts {}, and its bounce comes out wrong, because \
                 of {place} {about}; try --dt {}",
                time(hit),
                typed(0.1 * hit * substeps)
            )),
            _ => None,
        }
    }

    /// The duration of a hit \[s\]: half a swing.
    pub(crate) fn duration(&self) -> f64 {
        let Mode { omega2, damping } = self.part.mode;
        std::f64::consts::PI / (omega2 - 0.25 * damping * damping).max(0.1 * omega2).sqrt()
    }
}

/// The oscillation of two against each other while they touch.
fn swing(penalty: &Penalty, ball: &Body, other: &Body) -> Mode {
    let [mass, other_mass] = [ball, other].map(|ball| ball.mass[0]);
    let inverse = 1.0 / mass + if other.is_free() { 1.0 / other_mass } else { 0.0 };
    // Its damping counts what is fixed by the mass it has, if it has any.
    let reduced = if other_mass > 0.0 { mass * other_mass / (mass + other_mass) } else { mass };
    let stiffness = f64::from(penalty.stiffness);
    let damping = 2.0 * f64::from(penalty.damping) * (stiffness * reduced).sqrt();
    Mode { omega2: stiffness * inverse, damping: damping * inverse }
}
