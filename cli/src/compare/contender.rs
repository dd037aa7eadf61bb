//! The contenders: our structures, and other libraries where the program has them.

use super::workload::Workload;
use crate::outcome::{Failure, Outcome};
use pointmass::Vec3;
use pointmass::index::{AnyIndex, Cost, Neighbour, SpatialIndex, Structure};
use serde::Serialize;
use std::hint::black_box;

/// A question, and the points that it is about.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Question<'a> {
    pub(crate) points: &'a [Vec3],
    /// The same points after a small move.
    pub(crate) moved: &'a [Vec3],
    pub(crate) radius: f32,
    /// The number of nearest.
    pub(crate) k: usize,
}

/// Memory that answers are written to, so that none is asked of the system while the clock runs.
#[derive(Debug, Default)]
pub(crate) struct Scratch {
    pub(crate) counts: Vec<u32>,
    pub(crate) distances: Vec<f32>,
    pub(crate) found: Vec<Neighbour>,
}

impl Scratch {
    pub(crate) fn new(question: &Question<'_>) -> Self {
        let found = vec![Neighbour::default(); question.k];
        Self { counts: vec![0; question.points.len()], distances: Vec::new(), found }
    }
}

/// A whole answer, to be verified.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Answer {
    /// The number of others, by row.
    Counts(Vec<u32>),
    /// The sum of `link` over the others of every row.
    Links(Vec<u64>),
    /// The distances of the k nearest others of every row; infinite where there are fewer.
    Distances(Vec<f32>),
    /// The number of rows and others in all.
    Total(u64),
}

impl Answer {
    /// The answer for some rows alone, where it has rows; `k` is the number of nearest of each.
    pub(crate) fn of(&self, rows: &[usize], k: usize) -> Self {
        match self {
            Self::Counts(counts) => Self::Counts(rows.iter().filter_map(|&row| counts.get(row).copied()).collect()),
            Self::Links(links) => Self::Links(rows.iter().filter_map(|&row| links.get(row).copied()).collect()),
            Self::Distances(distances) => {
                let of_row = |&row: &usize| distances.get(row * k..(row + 1) * k).unwrap_or_default();
                Self::Distances(rows.iter().flat_map(of_row).copied().collect())
            }
            Self::Total(total) => Self::Total(*total),
        }
    }
}

/// A fingerprint of two rows, in either order (the finaliser of SplitMix64: Steele, Lea, Flood, OOPSLA 2014).
pub(crate) fn link(a: u32, b: u32) -> u64 {
    let mut x = (u64::from(a.min(b)) << 32 | u64::from(a.max(b))).wrapping_add(0x9e37_79b9_7f4a_7c15);
    x = (x ^ (x >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    x = (x ^ (x >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    x ^ (x >> 31)
}

/// The properties of what has been built.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub(crate) struct Build {
    /// Nodes or cells; none if it does not say.
    pub(crate) nodes: Option<usize>,
    /// Levels below the root.
    pub(crate) depth: Option<usize>,
    /// The most points or triangles in a leaf or cell.
    pub(crate) fullest: Option<usize>,
    /// Leaves left too large, or times that cells were doubled, for want of memory.
    pub(crate) crowded: Option<usize>,
    /// Bytes for each point or triangle.
    pub(crate) bytes_each: Option<f64>,
}

/// The work of a query for a point, before it is asked of all.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Effort {
    /// Distances computed, and nodes visited.
    pub(crate) distances: f64,
    /// Points found.
    pub(crate) found: f64,
}

/// One who takes part: sorts points in, and answers. `None`: it has no such query.
pub(crate) trait Contender {
    /// True if its answers have to be the same as ours to the last bit.
    fn is_exact(&self) -> bool {
        true
    }

    fn build(&mut self, points: &[Vec3], reach: f32) -> Outcome;

    /// Follows the points it was built from to where they are now.
    fn follow(&mut self, points: &[Vec3], reach: f32) -> Outcome;

    fn built(&self) -> Build;

    /// Answers and forgets the answer; what is timed. The cost, if it says.
    fn run(&mut self, query: Workload, question: &Question<'_>, scratch: &mut Scratch) -> Option<Option<Cost>>;

    /// Answers; what is verified.
    fn answer(&mut self, query: Workload, question: &Question<'_>) -> Option<Answer>;

    /// The work that it would do for a point, on average of some rows; none if it does not say.
    fn effort(&mut self, query: Workload, question: &Question<'_>, rows: &[usize]) -> Option<Effort>;
}

/// One of our structures.
pub(crate) struct Own<'m>(AnyIndex<'m>);

impl<'m> Own<'m> {
    /// In so much memory as it wants for so many points; there has to be as much.
    pub(crate) fn new(structure: Structure, points: usize, memory: &'m mut [u32]) -> Self {
        let words = structure.words(points).min(memory.len());
        Self(structure.index(&mut memory[..words]))
    }

    pub(crate) fn index(&mut self) -> &mut AnyIndex<'m> {
        &mut self.0
    }
}

impl Contender for Own<'_> {
    fn build(&mut self, points: &[Vec3], reach: f32) -> Outcome {
        Ok(self.0.build(points, reach)?)
    }

    fn follow(&mut self, points: &[Vec3], _: f32) -> Outcome {
        Ok(self.0.refit(points)?)
    }

    fn built(&self) -> Build {
        let stats = self.0.stats();
        Build {
            nodes: Some(stats.nodes),
            depth: Some(stats.depth),
            fullest: Some(stats.fullest),
            crowded: Some(stats.crowded),
            bytes_each: Some(stats.bytes as f64 / stats.points.max(1) as f64),
        }
    }

    fn run(&mut self, query: Workload, question: &Question<'_>, scratch: &mut Scratch) -> Option<Option<Cost>> {
        let (index, radius) = (&self.0, question.radius);
        let mut see = |row: u32, others: &[u32]| {
            black_box((row, others.first(), others.len()));
        };
        Some(Some(match query {
            Workload::Within => index.neighbours(radius, &mut see),
            Workload::Pairs => index.pairs(radius, &mut see),
            Workload::Nearest => index.all_nearest(f32::INFINITY, &mut scratch.found, &mut |row, found| {
                black_box((row, found.last()));
            }),
            _ => {
                let cost = index.counts(radius, &mut scratch.counts);
                black_box(&scratch.counts);
                cost
            }
        }))
    }

    fn answer(&mut self, query: Workload, question: &Question<'_>) -> Option<Answer> {
        let (index, radius, n) = (&self.0, question.radius, question.points.len());
        let mut links = vec![0u64; if matches!(query, Workload::Within | Workload::Pairs) { n } else { 0 }];
        Some(match query {
            Workload::Within => {
                index.neighbours(radius, &mut |row, others| {
                    let sum = others.iter().fold(0, |sum: u64, &other| sum.wrapping_add(link(row, other)));
                    links[row as usize] = links[row as usize].wrapping_add(sum);
                });
                Answer::Links(links)
            }
            Workload::Pairs => {
                index.pairs(radius, &mut |row, others| others.iter().for_each(|&other| tie(&mut links, row, other)));
                Answer::Links(links)
            }
            Workload::Nearest => {
                let mut distances = vec![f32::INFINITY; n * question.k];
                let mut found = vec![Neighbour::default(); question.k];
                index.all_nearest(f32::INFINITY, &mut found, &mut |row, found| {
                    let place = &mut distances[row as usize * question.k..];
                    place.iter_mut().zip(found).for_each(|(to, neighbour)| *to = neighbour.distance);
                });
                Answer::Distances(distances)
            }
            _ => {
                let mut counts = vec![0; n];
                index.counts(radius, &mut counts);
                Answer::Counts(counts)
            }
        })
    }

    fn effort(&mut self, query: Workload, question: &Question<'_>, rows: &[usize]) -> Option<Effort> {
        let mut found = vec![Neighbour::default(); question.k + 1];
        let mut sum = Cost::default();
        for &row in rows {
            let center = question.points[row];
            sum += match query {
                Workload::Nearest => self.0.nearest(center, f32::INFINITY, &mut found),
                _ => self.0.count(center, question.radius),
            };
        }
        let each = |count: u64| count as f64 / rows.len().max(1) as f64;
        Some(Effort { distances: each(sum.tests + sum.visits), found: each(sum.found) })
    }
}

/// Adds a pair to the fingerprints of both rows.
pub(crate) fn tie(links: &mut [u64], a: u32, b: u32) {
    let link = link(a, b);
    for row in [a, b] {
        links[row as usize] = links[row as usize].wrapping_add(link);
    }
}

/// Makes so many words of memory available.
pub(crate) fn provide(memory: &mut Vec<u32>, words: usize) -> Outcome {
    let more = words.saturating_sub(memory.len());
    memory.try_reserve_exact(more).map_err(|_| {
        let megabytes = words >> 18;
        Failure::new(format!("there are no {megabytes} MB of memory for a structure of so many; ask for fewer"))
    })?;
    memory.resize(memory.len() + more, 0);
    Ok(())
}
