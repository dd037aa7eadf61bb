//! The camera, and the lens that turns places into pixels.

use glam::{Mat3, Vec2, Vec3};

/// A pinhole camera with square pixels; the vertical angle follows from the picture's shape.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    /// Where it stands.
    pub eye: Vec3,
    /// The direction it looks in.
    pub towards: Vec3,
    /// The direction that is upright in the picture.
    pub up: Vec3,
    /// Half of the horizontal angle of view, in radians.
    pub xfov: f32,
    /// Nothing closer than this is drawn.
    pub near: f32,
    /// Nothing farther than this is drawn.
    pub far: f32,
}

/// At the origin, looking along −z.
impl Default for Camera {
    fn default() -> Self {
        Self { eye: Vec3::ZERO, towards: Vec3::NEG_Z, up: Vec3::Y, xfov: 0.5, near: 0.01, far: 1000.0 }
    }
}

/// A camera fitted to a picture of a certain size, with every value made usable.
///
/// Its own coordinates, called *view* coordinates, have the eye at the origin, x to the right, y
/// up and the depth along −z. Pictures are measured in pixels from the top left corner.
#[derive(Clone, Copy, Debug)]
pub(super) struct Lens {
    /// Turns world directions into view directions.
    pub(super) turn: Mat3,
    eye: Vec3,
    /// The distance, in pixels, at which one metre is one pixel.
    focal: f32,
    pub(super) width: usize,
    pub(super) height: usize,
    pub(super) near: f32,
    pub(super) far: f32,
}

impl Lens {
    /// Fits `camera` to a picture. Values that make no sense are replaced by ones that do.
    pub(super) fn new(camera: &Camera, width: usize, height: usize) -> Self {
        let or = |value: f32, usual: f32| if value.is_finite() { value } else { usual };
        let near = or(camera.near, 0.0).max(1e-4);
        let half_angle = or(camera.xfov, 0.5).clamp(0.001, 1.55);
        Self {
            turn: upright(camera.towards, camera.up),
            eye: if camera.eye.is_finite() { camera.eye } else { Vec3::ZERO },
            focal: 0.5 * width as f32 / half_angle.tan(),
            width,
            height,
            near,
            far: or(camera.far, 1e9).max(near * 1.001),
        }
    }

    /// From world to view coordinates.
    pub(super) fn view(&self, world: Vec3) -> Vec3 {
        self.turn * (world - self.eye)
    }

    /// How far in front of the eye a place is, in view coordinates.
    pub(super) fn depth(view: Vec3) -> f32 {
        -view.z
    }

    /// Where in the picture a place in front of the eye is, in view coordinates.
    pub(super) fn project(&self, view: Vec3) -> Vec2 {
        let scale = self.pixels_per_metre(Self::depth(view));
        self.center() + scale * Vec2::new(view.x, -view.y)
    }

    /// The place at a depth of one metre that is seen at a place in the picture, in view coordinates.
    pub(super) fn ray(&self, picture: Vec2) -> Vec3 {
        let off = (picture - self.center()) / self.focal;
        Vec3::new(off.x, -off.y, -1.0)
    }

    /// How many pixels a metre takes at a depth.
    pub(super) fn pixels_per_metre(&self, depth: f32) -> f32 {
        self.focal / depth
    }

    /// The four planes through the eye and the picture's sides, pushed outwards by `margin`
    /// pixels, as normals that point into the view.
    pub(super) fn sides(&self, margin: f32) -> [Vec3; 4] {
        let reach = self.center() + margin;
        [
            Vec3::new(self.focal, 0.0, -reach.x),
            Vec3::new(-self.focal, 0.0, -reach.x),
            Vec3::new(0.0, self.focal, -reach.y),
            Vec3::new(0.0, -self.focal, -reach.y),
        ]
    }

    fn center(&self) -> Vec2 {
        0.5 * Vec2::new(self.width as f32, self.height as f32)
    }

    /// The translation that goes with [`Lens::turn`].
    pub(super) fn shift(&self) -> Vec3 {
        self.turn * -self.eye
    }
}

/// The rotation that takes `towards` to −z and `up` as near to y as it can.
fn upright(towards: Vec3, up: Vec3) -> Mat3 {
    let back = -towards.try_normalize().unwrap_or(Vec3::NEG_Z);
    let right = [up, Vec3::Y, Vec3::X]
        .into_iter()
        .filter_map(Vec3::try_normalize)
        .map(|up| up.cross(back))
        .find(|right| right.length_squared() > 1e-8)
        .map_or(Vec3::X, Vec3::normalize);
    Mat3::from_cols(right, back.cross(right), back).transpose()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn lens() -> (Camera, Lens) {
        let camera = Camera {
            eye: Vec3::new(1.0, 2.0, 3.0),
            towards: Vec3::new(-1.0, -0.5, 2.0),
            up: Vec3::new(0.2, 1.0, 0.1),
            xfov: 0.6,
            ..Camera::default()
        };
        (camera, Lens::new(&camera, 640, 480))
    }

    #[test]
    fn straight_ahead_is_the_middle() {
        let (camera, lens) = lens();
        let at = lens.project(lens.view(camera.eye + 7.0 * camera.towards));
        assert!((at - Vec2::new(320.0, 240.0)).length() < 1e-3, "{at}");
    }

    #[test]
    fn the_angle_of_view_is_the_edge() {
        let (camera, lens) = lens();
        let ahead = camera.towards.normalize();
        let right = ahead.cross(camera.up).normalize();
        let upright = right.cross(ahead);
        let tangent = camera.xfov.tan();
        let edge = lens.project(lens.view(camera.eye + 5.0 * (ahead + tangent * right)));
        assert!((edge - Vec2::new(640.0, 240.0)).length() < 1e-3, "{edge}");
        let top = lens.project(lens.view(camera.eye + 5.0 * (ahead + 0.75 * tangent * upright)));
        assert!((top - Vec2::new(320.0, 0.0)).length() < 1e-3, "{top}");
    }

    #[test]
    fn a_senseless_camera_still_has_a_lens() {
        let nan = Vec3::splat(f32::NAN);
        for (towards, up) in [(Vec3::ZERO, Vec3::ZERO), (nan, nan), (Vec3::Y, Vec3::Y)] {
            let camera = Camera { eye: nan, towards, up, xfov: f32::NAN, near: -1.0, far: f32::NAN };
            let lens = Lens::new(&camera, 64, 48);
            assert!((lens.turn.determinant() - 1.0).abs() < 1e-5);
            assert!(lens.far > lens.near && lens.near > 0.0 && lens.focal.is_finite());
        }
    }
}
