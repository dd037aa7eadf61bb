//! Compiles nanoflann behind a few C functions where its header is installed (Debian: libnanoflann-dev).

use std::path::Path;

fn main() {
    println!("cargo::rustc-check-cfg=cfg(nanoflann)");
    println!("cargo::rerun-if-changed=src/nanoflann.cpp");
    let header = Path::new("/usr/include/nanoflann.hpp");
    if !header.exists() {
        // A package keeps its files' old dates: only the folder tells that it was installed meanwhile.
        if let Some(folder) = header.parent().filter(|folder| folder.exists()) {
            println!("cargo::rerun-if-changed={}", folder.display());
        }
        return;
    }
    println!("cargo::rerun-if-changed={}", header.display());
    let mut build = cc::Build::new();
    build.cpp(true).std("c++17").file("src/nanoflann.cpp").opt_level(3).define("NDEBUG", None);
    // Without a C++ compiler there is one rival less, which is no reason to fail or to warn.
    if build.warnings(false).cargo_warnings(false).try_compile("pointmass_nanoflann").is_ok() {
        println!("cargo::rustc-cfg=nanoflann");
    }
}
