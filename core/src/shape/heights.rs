//! A height field that owns its heights, and the same as files have it.

use super::{BadHeights, HeightField};
use alloc::sync::Arc;
use alloc::vec;
use alloc::vec::Vec;
use glam::Vec3;

/// A height field on the heap.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(try_from = "Heights", into = "Heights"))]
pub struct HeightFieldBuf {
    heights: Arc<[f32]>,
    sums: Arc<[u64]>,
    blocks: Arc<[[f32; 2]]>,
    /// The same with no memory of its own.
    grid: HeightField<'static>,
}

/// A height field as files have it.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Heights {
    /// The place of height zero in the first column and row \[m\].
    #[cfg_attr(feature = "schema", schemars(with = "[f32; 3]"))]
    pub origin: Vec3,
    /// How far apart neighbouring columns are in x, and rows in z \[m\].
    pub spacing: f32,
    /// The number of heights in a row.
    pub columns: u32,
    /// Heights over the origin, row by row \[m\].
    pub heights: Vec<f32>,
}

impl HeightFieldBuf {
    /// The same, borrowed.
    #[must_use]
    pub fn view(&self) -> HeightField<'_> {
        HeightField { heights: &self.heights, sums: &self.sums, blocks: &self.blocks, ..self.grid }
    }
}

impl TryFrom<Heights> for HeightFieldBuf {
    type Error = BadHeights;

    /// # Errors
    /// As `HeightField::new`.
    fn try_from(file: Heights) -> Result<Self, BadHeights> {
        let field = HeightField::new(file.origin, file.spacing, file.columns as usize, &file.heights)?;
        let mut sums = vec![0; field.cell_count()];
        let mut blocks = vec![[0.0; 2]; field.block_count()];
        let field = field.with_sums(&mut sums).with_blocks(&mut blocks);
        let grid = HeightField { heights: &[], sums: &[], blocks: &[], ..field };
        Ok(Self { grid, heights: file.heights.into(), sums: sums.into(), blocks: blocks.into() })
    }
}

impl From<HeightFieldBuf> for Heights {
    fn from(field: HeightFieldBuf) -> Self {
        let HeightField { origin, spacing, columns, .. } = field.grid;
        Self { origin, spacing, columns: columns as u32, heights: field.heights.to_vec() }
    }
}

#[cfg(feature = "schema")]
impl schemars::JsonSchema for HeightFieldBuf {
    fn schema_name() -> alloc::borrow::Cow<'static, str> {
        Heights::schema_name()
    }
    fn json_schema(generator: &mut schemars::SchemaGenerator) -> schemars::Schema {
        Heights::json_schema(generator)
    }
}
