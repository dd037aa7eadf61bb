//! Numbers side by side in memory: as many as go side by side at all.

use super::{ABREAST, Eight, LANES, Lanes, Vectors};

/// A number of each.
pub(crate) type Row = [f32; ABREAST];

/// Takes them into the first lanes of such registers as `like` is in.
#[inline(always)]
pub(crate) fn load<F: Eight>(like: F, row: &Row) -> F {
    let mut lanes = [0.0; LANES];
    lanes[..ABREAST].copy_from_slice(row);
    like.of(lanes)
}

/// The first lanes.
#[inline(always)]
pub(crate) fn saved<F: Eight>(lanes: F) -> Row {
    let (lanes, mut row) = (lanes.to_array(), [0.0; ABREAST]);
    row.copy_from_slice(&lanes[..ABREAST]);
    row
}

/// A mask of the lanes whose bits are set.
#[inline(always)]
pub(crate) fn mask_of<F: Lanes>(like: F, bits: u32) -> F {
    let [mask] = like.of_parts(
        #[inline(always)]
        |like, nth| {
            let (mut lanes, bits) = ([0.0; LANES], bits >> (LANES * nth));
            for (lane, x) in lanes.iter_mut().enumerate() {
                *x = f32::from_bits(0u32.wrapping_sub(bits >> lane & 1));
            }
            [like.of(lanes)]
        },
    );
    mask
}

impl<F: Eight> Vectors<F> {
    /// Takes vectors into the first lanes.
    #[inline(always)]
    pub(crate) fn load(like: F, [x, y, z]: &[Row; 3]) -> Self {
        Self([load(like, x), load(like, y), load(like, z)])
    }

    /// Those of the first lanes.
    #[inline(always)]
    pub(crate) fn saved(self) -> [Row; 3] {
        let [x, y, z] = self.0;
        [saved(x), saved(y), saved(z)]
    }
}
