//! A check for those who sit at a terminal.

use super::modes::How;
use super::report::{Check, Oscillations, Stand};
use super::words::{limit, plain, time};
use crate::words::{counted, thousands};
use pointmass::stability::Limit;
use std::fmt::Write;

/// The whole answer.
pub(crate) fn text(check: &Check) -> String {
    let mut text = String::new();
    for (name, value) in facts(check) {
        // Writing to a string cannot fail.
        let _ = writeln!(text, "{name:>10}  {value}");
    }
    let row = |name: &str, cells: &[String], end: &str| {
        let cells: String = cells.iter().map(|cell| format!(" {cell:>13}")).collect();
        format!("{name:18}{cells}   {end}")
    };
    let _ = writeln!(text, "\n{}", row("largest step", &heads(check), &format!("at {}", time(check.dt))));
    for stand in &check.methods {
        let mark = if stand.method == check.integrator { "*" } else { " " };
        let _ = writeln!(
            text,
            "{}",
            row(&format!("{mark} {}", stand.method), &limits(check, stand), verdict(stand).as_str())
        );
    }
    text.push('\n');
    for advice in &check.advice {
        paragraph(&mut text, "-", advice);
    }
    text
}

/// The lines on what bounds the steps; those on contacts only where there are some.
pub(crate) fn heads(check: &Check) -> Vec<String> {
    let heads = ["at rest", "every pose", "drag"].into_iter().chain(check.touching.as_ref().map(|_| "contact"));
    heads.map(str::to_string).collect()
}

/// The largest steps of a method, as `heads` names them.
pub(crate) fn limits(check: &Check, stand: &Stand) -> Vec<String> {
    let mut limits = vec![at_rest(stand), limit(stand.every_pose), limit(stand.drag)];
    limits.extend(check.touching.as_ref().map(|_| limit(stand.contact)));
    limits
}

/// What there is to know beside the table, each with its name.
pub(crate) fn facts(check: &Check) -> Vec<(&'static str, String)> {
    let Check { particles, free, springs, emitters, dt, integrator, .. } = check;
    let mut facts = vec![
        ("scene", check.scene.clone()),
        ("judged", format!("steps of {} by {integrator}", time(*dt))),
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
    facts.extend(check.oscillations.as_ref().map(|modes| ("at rest", oscillations(modes))));
    facts.extend(check.stiffest.as_ref().map(|part| ("stiffest", format!("{} {}", part.place, part.about))));
    let drag = check.dragged.as_ref();
    facts.extend(drag.map(|part| ("drag", format!("{} {}: {} /s", part.place, part.about, plain(part.mode.damping)))));
    facts.extend(
        check
            .touching
            .as_ref()
            .zip(check.hit)
            .map(|(part, hit)| ("contact", format!("{} {}; a hit lasts {}", part.place, part.about, time(hit)))),
    );
    facts.extend(check.followed.as_ref().map(|followed| {
        let (step, g) = (time(followed.step), plain(followed.acceleration));
        let bounces = counted(followed.max_bounces as usize, "bounce");
        (
            "hits",
            format!("found within 0.1 mm on paths bent by {g} m/s² up to steps of {step}; at most {bounces} a step"),
        )
    }));
    facts.extend(check.pair.as_ref().map(|pair| {
        let ([a, b], distance, period) = (pair.particles, plain(pair.distance), time(pair.period));
        ("orbits", format!("particles {a} and {b}, {distance} m apart, could circle each other in {period}"))
    }));
    facts.extend(check.sinks.iter().map(|sink| {
        let (gradient, mass, within) = (plain(sink.gradient), plain(sink.mass), time(1.0 / sink.rate));
        ("sink", format!("{}: its pull changes by {gradient} N/m; {mass} kg mixed that within {within}", sink.place))
    }));
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
    if stand.estimated { format!("about {}", limit(stand.at_rest)) } else { limit(stand.at_rest) }
}

/// What becomes of the step.
pub(crate) fn verdict(stand: &Stand) -> String {
    let grows = stand.growth_across > 0.0;
    let across = || format!("up to e-fold in {}", time(1.0 / stand.growth_across));
    match stand.every_pose {
        _ if stand.chooses_steps => "chooses its own steps".into(),
        Limit::Never if grows => format!("grows, {}", across()),
        _ if !stand.stable => "unstable".into(),
        _ if grows => format!("stable; taut springs grow, {}", across()),
        _ => "stable".into(),
    }
}

/// Words in lines that can be read, behind a mark; what follows the first line stands further in.
fn paragraph(text: &mut String, mark: &str, words: &str) {
    const WIDTH: usize = 100;
    let mut line = mark.to_string();
    for word in words.split_whitespace() {
        if line.chars().count() + 1 + word.chars().count() > WIDTH {
            let _ = writeln!(text, "{line}");
            line = " ".into();
        }
        line.push(' ');
        line.push_str(word);
    }
    let _ = writeln!(text, "{line}");
}
