//! Ties of particles to places on other bodies, against closed forms: what they keep, how far they give way, and what does them no harm.

use pointmass::constrain::{ShapeMatching, Tie};
use pointmass::{Constraint, Drag, Gravity, Measures, Method, Particle, Rope, Scene, Time, Vec3};
use pointmass_tests::{Random, f64s, gap, is_run, run, started};

/// The place on a body, in double precision, by its particles' shares and an offset along their normal.
fn place(x: &[Vec3], to: &[u32], weights: &[f32], offset: f32) -> [f64; 3] {
    let at = |i: usize| f64s(x[to[i] as usize]);
    let mut sum = [0.0; 3];
    for (i, &weight) in weights.iter().enumerate() {
        sum = core::array::from_fn(|k| sum[k] + f64::from(weight) * at(i)[k]);
    }
    if offset != 0.0 {
        let edge = |i: usize| -> [f64; 3] { core::array::from_fn(|k| at(i)[k] - at(0)[k]) };
        let (a, b) = (edge(1), edge(2));
        let n = [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
        let size = n.iter().map(|x| x * x).sum::<f64>().sqrt();
        sum = core::array::from_fn(|k| sum[k] + f64::from(offset) * n[k] / size);
    }
    sum
}

/// A body of so many particles somewhere in a room of a size, and one more that is tied to it, all on their ways.
fn thrown(random: &mut Random, count: usize, scale: f32) -> Vec<Particle> {
    let (position, velocity) = (random.vector(2.0 * scale), random.vector(scale));
    let mut one = || Particle {
        position: position + random.vector(0.5 * scale),
        velocity: velocity + random.vector(0.5 * scale),
        mass: random.between(0.2, 1.2),
        ..Particle::REST
    };
    (0..=count).map(|_| one()).collect()
}

#[test]
fn ties_keep_momentum_and_place() {
    let mut random = Random::new(5);
    let mut failures = vec![];
    for (round, method) in Method::ALL.iter().enumerate() {
        for count in [1usize, 2, 3, 4, 8] {
            for (substeps, compliance) in [(1u32, 0.0f32), (7, 0.0), (2, 2e-3), (9, 2e-2)] {
                let scale = [1.0f32, 0.05, 30.0][(round + count) % 3];
                let mut start = thrown(&mut random, count, scale);
                let to: Vec<u32> = (0..count as u32).collect();
                // Of one or two the place is on them.
                match count {
                    1 => start[1].position = start[0].position,
                    2 => start[2].position = start[0].position.lerp(start[1].position, 0.3),
                    _ => {}
                }
                let tie = Tie { compliance, damping: 0.1, ..Tie::rigid(count as u32, to.clone()) };
                let body = ShapeMatching::rigid(to.clone());
                let rod = Rope::rigid([0, 1], [start[0].position.distance(start[count.min(1)].position)]);
                let both = ((count > 2).then_some(body), (count == 2).then_some(rod), &tie);
                let parts = Scene { start: &start, constraints: &both, ..Scene::EMPTY };
                let scene = Scene { substeps, integrator: method.integrator(), ..parts };
                let mut system = started(&scene, start.len(), 0);
                let before = Measures::of(&system, &scene);
                run(&mut system, &scene, 1.0 / 120.0, 60);
                let after = Measures::of(&system, &scene);
                let mass: f64 = start.iter().map(|p| f64::from(p.mass)).sum();
                let (unit, name) = (mass * f64::from(scale), format!("{method}, {count}, {substeps}, {compliance}"));
                let lost = gap(before.momentum, after.momentum) / unit;
                let turned = gap(before.angular_momentum, after.angular_momentum) / (unit * f64::from(scale));
                // A cluster that is drawn far out of shape in a sub-step loses a little by itself.
                let turns = if substeps == 1 { 3e-3 } else { 1e-3 };
                let gained = after.energy.total() / before.energy.total() - 1.0;
                if !(lost < 1e-4 && (turned < turns || count == 1 && compliance > 0.0) && gained < 1e-3) {
                    failures.push(format!("{name}: {lost:.1e}, {turned:.1e}, {gained:.1e}"));
                }
            }
        }
    }
    assert!(failures.is_empty(), "{} {failures:#?}", failures.len());
}

/// Bodies that hang from what is fixed, or from which something hangs: how far from its place the tied particle comes to rest.
#[test]
fn what_hangs_by_a_tie_is_as_far_away_as_its_compliance_says() {
    let mut cases = 0;
    for (round, method) in Method::ALL.iter().enumerate() {
        for (substeps, compliance, mass) in [(1u32, 0.01f32, 0.1f32), (4, 1e-3, 2.0), (10, 0.5, 1e-3), (5, 0.0, 1.0)] {
            for count in [1usize, 2, 3, 4, 8] {
                for is_held in [false, true] {
                    if !is_run(&mut cases) {
                        continue;
                    }
                    let scale = [1.0f32, 0.1, 20.0][(round + count) % 3];
                    let (step, g) = (f64::from(scale).sqrt() / 60.0, 10.0);
                    let compliance = compliance * scale;
                    let corner = |i: usize| Vec3::new((i & 1) as f32, (i >> 2) as f32, (i >> 1 & 1) as f32) * scale;
                    let part = Particle { mass, drag: 4.0 * mass / scale.sqrt(), ..Particle::REST };
                    let body = (0..count).map(|i| Particle { position: corner(i), fixed: !is_held, ..part });
                    let spot = [0.0, 0.5, 0.3, 0.4, 0.5][count.div_ceil(2)] * scale;
                    let position = match count {
                        1 => Vec3::ZERO,
                        2 => Vec3::X * spot,
                        // Above their plane, or in it.
                        3 => Vec3::new(spot, 0.2 * scale, spot),
                        4 => Vec3::new(spot, 0.0, spot),
                        // By the top or from the bottom.
                        _ => Vec3::new(spot, if is_held { scale } else { 0.0 }, spot),
                    };
                    let mut start: Vec<_> = body.collect();
                    start.push(Particle { position, fixed: is_held, ..part });
                    let to: Vec<u32> = (0..count as u32).collect();
                    let tie = Tie { compliance, ..Tie::rigid(count as u32, to.clone()) };
                    let rod = (count == 2).then_some(Rope::rigid([0, 1], [scale]));
                    let bonds = ((count > 2).then_some(ShapeMatching::rigid(to)), rod, tie);
                    let forces = (Gravity { acceleration: Vec3::NEG_Y * g }, Drag {});
                    let parts = Scene { start: &start, forces: &forces, constraints: &bonds, ..Scene::EMPTY };
                    let scene = Scene { substeps, integrator: method.integrator(), ..parts };
                    let mut system = started(&scene, start.len(), 0);
                    run(&mut system, &scene, step, 900);
                    let x = system.particles().position;
                    let shares = |x: Vec3| match count {
                        1 => vec![1.0],
                        2 => vec![1.0 - x.x, x.x],
                        3 => vec![1.0 - x.x - x.z, x.x, x.z],
                        4 => [[-1.0, -1.0], [1.0, -1.0], [-1.0, 1.0], [1.0, 1.0]]
                            .map(|[a, b]| 0.25 * (1.0 + a * (2.0 * x.x - 1.0) + b * (2.0 * x.z - 1.0)))
                            .to_vec(),
                        _ => {
                            (0..8).map(|i| 0.125 * (1.0 + 2.0 * (corner(i) / scale - 0.5).dot(2.0 * x - 1.0))).collect()
                        }
                    };
                    let numbers: Vec<u32> = (0..count as u32).collect();
                    let to = place(x, &numbers, &shares(position / scale), if count == 3 { -position.y } else { 0.0 });
                    let below = to[1] - f64::from(x[count].y);
                    let below = if is_held { -below } else { below };
                    let hung = if is_held { count as f64 } else { 1.0 };
                    let expected = f64::from(compliance) * f64::from(mass * g) * hung;
                    let off = (below - expected).abs();
                    let name = format!("{method}, {count}, {substeps}, {compliance} m/N, {scale} m, {is_held}");
                    // Beside what else holds a body it is met once a sub-step.
                    let falls = f64::from(g) * (step / f64::from(substeps)).powi(2);
                    assert!(
                        off < 0.01 * expected + hung.max(2.0) * falls + 1e-5 * f64::from(scale),
                        "{name}: {below} m, not {expected} m"
                    );
                }
            }
        }
    }
}

/// The shares that are learnt are those that are given, wherever the particles stand among all.
#[test]
fn places_that_are_given_are_those_that_are_learnt() {
    let mut random = Random::new(9);
    for (round, method) in Method::ALL.iter().enumerate() {
        let corners = [Vec3::ZERO, Vec3::X, Vec3::Y];
        let weights = [0.5, 0.125, 0.375];
        let spot = Vec3::new(0.125, 0.375, 0.25);
        let part = |position| Particle { position, velocity: Vec3::new(0.3, -0.2, 0.1), ..Particle::REST };
        let others: Vec<_> = (0..round).map(|_| part(random.vector(3.0))).collect();
        let first = others.len() as u32;
        let start: Vec<_> = others.into_iter().chain(corners.map(part)).chain([part(spot)]).collect();
        let to = [first, first + 1, first + 2];
        let learnt = Tie { compliance: 1e-3, ..Tie::rigid(first + 3, to) };
        let given =
            Tie { particle: first + 3, to, weights: Some(weights), offset: 0.25, compliance: 1e-3, damping: 0.0 };
        assert_eq!((learnt.fault(), given.fault()), (None, None));
        let spin = |x: Vec3| Vec3::new(0.2, -0.5, 0.4).cross(x);
        let start: Vec<_> = start.iter().map(|p| Particle { velocity: p.velocity + spin(p.position), ..*p }).collect();
        let body = ShapeMatching::rigid(to);
        let ends = [&learnt as &dyn Constraint, &given].map(|tie| {
            let both = (&body, tie);
            let parts = Scene { start: &start, constraints: &both, forces: &Gravity::EARTH, ..Scene::EMPTY };
            let scene = Scene { substeps: 3, integrator: method.integrator(), ..parts };
            let mut system = started(&scene, start.len(), 0);
            run(&mut system, &scene, 1.0 / 60.0, 60);
            system.particles().position.to_vec()
        });
        assert_eq!(ends[0], ends[1], "{method}");
        let at = place(&ends[0], &to, &weights, 0.25);
        let off = gap(at, f64s(ends[0][first as usize + 3]));
        assert!(off < 1e-3, "{method}: {off}");
    }
}

#[test]
fn ties_that_cannot_act_do_no_harm() {
    let part = |position| Particle { position, velocity: Vec3::X, mass: 1.0, ..Particle::REST };
    let spots = [
        [Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::splat(0.5)],
        // On one line, and all in one place.
        [Vec3::ZERO, Vec3::X, Vec3::X * 2.0, Vec3::splat(0.5)],
        [Vec3::ONE; 4],
        [Vec3::splat(1e30), Vec3::splat(-1e30), Vec3::X * 1e30, Vec3::ZERO],
        [Vec3::splat(1e-30), Vec3::ZERO, Vec3::X * 1e-30, Vec3::ZERO],
    ];
    for (number, spots) in spots.into_iter().enumerate() {
        for fixed in 0..16u32 {
            for (to, given) in [(vec![0u32, 1, 2], false), (vec![0, 1, 2], true), (vec![0, 1], false), (vec![2], false)]
            {
                for compliance in [0.0f32, 1e-3] {
                    let mut start = spots.map(part).to_vec();
                    (0..4).for_each(|i| start[i].fixed = fixed >> i & 1 == 1);
                    let tie = Tie {
                        particle: 3,
                        weights: given.then(|| vec![-1.0, 4.0, -2.0]),
                        offset: if given { 3.0 } else { 0.0 },
                        to: to.clone(),
                        compliance,
                        damping: 1.0,
                    };
                    let scene = Scene { start: &start, constraints: &tie, substeps: 2, ..Scene::EMPTY };
                    let mut system = started(&scene, start.len(), 0);
                    run(&mut system, &scene, 1.0 / 60.0, 30);
                    let name = format!("{number} {fixed} {to:?} {given} {compliance}");
                    let alive = system.particles().position.len();
                    assert!(alive == 4 || number == 3, "{name}: {alive}");
                    let still = (0..4).filter(|&i| start[i].fixed);
                    let moved = still.clone().filter(|&i| {
                        alive == 4 && {
                            let end = start[i].position + start[i].velocity * 0.5;
                            system.particles().position[i].distance(end) > 1e-4 * (1.0 + end.length())
                                && system.particles().position[i] != start[i].position
                        }
                    });
                    assert_eq!(moved.count(), 0, "{name}");
                }
            }
        }
    }
    // Whoever has lost an end, or names one that never was, is let go.
    let mut start = spots[0].map(part);
    start[1].lifetime = 0.1;
    for to in [[0u32, 1, 2], [0, 9, 2]] {
        let tie = Tie::rigid(3, to);
        let scene = Scene { start: &start, constraints: &tie, forces: &Drag {}, ..Scene::EMPTY };
        let mut system = started(&scene, start.len(), 0);
        run(&mut system, &scene, 1.0 / 60.0, 20);
        let velocity = system.particles().velocity.to_vec();
        system.step_to(&scene, Time::from_seconds(1.0));
        assert_eq!(velocity, system.particles().velocity, "{to:?}");
    }
}

#[test]
fn what_cannot_be_tied_is_named() {
    let sound = Tie {
        weights: Some([0.5, 0.25, 0.25]),
        particle: 3,
        to: [0, 1, 2],
        offset: 0.0,
        compliance: 0.0,
        damping: 0.0,
    };
    let faults = [
        (Tie { particle: 2, ..sound }, "to"),
        (Tie { weights: Some([0.5, 0.5, 0.25]), ..sound }, "weights"),
        (Tie { weights: Some([f32::NAN; 3]), ..sound }, "weights"),
        (Tie { weights: None, offset: 0.1, ..sound }, "offset"),
        (Tie { offset: f32::INFINITY, ..sound }, "offset"),
        (Tie { compliance: -1.0, ..sound }, "compliance"),
        (Tie { damping: f32::NAN, ..sound }, "damping"),
    ];
    for (tie, name) in faults {
        assert_eq!(tie.fault().map(|(name, _)| name), Some(name), "{tie:?}");
    }
    assert_eq!(sound.fault(), None);
    let nothing: [u32; 0] = [];
    assert_eq!(Tie::rigid(3, nothing).fault().map(|(name, _)| name), Some("to"));
}
