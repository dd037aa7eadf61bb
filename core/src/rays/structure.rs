//! The structures by name.

use crate::named::by_name;

/// How pieces are organised, by its name, as files and the command line say it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "snake_case"))]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema), schemars(rename = "RayStructure"))]
pub enum Structure {
    /// No structure: every piece is looked at.
    Brute,
    /// Cells of one size.
    Grid,
    /// Cubes cut into eighths.
    Octree,
    /// Boxes cut by planes across the axes where that pays most.
    Kd,
    /// Parts cut by planes of any orientation.
    Bsp,
    /// Boxes cut where those of both parts become small.
    Bvh,
}

impl Structure {
    /// All of them.
    pub const ALL: &'static [Self] = &[Self::Brute, Self::Grid, Self::Octree, Self::Kd, Self::Bsp, Self::Bvh];

    /// Its name.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Brute => "brute",
            Self::Grid => "grid",
            Self::Octree => "octree",
            Self::Kd => "kd",
            Self::Bsp => "bsp",
            Self::Bvh => "bvh",
        }
    }
}

by_name!(Structure, UnknownStructure, "structure");
