//! Bodies of several convex pieces: cut from meshes, at rest, in flight, in each other, and at the seams between pieces.

use pointmass::constrain::{CompoundBuf, CompoundError, HullBuf, RigidBodies, RigidBox};
use pointmass::force::Friction;
use pointmass::scene::{Files, Model, SceneFile};
use pointmass::shape::{MeshBuf, NotSolid, Plane};
use pointmass::{ContactMaterial, Gravity, Heap, Measures, Particle, Scene, System, Time, Vec3};
use pointmass_tests::{Random, every, f64s, started};
use std::f32::consts::{FRAC_PI_2, FRAC_PI_4, PI, TAU};

const DOWN: Gravity = Gravity { acceleration: Vec3::new(0.0, -9.81, 0.0) };
const GROUND: Plane = Plane { point: Vec3::ZERO, normal: Vec3::Y };

/// Material 0 with a coefficient of friction and an elasticity.
const fn felt(mu: f32, elasticity: f32) -> [ContactMaterial; 1] {
    [ContactMaterial { elasticity: Some(elasticity), friction: Some(Friction { static_: mu, kinetic: mu }) }]
}

/// The corners of a box.
fn corners(low: [f32; 3], high: [f32; 3]) -> Vec<Vec3> {
    (0..8).map(|i| Vec3::from_array([0, 1, 2].map(|k| if i >> k & 1 == 1 { high[k] } else { low[k] }))).collect()
}

/// An L 1 thick: a foot so long, and a back so high.
fn angle(foot: f32, back: f32) -> CompoundBuf {
    let arms = [corners([0.0; 3], [foot, 1.0, 1.0]), corners([0.0, 1.0, 0.0], [1.0, back, 1.0])];
    CompoundBuf::of(&arms).expect("two boxes")
}

/// A U that stands on its two legs: 3 wide, 3 high, with a gap of 1 × 2, all that so many times.
fn gate(scale: f32) -> CompoundBuf {
    let part = |low: [f32; 3], high: [f32; 3]| corners(low.map(|x| x * scale), high.map(|x| x * scale));
    let legs = [part([0.0; 3], [1.0, 2.0, 1.0]), part([2.0, 0.0, 0.0], [3.0, 2.0, 1.0])];
    let [left, right] = legs;
    CompoundBuf::of(&[left, right, part([0.0, 2.0, 0.0], [3.0, 3.0, 1.0])]).expect("three boxes")
}

/// A closed profile of radii and heights, counterclockwise, turned about y: corners and triangles.
fn revolved(profile: &[[f32; 2]], around: u32) -> MeshBuf {
    let many = profile.len() as u32;
    let place = |i: u32, [r, y]: [f32; 2]| {
        let (sin, cos) = (TAU * i as f32 / around as f32).sin_cos();
        Vec3::new(r * cos, y, -r * sin)
    };
    let vertices: Vec<_> = (0..around).flat_map(|i| profile.iter().map(move |&p| place(i, p))).collect();
    let quads = (0..around).flat_map(|i| (0..many).map(move |j| (i, j))).map(|(i, j)| {
        let (next, up) = ((i + 1) % around, (j + 1) % many);
        [i * many + j, next * many + j, next * many + up, i * many + up]
    });
    let halves = quads.flat_map(|[a, b, c, d]| [[a, b, c], [a, c, d]]);
    let place = |corner: u32| vertices[corner as usize];
    let is_one = |&[a, b, c]: &[u32; 3]| place(a) != place(b) && place(b) != place(c) && place(c) != place(a);
    let triangles = halves.filter(is_one).collect();
    MeshBuf::new(vertices, triangles).expect("a mesh")
}

/// A ring of square section: 3 cm within, 4 cm without, 1 cm high.
fn ring() -> MeshBuf {
    revolved(&[[0.03, -0.005], [0.04, -0.005], [0.04, 0.005], [0.03, 0.005]], 24)
}

/// A cup of 9 cm: 6 cm wide below and 8 cm above, with walls of 3 to 4 mm on a floor of 5 mm.
fn cup() -> MeshBuf {
    revolved(&[[0.0, 0.0], [0.03, 0.0], [0.04, 0.09], [0.036, 0.09], [0.027, 0.005], [0.0, 0.005]], 16)
}

/// A body and its particles, turned about an axis by an angle.
fn placed(
    form: &CompoundBuf,
    (number, first): (u16, u32),
    at: Vec3,
    (axis, turn): (Vec3, f32),
    whole: Particle,
) -> (RigidBox, [Particle; 8]) {
    let (sin, cos) = (0.5 * turn).sin_cos();
    let [x, y, z] = (axis * sin).to_array();
    let body = RigidBox { turn: [x, y, z, cos], ..RigidBox::with_compound(form, number, at, first) };
    (body, body.solid_compound(form, whole))
}

type Bodies<'a> = RigidBodies<&'a [RigidBox], &'a [HullBuf]>;

/// Bodies with their hulls and particles.
#[derive(Default)]
struct Heaped {
    boxes: Vec<RigidBox>,
    hulls: Vec<HullBuf>,
    start: Vec<Particle>,
}

impl Heaped {
    /// Adds one; returns its number.
    fn add(&mut self, form: &CompoundBuf, at: Vec3, turn: (Vec3, f32), whole: Particle) -> usize {
        let numbers = (self.hulls.len() as u16, self.start.len() as u32);
        let (body, particles) = placed(form, numbers, at, turn, whole);
        self.hulls.extend_from_slice(form.pieces());
        self.start.extend(particles);
        self.boxes.push(body);
        self.boxes.len() - 1
    }

    fn bodies(&self) -> Bodies<'_> {
        RigidBodies { boxes: &self.boxes, hulls: &self.hulls, balls: 8 }
    }

    /// What falls on the ground.
    fn scene<'s>(&'s self, bodies: &'s Bodies<'s>, materials: &'s [ContactMaterial; 1], substeps: u32) -> Scene<'s> {
        let Self { start, .. } = self;
        Scene { start, forces: &DOWN, colliders: &GROUND, constraints: bodies, materials, substeps, ..Scene::EMPTY }
    }
}

/// The middle of a body's particles, and where its y axis points.
fn pose(system: &System<Heap>, number: usize) -> (Vec3, Vec3) {
    let x = &system.particles().position[8 * number..][..8];
    let middle = x.iter().copied().sum::<Vec3>() / 8.0;
    let side = |bit: usize| (0..8).map(|i| if i & bit == 0 { -x[i] } else { x[i] }).sum::<Vec3>();
    // Particles lie at L (±1, ±1, ±1), and L is a lower triangle: z, and what of y is square to it.
    let z = side(4).normalize();
    let y = side(2);
    (middle, (y - z * y.dot(z)).normalize())
}

fn fastest(system: &System<Heap>) -> f32 {
    system.particles().velocity.iter().map(|v| v.length()).fold(0.0, f32::max)
}

/// Runs for seconds with steps of 1/60 s.
fn go(system: &mut System<Heap>, scene: &Scene<'_>, seconds: u64) {
    let frame = (system.time().seconds() * 60.0).round() as u64;
    for frame in frame + 1..=frame + 60 * seconds {
        system.step_to(scene, Time::frame(frame, 60));
    }
}

/// What a mesh is cut into: as large as it is, with its own mass, centre and inertia, and nowhere farther off than asked.
#[test]
fn meshes_are_cut_within_what_is_asked() {
    for (mesh, within, most, exact) in [(ring(), 2e-3, 12, false), (cup(), 1e-3, 20, true), (cup(), 3e-3, 20, false)] {
        let form = CompoundBuf::of_mesh(&mesh, within, 64).expect("it can be cut");
        let held: f32 = form.pieces().iter().map(|piece| piece.lend().volume()).sum();
        assert!(form.pieces().len() <= most && form.leaves() <= within, "{} {}", form.pieces().len(), form.leaves());
        // Pieces that have nothing inward in them fill the solid exactly.
        assert!(!exact || (held / form.volume() - 1.0).abs() < 1e-3, "{held} {}", form.volume());
        // All that the mesh touches is touched by a piece, and nothing farther than that.
        let mut random = Random::new(7);
        for _ in 0..2000 {
            let [a, b, c] = mesh.triangles()[(random.unit() * mesh.triangles().len() as f32) as usize]
                .map(|corner| mesh.vertices()[corner as usize]);
            let (u, v) = (random.unit(), random.unit());
            let (u, v) = if u + v > 1.0 { (1.0 - u, 1.0 - v) } else { (u, v) };
            let place = a + (b - a) * u + (c - a) * v - form.center();
            let far = form.pieces().iter().map(|piece| {
                let hull = piece.lend();
                let out = |face: &pointmass::constrain::HullFace| face.normal.dot(place - hull.center) - face.offset;
                hull.faces.iter().map(out).fold(f32::NEG_INFINITY, f32::max)
            });
            let far = far.fold(f32::INFINITY, f32::min);
            assert!(far < 1e-5 && far > -within - 1e-5, "{place} {far}");
        }
    }
    // Of the ring, a prism over 24-gons, closed forms: area n/2 r² sin(2π/n), and Σ m y² = h²/12.
    let form = CompoundBuf::of_mesh(&ring(), 2e-3, 64).expect("it can be cut");
    let area = 12.0 * (TAU / 24.0).sin() * (0.04f32.powi(2) - 0.03f32.powi(2));
    assert!((form.volume() / (area * 0.01) - 1.0).abs() < 1e-4 && form.center().length() < 1e-6);
    assert!((form.spread().y_axis.y / (0.01 * 0.01 / 12.0) - 1.0).abs() < 1e-4);
    // An L, from its mesh as from its boxes.
    let outline = [[0.0, 0.0], [3.0, 0.0], [3.0, 1.0], [1.0, 1.0], [1.0, 4.0], [0.0, 4.0]];
    let vertices = [0.0, 1.0].into_iter().flat_map(|z| outline.iter().map(move |&[x, y]| Vec3::new(x, y, z))).collect();
    let flat = [[0, 1, 2], [0, 2, 3], [0, 3, 5], [3, 4, 5]];
    let ends = flat.iter().flat_map(|&[a, b, c]| [[a, c, b], [a + 6, b + 6, c + 6]]);
    let sides = (0..6u32).flat_map(|i| [[i, (i + 1) % 6, (i + 1) % 6 + 6], [i, (i + 1) % 6 + 6, i + 6]]);
    let mesh = MeshBuf::new(vertices, ends.chain(sides).collect()).expect("a mesh");
    let (cut, made) = (CompoundBuf::of_mesh(&mesh, 1e-3, 8).expect("two boxes"), angle(3.0, 4.0));
    assert_eq!((cut.pieces().len(), made.pieces().len()), (2, 2));
    assert!(
        (cut.center() - Vec3::new(1.0, 1.5, 0.5)).length() < 1e-5 && (cut.center() - made.center()).length() < 1e-5
    );
    assert!((cut.spread() - made.spread()).to_cols_array().iter().all(|x| x.abs() < 1e-5));
}

/// What cannot be cut is refused by name.
#[test]
fn what_is_no_solid_or_needs_more_pieces_is_refused() {
    assert!(matches!(CompoundBuf::of_mesh(&ring(), 2e-3, 4), Err(CompoundError::Coarse(4, far)) if far > 2e-3));
    let open = MeshBuf::new(ring().vertices().to_vec(), ring().triangles()[1..].to_vec()).expect("a mesh");
    assert!(matches!(CompoundBuf::of_mesh(&open, 1e-3, 64), Err(CompoundError::Solid(NotSolid::Open(_)))));
    for within in [-1.0, -f32::MIN_POSITIVE, f32::NAN] {
        let error = CompoundBuf::of_mesh(&ring(), within, 255).expect_err("nothing is so near");
        assert!(matches!(error, CompoundError::Within(_)) && error.to_string().contains("from zero on"), "{error}");
    }
    assert_eq!(CompoundBuf::of(&[]), Err(CompoundError::Pieces(0)));
    let flat = vec![Vec3::ZERO, Vec3::X, Vec3::Y];
    assert!(matches!(CompoundBuf::of(&[corners([0.0; 3], [1.0; 3]), flat]), Err(CompoundError::Hull(1, _))));
    let form = angle(3.0, 3.0);
    let body = RigidBox { pieces: 0, ..RigidBox::with_compound(&form, 0, Vec3::ZERO, 0) };
    let bodies = RigidBodies { boxes: [body], hulls: form.pieces(), balls: 0 };
    assert_eq!(bodies.fault().map(|(name, _)| name), Some("pieces"));
}

/// The volume of shells: cavities count less, what stands apart more, whichever way each is turned; what crosses is refused.
#[test]
fn shells_count_as_they_lie() {
    let faces = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let shell = |first: u32, turned: bool| {
        let faces = faces.map(|face| face.map(|corner: u32| first + corner));
        let triangles = faces.into_iter().flat_map(|[a, b, c, d]| [[a, b, c], [a, c, d]]);
        triangles.map(|[a, b, c]| if turned { [a, c, b] } else { [a, b, c] }).collect::<Vec<_>>()
    };
    let of = |boxes: &[([f32; 3], [f32; 3])], turned: usize| {
        let vertices = boxes.iter().flat_map(|&(low, high)| corners(low, high)).collect();
        let numbered = boxes.iter().enumerate();
        let triangles = numbered.flat_map(|(i, _)| shell(8 * i as u32, turned >> i & 1 == 1)).collect();
        CompoundBuf::of_mesh(&MeshBuf::new(vertices, triangles).expect("a mesh"), 1e-3, 64).map(|form| form.volume())
    };
    let outer = ([0.0; 3], [4.0; 3]);
    let (inner, core, beside, edge) =
        (([1.0; 3], [3.0; 3]), ([1.5; 3], [2.5; 3]), ([5.0; 3], [6.0; 3]), ([4.0, 4.0, 0.0], [5.0, 5.0, 4.0]));
    for (boxes, volume) in [
        (vec![outer, inner], 56.0),
        (vec![inner, outer, core], 57.0),
        (vec![outer, beside], 65.0),
        (vec![outer, edge], 68.0),
    ] {
        for turned in 0..1 << boxes.len() {
            let found = of(&boxes, turned).expect("a solid");
            assert!((found - volume).abs() < 1e-4 * volume, "{boxes:?} {turned} {found}");
        }
    }
    let across = ([2.0, 1.0, 1.0], [6.0, 3.0, 3.0]);
    assert!(matches!(of(&[outer, across], 0), Err(CompoundError::Solid(NotSolid::Crossing(_)))));
}

/// A body of one piece is the hull, to the bit.
#[test]
fn one_piece_is_the_plain_hull() {
    let points = [Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::Z, Vec3::new(0.7, 0.7, 0.7)];
    let hull = HullBuf::of(&points).expect("a hull");
    let form = CompoundBuf::of(&[points.to_vec()]).expect("a hull");
    let run = |plain: bool| {
        let at = [Vec3::Y * 1.5, Vec3::new(0.2, 3.0, 0.1)];
        let bodies = [0, 1].map(|i| match plain {
            true => RigidBox::with_hull(&hull.lend(), i, at[usize::from(i)], 8 * u32::from(i)),
            false => RigidBox::with_compound(&form, i, at[usize::from(i)], 8 * u32::from(i)),
        });
        let whole = Particle { mass: 3.0, velocity: Vec3::X, material: Some(0), ..Particle::REST };
        let solid = |body: &RigidBox| {
            if plain { body.solid_hull(&hull.lend(), whole) } else { body.solid_compound(&form, whole) }
        };
        let start: Vec<_> = bodies.iter().flat_map(solid).collect();
        let hulls = if plain { vec![hull.clone(), hull.clone()] } else { [form.pieces(), form.pieces()].concat() };
        let bodies = RigidBodies { boxes: bodies, hulls, balls: 0 };
        let materials = felt(0.5, 0.4);
        let scene = Scene {
            start: &start,
            forces: &DOWN,
            colliders: &GROUND,
            constraints: &bodies,
            materials: &materials,
            substeps: 10,
            ..Scene::EMPTY
        };
        let mut system = started(&scene, 16, 1);
        go(&mut system, &scene, 3);
        system.hash()
    };
    assert_eq!(run(true), run(false));
}

/// In free flight a body keeps its momenta and its energy.
#[test]
fn what_flies_freely_keeps_its_momenta_and_energy() {
    let forms = [angle(3.0, 4.0), gate(1.0), CompoundBuf::of_mesh(&ring(), 2e-3, 64).expect("a ring")];
    for (i, form) in forms.iter().enumerate() {
        let mut all = Heaped::default();
        all.add(form, Vec3::new(1.0, 2.0, -3.0), (Vec3::X, 0.3), Particle { mass: 2.0, ..Particle::REST });
        let (spin, center) = (Vec3::new(1.0, 3.0, 0.2), Vec3::new(1.0, 2.0, -3.0));
        all.start.iter_mut().for_each(|p| p.velocity = Vec3::new(0.3, -0.1, 0.2) + spin.cross(p.position - center));
        let bodies = all.bodies();
        let scene = Scene { start: &all.start, constraints: &bodies, substeps: 20, ..Scene::EMPTY };
        let mut system = started(&scene, 8, 1);
        let momentum = |system: &System<Heap>| {
            let (x, v) = (system.particles().position, system.particles().velocity);
            let middle = x.iter().copied().sum::<Vec3>() / 8.0;
            x.iter().zip(v).map(|(x, v)| (*x - middle).cross(*v) * 0.25).sum::<Vec3>()
        };
        let energy = |system: &System<Heap>| Measures::of(system, &scene).energy.kinetic;
        let (first, begun) = (momentum(&system), energy(&system));
        go(&mut system, &scene, 10);
        let off = (momentum(&system) - first).length() / first.length();
        assert!(off < 1e-4, "form {i}: {off}");
        assert!((energy(&system) / begun - 1.0).abs() < 1e-2, "form {i}");
    }
}

/// A U stands over a bar without touching it, though its hull holds it.
#[test]
fn a_gate_stands_over_a_bar() {
    for (scale, turn) in [(1.0f32, 0.0), (0.01, FRAC_PI_2), (0.1, 0.7)] {
        let sized = |high: [f32; 3]| high.map(|x| x * scale);
        let gate = gate(scale);
        let bar = CompoundBuf::of(&[corners([0.0; 3], sized([0.8, 1.8, 4.0]))]).expect("a box");
        let mut all = Heaped::default();
        let upright = (Vec3::Y, turn);
        all.add(&bar, Vec3::Y * 0.9 * scale, upright, Particle { fixed: true, ..Particle::REST });
        let height = gate.center().y;
        let whole = Particle { mass: 1.0, material: Some(0), ..Particle::REST };
        all.add(&gate, Vec3::Y * (height + 0.05 * scale), upright, whole);
        let (bodies, materials) = (all.bodies(), felt(0.5, 0.0));
        let scene = all.scene(&bodies, &materials, 20);
        let mut system = started(&scene, 16, 1);
        go(&mut system, &scene, 3);
        let (middle, up) = pose(&system, 1);
        assert!((middle - Vec3::Y * height).length() < 5e-3 * scale, "{scale}: {middle} {height}");
        assert!(up.y > 0.9999 && fastest(&system) < 1e-3, "{scale}: {up} {}", fastest(&system));
        // The feet alone are touched: four points at the most, all on the ground.
        let report = system.step_to(&scene, system.time() + Time::frame(1, 60));
        assert_eq!((report.contacts, report.caps.contacts), (0, 0), "{scale}");
        assert!(report.hits > 0);
    }
}

/// An L on its foot's end stands if its centre of mass is over that, and falls if not.
#[test]
fn an_angle_stands_on_what_its_centre_of_mass_is_over() {
    // Upside down, on the end of its back: x from 0 to 1, and the centre of mass at (f²/2 + (h − 1)/2) / (f + h − 1).
    for (foot, stands) in [(2.6f32, true), (3.4, false)] {
        let form = angle(foot, 4.0);
        let over = (0.5 * foot * foot + 1.5) / (foot + 3.0);
        assert!((form.center().x - over).abs() < 1e-5 && (over < 1.0) == stands);
        let mut all = Heaped::default();
        let height = 4.0 - form.center().y;
        let whole = Particle { mass: 5.0, material: Some(0), ..Particle::REST };
        all.add(&form, Vec3::Y * (height + 1e-3), (Vec3::X, PI), whole);
        let (bodies, materials) = (all.bodies(), felt(0.8, 0.0));
        let scene = all.scene(&bodies, &materials, 20);
        let mut system = started(&scene, 8, 1);
        go(&mut system, &scene, 6);
        let (middle, up) = pose(&system, 0);
        assert!(fastest(&system) < 1e-2, "{foot}: {}", fastest(&system));
        if stands {
            assert!((middle.y - height).abs() < 0.02 && up.y < -0.999, "{foot}: {middle} {up}");
        } else {
            // It lies on its side, or leans on the tips of both arms: the sum of the ways to both is then the height of none.
            assert!(middle.y < 0.9 * height, "{foot}: {middle} {up}");
        }
    }
}

/// A ball that is dropped into a cup lies on the cup's floor; a ring that is dropped over a peg lies around it.
#[test]
fn balls_lie_in_cups_and_rings_around_pegs() {
    let (cup, ring) = (CompoundBuf::of_mesh(&cup(), 1e-3, 64), CompoundBuf::of_mesh(&ring(), 2e-3, 64));
    let (cup, ring) = (cup.expect("a cup"), ring.expect("a ring"));
    let peg = CompoundBuf::of(&[corners([-0.01, 0.0, -0.01], [0.01, 0.1, 0.01])]).expect("a box");
    let mut all = Heaped::default();
    let whole = Particle { mass: 0.1, material: Some(0), ..Particle::REST };
    let cup_at = Vec3::new(0.2, cup.center().y, 0.0);
    all.add(&cup, cup_at, (Vec3::Y, 0.0), whole);
    all.add(&peg, Vec3::Y * 0.05, (Vec3::Y, 0.0), Particle { fixed: true, ..whole });
    all.add(&ring, Vec3::new(0.005, 0.12, 0.003), (Vec3::Z, 0.2), whole);
    let ball = Particle { radius: 0.012, mass: 0.02, position: Vec3::new(0.207, 0.15, 0.004), ..whole };
    all.start.push(ball);
    let (bodies, materials) = (all.bodies(), felt(0.4, 0.1));
    let scene = all.scene(&bodies, &materials, 20);
    let mut system = started(&scene, 32, 1);
    go(&mut system, &scene, 4);
    let x = system.particles().position;
    let (cup, up) = pose(&system, 0);
    assert!((cup.y - cup_at.y).abs() < 1e-3 && up.y > 0.999, "{cup} {up}");
    let ball = x[24];
    assert!((ball.y - 0.017).abs() < 5e-4, "{ball}");
    assert!(Vec3::new(ball.x - cup.x, 0.0, ball.z - cup.z).length() < 0.027 - 0.01, "{ball} {cup}");
    let (ring, axis) = pose(&system, 2);
    assert!((ring.y - 0.005).abs() < 5e-4 && axis.y.abs() > 0.999, "{ring} {axis}");
    assert!(Vec3::new(ring.x, 0.0, ring.z).length() < 0.03, "{ring}");
    assert!(fastest(&system) < 0.02, "{}", fastest(&system));
}

/// A ring that hangs in another stays there.
#[test]
fn rings_hang_in_each_other() {
    let ring = CompoundBuf::of_mesh(&ring(), 2e-3, 64).expect("a ring");
    let mut all = Heaped::default();
    let whole = Particle { mass: 0.1, material: Some(0), ..Particle::REST };
    all.add(&ring, Vec3::ZERO, (Vec3::X, FRAC_PI_2), Particle { fixed: true, ..whole });
    for i in 1..4 {
        let (axis, turn) = if i % 2 == 1 { (Vec3::Z, FRAC_PI_2) } else { (Vec3::X, FRAC_PI_2) };
        all.add(&ring, Vec3::Y * (-0.055 * i as f32), (axis, turn), whole);
    }
    let (bodies, materials) = (all.bodies(), felt(0.5, 0.0));
    let scene = Scene { colliders: &(), ..all.scene(&bodies, &materials, 20) };
    let mut system = started(&scene, 32, 1);
    go(&mut system, &scene, 5);
    for i in 1..4 {
        let way = pose(&system, i - 1).0 - pose(&system, i).0;
        // Inner edges touch at 3 cm each, but for the chords of the rings.
        assert!(way.y > 0.054 && way.length() < 0.0605, "{i}: {way}");
    }
    assert_eq!(system.totals().caps.contacts, 0);
    assert!(fastest(&system) < 0.2, "{}", fastest(&system));
}

/// What slides or rolls over the seams between pieces does not feel them.
#[test]
fn seams_are_not_felt() {
    let tiles: Vec<_> = (0..6).flat_map(|i| (0..2).map(move |k| (i as f32, k as f32))).collect();
    let tiles: Vec<_> = tiles.iter().map(|&(x, z)| corners([x, -0.5, z], [x + 1.0, 0.0, z + 1.0])).collect();
    let tray = CompoundBuf::of(&tiles).expect("tiles");
    for turn in [0.0, 0.2, FRAC_PI_4] {
        let mut all = Heaped::default();
        let whole = Particle { mass: 1.0, material: Some(0), ..Particle::REST };
        all.add(&tray, tray.center(), (Vec3::Y, 0.0), Particle { fixed: true, ..whole });
        let die = CompoundBuf::of(&[corners([-0.15; 3], [0.15; 3])]).expect("a box");
        let moving = Particle { velocity: Vec3::X, ..whole };
        all.add(&die, Vec3::new(0.4, 0.15, 0.9), (Vec3::Y, turn), moving);
        all.start.push(Particle { radius: 0.1, position: Vec3::new(0.4, 0.1, 1.5), ..moving });
        let (bodies, materials) = (all.bodies(), felt(0.0, 0.0));
        let scene = Scene { colliders: &(), ..all.scene(&bodies, &materials, 10) };
        let mut system = started(&scene, 32, 1);
        go(&mut system, &scene, 4);
        let (middle, up) = pose(&system, 1);
        assert!((middle - Vec3::new(4.4, 0.15, 0.9)).length() < 5e-3 && up.y > 0.9999, "{turn}: {middle} {up}");
        let ball = system.particles().position[16];
        assert!((ball - Vec3::new(4.4, 0.1, 1.5)).length() < 5e-3, "{turn}: {ball}");
    }
}

/// No throw of concave bodies, whatever their elasticity and friction, ends with more energy than it had.
#[test]
fn no_throw_gives_energy() {
    let forms = [angle(3.0, 4.0), gate(1.0)];
    let mut random = Random::new(3);
    for throw in (0..40).step_by(every(4)) {
        let mut all = Heaped::default();
        for i in 0..4 {
            let at = Vec3::new(0.0, 4.0 + 7.5 * i as f32, 0.0) + random.vector(1.0);
            let whole = Particle { mass: 1.0, velocity: random.vector(3.0), material: Some(0), ..Particle::REST };
            let turn = (random.direction(), random.between(0.0, PI));
            all.add(&forms[i % 2], at, turn, whole);
        }
        let (mu, elasticity) = (random.between(0.0, 1.0), [0.0, 0.5, 1.0][throw % 3]);
        let (bodies, materials) = (all.bodies(), felt(mu, elasticity));
        let substeps = [5, 10, 20][throw / 3 % 3];
        let scene = all.scene(&bodies, &materials, substeps);
        let mut system = started(&scene, 32, 1);
        let energy = |system: &System<Heap>| {
            let energy = Measures::of(system, &scene).energy;
            energy.kinetic + energy.potential
        };
        let first = energy(&system);
        // What explicit Euler gives to what falls, m (g h)² / 2 a sub-step.
        let h = 1.0 / (60.0 * f64::from(substeps));
        for frame in 1..=300u64 {
            system.step_to(&scene, Time::frame(frame, 60));
            let fallen = 4.0 * 0.5 * (9.81 * h).powi(2) * (frame * u64::from(substeps)) as f64;
            let now = energy(&system);
            assert!(now <= first * (1.0 + 1e-3) + fallen, "throw {throw}, frame {frame}: {now} of {first}");
        }
        assert!(system.particles().position.iter().all(|x| x.y > -0.5), "throw {throw}");
    }
}

/// Concave bodies on a heap come to rest, and sleep; a heap that sleeps has the bits that it had.
#[test]
fn heaps_come_to_rest() {
    let (cup, ring) = (CompoundBuf::of_mesh(&cup(), 1e-3, 64), CompoundBuf::of_mesh(&ring(), 2e-3, 64));
    let (cup, ring) = (cup.expect("a cup"), ring.expect("a ring"));
    for seed in [11, 22] {
        let (mut all, mut random) = (Heaped::default(), Random::new(seed));
        for i in 0..8 {
            let at = Vec3::new(random.between(-0.05, 0.05), 0.1 + 0.09 * i as f32, random.between(-0.05, 0.05));
            let whole = Particle { mass: 0.1, material: Some(0), ..Particle::REST };
            let turn = (random.direction(), random.between(0.0, PI));
            all.add(if i % 3 == 0 { &cup } else { &ring }, at, turn, whole);
        }
        let (bodies, materials) = (all.bodies(), felt(0.5, 0.2));
        let scene = all.scene(&bodies, &materials, 20);
        let mut system = started(&scene, 64, 1);
        go(&mut system, &scene, 8);
        assert!(fastest(&system) < 0.02, "{}", fastest(&system));
        // Nobody who may touch is left out, and the ground, which rims and bottoms lie on, presses in one direction.
        assert_eq!(system.totals().caps.contacts, 0);
        assert!(system.particles().position.iter().all(|x| x.y > -0.005 && x.is_finite()));
        let places = f64s(system.particles().position[0]);
        assert!(places.iter().all(|x| x.abs() < 1.0));
    }
}

/// Of more pairs of pieces than there is room for some are left out, counted.
#[test]
fn pairs_of_pieces_beyond_the_room_are_counted() {
    let grid: Vec<_> = (0..64).map(|i| [i % 4, i / 4 % 4, i / 16].map(|k| k as f32)).collect();
    let grid: Vec<_> = grid.iter().map(|&[x, y, z]| corners([x, y, z], [x + 1.0, y + 1.0, z + 1.0])).collect();
    let form = CompoundBuf::of(&grid).expect("a grid");
    let mut all = Heaped::default();
    for i in 0..4 {
        all.add(&form, Vec3::X * 0.1 * i as f32, (Vec3::Y, 0.0), Particle::REST);
    }
    let bodies = all.bodies();
    let scene = Scene { start: &all.start, constraints: &bodies, substeps: 2, ..Scene::EMPTY };
    let mut system = started(&scene, 32, 1);
    go(&mut system, &scene, 1);
    assert!(system.totals().caps.contacts > 0);
    assert!(system.particles().position.iter().all(|x| x.is_finite()));
}

/// The ring by whatever name, for scenes.
struct Rings;

impl Files for Rings {
    fn text(&mut self, path: &str) -> Result<String, String> {
        Err(path.into())
    }
    fn mesh(&mut self, _: &str) -> Result<MeshBuf, String> {
        Ok(ring())
    }
    fn exists(&mut self, _: &str) -> bool {
        true
    }
}

/// Scenes say pieces, or a mesh, which is drawn as it is; errors say where, what and how much.
#[test]
fn scenes_have_bodies_with_hollows() {
    let load = |form: &str| {
        let text = format!(
            r#"{{"boxes": [{{"form": {form}, "sides": [0.16, 0.02, 0.16], "mass": 2, "position": [0, 1, 0], "count": [2, 1, 1]}}]}}"#
        );
        let file = SceneFile::from_json("it.json", &text).map_err(|error| error.to_string())?;
        Model::load(&file, "it.json", &mut Rings).map_err(|error| error.to_string())
    };
    let model = load(r#"{"solid": {"mesh": "ring.obj", "within": 0.004}}"#).expect("it can be cut");
    let bodies = &model.constraints.1;
    // Twice as large as the mesh is, and both have the same hulls.
    assert!(bodies.boxes.iter().all(|of| of.hull == Some(0) && usize::from(of.pieces) == bodies.hulls.len()));
    assert!((bodies.boxes[0].half - Vec3::new(0.08, 0.01, 0.08)).length() < 1e-3 && bodies.hulls.len() > 4);
    let (corners, triangles) = model.surface(&bodies.boxes[1]).expect("a mesh");
    assert_eq!((corners.len(), triangles.len()), (ring().vertices().len(), ring().triangles().len()));
    let widest = corners.iter().map(|x| x.length()).fold(0.0, f32::max);
    assert!((widest - 0.08f32.hypot(0.01)).abs() < 1e-3, "{widest}");
    let mass: f32 = model.particles.iter().map(|p| p.mass).sum();
    assert!((mass - 4.0).abs() < 1e-5);
    let pieces = r#"{"pieces": [[[0,0,0],[3,0,0],[0,1,0],[3,1,0],[0,0,1],[3,0,1],[0,1,1],[3,1,1]],
        [[0,1,0],[1,1,0],[0,4,0],[1,4,0],[0,1,1],[1,1,1],[0,4,1],[1,4,1]]]}"#;
    let model = load(pieces).expect("two boxes");
    assert_eq!((model.constraints.1.hulls.len(), model.constraints.1.boxes[1].pieces), (2, 2));
    assert_eq!(model.surface(&model.constraints.1.boxes[0]).map(|(_, triangles)| triangles.len()), Some(24));
    for (form, words) in [
        (r#"{"solid": {"mesh": "ring.obj", "within": 0.001, "pieces": 4}}"#, ["boxes[0].form", "4 pieces"]),
        (r#"{"solid": {"mesh": "ring.obj", "within": 0}}"#, ["boxes[0].form.solid.within", "above zero"]),
        (r#"{"solid": {"mesh": "ring.obj", "within": 0.001, "pieces": 256}}"#, ["boxes[0].form.solid.pieces", "255"]),
        (r#"{"pieces": []}"#, ["boxes[0].form", ""]),
        (
            r#"{"pieces": [[[0,0,0],[1,0,0],[0,1,0],[0,0,1]], [[0,0,0],[1,0,0],[0,1,0]]]}"#,
            ["boxes[0].form", "piece 1 is flat"],
        ),
    ] {
        let error = load(form).err().unwrap_or_default();
        assert!(error.contains("it.json") && words.iter().all(|word| error.contains(word)), "{error}");
    }
}

/// Without sides, points and meshes are as large as they are; with a density they weigh what their form does.
#[test]
fn scenes_have_bodies_as_large_as_their_form_and_as_heavy_as_their_material() {
    let load = |numbers: &str| {
        let text = format!(r#"{{"boxes": [{{{numbers}, "position": [0, 1, 0], "count": [2, 1, 1]}}]}}"#);
        let file = SceneFile::from_json("it.json", &text).map_err(|error| error.to_string())?;
        Model::load(&file, "it.json", &mut Rings).map_err(|error| error.to_string())
    };
    let ring = 12.0 * (TAU / 24.0).sin() * (0.04f32.powi(2) - 0.03f32.powi(2)) * 0.01;
    let hull = 12.0 * (TAU / 24.0).sin() * 0.04f32.powi(2) * 0.01;
    let corner = r#"{"points": [[0,0,0], [3,0,0], [0,1,0], [0,0,2]]}"#;
    let two = r#"{"pieces": [[[0,0,0],[3,0,0],[0,1,0],[3,1,0],[0,0,1],[3,0,1],[0,1,1],[3,1,1]],
        [[0,1,0],[1,1,0],[0,4,0],[1,4,0],[0,1,1],[1,1,1],[0,4,1],[1,4,1]]]}"#;
    for (form, sides, size, volume) in [
        ("\"box\"", Some([0.5, 2.0, 3.0]), [0.5, 2.0, 3.0], 3.0),
        ("\"octahedron\"", Some([2.0, 1.0, 3.0]), [2.0, 1.0, 3.0], 1.0),
        (corner, None, [3.0, 1.0, 2.0], 1.0),
        (corner, Some([1.0, 1.0, 1.0]), [1.0, 1.0, 1.0], 1.0 / 6.0),
        (two, None, [3.0, 4.0, 1.0], 6.0),
        (r#"{"mesh": "ring.obj"}"#, None, [0.08, 0.01, 0.08], hull),
        (r#"{"solid": {"mesh": "ring.obj", "within": 0.002}}"#, None, [0.08, 0.01, 0.08], ring),
        (r#"{"solid": {"mesh": "ring.obj", "within": 0.02}}"#, Some([0.8, 0.1, 0.8]), [0.8, 0.1, 0.8], ring * 1e3),
    ] {
        let sides = sides.map_or(String::new(), |sides| format!(r#""sides": {sides:?}, "#));
        let model =
            load(&format!(r#""form": {form}, {sides}"density": 700"#)).unwrap_or_else(|error| panic!("{error}"));
        let weighs = model.particles.iter().map(|p| p.mass).sum::<f32>() / (2.0 * 700.0);
        assert!((weighs / volume - 1.0).abs() < 1e-3, "{form}: {weighs} m³ for {volume}");
        let bodies = &model.constraints.1;
        let apart = bodies.boxes[1].center - bodies.boxes[0].center;
        assert!((apart - Vec3::X * size[0]).length() < 1e-4, "{form}: {apart}");
        let corners: Vec<_> = match model.surface(&bodies.boxes[0]) {
            Some((corners, _)) => corners.to_vec(),
            None => [-1.0, 1.0].map(|sign| bodies.boxes[0].half * sign).to_vec(),
        };
        let widest = corners.iter().copied().reduce(Vec3::max).expect("corners")
            - corners.iter().copied().reduce(Vec3::min).expect("corners");
        assert!((widest - Vec3::from(size)).length() < 1e-3 * widest.length(), "{form}: {widest} for {size:?}");
    }
    for (numbers, at, words) in [
        (r#""density": 700"#, "boxes[0].sides", "are missing"),
        (r#""form": "tetrahedron", "mass": 1"#, "boxes[0].sides", "are missing"),
        (r#""sides": [1, 1, 1]"#, "boxes[0].mass", "density"),
        (r#""sides": [1, 1, 1], "mass": 1, "density": 1"#, "boxes[0].density", "either"),
        (r#""sides": [1, 1, 1], "density": -1"#, "boxes[0].density", "above zero"),
        (r#""sides": [1, 1, 0], "density": 1"#, "boxes[0].sides", "above zero"),
        (r#""sides": [1, 1, 1], "mass": -1"#, "boxes[0].mass", "above zero"),
        (r#""form": {"points": [[0,0,0],[1,0,0],[0,1,0]]}, "density": 1"#, "boxes[0].form", "flat"),
        (r#""form": {"points": []}, "density": 1"#, "boxes[0].form", "flat"),
        (r#""sides": [10, 1, 1], "density": 1e38"#, "boxes[0]", "too much"),
    ] {
        let error = load(numbers).err().unwrap_or_default();
        assert!(error.contains(at) && error.contains(words), "{numbers}: {error}");
    }
}
