//! Clusters that keep their shape: rigid bodies and jellies of particles.

mod body;

use super::bodies::Change;
#[cfg(feature = "alloc")]
use super::declared::{Declared, twice};
use super::turn::{Turn, about, keeping_by, moment, nearest, outer, solve_thin};
use super::walls::{self, Motion, Wall};
use super::{Bodies, Constraint, Demand, Share, Words};
use crate::math::{dot, max, sqrt};
#[cfg(feature = "alloc")]
use crate::particles::Particle;
use body::{Body, Hold, Member};
use glam::{Mat3, Vec3};

/// Keeps a cluster of particles in the shape that it had when the constraint first acted, moved and turned as a whole: a rigid body,
/// or with a compliance a soft one.
///
/// Every particle goes to its goal, its place in the shape turned by R about the common centre (Müller, Heidelberger, Teschner and Gross,
/// "Meshless Deformations Based on Shape Matching", SIGGRAPH 2005). R is the rotation that keeps the angular momentum: Σ m y × (R q − x)
/// = 0, where x is where the method has moved a particle, q its place in the shape, both from the centre, and y = x − v h where its path of
/// this sub-step comes from. Solved by Newton's method from the last rotation on, this is the equation of Moser and Veselov for a rigid body
/// (McLachlan and Zanna, "The Discrete Moser-Veselov Algorithm for the Free Rigid Body, Revisited", Found. Comput. Math. 5, 2005): what flies
/// freely follows Euler's equations, with an error that falls with the square of the sub-step. Where it has no solution, since the cluster
/// turns by more than a radian or is far out of shape, R is that which comes nearest (Müller, Bender, Chentanez and Macklin, "A
/// Robust Method to Extract the Rotational Part of Deformations", MIG 2016). At the sub-step's end velocities become those of the
/// rigid motion with the same momenta, v + ω × r with ω = I⁻¹ L. Linear and angular momentum are kept to rounding either way, and what rounding takes of
/// the latter is given back as soon as velocities can show it.
///
/// With a compliance α the whole of the cluster gives way by α times a force: particles share it as they share the mass, each held by a spring
/// of m / (M α). A damping β takes from their speeds against the rigid motion what a force β times that speed does, shared likewise.
/// Both hold whatever the sub-steps, as the step that takes them is implicit (Macklin, Müller and Chentanez, "XPBD", MIG 2016).
///
/// The scenery presses the cluster while it is solved: an impulse at a particle that meets it moves all of it, as what is rigid or gives way that
/// softly answers, with friction and elasticity, and particles that touch at once share the load. So a block of eight corners slides, bounces and rests as a
/// block does, and a drum of points on its rim rolls as its inertia says. Only particles meet the scenery, as balls of their radius: what
/// is pointed may reach in between them. [`RigidBodies`](crate::RigidBodies) meet it, and each other, as boxes and hulls.
///
/// Constraints that hold single particles back (contacts with balls, links) are listed behind it: velocities are shared among all at the sub-step's end, and
/// places in the next sub-step, so that a blow on one of n takes about n sub-steps to stop all of them. Until then it is a little out of shape.
/// [`Contacts`](super::Contacts) leave balls of a rigid cluster alone, so those may overlap; of a particle in several clusters that is so for the last.
/// Balls of a soft one keep it from being crushed, and must not overlap in its shape: they would be pushed apart in each sub-step and pulled back.
///
/// Whoever is fixed stays: about one that is fixed the others swing, about two they turn, and three hold all of them. Whoever has died is
/// left out. Lines and planes of particles are bodies as good as any; one particle alone, or all in one place, are not bound.
///
/// ```
/// use pointmass::constrain::ShapeMatching;
/// use pointmass::{Heap, Particle, Scene, System, Time, Vec3};
///
/// // Four corners that spin about z once in 2π seconds.
/// let corner = |position: Vec3| Particle { position, velocity: Vec3::Z.cross(position), ..Particle::REST };
/// let start = [corner(Vec3::X), corner(Vec3::Y), corner(Vec3::NEG_X), corner(Vec3::NEG_Y)];
/// let body = ShapeMatching::rigid([0, 1, 2, 3]);
/// let scene = Scene { start: &start, constraints: &body, substeps: 20, ..Scene::EMPTY };
/// let mut system = System::with(Heap::new(scene.size()));
/// system.start(&scene, 1)?;
/// for frame in 1..=60 {
///     system.step_to(&scene, Time::frame(frame, 60));
/// }
/// let x = system.particles().position;
/// assert!(x[0].distance(Vec3::new(1f32.cos(), 1f32.sin(), 0.0)) < 1e-4);
/// assert!(x[0].distance(-x[2]) < 1e-5);
/// # Ok::<(), pointmass::InsufficientMemory>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct ShapeMatching<P> {
    /// The particles, by their place in the scene's start.
    pub particles: P,
    /// α: how far the whole of it gives way to a force \[m/N\]; zero is rigid.
    #[cfg_attr(feature = "serde", serde(default))]
    pub compliance: f32,
    /// β: the force of the whole of it against being deformed, for the speed of that \[N s/m\].
    #[cfg_attr(feature = "serde", serde(default))]
    pub damping: f32,
}

/// Words kept before the places in the shape: whether they are known, the rotation, and the angular momentum that it owes.
const HEAD: usize = 8;
/// The rotation's words of those, and what follows them.
const OWED: usize = 5;
/// The share of an energy that may be rounding.
const ROUNDING: f32 = 1e-5;
/// The share of an angular momentum beyond which what is lost of it is no rounding.
const DEBT: f32 = 1e-5;

impl<P> ShapeMatching<P> {
    /// A rigid body.
    #[must_use]
    pub const fn rigid(particles: P) -> Self {
        Self { particles, compliance: 0.0, damping: 0.0 }
    }
}

impl<P: AsRef<[u32]>> ShapeMatching<P> {
    /// The first of its numbers that cannot be used, and what it has to be.
    #[must_use]
    pub fn fault(&self) -> Option<(&'static str, &'static str)> {
        let not_negative = |x: f32| (0.0..f32::INFINITY).contains(&x);
        let faults = [
            (self.particles.as_ref().len() < 2, "particles", "has to name two particles or more"),
            (!not_negative(self.compliance), "compliance", "must not be below zero, in m/N"),
            (!not_negative(self.damping), "damping", "must not be below zero, in N s/m"),
        ];
        faults.into_iter().find(|&(wrong, ..)| wrong).map(|(_, name, message)| (name, message))
    }

    /// Takes the places of all as they are at the first sub-step's beginning.
    fn learn(&self, bodies: &Bodies<'_>, kept: &mut [u32]) {
        let Some((head, places)) = kept.split_at_mut_checked(HEAD) else { return };
        head[1..OWED].copy_from_slice(&Turn::NONE.0.map(f32::to_bits));
        head[OWED..].fill(0);
        let mut first = None;
        for (&number, place) in self.particles.as_ref().iter().zip(places.chunks_exact_mut(3)) {
            if let Some(row) = bodies.row_of_start(number) {
                let x = bodies.position[row];
                place.copy_from_slice(&(x - *first.get_or_insert(x)).to_array().map(f32::to_bits));
            }
        }
    }

    /// Visits all that live.
    fn each(&self, bodies: &mut Bodies<'_>, kept: &[u32], visit: &mut dyn FnMut(&mut Bodies<'_>, Member)) {
        let places = kept.get(HEAD..).unwrap_or_default().chunks_exact(3);
        for (&number, place) in self.particles.as_ref().iter().zip(places) {
            if let Some(row) = bodies.row_of_start(number) {
                let [x, y, z] = [place[0], place[1], place[2]].map(f32::from_bits);
                let fixed = !(bodies.inverse_mass[row] > 0.0);
                visit(bodies, Member { row, place: Vec3::new(x, y, z), fixed });
            }
        }
    }

    /// Moves all that are not fixed by so much, or makes them faster by that.
    fn change(
        &self,
        bodies: &mut Bodies<'_>,
        kept: &[u32],
        what: Change,
        by: &mut dyn FnMut(&Bodies<'_>, &Member) -> Vec3,
    ) {
        self.each(bodies, kept, &mut |bodies, member| {
            let by = by(bodies, &member);
            if !member.fixed && by.is_finite() {
                bodies.change(what, member.row, by);
            }
        });
    }

    /// Where it is as a whole, and how fast; none if there is nothing to move or to keep.
    fn body(&self, bodies: &mut Bodies<'_>, kept: &[u32]) -> Option<Body> {
        let (mut mass, mut fixed, mut first) = (0.0, 0u32, None);
        self.each(bodies, kept, &mut |bodies, member| {
            first.get_or_insert((bodies.position[member.row], bodies.velocity[member.row]));
            match member.fixed {
                true => fixed += 1,
                false => mass += bodies.mass[member.row],
            }
        });
        let (origin, drift) = first?;
        if !(mass > 0.0 && mass < f32::INFINITY) {
            return None;
        }
        let mut body = Body { origin, mass, fixed, hold: Hold::Free, center: Vec3::ZERO, rest: Vec3::ZERO, drift };
        // Means of what is left of the last ones: shares of the mass that rounding keeps from adding up to one would brake, ever so slightly.
        for _ in 0..2 {
            let (mut center, mut rest, mut drift) = (Vec3::ZERO, Vec3::ZERO, Vec3::ZERO);
            self.each(bodies, kept, &mut |bodies, member| {
                let weight = match (fixed, member.fixed) {
                    (0, _) => bodies.mass[member.row] / mass,
                    (_, true) => 1.0 / fixed as f32,
                    (_, false) => return,
                };
                center += body.place(bodies, member.row) * weight;
                rest += (member.place - body.rest) * weight;
                drift += (bodies.velocity[member.row] - body.drift) * weight;
            });
            body.center += center;
            body.rest += rest;
            body.drift += drift;
        }
        Some(body)
    }

    /// What those that are fixed leave of its freedom to turn; there are two of them at least. The last rotation is brought to agree.
    fn hold(&self, bodies: &mut Bodies<'_>, kept: &[u32], body: &Body, last: &mut Turn) -> Hold {
        let (mut arm, mut far) = (None, 0.0);
        self.each(bodies, kept, &mut |_, member| {
            let place = member.place - body.rest;
            let square = dot(place, place);
            if member.fixed && square > far {
                (arm, far) = (Some((member.row, place)), square);
            }
        });
        let Some((row, place)) = arm else { return Hold::Free };
        let (mut wide, mut to, mut spread, mut spin) = (0.0, Mat3::ZERO, Mat3::ZERO, Vec3::ZERO);
        self.each(bodies, kept, &mut |bodies, member| {
            if member.fixed {
                let (q, r) = (member.place - body.rest, body.place(bodies, member.row));
                let aside = q.cross(place);
                wide = max(wide, dot(aside, aside));
                to += outer(r, q);
                spread += outer(r, r);
                spin += r.cross(bodies.velocity[member.row] - body.drift);
            }
        });
        if wide > 1e-6 * far * far {
            *last = nearest(*last, to, None);
            return Hold::Fast { omega: solve_thin(spread, spin) };
        }
        let (r, v) = (body.place(bodies, row), bodies.velocity[row] - body.drift);
        let square = dot(r, r);
        if !(square > 0.0) {
            return Hold::Free;
        }
        *last = last.bring(place, r);
        Hold::About { axis: r / sqrt(square), omega: r.cross(v) / square }
    }

    /// Its angular momentum about its centre over its mass, and the sum of r rᵀ likewise.
    fn spin(&self, bodies: &mut Bodies<'_>, kept: &[u32], body: &Body) -> (Vec3, Mat3) {
        let (mut spin, mut spread) = (Vec3::ZERO, Mat3::ZERO);
        self.each(bodies, kept, &mut |bodies, member| {
            let (r, v) = (body.place(bodies, member.row), bodies.velocity[member.row] - body.drift);
            let weight = body.weight(bodies, &member);
            spin += r.cross(v) * weight;
            spread += outer(r * weight, r);
        });
        (spin, spread)
    }

    /// The angular momentum over the mass that rounding has taken so far: what is too little for velocities to show waits until it is not.
    fn owed(kept: &[u32]) -> Vec3 {
        let [x, y, z] = [0, 1, 2].map(|axis| kept.get(OWED + axis).copied().map_or(0.0, f32::from_bits));
        Vec3::new(x, y, z)
    }

    /// Remembers what of an angular momentum it has not got.
    fn owe(&self, bodies: &mut Bodies<'_>, kept: &mut [u32], body: &Body, spin: Vec3) {
        let lost = spin - self.spin(bodies, kept, body).0;
        let is_rounding = dot(lost, lost) <= DEBT * DEBT * dot(spin, spin);
        let owed = if is_rounding { lost } else { Vec3::ZERO };
        kept[OWED..HEAD].copy_from_slice(&owed.to_array().map(f32::to_bits));
    }

    /// The share of the way to their goals that particles go in a sub-step of `h` \[s\].
    fn give(&self, body: &Body, h: f32) -> f32 {
        1.0 / (1.0 + self.compliance * body.mass / (h * h))
    }

    /// Takes so large a share of how fast particles move against the motion of the whole that has the same momenta, and keeps how that is held; tells
    /// the sum of r rᵀ over the mass.
    fn share_speed(&self, bodies: &mut Bodies<'_>, kept: &mut [u32], body: &mut Body, taken: f32) -> Mat3 {
        let (spin, spread) = self.spin(bodies, kept, body);
        let spin = spin + Self::owed(kept);
        if body.fixed > 1 {
            body.hold = self.hold(bodies, kept, body, &mut Turn::kept(kept));
        }
        let omega = match body.hold {
            Hold::Free => solve_thin(spread, spin),
            Hold::About { axis, omega } => omega + axis * about(axis, spread, spin - moment(spread, omega)),
            Hold::Fast { omega } => omega,
        };
        if !(taken > 0.0) {
            return spread;
        }
        self.change(bodies, kept, Change::Velocity, &mut |bodies, member| {
            let rigid = body.drift + omega.cross(body.place(bodies, member.row));
            (rigid - bodies.velocity[member.row]) * taken
        });
        if let Hold::Free = body.hold {
            self.owe(bodies, kept, body, spin);
        }
        spread
    }

    /// The rotation that keeps the angular momentum, or else the nearest one.
    fn turn(&self, bodies: &mut Bodies<'_>, kept: &[u32], body: &Body, last: Turn) -> Turn {
        let h = bodies.substep.seconds();
        // Σ m y qᵀ, Σ m x qᵀ and Σ m y × x.
        let (mut from, mut to, mut torque) = (Mat3::ZERO, Mat3::ZERO, Vec3::ZERO);
        self.each(bodies, kept, &mut |bodies, member| {
            let x = body.place(bodies, member.row);
            let y = x - (bodies.velocity[member.row] - body.drift) * h;
            let weight = body.weight(bodies, &member);
            let q = (member.place - body.rest) * weight;
            from += outer(y, q);
            to += outer(x, q);
            torque += y.cross(x) * weight;
        });
        let axis = match body.hold {
            Hold::Free => None,
            Hold::About { axis, .. } => Some(axis),
            Hold::Fast { .. } => return last,
        };
        keeping_by(solve_thin, last, (from, torque), axis).unwrap_or_else(|| nearest(last, to, axis))
    }
}

impl<P: AsRef<[u32]> + Sync> Constraint for ShapeMatching<P> {
    fn demand(&self) -> Demand {
        let places = self.particles.as_ref().len().saturating_mul(3);
        let walls = self.particles.as_ref().len().saturating_mul(walls::WORDS).saturating_add(1);
        let (kept, step) =
            (Words { per_row: 0, fixed: places.saturating_add(HEAD) }, Words { per_row: 0, fixed: walls });
        Demand { kept, step, binds: true, ..Demand::NONE }
    }

    fn is_empty(&self) -> bool {
        self.particles.as_ref().len() < 2
    }

    fn bind(&self, bodies: &mut Bodies<'_>) {
        // What gives way is kept from being crushed by its own balls.
        if self.compliance == 0.0 {
            bodies.bind(self.particles.as_ref());
        }
    }

    fn prepare(&self, bodies: &mut Bodies<'_>, share: &mut Share<'_>) {
        if share.claim(*b"shap", &[self.particles.as_ref().len()]) {
            self.learn(bodies, share.kept.fixed);
        }
    }

    fn project(&self, bodies: &mut Bodies<'_>, share: &mut Share<'_>) {
        let (h, kept, particles) = (bodies.substep.seconds(), &mut *share.kept.fixed, self.particles.as_ref());
        let (free, step) = share.step.split_at_mut(share.step.len().min(1));
        let walls = walls::of(step, particles.len());
        walls::gather(walls, particles, bodies);
        free.fill(f32::INFINITY.to_bits());
        let Some(mut body) = self.body(bodies, kept) else { return };
        if !(h > 0.0) {
            return;
        }
        if self.compliance > 0.0 && (body.fixed > 0 || walls.iter().any(Wall::presses)) {
            self.each(bodies, kept, &mut |bodies, member| bodies.catch_up(member.row));
        }
        let (spin, _) = self.spin(bodies, kept, &body);
        let mut last = Turn::kept(kept);
        if body.fixed > 1 {
            body.hold = self.hold(bodies, kept, &body, &mut last);
        }
        let turn = self.turn(bodies, kept, &body, last);
        kept[1..OWED].copy_from_slice(&turn.0.map(f32::to_bits));
        let (rotation, give) = (turn.matrix(), self.give(&body, h));
        self.change(bodies, kept, Change::Place, &mut |bodies, member| {
            let goal = body.center + rotation * (member.place - body.rest);
            (goal - (bodies.position[member.row] - body.origin)) * give
        });
        // What rounding has changed of the momenta, or turning too far, is given back.
        let Some(mut now) = self.body(bodies, kept) else { return };
        let (left, spread) = self.spin(bodies, kept, &now);
        let spin = spin + Self::owed(kept);
        let omega = match body.hold {
            Hold::Free => solve_thin(spread, spin - left),
            Hold::About { axis, .. } => axis * about(axis, spread, spin - left),
            Hold::Fast { .. } => Vec3::ZERO,
        };
        let drift = body.drift - now.drift;
        self.change(bodies, kept, Change::Velocity, &mut |bodies, member| {
            drift + omega.cross(now.place(bodies, member.row))
        });
        now.drift = body.drift;
        if let Hold::Free = body.hold {
            self.owe(bodies, kept, &now, spin);
        }
        if walls.iter().any(Wall::is_near) {
            now.hold = body.hold;
            free.fill(now.energy(self.spin(bodies, kept, &now).0, spread).to_bits());
            let whole = now.whole(spread, give);
            let moved = whole.press(walls, bodies);
            self.change(bodies, kept, Change::Place, &mut |bodies, member| whole.moves(bodies, member.row, &moved));
        }
    }

    fn settle(&self, bodies: &mut Bodies<'_>, share: &mut Share<'_>) {
        let (kept, particles) = (&mut *share.kept.fixed, self.particles.as_ref());
        let (free, step) = share.step.split_at_mut(share.step.len().min(1));
        let walls = walls::of(step, particles.len());
        let Some(mut body) = self.body(bodies, kept).filter(|_| bodies.substep.seconds() > 0.0) else { return };
        let brake = self.damping * bodies.substep.seconds() / body.mass;
        let taken = if self.compliance > 0.0 { brake / (1.0 + brake) } else { 1.0 };
        let spread = self.share_speed(bodies, kept, &mut body, taken);
        if walls.iter().any(Wall::is_near) {
            let whole = body.whole(spread, max(self.give(&body, bodies.substep.seconds()), taken));
            let (spin, _) = self.spin(bodies, kept, &body);
            let energy = |motion: &Motion| {
                let drift = body.drift + motion.along;
                Body { drift, ..body }.energy(spin + moment(spread, motion.turning), spread)
            };
            // As much as it had before walls pressed it, or has by what else has moved it since. What is soft has more, in its shape.
            let free = free.iter().fold(energy(&Motion::NONE), |most, &free| max(f32::from_bits(free), most));
            let rigid = self.compliance == 0.0;
            let faster = whole.answer(walls, bodies, &|motion| rigid && energy(motion) > free * (1.0 + ROUNDING));
            self.change(bodies, kept, Change::Velocity, &mut |bodies, member| whole.moves(bodies, member.row, &faster));
            walls::report(walls, bodies);
        }
        walls::follow(walls, bodies);
    }
}

#[cfg(feature = "alloc")]
impl<P: AsRef<[u32]> + Sync> Declared for ShapeMatching<P> {
    fn name(&self) -> &'static str {
        "cluster"
    }

    fn solved(&self) -> &'static str {
        "as one: exact at rest"
    }

    fn fault(&self) -> Option<(&'static str, &'static str)> {
        Self::fault(self).or_else(|| twice(self.particles.as_ref()))
    }

    fn ends(&self) -> [&[u32]; 3] {
        [self.particles.as_ref(), &[], &[]]
    }

    fn straight(&self) -> Option<&'static str> {
        Some("clusters")
    }

    fn is_body(&self) -> bool {
        true
    }

    fn compliance(&self) -> f32 {
        self.compliance
    }

    fn inverse_mass(&self, start: &[Particle]) -> f64 {
        let particles = self.particles.as_ref().iter().filter_map(|&number| start.get(number as usize));
        1.0 / particles.map(|particle| f64::from(particle.mass)).sum::<f64>()
    }
}
