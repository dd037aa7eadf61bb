//! Which of eight lanes are hits.

use super::LANES;

/// For eight lanes, of which some are hits: the lanes of these, one behind the other.
pub(crate) static HITS: [[u32; LANES]; 256] = {
    let mut all = [[0; LANES]; 256];
    let mut hits = 0;
    while hits < all.len() {
        let (mut lane, mut len) = (0, 0);
        while lane < LANES {
            if hits >> lane & 1 == 1 {
                all[hits][len] = lane as u32;
                len += 1;
            }
            lane += 1;
        }
        hits += 1;
    }
    all
};

/// The number of hits among eight lanes, by their bits.
pub(crate) static COUNTS: [u8; 256] = {
    let mut all = [0; 256];
    let mut hits = 0;
    while hits < all.len() {
        all[hits] = hits.count_ones() as u8;
        hits += 1;
    }
    all
};
