//! Neighbours in a cloud of points, by each of the structures: the same answers, at different costs.
//!
//! `cargo run --release -p pointmass --example point_cloud`

use pointmass::Vec3;
use pointmass::index::{Neighbour, SpatialIndex, Structure};
use pointmass::rng::Stream;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    // A cloud that is denser toward its middle.
    let points: Vec<Vec3> = (0..20_000)
        .map(|i| {
            let ([x, y], [z, far]) = (Stream::new(1, 0, i).units(0), Stream::new(1, 0, i).units(1));
            (Vec3::new(x, y, z) - 0.5) * (0.1 + 2.0 * far)
        })
        .collect();
    let radius = 0.05;
    for &structure in Structure::ALL {
        let mut memory = vec![0; structure.words(points.len())];
        let mut index = structure.index(&mut memory);
        index.build(&points, radius)?;
        let (mut pairs, mut found) = (0, [Neighbour::default(); 8]);
        let cost = index.pairs(radius, &mut |_, others| pairs += others.len());
        index.nearest(Vec3::ZERO, f32::INFINITY, &mut found);
        println!(
            "{:9} {pairs} pairs, {} distances computed; the eight nearest to the middle begin with {}",
            structure.to_string(),
            cost.tests,
            found[0].row
        );
    }
    Ok(())
}
