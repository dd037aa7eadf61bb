//! Balls so fast that they would pass each other between two steps.

use pointmass::{Contacts, Heap, Meetings, Particle, Scene, System, Time, Vec3};
use pointmass_tests::{Random, f64s, often};

const RADIUS: f32 = 0.01;

/// Two that pass each other within a step or do not, and how near they come if nothing is in the way \[m\].
fn pair(random: &mut Random, dt: f64) -> ([Particle; 2], f64) {
    let (aim, speed) = (random.direction(), random.magnitude(1.0, 10_000.0));
    let way = speed * dt as f32;
    // They would be nearest to each other somewhere on the way, or a little before or after.
    let ahead = way * random.between(-0.1, 1.1);
    let aside = aim.cross(random.direction()).normalize_or(aim.any_orthonormal_vector()) * random.between(0.0, 0.03);
    let middle = random.vector(1.0);
    let common = random.vector(10.0);
    let ball = |position: Vec3, velocity: Vec3, mass: f32| Particle {
        position,
        velocity,
        mass,
        radius: RADIUS,
        elasticity: 1.0,
        ..Particle::REST
    };
    let share = random.unit();
    let first = ball(middle - aim * ahead + aside, aim * (speed * share) + common, random.magnitude(0.1, 10.0));
    let second = ball(middle, aim * (speed * (share - 1.0)) + common, random.magnitude(0.1, 10.0));
    let between = |a: Vec3, b: Vec3| -> [f64; 3] { core::array::from_fn(|i| f64s(a)[i] - f64s(b)[i]) };
    let (x, v) = (between(first.position, second.position), between(first.velocity, second.velocity));
    let dot = |a: [f64; 3], b: [f64; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    let time = (-dot(x, v) / dot(v, v)).clamp(0.0, dt);
    let nearest: [f64; 3] = core::array::from_fn(|i| x[i] + v[i] * time);
    // Those that overlap from the beginning are none of ours.
    let apart = dot(x, x).sqrt() > 2.0 * f64::from(RADIUS) + 1e-3;
    ([first, second], if apart { dot(nearest, nearest).sqrt() } else { f64::NAN })
}

/// Counts how many of so many pairs met, and checks that none did that should have passed, and all that should not.
fn none_passes(touching: Scene<'_>, slack: f64, count: usize) -> usize {
    let mut random = Random::new(41);
    let dt = Time::frame(1, 60);
    let none = [Particle::REST; 2];
    let mut system = System::with(Heap::new(Scene { start: &none, ..touching }.size()));
    let mut met = 0;
    for i in 0..count {
        let (start, nearest) = pair(&mut random, dt.seconds_f64());
        let scene = Scene { start: &start, ..touching };
        system.start(&scene, 1).expect("room for two");
        let meetings = system.step(&scene, dt).contacts;
        let reach = 2.0 * f64::from(RADIUS);
        if nearest < reach - slack {
            assert!(meetings >= 1, "{i}: {start:?} come as near as {nearest}");
            let p = system.particles();
            let (x, v) = (p.position[0] - p.position[1], p.velocity[0] - p.velocity[1]);
            let bound = 1e-3 * v.length() * (x.length() + RADIUS);
            assert!(x.dot(v) > -bound, "{i}: {start:?} still close in");
            met += 1;
        } else if nearest > reach + slack {
            assert_eq!(meetings, 0, "{i}: {start:?} do not come nearer than {nearest}");
        }
    }
    met
}

#[test]
fn hard_balls_never_pass_through_each_other() {
    let count = often(1_000_000);
    // Rounding of places 200 m away.
    assert!(none_passes(Scene { meetings: Meetings::IMPULSE, ..Scene::EMPTY }, 2e-4, count) > count / 3);
}

#[test]
fn balls_held_by_position_never_pass_through_each_other() {
    let count = often(20_000);
    // Slow ones are held against each other at the ends of sub-steps alone, and may graze each other between them.
    let slack = 2e-4 + f64::from(RADIUS) / 16.0;
    let touching = Scene { substeps: 12, constraints: &Contacts::HARD, ..Scene::EMPTY };
    assert!(none_passes(touching, slack, count) > count / 3);
}

/// Where places are so coarse that paths seem curved by their rounding, none of their chords tells by itself that two come closer.
#[test]
fn slow_balls_far_from_the_origin_never_pass_through_each_other() {
    for far in [1e3_f32, 2e4, 6e4, 1e5, 3e5] {
        let spacing = f64::from(far.next_up() - far);
        for (rate, axis) in [(24.0, Vec3::X), (60.0, Vec3::Y), (240.0, Vec3::ONE / 3.0_f32.sqrt())] {
            for spacings in [1.2, 1.6, 2.5, 3.5, 4.27, 5.0, 8.0] {
                let speed = (spacings * spacing * rate) as f32;
                let ball = |ahead: f32, speed: f32| Particle {
                    position: axis * (far + ahead),
                    velocity: axis * speed,
                    radius: 0.25,
                    elasticity: 1.0,
                    ..Particle::REST
                };
                let start = [ball(0.0, speed), ball(1.0, -speed)];
                let scene = Scene { start: &start, meetings: Meetings::IMPULSE, ..Scene::EMPTY };
                let mut system = System::with(Heap::new(scene.size()));
                system.start(&scene, 1).expect("room for two");
                while system.time().seconds_f64() < 1.0 / f64::from(speed) + 3.0 / rate {
                    system.step(&scene, Time::from_seconds_f64(1.0 / rate));
                }
                let p = system.particles();
                let order = (p.position[1] - p.position[0]).dot(axis);
                assert!(order > 0.25, "{far} m off, {speed} m/s, {rate}/s along {axis}: {order}");
                assert!(
                    (p.velocity[1] - p.velocity[0]).dot(axis) > 0.0,
                    "{far} m off, {speed} m/s, {rate}/s along {axis}"
                );
            }
        }
    }
}
