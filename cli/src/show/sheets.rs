//! Where cloth lies on cloth: points over triangles, and edges across edges, that are as near each other as their thickness keeps them.

use glam::Vec3;
use pointmass::force::State;
use pointmass::index::{SpatialIndex, Structure};
use pointmass::scene::SheetContactsBuf;
use pointmass::shape::{Line, Surface, Triangle};
use pointmass::{Color, Particle, draw};
use std::collections::BTreeMap;

/// The share of their thickness by which two may be farther apart than that and touch all the same.
const SLACK: f32 = 0.05;
/// The share of a triangle that rounding makes of none.
const ROUNDING: f32 = 1e-5;

/// The lines of all that touch, upright on both and as far on one side as on the other, so `long` \[m\].
pub(super) fn lines(
    state: &State<'_>,
    sheets: &SheetContactsBuf,
    start: &[Particle],
    long: f32,
    color: Color,
) -> Vec<draw::Line> {
    let line = |[a, b]: [Vec3; 2]| {
        let (middle, half) = ((a + b) * 0.5, (a - b).normalize_or_zero() * (0.5 * long));
        draw::Line::plain([middle - half, middle + half], color)
    };
    touches(state, sheets, start).into_iter().map(|touch| line(touch.places)).collect()
}

/// A point and a triangle, or two edges, that touch.
struct Touch {
    /// The places where they are nearest to each other, and how far apart these are \[m\].
    places: [Vec3; 2],
    distance: f32,
    /// The triangle's corners; none of two edges.
    triangle: Option<[u32; 3]>,
}

/// Who touches: a point, and the corners that the nearest place of a triangle lies between; or the ends of two edges.
type Key = (Vec<u32>, Vec<u32>);

/// The sheets as they are now, and as they began.
struct Sheets {
    /// Where particles are, no numbers where they are dead, and where they were \[m\].
    now: Vec<Vec3>,
    begun: Vec<Vec3>,
    /// Half the thickness at each \[m\].
    half: Vec<f32>,
    /// The sheet to which each belongs.
    sheet: Vec<u32>,
}

impl Sheets {
    fn of(state: &State<'_>, sheets: &SheetContactsBuf, start: &[Particle]) -> Self {
        let now = |&number: &u32| state.springs.row(number).map_or(Vec3::NAN, |row| state.position[row]);
        let begun = |&number: &u32| start.get(number as usize).map_or(Vec3::NAN, |particle| particle.position);
        let now: Vec<_> = sheets.particles.iter().map(now).collect();
        let mut half = vec![0.0_f32; now.len()];
        let mut sheet: Vec<_> = (0..now.len() as u32).collect();
        for (i, corners) in sheets.triangles.iter().enumerate() {
            let thickness = sheets.thickness.get(i).or(sheets.thickness.last()).copied().unwrap_or(0.0);
            let roots = corners.map(|corner| root(&sheet, corner));
            for (&corner, other) in corners.iter().zip(roots) {
                half[corner as usize] = half[corner as usize].max(0.5 * thickness);
                sheet[other as usize] = roots[0].min(roots[1]).min(roots[2]);
            }
        }
        let sheet = (0..now.len() as u32).map(|i| root(&sheet, i)).collect();
        Self { now, begun: sheets.particles.iter().map(begun).collect(), half, sheet }
    }

    /// Puts a point and a triangle on the list, if they touch.
    fn point(&self, point: u32, triangle: [u32; 3], list: &mut BTreeMap<Key, Touch>) {
        let ends = |of: &[Vec3]| {
            let (place, corners) = (of[point as usize], triangle.map(|corner| of[corner as usize]));
            [place, Triangle { corners }.nearest(place)]
        };
        let places = ends(&self.now);
        let begun = || {
            let [point, place] = ends(&self.begun);
            point.distance(place)
        };
        if let Some(distance) = self.distance([point, triangle[0]], places, begun) {
            let between = between(places[1], triangle, triangle.map(|corner| self.now[corner as usize]));
            list.insert((vec![point], between), Touch { places, distance, triangle: Some(triangle) });
        }
    }

    /// Puts two edges on the list, if they touch where they cross.
    fn edges(&self, edges: [[u32; 2]; 2], list: &mut BTreeMap<Key, Touch>) {
        let of = |all: &[Vec3]| edges.map(|edge| edge.map(|end| all[end as usize]));
        let Some(places) = across(of(&self.now)) else { return };
        if let Some(distance) = self.distance([edges[0][0], edges[1][0]], places, || apart(of(&self.begun))) {
            let mut key = edges.map(|[a, b]| vec![a.min(b), a.max(b)]);
            key.sort_unstable();
            let [one, other] = key;
            list.insert((one, other), Touch { places, distance, triangle: None });
        }
    }

    /// How far apart two are \[m\], if that is no more than they are kept: within a sheet half of what they began with, if that is less.
    fn distance(&self, [a, b]: [u32; 2], places: [Vec3; 2], begun: impl FnOnce() -> f32) -> Option<f32> {
        let [a, b] = [a as usize, b as usize];
        let thickness = self.half[a] + self.half[b];
        let distance = places[0].distance(places[1]);
        if !(distance <= thickness * (1.0 + SLACK)) {
            return None;
        }
        let kept = if self.sheet[a] == self.sheet[b] { thickness.min(0.5 * begun()) } else { thickness };
        (distance <= kept * (1.0 + SLACK)).then_some(distance)
    }
}

/// All that touch, each once.
fn touches(state: &State<'_>, contacts: &SheetContactsBuf, start: &[Particle]) -> Vec<Touch> {
    let sheets = Sheets::of(state, contacts, start);
    let mut all = BTreeMap::new();
    near(&sheets, &contacts.triangles, |one, other| {
        for (a, b) in [(one, other), (other, one)] {
            a.iter().filter(|corner| !b.contains(corner)).for_each(|&corner| sheets.point(corner, b, &mut all));
        }
        let edges = |[a, b, c]: [u32; 3]| [[a, b], [b, c], [c, a]];
        for a in edges(one) {
            let strangers = edges(other).into_iter().filter(|b| !b.iter().any(|end| a.contains(end)));
            strangers.for_each(|b| sheets.edges([a, b], &mut all));
        }
    });
    let idle: Vec<_> = all.iter().map(|(key, touch)| is_idle(key, touch, &all)).collect();
    all.into_values().zip(idle).filter(|&(_, idle)| !idle).map(|(touch, _)| touch).collect()
}

/// Tells whether a point is nearer to another triangle that has the corner or edge to which it is nearest of this one.
fn is_idle((point, between): &Key, touch: &Touch, all: &BTreeMap<Key, Touch>) -> bool {
    if touch.triangle.is_none() || between.len() == 3 {
        return false;
    }
    let others = all.range((point.clone(), Vec::new())..).take_while(|((other, _), _)| other == point);
    others.into_iter().any(|(_, other)| {
        let has = |corner| other.triangle.is_some_and(|triangle| triangle.contains(corner));
        other.distance < touch.distance && between.iter().all(has)
    })
}

/// Visits the pairs of triangles that may touch.
fn near(sheets: &Sheets, triangles: &[[u32; 3]], mut visit: impl FnMut([u32; 3], [u32; 3])) {
    let places = |corners: [u32; 3]| corners.map(|corner| sheets.now[corner as usize]);
    let lives = |corners: &&[u32; 3]| places(**corners).iter().all(|place| place.is_finite());
    let living: Vec<_> = triangles.iter().filter(lives).copied().collect();
    let thick = 2.0 * (1.0 + SLACK) * sheets.half.iter().copied().fold(0.0, f32::max);
    let middles: Vec<_> = living.iter().map(|&corners| places(corners).iter().sum::<Vec3>() / 3.0).collect();
    let far = |(&corners, &middle): (&[u32; 3], &Vec3)| places(corners).map(|place| place.distance(middle));
    let widest = living.iter().zip(&middles).flat_map(far).fold(0.0, f32::max);
    // A little more than it takes, for what rounding takes away.
    let reach = (2.0 * widest + thick) * 1.001;
    let mut memory = vec![0; Structure::Grid.words(middles.len())];
    let mut index = Structure::Grid.in_room(&mut memory, None);
    if index.build(&middles, reach).is_err() {
        return;
    }
    let bounds = |corners: [u32; 3]| {
        let [a, b, c] = places(corners);
        (a.min(b).min(c), a.max(b).max(c))
    };
    index.pairs(reach, &mut |number, others| {
        let one = living[number as usize];
        let (low, high) = bounds(one);
        for &other in others.iter().map(|&other| &living[other as usize]) {
            let (least, most) = bounds(other);
            if low.cmple(most + thick).all() && least.cmple(high + thick).all() {
                visit(one, other);
            }
        }
    });
}

/// The first particle of what a particle hangs together with, as far as that is known.
fn root(sheet: &[u32], mut of: u32) -> u32 {
    while sheet[of as usize] != of {
        of = sheet[of as usize];
    }
    of
}

/// The corners that a place of a triangle lies between, in order: one of three, two at an edge.
fn between(place: Vec3, triangle: [u32; 3], corners: [Vec3; 3]) -> Vec<u32> {
    let double = |[a, b, c]: [Vec3; 3]| (b - a).cross(c - a).length();
    let least = ROUNDING * double(corners);
    let share = |i: usize| double([place, corners[(i + 1) % 3], corners[(i + 2) % 3]]);
    let mut between: Vec<_> = (0..3).filter(|&i| share(i) > least).map(|i| triangle[i]).collect();
    between.sort_unstable();
    between
}

/// The places where two edges are nearest to each other, if these are at the end of neither.
pub(super) fn across([[a, b], [c, d]]: [[Vec3; 2]; 2]) -> Option<[Vec3; 2]> {
    let (e, f, way) = (b - a, d - c, a - c);
    let (ee, ff, ef, ew, fw) = (e.dot(e), f.dot(f), e.dot(f), e.dot(way), f.dot(way));
    let determinant = ee * ff - ef * ef;
    // Edges that are all but parallel are near each other at their ends.
    if !(determinant > 1e-6 * ee * ff) {
        return None;
    }
    let [s, t] = [(ef * fw - ff * ew) / determinant, (ee * fw - ef * ew) / determinant];
    (s > 0.0 && s < 1.0 && t > 0.0 && t < 1.0).then(|| [a.lerp(b, s), c.lerp(d, t)])
}

/// How far apart two edges are \[m\].
fn apart(edges: [[Vec3; 2]; 2]) -> f32 {
    let [one, other] = edges;
    let from = |place: Vec3, [from, to]: [Vec3; 2]| place.distance(Line { from, to }.nearest(place));
    let ends = one.map(|end| from(end, other)).into_iter().chain(other.map(|end| from(end, one)));
    let across = across(edges).map(|[a, b]| a.distance(b));
    ends.chain(across).fold(f32::INFINITY, f32::min)
}

#[cfg(test)]
mod tests {
    use super::*;
    use pointmass::Time;
    use pointmass::scene::{Model, SceneFile};

    /// A strip that stands and folds onto itself, and a sheet that falls on it.
    const SCENE: &str = r#"{
        "run": {"substeps": 4},
        "forces": [{"gravity": {"acceleration": [0, -9.81, 0]}}],
        "scenery": [{"shape": {"plane": {"point": [0, 0, 0], "normal": [0, 1, 0]}}}],
        "cloths": [
            {"form": {"sheet": {"corner": [0, 0.02, 0], "sides": [[0.12, 0.01, 0], [0, 0.5, 0.15]], "cells": [1, 8]}},
                "density": 0.2, "thickness": 0.02, "shell": {"stretch": [300, 200], "shear": 60, "bending": 2e-5, "damping": 2e-3}},
            {"form": {"sheet": {"corner": [-0.15, 0.62, -0.15], "sides": [[0.4, 0.05, 0], [0.02, -0.05, 0.4]], "cells": [3, 3]}},
                "density": 0.2, "thickness": 0.03, "shell": {"stretch": [300, 200], "shear": 60, "bending": 2e-5, "damping": 2e-3}}
        ]
    }"#;

    /// How far a place is from a triangle at the most: from the nearest of many places in it \[m\].
    fn sampled(place: Vec3, [a, b, c]: [Vec3; 3]) -> f32 {
        const FINE: u32 = 24;
        let all = (0..=FINE).flat_map(|i| (0..=FINE - i).map(move |j| [i, j].map(|k| k as f32 / FINE as f32)));
        all.map(|[s, t]| place.distance(a + (b - a) * s + (c - a) * t)).fold(f32::INFINITY, f32::min)
    }

    #[test]
    fn all_that_touch_are_within_both_thicknesses_and_none_is_left_out() {
        let file = SceneFile::from_json("a.json", SCENE).expect("a scene");
        let model = Model::load(&file, "a.json", &mut ()).expect("a scene");
        let (scene, mut system) = (model.scene(), model.system(0, 1).expect("memory"));
        let contacts = &model.constraints.3;
        let [mut own, mut of_both] = [0; 2];
        for frame in 0..=40 {
            system.step_to(&scene, Time::frame(frame, 60));
            let state = system.state(&scene);
            let found = touches(&state, contacts, &model.particles);
            let sheets = Sheets::of(&state, contacts, &model.particles);
            let places = |corners: [u32; 3]| corners.map(|corner| sheets.now[corner as usize]);
            // A triangle on which a place is.
            let on = |place: Vec3, strip: bool| {
                let mut all = contacts.triangles.iter().filter(|corners| (corners[0] < 18) == strip);
                all.any(|&corners| sampled(place, places(corners)) < 8e-3)
            };
            for Touch { places: [a, b], distance, .. } in &found {
                let is_own = [true, false].into_iter().any(|strip| on(*a, strip) && on(*b, strip));
                let is_other = on(*a, true) && on(*b, false) || on(*a, false) && on(*b, true);
                assert!(is_own || is_other, "{frame}: {a} {b} are on no sheet");
                assert!(
                    *distance < 0.03 * (1.0 + SLACK) && (a.distance(*b) - distance).abs() < 1e-6,
                    "{frame}: {distance}"
                );
                [own, of_both] = [own + i32::from(is_own), of_both + i32::from(is_other)];
            }
            // Whoever of one sheet is by far near enough to a triangle of the other touches something.
            for (point, &place) in sheets.now.iter().enumerate() {
                let others = contacts.triangles.iter().filter(|corners| (corners[0] < 18) != (point < 18));
                let nearest = others.map(|&corners| sampled(place, places(corners))).fold(f32::INFINITY, f32::min);
                let is_found = found.iter().any(|touch| touch.places.contains(&place));
                assert!(!(nearest < 0.025) || is_found, "{frame}: {point} is {nearest} from the other sheet");
            }
        }
        // Nothing touches to begin with, and then the strip touches itself and the sheet on it.
        assert!(own > 30 && of_both > 30, "{own} {of_both}");
    }

    #[test]
    fn edges_touch_where_they_cross_and_points_where_they_are_nearest() {
        let edge = [Vec3::ZERO, Vec3::X];
        let upright = |x: f32| [Vec3::new(x, -1.0, 0.1), Vec3::new(x, 3.0, 0.1)];
        let [a, b] = across([edge, upright(0.25)]).expect("they cross");
        assert!(a.distance(Vec3::X * 0.25) < 1e-6 && b.distance(a + Vec3::Z * 0.1) < 1e-6, "{a} {b}");
        for (other, far) in [([Vec3::Y, Vec3::Y + Vec3::X], 1.0), (upright(2.0), 1.01_f32.sqrt())] {
            assert_eq!(across([edge, other]), None);
            assert!((apart([edge, other]) - far).abs() < 1e-6);
        }
        assert!((apart([edge, upright(0.25)]) - 0.1).abs() < 1e-6);
        let corners = [Vec3::ZERO, Vec3::X, Vec3::Y * 2.0];
        let at = |x: f32, y: f32, z: f32| {
            let place = Vec3::new(x, y, z);
            let nearest = Triangle { corners }.nearest(place);
            let least = |of: &[u32]| {
                let ends: Vec<_> = of.iter().map(|&corner| corners[corner as usize]).collect();
                match ends[..] {
                    [a] => place.distance(a),
                    [a, b] => place.distance(Line { from: a, to: b }.nearest(place)),
                    _ => (place.dot(Vec3::Z)).abs(),
                }
            };
            // They are all that it takes to find the place.
            let far = least(&between(nearest, [0, 1, 2], corners));
            assert!((far - place.distance(nearest)).abs() < 1e-5, "{place}: {far}");
        };
        for i in 0..343 {
            let [x, y, z] = [i % 7, i / 7 % 7, i / 49].map(|k| 0.6 * k as f32 - 1.7);
            at(x, y, z);
        }
    }
}
