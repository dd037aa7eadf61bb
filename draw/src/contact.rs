//! Soft shadows, and light, on the ground under a dot: they tell how high it is.

use super::brush::Stroke;
use super::camera::Lens;
use super::canvas::Canvas;
use super::rays::{Hit, Rays};
use glam::{Mat2, Vec2, Vec3};

/// How high above the ground a dot still has a shadow, in radii.
const HEIGHT: f32 = 14.0;

/// The darkest shadow.
const DARKNESS: f32 = 0.6;

/// How wide a shadow is on the ground and how much wider it gets for each radius of height, and
/// how much wider a light is than that.
const WIDTH: f32 = 1.5;
const WIDENING: f32 = 0.12;
const LIGHT_WIDTH: f32 = 2.2;

/// How much light a glowing dot sheds on the ground.
const LIGHT: f32 = 0.5;

/// Something above the ground.
pub(super) struct Caster {
    /// Its middle, in view coordinates, and half its size in the world.
    pub(super) place: Vec3,
    pub(super) reach: f32,
    pub(super) opacity: f32,
    /// The share of it that is light.
    pub(super) glow: f32,
    pub(super) color: Vec3,
}

/// Paints what something does to the ground under it.
pub(super) fn paint(caster: &Caster, rays: &Rays, up: Vec3, lens: &Lens, canvas: &mut Canvas) {
    let reach = HEIGHT * caster.reach;
    // A dot on the ground may well be a little under it.
    let from = caster.place + caster.reach * up;
    let Some(hit) = rays.first(from, -up, reach) else { return };
    let height = (hit.distance / caster.reach - 1.0).max(0.0);
    let strength = 1.0 - hit.distance / reach;
    let strength = strength * strength * caster.opacity;
    let ground = from - hit.distance * up;
    let width = caster.reach * (WIDTH + WIDENING * height);

    let shadow = DARKNESS * strength * (1.0 - caster.glow);
    let light = LIGHT * strength * caster.glow;
    if shadow > 0.02 {
        let Some(spot) = Spot::new(ground, &hit, width, lens) else { return };
        spot.each_pixel(canvas, |canvas, pixel, share| {
            canvas.tint(pixel, Vec3::splat(1.0 - shadow * share));
        });
    }
    if light > 0.02 {
        let Some(spot) = Spot::new(ground, &hit, LIGHT_WIDTH * width, lens) else { return };
        spot.each_pixel(canvas, |canvas, pixel, share| {
            canvas.tint(pixel, 1.0 + light * share * caster.color);
        });
    }
}

/// A round spot on a surface, an ellipse in the picture.
struct Spot {
    middle: Vec2,
    /// From the picture to the plane of the spot, where its radius is 1.
    flatten: Mat2,
    radius: f32,
    depth: f32,
    width: f32,
}

impl Spot {
    fn new(ground: Vec3, hit: &Hit, width: f32, lens: &Lens) -> Option<Self> {
        if Lens::depth(ground) - width < lens.near {
            return None;
        }
        let middle = lens.project(ground);
        let (x, y) = hit.normal.any_orthonormal_pair();
        let arm = |axis: Vec3| lens.project(ground + width * axis) - middle;
        let lie = Mat2::from_cols(arm(x), arm(y));
        let flatten = lie.inverse();
        let radius = (lie.x_axis.length_squared() + lie.y_axis.length_squared()).sqrt();
        flatten.is_finite().then_some(Self { middle, flatten, radius, depth: Lens::depth(ground), width })
    }

    /// Calls `paint` with each pixel of the surface in the spot and its share, from 1 in the middle
    /// to 0 at the edge.
    fn each_pixel(&self, canvas: &mut Canvas, paint: impl Fn(&mut Canvas, usize, f32)) {
        let dab = Stroke::dab(self.middle, self.radius);
        dab.each_pixel(canvas.width, canvas.height, |touch| {
            let inside = 1.0 - (self.flatten * touch.offset).length_squared();
            if inside > 0.0 {
                let share = inside * canvas.lies_at(touch.pixel, self.depth, 1.2 * self.width);
                paint(canvas, touch.pixel, share * inside);
            }
        });
    }
}
