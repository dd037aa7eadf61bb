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
#[path = "../firmware/src/indices.rs"]
mod indices;
#[path = "../firmware/src/motion.rs"]
mod motion;
#[path = "../firmware/src/scenes.rs"]
mod scenes;

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
