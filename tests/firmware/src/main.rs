//! Runs the hash scenes on a microcontroller and compares them with `tests/hashes.txt`.
//!
//! Prints a line `name hash` per scene over semihosting, in the format of that file, and exits with 0
//! if all are as expected, else with 1.

#![no_std]
#![no_main]

// Linked for its critical section.
#[cfg(target_arch = "arm")]
use cortex_m as _;

mod expected;
mod scenes;

use semihosting::{println, process};
use static_cell::ConstStaticCell;

/// Fresh memory is all zeros: it lies in .bss and costs no flash.
static MEMORY: ConstStaticCell<scenes::Memory> = ConstStaticCell::new(scenes::Memory::new());

#[cfg_attr(target_arch = "arm", cortex_m_rt::entry)]
#[cfg_attr(target_arch = "riscv32", riscv_rt::entry)]
fn main() -> ! {
    let (mut seen, mut wrong) = (0, 0);
    scenes::run(MEMORY.take(), &mut |name, hash| {
        println!("{name} {hash:016x}");
        seen += 1;
        match expected::hash(name) {
            Some(want) if want == hash => {}
            Some(want) => {
                println!("# {name}: expected {want:016x}");
                wrong += 1;
            }
            None => {
                println!("# {name}: not in tests/hashes.txt");
                wrong += 1;
            }
        }
    });
    let listed = expected::all().count();
    if seen != listed {
        println!("# {seen} scenes ran, tests/hashes.txt lists {listed}");
    }
    process::exit(i32::from(wrong > 0 || seen != listed))
}
