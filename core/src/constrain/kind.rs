//! The constraints that a scene file names.

use super::declared::Declared;
use super::{
    Attach, Bodies, Constraint, Demand, Distance, Hinge, Rope, ShapeMatching, Share, Shell, StrainLimits, Strands, Tie,
    TiedRope,
};
use crate::motion::MotionBuf;
use crate::particles::Particle;
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
    /// The name of its kind, in small letters, such as `strain_limits`; a rope is one, tied or not.
    #[must_use]
    pub fn name(&self) -> &'static str {
        self.get().name()
    }

    /// How a sub-step solves it, in words.
    #[must_use]
    pub fn solved(&self) -> &'static str {
        self.get().solved()
    }

    /// The first of its numbers that cannot be used, and what it has to be.
    #[must_use]
    pub fn fault(&self) -> Option<(&'static str, &'static str)> {
        self.get().fault()
    }

    /// The number of things that it holds together, each by itself: as many as it has strands, else one.
    #[must_use]
    pub fn count(&self) -> usize {
        self.get().count()
    }

    /// The pairs of particles that it joins by a straight link.
    pub fn links(&self) -> impl Iterator<Item = [u32; 2]> {
        self.get().links()
    }

    /// How long each of its [`links`](Self::links) is at rest \[m\], in their order, and for ever the last of these; nothing where it has none, or
    /// where that is how they begin.
    pub fn lengths(&self) -> impl Iterator<Item = f32> {
        let list = self.get().lengths();
        list.iter().copied().chain(list.last().into_iter().flat_map(|&last| core::iter::repeat(last)))
    }

    /// The particles of the scene's start that it binds.
    pub fn ends(&self) -> impl Iterator<Item = &u32> {
        self.get().ends().into_iter().flatten()
    }

    /// The triangles of the surface that it makes of particles.
    pub fn triangles(&self) -> impl Iterator<Item = [u32; 3]> {
        self.get().triangles()
    }

    /// The part of it that acts along straight ways alone, and so not through the sides of a periodic room, in words.
    #[must_use]
    pub fn straight(&self) -> Option<&'static str> {
        self.get().straight()
    }

    /// True if it puts particles where a script says, whatever pulls at them.
    #[must_use]
    pub fn leads(&self) -> bool {
        self.get().leads()
    }

    /// True if all its particles hang together: who holds some of them holds all.
    #[must_use]
    pub fn is_body(&self) -> bool {
        self.get().is_body()
    }

    /// True if it is solved by iterations (conjugate gradients) until little is left.
    #[must_use]
    pub fn iterates(&self) -> bool {
        self.get().iterates()
    }

    /// α: how far a part of it gives way to a force \[m/N\]; zero where it is rigid, or has a stiffness instead.
    #[must_use]
    pub fn compliance(&self) -> f32 {
        self.get().compliance()
    }

    /// True if its links only pull.
    #[must_use]
    pub fn is_tether(&self) -> bool {
        self.get().is_tether()
    }

    /// The stiffness of the stiffest of its parts \[N/m\], as the scene's particles start; none where it is rigid.
    #[must_use]
    pub fn stiffness(&self, start: &[Particle]) -> Option<f64> {
        self.get().stiffness(start)
    }

    /// The inverse of the mass that the fastest oscillation of such a part moves \[1/kg\], as if nothing else held it.
    #[must_use]
    pub fn inverse_mass(&self, start: &[Particle]) -> f64 {
        self.get().inverse_mass(start)
    }

    /// The share by which its own weight stretches it, were it hung from what is fixed of it, in gravity of so much \[m/s²\]; none where that
    /// is not known, or follows from its links.
    #[must_use]
    pub fn hung(&self, start: &[Particle], gravity: f32) -> Option<f64> {
        self.get().hung(start, gravity)
    }
}

impl Constraint for ConstraintKind {
    fn demand(&self) -> Demand {
        self.get().demand()
    }
    fn bind(&self, bodies: &mut Bodies<'_>) {
        self.get().bind(bodies);
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
    fn repeats(&self) -> bool {
        self.get().repeats()
    }
    fn project_again(&self, bodies: &mut Bodies<'_>, share: &mut Share<'_>) -> bool {
        self.get().project_again(bodies, share)
    }
    fn settle(&self, bodies: &mut Bodies<'_>, share: &mut Share<'_>) {
        self.get().settle(bodies, share);
    }
}
