//! The rims of a sheet that has lost particles are kept apart from others as those of a whole one are.

use super::cloths::{G, crosses};
use pointmass::constrain::SheetContacts;
use pointmass::{Gravity, Method, Particle, Scene, Time, Vec3};
use pointmass_tests::started;

/// Two triangles with a common edge that stand one over the other, of which the upper one loses its tip, and a third one that falls on that edge.
struct Torn {
    /// The numbers of the common edge's ends, of the tip, and of the lowest corner.
    numbers: [u32; 4],
    /// How far the corners of each triangle are turned, and whether the upper one comes first.
    turns: [usize; 2],
    upper_first: bool,
}

impl Torn {
    /// The triangle that is left, and those of all.
    fn triangles(&self) -> ([u32; 3], [[u32; 3]; 3]) {
        let [a, b, tip, low] = self.numbers;
        let turned = |mut corners: [u32; 3], by: usize| {
            corners.rotate_left(by);
            corners
        };
        let (upper, lower) = (turned([a, b, tip], self.turns[0]), turned([b, a, low], self.turns[1]));
        let [first, second] = if self.upper_first { [upper, lower] } else { [lower, upper] };
        (lower, [first, second, [4, 5, 6]])
    }

    /// Fails if what falls goes through the edge; `flat`: with its face, over the ends of that, else with an edge, across it.
    fn holds(&self, size: f32, flat: bool, method: Method, substeps: u32) {
        let mut start = [Particle { elasticity: 0.0, ..Particle::REST }; 7];
        let places = [Vec3::NEG_X, Vec3::X, Vec3::Y * 1.2, Vec3::NEG_Y * 1.5];
        for (&number, place) in self.numbers.iter().zip(places) {
            start[number as usize].position = place * size;
            start[number as usize].fixed = true;
        }
        start[self.numbers[2] as usize].lifetime = 0.02;
        let falling = if flat {
            [Vec3::new(-3.0, 2.0, -3.0), Vec3::new(3.0, 2.0, -3.0), Vec3::new(0.0, 2.0, 4.0)]
        } else {
            [Vec3::new(0.1, 2.0, -2.0), Vec3::new(0.1, 2.0, 2.0), Vec3::new(0.1, 4.0, 0.1)]
        };
        for (particle, place) in start[4..].iter_mut().zip(falling) {
            (particle.position, particle.velocity) = (place * size, Vec3::NEG_Y * (4.0 * size));
        }
        let (left, triangles) = self.triangles();
        let contacts = SheetContacts { particles: [0, 1, 2, 3, 4, 5, 6], triangles, thickness: [0.02 * size] };
        let scene = Scene {
            start: &start,
            forces: &Gravity { acceleration: Vec3::NEG_Y * (G * size) },
            constraints: &contacts,
            substeps,
            integrator: method.integrator(),
            ..Scene::EMPTY
        };
        let mut system = started(&scene, 7, 0);
        for frame in 1..=45 {
            system.step_to(&scene, Time::frame(frame, 60));
            let columns = system.particles();
            let place = |number: u32| columns.position[columns.row_of[number as usize] as usize];
            let edges = |[a, b, c]: [u32; 3]| [[a, b], [b, c], [c, a]].map(|edge| edge.map(place));
            let (one, other) = (left.map(place), [4, 5, 6].map(place));
            let through = edges(left).into_iter().filter(|&edge| crosses(edge, other)).count()
                + edges([4, 5, 6]).into_iter().filter(|&edge| crosses(edge, one)).count();
            let Self { numbers, turns, upper_first } = self;
            assert_eq!(
                through, 0,
                "{numbers:?}, {turns:?}, {upper_first}, flat {flat}, {size} m, {method}, {substeps}, frame {frame}"
            );
        }
        let report = *system.totals();
        assert!(report.died.lifetime == 1 && report.contacts > 0, "{report:?}");
    }
}

#[test]
fn torn_rims_are_kept_apart() {
    let cases =
        [(1.0, Method::Symplectic, 5), (0.1, Method::Verlet, 1), (10.0, Method::Rk4, 8), (1.0, Method::Midpoint, 2)];
    for (round, code) in (0..24).enumerate() {
        // All orders of four numbers.
        let mut left = vec![0, 1, 2, 3];
        let numbers = [code / 6, code / 2 % 3, code % 2, 0].map(|nth| left.remove(nth));
        let torn = Torn { numbers, turns: [round % 3, round / 3 % 3], upper_first: round % 2 == 0 };
        for (size, method, substeps) in cases {
            for flat in [false, true] {
                torn.holds(size, flat, method, substeps);
            }
        }
    }
}
