//! What parts of a scene file name by number: materials, and the groups that they stand in.

use super::numbers::Checked;
use super::{Group, SceneError, SceneFile};
use crate::particles::Color;
use crate::shape::Affine;
use alloc::format;
use alloc::vec::Vec;

/// The largest number of materials: particles keep their number plus one in 16 bits.
pub(super) const MAX_MATERIALS: usize = u16::MAX as usize;

/// How deep groups may stand in each other.
pub(super) const MAX_GROUPS: usize = 1024;

impl Group {
    /// Its matrix as a map of space.
    ///
    /// # Errors
    /// If the last row is not 0 0 0 1, or the map cannot be undone.
    pub fn affine(&self) -> Result<Affine, &'static str> {
        super::inline::affine(self.matrix)
    }
}

impl SceneFile {
    /// The groups around a piece of scenery, the outermost first.
    pub(super) fn chain(&self, group: Option<u32>) -> Vec<u32> {
        let mut chain = Vec::new();
        let mut next = group;
        while let Some(index) = next {
            chain.push(index);
            // Parents come before their children, so this ends.
            next = self.groups.get(index as usize).and_then(|g| g.parent).filter(|&parent| parent < index);
        }
        chain.reverse();
        chain
    }

    /// The material that a group gives, or the nearest around it that has one.
    pub(super) fn material_of(&self, group: Option<u32>) -> Option<u16> {
        self.chain(group).iter().rev().find_map(|&index| self.groups.get(index as usize)?.material)
    }

    pub(super) fn check_material(&self, at: &str, material: Option<u16>) -> Checked {
        match material {
            Some(number) if usize::from(number) >= self.materials.len() => {
                let count = self.materials.len();
                let message = format!("{number} is out of range; there are {count}, from 0");
                Err(SceneError::value(format!("{at}.material"), message))
            }
            _ => Ok(()),
        }
    }

    pub(super) fn check_group(&self, at: &str, group: Option<u32>) -> Checked {
        let count = self.groups.len();
        match group {
            Some(group) if group as usize >= count => {
                let message = format!("{group} is out of range; there are {count}, from 0");
                Err(SceneError::value(format!("{at}.group"), message))
            }
            _ => Ok(()),
        }
    }
}

/// The colour that a particle has by itself, or by its material.
pub(super) fn color(file: &SceneFile, own: Option<Color>, material: Option<u16>) -> Option<Color> {
    own.or_else(|| Some(file.materials.get(usize::from(material?))?.color()))
}
