//! What strands are made of.

use core::f32::consts::PI;

/// What a strand is made of, by numbers that do not depend on how finely it is divided.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct StrandParams {
    /// Young's modulus times the area of the section, E A \[N\]: a pull of a hundredth of that makes it longer by a hundredth. Without it
    /// the strand does not stretch.
    #[cfg_attr(feature = "serde", serde(default, skip_serializing_if = "Option::is_none"))]
    pub stretch: Option<f32>,
    /// Bending stiffness E I \[N m²\] about the two principal axes of the section: a moment of so much over R bends it to a radius R.
    pub bending: [f32; 2],
    /// Twisting stiffness G J \[N m²\]: a torque of so much over l twists a length l of it by a radian.
    pub twisting: f32,
    /// How long stresses take to fade whose strain stands still \[s\] (Kelvin and Voigt): a stress is that of the strain and of so
    /// many seconds of its rate.
    #[cfg_attr(feature = "serde", serde(default))]
    pub damping: f32,
}

impl StrandParams {
    /// A solid round strand of a radius \[m\], of a material of Young's modulus \[Pa\] and Poisson's ratio, without damping: E A = E π r²,
    /// E I = E π r⁴ / 4 and G J = E π r⁴ / (4 + 4 ν). Hair has 40 µm, 4 GPa and 0.35, grass some 1 GPa, rubber 5 MPa and 0.5, steel 200 GPa and
    /// 0.3.
    #[must_use]
    pub const fn round(radius: f32, young: f32, poisson: f32) -> Self {
        let stretch = young * PI * radius * radius;
        let bending = 0.25 * stretch * radius * radius;
        Self { stretch: Some(stretch), bending: [bending; 2], twisting: bending / (1.0 + poisson), damping: 0.0 }
    }

    /// The first of its numbers that cannot be used, and what it has to be.
    #[must_use]
    pub fn fault(&self) -> Option<(&'static str, &'static str)> {
        let not_negative = |x: f32| (0.0..f32::INFINITY).contains(&x);
        let stretches = self.stretch.is_none_or(|stretch| stretch > 0.0 && stretch < f32::INFINITY);
        let faults = [
            (!stretches, "stretch", "has to be above zero, in N"),
            (!self.bending.into_iter().all(not_negative), "bending", "must not be below zero, in N m²"),
            (!not_negative(self.twisting), "twisting", "must not be below zero, in N m²"),
            (!not_negative(self.damping), "damping", "must not be below zero, in s"),
        ];
        faults.into_iter().find(|&(wrong, ..)| wrong).map(|(_, name, message)| (name, message))
    }
}
