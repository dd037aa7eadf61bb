//! The `pointmass` command: parses its arguments, does what they say, and turns the outcome into an exit code.

use clap::Parser;
use pointmass_cli::args::{Args, Command};
use pointmass_cli::{check, compare, convert, lab, render, run};
use std::process::ExitCode;

fn main() -> ExitCode {
    let args = Args::parse();
    let outcome = match &args.command {
        Command::Run(args) => run::run(args),
        Command::Render(args) => render::render(args),
        Command::Convert(args) => convert::convert(args),
        Command::Check(args) => check::check(args),
        Command::Compare(args) => compare::compare(args),
        Command::Lab(args) => lab::lab(args),
        Command::Schema => pointmass_cli::print(&pointmass::scene::schema()),
    };
    match outcome {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            pointmass_cli::tell("error", &error.to_string());
            ExitCode::FAILURE
        }
    }
}
