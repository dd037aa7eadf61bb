//! The lecture's fountain on a host: a jet of drops under gravity and drag, which bounce off the ground and die.
//!
//! `cargo run --release -p pointmass --example std_fountain`

use pointmass::shape::{Disc, Mesh, Plane, Shape};
use pointmass::{Drag, Emitter, Gravity, Heap, Scene, Spread, System, Time, Varied, Vec3};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let nozzle = Shape::<Mesh>::Circle(Disc { center: Vec3::Y * 0.1, normal: Vec3::Y, radius: 0.05 });
    let jet = Emitter {
        speed: Varied { mean: 6.0, half_width: 0.5 },
        spread: Spread::Uniform(0.2),
        drag: Varied::exactly(0.1),
        lifetime: Varied { mean: 2.5, half_width: 0.5 },
        ..Emitter::new(nozzle, 400.0)
    };
    let ground = Plane { point: Vec3::ZERO, normal: Vec3::Y };
    let scene = Scene { emitters: &jet, forces: &(Gravity::EARTH, Drag {}), colliders: &ground, ..Scene::EMPTY };
    // Room for as many as can live at once; nothing is asked for after this.
    let mut system = System::with(Heap::try_new(pointmass::Size { particles: 1300, ..scene.size() })?);
    system.start(&scene, 7)?;
    for frame in 1..=300 {
        system.step_to(&scene, Time::frame(frame, 60));
        if frame % 60 == 0 {
            let highest = system.particles().position.iter().map(|x| x.y).fold(0.0, f32::max);
            println!("{:.0} s: {} drops, the highest at {highest:.2} m", system.time().seconds_f64(), system.len());
        }
    }
    println!("{} bounces, hash {:016x}", system.totals().hits, system.hash());
    Ok(())
}
