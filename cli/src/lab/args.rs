//! The arguments of `lab`.

use crate::formats::{Said, StudyFormat, named};
use crate::load::Reading;
use crate::parse::{chosen, seconds, step};
use clap::ValueEnum;
use pointmass::Method;
use std::path::PathBuf;

/// Arguments of `lab`.
#[derive(Debug, clap::Args)]
pub(crate) struct Lab {
    /// A scene instead of the reference problems: .json or .scn
    #[arg(conflicts_with = "problems")]
    pub(crate) scene: Option<PathBuf>,
    /// How the scene is read.
    #[command(flatten)]
    pub(crate) reading: Reading,
    /// Which reference problems
    #[arg(
        long,
        value_name = "NAME,...",
        value_enum,
        value_delimiter = ',',
        default_value = "oscillator,pendulum,driven,kepler,stiff,rope"
    )]
    pub(crate) problems: Vec<Named>,
    /// Which methods, such as verlet,rk4; or all
    #[arg(long, value_name = "NAME,...", default_value = "all", value_parser = methods)]
    pub(crate) integrators: Methods,
    /// The steps in seconds, such as 1/60,1/120,1/240; by default powers of two that suit the problem, or the scene's step
    /// and its half, down to a sixteenth
    #[arg(long, value_name = "S,...", allow_hyphen_values = true, value_delimiter = ',', value_parser = step)]
    pub(crate) dt: Vec<f64>,
    /// When errors are taken, in seconds; by default what suits the problem, or what the scene says
    #[arg(long, value_name = "S", allow_hyphen_values = true, value_parser = span)]
    pub(crate) duration: Option<f64>,
    /// Write the findings into FILE: .html, a page with charts; .svg, the charts; .csv or .json, all figures; may be
    /// given several times
    #[arg(long, value_name = "FILE", value_parser = named::<StudyFormat>)]
    pub(crate) out: Vec<(PathBuf, StudyFormat)>,
    /// How to say on standard output what was found
    #[arg(long, value_enum, default_value_t = Said::Text)]
    pub(crate) report: Said,
    /// Print the errors of every step
    #[arg(long)]
    pub(crate) detail: bool,
}

/// A reference problem by its name.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, ValueEnum)]
pub(crate) enum Named {
    /// The harmonic oscillator x'' = −4 x
    Oscillator,
    /// The pendulum θ'' = −sin θ, let go from up to 2 rad
    Pendulum,
    /// The driven oscillator x'' = −4 x + 2 cos t: its force depends on time
    Driven,
    /// Two bodies on ellipses of eccentricity 0.41
    Kepler,
    /// Overdamped springs, whose fast decay is 98 times the slow one
    Stiff,
    /// A chain of ten damped springs that swings
    Rope,
}

/// Integrators to try, each once.
#[derive(Clone, Debug)]
pub(crate) struct Methods(pub(crate) Vec<Method>);

fn methods(text: &str) -> Result<Methods, String> {
    chosen(text, Method::ALL).map(Methods)
}

fn span(text: &str) -> Result<f64, String> {
    let value = seconds(text)?;
    if value > 0.0 { Ok(value) } else { Err("expected more than 0 s".into()) }
}
