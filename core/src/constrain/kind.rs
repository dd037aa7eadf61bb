//! The constraints that a scene file names.

use super::tie::BODY_TWICE;
use super::{
    Attach, Bodies, Constraint, Demand, Distance, Hinge, Rope, ShapeMatching, Share, Shell, StrainLimits, Strands, Tie,
    TiedRope,
};
use crate::motion::MotionBuf;
use alloc::vec::Vec;

/// A constraint, as files say it.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "snake_case"))]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub enum ConstraintKind {
    /// Two particles at a distance.
    Distance(Distance),
    /// A chain of links.
    Rope(Rope<Vec<u32>, Vec<f32>>),
    /// A cluster that keeps its shape.
    Cluster(ShapeMatching<Vec<u32>>),
    /// Particles that go where a script says.
    Attach(Attach<Vec<u32>, MotionBuf>),
    /// A thin sheet that stretches, shears and bends.
    Shell(Shell<Vec<u32>, Vec<[u32; 3]>, Vec<Hinge>>),
    /// Hair, wires, stalks: strands that stretch, bend and twist.
    Strands(Strands<Vec<u32>, Vec<u32>>),
    /// Triangles that stretch and shear only so far.
    StrainLimits(StrainLimits<Vec<[u32; 3]>>),
    /// A particle at a place on another body.
    Tie(Tie<Vec<u32>, Vec<f32>>),
    /// A chain of links whose ends are tied to other bodies.
    TiedRope(TiedRope<Vec<u32>, Vec<f32>, Vec<u32>, Vec<f32>>),
}

impl ConstraintKind {
    /// The constraint of that kind.
    fn get(&self) -> &dyn Constraint {
        match self {
            Self::Distance(distance) => distance,
            Self::Rope(rope) => rope,
            Self::Cluster(cluster) => cluster,
            Self::Attach(attach) => attach,
            Self::Shell(shell) => shell,
            Self::Strands(strands) => strands,
            Self::StrainLimits(limits) => limits,
            Self::Tie(tie) => tie,
            Self::TiedRope(tied) => tied,
        }
    }

    /// The first of its numbers that cannot be used, and what it has to be.
    #[must_use]
    pub fn fault(&self) -> Option<(&'static str, &'static str)> {
        match self {
            Self::Distance(distance) => distance.fault(),
            Self::Rope(rope) => rope.fault().or_else(|| twice(&rope.particles)),
            Self::Cluster(cluster) => cluster.fault().or_else(|| twice(&cluster.particles)),
            Self::Attach(attach) => attach.motion.fault().map(|why| ("motion", why)),
            Self::Shell(shell) => shell.fault().or_else(|| twice(&shell.particles)),
            Self::Strands(strands) => strands.fault().or_else(|| twice(&strands.particles)),
            Self::StrainLimits(limits) => limits.fault(),
            Self::Tie(tie) => tie.fault().or_else(|| twice(&tie.to).map(|(_, why)| ("to", why))),
            Self::TiedRope(tied) => {
                let bodies = || tied.ends.iter().flatten().find_map(|tie| twice(&tie.to)).map(|_| BODY_TWICE);
                tied.fault_but_twice().or_else(|| twice(&tied.rope.particles)).or_else(bodies)
            }
        }
    }

    /// The pairs of particles that it joins by a straight link, to be drawn as a line each.
    pub fn links(&self) -> impl Iterator<Item = [u32; 2]> {
        let (list, closed) = match self {
            Self::Distance(distance) => (&distance.ends[..], false),
            Self::Rope(rope) => (&rope.particles[..], rope.closed),
            Self::Cluster(_)
            | Self::Attach(_)
            | Self::Shell(_)
            | Self::Strands(_)
            | Self::StrainLimits(_)
            | Self::Tie(_) => (&[][..], false),
            Self::TiedRope(tied) => (&tied.rope.particles[..], tied.rope.closed),
        };
        let back = list.last().zip(list.first()).filter(|_| closed).map(|(&last, &first)| [last, first]);
        list.windows(2).map(|pair| [pair[0], pair[1]]).chain(back)
    }

    /// How long each of its [`links`](Self::links) is at rest \[m\], in their order, and for ever the last of these; nothing where it has none.
    pub fn lengths(&self) -> impl Iterator<Item = f32> {
        let list = match self {
            Self::Distance(distance) => core::slice::from_ref(&distance.length),
            Self::Rope(rope) | Self::TiedRope(TiedRope { rope, .. }) => &rope.lengths[..],
            Self::Cluster(_)
            | Self::Attach(_)
            | Self::Shell(_)
            | Self::Strands(_)
            | Self::StrainLimits(_)
            | Self::Tie(_) => &[],
        };
        list.iter().copied().chain(list.last().into_iter().flat_map(|&last| core::iter::repeat(last)))
    }

    /// The particles of the scene's start that it binds.
    pub fn ends(&self) -> impl Iterator<Item = &u32> {
        let nobody: [&[u32]; 2] = [&[]; 2];
        let (list, tied) = match self {
            Self::Distance(distance) => (&distance.ends[..], nobody),
            Self::Rope(rope) => (&rope.particles[..], nobody),
            Self::Cluster(cluster) => (&cluster.particles[..], nobody),
            Self::Attach(attach) => (&attach.particles[..], nobody),
            Self::Shell(shell) => (&shell.particles[..], nobody),
            Self::Strands(strands) => (&strands.particles[..], nobody),
            Self::StrainLimits(limits) => (limits.triangles.as_flattened(), nobody),
            Self::Tie(tie) => (&tie.to[..], [core::slice::from_ref(&tie.particle), &[]]),
            Self::TiedRope(tied) => {
                (&tied.rope.particles[..], [0, 1].map(|i| tied.ends[i].as_ref().map_or(&[][..], |tie| &tie.to[..])))
            }
        };
        list.iter().chain(tied.into_iter().flatten())
    }
}

/// What is wrong with a list that names a particle twice.
fn twice(particles: &[u32]) -> Option<(&'static str, &'static str)> {
    let mut sorted = particles.to_vec();
    sorted.sort_unstable();
    let twice = sorted.windows(2).any(|pair| pair[0] == pair[1]);
    twice.then_some(("particles", "must not name a particle twice"))
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
