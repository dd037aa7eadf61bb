//! The summary of a run, for people and for programs.

use super::groups::GroupError;
use crate::report::words::counted;
use crate::substeps::{MOST, Told};
use crate::world::World;
use pointmass::force::Entry;
use pointmass::{Books, Caps, Energy, Measures, Report};
use pointmass_files::instant::nanoseconds;
use serde::Serialize;
use std::fmt::Write;

/// The summary of a run. Times are in seconds of the scene, except `seconds`, which people had to wait.
#[derive(Debug, Serialize)]
pub(crate) struct Summary {
    /// The scene's file.
    pub(crate) scene: String,
    /// The method.
    pub(crate) integrator: String,
    /// The step \[s\].
    pub(crate) dt: f64,
    /// The seed.
    pub(crate) seed: u64,
    /// Steps made.
    pub(crate) steps: u64,
    /// How long the last of them was \[s\].
    #[serde(skip)]
    pub(crate) last: f64,
    /// The instant reached \[s\].
    pub(crate) time: f64,
    /// The division of steps.
    pub(crate) substeps: Told,
    /// Particles alive at the end.
    pub(crate) live: u64,
    /// The totals of what has happened.
    #[serde(flatten)]
    pub(crate) totals: Report,
    /// Errors of sums over far groups against all pairs, if that was asked.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) group_errors: Option<Vec<GroupError>>,
    /// The ledger of energy, if it was kept.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) ledger: Option<Books>,
    /// Energy and momenta at the end.
    #[serde(flatten)]
    pub(crate) measures: Measures,
    /// Energy and power of every force at the end.
    pub(crate) forces: Vec<Entry>,
    /// The state's fingerprint.
    pub(crate) hash: String,
    /// Time it took \[s\].
    pub(crate) seconds: f64,
    /// Time it took for each particle and step \[ns\].
    pub(crate) ns_per_particle_step: f64,
}

/// Effort spent on a run.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Effort {
    /// Steps made.
    pub(crate) steps: u64,
    /// Particles alive, summed over all steps.
    pub(crate) particle_steps: u64,
    /// Time spent stepping \[s\].
    pub(crate) seconds: f64,
}

impl Summary {
    /// Sums up the world as it is.
    pub(crate) fn of(scene: &std::path::Path, world: &World, last: f64, effort: Effort) -> Self {
        Self {
            scene: crate::load::name(scene).into_owned(),
            integrator: world.integrator().to_string(),
            dt: world.dt,
            seed: world.system.seed(),
            steps: effort.steps,
            last,
            time: nanoseconds(world.system.time().seconds_f64()),
            substeps: world.pace.told(),
            live: world.system.len() as u64,
            totals: *world.system.totals(),
            group_errors: None,
            ledger: None,
            measures: Measures::of(&world.system, &world.model.scene()),
            forces: Measures::by_force(&world.system, &world.model.scene()),
            hash: format!("{:016x}", world.system.hash()),
            seconds: effort.seconds,
            ns_per_particle_step: match effort.particle_steps {
                0 => 0.0,
                steps => effort.seconds * 1e9 / steps as f64,
            },
        }
    }

    /// The number of steps and their lengths, in words.
    fn lengths(&self) -> String {
        /// The share of a last step that rounding makes up.
        const ROUNDING: f64 = 1e-6;
        let (steps, dt, last) = (self.steps, self.dt, self.last);
        let is_whole = (dt - last).abs() <= ROUNDING * dt;
        match steps {
            1 => format!("1 step of {:.6} s", if is_whole { dt } else { last }),
            0 => format!("0 steps of {dt:.6} s"),
            _ if is_whole => format!("{steps} steps of {dt:.6} s"),
            _ => format!("{steps} steps of {dt:.6} s, the last of {last:.6} s,"),
        }
    }

    /// A page for people.
    pub(crate) fn text(&self) -> String {
        let Report { initial, born, died, refused, hits, contacts, broken, caps, effort } = &self.totals;
        let Measures { energy: Energy { kinetic, potential }, momentum, angular_momentum } = self.measures;
        let mut rows: Vec<(&str, String)> = vec![
            ("scene", self.scene.clone()),
            ("run", format!("{} by {}, seed {}", self.lengths(), self.integrator, self.seed)),
            ("time", format!("{} s", self.time)),
        ];
        rows.extend(substeps(&self.substeps, self.steps).map(|told| ("sub-steps", told)));
        rows.push((
            "particles",
            format!("{initial} at first + {born} born = {} live + {} died", self.live, died.total()),
        ));
        let died = [
            ("of age", died.lifetime),
            ("at sinks", died.sink),
            ("of crowding", died.density),
            ("by chance", died.chance),
            ("by the program's own rule or hand", died.other),
            ("no longer finite", died.nonfinite),
        ];
        push_counts(&mut rows, "died", &died);
        push_counts(&mut rows, "refused", &[("found no room; raise --capacity", *refused)]);
        push_counts(&mut rows, "hits", &[("", *hits)]);
        push_counts(&mut rows, "contacts", &[("", *contacts)]);
        push_counts(&mut rows, "broken", &[("springs", *broken)]);
        let Caps {
            bounces,
            chords,
            springs,
            contacts,
            stalled,
            graphs,
            edges,
            crushed,
            degenerate,
            outside,
            insufficient_memory,
        } = *caps;
        let caps = [
            ("paths with too many bounces", bounces),
            ("paths with too many chords", chords),
            ("springs without an end", springs),
            ("contacts without room", contacts),
            ("steps of particles lost to rounding", stalled),
            ("solutions of shells without graphs", graphs),
            ("solutions of shells that may have left edges too long", edges),
            ("pieces of shells that walls crush and that stayed where they were", crushed),
            ("triangles, folds and edges without extent, which do nothing", degenerate),
            ("births on the surface of what they should lie in", outside),
            ("steps that did not fit", insufficient_memory),
        ];
        push_counts(&mut rows, "bounds met", &caps);
        rows.push(("effort", method_effort(effort)));
        rows.push((
            "energy",
            format!("{} J kinetic, {} J potential{}", number(kinetic), number(potential), parts(&self.forces)),
        ));
        rows.extend(self.group_errors.iter().map(|errors| ("groups", far(errors))));
        rows.extend(self.ledger.iter().flat_map(accounts));
        rows.push(("momentum", vector(momentum, "kg m/s")));
        rows.push(("angular", vector(angular_momentum, "kg m²/s")));
        rows.push(("hash", self.hash.clone()));
        let pace = self.ns_per_particle_step;
        rows.push(("took", format!("{:.3} s, {pace:.1} ns a particle and step", self.seconds)));
        let mut text = String::new();
        for (name, value) in rows {
            // Writing to a string cannot fail.
            let _ = writeln!(text, "{name:>10}  {value}");
        }
        text
    }
}

/// The work of the method, in words.
fn method_effort(effort: &pointmass::Effort) -> String {
    let pointmass::Effort {
        evaluations,
        lists,
        streamed,
        all_pairs,
        accepted,
        rejected,
        solves,
        iterations,
        residual,
        capped,
    } = *effort;
    let mut text = format!("{evaluations} evaluations of all forces");
    let ways = [("listed", lists), ("looked up without a list", streamed), ("sought among all pairs", all_pairs)];
    let ways: Vec<_> = ways.iter().filter(|way| way.1 > 0).map(|(how, times)| format!("{how} {times} times")).collect();
    if !ways.is_empty() {
        text.push_str(&format!(" (neighbours {})", ways.join(", ")));
    }
    if accepted > 0 {
        text.push_str(&format!(", {accepted} inner steps and {rejected} that erred too much"));
    }
    if solves > 0 {
        let mean = iterations as f64 / solves as f64;
        text.push_str(&format!(", {mean:.1} iterations for each of {solves} solutions, residual {residual:.1e}"));
    }
    if capped > 0 {
        text.push_str(&format!("; cut short {capped} times"));
    }
    text
}

/// The books, a row an entry; what is nothing is left out.
fn accounts(books: &Books) -> Vec<(&'static str, String)> {
    let Books { opening, emission, restitution, friction, constraints, scenery, breaking, .. } = *books;
    let Books { deletion, outside, remainder, closing, .. } = *books;
    let mut entries = vec![("at first", opening), ("born", emission)];
    entries.extend(books.work.iter().copied());
    entries.extend([
        ("lost in hits", restitution),
        ("friction", friction),
        ("constraints", constraints),
        ("moving scenery", scenery),
        ("springs that broke", breaking),
        ("died", deletion),
        ("from outside", outside),
        ("error of the method", remainder),
    ]);
    entries.retain(|&(_, joules)| joules != 0.0);
    entries.push(("at last", closing));
    let row = |(i, (name, joules)): (usize, (&str, f64))| {
        let sign = if joules > 0.0 { "+" } else { "" };
        (if i == 0 { "ledger" } else { "" }, format!("{:>16} J  {name}", format!("{sign}{}", number(joules))))
    };
    entries.into_iter().enumerate().map(row).collect()
}

/// Errors of sums over far groups against all pairs, in words.
fn far(errors: &[GroupError]) -> String {
    let told = errors.iter().map(|error| {
        let GroupError { force, theta, rms, largest, particles } = error;
        format!(
            "{force} at theta {theta} errs by {rms:.1e} (root mean square of {particles}), {largest:.1e} at the most"
        )
    });
    if errors.is_empty() { "no force takes far groups as one".into() } else { told.collect::<Vec<_>>().join("; ") }
}

/// The parts of the potential energy, if it is more than one force's.
fn parts(forces: &[Entry]) -> String {
    let parts: Vec<_> = forces.iter().filter(|entry| entry.energy != 0.0).collect();
    if parts.len() < 2 {
        return String::new();
    }
    let told: Vec<_> = parts.iter().map(|entry| format!("{} {}", entry.name, number(entry.energy))).collect();
    format!(" ({})", told.join(", "))
}

/// The division of steps, in words, if they were divided.
fn substeps(told: &Told, steps: u64) -> Option<String> {
    let Told { least, most, total, beyond, farthest, tolerance, .. } = *told;
    if most <= 1 {
        return None;
    }
    let mean = total as f64 / steps as f64;
    let mut text = if least == most {
        format!("{most} a step")
    } else {
        format!("{least} to {most} a step, {mean:.1} on average")
    };
    if let Some(tolerance) = tolerance {
        text.push_str(&format!(", chosen to end within {tolerance:.1e} m"));
    }
    if beyond > 0 {
        let steps = counted(beyond as usize, "step");
        let far = match farthest.is_finite() {
            true => format!("the worst by about {farthest:.1e} m"),
            false => "and somebody is no longer finite".into(),
        };
        text.push_str(&format!(
            "; but {steps} may be farther off, {far}: {MOST} is the most, and after hits more may not help"
        ));
    }
    Some(text)
}

/// Adds a row with those counts that are not zero, if there are any.
fn push_counts<'a>(rows: &mut Vec<(&'a str, String)>, name: &'a str, counts: &[(&str, u64)]) {
    let told: Vec<_> =
        counts.iter().filter(|&&(_, n)| n > 0).map(|(what, n)| format!("{n} {what}").trim_end().to_string()).collect();
    if !told.is_empty() {
        rows.push((name, told.join(", ")));
    }
}

fn vector([x, y, z]: [f64; 3], unit: &str) -> String {
    format!("({}, {}, {}) {unit}", number(x), number(y), number(z))
}

/// A number with six decimals, or with an exponent where that would be too long or leave next to nothing.
fn number(x: f64) -> String {
    if x == 0.0 || (1e-3..1e9).contains(&x.abs()) { format!("{:.6}", x + 0.0) } else { format!("{x:.6e}") }
}
