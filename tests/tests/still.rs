//! What hangs still has no speed, whatever holds it, whatever the method and the sub-steps.

use pointmass::constrain::{ShapeMatching, Shell, ShellParams, StrandParams, Strands, Tie};
use pointmass::{Constraint, Distance, Drag, Gravity, Method, Particle, Rope, Scene, Sheet, Vec3};
use pointmass_tests::{is_run, run, started};

/// Something that hangs.
struct Hung {
    name: &'static str,
    start: Vec<Particle>,
    bond: Box<dyn Constraint>,
}

/// So many particles one below the other, of which the first are fixed.
fn line(count: u32, fixed: u32, scale: f32) -> Vec<Particle> {
    let at = |i: u32| Particle { position: Vec3::NEG_Y * (i as f32 * 0.1 * scale), fixed: i < fixed, ..Particle::REST };
    (0..count).map(at).collect()
}

/// Links each by itself.
fn chain(count: u32, scale: f32, compliance: f32, tether: bool) -> Vec<Distance> {
    let length = 0.1 * scale;
    (1..count).map(|i| Distance { ends: [i - 1, i], length, compliance, damping: 0.0, tether }).collect()
}

/// One of each kind: `soft` things stretch by some hundredths of their size.
fn things(scale: f32) -> Vec<Hung> {
    let (mass, g) = (0.02, 10.0);
    let soft = 0.02 * 0.1 * scale / (mass * g);
    let hung = |name, start: Vec<Particle>, bond: Box<dyn Constraint>| {
        let heavy = |p: &Particle| Particle { mass, drag: 3.0 * mass, ..*p };
        Hung { name, start: start.iter().map(heavy).collect(), bond }
    };
    let sheet =
        Sheet { corner: Vec3::ZERO, sides: [Vec3::X * (0.2 * scale), Vec3::NEG_Y * (0.4 * scale)], cells: [2, 4] };
    let mut cloth: Vec<Particle> = sheet.particles(Particle::REST).collect();
    cloth.iter_mut().for_each(|p| p.fixed = p.position.y == 0.0);
    let params = ShellParams { stretch: [40.0 / scale; 2], shear: 10.0 / scale, bending: 1e-5 * scale, damping: 1e-3 };
    let shell = Shell {
        particles: (0..15).collect::<Vec<u32>>(),
        triangles: sheet.triangles().collect::<Vec<_>>(),
        hinges: sheet.hinges().collect::<Vec<_>>(),
        warp: Vec3::X,
        params,
    };
    let params = StrandParams {
        stretch: Some(20.0),
        bending: [1e-4 * scale * scale; 2],
        twisting: 1e-4 * scale * scale,
        damping: 1e-3,
    };
    let numbers: Vec<u32> = (0..6).collect();
    let strand = Strands::of(numbers.clone(), vec![6], params);
    let stiff = Strands::of(numbers.clone(), vec![6], StrandParams { stretch: None, ..params });
    let box_of = |fixed: usize| -> Vec<Particle> {
        let at = |i: usize| Vec3::new((i & 1) as f32, -((i >> 1 & 1) as f32), (i >> 2) as f32) * (0.1 * scale);
        (0..8).map(|i| Particle { position: at(i), fixed: i < fixed, ..Particle::REST }).collect()
    };
    let cluster = |compliance| ShapeMatching { compliance, ..ShapeMatching::rigid((0..8).collect::<Vec<u32>>()) };
    let tie = |compliance| Tie { compliance, ..Tie::rigid(3, [0u32, 1, 2]) };
    let mut held = box_of(3);
    held.truncate(4);
    let rope = |compliance| Rope { compliance, ..Rope::rigid((0..6).collect::<Vec<u32>>(), vec![0.1 * scale]) };
    vec![
        hung("rod", line(2, 1, scale), Box::new(Distance::rod([0, 1], 0.1 * scale))),
        hung("string", line(2, 1, scale), Box::new(Distance::string([0, 1], 0.1 * scale))),
        hung("rods", line(6, 1, scale), Box::new(chain(6, scale, 0.0, false))),
        hung("strings", line(6, 1, scale), Box::new(chain(6, scale, 0.0, true))),
        hung("soft links", line(6, 1, scale), Box::new(chain(6, scale, soft, false))),
        hung("rope", line(6, 1, scale), Box::new(rope(0.0))),
        hung("soft rope", line(6, 1, scale), Box::new(rope(soft))),
        hung("shell", cloth, Box::new(shell)),
        hung("strand", line(6, 2, scale), Box::new(strand)),
        hung("stiff strand", line(6, 2, scale), Box::new(stiff)),
        hung("cluster", box_of(4), Box::new(cluster(0.0))),
        hung("tie", held.clone(), Box::new(tie(0.0))),
        hung("soft tie", held, Box::new(tie(soft))),
        hung("jelly", box_of(4), Box::new(cluster(soft))),
    ]
}

#[test]
fn what_hangs_still_shows_no_speed() {
    let (mut cases, mut failures) = (0, vec![]);
    for (round, scale) in [1.0, 0.1, 20.0].into_iter().enumerate() {
        // Times go by the root of the size.
        let step = f64::from(scale).sqrt() / 60.0;
        let forces = (Gravity { acceleration: Vec3::NEG_Y * 10.0 }, Drag {});
        for Hung { name, start, bond } in &things(scale) {
            let brake = |p: &Particle| Particle { drag: p.drag / scale.sqrt(), ..*p };
            let start: Vec<_> = start.iter().map(brake).collect();
            // Every method meets every thing, in one of the sizes.
            let methods = Method::ALL.iter().enumerate().filter(|(number, _)| number % 3 == round);
            for (_, &method) in methods {
                for substeps in [1, 4, 10] {
                    if !is_run(&mut cases) {
                        continue;
                    }
                    let parts = Scene { start: &start, forces: &forces, constraints: &**bond, ..Scene::EMPTY };
                    let scene = Scene { substeps, integrator: method.integrator(), ..parts };
                    let mut system = started(&scene, start.len(), 0);
                    run(&mut system, &scene, step, 600);
                    let speed = system.particles().velocity.iter().fold(0f32, |most, v| most.max(v.length()));
                    let h = step as f32 / substeps as f32;
                    let falls = 10.0 * h;
                    if !(speed < 0.02 * falls + 4.0 * f32::EPSILON * scale / h) {
                        failures.push(format!(
                            "{name} of {scale} m, {method}, {substeps} sub-steps: {} of g h",
                            speed / falls
                        ));
                    }
                }
            }
        }
    }
    assert!(failures.is_empty(), "{} {failures:#?}", failures.len());
}
