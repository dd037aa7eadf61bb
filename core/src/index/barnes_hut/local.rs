//! The pull of far nodes on a group, as one polynomial of the place in it.

use crate::index::region::Region;
use crate::lanes::{self, splat};
use crate::math::max;
use glam::Vec3;
use wide::f32x8;

/// Sums of far nodes as a Taylor series about a group's centre, of third order (Greengard and Rokhlin 1987; in Cartesian
/// coordinates Dehnen 2002): A_i + B_ij η_j + C_ijk η_j η_k / 2 + E_ijkl η_j η_k η_l / 6, η being the way from the centre
/// over the group's half side.
pub(super) struct Local {
    center: Vec3,
    half: f32,
    terms: Terms<f32x8>,
}

/// The coefficients of the series, which are symmetric in all axes. With i an axis, j the next and k the one after that:
#[derive(Clone, Copy)]
struct Terms<T> {
    /// A_i.
    first: [T; 3],
    /// B_ii, then B_ij.
    second: [T; 6],
    /// C_iii, C_iij, C_ijj, then C_xyz.
    third: [T; 10],
    /// E_iiii, E_iiij, E_ijjj, E_iijj, then E_iijk.
    fourth: [T; 15],
}

/// The axes i, j and k.
const TURNS: [[usize; 3]; 3] = [[0, 1, 2], [1, 2, 0], [2, 0, 1]];

/// The way to eight nodes, as a unit vector, or less by softening.
#[derive(Clone, Copy)]
struct Way {
    n: [f32x8; 3],
    /// One over the distance u.
    inverse: f32x8,
    /// The group's half side over u.
    q: f32x8,
}

impl Local {
    pub(super) const NONE: Self = Self {
        center: Vec3::ZERO,
        half: 0.0,
        terms: Terms {
            first: [f32x8::ZERO; 3],
            second: [f32x8::ZERO; 6],
            third: [f32x8::ZERO; 10],
            fourth: [f32x8::ZERO; 15],
        },
    };

    /// One for a group in a box, on which nothing acts yet.
    pub(super) fn within(region: &Region) -> Self {
        let sides = region.high - region.low;
        let half = 0.5 * max(sides.x, max(sides.y, sides.z));
        Self { center: region.low + sides * 0.5, half, ..Self::NONE }
    }

    #[inline(always)]
    fn way(&self, at: [f32x8; 3], square: f32x8) -> Way {
        let place = splat(self.center);
        let r = [at[0] - place[0], at[1] - place[1], at[2] - place[2]];
        let u2 = dot(r, r) + square;
        let inverse = (f32x8::ONE / lanes::sqrt(u2)) & u2.simd_gt(f32x8::ZERO);
        Way { n: r.map(|r| r * inverse), inverse, q: f32x8::splat(self.half) * inverse }
    }

    /// Adds what eight nodes do by their weight alone; `square` is s².
    #[inline(always)]
    pub(super) fn add(&mut self, [x, y, z, w]: [f32x8; 4], square: f32x8) {
        let way = self.way([x, y, z], square);
        self.terms.add_weight(&way, w);
    }

    /// Adds what eight nodes do by all their moments, the dipole among them if they have one.
    #[inline(always)]
    pub(super) fn add_all<const DIPOLE: bool>(&mut self, node: [f32x8; 13], square: f32x8) {
        let [x, y, z, w, xx, yy, zz, xy, yz, zx, dx, dy, dz] = node;
        let way = self.way([x, y, z], square);
        self.terms.add_weight(&way, w);
        self.terms.add_second(&way, [xx, yy, zz, xy, yz, zx]);
        if DIPOLE {
            self.terms.add_dipole(&way, [dx, dy, dz]);
        }
    }

    /// The series.
    pub(super) fn series(&self) -> Series {
        let Terms { first, second, third, fourth } = &self.terms;
        let terms =
            Terms { first: totals(first), second: totals(second), third: totals(third), fourth: totals(fourth) };
        Series { center: self.center, half: self.half, terms }
    }
}

impl Terms<f32x8> {
    /// Adds those of weights: W n, W q (3 n n − δ), W q² (15 n n n − 3 δ n), W q³ (105 n n n n − 15 δ n n + 3 δ δ), W being
    /// w/u², and products with δ standing for their sum over all ways to choose the axes.
    #[inline(always)]
    fn add_weight(&mut self, &Way { n, inverse, q }: &Way, w: f32x8) {
        let number = f32x8::splat;
        let squares = n.map(|n| n * n);
        let w = w * inverse * inverse;
        let (w1, w2) = (w * q, w * q * q);
        let w3 = w2 * q;
        self.third[9] += w2 * (number(15.0) * n[0] * n[1] * n[2]);
        for [i, j, k] in TURNS {
            let (both, fifteen) = (n[i] * n[j], number(15.0) * squares[i]);
            let more = number(7.0) * fifteen;
            self.first[i] += w * n[i];
            self.second[i] += w1 * (number(3.0) * squares[i] - f32x8::ONE);
            self.second[3 + i] += w1 * (number(3.0) * both);
            self.third[i] += w2 * (n[i] * (fifteen - number(9.0)));
            self.third[3 + i] += w2 * (n[j] * (fifteen - number(3.0)));
            self.third[6 + k] += w2 * (n[k] * (fifteen - number(3.0)));
            self.fourth[i] += w3 * (squares[i] * (more - number(90.0)) + number(9.0));
            self.fourth[3 + i] += w3 * (both * (more - number(45.0)));
            self.fourth[6 + k] += w3 * (n[k] * n[i] * (more - number(45.0)));
            self.fourth[9 + i] += w3 * (squares[j] * (more - number(15.0)) - (fifteen - number(3.0)));
            self.fourth[12 + i] += w3 * (n[j] * n[k] * (more - number(15.0)));
        }
    }

    /// Adds those of second moments S up to the second: with s⃗ = S n, p = n·S n and t = tr S, all over u²,
    /// (n (15/2 p − 3/2 t) − 3 s) / u² and q (n n (105/2 p − 15/2 t) − δ (15/2 p − 3/2 t) − 15 n s + 3 S) / u².
    #[inline(always)]
    fn add_second(&mut self, &Way { n, inverse, q }: &Way, second: [f32x8; 6]) {
        let (number, square) = (f32x8::splat, inverse * inverse);
        let [xx, yy, zz, xy, yz, zx] = second;
        let second @ [xx, yy, zz, xy, yz, zx] =
            [xx * square, yy * square, zz * square, xy * square, yz * square, zx * square];
        let s =
            [xx * n[0] + xy * n[1] + zx * n[2], xy * n[0] + yy * n[1] + yz * n[2], zx * n[0] + yz * n[1] + zz * n[2]];
        let (p, t) = (number(7.5) * dot(n, s), xx + yy + zz);
        let along = p - number(1.5) * t;
        let half = number(3.5) * p - number(3.75) * t;
        let q = square * q;
        let m: [f32x8; 3] = core::array::from_fn(|i| half * n[i] - number(15.0) * s[i]);
        for [i, j, _] in TURNS {
            self.first[i] += square * (n[i] * along - number(3.0) * s[i]);
            self.second[i] += q * ((number(2.0) * n[i] * m[i] - along) + number(3.0) * second[i]);
            self.second[3 + i] += q * ((n[i] * m[j] + n[j] * m[i]) + number(3.0) * second[3 + i]);
        }
    }

    /// Adds those of dipoles up to the third: with D over u and p = n·D, (D − 3 n p) / u², q (3 (δ p + n D) − 15 n n p) / u²
    /// and q² (15 (δ n p + n n D) − 3 δ D − 105 n n n p) / u².
    #[inline(always)]
    fn add_dipole(&mut self, &Way { n, inverse, q }: &Way, dipole: [f32x8; 3]) {
        let number = f32x8::splat;
        let d = dipole.map(|moment| moment * inverse);
        let (p, w) = (dot(n, d), inverse * inverse);
        let (w1, w2) = (w * q, w * q * q);
        let three = number(3.0);
        let m: [f32x8; 3] = core::array::from_fn(|i| three * d[i] - number(7.5) * p * n[i]);
        let v: [f32x8; 3] = core::array::from_fn(|i| number(15.0) * p * n[i] - three * d[i]);
        let h: [f32x8; 3] = core::array::from_fn(|i| number(15.0) * d[i] - number(35.0) * p * n[i]);
        let of_three = |i: usize, j: usize, k: usize| n[i] * n[j] * h[k] + n[i] * n[k] * h[j] + n[j] * n[k] * h[i];
        self.third[9] += w2 * of_three(0, 1, 2);
        for [i, j, _] in TURNS {
            self.first[i] += w * (d[i] - three * p * n[i]);
            self.second[i] += w1 * (number(2.0) * n[i] * m[i] + three * p);
            self.second[3 + i] += w1 * (n[i] * m[j] + n[j] * m[i]);
            self.third[i] += w2 * (of_three(i, i, i) + three * v[i]);
            self.third[3 + i] += w2 * (of_three(i, i, j) + v[j]);
            self.third[6 + i] += w2 * (of_three(i, j, j) + v[i]);
        }
    }
}

/// A series whose coefficients are known.
#[derive(Clone, Copy)]
pub(super) struct Series {
    center: Vec3,
    half: f32,
    terms: Terms<f32>,
}

impl Series {
    pub(super) const NONE: Self = Self {
        center: Vec3::ZERO,
        half: 0.0,
        terms: Terms { first: [0.0; 3], second: [0.0; 6], third: [0.0; 10], fourth: [0.0; 15] },
    };

    /// The same, to be evaluated.
    pub(super) fn prepared(&self) -> Prepared {
        let Terms { third, fourth, .. } = self.terms;
        let (third, fourth) = (times(third, 0.5), times(fourth, 1.0 / 6.0));
        Prepared(Self { terms: Terms { third, fourth, ..self.terms }, ..*self })
    }

    /// With another one, of a box that has this one's in it.
    pub(super) fn and(mut self, wider: &Self) -> Self {
        let (way, ratio) = (wider.way(self.center), if wider.half > 0.0 { self.half / wider.half } else { 0.0 });
        let Terms { second, third, fourth, .. } = &wider.terms;
        let along = fourth_along(fourth, way);
        let more = third_along(&plus(*third, times(along, 0.5)), way);
        let (square, cube) = (ratio * ratio, ratio * ratio * ratio);
        let terms = &mut self.terms;
        terms.first = plus(terms.first, wider.prepared().at(self.center).to_array());
        terms.second = plus(terms.second, times(plus(*second, more), ratio));
        terms.third = plus(terms.third, times(plus(*third, along), square));
        terms.fourth = plus(terms.fourth, times(*fourth, cube));
        self
    }

    /// The way from the centre to a place, over the half side.
    fn way(&self, place: Vec3) -> Vec3 {
        if self.half > 0.0 { (place - self.center) / self.half } else { Vec3::ZERO }
    }
}

/// A series, its coefficients over the factorials of their order.
pub(super) struct Prepared(Series);

impl Prepared {
    /// The sum at a place.
    pub(super) fn at(&self, place: Vec3) -> Vec3 {
        let Terms { first, second, third, fourth } = &self.0.terms;
        let way = self.0.way(place);
        let second = plus(*second, third_along(&plus(*third, fourth_along(fourth, way)), way));
        Vec3::from_array(plus(*first, second_along(&second, way)))
    }
}

#[inline(always)]
fn totals<const N: usize>(of: &[f32x8; N]) -> [f32; N] {
    core::array::from_fn(|i| lanes::total(of[i]))
}

#[inline(always)]
fn times<const N: usize>(a: [f32; N], by: f32) -> [f32; N] {
    core::array::from_fn(|i| a[i] * by)
}

#[inline(always)]
fn plus<const N: usize>(a: [f32; N], b: [f32; N]) -> [f32; N] {
    core::array::from_fn(|i| a[i] + b[i])
}

/// B_ij η_j.
#[inline(always)]
fn second_along(b: &[f32; 6], way: Vec3) -> [f32; 3] {
    core::array::from_fn(|i| {
        let [_, j, k] = TURNS[i];
        b[i] * way[i] + b[3 + i] * way[j] + b[3 + k] * way[k]
    })
}

/// C_ijk η_k.
#[inline(always)]
fn third_along(c: &[f32; 10], way: Vec3) -> [f32; 6] {
    let mut b = [0.0; 6];
    for [i, j, k] in TURNS {
        b[i] = c[i] * way[i] + c[3 + i] * way[j] + c[6 + k] * way[k];
        b[3 + i] = c[3 + i] * way[i] + c[6 + i] * way[j] + c[9] * way[k];
    }
    b
}

/// E_ijkl η_l.
#[inline(always)]
fn fourth_along(e: &[f32; 15], way: Vec3) -> [f32; 10] {
    let mut c = [0.0; 10];
    for [i, j, k] in TURNS {
        c[i] = e[i] * way[i] + e[3 + i] * way[j] + e[6 + k] * way[k];
        c[3 + i] = e[3 + i] * way[i] + e[9 + i] * way[j] + e[12 + i] * way[k];
        c[6 + i] = e[9 + i] * way[i] + e[6 + i] * way[j] + e[12 + j] * way[k];
    }
    c[9] = e[12] * way.x + e[13] * way.y + e[14] * way.z;
    c
}

#[inline(always)]
fn dot(a: [f32x8; 3], b: [f32x8; 3]) -> f32x8 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}
