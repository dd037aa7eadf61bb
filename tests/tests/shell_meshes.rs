//! Shells of any mesh: how few iterations they take, and what they keep in one piece and in several, whatever the order of their particles.

use pointmass::constrain::{Hinge, Shell, ShellParams, mesh_hinges};
use pointmass::{Constraint, Effort, Gravity, Measures, Method, Particle, Report, Scene, Sheet, Time, Vec3};
use pointmass_tests::points::shuffle;
use pointmass_tests::{Random, every, gap, icosahedron, often, started};

const DOWN: Gravity = Gravity { acceleration: Vec3::new(0.0, -9.81, 0.0) };

type Mesh = (Vec<Vec3>, Vec<[u32; 3]>);
type Cloth = Shell<Vec<u32>, Vec<[u32; 3]>, Vec<Hinge>>;

fn shell((places, triangles): &Mesh, params: ShellParams) -> Cloth {
    let (particles, hinges) = ((0..places.len() as u32).collect(), mesh_hinges(triangles));
    Shell { particles, triangles: triangles.clone(), hinges, warp: Vec3::X, params }
}

fn params(stretch: f32, bending: f32) -> ShellParams {
    ShellParams { stretch: [stretch; 2], shear: 0.4 * stretch, bending, damping: 1e-3 }
}

fn sheet(cells: [u32; 2], corner: Vec3) -> Mesh {
    let sheet = Sheet { corner, sides: [Vec3::X, Vec3::Z * (cells[1] as f32 / cells[0] as f32)], cells };
    (sheet.positions().collect(), sheet.triangles().collect())
}

/// A ball of an icosahedron whose edges are halved so often.
fn ball(times: u32) -> Mesh {
    let (mut places, mut triangles) = icosahedron();
    for _ in 0..times {
        let mut middles = std::collections::BTreeMap::new();
        let mut middle = |places: &mut Vec<Vec3>, a: u32, b: u32| {
            *middles.entry([a.min(b), a.max(b)]).or_insert_with(|| {
                places.push((places[a as usize] + places[b as usize]).normalize());
                places.len() as u32 - 1
            })
        };
        let halves = triangles.iter().flat_map(|&[a, b, c]| {
            let [d, e, f] = [middle(&mut places, a, b), middle(&mut places, b, c), middle(&mut places, c, a)];
            [[a, d, f], [d, b, e], [f, e, c], [d, e, f]]
        });
        triangles = halves.collect();
    }
    (places.into_iter().map(|place| place.normalize() * 0.4).collect(), triangles)
}

/// Triangles around one point.
fn fan(spokes: u32) -> Mesh {
    let rim = (0..spokes).map(|i| {
        let (sin, cos) = (i as f32 * std::f32::consts::TAU / spokes as f32).sin_cos();
        Vec3::new(cos, 0.0, sin)
    });
    let triangles = (0..spokes).map(|i| [0, 1 + (i + 1) % spokes, 1 + i]);
    (std::iter::once(Vec3::ZERO).chain(rim).collect(), triangles.collect())
}

/// A band with half a twist.
fn twisted(length: u32) -> Mesh {
    let places = (0..length).flat_map(|i| {
        let round = i as f32 * std::f32::consts::TAU / length as f32;
        let out = Vec3::new(round.cos(), 0.0, round.sin());
        let across = (out * (0.5 * round).cos() + Vec3::Y * (0.5 * round).sin()) * 0.15;
        [-1.0, 0.0, 1.0].map(|side| out + across * side)
    });
    let number = move |i: u32, side: u32| if i < length { 3 * i + side } else { 2 - side };
    let triangles = (0..length).flat_map(move |i| {
        (0..2).flat_map(move |side| {
            let [a, b, c, d] = [number(i, side), number(i + 1, side), number(i, side + 1), number(i + 1, side + 1)];
            [[a, b, d], [a, d, c]]
        })
    });
    (places.collect(), triangles.collect())
}

/// Triangles a hundred times as long as wide.
fn needles() -> Mesh {
    let (places, triangles) = sheet([4, 20], Vec3::ZERO);
    (places.into_iter().map(|place| place * Vec3::new(1.0, 1.0, 0.01)).collect(), triangles)
}

/// The same with its vertices in another order.
fn shuffled((places, triangles): Mesh, random: &mut Random) -> Mesh {
    let mut order: Vec<u32> = (0..places.len() as u32).collect();
    shuffle(&mut order, random);
    let mut moved = places.clone();
    for (place, &to) in places.iter().zip(&order) {
        moved[to as usize] = *place;
    }
    (moved, triangles.into_iter().map(|corners| corners.map(|corner| order[corner as usize])).collect())
}

fn start(places: &[Vec3], mass: f32, mut velocity: impl FnMut(Vec3) -> Vec3) -> Vec<Particle> {
    let at = |&position: &Vec3| Particle { position, velocity: velocity(position), mass, ..Particle::REST };
    places.iter().map(at).collect()
}

/// The stiffer and the finer a mesh, the more iterations by the masses alone: as the square root of what is asked here a thousandfold.
#[test]
fn finer_and_stiffer_sheets_take_few_more_iterations() {
    let mut most = [0.0f64; 2];
    for (cells, substeps, stretch) in
        [(8u32, 5u32, 100.0f32), (8, 5, 5e4), (24, 5, 500.0), (24, 2, 5e3), (24, 10, 5e4), (32, 5, 5e3)]
    {
        let mesh = sheet([cells, cells], Vec3::ZERO);
        let mut start = start(&mesh.0, 0.2 / mesh.0.len() as f32, |_| Vec3::ZERO);
        [0, cells as usize].into_iter().for_each(|corner| start[corner].fixed = true);
        let shell = shell(&mesh, params(stretch, 1e-5));
        let scene = Scene { start: &start, forces: &DOWN, constraints: &shell, substeps, ..Scene::EMPTY };
        let mut system = started(&scene, start.len(), 0);
        for frame in 1..=often(30) {
            system.step_to(&scene, Time::frame(frame as u64, 60));
        }
        let effort = system.totals().effort;
        assert_eq!(effort.capped, 0, "{cells} cells, {stretch} N/m: {effort:?}");
        let mean = effort.iterations as f64 / effort.solves as f64;
        let which = usize::from(cells > 8);
        most[which] = most[which].max(mean);
        assert!(mean < 25.0, "{cells} cells, {substeps} sub-steps, {stretch} N/m: {mean}");
    }
    assert!(most[1] < 3.0 * most[0] + 3.0, "{most:?}");
}

#[test]
fn meshes_of_all_kinds_keep_their_momenta() {
    let mut random = Random::new(77);
    let mut methods = [Method::Symplectic, Method::Verlet, Method::Rk4].into_iter().cycle();
    for (name, mesh) in [
        ("ball", ball(2)),
        ("fan", fan(90)),
        ("band", twisted(30)),
        ("needles", needles()),
        ("strip", sheet([30, 1], Vec3::ZERO)),
    ] {
        for (stretch, bending, substeps) in [(50.0, 0.0, 1), (2e3, 1e-4, 4), (1e4, 1e-2, 10)] {
            let mesh = shuffled(mesh.clone(), &mut random);
            let start = start(&mesh.0, 1e-3, |x| {
                Vec3::new(0.3, -0.2, 0.1) + Vec3::new(1.0, 2.0, -1.0).cross(x) + random.vector(0.05)
            });
            let shell = shell(&mesh, params(stretch, bending));
            let method = methods.next().expect("there is always a next one");
            let integrator = method.integrator();
            let scene = Scene { start: &start, constraints: &shell, substeps, integrator, ..Scene::EMPTY };
            let mut system = started(&scene, start.len(), 0);
            let before = Measures::of(&system, &scene);
            for frame in 1..=often(100) {
                system.step_to(&scene, Time::frame(frame as u64, 60));
            }
            let after = Measures::of(&system, &scene);
            let mass = 1e-3 * start.len() as f64;
            let drift = gap(before.momentum, after.momentum) / mass;
            assert!(drift < 2e-5, "{name}, {method}, {stretch} N/m: {drift}");
            let turned = gap(before.angular_momentum, after.angular_momentum);
            let lost = turned / gap(before.angular_momentum, [0.0; 3]);
            assert!(lost < 5e-4, "{name}, {method}, {stretch} N/m: {lost}");
            let kept = after.energy.kinetic / before.energy.kinetic;
            assert!(kept > 0.3 && kept < 1.001, "{name}, {method}, {stretch} N/m: {kept}");
        }
    }
}

/// One piece trembles, the second is at rest, the third hangs from a nail, the fourth falls: none feels another.
#[test]
fn pieces_of_one_shell_do_not_feel_each_other() {
    for (stretch, substeps, method) in
        [(100.0f32, 1, Method::Symplectic), (2e3, 4, Method::Verlet), (3e4, 10, Method::Rk4)]
    {
        let mut random = Random::new(3);
        let cells = [[5u32, 4u32], [6, 6], [4, 7]];
        let (mut places, mut triangles, mut pieces) = (vec![], vec![], vec![]);
        for (i, cells) in cells.into_iter().enumerate() {
            let (more, faces) = sheet(cells, Vec3::new(3.0 * i as f32, 0.0, 0.0));
            let first = places.len() as u32;
            pieces.push(places.len()..places.len() + more.len());
            places.extend(more);
            triangles.extend(faces.into_iter().map(|corners| corners.map(|corner| corner + first)));
        }
        let mesh = (places, triangles);
        let mut start = start(&mesh.0, 1e-3, |_| Vec3::ZERO);
        start[pieces[0].clone()].iter_mut().for_each(|particle| particle.velocity = random.vector(1.0));
        start[pieces[2].start].fixed = true;
        start[pieces[2].clone()].iter_mut().for_each(|particle| particle.velocity = random.vector(1.0));
        let (shell, integrator) = (shell(&mesh, params(stretch, 1e-4)), method.integrator());
        let scene = Scene { start: &start, constraints: &shell, substeps, integrator, ..Scene::EMPTY };
        let mut system = started(&scene, start.len(), 0);
        let momentum = |velocities: &[Vec3]| velocities.iter().sum::<Vec3>() / velocities.len() as f32;
        let before = momentum(&system.particles().velocity[pieces[0].clone()]);
        for frame in 1..=often(200) {
            system.step_to(&scene, Time::frame(frame as u64, 60));
        }
        let (x, v) = (system.particles().position, system.particles().velocity);
        let drift = (momentum(&v[pieces[0].clone()]) - before).length();
        assert!(drift < 2e-5, "{method}, {stretch} N/m: {drift}");
        for row in pieces[1].clone() {
            let gone = (x[row] - start[row].position).length();
            // Speeds too small to move a place of that many digits in a sub-step are none.
            let still = (f32::EPSILON * x[row].length() * 60.0 * substeps as f32).max(1e-4);
            assert!(gone < 1e-5 && v[row].length() < still, "{method}, {stretch} N/m: {gone}, {}", v[row]);
        }
        assert!(x[pieces[2].start] == start[pieces[2].start].position);
    }
}

/// The order of particles, and hinges that are none, change what rounding and the iterations leave, and no more.
#[test]
fn the_order_of_particles_does_not_matter() {
    let mesh = sheet([9, 7], Vec3::ZERO);
    let mut random = Random::new(8);
    let mut order: Vec<u32> = (0..mesh.0.len() as u32).collect();
    let run = |order: &[u32], extra: usize| {
        let mut places = mesh.0.clone();
        mesh.0.iter().zip(order).for_each(|(place, &to)| places[to as usize] = *place);
        let triangles = mesh.1.iter().map(|corners| corners.map(|corner| order[corner as usize])).collect();
        let mut start = start(&places, 1e-3, |_| Vec3::ZERO);
        [0, 9].into_iter().for_each(|corner: usize| start[order[corner] as usize].fixed = true);
        let mut shell = shell(&(places, triangles), params(300.0, 0.0));
        // So many that there is no room for the mesh's own edges.
        let hinge = shell.hinges[0];
        shell.hinges.extend(std::iter::repeat_n(hinge, extra));
        let scene = Scene { start: &start, forces: &DOWN, constraints: &shell, substeps: 6, ..Scene::EMPTY };
        let mut system = started(&scene, start.len(), 0);
        for frame in 1..=12 {
            system.step_to(&scene, Time::frame(frame, 60));
        }
        let x = system.particles().position;
        order.iter().map(|&to| x[to as usize]).collect::<Vec<Vec3>>()
    };
    let plain = run(&order, 0);
    for extra in [0, 1000] {
        shuffle(&mut order, &mut random);
        for (a, b) in run(&order, extra).iter().zip(&plain) {
            assert!(a.distance(*b) < 2e-3, "{extra}: {a}, not {b}");
        }
    }
}

/// Rings around a hub of so many spokes, each a little farther out and uneven.
fn wheel(spokes: u32, rings: u32, random: &mut Random) -> Mesh {
    let mut places = vec![Vec3::ZERO];
    for ring in 1..=rings {
        for i in 0..spokes {
            let (sin, cos) = (i as f32 * std::f32::consts::TAU / spokes as f32).sin_cos();
            places.push(Vec3::new(cos, 0.0, sin) * (ring as f32 / rings as f32) + random.vector(0.1 / spokes as f32));
        }
    }
    let mut triangles = vec![];
    for i in 0..spokes {
        let [this, next] = [1 + i, 1 + (i + 1) % spokes];
        triangles.push([0, next, this]);
        for ring in 1..rings {
            let [a, b] = [this, next].map(|number| number + (ring - 1) * spokes);
            triangles.extend([[a, b, b + spokes], [a, b + spokes, a + spokes]]);
        }
    }
    (places, triangles)
}

/// A sheet whose particles are off their places, and many of whose edges lead across.
fn uneven(cells: u32, random: &mut Random) -> Mesh {
    let (mut places, mut triangles) = sheet([cells; 2], Vec3::ZERO);
    places.iter_mut().for_each(|place| *place += random.vector(0.25 / cells as f32) * Vec3::new(1.0, 0.2, 1.0));
    let area = |places: &[Vec3], [a, b, c]: [u32; 3]| {
        let [a, b, c] = [a, b, c].map(|corner| places[corner as usize]);
        (b - a).cross(c - a).y
    };
    for _ in 0..4 * cells * cells {
        let face = (random.vector(0.5).x + 0.5) * triangles.len() as f32;
        let face = (face as usize).min(triangles.len() - 1);
        let [a, b, c] = triangles[face];
        let across = |&other: &usize| other != face && triangles[other].contains(&a) && triangles[other].contains(&b);
        let Some(other) = (0..triangles.len()).find(across) else { continue };
        let Some(&d) = triangles[other].iter().find(|&&corner| corner != a && corner != b) else { continue };
        let flipped = [[c, a, d], [c, d, b]];
        let least = 0.2 / (cells * cells) as f32;
        let sign = area(&places, [a, b, c]).signum();
        if flipped.iter().all(|&corners| area(&places, corners) * sign > least) {
            [triangles[face], triangles[other]] = flipped;
        }
    }
    (places, triangles)
}

/// Meshes of many kinds that lie in a plane at first, and their names.
fn of_all_kinds(random: &mut Random) -> Vec<(String, Mesh)> {
    let mut all: Vec<(String, Mesh)> = [(3, 7), (5, 4), (8, 2), (13, 2), (24, 2), (40, 1), (40, 3), (300, 2)]
        .into_iter()
        .map(|(spokes, rings)| (format!("{spokes} spokes, {rings} rings"), wheel(spokes, rings, random)))
        .collect();
    all.push(("700 spokes, 1 ring".into(), wheel(700, 1, random)));
    all.extend([6, 11, 19].map(|cells| (format!("uneven, {cells} cells"), uneven(cells, random))));
    all.push(("needles".into(), needles()));
    all.push(("strip".into(), sheet([30, 1], Vec3::ZERO)));
    let (mut places, mut triangles) = sheet([7, 6], Vec3::ZERO);
    for corner in [Vec3::X * 3.0, Vec3::Z * 4.0] {
        let first = places.len() as u32;
        let (more, faces) = sheet([4, 5], corner);
        places.extend(more);
        triangles.extend(faces.into_iter().map(|corners| corners.map(|corner| corner + first)));
    }
    all.push(("three pieces".into(), (places, triangles)));
    let (mut places, mut triangles) = sheet([8, 8], Vec3::ZERO);
    let fins = [[10u32, 11], [40, 41], [30, 39]];
    for [a, b] in fins {
        places.push((places[a as usize] + places[b as usize]) * 0.5 + Vec3::Y * 0.1);
        triangles.push([a, b, places.len() as u32 - 1]);
    }
    all.push(("edges of three triangles".into(), (places, triangles)));
    let (places, mut triangles) = sheet([8, 8], Vec3::ZERO);
    triangles.extend(triangles.clone().into_iter().step_by(5));
    all.push(("triangles twice".into(), (places, triangles)));
    let (mut places, triangles) = sheet([5, 5], Vec3::ZERO);
    places.extend((0..200).map(|i| Vec3::new(i as f32, 5.0, 0.0)));
    all.push(("in no triangle".into(), shuffled((places, triangles), random)));
    let (places, mut triangles) = sheet([12, 12], Vec3::ZERO);
    let mut number = 0;
    triangles.retain(|_| {
        number += 1;
        number % 24 < 4 || number % 24 > 9 || number / 24 % 4 < 2
    });
    all.push(("holes".into(), (places, triangles)));
    all
}

/// How many times as long as high the most slender triangle is.
fn slenderness((places, triangles): &Mesh) -> f32 {
    let of = |&corners: &[u32; 3]| {
        let [a, b, c] = corners.map(|corner| places[corner as usize]);
        let longest = [b - a, c - b, a - c].into_iter().map(Vec3::length_squared).fold(0.0, f32::max);
        longest / (b - a).cross(c - a).length()
    };
    triangles.iter().map(of).fold(0.0, f32::max)
}

/// Where a mesh is that hangs from its first particle for a while, and with what effort; with hinges that are none, there is no room for graphs.
fn hung(mesh: &Mesh, params: ShellParams, substeps: u32, extra: usize) -> (Vec<Vec3>, Report) {
    let mut start = start(&mesh.0, 0.2 / mesh.0.len() as f32, |x| Vec3::new(0.3 * x.z, 0.2 * x.x, -0.3));
    start[0].fixed = true;
    let mut shell = shell(mesh, params);
    let none = Hinge { edge: [0; 2], far: [0; 2], faces: [0; 2] };
    shell.hinges.extend(std::iter::repeat_n(none, extra));
    let scene = Scene { start: &start, forces: &DOWN, constraints: &shell, substeps, ..Scene::EMPTY };
    let mut system = started(&scene, start.len(), 0);
    for frame in 1..=5 {
        system.step_to(&scene, Time::frame(frame, 60));
    }
    (system.particles().position.to_vec(), *system.totals())
}

/// By graphs, whatever the mesh, it takes few iterations to what masses alone lead to as well; and where there is no room for graphs, that is counted.
#[test]
fn meshes_of_all_kinds_are_solved_in_few_iterations() {
    let mut random = Random::new(4711);
    for (i, (name, mesh)) in of_all_kinds(&mut random).into_iter().enumerate() {
        let ways = [(100.0, 1e-6, 6), (500.0, 1e-5, 3)];
        for (stretch, bending, substeps) in ways.into_iter().skip(i % every(2)).step_by(every(2)) {
            let params = params(stretch, bending);
            let (places, report) = hung(&mesh, params, substeps, 0);
            let effort = report.effort;
            assert_eq!((report.caps.graphs, effort.capped), (0, 0), "{name}, {stretch} N/m: {effort:?}");
            let mean = |effort: &Effort| effort.iterations as f64 / effort.solves as f64;
            let (by_masses, masses) = hung(&mesh, params, substeps, 8);
            assert_eq!(masses.caps.graphs, u64::from(5 * substeps), "{name}");
            let (few, many) = (mean(&effort), mean(&masses.effort));
            // Needles, as there are where hundreds of spokes meet, are stiff beyond what groups of particles tell.
            let most = if slenderness(&mesh) > 30.0 { f64::max(0.5 * many, 30.0) } else { 30.0 };
            let off = places.iter().zip(&by_masses).map(|(a, b)| a.distance(*b)).fold(0.0, f32::max);
            println!("{name}, {stretch} N/m: {few:.1} iterations, by masses {many:.1}, off by {off:.1e} m");
            assert!(few < most, "{name}, {stretch} N/m: {few} iterations, by masses {many}");
            assert!(off < 2e-4, "{name}, {stretch} N/m: {off} m");
        }
    }
}

/// Words of 32 bits, for each particle: what is kept and what is worked with. Printed, as they are what decides which chip it runs on.
#[test]
fn shells_ask_for_few_words_a_particle() {
    for (cells, most) in [(16u32, [122, 165]), (64, [134, 172]), (128, [134, 172])] {
        let mesh = sheet([cells; 2], Vec3::ZERO);
        let demand = shell(&mesh, params(500.0, 1e-5)).demand();
        let words =
            [demand.kept, demand.scratch, demand.step].map(|words| words.of(mesh.0.len()) as f64 / mesh.0.len() as f64);
        println!(
            "{cells}²: {:.0} bytes kept a particle, {:.0} to work with, {:.0} for walls",
            4.0 * words[0],
            4.0 * words[1],
            4.0 * words[2]
        );
        assert!(words[0] < most[0] as f64 && words[1] < most[1] as f64, "{cells}: {words:?}");
    }
}
