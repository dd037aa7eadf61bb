//! Compiles nanoflann behind a few C functions where its header is installed (Debian: libnanoflann-dev).

use std::path::Path;

fn main() {
    println!("cargo::rustc-check-cfg=cfg(nanoflann)");
    println!("cargo::rerun-if-changed=src/nanoflann.cpp");
    let header = Path::new("/usr/include/nanoflann.hpp");
    println!("cargo::rerun-if-changed={}", header.display());
    if !header.exists() {
        return;
    }
    let mut build = cc::Build::new();
    build.cpp(true).std("c++17").file("src/nanoflann.cpp").opt_level(3).define("NDEBUG", None);
    // Without a C++ compiler there is one rival less, which is no reason to fail or to warn.
    if build.warnings(false).cargo_warnings(false).try_compile("pointmass_nanoflann").is_ok() {
        println!("cargo::rustc-cfg=nanoflann");
    }
}
