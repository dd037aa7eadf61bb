//! What there is to draw: trails, lines, shapes and surfaces as plain lists.

use pointmass::constrain::{Distance, RigidBodies, RigidBox, Rope, ShapeMatching, TiedRope};
use pointmass::draw::{
    Instance, Knot, Line, Lock, Patch, Ring, StrandLight, Trails, Vertex, arrows, body, cells, links, links_by_strain,
    solids, springs, strained, strands, surface, velocities,
};
use pointmass::index::{SpatialIndex, Structure};
use pointmass::material::{Heading, TrailMaterial};
use pointmass::shape::Sphere;
use pointmass::{
    ConstraintKind, ContactMaterial, Emitter, Gravity, Material, Method, Particle, Scene, Sheet, Spread, Spring, Time,
    Varied, Vec3,
};
use pointmass_tests::started;
use std::collections::HashMap;

fn length(line: &Line) -> f32 {
    line.ends[0].distance(line.ends[1])
}

/// The trails of a scene at an instant, looked at so often a second, each with that many knots.
fn trails_at(scene: &Scene<'_>, trail: TrailMaterial, fps: u32, frames: u64, knots: usize) -> Vec<Line> {
    let capacity = scene.size().particles;
    let mut system = started(scene, capacity, 1);
    let (mut rings, mut memory) = (vec![Ring::NONE; capacity], vec![Knot::NONE; capacity * knots]);
    let mut trails = Trails::new(&mut rings, &mut memory, Some(trail));
    trails.look(&system.state(scene));
    for frame in 1..=frames {
        system.step_to(scene, Time::frame(frame, fps));
        assert_eq!(trails.look(&system.state(scene)), 0);
    }
    let mut lines = vec![Line::NONE; capacity * (knots + 1)];
    let (count, left_out) = trails.lines(&system.state(scene), &mut lines);
    assert_eq!(left_out, 0);
    lines.truncate(count);
    lines
}

#[test]
fn a_trail_is_as_long_as_the_way_of_its_time_at_any_rate_and_fades_to_nothing() {
    for speed in [0.01f32, 3.0, 500.0] {
        for seconds in [0.1f32, 0.73] {
            for (fps, knots) in [(10, 12), (24, 40), (60, 40), (60, 5), (1000, 40)] {
                let start = [Particle { velocity: Vec3::new(0.6, 0.0, -0.8) * speed, ..Particle::REST }];
                let scene = Scene { start: &start, ..Scene::EMPTY };
                let trail = TrailMaterial { seconds, width: 0.2 };
                let lines = trails_at(&scene, trail, fps, u64::from(fps), knots);
                let way: f32 = lines.iter().map(length).sum();
                assert!((way - speed * seconds).abs() < 0.01 * way, "{speed}, {seconds}, {fps}, {knots}: {way}");
                let (first, last) = (lines[0], lines[lines.len() - 1]);
                assert_eq!((first.widths[0], first.colors[0][3]), (0.2, 255));
                assert!(last.widths[1] < 1e-4 && last.colors[1][3] == 0, "{last:?}");
                assert!(lines.windows(2).all(|pair| pair[0].ends[1] == pair[1].ends[0]));
            }
        }
    }
}

#[test]
fn a_trail_follows_a_bent_way_within_a_hundredth() {
    // A throw: the way of the last 0.6 s, by its integral.
    let start = [Particle { velocity: Vec3::new(2.0, 6.0, 0.0), ..Particle::REST }];
    let exact: f64 = (0..60_000)
        .map(|i| {
            let t = 0.4 + (f64::from(i) + 0.5) * 1e-5;
            2.0f64.hypot(6.0 - 9.80665 * t) * 1e-5
        })
        .sum();
    for method in Method::ALL {
        let forces = &Gravity { acceleration: Vec3::NEG_Y * 9.80665 };
        let scene = Scene { start: &start, forces, integrator: method.integrator(), ..Scene::EMPTY };
        let lines = trails_at(&scene, TrailMaterial { seconds: 0.6, width: 0.0 }, 120, 120, 32);
        let way: f32 = lines.iter().map(length).sum();
        assert!((f64::from(way) / exact - 1.0).abs() < 0.01, "{method}: {way} for {exact}");
        assert!(lines.iter().all(|line| line.widths == [0.0; 2]));
    }
}

#[test]
fn no_trail_jumps_from_the_dead_to_who_takes_its_slot() {
    // Twenty slots, taken again several times a second, at both ends of a long way.
    let emitters: [Emitter<Sphere>; 2] = [-50.0, 50.0].map(|x| Emitter {
        speed: Varied { mean: 4.0, half_width: 2.0 },
        lifetime: Varied { mean: 0.3, half_width: 0.1 },
        spread: Spread::Uniform(1.0),
        ..Emitter::new(Sphere { center: Vec3::X * x, radius: 0.1 }, 40.0)
    });
    let scene = Scene { emitters: &&emitters[..], ..Scene::EMPTY };
    let (mut system, mut deaths) = (started(&scene, 20, 3), 0);
    let (mut rings, mut memory) = ([Ring::NONE; 20], [Knot::NONE; 20 * 10]);
    let all = TrailMaterial { seconds: 0.2, width: 0.0 };
    let mut trails = Trails::new(&mut rings, &mut memory, Some(all));
    let mut sides = HashMap::new();
    for frame in 1..=300u64 {
        let report = system.step_to(&scene, Time::frame(frame, 50));
        deaths += report.died.lifetime;
        let state = system.state(&scene);
        assert_eq!(trails.look(&state), 0);
        let mut lines = [Line::NONE; 20 * 11];
        let (count, _) = trails.lines(&state, &mut lines);
        for line in &lines[..count] {
            assert!(length(line) <= 6.0 * 0.2 + 1e-3, "{frame}: {line:?}");
            assert!(line.ends[0].x * line.ends[1].x > 0.0);
            *sides.entry(line.ends[0].x > 0.0).or_insert(0) += 1;
        }
        let total: f32 = lines[..count].iter().map(length).sum();
        assert!(total <= system.len() as f32 * 6.0 * 0.2 * 1.001, "{frame}: {total}");
    }
    assert!(deaths > 200 && sides.len() == 2 && sides.values().all(|&count| count > 1000), "{deaths}, {sides:?}");
}

#[test]
fn trails_belong_to_materials_and_what_finds_no_room_is_counted() {
    let plain = Material::of(ContactMaterial::default());
    let materials = [plain, Material { trail: Some(TrailMaterial { seconds: 0.5, width: 0.1 }), ..plain }];
    let start: Vec<_> = (0..30u16)
        .map(|i| Particle { velocity: Vec3::X, material: (i % 3).checked_sub(1), ..Particle::REST })
        .collect();
    let scene = Scene { start: &start, materials: &materials, ..Scene::EMPTY };
    let mut system = started(&scene, start.len(), 1);
    // There are rings for twenty, with too few knots, and with enough.
    for (knots, known) in [(2, 0), (8, 6)] {
        let (mut rings, mut memory) = (vec![Ring::NONE; 20], vec![Knot::NONE; 20 * knots]);
        let mut trails = Trails::new(&mut rings, &mut memory, None);
        assert_eq!(trails.look(&system.state(&scene)), 10 - known);
        system.step(&scene, Time::from_seconds(0.25));
        let mut lines = [Line::NONE; 4];
        assert_eq!(trails.lines(&system.state(&scene), &mut lines), (known.min(4), known - known.min(4)));
        assert!(lines[..known.min(4)].iter().all(|line| (length(line) - 0.25).abs() < 1e-6));
    }
    // A run that begins anew has no streak from where the last one ended.
    let (mut rings, mut memory) = (vec![Ring::NONE; 30], vec![Knot::NONE; 30 * 8]);
    let mut trails = Trails::new(&mut rings, &mut memory, None);
    system.step_to(&scene, Time::from_seconds(3.0));
    trails.look(&system.state(&scene));
    system.start(&scene, 1).expect("there is memory");
    trails.look(&system.state(&scene));
    let mut lines = [Line::NONE; 300];
    let (count, _) = trails.lines(&system.state(&scene), &mut lines);
    assert!(lines[..count].iter().all(|line| length(line) == 0.0));
}

#[test]
fn springs_that_hold_are_drawn_in_the_colour_of_their_strain() {
    let start = [0.0f32, 1.0, 2.2, 3.1].map(|x| Particle { position: Vec3::X * x, ..Particle::REST });
    let list = [[0, 1], [1, 2], [2, 3], [0, 3]].map(|ends| Spring::new(ends, 1.0, 0.0));
    let list = [list[0], list[1], list[2], Spring { breaks_at: Some(2.0), ..list[3] }];
    let scene = Scene { start: &start, springs: &&list[..], ..Scene::EMPTY };
    let mut system = started(&scene, 4, 1);
    let mut lines = [Line::NONE; 4];
    assert_eq!(springs(&system.state(&scene), 0.2, &mut lines), (4, 0));
    system.step(&scene, Time::frame(1, 60));
    assert_eq!(springs(&system.state(&scene), 0.2, &mut lines), (3, 0), "the longest broke");
    let [rest, long, short] = [0, 1, 2].map(|i| lines[i].colors[0]);
    assert!(long[0] > rest[0] && long[2] < rest[2] && short[2] > rest[2] && short[0] < rest[0]);
    assert_eq!(lines[1].ends, [Vec3::X, Vec3::X * 2.2]);
    assert_eq!(springs(&system.state(&scene), 0.2, &mut lines[..1]), (1, 2));
    assert_eq!(velocities(&system.state(&scene), 2.0, &mut lines), (4, 0));
    assert!(lines.iter().all(|line| line.ends[0] == line.ends[1]), "nothing moves");
}

#[test]
fn constraints_are_drawn_by_the_links_between_those_who_live() {
    let start: Vec<_> = (0..6)
        .map(|i| Particle { position: Vec3::X * i as f32, lifetime: if i == 2 { 0.1 } else { 9.0 }, ..Particle::REST })
        .collect();
    let rope = |closed| ConstraintKind::Rope(Rope { closed, ..Rope::rigid(vec![0, 1, 2, 3], vec![1.0]) });
    let distance = ConstraintKind::Distance(Distance::rod([4, 5], 1.0));
    for (list, pairs) in [
        (vec![rope(false), distance.clone()], vec![[0, 1], [1, 2], [2, 3], [4, 5]]),
        (vec![distance, rope(true)], vec![[4, 5], [0, 1], [1, 2], [2, 3], [3, 0]]),
    ] {
        let all = || list.iter().flat_map(ConstraintKind::links);
        assert_eq!(all().collect::<Vec<_>>(), pairs);
        let scene = Scene { start: &start, ..Scene::EMPTY };
        let mut system = started(&scene, 6, 1);
        let mut lines = [Line::NONE; 5];
        assert_eq!(links(&system.state(&scene), all(), [9; 4], &mut lines), (pairs.len(), 0));
        for (line, [a, b]) in lines.iter().zip(&pairs) {
            assert_eq!(line.ends.map(|end| end.x as u32), [*a, *b]);
        }
        assert_eq!(links(&system.state(&scene), all(), [9; 4], &mut lines[..1]), (1, pairs.len() - 1));
        system.step(&scene, Time::from_seconds(0.2));
        let living = pairs.iter().filter(|pair| !pair.contains(&2)).count();
        assert_eq!(links(&system.state(&scene), all(), [9; 4], &mut lines), (living, 0));
    }
}

/// Each link of a rope, a closed one too, a rod or a tied rope has the colour that its own length at rest says, whatever that of the others and
/// however many are named.
#[test]
fn links_have_the_colors_of_their_strain() {
    let strains = [-0.2, -0.05, 0.0, 0.03, 0.2];
    // Five in a row, links of 1, 2, 3 and 4 m between them, and one of 10 m from the last back to the first.
    let places = [0.0, 1.0, 3.0, 6.0, 10.0];
    let particles = vec![0, 1, 2, 3, 4];
    let shared = [1.0, 2.0, 3.0, 4.0, 10.0].into_iter().zip(strains).map(|(far, strain)| far / (1.0 + strain));
    let lengths: Vec<f32> = shared.collect();
    let rope = |closed, count: usize| Rope { closed, ..Rope::rigid(particles.clone(), lengths[..count].to_vec()) };
    let rod = Distance::rod([0, 4], lengths[4]);
    let start: Vec<_> = places.map(|x| Particle { position: Vec3::X * x, ..Particle::REST }).into_iter().collect();
    let scene = Scene { start: &start, ..Scene::EMPTY };
    let system = started(&scene, 5, 1);
    let full = 0.1;
    for (kind, all) in [
        (ConstraintKind::Rope(rope(false, 4)), &strains[..4]),
        (ConstraintKind::Rope(rope(true, 5)), &strains[..]),
        (ConstraintKind::TiedRope(TiedRope { rope: rope(false, 4), ends: [None, None] }), &strains[..4]),
        (ConstraintKind::Distance(rod), &strains[4..]),
        // The last length holds for all further links: the others are 3 and 4 m long.
        (ConstraintKind::Rope(rope(false, 2)), &[-0.2, -0.05, 3.0 / lengths[1] - 1.0, 4.0 / lengths[1] - 1.0]),
    ] {
        let mut lines = [Line::NONE; 6];
        let pairs = kind.links().zip(kind.lengths());
        assert_eq!(links_by_strain(&system.state(&scene), pairs, full, &mut lines), (all.len(), 0));
        for (line, strain) in lines.iter().zip(all) {
            for (one, other) in line.colors[0].into_iter().zip(strained(strain / full)) {
                assert!(one.abs_diff(other) < 2, "{strain}: {:?}", line.colors[0]);
            }
        }
    }
    let none = ConstraintKind::Cluster(ShapeMatching::rigid(particles.clone()));
    assert_eq!((none.links().count(), none.lengths().count()), (0, 0));
}

#[test]
fn a_surface_has_the_normals_of_what_it_stands_for_and_tears_where_its_springs_do() {
    // A bowl, y = x² + z² over a square.
    let sheet = Sheet { corner: Vec3::new(-1.0, 0.0, -1.0), sides: [Vec3::X * 2.0, Vec3::Z * 2.0], cells: [40, 40] };
    let bowl = |at: Vec3| Vec3::new(at.x, at.x * at.x + at.z * at.z, at.z);
    let before = Particle { position: Vec3::Y * 9.0, ..Particle::REST };
    let start: Vec<_> = std::iter::once(before)
        .chain(sheet.positions().map(|at| Particle { position: bowl(at), ..Particle::REST }))
        .collect();
    // One edge is a spring that breaks at once.
    let [a, b] = [sheet.number(20, 20), sheet.number(21, 20)];
    let torn = [Spring { breaks_at: Some(1.5), ..Spring::new([a + 1, b + 1], 1e-3, 0.0) }];
    let scene = Scene { start: &start, springs: &&torn[..], ..Scene::EMPTY };
    let mut system = started(&scene, start.len(), 1);
    let all: Vec<_> = sheet.triangles().collect();
    let patch = Patch { first: 1, count: 41 * 41, triangles: &all };
    let (mut vertices, mut triangles) = (vec![Vertex::NONE; 41 * 41], vec![[0; 3]; all.len()]);
    assert_eq!(surface(&system.state(&scene), &patch, &mut vertices, &mut triangles), (41 * 41, all.len()));
    let turned = vertices[0].normal.y.signum();
    for across in 1..40 {
        for along in 1..40 {
            let Vertex { place, normal, .. } = vertices[sheet.number(along, across) as usize];
            let exact = Vec3::new(-2.0 * place.x, 1.0, -2.0 * place.z).normalize();
            assert!((normal * turned - exact).length() < 0.01, "{normal} at {place}");
        }
    }
    system.step(&scene, Time::frame(1, 60));
    let (_, kept) = surface(&system.state(&scene), &patch, &mut vertices, &mut triangles);
    assert_eq!(kept, all.len() - 2, "the edge's two triangles are gone");
    assert!(!triangles[..kept].iter().any(|corners| corners.contains(&a) && corners.contains(&b)));
    // Without room for its last rows of corners, their triangles go as well; beyond the start there is nobody.
    let (count, kept) = surface(&system.state(&scene), &patch, &mut vertices[..41 * 20], &mut triangles);
    assert!(count == 41 * 20 && triangles[..kept].as_flattened().iter().all(|&corner| corner < 41 * 20));
    let beyond = Patch { first: u32::MAX - 3, ..patch };
    assert_eq!(surface(&system.state(&scene), &beyond, &mut vertices, &mut triangles).1, 0);
}

#[test]
fn shapes_are_as_large_as_their_particles_and_point_as_their_material_says() {
    let plain = Material::of(ContactMaterial::default());
    let heading = |heading| Material { heading: Some(heading), ..plain };
    let materials = [
        plain,
        heading(Heading::Velocity),
        heading(Heading::Upright),
        Material { size: 0.5, ..heading(Heading::Free) },
    ];
    let start: Vec<_> = (0..50u16)
        .map(|i| Particle {
            velocity: Vec3::new(f32::from(i), 1.0 + f32::from(i % 7), -f32::from(i % 5)),
            radius: 0.1 * f32::from(i % 4),
            material: (i % 5).checked_sub(1),
            ..Particle::REST
        })
        .collect();
    let scene = Scene { start: &start, materials: &materials, ..Scene::EMPTY };
    let system = started(&scene, start.len(), 1);
    let mut list = [Instance::NONE; 50];
    let (count, left_out) = solids(&system.state(&scene), &mut list);
    let drawn = |particle: &&Particle| match particle.material {
        Some(1 | 2) => particle.radius > 0.0,
        Some(3) => true,
        _ => false,
    };
    let expected: Vec<_> = start.iter().filter(drawn).collect();
    assert_eq!((count, left_out), (expected.len(), 0));
    for (instance, particle) in list.iter().zip(expected) {
        let half = if instance.material == 3 { 0.25 } else { particle.radius };
        for axis in [instance.axes.x_axis, instance.axes.y_axis, instance.axes.z_axis] {
            assert!((axis.length() - half).abs() < 1e-5 * half);
        }
        assert!((instance.axes.determinant() / half.powi(3) - 1.0).abs() < 1e-4);
        match instance.material {
            1 => assert!(instance.axes.y_axis.normalize().dot(particle.velocity.normalize()) > 1.0 - 1e-5),
            2 => assert_eq!(instance.axes.y_axis.normalize(), Vec3::Y),
            _ => {}
        }
    }
    assert_eq!(solids(&system.state(&scene), &mut list[..3]), (3, count - 3));
}

#[test]
fn a_scene_file_says_shapes_and_trails_and_reads_back_what_it_wrote() {
    use pointmass::scene::{Model, SceneFile};
    let text = |material: &str| format!(r#"{{"materials": [{material}], "particles": [{{"material": 0}}]}}"#);
    let sound = r#"{"size": 0.1, "trail": {"seconds": 2, "width": 0.5},
        "shape": {"form": {"cone": {"center": [0, 0, 0], "radius": 1, "height": 2}}, "heading": "velocity"}}"#;
    let file = SceneFile::from_json("looks.json", &text(sound)).expect("it is sound");
    assert_eq!(SceneFile::from_json("again.json", &file.to_json()).expect("it is sound"), file);
    let model = Model::load(&file, "looks.json", &mut ()).expect("it loads");
    let material = model.scene().materials.get(0).expect("there is one");
    assert_eq!(material.trail, Some(TrailMaterial { seconds: 2.0, width: 0.5 }));
    assert_eq!((material.heading, model.shapes[0].is_some()), (Some(Heading::Velocity), true));
    for (material, told) in [
        (r#"{"trail": {"seconds": 0}}"#, "materials[0].trail.seconds: has to be above zero, in seconds, not 0"),
        (r#"{"trail": {"seconds": 1, "width": -1}}"#, "materials[0].trail.width: has to be zero or more"),
        (
            r#"{"shape": {"form": {"sphere": {"center": [0, 0, 0], "radius": -1}}}}"#,
            "materials[0].shape.form: radius and height have to be zero or more, not -1",
        ),
        (
            r#"{"shape": {"form": {"plane": {"point": [0, 0, 0], "normal": [0, 1, 0]}}}}"#,
            "materials[0].shape.form: a particle cannot be drawn as a plane or a line",
        ),
        (
            r#"{"sprite": {"picture": "puff"}, "shape": {"form": {"box": {"min": [0, 0, 0], "max": [1, 1, 1]}}}}"#,
            "materials[0].shape: particles are drawn as a shape or with a sprite, not both",
        ),
    ] {
        let checked = SceneFile::from_json("looks.json", &text(material)).and_then(|file| file.check().map(|()| file));
        let error = checked.expect_err(material).to_string();
        assert!(error.contains(told), "{material}: {error}");
    }
}

#[test]
fn boxes_of_every_index_hold_each_point_once() {
    let spread = |i: u32, k: u32| (i.wrapping_mul(k) >> 8) as f32 / 16_777_216.0;
    for (count, far) in [(0u32, 0.0f32), (1, 0.0), (700, 0.0), (700, 1e5)] {
        let mut points: Vec<_> = (0..count)
            .map(|i| {
                Vec3::new(far, -far, 0.0)
                    + Vec3::new(9.0, 2.0, 5.0)
                        * Vec3::from([0x9e37_79b1, 0x85eb_ca6b, 0xc2b2_ae35].map(|k| spread(i, k)))
            })
            .collect();
        points.extend([Vec3::NAN, Vec3::new(0.0, f32::INFINITY, 0.0)]);
        for &structure in Structure::ALL {
            let mut memory = vec![0; structure.words(points.len())];
            let mut index = structure.index(&mut memory);
            index.build(&points, 0.0).expect("there is room");
            let (mut places, mut parts) = (vec![0; count as usize], 0);
            index.parts(&mut |slots| {
                parts += usize::from(!slots.is_empty());
                slots.for_each(|place| places[place] += 1);
            });
            assert!(places.iter().all(|&times| times == 1), "{structure:?}, {count}");
            let mut lines = vec![Line::NONE; 12 * parts];
            assert_eq!(cells(&index, &points, [9; 4], &mut lines), (12 * parts, 0), "{structure:?}, {count}");
            let low = |edges: &[Line]| edges.iter().flat_map(|line| line.ends).fold(Vec3::INFINITY, Vec3::min);
            let high = |edges: &[Line]| edges.iter().flat_map(|line| line.ends).fold(Vec3::NEG_INFINITY, Vec3::max);
            for point in points.iter().filter(|point| point.is_finite()) {
                let holds = |edges: &&[Line]| point.cmpge(low(edges)).all() && point.cmple(high(edges)).all();
                assert!(lines.chunks(12).any(|edges| holds(&edges)), "{structure:?}: nothing holds {point}");
            }
            let room = lines.len().min(5);
            assert_eq!(cells(&index, &points, [9; 4], &mut lines[..room]), (room, 12 * parts - room));
        }
    }
}

#[test]
fn arrows_begin_or_end_on_their_surface() {
    let ball = Sphere { center: Vec3::new(1.0, -2.0, 3.0), radius: 2.0 };
    let out = |point: Vec3| point.distance(ball.center) - ball.radius;
    for (direction, length) in [(None, 0.5), (Some(Vec3::X * 7.0), 0.5), (None, -0.3)] {
        let mut lines = [Line::NONE; 40];
        assert_eq!(arrows(&ball, direction, length, 8, [255; 4], &mut lines), (40, 0));
        for arrow in lines.chunks(5) {
            let [from, to] = arrow[0].ends;
            let (on, off) = if length > 0.0 { (from, to) } else { (to, from) };
            assert!(out(on).abs() < 1e-5 && (to.distance(from) - length.abs()).abs() < 1e-5, "{from} to {to}");
            assert!(direction.is_some() || (out(off) - length.abs()).abs() < 1e-5, "{from} to {to}");
            assert!(direction.is_none_or(|direction| (to - from).dot(direction) > 3.49), "{from} to {to}");
        }
    }
}

/// Strands beyond the particles that there are take no time.
#[test]
fn strands_end_where_particles_do() {
    let start = [0.0, 1.0, 2.0, 3.0].map(|x| Particle { position: Vec3::X * x, ..Particle::REST });
    let scene = Scene { start: &start, ..Scene::EMPTY };
    let system = started(&scene, 4, 0);
    let light = StrandLight { direction: Vec3::NEG_Y, eye: Vec3::Z, ambient: 0.3, gloss: 0.1 };
    let many = u32::MAX;
    for ([first, points, count], expected) in [
        ([0, 2, many], 2),
        ([1, 2, many], 1),
        ([0, 3, many], 2),
        ([0, many, many], 3),
        ([2, many, 1], 1),
        ([0, 1, many], 0),
        ([0, 0, many], 0),
        ([4, 2, many], 0),
        ([many, 2, many], 0),
    ] {
        let lock = Lock { first, points, count, width: 1e-3 };
        let mut lines = [Line::NONE; 9];
        assert_eq!(strands(&system.state(&scene), &lock, &light, &mut lines), (expected, 0), "{lock:?}");
    }
}

/// Materials in a vector are a list of them.
#[test]
fn a_vector_of_materials_is_a_list() {
    let materials = vec![Material::default(), Material { glow: 0.5, ..Material::default() }];
    let scene = Scene { materials: &materials, ..Scene::EMPTY };
    assert_eq!((scene.materials.count(), scene.materials.get(1)), (2, Some(materials[1])));
    assert_eq!(scene.materials.get(2), None);
}

/// The lines of a trail join, wherever it bends.
#[test]
fn a_trail_has_no_gaps() {
    let place = Vec3::new(-0.6, -0.3, 7.0);
    let start = [Particle { velocity: Vec3::new(0.6, 4.2, 0.1), position: place, ..Particle::REST }];
    let gravity = Gravity { acceleration: Vec3::new(0.0, -9.81, 0.3) };
    let scene = Scene { start: &start, forces: &gravity, ..Scene::EMPTY };
    let lines = trails_at(&scene, TrailMaterial { seconds: 0.5, width: 0.1 }, 50, 60, 40);
    assert!(lines.len() > 20 && lines.windows(2).all(|two| two[0].ends[1] == two[1].ends[0]), "{lines:?}");
}

/// A body that loses particles is drawn where those that are left have it, as large as it is, however few they are.
#[test]
fn a_body_that_loses_particles_stays_as_it_is() {
    let turn = [0.3, -0.2, 0.4, 0.8];
    let cuboid = RigidBox { turn, ..RigidBox::new(Vec3::new(0.3, 0.2, 0.1), Vec3::new(1.0, 2.0, -1.0), 0) };
    let spin = Vec3::new(1.0, 2.0, -0.5) * 3.0;
    let particles = cuboid.solid(Particle::REST);
    let boxes = RigidBodies::boxes([cuboid]);
    // Corners by bits: a face, three of it, an edge, a diagonal of space, one.
    for left in [&[0, 1, 2, 3, 4, 6][..], &[0, 1, 4, 5], &[0, 1, 4], &[3, 7], &[0, 7], &[5]] {
        let all: Vec<Particle> = (0..8)
            .map(|i| {
                let lifetime = if left.contains(&i) { f32::INFINITY } else { 0.4 };
                let p = particles[i];
                Particle { velocity: spin.cross(p.position - cuboid.center), lifetime, ..p }
            })
            .collect();
        let scene = Scene { start: &all, constraints: &boxes, substeps: 20, ..Scene::EMPTY };
        let mut system = started(&scene, 8, 1);
        let mut drawn = |frame: u64| {
            system.step_to(&scene, Time::frame(frame, 60));
            body(&system.state(&scene), &cuboid, &all).expect("it is there")
        };
        let before = drawn(23);
        let after = drawn(25);
        let off = |a: Vec3, b: Vec3| (a - b).length();
        let [x, y, z] = [after.axes.x_axis, after.axes.y_axis, after.axes.z_axis];
        for (axis, half) in [(x, 0.3), (y, 0.2), (z, 0.1)] {
            assert!((axis.length() - half).abs() < 1e-4, "{left:?}: {axis} is not {half} long");
        }
        assert!(x.dot(y).abs() + y.dot(z).abs() + z.dot(x).abs() < 1e-4, "{left:?}: {x} {y} {z}");
        // It goes on turning, by a quarter of a radian; about a line nothing says how far.
        if left.len() > 2 {
            assert!(off(before.center, after.center) < 0.3, "{left:?}: {} and {}", before.center, after.center);
            assert!(off(before.axes.x_axis, x) < 0.3, "{left:?}: {} and {x}", before.axes.x_axis);
        }
        // Each particle that is left is where the box has it.
        let state = system.state(&scene);
        for &i in left {
            let row = state.springs.row(i as u32).expect("it lives");
            let sign = |bit: usize| if i >> bit & 1 == 1 { 1.0 } else { -1.0 };
            let place = after.center + (x * sign(0) + y * sign(1) + z * sign(2)) / 3f32.sqrt();
            assert!(off(place, state.position[row]) < 1e-4, "{left:?}: {i} is at {}", state.position[row]);
        }
    }
}
