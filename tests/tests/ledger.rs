//! The ledger closes: what is left over is the method's own error.

use pointmass::{Books, Heap, Ledger, Method, Scene, Size, System, Time};
use pointmass_tests::busy::{SIZE, busy};

/// The books after a second in steps of `h`.
fn books(scene: &Scene<'_>, particles: usize, h: f64) -> Books {
    let mut system = System::with(Heap::new(Size { particles, ..scene.size() }));
    system.start(scene, 1).expect("it fits");
    let mut ledger = Ledger::new(&system, scene);
    for i in 1..=(1.0 / h).round() as u32 {
        system.step_observed(scene, Time::from_seconds_f64(h * f64::from(i)) - system.time(), &mut ledger);
    }
    ledger.books().clone()
}

fn print(books: &Books) {
    println!("{books:?}");
}

#[test]
fn rk() {
    busy(|scene| {
        for h in [1.0 / 60.0, 1.0 / 120.0, 1.0 / 240.0] {
            for method in Method::ALL {
                let scene = Scene { integrator: method, ..*scene };
                println!("{method} {h}");
                print(&books(&scene, SIZE.particles, h));
            }
        }
    });
}
