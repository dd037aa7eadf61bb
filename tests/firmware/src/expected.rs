//! The hashes that every target must produce, from `tests/*.txt`: lines `name hash`, comments after `#`.

/// All names and hashes of a file, in its order.
pub(crate) fn all(text: &'static str) -> impl Iterator<Item = (&'static str, u64)> {
    text.lines().filter_map(|line| {
        let line = line.split('#').next()?;
        let mut words = line.split_ascii_whitespace();
        let name = words.next()?;
        let hash = words.next().and_then(|word| u64::from_str_radix(word, 16).ok());
        Some((name, hash.expect("a name without a hash")))
    })
}

/// The hash expected under this name.
pub(crate) fn hash(text: &'static str, name: &str) -> Option<u64> {
    all(text).find(|(listed, _)| *listed == name).map(|(_, hash)| hash)
}
