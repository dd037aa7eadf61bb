//! Glows and ribbons on their way, and what comes between.

use super::super::*;
use super::{HEIGHT, WIDTH, dot, frame, stage};
use glam::Vec3;

#[test]
fn a_glow_on_its_way_is_whole_where_it_is_and_its_trace_is_behind() {
    let glow = Dot { glow: 1.0, size: 0.3, ..dot(Vec3::NEG_Z * 3.0, [255, 60, 0]) };
    let seen = |way: f32| {
        let image = frame(&stage(vec![]), &[Dot { previous: glow.position - Vec3::X * way, ..glow }], &[]);
        (0..WIDTH).map(|x| image[(x, HEIGHT / 2)].0[0]).collect::<Vec<_>>()
    };
    let lens = camera::Lens::new(&Camera::default(), WIDTH as usize, HEIGHT as usize);
    for way in [0.03, 0.1, 0.3, 0.8] {
        let row = seen(way);
        // Of two pixels as far before and behind it, the one behind is no darker.
        let (behind, before) = row.split_at(row.len() / 2);
        let darker = behind.iter().rev().zip(before).filter(|(behind, before)| *behind + 1 < **before);
        assert_eq!(darker.count(), 0, "{way}: {row:?}");
        let back = (0.6 * way * lens.pixels_per_metre(3.0)) as usize;
        assert!(before[0] > 150 && behind[behind.len() - 1 - back] > 50, "{way}: {row:?}");
    }
}
