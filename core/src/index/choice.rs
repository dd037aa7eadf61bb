//! Which index a scene's forces find their neighbours by.

use super::facts::ARE_KEPT;
use super::{Grid, Kd, Room, SpatialIndex, Structure};
use crate::composed::stands_for;
use glam::Vec3;

/// Makes an index of a step's particles in memory of the system. A reference or box of a choice is one.
///
/// `()` makes none, and forces look at all pairs; a [`Structure`] is chosen by name; [`InGrid`] and [`InKd`] by type, so that
/// firmware carries no other. In [`Periodic`] any of them finds neighbours through the sides of a room.
///
/// ```
/// use pointmass::index::{Hash, IndexChoice, Room, SpatialIndex, Structure};
/// use pointmass::Vec3;
///
/// /// Hashed cells for many points, all pairs for a few.
/// struct ForMany;
///
/// impl IndexChoice for ForMany {
///     fn columns(&self) -> usize {
///         Structure::Hash.words(1000).div_ceil(3000)
///     }
///     fn with_index(
///         &self,
///         memory: &mut [u32],
///         points: &[Vec3],
///         reach: f32,
///         room: Option<&Room>,
///         then: &mut dyn FnMut(Option<&dyn SpatialIndex>),
///     ) {
///         let mut hash = Hash::in_room(memory, room);
///         let built = points.len() > 100 && hash.build(points, reach).is_ok();
///         then(if built { Some(&hash) } else { None });
///     }
/// }
///
/// let (points, mut memory) = ([Vec3::ZERO; 200], [0; 9000]);
/// ForMany.with_index(&mut memory, &points, 0.1, None, &mut |index| {
///     assert_eq!(index.map(|index| index.count(Vec3::ZERO, 0.1).found), Some(200));
/// });
/// ```
pub trait IndexChoice: Sync {
    /// Vectors of memory that it takes for each particle. With few particles they may not do: then there is no index.
    fn columns(&self) -> usize;

    /// Calls `then` with the points in an index, or with none if it has no memory for them: in a room, if there is one, or in all of space. It has to do so
    /// exactly once, and rows of that index have to be below `points.len()`: others are passed over.
    fn with_index(
        &self,
        memory: &mut [u32],
        points: &[Vec3],
        reach: f32,
        room: Option<&Room>,
        then: &mut dyn FnMut(Option<&dyn SpatialIndex>),
    );

    /// Calls `then` with an index, empty yet, in memory where [`with_index`](Self::with_index) has left one and which has been left alone since: to be
    /// [taken up](SpatialIndex::take_up). By default it does not.
    fn reopen(&self, memory: &mut [u32], room: Option<&Room>, then: &mut dyn FnMut(&mut dyn SpatialIndex)) {
        let _ = (memory, room, then);
    }

    /// The room through whose sides particles are neighbours; none: they are in all of space.
    fn room(&self) -> Option<&Room> {
        None
    }

    /// Brings those who have left the room at one side in at the other: at the end of each step.
    fn wrap(&self, position: &mut [Vec3]) {
        let _ = position;
    }
}

stands_for! {
    IndexChoice {
        fn columns(&self) -> usize {
            (**self).columns()
        }
        fn with_index(
            &self,
            memory: &mut [u32],
            points: &[Vec3],
            reach: f32,
            room: Option<&Room>,
            then: &mut dyn FnMut(Option<&dyn SpatialIndex>),
        ) {
            (**self).with_index(memory, points, reach, room, then);
        }
        fn reopen(&self, memory: &mut [u32], room: Option<&Room>, then: &mut dyn FnMut(&mut dyn SpatialIndex)) {
            (**self).reopen(memory, room, then);
        }
        fn room(&self) -> Option<&Room> {
            (**self).room()
        }
        fn wrap(&self, position: &mut [Vec3]) {
            (**self).wrap(position);
        }
    }
}

/// Vectors a point that so many words for a thousand points take.
const fn columns(words_for_1000: usize) -> usize {
    words_for_1000.div_ceil(3000)
}

impl IndexChoice for () {
    fn columns(&self) -> usize {
        0
    }
    fn with_index(
        &self,
        _: &mut [u32],
        _: &[Vec3],
        _: f32,
        _: Option<&Room>,
        then: &mut dyn FnMut(Option<&dyn SpatialIndex>),
    ) {
        then(None);
    }
}

impl IndexChoice for Structure {
    fn columns(&self) -> usize {
        columns(self.words(1000))
    }
    fn with_index(
        &self,
        memory: &mut [u32],
        points: &[Vec3],
        reach: f32,
        room: Option<&Room>,
        then: &mut dyn FnMut(Option<&dyn SpatialIndex>),
    ) {
        let mut index = self.in_room(memory, room);
        let built = index.build(points, reach).is_ok();
        then(built.then_some(&index));
    }
    fn reopen(&self, memory: &mut [u32], room: Option<&Room>, then: &mut dyn FnMut(&mut dyn SpatialIndex)) {
        if ARE_KEPT {
            then(&mut self.in_room(memory, room));
        }
    }
}

macro_rules! by_type {
    ($($(#[$doc:meta])* $name:ident = $index:ident;)+) => {$(
        $(#[$doc])*
        #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
        pub struct $name;

        impl IndexChoice for $name {
            fn columns(&self) -> usize {
                const { columns(Structure::$index.words(1000)) }
            }
            fn with_index(
                &self,
                memory: &mut [u32],
                points: &[Vec3],
                reach: f32,
                room: Option<&Room>,
                then: &mut dyn FnMut(Option<&dyn SpatialIndex>),
            ) {
                let mut index = $index::in_room(memory, room);
                let built = index.build(points, reach).is_ok();
                then(built.then_some(&index));
            }
            fn reopen(&self, memory: &mut [u32], room: Option<&Room>, then: &mut dyn FnMut(&mut dyn SpatialIndex)) {
                if ARE_KEPT {
                    then(&mut $index::in_room(memory, room));
                }
            }
        }
    )+};
}
by_type! {
    /// A grid: for particles that are spread evenly.
    InGrid = Grid;
    /// A kd-tree: for particles that cluster.
    InKd = Kd;
}

/// Neighbours through the sides of a room, found by any choice of index.
///
/// Forces between neighbours, springs, contacts of balls (by force, position and impulse), distances, ropes and attachments act along the
/// shortest way through the sides, births and deaths count neighbours through them, and whoever has left at one side by the end of a step comes
/// in at the other. It takes the reach of forces, the widths of balls and lengths to be less than half of the shortest side: of a neighbour in
/// several images the nearest counts. All else acts straight: colliders, sinks, what makes bodies or surfaces of particles, and forces that reach
/// any distance.
///
/// ```
/// use pointmass::force::{LennardJones, Radial};
/// use pointmass::index::{Periodic, Room, Structure};
/// use pointmass::{Heap, Particle, Scene, System, Time, Vec3};
///
/// // Two atoms beside opposite sides are 1 m apart, and attract each other through the side.
/// let start = [0.5, 9.5].map(|x| Particle { position: Vec3::X * x, ..Particle::REST });
/// let atoms = Radial(LennardJones { epsilon: 1.0, sigma: 0.5, cutoff: 2.0 });
/// let index = Periodic { room: Room::new(Vec3::ZERO, Vec3::X * 10.0), index: Structure::Grid };
/// let scene = Scene { start: &start, forces: &atoms, index: &index, ..Scene::EMPTY };
/// let mut system = System::with(Heap::new(scene.size()));
/// system.start(&scene, 1)?;
/// system.step(&scene, Time::frame(1, 60));
/// let [left, right] = [0, 1].map(|row| system.particles().velocity[row].x);
/// assert!(left < 0.0 && right == -left);
/// # Ok::<(), pointmass::InsufficientMemory>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Periodic<I> {
    /// The room; an open one changes nothing.
    pub room: Room,
    /// The index by which neighbours are found.
    pub index: I,
}

impl<I: IndexChoice> IndexChoice for Periodic<I> {
    fn columns(&self) -> usize {
        self.index.columns()
    }
    fn with_index(
        &self,
        memory: &mut [u32],
        points: &[Vec3],
        reach: f32,
        room: Option<&Room>,
        then: &mut dyn FnMut(Option<&dyn SpatialIndex>),
    ) {
        self.index.with_index(memory, points, reach, room, then);
    }
    fn reopen(&self, memory: &mut [u32], room: Option<&Room>, then: &mut dyn FnMut(&mut dyn SpatialIndex)) {
        self.index.reopen(memory, room, then);
    }
    fn room(&self) -> Option<&Room> {
        Some(&self.room).filter(|room| !room.is_open())
    }
    fn wrap(&self, position: &mut [Vec3]) {
        if !self.room.is_open() {
            position.iter_mut().for_each(|x| *x = self.room.wrap(*x));
        }
    }
}
