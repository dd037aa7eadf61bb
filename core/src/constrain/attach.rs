//! Particles that go where a script says, and take along whatever is bound to them.

#[cfg(feature = "alloc")]
use super::declared::Declared;
use super::{Bodies, Constraint, Demand, Share, Words};
use crate::index::image_beside;
#[cfg(feature = "alloc")]
use crate::motion::MotionBuf;
use crate::motion::Script;
#[cfg(feature = "alloc")]
use alloc::vec::Vec;
use glam::Vec3;

/// Attaches particles to something that moves by a script: each keeps the place in its frame that it had when the constraint first
/// acted.
///
/// Through a sub-step they go straight to where they have to be at its end; springs, rods and contacts feel them on that way. Whoever
/// is `fixed` is moved by nothing else; others give way to constraints that come later in the list.
///
/// In a [periodic room](crate::index::Periodic) the places of all are those beside the first of them.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Attach<P, M> {
    /// The particles, by their place in the scene's start.
    pub particles: P,
    /// How they move.
    pub motion: M,
}

impl<P: AsRef<[u32]>, M> Attach<P, M> {
    /// The words that it keeps: each particle's place in the frame, and whose these are.
    fn kept(&self) -> usize {
        3 * self.particles.as_ref().len() + 1
    }
}

impl<P: AsRef<[u32]>, M: Script> Attach<P, M> {
    /// Takes the places of all in the frame as it is at the sub-step's beginning, at the first of all.
    fn learn(&self, bodies: &Bodies<'_>, kept: &mut [u32]) {
        let Some((_, places)) = kept.split_first_mut() else { return };
        let (frame, mut first) = (self.motion.frame(bodies.substep.during[0]), None);
        for (&number, place) in self.particles.as_ref().iter().zip(places.chunks_exact_mut(3)) {
            if let Some(row) = bodies.row_of_start(number) {
                let first = *first.get_or_insert(bodies.position[row]);
                let beside = image_beside(bodies.near.room(), first, bodies.position[row]);
                let local = frame.local(beside).to_array();
                place.copy_from_slice(&local.map(f32::to_bits));
            }
        }
    }

    /// Visits all that live, each with its row and its place in the frame.
    fn each(&self, bodies: &mut Bodies<'_>, kept: &[u32], visit: impl Fn(&mut Bodies<'_>, usize, Vec3)) {
        let places = kept.get(1..).unwrap_or_default().chunks_exact(3);
        for (&number, place) in self.particles.as_ref().iter().zip(places) {
            if let Some(row) = bodies.row_of_start(number) {
                let [x, y, z] = [place[0], place[1], place[2]].map(f32::from_bits);
                visit(bodies, row, Vec3::new(x, y, z));
            }
        }
    }
}

/// A place, or that image of it in a periodic room which is nearest to where the particle in a row is.
fn beside(bodies: &Bodies<'_>, row: usize, place: Vec3) -> Vec3 {
    image_beside(bodies.near.room(), bodies.position[row], place)
}

impl<P: AsRef<[u32]> + Sync, M: Script> Constraint for Attach<P, M> {
    fn demand(&self) -> Demand {
        Demand { kept: Words { per_row: 0, fixed: self.kept() }, ..Demand::NONE }
    }

    fn is_empty(&self) -> bool {
        self.particles.as_ref().is_empty()
    }

    /// Sends them off straight to where they have to be.
    fn prepare(&self, bodies: &mut Bodies<'_>, share: &mut Share<'_>) {
        if share.claim(*b"atta", &[self.particles.as_ref().len()]) {
            self.learn(bodies, share.kept.fixed);
        }
        let (end, h) = (self.motion.frame(bodies.substep.during[1]), bodies.substep.seconds());
        if h > 0.0 {
            self.each(bodies, share.kept.fixed, |bodies, row, place| {
                bodies.velocity[row] = (beside(bodies, row, end.world(place)) - bodies.position[row]) * (1.0 / h);
            });
        }
    }

    fn project(&self, bodies: &mut Bodies<'_>, share: &mut Share<'_>) {
        let end = self.motion.frame(bodies.substep.during[1]);
        self.each(bodies, share.kept.fixed, |bodies, row, place| {
            let target = end.world(place);
            let to = beside(bodies, row, target);
            bodies.shift(row, to - bodies.position[row]);
            bodies.position[row] = to;
            bodies.velocity[row] = end.velocity_at(target);
        });
    }
}

#[cfg(feature = "alloc")]
impl Declared for Attach<Vec<u32>, MotionBuf> {
    fn name(&self) -> &'static str {
        "attach"
    }

    fn solved(&self) -> &'static str {
        "go where the script says"
    }

    fn fault(&self) -> Option<(&'static str, &'static str)> {
        self.motion.fault().map(|why| ("motion", why))
    }

    fn ends(&self) -> [&[u32]; 3] {
        [&self.particles, &[], &[]]
    }

    fn leads(&self) -> bool {
        true
    }
}
