//! OFF, the Object File Format of Geomview, in its text form.
//!
//! This reader is our own: `off-rs` 2.0 refuses the headers `COFF` and `NOFF`, counts that follow on the header's
//! line, and faces coloured in any way but with four floats, and it accepts NaN and vertices that aren't there.

use super::MeshData;
use super::text::{self, Line};
use crate::fault::Fault;
use crate::outcome::excerpt;

pub(super) fn read(bytes: &[u8]) -> Result<MeshData, Fault> {
    let text = text::decode(bytes);
    let mut lines = text::lines(&text).filter(|line| !line.content.is_empty());
    let counts = counts(&mut lines)?;
    // The vectors grow with the lines that are there, never by a count.
    let mut mesh = MeshData::default();
    for read in 0..counts.vertices {
        let line = lines.next().ok_or_else(|| counts.too_few(read, counts.vertices, "vertices"))?;
        // Normals and colours may follow the position; nobody here needs them.
        mesh.vertices.push(line.point(&mut line.words())?);
    }
    for read in 0..counts.faces {
        let line = lines.next().ok_or_else(|| counts.too_few(read, counts.faces, "faces"))?;
        let corners = corners(&line, mesh.vertices.len())?;
        mesh.add_polygon(&corners);
    }
    Ok(mesh)
}

struct Counts {
    /// The line they stand on.
    line: usize,
    vertices: usize,
    faces: usize,
}

impl Counts {
    fn too_few(&self, read: usize, promised: usize, what: &str) -> Fault {
        Fault::at(self.line, format!("promises {promised} {what}, but the file ends after {read}: is it cut short?"))
    }
}

/// Reads the header and the counts, which stand on its line or on the next.
fn counts<'a>(lines: &mut impl Iterator<Item = Line<'a>>) -> Result<Counts, Fault> {
    const COUNTS: &str = "the numbers of vertices, faces and edges";
    let header = lines.next().ok_or_else(|| Fault::new("has only comments: expected an OFF file"))?;
    let mut rest = after_keyword(&header)?;
    if rest.content.is_empty() {
        rest = lines.next().ok_or_else(|| header.fault(&format!("{COUNTS} after it")))?;
    }
    let mut words = rest.words();
    // The number of edges is often wrong or left out, and of no use.
    let mut count = || words.next()?.parse().ok();
    match (count(), count()) {
        (Some(vertices), Some(faces)) => Ok(Counts { line: rest.number, vertices, faces }),
        _ => Err(rest.fault(COUNTS)),
    }
}

/// The rest of the line after `OFF`, `COFF`, `NOFF` and the like; also `OFF8 6 12`, as a widespread collection of models has it.
fn after_keyword<'a>(header: &Line<'a>) -> Result<Line<'a>, Fault> {
    let not_off = || header.fault("`OFF` (or COFF, NOFF, STOFF), as an OFF file begins");
    let (prefix, rest) = header.content.split_once("OFF").ok_or_else(not_off)?;
    if !prefix.chars().all(|letter| "STCN4n".contains(letter)) {
        return Err(not_off());
    }
    if prefix.contains(['4', 'n']) {
        return Err(header.fault("vertices of three coordinates: save the mesh as plain OFF"));
    }
    let rest = rest.trim_start();
    if rest.starts_with("BINARY") {
        return Err(header.fault("a text: save the mesh as OFF in text form"));
    }
    Ok(Line { number: header.number, content: rest })
}

/// The corners of a face, `count index index index …`; a colour may follow.
fn corners(line: &Line<'_>, vertices: usize) -> Result<Vec<u32>, Fault> {
    let mut words = line.words();
    let sides: Option<usize> = words.next().and_then(|word| word.parse().ok());
    let sides = sides.filter(|sides| *sides >= 3).ok_or_else(|| line.fault("a face: 3 or more and as many indices"))?;
    let mut corners = Vec::new();
    for word in words.take(sides) {
        let index = word.parse().ok().filter(|index| (*index as usize) < vertices).ok_or_else(|| {
            let expected = format!("a vertex index below {vertices}, the number of vertices");
            Fault::at(line.number, format!("`{}`: expected {expected}", excerpt(word)))
        })?;
        corners.push(index);
    }
    if corners.len() < sides {
        return Err(line.fault(&format!("{sides} indices, found {}", corners.len())));
    }
    Ok(corners)
}

#[cfg(test)]
mod tests {
    use super::super::{MeshData, parse};

    const BODY: &str = "3 1 3\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";

    fn triangle() -> MeshData {
        MeshData { vertices: vec![[0., 0., 0.], [1., 0., 0.], [0., 1., 0.]], triangles: vec![[0, 1, 2]] }
    }

    #[test]
    fn reads_the_usual_variants() {
        let variants = [
            format!("OFF\n{BODY}"),
            format!("OFF {BODY}"),
            format!("OFF{BODY}"),
            format!("# made by hand\n\nOFF # header\n\n{BODY}").replace("0 1 0", "0 1 0 # last\n#\n"),
            format!("OFF\n{BODY}").replace('\n', "\r\n"),
            format!("\u{feff}OFF\n{BODY}").trim_end().to_owned(),
            format!("OFF\n{BODY}").replace("3 1 3", "3 1"),
            format!("OFF\n{BODY}").replace("3 0 1 2", "3 0 1 2 255 0 0"),
            format!("OFF\n{BODY}").replace("3 0 1 2", "3  0\t1 2  0.5 0.5 0.5 1"),
            format!("OFF\n{BODY}").replace("3 0 1 2", "3 0 1 2 7"),
            format!("COFF\n{BODY}").replace(" 0\n", " 0 255 0 0 255\n"),
            format!("NOFF\n{BODY}").replace(" 0\n", " 0 0 0 1\n"),
            format!("STCNOFF\n{BODY}").replace(" 0\n", " 0 0 0 1 0 0 0 1 0.5 0.5\n"),
        ];
        for variant in variants {
            assert_eq!(parse("t.off", "off", variant.as_bytes()), Ok(triangle()), "{variant}");
        }
    }

    #[test]
    fn a_polygon_becomes_a_fan() {
        let mesh = parse("p.off", "off", b"OFF 5 1 0\n0 0 0\n1 0 0\n2 1 0\n1 2 0\n0 1 0\n5 4 0 1 2 3").unwrap();
        assert_eq!(mesh.triangles, [[4, 0, 1], [4, 1, 2], [4, 2, 3]]);
    }

    #[test]
    fn errors_name_the_line_and_the_value() {
        let cases = [
            ("", "x.off: is empty: expected a mesh"),
            ("# nothing\n", "x.off: has only comments: expected an OFF file"),
            ("solid cube", "x.off:1: `solid cube`: expected `OFF` (or COFF, NOFF, STOFF), as an OFF file begins"),
            ("XOFF\n1 1 1", "x.off:1: `XOFF`: expected `OFF` (or COFF, NOFF, STOFF), as an OFF file begins"),
            ("4OFF\n1 1 1", "x.off:1: `4OFF`: expected vertices of three coordinates: save the mesh as plain OFF"),
            ("OFF BINARY\n", "x.off:1: `OFF BINARY`: expected a text: save the mesh as OFF in text form"),
            ("OFF\n", "x.off:1: `OFF`: expected the numbers of vertices, faces and edges after it"),
            ("OFF\n3 -1 0", "x.off:2: `3 -1 0`: expected the numbers of vertices, faces and edges"),
            ("OFF\n3", "x.off:2: `3`: expected the numbers of vertices, faces and edges"),
            ("OFF\n9 1 0\n0 0 0\n", "x.off:2: promises 9 vertices, but the file ends after 1: is it cut short?"),
            (
                "OFF\n18446744073709551615 1 0\n0 0 0",
                "x.off:2: promises 18446744073709551615 vertices, but the file ends after 1: is it cut short?",
            ),
            ("OFF\n0 1 0\n", "x.off:2: promises 1 faces, but the file ends after 0: is it cut short?"),
            ("OFF\n1 1 0\n0 nan 0", "x.off:3: `nan`: expected a finite coordinate within ±3.4e38"),
            ("OFF\n1 1 0\n0 0 1e39", "x.off:3: `1e39`: expected a finite coordinate within ±3.4e38"),
            ("OFF\n1 1 0\n0 0", "x.off:3: `0 0`: expected three coordinates"),
            ("OFF\n0 0 0\n", "x.off: has no triangles: a mesh needs at least one face"),
        ];
        for (text, expected) in cases {
            assert_eq!(parse("x.off", "off", text.as_bytes()).unwrap_err().to_string(), expected);
        }
    }

    #[test]
    fn errors_in_faces_name_the_line_and_the_value() {
        let cases = [
            ("3 0 1 3", "`3`: expected a vertex index below 3, the number of vertices"),
            ("3 0 1 -1", "`-1`: expected a vertex index below 3, the number of vertices"),
            ("3 0 1 4294967296", "`4294967296`: expected a vertex index below 3, the number of vertices"),
            ("3 0 1", "`3 0 1`: expected 3 indices, found 2"),
            ("9999999999 0 1 2", "`9999999999 0 1 2`: expected 9999999999 indices, found 3"),
            ("2 0 1", "`2 0 1`: expected a face: 3 or more and as many indices"),
            ("x 0 1", "`x 0 1`: expected a face: 3 or more and as many indices"),
        ];
        for (face, expected) in cases {
            let text = format!("OFF\n{BODY}").replace("3 0 1 2", face);
            let error = parse("x.off", "off", text.as_bytes()).unwrap_err();
            assert_eq!(error.to_string(), format!("x.off:6: {expected}"));
        }
    }
}
