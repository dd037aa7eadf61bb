//! The library behind the `pointmass` binary.
//!
//! `args` parses, one module a command does the work: `run`, `render`, `convert`, `check`, `compare`, `lab`. They share
//! `load` (scenes and meshes from disk), `world` (a scene in motion), `schedule` (when steps end), `substeps` (how they are
//! divided), `record` (state to files), `draw` (state to pictures), and what reports are made of: `plot`, `page`, `words`.

pub mod args;
pub mod check;
pub mod compare;
pub mod convert;
pub mod draw;
pub mod formats;
mod grid;
pub mod groups;
pub mod lab;
pub mod load;
pub mod meshes;
mod page;
mod plot;
mod progress;
mod record;
pub mod render;
pub mod report;
pub mod run;
pub mod schedule;
mod stage;
mod stall;
pub mod substeps;
pub mod temporary;
pub mod whole;
mod words;
pub mod world;

use args::{Args, Command};
use clap::Parser;
use std::process::ExitCode;

/// What the command does: parses its arguments, does what they say, and turns the outcome into an exit code.
#[must_use]
pub fn main(peers: compare::Peers) -> ExitCode {
    temporary::clean_up_when_interrupted();
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

/// What went wrong, as one line for a person.
#[derive(Debug)]
pub struct Failure(String);

impl Failure {
    /// A failure with a message that names what it is about.
    pub fn new(message: impl Into<String>) -> Self {
        Self(message.into())
    }

    /// A failure to read or write `path`.
    pub fn io(path: &std::path::Path, error: &std::io::Error) -> Self {
        Self(format!("{}: {error}{}", path.display(), hint(path, error)))
    }
}

impl std::fmt::Display for Failure {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(&one_line(&self.0))
    }
}

/// Which file may be meant where there is none.
pub(crate) fn hint(path: &std::path::Path, error: &std::io::Error) -> String {
    let is_missing = error.kind() == std::io::ErrorKind::NotFound;
    let alike = is_missing.then(|| load::alike(path)).flatten();
    alike.map_or(String::new(), |name| format!("; did you mean {name}?"))
}

/// Text as a terminal may show it: names in it come from files and arguments, and may hold codes that terminals obey.
/// Lines stay lines, and JSON stays the same JSON.
#[must_use]
pub fn harmless(text: &str) -> String {
    let obeyed = |c: char| c != '\n' && (c.is_control() || is_bidirectional(c));
    let mut harmless = String::with_capacity(text.len());
    for c in text.chars() {
        if obeyed(c) { harmless.push_str(&format!("\\u{:04x}", u32::from(c))) } else { harmless.push(c) }
    }
    harmless
}

/// Whether it changes the order in which letters are shown.
fn is_bidirectional(c: char) -> bool {
    matches!(c, '\u{200e}' | '\u{200f}' | '\u{061c}' | '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}')
}

/// A message as one line of bounded length: names in it come from files, and may hold anything.
fn one_line(message: &str) -> String {
    const LONGEST: usize = 600;
    let mut line: String = message
        .chars()
        .flat_map(|c| {
            let escaped = c.is_control() || is_bidirectional(c);
            escaped.then(|| c.escape_debug()).into_iter().flatten().chain((!escaped).then_some(c))
        })
        .take(LONGEST)
        .collect();
    if message.chars().nth(LONGEST).is_some() {
        line.push_str(" ...");
    }
    line
}

impl std::error::Error for Failure {}

impl From<pointmass::scene::SceneError> for Failure {
    fn from(error: pointmass::scene::SceneError) -> Self {
        Self(error.to_string())
    }
}

/// What a command comes to.
pub type Outcome<T = ()> = Result<T, Failure>;

/// Prints to standard output; a reader that has gone away is no error.
///
/// # Errors
/// If the output cannot be written for another reason.
pub fn print(text: &str) -> Outcome {
    use std::io::Write;
    let mut out = std::io::stdout().lock();
    match out.write_all(harmless(text).as_bytes()).and_then(|()| out.flush()) {
        Err(error) if error.kind() != std::io::ErrorKind::BrokenPipe => {
            Err(Failure(format!("standard output: {error}")))
        }
        _ => Ok(()),
    }
}

/// Prints warnings to standard error, the first hundred of them.
pub fn warn(warnings: &[String]) {
    const MOST: usize = 100;
    for warning in warnings.iter().take(MOST) {
        tell("warning", warning);
    }
    if warnings.len() > MOST {
        tell("warning", &format!("{} more of the kind", warnings.len() - MOST));
    }
}

/// Prints a line to standard error.
pub fn tell(what: &str, message: &str) {
    use std::io::Write;
    // If standard error is closed or full, nobody is left to be told.
    let _ = writeln!(std::io::stderr(), "{what}: {}", one_line(message));
}
