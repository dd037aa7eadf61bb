//! How ties of scene files become constraints.

use super::start::Start;
use super::ties::{Body, BodyTie};
use crate::constrain::{ConstraintKind, Rope, Tie, TiedRope};
use crate::draw::Lock;
use crate::math::{clamp, dot, length};
use crate::rays;
use crate::shape::{Aabb, MeshBuf, Surface, Triangle};
use alloc::collections::btree_map::Entry;
use alloc::format;
use alloc::string::{String, ToString};
use alloc::vec::Vec;
use glam::Vec3;

/// A rope of a file, with what its ends are tied to.
type FileRope = TiedRope<Vec<u32>, Vec<f32>, Vec<u32>, Vec<f32>>;

/// How far a point may be off the line that it is tied to, a share of a segment of that.
const OFF: f32 = 1e-3;

/// What is wrong with a cloth that is a line, or has no triangles near enough.
const BARE: &str = "it has no triangle to be tied to; a sheet needs cells along both of its sides";

/// What is wrong with a number beyond the bodies of a kind.
fn beyond(kind: &str, number: u32, count: usize) -> String {
    format!("{kind} {number} is out of range; there are {count}, from 0")
}

impl Start {
    /// The first particle of a body, and their number.
    fn span(&self, body: Body) -> Result<[u32; 2], String> {
        let line = |locks: &[Lock], number: u32, kind: &str| {
            let mut left = number;
            for lock in locks {
                if left < lock.count {
                    return Ok([lock.first + left * lock.points, lock.points]);
                }
                left -= lock.count;
            }
            Err(beyond(kind, number, locks.iter().map(|lock| lock.count as usize).sum()))
        };
        match body {
            Body::Cloth(number) => match self.cloth_span(number as usize) {
                Some(span) => Ok(span),
                None => Err(beyond("cloth", number, self.cloths.len())),
            },
            Body::Box(number) => match self.boxes.get(number as usize) {
                Some(of) => Ok([of.first, of.count]),
                None => Err(beyond("box", number, self.boxes.len())),
            },
            Body::Strand(number) => line(&self.locks[..self.locks.len() - self.ropes.len()], number, "strand"),
            Body::Rope(number) => line(&self.locks[self.locks.len() - self.ropes.len()..], number, "rope"),
        }
    }

    /// Tells whether a body is a cloth without triangles.
    fn is_bare(&self, body: Body) -> bool {
        let Body::Cloth(number) = body else { return false };
        let first = self.cloths.get(number as usize).map(|&[first, _]| first as u32);
        first.is_some_and(|first| self.patches.iter().all(|patch| patch.first != first))
    }

    /// The particle that a point is.
    fn point(&self, of: Option<Body>, point: u32) -> Result<u32, String> {
        let [first, count] = of.map_or(Ok([0, self.own]), |body| self.span(body))?;
        if point < count { Ok(first + point) } else { Err(beyond("point", point, count as usize)) }
    }

    /// The corners of that of a cloth's triangles which is nearest to a place, of several as near of the first; they are counted from its first
    /// particle. What finds it is made when it is first asked for.
    fn nearest_triangle(&mut self, [first, count]: [u32; 2], place: Vec3) -> Option<[u32; 3]> {
        let skin = match self.skins.entry(first) {
            Entry::Occupied(made) => made.into_mut(),
            Entry::Vacant(none) => {
                let triangles = self.patches.iter().find(|patch| patch.first == first)?.triangles.clone();
                let own = self.particles.get(first as usize..)?.iter().take(count as usize);
                let corners = own.map(|particle| particle.position).collect();
                none.insert(MeshBuf::new(corners, triangles).ok()?.organised(rays::Structure::Bvh))
            }
        };
        let far = |near: Vec3| dot(near - place, near - place);
        let reach = length(skin.nearest(place) - place);
        let around = Aabb { min: place - reach, max: place + reach }.with_slack();
        let mut nearest: Option<(f32, [u32; 3])> = None;
        skin.index().near(&skin.view(), &around, &mut |number| {
            let corners = skin.triangles()[number];
            let spot = Triangle { corners: corners.map(|corner| skin.vertices()[corner as usize]) }.nearest(place);
            if nearest.is_none_or(|(least, _)| far(spot) < least) {
                nearest = Some((far(spot), corners));
            }
        });
        nearest.map(|(_, corners)| corners)
    }

    /// The particles of the part of a body that is nearest to a place, which say where it is.
    fn nearest(&mut self, to: Body, place: Vec3) -> Result<Vec<u32>, String> {
        let [first, count] = self.span(to)?;
        if let Body::Cloth(_) = to {
            let corners = self.nearest_triangle([first, count], place).ok_or(BARE)?;
            return Ok(corners.map(|corner| first + corner).to_vec());
        }
        let at = |number: u32| self.particles[number as usize].position;
        match to {
            Body::Box(_) | Body::Cloth(_) => Ok((first..first + count).collect()),
            Body::Strand(_) | Body::Rope(_) => {
                let beside = |point: &u32| {
                    let (from, way) = (at(*point), at(point + 1) - at(*point));
                    let share = clamp(dot(place - from, way) / dot(way, way), 0.0, 1.0);
                    (length(place - from - way * share), length(way))
                };
                let all = (first..first + count - 1).map(|point| (beside(&point), point));
                let Some(((far, size), point)) = all.min_by(|a, b| a.0.0.total_cmp(&b.0.0)) else {
                    return Err("it has no segment to be tied to".to_string());
                };
                if far > OFF * size {
                    return Err(format!("the point begins {far:?} m beside its line; put it on that"));
                }
                Ok(alloc::vec![point, point + 1])
            }
        }
    }

    /// The tie of a particle to a body at the place where it begins.
    pub(super) fn tied(
        &mut self,
        particle: u32,
        to: Body,
        [compliance, damping]: [f32; 2],
    ) -> Result<Tie<Vec<u32>, Vec<f32>>, String> {
        let nearest = self.nearest(to, self.particles[particle as usize].position)?;
        if nearest.contains(&particle) {
            return Err("it is a part of that body; name another".to_string());
        }
        Ok(Tie { particle, to: nearest, weights: None, offset: 0.0, compliance, damping })
    }

    /// Ties a particle to a body at the place where it begins. A rope whose end it is solves for it with what it is tied to.
    pub(super) fn tie(&mut self, particle: u32, to: Body, give: [f32; 2]) -> Result<(), String> {
        let tie = self.tied(particle, to, give)?;
        match if tie.compliance == 0.0 { self.free_end(particle) } else { None } {
            Some((TiedRope { ends, .. }, end)) => ends[end] = Some(tie),
            None => self.constraints.push(ConstraintKind::Tie(tie)),
        }
        Ok(())
    }

    /// The rope of which a particle is an end that nothing holds, and which.
    fn free_end(&mut self, particle: u32) -> Option<(&mut FileRope, usize)> {
        if self.particles.get(particle as usize)?.fixed {
            return None;
        }
        let of = |rope: &Rope<Vec<u32>, Vec<f32>>| {
            [rope.particles.first(), rope.particles.last()].iter().position(|&end| end == Some(&particle))
        };
        for constraint in &mut self.constraints {
            match constraint {
                ConstraintKind::Rope(rope) if of(rope).is_some() => {
                    *constraint = ConstraintKind::TiedRope(TiedRope { rope: rope.clone(), ends: [None, None] });
                }
                _ => {}
            }
            if let ConstraintKind::TiedRope(tied) = constraint
                && let Some(end) = of(&tied.rope)
            {
                return tied.ends[end].is_none().then_some((tied, end));
            }
        }
        None
    }

    /// Ties all points that are to be tied.
    pub(super) fn add_ties(&mut self, ties: &[BodyTie]) -> Result<(), (String, String)> {
        for (i, tie) in ties.iter().enumerate() {
            for (k, &point) in tie.points.iter().enumerate() {
                let at = |field: &str| format!("ties[{i}].{field}");
                if let Some(body) = tie.of {
                    self.span(body).map_err(|message| (at("of"), message))?;
                }
                self.span(tie.to).map_err(|message| (at("to"), message))?;
                if self.is_bare(tie.to) {
                    return Err((at("to"), BARE.to_string()));
                }
                let particle = self.point(tie.of, point).map_err(|message| (at(&format!("points[{k}]")), message))?;
                self.tie(particle, tie.to, [tie.compliance, tie.damping])
                    .map_err(|message| (at(&format!("points[{k}]")), message))?;
            }
        }
        Ok(())
    }
}
