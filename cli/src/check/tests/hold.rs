//! The words about constraints, held against scenes that come to rest.

use super::super::bounds::Bounds;
use super::super::hold::Hold;
use super::super::part::place;
use pointmass::scene::{Model, SceneFile};
use pointmass::stability::Limit;
use pointmass::{Heap, Method, Report, System, Time, Vec3};
use std::fmt::Write;

/// A scene under gravity \[m/s²\], of particles and whatever else.
fn model(gravity: f64, particles: &str, rest: &str) -> Model {
    let text = format!(
        r#"{{"forces": [{{"gravity": {{"acceleration": [0, {}, 0]}}}}, {{"drag": {{}}}}], "particles": [{particles}], {rest}}}"#,
        -gravity
    );
    let file = SceneFile::from_json("a.json", &text).unwrap_or_else(|error| panic!("{error}: {text}"));
    Model::load(&file, "a.json", &mut crate::load::Disk).expect("a sound scene")
}

/// A particle of a scene, braked so that it comes to rest soon.
fn particle(at: Vec3, mass: f64, fixed: bool) -> String {
    let Vec3 { x, y, z } = at;
    format!(r#"{{"position": [{x}, {y}, {z}], "mass": {mass}, "drag": {}, "fixed": {fixed}}}"#, 0.8 * mass)
}

/// Where all are after some seconds, in steps that are cut into so many parts.
fn rest(model: &Model, substeps: u32, method: Method, seconds: u64) -> (Vec<Vec3>, Report) {
    let model = Model { substeps, integrator: method.into(), ..model.clone() };
    let mut system = System::with(Heap::new(model.size(model.particles.len())));
    system.start(&model.scene(), 1).expect("room");
    for frame in 1..=60 * seconds {
        system.step_to(&model.scene(), Time::frame(frame, 60));
    }
    (system.particles().position.to_vec(), *system.totals())
}

/// The one group of constraints of a scene.
#[track_caller]
fn only(model: &Model) -> Hold {
    let mut holds = Hold::all(model);
    assert_eq!(holds.len(), 1);
    holds.remove(0)
}

/// Distances between particles, in the order given.
fn distances(ends: &[[usize; 2]], lengths: &[f32], compliance: f64) -> String {
    let distance = |([a, b], length): (&[usize; 2], &f32)| {
        format!(r#"{{"distance": {{"ends": [{a}, {b}], "length": {length}, "compliance": {compliance}}}}}"#)
    };
    let all: Vec<_> = ends.iter().zip(lengths).map(distance).collect();
    format!(r#""constraints": [{}]"#, all.join(", "))
}

/// The largest share by which one of some links is too long.
fn worst(x: &[Vec3], ends: &[[usize; 2]], lengths: &[f32]) -> f64 {
    let strain = |([a, b], length): (&[usize; 2], &f32)| f64::from(x[*a].distance(x[*b])) / f64::from(*length) - 1.0;
    ends.iter().zip(lengths).map(strain).fold(0.0, f64::max)
}

#[test]
fn chains_of_distances_hang_as_long_as_it_is_said() {
    for (links, length, mass, weight, compliance, gravity) in [
        (12usize, 0.1f32, 0.05f64, 1.0, 0.0, 9.8),
        (12, 0.02, 3.0, 1.0, 0.0, 1.6),
        (20, 0.5, 0.001, 40.0, 0.0, 9.8),
        (8, 0.1, 0.05, 3.0, 2e-3, 9.8),
    ] {
        for (backward, substeps, method) in [
            (false, 4, Method::Symplectic),
            (true, 4, Method::Verlet),
            (false, 11, Method::Rk4),
            (true, 30, Method::Symplectic),
        ] {
            let mut particles = String::new();
            for i in 0..=links {
                let own = if i == links { weight } else { 1.0 };
                let at = Vec3::new(3.0, -2.0 - i as f32 * length, 1.0);
                let _ = write!(particles, "{}{}", if i > 0 { ", " } else { "" }, particle(at, own * mass, i == 0));
            }
            let mut ends: Vec<_> = (0..links).map(|i| [i, i + 1]).collect();
            if backward {
                ends.reverse();
            }
            let lengths = vec![length; links];
            let model = model(gravity, &particles, &distances(&ends, &lengths, compliance));
            let (hold, h) = (only(&model), 1.0 / 60.0 / f64::from(substeps));
            let hangs = worst(&rest(&model, substeps, method, 15).0, &ends, &lengths);
            let said = hold.gives + hold.fault(h);
            // Where order and compliance put the worst of both into one link the sum is exact.
            let slack = if backward && compliance > 0.0 { 0.1 } else { 0.01 };
            let rounding = f64::from(f32::EPSILON) * 4.0 / f64::from(length);
            assert!(
                (hangs - said).abs() < slack * said + rounding,
                "{links} {length} {backward} {substeps} {method}: {hangs}, said {said}"
            );
            let Limit::Step(enough) = hold.largest_step() else { panic!("a step") };
            assert!((hold.fault(enough) - 0.01).abs() < 1e-9);
        }
    }
}

#[test]
fn nets_and_bridges_of_distances_hang_as_it_is_said() {
    // A bridge that is longer than its span, a weight in it; and a net that hangs by two corners.
    let (n, span) = (16usize, 1.0f32);
    let bridge: Vec<_> = (0..=n).map(|i| Vec3::X * (span * i as f32 / n as f32)).collect();
    let chain: Vec<_> = (0..n).map(|i| [i, i + 1]).collect();
    let side = 5usize;
    let net: Vec<_> = (0..side * side).map(|i| Vec3::new((i % side) as f32, 0.0, (i / side) as f32) * 0.1).collect();
    let at = |x: usize, z: usize| z * side + x;
    let along = (0..side).flat_map(|z| (1..side).map(move |x| [at(x - 1, z), at(x, z)]));
    let across = (1..side).flat_map(|z| (0..side).map(move |x| [at(x, z - 1), at(x, z)]));
    let threads: Vec<_> = along.chain(across).collect();
    for (places, ends, held, longer, heavy, substeps) in [
        (&bridge, &chain, [0, n], 1.2, 5usize, [8, 20]),
        // The tauter it is, the sooner its own fault makes it hang deeper, and pulls less.
        (&bridge, &chain, [0, n], 1.02, 5, [24, 50]),
        (&net, &threads, [0, side - 1], 1.05, 12, [8, 20]),
    ] {
        let lengths: Vec<_> = ends.iter().map(|&[a, b]| longer * places[a].distance(places[b])).collect();
        let mass = |i: usize| if i == heavy { 0.2 } else { 0.02 };
        let all: Vec<_> = (0..places.len()).map(|i| particle(places[i], mass(i), held.contains(&i))).collect();
        let model = model(9.8, &all.join(", "), &distances(ends, &lengths, 0.0));
        let hold = only(&model);
        assert!(!hold.estimated);
        for substeps in substeps {
            let hangs = worst(&rest(&model, substeps, Method::Symplectic, 10).0, ends, &lengths);
            let said = hold.fault(1.0 / 60.0 / f64::from(substeps));
            assert!((0.93..1.07).contains(&(hangs / said)), "{longer} {substeps}: {hangs}, said {said}");
        }
    }
}

#[test]
fn what_falls_freely_is_not_stretched_and_ropes_owe_nothing() {
    let three: Vec<_> = (0..3).map(|i| particle(Vec3::Y * (-0.1 * i as f32), 1.0, i == 0)).collect();
    let pair = distances(&[[1, 2]], &[0.1], 1e-4);
    let hold = only(&model(9.8, &three.join(", "), &pair));
    assert_eq!((hold.gives, hold.owes, hold.largest_step()), (0.0, 0.0, Limit::Unconditional));
    assert!((hold.rate.expect("a rate") - (2.0f64 / 1e-4).sqrt()).abs() < 1e-3);
    let rope = r#""constraints": [{"rope": {"particles": [0, 1, 2], "lengths": [0.1], "compliance": 1e-4}}]"#;
    let hold = only(&model(9.8, &three.join(", "), rope));
    assert_eq!((hold.kind, hold.owes), ("rope", 0.0));
    assert!((hold.gives / (1e-4 * 2.0 * 9.8 / 0.1) - 1.0).abs() < 1e-3, "{}", hold.gives);
    // Nobody is asked about nothing, and what is in one place or weighs nothing does no harm.
    assert!(Hold::all(&model(9.8, &three.join(", "), r#""constraints": []"#)).is_empty());
    let same = vec![particle(Vec3::ZERO, 1e-30, false); 3].join(", ");
    for constraints in
        [distances(&[[0, 1], [1, 2], [0, 2]], &[0.0, 0.0, 1e30], 0.0), distances(&[[0, 1]], &[1.0], 1e30)]
    {
        for gravity in [0.0, 9.8, 1e30] {
            let hold = only(&model(gravity, &same, &constraints));
            assert!(hold.gives.is_finite() && hold.owes.is_finite(), "{hold:?}");
        }
    }
}

#[test]
fn sheets_hang_as_much_longer_as_it_is_said() {
    for (length, cells, stretch, density, far) in [(0.5f32, 6u32, 40.0f32, 0.2f32, 0.0f32), (2.0, 4, 300.0, 0.3, 20.0)]
    {
        let fixed: Vec<_> = (0..=2).map(|i| i * (cells + 1)).collect();
        let cloth = format!(
            r#""cloths": [{{"form": {{"sheet": {{"corner": [{far}, 0, 0], "sides": [[0, -{length}, 0], [0, 0, {}]], "cells": [{cells}, 2]}}}},
                "density": {density}, "shell": {{"stretch": [{stretch}, {stretch}], "shear": {}}}, "fixed": {fixed:?}, "drag": 0.01}}]"#,
            0.25 * length,
            0.5 * stretch,
        );
        let model = model(9.8, "", &cloth);
        let hold = only(&model);
        assert_eq!((hold.place.as_str(), hold.kind), ("cloths[0]", "shell"));
        for substeps in [2, 10] {
            let (x, report) = rest(&model, substeps, Method::Symplectic, 5);
            // By Green's strain; at the top half a cell is missing, and the mean is half of what is at the top.
            let longer = f64::from((x[0].y - x[cells as usize].y) / length) - 1.0;
            assert!((0.9..1.1).contains(&(2.0 * longer / hold.gives)), "{longer}, said {} at the top", hold.gives);
            let iterations = report.effort.iterations as f64 / report.effort.solves as f64;
            let said = hold.iterations(1.0 / 60.0 / f64::from(substeps)) as f64;
            assert!(iterations <= said, "{iterations} iterations, said {said}");
        }
    }
}

/// The largest strain of an edge along a sheet's sides in any of the first frames, in steps that are cut into so many parts.
fn struck(model: &Model, substeps: u32, cells: usize, edge: f64) -> f64 {
    let model = Model { substeps, ..model.clone() };
    let mut system = System::with(Heap::new(model.size(model.particles.len())));
    system.start(&model.scene(), 1).expect("room");
    let side = cells + 1;
    let along = (0..side * side).filter(|i| i % side < cells).map(|i| [i, i + 1]);
    let across = (0..side * cells).map(|i| [i, i + side]);
    let edges: Vec<_> = along.chain(across).collect();
    let strain = |frame| {
        system.step_to(&model.scene(), Time::frame(frame, 60));
        let x = system.particles().position;
        edges.iter().map(|&[a, b]| f64::from(x[a].distance(x[b])) / edge - 1.0).fold(0.0, f64::max)
    };
    (1..=20).map(strain).fold(0.0, f64::max)
}

#[test]
fn sheets_that_hit_are_stretched_as_far_as_it_is_said() {
    for (cells, side, density, stretch, speed, thickness, friction) in [
        (12usize, 1.0f64, 0.2, 500.0, 4.0, 0.0, 0.0),
        (16, 0.5, 0.1, 1000.0, 3.0, 0.003, 0.0),
        (14, 1.0, 0.2, 2000.0, 6.0, 0.01, 0.5),
    ] {
        let touches = if thickness > 0.0 { format!(r#""thickness": {thickness},"#) } else { String::new() };
        let cloth = format!(
            r#""materials": [{{"contact": {{"friction": {{"static": {friction}, "kinetic": {friction}}}}}}}],
               "cloths": [{{"form": {{"sheet": {{"corner": [{0}, {1}, {0}], "sides": [[{side}, 0, 0], [0, 0, {side}]], "cells": [{cells}, {cells}]}}}},
                "density": {density}, "shell": {{"stretch": [{stretch}, {stretch}], "shear": {2}, "bending": 1e-5, "damping": 2e-3}},
                {touches} "material": 0, "velocity": [0, -{speed}, 0]}}],
               "scenery": [{{"shape": {{"plane": {{"point": [0, 0, 0], "normal": [0, 1, 0]}}}}}},
                {{"shape": {{"sphere": {{"center": [0, {3}, 0], "radius": {4}}}}}}}]"#,
            -0.5 * side,
            0.32 * side,
            0.4 * stretch,
            0.2 * side,
            0.1 * side,
        );
        let model = model(9.8, "", &cloth);
        let (hold, edge) = (only(&model), side / cells as f64);
        let fall = hold.fall.expect("a fall");
        assert_eq!(fall.rough, friction > 0.0);
        assert!((fall.edge / edge - 1.0).abs() < 1e-4 && fall.speed < (speed * speed + 19.6 * 0.33 * side).sqrt());
        let given = struck(&model, 40, cells, edge);
        assert!((0.5..1.1).contains(&(given / fall.gives)), "{cells}: {given}, said {}", fall.gives);
        for substeps in [1, 2, 5] {
            let (all, h) = (struck(&model, substeps, cells, edge), 1.0 / 60.0 / f64::from(substeps));
            let more = fall.fault(h).expect("not too far");
            assert!(all - given < more + 0.005, "{cells}, {substeps}: {all} beside {given}, said {more} more");
            assert!(all < fall.gives + more, "{cells}, {substeps}: {all}, said {} and {more}", fall.gives);
        }
        assert!((fall.fault(fall.step(0.01)).expect("not too far") - 0.01).abs() < 1e-9);
        assert!(hold.enough() == Limit::Step(fall.step(0.01)) && hold.largest_step() == Limit::Unconditional);
        assert_eq!(fall.fault(4.0 * edge / fall.speed), None);
    }
}

#[test]
fn sheets_fall_where_nothing_holds_them_and_something_is_beneath() {
    let cloth = r#""cloths": [{"form": {"sheet": {"corner": [0, 2, 0], "sides": [[1, 0, 0], [0, 0, 1]], "cells": [4, 4]}}, "mass": 1,
        "shell": {"stretch": [100, 400], "shear": 50}HELD}]"#;
    let floor = r#", "scenery": [{"shape": {"plane": {"point": [0, 0, 0], "normal": [0, 1, 0]}}}]"#;
    let bolt = particle(Vec3::Y * 2.0, 1.0, true);
    let tie = r#", "constraints": [{"distance": {"ends": [0, 1], "length": 0.1}}]"#;
    let at = |held: &str, rest: &str| {
        let model = model(9.8, &bolt, &(cloth.replace("HELD", held) + rest));
        Hold::all(&model).pop().expect("a sheet").fall
    };
    let fall = at("", floor).expect("a fall");
    assert!((fall.speed - (2.0 * 9.8 * 2.0f64).sqrt()).abs() < 1e-3, "{fall:?}");
    // The softer of its sides has the slower waves: 10 m/s.
    assert!((fall.gives / (1.5 * fall.speed / 10.0) - 1.0).abs() < 1e-3, "{fall:?}");
    assert_eq!([at("", ""), at(r#", "fixed": [0]"#, floor), at("", &format!("{floor}{tie}"))], [None; 3]);
}

/// A pile of boxes on the ground, of some side \[m\].
fn pile(gravity: f64, side: f32, count: u32) -> Model {
    let boxes = format!(
        r#""boxes": [{{"sides": [{side}, {side}, {side}], "mass": 0.7, "position": [0, {}, 0], "count": [1, {count}, 1]}}],
           "scenery": [{{"shape": {{"plane": {{"point": [0, 0, 0], "normal": [0, 1, 0]}}}}}}]"#,
        0.5 * side
    );
    model(gravity, "", &boxes)
}

#[test]
fn piles_of_boxes_sink_as_deep_as_it_is_said() {
    for (gravity, side, count, substeps) in
        [(9.8, 0.1f32, 10u32, 10u32), (9.8, 0.1, 10, 30), (1.6, 0.02, 10, 20), (30.0, 1.0, 10, 5), (9.8, 0.1, 3, 10)]
    {
        let model = pile(gravity, side, count);
        let (hold, (x, _)) = (only(&model), rest(&model, substeps, Method::Verlet, 3));
        let middle = |n: usize| x[8 * n..][..8].iter().map(|x| x.y).sum::<f32>() / 8.0;
        let gap = |n: usize| if n == 0 { middle(0) + 0.5 * side } else { middle(n) - middle(n - 1) };
        let sinks = (0..count as usize).map(|n| f64::from(side - gap(n)) / f64::from(side)).fold(0.0, f64::max);
        let said = hold.fault(1.0 / 60.0 / f64::from(substeps));
        let least = if count == 10 { 0.9 } else { 0.0 };
        assert!((least..1.1).contains(&(sinks / said)), "{gravity} {side} {count} {substeps}: {sinks}, said {said}");
    }
}

/// The tallest pile counts, wherever gravity pulls; what lies beside it or far above is not on it. Of few boxes all may come to lie on each other.
#[test]
fn piles_are_as_tall_as_they_stand() {
    let boxes = |place: &str, count: &str, spacing: &str| {
        format!(
            r#"{{"sides": [0.3, 0.1, 0.2], "mass": 1, "position": {place}, "count": {count}, "spacing": {spacing}}}"#
        )
    };
    let tall = boxes("[5, 0.05, 0]", "[1, 14, 1]", "[0.3, 0.1, 0.2]");
    let low = boxes("[0, 0.05, 0]", "[6, 3, 6]", "[0.31, 0.1, 0.21]");
    let apart = boxes("[9, 0.05, 0]", "[1, 30, 1]", "[0.3, 0.2, 0.2]");
    let bonded = (0..12).map(|i| {
        boxes(&format!("[{}, {}, 3]", 0.14 * f64::from(i % 2), 0.05 + 0.1 * f64::from(i)), "[1, 1, 1]", "[1, 1, 1]")
    });
    let bonded = bonded.collect::<Vec<_>>().join(", ");
    let aside = boxes("[5, 0, 0]", "[17, 1, 1]", "[0.3, 0.1, 0.2]");
    for (all, gravity, pile) in [
        (&tall, 9.8, 14),
        (&low, 9.8, 10),
        (&format!("{low}, {tall}"), 9.8, 14),
        (&apart, 9.8, 10),
        (&bonded, 9.8, 12),
        (&aside, 9.8, 10),
        (&tall, -9.8, 14),
    ] {
        let model = model(gravity, "", &format!(r#""boxes": [{all}]"#));
        let holds = Hold::all(&model);
        assert!(holds.iter().all(|hold| hold.pile == Some(pile)), "{all}: {:?}", holds[0].pile);
    }
}

#[test]
fn boxes_have_their_places_and_bound_the_steps_of_auto() {
    let pile = pile(9.8, 0.1, 3);
    assert_eq!([0, 23].map(|i| place(&pile, 0, i)), ["boxes[0]", "boxes[0]"]);
    let both = model(
        9.8,
        &particle(Vec3::ZERO, 1.0, true),
        r#""cloths": [{"form": {"sheet": {"corner": [0, 0, 0], "sides": [[1, 0, 0], [0, 0, 1]], "cells": [1, 1]}}, "mass": 1,
            "springs": {"structural": {"ks": 1}}}],
           "boxes": [{"sides": [1, 1, 1], "mass": 1, "position": [0, 9, 0], "count": [2, 1, 1]}, {"sides": [1, 1, 1], "mass": 1, "position": [0, 20, 0]}]"#,
    );
    let places = [0, 1, 4, 5, 20, 21].map(|i| place(&both, 0, i));
    assert_eq!(places, ["particles[0]", "cloths[0]", "cloths[0]", "boxes[0]", "boxes[0]", "boxes[1]"]);
    assert_eq!(place(&both, 1, 2), "cloths[0]");
    // A run's step is as many times as long as the scene cuts it into parts.
    let bounds = Bounds::of(&both);
    let cut = Bounds::of(&Model { substeps: 7, ..both });
    for &method in Method::ALL {
        match (bounds.whole_step(method), cut.whole_step(method)) {
            (Limit::Step(one), Limit::Step(seven)) => assert!((seven / one - 7.0).abs() < 1e-9),
            (one, seven) => assert_eq!(one, seven),
        }
    }
}

/// Slack ropes come to rest in sub-steps that are just short enough for that, and not in all that are far longer.
#[test]
fn slack_ropes_tremble_in_long_sub_steps() {
    for (length, segments, gravity, drag) in [(1.0, 50, 9.81, 1.0), (20.0, 40, 1.62, 1.0), (1.0, 30, 9.81, 10.0)] {
        let deep = f64::sqrt(0.5 * 0.5 - 0.2 * 0.2) * length;
        let text = format!(
            r#"{{"forces": [{{"gravity": {{"acceleration": [0, -{gravity}, 0]}}}}, {{"drag": {{}}}}], "ropes": [{{
                "curve": [[0, 0, 0], [{}, -{deep}, 0], [{}, 0, 0]], "segments": {segments}, "weight": 0.1, "drag": {},
                "fixed": [0, {segments}]}}]}}"#,
            0.2 * length,
            0.4 * length,
            0.08 * length * drag * f64::sqrt(gravity / length / 9.81),
        );
        let file = SceneFile::from_json("a.json", &text).expect("a scene");
        let model = Model::load(&file, "", &mut crate::load::Disk).expect("a sound scene");
        let [hold] = &Hold::all(&model)[..] else { panic!("one rope") };
        let (_, calm) = hold.trembling(1e9).expect("any rope trembles in long sub-steps");
        let fastest = |h: f64| {
            let mut system = System::with(Heap::new(model.size(model.particles.len())));
            system.start(&model.scene(), 1).expect("room");
            for _ in 0..(20.0 * f64::sqrt(length / gravity * 9.81) / h) as u32 {
                system.step(&model.scene(), Time::from_seconds_f64(h));
            }
            let speeds = system.particles().velocity.iter().map(|v| f64::from(v.length()));
            speeds.fold(0.0, f64::max) / (gravity * h)
        };
        assert!(hold.trembling(0.99 * calm).is_none());
        let still = fastest(0.98 * calm);
        let trembling = [1.3, 1.6, 2.0].map(|longer| fastest(longer * calm)).into_iter().fold(0.0, f64::max);
        assert!(still < 2e-2 && trembling > 0.1, "{length} m: {still} and {trembling} g h");
    }
}
