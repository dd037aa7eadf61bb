//! A check, told at a terminal or on a page, and as a table.

use super::hold::Hold;
use super::modes::How;
use super::study::{Oscillations, Stand, Study};
use super::verdict::Verdict;
use super::words::{limit, plain, time};
use crate::outcome::Outcome;
use crate::report::Report;
use crate::report::plot::Chart;
use crate::report::table::{Cell, Table};
use crate::report::words::{counted, short, thousands};
use pointmass::stability::Limit;
use std::fmt::Write;

/// The meaning of the figures.
const NOTES: [&str; 9] = [
    "A step is stable while nothing that should swing or come to rest grows. It is not accurate yet.",
    "At rest: the oscillations of the springs where the scene begins, as if each had its rest length there, without gravity \
     and other forces; what only drifts is left out. Of too many to work out all, one tells what they stand at most.",
    "Every pose: the stiffness at each particle over its mass, as if all its springs pulled in one line, which no pose \
     exceeds near the springs' rest lengths. Springs that are damped more or less than others are taken at their worst.",
    "Contact: hits of balls that push each other apart give back no more energy than they take on average over how the steps fall \
     within them, within 2 %; single ones may, rk4 by 39 % near that step. Nor does a ball grow restless among as many of its size as can touch it.",
    "Goal: whoever is held by goals, with its springs and drag, in every pose.",
    "Gas: it pushes nobody farther in a step than a quarter of the radius of its mesh, 3 V / A, and answers what changes its volume within what \
     methods stand, as the scene starts.",
    "Drag: with that which grows with the speed, and viscosity, as fast and as near to each other as particles start, or as fast as they \
     fall at last. Of steps of which nothing is said but that they are not known, other forces were not looked at.",
    "Particles whose drag or mass changes over their lives are taken at their lightest, most and least braked.",
    "Taut springs pull across themselves as well, and their damping does not act there: explicit Euler and the midpoint \
     method make that grow at any step, however slowly.",
];

/// The meaning of those of constraints.
const HELD: [&str; 3] = [
    "Constraints: their stiffness, their fastest oscillation, were it alone, and by how much their own weight stretches them, \
     were they hung from what is fixed. A sub-step damps what swings in less than 2π of it, as implicit Euler does.",
    "Ropes, clusters and sheets are solved as a whole, and are at rest what they are by their numbers. What is damped is drawn out farther by what others tie to it \
     where that moves its points by more than an eighth of an edge in a sub-step: by g h² times the load over what the points weigh that bear it. Distances are met one \
     after the other: each pulls at those before it once more, by h²/m times its pull. 1 % with: the sub-step that leaves so much.",
    "A hit: what falls freely onto the scenery beneath it is stretched by up to 1.5 times its speed over that of waves of stretch in it, √(stretch / density), \
     and by up to 5 % more for each edge's length that it goes in a sub-step, 20 % with friction. All are measured; where cloth crumples by single cells it may be \
     more. What is held, but for that, is at rest the same in any sub-steps: they buy motion that does not fade.",
];

/// Tells all of it.
pub(crate) fn tell(study: &Study, charts: &[Chart<'_>], report: &mut dyn Report) -> Outcome {
    report.facts(&facts(study));
    if report.is_page() {
        report.heading(2, "What to do");
        report.list(&study.advice);
    }
    report.heading(2, "The largest steps");
    report.table(&steps(study));
    if !study.holds.is_empty() {
        report.heading(2, "What holds together");
        report.table(&holds(study));
        let notes = if report.is_page() { &HELD[..] } else { &[] };
        notes.iter().for_each(|note| report.paragraph(note));
    }
    if report.is_page() {
        report.heading(2, "Where methods are stable");
        report.charts(&charts.iter().collect::<Vec<_>>())?;
        report.heading(2, "What it means");
        NOTES.iter().for_each(|note| report.paragraph(note));
    } else {
        report.heading(2, "What to do");
        report.list(&study.advice);
    }
    Ok(())
}

/// The bounds on the steps of every method; those of contacts, goals and gas only where there are some.
fn steps(study: &Study) -> Table {
    let stands = || study.methods.iter();
    let mut table = Table::default();
    table.column("", stands().map(|stand| Cell::from(&*stand.method).best(stand.method == study.integrator)));
    table.column("at rest", stands().map(at_rest));
    table.column("every pose", stands().map(|stand| limit(stand.every_pose)));
    table.column("drag", stands().map(|stand| limit(stand.drag)));
    if study.touching.is_some() {
        table.column("contact", stands().map(|stand| limit(stand.contact)));
    }
    if study.led.is_some() {
        table.column("goal", stands().map(|stand| limit(stand.goal)));
    }
    if study.filled.is_some() {
        table.column("gas", stands().map(|stand| limit(stand.gas)));
    }
    table.words(format!("at {}", time(study.h())), stands().map(verdict));
    table
}

/// The constraints.
fn holds(study: &Study) -> Table {
    let holds = || study.holds.iter();
    let stiffness = |hold: &Hold| (!hold.leads).then(|| hold.stiffness.map_or("rigid".into(), plain));
    let gives = |hold: &Hold| (hold.gives > 0.0).then(|| short(100.0 * hold.gives));
    let mut table = Table::default();
    table.column("", holds().map(Hold::name));
    table.words("kind", holds().map(|hold| hold.kind.replace('_', " ")));
    table.column("particles", holds().map(|hold| thousands(hold.particles)));
    table.column("N/m", holds().map(stiffness));
    table.column("fastest /s", holds().map(|hold| hold.rate.map(plain)));
    table.column("gives %", holds().map(gives));
    table.column("1 % with", holds().map(|hold| limit(hold.enough())));
    table.words(format!("in {}", time(study.h())), holds().map(|hold| hold.told(study.h())));
    table
}

/// The steps for other programs.
pub(crate) fn sheet(study: &Study) -> Table {
    let stands = || study.methods.iter();
    let seconds = |limit: Limit| match limit {
        Limit::Step(step) => Cell::from(step),
        _ => super::words::limit(limit).into(),
    };
    let mut table = Table::default();
    table.column("method", stands().map(|stand| stand.method.as_str()));
    table.column("chooses_steps", stands().map(|stand| stand.chooses_steps));
    table.column("at_rest_s", stands().map(|stand| seconds(stand.at_rest)));
    table.column("estimated", stands().map(|stand| stand.estimated));
    table.column("every_pose_s", stands().map(|stand| seconds(stand.every_pose)));
    table.column("drag_s", stands().map(|stand| seconds(stand.drag)));
    table.column("contact_s", stands().map(|stand| seconds(stand.contact)));
    table.column("goal_s", stands().map(|stand| seconds(stand.goal)));
    table.column("gas_s", stands().map(|stand| seconds(stand.gas)));
    table.column("dt_s", stands().map(|_| study.dt));
    table.column("stable", stands().map(|stand| stand.stable));
    table.column("growth_across_per_s", stands().map(|stand| stand.growth_across));
    table.column("verdict", stands().map(|stand| stand.verdict.name()));
    table
}

/// All there is to know beside the table, each with its name.
fn facts(study: &Study) -> Vec<(&'static str, String)> {
    let Study { particles, free, springs, emitters, dt, substeps, integrator, .. } = study;
    let parts = match substeps {
        1 => String::new(),
        n => format!(", each in {n} sub-steps of {}", time(study.h())),
    };
    let mut facts = vec![
        ("scene", study.scene.clone()),
        ("judged", format!("steps of {} by {integrator}{parts}", time(*dt))),
        (
            "holds",
            format!(
                "{} ({} free), {}, {}",
                counted(*particles, "particle"),
                thousands(*free),
                counted(*springs, "spring"),
                counted(*emitters, "emitter")
            ),
        ),
    ];
    facts.extend(study.oscillations.as_ref().map(|modes| ("at rest", oscillations(modes))));
    facts.extend(study.stiffest.as_ref().map(|part| ("stiffest", format!("{} {}", part.place, part.about))));
    let drag = study.dragged.as_ref();
    facts.extend(drag.map(|part| ("drag", format!("{} {}: {} /s", part.place, part.about, plain(part.mode.damping)))));
    facts.extend(
        study
            .touching
            .as_ref()
            .zip(study.hit)
            .map(|(part, hit)| ("contact", format!("{} {}; a hit lasts {}", part.place, part.about, time(hit)))),
    );
    facts.extend(study.led.as_ref().map(|part| ("goal", format!("{} {}", part.place, part.about))));
    facts.extend(study.filled.as_ref().map(|part| ("gas", format!("{} {}", part.place, part.about))));
    facts.extend(study.followed.as_ref().map(|followed| {
        let (step, g) = (time(followed.step), plain(followed.acceleration));
        let bounces = counted(followed.max_bounces as usize, "bounce");
        (
            "hits",
            format!("found within 0.1 mm on paths bent by {g} m/s² up to steps of {step}; at most {bounces} a step"),
        )
    }));
    facts.extend(study.pair.as_ref().map(|pair| {
        let ([a, b], distance, period) = (pair.particles, plain(pair.distance), time(pair.period));
        ("orbits", format!("particles {a} and {b}, {distance} m apart, could circle each other in {period}"))
    }));
    facts.extend(study.sinks.iter().map(|sink| ("sink", format!("{}: {}", sink.place, sink.told()))));
    facts
}

fn oscillations(modes: &Oscillations) -> String {
    let mut text = match modes.how {
        How::Independent => format!("{} oscillations, the fastest", modes.count),
        How::Coupled => format!("{} oscillations (damping couples them), the fastest", modes.count),
        How::Extreme => "too many oscillations to work out all; the fastest alone".to_string(),
    };
    let _ = write!(text, " of {} /s", plain(modes.fastest));
    if let Some(ratio) = modes.damping_ratio {
        let _ = write!(text, ", damping ratio {}", plain(ratio));
    }
    text
}

/// The largest step at rest.
fn at_rest(stand: &Stand) -> String {
    if stand.estimated { format!("at most {}", limit(stand.at_rest)) } else { limit(stand.at_rest) }
}

/// The verdict on the step, which is the whole truth only if all forces were looked at.
fn verdict(stand: &Stand) -> String {
    let across = || format!("up to e-fold in {}", time(1.0 / stand.growth_across));
    match stand.verdict {
        Verdict::Grows => format!("grows, {}", across()),
        Verdict::Stable | Verdict::NotKnown if stand.growth_across > 0.0 => {
            format!("stable; taut springs grow, {}", across())
        }
        verdict => verdict.name().replace('_', " "),
    }
}
