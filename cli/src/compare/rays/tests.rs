//! Comparisons on a mesh are tried with segments and answers that are known beforehand.

use super::super::contender::Build;
use super::super::workload::Workload;
use super::made::Made;
use super::query::Query;
use super::surface::Surface;
use super::tracer::{Answers, Entrant, Own, Tracer};
use super::verify::Expected;
use crate::outcome::Outcome;
use pointmass::rays::{Cost, Structure};
use pointmass::shape::{Collider, Hit, Surface as _, Triangle};
use pointmass::{Vec3, math};
use pointmass_files::meshes::MeshData;

fn made(made: Made, triangles: usize) -> Surface {
    Surface::made(made, triangles).expect("a mesh")
}

#[test]
fn segments_are_drawn_as_they_are_described() {
    let surface = made(Made::Knot, 400);
    let all = Query::all(&surface, 500, Some(0.01), 3);
    assert_eq!(all.iter().map(|query| query.workload).collect::<Vec<_>>(), Workload::OF_MESHES);
    let [short, sorted, long, balls] = &all[..] else { panic!() };
    let step = 0.01 * surface.size;
    for segment in &short.segments {
        assert!((math::length(segment.step()) - step).abs() < 1e-3 * step && segment.radius == 0.0);
        let apart = math::length(surface.mesh.nearest(segment.from) - segment.from);
        assert!(apart <= 1.001 * step, "{apart} from the surface, {step} allowed");
    }
    let hits = short.segments.iter().filter(|segment| surface.mesh.first_hit(segment).is_some()).count();
    assert!((50..350).contains(&hits), "{hits} of 500 hit");
    for segment in &long.segments {
        for end in [segment.from, segment.to] {
            let radius = math::length(end - surface.mesh.bounds().center());
            assert!((2.0 * radius / surface.size - 1.0).abs() < 1e-3, "{radius}");
        }
    }
    assert!(
        balls.segments.iter().zip(&short.segments).all(|(ball, point)| ball.from == point.from && ball.radius == 0.01)
    );

    // The same segments, and each much nearer to the one before it.
    let key = |segment: &pointmass::shape::Segment| segment.from.to_array().map(f32::to_bits);
    let mut keys = [short, sorted].map(|query| query.segments.iter().map(key).collect::<Vec<_>>());
    keys.iter_mut().for_each(|keys| keys.sort_unstable());
    assert_eq!(keys[0], keys[1]);
    let way =
        |query: &Query| query.segments.windows(2).map(|pair| math::length(pair[1].from - pair[0].from)).sum::<f32>();
    assert!(way(sorted) < 0.3 * way(short), "{} and {}", way(sorted), way(short));
}

/// A tracer that lies about one segment.
struct Liar<'a>(Own<'a>, Workload);

impl Tracer for Liar<'_> {
    fn built(&self) -> Build {
        self.0.built()
    }
    fn trace(&self, query: &Query, asked: usize, answers: &mut Answers) -> bool {
        self.0.trace(query, asked, answers);
        if let Some(answer) = answers.exact.get_mut(17).filter(|_| query.workload == self.1) {
            answer.get_or_insert(Hit::new(0.5, Vec3::X, 0.0)).face ^= 1;
        }
        true
    }
    fn cost(&self, query: &Query, asked: usize) -> Option<Cost> {
        self.0.cost(query, asked)
    }
}

#[test]
fn a_wrong_hit_is_caught_and_the_segment_named() {
    let surface = made(Made::Terrain, 200);
    let mesh = surface.mesh.view();
    let all = Query::all(&surface, 60, Some(0.01), 3);
    let mut memory = vec![0; Structure::Bvh.words(mesh.triangles().len())];
    let own = Own { mesh, index: Structure::Bvh.build(&mesh, &mut memory).expect("room") };
    let (expected, judged) = Expected::by((&own, "bvh"), mesh, &all, 60, 1).map_err(|e| e.to_string()).expect("right");
    assert_eq!(judged, 60);
    let said = |outcome: Outcome| outcome.err().map(|failure| failure.to_string()).unwrap_or_default();
    assert_eq!(said(expected.check(&own, "bvh", &all, 60)), "");
    for about in Workload::OF_MESHES {
        let liar = Liar(Own { ..own }, about);
        let checked = said(expected.check(&liar, "liar", &all, 60));
        let judged = said(Expected::by((&liar, "liar"), mesh, &all, 60, 1).map(drop));
        for said in [checked, judged] {
            let name = about.name();
            assert!(
                said.starts_with(&format!("liar gives a wrong answer to {name}, segment 17 of 60, from ")),
                "{said}"
            );
            assert!(said.contains("expected ") && said.contains("nothing was measured"), "{said}");
        }
        assert_eq!(said(expected.check(&liar, "liar", &all, 17)), "", "of those it is not asked nothing is said");
    }
}

#[test]
fn every_structure_finds_what_a_loop_over_triangles_finds() {
    for surface in [made(Made::Knot, 300), made(Made::Terrain, 300)] {
        let mesh = surface.mesh.view();
        let all = Query::all(&surface, 120, Some(0.002), 5);
        let corner = |i: u32| mesh.vertices()[i as usize];
        let faces: Vec<_> = mesh.triangles().iter().map(|face| Triangle { corners: face.map(corner) }).collect();
        for &structure in Structure::ALL {
            let mut memory = Vec::new();
            let mut entrant = Entrant::Own(structure);
            memory.resize(entrant.words(mesh.triangles().len()), 0);
            let (tracer, _) = entrant.build(mesh, &mut memory, 2).map_err(|e| e.to_string()).expect("room");
            let mut answers = Answers::default();
            for query in &all {
                assert!(tracer.trace(query, usize::MAX, &mut answers));
                for (segment, found) in query.segments.iter().zip(&answers.exact) {
                    let times = faces.iter().filter_map(|face| face.first_hit(segment)).map(|hit| hit.time);
                    let first = times.fold(f32::INFINITY, f32::min);
                    let time = found.map_or(f32::INFINITY, |hit| hit.time);
                    assert!(
                        first == time || (first - time).abs() < 1e-4,
                        "{structure}: {time} for {first}, {segment:?}"
                    );
                }
                let cost = tracer.cost(query, query.segments.len()).unwrap_or_default();
                let most = (mesh.triangles().len() * query.segments.len()) as u64;
                assert!(cost.tests <= 2 * most && (cost.tests > 0), "{structure}: {cost:?}");
                // Brute force looks at all boxes, others at far fewer.
                assert_eq!(
                    (cost.visits == most, cost.visits < most),
                    (structure == Structure::Brute, structure != Structure::Brute)
                );
            }
            let built = tracer.built();
            assert!(built.nodes.is_some() && built.bytes_each.is_some_and(|bytes| bytes < 400.0), "{built:?}");
        }
    }
}

#[test]
fn meshes_without_an_extent_are_refused() {
    let mesh = |size: f32| MeshData {
        vertices: vec![[0.0; 3], [size, 0.0, 0.0], [0.0, size, 0.0]],
        triangles: vec![[0, 1, 2]],
    };
    let said = |size| {
        let surface = Surface::new("a.off", String::new(), String::new(), mesh(size));
        surface.err().map(|failure| failure.to_string()).unwrap_or_default()
    };
    assert_eq!(said(1.0), "");
    assert!(said(0.0).starts_with("a.off: the mesh is 0.0e0 across: expected from 1e-12 to 1e15"), "{}", said(0.0));
    assert!(said(1e20).contains("scale it"));
}
