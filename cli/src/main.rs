//! The `pointmass` command.

use pointmass_cli::compare::Peers;
use std::process::ExitCode;

fn main() -> ExitCode {
    pointmass_cli::main(Peers::default())
}
