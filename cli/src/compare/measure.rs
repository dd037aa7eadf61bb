//! The clock: everybody in turn, round after round, so that what else the machine does hits all alike.

use super::bench::{Gauge, Share};
use super::contender::{Build, Contender, Entrant, Question, Scratch};
use super::stopwatch::Stopwatch;
use super::workload::Workload;
use crate::Outcome;
use pointmass::index::Cost;
use std::hint::black_box;
use std::time::{Duration, Instant};

/// Rounds, if nobody says how many: until so much time has passed, but so many at least and so many at most.
const PATIENCE: Duration = Duration::from_secs(3);
const ROUNDS: std::ops::RangeInclusive<usize> = 7..=31;
/// If those at least would take longer than this, so few have to do.
const LONG: Duration = Duration::from_secs(60);
const FEWEST: usize = 3;
/// So few points that a measurement takes less than what surrounds it are gone through several times.
const FEW: usize = 2000;

/// Who is asked what, and how often.
pub(crate) struct Plan<'a> {
    pub(crate) shares: &'a [Share],
    pub(crate) repeat: Option<u32>,
}

/// What one entrant's measurements came to.
#[derive(Clone, Debug, Default)]
pub(crate) struct Measured {
    pub(crate) build: Build,
    /// Samples \[ns for each point\] by workload, and what it took.
    pub(crate) series: Vec<(Workload, Vec<f64>, Option<Cost>)>,
}

impl Measured {
    fn add(&mut self, workload: Workload, sample: f64, cost: Option<Cost>) {
        match self.series.iter_mut().find(|(known, ..)| *known == workload) {
            Some((_, samples, _)) => samples.push(sample),
            None => self.series.push((workload, vec![sample], cost)),
        }
    }
}

/// Measures all entrants that take part.
///
/// # Errors
/// If one of them has no room for the points.
pub(crate) fn measure(
    entrants: &mut [Entrant],
    question: &Question<'_>,
    memory: &mut [u32],
    plan: &Plan<'_>,
    gauge: &mut Gauge,
) -> Outcome<Vec<Measured>> {
    let mut measured = vec![Measured::default(); entrants.len()];
    let mut scratch = Scratch::new(question);
    let (n, turns) = (question.points.len(), plan.shares.iter().filter(|share| share.is_in()).count());
    let begun = Instant::now();
    let (mut round, mut rounds) = (0, plan.rounds(Duration::ZERO, 1));
    while round < rounds {
        let mut left = turns;
        // Another begins each round, so that nobody always follows the same.
        for turn in 0..entrants.len() {
            let at = (turn + round) % entrants.len();
            let (entrant, share) = (&mut entrants[at], &plan.shares[at]);
            if share.is_in() {
                left -= 1;
                gauge.step(n as u64, (n * (left + turns * (rounds - round - 1))) as u64, entrant.name());
                let mut contender = entrant.enter(n, memory);
                take_turn(contender.as_mut(), question, &share.queries, &mut scratch, &mut measured[at])?;
            }
        }
        round += 1;
        rounds = plan.rounds(begun.elapsed(), round).max(round);
    }
    Ok(measured)
}

impl Plan<'_> {
    /// How many rounds there will be, by what the first ones took.
    fn rounds(&self, elapsed: Duration, done: usize) -> usize {
        match self.repeat {
            Some(rounds) => rounds as usize,
            None => {
                let each = elapsed.as_secs_f64() / done.max(1) as f64;
                let possible = PATIENCE.as_secs_f64() / each.max(1e-9);
                let is_long = each * *ROUNDS.start() as f64 > LONG.as_secs_f64();
                (possible as usize).clamp(if is_long { FEWEST } else { *ROUNDS.start() }, *ROUNDS.end())
            }
        }
    }
}

fn take_turn(
    contender: &mut dyn Contender,
    question: &Question<'_>,
    queries: &[Workload],
    scratch: &mut Scratch,
    measured: &mut Measured,
) -> Outcome {
    let (n, radius) = (question.points.len(), question.radius);
    let times = (FEW / n).max(1);
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
            measured.add(query, per_point(elapsed), cost);
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
            measured.add(Workload::Moving, per_point(following + counting), cost);
        }
    }
    Ok(())
}
