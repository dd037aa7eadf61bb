//! STL, binary and text, read by `stl_io`, which also makes corners of the same bits one vertex.
//!
//! The library tells the two kinds apart by the first line alone, stops at the end of the first of several solids,
//! refuses a solid without a name and a facet whose normal isn't a number, and never says which line it means. So the
//! file is told apart here, and a text is handed over as one solid with plain normals, which a mesh has no use for.

use std::io::{self, Cursor};

use stl_io::IndexedMesh;

use super::MeshData;
use super::text;
use crate::fault::{Fault, excerpt};

/// Eighty bytes that say anything, then the number of triangles.
const HEADER: usize = 84;
/// A normal, three corners and two bytes of attributes.
const TRIANGLE: usize = 50;
/// From `facet` to `endfacet`.
const LINES_OF_A_FACET: usize = 7;

pub(super) fn read(bytes: &[u8]) -> Result<MeshData, Fault> {
    let mesh = if is_text(bytes) { read_text(bytes) } else { read_binary(bytes) }?;
    // A file within the size limit has far fewer vertices than a `u32` counts.
    Ok(MeshData {
        vertices: mesh.vertices.iter().map(|vertex| vertex.0).collect(),
        triangles: mesh.faces.iter().map(|face| face.vertices.map(|index| index as u32)).collect(),
    })
}

/// Whether it is the text kind; a binary header may begin with `solid` just as well.
fn is_text(bytes: &[u8]) -> bool {
    // Byte 83 is the highest of the number of triangles: zero in any file within the size limit, and never in a text.
    let head = text::decode(&bytes[..bytes.len().min(HEADER)]);
    head.trim_start().to_ascii_lowercase().starts_with("solid") && bytes.get(HEADER - 1) != Some(&0)
}

fn read_binary(bytes: &[u8]) -> Result<IndexedMesh, Fault> {
    let Some((header, triangles)) = bytes.split_at_checked(HEADER) else {
        return Err(Fault::new(
            "is neither a text that begins with `solid` nor a binary STL, which has 84 bytes or more",
        ));
    };
    let promised = u32::from_le_bytes([header[80], header[81], header[82], header[83]]);
    let found = triangles.len() / TRIANGLE;
    if promised as usize > found {
        return Err(Fault::new(format!("promises {promised} triangles, but has bytes for {found}: is it cut short?")));
    }
    // An empty first line, so that the library can't take the header for a text.
    let mut bytes = bytes.to_vec();
    bytes[0] = b'\n';
    let mesh = read_with_library(&bytes).map_err(|error| Fault::new(excerpt(&error.to_string())))?;
    for (face, number) in mesh.faces.iter().zip(1..) {
        let mut corners = face.vertices.iter().map(|index| mesh.vertices[*index].0);
        if let Some(corner) = corners.find(|corner| !corner.iter().all(|x| x.is_finite())) {
            return Err(Fault::new(format!(
                "triangle {number} has a corner at {corner:?}: expected finite coordinates"
            )));
        }
    }
    Ok(mesh)
}

fn read_text(bytes: &[u8]) -> Result<IndexedMesh, Fault> {
    let text = text::decode(bytes);
    let solid = one_solid(&text)?;
    read_with_library(solid.as_bytes()).map_err(|error| {
        // The library doesn't say where, but shows how far it gets; the lines are the same in both texts.
        let read = facets_before_fault(solid.as_bytes());
        let mut full = solid.lines().zip(1..).skip(1).filter(|(line, _)| !line.trim().is_empty());
        let start = full.nth(read * LINES_OF_A_FACET).map_or(1, |(_, line)| line);
        Fault::at(start, format!("the facet that should begin here: {}", excerpt(&error.to_string())))
    })
}

/// The text, line for line, as a single solid in lower case with plain normals.
fn one_solid(text: &str) -> Result<String, Fault> {
    let mut solid = String::from("solid \n");
    let mut ended = false;
    for line in text::lines(text).skip(1) {
        let lower = line.content.to_ascii_lowercase();
        let mut words = lower.split_whitespace();
        match words.next() {
            None => {}
            Some("solid") => ended = false,
            Some("endsolid") => ended = true,
            Some("facet") => solid.push_str("facet normal 0 0 0"),
            Some("vertex") => {
                line.point(&mut words)?;
                solid.push_str(&lower);
            }
            Some(_) => solid.push_str(&lower),
        }
        solid.push('\n');
    }
    if !ended {
        let last = text.lines().count();
        return Err(Fault::at(last, "the solid has no `endsolid`: is the file cut short?"));
    }
    solid.push_str("endsolid\n");
    Ok(solid)
}

fn read_with_library(bytes: &[u8]) -> io::Result<IndexedMesh> {
    stl_io::create_stl_reader(&mut Cursor::new(bytes))?.as_indexed_triangles()
}

fn facets_before_fault(bytes: &[u8]) -> usize {
    stl_io::create_stl_reader(&mut Cursor::new(bytes)).map_or(0, |facets| facets.take_while(Result::is_ok).count())
}

#[cfg(test)]
mod tests {
    use super::super::{MeshData, parse};
    use crate::outcome::Outcome;

    const FACET: &str = "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\n";

    fn read(bytes: impl AsRef<[u8]>) -> Outcome<MeshData> {
        parse("x.stl", "stl", bytes.as_ref())
    }

    fn binary(head: &str, promised: u32, triangles: &[[f32; 9]]) -> Vec<u8> {
        let mut bytes = format!("{head:80}").into_bytes();
        bytes.extend(promised.to_le_bytes());
        for corners in triangles {
            bytes.extend([0; 12]);
            bytes.extend(corners.iter().flat_map(|x| x.to_le_bytes()));
            bytes.extend([0; 2]);
        }
        bytes
    }

    #[test]
    fn reads_the_usual_texts() {
        let variants = [
            format!("solid a\n{FACET}endsolid a\n"),
            format!("solid\n{FACET}endsolid"),
            format!("  solid a b c\n\n  {FACET}endsolid a b c\n").replace('\n', "\r\n"),
            format!("solid a\n{FACET}endsolid a\n").replace("0 0 1\n", "nan nan nan\n"),
            format!("solid a\n{FACET}endsolid a\n").to_uppercase(),
            format!("solid a\n{FACET}endsolid a\n").replace("vertex 1", "  vertex\t1.0e+00"),
        ];
        for variant in variants {
            let mesh = read(&variant).unwrap();
            assert_eq!(mesh.vertices, [[0., 0., 0.], [1., 0., 0.], [0., 1., 0.]], "{variant}");
            assert_eq!(mesh.triangles, [[0, 1, 2]], "{variant}");
        }
        assert!(read([b"solid caf\xe9\n", FACET.as_bytes(), b"endsolid caf\xe9"].concat()).is_ok());
    }

    #[test]
    fn solids_become_one_mesh_with_shared_vertices() {
        let other = FACET.replace("0 1 0", "0 2 0");
        let mesh = read(format!("solid a\n{FACET}endsolid a\nsolid b\n{other}{FACET}endsolid b\n")).unwrap();
        assert_eq!(mesh.vertices.len(), 4);
        assert_eq!(mesh.triangles, [[0, 1, 2], [0, 1, 3], [0, 1, 2]]);
    }

    #[test]
    fn a_binary_header_may_say_anything() {
        let corners = [0., 0., 0., 1., 0., 0., 0., 1., 0.];
        for head in ["", "made by hand", "solid ", "solid a\nfacet"] {
            let mesh = read(binary(head, 1, &[corners, corners])).unwrap();
            assert_eq!((mesh.vertices.len(), mesh.triangles), (3, vec![[0, 1, 2]]), "{head}");
        }
    }

    #[test]
    fn errors_in_texts_name_the_line_and_the_value() {
        let two = format!("solid a\n{FACET}\n{FACET}endsolid a\n");
        let cases = [
            (
                two.replacen("vertex 1 0 0", "vertex 1 x 0", 1),
                "x.stl:5: `x`: expected a finite coordinate within ±3.4e38",
            ),
            (
                two.replacen("vertex 1 0 0", "vertex 1 0 inf", 1),
                "x.stl:5: `inf`: expected a finite coordinate within ±3.4e38",
            ),
            (two.replacen("vertex 1 0 0", "vertex 1 0", 1), "x.stl:5: `vertex 1 0`: expected three coordinates"),
            (
                two.replace("endfacet\nendsolid", "endsolid"),
                "x.stl:10: the facet that should begin here: expected [\"endfacet\"], got [\"endsolid\"]",
            ),
            (two.replace("endsolid a\n", ""), "x.stl:16: the solid has no `endsolid`: is the file cut short?"),
            ("solid a\nendsolid a\n".into(), "x.stl: has no triangles: a mesh needs at least one face"),
            (
                "solid a\nfoo\nendsolid\n".into(),
                "x.stl:2: the facet that should begin here: invalid facet header: [\"foo\"]",
            ),
        ];
        for (text, expected) in cases {
            assert_eq!(read(text).unwrap_err().to_string(), expected);
        }
    }

    #[test]
    fn errors_in_binaries_name_the_value() {
        let corners = [0., 0., 0., 1., 0., 0., 0., 1., 0.];
        let cases = [
            (
                b"OFF\n".to_vec(),
                "is neither a text that begins with `solid` nor a binary STL, which has 84 bytes or more",
            ),
            (binary("", 2, &[corners]), "promises 2 triangles, but has bytes for 1: is it cut short?"),
            (binary("", u32::MAX, &[]), "promises 4294967295 triangles, but has bytes for 0: is it cut short?"),
            (binary("", 0, &[]), "has no triangles: a mesh needs at least one face"),
            (
                binary("", 2, &[corners, [0., 0., 0., 0., f32::NAN, 1., 1., 1., 1.]]),
                "triangle 2 has a corner at [0.0, NaN, 1.0]: expected finite coordinates",
            ),
        ];
        for (bytes, expected) in cases {
            assert_eq!(read(bytes).unwrap_err().to_string(), format!("x.stl: {expected}"));
        }
    }
}
