//! Elastic strands against closed forms: how they bend, twist, stretch and swing, what they keep, and what does them no harm.

use pointmass::scene::{Model, SceneFile};
use pointmass::{
    ConstraintKind, Drag, Gravity, Heap, Measures, Method, Particle, Scene, StrandParams, Strands, System, Time, Vec3,
};
use pointmass_tests::{Random, every, gap, is_run, is_third, often, run, started};
use std::f64::consts::{PI, TAU};

const G: f32 = 9.81;

type Tuft = Strands<Vec<u32>, Vec<u32>>;

/// A straight strand: where it begins, its direction, its length and the number of its edges.
#[derive(Clone, Copy)]
struct Rod {
    root: Vec3,
    along: Vec3,
    long: f32,
    edges: u32,
}

impl Rod {
    fn edge(&self) -> f32 {
        self.long / self.edges as f32
    }

    /// Its particles, of a mass for each metre; clamped at the root by two that are fixed, the first of them beyond it.
    fn clamped(&self, density: f32) -> Vec<Particle> {
        let edge = self.edge();
        let place = |i: u32| self.root + self.along * (edge * (i as f32 - 1.0));
        let mass = |i: u32| density * edge * if i == self.edges + 1 { 0.5 } else { 1.0 };
        let point = |i: u32| Particle { position: place(i), mass: mass(i), fixed: i < 2, ..Particle::REST };
        (0..self.edges + 2).map(point).collect()
    }

    /// Its particles, free.
    fn free(&self, density: f32) -> Vec<Particle> {
        let all = self.clamped(density).into_iter().skip(1);
        let free = all.enumerate().map(|(i, p)| Particle {
            mass: if i == 0 { 0.5 * p.mass } else { p.mass },
            fixed: false,
            ..p
        });
        free.collect()
    }
}

/// All particles as one strand.
fn strand(start: &[Particle], params: StrandParams) -> Tuft {
    Strands::of((0..start.len() as u32).collect(), vec![start.len() as u32], params)
}

/// A strand that is the same to all sides.
fn even(stretch: f32, bending: f32, twisting: f32, damping: f32) -> StrandParams {
    StrandParams { stretch: Some(stretch), bending: [bending; 2], twisting, damping }
}

/// Two directions at right angles, turned anyhow.
fn pose(random: &mut Random) -> [Vec3; 2] {
    let along = random.vector(1.0).normalize();
    [along, along.cross(random.vector(1.0)).normalize()]
}

/// The tip of a strand after a time.
fn tip(start: &[Particle], tuft: &Tuft, down: Vec3, method: Method, substeps: u32, seconds: f32) -> Vec3 {
    let integrator = method.integrator();
    let forces = Gravity { acceleration: down };
    let scene = Scene { start, forces: &forces, constraints: tuft, substeps, integrator, ..Scene::EMPTY };
    let mut system = started(&scene, start.len(), 0);
    run(&mut system, &scene, 1.0 / 60.0, (60.0 * seconds) as u32 + 1);
    system.particles().position[start.len() - 1]
}

#[test]
fn a_cantilever_sags_as_beam_theory_has_it() {
    let mut methods = Method::ALL.iter().cycle();
    let mut random = Random::new(3);
    for (edges, long, far) in [(8u32, 0.3f32, 0.0f32), (16, 1.0, 10.0), (24, 0.04, 0.3)] {
        for substeps in [5, 10, 20, 50] {
            let [along, down] = pose(&mut random);
            let rod = Rod { root: random.vector(far), along, long, edges };
            let (density, sag) = (0.01f32, 0.02 * long);
            let bending = density * G * long.powi(4) / (8.0 * sag);
            let slowest = 3.516 * (bending / (density * long.powi(4))).sqrt();
            let method = *methods.next().expect("there is always a next one");
            // Nearly critically damped: soon it is at rest.
            let mut params = even(3e3 * bending / (long * long), bending, bending, 2.0 / slowest);
            let start = rod.clamped(density);
            let side = substeps % 20 == 0;
            // About the other axis it is stiffer.
            params.bending[usize::from(side)] *= 7.0;
            let across = if side { along.cross(down) } else { down };
            let tuft = Strands { across, ..strand(&start, params) };
            let end = tip(&start, &tuft, down * G, method, substeps, 14.0 / slowest);
            let has = (end - rod.root - along * long).dot(down);
            assert!((has / sag - 1.0).abs() < 0.03, "{method}, {edges} edges, {substeps} sub-steps: {}", has / sag);
        }
    }
}

/// What it moves in a sub-step is less than rounding of its places far from the origin, and is not lost in that.
#[test]
fn far_from_the_origin_a_wire_sags_as_near_it() {
    let mut methods = Method::ALL.iter().cycle();
    let (mut random, mut cases) = (Random::new(11), 0);
    for (edges, long, thick) in [(20u32, 0.3f32, 2e-3f32), (12, 0.5, 4e-3), (30, 0.2, 1e-3)] {
        for far in [10.0, 100.0, 300.0] {
            for (substeps, lag) in [(5, 2.0), (20, 2.0), (60, 4.0)] {
                if !is_third(&mut cases) {
                    continue;
                }
                let [along, down] = pose(&mut random);
                let root = random.vector(1.0).normalize() * far;
                let rod = Rod { root, along, long, edges };
                let density = 1200.0 * std::f32::consts::PI * thick * thick;
                let params = StrandParams::round(thick, 2e9, 0.35);
                let sag = density * G * long.powi(4) / (8.0 * params.bending[0]);
                let slowest = 3.516 * (params.bending[0] / (density * long.powi(4))).sqrt();
                let start = rod.clamped(density);
                let wire = strand(&start, StrandParams { damping: lag / slowest, ..params });
                let method = *methods.next().expect("there is always a next one");
                let end = tip(&start, &wire, down * G, method, substeps, 14.0 * lag / slowest);
                let has = (end - start[start.len() - 1].position).dot(down) / sag;
                assert!((has - 1.0).abs() < 0.03, "{method}, {far} m off, {edges} edges, {substeps} sub-steps: {has}");
            }
        }
    }
}

/// What gravity moves across an edge in a sub-step stretches nothing, though it is a jerk to damping that acts over many sub-steps.
#[test]
fn damping_over_many_substeps_does_not_hold_a_cantilever() {
    let mut methods = Method::ALL.iter().cycle();
    let mut random = Random::new(5);
    for (edges, long, fall) in [(20u32, 3e-3f32, 0.18f32), (9, 0.2, 0.03), (33, 0.05, 0.1), (14, 2.0, 0.1)] {
        for lag in [0.5f32, 6.0, 60.0] {
            let [along, down] = pose(&mut random);
            let rod = Rod { root: random.vector(long), along, long, edges };
            let method = *methods.next().expect("there is always a next one");
            // A round wire of 1/150 of its length; in a sub-step one falls by a share of an edge.
            let (substeps, density, sag) = (10, 1e-3f32, 0.015 * long);
            let h = (fall * rod.edge() / G).sqrt();
            let bending = density * G * long.powi(4) / (8.0 * sag);
            let stretch = 4.0 * bending / (long / 150.0).powi(2);
            let start = rod.clamped(density);
            let tuft = strand(&start, even(stretch, bending, bending, lag * h));
            let gravity = Gravity { acceleration: down * G };
            let integrator = method.integrator();
            let scene =
                Scene { start: &start, forces: &gravity, constraints: &tuft, substeps, integrator, ..Scene::EMPTY };
            let mut system = started(&scene, start.len(), 0);
            // Its slowest swing lasts 5 √(sag / g); what is damped more than critically takes as long as its stresses.
            let seconds = 10.0 * (lag * h) + 20.0 * (sag / G).sqrt() + 40.0 * (sag / G) / (lag * h);
            let frame = h * substeps as f32;
            run(&mut system, &scene, f64::from(frame), (seconds / frame) as u32 + 1);
            let has = (system.particles().position[start.len() - 1] - rod.root - along * long).dot(down);
            assert!((has / sag - 1.0).abs() < 0.02, "{method}, {edges} edges of {long} m, {lag}: {}", has / sag);
        }
    }
}

/// Threads that swing from level, whip and fold, and wires between two hooks, gain nothing, in whatever sub-steps. What bears a load is lent the half of
/// the square of what gravity gives it in a sub-step, each time; places may be a sub-step ahead of velocities.
#[test]
fn what_hangs_gains_no_energy() {
    let mut methods = Method::ALL.iter().cycle();
    let mut random = Random::new(11);
    for (edges, long, radius, young) in
        [(25u32, 1.0f32, 3e-4f32, 1e8f32), (20, 0.2, 4e-5, 4e9), (10, 0.5, 1e-3, 2e6), (30, 1.0, 2e-4, 2e11)]
    {
        for ends in 0..3 {
            for substeps in [1, 3, 10] {
                let [along, down] = pose(&mut random);
                let rod = Rod { root: random.vector(long), along, long, edges };
                let method = *methods.next().expect("there is always a next one");
                let density = 1300.0 * std::f32::consts::PI * radius * radius;
                let mut start = rod.clamped(density);
                // Clamped, by a hinge, or between two.
                start[0].fixed = ends != 1;
                start[edges as usize + 1].fixed = ends == 2;
                let start = &start[usize::from(ends > 0)..];
                let tuft = strand(start, StrandParams::round(radius, young, 0.3));
                let gravity = Gravity { acceleration: down * G };
                let integrator = method.integrator();
                let scene = Scene { start, forces: &gravity, constraints: &tuft, substeps, integrator, ..Scene::EMPTY };
                let mut system = started(&scene, start.len(), 0);
                let (mass, h) = (density * long, 1.0 / (60.0 * substeps as f32));
                for frame in 1..=150u64 {
                    system.step_to(&scene, Time::frame(frame, 60));
                    let all = system.particles();
                    let fallen =
                        all.position.iter().zip(start).map(|(x, from)| from.mass * (*x - from.position).dot(down));
                    let moving = all.velocity.iter().zip(all.mass).map(|(v, m)| 0.5 * m * v.length_squared());
                    let gained = moving.sum::<f32>() - G * fallen.sum::<f32>();
                    let lent = 0.5 * mass * G * G * h * (frame as f32 / 60.0);
                    assert!(
                        gained < (0.02 + h * (2.0 * G / long).sqrt()) * mass * G * long + lent,
                        "{method}, {edges} edges of {long} m, {ends} in {substeps}: {} at {frame}",
                        gained / (mass * G * long)
                    );
                }
            }
        }
    }
}

/// A wire without bending stiffness worth the name between two hooks sags by L (3 w L / (64 E A))^⅓, however stiff it is and however damped.
#[test]
fn a_damped_wire_between_hooks_sags_as_far_as_it_stretches() {
    for (long, edges, substeps, damping) in
        [(1.0f32, 30u32, 4, 0.2f32), (1.0, 30, 10, 0.2), (0.5, 20, 10, 0.02), (3.0, 40, 20, 1.0)]
            .into_iter()
            .step_by(every(2))
    {
        let rod = Rod { root: Vec3::ONE, along: Vec3::X, long, edges };
        let (density, stretch) = (1e-3f32, 2.5e4f32);
        let mut start = rod.clamped(density);
        start.remove(0);
        start[edges as usize].fixed = true;
        let tuft = strand(&start, even(stretch, 1e-7, 1e-7, damping));
        let gravity = Gravity { acceleration: Vec3::NEG_Y * G };
        let scene = Scene { start: &start, forces: &gravity, constraints: &tuft, substeps, ..Scene::EMPTY };
        let mut system = started(&scene, start.len(), 0);
        run(&mut system, &scene, 1.0 / 60.0, 900);
        let sag = 1.0 - system.particles().position[edges as usize / 2].y;
        let right = long * (3.0 * density * G * long / (64.0 * stretch)).cbrt();
        assert!((sag / right - 1.0).abs() < 0.03, "{long} m in {substeps}, {damping} s: {}", sag / right);
    }
}

#[test]
fn a_load_at_the_tip_bends_a_cantilever_by_its_third_power() {
    let rod = |edges| Rod { root: Vec3::ONE, along: Vec3::NEG_X, long: 0.5, edges };
    for (edges, substeps, method) in [(6, 10, Method::Verlet), (12, 5, Method::Symplectic), (31, 20, Method::Rk4)] {
        let density = 5e-3f32;
        let mut start = rod(edges).clamped(density);
        let (load, sag) = (0.1, 0.01);
        start[edges as usize + 1].mass += load;
        // Of its own weight comes P L³/(3 E I) + w L⁴/(8 E I) as well.
        let bending = G * (load * 0.5f32.powi(3) / 3.0 + density * 0.5f32.powi(4) / 8.0) / sag;
        let slowest = (G / sag).sqrt();
        let tuft = strand(&start, even(1e5, bending, bending, 2.0 / slowest));
        let has = 1.0 - tip(&start, &tuft, Vec3::NEG_Y * G, method, substeps, 14.0 / slowest).y;
        assert!((has / sag - 1.0).abs() < 0.03, "{method}, {edges} edges: {}", has / sag);
    }
}

/// How far the end of a cantilever goes down and comes in under a load P, as shares of its length, with α = P L²/(E I): by shooting at
/// E I θ″ = −P cos θ (Bisshopp and Drucker, "Large deflection of cantilever beams", Quart. Appl. Math. 3, 1945).
fn elastica(load: f64) -> [f64; 2] {
    let shoot = |curvature: f64| {
        let n = 4000;
        let h = 1.0 / f64::from(n);
        let (mut angle, mut bend, mut down, mut out) = (0.0f64, curvature, 0.0, 0.0);
        for _ in 0..n {
            // The midpoint's rule.
            let (a, b) = (angle + 0.5 * h * bend, bend - 0.5 * h * load * angle.cos());
            down += h * a.sin();
            out += h * a.cos();
            angle += h * b;
            bend -= h * load * a.cos();
        }
        (bend, [down, 1.0 - out])
    };
    let [mut low, mut high] = [0.0, load];
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if shoot(middle).0 > 0.0 { high = middle } else { low = middle }
    }
    shoot(low).1
}

#[test]
fn a_large_load_bends_a_cantilever_into_the_elastica() {
    for (load, printed) in [(1.0, 0.30172), (2.0, 0.49346), (5.0, 0.71379), (10.0, 0.81061)] {
        assert!((elastica(load)[0] - printed).abs() < 2e-5, "{load}: {:?}", elastica(load));
    }
    let mut random = Random::new(8);
    for (load, edges, substeps, method) in [
        (1.0f32, 12u32, 5, Method::Symplectic),
        (2.0, 20, 10, Method::Verlet),
        (5.0, 16, 20, Method::Rk4),
        (10.0, 30, 10, Method::Euler),
    ] {
        let [along, down] = pose(&mut random);
        let rod = Rod { root: random.vector(3.0), along, long: 0.8, edges };
        let mut start = rod.clamped(2e-3);
        start[edges as usize + 1].mass += 0.2;
        let bending = 0.2 * G * 0.64 / load;
        let period = (0.2 * 0.512 / (3.0 * bending)).sqrt();
        let tuft = strand(&start, even(1e4 * bending, bending, bending, 2.0 * period));
        let end = (tip(&start, &tuft, down * G, method, substeps, 24.0 * period) - rod.root) / 0.8;
        let [sag, nearer] = elastica(load.into()).map(|x| x as f32);
        assert!((end.dot(down) / sag - 1.0).abs() < 0.03, "{method}, {load}: {} {sag}", end.dot(down));
        assert!((end.dot(along) + nearer - 1.0).abs() < 0.03, "{method}, {load}: {} {nearer}", end.dot(along));
    }
}

#[test]
fn a_clamped_bar_swings_with_the_period_of_its_first_mode() {
    for (edges, substeps, method, stiff) in
        [(10u32, 20, Method::Symplectic, 1.0f32), (20, 10, Method::Verlet, 0.3), (14, 40, Method::Rk4, 3.0)]
    {
        let rod = Rod { root: Vec3::new(-2.0, 1.0, 0.0), along: Vec3::Z, long: 0.4, edges };
        let density = 0.05f32;
        let bending = stiff * 5e-3;
        let omega = 3.516 * (bending / (density * rod.long.powi(4))).sqrt();
        let mut start = rod.clamped(density);
        for particle in &mut start[2..] {
            let far = (particle.position.z / rod.long).powi(2);
            particle.velocity = Vec3::Y * (0.01 * omega * rod.long * far);
        }
        let tuft = strand(&start, even(1e4 * bending, bending, bending, 0.0));
        let integrator = method.integrator();
        let scene = Scene { start: &start, constraints: &tuft, substeps, integrator, ..Scene::EMPTY };
        let mut system = started(&scene, start.len(), 0);
        let step = f64::from(TAU as f32 / omega) / 100.0;
        // The times at which the tip passes its place at rest; higher modes make single ones early or late.
        let (mut passed, mut last) = (Vec::new(), 0.0f32);
        for frame in 1..=560u32 {
            system.step_to(&scene, Time::from_seconds_f64(step * f64::from(frame)));
            let now = system.particles().position[start.len() - 1].y - 1.0;
            if last * now < 0.0 {
                passed.push((f64::from(frame) - f64::from(now / (now - last))) * step);
            }
            last = now;
        }
        let period = 2.0 * (passed[passed.len() - 1] - passed[0]) / (passed.len() - 1) as f64;
        let share = period * f64::from(omega) / TAU;
        assert!(passed.len() > 8 && (share - 1.0).abs() < 0.03, "{method}, {edges} edges: {share} {}", passed.len());
    }
}

/// How far a strand between two clamps gets from its axis, as a share of its length, once it has been twisted by so many radians.
fn writhe(rod: &Rod, twist: f32, ratio: f32, substeps: u32, method: Method) -> f32 {
    let density = 0.02f32;
    let bending = 2e-3f32;
    let mut start = rod.clamped(density);
    let last = start.len() - 1;
    start.push(Particle { position: rod.root + rod.along * (rod.long + rod.edge()), ..start[last] });
    start[last].fixed = true;
    start[last + 1].fixed = true;
    let mut random = Random::new(1);
    start[2..last].iter_mut().for_each(|p| p.position += random.vector(1e-4 * rod.long));
    let stretch = 400.0 * bending / rod.long.powi(2);
    let at_rest = Strands { twist: -twist / rod.long, ..strand(&start, even(stretch, bending, ratio * bending, 1e-3)) };
    let integrator = method.integrator();
    let scene = Scene { start: &start, constraints: &at_rest, substeps, integrator, ..Scene::EMPTY };
    let mut system = started(&scene, start.len(), 0);
    run(&mut system, &scene, 1.0 / 60.0, 300);
    let far = |x: &Vec3| (*x - rod.root).cross(rod.along).length() / rod.long;
    system.particles().position.iter().map(far).fold(0.0, f32::max)
}

/// Both ends clamped and turned by θ: straight until θ = 8.9868 B / C, twice the first root of tan x = x (Love, "A Treatise on the
/// Mathematical Theory of Elasticity", 1927, article 272); ends that cannot come nearer only count once it is bent.
#[test]
fn a_twisted_strand_writhes_at_its_theoretical_twist() {
    for (edges, ratio, substeps, method, sense) in [
        (18u32, 1.5f32, 10, Method::Symplectic, 1.0f32),
        (12, 2.0, 5, Method::Verlet, -1.0),
        (24, 1.0, 8, Method::Rk4, 1.0),
    ] {
        let rod = Rod { root: Vec3::new(0.5, 0.0, -1.0), along: Vec3::new(0.6, 0.0, 0.8), long: 0.5, edges };
        let critical = 8.9868 / ratio * sense;
        let [below, above] = [0.93, 1.08].map(|share| writhe(&rod, share * critical, ratio, substeps, method));
        assert!(below < 3e-3, "{method}, {edges} edges: {below}");
        assert!(above > 0.02, "{method}, {edges} edges: {above}");
    }
}

/// A coil of a radius and pitch that begins at a place, with so many points.
fn coil(points: u32, radius: f32, pitch: f32, turns: f32) -> Vec<Particle> {
    let place = |i: u32| {
        let far = i as f32 / (points - 1) as f32 * turns;
        let (sin, cos) = (far * TAU as f32).sin_cos();
        Vec3::new(radius * cos, radius * sin, pitch * far)
    };
    (0..points).map(|i| Particle { position: place(i), mass: 1e-3, ..Particle::REST }).collect()
}

/// The distances of all points from the first, and of each from the third next: its shape, wherever it is.
fn shape(x: &[Vec3]) -> Vec<f32> {
    let far = x.iter().map(|&y| y.distance(x[0]));
    far.chain(x.windows(4).map(|part| part[3].distance(part[0]))).collect()
}

fn worst(a: &[f32], b: &[f32]) -> f32 {
    a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max)
}

#[test]
fn a_coil_stays_one_and_comes_back_to_its_shape() {
    for (points, substeps, method, bending) in [
        (20u32, 5, Method::Symplectic, [1e-2f32, 1e-2]),
        (33, 10, Method::Verlet, [2e-2, 1e-2]),
        (40, 2, Method::Rk4, [1e-2, 5e-2]),
    ] {
        let mut start = coil(points, 0.05, 0.04, 2.5);
        let params = StrandParams { stretch: Some(5e3), bending, twisting: 8e-3, damping: 0.02 };
        let tuft = strand(&start, params);
        let rest = shape(&start.iter().map(|p| p.position).collect::<Vec<_>>());
        for disturbed in [false, true] {
            let mut random = Random::new(points.into());
            start.iter_mut().for_each(|p| p.velocity = random.vector(if disturbed { 1.0 } else { 0.0 }));
            let integrator = method.integrator();
            let scene = Scene { start: &start, constraints: &tuft, substeps, integrator, ..Scene::EMPTY };
            let mut system = started(&scene, start.len(), 0);
            let mut farthest = 0.0f32;
            for frame in 1..=120 {
                system.step_to(&scene, Time::frame(frame, 60));
                farthest = farthest.max(worst(&rest, &shape(system.particles().position)));
            }
            let off = worst(&rest, &shape(system.particles().position));
            assert!(
                off < if disturbed { 2e-3 } else { 2e-5 },
                "{method}, {points} points, {disturbed}: {farthest}, then {off}"
            );
            assert!(!disturbed || farthest > 5e-3, "{method}, {points} points: {farthest}");
        }
    }
}

#[test]
fn a_strand_that_hangs_stretches_by_its_weight() {
    for (edges, substeps, method) in [(3, 3, Method::Symplectic), (17, 8, Method::Verlet), (40, 2, Method::Rk4)] {
        let rod = Rod { root: Vec3::ZERO, along: Vec3::NEG_Y, long: 2.0, edges };
        let mut start = rod.clamped(0.1);
        start[edges as usize + 1].mass += 0.3;
        // By 1 % for the load, and half of that times 2/3 for its own weight.
        let tuft = strand(&start, even(0.3 * G / 0.01, 1e-5, 1e-5, 0.05));
        let longer = -tip(&start, &tuft, Vec3::NEG_Y * G, method, substeps, 3.0).y / 2.0 - 1.0;
        let theory = 0.01 + 0.01 / 3.0;
        assert!((longer / theory - 1.0).abs() < 0.01, "{method}, {edges} edges: {longer}");
    }
}

#[test]
fn a_limp_strand_hangs_as_a_catenary() {
    for (edges, substeps, stretch) in [(24u32, 5, None), (48, 10, Some(1e4)), (24, 20, Some(1e3))] {
        let edge = 1.2 / edges as f32;
        // It begins as two straight halves.
        let place = |i: u32| {
            let far = i as f32 / edges as f32;
            Vec3::new(far, -(0.36f32 - 0.25).sqrt() * (1.0 - (2.0 * far - 1.0).abs()), 0.0)
        };
        let point = |i: u32| Particle {
            position: place(i),
            mass: 0.2 * edge,
            drag: 0.4 * edge,
            fixed: i == 0 || i == edges,
            ..Particle::REST
        };
        let start: Vec<_> = (0..=edges).map(point).collect();
        let tuft = strand(&start, StrandParams { stretch, bending: [0.0; 2], twisting: 0.0, damping: 0.01 });
        let forces = (Gravity { acceleration: Vec3::NEG_Y * G }, Drag {});
        let scene = Scene { start: &start, forces: &forces, constraints: &tuft, substeps, ..Scene::EMPTY };
        let mut system = started(&scene, start.len(), 0);
        run(&mut system, &scene, 1.0 / 60.0, 360);
        let sag = -system.particles().position[edges as usize / 2].y;
        assert!((sag - 0.292_343_8).abs() < 3e-3, "{edges} edges, {substeps} sub-steps: {sag}");
    }
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

fn keeps_its_momenta(frames: u32, cases: &[(u32, f32, f32)]) {
    let mut methods = [Method::Symplectic, Method::Verlet, Method::Rk4, Method::Euler].into_iter().cycle();
    for &(edges, scale, away) in cases {
        for (substeps, stiff, stretch) in [(1, 1.0f32, Some(10.0f32)), (5, 1e-3, None), (20, 1e-2, Some(1e3))] {
            let mut random = Random::new(5);
            let [along, _] = pose(&mut random);
            let rod = Rod { root: Vec3::new(7.0, -3.0, 2.0) * away, along, long: 0.5 * scale, edges };
            let mut start = rod.free(0.02);
            let middle = rod.root + along * (0.5 * rod.long);
            for (i, p) in start.iter_mut().enumerate() {
                let wave = random.vector(0.02) + Vec3::new(0.2, 0.1, -0.1) * (i as f32 * 1.3).sin();
                // What flies on slowly stays where places are fine.
                p.velocity = Vec3::new(1.0, 2.0, 3.0).cross(p.position - middle) + (wave + Vec3::X * 0.02) * scale;
            }
            let bending = stiff * 1e-2 * scale * scale;
            let stretch = stretch.map(|stretch| stretch * scale);
            let tuft = strand(&start, StrandParams { stretch, ..even(1.0, bending, bending, 0.0) });
            let method = methods.next().expect("there is always a next one");
            let integrator = method.integrator();
            let scene = Scene { start: &start, constraints: &tuft, substeps, integrator, ..Scene::EMPTY };
            let mut system = started(&scene, start.len(), 0);
            let (before, turned) = (Measures::of(&system, &scene), spin(&system, &start));
            let moving = before.energy.kinetic;
            for frame in 1..=u64::from(frames) {
                system.step_to(&scene, Time::frame(frame, 60));
                let now = Measures::of(&system, &scene).energy.kinetic;
                assert!(now < moving * (1.0 + 1e-5), "{method}, {substeps}, {scale} m, {frame}: {}", now / moving);
            }
            let after = Measures::of(&system, &scene);
            let mass: f64 = start.iter().map(|p| f64::from(p.mass)).sum();
            let drift = gap(before.momentum, after.momentum) / (mass * f64::from(scale));
            assert!(drift < 5e-5 * (1.0 + f64::from(away)), "{method}, {substeps} sub-steps: {drift}");
            let all = f64::from(frames * substeps);
            let rounding = 2e-9 * all + 3e-3 * f64::from(away) * (all / 4500.0).sqrt().max(1.0);
            let lost = gap(turned, spin(&system, &start)) / gap(turned, [0.0; 3]);
            assert!(lost < 1e-4 + rounding, "{method}, {substeps} sub-steps, {scale} m, {away}: {lost}");
            assert!(after.energy.kinetic > 0.5 * moving, "{method}: {}", after.energy.kinetic / moving);
        }
    }
}

#[test]
fn a_free_strand_keeps_its_momenta_and_gains_no_energy() {
    keeps_its_momenta(often(600) as u32 * 2, &[(12, 1.0, 0.0), (7, 1.0, 1.0), (20, 1e-2, 0.0), (9, 30.0, 0.0)]);
}

/// However stiff it is, however wildly it moves and however long its sub-steps: neither energy nor angular momentum comes of solving it, and it stays
/// about as long as it is.
fn gains_nothing(frames: u32, edges: u32, stretches: &[Option<f32>]) {
    let mut methods = [Method::Symplectic, Method::Verlet, Method::Rk4, Method::Euler].into_iter().cycle();
    for (&stretch, wild) in stretches.iter().flat_map(|stretch| [0.1f32, 0.5, 1.0].map(|wild| (stretch, wild))) {
        for (bending, substeps) in [1e-5, 1e-3].into_iter().flat_map(|b| [1, 2, 3, 5, 10, 20, 50].map(|n| (b, n))) {
            let mut random = Random::new(77);
            let rod =
                Rod { root: Vec3::NEG_X * (0.05 * edges as f32), along: Vec3::X, long: 0.1 * edges as f32, edges };
            let mut start = rod.free(0.5);
            start.iter_mut().for_each(|p| p.velocity = Vec3::Z.cross(p.position) * 3.0 + random.vector(wild));
            let mass: f32 = start.iter().map(|p| p.mass).sum();
            let drift = start.iter().map(|p| p.velocity * p.mass).sum::<Vec3>() / mass;
            start.iter_mut().for_each(|p| p.velocity -= drift);
            let strand = strand(&start, StrandParams { stretch, ..even(1.0, bending, bending, 0.0) });
            let method = methods.next().expect("there is always a next one");
            let integrator = method.integrator();
            let scene = Scene { start: &start, constraints: &strand, substeps, integrator, ..Scene::EMPTY };
            let mut system = started(&scene, start.len(), 0);
            let (moving, turned) = (Measures::of(&system, &scene).energy.kinetic, spin(&system, &start));
            let name = format!("{method}, {substeps} sub-steps, {stretch:?} N, {bending} N m², {wild} m/s");
            for frame in 1..=u64::from(frames) {
                system.step_to(&scene, Time::frame(frame, 60));
                let kinetic = Measures::of(&system, &scene).energy.kinetic;
                assert!(kinetic < moving * (1.0 + 1e-5), "{name}, {frame}: {}", kinetic / moving);
                let x = system.particles().position;
                let long = x.windows(2).map(|ends| ends[0].distance(ends[1]) / 0.1).fold(0.0, f32::max);
                assert!(long < 1.5, "{name}, {frame}: {long}");
            }
            let lost = gap(turned, spin(&system, &start)) / gap(turned, [0.0; 3]);
            assert!(lost < 1e-4, "{name}: {lost}");
        }
    }
}

#[test]
fn no_energy_comes_of_solving_a_free_strand() {
    gains_nothing(often(120) as u32, 23, &[None, Some(1e2), Some(1e4)]);
}

#[test]
#[ignore = "long: minutes"]
fn no_energy_comes_of_solving_a_free_strand_for_a_minute() {
    gains_nothing(3600, 23, &[None, Some(1e2), Some(1e3), Some(1e4), Some(1e6)]);
}

#[test]
#[ignore = "long: minutes"]
fn a_free_strand_keeps_its_momenta_for_a_minute() {
    keeps_its_momenta(3600, &[(12, 1.0, 0.0), (33, 1.0, 0.0)]);
}

/// Strands that are solved together are those that are solved alone, to the bit.
#[test]
fn strands_in_company_do_as_they_do_alone() {
    let mut random = Random::new(12);
    let params = StrandParams { damping: 1e-3, ..StrandParams::round(1e-3, 1e8, 0.4) };
    let counts = [9u32, 2, 14, 7, 7, 30, 3, 9, 12, 5, 21];
    let mut start = Vec::new();
    for &count in &counts {
        let [along, _] = pose(&mut random);
        let rod = Rod { root: random.vector(1.0), along, long: 0.02 * count as f32, edges: count - 1 };
        let mut points = rod.free(0.01);
        points[0].fixed = count % 2 == 1;
        points[1].fixed = count % 3 == 0;
        points.iter_mut().for_each(|p| p.velocity = random.vector(1.0));
        start.extend(points);
    }
    let down = Gravity { acceleration: Vec3::NEG_Y * G };
    let all = Strands::of((0..start.len() as u32).collect::<Vec<_>>(), counts.to_vec(), params);
    let mut first = 0;
    let alone: Vec<_> = counts
        .iter()
        .map(|&count| {
            first += count;
            Strands::of((first - count..first).collect::<Vec<_>>(), vec![count], params)
        })
        .collect();
    let scene = Scene { start: &start, forces: &down, substeps: 4, ..Scene::EMPTY };
    let (together, apart) = (Scene { constraints: &all, ..scene }, Scene { constraints: &&alone[..], ..scene });
    let (mut one, mut other) = (started(&together, start.len(), 0), started(&apart, start.len(), 0));
    run(&mut one, &together, 1.0 / 60.0, 60);
    run(&mut other, &apart, 1.0 / 60.0, 60);
    assert_eq!(one.particles().position, other.particles().position);
    assert_eq!(one.particles().velocity, other.particles().velocity);
    assert!(one.particles().position.iter().zip(&start).any(|(x, p)| x.distance(p.position) > 0.05));
}

/// Edges whose ends begin in one place are counted, once.
#[test]
fn edges_without_length_are_counted() {
    let rod = Rod { root: Vec3::ZERO, along: Vec3::X, long: 1.0, edges: 10 };
    let plain = rod.clamped(0.1);
    let mut twice = plain.clone();
    twice[7].position = plain[8].position;
    twice[4].position = plain[3].position;
    // Those that are not there are none.
    let (mut nowhere, few) = (plain.clone(), plain[..7].to_vec());
    nowhere[9].position.y = f32::NAN;
    for (start, right) in [(plain, 0), (twice, 2), (nowhere, 2), (few, 0)] {
        let tuft = Strands::of((0..11).collect::<Vec<u32>>(), [11], even(10.0, 1e-4, 1e-4, 1e-3));
        let scene = Scene { start: &start, constraints: &tuft, substeps: 4, ..Scene::EMPTY };
        let mut system = started(&scene, start.len(), 0);
        run(&mut system, &scene, 1.0 / 60.0, 3);
        assert_eq!(system.totals().caps.degenerate, right);
    }
}

#[test]
fn nothing_does_a_strand_harm() {
    let rod = Rod { root: Vec3::ZERO, along: Vec3::X, long: 1.0, edges: 10 };
    let plain = rod.clamped(0.1);
    let change = |at: usize, part: Particle| {
        let mut start = plain.clone();
        start[at] = part;
        start
    };
    let point: Vec<_> = plain.iter().map(|p| Particle { position: Vec3::ONE, ..*p }).collect();
    let fixed: Vec<_> = plain.iter().map(|p| Particle { fixed: true, ..*p }).collect();
    let between: Vec<_> = plain.iter().enumerate().map(|(i, p)| Particle { fixed: i % 4 == 1, ..*p }).collect();
    let back: Vec<_> =
        plain.iter().enumerate().map(|(i, p)| Particle { position: Vec3::X * (i % 2) as f32, ..*p }).collect();
    let starts = [
        (plain.clone(), true),
        (change(7, plain[8]), true),
        (change(7, Particle { position: Vec3::NAN, ..plain[7] }), false),
        (change(7, Particle { velocity: Vec3::splat(f32::INFINITY), ..plain[7] }), false),
        (change(7, Particle { position: Vec3::splat(3e38), ..plain[7] }), false),
        (change(7, Particle { velocity: Vec3::splat(1e30), ..plain[7] }), false),
        (change(7, Particle { mass: 1e-30, ..plain[7] }), false),
        (point, true),
        (fixed, true),
        (between, true),
        (back, true),
        (plain[..7].to_vec(), true),
    ];
    let params = [
        even(10.0, 1e-4, 1e-4, 1e-3),
        StrandParams { stretch: None, ..even(1.0, 0.0, 0.0, 0.0) },
        even(1e6, 10.0, 1e-6, 0.0),
        even(1e30, 1e30, 1e30, 0.0),
        even(f32::NAN, 1.0, 1.0, 0.0),
        even(1e-30, f32::INFINITY, 1.0, 1e30),
        even(0.0, 0.0, 1.0, 0.0),
    ];
    let mut cases = 0;
    for (at, (start, tame)) in starts.iter().enumerate() {
        for (number, &params) in params.iter().enumerate() {
            for points in [vec![12], vec![5, 3], vec![2], vec![1, 0], vec![99]] {
                for (substeps, turning) in [(1, [0.0; 2]), (4, [0.0, 50.0]), (2, [f32::NAN, 1.0]), (3, [3e38; 2])] {
                    if !is_run(&mut cases) {
                        continue;
                    }
                    let particles = (0..12).chain([77]).collect::<Vec<u32>>();
                    let held = [true; 2];
                    let tuft = Strands { twist: 3.0, held, turning, ..Strands::of(particles, points.clone(), params) };
                    let forces = Gravity { acceleration: Vec3::NEG_Y * G };
                    let scene = Scene { start, forces: &forces, constraints: &tuft, substeps, ..Scene::EMPTY };
                    let mut system = started(&scene, start.len(), 0);
                    run(&mut system, &scene, 1.0 / 60.0, 20);
                    let all = system.particles().position;
                    let sound = all.len() == start.len() && all.iter().all(|x| x.is_finite() && x.length() < 100.0);
                    assert!(sound || !*tame || number > 2, "{at} {number} {points:?} {substeps}: {all:?}");
                }
            }
        }
    }
    let tuft = strand(&plain, params[0]);
    assert!(tuft.fault().is_none());
    assert_eq!(strand(&plain, even(0.0, 0.0, 0.0, 0.0)).fault().map(|(name, _)| name), Some("stretch"));
    assert_eq!(strand(&plain, even(1.0, -1.0, 0.0, 0.0)).fault().map(|(name, _)| name), Some("bending"));
    assert_eq!(Strands { points: vec![1], ..tuft.clone() }.fault().map(|(name, _)| name), Some("points"));
    assert_eq!(Strands { twist: f32::NAN, ..tuft }.fault().map(|(name, _)| name), Some("twist"));
}

#[test]
fn files_grow_strands_that_go_with_what_moves() {
    let text = r#"{
        "forces": [{"gravity": {"acceleration": [0, -9.8, 0]}}],
        "particles": [{"position": [9, 9, 9]}],
        "strands": [
            {
                "form": {"on": {
                    "shape": {"sphere": {"center": [0, 1, 0], "radius": 0.1}}, "within": [[-1, 1, -1], [1, 2, 1]], "count": 7,
                    "length": 0.2, "curl": {"radius": 0.01, "pitch": 0.05}, "spread": 0.2
                }},
                "segments": 12, "radius": 1e-3, "young": 1e7, "density": 1000, "damping": 0.01, "colors": [[1, 2, 3, 255]],
                "motion": {"drift": [0.5, 0, 0]}
            },
            {
                "form": {"curve": [[0, 0, 0], [1, 0, 0], [1, 1, 0]]}, "segments": 8, "radius": 2e-3, "young": 2e11, "poisson": 0.3,
                "density": 7850, "fixed": [0, 8], "width": 0.01
            }
        ]
    }"#;
    let file = SceneFile::from_json("a.json", text).expect("it is sound");
    let model = Model::load(&file, "a.json", &mut ()).expect("it can be made");
    let [ConstraintKind::Attach(roots), ConstraintKind::Strands(tuft), ConstraintKind::Strands(wire)] =
        &model.constraints.0[..]
    else {
        panic!("{:?}", model.constraints.0)
    };
    assert_eq!((roots.particles.len(), tuft.particles.len(), tuft.points[0], wire.points[0]), (14, 98, 14, 9));
    let (grown, along) = (&model.particles[1..99], &model.particles[99..]);
    // A strand weighs as much as it is long, and its root lies on the upper half of the ball.
    for strand in grown.chunks(14) {
        let root = strand[1].position - Vec3::Y;
        assert!(strand[0].fixed && strand[1].fixed && !strand[2].fixed && root.y >= 0.0);
        assert!((root.length() - 0.1).abs() < 1e-5 && strand[0].position.distance(Vec3::Y) < 0.1);
        let mass: f64 = strand.iter().map(|p| f64::from(p.mass)).sum();
        let whole = 1000.0 * PI * 1e-6 * 0.2 * 13.0 / 12.0;
        // Chords are a little shorter than the coil.
        assert!((mass / whole - 1.0).abs() < 0.05, "{mass} {whole}");
    }
    let mass: f64 = along.iter().map(|p| f64::from(p.mass)).sum();
    assert!((mass / (7850.0 * PI * 4e-6 * 2.0) - 1.0).abs() < 1e-5 && along[4].position.distance(Vec3::X) < 1e-6);
    let stiff = f64::from(wire.params.bending[0]) / (2e11 * PI * 1.6e-11 / 4.0);
    assert!((stiff - 1.0).abs() < 1e-5 && (wire.params.twisting * 1.3 / wire.params.bending[0] - 1.0).abs() < 1e-5);
    assert_eq!((model.locks.len(), model.locks[0].count, model.locks[1].width), (2, 7, 0.01));
    let mut system = model.system(0, 1).expect("there is memory");
    for frame in 1..=60 {
        system.step_to(&model.scene(), Time::frame(frame, 60));
    }
    let now = system.particles().position;
    for (strand, start) in now[1..99].chunks(14).zip(grown.chunks(14)) {
        assert!(strand[1].distance(start[1].position + Vec3::X * 0.5) < 1e-4, "{}", strand[1]);
        assert!((strand[13].x - start[13].position.x - 0.5).abs() < 0.3, "{}", strand[13]);
    }
    for (wrong, why) in [
        (r#""segments": 12"#, r#""segments": 0"#),
        (r#""young": 1e7"#, r#""young": 0"#),
        (r#""poisson": 0.3"#, r#""poisson": 0.7"#),
        (r#""fixed": [0, 8]"#, r#""fixed": [9]"#),
        (r#""length": 0.2"#, r#""length": -1"#),
        (r#""pitch": 0.05"#, r#""pitch": 0"#),
        ("[[0, 0, 0], [1, 0, 0], [1, 1, 0]]", "[[0, 0, 0]]"),
        ("[[0, 0, 0], [1, 0, 0], [1, 1, 0]]", "[[0, 0, 0], [1, 0, 0], [0, 0, 0]]"),
        (r#""count": 7"#, r#""count": 4000000000"#),
    ] {
        let file = SceneFile::from_json("a.json", &text.replace(wrong, why)).expect("it is a scene");
        assert!(file.check().is_err(), "{why}");
    }
}
