//! Where surfaces meet at an angle: what lies in the groove goes along that, as weight and friction say, and what is in a corner stays.

use pointmass::force::Friction;
use pointmass::shape::{Collider, Cuboid, Cylinder, Plane, Sphere};
use pointmass::{ContactMaterial, Gravity, Mat3, Meetings, Method, Particle, Report, Scene, Vec3};
use pointmass_tests::{Random, is_run, run, started};

const G: f32 = 9.80665;

/// A groove between two planes: how far each is from its middle \[rad\], what its bottom goes through, and its axes, across, up and along.
struct Groove {
    half: f32,
    home: Vec3,
    axes: [Vec3; 3],
}

impl Groove {
    fn walls(&self) -> [Plane; 2] {
        let [across, up, _] = self.axes;
        [1.0, -1.0]
            .map(|side| Plane { point: self.home, normal: across * (side * self.half.cos()) + up * self.half.sin() })
    }

    /// In the world, from a vector along its axes.
    fn in_world(&self, [x, y, z]: [f32; 3]) -> Vec3 {
        self.axes[0] * x + self.axes[1] * y + self.axes[2] * z
    }

    /// One that lies in it, with such a speed along it.
    fn lying(&self, radius: f32, elasticity: f32, speed: f32) -> Particle {
        // Off both by several roundings, on the side where it is to be.
        let beside = 8.0 * f32::EPSILON * (1.0 + self.home.abs().max_element());
        let position = self.home + self.axes[1] * ((radius + beside) / self.half.sin());
        Particle { position, velocity: self.axes[2] * speed, radius, elasticity, ..Particle::REST }
    }
}

/// Unit vectors that are perpendicular, turned at will.
fn axes(turn: [f32; 3]) -> [Vec3; 3] {
    let [x, y, z] = turn;
    let turn = Mat3::from_rotation_x(x) * Mat3::from_rotation_y(y);
    let turn = turn * Mat3::from_rotation_z(z);
    [turn.x_axis, turn.y_axis, turn.z_axis]
}

/// Where and how fast something is after steps until about an instant under a weight, and what was counted.
fn ends(
    start: Particle,
    walls: &dyn Collider,
    weight: Vec3,
    friction: f32,
    method: Method,
    times: [f64; 2],
) -> ([Vec3; 2], Report) {
    ends_meeting(Meetings::Through, start, walls, weight, friction, method, times)
}

/// The same where particles meet so: one alone meets nobody.
fn ends_meeting(
    meetings: Meetings,
    start: Particle,
    walls: &dyn Collider,
    weight: Vec3,
    friction: f32,
    method: Method,
    [h, end]: [f64; 2],
) -> ([Vec3; 2], Report) {
    let (start, forces) = ([Particle { material: Some(0), ..start }], Gravity { acceleration: weight });
    let friction = Friction { static_: 1.25 * friction, kinetic: friction };
    let materials = [ContactMaterial { elasticity: None, friction: Some(friction) }];
    let integrator = method.integrator();
    let scene = Scene {
        start: &start,
        forces: &forces,
        colliders: walls,
        materials: &materials,
        integrator: &integrator,
        meetings,
        ..Scene::EMPTY
    };
    let mut system = started(&scene, 1, 1);
    run(&mut system, &scene, h, (end / h).round() as u32);
    let all = system.particles();
    ([all.position[0], all.velocity[0]], *system.totals())
}

/// Whatever the angle between its sides, what lies in a groove goes along it as on a plane, pressed by both sides together, whichever way it leans; hits
/// do not run out.
#[test]
fn grooves_lead_down_by_coulomb_s_law() {
    let (mut cases, mut random) = (0, Random::new(3));
    for half in [0.1f32, 0.5, 0.78, 1.0] {
        for &method in Method::ALL {
            for h in [1.0 / 24.0, 1.0 / 60.0, 1.0 / 240.0] {
                for (radius, far, elasticity) in [(0.0, 0.0, 0.5), (0.0, 0.3, 0.5), (0.1, 3.0, 0.0), (0.0, 10.0, 0.8)] {
                    let turn = random.vector(3.0).to_array();
                    let [slope, lean, speed] =
                        [(0.1, 1.2), (-0.9, 0.9), (0.0, 2.0)].map(|(low, high)| random.between(low, high));
                    if !is_run(&mut cases) {
                        continue;
                    }
                    let groove = Groove { half, home: axes(turn)[1] * far, axes: axes(turn) };
                    // It may lean until one side alone bears it.
                    let lean = slope.cos() * (lean / half.tan()).atan().sin();
                    let weight = [lean, -(slope.cos().powi(2) - lean * lean).sqrt(), slope.sin()].map(|x| x * G);
                    // Both sides press by what is across them; along them friction answers the sum.
                    let pressing = weight[1].abs() / half.sin();
                    for share in [0.0, 0.5, 2.0] {
                        let friction = share * weight[2] / pressing;
                        let start = groove.lying(radius, elasticity, speed);
                        let walls = groove.walls();
                        let ([x, v], report) = ends(start, &walls, groove.in_world(weight), friction, method, [h, 0.5]);
                        let rate = weight[2] * (1.0 - share);
                        let time = if rate < 0.0 { f32::min(0.5, speed / -rate) } else { 0.5 };
                        let (way, fast) = (speed * time + 0.5 * rate * time * time, speed + rate * time);
                        let case = format!(
                            "{half} rad, {method:?} by {h}, {radius} m at {far}, {elasticity}, {slope}, {lean}, {share}"
                        );
                        let [off_way, off_fast] =
                            [x - start.position - groove.axes[2] * way, v - groove.axes[2] * fast].map(Vec3::length);
                        // What bounces from side to side at first is braked a little less. From the origin on rounding grows with each
                        // bit of the way, and some of the first step is lost.
                        let part = if share > 0.0 { 0.03 } else { 0.01 };
                        let part = if far == 0.0 { part + rate.abs().max(1.0) * h as f32 } else { part };
                        let first = 2.0 * (rate.abs() + speed) * h as f32;
                        assert!(
                            off_fast < part * (speed + rate.abs() * 0.5) + first * 0.1,
                            "{case}: {off_fast} m/s off {fast}"
                        );
                        assert!(off_way < part * way + 0.5 * first * 0.5 + 1e-4, "{case}: {off_way} m off {way}");
                        // Who has just fallen into a narrow one bounces from side to side more often than a step allows, at the origin longer.
                        let is_narrow = half < 0.2 && elasticity > 0.0;
                        let most = u64::from(is_narrow) * if far == 0.0 { u64::MAX } else { 1 };
                        assert!(report.caps.bounces <= most, "{case}: {}", report.hits);
                    }
                }
            }
        }
    }
}

/// A corner holds what is pressed into it where it is; who is pressed out of it goes.
#[test]
fn corners_hold_what_is_pressed_into_them() {
    let (mut cases, mut random) = (0, Random::new(4));
    for &method in Method::ALL {
        for h in [1.0 / 24.0, 1.0 / 60.0, 1.0 / 240.0] {
            for (radius, far, elasticity) in [(0.0, 0.0, 0.5), (0.1, 3.0, 0.0), (0.0, 10.0, 0.9)] {
                let ([out, into], turn) =
                    ([(); 2].map(|()| random.vector(1.0).abs() + 0.05), random.vector(3.0).to_array());
                if !is_run(&mut cases) {
                    continue;
                }
                let axes = axes(turn);
                let home = axes[1] * far;
                let in_world = |v: Vec3| axes[0] * v.x + axes[1] * v.y + axes[2] * v.z;
                let walls = axes.map(|normal| Plane { point: home, normal });
                let start =
                    Particle { position: home + in_world(Vec3::splat(radius)), radius, elasticity, ..Particle::REST };
                let case = format!("{method:?} by {h}, {radius} m at {far}, {elasticity}, {into}");
                let ([x, v], report) = ends(start, &walls, in_world(into * -G), 0.0, method, [h, 1.0]);
                let room = 64.0 * f32::EPSILON * (1.0 + far);
                assert!((x - start.position).length() < room, "{case}: {}", x - start.position);
                assert!(v == Vec3::ZERO || v.length() < room / h as f32, "{case}: {v}");
                assert_eq!(report.caps.bounces, 0, "{case}");
                let ([x, _], _) = ends(start, &walls, in_world(out * G), 0.0, method, [h, 1.0]);
                let way = in_world(out) * (0.5 * G);
                assert!((x - start.position - way).length() < 0.01 + 2.0 * way.length() * h as f32, "{case}: {x}");
            }
        }
    }
}

/// In a valley nobody is held who goes on up the other side: of a slide without bounces that loses what leads into that.
#[test]
fn valleys_let_pass_who_is_fast() {
    let mut cases = 0;
    for half in [1.1f32, 1.2, 1.4] {
        for &method in Method::ALL {
            for h in [1.0 / 60.0, 1.0 / 240.0] {
                for (radius, far) in [(0.0, 0.0), (0.1, 30.0)] {
                    if !is_run(&mut cases) {
                        continue;
                    }
                    let groove = Groove { half, home: Vec3::X * far, axes: axes([0.3, 0.5, 0.7]) };
                    let high = 0.3;
                    let bottom = groove.lying(radius, 0.0, 0.0);
                    let up = groove.in_world([half.sin(), half.cos(), 0.0]);
                    let start = Particle { position: bottom.position + up * (high / half.cos()), ..bottom };
                    // Down one side, and half as long up the other.
                    let down = (2.0 * high / G).sqrt() / half.cos();
                    let turned = -(2.0 * half).cos();
                    let end = f64::from(down) * (1.0 + 0.5 * f64::from(turned));
                    let walls = groove.walls();
                    let weight = groove.in_world([0.0, -G, 0.0]);
                    let ([x, v], _) = ends(start, &walls, weight, 0.0, method, [h, end]);
                    let energy = 0.5 * v.length_squared() - weight.dot(x - bottom.position);
                    let left = energy / (G * high);
                    let expected = turned * turned;
                    assert!(
                        (left - expected).abs() < 0.02 + 4.0 * h as f32,
                        "{half} {method:?} {h} {radius}: {left} of {expected}"
                    );
                }
            }
        }
    }
}

/// A groove that curves holds what lies in it too: between a ball and the ground, and along the edges of a box.
#[test]
fn grooves_may_be_anywhere() {
    for elasticity in [0.0, 0.5, 0.9] {
        let ball = Sphere { center: Vec3::Y * 0.5, radius: 1.0 };
        let wall = Plane { point: Vec3::X * 1.05, normal: Vec3::NEG_X };
        // Between a ball and a wall that hardly misses it, above the place where they are closest.
        let start = Particle { position: Vec3::new(1.02, 1.0, 0.0), elasticity, ..Particle::REST };
        let ([x, _], report) = ends(start, &(ball, wall), Vec3::new(0.5, -G, 0.0), 0.0, Method::Rk4, [1.0 / 60.0, 0.5]);
        assert!(x.is_finite() && report.caps.bounces == 0, "{elasticity}: {x} after {} hits", report.hits);
        let chest = Cuboid { min: Vec3::splat(-1.0), max: Vec3::splat(1.0) };
        let start = Particle { position: Vec3::new(-0.9, -0.999_99, -0.999_99), elasticity, ..Particle::REST };
        let weight = Vec3::new(1.0, -5.0, -5.0);
        let ([x, v], report) = ends(start, &chest, weight, 0.0, Method::Rk4, [1.0 / 60.0, 1.0]);
        assert!((x.x - -0.4).abs() < 1e-3 && (v.x - 1.0).abs() < 1e-3, "{elasticity}: {x} {v}");
        assert_eq!(report.caps.bounces, 0, "{elasticity}");
    }
}

/// A fall into a groove without friction takes nothing of the way along that, however narrow it is, and whatever bounces on the way.
#[test]
fn falling_into_a_groove_takes_no_way_along_it() {
    let (mut cases, mut random) = (0, Random::new(5));
    for half in [0.03f32, 0.1, 0.4, 0.7, 0.8, 1.0] {
        for &method in Method::ALL {
            for (radius, far, high) in [(0.0, 0.0, 1e-3), (0.0, 3.0, 0.1), (0.05, 0.0, 0.1), (0.05, 3.0, 1e-3)] {
                let (turn, aside) = (random.vector(3.0).to_array(), random.between(0.0, 0.5));
                let elasticity = [0.0, 0.3, 0.6][cases % 3];
                if !is_run(&mut cases) {
                    continue;
                }
                let groove = Groove { half, home: axes(turn)[1] * far, axes: axes(turn) };
                let weight = groove.in_world([0.3, -9.0, 3.0]);
                let start = groove.lying(radius, elasticity, 0.0);
                let velocity = groove.in_world([aside, 0.0, 1.0]);
                let start = Particle { position: start.position + groove.axes[1] * high, velocity, ..start };
                let h = if cases % 2 == 0 { 1.0 / 60.0 } else { 1.0 / 200.0 };
                let meetings = if cases % 4 < 2 { Meetings::Through } else { Meetings::IMPULSE };
                let walls = groove.walls();
                let ([x, v], _) = ends_meeting(meetings, start, &walls, weight, 0.0, method, [h, 1.0]);
                let [way, fast] = [x - start.position, v].map(|x| x.dot(groove.axes[2]));
                let case = format!("{half} rad, {method:?} by {h}, {radius} m at {far}, {elasticity}, from {high}");
                // Methods of first order are off by half a step's fall, and of the steps in which it comes to lie some milliseconds may be lost.
                let room = 0.02 + 1.5 * h as f32;
                assert!((way - 2.5).abs() < room && (fast - 4.0).abs() < 0.03, "{case}: {way} m, {fast} m/s");
            }
        }
    }
}

/// A wall at the end of a groove stops who slides along that, and lets go who is driven back.
#[test]
fn walls_at_the_end_of_a_groove_stop() {
    let mut cases = 0;
    for (size, far) in [(0.01f32, 0.0f32), (1.0, 0.0), (1.0, 3.0), (100.0, 30.0)] {
        for &method in Method::ALL {
            for (share, elasticity) in [(0.0, 0.0), (0.1, 0.0), (0.0, 0.5), (0.1, 0.8)] {
                if !is_run(&mut cases) {
                    continue;
                }
                let (min, radius) = (Vec3::splat(far), share * size);
                let chest = Cuboid { min, max: min + Vec3::splat(size) };
                let beside = 5.0 * f32::EPSILON * (size + far);
                let fast = (size * 9.8).sqrt() * 0.3;
                let z = far + 0.8 * size - radius;
                let position = Vec3::new(far + radius + beside, far + radius + beside, z);
                let velocity = Vec3::Z * fast;
                let start = Particle { position, velocity, radius, elasticity, ..Particle::REST };
                let end = f64::from(0.4 * size / fast);
                let weight = Vec3::new(-3.0, -9.8, 0.0);
                let ([x, v], report) = ends(start, &chest, weight, 0.0, method, [end / 40.0, end]);
                let case = format!("{size} m at {far}, {radius}, {elasticity}, {method:?}");
                assert!((v.z + elasticity * fast).abs() < 0.01 * fast, "{case}: {v} of {fast}");
                let back = far + size - radius - elasticity * 0.2 * size;
                assert!((x.z - back).abs() < 0.02 * size, "{case}: {x} for {back}");
                assert_eq!(report.caps.bounces, 0, "{case}");
            }
        }
    }
}

/// A ball that overlaps the walls of a groove is not thrown out of it.
#[test]
fn who_overlaps_gains_nothing() {
    for half in [0.1f32, 0.35, 0.7] {
        for overlap in [1e-4f32, 1e-3, 1e-2] {
            let groove = Groove { half, home: Vec3::ZERO, axes: [Vec3::X, Vec3::Y, Vec3::Z] };
            let start = groove.lying(0.03, 0.3, 0.2);
            let position = start.position - Vec3::Y * (overlap / half.sin()) + Vec3::X * (0.5 * overlap / half.cos());
            let start = Particle { position, ..start };
            let weight = Vec3::NEG_Y * G;
            let ([x, v], _) = ends(start, &groove.walls(), weight, 0.0, Method::Rk4, [1.0 / 60.0, 0.2]);
            let gain = 0.5 * (v.length_squared() - 0.04) + G * (x.y - position.y);
            assert!(gain < 1e-3 * overlap + 1e-5, "{half} rad, {overlap} m: {gain} J/kg, {x}");
        }
    }
}

/// Round a ring-shaped groove, at the foot of a cylinder's wall, it goes as far as its speed says.
#[test]
fn rings_lead_round() {
    let walls = Cylinder { center: Vec3::Y * 0.1, radius: 0.1, height: 0.2 };
    for (radius, elasticity) in [(0.0, 0.0), (0.0, 0.5), (0.01, 0.5), (0.01, 0.9)] {
        for h in [1.0 / 60.0, 1.0 / 240.0] {
            let (reach, speed) = (0.1 - radius, 0.3);
            let position = Vec3::new(reach - 2e-7, radius + 2e-7, 0.0);
            let start = Particle { position, velocity: Vec3::Z * speed, radius, elasticity, ..Particle::REST };
            for meetings in [Meetings::Through, Meetings::IMPULSE] {
                let weight = Vec3::NEG_Y * G;
                let ([x, v], _) = ends_meeting(meetings, start, &walls, weight, 0.0, Method::Rk4, [h, 0.5]);
                let way = x.z.atan2(x.x) * reach;
                let case = format!("{radius} {elasticity} {h} {meetings:?}");
                assert!((way / (0.5 * speed) - 1.0).abs() < 0.02, "{case}: {way}");
                assert!((v.length() / speed - 1.0).abs() < 0.02, "{case}: {v}");
            }
        }
    }
}
