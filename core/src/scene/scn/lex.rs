//! Words of a `.scn` text and the numbers they spell, each with its place.

/// A place in a text: line and column, both from 1.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Place {
    /// Line.
    pub line: u32,
    /// Column, in characters.
    pub column: u32,
}

/// An error in a `.scn` text, and its place.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ScnError<'a> {
    /// Where the offending word begins.
    pub place: Place,
    /// The command it belongs to; empty outside of one.
    pub command: &'a str,
    /// The offending word; empty at the end of the text.
    pub word: &'a str,
    /// The problem with it.
    pub problem: Problem,
}

/// A problem with a word.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Problem {
    /// It is no command.
    UnknownCommand,
    /// It is no shape.
    UnknownShape,
    /// The text ends where this argument should stand.
    Missing(&'static str),
    /// It should spell this argument, a decimal number.
    NotANumber(&'static str),
    /// It should spell this argument, a whole number.
    NotWhole(&'static str),
    /// It should spell this argument, but is beyond the range of an `f32`.
    TooLarge(&'static str),
    /// It should spell this argument, which has to be finite.
    NotFinite(&'static str),
    /// The argument has to be as the text says.
    Must(&'static str),
}

impl core::fmt::Display for ScnError<'_> {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        let Self { command, word, .. } = self;
        if !command.is_empty() {
            write!(f, "{command}: ")?;
        }
        // A word may be a whole binary file: show its beginning.
        let shown = word.char_indices().nth(40).map_or(*word, |(end, _)| &word[..end]);
        match self.problem {
            Problem::UnknownCommand => write!(f, "unknown command '{}'", shown.escape_debug()),
            Problem::UnknownShape => write!(
                f,
                "unknown shape '{}'; expected box, sphere, cylinder, cone, mesh, line or circle",
                shown.escape_debug()
            ),
            Problem::Missing(what) => write!(f, "the file ends where {what} is expected"),
            Problem::NotANumber(what) => write!(f, "expected {what}, a number, found '{}'", shown.escape_debug()),
            Problem::NotWhole(what) => write!(f, "expected {what}, a whole number, found '{}'", shown.escape_debug()),
            Problem::TooLarge(what) => write!(f, "{what} {shown} is beyond the range of a 32-bit float"),
            Problem::NotFinite(what) => write!(f, "{what} has to be finite, not {shown}"),
            Problem::Must(what) => write!(f, "{what}, found '{}'", shown.escape_debug()),
        }
    }
}

impl core::error::Error for ScnError<'_> {}

/// The number of something declared elsewhere, and where it stands.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Index {
    /// As written; −1 often means none.
    pub value: i64,
    /// Where it stands.
    pub place: Place,
}

/// Cuts a text into words.
#[derive(Clone, Debug)]
pub(super) struct Lexer<'a> {
    rest: &'a str,
    place: Place,
    /// The command whose arguments are being read.
    pub(super) command: &'a str,
}

impl<'a> Lexer<'a> {
    pub(super) fn new(text: &'a str) -> Self {
        let rest = text.strip_prefix('\u{feff}').unwrap_or(text);
        Self { rest, place: Place { line: 1, column: 1 }, command: "" }
    }

    /// The next word and its place, comments skipped.
    pub(super) fn next(&mut self) -> Option<(&'a str, Place)> {
        loop {
            let blank = self.rest.find(|c: char| !c.is_whitespace()).unwrap_or(self.rest.len());
            self.skip(blank);
            if self.rest.starts_with('#') {
                self.skip(self.rest.find(['\n', '\r']).unwrap_or(self.rest.len()));
            } else {
                break;
            }
        }
        let end = self.rest.find(char::is_whitespace).unwrap_or(self.rest.len());
        let (word, place) = (&self.rest[..end], self.place);
        self.skip(end);
        (!word.is_empty()).then_some((word, place))
    }

    /// Goes to the next line that begins with a word which is wanted in its column, or to the end.
    pub(super) fn skip_to_line_of(&mut self, is_wanted: impl Fn(&str, usize) -> bool) {
        while let Some(end) = self.rest.find(['\n', '\r']) {
            self.skip(end + 1);
            let line = self.rest.trim_start_matches(|c: char| c.is_whitespace() && c != '\n' && c != '\r');
            let column = 1 + self.rest[..self.rest.len() - line.len()].chars().count();
            if line.split(char::is_whitespace).next().is_some_and(|word| is_wanted(word, column)) {
                return;
            }
        }
        self.skip(self.rest.len());
    }

    /// The next word as the argument `what`.
    pub(super) fn word(&mut self, what: &'static str) -> Result<(&'a str, Place), ScnError<'a>> {
        self.next().ok_or_else(|| self.error(self.place, "", Problem::Missing(what)))
    }

    /// The next word as a number: decimal, in the manner of C's `strtod`.
    pub(super) fn float(&mut self, what: &'static str) -> Result<f32, ScnError<'a>> {
        let (word, place) = self.word(what)?;
        let Ok(number) = word.parse::<f32>() else {
            return Err(self.error(place, word, Problem::NotANumber(what)));
        };
        if number.is_finite() {
            return Ok(number);
        }
        let spelled = word.bytes().any(|b| b.is_ascii_digit());
        let problem = if spelled { Problem::TooLarge(what) } else { Problem::NotFinite(what) };
        Err(self.error(place, word, problem))
    }

    /// The next word as a number of at least zero.
    pub(super) fn positive(&mut self, what: &'static str, must: &'static str) -> Result<f32, ScnError<'a>> {
        let mut ahead = self.clone();
        let number = self.float(what)?;
        match ahead.next() {
            Some((word, place)) if number < 0.0 => Err(self.error(place, word, Problem::Must(must))),
            _ => Ok(number),
        }
    }

    /// The next word as a whole number.
    pub(super) fn index(&mut self, what: &'static str) -> Result<Index, ScnError<'a>> {
        let (word, place) = self.word(what)?;
        match word.parse() {
            Ok(value) => Ok(Index { value, place }),
            Err(_) => Err(self.error(place, word, Problem::NotWhole(what))),
        }
    }

    pub(super) fn error(&self, place: Place, word: &'a str, problem: Problem) -> ScnError<'a> {
        ScnError { place, command: self.command, word, problem }
    }

    fn skip(&mut self, bytes: usize) {
        let (passed, rest) = self.rest.split_at(bytes);
        for c in passed.chars() {
            if c == '\n' {
                self.place = Place { line: self.place.line.saturating_add(1), column: 1 };
            } else {
                self.place.column = self.place.column.saturating_add(1);
            }
        }
        self.rest = rest;
    }
}
