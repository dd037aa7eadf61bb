//! Everything that a user can bring along: forces, integrators, constraints, emitters, colliders, reapers, indices, observers,
//! memory; and columns of their own.

#[path = "extend/composed.rs"]
mod composed;
#[path = "extend/custom.rs"]
mod custom;
#[path = "extend/loads.rs"]
mod loads;
#[path = "extend/repeats.rs"]
mod repeats;
#[path = "extend/strangers.rs"]
mod strangers;

use core::ops::Range;
use pointmass::constrain::{Bodies, Demand, Share, Words};
use pointmass::emit::{Births, EmitterState};
use pointmass::force::{Perturbation, State};
use pointmass::index::{Cost, IndexChoice, Neighbour, Room, SpatialIndex, Stats, Structure, TooSmall};
use pointmass::integrate::{Dynamics, Motion};
use pointmass::reap::Verdicts;
use pointmass::shape::{Collider, Cuboid, Hit, Plane, Segment};
use pointmass::{
    Attention, Cause, Chance, Columns, Constraint, Contacts, Custom, Dense, Distance, Drag, Emit, Emitter, Force,
    Gravity, Heap, Impact, Integrator, Measures, Meetings, Method, Observer, Particle, Paths, PendingDeath, Phase,
    Reaper, Scene, Size, Slices, Storage, System, Time, Vec3, Viscosity, WhereSparse,
};
use pointmass_tests::{Random, f64s, gap, point, run, started};
use std::sync::atomic::{AtomicUsize, Ordering};

/// A magnetic field along z: it turns velocities, here by one radian a second.
struct Magnet;

impl Force for Magnet {
    fn add_to(&self, state: &State<'_>, rows: Range<usize>, total: &mut [Vec3]) {
        for (total, row) in total.iter_mut().zip(rows) {
            *total += state.velocity[row].cross(Vec3::Z) * state.mass[row];
        }
    }
}

/// A harmonic well about the origin, k = 4 N/m, that is switched on at half a second.
struct LateWell;

impl Force for LateWell {
    fn add_to(&self, state: &State<'_>, rows: Range<usize>, total: &mut [Vec3]) {
        if state.time >= Time::from_seconds(0.5) {
            total.iter_mut().zip(&state.position[rows]).for_each(|(total, &x)| *total -= x * 4.0);
        }
    }
    fn energy(&self, state: &State<'_>) -> f64 {
        state.position.iter().map(|&x| 2.0 * gap(f64s(x), [0.0; 3]).powi(2)).sum()
    }
}

#[test]
fn a_force() {
    let start = [Particle { velocity: Vec3::X, mass: 3.0, ..Particle::REST }];
    let integrator = Method::Rk4.integrator();
    let scene = Scene { start: &start, forces: &Magnet, integrator, ..Scene::EMPTY };
    let mut system = started(&scene, 1, 0);
    run(&mut system, &scene, 0.01, 200);
    // Clockwise on a circle of radius 1: (sin t, cos t − 1).
    let place = [2f64.sin(), 2f64.cos() - 1.0, 0.0];
    assert!(gap(f64s(system.particles().position[0]), place) < 1e-5);
    // In a list with the engine's own, and reported.
    let start = [Particle { position: Vec3::X, drag: 0.0, ..Particle::REST }];
    let forces: [&dyn Force; 3] = [&Drag {}, &LateWell, &Magnet];
    let scene = Scene { start: &start, forces: &forces, integrator, ..Scene::EMPTY };
    let mut system = started(&scene, 1, 0);
    assert_eq!(Measures::of(&system, &scene).energy.potential, 2.0);
    run(&mut system, &scene, 0.01, 49);
    assert_eq!(system.particles().position[0], Vec3::X);
    run_from(&mut system, &scene, 49, 0.01, 100);
    assert!((Measures::of(&system, &scene).energy.total() - 2.0).abs() < 1e-4);
    assert!(system.particles().position[0].length() < 0.99);
}

/// Steps `from` + 1 to `from` + `n` of `h` each.
fn run_from(system: &mut System<Heap>, scene: &Scene<'_>, from: u32, h: f64, n: u32) {
    for i in from + 1..=from + n {
        system.step(scene, Time::from_seconds_f64(h * f64::from(i)) - system.time());
    }
}

/// Drift, kick, drift: what leapfrog is when places come first.
struct Leapfrog;

impl Integrator for Leapfrog {
    fn columns(&self) -> usize {
        4
    }
    fn needs_start(&self) -> bool {
        true
    }
    fn advance(&self, motion: Motion<'_>, time: Time, step: Time, world: &mut dyn Dynamics) {
        let Motion { position: x, velocity: v, start: [x0, v0], work, .. } = motion;
        assert!(x0 == x && v0 == v, "the state at the beginning");
        let [_, _, _, a] = work.take();
        assert!(a.len() == x.len(), "it asked for four columns");
        let h = step.seconds();
        x.iter_mut().zip(v.iter()).for_each(|(x, &v)| *x += v * (0.5 * h));
        world.accelerations(time + step.half(), x, v, a);
        v.iter_mut().zip(a.iter()).for_each(|(v, &a)| *v += a * h);
        x.iter_mut().zip(v.iter()).for_each(|(x, &v)| *x += v * (0.5 * h));
    }
}

#[test]
fn an_integrator() {
    let at = |x: f32, y: f32| Particle { position: Vec3::new(x, y, 0.0), ..Particle::REST };
    let (start, well) = ([at(1.0, 0.0), at(0.0, 2.0), at(0.5, 0.5)], pointmass_tests::Law(|_, x: f32, _| -x));
    let floor = Plane { point: Vec3::Y * -100.0, normal: Vec3::Y };
    for scene in [
        Scene { start: &start, forces: &well, integrator: &Leapfrog, ..Scene::EMPTY },
        Scene { start: &start, forces: &well, integrator: &&Leapfrog, colliders: &floor, ..Scene::EMPTY },
    ] {
        assert_eq!(scene.columns(), 6);
        let mut system = started(&scene, 3, 0);
        run(&mut system, &scene, 0.01, 100);
        // Order 2: (h ω)² / 24 of the phase of 1 rad.
        for (x, p) in system.particles().position.iter().zip(start) {
            let expected = f64::from(p.position.x) * 1f64.cos();
            assert!((f64::from(x.x) - expected).abs() < 2e-5 && x.y == p.position.y);
        }
    }
}

/// Asks for the forces on more particles than there are.
struct Greedy;

impl Integrator for Greedy {
    fn columns(&self) -> usize {
        1
    }
    fn advance(&self, motion: Motion<'_>, time: Time, _: Time, world: &mut dyn Dynamics) {
        let Motion { position, velocity, .. } = motion;
        world.linearise(time, position, velocity, &mut |system| {
            let (mut total, along) = ([Vec3::X; 3], [Vec3::ONE; 3]);
            system.force(&mut total);
            assert_eq!(total, [Gravity::EARTH.acceleration, Vec3::ZERO, Vec3::ZERO]);
            system.jacobian(&Perturbation { along: &along, position: 0.0, velocity: 1.0 }, &mut total);
            assert_eq!(total, [Vec3::splat(-0.5), Vec3::ZERO, Vec3::ZERO]);
            system.stiffness([0.0, 1.0], &mut total);
            assert_eq!(total, [Vec3::splat(0.5), Vec3::ZERO, Vec3::ZERO]);
        });
    }
}

#[test]
fn there_are_no_forces_beyond_the_particles() {
    let start = [Particle { drag: 0.5, ..Particle::REST }];
    let forces = (Gravity::EARTH, Drag {});
    let scene = Scene { start: &start, forces: &forces, integrator: &Greedy, ..Scene::EMPTY };
    started(&scene, 1, 0).step(&scene, Time::SECOND);
}

/// A wire bent to a circle about the z axis, on which beads are threaded, and which counts in its own memory how often it has
/// been asked, for each bead and altogether. Beads that come within a reach of each other stop.
struct Wire {
    radius: f32,
    reach: f32,
}

impl Constraint for Wire {
    fn demand(&self) -> Demand {
        Demand {
            step: Words { per_row: 1, fixed: 2 },
            scratch: Words { per_row: 3, fixed: 0 },
            finds_near: self.reach > 0.0,
            ..Demand::NONE
        }
    }
    fn prepare(&self, bodies: &mut Bodies<'_>, share: &mut Share<'_>) {
        if bodies.substep.number == 0 {
            share.step.fill(0);
        }
        share.step[0] += 1;
    }
    fn project(&self, bodies: &mut Bodies<'_>, share: &mut Share<'_>) {
        assert!(share.step[0] == bodies.substep.number + 1 && share.scratch.len() >= 3 * bodies.len());
        for row in 0..bodies.len() {
            let x = bodies.position[row];
            let flat = Vec3::new(x.x, x.y, 0.0);
            bodies.shift(row, flat * (self.radius / flat.length()) - x);
            share.step[2 + row] += 1;
        }
    }
    fn settle(&self, bodies: &mut Bodies<'_>, share: &mut Share<'_>) {
        let Bodies { position, velocity, near, .. } = bodies;
        near.pairs(position, self.reach, &mut |a, b| {
            velocity[a as usize] = Vec3::ZERO;
            velocity[b as usize] = Vec3::ZERO;
            share.step[1] += 1;
        });
        let last = bodies.substep.is_last();
        assert!(!last || share.step[2..2 + bodies.len()].iter().all(|&times| times == bodies.substep.count));
    }
}

/// Holds the first two of the start in their places to each other, by nothing.
struct Glue;

impl Constraint for Glue {
    fn demand(&self) -> Demand {
        Demand { binds: true, ..Demand::NONE }
    }
    fn bind(&self, bodies: &mut Bodies<'_>) {
        bodies.bind(&[0, 1]);
    }
    fn project(&self, _: &mut Bodies<'_>, _: &mut Share<'_>) {}
}

/// Contacts leave alone whom any constraint binds, and nobody else, in whatever order they are listed.
#[test]
fn a_constraint_that_binds() {
    let ball = |x: f32| Particle { position: Vec3::X * x, radius: 0.1, ..Particle::REST };
    let start = [ball(0.0), ball(0.15), ball(5.0), ball(5.15)];
    let (before, behind) = ((Glue, Contacts::HARD), (Contacts::HARD, Glue));
    let lists: [&dyn Constraint; 3] = [&before, &behind, &(Some(&before), None::<Distance>)];
    for constraints in lists {
        let scene = Scene { start: &start, constraints, substeps: 4, ..Scene::EMPTY };
        let mut system = started(&scene, 4, 0);
        run(&mut system, &scene, 0.01, 3);
        let x = system.particles().position;
        assert_eq!([x[0], x[1]], [start[0].position, start[1].position]);
        assert!((x[3].distance(x[2]) - 0.2).abs() < 1e-5, "{x:?}");
    }
}

#[test]
fn a_constraint() {
    let bead = |angle: f32| Particle { position: Vec3::new(angle.sin(), -angle.cos(), 0.0) * 2.0, ..Particle::REST };
    let start = [bead(0.2), bead(-1.5), bead(3.0)];
    let wire = Wire { radius: 2.0, reach: 0.0 };
    let wires = [Wire { radius: 2.0, reach: 0.0 }];
    let lists: [&dyn Constraint; 5] = [&wire, &&wire, &wires, &(&wire, ()), &((), Some(&wire), None::<Distance>)];
    let mut hashes = Vec::new();
    for constraints in lists {
        assert!(!constraints.is_empty());
        let forces = &Gravity::EARTH;
        let scene = Scene { start: &start, forces, constraints, substeps: 20, ..Scene::EMPTY };
        let mut system = started(&scene, 3, 0);
        let energy = Measures::of(&system, &scene).energy.total();
        run(&mut system, &scene, 1.0 / 60.0, 300);
        for x in system.particles().position {
            assert!((x.length() - 2.0).abs() < 1e-5 && x.z == 0.0, "{x}");
        }
        // Beads slide without friction; projections of first order take a little, and give nothing.
        let off = Measures::of(&system, &scene).energy.total() - energy;
        assert!((-5.0..0.1).contains(&off), "{off} J of some 100");
        hashes.push(system.hash());
    }
    assert!(hashes.windows(2).all(|pair| pair[0] == pair[1]));
    // Two that meet stop: whichever index finds them.
    let start = [bead(-1.0), bead(1.0)];
    for index in [&() as &dyn IndexChoice, &Structure::Grid, &Structure::Kd] {
        let wire = Wire { radius: 2.0, reach: 0.5 };
        let scene =
            Scene { start: &start, forces: &Gravity::EARTH, constraints: &wire, substeps: 8, index, ..Scene::EMPTY };
        let mut system = started(&scene, 2, 0);
        run(&mut system, &scene, 1.0 / 60.0, 240);
        let x = system.particles().position;
        assert!((x[0] - x[1]).length() < 0.5 && (x[0].x + x[1].x).abs() < 1e-3, "{x:?}");
    }
    // Those that are none ask for nothing.
    let none = Scene { constraints: &((), [(), ()]), ..Scene::EMPTY };
    assert_eq!(none.columns(), Scene::EMPTY.columns());
}

/// Births on a helix, one step on with each; half of its numbers belong to a second, slower one.
struct Helix;

impl Emit for Helix {
    fn count(&self) -> usize {
        2
    }
    fn emit(&self, from: Time, to: Time, births: &mut Births<'_>) {
        for rate in [30.0, 7.0] {
            let number = births.claim();
            let mut due = births.due(number, rate, from, to);
            while !births.is_full() {
                let Some(at) = due.next() else { break };
                let given = births.give(number, at, |random| {
                    let angle = at.seconds();
                    let [mass, _] = random.units(0);
                    let position = Vec3::new(angle.cos(), angle, angle.sin());
                    Particle { position, mass: 1.0 + mass, lifetime: 1.0, ..Particle::REST }
                });
                assert!(given.is_ok(), "there is room");
            }
            births.refuse(number, due.left());
        }
    }
}

#[test]
fn an_emitter() {
    let jet = Emitter::new(point(Vec3::ZERO), 11.0);
    let emitters = (&jet, Helix, &Helix as &dyn Emit);
    assert_eq!(emitters.count(), 5);
    let scene = Scene { emitters: &emitters, ..Scene::EMPTY };
    for fps in [10, 60, 77] {
        let mut system = started(&scene, 500, 3);
        run(&mut system, &scene, 1.0 / f64::from(fps), 3 * fps);
        assert_eq!(system.totals().born, 3 * (11 + 2 * 37));
        assert_eq!(system.totals().died.lifetime, 2 * 2 * 37);
        let p = system.particles();
        for (x, born) in p.position.iter().zip(p.born) {
            let angle = born.seconds();
            assert!(*x == Vec3::ZERO || *x == Vec3::new(angle.cos(), angle, angle.sin()));
        }
        // The two helices have numbers of their own, and so other masses.
        let mut masses: Vec<u32> = p.mass.iter().filter(|&&m| m != 1.0).map(|m| m.to_bits()).collect();
        masses.sort_unstable();
        masses.dedup();
        assert_eq!(masses.len(), 74);
    }
    let mut small = started(&scene, 4, 3);
    small.step(&scene, Time::SECOND);
    assert_eq!((small.totals().born, small.totals().refused), (4, 11 + 74 - 4));
}

/// The inside of a paraboloid y = x² + z² of revolution, in double precision: a bowl.
struct Bowl;

impl Bowl {
    fn height(p: Vec3) -> f64 {
        let [x, y, z] = f64s(p);
        y - x * x - z * z
    }
}

impl Collider for Bowl {
    fn first_hit(&self, segment: &Segment) -> Option<Hit> {
        if !(Self::height(segment.from) > 0.0 && Self::height(segment.to) <= 0.0) {
            return None;
        }
        let (mut low, mut high) = (0.0f32, 1.0f32);
        for _ in 0..30 {
            let middle = 0.5 * (low + high);
            if Self::height(segment.at(middle)) > 0.0 { low = middle } else { high = middle }
        }
        let p = segment.at(low);
        let normal = Vec3::new(-2.0 * p.x, 1.0, -2.0 * p.z).normalize();
        Some(Hit::new(low, normal, 1e-6))
    }
}

#[test]
fn a_collider() {
    let drop = |x: f32| Particle { position: Vec3::new(x, 2.0, 0.3), elasticity: 1.0, ..Particle::REST };
    let start = [-0.8, -0.1, 0.0, 0.5, 1.1].map(drop);
    let lid = Plane { point: Vec3::Y * 1.9, normal: Vec3::Y };
    for colliders in [&Bowl as &dyn Collider, &(&Bowl, Plane { point: Vec3::Y * 9.0, ..lid }), &[Bowl]] {
        assert!(!colliders.is_empty());
        let integrator = Method::Verlet.integrator();
        let scene = Scene { start: &start, forces: &Gravity::EARTH, colliders, integrator, ..Scene::EMPTY };
        let mut system = started(&scene, 5, 0);
        let energy = Measures::of(&system, &scene).energy.total();
        run(&mut system, &scene, 1.0 / 120.0, 1200);
        assert!(system.totals().hits > 20);
        assert!(system.particles().position.iter().all(|&x| Bowl::height(x) > 0.0));
        // Each hit errs by the chord's 1e-4 m of 2 m at the most.
        let share = Measures::of(&system, &scene).energy.total() / energy;
        assert!((share - 1.0).abs() < 0.01, "{share}");
    }
    // As a sink it takes them all.
    let scene = Scene { start: &start, forces: &Gravity::EARTH, sinks: &Bowl, ..Scene::EMPTY };
    let mut system = started(&scene, 5, 0);
    run(&mut system, &scene, 1.0 / 60.0, 60);
    assert_eq!((system.len(), system.totals().died.sink), (0, 5));
}

/// Takes those who are above 1.5 m, and those who were taken in as the first of seven.
struct Doom;

impl Reaper for Doom {
    fn judge(&self, state: &State<'_>, rows: Range<usize>, verdicts: &mut Verdicts<'_>) {
        for (nth, row) in rows.enumerate() {
            let is_seventh = state.id(row).is_some_and(|id| id.serial() % 7 == 0);
            if state.position[row].y > 1.5 || is_seventh {
                verdicts.end(nth, Cause::Other);
            }
        }
    }
}

/// Takes those who have lived for as many tenths of a second as their own random word says, as of age.
struct Tenths;

impl Reaper for Tenths {
    fn judge(&self, state: &State<'_>, rows: Range<usize>, verdicts: &mut Verdicts<'_>) {
        let place = verdicts.claim();
        for (nth, row) in rows.enumerate() {
            let tenths = 1 + state.word(row, place).expect("a row that is there") % 8;
            if (state.time - state.born[row]).seconds() > 0.1 * tenths as f32 {
                verdicts.end(nth, Cause::Lifetime);
            }
        }
    }
}

#[test]
fn a_reaper() {
    let at = |x: f32, y: f32| Particle { position: Vec3::new(x, y, 0.0), ..Particle::REST };
    let start: Vec<_> = (0..20).map(|i| at(i as f32, 0.1 * i as f32)).collect();
    let scene = Scene { start: &start, reapers: &Doom, ..Scene::EMPTY };
    let mut system = started(&scene, 20, 0);
    let report = system.step(&scene, Time::SECOND);
    // Serials 0, 7 and 14, and 16 to 19.
    assert_eq!((report.died.other, report.died.total(), system.len()), (7, 7, 13));
    assert!(system.particles().serial.iter().all(|serial| serial % 7 != 0 && *serial < 16));
    // It is not asked again about the dead, and says nothing of who lives.
    assert_eq!(system.step(&scene, Time::SECOND).died.total(), 0);

    // In lists of every make, with what another knows: the same deaths, each counted under its own cause.
    let crowd = vec![at(0.0, 0.0); 800];
    let kinds: [&dyn Reaper; 2] = [&Tenths, &Doom];
    let lists: [&dyn Reaper; 4] = [&(Tenths, Doom), &kinds, &&kinds[..], &((), (Tenths,), [(), ()], &Doom)];
    let outcome = |reapers: &dyn Reaper| {
        let scene = Scene { start: &crowd, reapers, ..Scene::EMPTY };
        let mut system = started(&scene, 800, 5);
        run(&mut system, &scene, 0.01, 45);
        (system.hash(), system.totals().died)
    };
    let (hash, died) = outcome(lists[0]);
    assert_eq!(died.other, 115);
    // Four of eight tenths have passed: half of those that are no seventh.
    assert!((300..386).contains(&died.lifetime), "{died:?}");
    assert!(lists.iter().all(|&list| outcome(list) == (hash, died)));
}

/// Points along x, each with its row: whoever is near is near along it.
#[derive(Default)]
struct AlongX {
    points: Vec<(Vec3, u32)>,
    order: Vec<u32>,
}

impl AlongX {
    /// Those that may lie within a radius of a place, by their x.
    fn slab(&self, x: f32, radius: f32) -> &[(Vec3, u32)] {
        let [low, high] = [x - radius, x + radius];
        let first = self.points.partition_point(|(point, _)| point.x < low);
        let behind = self.points.partition_point(|(point, _)| point.x <= high);
        self.points.get(first..behind).unwrap_or_default()
    }
}

impl SpatialIndex for AlongX {
    fn build(&mut self, points: &[Vec3], _: f32) -> Result<(), TooSmall> {
        self.points = points.iter().copied().zip(0..).filter(|(point, _)| point.is_finite()).collect();
        self.points.sort_by(|(a, _), (b, _)| a.x.total_cmp(&b.x));
        self.order = self.points.iter().map(|&(_, row)| row).collect();
        Ok(())
    }

    fn refit(&mut self, points: &[Vec3]) -> Result<(), TooSmall> {
        self.build(points, 0.0)
    }

    fn stats(&self) -> Stats {
        Stats { points: self.points.len(), ..Stats::default() }
    }

    fn order(&self) -> &[u32] {
        &self.order
    }

    fn count(&self, center: Vec3, radius: f32) -> Cost {
        self.within(center, radius, &mut |_| {})
    }

    fn within(&self, center: Vec3, radius: f32, visit: &mut dyn FnMut(&[u32])) -> Cost {
        let (mut cost, slab) = (Cost::default(), self.slab(center.x, radius));
        for (point, row) in slab.iter().filter(|(point, _)| (*point - center).length_squared() <= radius * radius) {
            assert!(point.is_finite());
            visit(&[*row]);
            cost.found += 1;
        }
        Cost { visits: 1, tests: slab.len() as u64, ..cost }
    }

    fn nearest(&self, center: Vec3, radius: f32, found: &mut [Neighbour]) -> Cost {
        let mut near: Vec<_> = self
            .slab(center.x, radius)
            .iter()
            .map(|&(point, row)| Neighbour { row, distance: (point - center).length() })
            .filter(|near| near.distance <= radius)
            .collect();
        near.sort_by(|a, b| a.distance.total_cmp(&b.distance).then(a.row.cmp(&b.row)));
        for (place, near) in found.iter_mut().zip(&near) {
            *place = *near;
        }
        Cost { found: near.len().min(found.len()) as u64, ..Cost::default() }
    }

    fn counts(&self, radius: f32, counts: &mut [u32]) -> Cost {
        counts.fill(0);
        self.neighbours(radius, &mut |row, others| counts[row as usize] += others.len() as u32)
    }

    fn neighbours(&self, radius: f32, visit: &mut dyn FnMut(u32, &[u32])) -> Cost {
        let mut cost = Cost::default();
        for &(point, row) in &self.points {
            cost += self.within(point, radius, &mut |run| {
                if run != [row] {
                    visit(row, run);
                }
            });
        }
        cost
    }

    fn pairs(&self, radius: f32, visit: &mut dyn FnMut(u32, &[u32])) -> Cost {
        self.neighbours(radius, &mut |row, others| {
            if others.iter().all(|&other| row < other) {
                visit(row, others);
            }
        })
    }

    fn all_nearest(&self, radius: f32, found: &mut [Neighbour], visit: &mut dyn FnMut(u32, &[Neighbour])) -> Cost {
        let mut cost = Cost::default();
        for &(point, row) in &self.points {
            let more = self.nearest(point, radius, found);
            visit(row, &found[..more.found as usize]);
            cost += more;
        }
        cost
    }
}

/// The choice of it, which counts how often it is asked.
#[derive(Default)]
struct InOrder(AtomicUsize);

impl IndexChoice for InOrder {
    fn columns(&self) -> usize {
        0
    }

    fn with_index(
        &self,
        _: &mut [u32],
        points: &[Vec3],
        reach: f32,
        room: Option<&Room>,
        then: &mut dyn FnMut(Option<&dyn SpatialIndex>),
    ) {
        // It knows of none: in a room, neighbours are then looked for among all.
        if room.is_some() {
            return then(None);
        }
        self.0.fetch_add(1, Ordering::Relaxed);
        let mut index = AlongX::default();
        assert!(reach > 0.0 && index.build(points, reach).is_ok());
        then(Some(&index));
    }
}

/// Forces, contacts by position and by impulse, births and deaths find their neighbours by an index of one's own.
#[test]
fn an_index() {
    let mut random = Random::new(9);
    let start: Vec<_> = (0..200)
        .map(|_| Particle {
            position: random.vector(1.0),
            velocity: random.vector(1.0),
            radius: 0.08,
            ..Particle::REST
        })
        .collect();
    let viscosity = Viscosity { coefficient: 0.5, reach: 0.4 };
    let sparse = Emitter {
        inside: true,
        where_sparse: Some(WhereSparse { radius: 0.3, fewest: 4 }),
        ..Emitter::new(Cuboid { min: Vec3::splat(-1.0), max: Vec3::ONE }, 60.0)
    };
    let dense = Dense { radius: 0.3, most: 6 };
    let apart = Contacts { compliance: 0.0 };
    let base = Scene { start: &start, ..Scene::EMPTY };
    let scenes = [
        Scene { forces: &viscosity, ..base },
        Scene { constraints: &apart, substeps: 4, ..base },
        Scene { meetings: Meetings::IMPULSE, ..base },
        Scene { emitters: &sparse, reapers: &dense, ..base },
    ];
    for (i, scene) in scenes.iter().enumerate() {
        let own = InOrder::default();
        let end = |index: &dyn IndexChoice| {
            let scene = Scene { index, ..*scene };
            let mut system = started(&scene, 400, 1);
            run(&mut system, &scene, 1.0 / 60.0, 30);
            system.hash()
        };
        let (ours, all_pairs) = (end(&own), end(&()));
        assert!(own.0.load(Ordering::Relaxed) >= 30, "{i}: it is asked in every step");
        assert_eq!(ours, all_pairs, "{i}");
    }
}

/// A record of what is told of a step.
#[derive(Default)]
struct Diary {
    phases: Vec<Phase>,
    hits: u64,
    only_events: bool,
}

impl Observer for Diary {
    fn attention(&self) -> Attention {
        if self.only_events { Attention::Events } else { Attention::Phases }
    }

    fn after(&mut self, phase: Phase, _: &State<'_>) {
        self.phases.push(phase);
    }

    fn hit(&mut self, _: &Impact) {
        self.hits += 1;
    }
}

#[test]
fn an_observer() {
    let start = [Particle { position: Vec3::Y, velocity: Vec3::Y * -70.0, ..Particle::REST }];
    let floor = Plane { point: Vec3::ZERO, normal: Vec3::Y };
    let scene = Scene { start: &start, colliders: &floor, ..Scene::EMPTY };
    for only_events in [false, true] {
        let mut diary = Diary { only_events, ..Diary::default() };
        let report = started(&scene, 1, 1).step_observed(&scene, Time::frame(1, 60), &mut diary);
        assert_eq!((diary.hits, report.hits), (1, 1));
        let phases = [Phase::Begin, Phase::Create, Phase::Move, Phase::Collide, Phase::Delete];
        assert!(only_events || diary.phases == phases, "{:?}", diary.phases);
    }
}

/// Memory of a user's own: plain vectors, each longer than need be by another number.
#[derive(Clone)]
struct Arena {
    vectors: [Vec<Vec3>; 3],
    numbers: [Vec<f32>; 6],
    times: [Vec<Time>; 2],
    words: [Vec<u32>; 7],
    colors: Vec<[u8; 4]>,
    materials: Vec<u16>,
    pending_deaths: Vec<PendingDeath>,
    emitter_states: Vec<EmitterState>,
}

impl Arena {
    fn new(size: Size) -> Self {
        let n = size.particles;
        let (work, kept) = (n * size.columns, n * size.kept);
        let extra = |i| [n, n + 3, n + 6, n + 9, 2 * size.springs, n + 15, kept][i];
        Self {
            vectors: [vec![Vec3::ZERO; n], vec![Vec3::ZERO; n + 1], vec![Vec3::ZERO; work]],
            numbers: core::array::from_fn(|i| vec![0.0; n + i]),
            times: core::array::from_fn(|i| vec![Time::ZERO; n + 2 * i]),
            words: core::array::from_fn(|i| vec![0; extra(i)]),
            colors: vec![[0; 4]; n + 5],
            materials: vec![0; n],
            pending_deaths: vec![PendingDeath::Lives; n + 7],
            emitter_states: vec![EmitterState::default(); size.emitters],
        }
    }
}

impl Storage for Arena {
    fn slices(&mut self) -> Slices<'_> {
        let [position, velocity, work] = &mut self.vectors;
        let [radius, mass, inverse_mass, drag, charge, elasticity] = &mut self.numbers;
        let [born, dies] = &mut self.times;
        let [serial, slot, row_of, last_spring, incident, key, kept] = &mut self.words;
        Slices {
            position,
            velocity,
            radius: radius.into(),
            mass: mass.into(),
            inverse_mass: inverse_mass.into(),
            drag: drag.into(),
            charge: charge.into(),
            elasticity: elasticity.into(),
            born,
            dies,
            color: (&mut self.colors).into(),
            material: (&mut self.materials).into(),
            pending_death: &mut self.pending_deaths,
            serial,
            slot,
            key,
            row_of,
            last_spring: last_spring.into(),
            emitter_states: &mut self.emitter_states,
            incident,
            kept,
            work,
        }
    }
    fn columns(&self) -> Columns<'_> {
        let [position, velocity, work] = &self.vectors;
        let [radius, mass, inverse_mass, drag, charge, elasticity] = &self.numbers;
        let [born, dies] = &self.times;
        let [serial, slot, row_of, last_spring, incident, key, kept] = &self.words;
        Columns {
            position,
            velocity,
            radius,
            mass,
            inverse_mass,
            drag,
            charge,
            elasticity,
            born,
            dies,
            color: &self.colors,
            material: &self.materials,
            pending_death: &self.pending_deaths,
            serial,
            slot,
            key,
            row_of,
            last_spring,
            emitter_states: &self.emitter_states,
            incident,
            kept,
            work,
        }
    }
}

#[test]
fn memory() {
    let start: Vec<Particle> =
        (0..6).map(|i| Particle { position: Vec3::X * i as f32, lifetime: 0.1 * i as f32, ..Particle::REST }).collect();
    let springs: Vec<_> = (0..5).map(|i| pointmass::Spring::new([i, i + 1], 0.8, 20.0).damped(0.1)).collect();
    let emitters = (Helix, Emitter::new(point(Vec3::Y), 20.0));
    let (forces, floor) = ((Gravity::EARTH, Magnet), Plane { point: Vec3::NEG_Y, normal: Vec3::Y });
    let scene = Scene {
        start: &start,
        springs: &springs,
        emitters: &emitters,
        forces: &forces,
        colliders: &floor,
        sinks: &(),
        reapers: &(Doom, Chance { rate: 0.3 }),
        custom: &[Custom::new("heat")],
        materials: &(),
        constraints: &(),
        substeps: 1,
        paths: Paths::CURVED,
        meetings: Meetings::Through,
        max_bounces: 8,
        integrator: &Leapfrog,
        index: &(),
    };
    let size = Size { particles: 40, ..scene.size() };
    let mut arena = System::with(Arena::new(size));
    let mut heap = started(&scene, 40, 6);
    assert_eq!(arena.capacity(), 40);
    arena.start(&scene, 6).expect("it fits");
    for i in 1..=90 {
        let dt = Time::frame(i, 60) - heap.time();
        assert_eq!(arena.step(&scene, dt), heap.step(&scene, dt));
        assert_eq!(arena.hash(), heap.hash());
    }
    assert!(heap.totals().refused > 0 && heap.totals().hits > 0 && heap.totals().died.lifetime > 0);
    assert!(heap.totals().died.chance > 0 && heap.totals().died.other > 0);
}
