//! What lies behind a scene and between it and the eye: sky and fog.

/// A background that changes with the elevation e of the line of sight. In linear light it is `horizon` at e = 0; above, the share of
/// `zenith` is 1 − (1 − sin e)³, and below, that of `ground` is 1 − (1 + sin e)³.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Sky {
    /// The colour straight up.
    pub zenith: [f32; 3],
    /// The colour in all level directions.
    pub horizon: [f32; 3],
    /// The colour straight down; without one, that of the horizon.
    #[cfg_attr(feature = "serde", serde(default, skip_serializing_if = "Option::is_none"))]
    pub ground: Option<[f32; 3]>,
}

/// Fog of one density everywhere: of the light from a distance d the share exp(−`density` · (d − `from`)) arrives, and fog's own color takes
/// the place of the rest (the law of Bouguer and Beer). The background is not in it.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Fog {
    /// Its colour; without one, that of the background in the same direction, into which things fade then.
    #[cfg_attr(feature = "serde", serde(default, skip_serializing_if = "Option::is_none"))]
    pub color: Option<[f32; 3]>,
    /// The coefficient of extinction, zero or more \[1/m\].
    pub density: f32,
    /// The distance from the eye at which it begins, zero or more \[m\].
    #[cfg_attr(feature = "serde", serde(default))]
    pub from: f32,
}
