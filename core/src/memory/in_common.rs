//! What all particles of a system are known to have in common: columns that are one number all over need not be read.

/// The numbers that may be known: the place of each in an array of them.
pub(crate) const NUMBERS: usize = 5;

/// Mass, drag, inverse mass, radius and elasticity of the first that has come since a start, and in which of them others differ.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct InCommon {
    first: [f32; NUMBERS],
    /// A bit for each in which somebody differs, and one that is set once somebody has come: an empty system is nothing but zeros.
    differ: u8,
}

/// The bit of whether somebody has come, and those of mass, drag and inverse mass.
const BEGUN: u8 = 1 << NUMBERS;
const INERTIA: u8 = 0b111;

impl InCommon {
    pub(crate) const UNKNOWN: Self = Self { first: [0.0; NUMBERS], differ: 0 };

    /// Another one comes, who has these.
    #[inline]
    pub(crate) fn add(&mut self, numbers: [f32; NUMBERS]) {
        if self.differ & BEGUN == 0 {
            self.first = numbers;
        }
        self.differ |= BEGUN;
        for (i, (first, number)) in self.first.iter().zip(numbers).enumerate() {
            self.differ |= u8::from(first.to_bits() != number.to_bits()) << i;
        }
    }

    /// Masses and drags change from now on, each by itself.
    pub(crate) fn vary_inertias(&mut self) {
        self.differ |= INERTIA;
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
        (self.differ & (BEGUN | 1 << which) == BEGUN).then_some(self.first[which])
    }
}
