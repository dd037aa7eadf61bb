//! PLY, text and binary of both byte orders, read by `ply-rs-bw`.
//!
//! The library is asked for one element at a time: reading a whole file it keeps every list of every element, believes
//! counts of elements that take no bytes, and doesn't say which element of a binary file it means.

mod elements;
mod header;
mod payload;

use ply_rs_bw::ply::Property;

use super::MeshData;
use super::text;
use crate::fault::Fault;
use crate::outcome::excerpt;
use elements::Face;
pub(crate) use elements::{Point, Skipped};
pub(crate) use header::split;

pub(super) fn read(bytes: &[u8]) -> Result<MeshData, Fault> {
    let (header, mut payload) = header::split(bytes)?;
    let vertices = header::check(&header)?;
    let mut mesh = MeshData::default();
    for element in header.elements.values() {
        for number in 1..=element.count {
            // Nothing is stored for an element without properties, so it would be read forever.
            if element.properties.is_empty() {
                break;
            }
            match element.name.as_str() {
                "vertex" => {
                    let Point(point) = payload.next(element, number)?;
                    let point = point.map(|x| x as f32);
                    if !point.iter().all(|x| x.is_finite()) {
                        return Err(payload.fault(element, number, &format!("{point:?}: expected finite coordinates")));
                    }
                    mesh.vertices.push(point);
                }
                "face" => {
                    let Face(list) = payload.next(element, number)?;
                    let corners = corners(list.as_ref(), vertices).map_err(|m| payload.fault(element, number, &m))?;
                    mesh.add_polygon(&corners);
                }
                _ => {
                    let Skipped = payload.next(element, number)?;
                }
            }
        }
    }
    Ok(mesh)
}

/// The corners of a face, at least three, all below `vertices`.
fn corners(list: Option<&Property>, vertices: usize) -> Result<Vec<u32>, String> {
    let list = list.ok_or("has no vertex indices")?;
    let corners = list.to_u32_list().ok_or_else(|| match smallest(list) {
        Some(index) => format!("{index}: expected an index from 0 up"),
        None => "expected whole numbers as indices".to_owned(),
    })?;
    if corners.len() < 3 {
        return Err(format!("{corners:?}: expected three corners or more"));
    }
    match corners.iter().find(|index| **index as usize >= vertices) {
        Some(index) => Err(format!("{index}: expected an index below {vertices}, the number of vertices")),
        None => Ok(corners),
    }
}

/// The smallest number in a list of a signed type.
fn smallest(list: &Property) -> Option<i32> {
    match list {
        Property::ListChar(list) => list.iter().copied().map(i32::from).min(),
        Property::ListShort(list) => list.iter().copied().map(i32::from).min(),
        Property::ListInt(list) => list.iter().copied().min(),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::super::{MeshData, parse};
    use crate::outcome::Outcome;

    const HEAD: &str = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n\
                        element face 1\nproperty list uchar int vertex_indices\nend_header\n";
    const BODY: &str = "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";

    fn read(bytes: impl AsRef<[u8]>) -> Outcome<MeshData> {
        parse("x.ply", "ply", bytes.as_ref())
    }

    #[test]
    fn reads_the_usual_texts() {
        let variants = [
            format!("{HEAD}{BODY}"),
            format!("{HEAD}{BODY}").replace('\n', "\r\n"),
            format!("{HEAD}\n{}", BODY.trim_end()),
            format!("{HEAD}{BODY}").replace("vertex_indices", "vertex_index").replace("float", "float64"),
            format!("{HEAD}{BODY}").replace("uchar int", "uint8 uint32").replace("format", "comment by hand\nformat"),
            format!("{HEAD}{BODY}").replace("1 0 0", "1. .0e1 +0"),
            // Normals that aren't numbers, elements nobody needs, and ones that take no bytes.
            format!("{HEAD}{BODY}").replace("float z", "float z\nproperty float nx").replace(" 0\n", " 0 nan\n"),
            format!("{HEAD}7 8\n{BODY}").replace("element vertex", "element edge 1\nproperty int a\nelement vertex"),
            format!("{HEAD}{BODY}").replace("element vertex", "element nothing 18446744073709551615\nelement vertex"),
        ];
        for variant in variants {
            let mesh = read(&variant).unwrap_or_else(|error| panic!("{error} in {variant}"));
            assert_eq!(mesh.vertices, [[0., 0., 0.], [1., 0., 0.], [0., 1., 0.]], "{variant}");
            assert_eq!(mesh.triangles, [[0, 1, 2]], "{variant}");
        }
        assert!(read([b"ply\ncomment caf\xe9\n", &HEAD.as_bytes()[4..], BODY.as_bytes()].concat()).is_ok());
    }

    #[test]
    fn faces_may_come_before_vertices() {
        let head = "ply\nformat ascii 1.0\nelement face 1\nproperty list uchar int vertex_index\nelement vertex 3\n\
                    property float x\nproperty float y\nproperty float z\nend_header\n";
        assert_eq!(read(format!("{head}3 0 1 2\n0 0 0\n1 0 0\n0 1 0\n")).unwrap().triangles, [[0, 1, 2]]);
    }

    #[test]
    fn errors_name_the_line_and_the_value() {
        let cases = [
            ("3 0 1 2", "3 0 1 3", "x.ply:13: face 1 of 1: 3: expected an index below 3, the number of vertices"),
            ("3 0 1 2", "3 0 1 -2", "x.ply:13: face 1 of 1: -2: expected an index from 0 up"),
            (
                "3 0 1 2",
                "3 0 1 4294967296",
                "x.ply:13: face 1 of 1: `3 0 1 4294967296`: expected numbers for vertex_indices",
            ),
            ("3 0 1 2", "2 0 1", "x.ply:13: face 1 of 1: [0, 1]: expected three corners or more"),
            (
                "3 0 1 2",
                "9999999999 0 1",
                "x.ply:13: face 1 of 1: `9999999999 0 1`: expected numbers for vertex_indices",
            ),
            ("1 0 0", "1 x 0", "x.ply:11: vertex 2 of 3: `1 x 0`: expected numbers for x, y, z"),
            ("1 0 0", "1 nan 0", "x.ply:11: vertex 2 of 3: [1.0, inf, 0.0]: expected finite coordinates"),
            ("1 0 0", "1 1e39 0", "x.ply:11: vertex 2 of 3: [1.0, inf, 0.0]: expected finite coordinates"),
            ("vertex 3", "vertex 9", "x.ply:13: vertex 5 of 9: the file ends here: is it cut short?"),
            (
                "face 1",
                "face 18446744073709551615",
                "x.ply:13: face 2 of 18446744073709551615: the file ends here: is it cut short?",
            ),
            ("uchar int", "uchar float", "x.ply:13: face 1 of 1: expected whole numbers as indices"),
            ("face 1", "face 0", "x.ply: has no triangles: a mesh needs at least one face"),
            ("face 1", "face -1", "x.ply:7: `element face -1`: expected a line of a PLY header"),
            ("face 1", "strip 1", "x.ply: header: expected an element `face` with a list `vertex_indices`"),
            ("float z", "float w", "x.ply: header: expected an element `vertex` with properties x, y and z"),
            ("ascii", "utf8", "x.ply:2: `format utf8 1.0`: expected a line of a PLY header"),
            ("format ascii 1.0\n", "", "x.ply: header: No format line found."),
            ("end_header\n", "", "x.ply: has no line `end_header`: is it cut short?"),
            ("ply\n", "OFF\n", "x.ply:1: expected `ply`, as a PLY file begins"),
        ];
        for (right, wrong, expected) in cases {
            let text = format!("{HEAD}{BODY}").replacen(right, wrong, 1);
            assert_eq!(read(text).unwrap_err().to_string(), expected);
        }
    }

    #[test]
    fn errors_in_binaries_name_the_element() {
        let head = HEAD.replace("ascii", "binary_little_endian").replace("uchar int", "int int");
        let points: Vec<u8> = [0f32; 9].iter().flat_map(|x| x.to_le_bytes()).collect();
        let with_list = |list: &[i32]| {
            let list: Vec<u8> = list.iter().flat_map(|x| x.to_le_bytes()).collect();
            read([head.as_bytes(), &points, &list].concat()).map_err(|error| error.to_string())
        };
        assert!(with_list(&[3, 0, 1, 2]).is_ok());
        let cut_short = Err("x.ply: face 1 of 1: the file ends here: is it cut short?".to_owned());
        assert_eq!(with_list(&[3, 0, 1]), cut_short);
        assert_eq!(with_list(&[i32::MAX, 0, 1, 2]), cut_short);
        let negative = Err("x.ply: face 1 of 1: List length cannot be negative (i32).".to_owned());
        assert_eq!(with_list(&[-1, 0, 1, 2]), negative);
        let missing = Err("x.ply: face 1 of 1: 3: expected an index below 3, the number of vertices".to_owned());
        assert_eq!(with_list(&[3, 0, 1, 3]), missing);
    }
}
