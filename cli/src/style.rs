//! The lecture's ways to draw particles, for scenes that do not say theirs, or to see them in another.

use clap::ValueEnum;
use pointmass::material::{
    Blend, ContactMaterial, Facing, Heading, Material, MaterialList, SpriteMaterial, TrailMaterial,
};

/// A way to draw particles.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum Style {
    /// Points of a pixel or two
    Points,
    /// Pictures; puffs, where the scene says none
    Sprites,
    /// Shapes; balls, where the scene says none
    Shapes,
    /// Points and the ways they have come, a second long where the scene says nothing
    Trails,
    /// Points, and lines where springs join them: red where longer than at rest, blue where shorter
    Lines,
}

/// A scene's materials as a style draws them, and one more for particles that have none.
pub(crate) struct Styled<'a> {
    pub(crate) materials: &'a dyn MaterialList,
    pub(crate) style: Style,
}

impl Styled<'_> {
    /// The column of particles' materials, in which those without one have the last.
    pub(crate) fn column(&self, material: &[u16]) -> Vec<u16> {
        let last = u16::try_from(self.materials.count()).map_or(0, |count| count.saturating_add(1));
        material.iter().map(|&number| if number == 0 { last } else { number }).collect()
    }
}

impl MaterialList for Styled<'_> {
    fn count(&self) -> usize {
        self.materials.count() + 1
    }

    fn get(&self, number: usize) -> Option<Material<'_>> {
        let plain = || (number == self.materials.count()).then(|| Material::of(ContactMaterial::default()));
        let own = self.materials.get(number).or_else(plain)?;
        let bare = Material { sprite: None, heading: None, trail: None, ..own };
        let puff = SpriteMaterial { frames: 1, rate: 0.0, blend: Blend::Alpha, facing: Facing::Camera };
        let trail = TrailMaterial { seconds: 1.0, width: 0.0 };
        Some(match self.style {
            Style::Points | Style::Lines => Material { size: 0.0, ..bare },
            Style::Sprites => Material { sprite: own.sprite.or(Some(puff)), ..bare },
            Style::Shapes => Material { heading: own.heading.or(Some(Heading::Upright)), ..bare },
            Style::Trails => Material { size: 0.0, trail: own.trail.or(Some(trail)), ..bare },
        })
    }
}
