//! The hashes that every target must produce: `tests/hashes.txt`, lines `name hash`, comments after `#`.

/// All names and hashes, in the file's order.
pub(crate) fn all() -> impl Iterator<Item = (&'static str, u64)> {
    include_str!("../../hashes.txt").lines().filter_map(|line| {
        let line = line.split('#').next()?;
        let mut words = line.split_ascii_whitespace();
        let name = words.next()?;
        let hash = words.next().and_then(|word| u64::from_str_radix(word, 16).ok());
        Some((name, hash.expect("tests/hashes.txt: a name without a hash")))
    })
}

/// The hash expected under this name.
pub(crate) fn hash(name: &str) -> Option<u64> {
    all().find(|(listed, _)| *listed == name).map(|(_, hash)| hash)
}
