//! The programs that the firmware runs, on the host: the same hashes on every target.

#[path = "../firmware/src/bonds.rs"]
mod bonds;
#[path = "../firmware/src/cloth.rs"]
mod cloth;
#[path = "../firmware/src/contacts.rs"]
mod contacts;
#[path = "../firmware/src/drawing.rs"]
mod drawing;
#[path = "../firmware/src/expected.rs"]
mod expected;
#[path = "../firmware/src/hulls.rs"]
mod hulls;
#[path = "../firmware/src/indices.rs"]
mod indices;
#[path = "../firmware/src/motion.rs"]
mod motion;
#[path = "../firmware/src/scenes.rs"]
mod scenes;
#[path = "../firmware/src/sheets.rs"]
mod sheets;

use pointmass::constrain::{HullBuf, HullEdge};

#[test]
fn every_scene_has_its_hash() {
    as_expected("tests/hashes.txt", scenes::EXPECTED, |out| scenes::run(&mut scenes::Memory::new(), out));
}

#[test]
fn every_index_has_its_hash() {
    as_expected("tests/indices.txt", indices::EXPECTED, |out| indices::run(&mut indices::Memory::new(), out));
}

#[test]
fn every_method_has_its_hash() {
    as_expected("tests/motion.txt", motion::EXPECTED, |out| motion::run(&mut motion::Memory::new(), out));
}

#[test]
fn every_response_has_its_hash() {
    as_expected("tests/contacts.txt", contacts::EXPECTED, |out| contacts::run(&mut contacts::Memory::new(), out));
}

#[test]
fn every_bond_has_its_hash() {
    as_expected("tests/bonds.txt", bonds::EXPECTED, |out| bonds::run(&mut bonds::Memory::new(), out));
}

/// What the chips are given is what a host makes of the corners.
#[test]
fn hulls_of_the_firmware_are_whole() {
    for hull in [hulls::WEDGE, hulls::SPINDLE] {
        assert_eq!(hull.fault(), None);
        assert!(hull.centroid().length() < 1e-6);
        let made = HullBuf::of(hull.corners).expect("they have a hull");
        let (own, made) = (hull.volume(), made.lend().volume());
        assert!((own - made).abs() < 1e-5 * made, "{own} {made}");
        for HullEdge { ends: [a, b], faces: [left, right] } in hull.edges {
            // Each face runs with its left edges, against its right ones.
            for (number, side) in [(left, [a, b]), (right, [b, a])] {
                let face = &hull.faces[usize::from(*number)];
                let around = &hull.loops[usize::from(face.first)..][..usize::from(face.count)];
                let runs = around.iter().zip(around.iter().cycle().skip(1));
                assert!(runs.into_iter().any(|(from, to)| [from, to] == side), "{side:?} {around:?}");
            }
        }
    }
}

fn as_expected(file: &str, list: &'static str, run: impl FnOnce(&mut dyn FnMut(&str, u64))) {
    let mut lines = Vec::new();
    run(&mut |name, hash| lines.push((name.to_owned(), hash)));
    for (name, hash) in &lines {
        println!("{name} {hash:016x}");
    }
    for (name, hash) in &lines {
        let want = expected::hash(list, name).unwrap_or_else(|| panic!("{name} is not in {file}"));
        assert_eq!(*hash, want, "{name}: {hash:016x}, expected {want:016x}");
    }
    assert_eq!(lines.len(), expected::all(list).count(), "{file} lists others too");
}
