//! Any of the flows.

use super::{Curl, Flow, Gusts, Uniform, Vortex};
use crate::time::Time;
use glam::Vec3;

/// Declares the flows that have a name: that of the kind, in small letters.
macro_rules! kinds {
    ($($(#[doc = $doc:literal])* $kind:ident($flow:ty);)+) => {
        /// A flow as files name it.
        #[derive(Clone, Copy, Debug, PartialEq)]
        #[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "snake_case"))]
        #[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
        pub enum FlowKind {
            $($(#[doc = $doc])* $kind($flow),)+
        }

        impl FlowKind {
            fn get(&self) -> &dyn Flow {
                match self { $(Self::$kind(flow) => flow,)+ }
            }
        }
    };
}

kinds! {
    /// The same everywhere and always.
    Uniform(Uniform);
    /// The same everywhere, and now stronger, now weaker.
    Gusts(Gusts);
    /// A whirl about an axis.
    Vortex(Vortex);
    /// Turbulence that neither gathers nor spreads.
    Curl(Curl);
}

impl Flow for FlowKind {
    fn velocity(&self, place: Vec3, time: Time) -> Vec3 {
        self.get().velocity(place, time)
    }
    fn everywhere(&self, time: Time) -> Option<Vec3> {
        self.get().everywhere(time)
    }
}
