//! Constraints that name particles that there are not, or hold numbers that cannot be used, are counted as they begin.

use pointmass::constrain::{
    RigidBodies, RigidBox, ShellParams, StrainLimitParams, StrandParams, Strands, Tie, TiedRope,
};
use pointmass::{
    Attach, Constraint, Distance, Particle, Rope, Scene, ShapeMatching, SheetContacts, Shell, StrainLimits, Time, Vec3,
};
use pointmass_tests::started;

/// How many parts of a constraint on three particles are counted as doing nothing in a step, and in the next ones.
fn lacking(constraint: &dyn Constraint) -> (u64, u64) {
    let place = |x, y| Particle { position: Vec3::new(x, y, 0.0), ..Particle::REST };
    let start = [place(0.0, 0.0), place(1.0, 0.0), place(0.0, 1.0)];
    let scene = Scene { start: &start, constraints: &constraint, substeps: 3, ..Scene::EMPTY };
    let mut system = started(&scene, 3, 0);
    let first = system.step(&scene, Time::frame(1, 60)).caps.degenerate;
    (first, (0..3).map(|_| system.step(&scene, Time::frame(1, 60)).caps.degenerate).sum())
}

#[test]
fn what_lacks_particles_or_sound_numbers_is_counted_once() {
    let shell = |particles: [u32; 3], triangles: [[u32; 3]; 1]| Shell {
        particles,
        triangles,
        hinges: [],
        warp: Vec3::X,
        params: ShellParams::isotropic(1e3, 0.3, 0.1),
    };
    let sheet = |triangles: [[u32; 3]; 1]| SheetContacts { particles: [0, 1, 2], triangles, thickness: [0.01] };
    let strand = |particles: [u32; 3]| {
        let params = StrandParams { stretch: None, bending: [1e-3; 2], twisting: 1e-3, damping: 0.0 };
        Strands::of(particles, [3], params)
    };
    let limits = |triangles: [[u32; 3]; 1]| StrainLimits {
        triangles,
        warp: Vec3::X,
        params: StrainLimitParams { warp: Some([0.9, 1.1]), weft: None, shear: None, compliance: 0.0, damping: 0.0 },
    };
    let dice = |first, hull| {
        RigidBodies::boxes([RigidBox { count: 3, hull, ..RigidBox::new(Vec3::ONE, Vec3::splat(0.3), first) }])
    };
    let tied = |particle, to| TiedRope {
        rope: Rope::rigid([0, 1], [1.0]),
        ends: [Some(Tie::<[u32; 1]>::rigid(particle, [to])), None],
    };
    let cases: [(&str, &dyn Constraint, u64); 25] = [
        ("a rod", &Distance::rod([0, 1], 1.0), 0),
        ("a rod to nobody", &Distance::rod([0, 4000], 1.0), 1),
        ("a rod of no length", &Distance::rod([0, 1], f32::NAN), 1),
        ("two rods, one to nobody", &[Distance::rod([0, 1], 1.0), Distance::rod([3, 1], 1.0)], 1),
        ("a rope", &Rope::rigid([0, 1, 2], [1.0, 2f32.sqrt()]), 0),
        ("a rope through two that are nobody", &Rope::rigid([0, 8, 9], [1.0]), 2),
        ("a rope without lengths", &Rope::<_, [f32; 0]>::rigid([0, 1, 2], []), 1),
        ("a tie", &Tie::<[u32; 1]>::rigid(0, [1]), 0),
        ("a tie to nobody", &Tie::<[u32; 1]>::rigid(0, [7]), 1),
        ("a tie of a negative compliance", &Tie { compliance: -1.0, ..Tie::<[u32; 1]>::rigid(0, [1]) }, 1),
        ("a tied rope", &tied(0, 2), 0),
        ("a rope tied to nobody", &tied(0, 3), 1),
        ("what is led", &Attach { particles: [0, 1], motion: () }, 0),
        ("nobody who is led", &Attach { particles: [0, 3], motion: () }, 1),
        ("a shape", &ShapeMatching { particles: [0, 1, 2], compliance: 0.0, damping: 0.0 }, 0),
        ("a shape of nobody", &ShapeMatching { particles: [0, 1, 3], compliance: f32::NAN, damping: 0.0 }, 2),
        ("a shell", &shell([0, 1, 2], [[0, 1, 2]]), 0),
        ("a shell through nobody", &shell([0, 1, 3], [[0, 1, 2]]), 1),
        ("a shell with a corner beyond its particles", &shell([0, 1, 2], [[0, 1, 3]]), 1),
        ("contacts of a sheet", &sheet([[0, 1, 2]]), 0),
        ("contacts of a sheet beyond its particles", &sheet([[0, 1, 3]]), 1),
        ("limits", &limits([[0, 1, 2]]), 0),
        ("limits of nobody", &limits([[0, 1, 3]]), 1),
        ("a die of two that are there", &dice(1, None), 1),
        ("a die without its hull", &dice(0, Some(5)), 1),
    ];
    for (name, constraint, count) in cases {
        assert_eq!(lacking(constraint), (count, 0), "{name}");
    }
    assert_eq!([[0, 1, 2], [0, 1, 3]].map(|particles| lacking(&strand(particles))), [(0, 0), (1, 0)]);
}
