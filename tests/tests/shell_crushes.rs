//! Shells that scenery crushes: however their triangles collapse, no energy comes from nowhere.

use pointmass::constrain::{Hinge, Shell, ShellParams};
use pointmass::force::Friction;
use pointmass::material::ContactMaterial;
use pointmass::motion::Motion;
use pointmass::shape::{Aabb, Collider, Moving, Plane};
use pointmass::{Gravity, Method, Particle, Scene, Sheet, Time, Vec3};
use pointmass_tests::{Random, config, every, is_third, often, started};
use proptest::prelude::*;
use proptest::sample::select;

const G: f32 = 9.81;
/// Mass for each square metre \[kg/m²\].
const DENSITY: f32 = 0.2;
/// The share of its speed that rounding, and what ends the search for a solution, may take of what slides.
const SLIDES_ON: f32 = 2e-3;
const EVERYWHERE: Aabb = Aabb { min: Vec3::NEG_INFINITY, max: Vec3::INFINITY };

/// What crushes a sheet.
#[derive(Clone, Copy, Debug, PartialEq)]
enum By {
    /// A wall that it slides into, edge on.
    Wall,
    /// Two of them that meet, corner on.
    Corner,
    /// A floor that it falls on, edge on.
    Floor,
    /// The same, aslant, and down a slope.
    Slope,
    /// A slope that it slides on, flat.
    Slide,
    /// Two plates that close on it and part again.
    Plates,
    /// A ring of planes that shrinks around it and opens again.
    Ring,
}

/// A sheet of a side of one metre times its size, and what happens to it.
#[derive(Clone, Copy, Debug)]
struct Crush {
    by: By,
    cells: u32,
    method: Method,
    substeps: u32,
    /// Stiffness \[N/m\] and bending stiffness \[N m\] of a sheet of size one.
    stretch: f32,
    bending: f32,
    /// How long stresses take to fade \[s\].
    damping: f32,
    friction: f32,
    elasticity: f32,
    /// Sides of the sheet a second.
    speed: f32,
    size: f32,
    /// How far from the origin it is, in sides of the sheet.
    far: f32,
    /// How far its particles are out of its plane at the most, in cells.
    rough: f32,
    seed: u64,
}

/// What became of it: the largest energy of motion, height and stretching, as a share of what can have come from somewhere, and how far anybody was
/// from where the world is, in sides of the sheet.
#[derive(Clone, Copy, Debug)]
struct Outcome {
    energy: f64,
    away: f32,
    /// How far anybody was beyond the scenery, in sides of the sheet.
    beyond: f32,
    /// How much faster or slower all together went along the floor than a body without friction, at the most and as a share of their speed as they began.
    braked: f32,
    alive: bool,
    capped: u64,
}

/// Where the world is, how it is turned, and how large it is.
struct Place {
    origin: Vec3,
    turn: [Vec3; 3],
    size: f32,
}

impl Place {
    fn of_crush(crush: &Crush, random: &mut Random) -> Self {
        let x = random.direction();
        let y = x.any_orthonormal_vector();
        let this = Self { origin: Vec3::ZERO, turn: [x, y, x.cross(y)], size: crush.size };
        Self { origin: this.of(Vec3::new(0.3, -0.8, 0.5)) * crush.far, ..this }
    }

    fn turned(&self, v: Vec3) -> Vec3 {
        let [x, y, z] = self.turn;
        x * v.x + y * v.y + z * v.z
    }

    fn of(&self, x: Vec3) -> Vec3 {
        self.origin + self.turned(x) * self.size
    }

    fn plane(&self, [point, normal]: [Vec3; 2]) -> Plane {
        Plane { point: self.of(point), normal: self.turned(normal) }
    }
}

impl Crush {
    /// The planes that stand still and those that close, by a point and their normal, in sides of the sheet; and where the sheet's corner and sides are.
    fn world(&self) -> (Vec<[Vec3; 2]>, Vec<[Vec3; 2]>, [Vec3; 3]) {
        let floor = [Vec3::ZERO, Vec3::Y];
        let lying = [Vec3::new(-0.5, 0.02, -0.5), Vec3::X, Vec3::Z];
        match self.by {
            By::Wall => (vec![floor, [Vec3::X * 0.52, Vec3::NEG_X]], vec![], lying),
            By::Corner => {
                let walls = [1.0, -1.0].map(|side| [Vec3::X * 0.73, Vec3::new(-1.0, 0.0, side).normalize()]);
                let [a, b] = [Vec3::new(1.0, 0.0, 1.0), Vec3::new(1.0, 0.0, -1.0)].map(Vec3::normalize);
                (vec![floor, walls[0], walls[1]], vec![], [Vec3::Y * 0.02 - (a + b) * 0.5, b, a])
            }
            By::Floor | By::Slope => (vec![floor], vec![], [Vec3::Y * 0.02, Vec3::Y, Vec3::X]),
            By::Slide => (vec![floor], vec![], lying),
            By::Plates => {
                let plates = [1.0, -1.0].map(|side| [Vec3::X * (0.52 * side), Vec3::X * -side]);
                (vec![floor], plates.to_vec(), lying)
            }
            By::Ring => {
                let plates = (0..8).map(|i| {
                    let (sin, cos) = (core::f32::consts::FRAC_PI_4 * i as f32 + 0.1).sin_cos();
                    let out = Vec3::new(cos, 0.0, sin);
                    [out * 0.72, -out]
                });
                (vec![floor], plates.collect(), lying)
            }
        }
    }

    /// How far plates go to and fro, in sides of the sheet, and the energy that those which close may put in, in the sheet's masses × its sides² / s²: what
    /// flattens a sheet in its plane, and what is hit as fast as they are at the most.
    fn closing(&self) -> (f32, f32) {
        let sides = match self.by {
            By::Plates => 1.0,
            By::Ring => 2.0,
            _ => return (0.0, 0.0),
        };
        (0.35, sides * 0.5 * self.stretch * 0.25 / DENSITY + 2.0 * self.speed * self.speed)
    }

    /// The way of a particle of the sheet as it begins, in its sides a second.
    fn thrown(&self) -> Vec3 {
        match self.by {
            By::Wall => Vec3::new(self.speed, -0.2, 0.0),
            By::Corner => Vec3::new(self.speed, -0.2, 0.05 * self.speed),
            By::Floor => Vec3::NEG_Y * self.speed,
            By::Slope => Vec3::new(0.3, -1.0, 0.2) * self.speed,
            By::Slide => Vec3::new(0.8, -0.1, 0.6) * self.speed,
            By::Plates | By::Ring => Vec3::ZERO,
        }
    }

    /// Where all falls.
    fn down(&self) -> Vec3 {
        if matches!(self.by, By::Slope | By::Slide) { Vec3::new(0.3, -1.0, -0.4).normalize() } else { Vec3::NEG_Y }
    }

    /// The particles as they begin.
    fn start(&self, sheet: &Sheet, place: &Place, random: &mut Random) -> Vec<Particle> {
        let velocity = place.turned(self.thrown()) * self.size;
        let thread = Particle { mass: 0.0, velocity, elasticity: 0.0, material: Some(0), ..Particle::REST };
        let mut start: Vec<Particle> = sheet.particles(thread).collect();
        let third = DENSITY * self.size * self.size * 0.5 / (3 * self.cells * self.cells) as f32;
        sheet.triangles().flatten().for_each(|corner| start[corner as usize].mass += third);
        let normal = sheet.sides[0].cross(sheet.sides[1]);
        for particle in &mut start {
            let off = normal * ((random.unit() - 0.5) * self.rough / self.cells as f32);
            particle.position = place.of(particle.position + off);
        }
        start
    }

    fn params(&self) -> ShellParams {
        let [square, fourth] = [2, 4].map(|power| self.size.powi(power));
        ShellParams {
            stretch: [self.stretch * square; 2],
            shear: 0.3 * self.stretch * square,
            bending: self.bending * fourth,
            damping: self.damping,
        }
    }

    fn run(&self, frames: u64) -> Outcome {
        let mut random = Random::new(self.seed);
        let place = Place::of_crush(self, &mut random);
        let (still, closing, [corner, first, second]) = self.world();
        let planes: Vec<Plane> = still.iter().map(|&plane| place.plane(plane)).collect();
        let (way, work) = self.closing();
        // A quarter of a swing takes them as far as they go.
        let frequency = if way > 0.0 { self.speed / (way * core::f32::consts::TAU) } else { 0.0 };
        let plate = |&[point, normal]: &[Vec3; 2]| {
            let motion = Motion { swing: place.turned(normal) * (way * self.size), frequency, ..Motion::STILL };
            Moving::new(place.plane([point, normal]), &EVERYWHERE, motion)
        };
        let plates: Vec<_> = closing.iter().map(plate).collect();
        let sheet = Sheet { corner, sides: [first, second], cells: [self.cells; 2] };
        let (start, params) = (self.start(&sheet, &place, &mut random), self.params());
        let shell = Shell {
            particles: (0..start.len() as u32).collect::<Vec<_>>(),
            triangles: sheet.triangles().collect::<Vec<_>>(),
            hinges: sheet.hinges().collect::<Vec<Hinge>>(),
            warp: place.turned(first),
            params,
        };
        let friction = Some(Friction { static_: self.friction, kinetic: self.friction });
        let materials = [ContactMaterial { friction, elasticity: Some(self.elasticity) }];
        let pull = place.turned(self.down()) * (G * self.size);
        let gravity = Gravity { acceleration: pull };
        let colliders: &dyn Collider = &(&planes[..], &plates[..]);
        let scene = Scene {
            start: &start,
            forces: &gravity,
            colliders,
            materials: &materials,
            constraints: &shell,
            substeps: self.substeps,
            integrator: self.method.integrator(),
            ..Scene::EMPTY
        };
        let mut system = started(&scene, start.len(), 0);
        let energy = |x: &[Vec3], v: &[Vec3]| {
            let one = |i: usize| start[i].mass * (0.5 * v[i].length_squared() - (x[i] - place.origin).dot(pull));
            let moving: f64 = (0..x.len()).map(|i| f64::from(one(i))).sum();
            (moving + stretching(&sheet, &params, self.size, x)) / (f64::from(DENSITY) * f64::from(self.size).powi(4))
        };
        let (places, speeds): (Vec<_>, Vec<_>) = start.iter().map(|p| (p.position, p.velocity)).unzip();
        let most = energy(&places, &speeds) + f64::from(work);
        let flat = |v: Vec3| v - place.turn[1] * v.dot(place.turn[1]);
        let drift = |v: &[Vec3]| {
            flat(v.iter().zip(&start).map(|(&v, p)| v * p.mass).sum::<Vec3>())
                / start.iter().map(|p| p.mass).sum::<f32>()
        };
        let mut outcome = Outcome { energy: 0.0, away: 0.0, beyond: 0.0, braked: 0.0, alive: true, capped: 0 };
        for frame in 1..=frames {
            system.step_to(&scene, Time::frame(frame, 60));
            let (x, v) = (system.particles().position, system.particles().velocity);
            outcome.alive &= x.len() == start.len() && x.iter().chain(v).all(|x| x.is_finite());
            if !outcome.alive {
                break;
            }
            outcome.energy = outcome.energy.max(energy(x, v) / most);
            let away = x.iter().map(|&x| (x - place.origin).length() / self.size).fold(0.0, f32::max);
            outcome.away = outcome.away.max(away);
            let free = drift(&speeds) + flat(pull) * (frame as f32 / 60.0);
            let braked = (drift(v) - free).length() / (self.speed * self.size);
            outcome.braked = outcome.braked.max(braked);
            let swung = way * self.size * (core::f32::consts::TAU * frequency * frame as f32 / 60.0).sin();
            let deep = |planes: &[[Vec3; 2]], swung: f32| -> f32 {
                let planes = planes.iter().map(|&plane| place.plane(plane));
                let depth = |plane: Plane| x.iter().map(move |&x| swung - (x - plane.point).dot(plane.normal));
                planes.flat_map(depth).fold(0.0, f32::max) / self.size
            };
            outcome.beyond = outcome.beyond.max(deep(&still, 0.0)).max(deep(&closing, swung));
        }
        outcome.capped = system.totals().effort.capped;
        outcome
    }

    /// Tells whether all stays finite and where it can be, is solved to the end, and no energy comes from nowhere.
    fn check(&self) -> Result<(), TestCaseError> {
        let outcome = self.run(40);
        // Plates that meet leave no room.
        let beyond = outcome.beyond < 1e-4 || self.by == By::Ring;
        let sound = outcome.alive && outcome.away < 12.0 && outcome.capped == 0 && beyond;
        // In one step of a sixtieth of a second what moves goes through its cells at once: it keeps to a bound, and does not explode. Of 500 one gave 8
        // times its energy, and some have been met that gave 26 times.
        let is_pressed = matches!(self.by, By::Plates | By::Ring);
        let most = if self.substeps > 1 || !is_pressed { 1.01 } else { 100.0 };
        prop_assert!(sound && outcome.energy < most, "{self:?}: {outcome:?}");
        Ok(())
    }
}

/// The energy that a sheet is stretched and sheared by, in double precision \[J\].
fn stretching(sheet: &Sheet, params: &ShellParams, size: f32, x: &[Vec3]) -> f64 {
    let rest: Vec<Vec3> = sheet.positions().collect();
    let units = sheet.sides.map(Vec3::normalize);
    let along = |v: Vec3| units.map(|unit| f64::from(v.dot(unit) * size));
    let dot = |a: [f64; 3], b: [f64; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    let one = |corners: [u32; 3]| {
        let [a, b, c] = corners.map(|corner| corner as usize);
        let ([p, q], [r, s]) = (along(rest[b] - rest[a]), along(rest[c] - rest[a]));
        let twice = p * s - q * r;
        let [e, f] = [b, c].map(|i| (x[i] - x[a]).to_array().map(f64::from));
        let u: [f64; 3] = core::array::from_fn(|i| (e[i] * s - f[i] * q) / twice);
        let v: [f64; 3] = core::array::from_fn(|i| (f[i] * p - e[i] * r) / twice);
        let (warp, weft, shear) = (0.5 * (dot(u, u) - 1.0), 0.5 * (dot(v, v) - 1.0), dot(u, v));
        let [first, second] = params.stretch.map(f64::from);
        0.25 * twice.abs() * (first * warp * warp + second * weft * weft + f64::from(params.shear) * shear * shear)
    };
    sheet.triangles().map(one).sum()
}

fn any_crush() -> impl Strategy<Value = Crush> {
    let by = select(vec![By::Wall, By::Corner, By::Floor, By::Plates, By::Ring]);
    let method = select(vec![Method::Symplectic, Method::Verlet, Method::Rk4, Method::Midpoint]);
    let material = (
        (20f32.ln()..5000f32.ln()).prop_map(f32::exp),
        prop_oneof![1 => Just(0.0), 4 => (1e-6f32.ln()..1e-2f32.ln()).prop_map(f32::exp)],
        select(vec![0.0, 1e-3, 1e-2]),
    );
    let contact = (select(vec![0.0, 0.3, 1.0]), select(vec![0.0, 0.5]));
    let how = (select(vec![1u32, 2, 3, 10, 30]), 0.5f32..15.0, select(vec![0.0, 1e-4, 0.1]), any::<u64>());
    let place = (select(vec![0.1f32, 1.0, 10.0]), select(vec![0.0f32, 30.0]), 4u32..14);
    (by, method, material, contact, how, place).prop_map(
        |(by, method, (stretch, bending, damping), (friction, elasticity), how, (size, far, cells))| {
            let (substeps, speed, rough, seed) = how;
            Crush {
                by,
                cells,
                method,
                substeps,
                stretch,
                bending,
                damping,
                friction,
                elasticity,
                speed,
                size,
                far,
                rough,
                seed,
            }
        },
    )
}

#[test]
fn what_a_wall_crushes_does_not_explode() {
    // A sheet that slides into a wall so flat that it cannot buckle, and one that is pushed along a floor.
    let mut cases = 0;
    for (by, bending, substeps) in
        [(By::Wall, 1e-4, 10), (By::Wall, 0.0, 10), (By::Plates, 1e-4, 10), (By::Corner, 1e-4, 3)]
    {
        for (stretch, speed) in [(50.0, 3.0), (500.0, 8.0)] {
            if !is_third(&mut cases) {
                continue;
            }
            let crush = Crush {
                by,
                cells: 12,
                method: Method::Rk4,
                substeps,
                stretch,
                bending,
                damping: 0.01,
                friction: 0.3,
                elasticity: 0.5,
                speed,
                size: 1.0,
                far: 0.0,
                rough: 0.0,
                seed: 1,
            };
            crush.check().unwrap_or_else(|error| panic!("{error}"));
        }
    }
}

/// Sheets without damping that slide so slowly into a corner or a wall that these hold them for many sub-steps, each of which is long for their waves.
#[test]
fn slow_crushes_in_few_sub_steps_give_no_energy() {
    let mut random = Random::new(5);
    for i in 0..often(200) {
        let crush = Crush {
            by: [By::Corner, By::Wall][i % 2],
            cells: 7 + random.word() as u32 % 6,
            method: [Method::Symplectic, Method::Verlet, Method::Rk4, Method::Midpoint][i / 2 % 4],
            substeps: 3,
            stretch: random.magnitude(150.0, 3000.0),
            bending: 0.0,
            damping: 0.0,
            friction: 0.0,
            elasticity: 0.0,
            speed: random.between(0.4, 0.8),
            size: [0.1, 1.0, 10.0][i % 3],
            far: 0.0,
            rough: [0.0, 1e-4][i / 3 % 2],
            seed: i as u64,
        };
        crush.check().unwrap_or_else(|error| panic!("{error}"));
    }
}

/// Whatever becomes of sheets that fall aslant on a smooth floor, edge on, or slide on it, it takes nothing of how all together go along it.
#[test]
fn smooth_floors_brake_nobody() {
    let mut random = Random::new(8);
    for i in (0..96).step_by(every(11)) {
        let crush = Crush {
            by: [By::Slope, By::Slide, By::Slope][i % 3],
            cells: 4 + random.word() as u32 % 10,
            method: [Method::Verlet, Method::Rk4, Method::Symplectic, Method::Midpoint][i / 3 % 4],
            substeps: [2, 3, 10, 30][i / 2 % 4],
            stretch: random.magnitude(20.0, 5000.0),
            bending: [0.0, 1e-3][i / 5 % 2],
            damping: [0.0, 1e-3][i / 7 % 2],
            friction: 0.0,
            elasticity: [0.0, 0.5][i / 4 % 2],
            speed: random.magnitude(0.5, 15.0),
            size: [0.1, 1.0, 10.0][i / 2 % 3],
            far: 0.0,
            rough: [0.0, 1e-4, 0.1][i / 4 % 3],
            seed: i as u64,
        };
        let outcome = crush.run(40);
        assert!(outcome.alive && outcome.braked < SLIDES_ON, "{crush:?}: {outcome:?}");
    }
}

/// Sheets that fall so hard on a smooth floor, edge on, that they crumple.
#[test]
fn nobody_is_pressed_through_a_floor() {
    for i in 0..often(48).max(8) {
        let crush = Crush {
            by: By::Floor,
            cells: [6, 9, 13][i % 3],
            method: [Method::Verlet, Method::Rk4, Method::Symplectic, Method::Midpoint][i / 3 % 4],
            substeps: [30, 10][i % 2],
            stretch: 442.6,
            bending: 1.4e-3,
            damping: 1e-3,
            friction: 0.0,
            elasticity: 0.5,
            speed: 10.6,
            size: [10.0, 1.0][i / 6 % 2],
            far: [0.0, 30.0][i / 2 % 2],
            rough: [0.0, 1e-4, 0.1][i / 4 % 3],
            seed: i as u64,
        };
        let outcome = crush.run(40);
        assert!(outcome.beyond < 1e-4, "{crush:?}: {outcome:?}");
    }
}

proptest! {
    #![proptest_config(config!(60))]

    #[test]
    fn whatever_is_crushed_keeps_its_energy(crush in any_crush()) {
        crush.check()?;
    }
}

proptest! {
    #![proptest_config(config!(2000))]

    #[test]
    #[ignore = "long: minutes"]
    fn whatever_else_is_crushed_keeps_its_energy(crush in any_crush()) {
        crush.check()?;
    }
}

proptest! {
    #![proptest_config(config!(1000))]

    #[test]
    #[ignore = "long: minutes"]
    fn nobody_gets_through(crush in any_crush(), many in 0u32..2) {
        let crush = Crush { friction: 0.0, substeps: 10 + 20 * many, ..crush };
        let outcome = crush.run(40);
        prop_assert!(outcome.beyond < 1e-4, "{crush:?}: {outcome:?}");
    }
}
