//! Says where numbers go one by one, and where they go side by side in registers.

use std::env::{VarError, var};

fn main() -> Result<(), VarError> {
    // A chip without an operating system has no such registers, and no flash for what is written twice. Without any optimisation, what is spread
    // over its callers keeps every number that it ever had in a place of its own, which takes time and, of a thread's stack, megabytes: under
    // `--cfg abreast` it does all the same.
    let (chip, unoptimised) = (var("CARGO_CFG_TARGET_OS")? == "none", var("OPT_LEVEL")? == "0");
    let asked = |cfg: &str| var(cfg).is_ok();
    println!("cargo::rerun-if-changed=build.rs");
    println!("cargo::rustc-check-cfg=cfg(one_by_one)");
    println!("cargo::rustc-check-cfg=cfg(widest_found)");
    // The standard library finds out which registers there are when a program runs. Under `--cfg narrow` those do that the target has for sure.
    let finds = var("CARGO_CFG_TARGET_ARCH")? == "x86_64" && asked("CARGO_FEATURE_STD");
    if chip || (unoptimised && !asked("CARGO_CFG_ABREAST")) {
        println!("cargo::rustc-cfg=one_by_one");
    } else if finds && !asked("CARGO_CFG_NARROW") {
        println!("cargo::rustc-cfg=widest_found");
    }
    Ok(())
}
