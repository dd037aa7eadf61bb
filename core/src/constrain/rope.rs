//! Chains of links that are solved as one: ropes, strings, necklaces.

use super::{Bodies, Constraint, Demand, Share, Words};
use crate::index::between;
use crate::math::{clamp, floor, largest, length, max, sqrt};
use crate::memory::take;
use glam::Vec3;

/// Links between particles, each to the next, all solved at once: C = |x₁ − x₂| − length of every link.
///
/// A link of compliance α stretches by α times the force through it, and a rigid chain is as long as its links, however many there
/// are and whatever the sub-steps: in each the tridiagonal system (∇C M⁻¹ ∇Cᵀ + α/h²) Δλ = −C − (α/h²) λ is solved directly, link
/// by link there and back, until lengths are met to rounding (Macklin, Müller and Chentanez, "XPBD", MIG 2016, equation 18; Deul et
/// al., "Direct Position-Based Solver for Stiff Rods", Computer Graphics Forum 37, 2018, section 4). Two or three such rounds are the
/// rule, and eight the most. The time that it takes grows with the number of links alone.
///
/// A damping β takes from the speed at which a link stretches what a force β times that speed does, by an implicit step at the
/// sub-step's end. Rigid links keep nothing of that speed: with `Verlet` that is RATTLE (Andersen, J. Comput. Phys. 52, 1983).
///
/// Linear momentum is kept to rounding; so is angular momentum, since links act along the directions that they had when the sub-step began,
/// as long as none of them turns by more than 60° in a sub-step. Where one does (the end of a whip), the sub-step is gone through in paces,
/// which takes energy and angular momentum out of the motion, never puts any in. What is off even then is counted as capped in
/// [`Effort`](crate::Effort).
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
/// What a pivot is at the least for each link, a share of the first end's weight: chains that are stretched straight between two fixed ends
/// leave the system singular.
const RIDGE: f32 = 1e-6;
/// Words that each particle takes.
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
        let lengths = self.lengths.as_ref();
        lengths.get(link).or(lengths.last()).copied().unwrap_or(0.0)
    }

    /// Its particles and the memory for its links, with nothing known of these.
    fn links_of<'m>(&self, bodies: &Bodies<'_>, share: &'m mut Share<'_>) -> Links<'m> {
        let links = Links::new(share.scratch, self.particles.as_ref().len(), self.links());
        for (row, &number) in links.rows.iter_mut().zip(self.particles.as_ref()) {
            *row = bodies.row_of_start(number).map_or(NOBODY, |row| row as u32);
        }
        links
    }

    /// Brings all links to their lengths, in a few rounds. Tells whether they have come near.
    fn meet(&self, bodies: &mut Bodies<'_>, links: &mut Links<'_>, soft: f32, along: Way) -> bool {
        let h = bodies.substep.seconds();
        let longest = self.lengths.as_ref().iter().copied().fold(0.0, max);
        let mut worst = 0.0;
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
    fn hold(&self, bodies: &mut Bodies<'_>, links: &Links<'_>) {
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
    }

    /// Tells whether a particle is so light for what pulls at it that it would swing across its links faster than the sub-step shows. Along the
    /// directions of before it would be driven on and on by what it should only follow.
    fn is_stiff(&self, bodies: &Bodies<'_>, links: &Links<'_>) -> bool {
        let pull = |link: usize| links.pull[link].abs() / self.length(link);
        (0..links.count).any(|link| {
            let [one, other] = links.ends(link);
            let next = if other < links.count { pull(other) } else { 0.0 };
            // Past the end of an open chain nothing pulls back.
            let weight = bodies.inverse_mass.get(links.rows[other] as usize).copied().unwrap_or(0.0);
            one != other && next > 0.0 && weight * (pull(link) + next) > STIFF
        })
    }

    /// Takes out of the places what lengths show of the method's own way beyond where velocities lead. Soft links answer forces by what they
    /// do in a whole sub-step, as a method of first order shows it; what hangs still would show speed with others.
    fn catch_up(&self, bodies: &mut Bodies<'_>, links: &mut Links<'_>) {
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
        links.pull.fill(0.0);
        links.normal.fill(Vec3::ZERO);
    }

    /// The rounding of a link's length, from where its ends are.
    fn rounding(x: [Vec3; 2], distance: f32, length: f32) -> f32 {
        f32::EPSILON * (max(largest(x[0]), largest(x[1])) + distance + length)
    }
}

impl<P: AsRef<[u32]> + Sync, L: AsRef<[f32]> + Sync> Constraint for Rope<P, L> {
    fn demand(&self) -> Demand {
        let words = WORDS.saturating_mul(self.particles.as_ref().len());
        Demand { scratch: Words { per_row: 0, fixed: words }, ..Demand::NONE }
    }

    fn is_empty(&self) -> bool {
        self.links() == 0
    }

    fn project(&self, bodies: &mut Bodies<'_>, share: &mut Share<'_>) {
        let h = bodies.substep.seconds();
        if !(h > 0.0) {
            return;
        }
        let mut links = self.links_of(bodies, share);
        let soft = self.compliance / (h * h);
        if soft > 0.0 {
            self.catch_up(bodies, &mut links);
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
    }

    fn settle(&self, bodies: &mut Bodies<'_>, share: &mut Share<'_>) {
        let brake = self.damping * bodies.substep.seconds();
        let soft = if self.compliance > 0.0 { 1.0 / brake } else { 0.0 };
        if !(soft < f32::INFINITY) {
            return;
        }
        let mut links = self.links_of(bodies, share);
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

/// The row of a particle that is not there.
const NOBODY: u32 = u32::MAX;

/// Moves a particle, and its velocity with it; puts one that is fixed to a place, and leaves its velocity.
fn put(bodies: &mut Bodies<'_>, row: usize, by: Vec3, to: Vec3) {
    if bodies.inverse_mass[row] > 0.0 {
        bodies.shift(row, by);
    } else {
        bodies.position[row] = to;
    }
}

/// The links of a chain in a sub-step. Link i joins the particles i and i + 1, the last one of a closed chain its last and first.
struct Links<'m> {
    /// The number of links.
    count: usize,
    /// How far it all goes wrong, summed over the links: nothing is moved farther than twice that.
    reach: f32,
    /// The row of each particle.
    rows: &'m mut [u32],
    /// λ of each link, below zero where it pulls [kg m], or [kg m/s] where velocities are settled.
    pull: &'m mut [f32],
    /// By how much the link has to get longer; when it has been solved, the change of its λ.
    change: &'m mut [f32],
    /// What elimination has left beside the diagonal, and of the column of the link that closes the chain.
    upper: &'m mut [f32],
    border: &'m mut [f32],
    /// The direction that each link has, to its first end; zero if it is not to act.
    normal: &'m mut [Vec3],
    /// The direction along which it acts.
    way: &'m mut [Vec3],
    /// Where the method has moved each particle.
    aim: &'m mut [Vec3],
}

/// A link as it lies.
struct Line {
    rows: [usize; 2],
    apart: Vec3,
    distance: f32,
    normal: Vec3,
}

impl<'m> Links<'m> {
    /// Memory for them, in which nothing acts.
    fn new(words: &'m mut [u32], particles: usize, links: usize) -> Self {
        let mut rest = words;
        let rows = take(&mut rest, particles);
        rows.fill(NOBODY);
        let mut floats = |count: usize| {
            let words = take(&mut rest, count);
            words.fill(0);
            words
        };
        let [pull, change, upper, border] = core::array::from_fn(|_| bytemuck::cast_slice_mut(floats(particles)));
        let [normal, way, aim] = core::array::from_fn(|_| bytemuck::cast_slice_mut(floats(3 * particles)));
        let count = links.min(aim.len());
        Self { count, reach: 0.0, rows, pull, change, upper, border, normal, way, aim }
    }

    /// The numbers of a link's ends among the particles.
    fn ends(&self, link: usize) -> [usize; 2] {
        let next = link + 1;
        [link, if next == self.rows.len() { 0 } else { next }]
    }

    /// A link as it lies; none if it cannot act.
    fn line(&self, bodies: &Bodies<'_>, link: usize) -> Option<Line> {
        let rows = self.ends(link).map(|end| self.rows[end] as usize);
        let [p, q] = rows;
        if p >= bodies.len() || q >= bodies.len() || !(bodies.inverse_mass[p] + bodies.inverse_mass[q] > 0.0) {
            return None;
        }
        let apart = bodies.between(q, p);
        let distance = length(apart);
        (distance > 0.0 && distance < f32::INFINITY).then(|| Line { rows, apart, distance, normal: apart / distance })
    }

    /// Asks a link to close what it is open by; one that is slack lets go of what it has pulled.
    fn ask(&mut self, link: usize, slack: bool, normal: Vec3, open: f32, weight: f32) {
        let pull = self.pull[link];
        (self.normal[link], self.change[link]) = if slack { (Vec3::ZERO, -pull) } else { (normal, -open) };
        self.reach += if slack { pull.abs() * weight } else { open.abs() };
    }

    /// Minus what λ of a neighbour changes in a link, through the particle that both have.
    fn coupling(&self, bodies: &Bodies<'_>, link: usize, neighbour: usize, particle: usize) -> f32 {
        let row = self.rows[particle] as usize;
        if row < bodies.len() { bodies.inverse_mass[row] * self.normal[link].dot(self.way[neighbour]) } else { 0.0 }
    }

    /// What λ of a link changes in itself; one if it is not to act.
    fn diagonal(&self, bodies: &Bodies<'_>, link: usize, soft: f32) -> f32 {
        if self.normal[link] == Vec3::ZERO {
            return 1.0;
        }
        let [p, q] = self.ends(link).map(|end| bodies.inverse_mass[self.rows[end] as usize]);
        (p + q) * self.normal[link].dot(self.way[link]) * (1.0 + RIDGE) + soft
    }

    /// What elimination of the links before leaves of a link's λ in itself, through its first end alone.
    fn remains(&self, bodies: &Bodies<'_>, link: usize, left: f32, pivot: f32) -> f32 {
        if self.normal[link] == Vec3::ZERO {
            return 0.0;
        }
        let (own, weight) = (self.normal[link].dot(self.way[link]), bodies.inverse_mass[self.rows[link] as usize]);
        match link.checked_sub(1).filter(|&i| self.normal[i] != Vec3::ZERO) {
            // (n₁·w₁)(n₀·w₀) − (n₁·w₀)(n₀·w₁) = (n₁ × n₀)·(w₁ × w₀).
            Some(i) => {
                let bend = self.normal[link].cross(self.normal[i]).dot(self.way[link].cross(self.way[i]));
                weight * ((own * left + weight * bend) / pivot)
            }
            None => weight * own,
        }
    }

    /// The pivot of a link of whose own such a rest is left.
    fn pivot(&self, bodies: &Bodies<'_>, link: usize, left: f32) -> f32 {
        if self.normal[link] == Vec3::ZERO {
            return 1.0;
        }
        let [first, second] = self.ends(link).map(|end| bodies.inverse_mass[self.rows[end] as usize]);
        let own = self.normal[link].dot(self.way[link]);
        let least = if second > 0.0 { 0.5 * second } else { RIDGE * self.count as f32 * first };
        max(own * second + left, least * own)
    }

    /// Solves for the changes of λ: elimination from the first link to the last, and back. Tells whether there is a solution.
    fn solve(&mut self, bodies: &Bodies<'_>, soft: f32) -> bool {
        let closed = self.count == self.rows.len();
        let open = self.count - usize::from(closed);
        let last = self.count - 1;
        // What is left of a link's own pivot without its second end: no difference of what is nearly the same, which would lose a heavy bob.
        let mut left = 0.0;
        for link in 0..open {
            let lower = if link > 0 { -self.coupling(bodies, link, link - 1, link) } else { 0.0 };
            let upper = if link + 1 < open { -self.coupling(bodies, link, link + 1, link + 1) } else { 0.0 };
            let mut border = 0.0;
            if closed && link == 0 {
                border -= self.coupling(bodies, link, last, 0);
            }
            if closed && link + 1 == open {
                border -= self.coupling(bodies, link, last, last);
            }
            let [before, beside, pivot] = match link.checked_sub(1) {
                Some(i) => [self.change[i], self.border[i], self.pivot(bodies, i, left)],
                None => [0.0, 0.0, 1.0],
            };
            left = soft + self.remains(bodies, link, left, pivot);
            let pivot = self.pivot(bodies, link, left);
            self.upper[link] = upper / pivot;
            self.change[link] = (self.change[link] - lower * before) / pivot;
            self.border[link] = (border - lower * beside) / pivot;
        }
        for link in (0..open.saturating_sub(1)).rev() {
            let upper = self.upper[link];
            self.change[link] -= upper * self.change[link + 1];
            self.border[link] -= upper * self.border[link + 1];
        }
        if closed {
            let first = -self.coupling(bodies, last, 0, 0);
            let lower = -self.coupling(bodies, last, last - 1, last);
            let diagonal = self.diagonal(bodies, last, soft);
            let pivot = diagonal - first * self.border[0] - lower * self.border[last - 1];
            let rest = self.change[last] - first * self.change[0] - lower * self.change[last - 1];
            let closing = rest / max(pivot, diagonal * RIDGE);
            self.change[last] = closing;
            for link in 0..last {
                self.change[link] -= self.border[link] * closing;
            }
        }
        self.change[..self.count].iter().all(|change| change.is_finite())
    }

    /// By how much the changes of λ move a particle.
    fn movement(&self, bodies: &Bodies<'_>, particle: usize) -> Option<(usize, Vec3)> {
        let row = self.rows[particle] as usize;
        let weight = *bodies.inverse_mass.get(row)?;
        let mut sum = Vec3::ZERO;
        if particle < self.count {
            sum += self.way[particle] * self.change[particle];
        }
        let before = if particle > 0 { particle - 1 } else { self.rows.len() - 1 };
        if before < self.count {
            sum -= self.way[before] * self.change[before];
        }
        let by = sum * weight;
        (weight > 0.0 && by.is_finite()).then_some((row, by))
    }

    /// Lets the changes of λ act.
    fn act(&mut self, bodies: &mut Bodies<'_>, act: &mut dyn FnMut(&mut Bodies<'_>, usize, Vec3)) {
        let mut farthest = 0.0;
        for particle in 0..self.rows.len() {
            farthest = self.movement(bodies, particle).map_or(farthest, |(_, by)| max(farthest, length(by)));
        }
        let share = if farthest > 2.0 * self.reach { 2.0 * self.reach / farthest } else { 1.0 };
        for (pull, change) in self.pull.iter_mut().zip(self.change.iter_mut()) {
            *change *= share;
            *pull += *change;
        }
        for particle in 0..self.rows.len() {
            if let Some((row, by)) = self.movement(bodies, particle) {
                act(bodies, row, by);
            }
        }
    }

    /// Remembers where all are to go.
    fn aim_at(&mut self, bodies: &Bodies<'_>) {
        for (aim, &row) in self.aim.iter_mut().zip(self.rows.iter()) {
            *aim = bodies.position.get(row as usize).copied().unwrap_or(Vec3::ZERO);
        }
    }

    /// Puts all back to where they were as the sub-step began.
    fn start_over(&mut self, bodies: &mut Bodies<'_>) {
        for row in self.rows.iter().map(|&row| row as usize) {
            if row < bodies.len() {
                let to = bodies.before[0][row];
                put(bodies, row, to - bodies.position[row], to);
            }
        }
    }

    /// Moves all by a share of the way; whoever is fixed is to be so far on his.
    fn pace(&mut self, bodies: &mut Bodies<'_>, far: f32, share: f32) {
        for (&aim, row) in self.aim.iter().zip(self.rows.iter().map(|&row| row as usize)) {
            if row < bodies.len() {
                let from = bodies.before[0][row];
                let to = if far < 1.0 { from + (aim - from) * far } else { aim };
                put(bodies, row, (aim - from) * share, to);
            }
        }
    }

    /// The velocity that all of it has: that of whoever is fixed, else the mean by mass \[m/s\].
    fn drift(&self, bodies: &Bodies<'_>) -> Vec3 {
        let (mut sum, mut mass) = (Vec3::ZERO, 0.0);
        for row in self.rows.iter().map(|&row| row as usize).filter(|&row| row < bodies.len()) {
            if !(bodies.inverse_mass[row] > 0.0) {
                return bodies.velocity[row];
            }
            sum += bodies.velocity[row] * bodies.mass[row];
            mass += bodies.mass[row];
        }
        if mass > 0.0 { sum / mass } else { Vec3::ZERO }
    }

    /// Twice the kinetic energy beside that \[J\].
    fn vigour(&self, bodies: &Bodies<'_>) -> f32 {
        let drift = self.drift(bodies);
        let rows = self.rows.iter().map(|&row| row as usize).filter(|&row| row < bodies.len());
        let moving = rows.filter(|&row| bodies.inverse_mass[row] > 0.0);
        moving.map(|row| (bodies.velocity[row] - drift).length_squared() * bodies.mass[row]).sum()
    }

    /// Slows all down to the kinetic energy that they had before: links that have turned too far for the sub-step must not drive.
    fn calm(&self, bodies: &mut Bodies<'_>, before: f32) {
        let (drift, now) = (self.drift(bodies), self.vigour(bodies));
        if !(now > before) {
            return;
        }
        let share = sqrt(before / now);
        for row in self.rows.iter().map(|&row| row as usize) {
            if row < bodies.len() && bodies.inverse_mass[row] > 0.0 {
                bodies.velocity[row] = drift + (bodies.velocity[row] - drift) * share;
            }
        }
    }

    /// Takes back what links push.
    fn let_go(&mut self, bodies: &mut Bodies<'_>, act: &mut dyn FnMut(&mut Bodies<'_>, usize, Vec3)) {
        let mut pushes = false;
        for (change, &pull) in self.change.iter_mut().zip(self.pull.iter()) {
            *change = if pull > 0.0 { -pull } else { 0.0 };
            pushes |= pull > 0.0;
        }
        self.reach = f32::MAX;
        if pushes {
            self.act(bodies, act);
        }
    }
}
