//! The library behind the `pointmass` binary.
//!
//! `args` parses, one module a command does the work: `run`, `render`, `convert`, `check`, `compare`, `lab`. They share
//! `load` (scenes and meshes from disk), `world` (a scene in motion), `clock` (when steps end), `substeps` (how they are
//! divided), `record` (state to files), `draw` (state to pictures), and what reports are made of: `plot`, `page`, `words`.

pub mod args;
pub mod check;
pub mod clock;
pub mod compare;
pub mod convert;
pub mod draw;
pub mod formats;
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
mod stage;
mod stall;
pub mod substeps;
pub mod whole;
mod words;
pub mod world;

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
        Self(format!("{}: {error}", path.display()))
    }
}

impl std::fmt::Display for Failure {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(&one_line(&self.0))
    }
}

/// A message as one line of bounded length: names in it come from files, and may hold anything.
fn one_line(message: &str) -> String {
    const LONGEST: usize = 600;
    let mut line: String = message
        .chars()
        .flat_map(|c| {
            c.is_control().then(|| c.escape_debug()).into_iter().flatten().chain((!c.is_control()).then_some(c))
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
    match out.write_all(text.as_bytes()).and_then(|()| out.flush()) {
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
