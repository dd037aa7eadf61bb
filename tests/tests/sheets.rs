//! Thin shells against closed forms: how strips bend and stretch, how sheets hang, what they keep, and what does them no harm.

use pointmass::constrain::{Hinge, Shell, ShellParams, mesh_hinges};
use pointmass::force::{Aerodynamics, Uniform};
use pointmass::scene::{Model, SceneFile};
use pointmass::{
    ConstraintKind, Drag, Force, ForceKind, Gravity, Heap, Measures, Method, Particle, Scene, Sheet, System, Time, Vec3,
};
use pointmass_tests::{Random, every, gap, is_run, often, run, started};

const G: f32 = 9.81;
const DOWN: Gravity = Gravity { acceleration: Vec3::new(0.0, -G, 0.0) };

type Cloth = Shell<Vec<u32>, Vec<[u32; 3]>, Vec<Hinge>>;

/// A sheet's constraint, its particles being the scene's first.
fn shell(sheet: &Sheet, params: ShellParams) -> Cloth {
    Shell {
        particles: (0..sheet.positions().count() as u32).collect(),
        triangles: sheet.triangles().collect(),
        hinges: sheet.hinges().collect(),
        warp: sheet.sides[0],
        params,
    }
}

/// The particles of a sheet, each with a third of the mass of its triangles; `density` in kg/m².
fn particles(sheet: &Sheet, density: f32) -> Vec<Particle> {
    let mut all: Vec<Particle> = sheet.particles(Particle { mass: 0.0, ..Particle::REST }).collect();
    for corners in sheet.triangles() {
        let [a, b, c] = corners.map(|corner| all[corner as usize].position);
        let third = (b - a).cross(c - a).length() / 6.0;
        corners.iter().for_each(|&corner| all[corner as usize].mass += density * third);
    }
    all
}

/// The same in all directions.
fn even(stretch: f32, bending: f32, damping: f32) -> ShellParams {
    ShellParams { stretch: [stretch; 2], shear: stretch / 2.0, bending, damping }
}

#[test]
fn a_strip_clamped_at_one_end_sags_like_a_plate() {
    let (long, wide, density) = (0.3f32, 0.06f32, 0.2f32);
    let mut methods = Method::ALL.iter().cycle();
    for (cells, scale, far) in [(8u32, 1.0f32, Vec3::ZERO), (11, 4.0, Vec3::new(3.0, 0.0, -8.0)), (13, 1.0, Vec3::ONE)]
    {
        for (substeps, mirrored) in [(10, false), (20, true), (50, false)] {
            let (long, wide) = (long * scale, wide * scale);
            // The clamp is at the second of two rows that are fixed.
            let cell = long / (cells as f32 - 1.0);
            let across = (wide / cell).ceil() as u32;
            let side = if mirrored { Vec3::NEG_Z } else { Vec3::Z } * wide;
            let sides = [Vec3::X * (cell * cells as f32), side];
            let sheet = Sheet { corner: far - Vec3::X * cell, sides, cells: [cells, across] };
            // It is to sag by a fiftieth of its length.
            let sag = 0.02 * long;
            let bending = density * G * long.powi(4) / (8.0 * sag);
            let slowest = 3.516 * (bending / (density * long.powi(4))).sqrt();
            let mut start = particles(&sheet, density);
            for particle in &mut start {
                particle.fixed = particle.position.x - far.x < 0.1 * cell;
            }
            let method = methods.next().expect("there is always a next one");
            let (shell, integrator) = (shell(&sheet, even(4e3 * scale, bending, 0.0)), method.integrator());
            let scene =
                Scene { start: &start, forces: &DOWN, constraints: &shell, substeps, integrator, ..Scene::EMPTY };
            let mut system = started(&scene, start.len(), 0);
            // Undamped it swings about where it would hang: three times, each counting as much as a window rises.
            let frames = (60.0 * 3.0 * std::f32::consts::TAU / slowest) as u32;
            let (mut sum, mut weights) = (0.0, 0.0);
            for frame in 1..=frames {
                system.step_to(&scene, Time::frame(frame.into(), 60));
                let ends = (0..=across).map(|row| system.particles().position[sheet.number(cells, row) as usize].y);
                let weight = (frame as f32 / frames as f32 * std::f32::consts::PI).sin().powi(2);
                sum += weight * (far.y - ends.sum::<f32>() / (across + 1) as f32);
                weights += weight;
            }
            let has = sum / weights;
            assert!((has / sag - 1.0).abs() < 0.03, "{method}, {cells} cells, {substeps} sub-steps: {}", has / sag);
        }
    }
}

/// A curtain hangs as far as its material gives, however long a sub-step is and however damped it is: gravity takes it on by a half of a cell and more there.
#[test]
fn a_curtain_hangs_as_far_in_one_sub_step() {
    for (size, stretch, density, rate, method) in [
        (0.1f32, 10.0f32, 0.2f32, 60u64, Method::Rk4),
        (1.0, 100.0, 0.3, 24, Method::Symplectic),
        (0.2, 30.0, 0.2, 50, Method::Implicit),
    ] {
        for damping in [0.0, 0.003, 0.05, 0.1].into_iter().step_by(every(2)) {
            let sheet = Sheet { corner: Vec3::ZERO, sides: [Vec3::X * size, Vec3::NEG_Y * size], cells: [16, 16] };
            let mut start = particles(&sheet, density);
            for (i, particle) in start.iter_mut().enumerate() {
                (particle.fixed, particle.drag) = (i < 17, 10.0 * particle.mass);
            }
            let (shell, integrator) = (shell(&sheet, even(stretch, 1e-5, damping)), method.integrator());
            let forces = (DOWN, Drag {});
            let scene = Scene { start: &start, forces: &forces, constraints: &shell, integrator, ..Scene::EMPTY };
            let mut system = started(&scene, start.len(), 0);
            run(&mut system, &scene, 1.0 / rate as f64, 3 * rate as u32);
            // A row below another carries that much less; the half of a cell that the last row stands for is at its middle.
            let gives = 0.5 * density * G * size * size / stretch;
            let has = -system.particles().position[sheet.number(8, 16) as usize].y - size;
            assert!((has / gives - 1.0).abs() < 0.15, "{method}, damped by {damping} s: {has}, not {gives}");
        }
    }
}

/// A plate of metal, a thousand times as stiff against stretching as against what bends it in a sub-step, is solved whatever its mesh, and whoever of it is
/// fixed.
#[test]
fn a_stiff_plate_is_solved_whatever_its_mesh() {
    let (long, wide, density, young, thickness) = (1.0f32, 0.3f32, 11.6f32, 7e10f32, 4.3e-3f32);
    let bending = young * thickness.powi(3) / 12.0;
    let sag = density * G * long.powi(4) / (8.0 * bending);
    let mut cases = 0;
    for (along, across) in [(20u32, 6u32), (12, 5), (13, 4), (17, 9), (24, 7), (15, 5)] {
        for substeps in [20, 8, 50] {
            if !is_run(&mut cases) {
                continue;
            }
            let cell = long / along as f32;
            let sides = [Vec3::X * (long + cell), Vec3::Z * wide];
            let sheet = Sheet { corner: Vec3::NEG_X * cell, sides, cells: [along + 1, across] };
            let mut start = particles(&sheet, density);
            for particle in &mut start {
                particle.fixed = particle.position.x < 0.1 * cell;
            }
            let shell = shell(&sheet, even(young * thickness, bending, 0.02));
            let scene = Scene { start: &start, forces: &DOWN, constraints: &shell, substeps, ..Scene::EMPTY };
            let mut system = started(&scene, start.len(), 0);
            run(&mut system, &scene, 1.0 / 60.0, 50);
            let effort = &system.totals().effort;
            assert_eq!(effort.capped, 0, "{along} by {across}, {substeps} sub-steps");
            assert!(effort.iterations < 100 * effort.solves, "{} in {}", effort.iterations, effort.solves);
            let has = -system.particles().position[sheet.number(along + 1, 0) as usize].y / sag;
            assert!((has - 1.0).abs() < 0.05, "{along} by {across}, {substeps} sub-steps: {has}");
        }
    }
}

/// A curtain held along its upper edge: at every height it carries what is below.
#[test]
fn a_strip_that_hangs_stretches_by_its_weight() {
    for (cells, substeps, method, turned) in [
        ([2u32, 4u32], 3, Method::Symplectic, false),
        ([3, 8], 6, Method::Verlet, true),
        ([2, 11], 12, Method::Rk4, false),
    ] {
        let (long, density, stretch) = (0.5f32, 0.3f32, 400.0f32);
        // The long side along the weft, or along the warp.
        let (sides, cells) = if turned {
            ([Vec3::NEG_Y * long, Vec3::X * 0.1], [cells[1], cells[0]])
        } else {
            ([Vec3::X * 0.1, Vec3::NEG_Y * long], cells)
        };
        let sheet = Sheet { corner: Vec3::ZERO, sides, cells };
        let mut start = particles(&sheet, density);
        for particle in &mut start {
            particle.fixed = particle.position.y == 0.0;
        }
        let (mine, other) = if turned { (0, 1) } else { (1, 0) };
        let mut params = even(stretch, 1e-5, 0.01);
        params.stretch[other] = 3.0 * stretch;
        params.stretch[mine] = stretch;
        let (shell, integrator) = (shell(&sheet, params), method.integrator());
        let scene = Scene { start: &start, forces: &DOWN, constraints: &shell, substeps, integrator, ..Scene::EMPTY };
        let mut system = started(&scene, start.len(), 0);
        run(&mut system, &scene, 1.0 / 60.0, 60);
        // Particles along the lower edge have unequal shares of the mass; their mean counts.
        let ends: Vec<_> = sheet.positions().enumerate().filter(|(_, place)| place.y < 1e-4 - long).collect();
        let low = ends.iter().map(|&(i, _)| -system.particles().position[i].y).sum::<f32>() / ends.len() as f32;
        let longer = density * G * long * long / (2.0 * stretch);
        // Green's strain is stiffer by one and a half times the strain, which is up to 0.4 %.
        assert!(((low - long) / longer - 1.0).abs() < 0.015, "{method}: {}", (low - long) / longer);
    }
}

/// The lowest point and the longest edge, of so many cells a side, of a metre of cloth that hangs by two corners.
fn hung(cells: u32, substeps: u32) -> [f32; 2] {
    let sheet = Sheet { corner: Vec3::ZERO, sides: [Vec3::X, Vec3::NEG_Y], cells: [cells; 2] };
    let mut start = particles(&sheet, 0.2);
    start.iter_mut().for_each(|particle| particle.drag = 4.0 * particle.mass);
    // A handful of cloth: what is held does not shrink to a point as the mesh gets finer.
    let corner = |place: Vec3, x: f32| (place.x - x).abs() + place.y.abs() < 1.0 / 9.9;
    start.iter_mut().for_each(|p| p.fixed = corner(p.position, 0.0) || corner(p.position, 1.0));
    let params = ShellParams { stretch: [1000.0; 2], shear: 100.0, bending: 1e-5, damping: 2e-3 };
    let (shell, forces) = (shell(&sheet, params), (DOWN, Drag {}));
    let scene = Scene { start: &start, forces: &forces, constraints: &shell, substeps, ..Scene::EMPTY };
    let mut system = started(&scene, start.len(), 0);
    run(&mut system, &scene, 1.0 / 60.0, if cells < 32 { 60 } else { 180 });
    let x = system.particles().position;
    let edges = (0..=cells).flat_map(|v| (0..cells).map(move |u| [[u, v], [u + 1, v]]));
    let edges = edges.chain((0..cells).flat_map(|v| (0..=cells).map(move |u| [[u, v], [u, v + 1]])));
    let length = |ends: [[u32; 2]; 2]| {
        let [a, b] = ends.map(|[u, v]| x[sheet.number(u, v) as usize]);
        a.distance(b) * cells as f32
    };
    [x.iter().map(|x| -x.y).fold(0.0, f32::max), edges.map(length).fold(0.0, f32::max)]
}

/// The elongation of sheets of the same material, and their worst edges, against the finest of them.
fn sags_alike(sizes: &[[u32; 2]]) {
    let all: Vec<_> = sizes.iter().map(|&[cells, substeps]| hung(cells, substeps)).collect();
    let [low, _] = all[all.len() - 1];
    for (has, size) in all.iter().zip(sizes) {
        assert!((has[0] / low - 1.0).abs() < 0.005, "{size:?}: {all:?}");
        assert!(has[1] < 1.03, "{size:?}: {all:?}");
    }
}

#[test]
fn sheets_of_one_material_hang_alike_whatever_their_mesh_and_sub_steps() {
    sags_alike(&[[10, 2], [10, 6], [20, 2]]);
}

#[test]
#[ignore = "long: minutes"]
fn fine_sheets_of_one_material_hang_alike() {
    sags_alike(&[[32, 10], [64, 5], [64, 20], [128, 10]]);
}

/// A sheet that flies, turns, waves and trembles; flat, or bent at rest.
fn flying(cells: u32, bent: bool, scale: f32, far: Vec3) -> (Vec<Particle>, Sheet) {
    let sheet = Sheet { corner: Vec3::ZERO, sides: [Vec3::X * 0.5, Vec3::Z * 0.4], cells: [cells, cells - 1] };
    let (mut start, mut random) = (particles(&sheet, 0.2), Random::new(5));
    for particle in &mut start {
        let x = particle.position;
        let wave = (x.x * 8.0).sin() * (x.z * 5.0).cos();
        // It turns about its middle, and in a minute does not get where places are coarse.
        let turn = Vec3::new(1.0, 2.0, 3.0).cross(x - Vec3::new(0.25, 0.0, 0.2));
        let up = if bent { 0.08 * (x.x * 9.0).sin() + 0.03 * (x.z * 20.0).cos() } else { 0.0 };
        particle.position = (x + Vec3::Y * up + far) * scale;
        particle.velocity =
            (Vec3::new(0.02, 0.03, -0.02) + turn + Vec3::Y * (0.6 * wave) + random.vector(0.02)) * scale;
    }
    (start, sheet)
}

/// The angular momentum about the middle.
fn spin(system: &System<Heap>, start: &[Particle]) -> [f64; 3] {
    let all = system.particles();
    let mass: f64 = start.iter().map(|p| f64::from(p.mass)).sum();
    let mean = |of: &[Vec3]| {
        let sum = |k| start.iter().zip(of).map(|(p, v): (_, &Vec3)| f64::from(p.mass) * f64::from(v[k])).sum::<f64>();
        [0, 1, 2].map(|k| sum(k) / mass)
    };
    let (x, v) = (mean(all.position), mean(all.velocity));
    let mut sum = [0.0; 3];
    for ((p, place), velocity) in start.iter().zip(all.position).zip(all.velocity) {
        let [r, u] = [(place, x), (velocity, v)].map(|(of, mean)| [0, 1, 2].map(|k| f64::from(of[k]) - mean[k]));
        for (k, sum) in sum.iter_mut().enumerate() {
            let (i, j) = ((k + 1) % 3, (k + 2) % 3);
            *sum += f64::from(p.mass) * (r[i] * u[j] - r[j] * u[i]);
        }
    }
    sum
}

/// The energy by which a sheet of an even material is stretched and sheared, in double precision \[J\].
fn stretching(start: &[Particle], sheet: &Sheet, stretch: f32, x: &[Vec3]) -> f64 {
    let wide = |v: Vec3| v.to_array().map(f64::from);
    let dot = |a: [f64; 3], b: [f64; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    let one = |corners: [u32; 3]| {
        let [a, b, c] = corners.map(|corner| corner as usize);
        let edges = |place: &dyn Fn(usize) -> Vec3| [wide(place(b) - place(a)), wide(place(c) - place(a))];
        let ([e, f], [g, h]) = (edges(&|i| start[i].position), edges(&|i| x[i]));
        // Of an even material only squares of lengths count: with the metrics A at rest and B now, the energy is k/8 area tr((A^-1 B - 1)^2).
        let ([p, q, r], [s, t, u]) = ([dot(e, e), dot(e, f), dot(f, f)], [dot(g, g), dot(g, h), dot(h, h)]);
        let square = p * r - q * q;
        let by = [[r * s - q * t, r * t - q * u], [p * t - q * s, p * u - q * t]].map(|row| row.map(|x| x / square));
        let [[i, j], [k, l]] = [[by[0][0] - 1.0, by[0][1]], [by[1][0], by[1][1] - 1.0]];
        f64::from(stretch) / 8.0 * 0.5 * square.sqrt() * (i * i + 2.0 * j * k + l * l)
    };
    sheet.triangles().map(one).sum()
}

fn keeps_its_momenta(frames: u32, cases: &[(u32, bool, f32, f32)]) {
    let far = Vec3::new(20.0, -7.0, 3.0);
    let mut methods = [Method::Symplectic, Method::Verlet, Method::Rk4, Method::Euler].into_iter().cycle();
    for &(cells, bent, scale, away) in cases {
        for (substeps, stretch, damping) in [(1, 100.0, 0.0), (5, 1e4, 0.0), (20, 300.0, 1e-3)] {
            let (start, sheet) = flying(cells, bent, scale, far * away);
            let shell = shell(&sheet, even(stretch, 1e-6 * stretch, damping));
            let method = methods.next().expect("there is always a next one");
            let integrator = method.integrator();
            let scene = Scene { start: &start, constraints: &shell, substeps, integrator, ..Scene::EMPTY };
            let mut system = started(&scene, start.len(), 0);
            let (before, turned) = (Measures::of(&system, &scene), spin(&system, &start));
            let moving = before.energy.kinetic;
            for frame in 1..=u64::from(frames) {
                system.step_to(&scene, Time::frame(frame, 60));
                let kinetic = Measures::of(&system, &scene).energy.kinetic;
                let now = kinetic + stretching(&start, &sheet, stretch, system.particles().position);
                // Strain is told no finer than places are.
                let rounding = f64::from(stretch * away) * 1e-9 / moving;
                assert!(
                    now < moving * (1.0 + 1e-5 + rounding),
                    "{method}, {substeps} sub-steps, {scale} m, {frame}: {}",
                    now / moving
                );
            }
            let after = Measures::of(&system, &scene);
            let mass: f64 = start.iter().map(|p| f64::from(p.mass)).sum();
            let scale = f64::from(scale);
            let drift = gap(before.momentum, after.momentum) / (mass * scale);
            assert!(drift < 5e-5 * (1.0 + f64::from(away)), "{method}, {substeps} sub-steps: {drift}");
            // Velocities round in every sub-step; at 20 m places are no finer than 2e-6 m, and sub-steps round to that, up and down.
            let all = f64::from(frames * substeps);
            let rounding = 2e-9 * all + 3e-3 * f64::from(away) * (all / 4500.0).sqrt().max(1.0);
            let lost = gap(turned, spin(&system, &start)) / gap(turned, [0.0; 3]);
            assert!(lost < 1e-4 + rounding, "{method}, {substeps} sub-steps, {scale} m, {away}: {lost}");
            // What turns goes on turning; waves become strain and back, and those that steps are too long for fade.
            assert!(after.energy.kinetic > 0.5 * moving, "{method}: {}", after.energy.kinetic / moving);
        }
    }
}

#[test]
fn a_free_sheet_keeps_its_momenta_and_gains_no_energy() {
    keeps_its_momenta(
        often(300) as u32,
        &[(5, false, 1.0, 0.0), (4, true, 1.0, 1.0), (5, true, 1e-3, 0.0), (4, false, 50.0, 0.0)],
    );
}

/// However stiff it is and however long its sub-steps: neither energy nor angular momentum comes of solving it.
fn gains_nothing(frames: u32, cells: u32, bent: bool, stretches: &[f32]) {
    let mut methods = [Method::Symplectic, Method::Verlet, Method::Rk4, Method::Euler].into_iter().cycle();
    for &stretch in stretches {
        for (bending, substeps) in [1e-6, 1e-4, 1e-2].into_iter().flat_map(|b| [1, 2, 3, 5, 10, 20, 50].map(|n| (b, n)))
        {
            let (mut start, sheet) = flying(cells, bent, 1.0, Vec3::ZERO);
            // What stays where it is does not get where places are coarse.
            let mass: f32 = start.iter().map(|p| p.mass).sum();
            let drift = start.iter().map(|p| p.velocity * p.mass).sum::<Vec3>() / mass;
            start.iter_mut().for_each(|p| p.velocity -= drift);
            let shell = shell(&sheet, even(stretch, bending, 0.0));
            let method = methods.next().expect("there is always a next one");
            let integrator = method.integrator();
            let scene = Scene { start: &start, constraints: &shell, substeps, integrator, ..Scene::EMPTY };
            let mut system = started(&scene, start.len(), 0);
            let (moving, turned) = (Measures::of(&system, &scene).energy.kinetic, spin(&system, &start));
            let name = format!("{method}, {substeps} sub-steps, {stretch} N/m, {bending} N m");
            for frame in 1..=u64::from(frames) {
                system.step_to(&scene, Time::frame(frame, 60));
                let kinetic = Measures::of(&system, &scene).energy.kinetic;
                let now = kinetic + stretching(&start, &sheet, stretch, system.particles().position);
                assert!(now < moving * (1.0 + 1e-5), "{name}, {frame}: {}", now / moving);
                assert!(kinetic > 0.4 * moving, "{name}, {frame}: {}", kinetic / moving);
            }
            let lost = gap(turned, spin(&system, &start)) / gap(turned, [0.0; 3]);
            assert!(lost < 1e-4, "{name}: {lost}");
        }
    }
}

#[test]
fn no_energy_comes_of_solving_a_free_sheet() {
    gains_nothing(often(120) as u32, 5, false, &[1e2, 1e3, 1e4, 1e5]);
    gains_nothing(often(40) as u32, 4, true, &[1e2, 1e5]);
}

/// Far away places are coarse, which is no strain that would have to be paid for by motion.
#[test]
fn far_from_the_origin_a_free_sheet_goes_on_waving() {
    for (away, stretch) in [(0.0f32, 1e4), (100.0, 1e4), (1000.0, 1e3)] {
        let (start, sheet) = flying(5, false, 1.0, Vec3::new(away, -away, 0.5 * away));
        let shell = shell(&sheet, even(stretch, 1e-4, 0.0));
        let scene = Scene { start: &start, constraints: &shell, substeps: 10, ..Scene::EMPTY };
        let mut system = started(&scene, start.len(), 0);
        let before = Measures::of(&system, &scene).energy.kinetic;
        run(&mut system, &scene, 1.0 / 60.0, 30);
        let share = Measures::of(&system, &scene).energy.kinetic / before;
        assert!((0.9..1.1).contains(&share), "{away} m: {share}");
    }
}

#[test]
#[ignore = "long: minutes"]
fn no_energy_comes_of_solving_a_free_sheet_for_a_minute() {
    gains_nothing(3600, 6, false, &[1e2, 1e3, 1e4, 1e5]);
    gains_nothing(3600, 9, true, &[1e3, 1e5]);
}

#[test]
#[ignore = "long: minutes"]
fn a_free_sheet_keeps_its_momenta_for_a_minute() {
    keeps_its_momenta(3600, &[(6, false, 1.0, 0.0), (9, true, 1.0, 0.0)]);
}

/// Edges that turn so far in one sub-step that 64 passes do not shorten all of them are counted; what waves quietly has none.
#[test]
fn edges_that_are_left_too_long_are_counted() {
    let sheet = Sheet { corner: Vec3::ZERO, sides: [Vec3::X, Vec3::Z], cells: [24, 24] };
    let mut counted = vec![];
    for speed in [0.1, 30.0, 100.0, 300.0, 1e3, 1e4] {
        let mut random = Random::new(1);
        let mut start = particles(&sheet, 0.2);
        start.iter_mut().for_each(|p| p.velocity = random.vector(speed));
        let shell = shell(&sheet, even(1e4, 1e-6, 0.0));
        let scene = Scene { start: &start, constraints: &shell, ..Scene::EMPTY };
        let mut system = started(&scene, start.len(), 0);
        run(&mut system, &scene, 1.0 / 60.0, 20);
        counted.push(system.totals().caps.edges);
    }
    assert!(counted[0] == 0 && counted.iter().any(|&some| some > 0), "{counted:?}");
}

/// The angle of a sheet between both its outer edges, folded about its middle.
fn opening(x: &[Vec3], sheet: &Sheet) -> f32 {
    let [a, b, c] = [0, sheet.cells[0] / 2, sheet.cells[0]].map(|u| x[sheet.number(u, 1) as usize]);
    (a - b).angle_between(c - b)
}

#[test]
fn a_crease_comes_back_to_its_angle() {
    let sheet = Sheet { corner: Vec3::ZERO, sides: [Vec3::X * 0.2, Vec3::Z * 0.1], cells: [6, 3] };
    for (angle, substeps, method) in
        [(0.0f32, 10, Method::Symplectic), (0.5, 5, Method::Verlet), (-1.0, 20, Method::Rk4), (1.3, 10, Method::Euler)]
    {
        let mut start = particles(&sheet, 0.1);
        let (sin, cos) = angle.sin_cos();
        for particle in &mut start {
            let out = particle.position.x - 0.1;
            particle.position = Vec3::new(out * cos, out.abs() * sin, particle.position.z);
            // It is thrown wide open, or shut.
            particle.velocity = Vec3::Y * (out.abs() * 60.0);
        }
        let (shell, integrator) = (shell(&sheet, even(2e3, 1e-2, 5e-3)), method.integrator());
        let scene = Scene { start: &start, constraints: &shell, substeps, integrator, ..Scene::EMPTY };
        let mut system = started(&scene, start.len(), 0);
        let rest = opening(system.particles().position, &sheet);
        let mut widest = 0.0f32;
        for frame in 1..=90 {
            system.step_to(&scene, Time::frame(frame, 60));
            widest = widest.max((opening(system.particles().position, &sheet) - rest).abs());
        }
        let off = opening(system.particles().position, &sheet) - rest;
        assert!(widest > 0.1 && off.abs() < 0.01, "{method}, {angle} rad: {widest}, then {off}");
    }
}

#[test]
fn a_mesh_has_the_hinges_of_its_sheet() {
    for cells in [[1, 1], [4, 3], [1, 7], [5, 1], [0, 3], [3, 0]] {
        let sheet = Sheet { corner: Vec3::ZERO, sides: [Vec3::X, Vec3::Z], cells };
        // The side of an edge on which a triangle is does not tell one edge from another.
        let plain = |hinge: Hinge| {
            let mut sides = [0, 1].map(|side| (hinge.faces[side], hinge.far[side]));
            let mut edge = hinge.edge;
            sides.sort_unstable();
            edge.sort_unstable();
            (edge, sides)
        };
        let triangles: Vec<_> = sheet.triangles().collect();
        let mut own: Vec<_> = sheet.hinges().map(plain).collect();
        let mut found: Vec<_> = mesh_hinges(&triangles).into_iter().map(plain).collect();
        own.sort_unstable();
        found.sort_unstable();
        assert_eq!(own, found, "{cells:?}");
        for hinge in sheet.hinges() {
            for side in 0..2 {
                let face = triangles[hinge.faces[side] as usize];
                assert!(hinge.edge.iter().chain([&hinge.far[side]]).all(|corner| face.contains(corner)));
            }
        }
    }
}

#[test]
fn nothing_does_a_sheet_harm() {
    let sheet = Sheet { corner: Vec3::ZERO, sides: [Vec3::X, Vec3::Z], cells: [5, 4] };
    let plain = particles(&sheet, 0.2);
    let change = |at: usize, part: Particle| {
        let mut start = plain.clone();
        start[at] = part;
        start
    };
    let line: Vec<_> = plain.iter().map(|p| Particle { position: Vec3::X * p.position.x, ..*p }).collect();
    let point: Vec<_> = plain.iter().map(|p| Particle { position: Vec3::ONE, ..*p }).collect();
    let fixed: Vec<_> = plain.iter().map(|p| Particle { fixed: true, ..*p }).collect();
    let starts = [
        (plain.clone(), true),
        (change(7, Particle { position: Vec3::NAN, ..plain[7] }), false),
        (change(7, Particle { velocity: Vec3::splat(f32::INFINITY), ..plain[7] }), false),
        (change(7, Particle { position: Vec3::splat(3e38), ..plain[7] }), false),
        (change(7, Particle { velocity: Vec3::splat(1e30), ..plain[7] }), false),
        (change(7, Particle { mass: 1e-30, ..plain[7] }), false),
        (change(7, plain[8]), true),
        (line, true),
        (point, true),
        (fixed, true),
        (plain[..11].to_vec(), true),
    ];
    let params = [
        even(0.0, 0.0, 0.0),
        even(1e3, 1e-4, 1e-3),
        even(1e30, 1e30, 0.0),
        even(f32::NAN, 1.0, 0.0),
        even(1e-30, f32::INFINITY, 1e30),
    ];
    for (at, (start, tame)) in starts.iter().enumerate() {
        for (number, &params) in params.iter().enumerate() {
            let mut shell = shell(&sheet, params);
            // Corners and triangles that are not there.
            shell.triangles.push([0, 1, 999]);
            shell.hinges.push(Hinge { edge: [0, 777], far: [1, 2], faces: [0, 888] });
            for substeps in [1, 4] {
                let scene = Scene { start, forces: &DOWN, constraints: &shell, substeps, ..Scene::EMPTY };
                let mut system = started(&scene, start.len(), 0);
                run(&mut system, &scene, 1.0 / 60.0, 20);
                let all = system.particles().position;
                if *tame && number < 2 {
                    assert!(all.len() == start.len() && all.iter().all(|x| x.is_finite()), "{at} {number}: {all:?}");
                }
                // Who is not finite has gone, alone.
                assert!(
                    all.len() + 1 >= start.len() || number > 1 || at == 4 || at == 3,
                    "{at} {number}: {}",
                    all.len()
                );
            }
        }
    }
    assert!(shell(&sheet, even(1e3, 0.0, 0.0)).fault().is_none());
    assert_eq!(shell(&sheet, even(-1.0, 0.0, 0.0)).fault().map(|(name, _)| name), Some("stretch"));
    let strange = Shell { warp: Vec3::NAN, ..shell(&sheet, even(1.0, 0.0, 0.0)) };
    assert_eq!(strange.fault().map(|(name, _)| name), Some("warp"));
}

/// Triangles and folds that have no extent where they begin are counted, once: of a sheet squeezed into a line or a point all, none of any other; and not
/// those that are not there.
#[test]
fn what_has_no_extent_is_counted() {
    let sheet = Sheet { corner: Vec3::ZERO, sides: [Vec3::X, Vec3::Z], cells: [5, 4] };
    let plain = particles(&sheet, 0.2);
    let all = (sheet.triangles().count() + sheet.hinges().count()) as u64;
    let squeezed = |by: Vec3| plain.iter().map(|p| Particle { position: p.position * by, ..*p }).collect::<Vec<_>>();
    for (start, more, right) in [
        (plain.clone(), vec![], 0),
        (plain.clone(), vec![[0, 0, 1], [2, 2, 2], [0, 1, 2], [0, 1, 999]], 3),
        (squeezed(Vec3::X), vec![], all),
        (squeezed(Vec3::ZERO), vec![], all),
    ] {
        for substeps in [1, 5] {
            let mut shell = shell(&sheet, even(1e3, 1e-4, 1e-3));
            shell.triangles.extend(&more);
            let scene = Scene { start: &start, constraints: &shell, substeps, ..Scene::EMPTY };
            let mut system = started(&scene, start.len(), 0);
            run(&mut system, &scene, 1.0 / 60.0, 3);
            assert_eq!(system.totals().caps.degenerate, right, "{more:?}, {substeps} sub-steps");
        }
    }
}

/// A plate that falls in still air, and one held in a wind that carries it.
#[test]
fn a_level_plate_falls_at_its_terminal_speed() {
    for (cells, drag, wind, method, substeps) in [
        ([1u32, 1u32], 1.2f32, Vec3::ZERO, Method::Rk4, 1),
        ([4, 3], 2.0, Vec3::Y * 3.0, Method::Verlet, 2),
        ([5, 5], 0.7, Vec3::NEG_Y * 2.0, Method::Symplectic, 8),
        ([2, 2], 1.2, Vec3::ZERO, Method::Implicit, 1),
    ] {
        let (area, density) = (0.6f32, 0.5f32);
        let sheet = Sheet { corner: Vec3::new(7.0, 90.0, -3.0), sides: [Vec3::X * 0.75, Vec3::Z * 0.8], cells };
        let start = particles(&sheet, density);
        let air = Aerodynamics { drag, ..Aerodynamics::still(sheet.triangles().collect::<Vec<_>>()) };
        let forces = (DOWN, air.within(Uniform { velocity: wind }));
        let (shell, integrator) = (shell(&sheet, even(1e3, 1e-2, 0.0)), method.integrator());
        let scene = Scene { start: &start, forces: &forces, constraints: &shell, substeps, integrator, ..Scene::EMPTY };
        let mut system = started(&scene, start.len(), 0);
        run(&mut system, &scene, 1.0 / 60.0, 300);
        let mass: f32 = start.iter().map(|p| p.mass).sum();
        let terminal = (2.0 * mass * G / (1.2 * drag * area)).sqrt() - wind.y;
        for velocity in system.particles().velocity {
            let off = -velocity.y / terminal - 1.0;
            assert!(
                off.abs() < 2e-3 && velocity.x.abs() + velocity.z.abs() < 1e-2,
                "{method}: {velocity}, not {terminal}"
            );
        }
    }
}

/// The implicit method holds light sheets in a strong wind, with all their lift, in sub-steps several times as long as explicit methods stand.
#[test]
fn lift_throws_no_light_sheet_about_by_the_implicit_method() {
    let sheet = Sheet { corner: Vec3::ZERO, sides: [Vec3::X, Vec3::NEG_Y], cells: [6, 6] };
    for (density, wind, substeps) in [(0.01f32, 16.0f32, 4), (0.02, 16.0, 4), (0.01, 30.0, 16), (0.1, 10.0, 1)] {
        let mut start = particles(&sheet, density);
        for (i, particle) in start.iter_mut().enumerate() {
            particle.fixed = i % 7 == 0;
        }
        let air = Aerodynamics::still(sheet.triangles().collect::<Vec<_>>());
        let forces = (DOWN, air.within(Uniform { velocity: Vec3::new(0.95, 0.0, 0.3) * wind }));
        let (shell, integrator) = (shell(&sheet, even(1e3, 1e-5, 2e-3)), Method::Implicit.integrator());
        let scene = Scene { start: &start, forces: &forces, constraints: &shell, substeps, integrator, ..Scene::EMPTY };
        let mut system = started(&scene, start.len(), 0);
        for _ in 0..often(2400).max(240) {
            system.step(&scene, Time::from_seconds(1.0 / 60.0));
            let fastest = system.particles().velocity.iter().map(|v| v.length()).fold(0.0, f32::max);
            assert!(fastest < 6.0 * wind, "{density} kg/m² in {wind} m/s, {substeps} sub-steps: {fastest}");
        }
    }
}

/// Of plates at all angles: the printed law, no power from still air, and the power that is told.
#[test]
fn the_air_pushes_by_the_angle_of_attack_and_gives_nothing_when_it_is_still() {
    let mut random = Random::new(31);
    for scale in [1e-3f32, 1.0, 1e3] {
        for round in 0..often(2000) {
            let corners =
                [(); 3].map(|()| random.vector(1.0) * scale + Vec3::splat(if round % 3 == 0 { 5.0 } else { 0.0 }));
            let (velocity, wind) = (random.vector(8.0), if round % 2 == 0 { Vec3::ZERO } else { random.vector(8.0) });
            let [drag, lift, friction] = [random.unit().abs(), random.unit().abs(), 0.1];
            let start = corners.map(|position| Particle { position, velocity, ..Particle::REST });
            let air = Aerodynamics { drag, lift, friction, ..Aerodynamics::still([[0u32, 1, 2]]) };
            let air = air.within(Uniform { velocity: wind });
            let scene = Scene { start: &start, forces: &air, ..Scene::EMPTY };
            let mut system = System::with(Heap::new(scene.size()));
            system.start(&scene, 0).expect("the memory is made for it");
            let (state, mut push) = (system.state(&scene), [Vec3::ZERO; 3]);
            air.add_to(&state, 0..3, &mut push);
            let total: Vec3 = push.iter().sum();
            let double = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
            let (relative, normal) = (wind - velocity, double.normalize());
            let sine = relative.normalize().dot(normal);
            let dynamic = 0.5 * 1.2 * 0.5 * double.length() * relative.length_squared();
            let dragged = dynamic * (drag * sine * sine + friction * (1.0 - sine * sine));
            let lifted = dynamic * lift * sine.abs() * (1.0 - sine * sine).max(0.0).sqrt();
            let along = total.dot(relative.normalize());
            let aside = (total - relative.normalize() * along).length();
            let close = |a: f32, b: f32| (a - b).abs() < 2e-3 * dynamic;
            assert!(close(along, dragged) && close(aside, lifted), "{along} {dragged} {aside} {lifted}");
            let power = air.power(&state);
            assert!((power - f64::from(total.dot(velocity))).abs() < 1e-3 * f64::from(dynamic * 8.0), "{power}");
            assert!(wind != Vec3::ZERO || power <= 0.0, "{power}");
            // Any division into rows gives the same bits.
            let mut apart = [Vec3::ZERO; 3];
            air.add_to(&state, 0..1, &mut apart[..1]);
            air.add_to(&state, 1..3, &mut apart[1..]);
            assert_eq!(apart, push);
        }
    }
}

#[test]
fn files_make_shells_by_density_and_in_the_wind() {
    let text = r#"{
        "forces": [{"gravity": {"acceleration": [0, -9.8, 0]}}, {"wind": {"field": [{"uniform": {"velocity": [3, 0, 0]}}]}}],
        "particles": [{"position": [9, 9, 9]}],
        "cloths": [{
            "form": {"sheet": {"corner": [0, 0, 0], "sides": [[1, 0, 0], [0, 2, 0]], "cells": [4, 6]}}, "density": 0.3,
            "shell": {"stretch": [2000, 1500], "shear": 300, "bending": 1e-5}, "air": {"drag": 1.1}, "fixed": [0]
        }]
    }"#;
    let file = SceneFile::from_json("a.json", text).expect("it is sound");
    let model = Model::load(&file, "a.json", &mut ()).expect("it can be made");
    let mass: f32 = model.particles[1..].iter().map(|p| p.mass).sum();
    assert!((mass / 0.6 - 1.0).abs() < 1e-5 && model.springs.is_empty() && model.patches.len() == 1);
    let [ConstraintKind::Shell(shell)] = &model.constraints.0[..] else { panic!("{:?}", model.constraints.0) };
    assert_eq!((shell.particles.len(), shell.particles[0], shell.triangles.len()), (35, 1, 48));
    let Some(ForceKind::Aerodynamics(air)) = model.forces.0.last() else { panic!("{:?}", model.forces.0) };
    assert_eq!((air.triangles[0], air.field.len(), air.drag, air.density), ([1, 2, 7], 1, 1.1, 1.2));
    let mut system = model.system(0, 1).expect("there is memory");
    for frame in 1..=30 {
        system.step_to(&model.scene(), Time::frame(frame, 60));
    }
    assert!(system.particles().velocity.iter().any(|v| v.x > 0.1), "it goes with the wind");
    for (wrong, why) in [
        (r#""density": 0.3"#, r#""density": 0.3, "mass": 1"#),
        (r#""density": 0.3"#, r#""density": 0"#),
        (r#""shear": 300"#, r#""shear": -1"#),
        (r#""drag": 1.1"#, r#""drag": -1.1"#),
        (r#""shell": {"stretch": [2000, 1500], "shear": 300, "bending": 1e-5}, "#, ""),
    ] {
        let file = SceneFile::from_json("a.json", &text.replace(wrong, why)).expect("it is a scene");
        assert!(file.check().is_err(), "{why}");
    }
}
