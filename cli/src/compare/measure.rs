//! The clock: everybody in turn, round after round, so that what else the machine does hits all alike.

use super::contender::{Build, Contender, Question, Scratch};
use super::entrant::Entrant;
use super::gauge::Gauge;
use super::stopwatch::Stopwatch;
use super::study::{Contestant, Figure};
use super::workload::Workload;
use crate::outcome::Outcome;
use pointmass::index::Cost;
use std::hint::black_box;
use std::time::{Duration, Instant};

/// Rounds, if nobody says how many: until so much time has passed, but so many at least and so many at most.
const PATIENCE: Duration = Duration::from_secs(3);
const ROUNDS: std::ops::RangeInclusive<usize> = 7..=31;
/// If those at least would take longer than this, so few have to do.
const LONG: Duration = Duration::from_secs(60);
const FEWEST: usize = 3;
/// Fewer than this are gone through several times.
const FEW: usize = 2000;

/// The part of an entrant in a case.
#[derive(Clone, Debug, Default)]
pub(crate) struct Share {
    /// The workloads that are asked of it; of those who do not take part, none.
    pub(crate) queries: Vec<Workload>,
    /// The workloads that it does not do, and why.
    pub(crate) left_out: Option<String>,
}

impl Share {
    /// Whether it takes part.
    pub(crate) fn is_in(&self) -> bool {
        !self.queries.is_empty()
    }
}

/// Who is asked what, and how often.
pub(crate) struct Plan<'a> {
    pub(crate) shares: &'a [Share],
    pub(crate) repeat: Option<u32>,
}

/// The outcome of one entrant's measurements.
#[derive(Clone, Debug, Default)]
pub(crate) struct Measured {
    pub(crate) build: Build,
    /// Samples \[ns for each point, triangle or query\] by workload, and its counters: visits, tests, finds, for each too.
    pub(crate) series: Vec<(Workload, Vec<f64>, Option<[f64; 3]>)>,
}

impl Measured {
    pub(crate) fn add(&mut self, workload: Workload, sample: f64, counters: Option<[f64; 3]>) {
        match self.series.iter_mut().find(|(known, ..)| *known == workload) {
            Some((_, samples, _)) => samples.push(sample),
            None => self.series.push((workload, vec![sample], counters)),
        }
    }

    /// How often everything was measured.
    pub(crate) fn rounds(&self) -> usize {
        self.series.iter().map(|(_, samples, _)| samples.len()).max().unwrap_or(0)
    }

    /// Its outcome.
    pub(crate) fn contestant(self, name: &str, left_out: Option<String>) -> Contestant {
        let series = self.series.into_iter();
        let mut figures: Vec<_> =
            series.map(|(workload, samples, counters)| Figure::new(workload, samples, counters)).collect();
        figures.sort_by_key(|figure| figure.workload);
        Contestant { name: name.into(), left_out, mismatches: None, build: self.build, figures }
    }
}

/// Measures all entrants that take part.
pub(crate) fn measure(
    entrants: &mut [Entrant],
    question: &Question<'_>,
    memory: &mut [u32],
    plan: &Plan<'_>,
    gauge: &mut Gauge,
) -> Outcome<Vec<Measured>> {
    let mut measured = vec![Measured::default(); entrants.len()];
    let mut scratch = Scratch::new(question);
    let n = question.points.len();
    let players: Vec<_> = (0..entrants.len()).filter(|&at| plan.shares[at].is_in()).collect();
    take_turns(&players, plan.repeat, |at, left| {
        let (entrant, share) = (&mut entrants[at], &plan.shares[at]);
        gauge.step(n as u64, (n * left) as u64, entrant.name());
        let mut contender = entrant.enter(n, memory);
        take_turn(contender.as_mut(), question, &share.queries, &mut scratch, &mut measured[at])
    })?;
    Ok(measured)
}

/// Has every player take a turn in every round, of which it is told how many turns are left, that is expected.
pub(crate) fn take_turns(
    players: &[usize],
    repeat: Option<u32>,
    mut turn: impl FnMut(usize, usize) -> Outcome,
) -> Outcome {
    let begun = Instant::now();
    let (mut round, mut all) = (0, rounds(repeat, Duration::ZERO, 1));
    while round < all {
        for at in 0..players.len() {
            let left = players.len() * (all - round) - at - 1;
            // Another begins each round, so that nobody always follows the same.
            turn(players[(at + round) % players.len()], left)?;
        }
        round += 1;
        all = rounds(repeat, begun.elapsed(), round).max(round);
    }
    Ok(())
}

/// How many rounds there will be, by what the first ones took.
fn rounds(repeat: Option<u32>, elapsed: Duration, done: usize) -> usize {
    match repeat {
        Some(rounds) => rounds as usize,
        None => {
            let each = elapsed.as_secs_f64() / done.max(1) as f64;
            let possible = PATIENCE.as_secs_f64() / each.max(1e-9);
            let is_long = each * *ROUNDS.start() as f64 > LONG.as_secs_f64();
            (possible as usize).clamp(if is_long { FEWEST } else { *ROUNDS.start() }, *ROUNDS.end())
        }
    }
}

/// So few points or triangles are gone through several times, as a measurement of once takes less than what surrounds it.
pub(crate) fn times(n: usize) -> usize {
    (FEW / n).max(1)
}

fn take_turn(
    contender: &mut dyn Contender,
    question: &Question<'_>,
    queries: &[Workload],
    scratch: &mut Scratch,
    measured: &mut Measured,
) -> Outcome {
    let (n, radius) = (question.points.len(), question.radius);
    let times = times(n);
    let each = |count: u64| count as f64 / n as f64;
    let counters = |cost: Option<Cost>| cost.map(|cost| [each(cost.visits), each(cost.tests), each(cost.found)]);
    let per_point = |elapsed: Duration| elapsed.as_secs_f64() * 1e9 / (n * times) as f64;

    let begun = Stopwatch::start();
    for _ in 0..times {
        contender.build(black_box(question.points), radius)?;
    }
    measured.add(Workload::Build, per_point(begun.elapsed()), None);
    measured.build = contender.built();

    for &query in queries.iter().filter(|query| **query != Workload::Moving) {
        let mut cost = None;
        let begun = Stopwatch::start();
        for _ in 0..times {
            cost = contender.run(black_box(query), question, scratch);
        }
        let elapsed = begun.elapsed();
        if let Some(cost) = cost {
            measured.add(query, per_point(elapsed), counters(cost));
        }
    }
    if queries.contains(&Workload::Moving) {
        let (mut following, mut counting, mut cost) = (Duration::ZERO, Duration::ZERO, None);
        for time in 0..times {
            // There and back, so that there is a move each time.
            let places = if time % 2 == 0 { question.moved } else { question.points };
            let begun = Stopwatch::start();
            contender.follow(black_box(places), radius)?;
            following += begun.elapsed();
            let begun = Stopwatch::start();
            cost = contender.run(Workload::Count, question, scratch);
            counting += begun.elapsed();
        }
        measured.add(Workload::Refit, per_point(following), None);
        if let Some(cost) = cost {
            measured.add(Workload::Moving, per_point(following + counting), counters(cost));
        }
    }
    Ok(())
}
