//! Chains of links that are solved as one: ropes, strings, necklaces.

mod bounded;
mod links;

use super::{Bodies, Constraint, Demand, Share, Words};
use crate::index::between;
use crate::math::{clamp, floor, largest, length, max, sqrt};
use crate::memory::take;
use bounded::{Bounds, Form};
use glam::Vec3;
use links::{Links, NOBODY, put};

/// Links between particles, each to the next, all solved at once: C = |x₁ − x₂| − length of every link.
///
/// A link of compliance α stretches by α times the force through it, and a rigid chain is as long as its links, however many there
/// are and whatever the sub-steps: in each the tridiagonal system (∇C M⁻¹ ∇Cᵀ + α/h²) Δλ = −C − (α/h²) λ is solved directly, link
/// by link there and back, until lengths are met to rounding (Macklin, Müller and Chentanez, "XPBD", MIG 2016, equation 18; Deul et
/// al., "Direct Position-Based Solver for Stiff Rods", Computer Graphics Forum 37, 2018, section 4). Two or three such rounds are the
/// rule, and eight the most, of which each takes time in proportion to the number of links; where the sub-step is gone through in paces (below) there may be
/// up to 64 of these, of three rounds each, the last of 24.
///
/// A damping β takes from the speed at which a link stretches what a force β times that speed does, by an implicit step at the
/// sub-step's end. Rigid links keep nothing of that speed: with `Verlet` that is RATTLE (Andersen, J. Comput. Phys. 52, 1983).
/// The energy that this gives in one sub-step it takes in another; of a rope that nobody holds it takes what goes beyond at once, from how it
/// moves against a rigid motion with the same momenta, and from the ways of soft links too, so that it never gains any, nor does what is left of it
/// in parts.
///
/// Linear momentum is kept to rounding; so is angular momentum, since links act along the directions that they had when the sub-step began,
/// as long as none of them turns by more than 60° in a sub-step. Where one does (the end of a whip), or where links are so light for what pulls at
/// them that they would swing faster than sub-steps show (a heavy bob), the sub-step is gone through in paces along the directions that links then
/// have, which takes energy and angular momentum out of the motion, never puts any in; a rope that nobody holds is given the latter back. A rope
/// that does not come near its lengths even then keeps the form that it had as the sub-step began, if that was nearer, and is counted as capped in
/// [`Effort`](crate::Effort).
///
/// What nobody holds is given back what rounding of its places takes of its angular momentum about its middle, wherever it is. What is straight, to eight
/// roundings of its coordinates, ε |x|, cannot have any about itself: until it bends it may be without a share of 2e-5 + 8 ε |x| / r of all, r being how far its
/// ends are from its middle. Far off, rounding strains soft links by α⁻¹ (2 ε |x|)² / 2 each, which counts for nothing in its energy; and it drives them: a soft rope
/// that has come to all the energy it may have turns slower for a while (in 50 sub-steps by up to 1 % 30 m off, by 5 % at 100 m; one of a single link so soft
/// that it is slack most of the time, by a third within a minute at 30 m).
///
/// Whoever is fixed stays. Where a particle has died the chain is broken: both its links do nothing. A link whose ends are in one place
/// has no direction, and does nothing either. No particle may be named twice: a rope does not meet itself. In a
/// [periodic room](crate::index::Periodic) links act along the shortest way through the sides.
///
/// ```
/// use pointmass::constrain::Rope;
/// use pointmass::{Gravity, Heap, Particle, Scene, System, Time, Vec3};
///
/// // Half a metre of chain, held at one end.
/// let link = |i: usize| Particle { position: Vec3::X * (0.05 * i as f32), fixed: i == 0, ..Particle::REST };
/// let start: [Particle; 11] = core::array::from_fn(link);
/// let particles: [u32; 11] = core::array::from_fn(|i| i as u32);
/// let rope = Rope::rigid(particles, [0.05]);
/// let scene = Scene { start: &start, forces: &Gravity::EARTH, constraints: &rope, substeps: 5, ..Scene::EMPTY };
/// let mut system = System::with(Heap::new(scene.size()));
/// system.start(&scene, 1)?;
/// for frame in 1..=60 {
///     system.step_to(&scene, Time::frame(frame, 60));
/// }
/// let links = system.particles().position.windows(2).map(|ends| ends[0].distance(ends[1]));
/// assert!(links.into_iter().all(|length| (length - 0.05).abs() < 1e-6));
/// # Ok::<(), pointmass::InsufficientMemory>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Rope<P, L> {
    /// The particles, by their place in the scene's start, from one end to the other.
    pub particles: P,
    /// How long the links are, in the same order \[m\]; the last of the lengths holds for all further links.
    pub lengths: L,
    /// α: how far each link gives way to a force \[m/N\]; zero is rigid.
    #[cfg_attr(feature = "serde", serde(default))]
    pub compliance: f32,
    /// β: the force of each link against being stretched, for the speed of that \[N s/m\].
    #[cfg_attr(feature = "serde", serde(default))]
    pub damping: f32,
    /// True if links only pull, as those of a string do.
    #[cfg_attr(feature = "serde", serde(default))]
    pub tether: bool,
    /// True if one more link joins the last particle to the first.
    #[cfg_attr(feature = "serde", serde(default))]
    pub closed: bool,
}

/// Rounds of a solution, at the most.
const ROUNDS: u32 = 8;
/// The cosine of how far a link may turn in one: by 60°.
const COSINE: f32 = 0.5;
/// Paces of a sub-step in which links turn farther, at the most.
const PACES: f32 = 64.0;
/// Rounds of the last pace, at the most.
const LAST_ROUNDS: u32 = 24;
/// The square of how far a particle may swing across its links in a sub-step, in radians of its oscillation: half of what is stable.
const STIFF: f32 = 2.0;
/// How far a link may be off after all rounds, a share of its length: what is left is rounding.
const NEARLY: f32 = 1e-4;
/// Words that the links take for each particle.
const WORDS: usize = 14;

impl<P, L> Rope<P, L> {
    /// A chain of rigid links.
    #[must_use]
    pub const fn rigid(particles: P, lengths: L) -> Self {
        Self { particles, lengths, compliance: 0.0, damping: 0.0, tether: false, closed: false }
    }

    /// A string that does not stretch, and does not push.
    #[must_use]
    pub const fn string(particles: P, lengths: L) -> Self {
        Self { particles, lengths, compliance: 0.0, damping: 0.0, tether: true, closed: false }
    }
}

impl<P: AsRef<[u32]>, L: AsRef<[f32]>> Rope<P, L> {
    /// The first of its numbers that cannot be used, and what it has to be.
    #[must_use]
    pub fn fault(&self) -> Option<(&'static str, &'static str)> {
        let not_negative = |x: f32| (0.0..f32::INFINITY).contains(&x);
        let (particles, lengths) = (self.particles.as_ref(), self.lengths.as_ref());
        let faults = [
            (particles.len() < 2, "particles", "has to name two particles or more"),
            (self.closed && particles.len() < 3, "particles", "has to name three particles or more where it is closed"),
            (lengths.is_empty(), "lengths", "has to hold the length of a link at least, in m"),
            (lengths.len() > self.links(), "lengths", "must not hold more lengths than there are links"),
            (!lengths.iter().all(|&x| not_negative(x)), "lengths", "must not be below zero, in m"),
            (!not_negative(self.compliance), "compliance", "must not be below zero, in m/N"),
            (!not_negative(self.damping), "damping", "must not be below zero, in N s/m"),
        ];
        faults.into_iter().find(|&(wrong, ..)| wrong).map(|(_, name, message)| (name, message))
    }

    /// The number of links.
    fn links(&self) -> usize {
        let particles = self.particles.as_ref().len();
        if self.closed && particles > 2 { particles } else { particles.saturating_sub(1) }
    }

    /// How long a link is to be.
    fn length(&self, link: usize) -> f32 {
        self.form().length(link)
    }

    /// Its form at rest, on which its energy depends.
    fn form(&self) -> Form<'_> {
        let (particles, lengths) = (self.particles.as_ref().len(), self.lengths.as_ref());
        let Self { compliance, tether, .. } = *self;
        Form { particles, lengths, compliance, tether, closed: self.links() == particles }
    }

    /// Its particles and the memory for its links, with nothing known of these, and what is left of it.
    fn links_of<'m>(&self, bodies: &Bodies<'_>, scratch: &'m mut [u32]) -> (Links<'m>, &'m mut [u32]) {
        let (mut rest, count) = (scratch, self.particles.as_ref().len());
        let links = Links::new(take(&mut rest, WORDS * count), count, self.links());
        for (row, &number) in links.rows.iter_mut().zip(self.particles.as_ref()) {
            *row = bodies.row_of_start(number).map_or(NOBODY, |row| row as u32);
        }
        (links, rest)
    }

    /// What it asks for where something holds it: nothing is kept of it.
    pub(super) fn demand_held(&self) -> Demand {
        let fixed = WORDS.saturating_mul(self.particles.as_ref().len());
        Demand { scratch: Words { per_row: 0, fixed }, ..Demand::NONE }
    }

    /// Brings all links to their lengths, in a few rounds. Tells whether they have come near.
    fn meet(&self, bodies: &mut Bodies<'_>, links: &mut Links<'_>, soft: f32, along: Way) -> bool {
        let (h, mut worst) = (bodies.substep.seconds(), 0.0);
        let longest = self.lengths.as_ref().iter().copied().fold(0.0, max);
        for round in 0..along.rounds() {
            let mut met = true;
            (links.reach, worst) = (0.0, 0.0);
            for link in 0..links.count {
                let Some(line) = links.line(bodies, link) else { continue };
                let [p, q] = line.rows;
                let weight = bodies.inverse_mass[p] + bodies.inverse_mass[q];
                let rest = self.length(link);
                let open = line.distance - rest + soft * links.pull[link];
                let slack = self.tether && links.pull[link] * (weight + soft) >= open;
                if let Way::Now(_) = along {
                    links.way[link] = line.normal;
                } else if round == 0 {
                    let earlier = line.apart - (bodies.velocity[p] - bodies.velocity[q]) * h;
                    let far = length(earlier);
                    links.way[link] = if far > 0.0 && far < f32::INFINITY { earlier / far } else { line.normal };
                }
                if links.way[link].dot(line.normal) < COSINE {
                    if !slack {
                        return false;
                    }
                    links.way[link] = line.normal;
                }
                links.ask(link, slack, line.normal, open, weight);
                let x = [p, q].map(|row| bodies.position[row]);
                if slack {
                    met &= links.pull[link] == 0.0;
                } else {
                    met &= open.abs() <= Self::rounding(x, line.distance, rest);
                    worst = max(worst, open.abs() / (line.distance + rest));
                }
            }
            if met {
                return true;
            }
            if let Way::Now(_) = along {
                // Straight across a taut link it takes the root of that to close a gap.
                links.reach += sqrt(0.5 * links.reach * longest);
            }
            if !links.solve(bodies, soft) {
                return false;
            }
            links.act(bodies, &mut |bodies, row, by| bodies.shift(row, by));
        }
        worst < NEARLY
    }

    /// Goes from where all were as the sub-step began to where the method has moved them, in paces so short that no link turns far in
    /// one, and keeps to the lengths at each. That costs energy, and never brings any: nobody gets farther than he was to go.
    fn walk(&self, bodies: &mut Bodies<'_>, links: &mut Links<'_>, soft: f32) {
        let mut turn = 0.0;
        for link in 0..links.count {
            let ends = links.ends(link).map(|end| (links.rows[end] as usize, links.aim[end]));
            let [(p, to), (q, other)] = ends;
            if p < bodies.len() && q < bodies.len() {
                let [x, y] = [p, q].map(|row| bodies.before[0][row]);
                let apart = between(bodies.near.room(), y, x);
                let turned = length((to - x) - (other - y)) / max(length(apart), self.length(link));
                turn = if turned > turn { turned } else { turn };
            }
        }
        let paces = floor(clamp(2.0 * turn, 0.0, PACES - 1.0)) + 1.0;
        links.pull.fill(0.0);
        links.start_over(bodies);
        let mut met = true;
        for pace in 1..=paces as u32 {
            links.pace(bodies, pace as f32 / paces, 1.0 / paces);
            met = self.meet(bodies, links, soft, Way::Now(if pace as f32 == paces { LAST_ROUNDS } else { 3 }));
        }
        if !met {
            bodies.report.effort.capped += 1;
            self.hold(bodies, links);
        }
    }

    /// Gives a rope that has not come near its lengths the form back that it had when the sub-step began, if that was nearer: in the middle of all
    /// of its masses if nobody is fixed, which keeps its momentum.
    fn hold(&self, bodies: &mut Bodies<'_>, links: &mut Links<'_>) {
        let (mut sum, mut mass, mut is_free) = (Vec3::ZERO, 0.0, true);
        let rows = links.rows.iter().map(|&row| row as usize).zip(links.aim.iter());
        for (row, &aim) in rows.filter(|&(row, _)| row < bodies.len()) {
            is_free &= bodies.inverse_mass[row] > 0.0;
            sum += (aim - bodies.before[0][row]) * bodies.mass[row];
            mass += bodies.mass[row];
        }
        let way = if is_free && mass > 0.0 { sum / mass } else { Vec3::ZERO };
        let place = |bodies: &Bodies<'_>, end: usize| {
            let row = links.rows[end] as usize;
            let moves = bodies.inverse_mass[row] > 0.0;
            if moves { bodies.before[0][row] + way } else { links.aim[end] }
        };
        let (mut now, mut then) = (0.0, 0.0);
        for link in 0..links.count {
            let Some(line) = links.line(bodies, link) else { continue };
            let [one, other] = links.ends(link).map(|end| place(bodies, end));
            let rest = self.length(link);
            let off = |distance: f32| {
                let off = (distance - rest) / (distance + rest);
                if self.tether { max(off, 0.0) } else { off.abs() }
            };
            now = max(now, off(line.distance));
            then = max(then, off(length(between(bodies.near.room(), other, one))));
        }
        if !(then < now) {
            return;
        }
        for (particle, row) in links.rows.iter().map(|&row| row as usize).enumerate() {
            if row < bodies.len() {
                let to = place(bodies, particle);
                put(bodies, row, to - bodies.position[row], to);
            }
        }
        // Nothing pulls that could be taken back.
        links.pull.fill(0.0);
    }

    /// Tells whether a particle is so light for what pulls at it that it would swing across its links faster than the sub-step shows. Along the
    /// directions of before it would be driven on and on by what it should only follow.
    fn is_stiff(&self, bodies: &Bodies<'_>, links: &Links<'_>) -> bool {
        // What swings across a link is pulled back by its pull over the length that it has.
        let pull = |link: usize| {
            let length = links.line(bodies, link).map_or(0.0, |line| line.distance);
            links.pull[link].abs() / max(length, self.length(link))
        };
        (0..links.count).any(|link| {
            let [_, other] = links.ends(link);
            let next = if other < links.count { pull(other) } else { 0.0 };
            // Past the end of an open chain nothing pulls back.
            let weight = bodies.inverse_mass.get(links.rows[other] as usize).copied().unwrap_or(0.0);
            next > 0.0 && weight * (pull(link) + next) > STIFF
        })
    }

    /// Takes out of the places the method's own way beyond where velocities lead: of all, if somebody is fixed, else what lengths show of it. Soft
    /// links answer forces by what they do in a whole sub-step, along the directions of its beginning, as a method of first order shows it: with others what
    /// hangs still would show speed, and what swings would be driven.
    fn catch_up(&self, bodies: &mut Bodies<'_>, links: &mut Links<'_>) {
        let living = || links.rows.iter().map(|&row| row as usize).filter(|&row| row != NOBODY as usize);
        if living().any(|row| !(bodies.inverse_mass[row] > 0.0)) {
            return living().for_each(|row| bodies.catch_up(row));
        }
        let h = bodies.substep.seconds();
        links.reach = 0.0;
        for link in 0..links.count {
            let Some(line) = links.line(bodies, link) else { continue };
            let [p, q] = line.rows;
            let [ahead, behind] = [p, q].map(|row| bodies.lead(row, h));
            let weight = bodies.inverse_mass[p] + bodies.inverse_mass[q];
            links.way[link] = line.normal;
            let slack = self.tether && line.distance <= self.length(link);
            links.ask(link, slack, line.normal, (ahead - behind).dot(line.normal), weight);
        }
        if links.reach > 0.0 && links.solve(bodies, 0.0) {
            links.act(bodies, &mut |bodies, row, by| bodies.position[row] += by);
        }
    }

    /// The rounding of a link's length, from where its ends are.
    fn rounding(x: [Vec3; 2], distance: f32, length: f32) -> f32 {
        f32::EPSILON * (max(largest(x[0]), largest(x[1])) + distance + length)
    }
}

impl<P: AsRef<[u32]> + Sync, L: AsRef<[f32]> + Sync> Constraint for Rope<P, L> {
    fn demand(&self) -> Demand {
        let bounds = bounded::demand(self.particles.as_ref().len());
        Demand { scratch: bounds.scratch.and(self.demand_held().scratch), ..bounds }
    }

    fn is_empty(&self) -> bool {
        self.links() == 0
    }

    fn prepare(&self, _: &mut Bodies<'_>, share: &mut Share<'_>) {
        share.claim(*b"rope", &[]);
    }

    fn project(&self, bodies: &mut Bodies<'_>, share: &mut Share<'_>) {
        let h = bodies.substep.seconds();
        if !(h > 0.0) {
            return;
        }
        let soft = self.compliance / (h * h);
        let (mut links, work) = self.links_of(bodies, share.scratch);
        if soft > 0.0 {
            self.catch_up(bodies, &mut links);
            // Nothing is known of them any longer.
            links.pull.fill(0.0);
            links.normal.fill(Vec3::ZERO);
            links.change.fill(0.0);
        }
        let mut bounds = Bounds::of(self.form(), bodies, links.rows, share.kept.fixed, work);
        if let Some(bounds) = &mut bounds {
            bounds.limit(bodies);
        }
        links.aim_at(bodies);
        if !self.meet(bodies, &mut links, soft, Way::First) || self.is_stiff(bodies, &links) {
            let before = links.vigour(bodies);
            self.walk(bodies, &mut links, soft);
            links.calm(bodies, before);
        }
        if self.tether {
            links.let_go(bodies, &mut |bodies, row, by| bodies.shift(row, by));
        }
        if let Some(bounds) = &mut bounds {
            bounds.keep_within(bodies);
        }
    }

    fn settle(&self, bodies: &mut Bodies<'_>, share: &mut Share<'_>) {
        let brake = self.damping * bodies.substep.seconds();
        let soft = if self.compliance > 0.0 { 1.0 / brake } else { 0.0 };
        if !(soft < f32::INFINITY) {
            return;
        }
        let (mut links, work) = self.links_of(bodies, share.scratch);
        let mut bounds = Bounds::of(self.form(), bodies, links.rows, share.kept.fixed, work);
        if let Some(bounds) = &mut bounds {
            bounds.limit_settled(bodies);
        }
        let rounds = if self.tether { ROUNDS } else { 1 };
        let turn = |bodies: &mut Bodies<'_>, row: usize, by: Vec3| bodies.velocity[row] += by;
        for _ in 0..rounds {
            let mut met = true;
            links.reach = 0.0;
            for link in 0..links.count {
                let Some(line) = links.line(bodies, link) else { continue };
                let [p, q] = line.rows;
                let weight = bodies.inverse_mass[p] + bodies.inverse_mass[q];
                let rest = self.length(link);
                let x = [p, q].map(|row| bodies.position[row]);
                let loose = self.tether && line.distance < rest - 4.0 * Self::rounding(x, line.distance, rest);
                let open = (bodies.velocity[p] - bodies.velocity[q]).dot(line.normal) + soft * links.pull[link];
                let slack = loose || self.tether && links.pull[link] * (weight + soft) >= open;
                links.way[link] = line.normal;
                links.ask(link, slack, line.normal, open, weight);
                met &= slack && links.pull[link] == 0.0;
            }
            if met || !links.solve(bodies, soft) {
                break;
            }
            links.act(bodies, &mut { turn });
        }
        if self.tether {
            links.let_go(bodies, &mut { turn });
        }
        if let Some(bounds) = &mut bounds {
            bounds.keep_settled(bodies);
        }
    }
}

/// The directions along which links act.
#[derive(Clone, Copy)]
enum Way {
    /// Those that they had when the sub-step began.
    First,
    /// Those that they have, in so many rounds.
    Now(u32),
}

impl Way {
    fn rounds(self) -> u32 {
        match self {
            Self::First => ROUNDS,
            Self::Now(rounds) => rounds,
        }
    }
}

#[cfg(feature = "alloc")]
impl<P: AsRef<[u32]> + Sync, L: AsRef<[f32]> + Sync> super::declared::Declared for Rope<P, L> {
    fn fault(&self) -> Option<(&'static str, &'static str)> {
        Self::fault(self).or_else(|| super::declared::twice(self.particles.as_ref()))
    }

    fn ends(&self) -> [&[u32]; 3] {
        [self.particles.as_ref(), &[], &[]]
    }

    fn chain(&self) -> (&[u32], bool) {
        (self.particles.as_ref(), self.closed)
    }

    fn lengths(&self) -> &[f32] {
        self.lengths.as_ref()
    }
}
