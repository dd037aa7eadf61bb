//! What went wrong, as one line for a person, and names that were meant.

use std::path::{Path, PathBuf};

/// The outcome of reading or writing.
pub type Outcome<T = ()> = Result<T, Failure>;

/// A fault, as one line for a person.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Failure(String);

impl Failure {
    /// A failure with a message that names what it is about.
    pub fn new(message: impl Into<String>) -> Self {
        Self(message.into())
    }

    /// A failure to read or write `path`.
    pub fn io(path: &Path, error: &std::io::Error) -> Self {
        Self(format!("{}: {error}{}", path.display(), hint(path, error)))
    }
}

impl std::fmt::Display for Failure {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(&one_line(&self.0))
    }
}

impl<E: std::error::Error> From<E> for Failure {
    fn from(error: E) -> Self {
        Self(error.to_string())
    }
}

/// For those who collect errors of all kinds. It is none itself, so that it can take in every error.
impl From<Failure> for Box<dyn std::error::Error> {
    fn from(failure: Failure) -> Self {
        failure.to_string().into()
    }
}

/// The same for those that pass from thread to thread.
impl From<Failure> for Box<dyn std::error::Error + Send + Sync> {
    fn from(failure: Failure) -> Self {
        failure.to_string().into()
    }
}

/// Which file may be meant where there is none.
pub fn hint(path: &Path, error: &std::io::Error) -> String {
    let is_missing = error.kind() == std::io::ErrorKind::NotFound;
    let alike = is_missing.then(|| alike(path)).flatten();
    alike.map_or(String::new(), |name| format!("; did you mean {name}?"))
}

/// The name of a file that differs from that of a missing one in capitals alone, from the first folder that does.
pub fn alike(path: &Path) -> Option<String> {
    let (mut found, mut shown) = (PathBuf::new(), PathBuf::new());
    for part in path.components() {
        let next = found.join(part);
        if next.symlink_metadata().is_ok() {
            found = next;
            if shown.as_os_str().is_empty() {
                continue;
            }
            shown.push(part);
        } else {
            let wanted = part.as_os_str().to_string_lossy().to_lowercase();
            let folder = if found.as_os_str().is_empty() { Path::new(".") } else { &found };
            let names = folder.read_dir().ok()?.filter_map(|entry| Some(entry.ok()?.file_name()));
            let name = names.filter(|name| name.to_string_lossy().to_lowercase() == wanted).min()?;
            found.push(&name);
            shown.push(&name);
        }
    }
    let is_other = found.is_file() && !shown.as_os_str().is_empty();
    is_other.then(|| shown.display().to_string())
}

/// Text as a terminal may show it: names in it come from files and arguments, and may hold codes that terminals obey.
/// Lines stay lines, and JSON stays the same JSON.
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
pub fn one_line(message: &str) -> String {
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

/// A piece of the file, or of a library's message, on one line and cut where it is long.
pub fn excerpt(piece: &str) -> String {
    const LONGEST: usize = 120;
    let mut line = String::new();
    for word in piece.split_whitespace() {
        if !line.is_empty() {
            line.push(' ');
        }
        // A file may be one endless word, or an endless line of them.
        line.extend(
            word.chars().take(LONGEST + 1).map(|c| if c.is_control() { char::REPLACEMENT_CHARACTER } else { c }),
        );
        if let Some((end, _)) = line.char_indices().nth(LONGEST) {
            line.truncate(end);
            line.push('…');
            break;
        }
    }
    line
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_excerpt_is_short_and_on_one_line() {
        assert_eq!(excerpt("one\n\ttwo \u{7}"), "one two \u{fffd}");
        assert_eq!(excerpt(&"ä".repeat(500)), format!("{}…", "ä".repeat(120)));
        assert_eq!(excerpt(&"a ".repeat(500)).chars().count(), 121);
    }
}
