//! Ropes that nothing holds gain no energy and keep their angular momentum, soft or rigid; nor do parts of them gain any.

use pointmass::{Gravity, Id, Measures, Method, Particle, Rope, Scene, Time, Vec3};
use pointmass_tests::{Random, f64s, gap, is_third, often, run, started};

/// A rope as it begins: as it lies it is at rest.
struct Flying {
    start: Vec<Particle>,
    rope: Rope<Vec<u32>, Vec<f32>>,
    middle: Vec3,
}

/// What a rope is like.
#[derive(Clone, Copy, Debug)]
struct Like {
    links: usize,
    compliance: f32,
    closed: bool,
    tether: bool,
    /// How far masses are from their mean, as a share of that.
    uneven: f32,
    /// How far from the origin it is \[m\].
    far: f32,
    /// How many times as fast as 2 rad/s and up to 0.3 m/s beside that it moves.
    fast: f32,
}

fn flying(like: Like, random: &mut Random) -> Flying {
    let Like { links, compliance, closed, tether, uneven, far, fast } = like;
    let count = if closed { links } else { links + 1 };
    let part = |i: usize| {
        let angle = core::f32::consts::TAU * i as f32 / count as f32;
        let round = Vec3::new(angle.cos(), angle.sin(), 0.3 * random.unit()) * (0.016 * count as f32);
        let position = if closed { round } else { Vec3::new(0.1 * i as f32, 0.02 * random.unit(), 0.0) };
        let velocity = (Vec3::Z.cross(position) * 2.0 + random.vector(0.3)) * fast;
        Particle { position, velocity, mass: 0.1 * random.between(1.0 - uneven, 1.0 + uneven), ..Particle::REST }
    };
    let mut start: Vec<Particle> = (0..count).map(part).collect();
    let mass: f32 = start.iter().map(|p| p.mass).sum();
    let mean = |of: fn(&Particle) -> Vec3| start.iter().map(|p| of(p) * p.mass).sum::<Vec3>() / mass;
    let (x, v, middle) = (mean(|p| p.position), mean(|p| p.velocity), Vec3::new(far, -0.5 * far, 0.3 * far));
    start.iter_mut().for_each(|p| (p.position, p.velocity) = (p.position - x + middle, p.velocity - v));
    let between = |i: usize| (start[(i + 1) % count].position - start[i].position).length();
    let lengths: Vec<f32> = (0..links).map(between).collect();
    let rope = Rope { compliance, closed, tether, ..Rope::rigid((0..count as u32).collect(), lengths) };
    Flying { start, rope, middle }
}

impl Flying {
    /// The energy that its links are strained by, those between particles that are there \[J\].
    fn strained(&self, place: impl Fn(usize) -> Option<[f64; 3]>) -> f64 {
        let Rope { compliance, tether, ref lengths, .. } = self.rope;
        let one = |(i, &length): (usize, &f32)| {
            let (a, b) = (place(i)?, place((i + 1) % self.start.len())?);
            let off = gap(a, b) - f64::from(length);
            let off = if tether { off.max(0.0) } else { off };
            Some(0.5 * off * off / f64::from(compliance))
        };
        if compliance > 0.0 { lengths.iter().enumerate().filter_map(one).sum() } else { 0.0 }
    }
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// The angular momentum of some about where their middle is.
fn spin(start: &[Particle], x: &[Vec3], v: &[Vec3]) -> [f64; 3] {
    let mass: f64 = start.iter().map(|p| f64::from(p.mass)).sum();
    let mean = |of: &[Vec3]| {
        [0, 1, 2].map(|k| start.iter().zip(of).map(|(p, of)| f64::from(p.mass) * f64::from(of[k])).sum::<f64>() / mass)
    };
    let ([middle, drift], mut sum) = ([mean(x), mean(v)], [0.0; 3]);
    for ((p, &x), &v) in start.iter().zip(x).zip(v) {
        let minus = |a: Vec3, b: [f64; 3]| [0, 1, 2].map(|k| f64::from(a[k]) - b[k]);
        let own = cross(minus(x, middle), minus(v, drift));
        (0..3).for_each(|k| sum[k] += f64::from(p.mass) * own[k]);
    }
    sum
}

/// How much of its energy a rope has gained and how much of its angular momentum it has been without, at the most, in so many frames of 1/60 s.
fn follow(flying: &Flying, substeps: u32, method: Method, frames: u64) -> [f64; 2] {
    let (start, constraints) = (&flying.start, &flying.rope);
    let scene = Scene { start, constraints, substeps, integrator: method.integrator(), ..Scene::EMPTY };
    let mut system = started(&scene, start.len(), 0);
    let begun = Measures::of(&system, &scene).energy.kinetic;
    let (x, v): (Vec<_>, Vec<_>) = start.iter().map(|p| (p.position, p.velocity)).unzip();
    let (turned, mut most) = (spin(start, &x, &v), [0f64; 2]);
    for frame in 1..=frames {
        system.step_to(&scene, Time::frame(frame, 60));
        let (x, v) = (system.particles().position, system.particles().velocity);
        let strained = flying.strained(|i| Some(f64s(x[i])));
        let grown = (Measures::of(&system, &scene).energy.kinetic + strained) / begun - 1.0;
        let lost = gap(turned, spin(start, x, v)) / gap(turned, [0.0; 3]);
        assert!(grown.is_finite() && lost.is_finite(), "{method} in {substeps}: {grown}, {lost}");
        most = [most[0].max(grown), most[1].max(lost)];
    }
    most
}

/// What rounding of places may show as gained and lost, in so many sub-steps: nothing near the origin.
fn coarse(like: Like, flying: &Flying, sum: u64) -> [f64; 2] {
    let Like { links, compliance, far, .. } = like;
    if far == 0.0 {
        return [0.0; 2];
    }
    let coarse = f64::from(f32::EPSILON * flying.middle.length());
    let (x, v): (Vec<_>, Vec<_>) = flying.start.iter().map(|p| (p.position, p.velocity)).unzip();
    let (mut begun, mut way) = (0.0, 0.0);
    for p in &flying.start {
        begun += f64::from(0.5 * p.mass * p.velocity.length_squared());
        way += f64::from(p.mass * p.velocity.length());
    }
    // Soft links are strained by what their ends are rounded.
    let shown =
        if compliance > 0.0 { 2.0 * coarse * coarse / f64::from(compliance) * links as f64 / begun } else { 0.0 };
    // What is straight to so many roundings is a line to the engine, which carries nothing about itself.
    let line = 20.0 * coarse / (0.1 * links as f64);
    // Soft links that have all the energy that they may have, and are rounded shorter, turn slower for a while: by what roundings have come to, Σ m v × that.
    // A rounding is by half of `coarse`, and of one sense for as long as velocities stay, for some hundreds of sub-steps, whose root is 20.
    let slower = 0.5 * 20.0 * coarse * (sum as f64).sqrt() * way / gap(spin(&flying.start, &x, &v), [0.0; 3]);
    [line + shown, if compliance > 0.0 { slower } else { line } + shown]
}

fn gains_nothing(frames: u64, all: &[usize]) {
    let (mut random, mut cases, mut failures) = (Random::new(5), 0, vec![]);
    let mut methods =
        [Method::Symplectic, Method::Verlet, Method::Rk4, Method::Midpoint, Method::Euler].into_iter().cycle();
    let forms = [
        (false, false, 0.5, 0.0),
        (true, false, 0.9, 0.0),
        (false, true, 0.5, 30.0),
        (true, true, 0.0, 0.0),
        (false, false, 0.9, 100.0),
    ];
    for &links in all {
        for (closed, tether, uneven, far) in forms.into_iter().filter(|form| links > 2 || !form.0) {
            for compliance in [0.0, 1e-7, 1e-5, 1e-3, 1e-1] {
                for substeps in [1, 2, 5, 10, 20, 50] {
                    let like = Like { links, compliance, closed, tether, uneven, far, fast: 1.0 };
                    let flying = flying(like, &mut random);
                    let method = methods.next().expect("there is always a next one");
                    if !is_third(&mut cases) {
                        continue;
                    }
                    let [grown, lost] = follow(&flying, substeps, method, frames);
                    let [grows, turns] = coarse(like, &flying, frames * u64::from(substeps));
                    if !(grown < 1e-5 + grows && lost < 1e-4 + turns) {
                        failures.push(format!(
                            "{method} {like:?} in {substeps}: {grown:.1e}, {lost:.1e}, of which {grows:.1e}, {turns:.1e}"
                        ));
                    }
                }
            }
        }
    }
    assert!(failures.is_empty(), "{} {failures:#?}", failures.len());
}

/// Whatever their compliance, in any sub-steps, open or closed, near or far; and their angular momentum stays.
#[test]
fn free_ropes_gain_no_energy() {
    gains_nothing(often(240) as u64, &[1, 3, 12]);
}

#[test]
#[ignore = "long: minutes"]
fn free_ropes_keep_their_momenta_for_a_minute() {
    gains_nothing(3600, &[1, 2, 4]);
}

#[test]
#[ignore = "long: minutes"]
fn free_ropes_of_many_links_keep_their_momenta_for_a_minute() {
    gains_nothing(3600, &[12, 40]);
}

/// Nor where links turn so far in a sub-step, by up to a radian or two, that it is gone through in paces: where they would have to turn faster than their
/// energy lets them, they keep their form.
#[test]
fn ropes_that_are_thrown_about_gain_no_energy() {
    let (mut random, mut failures) = (Random::new(11), vec![]);
    let mut methods = [Method::Symplectic, Method::Verlet, Method::Rk4].into_iter().cycle();
    for throw in 0..often(60) {
        for (links, closed, fast) in
            [(2, false, 15.0), (4, false, 15.0), (4, true, 4.0), (4, true, 15.0), (9, false, 15.0)]
        {
            for compliance in [0.0, 1e-7, 1e-5] {
                let (substeps, tether) = (1 + throw as u32 % 2, throw % 3 == 0);
                let like = Like { links, compliance, closed, tether, uneven: 0.5, far: 0.0, fast };
                let (flying, method) = (flying(like, &mut random), methods.next().expect("there is always a next one"));
                let [grown, lost] = follow(&flying, substeps, method, 120);
                // What lies on a line to a thousandth cannot carry what it has of its angular momentum about that, a thousandth of all where all energy is
                // in that, and gets it back when it bends. What turns about it a thousand times as fast as across shows so many roundings.
                if !(grown < 1e-4 && lost < 2e-3) {
                    failures.push(format!("{method} {like:?} in {substeps}: {grown:.1e}, {lost:.1e}"));
                }
            }
        }
    }
    assert!(failures.is_empty(), "{} {failures:#?}", failures.len());
}

/// A rope that falls keeps its angular momentum about its middle as well, far from the origin too: gravity turns nothing.
#[test]
fn what_falls_goes_on_turning() {
    let mut random = Random::new(17);
    for (links, closed) in [(2, false), (4, false), (9, true)] {
        for (method, substeps) in Method::ALL.iter().zip([1, 5, 20, 50].into_iter().cycle()) {
            let like = Like { links, compliance: 0.0, closed, tether: false, uneven: 0.5, far: 30.0, fast: 1.0 };
            let flying = flying(like, &mut random);
            let (start, constraints) = (&flying.start, &flying.rope);
            let parts = Scene { start, constraints, forces: &Gravity::EARTH, ..Scene::EMPTY };
            let scene = Scene { substeps, integrator: method.integrator(), ..parts };
            let mut system = started(&scene, start.len(), 0);
            let (x, v): (Vec<_>, Vec<_>) = start.iter().map(|p| (p.position, p.velocity)).unzip();
            let begun = spin(start, &x, &v);
            // For two seconds: 20 m, and up to 20 m/s, whose rounding is 1e-6 of that.
            for frame in 1..=120 {
                system.step_to(&scene, Time::frame(frame, 60));
                let now = spin(start, system.particles().position, system.particles().velocity);
                let lost = gap(begun, now) / gap(begun, [0.0; 3]);
                // Two links come to lie on a line now and then, to eight roundings of places that are 30 m off: that cannot carry what it has about itself.
                let straight = if links == 2 { 8.0 * f64::from(f32::EPSILON) * 30.0 / 0.1 } else { 0.0 };
                assert!(lost < 1e-4 + straight, "{method} {like:?} in {substeps}, {frame}: {lost:.1e}");
            }
        }
    }
}

/// What is so heavy at both ends of light links that these are made heavier meanwhile keeps its momentum where nothing holds it, and the report tells of it.
#[test]
fn free_ropes_with_heavy_ends_keep_their_momentum() {
    let (mut random, mut counted) = (Random::new(23), 0);
    let mut methods = [Method::Symplectic, Method::Verlet, Method::Rk4].into_iter().cycle();
    for links in [6, 20, 40] {
        for (ratio, fast) in [(1e2f32, 1.0f32), (1e4, 3.0), (1e6, 10.0)] {
            let (length, drift, spin) = (1.0 / links as f32, random.vector(1.0), random.vector(fast));
            let way = random.vector(1.0).normalize();
            let part = |i: usize| {
                let position = way * (length * i as f32 - 0.5);
                let mass = if i == 0 || i == links { 1.0 } else { 1.0 / ratio };
                Particle { position, velocity: drift + spin.cross(position), mass, ..Particle::REST }
            };
            let start: Vec<Particle> = (0..=links).map(part).collect();
            let rope = Rope::rigid((0..=links as u32).collect::<Vec<_>>(), [length]);
            let method = methods.next().expect("there is always a next one");
            let parts = Scene { start: &start, constraints: &rope, ..Scene::EMPTY };
            let scene = Scene { integrator: method.integrator(), ..parts };
            let mut system = started(&scene, start.len(), 0);
            let before = Measures::of(&system, &scene).momentum;
            run(&mut system, &scene, 1.0 / 24.0, 48);
            let lost = gap(before, Measures::of(&system, &scene).momentum);
            counted += system.totals().effort.capped;
            // Some hundred paces in each of 48 sub-steps round it.
            assert!(lost < 2e-5 * f64::from(1.0 + fast), "{method}, {links} links, {ratio}, {fast}: {lost}");
        }
    }
    assert!(counted > 0, "nobody had to be made heavier");
}

/// What is left of a rope of which some have died gains none either: of a ring, and of an open one.
#[test]
fn parts_of_a_rope_gain_no_energy() {
    let mut random = Random::new(6);
    for (closed, dead) in [(true, &[5usize][..]), (true, &[3, 9]), (false, &[4]), (false, &[0, 7])] {
        for compliance in [0.0, 1e-6, 1e-3] {
            for (substeps, method) in
                [(1, Method::Symplectic), (2, Method::Verlet), (5, Method::Rk4), (20, Method::Euler)]
            {
                let like = Like { links: 14, compliance, closed, tether: false, uneven: 0.5, far: 0.0, fast: 1.0 };
                let mut flying = flying(like, &mut random);
                dead.iter().for_each(|&i| flying.start[i].lifetime = 0.1);
                let (start, constraints) = (&flying.start, &flying.rope);
                let scene = Scene { start, constraints, substeps, integrator: method.integrator(), ..Scene::EMPTY };
                let mut system = started(&scene, start.len(), 0);
                let ids: Vec<Id> = (0..start.len()).filter_map(|row| system.id(row)).collect();
                let mut begun = None;
                for frame in 1..=often(300).max(60) as u64 {
                    system.step_to(&scene, Time::frame(frame, 60));
                    let there = system.particles();
                    // The energy of each part beside that of its middle.
                    let row = |i: usize| system.row(ids[i]);
                    let count = start.len();
                    let first = if closed { dead[0] + 1 } else { 0 };
                    let (mut parts, mut part) = (vec![], vec![]);
                    for i in (first..first + count).map(|i| i % count) {
                        match row(i) {
                            Some(row) => part.push(row),
                            None => parts.push(core::mem::take(&mut part)),
                        }
                    }
                    parts.push(part);
                    let moving: f64 =
                        parts.iter().map(|part| beside_the_middle(part, there.mass, there.velocity)).sum();
                    let strained = flying.strained(|i| row(i).map(|row| f64s(there.position[row])));
                    let now = moving + strained;
                    assert!(frame < 8 || there.position.len() == count - dead.len());
                    if there.position.len() < count {
                        let grown = now / *begun.get_or_insert(now) - 1.0;
                        assert!(grown < 2e-5, "{like:?} without {dead:?} in {substeps}, {frame}: {grown:.1e}");
                    }
                }
            }
        }
    }
}

fn beside_the_middle(rows: &[usize], mass: &[f32], velocity: &[Vec3]) -> f64 {
    let all = || rows.iter().map(|&row| (f64::from(mass[row]), f64s(velocity[row])));
    let sum: f64 = all().map(|(m, _)| m).sum();
    let drift = [0, 1, 2].map(|k| all().map(|(m, v)| m * v[k]).sum::<f64>() / sum);
    all().map(|(m, v)| 0.5 * m * gap(v, drift).powi(2)).sum()
}
