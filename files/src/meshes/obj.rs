//! Wavefront OBJ: the vertices and faces of all its objects as one mesh.
//!
//! This reader is our own: `tobj` 4.0 makes triangles of polylines (`l 1 2 3`), overflows on a relative index of a
//! normal or texture coordinate that isn't there, refuses files over a remark behind a face, a comment in Latin-1, a
//! one-dimensional `vt` or a vertex colour that others lack, and doesn't say which line it means. Keeping all that from
//! it takes more code than the two statements that make a mesh.

use super::MeshData;
use super::text;
use crate::fault::Fault;
use crate::outcome::excerpt;
use std::borrow::Cow;
use std::iter::repeat_n;

pub(super) fn read(bytes: &[u8]) -> Result<MeshData, Fault> {
    let text = text::decode(bytes);
    let text = joined(&text);
    let mut mesh = MeshData::default();
    // A face may name vertices further down, so the highest index is looked at when all are known.
    let mut highest = None;
    for line in text::lines(&text) {
        let mut words = line.words();
        match words.next() {
            // A weight may follow, meant for curves only, or a colour.
            Some("v") => mesh.vertices.push(line.point(&mut words)?),
            Some("f") => {
                let known = mesh.vertices.len();
                let corners = words.map(|word| corner(word, known, line.number)).collect::<Result<Vec<_>, _>>()?;
                if corners.len() < 3 {
                    return Err(line.fault("a face of three or more corners"));
                }
                highest = highest.max(corners.iter().max().map(|index| (*index, line.number)));
                mesh.add_polygon(&corners);
            }
            // Normals, texture coordinates, materials, groups, lines and curves.
            _ => {}
        }
    }
    match highest {
        Some((index, line)) if index as usize >= mesh.vertices.len() => {
            let vertices = mesh.vertices.len();
            Err(Fault::at(line, format!("names vertex {}, but the file has {vertices} vertices", u64::from(index) + 1)))
        }
        _ => Ok(mesh),
    }
}

/// The text with every line as one that goes on in the next, as a backslash at its end says. Empty ones follow it, so that all others keep
/// their numbers.
fn joined(text: &str) -> Cow<'_, str> {
    if !text.contains('\\') {
        return text.into();
    }
    let (mut joined, mut open) = (String::with_capacity(text.len()), 0);
    for line in text::lines(text) {
        if let Some(part) = line.content.strip_suffix('\\') {
            joined.extend([part, " "]);
            open += 1;
        } else {
            joined.push_str(line.content);
            joined.extend(repeat_n('\n', 1 + open));
            open = 0;
        }
    }
    joined.into()
}

/// The vertex that a corner names: `v`, `v/vt`, `v//vn` or `v/vt/vn`, counted from 1, or back from the latest with -1.
fn corner(word: &str, known: usize, line: usize) -> Result<u32, Fault> {
    let number: Option<i64> = word.split('/').next().and_then(|vertex| vertex.parse().ok());
    let index = number.and_then(|number| match number {
        0 => None,
        1.. => Some(number - 1),
        _ => number.checked_add(known as i64),
    });
    index.and_then(|index| u32::try_from(index).ok()).ok_or_else(|| {
        let back = if known > 0 { format!(" or from -1 back to -{known}") } else { String::new() };
        Fault::at(line, format!("`{}`: expected a vertex number from 1 up{back}", excerpt(word)))
    })
}

#[cfg(test)]
mod tests {
    use super::super::{MeshData, parse};
    use crate::outcome::Outcome;

    const POINTS: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";

    fn read(text: &[u8]) -> Outcome<MeshData> {
        parse("x.obj", "obj", text)
    }

    #[test]
    fn reads_the_usual_variants() {
        let variants = [
            format!("{POINTS}f 1 2 3\n"),
            format!("{POINTS}f 1 2 3").replace('\n', "\r\n"),
            format!("f 1 2 3\n{POINTS}"),
            format!("{POINTS}f -3 -2 -1\n"),
            format!("# made by hand\nmtllib missing.mtl\no\n{POINTS}g a\nusemtl red\ns off\nf 1 2 3 # the only one\n"),
            format!("{POINTS}vt 0.5\nvt 0 1\nvn 0 0 1\nf 1/1/1 2/2/1 3/-9/1\n"),
            format!("{POINTS}vn 0 0 1\nf 1//1 2//1 3//1\n"),
            format!("{POINTS}f 1/1 2/1 3/1\nl 1 2 3\np 1\n"),
            format!("{POINTS}f 1 2 3\n").replacen("0\n", "0 1 0 0\n", 1),
            format!("{POINTS}f 1 2 3\n").replace("0\n", "0 1.0\n"),
            format!("{POINTS}f 1 \\\n2\\\r\n 3\n"),
            format!("# c:\\made\\\n{POINTS}f 1 2 3 \\").replace("v 1 ", "v \\\n1 "),
        ];
        for variant in variants {
            let mesh = read(variant.as_bytes()).unwrap();
            assert_eq!(mesh.vertices, [[0., 0., 0.], [1., 0., 0.], [0., 1., 0.]], "{variant}");
            assert_eq!(mesh.triangles, [[0, 1, 2]], "{variant}");
        }
        assert!(read(&[b"# caf\xe9\n", POINTS.as_bytes(), b"f 1 2 3"].concat()).is_ok());
    }

    #[test]
    fn objects_become_one_mesh_and_polygons_fans() {
        let text = format!("o a\n{POINTS}f 1 2 3\no b\nv 2 2 0\nv 3 3 0\nf 2 4 5 3\nf -1 -2 1\n");
        let mesh = read(text.as_bytes()).unwrap();
        assert_eq!(mesh.vertices.len(), 5);
        assert_eq!(mesh.triangles, [[0, 1, 2], [1, 3, 4], [1, 4, 2], [4, 3, 0]]);
    }

    #[test]
    fn errors_name_the_line_and_the_value() {
        let cases = [
            ("f 1 2 4", "x.obj:4: names vertex 4, but the file has 3 vertices"),
            ("f 1 2 4294967296", "x.obj:4: names vertex 4294967296, but the file has 3 vertices"),
            ("f 1 2", "x.obj:4: `f 1 2`: expected a face of three or more corners"),
            ("v 0 nan 0", "x.obj:4: `nan`: expected a finite coordinate within ±3.4e38"),
            ("v 0 1e39 0", "x.obj:4: `1e39`: expected a finite coordinate within ±3.4e38"),
            ("v 0 1", "x.obj:4: `v 0 1`: expected three coordinates"),
            ("f 1 \\\n 2 \\\n 3\nf 1 2 4", "x.obj:7: names vertex 4, but the file has 3 vertices"),
            ("f 1 \\\n 2", "x.obj:4: `f 1 2`: expected a face of three or more corners"),
            ("", "x.obj: has no triangles: a mesh needs at least one face"),
        ];
        for (statement, expected) in cases {
            assert_eq!(read(format!("{POINTS}{statement}").as_bytes()).unwrap_err().to_string(), expected);
        }
    }

    #[test]
    fn a_corner_that_is_no_vertex_number_is_quoted() {
        let numbers = ["0", "-4", "/3", "x", "4294967297", "99999999999999999999", "-9223372036854775808"];
        for number in numbers {
            let error = read(format!("{POINTS}f 1 2 {number}").as_bytes()).unwrap_err().to_string();
            let expected = "expected a vertex number from 1 up or from -1 back to -3";
            assert_eq!(error, format!("x.obj:4: `{number}`: {expected}"));
        }
        let error = read(b"f 1 2 -1").unwrap_err().to_string();
        assert_eq!(error, "x.obj:1: `-1`: expected a vertex number from 1 up");
    }
}
