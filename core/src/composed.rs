//! Traits that are closed under composition: slices, arrays, lists and tuples of X are X.

/// Makes lists and tuples of a trait's kinds kinds of it. `$parts!(this => parts)` has to expand to the trait's functions for a `self`
/// that is made of `parts`, over which `for` goes.
macro_rules! composed {
    ($kind:ident by $parts:ident) => {
        impl<T: $kind> $kind for [T] {
            $parts!(this => this);
        }

        impl<T: $kind, const N: usize> $kind for [T; N] {
            $parts!(this => this);
        }

        impl<T: $kind, const N: usize> $kind for heapless::Vec<T, N> {
            $parts!(this => this);
        }

        #[cfg(feature = "alloc")]
        impl<T: $kind> $kind for alloc::vec::Vec<T> {
            $parts!(this => this);
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
            $parts!(this => {
                #[allow(non_snake_case)]
                let ($($name,)+) = this;
                [$($name as &dyn $kind),+]
            });
        }
    };
}

pub(crate) use composed;
