//! Whoever watches is told of balls that come to touch by force, once a meeting, and of none that lie.

use pointmass::force::{Friction, Needs, State, Telling, Watched};
use pointmass::index::{IndexChoice, Periodic, Room, Structure};
use pointmass::integrate::Integrator;
use pointmass::shape::{Collider, Cuboid};
use pointmass::{
    Attention, Emitter, Force, Gravity, Id, Impact, Method, Observer, Particle, Penalty, Phase, Scene, Time, Varied,
    Vec3,
};
use pointmass_tests::{Random, every, is_third, point, started};
use std::ops::Range;

/// Keeps what it is told of.
#[derive(Default)]
struct Touches(Vec<Impact>);

impl Observer for Touches {
    fn attention(&self) -> Attention {
        Attention::Events
    }
    fn touched(&mut self, touch: &Impact) {
        self.0.push(*touch);
    }
}

/// Finds out for itself who comes to touch whom: it looks at all pairs at the end of each sub-step.
#[derive(Default)]
struct Looks {
    substeps: u32,
    last: Vec<[Vec3; 2]>,
    found: Vec<(Id, Id, f32)>,
    told: Vec<Impact>,
}

impl Observer for Looks {
    fn touched(&mut self, touch: &Impact) {
        self.told.push(*touch);
    }
    fn after(&mut self, phase: Phase, state: &State<'_>) {
        if !matches!(phase, Phase::Begin | Phase::Collide) {
            return;
        }
        let now: Vec<_> = state.position.iter().zip(state.velocity).map(|(&x, &v)| [x, v]).collect();
        for (row, other) in (0..now.len()).flat_map(|row| (row + 1..now.len()).map(move |other| (row, other))) {
            if phase == Phase::Begin {
                break;
            }
            let before = state.near.room().map_or(self.last[row][0] - self.last[other][0], |room| {
                let far = self.last[row][0] - self.last[other][0];
                let size = room.sides();
                far - size * (far / size).round()
            });
            let (apart, reach) = (state.between(other, row), state.radius[row] + state.radius[other]);
            let normal = apart.normalize();
            let parting = |all: &[[Vec3; 2]]| (all[row][1] - all[other][1]).dot(normal);
            let [begun, ended] = [parting(&self.last), parting(&now)];
            let (closing, pressed) = ((-begun).max(-ended), (begun - ended).max(0.0));
            if apart.length() < reach && before.length() >= reach && closing > self.substeps as f32 * pressed {
                self.found.push((state.id(row).expect("a row"), state.id(other).expect("a row"), closing));
            }
        }
        self.last = now;
    }
}

const PENALTY: Penalty =
    Penalty { stiffness: 4000.0, damping: 0.05, friction: Friction { static_: 0.3, kinetic: 0.3 }, reach: 0.3 };

/// Balls that fly through a cube of 2 m.
fn gas(seed: u64, count: usize) -> Vec<Particle> {
    let mut random = Random::new(seed);
    let place = |i: usize| Vec3::new((i % 5) as f32, (i / 5 % 5) as f32, (i / 25) as f32) * 0.38 - 0.76;
    (0..count)
        .map(|i| Particle {
            position: place(i) + random.vector(0.03),
            velocity: random.vector(3.0),
            radius: random.between(0.08, 0.15),
            mass: random.magnitude(0.5, 2.0),
            elasticity: 1.0,
            fixed: i == 7,
            ..Particle::REST
        })
        .collect()
}

/// What is told of balls that fly about in two seconds of sixty frames.
fn told(start: &[Particle], around: (&dyn Collider, &dyn IndexChoice), method: Method, substeps: u32) -> Vec<Impact> {
    let (colliders, index) = around;
    let integrator = method.integrator();
    let scene = Scene { start, forces: &PENALTY, colliders, index, substeps, integrator, ..Scene::EMPTY };
    let [mut system, mut looked, mut blind] = [(); 3].map(|()| started(&scene, start.len(), 0));
    let (mut touches, mut looks) = (Touches::default(), Looks { substeps, ..Looks::default() });
    for frame in 1..=120 {
        let dt = Time::frame(frame, 60) - system.time();
        let report = system.step_observed(&scene, dt, &mut touches);
        looked.step_observed(&scene, dt, &mut looks);
        assert_eq!(report, blind.step(&scene, dt), "{method}, {substeps}");
    }
    let hash = blind.hash();
    assert_eq!([system.hash(), looked.hash()], [hash; 2], "who looks on does not disturb: {method}, {substeps}");
    assert_eq!(touches.0, looks.told);
    // Forces hardly differ in the whole, and so little counts for no rest.
    let clear = |closing: f32| closing > 1e-3;
    let fixed = |id: Id| start[id.serial() as usize].fixed;
    let mut want = Vec::new();
    for &(row, other, _) in looks.found.iter().filter(|found| clear(found.2)) {
        want.extend([(row, Some(other)), (other, Some(row))].into_iter().filter(|pair| !fixed(pair.0)));
    }
    let have: Vec<_> =
        touches.0.iter().filter(|touch| clear(touch.closing)).map(|touch| (touch.id, touch.other)).collect();
    assert_eq!(have, want, "{method}, {substeps}");
    touches.0
}

const METHODS: [Method; 5] = [Method::Symplectic, Method::Verlet, Method::Midpoint, Method::Rk4, Method::Implicit];

#[test]
fn observers_are_told_of_each_meeting_by_force_once_whatever_finds_it() {
    let walls = Cuboid { min: Vec3::splat(-1.0), max: Vec3::ONE };
    let mut cases = 0;
    for (seed, (method, substeps)) in METHODS.into_iter().zip([1, 4, 2, 3, 5]).enumerate().step_by(every(2)) {
        let start = gas(seed as u64, 60);
        let want = told(&start, (&walls, &()), method, substeps);
        assert!(want.len() > 60, "{method}: {}", want.len());
        for touch in &want {
            let (row, radius) = (touch.row, start[touch.id.serial() as usize].radius);
            assert!(touch.place.abs().max_element() <= 1.0 && radius > 0.0 && row < 60, "{touch:?}");
            let other = touch.other.expect("a ball");
            let twins = want.iter().filter(|twin| (twin.id, twin.other) == (other, Some(touch.id)));
            let twins: Vec<_> = twins.filter(|twin| twin.time == touch.time).collect();
            assert_eq!(twins.len(), usize::from(!start[other.serial() as usize].fixed));
            assert!(twins.iter().all(|twin| twin.normal == -touch.normal && twin.closing == touch.closing));
        }
        for structure in Structure::ALL.iter().filter(|_| is_third(&mut cases)) {
            assert_eq!(told(&start, (&walls, structure), method, substeps), want, "{method}, {structure}");
        }
    }
}

#[test]
fn they_are_told_of_meetings_through_the_sides_of_a_room() {
    let start = gas(9, 60);
    let room = Room::new(Vec3::splat(-1.0), Vec3::ONE);
    let want = told(&start, (&(), &Periodic { room, index: () }), Method::Verlet, 2);
    let far = |touch: &&Impact| {
        let other = want.iter().find(|twin| (twin.id, twin.time) == (touch.other.expect("a ball"), touch.time));
        other.is_some_and(|other| other.place.distance(touch.place) > 1.0)
    };
    assert!(want.iter().filter(far).count() > 10);
    for structure in Structure::ALL.iter().step_by(every(3)) {
        assert_eq!(told(&start, (&(), &Periodic { room, index: *structure }), Method::Verlet, 2), want, "{structure}");
    }
}

#[test]
fn who_bounces_twice_is_told_of_twice() {
    let start = [
        Particle { radius: 0.2, fixed: true, ..Particle::REST },
        Particle { position: Vec3::Y * 1.4, radius: 0.2, ..Particle::REST },
    ];
    let bouncy = Penalty { stiffness: 1e5, reach: 0.4, ..Penalty::NONE };
    for method in [Method::Symplectic, Method::Verlet, Method::Midpoint, Method::Rk4, Method::Embedded] {
        for (rate, substeps) in [(60, 20), (240, 4), (600, 1), (1000, 2)] {
            let scene = Scene {
                start: &start,
                forces: &(Gravity::EARTH, bouncy),
                integrator: method.integrator(),
                substeps,
                ..Scene::EMPTY
            };
            let (mut system, mut touches) = (started(&scene, 2, 0), Touches::default());
            // It falls for 0.452 s, and comes down again every 0.903 s.
            while system.time() < Time::from_seconds(1.8) {
                system.step_observed(&scene, Time::frame(1, rate), &mut touches);
            }
            let name = format!("{method}, {rate} Hz, {substeps} sub-steps: {:?}", touches.0);
            assert_eq!(touches.0.len(), 2, "{name}");
            let fall = (2.0f32 * 9.80665).sqrt();
            for touch in &touches.0 {
                assert!((touch.closing / fall - 1.0).abs() < 0.05 && touch.normal == Vec3::Y, "{name}");
                assert!(touch.before.y < -0.9 * fall && touch.after.y > touch.before.y - 0.2, "{name}");
                assert_eq!((touch.row, touch.other, touch.mass), (1, system.id(0), 1.0), "{name}");
            }
        }
    }
}

#[test]
fn nobody_is_told_of_who_rests_in_a_heap() {
    // Without friction a heap comes to rest where nobody can go lower; with a dashpot's for friction it creeps, and one may fall at any time.
    let heap = Penalty { stiffness: 5e3, damping: 0.5, friction: Friction::NONE, ..PENALTY };
    let walls = Cuboid { min: Vec3::splat(-0.4), max: Vec3::new(0.4, 5.0, 0.4) };
    let cases = [
        (Method::Symplectic, 60, 8),
        (Method::Verlet, 60, 20),
        (Method::Implicit, 240, 2),
        (Method::Rk4, 120, 4),
        (Method::Midpoint, 500, 1),
    ];
    for (method, rate, substeps) in cases.into_iter().step_by(every(3)) {
        let mut start = gas(3, 75);
        start.iter_mut().for_each(|ball| (ball.velocity, ball.elasticity) = (ball.velocity * 0.2, 0.2));
        start.iter_mut().for_each(|ball| ball.position = ball.position * Vec3::new(0.3, 1.0, 0.3) + Vec3::Y * 0.5);
        let scene = Scene {
            start: &start,
            forces: &(Gravity::EARTH, heap),
            colliders: &walls,
            integrator: method.integrator(),
            index: &Structure::Grid,
            substeps,
            ..Scene::EMPTY
        };
        let (mut system, mut falling, mut resting) =
            (started(&scene, start.len(), 0), Touches::default(), Touches::default());
        for step in 0..10 * rate {
            let touches = if step < 8 * rate { &mut falling } else { &mut resting };
            system.step_observed(&scene, Time::frame(1, rate), touches);
        }
        assert!(falling.0.len() > 100, "{method}: {}", falling.0.len());
        assert!(resting.0.is_empty(), "{method}: {} {:?}", resting.0.len(), resting.0[0]);
    }
}

/// Pushes all off the plane y = 0, each by itself.
struct Floor;

impl Floor {
    fn overlap(state: &State<'_>, row: usize) -> f32 {
        state.radius[row] - state.position[row].y
    }
}

impl Force for Floor {
    fn add_to(&self, state: &State<'_>, rows: Range<usize>, total: &mut [Vec3]) {
        for (row, total) in rows.zip(total) {
            total.y += 1e4 * Self::overlap(state, row).max(0.0);
        }
    }
    fn is_local(&self) -> bool {
        true
    }
    fn needs(&self) -> Needs {
        Needs { tell: Some(Telling::TOUCHES), ..Needs::default() }
    }
    fn tell(&self, watched: &mut Watched<'_>) {
        let Watched { before, now, .. } = *watched;
        for row in 0..now.position.len() {
            if Self::overlap(&now, row) > 0.0 && Self::overlap(&before, row) <= 0.0 {
                let [before, after] = [before.velocity[row], now.velocity[row]];
                watched.tell(&Impact {
                    id: now.id(row).expect("a row"),
                    row,
                    other: None,
                    mass: now.mass[row],
                    place: now.position[row],
                    normal: Vec3::Y,
                    closing: -before.y,
                    before,
                    after,
                    surface: Vec3::ZERO,
                    time: now.time,
                });
            }
        }
    }
}

#[test]
fn a_force_of_ones_own_tells_too() {
    let ball = |i| Particle { position: Vec3::Y * (0.5 + i as f32 * 1e-4), radius: 0.1, ..Particle::REST };
    let start: Vec<_> = (0..3000).map(ball).collect();
    for (substeps, integrator) in [(1, Method::Symplectic.integrator()), (4, Method::Rk4.integrator())] {
        let integrator: &dyn Integrator = integrator;
        let scene = Scene { start: &start, forces: &(Gravity::EARTH, Floor), substeps, integrator, ..Scene::EMPTY };
        let [mut system, mut blind] = [(); 2].map(|()| started(&scene, start.len(), 0));
        let mut touches = Touches::default();
        for _ in 0..240 {
            system.step_observed(&scene, Time::frame(1, 600), &mut touches);
            blind.step(&scene, Time::frame(1, 600));
        }
        assert_eq!(system.hash(), blind.hash());
        // Those who have fallen far enough in 0.4 s.
        let fallen = start.iter().filter(|ball| ball.position.y - 0.1 < 0.5 * 9.80665 * 0.16).count();
        assert!(touches.0.len().abs_diff(fallen) < 10, "{} of {fallen}", touches.0.len());
        assert!(touches.0.iter().all(|touch| touch.closing > 2.5 && touch.other.is_none()));
    }
}

#[test]
fn who_is_still_to_be_born_touches_nobody() {
    // A ball rolls over the source before anybody is born there, in a step of many parts.
    let start = [Particle { position: Vec3::NEG_X * 0.5, velocity: Vec3::X * 10.0, radius: 0.1, ..Particle::REST }];
    let radius = Varied::exactly(0.1);
    let emitter = Emitter { radius, ..Emitter::new(point(Vec3::ZERO), 1.5) };
    let scene = Scene { start: &start, emitters: &emitter, forces: &PENALTY, substeps: 50, ..Scene::EMPTY };
    let (mut system, mut touches) = (started(&scene, 2, 0), Touches::default());
    let report = system.step_observed(&scene, Time::from_seconds(1.0), &mut touches);
    assert_eq!((report.born, touches.0.len()), (1, 0), "{:?}", touches.0);
}
