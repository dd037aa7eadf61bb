//! What a comparison runs on.

use serde::Serialize;
use std::fs;

/// A machine, as far as it says what it is.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Machine {
    /// The processor.
    pub cpu: String,
    /// How many cores the program may use. It uses one.
    pub cores: usize,
    /// The operating system.
    pub os: String,
    /// What the program was compiled for, and how.
    pub build: String,
}

impl Machine {
    /// This one.
    #[must_use]
    pub fn this() -> Self {
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
