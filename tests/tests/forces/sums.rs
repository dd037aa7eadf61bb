//! Sums of forces, and sums of rows.

use super::{UNIT, cloud, forces, sink};
use pointmass::force::{Curl, Gusts, Radial, State, Weight};
use pointmass::{
    Coulomb, Drag, Force, Gravity, Measures, Method, MutualGravity, PowerLaw, Pressure, QuadraticDrag, Scene, Spring,
    Vec3, Viscosity, Wind,
};
use pointmass_tests::{icosahedron, point, run, started};

#[test]
fn any_division_of_the_rows_gives_the_same_bits() {
    let mut start = cloud(29);
    for (particle, place) in start.iter_mut().zip(icosahedron().0) {
        (particle.position, particle.charge) = (particle.position * 0.2 + place, particle.mass);
    }
    let springs: Vec<Spring> =
        (0..60).map(|i| Spring::new([i % 29, (i * 5 + 2) % 29], 0.5, 20.0).damped(0.5)).collect();
    let scene = Scene { start: &start, springs: &springs, ..Scene::EMPTY };
    let system = started(&scene, 29, 0);
    let state: State<'_> = system.state(&scene);
    let sink = sink(point(Vec3::X));
    let coulomb = Coulomb { constant: 1.0, ..Coulomb::VACUUM };
    let quadratic = QuadraticDrag { coefficient: 0.5 };
    let wind = Wind {
        field: (
            Gusts { velocity: Vec3::X, amplitude: 0.5, frequency: 1.0 },
            Curl { speed: 1.0, scale: 0.3, drift: Vec3::Y, seed: 0 },
        ),
        coefficient: None,
    };
    let power = Radial(PowerLaw { strength: 1.0, exponent: 2, softening: 0.1, reach: 0.8, weight: Weight::Mass });
    let viscous = Viscosity { coefficient: 1.0, reach: 0.8 };
    let gas = Pressure { triangles: icosahedron().1, amount: 1.0, outside: -1.0 };
    let all: [&dyn Force; 11] =
        [&Gravity::EARTH, &Drag {}, &UNIT, &sink, &state.springs, &coulomb, &quadratic, &wind, &power, &viscous, &gas];
    for force in all {
        let whole = forces(&system, &scene, force);
        for cuts in [&[0, 1, 29][..], &[0, 8, 16, 24, 29], &[0, 5, 5, 22, 29]] {
            let mut parts = vec![Vec3::ZERO; 29];
            for cut in cuts.windows(2) {
                force.add_to(&state, cut[0]..cut[1], &mut parts[cut[0]..cut[1]]);
            }
            assert_eq!(parts, whole);
        }
    }
}

#[test]
fn lists_of_forces_are_their_sum_to_the_bit() {
    let start = cloud(30);
    let (g, d, m) =
        (Gravity::EARTH, Drag {}, MutualGravity { constant: 1.0, softening: 0.05, ..MutualGravity::NEWTON });
    let sink = sink(point(Vec3::X * 3.0));
    let dynamic: [&dyn Force; 4] = [&g, &d, &m, &sink];
    let lists: [&dyn Force; 6] = [
        &(g, d, m, &sink),
        &dynamic,
        &&dynamic[..],
        &((g, d), (), (m, &sink)),
        &(&g as &dyn Force, [d], [&m], [&&sink]),
        &((), (((g, d, m, sink.clone()), ()), ())),
    ];
    let end = |force: &dyn Force| {
        let scene = Scene { start: &start, forces: force, integrator: Method::Rk4.integrator(), ..Scene::EMPTY };
        let mut system = started(&scene, 30, 0);
        run(&mut system, &scene, 1.0 / 60.0, 60);
        (system.hash(), Measures::of(&system, &scene).energy.potential)
    };
    let expected = end(lists[0]);
    for list in lists {
        let (hash, energy) = end(list);
        assert_eq!(hash, expected.0);
        // A report may sum in another order.
        assert!((energy / expected.1 - 1.0).abs() < 1e-13);
    }
    assert_ne!(end(&(g, d, m)).0, expected.0);
}
