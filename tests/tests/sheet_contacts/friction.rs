//! Friction of sheets on slopes: what lies still, what slides, and how fast.

use super::cloths::{Cloths, G, cotton, square};
use pointmass::constrain::ShellParams;
use pointmass::force::Friction;
use pointmass::material::ContactMaterial;
use pointmass::shape::{Collider, Plane};
use pointmass::{Gravity, Method, Scene, Time, Vec3};
use pointmass_tests::{every, methods, started};

/// What a sheet lies on.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Ground {
    /// A plane of the scenery.
    Plane,
    /// A sheet that is fixed.
    Fixed,
    /// A larger sheet that lies on a plane of three times the friction that the two have on each other.
    Loose,
}

/// A sheet that slides, or not.
#[derive(Clone, Copy, Debug)]
struct Slide {
    ground: Ground,
    mu: f32,
    /// The tangent of the slope's angle.
    slope: f32,
    /// How fast it begins along the slope, downward \[sizes/s\].
    speed: f32,
    /// How long it is watched \[s\].
    time: f32,
    method: Method,
    substeps: u32,
    /// Steps a second.
    rate: u32,
    /// How large the world is \[m\]: everything scales, gravity too.
    size: f32,
    /// The angle about the ground's normal, in which the slope goes down \[rad\], and where it is \[sizes\].
    heading: f32,
    far: Vec3,
    /// The number of cells along each of its sides.
    cells: u32,
}

impl Slide {
    /// The mean way and the mean speed down the slope at the end \[sizes, sizes/s\], and how far aside.
    fn run(&self) -> [f32; 3] {
        let Self { ground, size, .. } = *self;
        let (cloths, first) = self.cloths();
        let down = self.down();
        let cosine = 1.0 / (1.0 + self.slope * self.slope).sqrt();
        let gravity = Gravity { acceleration: (down * self.slope - Vec3::Y) * (cosine * G * size) };
        let rough = |mu| ContactMaterial { friction: Some(Friction { static_: mu, kinetic: mu }), elasticity: None };
        // The upper of two has what makes just that of both; the plane has none of its own.
        let materials = [rough(self.mu), rough(3.0 * self.mu), rough(self.mu / 3.0)];
        let lying = Plane { point: self.far * size, normal: Vec3::Y };
        let colliders: &dyn Collider = if ground == Ground::Fixed { &() } else { &lying };
        let constraints = (&cloths.shells[..], cloths.contacts(THICKNESS * size));
        let scene = Scene {
            start: &cloths.start,
            forces: &gravity,
            colliders,
            materials: &materials,
            constraints: &constraints,
            substeps: self.substeps,
            integrator: self.method.integrator(),
            ..Scene::EMPTY
        };
        let mut system = started(&scene, cloths.start.len(), 0);
        for frame in 1..=(self.time * self.rate as f32).round() as u64 {
            system.step_to(&scene, Time::frame(frame, self.rate));
        }
        let all = system.particles();
        let mean = |of: &[Vec3]| of[first..].iter().sum::<Vec3>() / (of.len() - first) as f32 / size;
        let begun: Vec<Vec3> = cloths.start.iter().map(|particle| particle.position).collect();
        let way = mean(all.position) - mean(&begun);
        [way.dot(down), mean(all.velocity).dot(down), way.dot(down.cross(Vec3::Y))]
    }

    fn down(&self) -> Vec3 {
        Vec3::new(self.heading.cos(), 0.0, self.heading.sin())
    }

    /// The sheets, and the first particle of the one that slides.
    fn cloths(&self) -> (Cloths, usize) {
        let (size, down) = (self.size, self.down());
        let across = Vec3::Y.cross(down);
        let mut cloths = Cloths::default();
        let high = |layers: f32| Vec3::Y * (layers * THICKNESS);
        let on_plane = self.ground != Ground::Fixed;
        let first = if self.ground == Ground::Plane { 0.5 } else { 1.0 };
        let upper = if self.ground == Ground::Loose { 1.5 } else { first };
        let stiff = ShellParams { bending: 1e-3 * size * size * size, ..cotton(size) };
        if self.ground != Ground::Plane {
            let center = (self.far + high(if on_plane { 0.5 } else { 0.0 }) + down * 0.25) * size;
            cloths.add(&square(center, [down * size, across * (0.4 * size)], 5), stiff, |x| x, Vec3::ZERO);
            cloths.start.iter_mut().for_each(|particle| particle.fixed = !on_plane);
            cloths.start.iter_mut().for_each(|particle| particle.material = Some(if on_plane { 1 } else { 0 }));
        }
        let count = cloths.start.len();
        let center = (self.far + high(upper) + across * 0.013) * size;
        let sides = [down * 0.2 + across * 0.03, across * 0.2 - down * 0.03].map(|side| side * size);
        cloths.add(&square(center, sides, self.cells), stiff, |x| x, down * (self.speed * size));
        cloths.start[count..]
            .iter_mut()
            .for_each(|particle| particle.material = Some(if self.ground == Ground::Loose { 2 } else { 0 }));
        (cloths, count)
    }
}

/// How thick sheets are \[sizes\].
const THICKNESS: f32 = 0.005;

/// Sheets on every ground by every method in sub-steps and steps long and short, large and small, in several poses.
fn slides() -> impl Iterator<Item = Slide> {
    let substeps = [2u32, 5, 10, 20];
    let cases = substeps.into_iter().flat_map(|substeps| Method::ALL.iter().map(move |&method| (substeps, method)));
    cases.enumerate().step_by(every(4)).map(|(i, (substeps, method))| Slide {
        ground: [Ground::Plane, Ground::Fixed, Ground::Loose][(i + i / 9) % 3],
        mu: [0.2, 0.6, 0.35, 0.1, 0.45][i % 5],
        slope: 0.0,
        speed: 0.0,
        time: 0.3,
        method,
        substeps,
        rate: [60, 30, 120, 240][(i + i / 4) % 4],
        size: [1.0, 0.1, 10.0, 1.0, 0.5][(i / 2) % 5],
        heading: 0.7 * i as f32,
        far: [Vec3::ZERO, Vec3::new(3.0, 1.0, -2.0), Vec3::new(-0.5, -0.2, 0.3)][(i / 3) % 3],
        cells: 4,
    })
}

/// What a friction that is off by 3 % changes of a speed and a way; methods of first order have ways that are a sub-step ahead or behind.
fn tolerance(slide: &Slide, gain: f32) -> [f32; 2] {
    let Slide { time, .. } = *slide;
    let h = 1.0 / (slide.rate * slide.substeps) as f32;
    [0.03 * gain * time, 0.5 * gain * time * (0.03 * time + h)]
}

#[test]
fn on_the_level_sheets_are_braked_by_their_coefficient() {
    for slide in slides() {
        // It does not come to rest.
        let slide = Slide { speed: G * slide.mu * 0.5, ..slide };
        let (gain, time) = (G * slide.mu, slide.time);
        let [way, speed, aside] = slide.run();
        let [faster, farther] = tolerance(&slide, gain);
        assert!((speed - (slide.speed - gain * time)).abs() < faster, "{slide:?}: {speed}");
        assert!((way - (slide.speed - 0.5 * gain * time) * time).abs() < farther, "{slide:?}: {way}");
        assert!(aside.abs() < farther, "{slide:?}: {aside}");
    }
}

#[test]
fn on_slopes_sheets_lie_still_below_the_angle_of_friction_and_slide_above_it() {
    for slide in slides() {
        for over in [0.9, 1.3] {
            let slide = Slide { slope: over * slide.mu, ..slide };
            let cosine = 1.0 / (1.0 + slide.slope * slide.slope).sqrt();
            let [weight, time] = [G * cosine * slide.mu, slide.time];
            let gain = weight * (over - 1.0f32).max(0.0);
            let [way, speed, _] = slide.run();
            let [faster, farther] = tolerance(&slide, weight);
            assert!((speed - gain * time).abs() < faster, "{slide:?}: {speed}, not {}", gain * time);
            let wanted = 0.5 * gain * time * time;
            assert!((way - wanted).abs() < farther, "{slide:?}: {way}, not {wanted}");
        }
    }
}

#[test]
fn sheets_of_many_cells_slide_whole_in_steps_of_any_length_anywhere() {
    // How far gravity moves a particle in a sub-step is more than rounding by far here, about as much there, and less in the shortest ones.
    let spans = [(60, 1), (60, 4), (60, 12), (24, 1), (144, 1), (480, 1), (1000, 1)];
    let cases = spans.into_iter().flat_map(|span| [0.0, 2.0, 18.0, 100.0].map(|far| (span, far)));
    for (i, ((rate, substeps), far)) in cases.enumerate().step_by(every(5)) {
        for method in methods(i) {
            let mu = [0.4, 0.2, 0.6][i % 3];
            let slide = Slide {
                ground: Ground::Plane,
                mu,
                slope: 1.3 * mu,
                speed: 0.0,
                time: if rate > 400 { 0.2 } else { 0.5 },
                method,
                substeps,
                rate,
                size: 1.0,
                heading: 0.3 + 0.7 * i as f32,
                far: Vec3::new(0.6 * far, 0.0, -0.8 * far),
                cells: 16,
            };
            let gain = G / (1.0 + slide.slope * slide.slope).sqrt() * (slide.slope - mu);
            let [_, speed, _] = slide.run();
            assert!((speed - gain * slide.time).abs() < 0.03 * gain / 0.3 * slide.time, "{slide:?}: {speed}");
        }
    }
}
