//! Ropes that hang: how they swing and how they sag, against closed forms.

use pointmass::{Drag, Gravity, Measures, Method, Particle, Rope, Scene, Time, Vec3};
use pointmass_tests::{Random, f64s, gap, is_run, is_third, run, started};

const G: f64 = 9.81;

/// A rope that hangs: so many links of equal masses, with a weight at its end.
#[derive(Clone, Copy, Debug)]
struct Hung {
    links: usize,
    length: f64,
    /// The mass of each particle, and of the last one besides \[kg\].
    mass: f64,
    bob: f64,
    /// How far all of it is stretched by what hangs at its end, as a share of its length.
    gives: f64,
}

/// The ways down and aside, and the pivot.
struct Pose {
    down: Vec3,
    aside: Vec3,
    pivot: Vec3,
}

impl Pose {
    fn any(random: &mut Random) -> Self {
        let down = random.direction();
        let aside = down.cross(random.direction()).normalize();
        Self { down, aside, pivot: random.vector(2.0) }
    }
}

impl Hung {
    fn link(&self) -> f64 {
        self.length / self.links as f64
    }

    fn mass_of(&self, particle: usize) -> f64 {
        self.mass + if particle == self.links { self.bob } else { 0.0 }
    }

    /// The pull in the link before each particle \[N\].
    fn pull(&self, particle: usize) -> f64 {
        (particle..=self.links).map(|i| self.mass_of(i)).sum::<f64>() * G
    }

    /// The angular frequency of its slowest small swing, and how far each particle goes aside in that: by inverse iteration.
    fn mode(&self) -> (f64, Vec<f64>) {
        let n = self.links;
        let stiff: Vec<f64> = (1..=n + 1).map(|i| if i <= n { self.pull(i) / self.link() } else { 0.0 }).collect();
        let (mut shape, mut square) = (vec![1.0; n], 0.0);
        for _ in 0..200 {
            // K y = M x, K being tridiagonal.
            let mut right: Vec<f64> = shape.iter().enumerate().map(|(i, x)| self.mass_of(i + 1) * x).collect();
            let mut pivot: Vec<f64> = (0..n).map(|i| stiff[i] + stiff[i + 1]).collect();
            for i in 1..n {
                let by = stiff[i] / pivot[i - 1];
                pivot[i] -= by * stiff[i];
                right[i] += by * right[i - 1];
            }
            let mut y = vec![0.0; n];
            for i in (0..n).rev() {
                let next = if i + 1 < n { stiff[i + 1] * y[i + 1] } else { 0.0 };
                y[i] = (right[i] + next) / pivot[i];
            }
            let last = y[n - 1];
            square = shape[n - 1] / last;
            shape = y.into_iter().map(|y| y / last).collect();
        }
        (square.sqrt(), shape)
    }

    /// Its period where it begins with its particles in these directions from each to the next, angles to the way down, in so many sub-steps.
    fn period(&self, angles: &[f64], pose: &Pose, method: Method, substeps: u32, periods: usize) -> f64 {
        let (start, rope) = self.parts(angles, pose);
        let forces = Gravity { acceleration: pose.down * G as f32 };
        let parts = Scene { start: &start, forces: &forces, constraints: &rope, ..Scene::EMPTY };
        let scene = Scene { substeps, integrator: method.integrator(), ..parts };
        let mut system = started(&scene, start.len(), 0);
        let (mut crossings, mut before) = (vec![], f32::NAN);
        for frame in 1.. {
            system.step_to(&scene, Time::frame(frame, 60));
            let aside = (system.particles().position[self.links] - pose.pivot).dot(pose.aside);
            if before > 0.0 && aside <= 0.0 {
                crossings.push((frame as f64 - 1.0 + f64::from(before / (before - aside))) / 60.0);
                if crossings.len() > periods {
                    break;
                }
            }
            before = aside;
            assert!(frame < 10_000, "it does not swing");
        }
        (crossings[periods] - crossings[0]) / periods as f64
    }

    /// Its particles and links where these have such angles to the way down.
    fn parts(&self, angles: &[f64], pose: &Pose) -> (Vec<Particle>, Rope<Vec<u32>, [f32; 1]>) {
        let mut place = pose.pivot;
        let part = |i: usize| {
            if i > 0 {
                let (sin, cos) = angles[i - 1].sin_cos();
                place += (pose.down * cos as f32 + pose.aside * sin as f32) * self.link() as f32;
            }
            Particle { position: place, mass: self.mass_of(i) as f32, fixed: i == 0, ..Particle::REST }
        };
        let start: Vec<Particle> = (0..=self.links).map(part).collect();
        let compliance = (self.gives * self.link() / self.pull(self.links)) as f32;
        let rope =
            Rope { compliance, ..Rope::rigid((0..=self.links as u32).collect::<Vec<_>>(), [self.link() as f32]) };
        (start, rope)
    }

    /// Swings for so long \[s\] in frames of such a rate and so many sub-steps. Tells how wide its last swings are against the first, by how much of the energy of
    /// a swing it has come to have more than in its first quarter, and how often its links were not met.
    fn swings(&self, angle: f64, tether: bool, run: (Method, u32, u32, f64), pose: &Pose) -> (f64, f64, u64) {
        let (method, rate, substeps, seconds) = run;
        let (start, rope) = self.parts(&vec![angle; self.links], pose);
        let rope = Rope { tether, ..rope };
        let forces = Gravity { acceleration: pose.down * G as f32 };
        let parts = Scene { start: &start, forces: &forces, constraints: &rope, ..Scene::EMPTY };
        let scene = Scene { substeps, integrator: method.integrator(), ..parts };
        let mut system = started(&scene, start.len(), 0);
        let frames = (seconds * f64::from(rate)) as u64;
        let ([mut first, mut last], [mut begun, mut grown]) = ([0f64; 2], [f64::MIN; 2]);
        let begin = Measures::of(&system, &scene).energy.total();
        for frame in 1..=frames {
            system.step_to(&scene, Time::frame(frame, rate));
            let way = system.particles().position[self.links] - pose.pivot;
            let aside = f64::from(way.dot(pose.aside)).atan2(f64::from(way.dot(pose.down))).abs();
            let strained = |pair: &[Vec3]| {
                let off = gap(f64s(pair[0]), f64s(pair[1])) - self.link();
                if rope.compliance > 0.0 { 0.5 * off * off / f64::from(rope.compliance) } else { 0.0 }
            };
            let strained: f64 = system.particles().position.windows(2).map(strained).sum();
            let energy = Measures::of(&system, &scene).energy.total() + strained - begin;
            // The first and the last quarter are some swings each.
            match 4 * frame / frames {
                0 => (first, begun) = (first.max(aside), begun.max(energy)),
                3.. => last = last.max(aside),
                _ => {}
            }
            grown = grown.max(energy);
        }
        let swing = self.bob * G * self.length * (1.0 - angle.cos());
        (last / first, (grown - begun) / swing, system.totals().effort.capped)
    }
}

/// Small swings of a bare rope, and of one with a weight at its end, rigid and soft: against the lowest eigenvalue of its links. A continuous rope swings
/// with the first zero of J₀, 2.4048, over 2: ω = 1.2024 √(g/L).
#[test]
fn ropes_swing_in_their_time() {
    let bare = Hung { links: 400, length: 2.0, mass: 0.01, bob: 0.0, gives: 0.0 };
    let continuous = 1.202_413 * (G / 2.0).sqrt();
    // Its masses are at the lower ends of links: half a link's more than the rope has.
    assert!((bare.mode().0 / continuous - 1.0).abs() < 2e-3, "{}", bare.mode().0 / continuous);
    let (mut random, mut swung, mut cases, mut failures) = (Random::new(1), 0, 0, vec![]);
    let swings = if cfg!(debug_assertions) { 1 } else { 3 };
    let mut methods = [Method::Symplectic, Method::Verlet, Method::Rk4, Method::Midpoint].into_iter().cycle();
    for length in [0.3, 1.0, 5.0] {
        for links in [1, 2, 5, 12, 30] {
            for share in [0.0, 1.0, 100.0, 1000.0] {
                for gives in [0.0, 1e-4] {
                    for substeps in [1, 2, 5, 20] {
                        if !is_run(&mut cases) {
                            continue;
                        }
                        let mass = 0.1 / links as f64;
                        let hung = Hung { links, length, mass, bob: 0.1 * share, gives };
                        let (omega, shape) = hung.mode();
                        let far = |i: usize| if i > 0 { shape[i - 1] } else { 0.0 };
                        let angles: Vec<f64> =
                            (0..links).map(|i| (0.03 * (far(i + 1) - far(i)) * links as f64).asin()).collect();
                        let method = methods.next().expect("there is always a next one");
                        let period = hung.period(&angles, &Pose::any(&mut random), method, substeps, swings);
                        let off = period * omega / core::f64::consts::TAU - 1.0;
                        swung += 1;
                        // Where the most of paces are too few, links are heavier meanwhile.
                        let is_heavier =
                            share > 100.0 && links as f64 * (G / length).sqrt() > 120.0 * f64::from(substeps);
                        if !(off.abs() < if is_heavier { 5e-2 } else { 5e-3 }) {
                            failures.push(format!("{method} {hung:?} in {substeps}: {off:.4}"));
                        }
                    }
                }
            }
        }
    }
    assert!(failures.is_empty() && swung >= 80, "{} of {swung} {failures:#?}", failures.len());
}

/// Wide swings of a heavy bob on a light rope: against the elliptic integral by the arithmetic-geometric mean.
#[test]
fn a_heavy_bob_swings_in_its_time() {
    let (mut random, mut swung, mut cases, mut failures) = (Random::new(2), 0, 0, vec![]);
    for angle in [0.1f64, 0.8, 1.4] {
        let (mut a, mut b) = (1.0, (angle / 2.0).cos());
        for _ in 0..6 {
            (a, b) = ((a + b) / 2.0, f64::sqrt(a * b));
        }
        for length in [0.3, 1.0, 5.0] {
            let right = core::f64::consts::TAU * (length / G).sqrt() / a;
            for links in [1, 3, 8] {
                for gives in [0.0, 1e-4] {
                    for substeps in [1, 2, 5, 20] {
                        for method in [Method::Symplectic, Method::Verlet, Method::Rk4] {
                            if !is_run(&mut cases) {
                                continue;
                            }
                            let hung = Hung { links, length, mass: 0.01 / links as f64, bob: 1.0, gives };
                            let period = hung.period(&vec![angle; links], &Pose::any(&mut random), method, substeps, 2);
                            let off = period / right - 1.0;
                            swung += 1;
                            if !(off.abs() < 5e-3) {
                                failures.push(format!("{method} {angle} {hung:?} in {substeps}: {off:.4}"));
                            }
                        }
                    }
                }
            }
        }
    }
    assert!(failures.is_empty() && swung > 100, "{} of {swung} {failures:#?}", failures.len());
}

/// However heavy a bob is for its rope, and in however few sub-steps: it goes on to swing as wide as it did, its energy stays, and links are met.
fn heavy_bobs_keep_swinging(seconds: f64, all: &[usize]) {
    let (mut random, mut failures) = (Random::new(4), vec![]);
    let mut methods =
        [Method::Symplectic, Method::Verlet, Method::Midpoint, Method::Rk4, Method::Verlet].into_iter().cycle();
    let mut ways = [(60, 1), (24, 5), (60, 2), (240, 1), (60, 5), (60, 20), (120, 1)].into_iter().cycle();
    let mut forms = [(0.0, false), (0.0, true), (1e-5, false)].into_iter().cycle();
    for &links in all {
        for share in [10.0, 30.0, 100.0, 1000.0] {
            for angle in [0.1, 0.5, 1.2] {
                let hung = Hung { links, length: 1.0, mass: 0.1 / links as f64, bob: 0.1 * share, gives: 0.0 };
                let (Some(method), Some((rate, substeps)), Some((gives, tether))) =
                    (methods.next(), ways.next(), forms.next())
                else {
                    continue;
                };
                let hung = Hung { gives, ..hung };
                let run = (method, rate, substeps, seconds);
                let (width, grown, capped) = hung.swings(angle, tether, run, &Pose::any(&mut random));
                // A rope that has to turn with its bob as that lets go swings a little by itself, the more the heavier it is.
                let own = 0.2 / share;
                // Velocities of a method of first order are half a sub-step old, which shows the more the faster light links swing across.
                let shown = if method == Method::Symplectic || gives > 0.0 || share > 100.0 { 1e-2 } else { 2e-3 };
                if !((width - 1.0).abs() < 0.01 + own && grown < shown && capped == 0) {
                    failures.push(format!(
                        "{method} {angle} {hung:?} {tether} in {substeps} of {rate}: {width:.4}, {grown:.1e}, {capped}"
                    ));
                }
            }
        }
    }
    assert!(failures.is_empty(), "{} {failures:#?}", failures.len());
}

#[test]
fn bobs_keep_swinging() {
    heavy_bobs_keep_swinging(if cfg!(debug_assertions) { 4.0 } else { 16.0 }, &[1, 3, 10]);
}

#[test]
#[ignore = "long: minutes"]
fn bobs_keep_swinging_on_ropes_of_many_links() {
    heavy_bobs_keep_swinging(32.0, &[5, 20, 40]);
}

/// Ropes of several lengths between hooks level and not, seen from any side: each particle is where the catenary has it, within 0.5 % of the span, and
/// no link is strained by 0.5 %.
#[test]
fn ropes_between_hooks_hang_in_catenaries() {
    let (mut random, mut cases) = (Random::new(3), 0);
    let mut ways = [
        (5, Method::Symplectic, false),
        (10, Method::Rk4, true),
        (20, Method::Verlet, false),
        (50, Method::Symplectic, true),
    ]
    .into_iter()
    .cycle();
    // With all checks the finest take long.
    let all = if cfg!(debug_assertions) { &[48usize, 24][..] } else { &[24, 48, 96] };
    for (span, rise, length) in [(1.0f64, 0.0f64, 1.2f64), (1.0, 0.5, 2.0), (3.0, -1.0, 3.4), (0.2, 0.0, 0.6)] {
        for &links in all {
            let (substeps, method, tether) = ways.next().expect("there is always a next one");
            if !is_third(&mut cases) {
                continue;
            }
            let pose = Pose::any(&mut random);
            // Two straight halves from hook to hook.
            let (far, half) = ((span * span + rise * rise).sqrt(), 0.5 * length);
            let (deep, along) = ((half * half - 0.25 * far * far).sqrt(), [span / far, rise / far]);
            let low = [0.5 * span + deep * along[1], 0.5 * rise - deep * along[0]];
            let corner = |i: usize| {
                let s = 2.0 * i as f64 / links as f64;
                let ([from, to], s) = if s < 1.0 { ([[0.0; 2], low], s) } else { ([low, [span, rise]], s - 1.0) };
                [0, 1].map(|k| from[k] + (to[k] - from[k]) * s)
            };
            let part = |i: usize| {
                let [x, y] = corner(i).map(|x| x as f32);
                let position = pose.pivot + pose.aside * x - pose.down * y;
                Particle { position, mass: 0.01, drag: 0.03, fixed: i == 0 || i == links, ..Particle::REST }
            };
            let start: Vec<Particle> = (0..=links).map(part).collect();
            let link = (length / links as f64) as f32;
            let rope = Rope { tether, ..Rope::rigid((0..=links as u32).collect::<Vec<_>>(), [link]) };
            let forces = (Gravity { acceleration: pose.down * G as f32 }, Drag {});
            let parts = Scene { start: &start, forces: &forces, constraints: &rope, ..Scene::EMPTY };
            let scene = Scene { substeps, integrator: method.integrator(), ..parts };
            let mut system = started(&scene, start.len(), 0);
            run(&mut system, &scene, 1.0 / 60.0, if cfg!(debug_assertions) { 800 } else { 1200 });
            let x = system.particles().position;
            let name = format!("{span} m, {rise} m, {length} m of {links}, {method} in {substeps}");
            // The catenary's parameter by halving: √(L² − v²) = 2 a sinh(s / 2a).
            let wanted = (length * length - rise * rise).sqrt();
            let (mut least, mut most) = (1e-3 * span, 1e3 * span);
            for _ in 0..200 {
                let a = 0.5 * (least + most);
                *if 2.0 * a * (span / (2.0 * a)).sinh() > wanted { &mut least } else { &mut most } = a;
            }
            let a = least;
            let lowest = 0.5 * span - a * (rise / (2.0 * a * (span / (2.0 * a)).sinh())).asinh();
            for (i, &x) in x.iter().enumerate() {
                let arc = length * i as f64 / links as f64 - a * (lowest / a).sinh();
                let across = lowest + a * (arc / a).asinh();
                let up = a * (((across - lowest) / a).cosh() - (lowest / a).cosh());
                let right = pose.pivot + pose.aside * across as f32 - pose.down * up as f32;
                let off = f64::from(x.distance(right)) / span;
                assert!(off < 5e-3, "{name}: particle {i} is off by {off} of the span");
            }
            for pair in x.windows(2) {
                let strain = gap(f64s(pair[0]), f64s(pair[1])) / f64::from(link) - 1.0;
                assert!(strain.abs() < 5e-3, "{name}: {strain}");
            }
        }
    }
}

/// A rope of one link swings as a rod does: by methods of second order on it gains nothing, however far it swings and however long its sub-steps are, and loses little
/// in short ones.
#[test]
fn a_rope_of_one_link_keeps_its_energy() {
    let mut failures = vec![];
    let second =
        Method::ALL.iter().filter(|method| !matches!(method, Method::Euler | Method::Symplectic | Method::Implicit));
    for (i, method) in second.enumerate() {
        for (k, (rate, substeps)) in [(60, 1), (24, 1), (60, 3), (144, 1), (60, 7), (24, 7)].into_iter().enumerate() {
            let length = [0.1f32, 0.3, 1.0][(i + k) % 3];
            let angle = [0.5f32, 1.57, 2.1][(i + k / 2) % 3];
            let bob = Vec3::new(angle.sin(), -angle.cos(), 0.0) * length;
            let start = [Particle { fixed: true, ..Particle::REST }, Particle { position: bob, ..Particle::REST }];
            let rope = Rope::rigid([0u32, 1], [length]);
            let parts = Scene { start: &start, forces: &Gravity::EARTH, constraints: &rope, ..Scene::EMPTY };
            let scene = Scene { substeps, integrator: method.integrator(), ..parts };
            let mut system = started(&scene, 2, 0);
            let swing = G * f64::from(length) * (1.0 - f64::from(angle.cos()));
            let energy = |system: &_| Measures::of(system, &scene).energy.total();
            let begun = energy(&system);
            let mut most = f64::NEG_INFINITY;
            for frame in 1..=20 * u64::from(rate) {
                system.step_to(&scene, Time::frame(frame, rate));
                most = most.max(energy(&system));
            }
            let [gained, kept] = [most, energy(&system)].map(|energy| (energy - begun) / swing);
            if !(gained < 5e-3 && (kept > -0.1 || rate * substeps < 60)) {
                failures.push(format!("{method}, {rate}/s in {substeps}, {length} m, {angle}: {gained:.4} {kept:.4}"));
            }
        }
    }
    assert!(failures.is_empty(), "{} {failures:#?}", failures.len());
}
