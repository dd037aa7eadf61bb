//! The faces of the scenery that particles of sheets are kept from, half a thickness off.

use super::super::contacts::Touch;
use super::super::{Bodies, Substep};
use super::contact::Surface;
use super::lists::{Kept, NOBODY, Work};
use super::rest::Rest;
use crate::material::on_surface;
use crate::math::{high, length, low, max, min};
use crate::shape::{Aabb, Contact, Segment};

/// Sub-steps ahead that a search of the scenery looks, at the most.
const AHEAD: u32 = 8;
/// The share of a gap that is missing that a sub-step gives back.
const RECOVERY: f32 = 0.2;
/// The share of half a thickness that a particle stays off, whatever happens.
const LEAST: f32 = 0.1;
/// A particle's way through the sub-step may pass through the scenery.
const LOST: u32 = 1;
/// A face is listed near it in the sub-step.
const LISTED: u32 = 2;

/// Lists the faces that particles may touch in the sub-step. Who has been found to be far from all is not asked again before it has gone
/// that far, if nothing there moves.
pub(super) fn gather(rest: &Rest<'_>, kept: &mut Kept<'_>, work: &Work<'_>, bodies: &mut Bodies<'_>) {
    kept.counts.surfaces = 0;
    if bodies.substep.number == 0 {
        kept.clear.fill(0.0);
    }
    kept.followed.fill(0);
    if bodies.colliders.is_empty() {
        return;
    }
    let Substep { number, count, .. } = bodies.substep;
    let ahead = (count - number).min(AHEAD) as f32;
    for i in 0..kept.rows.len() {
        let row = kept.rows[i];
        if row == NOBODY || !(kept.weight[i] > 0.0) {
            continue;
        }
        let (half, way) = (rest.half[i], length(work.now[i] - work.from[i]));
        // Others may push it as far again.
        let near = 2.0 * (half + way);
        if kept.clear[i] < near || bodies.colliders.moves() {
            kept.clear[i] = near + ahead * way;
            look(kept, (i, row as usize), [half, near], work, bodies);
        }
        kept.clear[i] = max(kept.clear[i] - way, 0.0);
    }
}

/// Lists the faces near a particle, and says how far off all are, at the least.
fn look(
    kept: &mut Kept<'_>,
    (i, row): (usize, usize),
    [half, near]: [f32; 2],
    work: &Work<'_>,
    bodies: &mut Bodies<'_>,
) {
    let (from, h) = (work.from[i], bodies.substep.seconds());
    let (own, elasticity) = (bodies.material[row].checked_sub(1), bodies.elasticity[row]);
    let reach = kept.clear[i];
    bodies.colliders.contacts(from, reach, bodies.substep.during[0], &mut |contact: &Contact| {
        let Contact { point, normal, distance, velocity, material, .. } = *contact;
        kept.clear[i] = min(distance, kept.clear[i]);
        if !(distance < near) || !normal.is_finite() {
            return;
        }
        let Some(place) = kept.surfaces.get_mut(kept.counts.surfaces as usize) else {
            bodies.report.caps.contacts += 1;
            kept.followed[i] |= LOST;
            return;
        };
        kept.counts.surfaces += 1;
        kept.followed[i] |= LISTED;
        let recovery = RECOVERY * max(half - distance, 0.0);
        let gap = if distance < half { distance + recovery } else { half };
        let surface = normal.dot(point + velocity * h);
        let (offset, limit) = (surface + gap, surface + min(LEAST * half, 0.5 * distance));
        let mut touch = Touch::new(on_surface(bodies.materials, elasticity, own, material));
        touch.begin(0.0);
        *place = Surface {
            particle: i as u32,
            normal,
            offset,
            limit,
            recovery,
            distance,
            velocity,
            touch,
            tangent: bytemuck::Zeroable::zeroed(),
        };
    });
}

/// Tells whether a face is listed near a particle in the sub-step.
pub(super) fn is_near(kept: &Kept<'_>, i: usize) -> bool {
    kept.followed[i] & LISTED != 0
}

/// Puts whoever has been pushed too near to a face, or past another, back to where it was, as seen from that. Tells whether somebody has been.
pub(super) fn hold(kept: &Kept<'_>, work: &mut Work<'_>, bodies: &Bodies<'_>) -> bool {
    let mut holds = false;
    for surface in &kept.surfaces[..kept.counts.surfaces as usize] {
        let i = surface.particle as usize;
        let near = || work.now[i].dot(surface.normal) < surface.limit;
        if work.held[i] == 0 && (near() || passes(kept, work, bodies, (i, surface))) {
            work.held[i] = 1;
            work.put(i, work.from[i] + surface.velocity * bodies.substep.seconds());
            holds = true;
        }
    }
    holds
}

/// Tells whether a particle goes through the scenery in the sub-step, which it does not where it goes less far than a face of it is off.
fn passes(kept: &Kept<'_>, work: &Work<'_>, bodies: &Bodies<'_>, (i, surface): (usize, &Surface)) -> bool {
    let h = bodies.substep.seconds();
    let way = length(work.now[i] - work.from[i]) + length(surface.velocity) * h;
    way >= surface.distance - bodies.radius[kept.rows[i] as usize] && meets(kept, work, bodies, i)
}

fn meets(kept: &Kept<'_>, work: &Work<'_>, bodies: &Bodies<'_>, i: usize) -> bool {
    // As far as the sweep lets in what is kept off.
    let radius = 0.5 * bodies.radius[kept.rows[i] as usize];
    let way = Segment { from: work.from[i], to: work.now[i], radius, during: bodies.substep.during };
    bodies.colliders.first_hit(&way).is_some()
}

/// Notes whose ways through the sub-step may pass through the scenery, and leaves all others out of the sweep at its end.
pub(super) fn follow(kept: &mut Kept<'_>, work: &Work<'_>, bodies: &mut Bodies<'_>) {
    if bodies.colliders.is_empty() {
        return;
    }
    for number in 0..kept.counts.surfaces as usize {
        let surface = &kept.surfaces[number];
        let i = surface.particle as usize;
        if kept.followed[i] & LOST == 0 && passes(kept, work, bodies, (i, surface)) {
            kept.followed[i] |= LOST;
        }
    }
    for i in 0..kept.rows.len() {
        let (row, listed) = (kept.rows[i], is_near(kept, i));
        if row == NOBODY || !(kept.weight[i] > 0.0) || kept.followed[i] & LOST != 0 {
            continue;
        }
        // What lists no faces may be in the way of others.
        let radius = bodies.radius[row as usize];
        let around =
            Aabb { min: low(work.from[i], work.now[i]) - radius, max: high(work.from[i], work.now[i]) + radius };
        if listed || !bodies.colliders.may_touch(&around) || !meets(kept, work, bodies, i) {
            bodies.mark_followed(row as usize);
        }
    }
}
