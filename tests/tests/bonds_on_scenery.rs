//! Ropes, strands and chains of links on scenery: it drives, brakes and bears them as it does their particles by themselves.

use pointmass::constrain::{Distance, Rope};
use pointmass::force::Friction;
use pointmass::shape::{Plane, Sphere};
use pointmass::{
    Constraint, ContactMaterial, Gravity, Method, Particle, Paths, Scene, StrandParams, Strands, Time, Vec3,
};
use pointmass_tests::{methods, started};

/// Particles in a row, and what binds them.
fn bonds(count: u32, length: f32) -> [(&'static str, Box<dyn Constraint>); 6] {
    let all: Vec<u32> = (0..count).collect();
    let soft = Rope { compliance: 1e-6, ..Rope::rigid(all.clone(), [length]) };
    let rods: Vec<_> = (1..count).map(|i| Distance::rod([i - 1, i], length)).collect();
    let params = StrandParams { stretch: None, bending: [1e-6; 2], twisting: 1e-6, damping: 0.0 };
    [
        ("rope", Box::new(Rope::rigid(all.clone(), [length]))),
        ("string", Box::new(Rope::string(all.clone(), [length]))),
        ("soft rope", Box::new(soft)),
        ("distances", Box::new(rods)),
        ("stiff strand", Box::new(Strands::of(all.clone(), vec![count], params))),
        ("strand", Box::new(Strands::of(all, vec![count], StrandParams { stretch: Some(1e3), ..params }))),
    ]
}

/// A slope, how rough and how elastic it is, how what lies on it begins [m/s], and in what sub-steps.
#[derive(Clone, Copy, Debug)]
struct Slope {
    degrees: f32,
    friction: f32,
    elasticity: f32,
    speed: f32,
    substeps: u32,
    /// Sub-steps take so many times as many a second, and lengths are so many times as large.
    rate: u32,
    size: f32,
    /// The way through which all go in a sub-step.
    paths: Paths,
}

const SLOPE: Slope = Slope {
    degrees: 30.0,
    friction: 0.0,
    elasticity: 0.0,
    speed: 0.0,
    substeps: 4,
    rate: 60,
    size: 1.0,
    paths: Paths::CURVED,
};

impl Slope {
    /// How fast who lies on it goes down it after half a second, in sizes a second, at the least and the most of all; and what a block does.
    fn slid(&self, method: Method, bond: &dyn Constraint, count: u32, length: f32) -> ([f32; 2], f32) {
        let Self { degrees, friction, elasticity, speed, substeps, rate, size, paths } = *self;
        let (sin, cos) = degrees.to_radians().sin_cos();
        let (up, down) = (Vec3::new(sin, cos, 0.0), Vec3::new(cos, -sin, 0.0));
        let place = |i: u32| down * (i as f32 * length) + up * (1e-4 * size);
        let part =
            Particle { mass: 0.01, elasticity, material: Some(0), velocity: down * (speed * size), ..Particle::REST };
        let start: Vec<_> = (0..count).map(|i| Particle { position: place(i), ..part }).collect();
        let friction = Friction { static_: friction, kinetic: friction };
        let scene = Scene {
            start: &start,
            forces: &Gravity { acceleration: Vec3::NEG_Y * (9.81 * size) },
            colliders: &Plane { point: Vec3::ZERO, normal: up },
            materials: &[ContactMaterial { elasticity: None, friction: Some(friction) }],
            constraints: bond,
            substeps,
            integrator: method.integrator(),
            paths,
            ..Scene::EMPTY
        };
        let mut system = started(&scene, start.len(), 0);
        for frame in 1..=u64::from(rate / 2) {
            system.step_to(&scene, Time::frame(frame, rate));
        }
        let fast = system.particles().velocity.iter().map(|v| v.dot(down) / size);
        let [least, most] = fast.fold([f32::INFINITY, f32::NEG_INFINITY], |[a, b], v| [a.min(v), b.max(v)]);
        ([least, most], (speed + 0.5 * 9.81 * (sin - friction.kinetic * cos)).max(0.0))
    }
}

/// Whatever method, bond, friction, elasticity, steps and size: what hangs together slides as a block does.
#[test]
fn what_hangs_together_slides_as_a_block_does() {
    let slopes = [
        SLOPE,
        Slope { elasticity: 0.5, substeps: 1, ..SLOPE },
        Slope { elasticity: 1.0, ..SLOPE },
        Slope { friction: 0.3, substeps: 10, ..SLOPE },
        Slope { friction: 0.8, ..SLOPE },
        Slope { degrees: 0.0, friction: 0.5, speed: 4.0, ..SLOPE },
        Slope { degrees: 60.0, friction: 0.2, rate: 240, substeps: 1, ..SLOPE },
        Slope { degrees: 10.0, rate: 24, substeps: 20, size: 30.0, ..SLOPE },
        Slope { degrees: 20.0, friction: 0.1, size: 0.02, ..SLOPE },
        Slope { friction: 0.2, paths: Paths::STRAIGHT, ..SLOPE },
    ];
    for (slope, method) in
        slopes.into_iter().enumerate().flat_map(|(i, slope)| methods(i).map(move |method| (slope, method)))
    {
        let (count, length) = (8, 0.1 * slope.size);
        for (name, bond) in bonds(count, length) {
            let ([least, most], block) = slope.slid(method, &*bond, count, length);
            // It comes down onto the slope first, and a method of first order counts a sub-step more or less.
            let step = 9.81 / (slope.rate * slope.substeps) as f32;
            let off = 0.02 * block.max(0.5) + 2.0 * step;
            let is_right = (least - block).abs() < off && (most - block).abs() < off;
            assert!(is_right, "{method}, {name}, {slope:?}: {least} to {most}, a block {block}");
        }
    }
}

/// A level rod that drops onto a plane, elastic or not: hits neither give it energy nor take more than they should, whatever the method and the paths.
#[test]
fn what_bounces_bound_keeps_its_energy() {
    let (height, minute) = (1.0f32, if cfg!(debug_assertions) { 10 } else { 60 });
    // By straight paths rounding tilts it within half a minute or so; from a tilted one its link takes what leads along it at each hit.
    let seconds = |paths| if paths == Paths::STRAIGHT { 10 } else { minute };
    for (&method, paths) in
        Method::ALL.iter().flat_map(|method| [Paths::CURVED, Paths::STRAIGHT].map(|paths| (method, paths)))
    {
        for (elasticity, substeps) in [(1.0f32, 1), (1.0, 7), (0.9, 1), (0.5, 4), (0.0, 2)] {
            let part = Particle { elasticity, ..Particle::REST };
            let start = [0.0f32, 0.2].map(|x| Particle { position: Vec3::new(x, height, 0.0), ..part });
            let rod = [Distance::rod([0, 1], 0.2)];
            let scene = Scene {
                start: &start,
                forces: &Gravity { acceleration: Vec3::NEG_Y * 9.81 },
                colliders: &Plane { point: Vec3::ZERO, normal: Vec3::Y },
                constraints: &rod,
                substeps,
                integrator: method.integrator(),
                paths,
                ..Scene::EMPTY
            };
            let mut system = started(&scene, 2, 0);
            let (begun, mut most, mut last) = (9.81 * height, 0.0f32, 0.0);
            for frame in 1..=seconds(paths) * 60 {
                system.step_to(&scene, Time::frame(frame, 60));
                let all = system.particles();
                let ends = all.position.iter().zip(all.velocity);
                last = 0.5 * ends.map(|(x, v)| 9.81 * x.y + 0.5 * v.length_squared()).sum::<f32>();
                most = most.max(last / begun);
            }
            let (name, h) = (format!("{method}, {paths:?}, {elasticity}, {substeps}"), 1.0 / (60.0 * substeps as f32));
            // Methods of first order begin with what they show of gravity in a sub-step too much or too little.
            assert!(most < 1.3, "{name}: {most} of its energy");
            if elasticity == 1.0 {
                // Explicit Euler loses some at each bounce off a straight path, as it comes to it late.
                let least = match method {
                    Method::Euler => 0.0,
                    Method::Symplectic | Method::Implicit => 0.1,
                    _ => 0.5,
                };
                assert!(last > least * begun, "{name}: {} left", last / begun);
            } else {
                assert!(last < 8.0 * (9.81 * h) * (9.81 * h) + 1e-3, "{name}: {last} J/kg are left");
            }
        }
    }
}

/// A rope that runs over a smooth peg, longer on one side, does as Atwood's machine: x = (l₂ − l₁) / 2 (cosh(t √(2 g / L)) − 1).
#[test]
fn a_rope_runs_over_a_peg_as_atwoods_machine() {
    let (radius, short, long, links) = (0.2f32, 0.5f32, 1.0f32, 60);
    let over = core::f32::consts::PI * radius;
    let length = short + long + over;
    let place = |s: f32| match s {
        s if s < short => Vec3::new(-radius, s - short, 0.0),
        s if s < short + over => {
            let (sin, cos) = ((s - short) / radius).sin_cos();
            Vec3::new(-cos, sin, 0.0) * (radius * 1.0001)
        }
        s => Vec3::new(radius, short + over - s, 0.0),
    };
    let part = Particle { mass: 0.1, elasticity: 0.0, ..Particle::REST };
    let start: Vec<_> =
        (0..=links).map(|i| Particle { position: place(length * i as f32 / links as f32), ..part }).collect();
    let lengths: Vec<_> = start.windows(2).map(|ends| ends[0].position.distance(ends[1].position)).collect();
    let peg = Sphere { center: Vec3::ZERO, radius };
    for (&method, (substeps, off)) in
        Method::ALL.iter().flat_map(|method| [(10, 0.1), (40, 0.04)].map(|of| (method, of)))
    {
        let rope = Rope::rigid((0..=links).collect::<Vec<u32>>(), lengths.clone());
        let scene = Scene {
            start: &start,
            forces: &Gravity { acceleration: Vec3::NEG_Y * 9.81 },
            colliders: &peg,
            constraints: &rope,
            substeps,
            integrator: method.integrator(),
            ..Scene::EMPTY
        };
        let mut system = started(&scene, start.len(), 0);
        for frame in 1..=24 {
            system.step_to(&scene, Time::frame(frame, 60));
        }
        let right = 0.5 * (long - short) * ((0.4 * (2.0 * 9.81 / length).sqrt()).cosh() - 1.0);
        let x = system.particles().position;
        let went = [x[0].y - start[0].position.y, start[links as usize].position.y - x[links as usize].y];
        assert!(
            went.iter().all(|went| (went / right - 1.0).abs() < off),
            "{method}, {substeps}: {went:?}, not {right}"
        );
    }
}
