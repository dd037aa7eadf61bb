//! Limits of strain: what hangs from nets, how far they shear, what they keep, and what does them no harm.

use pointmass::scene::{Model, SceneFile};
use pointmass::{
    ClothSprings, ConstraintKind, Drag, Gravity, Measures, Method, Particle, Scene, Sheet, Spring, SpringParams,
    StrainLimitParams, StrainLimits, Time, Vec3,
};
use pointmass_tests::{Random, every, f64s, gap, is_third, often, run, started};

type Limits = StrainLimits<Vec<[u32; 3]>>;

fn limits(sheet: &Sheet, params: StrainLimitParams) -> Limits {
    StrainLimits { triangles: sheet.triangles().collect(), warp: sheet.sides[0], params }
}

fn springs(sheet: &Sheet, ks: f32, kd: f32) -> Vec<Spring> {
    let soft = Some(SpringParams { ks, kd });
    sheet.springs(&ClothSprings { structural: soft, shear: soft, ..ClothSprings::default() }, 0).collect()
}

/// Two directions at right angles, turned anyhow.
fn pose(random: &mut Random) -> [Vec3; 2] {
    let down = random.direction();
    [down, down.cross(random.direction()).normalize()]
}

/// Of each triangle the lengths of warp and weft as shares of those at rest, and the sine of the angle of shear.
fn strains(sheet: &Sheet, x: &[Vec3]) -> Vec<[f32; 3]> {
    let rest: Vec<Vec3> = sheet.positions().collect();
    let [u, v] = sheet.sides.map(Vec3::normalize);
    let of = |corners: [u32; 3]| {
        let [a, b, c] = corners.map(|corner| corner as usize);
        let flat = [b, c].map(|i| [(rest[i] - rest[a]).dot(u), (rest[i] - rest[a]).dot(v)]);
        let [[p, q], [r, s]] = flat;
        let (e, f, twice) = (x[b] - x[a], x[c] - x[a], p * s - q * r);
        let [warp, weft] = [(e * s - f * q) / twice, (f * p - e * r) / twice];
        [warp.length(), weft.length(), warp.dot(weft) / (warp.length() * weft.length())]
    };
    sheet.triangles().map(of).collect()
}

#[test]
fn a_net_with_a_heavy_load_hangs_within_its_limit() {
    let (mut random, mut cases) = (Random::new(5), 0);
    let mut methods = Method::ALL.iter().cycle();
    for (cells, scale) in [([3u32, 4u32], 1.0f32), ([6, 8], 0.1), ([4, 16], 20.0)] {
        for (substeps, turned, most) in [(2, false, 1.02f32), (5, true, 1.1), (20, false, 1.0)] {
            if !is_third(&mut cases) {
                continue;
            }
            let [down, side] = pose(&mut random);
            let (long, edge) = (0.5 * scale, 0.5 * scale / cells[1] as f32);
            // Light knots under a heavier load would swing faster than these sub-steps resolve.
            let h = 1.0 / (60.0 * substeps as f32);
            let load = (0.06 * edge / (9.81 * h * h)).min(300.0);
            // It hangs along the weft, or along the warp.
            let sides = [side * (0.3 * scale), down * long];
            let (sides, cells) = if turned { ([sides[1], sides[0]], [cells[1], cells[0]]) } else { (sides, cells) };
            let sheet = Sheet { corner: random.vector(2.0 * scale), sides, cells };
            let knot = Particle { mass: 1e-3, drag: 4e-3 / scale.sqrt(), ..Particle::REST };
            let mut start: Vec<Particle> = sheet.particles(knot).collect();
            for particle in &mut start {
                let low = (particle.position - sheet.corner).dot(down) / long;
                particle.fixed = low < 1e-3;
                if low > 1.0 - 1e-3 {
                    particle.mass *= load;
                    particle.drag *= load;
                }
            }
            // Springs alone would let it stretch many times as long.
            let springs = springs(&sheet, 20.0 * 1e-3, 0.0);
            let params = StrainLimitParams { warp: Some([0.0, most]), ..StrainLimitParams::default() };
            let params = if turned { params } else { StrainLimitParams { weft: params.warp, warp: None, ..params } };
            let (limits, method) = (limits(&sheet, params), *methods.next().expect("there is always a next one"));
            let forces = (Gravity { acceleration: down * 9.81 }, Drag {});
            let (integrator, constraints) = (method.integrator(), &limits);
            let scene = Scene { start: &start, springs: &springs, forces: &forces, ..Scene::EMPTY };
            let scene = Scene { constraints, substeps, integrator, ..scene };
            let mut system = started(&scene, start.len(), 0);
            run(&mut system, &scene, 1.0 / 60.0, 150);
            let all = strains(&sheet, system.particles().position);
            let worst = all.iter().map(|strain| strain[usize::from(!turned)]).fold(0.0, f32::max);
            assert!(worst < most + 2e-3, "{method} {cells:?} {load} {substeps}: {worst} of {most}");
            assert!(worst > most - 0.01, "{method}: the load does hang on it: {worst}");
        }
    }
}

#[test]
fn limits_give_way_by_their_compliance() {
    for (cells, substeps, method) in
        [([2u32, 5u32], 10, Method::Symplectic), ([4, 8], 20, Method::Verlet), ([3, 3], 5, Method::Rk4)]
            .into_iter()
            .step_by(every(2))
    {
        let (wide, long, compliance) = (0.2f32, 0.4f32, 2e-3f32);
        let sheet = Sheet { corner: Vec3::ONE, sides: [Vec3::X * wide, Vec3::NEG_Y * long], cells };
        let mut start: Vec<Particle> = sheet.particles(Particle { mass: 1e-3, drag: 5e-2, ..Particle::REST }).collect();
        let load = 0.4f32;
        let last = cells[0] as usize + 1;
        let count = start.len();
        start[..last].iter_mut().for_each(|particle| particle.fixed = true);
        // Each cell's width bears its share of the load, and the outer knots half of one.
        for (i, particle) in start[count - last..].iter_mut().enumerate() {
            let share = if i == 0 || i + 1 == last { 0.5 } else { 1.0 };
            particle.mass = load / cells[0] as f32 * share;
            particle.drag = 2.0 * particle.mass;
        }
        let params = StrainLimitParams {
            weft: Some([0.9, 1.0]),
            warp: Some([1.0, 1.0]),
            shear: Some(0.0),
            compliance,
            damping: 1.0,
        };
        let (limits, forces) = (limits(&sheet, params), (Gravity { acceleration: Vec3::NEG_Y * 9.81 }, Drag {}));
        let integrator = method.integrator();
        let scene =
            Scene { start: &start, forces: &forces, constraints: &limits, substeps, integrator, ..Scene::EMPTY };
        let mut system = started(&scene, start.len(), 0);
        run(&mut system, &scene, 1.0 / 60.0, 600);
        // The weight of the rows is a sum of a series, and little beside the load.
        let rows = 1e-3 * (cells[0] + 1) as f32 * (cells[1] - 1) as f32 / 2.0;
        let stretch = compliance * (load + rows) * 9.81 / wide;
        let low = system.particles().position[count - last..].iter().map(|x| 1.0 - x.y).sum::<f32>() / last as f32;
        let has = low / long - 1.0;
        assert!((has / stretch - 1.0).abs() < 0.02, "{method} {cells:?}: {has}, not {stretch}");
    }
}

#[test]
fn shear_is_held_within_its_angle() {
    for (angle, substeps, method, scale) in
        [(0.2f32, 5, Method::Symplectic, 1.0f32), (0.5, 10, Method::Verlet, 10.0), (0.05, 20, Method::Implicit, 0.2)]
    {
        let sheet = Sheet { corner: Vec3::ZERO, sides: [Vec3::X * scale, Vec3::Y * scale], cells: [5, 4] };
        let mut start: Vec<Particle> = sheet.particles(Particle { mass: 1e-2, drag: 0.05, ..Particle::REST }).collect();
        start.iter_mut().filter(|particle| particle.position.y == 0.0).for_each(|particle| particle.fixed = true);
        let only = ClothSprings { structural: Some(SpringParams { ks: 400.0, kd: 0.1 }), ..ClothSprings::default() };
        let springs: Vec<_> = sheet.springs(&only, 0).collect();
        // It is blown aside; threads alone would let it lie down.
        let aside = Gravity { acceleration: Vec3::new(30.0, 20.0, 0.0) * scale };
        let sine = |held: bool| {
            let params = StrainLimitParams { shear: held.then_some(angle), ..StrainLimitParams::default() };
            let (limits, forces) = (limits(&sheet, params), (aside, Drag {}));
            let (constraints, integrator) = (&limits, method.integrator());
            let scene = Scene { start: &start, springs: &springs, forces: &forces, ..Scene::EMPTY };
            let scene = Scene { constraints, substeps, integrator, ..scene };
            let mut system = started(&scene, start.len(), 0);
            run(&mut system, &scene, 1.0 / 60.0, 180);
            strains(&sheet, system.particles().position).iter().map(|strain| strain[2].abs()).fold(0.0, f32::max)
        };
        let [free, held] = [sine(false), sine(true)];
        assert!(free > angle.sin() + 0.1 && held < angle.sin() + 1e-3, "{method} {angle}: {free}, then {held}");
        assert!(held > angle.sin() - 1e-2, "{held}");
    }
}

#[test]
fn what_is_pressed_together_shrinks_no_farther_than_its_limit() {
    for (least, substeps, method) in [(0.9f32, 5, Method::Symplectic), (0.5, 10, Method::Rk4), (1.0, 3, Method::Verlet)]
    {
        let sheet = Sheet { corner: Vec3::NEG_X, sides: [Vec3::X * 2.0, Vec3::Z], cells: [8, 3] };
        let mut start: Vec<Particle> = sheet.particles(Particle { mass: 0.1, ..Particle::REST }).collect();
        // Flat, it cannot get out of the way.
        start.iter_mut().for_each(|particle| particle.velocity = Vec3::X * (-4.0 * particle.position.x));
        let params = StrainLimitParams { warp: Some([least, 1.5]), ..StrainLimitParams::default() };
        let (limits, integrator) = (limits(&sheet, params), method.integrator());
        let scene = Scene { start: &start, constraints: &limits, substeps, integrator, ..Scene::EMPTY };
        let mut system = started(&scene, start.len(), 0);
        for frame in 1..=30 {
            system.step_to(&scene, Time::frame(frame, 60));
            let all = strains(&sheet, system.particles().position);
            let shortest = all.iter().map(|strain| strain[0]).fold(f32::INFINITY, f32::min);
            assert!(shortest > least - 2e-3, "{method} {frame}: {shortest} of {least}");
        }
    }
}

/// A sheet that flies, turns, waves and trembles.
fn flying(sheet: &Sheet, vigour: f32, seed: u64) -> Vec<Particle> {
    let mut random = Random::new(seed);
    let middle = sheet.corner + (sheet.sides[0] + sheet.sides[1]) * 0.5;
    let size = sheet.sides[0].length();
    let throw = |position: Vec3, random: &mut Random| {
        let turn = Vec3::new(1.0, 2.0, 3.0).cross(position - middle);
        (Vec3::new(0.2, 0.3, -0.2) + random.vector(vigour)) * size + turn
    };
    sheet
        .positions()
        .map(|position| Particle {
            position,
            velocity: throw(position, &mut random),
            mass: random.magnitude(0.01, 0.1),
            ..Particle::REST
        })
        .collect()
}

#[test]
fn within_limits_nothing_acts() {
    for method in [Method::Symplectic, Method::Rk4, Method::Implicit] {
        let sheet = Sheet { corner: Vec3::ONE, sides: [Vec3::X, Vec3::Z * 0.7], cells: [6, 5] };
        let (start, springs) = (flying(&sheet, 0.1, 3), springs(&sheet, 8.0, 0.01));
        let ends = |params: StrainLimitParams| {
            let (limits, integrator) = (limits(&sheet, params), method.integrator());
            let scene = Scene { start: &start, springs: &springs, forces: &Gravity::EARTH, ..Scene::EMPTY };
            let scene = Scene { constraints: &limits, substeps: 3, integrator, ..scene };
            let mut system = started(&scene, start.len(), 0);
            run(&mut system, &scene, 1.0 / 60.0, 40);
            let all = system.particles();
            (all.position.to_vec(), all.velocity.to_vec(), strains(&sheet, all.position))
        };
        let none = ends(StrainLimitParams::default());
        let wide = StrainLimitParams {
            warp: Some([0.0, 9.0]),
            weft: Some([0.0, 9.0]),
            shear: Some(1.55),
            ..StrainLimitParams::default()
        };
        let held = ends(StrainLimitParams { compliance: 1e-3, damping: 2.0, ..wide });
        assert!(none.2.iter().all(|strain| strain[2].abs() < 0.99));
        assert!(none.0 == held.0 && none.1 == held.1, "{method}");
    }
}

/// The angular momentum about the origin.
fn spin(start: &[Particle], [x, v]: [&[Vec3]; 2]) -> [f64; 3] {
    let mut sum = [0.0; 3];
    for ((p, x), v) in start.iter().zip(x).zip(v) {
        let ([a, b, c], [d, e, f], m) = (f64s(*x), f64s(*v), f64::from(p.mass));
        let each = [b * f - c * e, c * d - a * f, a * e - b * d];
        sum.iter_mut().zip(each).for_each(|(sum, each)| *sum += m * each);
    }
    sum
}

#[test]
fn a_free_net_keeps_its_momenta_and_gains_no_energy() {
    for (cells, scale, vigour, far) in
        [([4u32, 3u32], 1.0f32, 0.3f32, 0.0f32), ([7, 5], 1e-2, 1.0, 0.0), ([5, 5], 30.0, 0.3, 1.0)]
    {
        for (substeps, method, compliance) in
            [(2, Method::Symplectic, 0.0f32), (8, Method::Verlet, 1e-3), (20, Method::Rk4, 0.0)]
        {
            let corner = Vec3::new(-0.5 * scale, 0.0, -0.4 * scale) + Vec3::new(3.0, -2.0, 1.0) * far;
            let sheet = Sheet { corner, sides: [Vec3::X * scale, Vec3::Z * (0.8 * scale)], cells };
            let start = flying(&sheet, vigour, 9);
            let params = StrainLimitParams {
                warp: Some([0.95, 1.01]),
                weft: Some([0.9, 1.05]),
                shear: Some(0.1),
                compliance,
                damping: if compliance > 0.0 { 0.05 } else { 0.0 },
            };
            let (limits, integrator) = (limits(&sheet, params), method.integrator());
            let scene = Scene { start: &start, constraints: &limits, substeps, integrator, ..Scene::EMPTY };
            let mut system = started(&scene, start.len(), 0);
            let turned = spin(&start, [system.particles().position, system.particles().velocity]);
            let before = Measures::of(&system, &scene);
            // Limits see places as they are rounded. Moved back by half a unit of their last digit in a sub-step, each particle gains a speed of that.
            let (mass, number) = (start.iter().map(|p| f64::from(p.mass)).sum::<f64>(), start.len() as f64);
            let speed = (2.0 * before.energy.kinetic / mass).sqrt();
            let place = start.iter().map(|p| f64::from(p.position.length())).fold(0.0, f64::max);
            let noise = f64::from(f32::EPSILON) * place * (60.0 * f64::from(substeps));
            let gain = 1.0 + 1e-5 + 2.0 * noise / (speed * number.sqrt());
            let mut energy = before.energy.kinetic * gain;
            for frame in 1..=often(120) as u64 {
                system.step_to(&scene, Time::frame(frame, 60));
                // What gives way gives back what it has taken.
                let now = Measures::of(&system, &scene).energy.kinetic;
                assert!(now < energy, "{method} {substeps} {scale}: {now} after {energy}");
                energy = if compliance > 0.0 { energy } else { energy.min(now * gain) };
            }
            let after = Measures::of(&system, &scene);
            let drift = gap(before.momentum, after.momentum) / (mass * f64::from(scale));
            assert!(drift < 2e-5, "{method} {substeps} {scale}: momentum {drift}");
            let all = system.particles();
            let lost = gap(turned, spin(&start, [all.position, all.velocity])) / gap(turned, [0.0; 3]);
            assert!(lost < 1e-3, "{method} {substeps} {scale}: angular momentum {lost}");
            assert!(after.energy.kinetic > 0.1 * before.energy.kinetic, "it goes on: {}", after.energy.kinetic);
        }
    }
}

#[test]
fn what_is_degenerate_dead_or_no_number_does_no_harm() {
    let sheet = Sheet { corner: Vec3::ZERO, sides: [Vec3::X, Vec3::Z], cells: [3, 3] };
    let tight = StrainLimitParams {
        warp: Some([1.0, 1.0]),
        weft: Some([0.99, 1.01]),
        shear: Some(0.01),
        compliance: 0.0,
        damping: 3.0,
    };
    for case in 0..9 {
        let mut start = flying(&sheet, 2.0, 4);
        let mut limits = limits(&sheet, tight);
        match case {
            0 => start.iter_mut().for_each(|p| p.fixed = true),
            1 => start.iter_mut().for_each(|p| p.position = Vec3::ONE),
            2 => start.iter_mut().for_each(|p| p.position.z = 0.0),
            3 => start[5].position.y = f32::NAN,
            4 => start[5].velocity.y = f32::INFINITY,
            5 => start[5].lifetime = 0.05,
            6 => limits.triangles.extend([[0, 0, 1], [2, 2, 2], [0, 1, 99], [u32::MAX, 1, 2]]),
            7 => limits.warp = Vec3::Y,
            _ => limits.params.compliance = 1e30,
        }
        for (dt, substeps) in [(1.0 / 60.0, 4), (1e-9, 1), (10.0, 2)] {
            let scene = Scene { start: &start, constraints: &limits, substeps, ..Scene::EMPTY };
            let mut system = started(&scene, start.len(), 0);
            run(&mut system, &scene, dt, 20);
            let all = system.particles();
            assert!(all.position.iter().chain(all.velocity).all(|x| x.is_finite()), "{case}");
            let least = start.len() - usize::from((3..=5).contains(&case));
            assert!(system.len() >= least, "{case}: {} are left of {}", system.len(), start.len());
            let all = limits.triangles.len() as u64;
            let degenerate = system.totals().caps.degenerate;
            match case {
                0 | 5 | 7 | 8 => assert_eq!(degenerate, 0, "{case}"),
                1 | 2 => assert_eq!(degenerate, all, "{case}"),
                // Two of those that are there name a corner twice.
                6 => assert_eq!(degenerate, 2),
                _ => {}
            }
        }
    }
    let nan = limits(&sheet, StrainLimitParams { warp: Some([f32::NAN, 1.0]), shear: Some(f32::NAN), ..tight });
    let start = flying(&sheet, 2.0, 4);
    let scene = Scene { start: &start, constraints: &nan, ..Scene::EMPTY };
    run(&mut started(&scene, start.len(), 0), &scene, 0.1, 10);
    for (params, name) in [
        (StrainLimitParams::default(), "warp"),
        (StrainLimitParams { warp: Some([0.02, 0.1]), ..tight }, "warp"),
        (StrainLimitParams { warp: Some([-0.1, 1.1]), ..tight }, "warp"),
        (StrainLimitParams { weft: Some([1.1, 0.9]), ..tight }, "weft"),
        (StrainLimitParams { weft: Some([0.9, f32::INFINITY]), ..tight }, "weft"),
        (StrainLimitParams { shear: Some(2.0), ..tight }, "shear"),
        (StrainLimitParams { shear: Some(f32::NAN), ..tight }, "shear"),
        (StrainLimitParams { compliance: -1.0, ..tight }, "compliance"),
        (StrainLimitParams { damping: f32::NAN, ..tight }, "damping"),
    ] {
        assert_eq!(params.fault().map(|(name, _)| name), Some(name), "{params:?}");
    }
    assert_eq!(tight.fault(), None);
}

#[test]
fn files_give_limits_to_cloth_of_springs() {
    let text = r#"{
        "particles": [{"position": [9, 9, 9]}],
        "cloths": [{
            "form": {"sheet": {"corner": [0, 0, 0], "sides": [[1, 0, 0], [0, 0, 2]], "cells": [2, 3]}}, "mass": 1,
            "springs": {"structural": {"ks": 20}}, "limits": {"warp": [0.9, 1.02], "weft": [0.8, 1.1], "shear": 0.2}, "fixed": [0]
        }],
        "constraints": [{"strain_limits": {"triangles": [[1, 2, 4]], "warp": [1, 0, 0], "params": {"warp": [0, 1.5]}}}]
    }"#;
    let file = SceneFile::from_json("a.json", text).expect("it is sound");
    assert_eq!(SceneFile::from_json("b.json", &file.to_json()), Ok(file.clone()));
    let model = Model::load(&file, "a.json", &mut ()).expect("it can be made");
    let [ConstraintKind::StrainLimits(_), ConstraintKind::StrainLimits(limits)] = &model.constraints.0[..] else {
        panic!("{:?}", model.constraints.0)
    };
    assert_eq!((limits.triangles.len(), limits.triangles[0], limits.warp), (12, [1, 2, 5], Vec3::X));
    let StrainLimitParams { warp, weft, shear, compliance, damping } = limits.params;
    assert_eq!((warp, weft, shear), (Some([0.9, 1.02]), Some([0.8, 1.1]), Some(0.2)));
    assert_eq!([compliance, damping], [0.0; 2]);
    let mut system = model.system(0, 1).expect("there is memory");
    run(&mut system, &model.scene(), 1.0 / 60.0, 10);
    for (from, to, path, message) in [
        ("[0.9, 1.02]", "[-0.1, 0.02]", "cloths[0].limits.warp", "not [-0.1, 0.02]"),
        ("[0.8, 1.1]", "[1.1, 0.8]", "cloths[0].limits.weft", "not [1.1, 0.8]"),
        ("\"shear\": 0.2", "\"shear\": -0.2", "cloths[0].limits.shear", "not -0.2"),
        ("\"shear\": 0.2", "\"compliance\": -2", "cloths[0].limits.compliance", "not -2"),
        ("\"shear\": 0.2", "\"damping\": -2", "cloths[0].limits.damping", "not -2"),
        ("{\"warp\": [0.9, 1.02], \"weft\": [0.8, 1.1], \"shear\": 0.2}", "{}", "cloths[0].limits.warp", "such as"),
        ("\"mass\": 1,", "\"mass\": 1, \"shell\": {\"stretch\": [9, 9], \"shear\": 1},", "cloths[0].limits", "shell"),
        ("[0, 1.5]", "[0, 0.5]", "constraints[0].strain_limits.warp", "such as [0.9, 1.02]"),
        ("[[1, 2, 4]]", "[[1, 2, 40]]", "constraints[0]", "particle 40 is out of range"),
    ] {
        let file = SceneFile::from_json("a.json", &text.replace(from, to)).expect("it is a scene");
        let error = Model::load(&file, "a.json", &mut ()).expect_err(to).to_string();
        assert!(error.contains(path) && error.contains(message), "{to}: {error}");
    }
}
