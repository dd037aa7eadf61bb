//! Kinds of things that files and the command line call by a name.

/// Lets a kind with `ALL` and `name` be written and read by that name; `$unknown` is the error for a name that none has.
macro_rules! by_name {
    ($kind:ident, $unknown:ident, $noun:literal) => {
        impl core::fmt::Display for $kind {
            fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
                f.write_str(self.name())
            }
        }

        #[doc = concat!("There is no ", $noun, " of that name.")]
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        pub struct $unknown;

        impl core::fmt::Display for $unknown {
            fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
                f.write_str(concat!("unknown ", $noun, "; there are"))?;
                $kind::ALL.iter().try_for_each(|kind| write!(f, " {kind}"))
            }
        }

        impl core::error::Error for $unknown {}

        impl core::str::FromStr for $kind {
            type Err = $unknown;
            fn from_str(name: &str) -> Result<Self, $unknown> {
                Self::ALL.iter().copied().find(|kind| kind.name() == name).ok_or($unknown)
            }
        }
    };
}

pub(crate) use by_name;
