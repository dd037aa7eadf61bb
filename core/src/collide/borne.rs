//! The walls that bear what goes along them.

use crate::math::{length, scaled};
use glam::Vec3;

/// The greatest cosine between the normals of two walls that count as two.
const TWO: f32 = 0.999;

/// The number of walls that are heeded.
const MOST: usize = 4;

/// How far into a wall something leads that goes along it, by rounding, as a share of it.
const ROUNDING: f32 = 64.0 * f32::EPSILON;

/// The walls that bear something, by their normals.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Borne {
    normals: [Vec3; MOST],
    count: u8,
}

impl Borne {
    pub(super) const NOT: Self = Self { normals: [Vec3::ZERO; MOST], count: 0 };

    fn normals(&self) -> &[Vec3] {
        &self.normals[..usize::from(self.count)]
    }

    /// Has one more wall, unless it is one of those that are known, or there is no room.
    pub(super) fn add(&mut self, normal: Vec3) {
        let is_known = self.normals().iter().any(|known| known.dot(normal) > TWO);
        if let Some(place) = self.normals.get_mut(usize::from(self.count)).filter(|_| !is_known) {
            (*place, self.count) = (normal, self.count + 1);
        }
    }

    /// Those of them that something does not leave to which a push has given the second velocity.
    pub(super) fn kept_by(&self, [before, velocity]: [Vec3; 2]) -> Self {
        let mut kept = Self::NOT;
        let most = ROUNDING * (length(before) + length(velocity));
        self.normals().iter().filter(|normal| velocity.dot(**normal) <= most).for_each(|normal| kept.add(*normal));
        kept
    }

    /// What of a push is left by the walls that it leads into: of all that lead into none that which is nearest to it.
    pub(super) fn left_of(&self, push: Vec3) -> Vec3 {
        let (normals, least) = (self.normals(), -ROUNDING * length(push));
        let is_free = |left: &Vec3| normals.iter().all(|normal| left.dot(*normal) >= least);
        if is_free(&push) {
            return push;
        }
        let along_one = normals.iter().map(|normal| push - *normal * push.dot(*normal));
        let pairs = normals.iter().enumerate().flat_map(|(i, a)| normals[..i].iter().map(move |b| a.cross(*b)));
        let along_two = pairs.map(|line| scaled(line, push.dot(line) / line.dot(line)));
        let farthest = |best: Vec3, left: Vec3| if left.dot(left) > best.dot(best) { left } else { best };
        along_one.chain(along_two).filter(is_free).fold(Vec3::ZERO, farthest)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_left_of_a_push_leads_into_no_wall() {
        let [a, b] = [Vec3::new(0.6, 0.8, 0.0), Vec3::new(-0.8, 0.6, 0.0)];
        let mut borne = Borne::NOT;
        [a, a, b].into_iter().for_each(|normal| borne.add(normal));
        for push in [-Vec3::Y, Vec3::X, -Vec3::X, Vec3::Y, Vec3::new(0.1, -3.0, 2.0)] {
            let left = borne.left_of(push);
            assert!(left.dot(a) > -1e-5 && left.dot(b) > -1e-5, "{push}: {left}");
            assert!(left.dot(push) >= 0.0 && left.length() <= push.length() * 1.000_01, "{push}: {left}");
            assert!((left.z - push.z).abs() < 1e-6, "{push}: {left}");
        }
        assert_eq!(Borne::NOT.left_of(-Vec3::Y), -Vec3::Y);
    }
}
