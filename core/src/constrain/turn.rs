//! Rotations, and the equations of what turns as a whole.

use crate::math::{dot, sqrt};
use glam::{Mat3, Vec3};

/// Rounds of Newton's method, and of the search for the nearest rotation, at the most.
pub(super) const ROUNDS: [u32; 2] = [8, 40];
/// An angle \[rad\] that is rounding.
pub(super) const ROUNDING: f32 = 5e-7;

/// The square of an angle \[rad\] below which Newton's method has got there, though it gets no nearer.
pub(super) const EVEN: f32 = 1e-8;

/// A rotation: a unit quaternion x, y, z, w.
#[derive(Clone, Copy)]
pub(super) struct Turn(pub(super) [f32; 4]);

impl Turn {
    pub(super) const NONE: Self = Self([0.0, 0.0, 0.0, 1.0]);

    /// The one that is kept.
    pub(super) fn kept(kept: &[u32]) -> Self {
        Self([1, 2, 3, 4].map(|word| f32::from_bits(kept[word])))
    }

    /// Turned on the shortest way so that a place in the shape gets into a direction.
    pub(super) fn bring(self, place: Vec3, to: Vec3) -> Self {
        let from = self.matrix() * place;
        let lengths = sqrt(dot(from, from)) * sqrt(dot(to, to));
        // The tangent of half the angle, along the axis.
        let half = from.cross(to) / (lengths + dot(from, to));
        if half.is_finite() { self.on(half * 2.0) } else { self }
    }

    /// Turned on by about an angle \[rad\] about a direction: by 2 atan(|angle| / 2), for which no sine is needed (Cayley).
    pub(super) fn on(self, angle: Vec3) -> Self {
        let ([x, y, z, w], half) = (self.0, angle * 0.5);
        let v = Vec3::new(x, y, z);
        let turned = half * w + v + half.cross(v);
        let real = w - dot(half, v);
        let norm = 1.0 / sqrt(dot(turned, turned) + real * real);
        if norm > 0.0 && norm < f32::INFINITY {
            Self([turned.x * norm, turned.y * norm, turned.z * norm, real * norm])
        } else {
            self
        }
    }

    /// This rotation after another.
    pub(super) fn after(self, Self([a, b, c, d]): Self) -> Self {
        let [x, y, z, w] = self.0;
        Self([
            w * a + x * d + (y * c - z * b),
            w * b + y * d + (z * a - x * c),
            w * c + z * d + (x * b - y * a),
            w * d - (x * a + y * b + z * c),
        ])
    }

    pub(super) fn matrix(self) -> Mat3 {
        let [x, y, z, w] = self.0;
        Mat3::from_cols(
            Vec3::new(1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y + w * z), 2.0 * (x * z - w * y)),
            Vec3::new(2.0 * (x * y - w * z), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z + w * x)),
            Vec3::new(2.0 * (x * z + w * y), 2.0 * (y * z - w * x), 1.0 - 2.0 * (x * x + y * y)),
        )
    }
}

/// The small rotation whose moment is the given one: x of (tr(B) − B) x = moment, by Cramer's rule; none if there is none.
pub(super) fn turn_of(spread: Mat3, moment: Vec3) -> Vec3 {
    let trace = spread.x_axis.x + spread.y_axis.y + spread.z_axis.z;
    let column = |axis: Vec3, b: Vec3| axis - b / trace;
    let [x, y, z] = [column(Vec3::X, spread.x_axis), column(Vec3::Y, spread.y_axis), column(Vec3::Z, spread.z_axis)];
    let (change, determinant) = (moment / trace, dot(x, y.cross(z)));
    let turn = Vec3::new(dot(change, y.cross(z)), dot(change, z.cross(x)), dot(change, x.cross(y))) / determinant;
    // All on one line: it does not turn about that.
    if determinant > 1e-6 && turn.is_finite() { turn } else { Vec3::ZERO }
}

/// The rotation R near the last one for which Σ m y × R q is the torque; none where Newton's method does not get there.
pub(super) fn keeping(last: Turn, from: Mat3, torque: Vec3, axis: Option<Vec3>) -> Option<Turn> {
    // Newton's rounds themselves give back what the rule loses.
    keeping_by(solve_roughly, last, (from, torque), axis)
}

/// The same where the system of each round is solved so.
pub(super) fn keeping_by(
    solve: fn(Mat3, Vec3) -> Vec3,
    last: Turn,
    (from, torque): (Mat3, Vec3),
    axis: Option<Vec3>,
) -> Option<Turn> {
    let (mut turn, mut before) = (last, f32::INFINITY);
    for _ in 0..ROUNDS[0] {
        // Σ m y (R q)ᵀ, and of it what is antisymmetric: Σ m y × R q.
        let sum = from * turn.matrix().transpose();
        let [x, y, z] = [sum.x_axis, sum.y_axis, sum.z_axis];
        if !(x.x + y.y + z.z >= 0.0) {
            return None;
        }
        let has = Vec3::new(z.y - y.z, x.z - z.x, y.x - x.y);
        let (sum, lack) = (sum.transpose(), torque - has);
        let angle = axis.map_or_else(|| solve(sum, lack), |axis| axis * about(axis, sum, lack));
        let size = dot(angle, angle);
        if !(size < before && size < 4.0) {
            // Rounding goes to and fro.
            return (before < EVEN).then_some(turn);
        }
        (turn, before) = (turn.on(angle), size);
        if size < ROUNDING * ROUNDING {
            return Some(turn);
        }
    }
    (before < EVEN).then_some(turn)
}

/// The rotation nearest to Σ m x qᵀ, found from the last one on: one column pulls another round by r × a / |Σ r · a|.
pub(super) fn nearest(last: Turn, to: Mat3, axis: Option<Vec3>) -> Turn {
    let mut turn = last;
    for _ in 0..ROUNDS[1] {
        let rotation = turn.matrix();
        let (mut pull, mut along) = (Vec3::ZERO, 0.0);
        for (r, a) in [(rotation.x_axis, to.x_axis), (rotation.y_axis, to.y_axis), (rotation.z_axis, to.z_axis)] {
            pull += r.cross(a);
            along += dot(r, a);
        }
        let pull = axis.map_or(pull, |axis| axis * dot(axis, pull));
        let angle = pull / along.abs();
        let size = dot(angle, angle);
        if !(size < f32::INFINITY) {
            break;
        }
        turn = turn.on(angle);
        if size < ROUNDING * ROUNDING {
            break;
        }
    }
    turn
}

/// a bᵀ.
pub(super) fn outer(a: Vec3, b: Vec3) -> Mat3 {
    Mat3::from_cols(a * b.x, a * b.y, a * b.z)
}

/// (tr(B) − B) x: the moment that turning by x, or so fast, is.
pub(super) fn moment(b: Mat3, x: Vec3) -> Vec3 {
    system(b) * x
}

/// tr(B) − B, without what would cancel.
fn system(b: Mat3) -> Mat3 {
    let [x, y, z] = [b.x_axis, b.y_axis, b.z_axis];
    Mat3::from_cols(
        Vec3::new(y.y + z.z, -x.y, -x.z),
        Vec3::new(-y.x, x.x + z.z, -y.z),
        Vec3::new(-z.x, -z.y, x.x + y.y),
    )
}

/// How far to turn, or how fast, about an axis for a change of the moment.
pub(super) fn about(axis: Vec3, b: Mat3, change: Vec3) -> f32 {
    let by = dot(axis, change) / dot(axis, moment(b, axis));
    if by.is_finite() { by } else { 0.0 }
}

/// How far to turn, or how fast, for a change of the moment: x of (tr(B) − B) x = the change. About an axis on which all lies there is no
/// moment, and it does not turn.
pub(super) fn solve(b: Mat3, change: Vec3) -> Vec3 {
    let Some(columns) = ridged(b) else { return Vec3::ZERO };
    let (change, [x, y, z]) = (change / trace(b), columns);
    let answer = by_cramer(columns, change);
    // Of what is thin the rule loses figures, which its own remainder gives back.
    let has = x * answer.x + y * answer.y + z * answer.z;
    let answer = answer + by_cramer(columns, change - has);
    if answer.is_finite() { answer } else { Vec3::ZERO }
}

/// The same without giving back what rounding takes, as eight at once do.
fn solve_roughly(b: Mat3, change: Vec3) -> Vec3 {
    let Some(columns) = ridged(b) else { return Vec3::ZERO };
    let answer = by_cramer(columns, change / trace(b));
    if answer.is_finite() { answer } else { Vec3::ZERO }
}

fn trace(b: Mat3) -> f32 {
    b.x_axis.x + b.y_axis.y + b.z_axis.z
}

/// The columns of tr(B) − B in units of the trace, in which nothing underflows however small the cluster, and with a little moment about an
/// axis on which all lies; none if there is nothing.
fn ridged(b: Mat3) -> Option<[Vec3; 3]> {
    let trace = trace(b);
    if !(trace > 0.0 && trace < f32::INFINITY) {
        return None;
    }
    let Mat3 { x_axis: x, y_axis: y, z_axis: z } = system(b);
    let [x, y, z] = [x / trace, y / trace, z / trace];
    let is_plain = dot(x, y.cross(z)) > THIN;
    Some(if is_plain { [x, y, z] } else { [x + Vec3::X * THIN, y + Vec3::Y * THIN, z + Vec3::Z * THIN] })
}

/// x of A x = b, A by its columns and about as large as one; none if A is singular to rounding.
pub(super) fn across([x, y, z]: [Vec3; 3], b: Vec3) -> Option<Vec3> {
    let answer = by_cramer([x, y, z], b);
    (dot(x, y.cross(z)) > THIN * THIN && answer.is_finite()).then_some(answer)
}

/// The inverse of a symmetric matrix without a way in which it is less than nothing; none if it is singular to rounding.
pub(super) fn inverse(of: Mat3) -> Option<Mat3> {
    // In units of the trace nothing underflows.
    let trace = trace(of);
    let columns = [of.x_axis, of.y_axis, of.z_axis].map(|column| column / trace);
    let [x, y, z] = [Vec3::X, Vec3::Y, Vec3::Z].map(|axis| across(columns, axis / trace));
    Some(Mat3::from_cols(x?, y?, z?))
}

/// x of A x = b by Cramer's rule, by the columns of A.
fn by_cramer([x, y, z]: [Vec3; 3], b: Vec3) -> Vec3 {
    let determinant = dot(x, y.cross(z));
    Vec3::new(dot(b, y.cross(z)), dot(b, z.cross(x)), dot(b, x.cross(y))) / determinant
}

/// The same by elimination, the largest pivot first, which leaves no more of the change than rounding however thin what turns is.
pub(super) fn solve_thin(b: Mat3, change: Vec3) -> Vec3 {
    let trace = trace(b);
    if !(trace > 0.0 && trace < f32::INFINITY) {
        return Vec3::ZERO;
    }
    // In units of the trace nothing underflows, however small the cluster.
    let rows = (system(b).transpose() * (1.0 / trace)).to_cols_array_2d();
    let change = (change / trace).to_array();
    let [own, beside, across] = [rows[0][0], rows[1][1], rows[2][2]];
    let answer = if own >= beside && own >= across {
        from_the_first(rows, change)
    } else if beside >= across {
        last_first(from_the_first(first_last(rows.map(first_last)), first_last(change)))
    } else {
        first_last(from_the_first(last_first(rows.map(last_first)), last_first(change)))
    };
    let answer = Vec3::from_array(answer);
    if answer.is_finite() { answer } else { Vec3::ZERO }
}

fn first_last<T>([x, y, z]: [T; 3]) -> [T; 3] {
    [y, z, x]
}

fn last_first<T>([x, y, z]: [T; 3]) -> [T; 3] {
    [z, x, y]
}

/// x of A x = b by the rows of A, whose first number on the diagonal is its largest. Along a direction of which it makes nothing x is nothing.
fn from_the_first(rows: [[f32; 3]; 3], [a, b, c]: [f32; 3]) -> [f32; 3] {
    let [[xx, xy, xz], [yx, yy, yz], [zx, zy, zz]] = rows;
    let first = 1.0 / xx;
    let [p, q] = [yx * first, zx * first];
    let ([yy, yz], [zy, zz]) = ([yy - p * xy, yz - p * xz], [zy - q * xy, zz - q * xz]);
    let over = |pivot: f32| if pivot > THIN { 1.0 / pivot } else { 0.0 };
    // Of both the larger is next; of the last there is nothing left where all lies on a line.
    let largest_first = |[y, z]: [f32; 2]| if zz > yy { [z, y] } else { [y, z] };
    let ([b, c], [own, other]) = (largest_first([b - p * a, c - q * a]), largest_first([yy, zz]));
    let [yz, zy] = largest_first([yz, zy]);
    let second = over(own);
    let third = over(other - zy * second * yz);
    let z = (c - zy * second * b) * third;
    let with = |alone: f32, pair| {
        let [y, z] = largest_first(pair);
        Vec3::new((alone - xy * y - xz * z) * first, y, z)
    };
    let mut answer = with(a, [(b - yz * z) * second, z]);
    if third == 0.0 {
        let axis = with(0.0, [-yz * second, 1.0]);
        answer -= axis * (dot(axis, answer) / dot(axis, axis));
    }
    answer.to_array()
}

/// The share of a cluster's largest moment of inertia below which the least is rounding.
pub(super) const THIN: f32 = 1e-6;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::length;
    use crate::rng::Stream;

    /// However thin what turns is, and wherever it points: turning so has the moment that was asked for, and about the axis of what lies on a line
    /// there is none.
    #[test]
    fn what_is_thin_turns_as_it_is_asked_to() {
        for serial in 0..2000 {
            let stream = Stream::new(3, 1, serial);
            let vector = |place| {
                let ([x, y], [z, _]) = (stream.units(place), stream.units(place + 1));
                Vec3::new(x, y, z) - 0.5
            };
            let tilt = [1.0, 1e-1, 1e-2, 1e-3, 1e-4, 0.0][serial as usize % 6];
            let along = [Vec3::X, Vec3::Y, Vec3::Z][serial as usize % 3] + vector(0) * tilt;
            let along = along / sqrt(dot(along, along));
            let thick = [0.0, 0.0, 1e-2, 1.0][serial as usize % 4];
            let size = [1e-6, 1.0, 1e4][serial as usize / 4 % 3];
            let spread = (outer(along, along) + outer(vector(2), vector(2)) * (thick * thick)) * size;
            let omega = vector(4);
            let found = solve_thin(spread, moment(spread, omega));
            let left = moment(spread, omega) - moment(spread, found);
            assert!(dot(left, left) < (3e-6 * size) * (3e-6 * size), "{serial}: {left} of {spread}");
            assert!(dot(found, found) < 1.1 * dot(omega, omega) + 1e-6, "{serial}: {found} for {omega}");
            if thick == 0.0 {
                assert!(dot(found, along).abs() < 1e-3, "{serial}: {found} about {along}");
            }
        }
    }

    /// What turns in a sub-step is found by its angular momentum, thin or not: the system of a round is not symmetric.
    #[test]
    fn what_keeps_its_angular_momentum_is_found() {
        let mut lost = 0;
        for serial in 0..1000 {
            let stream = Stream::new(5, 1, serial);
            let vector = |place| {
                let ([x, y], [z, _]) = (stream.units(place), stream.units(place + 1));
                Vec3::new(x, y, z) - 0.5
            };
            let thick = [0.1, 0.3, 1.0][serial as usize % 3];
            let far = [0.03, 0.1, 0.3][serial as usize / 3 % 3];
            let (along, about) = (vector(0), vector(2));
            let true_turn = Turn::NONE.on(about * (far / sqrt(dot(about, about))));
            let (mut from, mut torque) = (Mat3::ZERO, Vec3::ZERO);
            for number in 0..10 {
                let place = along * (number as f32 - 4.5) + vector(4 + 2 * number) * thick;
                from += outer(place, place);
                torque += place.cross(true_turn.matrix() * place);
            }
            let found = keeping_by(solve_thin, Turn::NONE, (from, torque), None);
            let has = found.map(|turn| {
                let Mat3 { x_axis: x, y_axis: y, z_axis: z } = from * turn.matrix().transpose();
                Vec3::new(z.y - y.z, x.z - z.x, y.x - x.y)
            });
            let left = has.map(|has| length(has - torque) / trace(from));
            assert!(left.is_none_or(|left| left < 1e-5), "{serial}: {left:?}");
            lost += u32::from(left.is_none());
        }
        // Rounding keeps few of the thin ones from an answer.
        assert!(lost < 10, "{lost} of 1000");
    }
}
