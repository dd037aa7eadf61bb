//! `pointmass lab`: how exact the integrators are, on reference problems or on a scene.
//!
//! `problem` says what is to be solved (`law`, `exact`: its forces and closed forms), `trial` solves it once, `reference`
//! as well as can be; `study` is what that came to, which `remark` puts into words and `report`, `sheet` and `chart` tell.

mod args;
mod chart;
mod exact;
mod law;
mod problem;
mod reference;
mod remark;
mod report;
mod sheet;
mod study;
mod trial;

pub(crate) use args::Lab;

use crate::formats::{Said, StudyFormat, json, line};
use crate::outcome::{Outcome, print};
use crate::progress::Progress;
use crate::report::origin::Origin;
use crate::report::page::Page;
use crate::report::plot;
use crate::report::terminal::Terminal;
use pointmass_files::whole::Outs;
use problem::Problem;
use study::{Bench, Case, Study, contestants};

/// Tries all methods as the arguments say. Files are written whole, at the end, or not at all.
pub(crate) fn lab(args: &Lab) -> Outcome {
    let outs = Outs::create(&args.out, &args.scene)?;
    let problems = problem::problems(args)?;
    let study = study(args, &problems)?;
    outs.write(|format| match format {
        StudyFormat::Csv => sheet::sheet(&study).csv(),
        StudyFormat::Json => json(&study),
        StudyFormat::Html => {
            Page::told("How exact are the integrators?", &study.origin, |page| report::tell(&study, args.detail, page))
        }
        StudyFormat::Svg => plot::all(&chart::charts(&study)),
    })?;
    print(&match args.report {
        Said::Text => Terminal::told(|terminal| report::tell(&study, args.detail, terminal))?,
        Said::Json => line(&study)?,
    })
}

fn study(args: &Lab, problems: &[Problem]) -> Outcome<Study> {
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
        cases.push(remark::remarked(Case::new(problem, &reference, rows)));
    }
    Ok(Study { origin: Origin::this(), cases })
}
