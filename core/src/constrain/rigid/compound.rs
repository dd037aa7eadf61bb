//! Forms of bodies that are not convex: several hulls that keep together.

use super::cut::cut;
use super::hull::{Hull, eight};
use super::hull_buf::{HullBuf, HullError};
use super::rigid_box::RigidBox;
use crate::math::high;
use crate::particles::Particle;
use crate::shape::MeshBuf;
use crate::shape::enclosed::{Enclosed, Moments, NotSolid};
use alloc::vec::Vec;
use core::fmt;
use glam::{Mat3, Vec3};

/// The form of a body of several convex pieces, about its centre of mass.
///
/// ```
/// use pointmass::constrain::{CompoundBuf, RigidBodies, RigidBox};
/// use pointmass::{Particle, Vec3};
///
/// // An L of two boxes: its centre of mass lies in the corner that is left open.
/// let bar = |low: Vec3, high: Vec3| (0..8).map(move |i| Vec3::from_array([0, 1, 2].map(|k| if i >> k & 1 == 1 { high[k] } else { low[k] })));
/// let foot = bar(Vec3::ZERO, Vec3::new(3.0, 1.0, 1.0)).collect::<Vec<_>>();
/// let back = bar(Vec3::new(0.0, 1.0, 0.0), Vec3::new(1.0, 4.0, 1.0)).collect::<Vec<_>>();
/// let form = CompoundBuf::of(&[foot, back])?;
/// assert!((form.volume() - 6.0).abs() < 1e-5);
/// let body = RigidBox::with_compound(&form, 0, Vec3::Y, 0);
/// let start = body.solid_compound(&form, Particle { mass: 2.0, ..Particle::REST });
/// let bodies = RigidBodies { boxes: [body], hulls: form.pieces().to_vec(), balls: 0 };
/// assert_eq!((start.len(), bodies.fault()), (8, None));
/// # Ok::<(), pointmass::constrain::CompoundError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct CompoundBuf {
    pieces: Vec<HullBuf>,
    volume: f32,
    spread: Mat3,
    center: Vec3,
    leaves: f32,
}

/// Why there is no such form.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum CompoundError {
    /// The points of the piece with this number have no hull that could be used.
    Hull(usize, HullError),
    /// The mesh encloses no solid.
    Solid(NotSolid),
    /// There are no pieces, or more than a body may have.
    Pieces(usize),
    /// So many pieces, as many as there may be, are still so far off the mesh \[m\].
    Coarse(usize, f32),
    /// How far pieces may be off the mesh is less than nothing \[m\], or no number.
    Within(f32),
}

impl fmt::Display for CompoundError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Hull(piece, error) => write!(f, "piece {piece} {error}"),
            Self::Solid(error) => error.fmt(f),
            Self::Pieces(count) => write!(f, "has {count} pieces; there have to be from 1 to {MOST}"),
            Self::Coarse(count, far) => {
                write!(
                    f,
                    "cannot be cut into {count} pieces within that: they are still {far:?} m off it in some place"
                )
            }
            Self::Within(within) => {
                write!(f, "cannot be cut within {within:?} m: that has to be a number from zero on")
            }
        }
    }
}

impl core::error::Error for CompoundError {}

/// The most pieces that a body may have.
const MOST: usize = 255;

impl CompoundBuf {
    /// The convex hulls of several groups of points \[m\], put about the centre of mass of all of them. What lies in several pieces counts as
    /// often in its mass.
    ///
    /// # Errors
    /// If there are none or more than 255, or one has no hull.
    pub fn of(pieces: &[Vec<Vec3>]) -> Result<Self, CompoundError> {
        if !(1..=MOST).contains(&pieces.len()) {
            return Err(CompoundError::Pieces(pieces.len()));
        }
        let hull = |(number, points): (usize, &Vec<Vec3>)| {
            HullBuf::in_place(points).map_err(|error| CompoundError::Hull(number, error))
        };
        let hulls = pieces.iter().enumerate().map(hull).collect::<Result<Vec<_>, _>>()?;
        if let [hull] = &hulls[..] {
            let (volume, spread, center) = (hull.lend().volume(), hull.lend().spread(), hull.lend().center);
            return Ok(Self { pieces: Vec::from([hull.clone().at(Vec3::ZERO)]), volume, spread, center, leaves: 0.0 });
        }
        let triangles = hulls.iter().flat_map(|hull| {
            let hull = hull.lend();
            let places = move |corner: Vec3| (hull.center + corner).to_array().map(f64::from);
            hull.faces.iter().flat_map(move |face| hull.triangles(face)).map(move |corners| corners.map(places))
        });
        Ok(Self::about(Moments::of(triangles), hulls, Vec3::ZERO, 0.0))
    }

    /// A closed mesh, cut into convex pieces that are nowhere farther than `within` \[m\] off its surface, with the mass, centre and inertia of
    /// the solid itself: by planes through its inward edges and across its middle, whichever leave least between the hulls of both sides and the
    /// solid, then whatever may be joined again is. There are `most` pieces at the most, 255 if that is more.
    ///
    /// It takes time with the triangles times the planes that are tried, some 80 for each cut: of 500 triangles some seconds.
    ///
    /// # Errors
    /// If `within` is negative or no number, the mesh is not closed, or so many pieces are not enough.
    pub fn of_mesh(mesh: &MeshBuf, within: f32, most: usize) -> Result<Self, CompoundError> {
        if !(within >= 0.0) {
            return Err(CompoundError::Within(within));
        }
        let Enclosed { origin, triangles, .. } = Enclosed::of(mesh).map_err(CompoundError::Solid)?;
        let (hulls, leaves) = cut(&triangles, within, most.min(MOST));
        if hulls.is_empty() {
            return Err(CompoundError::Hull(0, HullError::Unclear));
        }
        if !(leaves <= within) {
            return Err(CompoundError::Coarse(hulls.len(), leaves));
        }
        Ok(Self::about(Moments::of(triangles.into_iter()), hulls, origin, leaves))
    }

    /// Puts hulls about the centre of mass.
    fn about(moments: Moments, hulls: Vec<HullBuf>, origin: Vec3, leaves: f32) -> Self {
        let vector = |place: [f64; 3]| Vec3::from_array(place.map(|x| x as f32));
        let [x, y, z] = moments.spread.map(vector);
        let center = vector(moments.centroid);
        let shifted = |hull: HullBuf| {
            let place = hull.lend().center - center;
            hull.at(place)
        };
        let (volume, spread) = (moments.volume as f32, Mat3::from_cols(x, y, z));
        let pieces = hulls.into_iter().map(shifted).collect();
        Self { pieces, volume, spread, center: origin + center, leaves }
    }

    /// Its pieces.
    #[must_use]
    pub fn pieces(&self) -> &[HullBuf] {
        &self.pieces
    }

    /// Its volume \[m³\].
    #[must_use]
    pub fn volume(&self) -> f32 {
        self.volume
    }

    /// Where its centre of mass was among what it was made of \[m\].
    #[must_use]
    pub fn center(&self) -> Vec3 {
        self.center
    }

    /// How far its pieces are off the mesh that it was made of \[m\].
    #[must_use]
    pub fn leaves(&self) -> f32 {
        self.leaves
    }

    /// Σ m x xᵀ over its mass, about its centre of mass \[m²\].
    #[must_use]
    pub fn spread(&self) -> Mat3 {
        self.spread
    }

    /// How far it reaches from its centre of mass along each axis \[m\].
    #[must_use]
    pub fn half(&self) -> Vec3 {
        let reach = |hull: Hull<'_>| {
            hull.corners.iter().fold(Vec3::ZERO, |most, &corner| high(most, (hull.center + corner).abs()))
        };
        self.pieces.iter().fold(Vec3::ZERO, |most, piece| high(most, reach(piece.lend())))
    }

    /// Eight places about its centre of mass \[m\] at which eight equal particles have its inertia.
    #[must_use]
    pub fn particles(&self) -> [Vec3; 8] {
        eight(self.spread)
    }
}

impl RigidBox {
    /// An upright body of eight particles that consists of pieces, of which the first has a number among the hulls.
    #[must_use]
    pub fn with_compound(form: &CompoundBuf, number: u16, center: Vec3, first: u32) -> Self {
        let pieces = form.pieces.len() as u16;
        Self { hull: Some(number), pieces, ..Self::new(form.half(), center, first) }
    }

    /// Eight particles that are together as heavy as `whole`, and move as it does, with the inertia of such a solid.
    #[must_use]
    pub fn solid_compound(&self, form: &CompoundBuf, whole: Particle) -> [Particle; 8] {
        self.at(form.particles(), whole)
    }
}
