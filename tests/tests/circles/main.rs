//! The core's files import each other in one direction: none is, through others, among those that it imports itself.
//!
//! An import is any path in code, `use` lines among them, that leads to another file; re-exports are followed to the file
//! that defines what is named. A `mod.rs` that re-exports what its children define does not import them by that, and what
//! is compiled for tests alone does not count.

mod modules;
mod paths;

use modules::{Imports, Modules};
use std::collections::{BTreeMap, BTreeSet};
use std::fmt;
use std::path::Path;

/// Files each of which imports, directly or through others of them, all others.
struct Circle(Imports);

impl fmt::Display for Circle {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        writeln!(f, "a circle of {}:", self.0.len())?;
        self.0.iter().try_for_each(|(file, to)| {
            writeln!(f, "  {file} -> {}", to.iter().map(String::as_str).collect::<Vec<_>>().join(", "))
        })
    }
}

/// All that is reached from `file`, which itself is part of it only if it lies in a circle.
fn reached<'a>(imports: &'a Imports, file: &'a str) -> BTreeSet<&'a str> {
    let mut found = BTreeSet::new();
    let mut open = vec![file];
    while let Some(next) = open.pop() {
        open.extend(imports[next].iter().map(String::as_str).filter(|to| found.insert(*to)));
    }
    found
}

fn circles(imports: &Imports) -> Vec<Circle> {
    let reach: BTreeMap<&str, _> = imports.keys().map(|f| (f.as_str(), reached(imports, f))).collect();
    let round = |file: &str| -> BTreeSet<&str> {
        reach[file].iter().copied().filter(|other| reach[other].contains(file)).collect()
    };
    let all: BTreeSet<_> = imports.keys().map(|f| round(f)).filter(|files| !files.is_empty()).collect();
    all.into_iter()
        .map(|files| {
            let within = |to: &BTreeSet<String>| to.iter().filter(|t| files.contains(t.as_str())).cloned().collect();
            Circle(files.iter().map(|f| (f.to_string(), within(&imports[*f]))).collect())
        })
        .collect()
}

/// The circles among sources.
fn found(read: impl Fn(&str) -> Option<String>) -> Vec<Circle> {
    let mut modules = Modules::default();
    modules.add(&[], &read);
    circles(&modules.imports())
}

#[test]
fn no_files_of_the_core_import_each_other() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../core/src");
    let circles = found(|file| std::fs::read_to_string(root.join(file)).ok());
    let told: String = circles.iter().map(Circle::to_string).collect();
    assert!(circles.is_empty(), "\n{told}");
}

/// The circles among made-up files, as text.
fn told(files: &[(&str, &str)]) -> String {
    let read = |name: &str| files.iter().find(|(file, _)| *file == name).map(|(_, text)| text.to_string());
    found(read).iter().map(Circle::to_string).collect()
}

#[test]
fn imports_in_one_direction_make_no_circle() {
    let files = [
        ("lib.rs", "mod a; mod b; pub use a::A; pub use b::B;"),
        ("a.rs", "use core::fmt; pub struct A(crate::B); impl fmt::Debug for A {}"),
        ("b.rs", "pub struct B { a: u32 }"),
    ];
    assert_eq!(told(&files), "");
}

#[test]
fn two_files_that_import_each_other_are_a_circle() {
    let files = [
        ("lib.rs", "mod a; mod b; mod c;"),
        ("a.rs", "use crate::b::B; pub struct A;"),
        ("b.rs", "use super::{a::A, c}; pub struct B;"),
        ("c.rs", "pub fn c() {}"),
    ];
    assert_eq!(told(&files), "a circle of 2:\n  a.rs -> b.rs\n  b.rs -> a.rs\n");
}

#[test]
fn circles_of_circles_are_one() {
    let files = [
        ("lib.rs", "mod a; mod b; mod c; mod d;"),
        ("a.rs", "use crate::b; pub fn a() {}"),
        ("b.rs", "use crate::a::a; use crate::c::c; pub fn b() {}"),
        ("c.rs", "use crate::b::b; pub fn c() {}"),
        ("d.rs", "use crate::a::a; pub fn d() {}"),
    ];
    assert_eq!(told(&files), "a circle of 3:\n  a.rs -> b.rs\n  b.rs -> a.rs, c.rs\n  c.rs -> b.rs\n");
}

#[test]
fn re_exports_are_followed() {
    let files = [
        ("lib.rs", "mod a; mod m; pub(crate) use m::Made as Renamed;"),
        ("a.rs", "use crate::Renamed; pub struct A;"),
        ("m/mod.rs", "mod made; mod other; pub(crate) use made::Made;"),
        ("m/made.rs", "use crate::a::A; pub struct Made;"),
        ("m/other.rs", "use super::Made;"),
    ];
    assert_eq!(told(&files), "a circle of 2:\n  a.rs -> m/made.rs\n  m/made.rs -> a.rs\n");
}

#[test]
fn what_a_macro_defines_is_its_callers() {
    let files = [
        ("lib.rs", "mod a; mod m; use core::fmt; pub use m::Made; use m::Made as Other;"),
        ("a.rs", "use crate::Other; pub struct A;"),
        ("m/mod.rs", "mod made; mod other; pub(crate) use made::Made; use super::fmt;"),
        ("m/made.rs", "use crate::a::A; define! { pub struct Made; }"),
        ("m/other.rs", "use super::Made; use super::fmt;"),
    ];
    assert_eq!(told(&files), "a circle of 2:\n  a.rs -> m/made.rs\n  m/made.rs -> a.rs\n");
}

#[test]
fn a_parent_that_uses_what_its_children_define_imports_them() {
    let child = ("m/child.rs", "use super::Of; pub struct Child;");
    let files = |parent| [("lib.rs", "mod m;"), ("m/mod.rs", parent), child];
    assert_eq!(told(&files("mod child; pub use child::Child; pub struct Of;")), "");
    let circle = "a circle of 2:\n  m/child.rs -> m/mod.rs\n  m/mod.rs -> m/child.rs\n";
    assert_eq!(told(&files("mod child; use child::Child; pub struct Of;")), circle);
    for of in ["struct Of(Child);", "struct Of; fn of(a: Of) { match a { Child => {}, _ => {} } }"] {
        let parent = format!("mod child; pub use child::Child; pub {of}");
        assert_eq!(told(&[("lib.rs", "mod m;"), ("m/mod.rs", &parent), child]), circle, "{of}");
    }
}

#[test]
fn a_name_that_a_function_binds_is_no_import() {
    let child = ("m/child.rs", "use super::Of; pub fn child() {}");
    let of = |parent: &str| told(&[("lib.rs", "mod m;"), ("m/mod.rs", parent), child]);
    for bound in [
        "fn a(child: u32) { child; }",
        "impl Of { fn a() { let (b, child) = (1, 2); |c| c + child; } }",
        "trait A { fn a(b: u32) { if let child @ 1 = b { child; } } }",
    ] {
        assert_eq!(of(&format!("mod child; pub use child::child; pub struct Of; {bound}")), "", "{bound}");
    }
    assert_ne!(of("mod child; pub use child::child; pub struct Of; fn a(b: u32) { child(); }"), "");
}

#[test]
fn paths_in_code_and_in_macros_are_imports() {
    let files = |body| [("lib.rs", "mod a; mod b;"), ("a.rs", body), ("b.rs", "use crate::a::a; pub struct B;")];
    for body in [
        "pub fn a() { let _ = super::b::B; }",
        "pub fn a(of: crate::b::B) {}",
        "pub fn a() { assert!(matches!(1, crate::b::B)); }",
        "macro_rules! b { ($x:ident) => { $crate::b::B } } pub fn a() {}",
        "use crate::b as other; pub fn a() { other::B; }",
    ] {
        assert_eq!(told(&files(body)), "a circle of 2:\n  a.rs -> b.rs\n  b.rs -> a.rs\n", "{body}");
    }
    assert_eq!(told(&files("pub(in crate) fn a() { let b = 1; b; }")), "");
}

#[test]
fn what_is_for_tests_alone_does_not_count() {
    let of = |a: &str| told(&[("lib.rs", "mod a; mod b;"), ("a.rs", a), ("b.rs", "use crate::a::a; pub fn b() {}")]);
    for test in [
        "#[cfg(test)] use crate::b::b; pub fn a() {}",
        "#[cfg(all(test, feature = \"alloc\"))] mod tests; pub fn a() {}",
        "#[cfg(test)] mod tests { use crate::b::b; } pub fn a() {}",
        "pub fn a() {} struct A; impl A { #[cfg(test)] fn b() { crate::b::b() } }",
    ] {
        assert_eq!(of(test), "", "{test}");
    }
    for both in ["any(test, feature = \"std\")", "not(test)", "feature = \"test\""] {
        assert_ne!(of(&format!("#[cfg({both})] use crate::b::b; pub fn a() {{}}")), "", "{both}");
    }
}
