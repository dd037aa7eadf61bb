//! A square of cloth by rapier3d's soft bodies, to be held against the same by pointmass.

use rapier3d::prelude::{
    ColliderBuilder, PhysicsWorld, SharedShape, SoftBodyBuilder, SoftBodyHandle, SpringCoefficients, Vector,
};

/// A square of cloth, and what it falls on.
#[derive(Clone, Copy, Debug)]
pub struct Cloth {
    /// Its first corner, and one cell along each side \[m\].
    pub corner: [f32; 3],
    /// The ways from one particle to the next along both sides \[m\].
    pub cells: [[f32; 3]; 2],
    /// Particles along each side.
    pub side: usize,
    /// Its mass \[kg\].
    pub mass: f32,
    /// How thick it is \[m\].
    pub thickness: f32,
    /// True if it hangs by both ends of its first side.
    pub hangs: bool,
    /// True if it touches itself.
    pub touches_itself: bool,
    /// Solver iterations of a step, which rapier3d makes sub-steps of: 4 by default.
    pub iterations: usize,
    /// The natural frequency of its edges \[Hz\]: 30 by default.
    pub frequency: f32,
    /// The middle and the radius of a ball \[m\], which lies over the plane y = 0.
    pub ball: ([f32; 3], f32),
}

/// The cloth under way in rapier3d: one thread, its defaults for everything but what [`Cloth`] says, steps of 1/60 s; it never sleeps.
pub struct Sheet {
    world: PhysicsWorld,
    body: SoftBodyHandle,
}

impl Sheet {
    /// The cloth at rest where it starts.
    #[must_use]
    pub fn new(cloth: &Cloth) -> Self {
        let mut world =
            PhysicsWorld { gravity: Vector::new(0.0, -super::rapier::GRAVITY, 0.0), ..PhysicsWorld::default() };
        world.integration_parameters.num_solver_iterations = cloth.iterations;
        world.insert_collider(ColliderBuilder::new(SharedShape::halfspace(Vector::Y)), None);
        let (middle, radius) = cloth.ball;
        world.insert_collider(ColliderBuilder::ball(radius).translation(middle.into()), None);
        let [u, v] = cloth.cells.map(Vector::from);
        let pinned = [0, cloth.side as u32 - 1];
        let builder = SoftBodyBuilder::cloth(cloth.corner.into(), u, v, cloth.side, cloth.side)
            .mass(cloth.mass)
            .particle_radius(0.5 * cloth.thickness)
            .softness(SpringCoefficients::new(cloth.frequency, 1.0))
            .pinned_particles(pinned.into_iter().filter(|_| cloth.hangs))
            .self_contacts(cloth.touches_itself)
            .can_sleep(false);
        let body = world.insert_soft_body(builder);
        Self { world, body }
    }

    /// Goes on by one step.
    pub fn step(&mut self) {
        self.world.step();
    }

    /// Where the particles are \[m\], row by row; a row goes along the second side.
    #[must_use]
    pub fn places(&self) -> Vec<[f32; 3]> {
        let (_, body) = self.world.soft_bodies().find(|&(handle, _)| handle == self.body).expect("it is there");
        body.particle_positions().map(Into::into).collect()
    }
}
