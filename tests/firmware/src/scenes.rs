//! What every target computes: the firmware here, the host in `tests/tests/hashes.rs`.
//!
//! Ten seconds of the hash scenes at 60 steps a second by rk4, in static memory, from the very files that the command
//! line and the npm package run.

use pointmass::scene::InlineScene;
use pointmass::{Inline, Method, Slices, Storage, System, Time};

/// Room for the largest of the scenes, and for no more than 64 particles, so that `overflow` overflows.
pub(crate) type Memory = Inline<64, 4, 20, 5>;

const SCENES: [(&str, &str); 3] = [
    ("overflow", include_str!("../../../scenes/overflow.scn")),
    ("rope", include_str!("../../../scenes/rope.scn")),
    ("orbit", include_str!("../../../scenes/orbit.scn")),
];

/// Calls `out` with the name and the hash of each scene.
pub(crate) fn run(memory: &mut Memory, out: &mut dyn FnMut(&str, u64)) {
    for (name, text) in SCENES {
        let Ok(scene) = InlineScene::<21, 20, 5>::read(text, Method::Rk4) else {
            out(name, 0);
            continue;
        };
        let scene = scene.scene();
        let mut system: System<Slices<'_>> = System::with(memory.slices());
        if system.start(&scene, 1).is_ok() {
            for frame in 1..=600 {
                system.step(&scene, Time::frame(frame, 60) - system.time());
            }
        }
        out(name, system.hash());
    }
}
