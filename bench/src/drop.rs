//! Ten thousand balls that fall into a box: the heap by which responses are compared, here and with other engines.

use pointmass::rng::Stream;
use pointmass::shape::Cuboid;
use pointmass::{ContactMaterial, Particle, Vec3};

/// Balls above an open box, and what they are like.
#[derive(Clone, Debug)]
pub struct Drop {
    /// Where their middles are at first \[m\].
    pub positions: Vec<Vec3>,
    /// Their radius \[m\].
    pub radius: f32,
    /// Dry friction, resting and sliding alike.
    pub friction: f32,
    /// Share of the normal speed kept.
    pub elasticity: f32,
    /// Half the box's inner width along x and z \[m\]; its floor is at zero.
    pub half_width: f32,
    /// The step \[s\].
    pub dt: f32,
}

/// How high the box's walls are \[m\].
pub const HEIGHT: f32 = 40.0;

impl Drop {
    /// So many balls of 5 cm radius and of water's density, in layers of 20 × 20, each a little aside, 2.4 radii apart.
    #[must_use]
    pub fn of(count: usize) -> Self {
        let (radius, across) = (0.05, 20);
        let gap = 2.4 * radius;
        let positions = (0..count).map(|i| {
            let random = Stream::new(11, 0, i as u32);
            let ([u, v], [w, _]) = (random.units(0), random.units(1));
            // Every other layer stands over the gaps of the one below.
            let layer = i / across / across;
            let shift = if layer % 2 == 0 { -0.25 } else { 0.25 };
            let place = |k: usize| (k as f32 + 0.5 - 0.5 * across as f32 + shift) * gap;
            let aside = |u: f32| (u - 0.5) * 0.3 * radius;
            let (x, z) = (place(i % across) + aside(u), place(i / across % across) + aside(v));
            Vec3::new(x, gap * (layer as f32 + 1.0) + aside(w), z)
        });
        let half_width = 0.5 * gap * (across as f32 + 0.5);
        Self { positions: positions.collect(), radius, friction: 0.5, elasticity: 0.0, half_width, dt: 1.0 / 60.0 }
    }

    /// Mass of a ball \[kg\].
    #[must_use]
    pub fn mass(&self) -> f32 {
        1000.0 * 4.0 / 3.0 * core::f32::consts::PI * self.radius.powi(3)
    }

    /// The balls as particles, of material 0.
    #[must_use]
    pub fn particles(&self) -> Vec<Particle> {
        let ball = |&position: &Vec3| Particle {
            position,
            radius: self.radius,
            mass: self.mass(),
            elasticity: self.elasticity,
            material: Some(0),
            ..Particle::REST
        };
        self.positions.iter().map(ball).collect()
    }

    /// The box from inside.
    #[must_use]
    pub fn walls(&self) -> Cuboid {
        let w = self.half_width;
        Cuboid { min: Vec3::new(-w, 0.0, -w), max: Vec3::new(w, HEIGHT, w) }
    }

    /// The materials.
    #[must_use]
    pub fn materials(&self) -> [ContactMaterial; 1] {
        let friction = pointmass::force::Friction { static_: self.friction, kinetic: self.friction };
        [ContactMaterial { elasticity: None, friction: Some(friction) }]
    }

    /// The energy that one ball loses in falling from its height to the floor, on average \[J\].
    #[must_use]
    pub fn energy(&self) -> f64 {
        let height: f64 = self.positions.iter().map(|x| f64::from(x.y)).sum::<f64>() / self.positions.len() as f64;
        f64::from(self.mass()) * 9.80665 * height
    }
}

/// The deepest overlap of two balls, or of a ball and the box \[m\].
#[must_use]
pub fn deepest(drop: &Drop, positions: &[Vec3]) -> f32 {
    use pointmass::index::{Grid, SpatialIndex, Structure};
    let mut memory = vec![0; Structure::Grid.words(positions.len())];
    let mut grid = Grid::new(&mut memory);
    let reach = 2.0 * drop.radius;
    let mut deepest = 0.0_f32;
    if grid.build(positions, reach).is_ok() {
        grid.pairs(reach, &mut |row, others| {
            for &other in others {
                deepest = deepest.max(reach - (positions[row as usize] - positions[other as usize]).length());
            }
        });
    }
    let walls = drop.walls();
    for &x in positions {
        let gap = (x - walls.min).min_element().min((walls.max - x).min_element());
        deepest = deepest.max(drop.radius - gap);
    }
    deepest
}
