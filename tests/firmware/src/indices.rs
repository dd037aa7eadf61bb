//! Answers of indices that every target computes alike: the firmware here, the host in `tests/tests/hashes.rs`.
//!
//! Every index over 256 points, a few of them equal and one not finite: built, asked everything, refitted to where the
//! points have moved, asked again, and once more in a box whose opposite faces are one. Then the sums of Barnes and Hut
//! over such points.

use pointmass::index::{BarnesHut, Cost, Neighbour, Opening, SpatialIndex, Structure};
use pointmass::rng::Stream;
use pointmass::{Fnv, Vec3};

/// The hashes in the form of `all` in `expected.rs`.
pub(crate) const EXPECTED: &str = include_str!("../../indices.txt");

const POINTS: usize = 256;
/// The radii to ask for; the first is the reach to build with.
const RADII: [f32; 3] = [0.1, 0.45, f32::INFINITY];
const CENTERS: [Vec3; 4] = [Vec3::ZERO, Vec3::new(0.49, -0.2, 0.1), Vec3::new(3.0, -4.0, 0.0), Vec3::NAN];

/// The rules by which nodes count as far in the sums, and the ways in which they act.
const LAWS: [Opening; 4] = [
    Opening { theta: 0.0, softening: 0.05, quadrupole: false },
    Opening { theta: 0.5, softening: 0.01, quadrupole: false },
    Opening { theta: 0.5, softening: 0.01, quadrupole: true },
    Opening { theta: 0.8, softening: 0.0, quadrupole: true },
];

/// Words that are enough for every structure.
const WORDS: usize = {
    let (mut most, mut i) = (BarnesHut::words(POINTS), 0);
    while i < Structure::ALL.len() {
        let words = Structure::ALL[i].words(POINTS);
        most = if words > most { words } else { most };
        i += 1;
    }
    most
};

/// Everything that the indices need, none of it on the stack.
pub(crate) struct Memory {
    points: [Vec3; POINTS],
    weights: [f32; POINTS],
    counts: [u32; POINTS],
    index: [u32; WORDS],
}

impl Memory {
    pub(crate) const fn new() -> Self {
        Self { points: [Vec3::ZERO; POINTS], weights: [0.0; POINTS], counts: [0; POINTS], index: [0; WORDS] }
    }
}

/// Calls `out` with the name of each structure and the hash of all it said, how and in which order. Before the first
/// comes `answers`, the hash of what all have to say; it comes again before a structure that says something else. Last
/// comes `barnes_hut`, the hash of its sums.
pub(crate) fn run(memory: &mut Memory, out: &mut dyn FnMut(&str, u64)) {
    let mut answers = None;
    for &structure in Structure::ALL {
        let mut log = Log { answers: 0, all: Fnv::new() };
        fly(structure, memory, &mut log);
        if answers != Some(log.answers) {
            answers = Some(log.answers);
            out("answers", log.answers);
        }
        out(structure.name(), log.all.finish());
    }
    let mut log = Log { answers: 0, all: Fnv::new() };
    sum(memory, &mut log);
    out("barnes_hut", log.all.finish());
}

/// The sums of all laws over masses, then over charges of both signs.
fn sum(Memory { points, weights, index: words, .. }: &mut Memory, log: &mut Log) {
    let mut tree = BarnesHut::new(words);
    for sign in [1.0, -1.0] {
        for ((row, point), weight) in (0..).zip(points.iter_mut()).zip(weights.iter_mut()) {
            let mass = 0.5 + Stream::new(8, 0, row).units(0)[0];
            (*point, *weight) = (place(row), if row % 2 == 0 { mass } else { mass * sign });
        }
        weights[50] = f32::NAN;
        log.add(&[1, tree.build(points, weights).is_ok().into()]);
        for law in LAWS {
            let cost = tree.field(law, 0..POINTS, &mut |row, sum| {
                let [x, y, z] = sum.to_array().map(f32::to_bits);
                log.add(&[2, row as u32, x, y, z]);
            });
            log.cost(3, cost);
        }
    }
}

fn fly(structure: Structure, Memory { points, counts, index: words, .. }: &mut Memory, log: &mut Log) {
    for (row, point) in (0..).zip(points.iter_mut()) {
        *point = place(row);
    }
    let mut index = structure.index(words);
    log.add(&[1, index.build(points, RADII[0]).is_ok().into()]);
    ask(&index, counts, log);
    for (row, point) in (0..).zip(points.iter_mut()) {
        *point += place(row + 1000) * 0.05;
    }
    log.add(&[2, index.refit(points).is_ok().into()]);
    ask(&index, counts, log);
    let mut index = structure.periodic(words, Vec3::splat(-0.5), Vec3::new(1.0, 0.9, 0.0));
    log.add(&[3, index.build(points, RADII[0]).is_ok().into()]);
    ask(&index, counts, log);
}

/// Uniform in a cube around the origin; every sixteenth with the one before it.
fn place(row: u32) -> Vec3 {
    if row == 100 {
        return Vec3::NAN;
    }
    let stream = Stream::new(7, 0, if row % 16 == 15 { row - 1 } else { row });
    let ([x, y], [z, _]) = (stream.units(0), stream.units(1));
    Vec3::new(x, y, z) - 0.5
}

fn ask(index: &dyn SpatialIndex, counts: &mut [u32], log: &mut Log) {
    let stats = index.stats();
    log.add(&[4, stats.points as u32, stats.skipped as u32]);
    for size in [stats.nodes, stats.depth, stats.fullest, stats.crowded, stats.bytes] {
        log.all.word(size as u32);
    }
    index.order().iter().for_each(|&row| log.add(&[5, row]));
    let mut found = [Neighbour::default(); 8];
    for radius in RADII {
        for (i, center) in (0..).zip(CENTERS) {
            log.cost(6, index.count(center, radius));
            let cost = index.within(center, radius, &mut |rows| rows.iter().for_each(|&row| log.add(&[7, i, row])));
            log.cost(7, cost);
            let cost = index.nearest(center, radius, &mut found);
            log.nearest(i, &found[..cost.found as usize]);
            log.cost(8, cost);
        }
        let cost = index.counts(radius, counts);
        (0..).zip(&*counts).for_each(|(row, &count)| log.add(&[9, row, count]));
        log.cost(9, cost);
        let cost = index.neighbours(radius, &mut |row, others| others.iter().for_each(|&i| log.add(&[10, row, i])));
        log.cost(10, cost);
        let cost = index.pairs(radius, &mut |row, others| {
            others.iter().for_each(|&other| log.add(&[11, row.min(other), row.max(other)]));
        });
        log.cost(11, cost);
        let cost = index.all_nearest(radius, &mut found, &mut |row, nearest| log.nearest(1000 + row, nearest));
        log.cost(12, cost);
    }
}

/// A log of what was said.
struct Log {
    /// A sum, which does not depend on the order.
    answers: u64,
    all: Fnv,
}

impl Log {
    /// Adds words that belong together and have to be the same for every structure.
    fn add(&mut self, words: &[u32]) {
        let mut item = Fnv::new();
        words.iter().for_each(|&word| item.word(word));
        self.answers = self.answers.wrapping_add(item.finish());
        self.all.long(item.finish());
    }

    fn nearest(&mut self, of: u32, found: &[Neighbour]) {
        for (place, neighbour) in (0..).zip(found) {
            self.add(&[8, of, place, neighbour.row, neighbour.distance.to_bits()]);
        }
    }

    fn cost(&mut self, of: u32, cost: Cost) {
        self.add(&[13, of, cost.found as u32]);
        self.all.long(cost.visits);
        self.all.long(cost.tests);
    }
}
