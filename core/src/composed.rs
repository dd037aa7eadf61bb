//! Traits that are closed under composition: slices, arrays, lists, options and tuples of X are X, and so is what stands for one.

/// Does something with each part: of a list one after the other, of a tuple each by its own type, so that nothing is asked through a table and
/// parts cost nothing that leave a function as it is.
macro_rules! each {
    ($all:expr, [], $part:ident => $do:block) => {
        for $part in $all $do
    };
    ($all:expr, [$($name:ident)+], $part:ident => $do:block) => {
        #[allow(non_snake_case)]
        let ($($name,)+) = $all;
        $({
            let $part = $name;
            $do
        })+
    };
}

/// Makes whatever stands for one of a trait's kinds one of it: a reference, and on the heap a box. What they do has to be said by `**self`.
macro_rules! stands_for {
    ($kind:ident { $($does:tt)* }) => {
        impl<T: $kind + ?Sized> $kind for &T { $($does)* }

        #[cfg(feature = "alloc")]
        impl<T: $kind + ?Sized> $kind for alloc::boxed::Box<T> { $($does)* }
    };
}

/// Makes lists, options and tuples of a trait's kinds kinds of it. `$parts!(parts)` has to expand to the trait's functions for a `self` that is made
/// of what `each!(self, parts, part => { .. })` goes over.
macro_rules! composed {
    ($kind:ident by $parts:ident) => {
        impl<T: $kind> $kind for [T] {
            $parts!([]);
        }

        impl<T: $kind, const N: usize> $kind for [T; N] {
            $parts!([]);
        }

        impl<T: $kind, const N: usize> $kind for heapless::Vec<T, N> {
            $parts!([]);
        }

        #[cfg(feature = "alloc")]
        impl<T: $kind> $kind for alloc::vec::Vec<T> {
            $parts!([]);
        }

        #[allow(for_loops_over_fallibles, reason = "an option is a list of one or of none")]
        impl<T: $kind> $kind for Option<T> {
            $parts!([]);
        }

        composed!($kind by $parts, A);
        composed!($kind by $parts, A B);
        composed!($kind by $parts, A B C);
        composed!($kind by $parts, A B C D);
        composed!($kind by $parts, A B C D E);
        composed!($kind by $parts, A B C D E F);
    };
    ($kind:ident by $parts:ident, $($name:ident)+) => {
        impl<$($name: $kind),+> $kind for ($($name,)+) {
            $parts!([$($name)+]);
        }
    };
}

pub(crate) use {composed, each, stands_for};
