//! Whoever watches is told of sheets that come together, once, and of none that lie.

use super::cloths::{Cloths, G, cotton, square};
use pointmass::constrain::SheetContacts;
use pointmass::shape::Plane;
use pointmass::{Attention, Gravity, Impact, Method, Observer, Particle, Scene, Time, Vec3};
use pointmass_tests::started;

/// Keeps what it is told of.
#[derive(Default)]
struct Blows(Vec<Impact>);

impl Observer for Blows {
    fn attention(&self) -> Attention {
        Attention::Events
    }
    fn touched(&mut self, touch: &Impact) {
        self.0.push(*touch);
    }
}

#[test]
fn observers_are_told_of_sheets_that_come_together() {
    for (size, speed, substeps, method) in
        [(1.0f32, 2.0f32, 5u32, Method::Symplectic), (0.1, 0.5, 10, Method::Verlet), (10.0, 20.0, 4, Method::Rk4)]
    {
        let mut cloths = Cloths::default();
        let sides = |side: f32| [Vec3::X * (side * size), Vec3::Z * (side * size)];
        cloths.add(&square(Vec3::ZERO, sides(0.4), 5), cotton(size), |x| x, Vec3::ZERO);
        let first = cloths.start.len();
        let center = Vec3::new(0.013, 0.05, 0.021) * size;
        cloths.add(&square(center, sides(0.3), 4), cotton(size), |x| x, Vec3::NEG_Y * (speed * size));
        let constraints = (&cloths.shells[..], cloths.contacts(0.004 * size));
        let integrator = method.integrator();
        let scene = Scene { start: &cloths.start, constraints: &constraints, substeps, integrator, ..Scene::EMPTY };
        let mut system = started(&scene, cloths.start.len(), 0);
        let mut blind = started(&scene, cloths.start.len(), 0);
        let mut blows = Blows::default();
        for frame in 1..=20 {
            system.step_observed(&scene, Time::frame(frame, 60) - system.time(), &mut blows);
            blind.step_to(&scene, Time::frame(frame, 60));
        }
        assert_eq!(system.hash(), blind.hash(), "who looks on does not disturb");
        let name = format!("{size} m, {speed}, {method}");
        // A sheet that crumples comes together with itself as well.
        let row = |blow: &Impact| blow.other.and_then(|other| system.row(other));
        blows.0.retain(|blow| row(blow).is_some_and(|other| (other >= first) != (blow.row >= first)));
        assert!(!blows.0.is_empty(), "{name}");
        // What is told of the upper ones is told of as many below, which are pushed the other way.
        let [above, below]: [Vec<_>; 2] =
            [true, false].map(|above| blows.0.iter().filter(|blow| (blow.row >= first) == above).collect());
        assert_eq!(above.len(), below.len(), "{name}");
        for blow in &blows.0 {
            let up = if blow.row >= first { blow.normal.y } else { -blow.normal.y };
            // The first blows are those of sheets that are flat; later they crumple, and touch on edge.
            let is_first = blow.closing > 0.9 * speed * size;
            assert!(!is_first || up > 0.9, "{name}: {blow:?}");
            assert_eq!(blow.mass, cloths.start[blow.row].mass, "{name}");
            assert!(blow.closing > 0.0 && blow.closing < 1.5 * speed * size, "{name}: {blow:?}");
        }
        let fastest = blows.0.iter().map(|blow| blow.closing).fold(0.0, f32::max);
        assert!((fastest / (speed * size) - 1.0).abs() < 0.05, "{name}: {fastest}");
    }
}

/// A triangle that falls flat on a floor, and stays there: each corner is told of once.
#[test]
fn observers_are_told_once_of_what_lands_and_stays() {
    let corners = [Vec3::new(0.0, 0.3, 0.0), Vec3::new(0.1, 0.3, 0.0), Vec3::new(0.0, 0.3, 0.1)];
    let start = corners.map(|position| Particle { position, elasticity: 0.0, ..Particle::REST });
    let contacts = SheetContacts { particles: [0, 1, 2], triangles: [[0, 1, 2]], thickness: [0.01] };
    let floor = Plane { point: Vec3::ZERO, normal: Vec3::Y };
    for substeps in [1, 4, 10] {
        let scene = Scene {
            start: &start,
            forces: &Gravity { acceleration: Vec3::NEG_Y * G },
            colliders: &floor,
            constraints: &contacts,
            substeps,
            ..Scene::EMPTY
        };
        let (mut system, mut blows) = (started(&scene, 3, 0), Blows::default());
        for frame in 1..=60 {
            system.step_observed(&scene, Time::frame(frame, 60) - system.time(), &mut blows);
        }
        let rows: Vec<_> = blows.0.iter().map(|blow| blow.row).collect();
        assert_eq!(rows, [0, 1, 2], "{substeps} sub-steps: {:?}", blows.0);
        for blow in &blows.0 {
            let fall = (2.0 * G * 0.295f32).sqrt();
            assert!((blow.closing / fall - 1.0).abs() < 0.1 && blow.other.is_none(), "{blow:?}");
            assert!(blow.normal.y > 0.999 && blow.before.y < -0.9 * fall && blow.after.y.abs() < 0.1, "{blow:?}");
        }
    }
}

/// A sheet that falls flat on a floor, whichever way that looks, and stays there: each of its particles is told of once, with and without a thickness.
#[test]
fn observers_are_told_once_of_each_particle_of_a_sheet_that_lands() {
    let cases: [(f32, u32, Method, Vec3); 5] = [
        (1.0, 1, Method::Symplectic, Vec3::Y),
        (1.0, 5, Method::Verlet, Vec3::X),
        (0.1, 10, Method::Rk4, Vec3::new(0.6, 0.0, -0.8)),
        (10.0, 4, Method::Midpoint, Vec3::NEG_Y),
        (1.0, 10, Method::Implicit, Vec3::new(0.0, 0.8, 0.6)),
    ];
    for ((size, substeps, method, normal), thick) in cases.into_iter().flat_map(|case| [(case, false), (case, true)]) {
        let across = normal.any_orthonormal_vector();
        let mut cloths = Cloths::default();
        let sides = [across, normal.cross(across)].map(|side| side * (0.3 * size));
        cloths.add(&square(normal * (0.2 * size), sides, 4), cotton(size), |x| x, Vec3::ZERO);
        let thickness = 0.01 * size;
        let constraints = (&cloths.shells[..], thick.then(|| cloths.contacts(thickness)));
        let floor = Plane { point: Vec3::ZERO, normal };
        let scene = Scene {
            start: &cloths.start,
            forces: &Gravity { acceleration: normal * (-G * size) },
            colliders: &floor,
            constraints: &constraints,
            integrator: method.integrator(),
            substeps,
            ..Scene::EMPTY
        };
        let (mut system, mut blows) = (started(&scene, cloths.start.len(), 0), Blows::default());
        let mut blind = started(&scene, cloths.start.len(), 0);
        for frame in 1..=60 {
            system.step_observed(&scene, Time::frame(frame, 60) - system.time(), &mut blows);
            blind.step_to(&scene, Time::frame(frame, 60));
        }
        let name = format!("{size} m, {substeps}, {method}, {normal}, thick: {thick}");
        assert_eq!(system.hash(), blind.hash(), "{name}");
        let mut rows: Vec<_> = blows.0.iter().map(|blow| blow.row).collect();
        rows.sort_unstable();
        assert!(rows.iter().copied().eq(0..cloths.start.len()), "{name}: {rows:?}");
        let fall = (2.0 * G * (if thick { 0.195 } else { 0.2f32 })).sqrt() * size;
        for blow in &blows.0 {
            assert!((blow.closing / fall - 1.0).abs() < 0.1 && blow.other.is_none(), "{name}: {blow:?}");
            assert!(blow.normal.dot(normal) > 0.999 && blow.before.dot(normal) < -0.9 * fall, "{name}: {blow:?}");
            assert!(blow.after.length() < 0.1 * fall && blow.surface == Vec3::ZERO, "{name}: {blow:?}");
            assert_eq!(blow.mass, cloths.start[blow.row].mass, "{name}");
        }
    }
}

/// A thick sheet that slides over a floor into a wall: the floor's pressure in the same sub-step does not keep the wall's blow from being told, once.
#[test]
fn observers_are_told_of_a_wall_that_a_lying_sheet_slides_into() {
    for (size, substeps, method) in
        [(1.0f32, 5u32, Method::Symplectic), (0.1, 1, Method::Verlet), (10.0, 8, Method::Rk4)]
    {
        let (speed, thickness) = (2.0 * size, 0.01 * size);
        let mut cloths = Cloths::default();
        let sides = [Vec3::X, Vec3::Z].map(|side| side * (0.3 * size));
        let center = Vec3::Y * (0.5 * thickness);
        cloths.add(&square(center, sides, 4), cotton(size), |x| x, Vec3::X * speed);
        let constraints = (&cloths.shells[..], cloths.contacts(thickness));
        let floor = Plane { point: Vec3::ZERO, normal: Vec3::Y };
        let wall = Plane { point: Vec3::X * (0.4 * size), normal: Vec3::NEG_X };
        let scene = Scene {
            start: &cloths.start,
            forces: &Gravity { acceleration: Vec3::NEG_Y * (G * size) },
            colliders: &(floor, wall),
            constraints: &constraints,
            integrator: method.integrator(),
            substeps,
            ..Scene::EMPTY
        };
        let (mut system, mut blows) = (started(&scene, cloths.start.len(), 0), Blows::default());
        for frame in 1..=20 {
            system.step_observed(&scene, Time::frame(frame, 60) - system.time(), &mut blows);
        }
        let at_wall = blows.0.iter().filter(|blow| blow.normal.x < -0.99 && blow.closing > 0.9 * speed);
        let mut rows: Vec<_> = at_wall.map(|blow| blow.row).collect();
        rows.sort_unstable();
        // The row of particles that goes ahead.
        let front = |&row: &usize| cloths.start[row].position.x > 0.14 * size;
        let ahead: Vec<_> = (0..cloths.start.len()).filter(front).collect();
        assert_eq!(rows, ahead, "{size} m, {substeps}, {method}: {:?}", blows.0);
    }
}
