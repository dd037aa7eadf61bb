//! The text formats share this: numbered lines of words, `#` comments, points of three coordinates.

use std::borrow::Cow;
use std::str::SplitWhitespace;

use crate::fault::Fault;
use crate::outcome::excerpt;

/// The file as text: without a byte order mark, and with a replacement for what isn't UTF-8.
///
/// Names and comments are in whatever encoding their author used; they are no reason to refuse a mesh.
pub(super) fn decode(bytes: &[u8]) -> Cow<'_, str> {
    String::from_utf8_lossy(bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes))
}

/// All lines of a text, also the empty ones.
pub(super) fn lines(text: &str) -> impl Iterator<Item = Line<'_>> {
    text.lines().zip(1..).map(|(line, number)| {
        let content = line.split_once('#').map_or(line, |(before, _)| before);
        Line { number, content: content.trim() }
    })
}

/// A line without its comment.
#[derive(Clone, Copy)]
pub(super) struct Line<'a> {
    /// Counted from 1.
    pub(super) number: usize,
    pub(super) content: &'a str,
}

impl<'a> Line<'a> {
    pub(super) fn words(&self) -> SplitWhitespace<'a> {
        self.content.split_whitespace()
    }

    /// A fault of this line, which quotes it.
    pub(super) fn fault(&self, expected: &str) -> Fault {
        Fault::at(self.number, format!("`{}`: expected {expected}", excerpt(self.content)))
    }

    /// The point that the next three words are.
    pub(super) fn point(&self, words: &mut SplitWhitespace<'_>) -> Result<[f32; 3], Fault> {
        let mut point = [0.0; 3];
        for coordinate in &mut point {
            let word = words.next().ok_or_else(|| self.fault("three coordinates"))?;
            // `parse` reads a number that is too large for an `f32` as infinity.
            let number = word.parse().ok().filter(|number: &f32| number.is_finite());
            *coordinate = number.ok_or_else(|| {
                Fault::at(self.number, format!("`{}`: expected a finite coordinate within ±3.4e38", excerpt(word)))
            })?;
        }
        Ok(point)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_keep_their_numbers_and_lose_their_comments() {
        let text = decode(b"\xef\xbb\xbfa b # c\r\n\n# \xe9\n d");
        let seen: Vec<_> = lines(&text).map(|line| (line.number, line.content)).collect();
        assert_eq!(seen, [(1, "a b"), (2, ""), (3, ""), (4, "d")]);
    }

    #[test]
    fn a_point_is_three_finite_numbers() {
        let point = |content: &str| {
            let line = Line { number: 1, content };
            line.point(&mut line.words())
        };
        assert_eq!(point("1 -2.5e1 .5 9"), Ok([1.0, -25.0, 0.5]));
        for bad in ["", "1 2", "1 2 x", "1 nan 3", "inf 0 0", "0 -1e39 0"] {
            assert!(point(bad).is_err(), "{bad}");
        }
    }
}
