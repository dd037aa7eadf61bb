//! Formats of files, by the end of their names.

/// A format of recordings.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "clap", derive(clap::ValueEnum))]
pub enum RecordFormat {
    /// A table with a head line.
    Csv,
    /// The same, each line a JSON object.
    Jsonl,
    /// Each record a line of JSON, with a list for each column.
    #[cfg_attr(feature = "clap", value(skip))]
    Frames,
    /// Atoms, all records in one file.
    Xyz,
    /// Arrays for NumPy, one a column and record, in one archive.
    Npz,
    /// The same, one file each.
    Npy,
    /// Points, faces and edges, one file a record.
    Ply,
    /// The same as text.
    Obj,
    /// The same for ParaView, with an index of the records (.pvd).
    Vtp,
    /// The same for viewers, all records in one animation.
    Glb,
    /// The same as text.
    Gltf,
}

impl RecordFormat {
    /// Those that have an end of names of their own.
    pub const ALL: [Self; 10] = [
        Self::Csv,
        Self::Jsonl,
        Self::Xyz,
        Self::Npz,
        Self::Npy,
        Self::Ply,
        Self::Obj,
        Self::Vtp,
        Self::Glb,
        Self::Gltf,
    ];

    /// The end of its files' names.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Csv => "csv",
            Self::Jsonl | Self::Frames => "jsonl",
            Self::Xyz => "xyz",
            Self::Npz => "npz",
            Self::Npy => "npy",
            Self::Ply => "ply",
            Self::Obj => "obj",
            Self::Vtp => "vtp",
            Self::Glb => "glb",
            Self::Gltf => "gltf",
        }
    }

    /// Tells whether one file can hold all records.
    pub fn holds_many(self) -> bool {
        !matches!(self, Self::Npy | Self::Ply | Self::Obj | Self::Vtp)
    }
}

/// A format of events.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "clap", derive(clap::ValueEnum))]
pub enum EventsFormat {
    /// A table with a head line.
    Csv,
    /// The same, each line a JSON object.
    Jsonl,
}

/// A format of points.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "clap", derive(clap::ValueEnum))]
pub enum PointsFormat {
    /// A table, with or without a head line.
    Csv,
    /// Point clouds and meshes, text or binary.
    Ply,
    /// Atoms, or lines of three numbers.
    Xyz,
    /// An array as NumPy saves it.
    Npy,
}
