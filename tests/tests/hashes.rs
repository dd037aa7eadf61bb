//! The scenes that the firmware runs, on the host: the same hashes on every target.

#[path = "../firmware/src/expected.rs"]
mod expected;
#[path = "../firmware/src/scenes.rs"]
mod scenes;

#[test]
fn every_scene_has_its_hash() {
    let mut lines = Vec::new();
    scenes::run(&mut scenes::Memory::new(), &mut |name, hash| lines.push((name.to_owned(), hash)));
    for (name, hash) in &lines {
        println!("{name} {hash:016x}");
    }
    for (name, hash) in &lines {
        let want = expected::hash(name).unwrap_or_else(|| panic!("{name} is not in tests/hashes.txt"));
        assert_eq!(*hash, want, "{name}: {hash:016x}, expected {want:016x}");
    }
    assert_eq!(lines.len(), expected::all().count(), "tests/hashes.txt lists others too");
}
