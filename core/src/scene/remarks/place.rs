//! Remarks on where things begin: sunk into scenery, or far from where constraints hold them.

use crate::constrain::ConstraintKind;
use crate::emit::Emitter;
use crate::index::between;
use crate::math::{floor, length, max, min};
use crate::motion::MotionBuf;
use crate::scene::placing::placement;
use crate::scene::{Item, Response, SceneFile};
use crate::shape::{Collider, MeshBuf, Placed, Shape, Surface};
use crate::time::Time;
use alloc::format;
use alloc::string::String;
use alloc::sync::Arc;
use core::fmt::Arguments;
use glam::Vec3;

/// The share of its radius that a ball may begin in scenery, as from rounded numbers.
const ROUNDED: f32 = 0.01;

/// The share of its length that a constraint may begin off it.
const CLOSE: f32 = 0.05;

/// As many balls are held against scenery.
const BALLS: usize = 10_000;

/// As often is a ball held against a piece of it.
const LOOKS: usize = 1_000_000;

/// The places of births that are held against scenery.
const PLACES: u16 = 16;

/// Scenery that stands still and needs no file, where its groups take it.
type Solid = Placed<Shape<Arc<MeshBuf>>>;

impl SceneFile {
    /// Remarks on what begins sunk into scenery, which lets nobody through and so holds it there, the first of each list for each piece of it. Meshes are
    /// not looked at, as they have not been read.
    pub(super) fn add_sunk(&self, add: &mut impl FnMut(Arguments<'_>, Option<String>)) {
        // By position they are lifted out.
        if let Some(Response::Position(_)) = self.contacts {
            return;
        }
        let mut looks = LOOKS;
        for (piece, solid) in self.scenery.iter().enumerate().filter_map(|(i, item)| Some((i, self.still(item)?))) {
            if let Some((i, depth, others)) = self.sunk_balls(&solid, &mut looks) {
                let others = if others > 0 { format!(", as {others} more are") } else { String::new() };
                let sunk = format!(
                    "it is {depth} m inside of scenery[{piece}]{others}, and stays as deep in it; let it begin a radius away"
                );
                add(format_args!("particles[{i}].position"), Some(sunk));
            }
            for (i, emitter) in self.emitters.iter().enumerate() {
                let Some(depth) = self.born_sunk(&solid, emitter) else { continue };
                let sunk = format!(
                    "births are {depth} m inside of scenery[{piece}] and more, have no speed, and stay as deep in it; let them begin a radius away"
                );
                add(format_args!("emitters[{i}].shape"), Some(sunk));
            }
        }
    }

    /// The first ball that begins sunk into something, how deep \[m\], and how many others do. So many may still be looked at.
    fn sunk_balls(&self, solid: &Solid, looks: &mut usize) -> Option<(usize, f32, usize)> {
        let balls = self.particles.iter().enumerate().filter(|(_, ball)| ball.radius > 0.0 && !ball.fixed);
        let balls = balls.take(BALLS.min(*looks)).inspect(|_| *looks -= 1);
        let mut sunk = balls.filter_map(|(i, ball)| {
            let depth = depth(solid, ball.position, ball.radius, ball.velocity)?;
            (depth > ROUNDED * ball.radius).then_some((i, depth))
        });
        let (first, depth) = sunk.next()?;
        Some((first, depth, sunk.count()))
    }

    /// How deep the births of an emitter begin in something at the least \[m\], if all of them do and none has a speed.
    fn born_sunk(&self, solid: &Solid, emitter: &Emitter<Shape<String>, Option<MotionBuf>>) -> Option<f32> {
        let Emitter { speed, velocity, fixed, inside, .. } = *emitter;
        let radius = emitter.radius.mean - emitter.radius.half_width.abs();
        let leaves = [speed.mean, speed.half_width] != [0.0; 2] || velocity != Vec3::ZERO || emitter.motion.is_some();
        if !(radius > 0.0) || fixed || inside || leaves {
            return None;
        }
        let (shape, to_world) = (unread(&emitter.shape)?, placement(self, emitter.group));
        let depth_at = |i: u16| {
            // The sequence that fills a box evenly by powers of the root of x⁴ = x + 1.
            let numbers = [0.819_172_5, 0.671_043_6, 0.549_700_5].map(|step| {
                let sum = f32::from(i) * step;
                sum - floor(sum)
            });
            depth(solid, to_world.point(shape.sample(numbers).point), radius, Vec3::ZERO).unwrap_or(0.0)
        };
        let least = (0..PLACES).map(depth_at).fold(f32::INFINITY, min);
        (least > ROUNDED * radius).then_some(least)
    }

    /// Scenery where it stands, if it does and is no mesh.
    fn still(&self, item: &Item) -> Option<Solid> {
        if item.motion.is_some() || matches!(item.shape, Shape::Line(_)) {
            return None;
        }
        let (shape, to_world) = (unread(&item.shape)?, placement(self, item.group));
        if shape.meets_balls(&to_world) { Placed::new(shape, to_world) } else { None }
    }

    /// Remarks on rigid links that begin far from their lengths, to which they are put in the first step whatever is in the way.
    pub(super) fn add_far(&self, add: &mut impl FnMut(Arguments<'_>, Option<String>)) {
        let room = self.room.map(|room| room.room());
        for (i, constraint) in self.constraints.iter().enumerate() {
            let name = match constraint {
                ConstraintKind::Distance(_) => "distance.length",
                ConstraintKind::Rope(_) => "rope.lengths",
                _ => continue,
            };
            if constraint.compliance() > 0.0 {
                continue;
            }
            let far = constraint.links().zip(constraint.lengths()).find_map(|(ends, wanted)| {
                let [a, b] = ends.map(|end| self.particles.get(end as usize));
                let (a, b) = (a?, b?);
                let apart = length(between(room.as_ref(), a.position, b.position));
                let off = if constraint.is_tether() { apart - wanted } else { (apart - wanted).abs() };
                let is_far = off > CLOSE * max(wanted, apart) && !(a.fixed && b.fixed);
                is_far.then_some((ends, wanted, apart))
            });
            let Some(([a, b], wanted, apart)) = far else { continue };
            let jump = format!(
                "{wanted} m is far from the {apart} m that particles {a} and {b} begin apart, so the first step moves them all the way; let them begin as far apart"
            );
            add(format_args!("constraints[{i}].{name}"), Some(jump));
        }
    }
}

/// A shape that has been read, if it needs no file.
fn unread(shape: &Shape<String>) -> Option<Shape<Arc<MeshBuf>>> {
    shape.with_mesh(|_| Err(())).ok()
}

/// How deep a ball is in something that it does not leave \[m\], zero where it is not.
fn depth(solid: &Solid, center: Vec3, radius: f32, velocity: Vec3) -> Option<f32> {
    let mut deepest = None;
    solid.contacts(center, radius, Time::ZERO, &mut |contact| {
        let depth = radius - contact.distance;
        let stays = !(velocity.dot(contact.normal) > 0.0);
        if stays && deepest.is_none_or(|deepest| depth > deepest) {
            deepest = Some(depth);
        }
    });
    deepest
}
