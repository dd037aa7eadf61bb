//! `pointmass check`: which steps a scene stands, what limits them, and what to change.
//!
//! `body` is whoever there may be, with the extremes of its `life` and what brakes it at the `onset`. `net` makes matrices of the springs, `modes` and `verlet`
//! work out their oscillations at rest, `bounds` what holds in every pose, `contact` and `hit` what touching balls ask for,
//! `goal` what goals do, `statics` how hard links are pulled, `fall` how hard sheets hit, `hold` what constraints do, `pull` what sinks do, `world` what else has a time of its own;
//! `study` is what it came to, with a `verdict` on each method, which `advice` puts into words, and `report` and `plot` tell.

mod advice;
mod bodies;
mod body;
mod bounds;
mod contact;
mod fall;
mod gas;
mod goal;
mod hit;
mod hold;
mod life;
mod modes;
mod net;
mod onset;
mod part;
mod plot;
mod pull;
mod report;
mod statics;
mod study;
#[cfg(test)]
mod tests;
mod verdict;
mod verlet;
mod words;
mod world;

pub(crate) use bounds::Bounds;

use crate::formats::{Said, StudyFormat, json, line, named};
use crate::load::{self, Reading};
use crate::outcome::{Outcome, print};
use crate::parse::step;
use crate::report::origin::Origin;
use crate::report::page::Page;
use crate::report::plot::all;
use crate::report::terminal::Terminal;
use crate::stall;
use modes::Spectrum;
use plot::Scenery;
use pointmass::Method;
use pointmass_files::whole::Outs;
use std::path::PathBuf;
use study::Study;

/// Arguments of `check`.
#[derive(Debug, clap::Args)]
pub(crate) struct Check {
    /// The scene: .json or .scn, or - for standard input
    pub(crate) scene: PathBuf,
    /// How the scene is read.
    #[command(flatten)]
    pub(crate) reading: Reading,
    /// The step in seconds that is judged, such as 0.001 or 1/60; by default what the scene says, 1/60 for .scn
    #[arg(long, value_name = "S", allow_hyphen_values = true, value_parser = step)]
    pub(crate) dt: Option<f64>,
    /// The method that is advised on, any that `run` knows; by default what the scene says, rk4 for .scn
    #[arg(long, value_name = "NAME")]
    pub(crate) integrator: Option<Method>,
    /// Write the findings into FILE: .html, a page with charts of where methods are stable and where the scene's
    /// oscillations lie; .svg, the charts; .csv or .json, all figures; may be given several times
    #[arg(long, value_name = "FILE", visible_alias = "plot", value_parser = named::<StudyFormat>)]
    pub(crate) out: Vec<(PathBuf, StudyFormat)>,
    /// How to say it on standard output
    #[arg(long, value_enum, default_value_t = Said::Text)]
    pub(crate) report: Said,
}

/// Checks a scene as the arguments say. Files are written whole, at the end, or not at all.
pub(crate) fn check(args: &Check) -> Outcome {
    let (mut file, source) = load::scene_with(&args.scene, args.reading.unknown(), |dt| args.dt.unwrap_or(dt))?;
    let run = &mut file.run;
    run.integrator = args.integrator.unwrap_or(run.integrator);
    run.dt = args.dt.unwrap_or(run.dt);
    let model = source.model(&file)?;
    let outs = Outs::create(&args.out, [&args.scene])?;
    let (mut study, spectra) = Study::of(&args.scene, &model, &file.run);
    study.advice = advice::advise(&study, &model);
    study.advice.extend(stall::foreseen(&model, file.run.dt, file.run.duration));
    let charts = scenery(&study, spectra, model.integrator.method).charts();
    outs.write(|format| match format {
        StudyFormat::Csv => report::sheet(&study).csv(),
        StudyFormat::Json => json(&study),
        StudyFormat::Html => Page::told("Which step?", &Origin::this(), |page| report::tell(&study, &charts, page)),
        StudyFormat::Svg => all(&charts),
    })?;
    print(&match args.report {
        Said::Text => Terminal::told(|terminal| report::tell(&study, &charts, terminal))?,
        Said::Json => line(&study)?,
    })
}

/// The oscillations that pictures show.
fn scenery(study: &Study, spectra: Vec<Spectrum>, method: Method) -> Scenery {
    let modes = spectra.into_iter().flat_map(|spectrum| spectrum.modes);
    let parts =
        [&study.dragged, &study.touching, &study.led, &study.filled].into_iter().flatten().map(|part| part.mode);
    Scenery { modes: modes.chain(parts).collect(), method, dt: study.h() }
}
