//! Says where numbers go one by one, and where they go side by side in registers.

use std::env::{VarError, var};

fn main() -> Result<(), VarError> {
    // A chip without an operating system has no such registers, and no flash for what is written twice. Without any optimisation, what is spread
    // over its callers keeps every number that it ever had in a place of its own: megabytes of a stack.
    let (chip, unoptimised) = (var("CARGO_CFG_TARGET_OS")? == "none", var("OPT_LEVEL")? == "0");
    println!("cargo::rerun-if-changed=build.rs");
    println!("cargo::rustc-check-cfg=cfg(one_by_one)");
    println!("cargo::rustc-check-cfg=cfg(widest_found)");
    // The standard library finds out which registers there are when a program runs. Under `--cfg narrow` those do that the target has for sure.
    let finds = var("CARGO_CFG_TARGET_ARCH")? == "x86_64" && var("CARGO_FEATURE_STD").is_ok();
    if chip || unoptimised {
        println!("cargo::rustc-cfg=one_by_one");
    } else if finds && var("CARGO_CFG_NARROW").is_err() {
        println!("cargo::rustc-cfg=widest_found");
    }
    Ok(())
}
