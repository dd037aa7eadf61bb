//! The radius within which a point has so many others on average.

use super::contender::{Own, provide};
use crate::outcome::Outcome;
use pointmass::Vec3;
use pointmass::index::{SpatialIndex, Structure};

/// How many points are asked.
const ASKED: usize = 2000;
/// How often the interval is halved; a single has 24 digits.
const HALVINGS: u32 = 40;

/// Finds it by bisection on the counts of a sample of points, which is true to a few per cent: the sample is taken at equal
/// distances of the structure's order, so that every part of space is in it with its share.
pub(crate) fn radius_for(points: &[Vec3], neighbours: f64, memory: &mut Vec<u32>) -> Outcome<f32> {
    // Of all structures the one least sensitive to how points lie and to the radius.
    let tree = Structure::ALL.iter().copied().find(|structure| structure.name() == "kd");
    let structure = tree.or(Structure::ALL.last().copied()).unwrap_or(Structure::Brute);
    let words = structure.words(points.len());
    provide(memory, words)?;
    let mut own = Own::new(structure, points.len(), memory);
    let index = own.index();
    index.build(points, 0.0)?;
    let (order, asked) = (index.order(), ASKED.min(points.len()));
    let asked: Vec<_> = (0..asked).map(|i| points[order[i * order.len() / asked] as usize]).collect();
    let enough = neighbours * asked.len() as f64;
    let has_enough = |radius: f32| {
        let mut found = 0.0;
        asked.iter().any(|&point| {
            found += index.count(point, radius).found.saturating_sub(1) as f64;
            found >= enough
        })
    };
    let (mut low, mut high) = (0.0, widest(points));
    for _ in 0..HALVINGS {
        let middle = low + (high - low) / 2.0;
        if middle <= low || middle >= high {
            break;
        }
        if has_enough(middle) { high = middle } else { low = middle }
    }
    Ok(high)
}

/// At least the distance of any two of the points, and positive.
fn widest(points: &[Vec3]) -> f32 {
    let bounds = points.iter().fold((Vec3::MAX, Vec3::MIN), |(low, high), point| (low.min(*point), high.max(*point)));
    // Halves, so that the difference of the largest numbers is one.
    let half = (bounds.1 * 0.5 - bounds.0 * 0.5).abs().max_element();
    match half > 0.0 {
        true => (half * 4.0).min(f32::MAX),
        false => 1.0,
    }
}

#[cfg(test)]
mod tests {
    use super::super::distribution::Distribution;
    use super::*;

    fn mean(points: &[Vec3], radius: f32) -> f64 {
        let near = |a: &Vec3| points.iter().filter(|b| a.distance(**b) <= radius).count() - 1;
        points.iter().map(near).sum::<usize>() as f64 / points.len() as f64
    }

    #[test]
    fn the_radius_has_so_many_neighbours() -> Outcome {
        for distribution in [Distribution::Uniform, Distribution::Plummer, Distribution::Line, Distribution::Mixed] {
            let points = distribution.points(500, 5);
            for wanted in [1.0, 30.0, 100.0] {
                let found = mean(&points, radius_for(&points, wanted, &mut Vec::new())?);
                // All points are asked here, so it is as exact as one more or less of them allows.
                assert!((found - wanted).abs() <= 0.05 + 0.01 * wanted, "{distribution:?}: {found}, {wanted} wanted");
            }
        }
        Ok(())
    }

    #[test]
    fn a_part_of_the_points_is_enough_to_find_it() -> Outcome {
        let points = Distribution::Clusters.points(4000, 5);
        let found = mean(&points, radius_for(&points, 30.0, &mut Vec::new())?);
        assert!((found - 30.0).abs() < 1.0, "{found}");
        Ok(())
    }

    #[test]
    fn too_many_neighbours_and_one_place_have_a_radius_too() -> Outcome {
        let points = Distribution::Uniform.points(50, 5);
        let radius = radius_for(&points, 1000.0, &mut Vec::new())?;
        assert!(radius.is_finite() && mean(&points, radius) == 49.0);
        assert!(radius_for(&[Vec3::ONE; 20], 3.0, &mut Vec::new())? > 0.0);
        let far = [Vec3::splat(-3e38), Vec3::splat(3e38), Vec3::ZERO];
        assert!(radius_for(&far, 1.0, &mut Vec::new())?.is_finite());
        Ok(())
    }
}
