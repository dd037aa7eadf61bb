//! The bench on which contenders meet: one set of points after the other, first verified, then measured.

use super::args::Compare;
use super::contender::{Effort, Question, provide};
use super::entrant::Entrant;
use super::gauge::Gauge;
use super::measure::{Measured, Plan, Share, measure};
use super::radius::radius_for;
use super::sample::sample;
use super::source::Source;
use super::study::{Case, Subject};
use super::verify::{EXHAUSTIVE, Expected, SAMPLE};
use super::workload::Workload;
use crate::outcome::{Failure, Outcome};
use crate::report::words::thousands;
use pointmass::Vec3;
use pointmass::rng::Stream;

/// The state that all cases share.
pub(crate) struct Bench<'a> {
    args: &'a Compare,
    queries: Vec<Workload>,
    entrants: &'a mut [Entrant],
    /// Lent to one structure after the other.
    memory: Vec<u32>,
    gauge: Gauge,
}

/// Up to so many distances for a query of all points, anybody may take part: a few seconds.
const CHEAP: f64 = 1e9;
/// Beyond that, who computes at most so many times what the thriftiest does,
const TIMES: f64 = 10.0;
/// if these are no more than so many for each point, or for each that is found.
const DEAR: f64 = 5e3;
const DEAR_FOUND: f64 = 20.0;
/// But nobody is waited for longer than this takes: some minutes for every query.
const MOST: f64 = 1e11;
/// The number of points that are asked to find out.
const TRIED: usize = 64;

/// Rounds that verification takes as long as, and rounds that are expected.
const VERIFICATION: u64 = 3;
const ROUNDS: u64 = 7;

impl<'a> Bench<'a> {
    /// For so many points in all.
    pub(crate) fn new(args: &'a Compare, queries: Vec<Workload>, entrants: &'a mut [Entrant], points: usize) -> Self {
        let ahead = points as u64 * entrants.len() as u64 * (VERIFICATION + ROUNDS);
        let gauge = Gauge::new(ahead);
        Self { args, queries, entrants, memory: Vec::new(), gauge }
    }

    /// Verifies and measures everybody on so many of the source's points.
    pub(crate) fn case(&mut self, source: &Source, n: usize) -> Outcome<Case> {
        let points = source.points(n);
        let words = self.entrants.iter().map(|entrant| entrant.words(n)).max().unwrap_or(0);
        provide(&mut self.memory, words)?;
        let all = n as u64 * self.entrants.len() as u64;
        self.gauge.begin(format!("{}, {} points", source.name(), thousands(n)), all * (VERIFICATION + ROUNDS));
        self.gauge.step(0, all * (VERIFICATION + ROUNDS), "radius");
        let radius = match self.args.radius {
            Some(radius) => radius,
            None => radius_for(&points, self.args.neighbours(), &mut self.memory)?,
        };
        let moved = moved(&points, radius, self.args.seed());
        let question = Question { points: &points, moved: &moved, radius, k: self.args.k() };
        let shares = self.shares(&question)?;
        let (expected, verified) = self.verify(&question, &shares)?;
        let plan = Plan { shares: &shares, repeat: self.args.repeat };
        let measured = measure(self.entrants, &question, &mut self.memory, &plan, &mut self.gauge)?;
        let rounds = measured.iter().map(Measured::rounds).max();
        let contestants = self.entrants.iter().zip(measured).zip(shares);
        let mut case = Case {
            subject: Subject::Points,
            of: source.name().into(),
            about: source.about(n),
            n,
            radius,
            neighbours: Some(expected.neighbours()),
            queries: None,
            verified,
            rounds: rounds.unwrap_or(0),
            contestants: contestants
                .map(|((entrant, measured), share)| measured.contestant(entrant.name(), share.left_out))
                .collect(),
        };
        case.rank();
        Ok(case)
    }

    /// The part that everybody takes, leaving out what would take too long.
    fn shares(&mut self, question: &Question<'_>) -> Outcome<Vec<Share>> {
        let n = question.points.len();
        let rows = sample(n, TRIED, self.args.seed());
        // What is within a radius costs about the same, however it is told.
        let mut efforts = Vec::new();
        for entrant in self.entrants.iter_mut() {
            let mut contender = entrant.enter(n, &mut self.memory);
            contender.build(question.points, question.radius)?;
            efforts.push([Workload::Count, Workload::Nearest].map(|query| contender.effort(query, question, &rows)));
        }
        let limits = [0, 1].map(|i| limit(n, efforts.iter().filter_map(|effort| effort[i])));
        let share = |effort: [Option<Effort>; 2]| {
            let too_much = |i: usize| {
                let distances = effort[i].map(|effort| effort.distances * n as f64)?;
                let limit = limits[i];
                let why = format!("would compute about {distances:.0e} distances, more than {limit:.0e}");
                (distances > limit).then_some(why)
            };
            let mut queries = self.queries.clone();
            let mut left_out = too_much(0).map(|why| format!("every query {why}"));
            if left_out.is_some() {
                queries.clear();
            } else if queries.contains(&Workload::Nearest) {
                left_out = too_much(1).map(|why| format!("nearest {why}"));
                queries.retain(|query| *query != Workload::Nearest || left_out.is_none());
            }
            Share { queries, left_out }
        };
        let shares: Vec<_> = efforts.into_iter().map(share).collect();
        if shares.iter().any(Share::is_in) {
            return Ok(shares);
        }
        let why = shares.into_iter().find_map(|share| share.left_out).unwrap_or_default();
        let title = &self.gauge.title;
        Err(Failure::new(format!("{title}: nobody is left to compare: {why}; lower --n or the radius")))
    }

    /// Holds everybody's answers against an exhaustive search; says how.
    fn verify(&mut self, question: &Question<'_>, shares: &[Share]) -> Outcome<(Expected, String)> {
        let n = question.points.len();
        let turns = shares.iter().filter(|share| share.is_in()).count() as u64;
        self.gauge.step(0, n as u64 * turns * (VERIFICATION + ROUNDS), "exhaustive search");
        let (expected, asked) = self.expected(question, shares)?;
        let mut left = turns;
        for (entrant, share) in self.entrants.iter_mut().zip(shares).filter(|(_, share)| share.is_in()) {
            let name = entrant.name().to_string();
            left -= 1;
            self.gauge.step(n as u64 * VERIFICATION, n as u64 * (left * VERIFICATION + turns * ROUNDS), &name);
            let queries: Vec<_> = share.queries.iter().copied().filter(|query| asked.contains(query)).collect();
            let mut contender = entrant.enter(n, &mut self.memory);
            expected.check(contender.as_mut(), &name, question, &queries)?;
        }
        let is_peer = |(entrant, share): (&Entrant, &Share)| share.is_in() && !entrant.is_own();
        let has_peers = self.entrants.iter().zip(shares).any(is_peer);
        let rounding = if has_peers { "; other libraries up to rounding" } else { "" };
        let rows = SAMPLE.min(n);
        let verified = match n <= EXHAUSTIVE {
            true => format!("verified against an exhaustive search, all rows{rounding}"),
            false => {
                format!("verified against each other, all rows, and an exhaustive search, {rows} of them{rounding}")
            }
        };
        Ok((expected, verified))
    }

    /// The answers that everybody has to give, and to which queries.
    fn expected(&mut self, question: &Question<'_>, shares: &[Share]) -> Outcome<(Expected, Vec<Workload>)> {
        let n = question.points.len();
        let own = self.entrants.iter_mut().zip(shares).filter(|(entrant, share)| share.is_in() && entrant.is_own());
        // Who does the most; the first of these.
        let leader = own.min_by_key(|(_, share)| std::cmp::Reverse(share.queries.len()));
        match leader.filter(|_| n > EXHAUSTIVE) {
            None => Ok((Expected::exhaustive(question, &self.queries, 0..n), self.queries.clone())),
            Some((entrant, share)) => {
                let name = entrant.name().to_string();
                let mut contender = entrant.enter(n, &mut self.memory);
                let expected = Expected::by(contender.as_mut(), &name, question, &share.queries, self.args.seed())?;
                Ok((expected, share.queries.clone()))
            }
        }
    }
}

/// The number of distances that a query of all points may compute, by what everybody would.
pub(crate) fn limit(n: usize, efforts: impl Iterator<Item = Effort>) -> f64 {
    let none = Effort { distances: f64::INFINITY, found: 0.0 };
    let least = efforts.fold(none, |least, effort| Effort {
        distances: least.distances.min(effort.distances),
        found: least.found.max(effort.found),
    });
    let each = (TIMES * least.distances).min(DEAR.max(DEAR_FOUND * least.found));
    CHEAP.max(n as f64 * each).min(MOST)
}

/// All points, each a little further: up to 5 % of the radius along every axis.
pub(crate) fn moved(points: &[Vec3], radius: f32, seed: u64) -> Vec<Vec3> {
    /// Apart from the streams of made-up points.
    const EMITTER: u32 = 1 << 18;
    let step = 0.05 * radius;
    let go = |(row, point): (usize, &Vec3)| {
        let stream = Stream::new(seed, EMITTER, row as u32);
        let ([x, y], [z, _]) = (stream.units(0), stream.units(1));
        let there = *point + step * (2.0 * Vec3::new(x, y, z) - 1.0);
        if there.is_finite() { there } else { *point }
    };
    points.iter().enumerate().map(go).collect()
}
