//! When balls touch in a room whose opposite faces are one.

use super::meeting::first_touch;
use super::path::Path;
use crate::index::Room;
use crate::math::floor;
use core::ops::Range;
use glam::Vec3;

/// Images of a ball along a side that are looked at: three are met by who goes two sides in a step.
const MOST: i32 = 3;

/// As [`first_touch`] of one ball as seen from the other, or from its images beside the room: also where the one that is touched lies from the
/// other itself. Where there are more images on the way than are looked at, that counts as a way too curved.
pub(super) fn first_touch_of_images(
    room: Option<&Room>,
    path: &Path,
    reach: f32,
    slack: f32,
) -> (Option<(f32, Vec3)>, bool) {
    let Some(room) = room.filter(|_| path.is_finite()) else {
        let (touch, curved) = first_touch(path, reach, slack);
        return (touch.map(|at| (at, Vec3::ZERO)), curved);
    };
    let (hull, sides, wide) = (path.hull(0.0), room.sides(), reach + room.slack());
    let (mut first, mut curved) = (None::<(f32, Vec3)>, false);
    let met = [0, 1, 2].map(|axis| images([hull.min[axis] - wide, hull.max[axis] + wide], sides[axis]));
    let is_any = met.iter().all(|(met, _)| !met.is_empty());
    curved |= is_any && met.iter().any(|(_, all)| !all);
    let [x, y, z] = met.map(|(met, _)| met);
    for (x, y, z) in x.flat_map(|x| y.clone().map(move |y| (x, y))).flat_map(|(x, y)| z.clone().map(move |z| (x, y, z)))
    {
        let image = sides * Vec3::new(x as f32, y as f32, z as f32);
        let moved = Path { x0: path.x0 - image, x1: path.x1 - image, ..*path };
        let (touch, bent) = first_touch(&moved, reach, slack);
        curved |= bent;
        first = match (touch, first) {
            (Some(at), Some((sooner, _))) if at >= sooner => first,
            (Some(at), _) => Some((at, image)),
            (None, _) => first,
        };
    }
    (first, curved)
}

/// The numbers of the sides by which what lies in a range may be an image of zero, and whether these are all.
fn images([low, high]: [f32; 2], side: f32) -> (Range<i32>, bool) {
    if side == 0.0 {
        return (0..1, true);
    }
    // The casts saturate.
    let (first, last) = (-floor(-low / side) as i32, floor(high / side) as i32);
    let end = last.saturating_add(1);
    (first..end.min(first.saturating_add(MOST)), end <= first.saturating_add(MOST))
}
