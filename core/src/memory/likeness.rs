//! What particles have in common, so that memory need not hold it of each.

use super::table::columns;
use crate::particles::Particle;

/// Writes the attributes that all may have in common.
macro_rules! likeness {
    (
        particle { $($particles:tt)+ }
        common { $($(#[$doc:meta])* $c:ident: $ty:ty = $zero:expr, of |$particle:ident| $of:expr,)+ }
        $($others:tt)+
    ) => {
        /// The columns that each particle has of its own, of those that all may have in common.
        #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
        pub struct Own {
            $($(#[$doc])* pub $c: bool,)+
        }

        impl Own {
            /// All of them.
            pub const ALL: Self = Self { $($c: true,)+ };
            /// None of them.
            pub const NONE: Self = Self { $($c: false,)+ };
        }

        impl Likeness {
            /// Another one comes: what it has otherwise than the others each has of its own from now on.
            pub fn add(&mut self, other: &Particle) {
                $(
                    let [ours, theirs] = [&self.particle, other].map(|$particle| $of);
                    // Zero and minus zero are not the same in a fingerprint, and what is no number is like nothing.
                    let are_like = ours == theirs && bytemuck::bytes_of(&ours) == bytemuck::bytes_of(&theirs);
                    self.own.$c |= !are_like;
                )+
            }
        }
    };
}
columns!(likeness);

/// What particles have in common: for memory ([`Heap::alike`](crate::Heap::alike)) that has columns of the rest alone.
///
/// [`Scene::likeness`](crate::Scene::likeness) tells that of all that a scene begins with and bears. Whoever puts in others adds these:
///
/// ```
/// use pointmass::{Likeness, Own, Particle};
///
/// let mut likeness = Likeness::of(Particle { charge: 1e-9, ..Particle::REST });
/// likeness.add(&Particle { charge: -1e-9, drag: 0.1, ..Particle::REST });
/// assert_eq!(likeness.own, Own { charge: true, drag: true, ..Own::NONE });
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Likeness {
    /// One of them, that all are like, but for what each has of its own.
    pub particle: Particle,
    /// The attributes that each has of its own.
    pub own: Own,
}

impl Likeness {
    /// That of one alone.
    #[must_use]
    pub fn of(particle: Particle) -> Self {
        let mut likeness = Self { particle, own: Own::NONE };
        likeness.add(&particle);
        likeness
    }
}
