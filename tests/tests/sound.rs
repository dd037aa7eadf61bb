//! Waves along what stretches: a rope, a strand and a strip of a shell that are pushed along swing in the time that the speed of sound in their
//! material makes of their length.

use pointmass::constrain::{ShellParams, StrandParams, Strands};
use pointmass::{Constraint, Method, Particle, Rope, Scene, Sheet, Shell, Time, Vec3};
use pointmass_tests::{every, started};

/// A bar that is fixed where it begins.
#[derive(Debug)]
struct Bar {
    /// Its length \[m\], its mass for each metre \[kg/m\] and E A, the force that would make it twice as long \[N\].
    length: f32,
    mass: f32,
    stretch: f32,
    along: Vec3,
    links: u32,
}

impl Bar {
    /// The time of its slowest swing along itself, in which a wave goes there and back twice at √(E/ρ) \[s\].
    fn period(&self) -> f64 {
        4.0 * f64::from(self.length) / (f64::from(self.stretch) / f64::from(self.mass)).sqrt()
    }

    /// A particle of it, and how fast that begins in the slowest swing, which takes its end a thousandth of the length away.
    fn particle(&self, place: Vec3, mass: f32) -> Particle {
        let share = place.dot(self.along) / self.length;
        let fastest = core::f32::consts::TAU / self.period() as f32 * 1e-3 * self.length;
        let velocity = self.along * (fastest * (core::f32::consts::FRAC_PI_2 * share).sin());
        Particle { position: place, velocity, mass, fixed: share < 1e-3, ..Particle::REST }
    }

    /// Its points in a row, the last with half the mass.
    fn chain(&self) -> Vec<Particle> {
        let mass = self.mass * self.length / self.links as f32;
        let place = |i: u32| self.along * (self.length * i as f32 / self.links as f32);
        (0..=self.links).map(|i| self.particle(place(i), if i == self.links { 0.5 * mass } else { mass })).collect()
    }

    /// How long a whole swing of its end takes \[s\], in sub-steps a two-thousandth of that, and the share of its height that is left then.
    fn swing(&self, start: &[Particle], constraint: &dyn Constraint, method: Method, substeps: u32) -> [f64; 2] {
        let scene = Scene { start, constraints: constraint, integrator: method.integrator(), substeps, ..Scene::EMPTY };
        let dt = Time::from_seconds(self.period() as f32 * substeps as f32 / 2000.0);
        let mut system = started(&scene, start.len(), 0);
        let end = start.len() - 1;
        let out = |x: Vec3| f64::from((x - start[end].position).dot(self.along));
        let (mut before, mut crossings, mut height) = (0.0, Vec::new(), 0.0f64);
        while crossings.len() < 3 {
            system.step(&scene, dt);
            let now = out(system.particles().position[end]);
            if before * now < 0.0 {
                crossings.push(system.time().seconds_f64() - dt.seconds_f64() * now / (now - before));
            }
            height = if crossings.len() == 2 { height.max(now) } else { height };
            before = now;
            assert!(system.time().seconds_f64() < 2.0 * self.period(), "it does not swing");
        }
        [crossings[2] - crossings[0], height / (1e-3 * f64::from(self.length))]
    }

    fn assert_swing(&self, [time, height]: [f64; 2], name: &str) {
        let right = self.period();
        assert!((time / right - 1.0).abs() < 5e-3, "{name} of {self:?} in {time} s for {right} s");
        assert!((height - 1.0).abs() < 0.03, "{name} of {self:?} is up to {height} of its height after a swing");
    }
}

const BARS: [Bar; 3] = [
    Bar { length: 1.0, mass: 0.1, stretch: 1e3, along: Vec3::X, links: 32 },
    Bar { length: 0.02, mass: 1e-3, stretch: 0.5, along: Vec3::new(0.6, 0.0, -0.8), links: 20 },
    Bar { length: 50.0, mass: 8.0, stretch: 1e6, along: Vec3::NEG_Y, links: 64 },
];
const METHODS: [(Method, u32); 3] = [(Method::Symplectic, 10), (Method::Verlet, 1), (Method::Rk4, 4)];

/// Each bar by each method, in debug builds by one of them.
fn cases() -> impl Iterator<Item = (&'static Bar, (Method, u32))> {
    BARS.iter().flat_map(|bar| METHODS.map(|how| (bar, how))).step_by(every(4))
}

#[test]
fn sound_runs_along_a_rope() {
    for (bar, (method, substeps)) in cases() {
        let length = bar.length / bar.links as f32;
        let all: Vec<u32> = (0..=bar.links).collect();
        let rope = Rope { compliance: length / bar.stretch, ..Rope::rigid(all, [length]) };
        bar.assert_swing(bar.swing(&bar.chain(), &rope, method, substeps), &format!("a rope, {method}"));
    }
}

#[test]
fn sound_runs_along_a_strand() {
    for (bar, (method, substeps)) in cases() {
        let stiff = 1e-4 * bar.stretch * bar.length * bar.length;
        let params = StrandParams { stretch: Some(bar.stretch), bending: [stiff; 2], twisting: stiff, damping: 0.0 };
        let strand = Strands::of((0..=bar.links).collect::<Vec<u32>>(), [bar.links + 1], params);
        bar.assert_swing(bar.swing(&bar.chain(), &strand, method, substeps), &format!("a strand, {method}"));
    }
}

#[test]
fn sound_runs_along_a_strip_of_a_shell() {
    for (bar, (method, substeps)) in cases() {
        let width = 0.1 * bar.length;
        let across = bar.along.any_orthonormal_vector() * width;
        let sheet = Sheet { corner: Vec3::ZERO, sides: [bar.along * bar.length, across], cells: [bar.links, 2] };
        let mut start: Vec<Particle> = sheet.particles(Particle { mass: 0.0, ..Particle::REST }).collect();
        for corners in sheet.triangles() {
            let [a, b, c] = corners.map(|corner| start[corner as usize].position);
            let third = bar.mass / width * (b - a).cross(c - a).length() / 6.0;
            corners.iter().for_each(|&corner| start[corner as usize].mass += third);
        }
        start.iter_mut().for_each(|particle| *particle = bar.particle(particle.position, particle.mass));
        let stretch = bar.stretch / width;
        let shell = Shell {
            particles: (0..start.len() as u32).collect::<Vec<_>>(),
            triangles: sheet.triangles().collect::<Vec<_>>(),
            hinges: sheet.hinges().collect::<Vec<_>>(),
            warp: bar.along,
            params: ShellParams { stretch: [stretch; 2], shear: 0.5 * stretch, bending: 0.0, damping: 0.0 },
        };
        bar.assert_swing(bar.swing(&start, &shell, method, substeps), &format!("a strip, {method}"));
    }
}
