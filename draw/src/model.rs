//! The stage brought before the lens: triangles in view coordinates, colours in linear light.

use super::camera::Lens;
use super::clip::{Frustum, Vertex};
use super::color::decode;
use super::{Line, Material, Stage};
use glam::Vec3;

/// How wide a line is, in pixels.
const LINE_WIDTH: f32 = 1.4;

/// How much nearer to the eye a line is drawn, so that it shows on the surface it lies on.
const LINE_LIFT: f32 = 0.998;

/// The triangles of a stage.
#[derive(Debug, Default)]
pub(super) struct Model {
    pub(super) facets: Vec<Facet>,
    pub(super) skins: Vec<Skin>,
}

/// A triangle.
#[derive(Clone, Copy, Debug)]
pub(super) struct Facet {
    pub(super) corners: [Vertex; 3],
    /// The normal of the flat triangle, on the outside.
    pub(super) flat: Vec3,
    /// Its material: an index into the model's skins.
    pub(super) skin: usize,
}

/// A material in linear light, and how its piece takes part in the picture.
#[derive(Clone, Copy, Debug)]
pub(super) struct Skin {
    /// The light that it sends out whatever the lamps do.
    pub(super) emission: Vec3,
    /// The light that it returns of the stage's ambient light.
    pub(super) ambient: Vec3,
    pub(super) diffuse: Vec3,
    pub(super) specular: Vec3,
    pub(super) shininess: f32,
    pub(super) opacity: f32,
    /// True if it is of a surface with an edge, such as a disc, which has an inside nowhere.
    pub(super) open: bool,
    pub(super) role: Role,
}

/// How a piece takes part in the picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Role {
    /// It casts shadows.
    Solid,
    /// It casts none, and melts into the background.
    Endless,
    /// It casts none, lies in none, and has no sides: every lamp lights it in full.
    Line,
}

impl Model {
    /// Largest surfaces first: where two lie in the same plane the later one shows, and of a rug
    /// and a floor that should be the rug.
    pub(super) fn new(stage: &Stage, lens: &Lens) -> Self {
        let mut model = Self::default();
        let mut pieces: Vec<_> = stage.pieces.iter().map(|piece| (piece.surface.area(), piece)).collect();
        pieces.sort_by(|(a, _), (b, _)| b.total_cmp(a));
        for (_, piece) in pieces {
            let role = if piece.endless { Role::Endless } else { Role::Solid };
            let skin = model.skin(&piece.material, stage.ambient, role);
            model.skins[skin].open = !piece.surface.is_closed();
            let seen = piece.surface.transformed(lens.turn, lens.shift());
            let lifted = |place: Vec3| place * (1.0 - piece.lift / Lens::depth(place).max(2.0 * piece.lift));
            let lifted = |corners: [Vec3; 3]| if piece.lift > 0.0 { corners.map(lifted) } else { corners };
            let facet = |(corners, normals, tints)| Facet::new(lifted(corners), normals, tints, skin);
            model.facets.extend(seen.corners().map(facet));
        }
        let frustum = Frustum::new(lens);
        for line in &stage.lines {
            let skin = model.skin(&line.material, stage.ambient, Role::Line);
            if let Some([a, b, c, d]) = ribbon(line, lens, &frustum) {
                let (normals, tints) = ([Vec3::Z; 3], [Vec3::ONE; 3]);
                model.facets.push(Facet::new([a, b, c], normals, tints, skin));
                model.facets.push(Facet::new([a, c, d], normals, tints, skin));
            }
        }
        model
    }

    fn skin(&mut self, material: &Material, ambient: Vec3, role: Role) -> usize {
        self.skins.push(Skin {
            emission: decode(material.emission),
            ambient: decode(material.ambient) * decode(ambient),
            diffuse: decode(material.diffuse),
            specular: decode(material.specular),
            // Without an exponent every place would be all highlight.
            shininess: if material.shininess >= 1.0 { material.shininess } else { 1.0 },
            opacity: if material.opacity >= 0.0 { material.opacity.min(1.0) } else { 1.0 },
            open: false,
            role,
        });
        self.skins.len() - 1
    }
}

impl Facet {
    fn new(corners: [Vec3; 3], normals: [Vec3; 3], tints: [Vec3; 3], skin: usize) -> Self {
        let [a, b, c] = corners;
        let flat = (b - a).cross(c - a).normalize_or_zero();
        let outside = flat.dot(normals.iter().sum()) >= 0.0;
        let corner = |at: usize| Vertex { place: corners[at], normal: normals[at], tint: tints[at] };
        Self { corners: [corner(0), corner(1), corner(2)], flat: if outside { flat } else { -flat }, skin }
    }

    /// How far away its middle is.
    pub(super) fn depth(&self) -> f32 {
        self.corners.iter().map(|corner| Lens::depth(corner.place)).sum::<f32>() / 3.0
    }
}

/// The corners of a strip that is equally wide, in the picture, all along.
fn ribbon(line: &Line, lens: &Lens, frustum: &Frustum) -> Option<[Vec3; 4]> {
    if !(line.a.is_finite() && line.b.is_finite()) {
        return None;
    }
    let (a, b) = frustum.clip_line(lens.view(line.a), lens.view(line.b))?;
    let along = (lens.project(b) - lens.project(a)).try_normalize()?;
    // The picture's y points down, so this is the perpendicular of (x, -y).
    let across = Vec3::new(along.y, along.x, 0.0);
    let half = |end: Vec3| across * 0.5 * LINE_WIDTH / lens.pixels_per_metre(Lens::depth(end));
    let corners = [a - half(a), b - half(b), b + half(b), a + half(a)];
    Some(corners.map(|corner| LINE_LIFT * corner))
}
