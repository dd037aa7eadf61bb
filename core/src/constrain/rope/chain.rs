//! The particles and links of a rope, and the parts in which it is where particles have died.

use super::super::Bodies;
use super::held::Held;

/// The row of a particle that is not there.
const NOBODY: u32 = u32::MAX;

/// A chain of particles, each linked to the next: a rope, or a part of one that is left between particles that have died.
#[derive(Clone, Copy)]
pub(super) struct Chain<'m> {
    /// The rows of its particles.
    pub(super) rows: &'m [u32],
    /// The number of the first of these, and of how many the whole rope has.
    pub(super) first: usize,
    pub(super) particles: usize,
    /// How long the rope's links are at rest, the last of which holds for all further ones \[m\].
    pub(super) lengths: &'m [f32],
    /// How far each link gives way \[m/N\].
    pub(super) compliance: f32,
    /// True if links only pull.
    pub(super) tether: bool,
    /// True if a link joins the last particle to the first.
    pub(super) closed: bool,
    /// What the rope's first and its last particle are joined to, if any of both is.
    pub(super) held: &'m [Option<Held>],
}

impl<'m> Chain<'m> {
    /// The number of its links.
    pub(super) fn links(&self) -> usize {
        self.rows.len() - usize::from(!self.closed && !self.rows.is_empty())
    }

    /// The number that a particle of it, or its link to the next, has in the whole rope.
    pub(super) fn number(&self, particle: usize) -> usize {
        (self.first + particle) % self.particles.max(1)
    }

    /// How long a link is to be \[m\].
    pub(super) fn length(&self, link: usize) -> f32 {
        self.lengths.get(self.number(link)).or(self.lengths.last()).copied().unwrap_or(0.0)
    }

    /// The numbers of a link's ends among its particles.
    pub(super) fn ends(&self, link: usize) -> [usize; 2] {
        let next = link + 1;
        [link, if next == self.rows.len() { 0 } else { next }]
    }

    /// The number of the link that ends at a particle, and of the particle before; of the first one, as if the chain were closed.
    pub(super) fn before(&self, particle: usize) -> usize {
        particle.checked_sub(1).unwrap_or(self.rows.len() - 1)
    }

    /// The rows of its particles, with their numbers in it.
    pub(super) fn members(self) -> impl Iterator<Item = (usize, usize)> + Clone + use<'m> {
        self.rows.iter().map(|&row| row as usize).enumerate()
    }

    /// What a particle of it is joined to.
    pub(super) fn held(&self, particle: usize) -> Option<&'m Held> {
        let number = self.number(particle);
        let is_last = number + 1 == self.particles;
        let end = if number == 0 || is_last { self.held.get(usize::from(is_last))? } else { &None };
        end.as_ref()
    }

    /// Tells whether nobody in it is fixed.
    pub(super) fn is_free(&self, bodies: &Bodies<'_>) -> bool {
        self.members().all(|(particle, row)| self.weight(bodies, particle, row) > 0.0)
    }

    /// The inverse mass of a particle, which is zero as well if it is joined to what nothing moves \[1/kg\].
    pub(super) fn weight(&self, bodies: &Bodies<'_>, particle: usize, row: usize) -> f32 {
        let own = bodies.inverse_mass.get(row).copied().unwrap_or(0.0);
        if self.held(particle).is_some_and(Held::is_fixed) { 0.0 } else { own }
    }

    /// Fills rows by the numbers of the rope's particles. Those of a closed one that is broken begin behind a gap, so that no part goes on at its beginning.
    pub(super) fn filled(self, bodies: &Bodies<'_>, particles: &[u32], rows: &'m mut [u32]) -> Self {
        for (row, &number) in rows.iter_mut().zip(particles) {
            *row = bodies.row_of_start(number).map_or(NOBODY, |row| row as u32);
        }
        let gap = rows.iter().position(|&row| row == NOBODY).filter(|_| self.closed);
        let first = gap.map_or(0, |gap| gap + 1);
        rows.rotate_left(first);
        Self { rows, first, ..self }
    }

    /// The parts in which it is, of two particles or more.
    pub(super) fn parts(self) -> impl Iterator<Item = Self> + use<'m> {
        let mut first = self.first;
        let part = move |rows: &'m [u32]| {
            let part = Self { rows, first, closed: self.closed && rows.len() == self.particles, ..self };
            first += rows.len() + 1;
            part
        };
        self.rows.split(|&row| row == NOBODY).map(part).filter(|part| part.rows.len() > 1)
    }
}
