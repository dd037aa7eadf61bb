//! `pointmass check`: which steps a scene stands, what limits them, and what to change.
//!
//! `net` makes matrices of the springs, `modes` and `verlet` work out their oscillations at rest, `bounds` what holds in
//! every pose, `contact` and `hit` what touching balls ask for, `world` what else has a time of its own; `report` is what it came to, which `advice` puts into words, and `text`, `plot` and `page` tell.

mod advice;
mod bounds;
mod contact;
mod hit;
mod modes;
mod net;
mod page;
mod plot;
mod report;
#[cfg(test)]
mod tests;
mod text;
mod verlet;
mod words;
mod world;

pub(crate) use bounds::Bounds;

use crate::args::{self, Report};
use crate::formats::PlotFormat;
use crate::load::{self, Disk};
use crate::whole::WholeFile;
use crate::{Failure, Outcome, print, stall};
use modes::Spectrum;
use plot::Scenery;
use pointmass::Method;
use pointmass::scene::Model;
use report::Check;
use std::io::Write;

/// Writes the picture, or the page around it.
fn draw(
    mut file: WholeFile,
    format: PlotFormat,
    check: &Check,
    spectrum: Option<&Spectrum>,
    method: Method,
) -> Outcome {
    let modes = spectrum.iter().flat_map(|spectrum| spectrum.modes.iter().copied());
    let parts = check.dragged.iter().chain(&check.touching);
    let modes = modes.chain(parts.map(|part| part.mode)).collect();
    let scenery = Scenery { check, modes, method };
    let text = match format {
        PlotFormat::Svg => plot::svg(&scenery)?,
        PlotFormat::Html => page::html(&scenery)?,
    };
    file.write_all(text.as_bytes()).map_err(|error| Failure::io(file.path(), &error))?;
    file.complete()
}

/// A vector in double precision.
fn wide(v: pointmass::Vec3) -> nalgebra::Vector3<f64> {
    v.to_array().map(f64::from).into()
}

/// Checks a scene as the arguments say. A file is written whole or not at all.
///
/// # Errors
/// If the scene cannot be used or a file cannot be written.
pub fn check(args: &args::Check) -> Outcome {
    let mut file = load::scene_with(&args.scene, args.reading.unknown())?;
    let run = &mut file.run;
    run.integrator = args.integrator.unwrap_or(run.integrator);
    run.dt = args.dt.unwrap_or(run.dt);
    let model = Model::load(&file, &args.scene.to_string_lossy(), &mut Disk)?;
    let plot =
        args.plot.as_ref().map(|(path, format)| WholeFile::create(path).map(|file| (file, *format))).transpose()?;
    let (mut check, spectrum) = Check::of(&args.scene, &model, &file.run);
    check.advice.extend(stall::foreseen(&model, file.run.dt, file.run.duration));
    if let Some((file, format)) = plot {
        draw(file, format, &check, spectrum.as_ref(), model.integrator.method)?;
    }
    match args.report {
        Report::Text => print(&text::text(&check)),
        Report::Json => print(&(serde_json::to_string(&check).unwrap_or_default() + "\n")),
    }
}
