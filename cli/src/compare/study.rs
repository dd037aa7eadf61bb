//! The outcome of a comparison, as every report tells it.

use super::contender::Build;
use super::workload::Workload;
use crate::report::origin::Origin;
use crate::statistics::{Summary, crossing, growth};
use serde::Serialize;

/// The points or meshes that structures are compared on.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub(crate) enum Subject {
    /// Points, which queries are asked about, one for each of them.
    Points,
    /// The triangles of a mesh, which segments are held against.
    Mesh,
}

impl Subject {
    fn choose(self, of_points: &'static str, of_mesh: &'static str) -> &'static str {
        match self {
            Self::Points => of_points,
            Self::Mesh => of_mesh,
        }
    }

    /// The name of what is sorted in.
    pub(crate) fn thing(self) -> &'static str {
        self.choose("point", "triangle")
    }

    /// Many of it.
    pub(crate) fn things(self) -> &'static str {
        self.choose("points", "triangles")
    }

    /// The unit of queries whose times and counters are told.
    pub(crate) fn query(self) -> &'static str {
        self.choose("point", "query")
    }

    /// The work that is done to find out.
    pub(crate) fn tests(self) -> &'static str {
        self.choose("distances", "triangles")
    }

    /// The name of what is looked at on the way there.
    pub(crate) fn visits(self) -> &'static str {
        self.choose("nodes", "boxes")
    }

    /// The unit that times are given in, such as `ns a point`.
    pub(crate) fn unit(self, workload: Workload) -> &'static str {
        self.choose("ns a point", if workload.is_query() { "ns a query" } else { "ns a triangle" })
    }

    /// The same of all workloads.
    pub(crate) fn units(self) -> &'static str {
        self.choose("ns a point", "ns a query, of the build in ns a triangle")
    }
}

/// A comparison.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct Study {
    /// Its origin.
    #[serde(flatten)]
    pub(crate) origin: Origin,
    /// The seed of all randomness.
    pub(crate) seed: u64,
    /// How many nearest others of points were looked for.
    pub(crate) k: usize,
    /// One for every set of points or mesh.
    pub(crate) cases: Vec<Case>,
    /// How time grows with the number of points or triangles.
    pub(crate) growth: Vec<Growth>,
    /// Where one overtakes another.
    pub(crate) crossovers: Vec<Crossover>,
    /// The advice what to use, and why.
    pub(crate) advice: Vec<Advice>,
    /// The remarks that a reader should know before believing any of it.
    pub(crate) notes: Vec<String>,
}

/// A set of points or a mesh, and all that was measured on it.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct Case {
    /// Which of the two.
    pub(crate) subject: Subject,
    /// The name of the distribution, surface, file or scene.
    pub(crate) of: String,
    /// Its description.
    pub(crate) about: String,
    /// How many points or triangles.
    pub(crate) n: usize,
    /// The radius of queries, or of balls, in the unit of the coordinates.
    pub(crate) radius: f32,
    /// How many others a point has within the radius, on average.
    pub(crate) neighbours: Option<f64>,
    /// How many queries of each kind were asked of a mesh; of points it is one for each.
    pub(crate) queries: Option<usize>,
    /// How the answers were verified.
    pub(crate) verified: String,
    /// How often everything was measured.
    pub(crate) rounds: usize,
    /// Who took part.
    pub(crate) contestants: Vec<Contestant>,
}

/// One who took part.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct Contestant {
    /// Its name.
    pub(crate) name: String,
    /// The workloads that it did not do, and why.
    pub(crate) left_out: Option<String>,
    /// How many of another library's first hits differ from ours by more than rounding.
    pub(crate) mismatches: Option<usize>,
    /// The structure that it built.
    pub(crate) build: Build,
    /// The measurements.
    pub(crate) figures: Vec<Figure>,
}

/// A measurement; times are in nanoseconds for each point, or of a mesh for each query, but for each triangle if built.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct Figure {
    /// The workload that was measured.
    pub(crate) workload: Workload,
    /// In the middle of all samples.
    pub(crate) median: f64,
    /// The least.
    pub(crate) min: f64,
    /// The interquartile range over the median.
    pub(crate) spread: f64,
    /// The median over the best contestant's.
    pub(crate) ratio: f64,
    /// True if the best cannot be told apart from it, nor from anybody between both.
    pub(crate) ties: bool,
    /// Nodes or rows of cells looked at, for each point or query; of a mesh by brute force the boxes of triangles.
    pub(crate) visits: Option<f64>,
    /// Distances computed for each point, or triangles tested for each query.
    pub(crate) tests: Option<f64>,
    /// Others, pairs or nearest found for each point, or hits for each query.
    pub(crate) found: Option<f64>,
    /// All samples, in the order in which they were taken.
    pub(crate) samples: Vec<f64>,
}

/// How a contestant's time grows with the number of points or triangles.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct Growth {
    /// The points or mesh that it is of.
    pub(crate) of: String,
    /// Doing what.
    pub(crate) workload: Workload,
    /// Who.
    pub(crate) name: String,
    /// The power of their number that its time grows with: in all, but of a mesh for each query.
    pub(crate) exponent: f64,
}

/// Where one contestant overtakes another.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct Crossover {
    /// The points or mesh that it is of.
    pub(crate) of: String,
    /// Doing what.
    pub(crate) workload: Workload,
    /// The faster of more of them.
    pub(crate) winner: String,
    /// The faster of fewer.
    pub(crate) loser: String,
    /// The sizes that were measured next to it.
    pub(crate) between: [usize; 2],
    /// Where the lines cross.
    pub(crate) at: f64,
    /// Whether the loser was the best of all at fewer, and the winner is at more.
    pub(crate) leads: bool,
}

/// A sentence of advice.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct Advice {
    /// For which points or mesh.
    pub(crate) of: String,
    /// For what; none: for all of it.
    pub(crate) workload: Option<Workload>,
    /// The structure to use.
    pub(crate) best: String,
    /// The advice and its reason.
    pub(crate) text: String,
}

/// Two medians closer than this are not told apart: what surrounds a loop, such as where it lies in memory, does as much.
pub(crate) const INDISTINCT: f64 = 0.03;

impl Figure {
    /// The figures of samples; ratio and ties are filled in once all are known.
    pub(crate) fn new(workload: Workload, samples: Vec<f64>, counters: Option<[f64; 3]>) -> Self {
        let Summary { median, min, spread } = Summary::of(&samples);
        let [visits, tests, found] = [0, 1, 2].map(|i| counters.map(|counters| counters[i]));
        Self { workload, median, min, spread, ratio: 1.0, ties: true, visits, tests, found, samples }
    }

    /// Whether two figures are closer than what their spreads leave open.
    pub(crate) fn is_like(&self, other: &Self) -> bool {
        let apart = (self.median - other.median).abs();
        apart <= self.median.min(other.median) * INDISTINCT || apart <= self.doubt().hypot(other.doubt())
    }

    /// Two standard errors of the median: of a normal distribution, each is 1.253 σ / √samples, and σ is the
    /// interquartile range over 1.349.
    fn doubt(&self) -> f64 {
        2.0 * 1.253 / 1.349 * self.spread * self.median / (self.samples.len().max(1) as f64).sqrt()
    }
}

impl Study {
    /// Its subject.
    pub(crate) fn subject(&self) -> Subject {
        self.cases.first().map_or(Subject::Points, |case| case.subject)
    }
}

impl Contestant {
    /// Its measurements, if there are any.
    pub(crate) fn figure(&self, workload: Workload) -> Option<&Figure> {
        self.figures.iter().find(|figure| figure.workload == workload)
    }
}

impl Case {
    /// The workloads that were measured, in order.
    pub(crate) fn workloads(&self) -> Vec<Workload> {
        workloads([self])
    }

    /// Who did this, the fastest first.
    pub(crate) fn ranking(&self, workload: Workload) -> Vec<(&Contestant, &Figure)> {
        let mut ranking: Vec<_> =
            self.contestants.iter().filter_map(|one| one.figure(workload).map(|figure| (one, figure))).collect();
        ranking.sort_by(|(_, a), (_, b)| a.median.total_cmp(&b.median));
        ranking
    }

    /// Holds all figures against the best. Nobody ties with it who is slower than one who does not, however much his own times vary.
    pub(crate) fn rank(&mut self) {
        for workload in self.workloads() {
            let ranking = self.ranking(workload);
            let Some(best) = ranking.first().map(|(_, figure)| (*figure).clone()) else { continue };
            let behind = ranking.iter().find(|(_, figure)| !figure.is_like(&best)).map(|(_, figure)| figure.median);
            for figure in self.contestants.iter_mut().flat_map(|one| &mut one.figures) {
                if figure.workload == workload {
                    figure.ratio = if best.median > 0.0 { figure.median / best.median } else { 1.0 };
                    figure.ties = behind.is_none_or(|behind| figure.median < behind);
                }
            }
        }
    }
}

/// Cases of the same points or mesh, by their number.
pub(crate) fn series(cases: &[Case]) -> Vec<(&str, Vec<&Case>)> {
    let mut series: Vec<(&str, Vec<&Case>)> = Vec::new();
    for case in cases {
        match series.iter_mut().find(|(of, _)| *of == case.of) {
            Some((_, cases)) => cases.push(case),
            None => series.push((&case.of, vec![case])),
        }
    }
    series.iter_mut().for_each(|(_, cases)| cases.sort_by_key(|case| case.n));
    series
}

/// Every name that takes part in any of the cases, in order.
pub(crate) fn names<'a>(cases: impl IntoIterator<Item = &'a Case>) -> Vec<&'a str> {
    let mut names: Vec<&str> = Vec::new();
    for one in cases.into_iter().flat_map(|case| &case.contestants) {
        if !names.contains(&one.name.as_str()) {
            names.push(&one.name);
        }
    }
    names
}

/// The workloads that were measured in any of the cases, in order.
pub(crate) fn workloads<'a>(cases: impl IntoIterator<Item = &'a Case>) -> Vec<Workload> {
    let contestants = cases.into_iter().flat_map(|case| &case.contestants);
    let mut workloads: Vec<_> = contestants.flat_map(|one| &one.figures).map(|figure| figure.workload).collect();
    workloads.sort_unstable();
    workloads.dedup();
    workloads
}

/// (number of points or triangles, figure) of one who took part, by number.
pub(crate) fn line<'a>(cases: &[&'a Case], name: &str, workload: Workload) -> Vec<(usize, &'a Figure)> {
    let figure = |case: &&'a Case| {
        let one = case.contestants.iter().find(|one| one.name == name)?;
        Some((case.n, one.figure(workload)?))
    };
    cases.iter().filter_map(figure).collect()
}

/// How time grows, of all who were measured on two numbers of points or triangles or more.
pub(crate) fn growths(cases: &[Case]) -> Vec<Growth> {
    let mut growths = Vec::new();
    for (of, cases) in series(cases) {
        for workload in workloads(cases.iter().copied()) {
            // As many queries of a mesh are asked whatever its size.
            let is_for_each = cases.iter().any(|case| case.subject == Subject::Mesh) && workload.is_query();
            for name in names(cases.iter().copied()) {
                let times: Vec<_> = line(&cases, name, workload)
                    .iter()
                    .map(|(n, figure)| (*n as f64, figure.median * if is_for_each { 1.0 } else { *n as f64 }))
                    .collect();
                if let Some(exponent) = growth(&times) {
                    growths.push(Growth { of: of.into(), workload, name: name.into(), exponent });
                }
            }
        }
    }
    growths
}

/// Where one overtakes another, if they can be told apart on both sides.
pub(crate) fn crossovers(cases: &[Case]) -> Vec<Crossover> {
    let mut crossovers = Vec::new();
    for (of, cases) in series(cases) {
        for workload in workloads(cases.iter().copied()) {
            for pair in cases.windows(2) {
                cross(of, workload, [pair[0], pair[1]], &mut crossovers);
            }
        }
    }
    crossovers
}

fn cross(of: &str, workload: Workload, ends: [&Case; 2], crossovers: &mut Vec<Crossover>) {
    let names = names(ends);
    let best = ends.map(|case| case.ranking(workload).first().map(|(one, _)| one.name.as_str()));
    for (i, a) in names.iter().enumerate() {
        for b in &names[i + 1..] {
            let (of_a, of_b) = (line(&ends, a, workload), line(&ends, b, workload));
            let ([(n0, a0), (n1, a1)], [(_, b0), (_, b1)]) = (&of_a[..], &of_b[..]) else { continue };
            if a0.is_like(b0) || a1.is_like(b1) {
                continue;
            }
            let at = crossing([*n0 as f64, *n1 as f64], [a0.median, a1.median], [b0.median, b1.median]);
            let (winner, loser) = if a1.median < b1.median { (a, b) } else { (b, a) };
            let leads = workload.is_query() && best == [Some(*loser), Some(*winner)];
            crossovers.extend(at.map(|at| Crossover {
                of: of.into(),
                workload,
                winner: winner.to_string(),
                loser: loser.to_string(),
                between: [*n0, *n1],
                at,
                leads,
            }));
        }
    }
}
