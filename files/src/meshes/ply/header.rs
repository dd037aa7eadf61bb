//! The header of a PLY file: what elements there are, of what properties, and in which encoding.

use ply_rs_bw::parser::{Parser, Reader};
use ply_rs_bw::ply::Header;

use super::elements::{LISTS, Skipped};
use super::payload::Payload;
use super::{Fault, excerpt, text};

/// How far a header may reach: more is not a mesh, and the library copies what it quotes.
const LONGEST: usize = 1 << 20;

/// Splits the file behind its header.
pub(crate) fn split(bytes: &[u8]) -> Result<(Header, Payload<'_>), Fault> {
    const END: &[u8] = b"\nend_header";
    let start = &bytes[..bytes.len().min(LONGEST)];
    if !start.starts_with(b"ply") {
        return Err(Fault::at(1, "expected `ply`, as a PLY file begins"));
    }
    let end = start.windows(END.len()).position(|window| window == END);
    let end = end.ok_or_else(|| Fault::new("has no line `end_header`: is it cut short?"))? + END.len();
    let end = end + start[end..].iter().position(|byte| *byte == b'\n').map_or(start.len() - end, |at| at + 1);
    let (head, unread) = bytes.split_at(end);
    let text = text::decode(head);
    let header = Parser::<Skipped>::new().read_header(&mut Reader::new(text.as_bytes())).map_err(|error| {
        let line = error.line().and_then(|number| text.lines().zip(1..).nth(number.saturating_sub(1)));
        match line {
            Some((line, number)) => Fault::at(number, format!("`{}`: expected a line of a PLY header", excerpt(line))),
            None => Fault::new(format!("header: {}", excerpt(&error.to_string()))),
        }
    })?;
    let line = text.lines().count();
    let payload = Payload::new(header.encoding, unread, line);
    Ok((header, payload))
}

/// The number of vertices that the header promises, if it describes a mesh.
pub(super) fn check(header: &Header) -> Result<usize, Fault> {
    let has = |element: &str, names: &[&str]| {
        header.elements.get(element).is_some_and(|def| names.iter().any(|name| def.properties.contains_key(*name)))
    };
    if !["x", "y", "z"].iter().all(|name| has("vertex", &[name])) {
        return Err(Fault::new("header: expected an element `vertex` with properties x, y and z"));
    }
    if !has("face", &LISTS) {
        return Err(Fault::new("header: expected an element `face` with a list `vertex_indices`"));
    }
    Ok(header.elements["vertex"].count)
}
