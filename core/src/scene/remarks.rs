//! Remarks on a declared scene: things that it can say, but hardly means.

use super::{Boxes, Cloth, Cord, Growth, Item, PeriodicRoom, Response, Run, SceneFile, SoftBody, Tuft};
use crate::constrain::{ConstraintKind, Strands};
use crate::emit::{Spread, Varied};
use crate::force::{ForceKind, Friction};
use crate::math::{length, sqrt};
use crate::reap::ReaperKind;
use crate::shape::{Aabb, Shape, Surface};
use alloc::format;
use alloc::string::String;
use alloc::vec::Vec;
use core::fmt::Arguments;
use glam::Vec3;

/// All directions \[rad\]: π, also as files round it.
const HALF_TURN: f32 = core::f32::consts::PI * 1.0002;

/// As many as are told: a large file may have one in every line.
pub(super) const MOST: usize = 1000;

/// Sub-steps that a step may have.
pub(super) const MOST_SUBSTEPS: u32 = 1000;

/// Balls may be so many times as heavy as others that bear them in the sub-steps that contacts by position usually take: two and three on top of
/// each other of which the upper one weighs 40 times as much lie still, with 100 times in steps of 1/24 s they do not.
const UNEVEN: f32 = 50.0;

impl SceneFile {
    /// Remarks on what can be run but is hardly meant, each by its path in the file; the first thousand.
    #[must_use]
    pub fn remarks(&self) -> Vec<String> {
        let mut remarks = Vec::new();
        let mut add = |at: Arguments<'_>, remark: Option<String>| {
            let told = remark.filter(|_| remarks.len() < MOST);
            remarks.extend(told.map(|text| format!("{at}: {text}")));
        };
        add(format_args!("run.capacity"), self.odd_capacity());
        self.add_elasticities(&mut add);
        self.add_springs(&mut add);
        for (i, body) in self.soft_bodies.iter().enumerate() {
            add(
                format_args!("soft_bodies[{i}].radius"),
                self.contacts.and_then(|contacts| body.overlap(contacts.contacts().is_some())),
            );
        }
        self.add_emitters(&mut add);
        add(format_args!("contacts.position"), self.uneven_balls());
        add(format_args!("contacts.impulse"), self.pressed_in());
        add(format_args!("boxes"), self.uneven_boxes());
        self.add_heaps(&mut add);
        for (i, cloth) in self.cloths.iter().enumerate() {
            add(format_args!("cloths[{i}].thickness"), self.heavy_on_cloth(cloth));
            add(format_args!("cloths[{i}]"), self.long_for_plate(cloth));
        }
        for (i, cord) in self.ropes.iter().enumerate() {
            add(format_args!("ropes[{i}].ends"), self.hung_on_sheet(cord));
        }
        // All such ropes are of one kind to whoever reads it.
        if let Some((i, remark)) = self.hung_in_turn() {
            add(format_args!("ropes[{i}].ends"), Some(remark));
        }
        if let Some(Response::Force(penalty)) = self.contacts {
            add(format_args!("contacts.force.friction.static"), odd_friction(penalty.friction));
        }
        for (i, material) in self.materials.iter().enumerate() {
            let friction = material.contact.friction.unwrap_or(Friction::NONE);
            add(format_args!("materials[{i}].contact.friction.static"), odd_friction(friction));
        }
        for (i, item) in self.scenery.iter().enumerate() {
            add(format_args!("scenery[{i}].shape"), self.reaches_out(item));
            add(format_args!("scenery[{i}].shape.triangle"), thin(&item.shape));
        }
        self.add_idle(&mut add);
        self.add_colors(&mut add);
        self.add_unread(&mut add);
        if let Some(i) = self.doubled_drag() {
            let twice = "wind brakes by the same coefficients, as seen from the moving air: both together brake twice; leave this one out, or give the wind a coefficient";
            add(format_args!("forces[{i}].drag"), Some(twice.into()));
        }
        remarks
    }

    /// Remarks on births.
    fn add_emitters(&self, add: &mut dyn FnMut(Arguments<'_>, Option<String>)) {
        for (i, emitter) in self.emitters.iter().enumerate() {
            add(
                format_args!("emitters[{i}].elasticity"),
                odd_elasticity(emitter.elasticity).filter(|_| !emitter.fixed),
            );
            add(format_args!("emitters[{i}].spread"), odd_spread(emitter.spread));
            add(format_args!("emitters[{i}].lifetime"), odd_lifetime(emitter.lifetime));
            let never = emitter.rate == 0.0 && emitter.burst.is_none_or(|burst| burst.count == 0);
            let barren = || "neither this nor a burst says how many, so nothing is born".into();
            add(format_args!("emitters[{i}].rate"), never.then(barren));
            let ended = emitter.stop.filter(|&stop| stop <= emitter.start);
            let nothing = |stop| format!("{stop} s is not after start, {} s, so nothing is born", emitter.start);
            add(format_args!("emitters[{i}].stop"), ended.map(nothing));
        }
    }

    /// A remark on balls that weigh too much for others that they may come to lie on: what bears a heavy one comes through light ones only bit by bit.
    fn uneven_balls(&self) -> Option<String> {
        let Some(Response::Position(_)) = self.contacts else { return None };
        let balls = self.particles.iter().filter(|ball| ball.radius > 0.0 && !ball.fixed).map(|ball| [ball.mass; 2]);
        let born = self.emitters.iter().filter(|emitter| emitter.radius.mean > 0.0 && !emitter.fixed).map(|emitter| {
            let Varied { mean, half_width } = emitter.mass;
            [mean - half_width.abs(), mean + half_width.abs()]
        });
        let all = balls.chain(born).filter(|[least, _]| *least > 0.0);
        let [least, most] = all.fold([f32::INFINITY, 0.0], |[a, b], [c, d]| [a.min(c), b.max(d)]);
        let uneven = || {
            format!(
                "balls of {most} kg weigh more than {UNEVEN} times as much as those of {least} kg, into which they may sink, and which they may throw about; smaller steps help, `impulse` does not sink"
            )
        };
        (most > UNEVEN * least).then(uneven)
    }

    /// A remark on balls that meet by impulse above rigid bodies, which are met after them: those that lie on each other are pressed into what bears them, whatever the steps.
    fn pressed_in(&self) -> Option<String> {
        let Some(Response::Impulse {}) = self.contacts else { return None };
        let balls = self.particles.iter().filter(|ball| ball.radius > 0.0 && !ball.fixed).count();
        let born = self.emitters.iter().filter(|emitter| emitter.radius.mean > 0.0 && !emitter.fixed).count();
        let press = "balls that lie on each other are pressed into the boxes that bear them, and through them; `position` keeps them out";
        (!self.boxes.is_empty() && balls + 2 * born > 1).then(|| press.into())
    }

    /// A remark on bodies that weigh too much for others that they may come to lie on: in a sub-step of h a body sinks into what bears it by the ratio of
    /// their masses times g h² / 4, as measured, and from a few hundredths of its size on through it.
    fn uneven_boxes(&self) -> Option<String> {
        /// The share of the smallest side that one may sink in.
        const SHARE: f32 = 0.01;
        let free = self.boxes.iter().filter(|boxes| !boxes.fixed);
        let known: Vec<_> = free.filter_map(|boxes| Some((boxes.weight()?, boxes.size(None)?.min_element()))).collect();
        let &(heaviest, _) = known.iter().max_by(|a, b| a.0.total_cmp(&b.0))?;
        let &(lightest, side) = known.iter().min_by(|a, b| a.0.total_cmp(&b.0))?;
        let (taken, pull) = (self.substeps() as f32, length(self.pull()));
        let h = self.run.dt as f32 / taken;
        let depth = 0.25 * (heaviest / lightest) * pull * h * h;
        let room = SHARE * side;
        let sinks = || {
            let needed = (taken * sqrt(depth / room)) as u32;
            let needed = needed.saturating_add(1);
            format!(
                "bodies of {heaviest} kg sink into those of {lightest} kg that bear them, and through them at last; {}",
                enough(needed)
            )
        };
        (depth > room && heaviest > lightest).then(sinks)
    }

    /// Remarks on springs.
    fn add_springs(&self, add: &mut impl FnMut(Arguments<'_>, Option<String>)) {
        for (i, spring) in self.springs.iter().enumerate() {
            add(format_args!("springs[{i}].ends"), odd_ends(spring.ends.map(i64::from)));
            add(format_args!("springs[{i}].ks"), odd_strength(spring.ks));
            add(format_args!("springs[{i}].kd"), odd_strength(spring.kd));
        }
    }

    /// Remarks on bodies that begin in one place.
    fn add_heaps(&self, add: &mut impl FnMut(Arguments<'_>, Option<String>)) {
        let is_scattered = |boxes: &Boxes| boxes.scatter.is_some_and(|scatter| scatter.position > 0.0);
        let free = self.boxes.iter().enumerate().filter(|(_, boxes)| !boxes.fixed && !is_scattered(boxes));
        let mut places = Vec::new();
        for (i, boxes) in free {
            let spacing = boxes.spacing.unwrap_or(Vec3::ONE).to_array();
            let axes = ["x", "y", "z"].into_iter().zip(boxes.count.into_iter().zip(spacing));
            let heap = axes.filter(|(_, (count, spacing))| *count > 1 && *spacing == 0.0).map(|(name, _)| name).next();
            let all =
                |name| format!("0 along {name} puts them into each other, and what begins so need not come apart");
            add(format_args!("boxes[{i}].spacing"), heap.map(all));
            // Zero has two signs.
            places.push(((boxes.position + Vec3::ZERO).to_array().map(f32::to_bits), i));
        }
        places.sort_unstable();
        for pair in places.windows(2).filter(|pair| pair[0].0 == pair[1].0) {
            let [before, i] = [pair[0].1, pair[1].1];
            let same = format!("it is that of boxes[{before}], and what begins in each other need not come apart");
            add(format_args!("boxes[{i}].position"), Some(same));
        }
    }

    /// A remark on what weighs too much for a sheet with thickness that hangs by some of its points and that it may come to lie on: in sub-steps of h it sinks
    /// into it by its mass over that of a point times g h² / 4, as measured within a factor of two, a body through it from the thickness on, the points of
    /// another sheet, which find the way between its own, from a 32nd of that.
    fn heavy_on_cloth(&self, cloth: &Cloth) -> Option<String> {
        if cloth.fixed.is_empty() {
            return None;
        }
        let (thickness, point) = (cloth.thickness.filter(|&thickness| thickness > 0.0)?, cloth.point_mass()?);
        let boxes = self.boxes.iter().filter(|boxes| !boxes.fixed).filter_map(Boxes::weight);
        let balls = self.particles.iter().filter(|ball| !ball.fixed && ball.radius > 0.0).map(|ball| ball.mass);
        let others = self.cloths.iter().filter(|other| other.fixed.is_empty() && other.thickness.is_some());
        let points = others.filter_map(Cloth::point_mass).filter(|&other| other > point);
        let [body, sheet] = [boxes.chain(balls).fold(0.0, f32::max), points.fold(0.0, f32::max)];
        let pull = length(self.pull());
        let depth = |load: f32, substeps: u32| {
            let h = self.run.dt as f32 / substeps as f32;
            0.25 * (load / point) * pull * h * h
        };
        let taken = self.substeps();
        let mut sinks = [(body, 1.0, "what weighs"), (sheet, 1.0 / 32.0, "a sheet whose points weigh")].into_iter();
        sinks.find_map(|(load, share, what)| {
            let least = (taken..=MOST_SUBSTEPS).find(|&substeps| !(depth(load, substeps) > share * thickness));
            let says = || {
                let helps = least.map_or("it is far too much".into(), enough);
                format!("{what} {load} kg sinks into it, whose points weigh {point} kg each, or falls through; {helps}")
            };
            (least != Some(taken)).then(says)
        })
    }

    /// A remark on a plate: a sheet that is held by some of its points and that stands by its stiffness against bending. A sub-step solves what is linear
    /// in its way, and a cell of length ℓ that turns through g h² is longer by (g h² / ℓ)² / 2 of itself then; where what that pulls with is more than its
    /// weight it sags too far, or shakes.
    fn long_for_plate(&self, cloth: &Cloth) -> Option<String> {
        /// The share of its weight that it pulls with from which on it shows, as measured.
        const SHOWS: f32 = 2.0;
        /// The share of its longer side that bending bears by itself.
        const STANDS: f32 = 0.25;
        let (params, sheet) = (cloth.shell_params()?, cloth.sheet()?);
        let [a, b] = sheet.sides;
        let density = cloth.by_area().unwrap_or(cloth.mass / length(a.cross(b)));
        let (pull, taken) = (length(self.pull()), self.substeps() as f32);
        let longest = sheet.sides.map(length).into_iter().fold(0.0, f32::max);
        let (weight, share) = (density * pull, STANDS * longest);
        if cloth.fixed.is_empty() || !(params.bending > weight * share * share * share) {
            return None;
        }
        let cells = sheet.sides.into_iter().zip(sheet.cells).map(|(side, cells)| length(side) / cells as f32);
        let h = self.run.dt as f32 / taken;
        let turns = pull * h * h / cells.fold(f32::INFINITY, f32::min);
        let stretch = params.stretch.into_iter().fold(0.0, f32::max);
        let excess = 0.5 * turns * turns * stretch / (SHOWS * weight * longest);
        let shakes = || {
            let needed = (taken * sqrt(sqrt(excess))) as u32;
            let needed = needed.saturating_add(1);
            format!(
                "it is so stiff that what it stretches by as it bends in a sub-step outweighs it: it hangs too far, or shakes; {}",
                enough(needed)
            )
        };
        (excess > 1.0 && excess < f32::INFINITY).then(shakes)
    }

    /// A remark on what reaches out of the room through one side and not through the opposite one, where it would come in again.
    fn reaches_out(&self, item: &Item) -> Option<String> {
        let stands = item.group.is_none() && item.motion.is_none();
        let Aabb { min, max } = stands.then(|| finite_bounds(&item.shape))??;
        let PeriodicRoom { low, sides } = self.room?;
        let names = ["x", "y", "z"].into_iter().zip(min.to_array().into_iter().zip(max.to_array()));
        let mut axes = names.zip(low.into_iter().zip(sides));
        let (name, _) = axes
            .find(|&((_, (min, max)), (low, side))| {
                let touches = side > 0.0 && max > low && min < low + side;
                touches && (min < low) != (max > low + side) && max - min < side
            })?
            .0;
        Some(format!(
            "it reaches out of the room along {name}, and does not act through its sides; put another one where it comes in again"
        ))
    }

    /// The sum of all gravity \[m/s²\].
    pub(super) fn pull(&self) -> Vec3 {
        self.forces.iter().fold(Vec3::ZERO, |sum, force| match force {
            ForceKind::Gravity(gravity) => sum + gravity.acceleration,
            _ => sum,
        })
    }

    /// Remarks on the elasticity of what the scene begins with.
    fn add_elasticities(&self, add: &mut impl FnMut(Arguments<'_>, Option<String>)) {
        let mut look = |list: &str, i: usize, elasticity: f32| {
            add(format_args!("{list}[{i}].elasticity"), odd_elasticity(Varied::exactly(elasticity)));
        };
        // A fixed particle hits nothing.
        let free = self.particles.iter().enumerate().filter(|(_, particle)| !particle.fixed);
        free.for_each(|(i, particle)| look("particles", i, particle.elasticity));
        self.cloths.iter().enumerate().for_each(|(i, cloth)| look("cloths", i, cloth.elasticity));
        self.boxes.iter().enumerate().for_each(|(i, boxes)| look("boxes", i, boxes.elasticity));
        self.strands.iter().enumerate().for_each(|(i, tuft)| look("strands", i, tuft.elasticity));
        self.ropes.iter().enumerate().for_each(|(i, cord)| look("ropes", i, cord.elasticity));
        self.soft_bodies.iter().enumerate().for_each(|(i, body)| look("soft_bodies", i, body.elasticity));
    }

    /// A remark on room for fewer than there are from the beginning. As many as are usual may not have been said at all.
    fn odd_capacity(&self) -> Option<String> {
        let (capacity, (least, is_all)) = (self.run.capacity, self.least_start());
        if capacity == Run::default().capacity || u64::from(capacity) >= least {
            return None;
        }
        let more = if is_all { "" } else { " and more" };
        let message = format!(
            "{capacity} is less than the {least} particles{more} that the scene begins with, which have room all the same; take no less"
        );
        Some(message)
    }

    /// The particles that it begins with, as far as they are known before meshes have been read, and whether those are all.
    fn least_start(&self) -> (u64, bool) {
        let cloths = self.cloths.iter().map(Cloth::count);
        let bodies = self.soft_bodies.iter().map(SoftBody::particles);
        let known = self.boxes.iter().map(Boxes::particles).chain(self.strands.iter().map(Tuft::particles));
        let known = known.chain(self.ropes.iter().map(Cord::particles)).map(Some);
        let own = (self.particles.len() as u64, true);
        known
            .chain(cloths)
            .chain(bodies)
            .fold(own, |(sum, is_all), more| (sum.saturating_add(more.unwrap_or(0)), is_all && more.is_some()))
    }

    /// Remarks on parts that do nothing.
    fn add_idle(&self, add: &mut impl FnMut(Arguments<'_>, Option<String>)) {
        for (i, constraint) in self.constraints.iter().enumerate() {
            if let ConstraintKind::Distance(distance) = constraint {
                let [a, b] = distance.ends;
                let itself = (a == b).then(|| format!("it holds particle {a} to itself, so it does nothing"));
                add(format_args!("constraints[{i}].distance.ends"), itself);
            }
            let ConstraintKind::Strands(strands) = constraint else { continue };
            for (end, name) in ["root", "tip"].into_iter().enumerate() {
                let nothing =
                    || format!("no {name} is held or clamped by two fixed neighbours, so nothing is turned there");
                add(format_args!("constraints[{i}].strands.turning"), self.is_idly_turned(strands, end).then(nothing));
            }
        }
        for (i, tuft) in self.strands.iter().enumerate() {
            let loose = tuft.motion.is_some() && tuft.fixed.is_empty() && matches!(tuft.form, Growth::Curve(_));
            let nothing = || "none of its points is fixed, so nothing follows it".into();
            add(format_args!("strands[{i}].motion"), loose.then(nothing));
            let loose = tuft.attach.is_some() && tuft.fixed.is_empty() && matches!(tuft.form, Growth::Curve(_));
            let nothing = || "none of its points is fixed, so nothing of it is tied; name them in fixed".into();
            add(format_args!("strands[{i}].attach"), loose.then(nothing));
        }
        for (i, cord) in self.ropes.iter().enumerate() {
            let nothing = || "none of its points is fixed, so nothing follows it".into();
            add(format_args!("ropes[{i}].motion"), (cord.motion.is_some() && cord.fixed.is_empty()).then(nothing));
        }
        for (i, sink) in self.sinks.iter().enumerate() {
            let idle = sink.intensity != 0.0 && [sink.ca, sink.la, sink.qa] == [0.0; 3];
            let nothing = || "it divides by ca, la and qa, which are all zero, so it pulls nobody".into();
            add(format_args!("sinks[{i}].intensity"), idle.then(nothing));
            let endless = sink.intensity != 0.0 && !idle && [sink.ca, sink.softening] == [0.0; 2];
            let bounded = || {
                "0 leaves its pull without bound at its surface, from which energies count, so these are infinite; say softening, or another ca".into()
            };
            add(format_args!("sinks[{i}].ca"), endless.then(bounded));
        }
        for (i, reaper) in self.reapers.iter().enumerate() {
            let narrow = matches!(reaper, ReaperKind::Dense(dense) if dense.radius == 0.0);
            let nobody = || "nobody is within 0 m of another who is not in the same place".into();
            add(format_args!("reapers[{i}].dense.radius"), narrow.then(nobody));
        }
        for (i, goal) in self.goals.iter().enumerate() {
            let infinite = matches!(goal.shape, Shape::Plane(_));
            let point = || "a plane is infinite, so all are led to its one point".into();
            add(format_args!("goals[{i}].shape"), infinite.then(point));
        }
    }
}

impl SceneFile {
    /// Remarks on the first drag of a list where the scene has forces, of which none looks at it.
    fn add_unread(&self, add: &mut impl FnMut(Arguments<'_>, Option<String>)) {
        let reads = |force: &ForceKind| matches!(force, ForceKind::Drag(_) | ForceKind::Wind(_));
        if self.forces.is_empty() || self.forces.iter().any(reads) {
            return;
        }
        let mut look = |list: &str, drags: &mut dyn Iterator<Item = f32>| {
            let Some((i, drag)) = drags.enumerate().find(|(_, drag)| *drag != 0.0) else { return };
            let nothing =
                || format!("{drag} brakes nobody, for no force looks at it; add drag or wind to the forces, or take 0");
            add(format_args!("{list}[{i}].drag"), Some(nothing()));
        };
        look("particles", &mut self.particles.iter().map(|particle| particle.drag));
        look("emitters", &mut self.emitters.iter().map(|emitter| emitter.drag.mean));
        look("boxes", &mut self.boxes.iter().map(|boxes| boxes.drag));
    }

    /// The drag in still air that acts beside a wind on the same coefficients, by its place in the list of forces.
    fn doubled_drag(&self) -> Option<usize> {
        let blows = |force: &ForceKind| matches!(force, ForceKind::Wind(wind) if wind.coefficient.is_none());
        let drag = self.forces.iter().position(|force| matches!(force, ForceKind::Drag(_)))?;
        self.forces.iter().any(blows).then_some(drag)
    }

    /// Tells whether strands turn an end, root or tip, that is neither held nor clamped in any of them: one of the two particles there, of the file's
    /// own, is not fixed.
    fn is_idly_turned(&self, strands: &Strands<Vec<u32>, Vec<u32>>, end: usize) -> bool {
        let is_free = |&at: &usize| {
            let number = strands.particles.get(at).and_then(|&number| usize::try_from(number).ok());
            number.and_then(|number| self.particles.get(number)).is_some_and(|particle| !particle.fixed)
        };
        let is_loose = |[first, last]: [usize; 2]| {
            let edge = if end == 0 { [first, first + 1] } else { [last - 1, last.saturating_sub(2)] };
            edge.iter().any(is_free)
        };
        strands.turning[end] != 0.0 && !strands.held[end] && strands.strands().all(is_loose)
    }
}

/// What helps where a remark asks for so many sub-steps.
pub(super) fn enough(needed: u32) -> String {
    match needed {
        ..=MOST_SUBSTEPS => format!("run.substeps of {needed} are enough"),
        _ => format!("no number of sub-steps is enough, of which run.substeps may say {MOST_SUBSTEPS}"),
    }
}

/// A remark on a triangle without an area.
fn thin(shape: &Shape<String>) -> Option<String> {
    let Shape::Triangle(triangle) = shape else { return None };
    let [a, b, c] = triangle.corners;
    ((b - a).cross(c - a) == Vec3::ZERO).then(|| "its corners lie on a line, so nothing hits it".into())
}

/// The bounds of a shape that needs no file and is finite.
fn finite_bounds(shape: &Shape<String>) -> Option<Aabb> {
    match shape {
        Shape::Box(cuboid) => Some(cuboid.bounds()),
        Shape::Circle(disc) => Some(disc.bounds()),
        Shape::Sphere(sphere) => Some(sphere.bounds()),
        Shape::Cylinder(cylinder) => Some(cylinder.bounds()),
        Shape::Cone(cone) => Some(cone.bounds()),
        Shape::Capsule(capsule) => Some(capsule.bounds()),
        Shape::Triangle(triangle) => Some(triangle.bounds()),
        Shape::Mesh(_) | Shape::Line(_) | Shape::Plane(_) | Shape::HeightField(_) => None,
    }
}

/// A remark on an odd share of the speed that hits leave.
pub(super) fn odd_elasticity(Varied { mean, half_width }: Varied) -> Option<String> {
    /// The error that sums of decimals may have.
    const ROUNDING: f32 = 1e-6;
    let (least, most) = (mean - half_width.abs(), mean + half_width.abs());
    if most > 1.0 + ROUNDING {
        return Some(format!("{most} is above 1, so hits add energy"));
    }
    (least < -ROUNDING).then(|| format!("{least} is below 0, which counts as 0: hits leave nothing of a speed"))
}

/// A remark on an odd angle within which births leave. The lecture's recipe takes the sine of any.
fn odd_spread(spread: Spread) -> Option<String> {
    let Spread::Uniform(cutoff) = spread else { return None };
    (!(0.0..=HALF_TURN).contains(&cutoff)).then(|| format!("{cutoff} rad is not from 0 to π, which is all directions"))
}

/// A remark on a lifetime that some are born without.
fn odd_lifetime(Varied { mean, half_width }: Varied) -> Option<String> {
    let least = mean - half_width.abs();
    let some =
        || format!("{least} s is the least of it: who is born with no more than 0 s lives on, as without a lifetime");
    (half_width != 0.0 && least < 0.0 && least.is_finite()).then(some)
}

/// A remark on odd ends of a spring.
pub(super) fn odd_ends([a, b]: [i64; 2]) -> Option<String> {
    (a == b).then(|| format!("the spring joins particle {a} to itself, so it does nothing"))
}

/// A remark on an odd stiffness or damping of a spring.
pub(super) fn odd_strength(number: f32) -> Option<String> {
    (number < 0.0).then(|| format!("{number} is below 0, so the spring gains energy without bound"))
}

fn odd_friction(Friction { static_, kinetic }: Friction) -> Option<String> {
    let odd = static_ < kinetic;
    odd.then(|| format!("{static_} is below kinetic, {kinetic}, though what rests is held more than what slides"))
}
