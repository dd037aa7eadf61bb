//! Advice on what to change.

use super::contact::STEPS;
use super::hold::{FAULT, Hold};
use super::part::place;
use super::study::{Stand, Study};
use super::words::{plain, time};
use crate::report::words::{counted, short};
use pointmass::Spring;
use pointmass::scene::Model;
use pointmass::stability::Limit;

/// Steps that an orbit should have at least, and parts of a sink's time.
const ORBIT: f64 = 50.0;
const PULL: f64 = 10.0;

/// The changes to make, the most urgent first; or that nothing has to be.
pub(crate) fn advise(check: &Study, model: &Model) -> Vec<String> {
    let Some(stand) = check.methods.iter().find(|stand| stand.method == check.integrator) else { return Vec::new() };
    let mut advice = Vec::new();
    match stand.every_pose.and(stand.drag).and(stand.contact).and(stand.goal).and(stand.gas) {
        _ if stand.chooses_steps => advice.push(format!("{} chooses its own steps", stand.method)),
        limit if limit.admits(check.h()) => advice.push(fine(check, limit)),
        Limit::Step(limit) => advice.extend(too_long(check, stand, limit)),
        _ => advice.push(never(check, model, stand)),
    }
    advice.extend(check.born.clone());
    advice.extend(damping(check, model));
    advice.extend(taut(check, stand));
    advice.extend(check.holds.iter().filter_map(|hold| held(check, hold)));
    advice.extend(check.holds.iter().filter_map(|hold| fallen(check, hold)));
    advice.extend(check.holds.iter().filter_map(|hold| shorter(check, hold.tumbling(check.h()))));
    advice.extend(check.holds.iter().filter_map(|hold| shorter(check, hold.trembling(check.h()))));
    advice.extend(world(check));
    advice
}

fn fine(check: &Study, limit: Limit) -> String {
    let (step, method) = (time(check.h()), &check.integrator);
    let others = check.not_judged.join(", ");
    match limit {
        Limit::Step(limit) => {
            let part = plain(100.0 * check.h() / limit);
            let but = if others.is_empty() { String::new() } else { format!(" but for {others}") };
            let text =
                format!("steps of {step} by {method} are stable{but}: {part} % of the largest that is in every pose");
            match check.h() > 0.5 * limit {
                true => format!("{text}; stable is not accurate, --substeps auto takes care of both"),
                false => text,
            }
        }
        _ if others.is_empty() => {
            format!(
                "neither springs nor drag nor contacts nor goals nor gas limit the step of {method}: {step} or any other"
            )
        }
        _ => format!(
            "neither springs nor drag nor contacts nor goals nor gas limit the step of {method}, but others do: whether {step} are \
             stable is not known"
        ),
    }
}

fn too_long(check: &Study, stand: &Stand, limit: f64) -> Vec<String> {
    let parts = (check.h() / limit).ceil();
    let step = time(check.h());
    let mut advice = vec![
        match stand.at_rest.and(stand.drag).admits(check.h()) {
            true if !stand.contact.admits(check.h()) => {
                format!("steps of {step} by {} are too long for contacts by force: hits add energy", stand.method)
            }
            true if !stand.gas.admits(check.h()) => {
                format!("steps of {step} by {} are too long for gas: it throws its mesh about", stand.method)
            }
            true if stand.every_pose.admits(check.h()) => {
                format!(
                    "steps of {step} by {} are too long for goals: whoever they hold swings ever wider",
                    stand.method
                )
            }
            true => format!("steps of {step} by {} are not stable in every pose: they may explode", stand.method),
            // What is braked so much may be slower or farther apart after a step, and stand the next.
            false if !check.judged_at_start.is_empty() => {
                format!("steps of {step} by {} are too long for how the scene starts: they may explode", stand.method)
            }
            false => format!("steps of {step} by {} explode", stand.method),
        },
        format!(
            "take --dt {} or less, or --substeps {parts} to keep the step, or --substeps auto for accuracy as well",
            check.typed(limit)
        ),
    ];
    let others: Vec<_> = check.methods.iter().filter(|other| other.stable && other.growth_across <= 0.0).collect();
    if !others.is_empty() {
        let names = others.iter().map(|other| other.method.as_str()).collect::<Vec<_>>().join(", ");
        advice.push(format!("or another --integrator that stands this step: {names}"));
    }
    advice
}

/// The advice on a method without any stable step, or on a scene that drives itself.
fn never(check: &Study, model: &Model, stand: &Stand) -> String {
    let drives = |spring: &&Spring| spring.ks < 0.0 || spring.kd < 0.0;
    if let Some(i) = model.springs.iter().position(|spring| drives(&spring)) {
        let place = place(model, 1, i);
        return format!("{place} has a stiffness or damping below zero: it adds energy, and no step is stable");
    }
    let is_pushed = model.particles.iter().any(|particle| !particle.fixed && particle.drag < 0.0);
    if is_pushed || model.springs.is_empty() || check.dragged.is_none() && stand.growth_across <= 0.0 {
        return "drag below zero adds energy, and no step is stable".into();
    }
    let grows = time(1.0 / stand.growth_across);
    format!(
        "{} makes what nothing damps grow at any step, at this one e-fold in {grows} or more; take symplectic, verlet or \
         rk4, or give {} and its like a kd",
        stand.method,
        place(model, 1, model.springs.iter().position(|spring| spring.kd == 0.0).unwrap_or(0))
    )
}

/// Damping beyond the critical costs steps and does not calm any faster.
fn damping(check: &Study, model: &Model) -> Option<String> {
    let part = check.stiffest.as_ref()?;
    let ratio = 0.5 * part.mode.damping / part.mode.omega2.sqrt();
    if !(ratio > 1.5 && ratio.is_finite()) {
        return None;
    }
    let kd = f64::from(model.springs.get(part.spring?)?.kd) / ratio;
    Some(format!(
        "{} is damped {} times as much as stops it fastest; with kd {} it would calm sooner and stand longer steps",
        part.place,
        plain(ratio),
        plain(kd)
    ))
}

fn taut(check: &Study, stand: &Stand) -> Option<String> {
    let is_worth_saying = stand.growth_across > 0.0 && stand.every_pose.admits(check.h()) && !stand.chooses_steps;
    is_worth_saying.then(|| {
        format!(
            "under tension, springs also swing across themselves, which only drag damps: {} makes that grow, at this step up \
             to e-fold in {}",
            stand.method,
            time(1.0 / stand.growth_across)
        )
    })
}

/// Advice about constraints that are off by much.
fn held(check: &Study, hold: &Hold) -> Option<String> {
    let warning = hold.warning(check.h())?;
    let Limit::Step(enough) = hold.largest_step() else { return None };
    Some(format!("{warning}: {}", cut(check, enough)))
}

/// Advice on how to get sub-steps of so long \[s\]; scenes cut steps into a thousand at the most.
fn cut(check: &Study, enough: f64) -> String {
    const MOST: f64 = 1000.0;
    let parts = (check.dt / enough).ceil();
    match parts <= MOST {
        true => format!("let the scene cut its steps into {parts} (`run.substeps`)"),
        false => format!("take --dt {} or less", check.typed(enough)),
    }
}

/// Advice about what takes shorter sub-steps than these.
fn shorter(check: &Study, warned: Option<(String, f64)>) -> Option<String> {
    let (warning, enough) = warned?;
    Some(format!("{warning}: {}", cut(check, enough)))
}

/// Advice about sheets that sub-steps stretch by much where they fall.
fn fallen(check: &Study, hold: &Hold) -> Option<String> {
    let fall = hold.fall.filter(|fall| check.h() > fall.step(FAULT) * (1.0 + 1e-6))?;
    let more = fall.fault(check.h()).map_or("far more".into(), |share| format!("{} % more", short(100.0 * share)));
    let (name, speed, now) = (hold.name(), plain(fall.speed), time(check.h()));
    let parts = (check.dt / fall.step(FAULT) * (1.0 - 1e-6)).ceil();
    Some(format!(
        "where {name} hits at up to {speed} m/s, sub-steps of {now} may stretch it by {more} than its material gives for a moment; \
         1 % with {parts} of them (`run.substeps`)"
    ))
}

fn world(check: &Study) -> Vec<String> {
    let mut advice = Vec::new();
    if !check.not_judged.is_empty() {
        advice.push(format!(
            "not looked at: {}, which limit the step as well; see whether half of it changes what happens, or take \
             --substeps auto",
            check.not_judged.join(", ")
        ));
    }
    if !check.judged_at_start.is_empty() {
        advice.push(format!(
            "judged by how fast and how near to each other particles start, in the winds of the first 8 s: {}; where they become \
             faster or nearer, the step has to be shorter, and --substeps auto makes it so",
            check.judged_at_start.join(" and ")
        ));
    }
    if let Some(followed) = check.followed.as_ref().filter(|followed| check.dt > followed.step) {
        advice.push(format!(
            "steps longer than {} bend too much for their hits to be found within 0.1 mm",
            time(followed.step)
        ));
    }
    if let Some(hit) = check.hit.filter(|hit| check.h() * STEPS > *hit) {
        advice.push(format!(
            "a hit lasts {}: take --dt {} or less for ten steps in it, as many as its bounce takes to be right",
            time(hit),
            check.typed(0.1 * hit)
        ));
    }
    if let Some(pair) = check.pair.as_ref().filter(|pair| check.h() * ORBIT > pair.period) {
        let [a, b] = pair.particles;
        advice.push(format!(
            "particles {a} and {b} would circle each other in {}: take --dt {} or less for {ORBIT} steps a round",
            time(pair.period),
            check.typed(pair.period / ORBIT)
        ));
    }
    let quick = || check.sinks.iter().filter(|sink| check.h() * sink.rate * PULL > std::f64::consts::TAU);
    if let Some(sink) = quick().reduce(|a, b| if b.rate > a.rate { b } else { a }) {
        let others = match quick().count() - 1 {
            0 => String::new(),
            n => format!(", and no faster near {}", counted(n, "other")),
        };
        advice.push(sink.without_bound().unwrap_or_else(|| {
            format!(
                "near {}, the pull changes within {}{others}: take --dt {} or less",
                sink.place,
                time(1.0 / sink.rate),
                check.typed(std::f64::consts::TAU / (PULL * sink.rate))
            )
        }));
    }
    advice
}
