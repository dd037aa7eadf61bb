//! The `pointmass` command, with other libraries for `compare --peers`.

use pointmass_cli::compare::Peers;
use std::process::ExitCode;

fn main() -> ExitCode {
    pointmass_cli::main(Peers { of_points: pointmass_peers::peers(), of_meshes: pointmass_peers::ray_peers() })
}
