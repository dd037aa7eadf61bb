//! Spring meshes: particles joined into cloth, along its threads, across its cells, and against bending.

use crate::force::Spring;
use crate::math::length;
use crate::particles::Particle;
use glam::Vec3;

/// The stiffness and damping of one kind of a mesh's springs.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct SpringParams {
    /// Stiffness \[N/m\].
    pub ks: f32,
    /// Damping \[N s/m\].
    #[cfg_attr(feature = "serde", serde(default))]
    pub kd: f32,
}

/// A mesh's springs by kind; a kind that is none has no springs.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(default, deny_unknown_fields))]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct ClothSprings {
    /// Along the edges: against stretching.
    #[cfg_attr(feature = "serde", serde(skip_serializing_if = "Option::is_none"))]
    pub structural: Option<SpringParams>,
    /// Across the cells of a sheet, both ways: against shearing.
    #[cfg_attr(feature = "serde", serde(skip_serializing_if = "Option::is_none"))]
    pub shear: Option<SpringParams>,
    /// Over two cells of a sheet, or between the far corners of two triangles with a common edge: against bending.
    #[cfg_attr(feature = "serde", serde(skip_serializing_if = "Option::is_none"))]
    pub bend: Option<SpringParams>,
}

/// A rectangular sheet of cells. It needs no heap: particles and springs come one by one.
///
/// ```
/// use pointmass::{Sheet, SpringParams, ClothSprings, Vec3};
///
/// let threads = ClothSprings { structural: Some(SpringParams { ks: 100.0, kd: 0.1 }), ..ClothSprings::default() };
/// let sheet = Sheet { corner: Vec3::ZERO, sides: [Vec3::X, Vec3::Z], cells: [2, 3] };
/// assert_eq!((sheet.positions().count(), sheet.springs(&threads, 0).count()), (3 * 4, 2 * 4 + 3 * 3));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Sheet {
    /// The corner where its first particle is \[m\].
    #[cfg_attr(feature = "schema", schemars(with = "[f32; 3]"))]
    pub corner: Vec3,
    /// From there to the next corner, along which numbers grow first, and to that on the other side \[m\].
    #[cfg_attr(feature = "schema", schemars(with = "[[f32; 3]; 2]"))]
    pub sides: [Vec3; 2],
    /// The number of cells along each.
    pub cells: [u32; 2],
}

impl Sheet {
    /// The number of the particle at a crossing: `along` the first side, `across` along the second; beyond all numbers the largest there is.
    #[must_use]
    pub const fn number(&self, along: u32, across: u32) -> u32 {
        across.saturating_mul(self.cells[0].saturating_add(1)).saturating_add(along)
    }

    /// Where its particles are, by number.
    pub fn positions(&self) -> impl Iterator<Item = Vec3> {
        let Self { corner, sides: [u, v], cells } = *self;
        let part = |i: u32, n: u32| if n == 0 { 0.0 } else { i as f32 / n as f32 };
        (0..=cells[1]).flat_map(move |across| {
            (0..=cells[0]).map(move |along| corner + u * part(along, cells[0]) + v * part(across, cells[1]))
        })
    }

    /// Its particles by number, each `like` the given one but in its place.
    pub fn particles(&self, like: Particle) -> impl Iterator<Item = Particle> {
        self.positions().map(move |position| Particle { position, ..like })
    }

    /// Its springs, of which the particle with number 0 is `first` in the scene's start. Ends beyond all numbers are the largest there is, where
    /// nobody is.
    pub fn springs(&self, springs: &ClothSprings, first: u32) -> impl Iterator<Item = Spring> {
        let sheet = *self;
        let ClothSprings { structural, shear, bend } = *springs;
        // How far a spring goes along and across, and what it is made of. Those that run backward start one cell later.
        let kinds = [
            ([1, 0], structural),
            ([0, 1], structural),
            ([1, 1], shear),
            ([-1, 1], shear),
            ([2, 0], bend),
            ([0, 2], bend),
        ];
        kinds.into_iter().filter_map(|(way, params)| Some((way, params?))).flat_map(move |(way, params)| {
            (0..=sheet.cells[1]).flat_map(move |across| {
                (0..=sheet.cells[0]).filter_map(move |along| sheet.spring([along, across], way, params, first))
            })
        })
    }

    fn spring(&self, from: [u32; 2], way: [i32; 2], params: SpringParams, first: u32) -> Option<Spring> {
        let [u, v] = [0, 1].map(|i| from[i].checked_add_signed(way[i]).filter(|&to| to <= self.cells[i]));
        let ends = [self.number(from[0], from[1]), self.number(u?, v?)].map(|number| first.saturating_add(number));
        let part = |i: usize| self.sides[i] * (way[i] as f32 / self.cells[i] as f32);
        // A side that is not gone along may have no cells.
        let step = (0..2).filter(|&i| way[i] != 0).map(part).fold(Vec3::ZERO, |sum, part| sum + part);
        Some(Spring::new(ends, length(step), params.ks).damped(params.kd))
    }

    /// The edges over which its [triangles](Sheet::triangles) bend: across each cell, then those along the first side, then those along
    /// the second.
    pub fn hinges(&self) -> impl Iterator<Item = Hinge> {
        let sheet = *self;
        let [width, height] = self.cells;
        // The corner and the number of the first triangle of a cell.
        let face = move |u: u32, v: u32| v.saturating_mul(width).saturating_add(u).saturating_mul(2).min(u32::MAX - 1);
        let cell = move |u: u32, v: u32| (sheet.number(u, v), face(u, v));
        let corners = move |u: u32, v: u32| {
            [sheet.number(u, v), sheet.number(u + 1, v), sheet.number(u, v + 1), sheet.number(u + 1, v + 1)]
        };
        let grid = |from: [u32; 2]| (from[1]..height).flat_map(move |v| (from[0]..width).map(move |u| (u, v)));
        let across = grid([0, 0]).map(move |(u, v)| {
            let ([a, b, c, d], (_, face)) = (corners(u, v), cell(u, v));
            Hinge { edge: [a, d], far: [c, b], faces: [face + 1, face] }
        });
        let along = grid([0, 1]).map(move |(u, v)| {
            let ([a, b, _, d], (below, face)) = (corners(u, v), cell(u, v - 1));
            Hinge { edge: [a, b], far: [d, below], faces: [cell(u, v).1, face + 1] }
        });
        let aside = grid([1, 0]).map(move |(u, v)| {
            let ([a, _, c, d], (before, face)) = (corners(u, v), cell(u - 1, v));
            Hinge { edge: [a, c], far: [before, d], faces: [face, cell(u, v).1 + 1] }
        });
        across.chain(along).chain(aside)
    }

    /// Two triangles for each cell, turned the same way.
    pub fn triangles(&self) -> impl Iterator<Item = [u32; 3]> {
        let sheet = *self;
        (0..sheet.cells[1]).flat_map(move |v| {
            (0..sheet.cells[0]).flat_map(move |u| {
                let [a, b] = [sheet.number(u, v), sheet.number(u + 1, v)];
                let [c, d] = [sheet.number(u, v + 1), sheet.number(u + 1, v + 1)];
                [[a, b, d], [a, d, c]]
            })
        })
    }
}

/// An edge over which two triangles bend.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Hinge {
    /// The vertices of the edge.
    pub edge: [u32; 2],
    /// The third vertex of each triangle.
    pub far: [u32; 2],
    /// The numbers of the triangles.
    pub faces: [u32; 2],
}

impl Hinge {
    /// All four vertices: those of the edge, then the far ones.
    #[must_use]
    pub const fn corners(&self) -> [u32; 4] {
        [self.edge[0], self.edge[1], self.far[0], self.far[1]]
    }

    /// 1 if a triangle goes along the edge in its sense, −1 if it goes against it.
    pub(crate) fn sign(&self, [a, b, c]: [u32; 3]) -> f32 {
        if [[a, b], [b, c], [c, a]].contains(&self.edge) { 1.0 } else { -1.0 }
    }
}

/// The edges over which a triangle mesh bends, by the numbers of their vertices: those that two triangles have in common. Edges of three
/// and more do not bend.
#[cfg(feature = "alloc")]
#[must_use]
pub fn mesh_hinges(triangles: &[[u32; 3]]) -> alloc::vec::Vec<Hinge> {
    use alloc::collections::BTreeMap;
    // Each edge once, with the corners that lie opposite and their triangles.
    let mut edges: BTreeMap<[u32; 2], alloc::vec::Vec<[u32; 2]>> = BTreeMap::new();
    for (face, &[a, b, c]) in triangles.iter().enumerate() {
        for [from, to, far] in [[a, b, c], [b, c, a], [c, a, b]] {
            if from != to && to != far && far != from {
                edges.entry([from.min(to), from.max(to)]).or_default().push([far, face as u32]);
            }
        }
    }
    let pairs = edges.into_iter().filter_map(|(edge, sides)| Some((edge, <[[u32; 2]; 2]>::try_from(sides).ok()?)));
    let hinges = pairs.map(|(edge, [[c, first], [d, second]])| Hinge { edge, far: [c, d], faces: [first, second] });
    hinges.filter(|hinge| hinge.far[0] != hinge.far[1]).collect()
}

/// The springs of a triangle mesh, of which vertex 0 is particle `first` in the scene's start: one along every edge, and
/// where two triangles share it one between their far corners. Triangles have no cells, so there are none across. Ends beyond all numbers are
/// the largest there is, where nobody is.
#[cfg(feature = "alloc")]
#[must_use]
pub fn mesh_springs(
    vertices: &[Vec3],
    triangles: &[[u32; 3]],
    springs: &ClothSprings,
    first: u32,
) -> alloc::vec::Vec<Spring> {
    use alloc::collections::BTreeMap;
    // Each edge once, with the corners that lie opposite.
    let mut edges: BTreeMap<[u32; 2], alloc::vec::Vec<u32>> = BTreeMap::new();
    for &[a, b, c] in triangles {
        for [from, to, far] in [[a, b, c], [b, c, a], [c, a, b]] {
            if from != to {
                edges.entry([from.min(to), from.max(to)]).or_default().push(far);
            }
        }
    }
    let spring = |[a, b]: [u32; 2], params: SpringParams| {
        let ends = vertices.get(a as usize).zip(vertices.get(b as usize))?;
        let ends_of = [a, b].map(|end| first.saturating_add(end));
        Some(Spring::new(ends_of, length(*ends.1 - *ends.0), params.ks).damped(params.kd))
    };
    let along =
        springs.structural.into_iter().flat_map(|params| edges.keys().filter_map(move |&edge| spring(edge, params)));
    let over = springs.bend.into_iter().flat_map(|params| {
        let pairs = edges.values().filter_map(|far| <[u32; 2]>::try_from(far.as_slice()).ok());
        pairs.filter(|[a, b]| a != b).filter_map(move |pair| spring(pair, params))
    });
    along.chain(over).collect()
}
