//! Forces, their energies, powers and Jacobians against each other.

use super::{cloud, sink};
use pointmass::force::{Curl, Gusts, Perturbation, Radial, State, Uniform, Weight};
use pointmass::{
    Coulomb, Drag, Force, Gravity, LennardJones, Measures, MutualGravity, Particle, PowerLaw, Pressure, QuadraticDrag,
    Scene, Sink, Spring, Vec3, Viscosity, Wind,
};
use pointmass_tests::{Random, f64s, icosahedron, point, started};

#[test]
fn forces_are_the_slopes_of_their_energies() {
    let mut start = cloud(20);
    start[10].position += Vec3::splat(0.3);
    let springs: Vec<Spring> = (0..30).map(|i| Spring::new([i % 20, (i * 7 + 3) % 20], 0.5, 20.0)).collect();
    let soft = MutualGravity { constant: 1.0, softening: 0.5, ..MutualGravity::NEWTON };
    let sink = sink(point(Vec3::splat(2.0)));
    let soft_sink = Sink { softening: 0.7, ..sink.clone() };
    let coulomb = Coulomb { constant: 1.0, softening: 0.5, ..Coulomb::VACUUM };
    let triangles = icosahedron().1;
    let gas = Pressure { triangles: &triangles, amount: 40.0, outside: 2.0 };
    for (particle, place) in start.iter_mut().zip(icosahedron().0) {
        particle.position = particle.position * 0.3 + place;
    }
    let power = |exponent, weight| Radial(PowerLaw { strength: 0.3, exponent, softening: 0.6, reach: 9.0, weight });
    let powers = (power(0, Weight::One), power(1, Weight::Mass), power(2, Weight::Charge), power(6, Weight::One));
    let atoms = Radial(LennardJones { epsilon: 0.1, sigma: 0.1, cutoff: 9.0 });
    let forces: [&dyn Force; 9] =
        [&Gravity::EARTH, &soft, &sink, &soft_sink, &coulomb, &gas, &powers, &atoms, &(Gravity::EARTH, soft, &sink)];
    for force in forces {
        for axis in 0..3 {
            let energy = |row: usize, shift: f32| {
                let mut start = start.clone();
                start[row].position[axis] += shift;
                let scene = Scene { start: &start, springs: &springs, forces: force, ..Scene::EMPTY };
                let system = started(&scene, 20, 0);
                let state = system.state(&scene);
                let mut total = vec![Vec3::ZERO; 20];
                force.add_to(&state, 0..20, &mut total);
                state.springs.add_to(&state, 0..20, &mut total);
                let energy = Measures::of(&system, &scene).energy.potential;
                assert!((energy - force.energy(&state) - state.springs.energy(&state)).abs() < 1e-9);
                (energy, f64::from(total[row][axis]))
            };
            for row in 0..20 {
                let h = 1.0 / 256.0;
                let slope = (energy(row, h).0 - energy(row, -h).0) / f64::from(2.0 * h);
                let force = energy(row, 0.0).1;
                // The third derivative, times h² / 6; springs bend the most, at short distances.
                assert!((force + slope).abs() < 5e-3 * (10.0 + force.abs()), "row {row}: {force}, −{slope}");
            }
        }
    }
}

/// Particles in motion, the first twelve of them the corners of an icosahedron.
fn moving() -> Vec<Particle> {
    let mut random = Random::new(21);
    let mut start = cloud(20);
    for (particle, place) in start.iter_mut().zip(icosahedron().0) {
        particle.position = particle.position * 0.2 + place;
    }
    for particle in &mut start {
        particle.charge = random.between(-1.0, 1.0);
        particle.fixed = false;
    }
    start
}

/// Calls `then` with the state of some particles.
fn with_state<T>(start: &[Particle], then: impl FnOnce(&State<'_>) -> T) -> T {
    let scene = Scene { start, ..Scene::EMPTY };
    let system = started(&scene, start.len(), 0);
    then(&system.state(&scene))
}

/// The same, moved along some vectors.
fn moved(start: &[Particle], along: &[Vec3], position: f32, velocity: f32) -> Vec<Particle> {
    let step = |(p, &along): (&Particle, &Vec3)| Particle {
        position: p.position + along * position,
        velocity: p.velocity + along * velocity,
        ..*p
    };
    start.iter().zip(along).map(step).collect()
}

fn force_on(start: &[Particle], force: &dyn Force) -> Vec<Vec3> {
    with_state(start, |state| {
        let mut total = vec![Vec3::ZERO; start.len()];
        force.add_to(state, 0..start.len(), &mut total);
        total
    })
}

fn dot(a: &[Vec3], b: &[Vec3]) -> f64 {
    a.iter().zip(b).map(|(a, b)| f64s(*a).iter().zip(f64s(*b)).map(|(a, b)| a * b).sum::<f64>()).sum()
}

fn action(start: &[Particle], force: &dyn Force, along: &[Vec3], [position, velocity]: [f32; 2]) -> Vec<Vec3> {
    with_state(start, |state| {
        let mut total = vec![Vec3::ZERO; start.len()];
        force.add_jacobian(state, &Perturbation { along, position, velocity }, &mut total);
        total
    })
}

#[test]
fn jacobians_are_the_slopes_of_their_forces() {
    let mut random = Random::new(22);
    let start = moving();
    let wind = Wind { field: Uniform { velocity: Vec3::X * 3.0 }, coefficient: None };
    let blown = Wind { field: wind.field, coefficient: Some(2.5) };
    let viscous = Viscosity { coefficient: 2.0, reach: 0.9 };
    // Nothing is left out of a stretched pair, as long as it is not about to break.
    let pair = [0.0, 0.34].map(|x| Particle { position: Vec3::new(x, 0.5 * x, x), ..Particle::REST });
    let atoms = Radial(LennardJones { epsilon: 1.0, sigma: 0.44, cutoff: 2.0 });
    let rising = Radial(PowerLaw { strength: 2.0, exponent: 0, softening: 0.7, reach: 5.0, weight: Weight::Mass });
    let cases: [(&str, &[Particle], &dyn Force); 8] = [
        ("drag", &start, &Drag {}),
        ("quadratic drag", &start, &QuadraticDrag { coefficient: 0.4 }),
        ("wind", &start, &wind),
        ("wind", &start, &blown),
        ("viscosity", &start, &viscous),
        ("Lennard-Jones", &pair, &atoms),
        ("power law", &start, &rising),
        ("gravity", &start, &Gravity::EARTH),
    ];
    for (name, start, force) in cases {
        assert_eq!(force.name(), name);
        let n = start.len();
        for weights in [[1.0, 0.0], [0.0, 1.0], [0.7, 0.3]] {
            // How its weights change with the places is left out.
            if name == "viscosity" && weights[0] > 0.0 {
                continue;
            }
            let along: Vec<Vec3> = (0..n).map(|_| random.vector(1.0)).collect();
            let told = action(start, force, &along, weights);
            let h = 1.0 / 1024.0;
            let [low, high] = [-h, h].map(|h| force_on(&moved(start, &along, h * weights[0], h * weights[1]), force));
            let size = told.iter().map(|v| v.length()).fold(1.0, f32::max);
            for row in 0..n {
                let slope = (high[row] - low[row]) / (2.0 * h);
                assert!((told[row] - slope).length() < 3e-3 * size, "{name} {weights:?}, {row}: {} {slope}", told[row]);
            }
            // The diagonal, entry by entry.
            let mut diagonal = vec![Vec3::ZERO; n];
            with_state(start, |state| force.add_stiffness(state, weights, &mut diagonal));
            for row in 0..n {
                for axis in 0..3 {
                    let mut unit = vec![Vec3::ZERO; n];
                    unit[row][axis] = 1.0;
                    let own = -action(start, force, &unit, weights)[row][axis];
                    let off = (diagonal[row][axis] - own).abs();
                    assert!(off <= 1e-5 * size.max(own), "{name}, {row}: {} {own}", diagonal[row][axis]);
                }
            }
        }
    }
}

#[test]
fn jacobians_are_symmetric_and_drive_nothing_apart() {
    let mut random = Random::new(23);
    let start = moving();
    let triangles = icosahedron().1;
    let gas = Pressure { triangles: &triangles, amount: 40.0, outside: 2.0 };
    let atoms = Radial(LennardJones { epsilon: 0.1, sigma: 0.3, cutoff: 1.5 });
    let power = Radial(PowerLaw { strength: -0.7, exponent: 4, softening: 0.3, reach: 2.0, weight: Weight::Charge });
    let turbulent = Wind { field: Curl { speed: 2.0, scale: 0.5, drift: Vec3::ZERO, seed: 1 }, coefficient: None };
    let soft = MutualGravity { constant: 1.0, softening: 0.5, ..MutualGravity::NEWTON };
    let coulomb = Coulomb { constant: 1.0, softening: 0.5, ..Coulomb::VACUUM };
    let sink = sink(point(Vec3::ZERO));
    let viscous = Viscosity { coefficient: 2.0, reach: 0.9 };
    let mut driven = start.clone();
    driven[3].drag = -2.0;
    // A force that drives by its sign alone is left out.
    let vacuum = Pressure { amount: -40.0, ..gas };
    let stirred = Viscosity { coefficient: -2.0, reach: 0.9 };
    let all: [&dyn Force; 13] = [
        &vacuum,
        &stirred,
        &QuadraticDrag { coefficient: -0.4 },
        &gas,
        &atoms,
        &power,
        &turbulent,
        &soft,
        &coulomb,
        &sink,
        &viscous,
        &Drag {},
        &QuadraticDrag { coefficient: 0.4 },
    ];
    for force in all {
        let name = force.name();
        let mut diagonal = vec![Vec3::ZERO; 20];
        with_state(&driven, |state| force.add_stiffness(state, [0.5, 0.5], &mut diagonal));
        assert!(diagonal.iter().all(|d| d.min_element() >= 0.0 && d.is_finite()), "{name}");
        for _ in 0..20 {
            let [a, b]: [Vec<Vec3>; 2] = core::array::from_fn(|_| (0..20).map(|_| random.vector(1.0)).collect());
            let [ja, jb] = [&a, &b].map(|along| action(&driven, force, along, [1.0, 0.3]));
            let size = dot(&ja, &ja).sqrt() * dot(&b, &b).sqrt();
            assert!((dot(&a, &jb) - dot(&b, &ja)).abs() <= 1e-5 * size, "{name}");
            assert!(dot(&a, &ja) <= 1e-6 * size, "{name}: {}", dot(&a, &ja));
        }
    }
}

#[test]
fn power_is_what_comes_into_motion_and_energy() {
    let start = moving();
    let triangles = icosahedron().1;
    let gas = Pressure { triangles: &triangles, amount: 40.0, outside: 2.0 };
    let gusts = Wind { field: Gusts { velocity: Vec3::X * 5.0, amplitude: 0.3, frequency: 1.0 }, coefficient: None };
    let power = Radial(PowerLaw { strength: 0.7, exponent: 2, softening: 0.5, reach: 9.0, weight: Weight::Charge });
    let soft = MutualGravity { constant: 1.0, softening: 0.5, ..MutualGravity::NEWTON };
    let coulomb = Coulomb { constant: 1.0, softening: 0.5, ..Coulomb::VACUUM };
    let soft_sink = Sink { softening: 0.7, ..sink(point(Vec3::splat(2.0))) };
    let viscous = Viscosity { coefficient: 2.0, reach: 0.9 };
    let all: [(&dyn Force, &str); 10] = [
        (&Gravity::EARTH, "gravity"),
        (&Drag {}, "drag"),
        (&QuadraticDrag { coefficient: 0.4 }, "quadratic drag"),
        (&gusts, "wind"),
        (&viscous, "viscosity"),
        (&soft, "mutual gravity"),
        (&coulomb, "charges"),
        (&power, "power law"),
        (&soft_sink, "sinks"),
        (&gas, "pressure"),
    ];
    let along: Vec<Vec3> = start.iter().map(|p| p.velocity).collect();
    for (force, name) in all {
        let h = 1.0 / 512.0;
        let energy = |h: f32| with_state(&moved(&start, &along, h, 0.0), |state| force.energy(state));
        let into_energy = (energy(h) - energy(-h)) / f64::from(2.0 * h);
        let into_motion = dot(&force_on(&start, force), &along);
        let told = with_state(&start, |state| force.power(state));
        let size = 1.0 + into_motion.abs() + into_energy.abs();
        assert!((told - into_motion - into_energy).abs() < 1e-4 * size, "{name}: {told}, {into_motion} {into_energy}");
        assert_eq!((force.name(), (&force).name()), (name, name));
        let mut entries = vec![];
        with_state(&start, |state| force.account(state, &mut |entry| entries.push(entry)));
        assert!(entries.len() == 1 && entries[0].name == name && entries[0].power == told);
    }
}
