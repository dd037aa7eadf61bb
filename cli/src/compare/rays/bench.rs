//! The bench on which tracers meet: one mesh after the other, first verified, then measured.

use super::super::args::Compare;
use super::super::contender::provide;
use super::super::gauge::Gauge;
use super::super::measure::{Measured, take_turns, times};
use super::super::stopwatch::Stopwatch;
use super::super::study::{Case, Subject};
use super::super::workload::Workload;
use super::query::{Query, ball};
use super::surface::Surface;
use super::tracer::{Answers, Entrant};
use super::verify::Expected;
use crate::outcome::{Failure, Outcome};
use crate::report::words::{digits, thousands};
use pointmass::shape::Mesh;

/// About how many triangles brute force tests for a kind of segments in a round, and for how many segments at the least.
const TESTS: usize = 20_000_000;
const FEWEST: usize = 50;

/// Rounds that are expected, and verification as one more.
const ROUNDS: usize = 8;

/// The state that all cases share.
pub(crate) struct Bench<'a> {
    args: &'a Compare,
    entrants: &'a mut [Entrant],
    /// Lent to one structure after the other.
    memory: Vec<u32>,
    gauge: Gauge,
}

/// The task of the entrants.
struct Task<'a> {
    mesh: Mesh<'a>,
    queries: &'a [Query],
    expected: Expected,
    /// The number of segments of each kind that an entrant is asked.
    asked: Vec<usize>,
}

impl<'a> Bench<'a> {
    /// For so many meshes.
    pub(crate) fn new(args: &'a Compare, entrants: &'a mut [Entrant], meshes: usize) -> Self {
        let gauge = Gauge::new((meshes * ROUNDS * entrants.len()) as u64);
        Self { args, entrants, memory: Vec::new(), gauge }
    }

    /// Verifies and measures everybody on a mesh.
    pub(crate) fn case(&mut self, surface: &Surface) -> Outcome<Case> {
        let mesh = surface.mesh.view();
        let n = mesh.triangles().len();
        let words = self.entrants.iter().map(|entrant| entrant.words(n)).max().unwrap_or(0);
        provide(&mut self.memory, words)?;
        self.gauge
            .begin(format!("{}, {} triangles", surface.name, thousands(n)), (ROUNDS * self.entrants.len()) as u64);
        let radius = ball(surface, self.args.radius);
        let queries = Query::all(surface, self.args.segments(), Some(radius), self.args.seed());
        let (task, verified) = self.verified(mesh, &queries)?;
        let mismatches = self.mismatches(&task)?;
        let measured = self.measure(&task)?;
        let rounds = measured.iter().map(Measured::rounds).max().unwrap_or(0);
        let mut contestants = Vec::new();
        for (i, measured) in measured.into_iter().enumerate() {
            let (all, asked) = (self.args.segments(), task.asked[i]);
            let left_out =
                (asked < all).then(|| format!("all but {} of {} segments", thousands(asked), thousands(all)));
            let mut one = measured.contestant(self.entrants[i].name(), left_out);
            one.mismatches = mismatches[i];
            contestants.push(one);
        }
        let mut case = Case {
            subject: Subject::Mesh,
            of: surface.name.clone(),
            about: about(surface, &task),
            n,
            radius,
            neighbours: None,
            queries: Some(self.args.segments()),
            verified,
            rounds,
            contestants,
        };
        case.rank();
        Ok(case)
    }

    /// The task of everybody, which our structures have solved; and how that was verified.
    fn verified<'t>(&mut self, mesh: Mesh<'t>, queries: &'t [Query]) -> Outcome<(Task<'t>, String)> {
        let n = mesh.triangles().len();
        let fewer = (TESTS / n).max(FEWEST).min(self.args.segments());
        let asked: Vec<_> =
            self.entrants.iter().map(|entrant| if entrant.is_brute() { fewer } else { self.args.segments() }).collect();
        // Brute force leads only where it is alone.
        let own = (0..asked.len()).filter(|&i| self.entrants[i].is_own());
        let Some(leader) = own.max_by_key(|&i| (asked[i], std::cmp::Reverse(i))) else {
            return Err(Failure::new("nobody is left to compare; name a structure"));
        };
        let (expected, judged) = {
            let name = self.entrants[leader].name().to_string();
            let (tracer, _) = self.entrants[leader].build(mesh, &mut self.memory, 1)?;
            Expected::by((&*tracer, &name), mesh, queries, asked[leader], self.args.seed())?
        };
        for (i, entrant) in self.entrants.iter_mut().enumerate().filter(|(i, _)| *i != leader) {
            let name = entrant.name().to_string();
            if entrant.is_own() {
                let (tracer, _) = entrant.build(mesh, &mut self.memory, 1)?;
                expected.check(&*tracer, &name, queries, asked[i])?;
            }
        }
        let judged = thousands(judged);
        let verified = format!("verified against each other, all segments, and every triangle, {judged} of each kind");
        Ok((Task { mesh, queries, expected, asked }, verified))
    }

    /// The number of answers of other libraries that are no rounding.
    fn mismatches(&mut self, task: &Task<'_>) -> Outcome<Vec<Option<usize>>> {
        let mut all = vec![None; self.entrants.len()];
        for (entrant, unlike) in self.entrants.iter_mut().zip(&mut all).filter(|(entrant, _)| !entrant.is_own()) {
            let name = entrant.name().to_string();
            let (tracer, _) = entrant.build(task.mesh, &mut self.memory, 1)?;
            *unlike = Some(task.expected.unlike(&*tracer, &name, task.queries)?);
        }
        Ok(all)
    }

    /// The clock.
    fn measure(&mut self, task: &Task<'_>) -> Outcome<Vec<Measured>> {
        let mut measured = vec![Measured::default(); self.entrants.len()];
        let mut answers = Answers::default();
        let (n, players) = (task.mesh.triangles().len(), (0..self.entrants.len()).collect::<Vec<_>>());
        take_turns(&players, self.args.repeat, |at, left| {
            let (entrant, measured, asked) = (&mut self.entrants[at], &mut measured[at], task.asked[at]);
            self.gauge.step(1, left as u64, entrant.name());
            let (tracer, took) = entrant.build(task.mesh, &mut self.memory, times(n))?;
            measured.add(Workload::Build, took.as_secs_f64() * 1e9 / n as f64, None);
            measured.build = tracer.built();
            for (i, query) in task.queries.iter().enumerate() {
                let times = times(asked);
                let begun = Stopwatch::start();
                let answered = (0..times).all(|_| tracer.trace(query, asked, &mut answers));
                let took = begun.elapsed().as_secs_f64() * 1e9 / (asked * times) as f64;
                if answered {
                    let each = |count: u64| count as f64 / asked as f64;
                    // The same in every round.
                    let is_new = measured.series.iter().all(|(known, ..)| *known != query.workload);
                    let cost = if is_new { tracer.cost(query, asked) } else { None };
                    let counters = cost.map(|cost| [each(cost.visits), each(cost.tests), task.expected.hits(i)]);
                    measured.add(query.workload, took, counters);
                }
            }
            Ok(())
        })?;
        Ok(measured)
    }
}

/// The mesh in words, and the share of segments of each kind that hit it.
fn about(surface: &Surface, task: &Task<'_>) -> String {
    let hit =
        |(i, query): (usize, &Query)| format!("{:.0} % of {}", task.expected.hits(i) * 100.0, query.workload.name());
    let hits: Vec<_> = task.queries.iter().enumerate().map(hit).collect();
    format!("{}; {} across; {} segments hit", surface.about, digits(f64::from(surface.size)), hits.join(", "))
}
