//! Air on strands by the segment: published coefficients, terminal speeds, what it takes, and what does it no harm.

use super::forces;
use pointmass::force::{CylinderDrag, FlowKind, Perturbation, Uniform};
use pointmass::scene::{Model, SceneFile};
use pointmass::{Force, ForceKind, Gravity, Method, Particle, Scene, Time, Vec3};
use pointmass_tests::{Random, often, started};
use std::f64::consts::{E, PI};

type Air<F> = CylinderDrag<Vec<[u32; 2]>, F>;

/// A chain through all particles in still air.
fn chain(points: usize, diameter: f32) -> Air<()> {
    CylinderDrag::still((1..points as u32).map(|i| [i - 1, i]).collect(), diameter)
}

/// A straight rod: each segment's mass is halved between its ends.
fn rod(root: Vec3, way: Vec3, segments: usize, mass: f32) -> Vec<Particle> {
    let point = |i: usize| Particle {
        position: root + way * (i as f32 / segments as f32),
        mass: mass / segments as f32 * if i == 0 || i == segments { 0.5 } else { 1.0 },
        ..Particle::REST
    };
    (0..=segments).map(point).collect()
}

/// The forces of one force on particles.
fn push(start: &[Particle], force: &dyn Force) -> Vec<Vec3> {
    let scene = Scene { start, forces: force, ..Scene::EMPTY };
    forces(&started(&scene, start.len(), 0), &scene, force)
}

fn sum(all: &[Vec3]) -> Vec3 {
    all.iter().sum()
}

/// The coefficient of drag at a Reynolds number that the force on a metre of rod comes to, across a wind of 1 m/s.
fn coefficient(reynolds: f64) -> f64 {
    let diameter = 0.01f32;
    let mut air = chain(2, diameter);
    air.viscosity = (f64::from(air.density * diameter) / reynolds) as f32;
    let force = push(&rod(Vec3::ZERO, Vec3::X, 1, 1.0), &air.clone().within(Uniform { velocity: Vec3::Y }));
    f64::from(sum(&force).y) / (0.5 * f64::from(air.density * diameter))
}

#[test]
fn coefficients_across_are_those_that_are_published() {
    // Kaplun's series for slow flow, with Euler's constant: C_D = 8 π/Re (S − 0.87 S³), 1/S = ½ − γ + ln(8/Re).
    for reynolds in [0.01, 0.02, 0.05, 0.1, 0.2, 0.3f64] {
        let s = 1.0 / (0.5 - 0.577_215_7 + (8.0 / reynolds).log(E));
        let published = 8.0 * PI / reynolds * (s - 0.87 * s * s * s);
        let has = coefficient(reynolds);
        assert!((has / published - 1.0).abs() < 0.08, "Re {reynolds}: {has}, not {published}");
    }
    // Dennis and Chang's steady flows, Park, Kwon and Choi's with eddies, and Wieselsberger's measurements.
    for (reynolds, published) in [
        (5.0, 4.116),
        (7.0, 3.421),
        (10.0, 2.846),
        (20.0, 2.045),
        (40.0, 1.522),
        (60.0, 1.39),
        (80.0, 1.35),
        (100.0, 1.33),
        (160.0, 1.32),
        (1e3, 1.0),
        (1e4, 1.1),
        (1e5, 1.2),
    ] {
        let has = coefficient(reynolds);
        assert!((has / published - 1.0).abs() < 0.08, "Re {reynolds}: {has}, not {published}");
    }
    // It has no jumps, and the force never falls as the wind rises.
    let all = (0..9000).map(|i| 10f64.powf(f64::from(i) / 1000.0 - 3.0)).map(|re| re * coefficient(re));
    let all: Vec<_> = all.collect();
    assert!(all.windows(2).all(|pair| (pair[1] / pair[0] - 1.0).abs() < 3e-3));
    assert!(
        all.windows(2).enumerate().all(|(i, pair)| pair[1] > pair[0] * (1.0 - 1e-6) * 10f64.powf(-0.001) || i == 0)
    );
}

/// What a metre feels across and along the wind \[N/m\], by the printed law in double precision.
fn law<F>(air: &Air<F>, aside: f64, along: f64) -> [f64; 2] {
    let [density, viscosity, friction, diameter] =
        [air.density, air.viscosity, air.friction, air.diameter].map(f64::from);
    let re = density * diameter * aside / viscosity;
    let x = re / 2000.0;
    let across = 3.4 + 5.8 * re.sqrt() / (1.0 + 0.04 * re) + 1.2 * re * (1.0 - 0.42 * x / (1.0 + x * x));
    let rubbed = 0.5 * density * PI * diameter * friction * along;
    [0.5 * viscosity * across * aside, (0.85 * viscosity + rubbed) * along]
}

/// The speed at which a metre of a weight \[N/m\] falls across itself, or along.
fn terminal(air: &Air<()>, weight: f64, upright: bool) -> f64 {
    let feels = |speed| if upright { law(air, 0.0, speed)[1] } else { law(air, speed, 0.0)[0] };
    let [mut low, mut high] = [0.0, 1e6];
    for _ in 0..200 {
        let middle = 0.5 * (low + high);
        if feels(middle) < weight { low = middle } else { high = middle }
    }
    low
}

#[test]
fn a_fibre_falls_at_its_terminal_speed() {
    let mut random = Random::new(11);
    let mut methods = Method::ALL.iter().cycle();
    for (diameter, solid) in [(2e-6f32, 100.0f32), (1e-5, 1300.0), (8e-5, 1300.0), (3e-3, 900.0), (0.04, 300.0)] {
        for upright in [false, true] {
            for segments in [1, 5, 12] {
                let method = *methods.next().expect("there is always a next one");
                let air = chain(segments + 1, diameter);
                let along = random.vector(1.0).normalize();
                let down = if upright { along } else { along.any_orthonormal_vector() };
                let gravity = Gravity { acceleration: down * 9.81 };
                // Nothing holds it together: it is so long that no point gets near the next one.
                let (long, weight) = (1e5 * diameter, solid * PI as f32 * diameter * diameter / 4.0);
                let speed = terminal(&air, f64::from(weight * 9.81), upright);
                let mut start = rod(random.vector(1e-3), along * long, segments, weight * long);
                // It begins at three quarters of that speed; what is missing fades at least as fast as it would if drag were linear.
                start.iter_mut().for_each(|particle| particle.velocity = down * (0.75 * speed as f32));
                let fades = speed / 9.81;
                let (forces, integrator) = ((gravity, air), method.integrator());
                let scene = Scene { start: &start, forces: &forces, integrator, ..Scene::EMPTY };
                let mut system = started(&scene, start.len(), 0);
                for i in 1..=60 {
                    system.step_to(&scene, Time::from_seconds_f64(f64::from(i) * 0.1 * fades));
                }
                for velocity in system.particles().velocity {
                    // Far from the origin places round, and what stands upright leans by that.
                    let [off, aside] = [velocity.dot(down) - speed as f32, velocity.cross(down).length()];
                    let [off, aside] = [off, aside].map(|by| f64::from(by.abs()) / speed);
                    assert!(
                        off < 2e-3 && aside < 4e-3,
                        "{method}, {diameter} m, upright {upright}: {velocity}, not {speed}"
                    );
                }
            }
        }
    }
}

#[test]
fn in_slow_flow_a_rod_sinks_upright_twice_as_fast_as_level() {
    for (scale, segments) in [(1e-6f32, 2), (1e-3, 7), (1.0, 20)] {
        // The Reynolds number is 1e-9.
        let air = Air { viscosity: scale * scale * 1e7, ..chain(segments + 1, 0.01 * scale) };
        for tilt in [0.0f32, 0.3, 1.0] {
            let (sin, cos) = tilt.sin_cos();
            let start = rod(Vec3::ZERO, Vec3::X * scale, segments, 1.0);
            let drag = |wind: Vec3| sum(&push(&start, &air.clone().within(Uniform { velocity: wind * scale })));
            let [level, upright] = [drag(Vec3::Y).y, drag(Vec3::X).x];
            assert!((level / upright - 2.0).abs() < 1e-3, "{scale}: {level} {upright}");
            // A rod that leans slides toward its lower end.
            let leaning = drag(Vec3::new(sin, cos, 0.0));
            assert!((leaning - Vec3::new(sin * upright, cos * level, 0.0)).length() < 2e-3 * level);
        }
    }
}

#[test]
fn segments_feel_the_printed_law_and_still_air_gives_nothing() {
    let mut random = Random::new(31);
    for scale in [1e-4f32, 1e-2, 1.0, 100.0] {
        for round in 0..often(1000) {
            let ends = [(); 2].map(|()| random.vector(scale) + Vec3::splat(if round % 3 == 0 { scale } else { 0.0 }));
            let speeds = [(); 2].map(|()| random.vector(8.0));
            let wind = if round % 2 == 0 { Vec3::ZERO } else { random.vector(8.0) };
            let start = [0, 1].map(|i| Particle { position: ends[i], velocity: speeds[i], ..Particle::REST });
            let friction = if round % 5 == 0 { 0.0 } else { 0.01 };
            let air = Air { friction, ..chain(2, 0.01 * scale) }.within(Uniform { velocity: wind });
            let scene = Scene { start: &start, forces: &air, ..Scene::EMPTY };
            let system = started(&scene, 2, 0);
            let state = system.state(&scene);
            let each = forces(&system, &scene, &air);
            // Half of it goes with each end.
            let way = ends[1] - ends[0];
            let direction = way.normalize();
            for (speed, has) in speeds.iter().zip(&each) {
                let relative = wind - *speed;
                let along = relative.dot(direction);
                let aside = relative - direction * along;
                let feels = law(&air, f64::from(aside.length()), f64::from(along.abs()));
                let [across, lengthways] = feels.map(|force| force as f32 * 0.5 * way.length());
                let expected = aside.normalize() * across + direction * (lengthways * along.signum());
                assert!((*has - expected).length() < 1e-4 * expected.length(), "{has}, not {expected}");
            }
            let total = each[0].length() + each[1].length();
            let power = air.power(&state);
            let told = each.iter().zip(speeds).map(|(f, v)| f64::from(f.dot(v))).sum::<f64>();
            assert!((power - told).abs() < 1e-5 * f64::from(total * 16.0), "{power} {told}");
            assert!(wind != Vec3::ZERO || power <= 0.0, "{power}");
            let mut apart = [Vec3::ZERO; 2];
            air.add_to(&state, 0..1, &mut apart[..1]);
            air.add_to(&state, 1..2, &mut apart[1..]);
            assert_eq!(apart[..], each[..], "any division into rows gives the same bits");
        }
    }
}

#[test]
fn a_strand_feels_the_same_however_finely_it_is_cut() {
    let mut random = Random::new(7);
    for diameter in [5e-5f32, 2e-3, 0.05] {
        // A bent strand of straight pieces, each of which is cut into more.
        let knots: Vec<Vec3> = (0..6).map(|i| Vec3::X * (0.1 * i as f32) + random.vector(0.05)).collect();
        let wind = Uniform { velocity: random.vector(10.0) };
        let felt = |cuts: usize| {
            let pieces =
                knots.windows(2).flat_map(|ends| (0..cuts).map(|i| ends[0].lerp(ends[1], i as f32 / cuts as f32)));
            let places: Vec<Vec3> = pieces.chain(knots.last().copied()).collect();
            let start: Vec<_> = places.iter().map(|&position| Particle { position, ..Particle::REST }).collect();
            let each = push(&start, &chain(start.len(), diameter).within(wind));
            (sum(&each), places.iter().zip(&each).map(|(x, f)| x.cross(*f)).sum::<Vec3>())
        };
        let (force, torque) = felt(1);
        for cuts in [2, 4, 32] {
            let (has, turns) = felt(cuts);
            assert!((has - force).length() < 1e-5 * force.length(), "{cuts}: {has}, not {force}");
            assert!((turns - torque).length() < 1e-5 * torque.length(), "{cuts}: {turns}, not {torque}");
        }
    }
}

#[test]
fn a_rod_that_spins_is_braked_along_all_of_it() {
    for (segments, share) in [(8, 0.05), (32, 0.01)] {
        // In slow flow the torque of a spin ω about the middle is 1.7 μ ω l³ / 12.
        let air = Air { density: 0.0, viscosity: 0.3, ..chain(segments + 1, 0.01) };
        let mut start = rod(Vec3::new(-1.0, 3.0, 0.0), Vec3::X * 2.0, segments, 1.0);
        start.iter_mut().for_each(|p| p.velocity = Vec3::Z.cross(p.position) * 5.0 - Vec3::NEG_X * 15.0);
        let torque: f32 = start.iter().zip(push(&start, &air)).map(|(p, f)| p.position.x * f.y).sum();
        let exact = -1.7 * 0.3 * 5.0 * 8.0 / 12.0;
        assert!((torque / exact - 1.0).abs() < share, "{segments}: {torque}, not {exact}");
    }
}

#[test]
fn its_jacobian_takes_energy_alone_and_is_the_slope_in_slow_flow() {
    let mut random = Random::new(23);
    for round in 0..often(100) {
        let start: Vec<_> = (0..6)
            .map(|_| Particle { position: random.vector(1.0), velocity: random.vector(3.0), ..Particle::REST })
            .collect();
        // Without inertia of the air drag is linear.
        let linear = round % 2 == 0;
        let air = Air { density: if linear { 0.0 } else { 1.2 }, viscosity: 1e-2, ..chain(6, 0.01) };
        let scene = Scene { start: &start, forces: &air, ..Scene::EMPTY };
        let system = started(&scene, 6, 0);
        let state = system.state(&scene);
        let [a, b] = [(); 2].map(|()| (0..6).map(|_| random.vector(1.0)).collect::<Vec<_>>());
        let act = |along: &[Vec3]| {
            let mut total = vec![Vec3::ZERO; 6];
            air.add_jacobian(&state, &Perturbation { along, position: 1.0, velocity: 1.0 }, &mut total);
            total
        };
        let dot = |a: &[Vec3], b: &[Vec3]| a.iter().zip(b).map(|(a, b)| f64::from(a.dot(*b))).sum::<f64>();
        let [on_a, on_b] = [act(&a), act(&b)];
        let size = dot(&on_a, &on_a).sqrt() * 6.0;
        assert!(dot(&a, &on_a) <= 1e-6 * size, "it drives");
        assert!((dot(&b, &on_a) - dot(&a, &on_b)).abs() < 1e-5 * size, "it is not symmetric");
        if linear {
            let later: Vec<_> =
                start.iter().zip(&a).map(|(p, &a)| Particle { velocity: p.velocity + a, ..*p }).collect();
            let change = push(&later, &air).into_iter().zip(push(&start, &air)).map(|(f, g)| f - g);
            let off = change.zip(&on_a).map(|(f, g)| (f - *g).length()).fold(0.0, f32::max);
            assert!(f64::from(off) < 1e-5 * size, "{off}");
        }
    }
}

#[test]
fn implicit_steps_of_any_length_only_slow_a_fibre_down() {
    for (step, wind) in [(0.1, Vec3::ZERO), (3.0, Vec3::ZERO), (50.0, Vec3::new(2.0, 1.0, 0.0))] {
        let mut random = Random::new(3);
        let mut start = rod(Vec3::ZERO, Vec3::new(0.03, 0.02, 0.0), 9, 1e-9);
        start.iter_mut().for_each(|particle| particle.velocity = random.vector(4.0));
        let air = chain(10, 1e-5).within(Uniform { velocity: wind });
        let scene = Scene { start: &start, forces: &air, integrator: Method::Implicit.integrator(), ..Scene::EMPTY };
        let mut system = started(&scene, 10, 0);
        let mut before = f32::INFINITY;
        for _ in 0..40 {
            system.step(&scene, Time::from_seconds(step));
            let fastest = system.particles().velocity.iter().map(|v| (*v - wind).length()).fold(0.0, f32::max);
            assert!(fastest < before * 1.01 || fastest < 1.0, "{step}: {fastest} after {before}");
            before = before.min(fastest);
        }
    }
}

#[test]
fn what_is_no_segment_or_no_number_is_left_alone() {
    let start = [Vec3::ZERO, Vec3::ZERO, Vec3::X, Vec3::NAN, Vec3::splat(3e38), Vec3::splat(-3e38), Vec3::Y]
        .map(|position| Particle { position, ..Particle::REST });
    let windy = |air: Air<()>| air.within(Uniform { velocity: Vec3::new(1.0, 2.0, 3.0) });
    let air = windy(CylinderDrag::still(vec![[0, 1], [2, 3], [4, 5], [2, 2], [2, 99], [u32::MAX, 0], [0, 2]], 0.01));
    let each = push(&start, &air);
    assert!(each.iter().all(|force| force.is_finite()));
    assert_eq!([each[1], each[3], each[6]], [Vec3::ZERO; 3]);
    assert!(each[0] == each[2] && each[0] != Vec3::ZERO, "what is sound feels the wind");
    let alone = [start[0], start[2]];
    let strange = [0.0, -1.0, 1e-45, 1e-30, 1e30, f32::MAX, f32::INFINITY, f32::NAN];
    for number in strange {
        for air in [
            Air { viscosity: number, ..chain(2, 0.01) },
            Air { density: number, ..chain(2, 0.01) },
            Air { density: 0.0, viscosity: number, ..chain(2, 0.01) },
            Air { friction: number, ..chain(2, 0.01) },
            chain(2, number),
        ] {
            assert!(push(&alone, &windy(air)).iter().all(|force| force.is_finite()), "{number}");
        }
    }
    // Without viscosity the drag is that of fast flow alone.
    let thin = push(&alone, &Air { viscosity: 0.0, ..chain(2, 0.01) }.within(Uniform { velocity: Vec3::Y * 3.0 }));
    assert!((sum(&thin).y / (0.5 * 1.2 * 0.01 * 1.2 * 9.0) - 1.0).abs() < 1e-5);
    // A segment goes with one of its ends.
    let mut start = rod(Vec3::ZERO, Vec3::X, 2, 1.0);
    start[2].lifetime = 0.01;
    let air = windy(chain(3, 0.01));
    let scene = Scene { start: &start, forces: &air, ..Scene::EMPTY };
    let mut system = started(&scene, 3, 0);
    system.step(&scene, Time::from_seconds(0.02));
    let each = forces(&system, &scene, &air);
    assert!(each.len() == 2 && each[0] == each[1] && each[0] != Vec3::ZERO);
}

#[test]
fn files_put_strands_into_the_wind() {
    let text = r#"{
        "forces": [{"gravity": {"acceleration": [0, -9.8, 0]}}, {"wind": {"field": [{"uniform": {"velocity": [3, 0, 0]}}]}}],
        "particles": [{"position": [9, 9, 9]}],
        "strands": [
            {"form": {"curve": [[0, 0, 0], [0, -1, 0]]}, "segments": 4, "radius": 1e-3, "young": 1e7, "density": 1000, "fixed": [0],
                "air": {"friction": 0.02}},
            {"form": {"on": {"shape": {"sphere": {"center": [5, 0, 0], "radius": 1}}, "count": 2, "length": 0.2}}, "segments": 3,
                "radius": 4e-5, "young": 4e9, "density": 1300, "air": {"diameter": 1e-3}},
            {"form": {"curve": [[3, 0, 0], [3, -1, 0]]}, "segments": 4, "radius": 1e-3, "young": 1e7, "density": 1000, "drag": 1e-4}
        ]
    }"#;
    let file = SceneFile::from_json("a.json", text).expect("it is sound");
    assert_eq!(SceneFile::from_json("b.json", &file.to_json()), Ok(file.clone()));
    let model = Model::load(&file, "a.json", &mut ()).expect("it can be made");
    let [_, _, ForceKind::CylinderDrag(wire), ForceKind::CylinderDrag(hair)] = &model.forces.0[..] else {
        panic!("{:?}", model.forces.0)
    };
    let wind = [FlowKind::Uniform(Uniform { velocity: Vec3::X * 3.0 })];
    assert_eq!((&wire.segments[..], &wire.field[..]), (&[[1, 2], [2, 3], [3, 4], [4, 5]][..], &wind[..]));
    assert_eq!([wire.diameter, wire.density, wire.viscosity, wire.friction], [2e-3, 1.2, 1.81e-5, 0.02]);
    // The segment beneath the surface is in no wind.
    assert_eq!(&hair.segments[..], &[[7, 8], [8, 9], [9, 10], [12, 13], [13, 14], [14, 15]][..]);
    assert_eq!((hair.diameter, hair.field.len()), (1e-3, 1));
    let mut system = model.system(0, 1).expect("there is memory");
    for frame in 1..=30 {
        system.step_to(&model.scene(), Time::frame(frame, 60));
    }
    assert!(system.particles().position[5].x > 0.05, "it goes with the wind");
    for (from, to, path) in [
        (r#""friction": 0.02"#, r#""friction": -1"#, "strands[0].air.friction"),
        (r#""friction": 0.02"#, r#""density": -1"#, "strands[0].air.density"),
        (r#""friction": 0.02"#, r#""viscosity": -1"#, "strands[0].air.viscosity"),
        (r#""diameter": 1e-3"#, r#""diameter": 0"#, "strands[1].air.diameter"),
        (r#""drag": 1e-4"#, r#""drag": 1e-4, "air": {}"#, "strands[2].drag"),
    ] {
        let file = SceneFile::from_json("a.json", &text.replace(from, to)).expect("it is a scene");
        assert!(file.check().is_err_and(|error| error.to_string().contains(path)), "{to}");
    }
}
