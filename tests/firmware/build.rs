//! Puts the board's memory map where the runtime crates' linker script finds it.

use std::{env, fs, path::Path};

fn main() {
    let target = env::var("TARGET").expect("cargo sets TARGET");
    if target.starts_with("wasm32") {
        // No board: memory is what one asks for.
        return;
    }
    let (board, scripts): (_, &[&str]) = match target.as_str() {
        "thumbv7em-none-eabihf" => ("mps2-an386", &["link.x"]),
        "thumbv6m-none-eabi" => ("microbit", &["link.x"]),
        // riscv-rt's script does not include the memory map by itself.
        "riscv32imac-unknown-none-elf" => ("virt", &["memory.x", "link.x"]),
        other => panic!("no board for {other}: see tests/firmware/build.rs"),
    };

    let source = format!("memory/{board}.x");
    let out = env::var("OUT_DIR").expect("cargo sets OUT_DIR");
    fs::copy(&source, Path::new(&out).join("memory.x")).expect("memory map");
    println!("cargo::rerun-if-changed={source}");
    println!("cargo::rustc-link-search={out}");
    for script in scripts {
        println!("cargo::rustc-link-arg-bins=-T{script}");
    }
    // Without page alignment, which would waste most of a small flash.
    println!("cargo::rustc-link-arg-bins=--nmagic");
}
