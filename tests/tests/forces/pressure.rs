//! Gas in a closed mesh.

use super::forces;
use pointmass::constrain::{Shell, ShellParams, mesh_hinges};
use pointmass::shape::Plane;
use pointmass::{Drag, Force, Gravity, Method, Particle, Pressure, Scene, Spring, Time, Vec3};
use pointmass_tests::{Random, every, f64s, gap, icosahedron, often, run, started};

type Mesh = Vec<[u32; 3]>;

/// A ball of 162 corners about a place, a little dented.
fn ball(center: Vec3, dent: f32) -> (Vec<Particle>, Mesh) {
    let (mut corners, mut triangles) = icosahedron();
    for _ in 0..2 {
        let mut halves = std::collections::HashMap::new();
        let mut finer = vec![];
        for [a, b, c] in triangles {
            let [ab, bc, ca] = [(a, b), (b, c), (c, a)].map(|(a, b)| {
                *halves.entry((a.min(b), a.max(b))).or_insert_with(|| {
                    corners.push((corners[a as usize] + corners[b as usize]).normalize());
                    corners.len() as u32 - 1
                })
            });
            finer.extend([[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]);
        }
        triangles = finer;
    }
    let mut random = Random::new(3);
    let particle = |place: &Vec3| Particle { position: center + *place + random.vector(dent), ..Particle::REST };
    (corners.iter().map(particle).collect(), triangles)
}

fn volume(start: &[Particle], triangles: &Mesh) -> f64 {
    let at = |corner: u32| {
        let (a, b) = (f64s(start[corner as usize].position), f64s(start[0].position));
        [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
    };
    let six = |&[a, b, c]: &[u32; 3]| {
        let [a, b, c] = [at(a), at(b), at(c)];
        (0..3).map(|i| a[i] * (b[(i + 1) % 3] * c[(i + 2) % 3] - b[(i + 2) % 3] * c[(i + 1) % 3])).sum::<f64>()
    };
    triangles.iter().map(six).sum::<f64>() / 6.0
}

#[test]
fn it_presses_outward_by_the_gas_law_and_on_nobody_in_all() {
    for (center, dent, tolerance) in [(Vec3::ZERO, 0.0, 5e-6), (Vec3::X, 0.05, 5e-6), (Vec3::splat(1000.0), 0.0, 3e-4)]
    {
        let (start, triangles) = ball(center, dent);
        let scene = Scene { start: &start, ..Scene::EMPTY };
        let system = started(&scene, start.len(), 0);
        let v = volume(&start, &triangles);
        for (amount, outside) in [(3.0, 0.0), (3.0, 0.2), (0.0, 1.5)] {
            let gas = Pressure { triangles: &triangles, amount, outside };
            let p = f64::from(amount) / v - f64::from(outside);
            let all = forces(&system, &scene, &gas);
            let sum = all.iter().fold([0.0; 3], |sum, f| core::array::from_fn(|k| sum[k] + f64::from(f[k])));
            let size: f64 = all.iter().map(|f| f64::from(f.length())).sum();
            assert!(gap(sum, [0.0; 3]) < 1e-6 * size, "{sum:?} of {size}");
            // The work of growing by a share of itself is 3 p V.
            let outward: f64 = all.iter().zip(&start).map(|(f, x)| f64::from(f.dot(x.position - center))).sum();
            assert!((outward / (3.0 * p * v) - 1.0).abs() < tolerance, "{outward} at {center}");
        }
    }
}

#[test]
fn a_balloon_rests_where_its_skin_holds_the_gas() {
    let (start, triangles) = ball(Vec3::Y, 0.0);
    let v = volume(&start, &triangles);
    let mut springs: Vec<Spring> = vec![];
    for &[a, b, c] in &triangles {
        for [a, b] in [[a, b], [b, c], [c, a]] {
            if a < b {
                let d = (start[a as usize].position - start[b as usize].position).length();
                springs.push(Spring::new([a, b], d * 0.8, 40.0));
            }
        }
    }
    // Grown by a share, springs and gas do the same work: Σ k (l − l₀) l = 3 p V.
    let length = |s: &Spring| f64::from(s.rest_length) / 0.8;
    let skin: f64 = springs.iter().map(|s| 40.0 * 0.2 * length(s) * length(s)).sum();
    let p = skin / (3.0 * v);
    let amount = ((p + 0.5) * v) as f32;
    let gas = Pressure { triangles: &triangles, amount, outside: 0.5 };
    let damped: Vec<Particle> =
        start.iter().map(|p| Particle { position: Vec3::Y + (p.position - Vec3::Y) * 1.1, drag: 3.0, ..*p }).collect();
    let radius = |start: &[Vec3]| {
        let middle = start.iter().copied().sum::<Vec3>() / start.len() as f32;
        start.iter().map(|x| (*x - middle).length()).sum::<f32>() / start.len() as f32
    };
    for method in [Method::Rk4, Method::Implicit] {
        let all = (&gas, Drag {});
        let integrator = method.integrator();
        let scene = Scene { start: &damped, springs: &springs, forces: &all, integrator, ..Scene::EMPTY };
        let mut system = started(&scene, start.len(), 0);
        run(&mut system, &scene, 0.01, often(1500).max(500) as u32);
        // Springs differ a little in length, so it rests in a shape a little different from the ball.
        let r = radius(system.particles().position);
        assert!((r - 1.0).abs() < 5e-3, "{method}: {r}");
        let fastest = system.particles().velocity.iter().map(|v| v.length()).fold(0.0, f32::max);
        assert!(fastest < 1e-2, "{method}: {fastest}");
    }
}

/// How damped a skin is hardly counts where it is at rest, where sub-steps are so short that the gas moves it by little in each.
#[test]
fn a_balloon_rests_where_its_skin_holds_the_gas_however_damped_that_is() {
    let (start, triangles) = ball(Vec3::ZERO, 0.0);
    let start: Vec<Particle> = start.into_iter().map(|p| Particle { mass: 2e-3, drag: 0.01, ..p }).collect();
    let all: Vec<u32> = (0..start.len() as u32).collect();
    let gas = Pressure { triangles: &triangles, amount: 400.0, outside: 0.0 };
    let radius = |damping: f32, substeps: u32, method: Method| {
        let params = ShellParams { stretch: [150.0; 2], shear: 60.0, bending: 1e-4, damping };
        let hinges = mesh_hinges(&triangles);
        let skin = Shell { particles: &all[..], triangles: &triangles[..], hinges, warp: Vec3::X, params };
        let forces = (&gas, Drag {});
        let integrator = method.integrator();
        let scene = Scene { start: &start, forces: &forces, constraints: &skin, substeps, integrator, ..Scene::EMPTY };
        let mut system = started(&scene, start.len(), 0);
        run(&mut system, &scene, 1.0 / 60.0, 90);
        let x = system.particles().position;
        x.iter().map(|x| x.length()).sum::<f32>() / x.len() as f32
    };
    let right = radius(0.0, 12, Method::Verlet);
    assert!(right > 1.15, "{right}");
    for (damping, substeps, method) in
        [(0.05, 5, Method::Symplectic), (0.002, 10, Method::Verlet), (0.2, 8, Method::Implicit)]
            .into_iter()
            .step_by(every(2))
    {
        let r = radius(damping, substeps, method);
        assert!((r / right - 1.0).abs() < 5e-3, "{damping} s, {method} in {substeps}: {r}, not {right}");
    }
}

/// A ball of sheet that gas holds up bounces off a smooth floor, whatever its size, comes back about as high in any sub-steps, and goes along the floor as gravity
/// has it, beside another that falls freely and is of the same shell.
#[test]
fn an_inflated_ball_bounces_off_a_floor_and_slides_along() {
    let (unit, faces) = ball(Vec3::ZERO, 0.0);
    let both = |size: f32| {
        let at = |up: f32| {
            move |p: &Particle| Particle {
                position: p.position * size + Vec3::Y * up * size,
                mass: size * size * 3e-3,
                ..*p
            }
        };
        unit.iter().map(at(2.5)).chain(unit.iter().map(at(200.0))).collect::<Vec<_>>()
    };
    let count = unit.len() as u32;
    let upper: Mesh = faces.iter().map(|face| face.map(|corner| corner + count)).collect();
    let all: Vec<u32> = (0..2 * count).collect();
    let triangles = [&faces[..], &upper[..]].concat();
    let floor = Plane { point: Vec3::ZERO, normal: Vec3::Y };
    let bounce = |size: f32, substeps: u32, method: Method| {
        let start = both(size);
        // Lengths by a size, times by its root, and masses by its square: forces go by its square, and the gas by its cube.
        let params = ShellParams {
            stretch: [400.0 * size; 2],
            shear: 200.0 * size,
            bending: 1e-4 * size.powi(3),
            damping: 0.01 * size.sqrt(),
        };
        let skin = Shell {
            particles: &all[..],
            triangles: &triangles[..],
            hinges: mesh_hinges(&triangles),
            warp: Vec3::X,
            params,
        };
        let gas = |triangles| Pressure { triangles, amount: 400.0 * size.powi(3), outside: 0.0 };
        let forces = (Gravity { acceleration: Vec3::new(1.5, -9.5, 0.0) }, gas(&faces), gas(&upper));
        let scene = Scene {
            start: &start,
            forces: &forces,
            constraints: &skin,
            colliders: &floor,
            substeps,
            integrator: method.integrator(),
            ..Scene::EMPTY
        };
        let mut system = started(&scene, start.len(), 0);
        let (dt, mut heights) = (f64::from(size).sqrt() / 30.0, vec![]);
        for frame in 1..=60 {
            system.step(&scene, Time::from_seconds_f64(dt * f64::from(frame)) - system.time());
            let x = &system.particles().position[..count as usize];
            heights.push(x.iter().map(|x| x.y).sum::<f32>() / (count as f32 * size));
        }
        assert_eq!(system.totals().caps.crushed, 0, "{size} m, {method}");
        let (v, t) = (system.particles().velocity, 60.0 * dt as f32);
        let mean = |v: &[Vec3]| v.iter().copied().sum::<Vec3>() / count as f32;
        let [low, high] = [mean(&v[..count as usize]), mean(&v[count as usize..])];
        assert!((low.x / (1.5 * t) - 1.0).abs() < 0.05, "{size} m, {method} in {substeps}: {low}, not {}", 1.5 * t);
        assert!((high.y / (-9.5 * t) - 1.0).abs() < 0.01, "{size} m, {method} in {substeps}: {high}");
        let lowest = heights.iter().position(|&y| y == heights.iter().copied().fold(9.0, f32::min)).unwrap_or(0);
        (heights[lowest], heights[lowest..].iter().copied().fold(0.0, f32::max))
    };
    let right = bounce(1.0, 16, Method::Symplectic);
    let cases = [
        (0.2, 4, Method::Symplectic),
        (0.2, 8, Method::Verlet),
        (5.0, 4, Method::Midpoint),
        (1.0, 6, Method::Rk4),
        (0.03, 5, Method::Symplectic),
        (1.0, 8, Method::Implicit),
    ];
    for (size, substeps, method) in cases.into_iter().step_by(every(3)) {
        let (low, high) = bounce(size, substeps, method);
        assert!((low - right.0).abs() < 0.03, "{size} m, {method} in {substeps}: {low}, not {}", right.0);
        assert!((high - right.1).abs() < 0.45, "{size} m, {method} in {substeps}: {high}, not {}", right.1);
    }
}

#[test]
fn what_has_collapsed_or_lost_corners_is_let_alone() {
    let (start, triangles) = ball(Vec3::ZERO, 0.0);
    let gas = Pressure { triangles: &triangles, amount: 1.0, outside: 0.0 };
    let act = |change: &dyn Fn(Vec3) -> Vec3| {
        let start: Vec<Particle> = start.iter().map(|p| Particle { position: change(p.position), ..*p }).collect();
        let scene = Scene { start: &start, ..Scene::EMPTY };
        forces(&started(&scene, start.len(), 0), &scene, &gas)
    };
    assert!(act(&|x| x * 1e-3).iter().all(|f| f.length() > 1.0), "small is not collapsed");
    assert!(act(&|x| x * Vec3::new(1.0, 1.0, 0.02)).iter().any(|f| f.length() > 0.1), "nor is flat");
    let nothing = vec![Vec3::ZERO; start.len()];
    assert_eq!(act(&|x| x * Vec3::new(1.0, 1.0, 1e-4)), nothing);
    assert_eq!(act(&|_| Vec3::ONE), nothing);
    assert_eq!(act(&|x| -x), nothing);

    // A corner dies: its triangles go with it, the others feel the gas on.
    let scene = Scene { start: &start, forces: &gas, ..Scene::EMPTY };
    let mut system = started(&scene, start.len(), 0);
    let id = system.id(0).expect("it lives");
    assert!(system.remove(&scene, id));
    let left = forces(&system, &scene, &gas);
    let whole = act(&|x| x);
    let touched = |corner: u32| triangles.iter().any(|t| t.contains(&0) && t.contains(&corner));
    for (row, f) in left.iter().enumerate() {
        let corner = if row == 0 { start.len() - 1 } else { row };
        let same = gap(f64s(*f), f64s(whole[corner])) < 0.05 * f64::from(whole[corner].length());
        assert!(same != touched(corner as u32), "corner {corner}: {f} was {}", whole[corner]);
    }
    system.step(&scene, Time::from_seconds(0.01));
    // One that never came, and none at all.
    let none: [&dyn Force; 2] = [
        &Pressure { triangles: [[9000, 9001, 9002]], amount: 1.0, outside: 0.0 },
        &Pressure { triangles: Vec::<[u32; 3]>::new(), amount: 1.0, outside: 0.0 },
    ];
    for force in none {
        assert!(forces(&system, &scene, force).iter().all(|&f| f == Vec3::ZERO));
    }
}
