//! How far rows may get in a step, eight at a time.

use super::TileSweep;
use crate::collide::tile::Tile;
use crate::lanes::{Eight, LANES, Vectors, not};
use crate::shape::Face;

/// Bounds on the ways of a block's rows in the step, beyond those that the rows show themselves.
#[derive(Clone, Copy)]
pub(super) struct Room {
    /// How much any number of their velocities changes at the most \[m/s\], if they are all on their ways by an Euler method.
    pub(super) change: Option<f32>,
    /// What rounding may come to anywhere \[m\].
    pub(super) rounding: f32,
    /// True if springs may lead them beyond parabolas.
    pub(super) swing: bool,
}

/// Boxes around ways, by which they are held against things.
pub(super) struct Ways<F> {
    pub(super) middle: Vectors<F>,
    pub(super) half: Vectors<F>,
    /// How far beyond the boxes they may get when they are followed on after hits among things.
    pub(super) beyond: F,
}

/// Boxes that rows do not leave in the step where they meet nothing, nor, if they may touch the face, by lying on it and bouncing off it:
/// along it they get no farther than their paths do and by what their velocities change, but for what friction holds them back; away from it
/// no farther than they could have got toward it. All that they may lean on is in them as well, half the change of velocity away in that time.
/// Velocities change by no number larger than `change`, by an Euler method.
#[inline(always)]
pub(super) fn straight_ways<F: Eight>(
    like: F,
    of: &TileSweep<'_, '_>,
    rows: &[u32; LANES],
    face: Option<Face>,
    rounding: f32,
    change: f32,
) -> Ways<F> {
    let (last, time, all) = (of.tile.position.len() - 1, of.tile.dt.seconds(), |x| like.all(x));
    let rows = &rows.map(|row| row as usize);
    let x0 = Vectors::gather(like, of.past.start[0], last, rows);
    let x1 = Vectors::gather(like, of.tile.position, last, rows);
    // Of a vector each of whose numbers is below that; an Euler method strays by half of it from the parabola.
    let bend = all(2.0 * change * time);
    let way = x1 - x0;
    let hull = Hull {
        middle: (x0 + x1) * all(0.5),
        half: way * all(0.5),
        room: of.radii(like, rows) + all(rounding + time * (1.0 / 3.0) * change) + all(0.5) * bend,
    };
    let strays = all(5.0) * bend;
    let across = |normal: Vectors<F>| way.dot(normal).abs() + bend;
    hull.ways(face, strays, across, way.length() + strays)
}

/// The same of any.
#[inline(always)]
pub(super) fn ways<F: Eight>(
    like: F,
    of: &TileSweep<'_, '_>,
    rows: &[u32; LANES],
    face: Option<Face>,
    room: Room,
) -> Ways<F> {
    let Tile { ref position, ref velocity, dt, .. } = *of.tile;
    let (last, [start_x, start_v], time) = (position.len() - 1, of.past.start, dt.seconds());
    let (all, rows) = (|x| like.all(x), &rows.map(|row| row as usize));
    let (x0, x1) = (Vectors::gather(like, start_x, last, rows), Vectors::gather(like, position, last, rows));
    let (v0, v1) = (Vectors::gather(like, start_v, last, rows), Vectors::gather(like, velocity, last, rows));
    let third = all(time * (1.0 / 3.0));
    let (a, b) = (x0 + v0 * third, x1 - v1 * third);
    let (way, mut low, mut high) = (x1 - x0, x0, x1);
    for axis in 0..3 {
        let [p, q, r, s] = [x0.0[axis], x1.0[axis], a.0[axis], b.0[axis]];
        (low.0[axis], high.0[axis]) = (p.least(q).least(r.least(s)), p.most(q).most(r.most(s)));
    }
    // Squares of what is slower than a few attometres a second may be nothing.
    let bend = ((v1 - v0).length() + all(1e-17)) * all(time);
    let hull = Hull {
        middle: (low + high) * all(0.5),
        half: (high - low) * all(0.5),
        room: of.radii(like, rows) + all(room.rounding) + all(0.5) * bend,
    };
    let excess = (way - (v0 + v1) * all(0.5 * time)).length() + all(1e-17);
    let fast = v0.length().most(v1.length()) * all(1.000_01 * time) + all(1e-17);
    let strays = all(5.0) * bend + excess;
    let strays = if room.swing { strays + fast } else { strays };
    hull.ways(face, strays, |_| fast + bend + excess, fast + strays)
}

/// Boxes around paths: their middles, how far these are from the sides, but for signs, and how much farther on all sides.
struct Hull<F> {
    middle: Vectors<F>,
    half: Vectors<F>,
    room: F,
}

impl<F: Eight> Hull<F> {
    /// The ways along these paths, which by the face stray so far from them, and get so far `away` from a face of this normal.
    #[inline(always)]
    fn ways(self, face: Option<Face>, strays: F, away: impl FnOnce(Vectors<F>) -> F, beyond: F) -> Ways<F> {
        let Self { middle, half, room } = self;
        let sides = |[x, y, z]: [F; 3]| Vectors([x.abs() + room, y.abs() + room, z.abs() + room]);
        let half = sides(half.0);
        let Some(face) = face else { return Ways { middle, half, beyond } };
        let [point, _, unit] = face.vectors();
        let (point, normal, steep) =
            (Vectors::splat(room, point), Vectors::splat(room, unit), Vectors::splat(room, unit.abs()));
        let height = (middle - point).dot(normal).abs();
        let touching = not(height.simd_gt((half + half * room.all(1e-5)).dot(steep) + room));
        let (strays, away) = (strays & touching, away(normal) & touching);
        Ways { middle, half: half + Vectors([strays, strays, strays]) + steep * away, beyond: beyond + strays }
    }
}

impl TileSweep<'_, '_> {
    /// The radii of rows.
    #[inline(always)]
    fn radii<F: Eight>(&self, like: F, rows: &[usize; LANES]) -> F {
        let (all, mut radii) = (&self.tile.attributes.lives.radius, [0.0; LANES]);
        if !self.are_points {
            let all = &all[..self.tile.position.len() - 1];
            radii.iter_mut().zip(rows).for_each(|(radius, &row)| *radius = all[row]);
        }
        like.of(radii)
    }
}
