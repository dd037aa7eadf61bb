//! Properties of every shape, whichever it is.

use super::*;
use crate::rng::Stream;
use crate::time::Time;
use glam::Vec3;
use proptest::prelude::*;

fn all() -> [Shape<Mesh<'static>>; 6] {
    let center = Vec3::new(0.3, -0.2, 0.5);
    [
        Shape::Box(Cuboid { min: Vec3::new(-0.5, -0.4, -0.3), max: Vec3::new(0.6, 0.7, 0.2) }),
        Shape::Sphere(Sphere { center, radius: 0.7 }),
        Shape::Cylinder(Cylinder { center, radius: 0.5, height: 1.2 }),
        Shape::Cone(Cone { center, radius: 0.6, height: 1.1 }),
        Shape::Capsule(Capsule { from: center, to: Vec3::new(0.8, 0.9, -0.4), radius: 0.5 }),
        Shape::Circle(Disc { center, normal: Vec3::new(1.0, 2.0, -3.0), radius: 0.8 }),
    ]
}

fn numbers(i: u32) -> [f32; 3] {
    let stream = Stream::new(1, 2, i);
    [stream.units(0)[0], stream.units(0)[1], stream.units(1)[0]]
}

#[test]
fn samples_lie_on_the_surface_and_normals_point_away() {
    for shape in all() {
        for i in 0..2000 {
            let spot = shape.sample(numbers(i));
            assert!((shape.nearest(spot.point) - spot.point).length() < 1e-6, "{shape:?} {spot:?}");
            assert!((spot.normal.length() - 1.0).abs() < 1e-6);
            let off = spot.point + spot.normal * 1e-3;
            assert!(((shape.nearest(off) - off).length() - 1e-3).abs() < 1e-5, "{shape:?} {spot:?}");
        }
    }
}

#[test]
fn nearest_is_no_farther_than_any_sample() {
    for shape in all() {
        for i in 0..200 {
            let [x, y, z] = numbers(i + 5000);
            let point = Vec3::new(x, y, z) * 3.0 - 1.5;
            let distance = (shape.nearest(point) - point).length();
            let best = (0..3000).map(|k| (shape.sample(numbers(k)).point - point).length()).fold(9.0, f32::min);
            assert!(distance <= best + 1e-6, "{shape:?} {point}: {distance} > {best}");
            assert!(best - distance < 0.15, "{shape:?} {point}: {distance} far below {best}");
        }
    }
}

#[test]
fn bounds_hold_every_sample_tightly() {
    for shape in all() {
        let b = shape.bounds();
        let seen = Aabb::around((0..20_000).map(|i| shape.sample(numbers(i)).point));
        assert!(seen.min.cmpge(b.min - 1e-6).all() && seen.max.cmple(b.max + 1e-6).all(), "{shape:?}");
        assert!((seen.max - b.max).length() < 0.1 && (seen.min - b.min).length() < 0.1, "{shape:?} {seen:?} {b:?}");
    }
}

/// The rounding of a hit is that of its shape's size, however near to zero the box of that ends.
#[test]
fn boxes_that_end_at_zero_have_room_for_rounding() {
    let cylinder = Cylinder { center: Vec3::new(0.3, -0.2, 0.5), radius: 0.5, height: 1.2 };
    let (from, to) =
        (Vec3::new(0.135_232_6, 0.272_200_17, -0.057_922_892), Vec3::new(0.3, 0.272_200_17, -0.057_922_892));
    let segment = Segment { radius: 0.057_922_374, ..Segment::new(from, to) };
    assert!(cylinder.first_hit(&segment).is_some() && cylinder.may_touch(&segment.bounds()));
}

/// Where a line grazes a mantle near the apex, however far from where it begins, the hit is as near to the surface as its slack says.
#[test]
fn hits_that_graze_a_cone_near_its_apex_are_on_it() {
    let sizes = [(0.6, 1.1), (1.0, 0.01), (0.01, 1.0), (300.0, 200.0), (2e-3, 3e-3), (1.0, 1.0)];
    let mut hits = 0;
    for (case, (radius, height)) in (0..).zip(sizes) {
        let size = crate::math::max(radius, height);
        let cone = Cone { center: Vec3::new(0.3, -0.2, 0.5) * size, radius, height };
        let apex = cone.center + Vec3::Y * (0.5 * height);
        for i in 0..20_000 {
            let at = |number: u32| numbers(4 * (20_000 * case + i) + number).map(|x| 2.0 * x - 1.0);
            // Through a place beside the mantle, the nearer the closer to the apex, along it but for little.
            let ([turn, down, close], [across, along, off]) = (at(0), at(1));
            let spot = cone.sample([1.0, 0.5 * turn + 0.5, 0.5 * (1.0 + down) * close * close]);
            let up = crate::math::unit(apex - spot.point);
            let place = spot.point + Vec3::from(at(2)) * (1e-3 * size * (close * off).abs());
            let way = up.cross(spot.normal) * across + up * along + Vec3::from(at(3)) * (0.02 * off * off * off);
            let segment = Segment::new(place - way * (3.0 * size), place + way * (3.0 * size));
            let Some(hit) = cone.first_hit(&segment) else { continue };
            let (point, middle) = (segment.at(hit.time).to_array(), cone.center.to_array());
            let [x, y, z]: [f64; 3] = core::array::from_fn(|i| f64::from(point[i]) - f64::from(middle[i]));
            let (radius, height) = (f64::from(radius), f64::from(height));
            let mantle = (x.hypot(z) * height + (y - 0.5 * height) * radius) / radius.hypot(height);
            let off = mantle.max(-0.5 * height - y).abs();
            assert!(off <= f64::from(hit.slack), "{cone:?} {segment:?} {hit:?}: {off}");
            hits += 1;
        }
    }
    assert!(hits > 20_000, "{hits}");
}

/// A path that a search for such paths has met.
#[test]
fn a_path_that_grazes_a_cone_from_far_hits_its_surface() {
    let cone = Cone { center: Vec3::new(0.3, -0.2, 0.5), radius: 0.6, height: 1.1 };
    let (from, to) =
        (Vec3::new(-1.955_945, 0.761_271_06, -1.957_171_3), Vec3::new(0.841_585_16, 0.149_515_78, 1.071_395_8));
    let hit = cone.first_hit(&Segment::new(from, to)).expect("it goes through the cone");
    let point = from + (to - from) * hit.time;
    assert!((cone.nearest(point) - point).length() <= hit.slack, "{hit:?}");
}

proptest! {
    /// A path's hit lies on the surface, faces the start, and the way to it is free.
    #[test]
    fn a_hit_is_on_the_surface_and_the_way_to_it_is_free(
        from in prop::array::uniform3(-2.0f32..2.0), to in prop::array::uniform3(-2.0f32..2.0)
    ) {
        let segment = Segment::new(from.into(), to.into());
        for shape in all() {
            let Some(hit) = shape.first_hit(&segment) else { continue };
            prop_assert!((0.0..=1.0).contains(&hit.time));
            let point = segment.at(hit.time);
            prop_assert!((shape.nearest(point) - point).length() < 1e-5, "{shape:?} {segment:?} {hit:?}");
            prop_assert!(segment.step().dot(hit.normal) < 1e-6);
            let before = Segment::new(segment.from, segment.at(hit.time) + hit.normal * 1e-5);
            if hit.time > 1e-3 {
                let again = shape.first_hit(&before);
                prop_assert!(again.is_none_or(|h| h.time > 0.999), "{shape:?} {segment:?} {hit:?} {again:?}");
            }
        }
    }

    /// Nobody is passed over who hits a shape or leans on it: along its surface, of any size, wherever it is, and where a box touches it at its poles.
    #[test]
    fn who_touches_a_shape_may_touch_it(
        u in prop::array::uniform3(0.0f32..1.0), away in -2e-6f32..2e-6, ways in prop::array::uniform3(-1.0f32..1.0), pole in 0usize..10,
        size in -4.0f32..4.0, center in prop::array::uniform3(-1.0f32..1.0), far in 0.0f32..3.0, ball in -6.0f32..-1.0,
    ) {
        let size = 10.0_f32.powf(size);
        let sphere = Sphere { center: Vec3::from(center) * (size * 10.0_f32.powf(far)), radius: size };
        let shapes = all().into_iter().map(|shape| (shape, 1.0)).chain([(Shape::Sphere(sphere), size)]);
        let poles = [[0.0, 0.0], [1.0, 0.0], [0.5, 0.0], [0.5, 0.25], [0.5, 0.5], [0.5, 0.75]];
        for ((shape, size), radius) in shapes.flat_map(|one| [(one.clone(), 0.0), (one, ball.exp2())]) {
            let u = poles.get(pole).map_or(u, |&[height, turn]| [height, turn, u[2]]);
            let spot = shape.sample(u);
            let (a, _) = crate::math::frame(spot.normal);
            let (radius, beside) = (radius * size, spot.point + spot.normal * ((away + radius) * size));
            let leaning = if pole < poles.len() { Vec3::ZERO } else { Vec3::from(ways) * 0.01 };
            let step = (a * ways[0] + leaning) * size;
            let segment = Segment { radius, ..Segment::new(beside - step, beside + step * ways[1]) };
            if shape.first_hit(&segment).is_some() {
                prop_assert!(shape.may_touch(&segment.bounds()), "{shape:?} {segment:?}");
            }
            let (mut leans, reach) = (false, radius + away.abs() * size);
            shape.contacts(beside, reach, Time::ZERO, &mut |_| leans = true);
            let around = Aabb { min: beside - reach, max: beside + reach };
            prop_assert!(!leans || shape.may_touch(&around), "{shape:?} {beside} {reach}");
        }
    }

    /// However a path is cut, its pieces together hit what the whole hits.
    #[test]
    fn a_path_cut_in_two_hits_all_the_same(
        from in prop::array::uniform3(-2.0f32..2.0), to in prop::array::uniform3(-2.0f32..2.0), cut in 0.0f32..1.0
    ) {
        let whole = Segment::new(from.into(), to.into());
        let middle = whole.at(cut);
        for shape in all() {
            let Some(hit) = shape.first_hit(&whole) else { continue };
            // A graze within rounding may be judged either way.
            if hit.normal.dot(crate::math::unit(whole.step())) > -0.02 { continue }
            let first = shape.first_hit(&Segment::new(whole.from, middle));
            let second = shape.first_hit(&Segment::new(middle, whole.to));
            prop_assert!(first.is_some() || second.is_some(), "{shape:?} {whole:?} {middle}");
        }
    }
}

#[test]
fn a_particle_on_the_surface_that_leaves_does_not_hit_it() {
    for shape in all() {
        for i in 0..2000 {
            let spot = shape.sample(numbers(i));
            // Set off by the rounding error, as the response does it.
            let from = spot.point + spot.normal * 2e-6;
            let away = Segment::new(from, from + spot.normal);
            assert_eq!(shape.first_hit(&away), None, "{shape:?} {spot:?}");
            let inward = Segment::new(from, from - spot.normal * 0.1);
            let hit = shape.first_hit(&inward).expect("a path into the surface hits it");
            assert!(hit.time < 1e-4, "{shape:?} {hit:?}");
        }
    }
}

#[test]
fn lists_of_colliders_are_colliders() {
    let near = Plane { point: Vec3::Y, normal: Vec3::Y };
    let far = Plane { point: Vec3::ZERO, normal: Vec3::Y };
    let down = Segment::new(Vec3::Y * 2.0, -Vec3::Y);
    let hit = |c: &dyn Collider| c.first_hit(&down).map(|h| h.time);
    assert_eq!(hit(&()), None);
    assert_eq!(hit(&(far, near)), hit(&near));
    assert_eq!(hit(&[far, near]), hit(&near));
    assert_eq!(hit(&(far, (), &near as &dyn Collider)), hit(&near));
    assert!(().is_empty() && ((), ()).is_empty() && !(far, ()).is_empty());
}
