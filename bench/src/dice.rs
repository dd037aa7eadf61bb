//! Dice thrown on a table: the heap by which rigid bodies are compared, here and with other engines.

use pointmass::constrain::{RigidBodies, RigidBox};
use pointmass::force::Friction;
use pointmass::rng::Stream;
use pointmass::{ContactMaterial, Particle, Vec3};

/// Dice above a table at y = 0, and how they are thrown.
#[derive(Clone, Debug)]
pub struct Throw {
    /// Half the side of a die \[m\].
    pub half: f32,
    /// The mass of a die \[kg\].
    pub mass: f32,
    /// Dry friction, resting and sliding alike.
    pub friction: f32,
    /// Share of the normal speed kept.
    pub elasticity: f32,
    /// The dice.
    pub dice: Vec<Die>,
}

/// A die as it is thrown.
#[derive(Clone, Copy, Debug)]
pub struct Die {
    /// Its middle \[m\].
    pub place: Vec3,
    /// How it is turned: an angle \[rad\] along its axis.
    pub turn: Vec3,
    /// Its velocity \[m/s\].
    pub velocity: Vec3,
    /// How it turns \[rad/s\].
    pub spin: Vec3,
}

/// A flat table of 6 m at y = 0 as a mesh, so many cells a side, of two triangles each: its vertices \[m\], and whose corners they are.
#[must_use]
pub fn table(cells: u32) -> (Vec<Vec3>, Vec<[u32; 3]>) {
    let at = |i: u32| 6.0 * i as f32 / cells as f32 - 3.0;
    let rows = |ends: u32| (0..ends).flat_map(move |i| (0..ends).map(move |j| (i, j)));
    let number = |i: u32, j: u32| i * (cells + 1) + j;
    let halves = |(i, j)| {
        let [a, b, c, d] = [number(i, j), number(i, j + 1), number(i + 1, j + 1), number(i + 1, j)];
        [[a, b, c], [a, c, d]]
    };
    (rows(cells + 1).map(|(i, j)| Vec3::new(at(i), 0.0, at(j))).collect(), rows(cells).flat_map(halves).collect())
}

/// A die as it lies: its middle \[m\], and the unit vectors along its sides.
pub type Pose = (Vec3, [Vec3; 3]);

impl Throw {
    /// So many dice of 5 cm and 0.1 kg in layers of 20 × 20, 10 cm apart, turned anyhow and thrown toward the middle.
    #[must_use]
    pub fn of(count: usize) -> Self {
        let dice = (0..count).map(|i| {
            let stream = Stream::new(7, 0, i as u32);
            let vary = |place: u32, by: f32| {
                let ([x, y], [z, _]) = (stream.units(2 * place), stream.units(2 * place + 1));
                (Vec3::new(x, y, z) * 2.0 - 1.0) * by
            };
            let at = |k: usize| (k as f32 - 9.5) * 0.1;
            let place = Vec3::new(at(i % 20), 0.15 + 0.1 * (i / 400) as f32, at(i / 20 % 20)) + vary(0, 0.005);
            let velocity = Vec3::new(-0.6 * place.x, 0.0, -0.6 * place.z) + vary(2, 0.3);
            Die { place, turn: vary(1, 2.0), velocity, spin: vary(3, 15.0) }
        });
        Self { half: 0.025, mass: 0.1, friction: 0.5, elasticity: 0.3, dice: dice.collect() }
    }

    /// The dice as particles, eight each, of material 0, and as bodies.
    #[must_use]
    pub fn bodies(&self) -> (Vec<Particle>, RigidBodies<Vec<RigidBox>>) {
        let (mut particles, mut boxes) = (Vec::new(), Vec::new());
        for die in &self.dice {
            let (sin, cos) = (0.5 * die.turn.length()).sin_cos();
            let [x, y, z] = (die.turn.normalize_or_zero() * sin).to_array();
            let body = RigidBox::new(Vec3::splat(self.half), die.place, particles.len() as u32);
            let body = RigidBox { turn: [x, y, z, cos], ..body };
            let (mass, elasticity) = (self.mass, self.elasticity);
            let whole = Particle { mass, elasticity, velocity: die.velocity, material: Some(0), ..Particle::REST };
            let turning = |p: Particle| p.velocity + die.spin.cross(p.position - die.place);
            particles.extend(body.solid(whole).map(|p| Particle { velocity: turning(p), ..p }));
            boxes.push(body);
        }
        (particles, RigidBodies::boxes(boxes))
    }

    /// The material.
    #[must_use]
    pub fn materials(&self) -> [ContactMaterial; 1] {
        let friction = Friction { static_: self.friction, kinetic: self.friction };
        [ContactMaterial { elasticity: None, friction: Some(friction) }]
    }

    /// How the dice lie, by where their particles are.
    #[must_use]
    pub fn poses(&self, position: &[Vec3]) -> Vec<Pose> {
        let pose = |corners: &[Vec3]| {
            let middle = corners.iter().sum::<Vec3>() / 8.0;
            let side = |i: usize, axis: usize| if i >> axis & 1 == 1 { 1.0 } else { -1.0 };
            let along =
                |axis: usize| corners.iter().enumerate().map(|(i, x)| (*x - middle) * side(i, axis)).sum::<Vec3>();
            (middle, [0, 1, 2].map(|axis| along(axis).normalize()))
        };
        position.chunks_exact(8).map(pose).collect()
    }
}

/// The deepest overlap of two dice, or of a die and the table \[m\]: the least over the fifteen axes of each two.
#[must_use]
pub fn deepest(half: f32, dice: &[Pose]) -> f32 {
    let reach = |axes: &[Vec3; 3], along: Vec3| axes.iter().map(|axis| half * axis.dot(along).abs()).sum::<f32>();
    let table = dice.iter().map(|(middle, axes)| reach(axes, Vec3::Y) - middle.y).fold(0.0, f32::max);
    let mut sorted: Vec<_> = dice.iter().collect();
    sorted.sort_by(|a, b| a.0.x.total_cmp(&b.0.x));
    let widest = 2.0 * half * 3f32.sqrt();
    let mut deepest = table;
    for (i, (a, u)) in sorted.iter().enumerate() {
        for (b, v) in sorted[i + 1..].iter().take_while(|(b, _)| b.x - a.x < widest) {
            let way = *b - *a;
            let edges =
                u.iter().flat_map(|u| v.iter().map(|v| u.cross(*v))).filter(|axis| axis.length_squared() > 1e-4);
            let axes = u.iter().chain(v).copied().chain(edges.map(Vec3::normalize));
            let overlap =
                axes.map(|axis| reach(u, axis) + reach(v, axis) - way.dot(axis).abs()).fold(f32::MAX, f32::min);
            deepest = deepest.max(overlap);
        }
    }
    deepest
}
