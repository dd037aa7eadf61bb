//! Runs the hash scenes on a microcontroller, or in WebAssembly, and compares them with `tests/hashes.txt`; with the feature `roomy`, for what
//! has the memory, the indices, the methods of motion, the responses of balls and what holds together as well, with `tests/indices.txt`,
//! `tests/motion.txt`, `tests/contacts.txt` and `tests/bonds.txt`.
//!
//! Prints a line `name hash` each over semihosting, or by the functions that `page.mjs` lends, in the format of those files, and
//! exits with 0 if all are as expected, else with 1.

#![no_std]
#![no_main]

// Linked for its critical section.
#[cfg(target_arch = "arm")]
use cortex_m as _;

#[cfg(feature = "roomy")]
mod bonds;
#[cfg(feature = "roomy")]
mod cloth;
#[cfg(feature = "roomy")]
mod contacts;
#[cfg(feature = "roomy")]
mod drawing;
mod expected;
#[cfg(feature = "roomy")]
mod hulls;
#[cfg(feature = "roomy")]
mod indices;
#[cfg(feature = "roomy")]
mod motion;
#[cfg(target_arch = "wasm32")]
mod page;
mod scenes;
#[cfg(feature = "roomy")]
mod sheets;

#[cfg(target_arch = "wasm32")]
use page::{println, process};
#[cfg(not(target_arch = "wasm32"))]
use semihosting::{println, process};
use static_cell::ConstStaticCell;

/// Fresh memory is all zeros: it lies in .bss and costs no flash.
static SCENES: ConstStaticCell<scenes::Memory> = ConstStaticCell::new(scenes::Memory::new());
#[cfg(feature = "roomy")]
static INDICES: ConstStaticCell<indices::Memory> = ConstStaticCell::new(indices::Memory::new());
#[cfg(feature = "roomy")]
static BONDS: ConstStaticCell<bonds::Memory> = ConstStaticCell::new(bonds::Memory::new());
#[cfg(feature = "roomy")]
static CONTACTS: ConstStaticCell<contacts::Memory> = ConstStaticCell::new(contacts::Memory::new());
#[cfg(feature = "roomy")]
static MOTION: ConstStaticCell<motion::Memory> = ConstStaticCell::new(motion::Memory::new());

#[cfg_attr(target_arch = "arm", cortex_m_rt::entry)]
#[cfg_attr(target_arch = "riscv32", riscv_rt::entry)]
#[cfg_attr(target_arch = "wasm32", unsafe(export_name = "main"))]
fn main() -> ! {
    #[allow(unused_mut)]
    let mut right = as_expected(scenes::EXPECTED, |out| scenes::run(SCENES.take(), out));
    #[cfg(feature = "roomy")]
    {
        right &= as_expected(indices::EXPECTED, |out| indices::run(INDICES.take(), out));
        right &= as_expected(contacts::EXPECTED, |out| contacts::run(CONTACTS.take(), out));
        right &= as_expected(bonds::EXPECTED, |out| bonds::run(BONDS.take(), out));
        right &= as_expected(motion::EXPECTED, |out| motion::run(MOTION.take(), out));
    }
    process::exit(i32::from(!right))
}

/// Runs a suite, prints its hashes, and says whether they are those of the list, all of them.
fn as_expected(list: &'static str, run: impl FnOnce(&mut dyn FnMut(&str, u64))) -> bool {
    let (mut seen, mut wrong) = (0, 0);
    run(&mut |name, hash| {
        println!("{name} {hash:016x}");
        seen += 1;
        match expected::hash(list, name) {
            Some(want) if want == hash => {}
            Some(want) => {
                println!("# {name}: expected {want:016x}");
                wrong += 1;
            }
            None => {
                println!("# {name}: not expected");
                wrong += 1;
            }
        }
    });
    let listed = expected::all(list).count();
    if seen != listed {
        println!("# {seen} ran, {listed} are expected");
    }
    wrong == 0 && seen == listed
}

#[panic_handler]
fn stop(panic: &core::panic::PanicInfo<'_>) -> ! {
    println!("{panic}");
    process::exit(101)
}
