//! The drop of many balls into an open box, and a throw of dice, by rapier3d, to be held against the same by pointmass.

use rapier3d::prelude::{ColliderBuilder, PhysicsWorld, RigidBodyBuilder, RigidBodyHandle, SharedShape, Vector};

/// Gravity \[m/s²\], along −y: what pointmass means by it.
pub const GRAVITY: f32 = 9.80665;

/// The balls that are dropped, and the box that they fall into: its floor is at y = 0, and it is open at the top.
#[derive(Clone, Debug)]
pub struct Drop {
    /// Where the balls' centres start \[m\], at rest.
    pub positions: Vec<[f32; 3]>,
    /// The radius of each \[m\].
    pub radius: f32,
    /// Their density \[kg/m³\].
    pub density: f32,
    /// The coefficient of friction of all that touch.
    pub friction: f32,
    /// The coefficient of restitution of all that touch.
    pub elasticity: f32,
    /// Half the box's width along x and z \[m\], about the y axis.
    pub half_width: f32,
    /// The step \[s\].
    pub dt: f32,
    /// The length that rapier calls so \[m\]: 2 % of it is how far ahead it looks for contacts, and three times it a
    /// second is how fast it parts what overlaps at the most. Its default of 1 is made for things of a metre: with
    /// balls of centimetres every ball has dozens of contacts to be looked at. Less is faster and leaves deeper
    /// overlaps.
    pub length_unit: f32,
    /// True if balls may turn; particles of pointmass have no orientation.
    pub turns: bool,
}

/// A drop under way in rapier: one thread, its defaults for everything but what [`Drop`] says; nothing ever sleeps.
pub struct Pile {
    world: PhysicsWorld,
    balls: Vec<RigidBodyHandle>,
    radius: f32,
    half_width: f32,
}

impl Pile {
    /// All balls at rest where they start, and the box: five half-spaces.
    #[must_use]
    pub fn new(drop: &Drop) -> Self {
        let mut world = PhysicsWorld { gravity: Vector::new(0.0, -GRAVITY, 0.0), ..PhysicsWorld::default() };
        world.integration_parameters.dt = drop.dt;
        world.integration_parameters.length_unit = drop.length_unit;
        // Rapier takes the average of both colliders' coefficients, so the walls get the balls'.
        let touching = |collider: ColliderBuilder| collider.friction(drop.friction).restitution(drop.elasticity);
        let half = drop.half_width;
        let sides = [Vector::X, -Vector::X, Vector::Z, -Vector::Z].map(|inward| (inward * -half, inward));
        for (place, inward) in [(Vector::ZERO, Vector::Y)].into_iter().chain(sides) {
            let wall = ColliderBuilder::new(SharedShape::halfspace(inward));
            world.insert_collider(touching(wall).translation(place), None);
        }
        let ball = |place: &[f32; 3]| {
            let body = RigidBodyBuilder::dynamic().translation((*place).into()).can_sleep(false);
            let body = if drop.turns { body } else { body.lock_rotations() };
            world.insert(body, touching(ColliderBuilder::ball(drop.radius)).density(drop.density)).0
        };
        let balls = drop.positions.iter().map(ball).collect();
        Self { world, balls, radius: drop.radius, half_width: half }
    }

    /// Goes on by one step.
    pub fn step(&mut self) {
        self.world.step();
    }

    /// The kinetic energy of all balls \[J\], their turning included.
    #[must_use]
    pub fn kinetic_energy(&self) -> f64 {
        self.balls.iter().map(|&ball| f64::from(self.world.bodies[ball].kinetic_energy())).sum()
    }

    /// How deep two balls, or a ball and the box, are in each other at the most \[m\].
    #[must_use]
    pub fn max_penetration(&self) -> f32 {
        max_penetration(&self.positions(), self.radius, self.half_width)
    }

    /// The balls' centres \[m\], in the order of the drop.
    #[must_use]
    pub fn positions(&self) -> Vec<[f32; 3]> {
        self.balls.iter().map(|&ball| self.world.bodies[ball].translation().into()).collect()
    }
}

/// A die as it is thrown.
#[derive(Clone, Copy, Debug)]
pub struct Die {
    /// Its middle \[m\].
    pub place: [f32; 3],
    /// How it is turned: an angle \[rad\] along its axis.
    pub turn: [f32; 3],
    /// Its velocity \[m/s\].
    pub velocity: [f32; 3],
    /// How it turns \[rad/s\].
    pub spin: [f32; 3],
}

/// The vertices \[m\] and triangles of a table.
pub type Table = (Vec<[f32; 3]>, Vec<[u32; 3]>);

/// Dice thrown on a half-space below y = 0 or a mesh in rapier: one thread, its defaults for everything, steps of 1/60 s.
pub struct Cuboids {
    world: PhysicsWorld,
    dice: Vec<RigidBodyHandle>,
}

impl Cuboids {
    /// Dice of half a side \[m\] and a mass \[kg\] as they are thrown, and the table; `touch` are the coefficients of friction and restitution.
    ///
    /// # Panics
    ///
    /// Where rapier takes the table for no mesh.
    #[must_use]
    pub fn new(dice: &[Die], half: f32, mass: f32, touch: [f32; 2], sleeps: bool, table: Option<&Table>) -> Self {
        let mut world = PhysicsWorld { gravity: Vector::new(0.0, -GRAVITY, 0.0), ..PhysicsWorld::default() };
        let touching = |collider: ColliderBuilder| collider.friction(touch[0]).restitution(touch[1]);
        let table = match table {
            Some((vertices, triangles)) => {
                let vertices = vertices.iter().map(|&place| place.into()).collect();
                SharedShape::trimesh(vertices, triangles.clone()).expect("the table is a mesh")
            }
            None => SharedShape::halfspace(Vector::Y),
        };
        world.insert_collider(touching(ColliderBuilder::new(table)), None);
        let throw = |die: &Die| {
            let body = RigidBodyBuilder::dynamic().translation(die.place.into()).rotation(die.turn.into());
            let body = body.linvel(die.velocity.into()).angvel(die.spin.into()).can_sleep(sleeps);
            world.insert(body, touching(ColliderBuilder::cuboid(half, half, half)).mass(mass)).0
        };
        let dice = dice.iter().map(throw).collect();
        Self { world, dice }
    }

    /// Goes on by one step.
    pub fn step(&mut self) {
        self.world.step();
    }

    /// The middle of each \[m\], and the unit vectors along its sides.
    pub fn poses(&self) -> impl Iterator<Item = ([f32; 3], [[f32; 3]; 3])> + '_ {
        self.dice.iter().map(|&die| {
            let die = &self.world.bodies[die];
            let turned = |axis: Vector| (*die.rotation() * axis).into();
            (die.translation().into(), [Vector::X, Vector::Y, Vector::Z].map(turned))
        })
    }

    /// The speed of the fastest one's middle \[m/s\].
    #[must_use]
    pub fn fastest(&self) -> f32 {
        self.dice.iter().map(|&die| self.world.bodies[die].linvel().length()).fold(0.0, f32::max)
    }
}

/// How deep two balls of a radius, or a ball and the box of a [`Drop`], are in each other at the most \[m\]; zero if none
/// touch. Written for either engine: it looks at places alone.
///
/// Balls are swept along x, so that only those are compared whose centres are within a diameter along it.
#[must_use]
pub fn max_penetration(positions: &[[f32; 3]], radius: f32, half_width: f32) -> f32 {
    let inside = |&[x, y, z]: &[f32; 3]| radius - y.min(half_width - x.abs()).min(half_width - z.abs());
    let deepest = positions.iter().map(inside).fold(0.0, f32::max);
    let mut sorted = positions.to_vec();
    sorted.sort_by(|a, b| a[0].total_cmp(&b[0]));
    let mut nearest = 4.0 * radius * radius;
    for (i, a) in sorted.iter().enumerate() {
        for b in sorted[i + 1..].iter().take_while(|b| b[0] - a[0] < 2.0 * radius) {
            nearest = nearest.min(crate::square_distance(*a, *b));
        }
    }
    deepest.max(2.0 * radius - nearest.sqrt())
}
