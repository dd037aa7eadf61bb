//! The library behind the `pointmass` binary: one module a command, which has its arguments beside it.
//!
//! The commands are `run`, `render`, `convert`, `check`, `compare` and `lab`. They share `load` (scenes from disk), `world` (a scene
//! in motion), `schedule` (when steps end), `substeps` (how they are divided), `stage` and `cast` (state to what `pointmass_draw` draws), `viewpoint`
//! (from where), `report` (findings to a terminal, a page or a table) and `outcome` (what went wrong). `pointmass_files` reads meshes and points, and writes recordings and films.

mod cast;
mod check;
pub mod compare;
mod convert;
mod formats;
mod lab;
pub mod load;
mod locate;
mod outcome;
mod parse;
mod progress;
mod render;
mod report;
mod run;
mod schedule;
mod show;
mod shutter;
mod sight;
mod stage;
mod stall;
mod statistics;
mod style;
mod substeps;
mod viewpoint;
mod world;

pub use outcome::{Failure, Outcome};

use clap::{Parser, Subcommand};
use outcome::{harmless, print, tell};
use std::process::ExitCode;

/// Particle systems that are exact, bounded and the same everywhere.
#[derive(Debug, Parser)]
#[command(
    name = "pointmass",
    version,
    max_term_width = 100,
    after_help = "\
Examples:
  pointmass render scenes/fountain.json --out fountain.gif
  pointmass render scenes/pour.json --out pour.mp4 --orbit 1
  pointmass run scenes/rope.scn --duration 10 --dt 0.001 --out rope.csv
  pointmass run scenes/fountain.json --report json | jq .died
  pointmass check scenes/rope.scn --dt 1/30
  pointmass convert lab.scn lab.json
  pointmass compare --distribution uniform,plummer --n 1e3,1e4,1e5 --out study.html
  pointmass compare --mesh bunny.ply --out rays.html
  pointmass lab --problems oscillator,kepler --out lab.html
  pointmass lab scenes/rope.scn --duration 2 --dt 1/60,1/120,1/240,1/480"
)]
struct Args {
    /// What to do.
    #[command(subcommand)]
    command: Command,
}

/// What to do.
#[derive(Debug, Subcommand)]
enum Command {
    /// Run a scene and report what happened
    Run(run::Run),
    /// Draw a scene as an animation or pictures
    Render(render::Render),
    /// Translate a scene between .scn and .json
    Convert(convert::Convert),
    /// Say which steps a scene stands with every integrator, what limits them and what to change
    Check(check::Check),
    /// Measure which spatial partition suits which points and queries, or which mesh and rays
    Compare(compare::Compare),
    /// Measure how exact the integrators are, and how well they keep energy
    Lab(lab::Lab),
    /// Print the JSON Schema of .json scenes
    Schema,
}

/// Runs the command: parses its arguments, does what they say, and turns the outcome into an exit code.
#[must_use]
pub fn main(peers: compare::Peers) -> ExitCode {
    pointmass_files::temporary::clean_up_when_interrupted(tell_of_interrupt);
    let args = Args::try_parse().unwrap_or_else(|error| refuse(&error));
    let outcome = match &args.command {
        Command::Run(args) => run::run(args),
        Command::Render(args) => render::render(args),
        Command::Convert(args) => convert::convert(args),
        Command::Check(args) => check::check(args),
        Command::Compare(args) => compare::compare(args, peers),
        Command::Lab(args) => lab::lab(args),
        Command::Schema => print(&pointmass::scene::schema()),
    };
    match outcome {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            tell("error", &error.to_string());
            ExitCode::FAILURE
        }
    }
}

/// Says what becomes of files in the making.
fn tell_of_interrupt() {
    use std::io::IsTerminal;
    if std::io::stderr().is_terminal() {
        // A bar may stand there.
        eprintln!();
    }
    tell("warning", "interrupted: recordings and pictures are dropped, since they are not complete");
}

/// Says what is wrong with the arguments, or helps, and ends the program. What is quoted may hold codes that terminals
/// obey; then it goes without colours.
fn refuse(error: &clap::Error) -> ! {
    let is_harmless = |text: &str| harmless(text) == text;
    if std::env::args_os().all(|argument| is_harmless(&argument.to_string_lossy())) {
        error.exit();
    }
    eprint!("{}", harmless(&error.render().to_string()));
    std::process::exit(error.exit_code());
}

#[test]
fn the_command_line_is_sound() {
    use clap::CommandFactory;
    Args::command().debug_assert();
}
