//! Scenes that every target computes alike: the firmware here, the host in `tests/tests/hashes.rs`.
//!
//! Ten seconds of the hash scenes at 60 steps a second by rk4, in static memory, from the very files that the command
//! line and the npm package run.

use pointmass::scene::InlineScene;
use pointmass::{Inline, System, Time};

/// Everything that the scenes need, none of it on the stack: a microbit has 16 KiB in all.
pub(crate) struct Memory {
    scene: InlineScene<21, 20, 4>,
    /// Room for no more than 40 particles, so that `overflow` overflows.
    system: Inline<40, 4, 20, 5>,
}

impl Memory {
    pub(crate) const fn new() -> Self {
        Self { scene: InlineScene::new(), system: Inline::new() }
    }
}

/// The hashes in the form of `all` in `expected.rs`.
pub(crate) const EXPECTED: &str = include_str!("../../hashes.txt");

const SCENES: [(&str, &str); 3] = [
    ("overflow", include_str!("../../../scenes/overflow.scn")),
    ("rope", include_str!("../../../scenes/rope.scn")),
    ("orbit", include_str!("../../../scenes/orbit.scn")),
];

/// Calls `out` with the name and the hash of each scene.
pub(crate) fn run(memory: &mut Memory, out: &mut dyn FnMut(&str, u64)) {
    for (name, text) in SCENES {
        let read = memory.scene.read(text);
        let scene = memory.scene.scene();
        let mut system = System::with(&mut memory.system);
        if read.is_ok() && system.start(&scene, 1).is_ok() {
            for frame in 1..=600 {
                system.step(&scene, Time::frame(frame, 60) - system.time());
            }
        }
        out(name, system.hash());
    }
}
