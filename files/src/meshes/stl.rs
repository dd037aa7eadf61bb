//! STL, binary and text; corners of the same bits are one vertex.
//!
//! This reader is our own: `stl_io` 0.11 tells the two kinds apart by the first line alone, stops at the end of the first
//! of several solids, refuses a solid without a name and a facet whose normal isn't a number, and never says which line
//! it means.

use super::MeshData;
use super::text;
use crate::fault::Fault;
use std::collections::HashMap;

/// Eighty bytes that say anything, then the number of triangles.
const HEADER: usize = 84;
/// A normal, three corners and two bytes of attributes.
const TRIANGLE: usize = 50;
/// The words that the lines of a facet begin with.
const FACET: [&str; 7] = ["facet", "outer", "vertex", "vertex", "vertex", "endloop", "endfacet"];

pub(super) fn read(bytes: &[u8]) -> Result<MeshData, Fault> {
    let facets = if is_text(bytes) { read_text(&text::decode(bytes)) } else { read_binary(bytes) }?;
    let (mut mesh, mut known) = (MeshData::default(), HashMap::new());
    for corners in facets {
        mesh.triangles.push(corners.map(|corner| {
            *known.entry(corner.map(f32::to_bits)).or_insert_with(|| {
                mesh.vertices.push(corner);
                // A file within the size limit has far fewer vertices than a `u32` counts.
                mesh.vertices.len() as u32 - 1
            })
        }));
    }
    Ok(mesh)
}

/// Whether it is the text kind; a binary header may begin with `solid` just as well.
fn is_text(bytes: &[u8]) -> bool {
    // Byte 83 is the highest of the number of triangles: zero in any file within the size limit, and never in a text.
    let head = text::decode(&bytes[..bytes.len().min(HEADER)]);
    head.trim_start().to_ascii_lowercase().starts_with("solid") && bytes.get(HEADER - 1) != Some(&0)
}

fn read_binary(bytes: &[u8]) -> Result<Vec<[[f32; 3]; 3]>, Fault> {
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
    let float = |bytes: &[u8], at: usize| f32::from_le_bytes([bytes[at], bytes[at + 1], bytes[at + 2], bytes[at + 3]]);
    let corners = |bytes| [12, 24, 36].map(|at| [0, 4, 8].map(|axis| float(bytes, at + axis)));
    let facets: Vec<_> = triangles.chunks_exact(TRIANGLE).take(promised as usize).map(corners).collect();
    for (corners, number) in facets.iter().zip(1..) {
        if let Some(corner) = corners.iter().find(|corner| !corner.iter().all(|x| x.is_finite())) {
            return Err(Fault::new(format!(
                "triangle {number} has a corner at {corner:?}: expected finite coordinates"
            )));
        }
    }
    Ok(facets)
}

fn read_text(text: &str) -> Result<Vec<[[f32; 3]; 3]>, Fault> {
    let (mut facets, mut corners, mut ended, mut next) = (Vec::new(), [[0.0; 3]; 3], false, 0);
    for line in text::lines(text).skip(1).filter(|line| !line.content.is_empty()) {
        let lower = line.content.to_ascii_lowercase();
        let mut words = lower.split_whitespace();
        match words.next() {
            Some(word @ ("solid" | "endsolid")) if next == 0 => ended = word == "endsolid",
            Some(word) if word == FACET[next] => {
                if word == "vertex" {
                    corners[next - 2] = line.point(&mut words)?;
                }
                next = (next + 1) % FACET.len();
                facets.extend((next == 0).then_some(corners));
            }
            _ => return Err(line.fault(&format!("`{}`", FACET[next]))),
        }
    }
    match ended && next == 0 {
        true => Ok(facets),
        false => Err(Fault::at(text.lines().count(), "the solid has no `endsolid`: is the file cut short?")),
    }
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
            (two.replace("endfacet\nendsolid", "endsolid"), "x.stl:16: `endsolid a`: expected `endfacet`"),
            (two.replace("endsolid a\n", ""), "x.stl:16: the solid has no `endsolid`: is the file cut short?"),
            ("solid a\nendsolid a\n".into(), "x.stl: has no triangles: a mesh needs at least one face"),
            ("solid a\nfoo\nendsolid\n".into(), "x.stl:2: `foo`: expected `facet`"),
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
