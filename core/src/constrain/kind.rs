//! The constraints that a scene file names.

use super::declared::Declared;
use super::{
    Attach, Bodies, Constraint, Demand, Distance, Hinge, Rope, ShapeMatching, Share, Shell, StrainLimits, Strands, Tie,
    TiedRope,
};
use crate::motion::MotionBuf;
use alloc::vec::Vec;

/// Declares the constraints that have a name: that of the kind, in small letters.
macro_rules! kinds {
    ($($(#[doc = $doc:literal])* $kind:ident($constraint:ty);)+) => {
        /// A constraint, as files say it.
        #[derive(Clone, Debug, PartialEq)]
        #[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "snake_case"))]
        #[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
        pub enum ConstraintKind {
            $($(#[doc = $doc])* $kind($constraint),)+
        }

        impl ConstraintKind {
            /// The constraint of that kind.
            fn get(&self) -> &dyn Declared {
                match self { $(Self::$kind(constraint) => constraint,)+ }
            }
        }
    };
}

kinds! {
    /// Two particles at a distance.
    Distance(Distance);
    /// A chain of links.
    Rope(Rope<Vec<u32>, Vec<f32>>);
    /// A cluster that keeps its shape.
    Cluster(ShapeMatching<Vec<u32>>);
    /// Particles that go where a script says.
    Attach(Attach<Vec<u32>, MotionBuf>);
    /// A thin sheet that stretches, shears and bends.
    Shell(Shell<Vec<u32>, Vec<[u32; 3]>, Vec<Hinge>>);
    /// Hair, wires, stalks: strands that stretch, bend and twist.
    Strands(Strands<Vec<u32>, Vec<u32>>);
    /// Triangles that stretch and shear only so far.
    StrainLimits(StrainLimits<Vec<[u32; 3]>>);
    /// A particle at a place on another body.
    Tie(Tie<Vec<u32>, Vec<f32>>);
    /// A chain of links whose ends are tied to other bodies.
    TiedRope(TiedRope<Vec<u32>, Vec<f32>, Vec<u32>, Vec<f32>>);
}

impl ConstraintKind {
    /// The first of its numbers that cannot be used, and what it has to be.
    #[must_use]
    pub fn fault(&self) -> Option<(&'static str, &'static str)> {
        self.get().fault()
    }

    /// The pairs of particles that it joins by a straight link, to be drawn as a line each.
    pub fn links(&self) -> impl Iterator<Item = [u32; 2]> {
        let (list, closed) = self.get().chain();
        let back = list.last().zip(list.first()).filter(|_| closed).map(|(&last, &first)| [last, first]);
        list.windows(2).map(|pair| [pair[0], pair[1]]).chain(back)
    }

    /// How long each of its [`links`](Self::links) is at rest \[m\], in their order, and for ever the last of these; nothing where it has none.
    pub fn lengths(&self) -> impl Iterator<Item = f32> {
        let list = self.get().lengths();
        list.iter().copied().chain(list.last().into_iter().flat_map(|&last| core::iter::repeat(last)))
    }

    /// The particles of the scene's start that it binds.
    pub fn ends(&self) -> impl Iterator<Item = &u32> {
        self.get().ends().into_iter().flatten()
    }
}

impl Constraint for ConstraintKind {
    fn demand(&self) -> Demand {
        self.get().demand()
    }
    fn prepare(&self, bodies: &mut Bodies<'_>, share: &mut Share<'_>) {
        self.get().prepare(bodies, share);
    }
    fn begin(&self, bodies: &mut Bodies<'_>, share: &mut Share<'_>) {
        self.get().begin(bodies, share);
    }
    fn project(&self, bodies: &mut Bodies<'_>, share: &mut Share<'_>) {
        self.get().project(bodies, share);
    }
    fn settle(&self, bodies: &mut Bodies<'_>, share: &mut Share<'_>) {
        self.get().settle(bodies, share);
    }
}
