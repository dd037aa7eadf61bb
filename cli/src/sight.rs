//! The films that show nothing at all.

use crate::cast::Seen;
use crate::report::words::short;
use glam::Vec3;
use pointmass_draw::{Camera, Piece, Stage};

/// Things before a camera: whether any of them is within its reach, and how far away the nearest is.
#[derive(Debug)]
pub(crate) struct Sight {
    is_seen: bool,
    nearest: f32,
    /// How much taller pictures are than wide, if they are.
    tall: f32,
}

impl Sight {
    /// Nothing has been looked at yet.
    pub(crate) fn new((width, height): (u32, u32)) -> Self {
        Self { is_seen: false, nearest: f32::INFINITY, tall: (height as f32 / width as f32).max(1.0) }
    }

    /// Takes note of what moves in a picture.
    pub(crate) fn note(&mut self, camera: &Camera, all: &[Seen]) {
        if self.is_seen {
            return;
        }
        for Seen { dots, billboards, segments, ribbons, pieces, .. } in all {
            let balls = dots.iter().map(|dot| (dot.position, 0.5 * dot.size));
            let boards = billboards.iter().map(|board| (board.center, board.right.length() + board.up.length()));
            for (place, reach) in balls.chain(boards) {
                if self.is_ahead(camera, place, reach) {
                    self.thing(camera, [place]);
                }
            }
            segments.iter().chain(ribbons).for_each(|line| self.thing(camera, line.ends));
            self.pieces(camera, pieces);
        }
    }

    /// Tells whether what reaches so far may be in the picture, however near or far it is. The corners are less than twice as far from its middle as the
    /// farther edges are.
    fn is_ahead(&self, camera: &Camera, place: Vec3, reach: f32) -> bool {
        let (way, ahead) = (place - camera.eye, camera.towards.normalize_or(Vec3::NEG_Z));
        let wide = 2.0 * self.tall * camera.xfov.tan() * way.dot(ahead);
        way.reject_from_normalized(ahead).length() <= wide + reach
    }

    fn pieces(&mut self, camera: &Camera, pieces: &[Piece]) {
        for Piece { surface, .. } in pieces {
            self.thing(camera, surface.vertices.iter().copied());
        }
    }

    /// A thing between some places.
    fn thing(&mut self, camera: &Camera, places: impl IntoIterator<Item = Vec3>) {
        let ahead = camera.towards.normalize_or(Vec3::NEG_Z);
        let depths = places.into_iter().map(|place| (place - camera.eye).dot(ahead));
        let [low, high] =
            depths.fold([f32::INFINITY, f32::NEG_INFINITY], |[low, high], depth| [low.min(depth), high.max(depth)]);
        if high > 0.0 {
            self.is_seen |= low <= camera.far;
            self.nearest = self.nearest.min(low);
        }
    }

    /// The warning that all that there is lies beyond a camera's reach; `stage` makes what stands still.
    pub(crate) fn warning(mut self, camera: &Camera, stage: impl FnOnce() -> Stage) -> Option<String> {
        if self.is_seen {
            return None;
        }
        let Stage { pieces, lines, .. } = stage();
        self.pieces(camera, &pieces);
        lines.iter().for_each(|line| self.thing(camera, [line.a, line.b]));
        (!self.is_seen && self.nearest.is_finite()).then(|| {
            let (far, nearest) = (camera.far, short(self.nearest.into()));
            let lies = format!("all that is before the camera lies there, the nearest {nearest} m away");
            format!("camera.far: nothing farther than {far} m is seen, and {lies}")
        })
    }
}
