//! How far rows may get in a step, side by side.

use super::TileSweep;
use crate::collide::tile::Tile;
use crate::collide::waiting::Packet;
use crate::lanes::{Eight, Lanes, Vectors, not};
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
/// no farther than they could have got toward it and by twice what their velocities change: where they are braked, these lie between what hits
/// leave and where the air would have them. All that they may lean on is in them as well, half the change of velocity away in that time.
/// Velocities change by no number larger than `change`, by an Euler method.
#[inline(always)]
pub(super) fn straight_ways<F: Lanes>(
    like: F,
    of: &TileSweep<'_, '_>,
    packet: &Packet<'_>,
    face: Option<Face>,
    rounding: f32,
    change: f32,
) -> Ways<F> {
    let (time, all) = (of.tile.dt.seconds(), |x| like.all(x));
    let [[x0, x1], _] = of.ends::<F, false>(like, packet);
    // Of a vector each of whose numbers is below that; an Euler method strays by half of it from the parabola.
    let bend = all(2.0 * change * time);
    let way = x1 - x0;
    let hull = Hull {
        middle: (x0 + x1) * all(0.5),
        half: way * all(0.5),
        room: of.radii(like, packet) + all(rounding + time * (1.0 / 3.0) * change) + all(0.5) * bend,
    };
    let strays = all(5.0) * bend;
    let across = |normal: Vectors<F>| way.dot(normal).abs() + all(2.0) * bend;
    hull.ways(face, strays, across, way.length() + strays)
}

/// The same of any.
#[inline(always)]
pub(super) fn ways<F: Lanes>(
    like: F,
    of: &TileSweep<'_, '_>,
    packet: &Packet<'_>,
    face: Option<Face>,
    room: Room,
) -> Ways<F> {
    let (time, all) = (of.tile.dt.seconds(), |x| like.all(x));
    let [[x0, x1], [v0, v1]] = of.ends::<F, true>(like, packet);
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
        room: of.radii(like, packet) + all(room.rounding) + all(0.5) * bend,
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

impl<F: Lanes> Hull<F> {
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
    /// The places of rows where the step begins and where it ends, and, if they are to be `FAST`, their velocities there.
    #[inline(always)]
    fn ends<F: Lanes, const FAST: bool>(&self, like: F, packet: &Packet<'_>) -> [[Vectors<F>; 2]; 2] {
        let Tile { ref position, ref velocity, .. } = *self.tile;
        let (last, [start_x, start_v]) = (position.len() - 1, self.past.start);
        let read = like.of_parts(
            #[inline(always)]
            |like, nth| {
                let rows = &packet.rows[nth].map(|row| row as usize);
                let column = |column| Vectors::gather(like, column, last, rows);
                let speed = |of| if FAST { column(of) } else { Vectors([like; 3]) };
                let [[a, b, c], [d, e, f]] = [column(start_x).0, column(position).0];
                let [[g, h, i], [j, k, l]] = [speed(start_v).0, speed(velocity).0];
                [a, b, c, d, e, f, g, h, i, j, k, l]
            },
        );
        let [a, b, c, d, e, f, g, h, i, j, k, l] = read;
        [[Vectors([a, b, c]), Vectors([d, e, f])], [Vectors([g, h, i]), Vectors([j, k, l])]]
    }

    /// The radii of rows.
    #[inline(always)]
    fn radii<F: Lanes>(&self, like: F, packet: &Packet<'_>) -> F {
        if self.are_points {
            return like.all(0.0);
        }
        let all = &self.tile.attributes.lives.radius[..self.tile.position.len() - 1];
        let [radii] = like.of_parts(
            #[inline(always)]
            |like, nth| [like.of(packet.rows[nth].map(|row| all[row as usize]))],
        );
        radii
    }
}
