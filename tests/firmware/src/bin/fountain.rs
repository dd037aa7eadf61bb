//! A fountain over the ground and nothing else: what a small chip pays for it. Exits with 0 if all is right.

#![no_std]
#![no_main]

// Linked for its critical section.
#[cfg(target_arch = "arm")]
use cortex_m as _;

#[path = "../jet.rs"]
mod jet;

use semihosting::process;
use static_cell::ConstStaticCell;

/// Fresh memory is all zeros: it lies in .bss and costs no flash.
static MEMORY: ConstStaticCell<jet::Memory> = ConstStaticCell::new(jet::Memory::new());

#[cfg_attr(target_arch = "arm", cortex_m_rt::entry)]
#[cfg_attr(target_arch = "riscv32", riscv_rt::entry)]
fn main() -> ! {
    process::exit(i32::from(jet::run(MEMORY.take()).is_err()))
}

#[panic_handler]
fn stop(_: &core::panic::PanicInfo<'_>) -> ! {
    process::exit(101)
}
