//! Chains of links that are solved as one: ropes, strings, necklaces.

mod bounded;
mod links;

use super::{Bodies, Constraint, Demand, Share, Words};
use crate::math::{max, min, sqrt};
use bounded::{Bounds, Form};
use links::{Line, Links, NOBODY};

/// Links between particles, each to the next, all solved at once: C = |x₁ − x₂| − length of every link.
///
/// A link of compliance α stretches by α times the force through it, and a rigid chain is as long as its links, however many there
/// are and whatever the sub-steps: in each the tridiagonal system (∇C M⁻¹ ∇Cᵀ + α/h²) Δλ = −C − (α/h²) λ is solved directly, link
/// by link there and back, until lengths are met to rounding (Macklin, Müller and Chentanez, "XPBD", MIG 2016, equation 18; Deul et
/// al., "Direct Position-Based Solver for Stiff Rods", Computer Graphics Forum 37, 2018, section 4). Two or three such rounds are the
/// rule, and eight the most, of which each takes time in proportion to the number of links; where the sub-step is gone through in paces (below) there may be
/// up to 256 of these.
///
/// A damping β takes from the speed at which a link stretches what a force β times that speed does, by an implicit step at the
/// sub-step's end. Rigid links keep nothing of that speed: with `Verlet` that is RATTLE (Andersen, J. Comput. Phys. 52, 1983).
/// The energy that this gives in one sub-step it takes in another; of a rope that nobody holds it takes what goes beyond at once, from how it
/// moves against a rigid motion with the same momenta, and from the ways of soft links too, so that it never gains any, nor does what is left of it
/// in parts.
///
/// Linear momentum is kept to rounding, but not by a free rope whose links are made heavier (below); so is angular momentum, since links act along the directions that they had when the sub-step began.
/// Where one of them would turn by more than 30° in it (the end of a whip), or where links are so light for what pulls at
/// them that they would swing faster than the sub-step shows (a heavy bob), the sub-step is gone through in paces that are short enough for that, with the
/// forces that the method shows (as multiple time steps: Tuckerman, Berne and Martyna, J. Chem. Phys. 97, 1992): a pendulum swings in its time and as wide as
/// before, however heavy its bob is and however few the sub-steps are. The number of paces grows with that of links and with the root of how many times as heavy as the rope the
/// bob is; where 256 are too few (30 links of 0.3 m in all in one sub-step of 1/60 s that hold a thousand times their mass), links are made heavier meanwhile, which makes such a swing slower by
/// some hundredths. Rounding of what pulls makes light links swing: with a bob of a thousand times the rope's mass by up to some thousandths of the energy of the swing in half a minute.
/// A rope that does not come near its lengths even so goes by the directions that links have at the sub-step's end, which takes energy, or keeps the form that it had as
/// the sub-step began, if that was nearer, and is counted as capped in [`Effort`](crate::Effort).
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
/// Rounds of one that has to go by the directions that links have, at the most.
const LAST_ROUNDS: u32 = 24;
/// The cosine of how far a link may turn in a pace: by 30°.
const COSINE: f32 = 0.866;
/// The cosine of how far one may turn so that its energy is safe: by 15°.
const GENTLE: f32 = 0.966;
/// Paces of a sub-step, at the most.
const PACES: u32 = 256;
/// How often paces are tried, at the most.
const TRIES: u32 = 12;
/// The square of how far a particle may swing across its links in a pace, in radians of its oscillation: half of what is stable for a long chain.
const STIFF: f32 = 1.0;
/// How much of what links were off as a solution began may be left before its last round, and of a rounding: what is heavy is thrown about by the least
/// of what rounding leaves of the pull of what is light.
const FINELY: f32 = 1e-3;
const FINE: f32 = 0.01;
/// How far a link may be off after all rounds, a share of its length: what is left is rounding.
const NEARLY: f32 = 1e-4;

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
        let (links, rest) = Links::new(scratch, self.particles.as_ref().len(), self.links());
        for (row, &number) in links.rows.iter_mut().zip(self.particles.as_ref()) {
            *row = bodies.row_of_start(number).map_or(NOBODY, |row| row as u32);
        }
        (links, rest)
    }

    /// What it asks for where something holds it: nothing is kept of it.
    pub(super) fn demand_held(&self) -> Demand {
        let fixed = links::WORDS.saturating_mul(self.particles.as_ref().len());
        Demand { scratch: Words { per_row: 0, fixed }, ..Demand::NONE }
    }

    /// Tells whether a link does not pull where it is.
    fn is_slack(&self) -> impl Fn(usize, &Line) -> bool + use<'_, P, L> {
        |link, line| self.tether && line.distance <= self.length(link)
    }

    /// Changes velocities so that all links come to their lengths in a pace of so long \[s\], in a few rounds. Tells whether they have come near.
    fn meet(&self, links: &mut Links<'_>, time: f32, along: Way) -> bool {
        let (soft, mut worst, mut begun) = (self.compliance / (time * time), 0.0, 0.0);
        links.pull.fill(0.0);
        for round in 0..along.rounds() {
            let (mut met, mut lets_go, mut fine) = (true, false, true);
            (links.reach, worst) = (0.0, 0.0);
            for link in 0..links.count {
                let Some(line) = links.line(link) else { continue };
                let rest = self.length(link);
                let rounding = links.rounding(&line, rest);
                let open = line.longer + self.due(line.before - rest, links.share) + soft * links.pull[link];
                let slack = self.tether && links.pull[link] * (line.weight + soft) >= open;
                links.way[link] = if along == Way::First { line.first } else { line.normal };
                let turn = links.way[link].dot(line.normal);
                if turn < COSINE {
                    if !slack {
                        return false;
                    }
                    links.way[link] = line.normal;
                } else if !slack {
                    links.turn = min(links.turn, turn);
                }
                links.ask(link, slack, line.normal, open, line.weight);
                if slack {
                    lets_go |= links.pull[link] != 0.0;
                } else {
                    met &= open.abs() <= rounding;
                    fine &= open.abs() <= FINE * rounding;
                    worst = max(worst, open.abs() / (line.distance + rest));
                }
            }
            // Rounding of places is nothing to be made good at once.
            if !(links.reach > 0.0) || round == 0 && met && !lets_go && links.share == 1.0 {
                return true;
            }
            begun = if round == 0 { worst } else { begun };
            if along == Way::Now {
                // Straight across a taut link it takes the root of that to close a gap.
                let longest = self.lengths.as_ref().iter().copied().fold(0.0, max);
                links.reach += sqrt(0.5 * links.reach * longest);
            }
            if !links.solve(soft) {
                return false;
            }
            links.act(time);
            if !lets_go && (fine || round > 0 && worst < FINELY * begun) {
                return true;
            }
        }
        worst < NEARLY
    }

    /// By how much a link has to get shorter in a share of the sub-step that is so much too long as that begins \[m\]. A rigid one gets so fast as to do it in
    /// the whole of it: what was drawn out would be shot about, and what is heavy be thrown about by rounding of places.
    fn due(&self, off: f32, share: f32) -> f32 {
        let is_rigid = self.compliance == 0.0 && !(self.tether && off < 0.0);
        if is_rigid { off * share } else { off }
    }

    /// Goes through the sub-step from where all were as it began, by the forces that the method shows, in so many paces, and keeps to the lengths at each.
    /// Gives up where links turn too far in a pace or do not come near their lengths, and where particles swing too far across them: tells how far, squared.
    fn walk(&self, bodies: &Bodies<'_>, links: &mut Links<'_>, paces: u32) -> Result<(), f32> {
        let share = 1.0 / paces as f32;
        let time = bodies.substep.seconds() * share;
        links.set_out(bodies, paces as f32, self.is_slack());
        let before = links.vigour(bodies, 0.5 * share);
        for _ in 0..paces {
            links.kick(bodies, share);
            let met = self.meet(links, time, Way::First);
            let stiff = links.stiffness(|link| self.length(link));
            if !met || stiff > STIFF {
                return Err(stiff);
            }
            if self.tether {
                links.let_go(time);
            }
            links.go();
        }
        if links.turn < GENTLE {
            links.calm(bodies, links.vigour(bodies, 0.5 * share), before + 2.0 * links.work(bodies));
        }
        links.arrive(bodies, paces as f32, self.is_slack());
        Ok(())
    }

    /// The same in as few paces as will do. Where the most of them will not, who is too light for what pulls at him is made heavier. Tells whether that has
    /// come to an end.
    fn walk_through(&self, bodies: &Bodies<'_>, links: &mut Links<'_>) -> bool {
        let (mut paces, mut stiff) = (1, links.stiffness(|link| self.length(link)));
        for _ in 0..TRIES {
            if paces == PACES {
                links.load(0.5 * STIFF, |link| self.length(link));
            }
            // What has not come near tells little: no more than eight times as many.
            let wanted = paces as f32 * min(sqrt(stiff / STIFF), 8.0);
            paces *= 2;
            while (paces as f32) < wanted {
                paces *= 2;
            }
            paces = paces.min(PACES);
            match self.walk(bodies, links, paces) {
                Ok(()) => return true,
                Err(next) if paces == PACES && !(next > STIFF) => return false,
                Err(next) => stiff = next,
            }
        }
        false
    }

    /// Goes straight to where lengths are met next to where the method has moved all, by the directions that links have there. Gives a rope that has not
    /// come near its lengths the form back that it had when the sub-step began, if that was nearer. No energy comes of it.
    fn jump(&self, bodies: &mut Bodies<'_>, links: &mut Links<'_>) {
        let h = bodies.substep.seconds();
        links.take_up(bodies, h);
        let before = links.vigour(bodies, 0.0);
        if !self.meet(links, h, Way::Now) {
            bodies.report.effort.capped += 1;
            let off = self.worst(links);
            links.keep_form(bodies);
            if !(self.worst(links) < off) {
                links.take_up(bodies, h);
                let _ = self.meet(links, h, Way::Now);
            }
        }
        if self.tether {
            links.let_go(h);
        }
        links.hand_back(bodies, h);
        links.calm(bodies, links.vigour(bodies, 0.0), before);
        links.hand_back(bodies, 0.0);
    }

    /// How far the worst link is off, as a share of its length.
    fn worst(&self, links: &Links<'_>) -> f32 {
        let off = |link| {
            let (distance, rest) = (links.line(link)?.distance, self.length(link));
            let off = (distance - rest) / (distance + rest);
            Some(if self.tether { off } else { off.abs() })
        };
        (0..links.count).filter_map(off).fold(0.0, max)
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
        let (mut links, work) = self.links_of(bodies, share.scratch);
        if self.compliance > 0.0 {
            // Soft links answer forces by what they do in a whole sub-step, along the directions of its beginning, as a method of first order shows it:
            // with others what hangs still would show speed, and what swings would be driven.
            links.catch_up(bodies, self.is_slack());
        }
        let mut bounds = Bounds::of(self.form(), bodies, links.rows, share.kept.fixed, work);
        if let Some(bounds) = &mut bounds {
            bounds.limit(bodies);
        }
        links.take_up(bodies, h);
        let stiff = |links: &Links<'_>| links.stiffness(|link| self.length(link));
        if self.meet(&mut links, h, Way::First) && !(links.shown(bodies) * stiff(&links) > STIFF) {
            if self.tether {
                links.let_go(h);
            }
            if links.has_acted() {
                links.hand_back(bodies, h);
            }
        } else if self.walk_through(bodies, &mut links) {
            links.put_back(bodies);
        } else {
            self.jump(bodies, &mut links);
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
        links.take_up(bodies, 0.0);
        for _ in 0..if self.tether { ROUNDS } else { 1 } {
            let mut met = true;
            links.reach = 0.0;
            for link in 0..links.count {
                let Some(line) = links.line(link) else { continue };
                let rest = self.length(link);
                let loose = self.tether && line.distance < rest - 4.0 * links.rounding(&line, rest);
                let open = links.parting(&line).dot(line.normal) + soft * links.pull[link];
                let slack = loose || self.tether && links.pull[link] * (line.weight + soft) >= open;
                links.way[link] = line.normal;
                links.ask(link, slack, line.normal, open, line.weight);
                met &= slack && links.pull[link] == 0.0;
            }
            if met || !links.solve(soft) {
                break;
            }
            links.act(1.0);
        }
        if self.tether {
            links.let_go(1.0);
        }
        links.hand_back(bodies, 0.0);
        if let Some(bounds) = &mut bounds {
            bounds.keep_settled(bodies);
        }
    }
}

/// The directions along which links act.
#[derive(Clone, Copy, PartialEq)]
enum Way {
    /// Those that they have when the pace begins.
    First,
    /// Those that they have at its end.
    Now,
}

impl Way {
    fn rounds(self) -> u32 {
        match self {
            Self::First => ROUNDS,
            Self::Now => LAST_ROUNDS,
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
