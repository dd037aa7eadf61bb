//! The `pointmass` command: parses its arguments, does what they say, and turns the outcome into an exit code.

use clap::Parser;
use pointmass_cli::args::{Args, Command};
use pointmass_cli::{check, compare, convert, lab, render, run};
use std::process::ExitCode;

/// Says what is wrong with the arguments, or helps, and ends the program. What is quoted may hold codes that terminals
/// obey; then it goes without colours.
fn refuse(error: &clap::Error) -> ! {
    let is_harmless = |text: &str| pointmass_cli::harmless(text) == text;
    if std::env::args_os().all(|argument| is_harmless(&argument.to_string_lossy())) {
        error.exit();
    }
    eprint!("{}", pointmass_cli::harmless(&error.render().to_string()));
    std::process::exit(error.exit_code());
}

fn main() -> ExitCode {
    pointmass_cli::temporary::clean_up_when_interrupted();
    let args = Args::try_parse().unwrap_or_else(|error| refuse(&error));
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
