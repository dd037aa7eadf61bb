//! Words that others have kept: a system that goes on with other constraints than it was started with goes on as if nothing had been kept.

use pointmass::constrain::{
    Attach, Bodies, Contacts, Demand, Distance, RigidBodies, RigidBox, Rope, ShapeMatching, Share, SheetContacts,
    Shell, ShellParams, StrainLimitParams, StrainLimits, StrandParams, Strands, Tie,
};
use pointmass::motion::Motion;
use pointmass::shape::Plane;
use pointmass::{Constraint, Gravity, Heap, Particle, Scene, Sheet, Size, System, Time, Vec3};

/// The rules by which words are filled, and one that leaves them as they were.
const RULES: u32 = 7;
const NOTHING: u32 = RULES;

/// Asks for as much memory as another constraint, and fills what is kept of it by a rule.
struct Scribbler<'a> {
    as_much_as: &'a dyn Constraint,
    rule: u32,
    seed: u32,
}

impl Constraint for Scribbler<'_> {
    fn demand(&self) -> Demand {
        self.as_much_as.demand()
    }
    fn project(&self, _: &mut Bodies<'_>, share: &mut Share<'_>) {
        let mut state = self.seed.wrapping_mul(2_654_435_769) | 1;
        for word in share.kept.rows.iter_mut().chain(&mut *share.kept.fixed) {
            state ^= state << 13;
            state ^= state >> 17;
            state ^= state << 5;
            *word = match self.rule {
                NOTHING => 0,
                0 => u32::MAX,
                1 => 1,
                2 => state % 40,
                3 => state,
                4 => f32::NAN.to_bits(),
                5 if state.is_multiple_of(5) => state % 3000,
                5 => 1,
                _ => ((state % 2001) as f32 * 1e-3 - 1.0).to_bits(),
            };
        }
    }
}

/// A crowd of particles: a sheet of 4 × 4, and a box of eight above it.
fn crowd(sheet: &Sheet) -> Vec<Particle> {
    let grain = |position: Vec3| Particle { position, mass: 0.1, radius: 0.01, ..Particle::REST };
    let corners = (0..8).map(|i| Vec3::new((i & 1) as f32, (i >> 1 & 1) as f32, (i >> 2) as f32) * 0.1);
    sheet.positions().map(grain).chain(corners.map(|x| grain(x + Vec3::new(0.1, 0.3, 0.1)))).collect()
}

/// Calls `visit` with a crowd and with each kind of constraint on it.
fn each_kind(mut visit: impl FnMut(&[Particle], &str, &dyn Constraint)) {
    let sheet = Sheet { corner: Vec3::new(0.0, 0.2, 0.0), sides: [Vec3::X * 0.4, Vec3::Z * 0.4], cells: [3, 3] };
    let start = crowd(&sheet);
    let woven: Vec<u32> = (0..16).collect();
    let cube: Vec<u32> = (16..24).collect();
    let triangles: Vec<_> = sheet.triangles().collect();
    let (shell, chest) = (
        Shell {
            particles: &woven[..],
            triangles: &triangles[..],
            hinges: sheet.hinges().collect::<Vec<_>>(),
            warp: Vec3::X,
            params: ShellParams { stretch: [100.0; 2], shear: 20.0, bending: 1e-4, damping: 0.0 },
        },
        RigidBodies {
            balls: 2,
            ..RigidBodies::boxes([RigidBox::new(Vec3::splat(0.1), Vec3::new(0.15, 0.35, 0.15), 16)])
        },
    );
    let rope = Rope::rigid(&woven[..4], [0.13]);
    let jelly = ShapeMatching { compliance: 1e-3, damping: 0.1, ..ShapeMatching::rigid(&cube[..]) };
    let wire = Strands { twist: 0.2, ..Strands::of(&woven[..8], [4, 4], StrandParams::round(2e-3, 3e9, 0.3)) };
    let hand = Attach { particles: [0, 3], motion: Motion { spin: 0.5, axis: Vec3::Y, ..Motion::STILL } };
    let tether = Distance::string([0, 16], 0.2);
    let cloth = SheetContacts { particles: &woven[..], triangles: &triangles[..], thickness: [0.02] };
    let within =
        StrainLimitParams { warp: Some([0.9, 1.1]), weft: None, shear: Some(0.2), compliance: 0.0, damping: 0.0 };
    let limits = StrainLimits { triangles: &triangles[..], warp: Vec3::X, params: within };
    let tie = Tie { compliance: 1e-3, ..Tie::rigid(16, [0, 1, 4]) };
    let all = &(&hand, tether, (&rope, &jelly, &tie), (&shell, &chest), &cloth, Contacts::HARD);
    let kinds: [(&str, &dyn Constraint); 11] = [
        ("shell", &shell),
        ("chest", &chest),
        ("rope", &rope),
        ("jelly", &jelly),
        ("wire", &wire),
        ("hand", &hand),
        ("tether", &tether),
        ("cloth", &cloth),
        ("limits", &limits),
        ("tie", &tie),
        ("all", all),
    ];
    kinds.into_iter().for_each(|(name, constraints)| visit(&start, name, constraints));
}

#[test]
fn whatever_others_have_kept_is_forgotten() {
    each_kind(|start, name, constraints| {
        let as_new = gone_on(start, constraints, NOTHING, 0);
        for (rule, seed) in (0..RULES).flat_map(|rule| (0..4).map(move |seed| (rule, seed))) {
            assert_eq!(gone_on(start, constraints, rule, seed), as_new, "{name}, rule {rule}, seed {seed}");
        }
    });
}

#[test]
fn constraints_that_nobody_made_room_for_lose_nobody() {
    each_kind(|start, name, constraints| {
        let scene = Scene { start, forces: &Gravity::EARTH, substeps: 2, ..Scene::EMPTY };
        for more in [[0, 0], [0, 3], [30, 40]] {
            let Size { columns, kept, .. } = scene.size();
            let size = Size { columns: columns + more[0], kept: kept + more[1], ..scene.size() };
            let mut system = System::with(Heap::new(size));
            system.start(&scene, 1).expect("it fits");
            for frame in 1..5 {
                system.step_to(&Scene { constraints, ..scene }, Time::frame(frame, 60));
            }
            assert_eq!(system.len(), start.len(), "{name}, {size:?}");
        }
    });
}

/// Where particles are after seven steps with constraints that were put in the place of a scribbler after the first.
fn gone_on(start: &[Particle], constraints: &dyn Constraint, rule: u32, seed: u32) -> Vec<Vec3> {
    let floor = Plane { point: Vec3::ZERO, normal: Vec3::Y };
    let scene = Scene { start, forces: &Gravity::EARTH, colliders: &floor, constraints, substeps: 2, ..Scene::EMPTY };
    let scribbler = Scribbler { as_much_as: constraints, rule, seed };
    let before = Scene { constraints: &scribbler, ..scene };
    let mut system = System::with(Heap::new(scene.size()));
    system.start(&before, 1).expect("it fits");
    system.step_to(&before, Time::frame(1, 60));
    for frame in 2..8 {
        system.step_to(&scene, Time::frame(frame, 60));
    }
    assert_eq!(system.len(), start.len());
    system.particles().position.to_vec()
}

#[test]
fn meshes_of_one_size_take_each_others_place() {
    let sheet = Sheet { corner: Vec3::new(0.0, 0.2, 0.0), sides: [Vec3::X * 0.4, Vec3::Z * 0.4], cells: [3, 3] };
    let start = crowd(&sheet);
    let woven: Vec<u32> = (0..16).collect();
    let (triangles, hinges): (Vec<_>, Vec<_>) = (sheet.triangles().collect(), sheet.hinges().collect());
    let params = ShellParams { stretch: [100.0; 2], shear: 20.0, bending: 1e-4, damping: 0.0 };
    for turn in 1..triangles.len() {
        // The same number of everything, but others beside each other.
        let mut others = triangles.clone();
        others.rotate_left(turn);
        others.iter_mut().step_by(2).for_each(|corners| corners.swap(0, 1));
        others[0] = [triangles[0][0], triangles[turn][1], triangles[turn][2]];
        let [one, other] = [&triangles, &others].map(|triangles| Shell {
            particles: &woven[..],
            triangles: &triangles[..],
            hinges: &hinges[..],
            warp: Vec3::X,
            params,
        });
        let [apart, others_apart] = [&triangles, &others].map(|triangles| SheetContacts {
            particles: &woven[..],
            triangles: &triangles[..],
            thickness: [0.02],
        });
        let scene =
            Scene { start: &start, forces: &Gravity::EARTH, constraints: &(&one, &apart), substeps: 2, ..Scene::EMPTY };
        let after = Scene { constraints: &(&other, &others_apart), ..scene };
        let mut system = System::with(Heap::new(scene.size()));
        system.start(&scene, 1).expect("it fits");
        for frame in 1..8 {
            system.step_to(if frame < 3 { &scene } else { &after }, Time::frame(frame, 60));
        }
        assert_eq!(system.len(), start.len(), "{turn}");
    }
}
