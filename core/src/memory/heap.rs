//! Memory on the heap, asked for once, without the columns of what all particles have in common.

use super::table::columns;
use super::{Column, Columns, Likeness, Own, Size, Slices, Storage};
use alloc::collections::TryReserveError;
use alloc::vec;
use alloc::vec::Vec;
use bytemuck::{NoUninit, Pod};

/// A column that may be left out.
#[derive(Debug)]
enum Held<T> {
    /// One entry a row.
    Own(Vec<T>),
    /// So many rows of one of the blocks.
    Common { block: usize, rows: usize },
}

/// Writes the owner's columns.
macro_rules! heap {
    (
        particle { $($(#[$p_doc:meta])* $p:ident: $p_ty:ty = $p_zero:expr,)+ }
        common { $($(#[$c_doc:meta])* $c:ident: $c_ty:ty = $c_zero:expr, of |$particle:ident| $c_of:expr,)+ }
        emitter { $($(#[$e_doc:meta])* $e:ident: $e_ty:ty = $e_zero:expr,)+ }
        spring { $($(#[$s_doc:meta])* $s:ident: $s_ty:ty = $s_zero:expr,)+ }
        kept { $($(#[$k_doc:meta])* $k:ident: $k_ty:ty = $k_zero:expr,)+ }
        work { $($(#[$w_doc:meta])* $w:ident: $w_ty:ty = $w_zero:expr,)+ }
    ) => {
        /// Memory on the heap, asked for once.
        ///
        /// [`alike`](Self::alike) leaves out the columns of what all particles have in common: see there.
        ///
        /// A copy of a [`System`](crate::System) in it goes on to the same bits. `clone_from` copies another's memory into this one where it lies: where both
        /// are as large it asks for none.
        #[derive(Debug)]
        pub struct Heap {
            $($p: Vec<$p_ty>,)+
            $($c: Held<$c_ty>,)+
            $($e: Vec<$e_ty>,)+
            $($s: Vec<$s_ty>,)+
            $($k: Vec<$k_ty>,)+
            $($w: Vec<$w_ty>,)+
            blocks: Vec<Vec<u32>>,
        }

        impl Heap {
            /// Fresh memory of the given size; ends the program if there is not so much.
            #[must_use]
            pub fn new(size: Size) -> Self {
                Self {
                    $($p: vec![$p_zero; size.particles],)+
                    $($c: Held::Own(vec![$c_zero; size.particles]),)+
                    $($e: vec![$e_zero; size.emitters],)+
                    $($s: vec![$s_zero; 2 * size.springs],)+
                    $($k: vec![$k_zero; size.particles * size.kept],)+
                    $($w: vec![$w_zero; size.particles * size.columns],)+
                    blocks: Vec::new(),
                }
            }

            /// Fresh memory of the given size.
            ///
            /// # Errors
            /// If there is not so much: nothing has been written then, and all is given back.
            pub fn try_new(size: Size) -> Result<Self, TryReserveError> {
                Self::alike(size, &Likeness { own: Own::ALL, ..Likeness::default() })
            }

            /// Fresh memory of the given size for particles that are alike: it has columns of those attributes alone that each has of its own.
            ///
            /// A particle takes 57 bytes, and those of its own columns: with all of them 91. What all have in a column that is left out is there as often
            /// as there are rows, for that is how it is read, but once for all columns in which it has the same bits: a radius, a charge, a material and a
            /// list of springs that nobody has are one block of four bytes a particle; masses of 1 kg and their inverses another. Nothing but reads
            /// touch a block, so births and deaths move less.
            ///
            /// A scene that begins with other particles, or whose emitters would bear others, is refused by [`start`](crate::System::start) with the name of
            /// the attribute; who is born or put in otherwise all the same is refused and counted.
            ///
            /// ```
            /// use pointmass::shape::Sphere;
            /// use pointmass::{Emitter, Heap, Particle, Scene, System, Time, Varied, Vec3};
            ///
            /// let ball = Sphere { center: Vec3::ZERO, radius: 0.1 };
            /// let source = Emitter { drag: Varied { mean: 0.2, half_width: 0.1 }, ..Emitter::new(ball, 100.0) };
            /// let scene = Scene { emitters: &source, ..Scene::EMPTY };
            /// let likeness = scene.likeness();
            /// assert!(likeness.own.drag && !likeness.own.mass);
            ///
            /// let mut system = System::with(Heap::alike(scene.size_for(200), &likeness)?);
            /// system.start(&scene, 1)?;
            /// assert_eq!(system.step(&scene, Time::SECOND).born, 100);
            /// assert!(system.spawn(&Particle { mass: 2.0, ..Particle::REST }).is_err());
            /// # Ok::<(), Box<dyn core::error::Error>>(())
            /// ```
            ///
            /// # Errors
            /// If there is not so much: nothing has been written then, and all is given back.
            pub fn alike(size: Size, likeness: &Likeness) -> Result<Self, TryReserveError> {
                let Size { particles, emitters, springs, columns, kept } = size;
                let (ends, work) = (springs.saturating_mul(2), particles.saturating_mul(columns));
                let kept = particles.saturating_mul(kept);
                let mut common = Blocks::default();
                let mut new = Self {
                    $($p: reserved(particles)?,)+
                    $($c: {
                        let $particle = &likeness.particle;
                        if likeness.own.$c { Held::Own(reserved(particles)?) } else { common.held($c_of, particles)? }
                    },)+
                    $($e: reserved(emitters)?,)+
                    $($s: reserved(ends)?,)+
                    $($k: reserved(kept)?,)+
                    $($w: reserved(work)?,)+
                    blocks: reserved(common.0.len())?,
                };
                for &(_, words) in &common.0 {
                    new.blocks.push(reserved(words)?);
                }
                $(new.$p.resize(particles, $p_zero);)+
                $(if let Held::Own(rows) = &mut new.$c { rows.resize(particles, $c_zero) })+
                $(new.$e.resize(emitters, $e_zero);)+
                $(new.$s.resize(ends, $s_zero);)+
                $(new.$k.resize(kept, $k_zero);)+
                $(new.$w.resize(work, $w_zero);)+
                new.blocks.iter_mut().zip(&common.0).for_each(|(block, &(word, words))| block.resize(words, word));
                Ok(new)
            }
        }

        impl Heap {
            /// A copy.
            ///
            /// # Errors
            /// If there is not so much memory: all is given back then.
            pub fn try_clone(&self) -> Result<Self, TryReserveError> {
                let mut blocks = reserved(self.blocks.len())?;
                for block in &self.blocks {
                    blocks.push(copied(block)?);
                }
                Ok(Self {
                    $($p: copied(&self.$p)?,)+
                    $($c: self.$c.copied()?,)+
                    $($e: copied(&self.$e)?,)+
                    $($s: copied(&self.$s)?,)+
                    $($k: copied(&self.$k)?,)+
                    $($w: copied(&self.$w)?,)+
                    blocks,
                })
            }
        }

        impl Clone for Heap {
            fn clone(&self) -> Self {
                Self {
                    $($p: self.$p.clone(),)+
                    $($c: self.$c.clone(),)+
                    $($e: self.$e.clone(),)+
                    $($s: self.$s.clone(),)+
                    $($k: self.$k.clone(),)+
                    $($w: self.$w.clone(),)+
                    blocks: self.blocks.clone(),
                }
            }

            fn clone_from(&mut self, other: &Self) {
                $(self.$p.clone_from(&other.$p);)+
                $(self.$c.clone_from(&other.$c);)+
                $(self.$e.clone_from(&other.$e);)+
                $(self.$s.clone_from(&other.$s);)+
                $(self.$k.clone_from(&other.$k);)+
                $(self.$w.clone_from(&other.$w);)+
                self.blocks.clone_from(&other.blocks);
            }
        }

        #[cfg(test)]
        impl Heap {
            /// Bytes of its columns and blocks.
            fn bytes(&self) -> usize {
                let rows = [$(size_of_val(&*self.$p),)+ $(self.$c.bytes(),)+];
                rows.iter().sum::<usize>() + self.blocks.iter().map(|block| size_of_val(&**block)).sum::<usize>()
            }
        }

        impl Storage for Heap {
            fn slices(&mut self) -> Slices<'_> {
                let blocks = &self.blocks;
                Slices {
                    $($p: &mut self.$p,)+
                    $($c: self.$c.column(blocks),)+
                    $($e: &mut self.$e,)+
                    $($s: &mut self.$s,)+
                    $($k: &mut self.$k,)+
                    $($w: &mut self.$w,)+
                }
            }
            fn columns(&self) -> Columns<'_> {
                Columns {
                    $($p: &self.$p,)+
                    $($c: self.$c.rows(&self.blocks),)+
                    $($e: &self.$e,)+
                    $($s: &self.$s,)+
                    $($k: &self.$k,)+
                    $($w: &self.$w,)+
                }
            }
        }
    };
}
columns!(heap);

impl<T: Copy> Clone for Held<T> {
    fn clone(&self) -> Self {
        match *self {
            Self::Own(ref rows) => Self::Own(rows.clone()),
            Self::Common { block, rows } => Self::Common { block, rows },
        }
    }

    fn clone_from(&mut self, other: &Self) {
        match (&mut *self, other) {
            (Self::Own(own), Self::Own(rows)) => own.clone_from(rows),
            _ => *self = other.clone(),
        }
    }
}

impl<T: Pod + PartialEq> Held<T> {
    fn copied(&self) -> Result<Self, TryReserveError> {
        Ok(match *self {
            Self::Own(ref rows) => Self::Own(copied(rows)?),
            Self::Common { block, rows } => Self::Common { block, rows },
        })
    }

    fn rows<'a>(&'a self, blocks: &'a [Vec<u32>]) -> &'a [T] {
        match *self {
            Self::Own(ref rows) => rows,
            Self::Common { block, rows } => common(blocks, block, rows),
        }
    }

    #[cfg(test)]
    fn bytes(&self) -> usize {
        match self {
            Self::Own(rows) => size_of_val(&**rows),
            Self::Common { .. } => 0,
        }
    }

    fn column<'a>(&'a mut self, blocks: &'a [Vec<u32>]) -> Column<'a, T> {
        match *self {
            Self::Own(ref mut rows) => Column::Own(rows),
            Self::Common { block, rows } => Column::Common(common(blocks, block, rows)),
        }
    }
}

/// So many rows of a block, by whose bits they are made.
fn common<T: Pod>(blocks: &[Vec<u32>], block: usize, rows: usize) -> &[T] {
    &bytemuck::cast_slice(&blocks[block])[..rows]
}

/// The words that blocks consist of, one word over and over, and how many they are.
#[derive(Default)]
struct Blocks(Vec<(u32, usize)>);

impl Blocks {
    /// A column that is left out, as all have the same in it.
    fn held<T: NoUninit>(&mut self, value: T, rows: usize) -> Result<Held<T>, TryReserveError> {
        let bytes = bytemuck::bytes_of(&value);
        let word = u32::from_ne_bytes(core::array::from_fn(|i| bytes[i % bytes.len()]));
        let words = rows.saturating_mul(bytes.len()).div_ceil(size_of::<u32>());
        let known = self.0.iter().position(|&(known, _)| known == word);
        let block = match known {
            Some(block) => block,
            None => {
                self.0.try_reserve(1)?;
                self.0.push((word, 0));
                self.0.len() - 1
            }
        };
        self.0[block].1 = self.0[block].1.max(words);
        Ok(Held::Common { block, rows })
    }
}

fn copied<T: Copy>(rows: &[T]) -> Result<Vec<T>, TryReserveError> {
    let mut copy = reserved(rows.len())?;
    copy.extend_from_slice(rows);
    Ok(copy)
}

fn reserved<T>(len: usize) -> Result<Vec<T>, TryReserveError> {
    let mut column = Vec::new();
    column.try_reserve_exact(len)?;
    Ok(column)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::particles::Particle;

    #[test]
    fn memory_that_is_not_there_is_an_error() {
        let size = Size { particles: 7, emitters: 3, springs: 5, columns: 2, kept: 4 };
        for own in [Own::ALL, Own::NONE] {
            let heap = |size| Heap::alike(size, &Likeness { own, ..Likeness::default() });
            for more in [usize::MAX, usize::MAX / 2, usize::MAX / 64, isize::MAX as usize / 12] {
                assert!(heap(Size { particles: more, ..size }).is_err(), "{more} particles");
                assert!(heap(Size { emitters: more, ..size }).is_err(), "{more} emitters");
                assert!(heap(Size { springs: more, ..size }).is_err(), "{more} springs");
                assert!(heap(Size { columns: more, ..size }).is_err(), "{more} columns");
                assert!(heap(Size { kept: more, ..size }).is_err(), "{more} kept words");
            }
            assert_eq!(heap(size).expect("a little memory").columns().size(), size);
        }
        assert_eq!(Heap::new(size).columns().size(), size);
    }

    #[test]
    fn what_is_left_out_is_held_once_for_all_columns_of_its_bits() {
        let bytes = |likeness: &Likeness| {
            let heap = Heap::alike(Size { particles: 1000, ..Size::default() }, likeness).expect("a little memory");
            (heap.bytes(), heap.blocks.len())
        };
        let (rest, all) = (Likeness::of(Particle::REST), Likeness { own: Own::ALL, ..Likeness::default() });
        assert_eq!(bytes(&all), (91_000, 0));
        // Zeros, ones, halves, and white.
        assert_eq!(bytes(&rest), (57_000 + 4 * 4000, 4));
        // An inverse mass is an elasticity.
        assert_eq!(bytes(&Likeness::of(Particle { mass: 2.0, ..Particle::REST })), (57_000 + 4 * 4000, 4));
        // The number of a material takes half a word.
        assert_eq!(
            bytes(&Likeness::of(Particle { material: Some(6), ..Particle::REST })),
            (57_000 + 4 * 4000 + 2000, 5)
        );
        let own = Own { drag: true, mass: true, ..Own::NONE };
        assert_eq!(bytes(&Likeness { own, ..rest }), (57_000 + 2 * 4000 + 4 * 4000, 4));
    }
}
