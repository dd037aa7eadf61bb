//! A cloth of so many cells a side falls over a ball, or hangs by two corners, with contacts or without, for so many frames of 1/60 s, by
//! pointmass, and by rapier3d's soft bodies in the same run:
//! `cargo run --release -p pointmass-bench --features rapier --example cloth -- [CELLS] [FRAMES] [on|off] [fall|hang] [SUBSTEPS] [STRETCH] [WHO] [ASIDE]`.
//!
//! It prints the time of a frame, and the largest strain of an edge along warp or weft in the second half; of pointmass what happened and the hash
//! as well. STRETCH is the stiffness \[N/m\]. WHO is `ours`, for pointmass alone, so that callgrind can count its instructions; or `rapier`, or the
//! numbers of iterations and the frequency of edges that rapier3d is to take, as `20,1000`, and `off` behind these if its cloth is not to touch itself
//! whatever ours does: then both go through a frame in turns. ASIDE is how far beside the ball's middle what falls begins \[m\].

use pointmass::constrain::{SheetContacts, Shell, ShellParams};
use pointmass::shape::{Plane, Sphere};
use pointmass::{Constraint, Gravity, Heap, Particle, Scene, Sheet, Size, System, Time, Vec3};
use std::time::{Duration, Instant};

/// The mass \[kg\], the thickness \[m\], and the ball.
const MASS: f32 = 0.2;
const THICKNESS: f32 = 0.004;
const BALL: Sphere = Sphere { center: Vec3::new(0.0, 0.2, 0.0), radius: 0.1 };

struct Case {
    cells: u32,
    frames: u32,
    touches: bool,
    hangs: bool,
    substeps: u32,
    stretch: f32,
    aside: f32,
}

impl Case {
    /// Where it starts: over the ball, or beside it at such a height that it swings clear of the floor.
    fn corner(&self) -> Vec3 {
        if self.hangs { Vec3::new(-0.5, 1.5, 0.5) } else { Vec3::new(self.aside - 0.5, 0.32, -0.5) }
    }
}

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let is = |i: usize, word: &str| arguments.get(i).is_some_and(|text| text == word);
    let number = |i: usize, usual: u32| arguments.get(i).and_then(|text| text.parse().ok()).unwrap_or(usual);
    let case = Case {
        cells: number(0, 40),
        frames: number(1, 60),
        touches: is(2, "on"),
        hangs: is(3, "hang"),
        substeps: number(4, 5),
        stretch: number(5, 500) as f32,
        aside: arguments.get(7).and_then(|text| text.parse().ok()).unwrap_or(0.0),
    };
    match arguments.get(6).map(String::as_str) {
        None | Some("ours") => run(&case, None),
        Some(who) => run(&case, rapier(&case, who)),
    }
}

/// Somebody's cloth: who it is, and a step of a frame, which says how long it took and where all are.
struct Cloth<'a> {
    name: String,
    step: Box<dyn FnMut() -> (Duration, Vec<Vec3>) + 'a>,
}

/// Takes ours through the case, in turns with another, if there is one.
fn run(case: &Case, other: Option<Cloth<'_>>) {
    let sheet = Sheet { corner: case.corner(), sides: [Vec3::X, Vec3::Z], cells: [case.cells; 2] };
    let count = (case.cells + 1) * (case.cells + 1);
    let thread = Particle { mass: MASS / count as f32, elasticity: 0.0, ..Particle::REST };
    let mut start: Vec<Particle> = sheet.particles(thread).collect();
    for corner in [0, case.cells as usize] {
        start[corner].fixed = case.hangs;
    }
    let (particles, triangles): (Vec<u32>, Vec<_>) = ((0..count).collect(), sheet.triangles().collect());
    let contacts = SheetContacts { particles: particles.clone(), triangles: triangles.clone(), thickness: [THICKNESS] };
    let params = ShellParams { stretch: [case.stretch; 2], shear: 0.4 * case.stretch, bending: 1e-5, damping: 2e-3 };
    let shell = Shell { particles, triangles, hinges: sheet.hinges().collect::<Vec<_>>(), warp: Vec3::X, params };
    let colliders = (Plane { point: Vec3::ZERO, normal: Vec3::Y }, BALL);
    let (with, without) = ((&shell, &contacts), (&shell,));
    let constraints: &dyn Constraint = if case.touches { &with } else { &without };
    let scene = Scene {
        start: &start,
        forces: &Gravity::EARTH,
        colliders: &colliders,
        constraints: &constraints,
        substeps: case.substeps,
        ..Scene::EMPTY
    };
    let mut system = System::with(Heap::new(Size { particles: count as usize, ..scene.size() }));
    system.start(&scene, 0).expect("the memory is made for the scene");
    let mut frame = 0;
    let step = || {
        frame += 1;
        let begun = Instant::now();
        system.step_to(&scene, Time::frame(frame, 60));
        (begun.elapsed(), system.particles().position.to_vec())
    };
    let ours = Cloth { name: "pointmass".into(), step: Box::new(step) };
    measure(case, [ours].into_iter().chain(other).collect());
    println!("{:?}", system.totals());
    println!("{:016x}", system.hash());
}

#[cfg(feature = "rapier")]
fn rapier(case: &Case, who: &str) -> Option<Cloth<'static>> {
    use pointmass_peers::rapier_cloth;
    let mut numbers = who.split(',').map(str::parse::<f32>);
    let mut next = |usual: f32| numbers.next().and_then(Result::ok).unwrap_or(usual);
    let (iterations, frequency) = (next(4.0) as usize, next(30.0));
    let cell = 1.0 / case.cells as f32;
    let mut sheet = rapier_cloth::Sheet::new(&rapier_cloth::Cloth {
        corner: case.corner().to_array(),
        // A row goes along its second side.
        cells: [[0.0, 0.0, cell], [cell, 0.0, 0.0]],
        side: case.cells as usize + 1,
        mass: MASS,
        thickness: THICKNESS,
        hangs: case.hangs,
        touches_itself: case.touches && !who.ends_with("off"),
        iterations,
        frequency,
        ball: (BALL.center.to_array(), BALL.radius),
    });
    let step = move || {
        let begun = Instant::now();
        sheet.step();
        (begun.elapsed(), sheet.places().into_iter().map(Vec3::from).collect())
    };
    Some(Cloth { name: format!("rapier3d, {iterations} iterations, {frequency} Hz"), step: Box::new(step) })
}

#[cfg(not(feature = "rapier"))]
fn rapier(_: &Case, _: &str) -> Option<Cloth<'static>> {
    eprintln!("built without the feature rapier");
    None
}

/// Goes through all frames with one after the other in turns, and prints what came of it, and what the first takes to what the second takes.
fn measure(case: &Case, cloths: Vec<Cloth<'_>>) {
    let mut all: Vec<_> = cloths.into_iter().map(|cloth| (cloth, Duration::ZERO, 0.0f32, 0.0)).collect();
    for frame in 0..case.frames {
        for (cloth, time, worst, lowest) in &mut all {
            let (took, places) = (cloth.step)();
            *time += took;
            if 2 * frame >= case.frames {
                *worst = worst.max(strain(&places, case.cells as usize + 1));
            }
            *lowest = places.iter().map(|x| x.y).fold(f32::INFINITY, f32::min);
        }
    }
    for (Cloth { name, .. }, time, worst, lowest) in &all {
        println!(
            "{name}: {:.3} ms a frame, strain {:.2} % at the most, lowest at {lowest:.4} m",
            time.as_secs_f64() * 1e3 / f64::from(case.frames.max(1)),
            100.0 * worst
        );
    }
    if let [(_, ours, ..), (_, other, ..)] = &all[..] {
        println!("{:.2} of its time", ours.as_secs_f64() / other.as_secs_f64());
    }
}

/// The largest strain of an edge along warp or weft.
fn strain(places: &[Vec3], side: usize) -> f32 {
    let rest = 1.0 / (side - 1) as f32;
    let edges = (0..places.len()).flat_map(|i| {
        let right = (i % side + 1 < side).then_some(i + 1);
        let down = (i + side < places.len()).then_some(i + side);
        [right, down].into_iter().flatten().map(move |j| (i, j))
    });
    edges.map(|(i, j)| (places[i] - places[j]).length() / rest - 1.0).fold(0.0, f32::max)
}
