//! What shells are made of.

/// What a sheet is made of, by numbers that do not depend on its mesh.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct ShellParams {
    /// Young's modulus times thickness along the warp and along the weft \[N/m\]: a strip of that width is stretched by a share
    /// s of its length with a pull of s times as much for each metre of its width. Woven cotton has about 2,000, jersey 100.
    pub stretch: [f32; 2],
    /// Shear modulus times thickness \[N/m\], for the angle between warp and weft. What is the same in all directions has the
    /// stretch over 2 + 2 ν, with Poisson's ratio ν; cloth has much less.
    pub shear: f32,
    /// Bending stiffness \[N m\]: a strip is bent to a radius R by a moment of so much over R for each metre of its width. Silk has
    /// about 1e-6, cotton 1e-5, denim 1e-4, paper 1e-3.
    #[cfg_attr(feature = "serde", serde(default))]
    pub bending: f32,
    /// How long stresses take to fade whose strain stands still \[s\] (Kelvin and Voigt): a stress is that of the strain and of so
    /// many seconds of its rate.
    #[cfg_attr(feature = "serde", serde(default))]
    pub damping: f32,
}

impl ShellParams {
    /// A plate of a thickness \[m\], of a material that is the same in all directions, with its Young's modulus \[Pa\] and Poisson's ratio ν,
    /// which is above -1 and up to 0.5, without damping: E t along warp and weft, G t = E t / (2 + 2 ν) between them, and D = E t³ / (12 (1 − ν²)) against bending (Timoshenko and
    /// Woinowsky-Krieger, "Theory of Plates and Shells", 1959, article 2). Paper has some 3 GPa, 0.3 and 0.1 mm, rubber 5 MPa and 0.5,
    /// aluminium foil 70 GPa, 0.35 and 15 µm.
    ///
    /// Shells have no Poisson's ratio between warp and weft: what is pulled along one does not get narrower, and a strip that is pulled along either
    /// has the modulus E; one that is pulled at 45° to them E / (1 + ν/2). What is bent in one direction does not bend in the other either. So wide plates,
    /// and those whose rims are clamped, bend as theory has it; a narrow strip that is clamped at its ends alone, a beam of E I, is stiffer than that by
    /// 1 / (1 − ν²).
    #[must_use]
    pub const fn isotropic(young: f32, poisson: f32, thickness: f32) -> Self {
        let stretch = young * thickness;
        let bending = stretch * thickness * thickness / (12.0 * (1.0 - poisson * poisson));
        Self { stretch: [stretch; 2], shear: 0.5 * stretch / (1.0 + poisson), bending, damping: 0.0 }
    }

    /// The first of its numbers that cannot be used, and what it has to be.
    #[must_use]
    pub fn fault(&self) -> Option<(&'static str, &'static str)> {
        let [warp, weft] = self.stretch;
        [
            ("stretch", warp, "must not be below zero, in N/m"),
            ("stretch", weft, "must not be below zero, in N/m"),
            ("shear", self.shear, "must not be below zero, in N/m"),
            ("bending", self.bending, "must not be below zero, in N m"),
            ("damping", self.damping, "must not be below zero, in s"),
        ]
        .into_iter()
        .find(|&(_, value, _)| !(0.0..f32::INFINITY).contains(&value))
        .map(|(name, _, message)| (name, message))
    }
}
