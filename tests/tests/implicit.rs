//! Implicit Euler: stiff cloth at sixty steps a second.

use pointmass::{Gravity, Heap, Implicit, Particle, Scene, Sheet, Spring, System, Thread, Threads, Time, Vec3};

/// A square of 1 m and 0.2 kg that hangs by two corners.
fn cloth(cells: u32, ks: f32, kd: f32) -> (Vec<Particle>, Vec<Spring>) {
    let thread = Some(Thread { ks, kd });
    let threads = Threads { structural: thread, shear: thread, bend: Some(Thread { ks: 0.01 * ks, kd: 0.01 * kd }) };
    let sheet = Sheet { corner: Vec3::ZERO, sides: [Vec3::X, Vec3::Z], cells: [cells; 2] };
    let mass = 4.0 / ((cells + 1) * (cells + 1)) as f32;
    let mut particles: Vec<_> = sheet.particles(Particle { mass, drag: 0.1 * mass, ..Particle::REST }).collect();
    for corner in [0, cells] {
        particles[corner as usize].fixed = true;
    }
    (particles, sheet.springs(&threads, 0).collect())
}

#[test]
fn stiff_cloth_stays_finite_and_settles() {
    let (start, springs) = cloth(63, 1e6, 10.0);
    for iterations in [100] {
        let integrator = Implicit { iterations, ..Implicit::USUAL };
        let scene = Scene {
            start: &start,
            springs: &springs,
            forces: &(Gravity::EARTH, pointmass::Drag {}),
            integrator: &integrator,
            ..Scene::EMPTY
        };
        let mut system = System::with(Heap::new(scene.size()));
        system.start(&scene, 1).expect("it fits");
        let begun = std::time::Instant::now();
        for i in 1..=600 {
            system.step(&scene, Time::frame(i, 60) - system.time());
            if i % 300 == 0 {
                let p = system.particles();
                let v = p.velocity.iter().map(|v| v.length()).fold(0.0, f32::max);
                let low = p.position.iter().map(|x| x.y).fold(0.0, f32::min);
                println!(
                    "{iterations} {i}: {} v {v} low {low} {:?} {:?}",
                    system.len(),
                    system.totals().effort,
                    begun.elapsed()
                );
            }
        }
    }
}
