//! The outcome of a command, and how it is said.

pub(crate) use pointmass_files::outcome::harmless;
pub use pointmass_files::outcome::{Failure, Outcome};

use pointmass_files::outcome::one_line;

/// Prints to standard output; a reader that has gone away is no error.
pub(crate) fn print(text: &str) -> Outcome {
    use std::io::Write;
    let mut out = std::io::stdout().lock();
    match out.write_all(harmless(text).as_bytes()).and_then(|()| out.flush()) {
        Err(error) if error.kind() != std::io::ErrorKind::BrokenPipe => {
            Err(Failure::new(format!("standard output: {error}")))
        }
        _ => Ok(()),
    }
}

/// Prints to standard error what would be on standard output, were that not taken.
pub(crate) fn mention(text: &str) {
    use std::io::Write;
    // As below.
    let _ = write!(std::io::stderr(), "{}", harmless(text));
}

/// Prints warnings to standard error, the first hundred of them.
pub(crate) fn warn(warnings: &[String]) {
    const MOST: usize = 100;
    for warning in warnings.iter().take(MOST) {
        tell("warning", warning);
    }
    if warnings.len() > MOST {
        tell("warning", &format!("{} more of the kind", warnings.len() - MOST));
    }
}

/// Prints a line to standard error.
pub(crate) fn tell(what: &str, message: &str) {
    use std::io::Write;
    // If standard error is closed or full, nobody is left to be told.
    let _ = writeln!(std::io::stderr(), "{what}: {}", one_line(message));
}
