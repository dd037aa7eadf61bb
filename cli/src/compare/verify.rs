//! Verification before measurement: who is wrong is not timed.
//!
//! Few points are searched exhaustively, by loops that share nothing with the structures. Of many, one structure says what
//! is expected of the others, and the exhaustive search judges it on a sample of rows.

use super::contender::{Answer, Contender, Question, link};
use super::sample::sample;
use super::workload::Workload;
use crate::outcome::{Failure, Outcome};
use pointmass::Vec3;

/// Up to so many points, every row is searched exhaustively.
pub(crate) const EXHAUSTIVE: usize = 20_000;
/// The number of rows that are otherwise.
pub(crate) const SAMPLE: usize = 100;

/// The answers that everybody has to give.
#[derive(Debug, Default)]
pub(crate) struct Expected {
    counts: Vec<u32>,
    links: Vec<u64>,
    distances: Vec<f32>,
    /// Counts after the move.
    moved: Vec<u32>,
}

/// The queries that are verified.
pub(crate) const ASKED: [Workload; 5] =
    [Workload::Count, Workload::Within, Workload::Pairs, Workload::Nearest, Workload::Moving];

impl Expected {
    /// By exhaustive search of some rows.
    pub(crate) fn exhaustive(
        question: &Question<'_>,
        queries: &[Workload],
        rows: impl Iterator<Item = usize> + Clone,
    ) -> Self {
        let mut expected = Self::default();
        let search = Search::new(question.points, question);
        for row in rows.clone() {
            let found = search.row(row, queries.contains(&Workload::Nearest));
            expected.counts.push(found.count);
            expected.links.push(found.links);
            expected.distances.extend(found.distances);
        }
        if queries.contains(&Workload::Moving) {
            let search = Search::new(question.moved, question);
            expected.moved = rows.map(|row| search.row(row, false).count).collect();
        }
        expected
    }

    /// By what one contender says, which is searched exhaustively for a sample of rows.
    pub(crate) fn by(
        leader: &mut dyn Contender,
        name: &str,
        question: &Question<'_>,
        queries: &[Workload],
        seed: u64,
    ) -> Outcome<Self> {
        let rows = sample(question.points.len(), SAMPLE, seed);
        let (truth, mut expected) = (Self::exhaustive(question, queries, rows.iter().copied()), Self::default());
        leader.build(question.points, question.radius)?;
        // Counts and links are what all that is found within the radius is held against.
        let is_needed = |query: &Workload| {
            matches!(query, Workload::Count | Workload::Within) || *query != Workload::Pairs && queries.contains(query)
        };
        for query in ASKED.into_iter().filter(is_needed) {
            if query == Workload::Moving {
                leader.follow(question.moved, question.radius)?;
            }
            let Some(answer) = leader.answer(query, question) else { continue };
            if let Some((i, what)) = truth.exactly(query, &answer.of(&rows, question.k)) {
                return Err(wrong(name, query, rows[i], what, question));
            }
            match answer {
                Answer::Counts(moved) if query == Workload::Moving => expected.moved = moved,
                Answer::Counts(counts) => expected.counts = counts,
                Answer::Links(links) => expected.links = links,
                Answer::Distances(distances) => expected.distances = distances,
                Answer::Total(_) => {}
            }
        }
        Ok(expected)
    }

    /// The number of others that a point has within the radius, on average.
    pub(crate) fn neighbours(&self) -> f64 {
        total(&self.counts) as f64 / self.counts.len().max(1) as f64
    }

    /// Builds a contender and has it answer everything.
    pub(crate) fn check(
        &self,
        contender: &mut dyn Contender,
        name: &str,
        question: &Question<'_>,
        queries: &[Workload],
    ) -> Outcome {
        contender.build(question.points, question.radius)?;
        for query in ASKED.into_iter().filter(|query| queries.contains(query)) {
            if query == Workload::Moving {
                contender.follow(question.moved, question.radius)?;
            }
            let Some(answer) = contender.answer(query, question) else { continue };
            let fault = if contender.is_exact() {
                self.exactly(query, &answer)
            } else {
                self.nearly(query, &answer).map(|what| (0, what))
            };
            if let Some((row, what)) = fault {
                return Err(wrong(name, query, row, what, question));
            }
        }
        Ok(())
    }

    /// The first row that differs, and how.
    fn exactly(&self, query: Workload, answer: &Answer) -> Option<(usize, String)> {
        match answer {
            Answer::Counts(counts) => {
                let expected = if query == Workload::Moving { &self.moved } else { &self.counts };
                first_unlike(expected, counts).map(|row| (row, told(&expected[row], counts.get(row))))
            }
            Answer::Links(links) => first_unlike(&self.links, links)
                .map(|row| (row, format!("expected {} neighbours, found others than these", self.counts[row]))),
            Answer::Distances(distances) => {
                let bits = |distances: &[f32]| distances.iter().map(|d| d.to_bits()).collect::<Vec<_>>();
                let k = (self.distances.len() / self.counts.len().max(1)).max(1);
                let (expected, found) = (self.distances.chunks(k), distances.chunks(k));
                let row = expected.zip(found).position(|(a, b)| bits(a) != bits(b))?;
                let [expected, found] = [&self.distances, distances].map(|all| &all[row * k..(row + 1) * k]);
                Some((row, format!("expected the distances {expected:?}, found {found:?}")))
            }
            Answer::Total(found) => {
                let expected = total(&self.counts);
                (expected != *found).then(|| (0, format!("expected {expected} in all, found {found}")))
            }
        }
    }

    /// The fault of another library, which rounds in its own way, if it differs by more than that.
    fn nearly(&self, query: Workload, answer: &Answer) -> Option<String> {
        let sums = |counts: &[u32], found: u64| {
            let expected = total(counts);
            let most = (expected as f64 * TOTALS).ceil() as u64;
            (expected.abs_diff(found) > most).then(|| format!("expected {expected} neighbours in all, found {found}"))
        };
        match answer {
            Answer::Counts(found) if query == Workload::Moving => sums(&self.moved, total(found)),
            Answer::Counts(found) => sums(&self.counts, total(found)),
            Answer::Total(found) => sums(&self.counts, *found),
            Answer::Links(links) => {
                let unlike = self.links.iter().zip(links).filter(|(a, b)| a != b).count();
                let most = (self.links.len() as f64 * ROWS).ceil() as usize;
                (unlike > most || self.links.len() != links.len())
                    .then(|| format!("{unlike} rows have other neighbours than expected"))
            }
            Answer::Distances(found) => {
                let far = |(a, b): (&f32, &f32)| !((a - b).abs() <= DISTANCES * a.abs() || a == b);
                let at = self.distances.iter().zip(found).position(far)?;
                Some(format!("expected the distance {}, found {}", self.distances[at], found[at]))
            }
        }
    }
}

/// By how much the totals of another library may differ, relatively.
pub(crate) const TOTALS: f64 = 1e-4;
/// Which part of rows may have other neighbours there.
const ROWS: f64 = 1e-3;
/// By how much its distances may differ, relatively.
pub(crate) const DISTANCES: f32 = 1e-5;

fn total(counts: &[u32]) -> u64 {
    counts.iter().map(|&count| u64::from(count)).sum()
}

fn told(expected: &u32, found: Option<&u32>) -> String {
    match found {
        Some(found) => format!("expected {expected} others within the radius, found {found}"),
        None => format!("expected {expected} others within the radius, found no answer"),
    }
}

fn first_unlike<T: PartialEq>(expected: &[T], found: &[T]) -> Option<usize> {
    let unlike = expected.iter().zip(found).position(|(a, b)| a != b);
    unlike.or_else(|| (expected.len() != found.len()).then(|| expected.len().min(found.len()).saturating_sub(1)))
}

fn wrong(name: &str, query: Workload, row: usize, what: String, question: &Question<'_>) -> Failure {
    let search = Search::new(if query == Workload::Moving { question.moved } else { question.points }, question);
    let (query, n, radius) = (query.name(), question.points.len(), question.radius);
    let some = search.others(row).map(|row| row.to_string()).take(8).collect::<Vec<_>>().join(" ");
    Failure::new(format!(
        "{name} gives a wrong answer to {query}, row {row} of {n}, radius {radius}: {what} (the first that an exhaustive \
         search finds within the radius: {some}); nothing was measured; please report this with the points and the command"
    ))
}

/// Exhaustive search.
struct Search<'a> {
    points: Vec<Vec3>,
    square: f32,
    scale: f32,
    question: &'a Question<'a>,
}

/// The findings for a row.
struct Found {
    count: u32,
    links: u64,
    distances: Vec<f32>,
}

impl<'a> Search<'a> {
    fn new(points: &[Vec3], question: &'a Question<'a>) -> Self {
        let scale = scale(points);
        let radius = question.radius * scale;
        Self { points: points.iter().map(|&point| point * scale).collect(), square: radius * radius, scale, question }
    }

    fn square_to(&self, row: usize, other: usize) -> f32 {
        let d = self.points[other] - self.points[row];
        d.x * d.x + d.y * d.y + d.z * d.z
    }

    /// The others within the radius.
    fn others(&self, row: usize) -> impl Iterator<Item = usize> {
        (0..self.points.len()).filter(move |&other| other != row && self.square_to(row, other) <= self.square)
    }

    fn row(&self, row: usize, nearest: bool) -> Found {
        let mut found = Found { count: 0, links: 0, distances: Vec::new() };
        let k = if nearest { self.question.k } else { 0 };
        let mut squares = vec![f32::INFINITY; k];
        for other in 0..self.points.len() {
            let square = self.square_to(row, other);
            if other == row {
                continue;
            }
            if square <= self.square {
                found.count += 1;
                found.links = found.links.wrapping_add(link(row as u32, other as u32));
            }
            if squares.last().is_some_and(|last| square < *last) {
                let at = squares.partition_point(|smaller| *smaller <= square);
                squares[at..].rotate_right(1);
                squares[at] = square;
            }
        }
        found.distances = squares.into_iter().map(|square| square.sqrt() / self.scale).collect();
        found
    }
}

/// A power of two by which coordinates far from 1 are multiplied so that their squares stay within an `f32`, as
/// structures do.
fn scale(points: &[Vec3]) -> f32 {
    let most = points.iter().fold(0.0f32, |most, point| most.max(point.abs().max_element()));
    let exponent = ((most.to_bits() >> 23) as i32 - 127).clamp(-126, 126);
    match most == 0.0 || (-30..=30).contains(&exponent) {
        true => 1.0,
        false => f32::from_bits(((127 - exponent) as u32) << 23),
    }
}
