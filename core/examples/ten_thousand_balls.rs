//! Ten thousand balls that fall into a box and come to rest, kept apart by position: a scene file made in the program.
//!
//! `cargo run --release -p pointmass --example ten_thousand_balls -- 10000`

use pointmass::scene::{Model, SceneFile};
use pointmass::{Measures, Particle, Time, Vec3};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let count: u16 = std::env::args().nth(1).map_or(Ok(500), |count| count.parse())?;
    let text = r#"{
        "run": {"index": "grid"},
        "forces": [{"gravity": {"acceleration": [0, -9.80665, 0]}}],
        "contacts": {"position": {"substeps": 8}},
        "materials": [{"contact": {"friction": {"static": 0.5, "kinetic": 0.4}}}],
        "scenery": [{"shape": {"box": {"min": [0, 0, 0], "max": [1.3, 99, 1.3]}}, "material": 0}]
    }"#;
    let mut file = SceneFile::from_json("balls.json", text)?;
    file.particles.extend((0..count).map(|i| {
        let place = [i % 12, i / 144, i / 12 % 12].map(|n| 0.1 + 0.1 * f32::from(n));
        let beside = f32::from(i % 7) * 0.001;
        let position = Vec3::from_array(place) + Vec3::new(beside, 0.0, -beside);
        Particle { position, radius: 0.045, mass: 0.38, elasticity: 0.2, material: Some(0), ..Particle::REST }
    }));
    let model = Model::load(&file, "balls.json", &mut ())?;
    let (scene, mut system) = (model.scene(), model.system(count.into(), 1)?);
    for frame in 1..=120 {
        system.step_to(&scene, Time::frame(frame, 60));
    }
    let highest = system.particles().position.iter().map(|x| x.y).fold(0.0, f32::max);
    let kinetic = Measures::of(&system, &scene).energy.kinetic;
    println!("{count} balls, {highest:.2} m high, {kinetic:.3} J of motion left; hash {:016x}", system.hash());
    Ok(())
}
