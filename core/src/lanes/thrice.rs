//! Numbers three times each in WebAssembly: of such as have only been loaded compilers load each by itself, and put vectors together of them.

use wide::{f32x8, u8x16};

/// Where the bytes of the three vectors that come of four numbers are from.
const ORDERS: [[u8; 16]; 3] = [bytes_of([0, 0, 0, 1]), bytes_of([1, 1, 2, 2]), bytes_of([2, 3, 3, 3])];

/// Each three times, one after the other.
#[inline(always)]
pub(super) fn thrice(lanes: f32x8) -> [f32x8; 3] {
    let [low, high]: [u8x16; 2] = bytemuck::cast(lanes);
    let part = |half: u8x16, order: usize| half.shuffle_zeroing(u8x16::new(ORDERS[order]));
    [
        bytemuck::cast([part(low, 0), part(low, 1)]),
        bytemuck::cast([part(low, 2), part(high, 0)]),
        bytemuck::cast([part(high, 1), part(high, 2)]),
    ]
}

/// The bytes of four numbers in an order.
const fn bytes_of(order: [u8; 4]) -> [u8; 16] {
    let (mut bytes, mut i) = ([0; 16], 0);
    while i < 16 {
        bytes[i] = 4 * order[i / 4] + i as u8 % 4;
        i += 1;
    }
    bytes
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_comes_three_times() {
        let numbers = [1.0, -0.0, f32::INFINITY, 1e-40, 5.5, -6.0, 7.0, f32::MAX];
        let made = thrice(f32x8::new(numbers)).map(f32x8::to_array);
        for (i, number) in made.as_flattened().iter().enumerate() {
            assert_eq!(number.to_bits(), numbers[i / 3].to_bits(), "{i}");
        }
    }
}
