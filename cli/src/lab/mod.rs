//! `pointmass lab`: how exact the integrators are, on reference problems or on a scene.
//!
//! `problem` says what is to be solved (`law`, `exact`: its forces and closed forms), `trial` solves it once, `reference`
//! as well as can be; `study` is what that came to, which `remark` puts into words and `table`, `sheet`, `chart` and `page`
//! tell.

mod chart;
mod exact;
mod law;
mod page;
mod problem;
mod reference;
mod remark;
mod sheet;
mod study;
mod table;
mod trial;

pub use problem::Named;

use crate::formats::{StudyFormat, json};
use crate::progress::Progress;
use crate::whole::Outs;
use crate::words::command;
use crate::{Failure, Outcome, args, plot, print};
use problem::Problem;
use study::{Bench, Case, Study, contestants};

/// Tries all methods as the arguments say. Files are written whole, at the end, or not at all.
///
/// # Errors
/// If the scene cannot be used or a file cannot be written.
pub fn lab(args: &args::Lab) -> Outcome {
    let outs = Outs::create(&args.out, &args.scene)?;
    let problems = problem::problems(args)?;
    let study = study(args, &problems)?;
    outs.write(|format| match format {
        StudyFormat::Csv => sheet::csv(&study),
        StudyFormat::Json => json(&study),
        StudyFormat::Html => page::html(&study),
        StudyFormat::Svg => plot::all(&chart::charts(&study)),
    })?;
    match args.report {
        args::Report::Text => print(&table::text(&study, args.detail)),
        args::Report::Json => {
            let text = serde_json::to_string(&study).map_err(|error| Failure::new(error.to_string()))?;
            print(&(text + "\n"))
        }
    }
}

fn study(args: &args::Lab, problems: &[Problem]) -> Outcome<Study> {
    let contestants = contestants(&args.integrators.0);
    let mut left = (problems.len() * (contestants.len() + 1)) as u64;
    let mut progress = Progress::of_work(left);
    let mut cases = Vec::new();
    for problem in problems {
        let mut done = |what: &str| {
            left -= 1;
            progress.work(1, left, &format!("{}: {what}", problem.name));
        };
        let reference = reference::reference(problem)?;
        done("reference");
        let bench = Bench { problem, reference: &reference };
        let mut rows = Vec::new();
        for (method, steps) in &contestants {
            rows.push(bench.row(*method, *steps)?);
            done(method.name());
        }
        cases.push(Case::new(problem, &reference, rows));
    }
    progress.finish();
    Ok(Study { version: env!("CARGO_PKG_VERSION").into(), command: command(std::env::args()), cases })
}
