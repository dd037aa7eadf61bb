//! Advice what to use, and why: sentences made of measured figures.

use super::study::{Advice, Case, Contestant, Figure, Subject, line, series, workloads};
use super::workload::Workload;
use crate::report::words::{digits, thousands};

/// One sentence or two for every workload of every series of cases, about the largest; and one for all.
pub(crate) fn advise(cases: &[Case]) -> Vec<Advice> {
    let mut advice = Vec::new();
    for (of, cases) in series(cases) {
        let Some(largest) = cases.last() else { continue };
        let queries: Vec<_> =
            workloads(cases.iter().copied()).into_iter().filter(|workload| workload.is_query()).collect();
        for &workload in &queries {
            advice.extend(for_workload(of, &cases, largest, workload));
        }
        if queries.len() > 1 {
            advice.extend(all_round(of, &cases, &queries));
        }
    }
    advice
}

fn for_workload(of: &str, cases: &[&Case], largest: &Case, workload: Workload) -> Option<Advice> {
    let ranking = largest.ranking(workload);
    let (best, figure) = *ranking.first()?;
    let like: Vec<&str> =
        ranking[1..].iter().filter(|(_, other)| other.ties).map(|(other, _)| other.name.as_str()).collect();
    let next = ranking[1..].iter().find(|(_, other)| !other.ties);
    let unit = largest.subject.unit(workload);
    let mut text = match like[..] {
        [] => format!("use {}: {} {unit}", best.name, digits(figure.median)),
        [other] => format!(
            "use {} or {other}: {} {unit}, and they are within {:.0} %, which is within the spread",
            best.name,
            digits(figure.median),
            between(&ranking[..2])
        ),
        _ => format!(
            "use any of {}, {}: {} {unit}, and they are within {:.0} %, which is within the spread",
            best.name,
            like.join(", "),
            digits(figure.median),
            between(&ranking[..=like.len()])
        ),
    };
    if let Some((other, slower)) = next {
        text.push_str(&format!("; {} takes {} times as long", other.name, digits(slower.ratio)));
        text.push_str(&reason(largest.subject, (best, figure), (other, slower)));
    }
    text.push('.');
    text.push_str(&with_build(largest, workload, &best.name));
    text.push_str(&elsewhere(cases, workload, &best.name, &like));
    Some(Advice { of: of.into(), workload: Some(workload), best: best.name.clone(), text })
}

/// By how many per cent the slowest of some is slower than the fastest.
fn between(ranking: &[(&Contestant, &Figure)]) -> f64 {
    let slowest = ranking.last().map_or(1.0, |(_, figure)| figure.ratio);
    ((slowest - 1.0) * 100.0).max(1.0)
}

/// Why the first is faster than the second, by what both counted.
fn reason(subject: Subject, (best, a): (&Contestant, &Figure), (other, b): (&Contestant, &Figure)) -> String {
    let (Some(a_tests), Some(b_tests), Some(a_visits), Some(b_visits)) = (a.tests, b.tests, a.visits, b.visits) else {
        return String::new();
    };
    let (visits, tests, query) = (subject.visits(), subject.tests(), subject.query());
    let (mine, theirs) = ([a_visits, a_tests].map(digits), [b_visits, b_tests].map(digits));
    if mine == theirs {
        return format!(", though both look at {} {visits} and {} {tests} a {query}", mine[0], mine[1]);
    }
    let mut reason = format!(
        ": to find {} it looks at {} {visits} and {} {tests} a {query}, {} at {} and {}",
        digits(a.found.unwrap_or_default()),
        theirs[0],
        theirs[1],
        best.name,
        mine[0],
        mine[1]
    );
    /// More points in a cell than this are a reason of their own.
    const FULL: usize = 256;
    let fullest = |one: &Contestant| one.build.fullest.unwrap_or(0);
    if a_tests > b_tests && a_visits > b_visits {
        reason.push_str(", which is more work, but simpler");
    } else if fullest(other) > FULL && fullest(best) <= FULL {
        reason.push_str(&format!(
            ", and up to {} {} share one of its cells",
            thousands(fullest(other)),
            subject.things()
        ));
    }
    reason
}

/// Whether building changes the order, for those who ask but once.
fn with_build(case: &Case, workload: Workload, best: &str) -> String {
    // How often a mesh is asked is not known.
    if workload == Workload::Moving || case.subject == Subject::Mesh {
        return String::new();
    }
    let total = |one: &Contestant| Some(one.figure(workload)?.median + one.figure(Workload::Build)?.median);
    let mut totals: Vec<_> = case.contestants.iter().filter_map(|one| Some((total(one)?, one))).collect();
    totals.sort_by(|(a, _), (b, _)| a.total_cmp(b));
    let (Some((first, one)), Some((own, _))) = (totals.first(), totals.iter().find(|(_, one)| one.name == best)) else {
        return String::new();
    };
    if one.name == best || *own <= first * (1.0 + super::study::INDISTINCT) {
        return String::new();
    }
    let (name, first, own) = (&one.name, digits(*first), digits(*own));
    format!(" Built anew for every query, {name} comes first: {first} ns with the build, {best} {own} ns.")
}

/// Numbers of points for which another is clearly better.
fn elsewhere(cases: &[&Case], workload: Workload, best: &str, like: &[&str]) -> String {
    let mut text = String::new();
    for case in cases.iter().rev().skip(1) {
        let ranking = case.ranking(workload);
        let Some((other, _)) = ranking.first() else { continue };
        let own = ranking.iter().find(|(one, _)| one.name == best);
        let Some((_, own)) = own.filter(|(_, own)| !own.ties && !like.contains(&other.name.as_str())) else { continue };
        let (other, ratio, n, things) = (&other.name, digits(own.ratio), thousands(case.n), case.subject.things());
        text.push_str(&format!(" Of {n} {things}, {other} is {ratio} times as fast as {best}."));
    }
    text
}

/// Who is never far behind.
fn all_round(of: &str, cases: &[&Case], queries: &[Workload]) -> Option<Advice> {
    let names: Vec<&str> = cases.last()?.contestants.iter().map(|one| one.name.as_str()).collect();
    let worst = |name: &str| -> Option<f64> {
        let mut worst = 1.0f64;
        for &workload in queries {
            let line = line(cases, name, workload);
            // Who was left out somewhere is no choice for all of it.
            if line.len() < cases.len() {
                return None;
            }
            worst = line.iter().fold(worst, |worst, (_, figure)| worst.max(figure.ratio));
        }
        Some(worst)
    };
    let mut all: Vec<_> = names.iter().filter_map(|name| Some((worst(name)?, *name))).collect();
    all.sort_by(|(a, _), (b, _)| a.total_cmp(b));
    let (ratio, best) = *all.first()?;
    let text = match ratio <= 1.0 + super::study::INDISTINCT {
        true => format!("{best} is the best or as good as the best in every query."),
        false => {
            let next = all.get(1).map_or(String::new(), |(ratio, name)| format!(" (next: {name}, {})", digits(*ratio)));
            format!("if one has to do for all of this, {best}: never more than {} times the best{next}.", digits(ratio))
        }
    };
    Some(Advice { of: of.into(), workload: None, best: best.into(), text })
}
