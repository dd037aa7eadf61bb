//! Rows that there are not, which an index of a user's own hands out: steps pass over them.

use core::ops::Range;
use pointmass::constrain::{Bodies, Demand, Share};
use pointmass::index::{Cost, Hash, IndexChoice, Neighbour, Periodic, Room, SpatialIndex, Stats, Structure, TooSmall};
use pointmass::{Constraint, Contacts, Dense, Force, Meetings, Particle, Penalty, Scene, Time, Vec3, force::Friction};
use pointmass_tests::{Random, started};

/// Rows of nobody.
const STRANGERS: [u32; 3] = [u32::MAX, 200, 1 << 31];

/// An index that says as well that strangers are near everybody.
struct Liar<'m>(Hash<'m>);

impl SpatialIndex for Liar<'_> {
    fn build(&mut self, points: &[Vec3], reach: f32) -> Result<(), TooSmall> {
        self.0.build(points, reach)
    }
    fn refit(&mut self, points: &[Vec3]) -> Result<(), TooSmall> {
        self.0.refit(points)
    }
    fn stats(&self) -> Stats {
        self.0.stats()
    }
    fn order(&self) -> &[u32] {
        &STRANGERS
    }
    fn count(&self, center: Vec3, radius: f32) -> Cost {
        self.0.count(center, radius)
    }
    fn within(&self, center: Vec3, radius: f32, visit: &mut dyn FnMut(&[u32])) -> Cost {
        visit(&STRANGERS);
        self.0.within(center, radius, visit)
    }
    fn nearest(&self, center: Vec3, radius: f32, found: &mut [Neighbour]) -> Cost {
        self.0.nearest(center, radius, found)
    }
    fn counts(&self, radius: f32, counts: &mut [u32]) -> Cost {
        self.0.counts(radius, counts)
    }
    fn neighbours(&self, radius: f32, visit: &mut dyn FnMut(u32, &[u32])) -> Cost {
        visit(u32::MAX, &[0]);
        self.0.neighbours(radius, &mut |row, others| {
            // So many that they are gone over lot by lot.
            (0..400).for_each(|_| visit(row, &STRANGERS));
            visit(row, others);
        })
    }
    fn in_order(&self, places: Range<usize>, _: f32, visit: &mut dyn FnMut(usize, &[u32])) -> bool {
        places.for_each(|place| visit(place, &STRANGERS));
        true
    }
    fn pairs(&self, radius: f32, visit: &mut dyn FnMut(u32, &[u32])) -> Cost {
        visit(u32::MAX, &[0]);
        visit(0, &STRANGERS);
        self.0.pairs(radius, visit)
    }
    fn all_nearest(&self, radius: f32, found: &mut [Neighbour], visit: &mut dyn FnMut(u32, &[Neighbour])) -> Cost {
        self.0.all_nearest(radius, found, visit)
    }
}

/// The choice of that index, or of what it wraps.
struct Choice {
    lies: bool,
}

impl IndexChoice for Choice {
    fn columns(&self) -> usize {
        Structure::Hash.words(1000).div_ceil(3000)
    }
    fn with_index(
        &self,
        memory: &mut [u32],
        points: &[Vec3],
        reach: f32,
        room: Option<&Room>,
        then: &mut dyn FnMut(Option<&dyn SpatialIndex>),
    ) {
        let mut index = Liar(Hash::in_room(memory, room));
        assert!(index.build(points, reach).is_ok());
        then(Some(if self.lies { &index } else { &index.0 }));
    }
}

/// What balls do that meet by contacts, by impulse, and by force, in a room or not.
fn states(lies: bool, is_room: bool) -> Vec<Vec<Vec3>> {
    let mut random = Random::new(9);
    let ball = |place, velocity| Particle { position: place, velocity, radius: 0.08, ..Particle::REST };
    let start: Vec<_> = (0..200).map(|_| ball(random.vector(1.0), random.vector(1.0))).collect();
    let penalty =
        Penalty { stiffness: 10.0, damping: 0.1, friction: Friction { static_: 0.5, kinetic: 0.5 }, reach: 0.2 };
    let periodic = Periodic { room: Room::new(Vec3::splat(-1.0), Vec3::splat(2.0)), index: Choice { lies } };
    let index: &dyn IndexChoice = if is_room { &periodic } else { &periodic.index };
    let dense = Dense { radius: 0.3, most: 100 };
    let kinds: [(&dyn Constraint, Meetings, &dyn Force); 3] =
        [(&Contacts::HARD, Meetings::Through, &()), (&(), Meetings::IMPULSE, &()), (&(), Meetings::Through, &penalty)];
    let go = |(constraints, meetings, forces)| {
        let scene = Scene { start: &start, constraints, meetings, forces, index, reapers: &dense, ..Scene::EMPTY };
        let mut system = started(&scene, 200, 0);
        for _ in 0..5 {
            system.step(&scene, Time::frame(1, 60));
        }
        system.particles().position.to_vec()
    };
    kinds.into_iter().map(go).collect()
}

#[test]
fn rows_that_there_are_not_are_passed_over() {
    for is_room in [false, true] {
        assert!(states(true, is_room) == states(false, is_room), "in a room: {is_room}");
    }
}

/// A constraint that speaks of rows that there are not.
struct Mistaken;

impl Constraint for Mistaken {
    fn demand(&self) -> Demand {
        Demand { loads: true, postpones: true, ..Demand::NONE }
    }
    fn prepare(&self, bodies: &mut Bodies<'_>, _: &mut Share<'_>) {
        for row in [bodies.len(), usize::MAX] {
            bodies.bear(row);
            bodies.lay_on(row, 1.0, Vec3::X);
        }
    }
    fn project(&self, bodies: &mut Bodies<'_>, _: &mut Share<'_>) {
        for row in [bodies.len(), usize::MAX] {
            bodies.take_up(row);
            bodies.shift(row, Vec3::X);
            bodies.put_down(row);
            bodies.mark_touching(row);
            bodies.postpone(row, Vec3::X);
            assert_eq!([bodies.between(0, row), bodies.between(row, 0)], [Vec3::ZERO; 2]);
            assert_eq!(bodies.laden_inverse(row), 0.0);
        }
    }
}

#[test]
fn constraints_move_nobody_in_rows_that_there_are_not() {
    let start = [Particle { velocity: Vec3::X, ..Particle::REST }];
    let scene = Scene { start: &start, constraints: &Mistaken, ..Scene::EMPTY };
    let mut system = started(&scene, 1, 0);
    system.step(&scene, Time::SECOND);
    assert_eq!((system.len(), system.particles().position[0]), (1, Vec3::X));
}
