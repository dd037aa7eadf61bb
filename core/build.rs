//! Says where numbers go one by one, and where they go side by side in registers.

use std::env::{VarError, var};

fn main() -> Result<(), VarError> {
    // A chip without an operating system has no such registers, and no flash for what is written twice. Without any optimisation, what is spread
    // over its callers keeps every number that it ever had in a place of its own: megabytes of a stack.
    let (chip, unoptimised) = (var("CARGO_CFG_TARGET_OS")? == "none", var("OPT_LEVEL")? == "0");
    println!("cargo::rerun-if-changed=build.rs");
    println!("cargo::rustc-check-cfg=cfg(one_by_one)");
    if chip || unoptimised {
        println!("cargo::rustc-cfg=one_by_one");
    }
    Ok(())
}
