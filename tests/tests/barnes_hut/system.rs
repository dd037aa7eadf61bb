//! Systems under the force: what is born, gone, fixed or no number, and what is conserved.

use super::{BOTH, UNIT, particles};
use pointmass::emit::Burst;
use pointmass::shape::Sphere;
use pointmass::{Emitter, Heap, Measures, Method, MutualGravity, Particle, Scene, System, Time, Varied, Vec3};
use pointmass_tests::fields::{Charges, bits};
use pointmass_tests::points::Spread;
use pointmass_tests::{Form, Random, f64s, gap, is_third, often, run, started};

#[test]
fn it_nearly_conserves_momentum() {
    let mut random = Random::new(20);
    let n = often(1000).max(200);
    let mut start = particles(&Charges::masses(Spread::Plummer, n, 1));
    start.iter_mut().for_each(|particle| particle.velocity = random.vector(60.0));
    for quadrupole in BOTH {
        let force = MutualGravity { quadrupole, ..UNIT };
        let integrator = Method::Verlet.integrator();
        let scene = Scene { start: &start, forces: &force, integrator, ..Scene::EMPTY };
        let mut system = started(&scene, n, 0);
        let before = Measures::of(&system, &scene);
        run(&mut system, &scene, 2e-5, 50);
        let after = Measures::of(&system, &scene);
        let p = system.particles();
        let size: f64 = p.mass.iter().zip(p.velocity).map(|(&m, v)| f64::from(m) * f64::from(v.length())).sum();
        let off = gap(before.momentum, after.momentum) / size;
        let energy = (after.energy.total() / before.energy.total() - 1.0).abs();
        println!("quadrupole {quadrupole}: {off:e} of all momentum, {energy:e} of all energy");
        assert!(off < 1e-4, "{off:e} of all momentum");
        assert!(energy < 1e-3, "{energy:e} of all energy");
    }
}

#[test]
fn newborn_particles_feel_it_too() {
    // A hundred and fifty, or with the newborn, are pulled by a heavy cluster that is fixed.
    let births = Form::Sphere(Sphere { center: Vec3::X * 3.0, radius: 0.5 });
    let burst = Some(Burst { count: 100, at: 0.005, every: 0.0 });
    let emitter = Emitter { burst, mass: Varied::exactly(1e-3), ..Emitter::new(births, 0.0) };
    for n in [50, 150] {
        let mut start = particles(&Charges::masses(Spread::Plummer, n, 1));
        start.iter_mut().for_each(|particle| particle.fixed = true);
        let end = |force: &MutualGravity, steps: u32| {
            let scene = Scene { start: &start, emitters: &emitter, forces: force, ..Scene::EMPTY };
            let mut system = started(&scene, 300, 3);
            run(&mut system, &scene, 0.01, steps);
            assert_eq!(system.len(), n + 100);
            let p = system.particles();
            p.position[n..].iter().zip(&p.velocity[n..]).map(|(x, v)| (*x, *v)).collect::<Vec<_>>()
        };
        // At the end of the step in which they are born, and later.
        for steps in [1, 20] {
            let (near, far) = (end(&MutualGravity { theta: 0.0, ..UNIT }, steps), end(&UNIT, steps));
            assert_ne!(near, far, "{n}, {steps}");
            for ((x, v), (y, w)) in near.iter().zip(&far) {
                assert!(v.x < -0.01 && (*v - *w).length() < 5e-3 * v.length(), "{n}, {steps}: {v} {w}");
                assert!((*x - *y).length() < 2e-3, "{n}, {steps}: {x} {y}");
            }
        }
    }
}

#[test]
fn those_who_are_gone_do_not_act() {
    let mut start = particles(&Charges::masses(Spread::Cube, 300, 1));
    let without = start.clone();
    // One removed, one too old, one that is no number, all of them heavier than all others together.
    let heavy = Particle { position: Vec3::splat(0.6), mass: 1e4, ..Particle::REST };
    start.push(heavy);
    start.push(Particle { lifetime: 1e-3, ..heavy });
    start.push(Particle { velocity: Vec3::splat(f32::NAN), ..heavy });
    start.push(Particle { position: Vec3::splat(f32::INFINITY), ..heavy });
    let force = MutualGravity { quadrupole: true, ..UNIT };
    let forces = &force;
    let scene = Scene { start: &start, ..Scene::EMPTY };
    let mut system = started(&Scene { forces, ..scene }, 320, 0);
    let id = system.id(300).expect("it is there");
    assert!(system.remove(&scene, id));
    // Nothing acts while the others go.
    system.step(&scene, Time::from_seconds(0.01));
    assert_eq!(system.len(), 300);
    system.step(&Scene { forces, ..scene }, Time::from_seconds(0.01));
    let scene = Scene { start: &without, forces, ..Scene::EMPTY };
    let mut expected = started(&scene, 300, 0);
    expected.step(&scene, Time::from_seconds(0.01));
    let all = |system: &System<Heap>| {
        let p = system.particles();
        let mut all: Vec<_> =
            (0..300).map(|row| (p.serial[row], bits(p.position[row]), bits(p.velocity[row]))).collect();
        all.sort_unstable();
        all
    };
    assert_eq!(all(&system), all(&expected));
}

#[test]
fn what_is_not_a_number_harms_nobody() {
    let (nan, inf) = (f32::NAN, f32::INFINITY);
    let sound = particles(&Charges::masses(Spread::Plummer, 200, 1));
    let bad = [
        Particle { position: Vec3::new(0.0, nan, 0.0), ..Particle::REST },
        Particle { position: Vec3::new(inf, 0.0, 0.0), ..Particle::REST },
        Particle { mass: nan, ..Particle::REST },
        Particle { mass: inf, ..Particle::REST },
        Particle { velocity: Vec3::splat(nan), mass: 1e-9, ..Particle::REST },
    ];
    let mut cases = 0;
    for &method in Method::ALL {
        for quadrupole in BOTH {
            let force = MutualGravity { quadrupole, ..UNIT };
            for bad in bad {
                if !is_third(&mut cases) {
                    continue;
                }
                let mut start = sound.clone();
                start.insert(100, bad);
                let scene = Scene { start: &start, forces: &force, integrator: method.integrator(), ..Scene::EMPTY };
                let mut system = started(&scene, 201, 0);
                run(&mut system, &scene, 1e-3, 10);
                assert!(system.len() >= 200, "{method}, {quadrupole}, beside {bad:?}: {:?}", system.totals().died);
            }
        }
    }
    // Not even if nothing else is there.
    let start = [Particle { position: Vec3::NAN, ..Particle::REST }; 200];
    let scene = Scene { start: &start, forces: &UNIT, ..Scene::EMPTY };
    let mut system = started(&scene, 200, 0);
    assert_eq!(system.step(&scene, Time::from_seconds(0.01)).died.nonfinite, 200);
}

#[test]
fn planets_and_a_moon_stay_on_their_ways() {
    let g = MutualGravity::NEWTON.constant;
    let (sun, planet, radius, way) = (1.989e30f32, 5.972e24f32, 1.496e11f32, 3.844e8f32);
    let (around_sun, around_planet) = ((g * sun / radius).sqrt(), (g * planet / way).sqrt());
    let at = |position, velocity, mass| Particle { position, velocity, mass, ..Particle::REST };
    let mut start = vec![
        at(Vec3::ZERO, Vec3::ZERO, sun),
        at(Vec3::X * radius, Vec3::Y * around_sun, planet),
        at(Vec3::X * (radius + way), Vec3::Y * (around_sun + around_planet), 7.35e22),
    ];
    let mut random = Random::new(2);
    start.extend((0..200).map(|_| at(random.direction() * random.between(3e11, 5e11), Vec3::ZERO, 1e15)));
    for (softening, quadrupole) in [(0.0, false), (0.0, true), (1e6, false), (1e6, true)] {
        let near = MutualGravity { softening, ..MutualGravity::NEWTON };
        let far = MutualGravity { theta: 0.5, quadrupole, ..near };
        let [near, far] = [near, far].map(|force| {
            let integrator = Method::Verlet.integrator();
            let scene = Scene { start: &start, forces: &force, integrator, ..Scene::EMPTY };
            let mut system = started(&scene, start.len(), 0);
            run(&mut system, &scene, 3600.0, 24);
            assert_eq!(system.totals().died.nonfinite, 0, "{force:?}");
            [1, 2].map(|row| f64s(system.particles().position[row]))
        });
        // In a day, the planet goes 2.6e9 m, and the moon 8.8e7 m around it.
        assert!(gap(near[0], far[0]) < 1e6 && gap(near[1], far[1]) < 1e6, "{near:?} {far:?}");
    }
}
