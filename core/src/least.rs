//! Lists that keep the least of all that come, in whatever order these do.

/// Takes one into a list of which so many places are taken; into a full one for the greatest, if that is greater. Tells whether one of them is left out.
///
/// A full list is a heap, the greatest first: each costs the logarithm of its length.
pub(crate) fn put<T: Copy>(list: &mut [T], len: &mut usize, one: T, is_less: impl Fn(&T, &T) -> bool) -> bool {
    if let Some(place) = list.get_mut(*len) {
        (*place, *len) = (one, *len + 1);
        if *len == list.len() {
            (0..*len / 2).rev().for_each(|from| sink(list, from, &is_less));
        }
        return false;
    }
    if list.first().is_some_and(|greatest| is_less(&one, greatest)) {
        list[0] = one;
        sink(list, 0, &is_less);
    }
    true
}

/// Lets one sink below those that are greater.
fn sink<T>(heap: &mut [T], mut from: usize, is_less: &impl Fn(&T, &T) -> bool) {
    loop {
        let mut greatest = from;
        for child in [2 * from + 1, 2 * from + 2] {
            if heap.get(child).is_some_and(|child| is_less(&heap[greatest], child)) {
                greatest = child;
            }
        }
        if greatest == from {
            return;
        }
        heap.swap(from, greatest);
        from = greatest;
    }
}

#[cfg(test)]
mod tests {
    use super::put;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn the_least_are_kept(all in proptest::collection::vec(0u8..50, 0..60), room in 0usize..20) {
            let (mut list, mut len, mut left_out) = ([0; 20], 0, 0);
            for &one in &all {
                left_out += usize::from(put(&mut list[..room], &mut len, one, |a, b| a < b));
            }
            let mut sorted = all.clone();
            sorted.sort_unstable();
            list[..len].sort_unstable();
            prop_assert_eq!(&list[..len], &sorted[..room.min(all.len())]);
            prop_assert_eq!(left_out, all.len().saturating_sub(room));
        }
    }
}
