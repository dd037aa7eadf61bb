//! The origin of findings: the program, what was typed, and the machine.

use serde::Serialize;
use std::fs;

/// The origin of findings.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct Origin {
    /// The version of this program.
    pub(crate) version: String,
    /// The command that has it all again.
    pub(crate) command: String,
    /// The machine that it ran on.
    pub(crate) machine: Machine,
}

impl Origin {
    /// The origin of this run's findings.
    pub(crate) fn this() -> Self {
        let (version, command) = (env!("CARGO_PKG_VERSION").into(), command(std::env::args()));
        Self { version, command, machine: Machine::this() }
    }
}

/// The command line, as a shell takes it.
pub(crate) fn command(args: impl Iterator<Item = String>) -> String {
    let plain =
        |word: &str| !word.is_empty() && word.chars().all(|c| c.is_ascii_alphanumeric() || "-_=.,/:+%@".contains(c));
    let quoted =
        args.skip(1).map(|word| if plain(&word) { word } else { format!("'{}'", word.replace('\'', r"'\''")) });
    std::iter::once("pointmass".to_string()).chain(quoted).collect::<Vec<_>>().join(" ")
}

/// A machine, as far as it says what it is.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub(crate) struct Machine {
    /// The processor.
    pub(crate) cpu: String,
    /// How many cores the program may use. It uses one.
    pub(crate) cores: usize,
    /// The operating system.
    pub(crate) os: String,
    /// The machine that the program was compiled for, and how.
    pub(crate) build: String,
}

impl Machine {
    /// This one.
    pub(crate) fn this() -> Self {
        let arch = std::env::consts::ARCH;
        let optimised = if cfg!(debug_assertions) { "not optimised" } else { "optimised" };
        Self {
            cpu: cpu().unwrap_or_else(|| format!("{arch}, of unknown make")),
            cores: std::thread::available_parallelism().map_or(1, std::num::NonZero::get),
            os: os().unwrap_or_else(|| std::env::consts::OS.to_string()),
            build: format!("{arch}, {optimised}"),
        }
    }
}

/// Linux tells in a file, Windows in a variable, macOS when asked.
fn cpu() -> Option<String> {
    let from_file = || {
        let text = fs::read_to_string("/proc/cpuinfo").ok()?;
        let line = text.lines().find(|line| line.starts_with("model name"))?;
        Some(line.split_once(':')?.1.trim().to_string())
    };
    let asked = || {
        if !cfg!(target_os = "macos") {
            return None;
        }
        let answer = std::process::Command::new("sysctl").args(["-n", "machdep.cpu.brand_string"]).output().ok()?;
        Some(String::from_utf8(answer.stdout).ok()?.trim().to_string())
    };
    let name = from_file().or_else(asked).or_else(|| std::env::var("PROCESSOR_IDENTIFIER").ok());
    name.filter(|name| !name.is_empty())
}

fn os() -> Option<String> {
    let text = fs::read_to_string("/etc/os-release").ok()?;
    let name = text.lines().find_map(|line| line.strip_prefix("PRETTY_NAME="))?;
    Some(name.trim_matches('"').to_string())
}
