//! How ties of scene files become constraints.

use super::start::Start;
use super::ties::{Body, BodyTie};
use crate::constrain::{ConstraintKind, Tie};
use crate::draw::Lock;
use crate::math::{clamp, dot, length};
use crate::shape::{Surface, Triangle};
use alloc::format;
use alloc::string::{String, ToString};
use alloc::vec::Vec;
use glam::Vec3;

/// How far a point may be off the line that it is tied to, a share of a segment of that.
const OFF: f32 = 1e-3;

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

    /// The particle that a point is.
    fn point(&self, of: Option<Body>, point: u32) -> Result<u32, String> {
        let [first, count] = of.map_or(Ok([0, self.own]), |body| self.span(body))?;
        if point < count { Ok(first + point) } else { Err(beyond("point", point, count as usize)) }
    }

    /// The particles of the part of a body that is nearest to a place, which say where it is.
    fn nearest(&self, to: Body, place: Vec3) -> Result<Vec<u32>, String> {
        let [first, count] = self.span(to)?;
        let at = |number: u32| self.particles[number as usize].position;
        match to {
            Body::Box(_) => Ok((first..first + count).collect()),
            Body::Cloth(_) => {
                let of = self.patches.iter().find(|patch| patch.first == first);
                let triangles = of.iter().flat_map(|patch| &patch.triangles);
                let far = |corners: &[u32; 3]| {
                    let [a, b, c] = corners.map(|corner| at(first + corner));
                    let near = Triangle { corners: [a, b, c] }.nearest(place);
                    dot(near - place, near - place)
                };
                let nearest = triangles.map(|corners| (far(corners), corners)).min_by(|a, b| a.0.total_cmp(&b.0));
                let (_, corners) = nearest.ok_or("it has no triangle to be tied to")?;
                Ok(corners.map(|corner| first + corner).to_vec())
            }
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
        &self,
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

    /// Ties a particle to a body at the place where it begins.
    pub(super) fn tie(&mut self, particle: u32, to: Body, give: [f32; 2]) -> Result<(), String> {
        self.constraints.push(ConstraintKind::Tie(self.tied(particle, to, give)?));
        Ok(())
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
                let particle = self.point(tie.of, point).map_err(|message| (at(&format!("points[{k}]")), message))?;
                self.tie(particle, tie.to, [tie.compliance, tie.damping])
                    .map_err(|message| (at(&format!("points[{k}]")), message))?;
            }
        }
        Ok(())
    }
}
