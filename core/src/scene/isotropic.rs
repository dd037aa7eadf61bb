//! Plates, foils and skins in scene files: by the modulus and the thickness of their material, which is the same in all directions.

use super::SceneError;
#[cfg(feature = "serde")]
use super::numbers::usual_poisson;
use super::numbers::{Checked, above_zero, zero_or_more};
use crate::constrain::ShellParams;
use alloc::format;

/// What a sheet or a mesh is made of, if that is the same in all directions. However fine it is divided, that changes neither what it weighs nor what it
/// does. See [`ShellParams::isotropic`].
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Isotropic {
    /// Young's modulus E \[Pa\]; rubber has 5e6, paper some 3e9, aluminium 7e10, steel 2e11. A strip that is pulled along a side has it; a sheet that hangs by an
    /// edge is longer by a share ρ g L / (2 E).
    pub young: f32,
    /// Poisson's ratio ν, from 0 to 0.5: it says how stiff it is against shear, E / (2 + 2 ν), and against bending. What is stretched does not get
    /// narrower by it.
    #[cfg_attr(feature = "serde", serde(default = "usual_poisson"))]
    pub poisson: f32,
    /// How thick the material is \[m\]; the cloth's own `thickness` is for what it touches.
    pub thickness: f32,
    /// The mass of a cubic metre \[kg/m³\], in place of the cloth's `mass` and its `density` for each square metre; rubber has 1100, steel 7850.
    #[cfg_attr(feature = "serde", serde(default, skip_serializing_if = "Option::is_none"))]
    pub density: Option<f32>,
    /// Bending stiffness \[N m\], if it is not that of a solid plate, E t³ / (12 (1 − ν²)): zero for what is as limp as a skin.
    #[cfg_attr(feature = "serde", serde(default, skip_serializing_if = "Option::is_none"))]
    pub bending: Option<f32>,
    /// How long stresses take to fade whose strain stands still \[s\].
    #[cfg_attr(feature = "serde", serde(default))]
    pub damping: f32,
}

impl Isotropic {
    /// The mass of a square metre \[kg/m²\], if it says that of a cubic metre.
    pub(super) fn by_area(self) -> Option<f32> {
        self.density.map(|density| density * self.thickness)
    }

    /// The numbers of a shell.
    pub(super) fn params(self) -> ShellParams {
        let plate = ShellParams::isotropic(self.young, self.poisson, self.thickness);
        ShellParams { bending: self.bending.unwrap_or(plate.bending), damping: self.damping, ..plate }
    }

    pub(super) fn check(self, at: &str) -> Checked {
        let refuse = |field: &str, message: &str| Err(SceneError::value(format!("{at}.{field}"), message));
        let density = self.density.unwrap_or(1.0);
        for (name, number) in [("young", self.young), ("thickness", self.thickness), ("density", density)] {
            above_zero(&format!("{at}.{name}"), number)?;
        }
        for (name, number) in [("bending", self.bending.unwrap_or(0.0)), ("damping", self.damping)] {
            zero_or_more(&format!("{at}.{name}"), number)?;
        }
        if !(0.0..=0.5).contains(&self.poisson) {
            return refuse("poisson", &format!("has to be from 0 to 0.5, not {}", self.poisson));
        }
        let params = self.params();
        if !(params.stretch[0] > 0.0) || params.fault().is_some() {
            return refuse("young", "and thickness make it stiffer or softer than 32-bit floats can tell");
        }
        match self.by_area() {
            Some(by_area) if !(by_area > 0.0 && by_area.is_finite()) => {
                refuse("density", "and thickness make it heavier or lighter than 32-bit floats can tell")
            }
            _ => Ok(()),
        }
    }
}
