//! Rapier's side of a drop of balls: that it is the drop that was asked for.
#![cfg(feature = "rapier")]

use pointmass_peers::rapier::{Drop, GRAVITY, Pile, max_penetration};

fn drop(positions: Vec<[f32; 3]>, elasticity: f32) -> Drop {
    let (radius, density, friction) = (0.05, 1000.0, 0.3);
    Drop {
        positions,
        radius,
        density,
        friction,
        elasticity,
        half_width: 0.5,
        dt: 1.0 / 60.0,
        length_unit: 0.5,
        turns: true,
    }
}

#[test]
fn a_ball_falls_with_its_mass_and_stays_in_the_box() {
    let mut pile = Pile::new(&drop(vec![[0.1, 5.0, 0.2]], 0.0));
    (0..30).for_each(|_| pile.step());
    let speed = f64::from(GRAVITY) * 0.5;
    let mass = 1000.0 * 4.0 / 3.0 * std::f64::consts::PI * 0.05f64.powi(3);
    let expected = 0.5 * mass * speed * speed;
    assert!((pile.kinetic_energy() / expected - 1.0).abs() < 1e-3, "{} for {expected}", pile.kinetic_energy());
    let fallen = f64::from(5.0 - pile.positions()[0][1]);
    // Its steps divide into a few; half a step of speed is the most it may be off.
    assert!((fallen - 0.5 * speed * 0.5).abs() < 0.5 * speed / 60.0, "{fallen}");
    (0..300).for_each(|_| pile.step());
    let [x, y, z] = pile.positions()[0];
    assert!((x - 0.1).abs() < 1e-3 && (z - 0.2).abs() < 1e-3 && (y - 0.05).abs() < 5e-3, "{x} {y} {z}");
    assert!(pile.kinetic_energy() < 1e-4 && pile.max_penetration() < 5e-3);
}

#[test]
fn many_stay_inside_and_come_to_rest() {
    let place = |i: usize| {
        [
            0.21 * (i % 4) as f32 - 0.32 + 0.01 * (i / 16) as f32,
            0.1 + 0.12 * (i / 16) as f32,
            0.2 * (i / 4 % 4) as f32 - 0.3,
        ]
    };
    let mut pile = Pile::new(&drop((0..128).map(place).collect(), 0.2));
    (0..400).for_each(|_| pile.step());
    let all = pile.positions();
    assert!(all.iter().all(|[x, y, z]| x.abs() < 0.5 && z.abs() < 0.5 && *y > 0.0), "{all:?}");
    assert!(pile.kinetic_energy() < 0.1 && pile.max_penetration() < 0.01, "{} J", pile.kinetic_energy());
}

#[test]
fn penetration_is_that_of_the_deepest() {
    assert_eq!(max_penetration(&[], 0.1, 1.0), 0.0);
    assert_eq!(max_penetration(&[[0.0, 1.0, 0.0], [0.3, 1.0, 0.0]], 0.1, 1.0), 0.0);
    let near = |positions: &[[f32; 3]], depth: f32| (max_penetration(positions, 0.1, 1.0) - depth).abs() < 1e-6;
    assert!(near(&[[0.0, 1.0, 0.0], [0.0, 1.15, 0.0]], 0.05), "two balls");
    assert!(near(&[[0.0, 0.07, 0.0]], 0.03), "the floor");
    assert!(near(&[[0.5, 1.0, -0.96]], 0.06), "a wall");
}
