//! The payload follows the header of a PLY file, element by element.

use std::io::ErrorKind;

use ply_rs_bw::parser::Parser;
use ply_rs_bw::ply::{ElementDef, Encoding, PropertyAccess};

use super::{Fault, excerpt, text};

/// How long a line of the text kind may be: the library takes eight times as much to split it into words.
const LONGEST: usize = 1 << 20;

/// The part that follows the header.
pub(crate) struct Payload<'a> {
    encoding: Encoding,
    unread: &'a [u8],
    /// The line that was read last, of a text.
    line: usize,
}

impl<'a> Payload<'a> {
    pub(super) fn new(encoding: Encoding, unread: &'a [u8], line: usize) -> Self {
        Self { encoding, unread, line }
    }

    /// Reads the next element, the `number`-th of its kind.
    pub(crate) fn next<E: PropertyAccess>(&mut self, element: &ElementDef, number: usize) -> Result<E, Fault> {
        let parser = Parser::new();
        let read = match self.encoding {
            Encoding::Ascii => return self.next_of_text(&parser, element, number),
            Encoding::BinaryBigEndian => parser.read_big_endian_element(&mut self.unread, element),
            Encoding::BinaryLittleEndian => parser.read_little_endian_element(&mut self.unread, element),
        };
        read.map_err(|error| match error.kind() {
            ErrorKind::UnexpectedEof => self.fault(element, number, "the file ends here: is it cut short?"),
            _ => self.fault(element, number, &excerpt(&error.to_string())),
        })
    }

    fn next_of_text<E: PropertyAccess>(
        &mut self,
        parser: &Parser<E>,
        element: &ElementDef,
        number: usize,
    ) -> Result<E, Fault> {
        while !self.unread.is_empty() {
            let end = self.unread.iter().position(|byte| *byte == b'\n').map_or(self.unread.len(), |at| at + 1);
            let (line, unread) = self.unread.split_at(end);
            self.unread = unread;
            self.line += 1;
            if line.len() > LONGEST {
                return Err(self.fault(element, number, "expected a line of less than 1 MiB"));
            }
            let line = text::decode(line);
            if !line.trim().is_empty() {
                let read = parser.read_ascii_element(&line, element);
                return read.or_else(|_| parser.read_ascii_element(&plain(&line), element)).map_err(|_| {
                    let names: Vec<_> = element.properties.keys().map(String::as_str).collect();
                    let expected = format!("`{}`: expected numbers for {}", excerpt(&line), excerpt(&names.join(", ")));
                    self.fault(element, number, &expected)
                });
            }
        }
        Err(self.fault(element, number, "the file ends here: is it cut short?"))
    }

    /// A fault in an element, or in what was read last where the encoding is a text.
    pub(super) fn fault(&self, element: &ElementDef, number: usize, message: &str) -> Fault {
        let message = format!("{} {number} of {}: {message}", excerpt(&element.name), element.count);
        match self.encoding {
            Encoding::Ascii => Fault::at(self.line, message),
            _ => Fault::new(message),
        }
    }
}

/// A line with `.5`, `5.` and `nan` written in a way that the library knows, the last as a number beyond any range.
///
/// Normals of degenerate faces are often `nan`, and don't matter; a coordinate that is infinite does and is refused.
fn plain(line: &str) -> String {
    let words = line.split_whitespace().map(|word| match word.parse::<f64>() {
        Ok(number) if number.is_finite() && word.contains('.') => format!("{number:e}"),
        Ok(number) if !number.is_finite() => "1e999".to_owned(),
        _ => word.to_owned(),
    });
    words.collect::<Vec<_>>().join(" ")
}
