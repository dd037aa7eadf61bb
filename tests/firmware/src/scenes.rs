//! What every target computes: the firmware here, the host in `tests/tests/hashes.rs`.

/// Calls `out` with the name and the hash of each scene.
pub(crate) fn run(out: &mut dyn FnMut(&str, u64)) {
    out("fnv", fnv1a(b"pointmass"));
}

/// FNV-1a, 64 bits: <https://datatracker.ietf.org/doc/html/draft-eastlake-fnv>.
fn fnv1a(bytes: &[u8]) -> u64 {
    bytes.iter().fold(0xcbf2_9ce4_8422_2325, |hash, &byte| (hash ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01b3))
}
