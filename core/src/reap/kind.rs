//! The reapers that a file can name.

use super::{Chance, Dense, Reaper, ReaperCode, Verdicts, same_as};
use crate::force::State;
use core::ops::Range;

/// Declares the reapers that have a name.
macro_rules! kinds {
    ($($(#[doc = $doc:literal])* $kind:ident = $name:literal, $reaper:ty;)+) => {
        /// A rule by which particles die, as files name it.
        #[derive(Clone, Debug, PartialEq)]
        #[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
        #[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
        pub enum ReaperKind {
            $($(#[doc = $doc])* #[cfg_attr(feature = "serde", serde(rename = $name))] $kind($reaper),)+
        }

        impl ReaperKind {
            /// The name that files give it.
            #[must_use]
            pub const fn kind(&self) -> &'static str {
                match self { $(Self::$kind(_) => $name,)+ }
            }

            /// The reaper itself.
            fn get(&self) -> &dyn Reaper {
                match self { $(Self::$kind(reaper) => reaper,)+ }
            }
        }
    };
}

kinds! {
    /// Death at random, as likely at any age.
    Chance = "chance", Chance;
    /// Death where too many are.
    Dense = "dense", Dense;
}

impl Reaper for ReaperKind {
    same_as!(this => this.get());
}
