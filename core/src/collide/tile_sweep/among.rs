//! Rows among many things: who may be near any of them is told eight at a time, and only those look for what they are near.

use super::{EVERYWHERE, TileSweep, Waiting, words};
use crate::collide::near::BLOCK;
use crate::collide::sweep::surroundings;
use crate::collide::tile::Tile;
use crate::collide::waiting::ones;
use crate::lanes::{Eight, Kernel, LANES, Vectors, max as larger, run, widest};
use crate::math::{largest, max};
use crate::shape::{Aabb, Face, Facing, Many};
use glam::Vec3;

/// Boxes around rows wherever they may get in the step, none of which is the tile's last.
struct Surround<'t, 's, 'a> {
    of: &'t TileSweep<'s, 'a>,
    rows: [usize; LANES],
    size: f32,
}

impl Kernel for Surround<'_, '_, '_> {
    type Output = [Aabb; LANES];

    /// As [`surroundings`] has it, and with more room.
    #[inline(always)]
    fn run<F: Eight>(self, like: F) -> Self::Output {
        let Self { of, rows, size } = self;
        let Tile { ref attributes, ref position, ref velocity, dt, .. } = *of.tile;
        let (last, [start_x, start_v], time) = (position.len() - 1, of.past.start, dt.seconds());
        let all = |x| like.all(x);
        let gathered = |column: &[Vec3]| Vectors::gather(like, column, last, &rows);
        let (x0, v0, x1, v1) = (gathered(start_x), gathered(start_v), gathered(position), gathered(velocity));
        let third = all(time * (1.0 / 3.0));
        let (a, b) = (x0 + v0 * third, x1 - v1 * third);
        let mut radius = [0.0; LANES];
        if !of.are_points {
            let radii = &attributes.lives.radius[..last];
            radius.iter_mut().zip(&rows).for_each(|(radius, &row)| *radius = radii[row]);
        }
        let largest = larger(larger(x0.largest(), x1.largest()), larger(a.largest(), b.largest()));
        let speed = larger(v0.length(), v1.length());
        let radius = like.of(radius);
        // Squares of what is slower than a few attometres a second may be nothing.
        let fast = speed + all(4.0) * (v1 - v0).length() + all(1e-17);
        let way = all(1.000_01 * time) * fast;
        let room = radius + way + all(256.0 * f32::EPSILON) * (largest + radius + all(size));
        let (mut min, mut max) = (x0, x0);
        for axis in 0..3 {
            let [p, q, r, s] = [x0.0[axis], x1.0[axis], a.0[axis], b.0[axis]];
            min.0[axis] = p.least(q).least(r.least(s)) - room;
            max.0[axis] = p.most(q).most(r.most(s)) + room;
        }
        let (min, max, mut boxes) = (min.rows(), max.rows(), [Aabb::EMPTY; LANES]);
        for i in 0..LANES {
            let ([x, y, z, _], [u, v, w, _]) = (min[i], max[i]);
            boxes[i] = Aabb { min: Vec3::new(x, y, z), max: Vec3::new(u, v, w) };
        }
        boxes
    }
}

impl TileSweep<'_, '_> {
    /// Follows all past many things, those in packets that meet nothing but a flat face: `face`, outside a box around all others.
    #[inline(never)]
    pub(super) fn go_among(&mut self, many: &dyn Many, face: Option<Face>, things: &Aabb) {
        let (len, old) = (self.tile.position.len(), self.tile.old);
        self.are_points = true;
        let mut waiting = face.map(Waiting::before);
        let size = max(max(largest(things.min), largest(things.max)), face.map_or(0.0, |face| face.size()));
        for first in (0..old).step_by(BLOCK) {
            let rows = first..old.min(first + BLOCK);
            let block = self.balls().block(rows.clone(), self.tile.reached);
            let are_points = block.are_points();
            let by_face = face.map_or([0; BLOCK / LANES], |face| block.near(&face).touching);
            let by_things = block.near_box(things);
            // Who gains speed by hits may get anywhere.
            let gains = !never_gain(&self.tile.attributes.elasticity[rows.clone()]);
            let reach = if gains { f32::INFINITY } else { block.reach(size) };
            let room = Aabb { min: things.min - reach, max: things.max + reach };
            self.are_points &= are_points;
            let marks = words(&by_face).zip(words(&by_things));
            for (row, (mut past_face, by_things)) in rows.step_by(u64::BITS as usize).zip(marks) {
                let asked = past_face | by_things;
                let near = if gains { asked } else { self.are_near(row, asked, &room, many, size) };
                for k in ones(near) {
                    if self.go_between(row + k, many, size) {
                        past_face &= !(1 << k);
                    }
                }
                if let Some(waiting) = &mut waiting {
                    self.queue(row, [past_face; 2], waiting);
                }
            }
        }
        if let Some(waiting) = &mut waiting {
            self.go_on(waiting);
        }
        let known = face.map_or(Facing::Nothing, Facing::Face);
        self.are_points &= self.tile.attributes.lives.radius[old..len].iter().all(|&radius| radius == 0.0);
        let gains = !never_gain(&self.tile.attributes.elasticity[old..len]);
        for first in (old..len).step_by(u64::BITS as usize) {
            let rows = first..len.min(first + u64::BITS as usize);
            let all = u64::MAX >> (u64::BITS as usize - rows.len());
            // Those who are born in the step get no farther than in a whole one.
            let near = if gains { all } else { self.are_near(first, all, &EVERYWHERE, many, size) };
            for row in rows {
                if near >> (row - first) & 1 == 0 || !self.go_between(row, many, size) {
                    self.follow_past(row, self.tile.obstacles.colliders, Some(known));
                }
            }
        }
    }

    /// Tells whether a box may be in between where a row's path begins and where it ends. Of what is no number it may.
    #[inline(always)]
    fn is_between(&self, row: usize, room: &Aabb) -> bool {
        let (a, b) = (self.past.start[0][row], self.tile.position[row]);
        let is_beside = |axis: usize| {
            (a[axis] < room.min[axis]) & (b[axis] < room.min[axis])
                | (a[axis] > room.max[axis]) & (b[axis] > room.max[axis])
        };
        !(is_beside(0) | is_beside(1) | is_beside(2))
    }

    /// Those of some rows from the first on that are asked about, may come between, and may be near things no farther from the origin than
    /// `size` \[m\].
    fn are_near(&self, first: usize, mut asked: u64, room: &Aabb, many: &dyn Many, size: f32) -> u64 {
        let last = self.tile.position.len() - 1;
        let (mut places, mut len, mut near) = ([0_u8; u64::BITS as usize + LANES], 0, 0);
        while asked != 0 {
            let place = asked.trailing_zeros() as usize;
            if first + place == last {
                // A tile's last row has none behind it to be read with it.
                near = 1 << place;
            } else if self.is_between(first + place, room) {
                places[len] = place as u8;
                len += 1;
            }
            asked &= asked - 1;
        }
        let (eights, _) = places.as_chunks_mut::<LANES>();
        for (eight, i) in eights.iter_mut().zip((0..len).step_by(LANES)) {
            // Those who are missing are the first over again.
            let (one, count) = (eight[0], LANES.min(len - i));
            eight[count..].fill(one);
            let rows = eight.map(|place| first + usize::from(place));
            let are = many.are_near(&run(Surround { of: self, rows, size })[..count]);
            for (i, place) in eight.iter().enumerate() {
                near |= u64::from(are >> i & 1) << (place % u64::BITS as u8);
            }
        }
        near
    }

    /// Follows the particle in a row past the things that it is near, among such as are no farther from the origin than `size` \[m\];
    /// false, if there is nothing near but the face outside their box.
    fn go_between(&mut self, row: usize, many: &dyn Many, size: f32) -> bool {
        let Tile { dt, attributes: ref m, .. } = *self.tile;
        let own = [m.lives.radius[row], m.elasticity[row]];
        let Some(bounds) = surroundings(&self.path(row), own, dt.seconds(), size) else {
            self.follow(row);
            return true;
        };
        many.near(&bounds, &mut |walls| self.follow_past(row, walls, Some(Facing::Several)))
    }
}

/// Tells whether all elasticities are between zero and one: the bits of such numbers are in the same order, and below those of all others.
fn never_gain(elasticities: &[f32]) -> bool {
    let most = widest(
        #[inline(always)]
        || elasticities.iter().fold(0, |most: u32, elasticity| most.max(elasticity.to_bits())),
    );
    most <= 1.0_f32.to_bits()
}
