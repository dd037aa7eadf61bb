//! Eight times two that touch, side by side in memory through a sub-step: what passes go over again and again.

use super::body::Body;
use super::fours::{fours, put};
use super::manifold::{Manifold, Manifolds, POINTS, Point};
use super::pose::Inverse;
use crate::lanes::{ABREAST, Eight, LANES, Row, Vectors, load, saved};
use core::mem::offset_of;
use glam::Vec3;

/// A point of each two, as passes want it.
#[derive(Clone, Copy, Debug, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
pub(super) struct Spots {
    /// From the centre of each to where they press on each other \[m\].
    pub(super) arms: [[Row; 3]; 2],
    /// How fast they shall part \[m/s\], the scenery's own speed included.
    pub(super) wanted: Row,
    /// The impulse that makes them part by 1 m/s \[kg\], and how the slip along the surface changes by one along the normal \[1/kg\].
    pub(super) mass: Row,
    pub(super) answer: [Row; 2],
    /// How fast what has crept shall be taken back, less how fast the scenery moves, along the two directions across the normal \[m/s\].
    pub(super) lag: [Row; 2],
    /// How much the slip (u, v) along the surface changes by an impulse along itself \[1/kg\]: the factors of u², uv and v².
    pub(super) rub: [Row; 3],
    /// The change of speed that is too small to go over their neighbours for \[m/s\].
    pub(super) little: Row,
    /// The impulse that keeps them apart, and that of friction on the second along these directions \[N s\].
    pub(super) pressed: Row,
    pub(super) held: [Row; 2],
}

impl Spots {
    /// Takes what impulses do at its point: uu, vv, nn, uv, un and vn along two directions across the normal, and that \[1/kg\].
    #[inline(always)]
    pub(super) fn weigh<F: Eight>(&mut self, [uu, vv, nn, uv, un, vn]: [F; 6]) {
        self.rub = [saved(uu), saved(nn.all(2.0) * uv), saved(vv)];
        self.answer = [saved(un), saved(vn)];
        self.mass = saved(nn.all(1.0) / nn);
    }

    /// The same where a mask holds.
    #[inline(always)]
    pub(super) fn weigh_where<F: Eight>(&mut self, mask: F, yields: [F; 6]) {
        let before = *self;
        self.weigh(yields);
        let rows = self.rub.iter_mut().chain(&mut self.answer).chain([&mut self.mass]);
        for (row, old) in rows.zip(before.rub.iter().chain(&before.answer).chain([&before.mass])) {
            *row = saved(mask.select(load(mask, row), load(mask, old)));
        }
    }
}

/// The same before passes and between them.
#[derive(Clone, Copy, Debug, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
pub(super) struct Places {
    /// The place on each, in its box's frame \[m\].
    pub(super) places: [[Row; 3]; 2],
    /// How the scenery moves there, and how fast along the normal \[m/s\].
    pub(super) surface: [Row; 3],
    pub(super) lift: Row,
    /// The change that forces make to the speed of either in a sub-step, and how fast they shall part in the end \[m/s\].
    pub(super) driven: Row,
    pub(super) bounce: Row,
    /// The impulse of friction that the sub-step begins with, in the world \[N s\]; in the end how far they have crept \[m\].
    pub(super) aside: [Row; 3],
}

/// So many times two that touch as go side by side.
#[derive(Clone, Copy, Debug, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
pub(super) struct Pack {
    /// The number of them, and the most points that any has.
    pub(super) count: u32,
    pub(super) most: u32,
    /// A bit for each whose first, and whose second, is pushed.
    pub(super) gives: [u32; 2],
    /// Their numbers, and those of their bodies.
    pub(super) manifolds: [u32; ABREAST],
    pub(super) bodies: [[u32; ABREAST]; 2],
    /// Those of their bodies that are pushed, the world for others.
    pub(super) pushed: [[u32; ABREAST]; 2],
    /// The tick of the clock of passes at which each was gone over last.
    pub(super) seen: Row,
    /// A bit for each that pressed at some point before it was gone over, and for each that comes to a blow in the sub-step if it touches.
    pub(super) pressed_before: u32,
    pub(super) blows: u32,
    /// The number of points of each.
    pub(super) points: Row,
    /// The normal, and two directions across it, in the world.
    pub(super) normal: [Row; 3],
    pub(super) along: [[Row; 3]; 2],
    pub(super) friction: [Row; 2],
    /// The coefficient of friction that is in force for each: all its points rest, or slide, together.
    pub(super) grip: Row,
    /// How their bodies turn by an angular impulse.
    pub(super) inverse: [Inverse; 2],
    /// The normal in the first's frame.
    pub(super) within: [Row; 3],
    pub(super) spots: [Spots; POINTS],
    pub(super) places: [Places; POINTS],
}

impl Pack {
    /// Takes those with some numbers, and nothing of what they do yet.
    pub(super) fn fill(&mut self, bodies: &[Body], manifolds: &Manifolds<'_>, numbers: &[u32]) {
        (self.count, self.most, self.gives, self.points) = (0, 0, [0; 2], [0.0; ABREAST]);
        self.pushed = [[0; ABREAST]; 2];
        for (lane, &number) in numbers.iter().enumerate().take(ABREAST) {
            let Some(manifold) = manifolds.get(number) else { continue };
            self.count = lane as u32 + 1;
            self.most = self.most.max(manifold.points().len() as u32);
            self.manifolds[lane] = number;
            self.points[lane] = manifold.points().len() as f32;
            for side in 0..2 {
                let body = manifold.bodies[side];
                self.bodies[side][lane] = body;
                let gives = bodies.get(body as usize).is_some_and(|body| body.gives(manifold.rested));
                self.gives[side] |= u32::from(gives) << lane;
                self.pushed[side][lane] = if gives { body } else { 0 };
            }
        }
    }

    /// Their number.
    #[inline(always)]
    pub(super) fn len(&self) -> usize {
        (self.count as usize).min(ABREAST)
    }

    /// The numbers of the points that any of them has.
    #[inline(always)]
    pub(super) fn numbers(&self) -> core::ops::Range<usize> {
        0..(self.most as usize).min(POINTS)
    }

    /// Where there is a point with a number.
    #[inline(always)]
    pub(super) fn is_there<F: Eight>(&self, like: F, number: usize) -> F {
        load(like, &self.points).simd_gt(like.all(number as f32))
    }

    /// A bit for each of them.
    #[inline(always)]
    pub(super) fn everyone(&self) -> u32 {
        (1 << self.len()) - 1
    }

    /// A bit for each that presses at some point.
    pub(super) fn pressed(&self) -> u32 {
        let mut pressed = 0;
        for i in self.numbers() {
            for lane in (0..self.len()).filter(|&lane| self.points[lane] > i as f32) {
                pressed |= u32::from(self.spots[i].pressed[lane] > 0.0) << lane;
            }
        }
        pressed
    }

    /// Leaves but a share of what two of them have pressed each other with.
    pub(super) fn press_part(&mut self, lane: usize, share: f32) {
        for spots in &mut self.spots {
            spots.pressed[lane] *= share;
            spots.held.iter_mut().for_each(|held| held[lane] *= share);
        }
    }

    /// Tells whether one of them is pressed by a surface that moves.
    pub(super) fn is_carried(&self, lane: usize) -> bool {
        let mut all = self.spots.iter().zip(&self.places).take(self.points[lane] as usize);
        all.any(|(spots, places)| spots.pressed[lane] > 0.0 && places.surface.iter().any(|row| row[lane] != 0.0))
    }

    /// Those of which a bit is set among `which`, on one side; `nobody` for the others.
    #[inline(always)]
    pub(super) fn side<'a>(&self, side: usize, bodies: &'a [Body], which: u32, nobody: &'a Body) -> [&'a Body; LANES] {
        let mut all = [nobody; LANES];
        for lane in (0..self.len()).filter(|lane| which >> lane & 1 != 0) {
            all[lane] = bodies.get(self.bodies[side][lane] as usize).unwrap_or(nobody);
        }
        all
    }

    /// All of them; `nothing` in lanes that stand for nobody.
    #[inline(always)]
    pub(super) fn all<'a>(&self, manifolds: &'a Manifolds<'_>, nothing: &'a Manifold) -> [&'a Manifold; LANES] {
        let mut all = [nothing; LANES];
        for (place, &number) in all.iter_mut().zip(&self.manifolds).take(self.len()) {
            *place = manifolds.get(number).unwrap_or(nothing);
        }
        all
    }

    /// Writes down what they have done to each other, for the next sub-step and for those who look on.
    #[inline(always)]
    pub(super) fn tell<F: Eight>(&self, like: F, manifolds: &mut Manifolds<'_>) {
        let axes = Vectors::load(like, &self.normal).rows();
        let mut presses = 0;
        for (i, (spots, places)) in self.spots.iter().zip(&self.places).enumerate().take(self.numbers().end) {
            let [u, v] = [Vectors::load(like, &self.along[0]), Vectors::load(like, &self.along[1])];
            let [x, y] = [load(like, &spots.held[0]), load(like, &spots.held[1])];
            let (pressed, Vectors(held)) = (load(like, &spots.pressed), u * x + v * y);
            let (driven, Vectors(crept)) = (load(like, &places.driven), Vectors::load(like, &places.aside));
            let [Vectors(a), Vectors(b)] = [Vectors::load(like, &spots.arms[0]), Vectors::load(like, &spots.arms[1])];
            let Vectors(p) = Vectors::load(like, &places.places[0]);
            let Vectors(q) = Vectors::load(like, &places.places[1]);
            let is_there = self.is_there(like, i);
            presses |= (is_there & pressed.simd_gt(like.all(0.0))).to_bitmask();
            let is_there = is_there.to_bitmask();
            let fours = [
                F::rows_of([pressed, held[0], held[1], held[2]]),
                F::rows_of([driven, crept[0], crept[1], crept[2]]),
                F::rows_of([a[0], a[1], a[2], b[0]]),
                F::rows_of([b[1], b[2], p[0], p[1]]),
                F::rows_of([p[2], q[0], q[1], q[2]]),
            ];
            for lane in (0..self.len()).filter(|lane| is_there >> lane & 1 != 0) {
                let Some(manifold) = manifolds.get_mut(self.manifolds[lane]) else { continue };
                for (k, rows) in fours.iter().enumerate() {
                    put(&mut manifold.points[i], 4 * k, rows[lane]);
                }
            }
        }
        for (lane, &axis) in axes.iter().enumerate().take(self.len()) {
            let Some(manifold) = manifolds.get_mut(self.manifolds[lane]) else { continue };
            manifold.axis = vector(axis);
            manifold.presses = (presses >> lane & 1) as u8;
            manifold.grip = self.grip[lane];
        }
    }
}

#[inline(always)]
fn vector([x, y, z, _]: [f32; 4]) -> Vec3 {
    Vec3::new(x, y, z)
}

/// A point of each, as it is kept.
pub(super) struct Kept<F> {
    pub(super) pressed: F,
    pub(super) held: Vectors<F>,
    pub(super) places: [Vectors<F>; 2],
    pub(super) surface: Vectors<F>,
    pub(super) lift: F,
}

impl<F: Eight> Kept<F> {
    #[inline(always)]
    pub(super) fn of(like: F, all: &[&Manifold; LANES], number: usize) -> Self {
        let first = (offset_of!(Manifold, points) + number * size_of::<Point>()) / 4;
        let [pressed, u, v, w] = fours(like, all, first);
        let [_, _, a, b] = fours(like, all, first + 12);
        let [c, x, y, z] = fours(like, all, first + 16);
        let [p, q, r, lift] = fours(like, all, first + 20);
        let (held, places) = (Vectors([u, v, w]), [Vectors([a, b, c]), Vectors([x, y, z])]);
        Self { pressed, held, places, surface: Vectors([p, q, r]), lift }
    }
}

/// The normals of all in the first's frame, their elasticities, their two coefficients of friction, and which of them is in force.
#[inline(always)]
pub(super) fn surfaces<F: Eight>(like: F, all: &[&Manifold; LANES]) -> (Vectors<F>, F, [F; 3]) {
    let first = offset_of!(Manifold, normal) / 4;
    let ([x, y, z, elasticity], [sticks, slides, grip, _]) = (fours(like, all, first), fours(like, all, first + 4));
    (Vectors([x, y, z]), elasticity, [sticks, slides, grip])
}
