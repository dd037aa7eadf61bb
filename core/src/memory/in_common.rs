//! What all particles of a system are known to have in common: columns that are one number all over need not be read.

/// The numbers that may be known: the place of each in an array of them.
pub(crate) const NUMBERS: usize = 5;

/// Mass, drag, inverse mass, radius and elasticity of the first that has come since a start, and in which of them others differ.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct InCommon {
    first: [f32; NUMBERS],
    /// False if nobody has come, so that an empty system is nothing but zeros.
    is_known: bool,
    differ: [bool; NUMBERS],
}

impl InCommon {
    pub(crate) const UNKNOWN: Self = Self { first: [0.0; NUMBERS], is_known: false, differ: [false; NUMBERS] };

    /// Another one comes, who has these.
    #[inline]
    pub(crate) fn add(&mut self, numbers: [f32; NUMBERS]) {
        if !self.is_known {
            (self.first, self.is_known) = (numbers, true);
        }
        for ((differs, first), number) in self.differ.iter_mut().zip(self.first).zip(numbers) {
            *differs |= first.to_bits() != number.to_bits();
        }
    }

    /// Masses and drags change from now on, each by itself.
    pub(crate) fn vary_inertias(&mut self) {
        let [mass, drag, inverse_mass, ..] = &mut self.differ;
        [*mass, *drag, *inverse_mass] = [true; 3];
    }

    /// Mass, drag and inverse mass, if all have the same.
    pub(crate) fn inertia(&self) -> Option<[f32; 3]> {
        Some([self.number(0)?, self.number(1)?, self.number(2)?])
    }

    pub(crate) fn inverse_mass(&self) -> Option<f32> {
        self.number(2)
    }

    pub(crate) fn radius(&self) -> Option<f32> {
        self.number(3)
    }

    pub(crate) fn elasticity(&self) -> Option<f32> {
        self.number(4)
    }

    fn number(&self, which: usize) -> Option<f32> {
        (self.is_known && !self.differ[which]).then_some(self.first[which])
    }
}
