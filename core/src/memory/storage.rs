//! Where a system's memory comes from: inline arrays, borrowed slices, or the heap, once (`heap.rs`).
//!
//! Capacity belongs to the owner of the memory and to nothing else: every algorithm works on `Slices`.

use super::Column;
use super::table::columns;
use crate::math::copied;
use crate::particles::Particle;
use glam::Vec3;

/// Memory that a system can live in. Fresh memory is all zeros.
///
/// Both functions have to hand out the same memory whenever they are called: columns of the same lengths, with what has been written to them. Where columns
/// become shorter while particles live in them, steps panic; that is the one thing which nobody looks after in a step.
pub trait Storage {
    /// All of it, for changing.
    fn slices(&mut self) -> Slices<'_>;
    /// All of it, for reading.
    fn columns(&self) -> Columns<'_>;
}

/// Writes the two views and the owners of inline memory.
macro_rules! storage {
    (
        particle { $($(#[$p_doc:meta])* $p:ident: $p_ty:ty = $p_zero:expr,)+ }
        common { $($(#[$c_doc:meta])* $c:ident: $c_ty:ty = $c_zero:expr, of |$particle:ident| $c_of:expr,)+ }
        emitter { $($(#[$e_doc:meta])* $e:ident: $e_ty:ty = $e_zero:expr,)+ }
        spring { $($(#[$s_doc:meta])* $s:ident: $s_ty:ty = $s_zero:expr,)+ }
        kept { $($(#[$k_doc:meta])* $k:ident: $k_ty:ty = $k_zero:expr,)+ }
        work { $($(#[$w_doc:meta])* $w:ident: $w_ty:ty = $w_zero:expr,)+ }
    ) => {
        /// A system's memory, borrowed: one slice a column. It is an owner itself, for memory that lies elsewhere.
        ///
        /// The columns of particles should be equally long; what is longer than the shortest goes unused.
        #[derive(Debug)]
        pub struct Slices<'a> {
            $($(#[$p_doc])* pub $p: &'a mut [$p_ty],)+
            $($(#[$c_doc])* pub $c: Column<'a, $c_ty>,)+
            $($(#[$e_doc])* pub $e: &'a mut [$e_ty],)+
            $($(#[$s_doc])* pub $s: &'a mut [$s_ty],)+
            $($(#[$k_doc])* pub $k: &'a mut [$k_ty],)+
            $($(#[$w_doc])* pub $w: &'a mut [$w_ty],)+
        }

        /// An attribute that all particles may have in common. A name is looked up only where it is read.
        // Ends of lists of springs are in the table with the others, though no particle says them.
        #[allow(non_camel_case_types, dead_code)]
        #[derive(Clone, Copy, Debug)]
        pub(crate) enum Attribute {
            $($c,)+
        }

        impl Attribute {
            pub(crate) fn name(self) -> &'static str {
                match self {
                    $(Self::$c => stringify!($c),)+
                }
            }
        }

        /// A system's memory, for reading.
        #[derive(Clone, Copy, Debug)]
        pub struct Columns<'a> {
            $($(#[$p_doc])* pub $p: &'a [$p_ty],)+
            $($(#[$c_doc])* pub $c: &'a [$c_ty],)+
            $($(#[$e_doc])* pub $e: &'a [$e_ty],)+
            $($(#[$s_doc])* pub $s: &'a [$s_ty],)+
            $($(#[$k_doc])* pub $k: &'a [$k_ty],)+
            $($(#[$w_doc])* pub $w: &'a [$w_ty],)+
        }

        // Asked for in several places: apart, it is in a chip's flash once. So are those of the owners.
        impl Storage for Slices<'_> {
            #[inline(never)]
            fn slices(&mut self) -> Slices<'_> {
                Slices {
                    $($p: self.$p,)+ $($c: self.$c.again(),)+ $($e: self.$e,)+ $($s: self.$s,)+ $($k: self.$k,)+ $($w: self.$w,)+
                }
            }
            fn columns(&self) -> Columns<'_> {
                Columns {
                    $($p: self.$p,)+ $($c: &self.$c,)+ $($e: self.$e,)+ $($s: self.$s,)+ $($k: self.$k,)+ $($w: self.$w,)+
                }
            }
        }

        impl Columns<'_> {
            /// The number of particles that fit.
            #[must_use]
            #[inline(never)]
            pub fn capacity(&self) -> usize {
                [$(self.$p.len(),)+ $(self.$c.len()),+].into_iter().fold(usize::MAX, usize::min)
            }
        }

        impl Columns<'_> {
            /// The columns by row, cut to the rows in use.
            pub(crate) fn living(self, len: usize) -> Self {
                Self { $($p: storage!(@living self, len, $p),)+ $($c: storage!(@living self, len, $c),)+ ..self }
            }
        }

        impl Slices<'_> {
            /// The number of particles that fit.
            #[cfg_attr(one_by_one, inline(never))]
            pub(crate) fn capacity(&self) -> usize {
                [$(self.$p.len(),)+ $(self.$c.len()),+].into_iter().fold(usize::MAX, usize::min)
            }

            /// Moves rows onto others, each `[from, to]`, one after the other; all exist.
            #[cfg_attr(one_by_one, inline(always))]
            pub(crate) fn move_rows(&mut self, moves: &[[u32; 2]]) {
                // Column by column, so that those in memory that is far away are waited for together.
                storage!(@move self, moves, $($p)+);
                $(storage!(@unless_by_number $c { self.$c.move_rows(moves); });)+
            }

            /// Gives a row those attributes of a particle that need not be kept of each.
            ///
            /// # Errors
            /// The first of them that the particle has otherwise than this memory holds it for all.
            #[cfg_attr(one_by_one, inline(never))]
            pub(crate) fn give(&mut self, row: usize, particle: &Particle) -> Result<(), Attribute> {
                $(storage!(@unless_by_number $c {
                    let $particle = particle;
                    if !self.$c.put(row, $c_of) {
                        return Err(Attribute::$c);
                    }
                });)+
                Ok(())
            }
        }

        /// Memory in the value itself: a `static`, a field, or a small stack variable.
        ///
        /// `COLUMNS` is how many `Vec3` the scene needs to work with for each particle, `KEPT` how many words it keeps of each:
        /// see [`Scene::columns`](crate::Scene::columns) and [`Scene::kept`](crate::Scene::kept). Scenes ask for so much, with gravity, a plane, and as many
        /// particles as they begin with or bear:
        ///
        /// | Scene | `PARTICLES` | `EMITTERS` | `COLUMNS` | `KEPT` |
        /// |---|---|---|---|---|
        /// | A fountain of an [`Emitter`](crate::Emitter) | 64 | 1 | 3 | 0 |
        /// | A [`Rope`](crate::Rope) of 8 links | 9 | 0 | 25 | 4 |
        /// | The same by [`Rk4`](crate::Rk4) | 9 | 0 | 27 | 7 |
        /// | A die, of [`RigidBodies`](crate::constrain::RigidBodies) | 8 | 0 | 28; hosts 182 | 75 |
        /// | Both | 17 | 0 | 22; hosts 94 | 37 |
        /// | A flag of 6 × 4 cells, a [`Shell`](crate::Shell) | 35 | 0 | 66 | 97 |
        ///
        /// These do not add up: parts work in the same columns by turns, and what they ask for themselves is divided among all particles. What a scene needs
        /// in all [`Scene::size_for`](crate::Scene::size_for) says, and [`start`](crate::System::start) where there is less; hosts, which solve for many
        /// touching bodies side by side, work in more than chips.
        ///
        /// ```
        /// # use pointmass::constrain::{Hinge, RigidBodies, RigidBox, ShellParams};
        /// # use pointmass::shape::{Disc, Plane};
        /// # use pointmass::{Drag, Emitter, Gravity, Rk4, Rope, Sheet, Shell, Size, Vec3};
        /// use pointmass::{Inline, Scene, System};
        ///
        /// # let ground = Plane { point: Vec3::ZERO, normal: Vec3::Y };
        /// # let forces = (Gravity::EARTH, Drag {});
        /// # let world = Scene { forces: &forces, colliders: &ground, ..Scene::EMPTY };
        /// # let size = |particles, emitters, columns, kept| Size { particles, emitters, springs: 0, columns, kept };
        /// # let source = Emitter::new(Disc { center: Vec3::Y, normal: Vec3::Y, radius: 0.1 }, 100.0);
        /// # let fountain = Scene { emitters: &source, ..world };
        /// # assert_eq!(fountain.size_for(64), size(64, 1, 3, 0));
        /// # let rope = Rope::rigid([0, 1, 2, 3, 4, 5, 6, 7, 8], [0.1]);
        /// # let hangs = Scene { constraints: &rope, ..world };
        /// # assert_eq!(hangs.size_for(9), size(9, 0, 25, 4));
        /// # assert_eq!(Scene { integrator: &Rk4, ..hangs }.size_for(9), size(9, 0, 27, 7));
        /// # let die = RigidBodies::boxes([RigidBox::new(Vec3::splat(0.01), Vec3::Y, 9)]);
        /// # assert!([28, 182].map(|columns| size(8, 0, columns, 75)).contains(&Scene { constraints: &die, ..world }.size_for(8)));
        /// # let both = (rope, die);
        /// # assert!([22, 94].map(|columns| size(17, 0, columns, 37)).contains(&Scene { constraints: &both, ..world }.size_for(17)));
        /// # let flag = Sheet { corner: Vec3::Y, sides: [Vec3::X, Vec3::NEG_Y * 0.6], cells: [6, 4] };
        /// # let shell = Shell {
        /// #     particles: (0..35).collect::<Vec<u32>>(),
        /// #     triangles: flag.triangles().collect::<Vec<_>>(),
        /// #     hinges: flag.hinges().collect::<Vec<Hinge>>(),
        /// #     warp: Vec3::X,
        /// #     params: ShellParams::isotropic(1e3, 0.3, 0.1),
        /// # };
        /// # assert_eq!(Scene { constraints: &shell, ..world }.size_for(35), size(35, 0, 66, 97));
        /// let mut system = System::with(Inline::<64, 1, 0, 3>::new());
        /// assert!(system.start(&fountain, 1).is_ok());
        /// let mut less = System::with(Inline::<64, 1, 0, 2>::new());
        /// assert_eq!(less.start(&fountain, 1).map_err(|lack| lack.need.columns), Err(3));
        /// ```
        #[derive(Clone, Debug)]
        pub struct Inline<
            const PARTICLES: usize,
            const EMITTERS: usize,
            const SPRINGS: usize,
            const COLUMNS: usize,
            const KEPT: usize = 0,
        > {
            $($p: [$p_ty; PARTICLES],)+
            $($c: [$c_ty; PARTICLES],)+
            $($e: [$e_ty; EMITTERS],)+
            $($s: [[$s_ty; 2]; SPRINGS],)+
            $($k: [[$k_ty; PARTICLES]; KEPT],)+
            $($w: [[$w_ty; PARTICLES]; COLUMNS],)+
        }

        impl<const P: usize, const E: usize, const S: usize, const C: usize, const K: usize> Inline<P, E, S, C, K> {
            /// Fresh memory, all zeros: in a `static` it costs no flash.
            #[must_use]
            pub const fn new() -> Self {
                Self {
                    $($p: [$p_zero; P],)+
                    $($c: [$c_zero; P],)+
                    $($e: [$e_zero; E],)+
                    $($s: [[$s_zero; 2]; S],)+
                    $($k: [[$k_zero; P]; K],)+
                    $($w: [[$w_zero; P]; C],)+
                }
            }
        }

        impl<const P: usize, const E: usize, const S: usize, const C: usize, const K: usize> Default
            for Inline<P, E, S, C, K>
        {
            fn default() -> Self {
                Self::new()
            }
        }

        impl<const P: usize, const E: usize, const S: usize, const C: usize, const K: usize> Storage
            for Inline<P, E, S, C, K>
        {
            #[inline(never)]
            fn slices(&mut self) -> Slices<'_> {
                Slices {
                    $($p: &mut self.$p,)+
                    $($c: Column::Own(&mut self.$c),)+
                    $($e: &mut self.$e,)+
                    $($s: self.$s.as_flattened_mut(),)+
                    $($k: self.$k.as_flattened_mut(),)+
                    $($w: self.$w.as_flattened_mut(),)+
                }
            }
            fn columns(&self) -> Columns<'_> {
                Columns {
                    $($p: &self.$p,)+
                    $($c: &self.$c,)+
                    $($e: &self.$e,)+
                    $($s: self.$s.as_flattened(),)+
                    $($k: self.$k.as_flattened(),)+
                    $($w: self.$w.as_flattened(),)+
                }
            }
        }

        /// Memory in the value itself for particles that are alike: those attributes that [`Common`] has of all are not kept of
        /// each, which takes 57 bytes a particle where [`Inline`] takes 91, besides the columns to work with. There are no springs. What all have lies in
        /// flash, as often as there are rows: up to 36 bytes a particle, less where several attributes have the same bits.
        ///
        /// A scene that begins with other particles, or whose emitters would bear others, is refused by
        /// [`start`](crate::System::start) with the name of the attribute; what is born otherwise all the same is refused and counted.
        ///
        /// ```
        /// use pointmass::{Alike, Common, Particle, Scene, System};
        ///
        /// /// Sparks of a milligram.
        /// struct Spark;
        ///
        /// impl Common for Spark {
        ///     const PARTICLE: Particle = Particle { mass: 1e-6, elasticity: 0.2, ..Particle::REST };
        /// }
        ///
        /// let mut system = System::with(Alike::<Spark, 64, 0, 1>::new());
        /// let start = [Spark::PARTICLE, Particle { radius: 0.1, ..Spark::PARTICLE }];
        /// assert!(system.start(&Scene { start: &start[..1], ..Scene::EMPTY }, 1).is_ok());
        /// let refused = system.start(&Scene { start: &start, ..Scene::EMPTY }, 1).unwrap_err();
        /// assert_eq!(refused.differs, Some("radius"));
        /// ```
        #[derive(Debug)]
        pub struct Alike<
            C,
            const PARTICLES: usize,
            const EMITTERS: usize,
            const COLUMNS: usize,
            const KEPT: usize = 0,
        > {
            $($p: [$p_ty; PARTICLES],)+
            $($e: [$e_ty; EMITTERS],)+
            $($k: [[$k_ty; PARTICLES]; KEPT],)+
            $($w: [[$w_ty; PARTICLES]; COLUMNS],)+
            common: core::marker::PhantomData<fn() -> C>,
        }

        /// What all have, as often as there are rows.
        #[allow(non_upper_case_globals)]
        impl<C: Common, const P: usize, const E: usize, const W: usize, const K: usize> Alike<C, P, E, W, K> {
            // A word for each, so that what has the same bits lies in flash once.
            $(const $c: &'static [[$c_ty; 4 / size_of::<$c_ty>()]; P] = {
                let $particle = &C::PARTICLE;
                &[[$c_of; 4 / size_of::<$c_ty>()]; P]
            };)+

            /// Fresh memory, all zeros: in a `static` it costs no flash.
            #[must_use]
            pub const fn new() -> Self {
                Self {
                    $($p: [$p_zero; P],)+
                    $($e: [$e_zero; E],)+
                    $($k: [[$k_zero; P]; K],)+
                    $($w: [[$w_zero; P]; W],)+
                    common: core::marker::PhantomData,
                }
            }
        }

        impl<C: Common, const P: usize, const E: usize, const W: usize, const K: usize> Default for Alike<C, P, E, W, K> {
            fn default() -> Self {
                Self::new()
            }
        }

        impl<C: Common, const P: usize, const E: usize, const W: usize, const K: usize> Storage for Alike<C, P, E, W, K> {
            #[inline(never)]
            fn slices(&mut self) -> Slices<'_> {
                Slices {
                    $($p: &mut self.$p,)+
                    $($c: Column::Common(&Self::$c.as_flattened()[..P]),)+
                    $($e: &mut self.$e,)+
                    $($s: &mut [],)+
                    $($k: self.$k.as_flattened_mut(),)+
                    $($w: self.$w.as_flattened_mut(),)+
                }
            }
            fn columns(&self) -> Columns<'_> {
                Columns {
                    $($p: &self.$p,)+
                    $($c: &Self::$c.as_flattened()[..P],)+
                    $($e: &self.$e,)+
                    $($s: &[],)+
                    $($k: self.$k.as_flattened(),)+
                    $($w: self.$w.as_flattened(),)+
                }
            }
        }
    };
    // By slot and by number, not by row.
    (@living $self:ident, $len:ident, row_of) => { $self.row_of };
    (@living $self:ident, $len:ident, last_spring) => { $self.last_spring };
    // Without a panic, so that compilers leave out what nobody reads.
    (@living $self:ident, $len:ident, $column:ident) => { $self.$column.get(..$len).unwrap_or(&[]) };
    (@unless_by_number last_spring $code:block) => {};
    (@unless_by_number $c:ident $code:block) => { $code };
    // By slot, not by row: it stays where it is.
    (@move $self:ident, $moves:ident, $($p:ident)+) => {
        $(storage!(@one $self, $moves, $p);)+
    };
    (@one $self:ident, $moves:ident, row_of) => {};
    (@one $self:ident, $moves:ident, position) => {
        $moves.iter().for_each(|[from, to]| copy($self.position, *from as usize, *to as usize));
    };
    (@one $self:ident, $moves:ident, velocity) => {
        $moves.iter().for_each(|[from, to]| copy($self.velocity, *from as usize, *to as usize));
    };
    (@one $self:ident, $moves:ident, $p:ident) => {
        $moves.iter().for_each(|[from, to]| $self.$p[*to as usize] = $self.$p[*from as usize]);
    };
}

columns!(storage);

/// What all particles of a system have in common, for memory ([`Alike`]) that does not keep it of each: radius, mass (or that it is
/// fixed), drag, charge, elasticity, colour and material. Its place, velocity and lifetime say nothing.
pub trait Common {
    /// A particle that all are like.
    const PARTICLE: Particle;
}

/// Copies a vector.
fn copy(column: &mut [Vec3], from: usize, to: usize) {
    column[to] = copied(column[from]);
}

/// How much memory a system has, or a scene needs.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Size {
    /// Particles alive at once.
    pub particles: usize,
    /// Emitters.
    pub emitters: usize,
    /// Springs.
    pub springs: usize,
    /// Vectors to work with for each particle.
    pub columns: usize,
    /// Words kept of each particle: columns of a user's own, and what constraints keep.
    pub kept: usize,
}

impl<T: Storage + ?Sized> Storage for &mut T {
    fn slices(&mut self) -> Slices<'_> {
        (**self).slices()
    }
    fn columns(&self) -> Columns<'_> {
        (**self).columns()
    }
}

#[cfg(feature = "alloc")]
impl<T: Storage + ?Sized> Storage for alloc::boxed::Box<T> {
    fn slices(&mut self) -> Slices<'_> {
        (**self).slices()
    }
    fn columns(&self) -> Columns<'_> {
        (**self).columns()
    }
}

impl Size {
    /// That of memory for so many particles, by the lengths of its other columns.
    #[cfg_attr(one_by_one, inline(never))]
    pub(super) fn of(particles: usize, [emitters, incident, work, kept]: [usize; 4]) -> Self {
        let share = |words: usize| words.checked_div(particles).unwrap_or(usize::MAX);
        Self { particles, emitters, springs: incident / 2, columns: share(work), kept: share(kept) }
    }
}

impl Columns<'_> {
    /// How much there is.
    #[must_use]
    pub fn size(&self) -> Size {
        let Self { emitter_states, incident, work, kept, .. } = self;
        Size::of(self.capacity(), [emitter_states.len(), incident.len(), work.len(), kept.len()])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_particle_takes_the_bytes_that_the_readme_says() {
        let one = size_of::<Inline<1001, 0, 0, 4>>() - size_of::<Inline<1, 0, 0, 4>>();
        assert_eq!(one, 1000 * (91 + 4 * 12));
        let kept = size_of::<Inline<1000, 0, 0, 4, 3>>() - size_of::<Inline<1000, 0, 0, 4>>();
        assert_eq!(kept, 1000 * 3 * 4);
    }
}
