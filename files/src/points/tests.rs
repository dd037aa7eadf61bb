//! Points that are read right, and files that are refused with the row and the value.

use super::{Cloud, PointsFormat, read};
use pointmass::Vec3;

fn load(format: PointsFormat, bytes: impl AsRef<[u8]>) -> Result<Cloud, String> {
    read(bytes.as_ref(), format).map_err(|fault| format!("f{fault}"))
}

fn points(format: PointsFormat, bytes: impl AsRef<[u8]>) -> Vec<[f32; 3]> {
    let shown = String::from_utf8_lossy(bytes.as_ref()).into_owned();
    let cloud = load(format, bytes).unwrap_or_else(|fault| panic!("{fault} in {shown}"));
    cloud.points.iter().map(Vec3::to_array).collect()
}

#[track_caller]
fn refused(format: PointsFormat, cases: &[(&str, &str)]) {
    for (bytes, expected) in cases {
        let said = load(format, bytes).map(|cloud| cloud.points.len());
        assert!(
            said.as_ref().is_err_and(|said| said.starts_with(expected)),
            "{said:?}, expected {expected}, of {bytes}"
        );
    }
}

const TWO: [[f32; 3]; 2] = [[1.0, 2.0, 3.0], [-4.5, 0.25, 6.0]];

#[test]
fn tables_have_heads_or_none_and_any_delimiter() {
    for text in [
        "x,y,z\n1,2,3\n-4.5,.25,6e0\n",
        "1,2,3\n-4.5,0.25,6",
        "\u{feff}X, Y , z\r\n1, 2 ,3\r\n\r\n-4.5,0.25,6\r\n",
        "id;mass;z;y;x\n0;9;3;2;1\n1;9;6;0.25;-4.5\n",
        "position.x\tposition.y\tposition.z\n1\t2\t3\n-4.5\t0.25\t6\n",
        "\"x\",\"y\",\"z\",\"name\"\n1,2,3,\"a,b\"\n-4.5,0.25,6,c\n",
        "name,x,y,z\na,1,2,3\nb,-4.5,0.25,6\n",
        "a,1,2,3\nb,-4.5,0.25,6\n",
        "left,up,front\n1,2,3\n-4.5,0.25,6\n",
        "# a comment\n1 2 3\n-4.5   0.25  6\n",
        "step,time,id,x,y,z\n0,0,0,7,7,7\n0,0,1,8,8,8\n10,1,0,1,2,3\n10,1,1,-4.5,0.25,6\n",
    ] {
        assert_eq!(points(PointsFormat::Csv, text), TWO, "{text}");
    }
    for text in [
        "# id x y z\n7 1 2 3\n8 -4.5 0.25 6\n",
        "//X Y Z R\n1 2 3 255\n-4.5 0.25 6 255\n",
        "# id, x, y, z\n7 1 2 3\n8 -4.5 0.25 6\n",
        "point;East [m];North [m];height (m)\n7;1;2;3\n8;-4.5;0.25;6\n",
        "height,x,y,z\n9,1,2,3\n9,-4.5,0.25,6\n",
        "X,1,2,3\nX,-4.5,0.25,6\n",
        "tree,1,2,3,n/a\nnan,-4.5,0.25,6,7\n",
        "# an x and a y\n1 2 3\n-4.5 .25 6\n",
        "# x y z\n1 2 3 7\n-4.5 .25 6 7\n",
        "step,x,y,z\n1,1,2,3\n2,-4.5,.25,6\n",
    ] {
        assert_eq!(points(PointsFormat::Csv, text), TWO, "{text}");
    }
    assert_eq!(points(PointsFormat::Csv, "x,y\n1,2\n"), [[1.0, 2.0, 0.0]]);
    assert_eq!(points(PointsFormat::Csv, "1,2\n3,4\n"), [[1.0, 2.0, 0.0], [3.0, 4.0, 0.0]]);
}

#[test]
fn columns_that_nobody_names_are_told() {
    let columns = |text: &str| load(PointsFormat::Csv, text).map(|cloud| cloud.columns);
    assert_eq!(columns("a,1,2,3\nb,4,5,6\n"), Ok(vec![2, 3, 4]));
    assert_eq!(columns("time,left,up\n1,2,3\n"), Ok(vec![1, 2, 3]));
    assert_eq!(columns("1,2\n4,5\n"), Ok(vec![1, 2]));
    assert_eq!(columns("x,y,z\n1,2,3\n"), Ok(vec![]));
    assert_eq!(columns("# x y z\n1 2 3\n"), Ok(vec![]));
}

#[test]
fn what_lies_far_from_zero_is_moved_there_before_digits_are_lost() {
    // A survey in UTM coordinates, with millimetres.
    let rows: [[f64; 3]; 3] =
        [[500_000.123, 5_400_000.456, 311.5], [500_900.124, 5_400_800.457, 312.0], [500_100.5, 5_400_100.25, 9.0]];
    let table: String = rows.iter().map(|[x, y, z]| format!("{x},{y},{z}\n")).collect();
    let doubles: Vec<u8> = rows.as_flattened().iter().flat_map(|x| x.to_le_bytes()).collect();
    let ply = PLY.replace("float", "double").replace("vertex 2", "vertex 3").replace("ascii", "binary_little_endian");
    for (format, bytes) in [
        (PointsFormat::Csv, table.clone().into_bytes()),
        (PointsFormat::Xyz, table.into_bytes()),
        (PointsFormat::Npy, npy("<f8", false, "(3, 3)", &doubles)),
        (PointsFormat::Ply, [ply.into_bytes(), doubles.clone()].concat()),
    ] {
        let cloud = load(format, bytes).unwrap();
        assert_eq!(cloud.origin, [500_500.0, 5_400_400.0, 0.0], "{format:?}");
        for (point, row) in cloud.points.iter().zip(rows) {
            let back = [0, 1, 2].map(|axis| f64::from(point[axis]) + cloud.origin[axis]);
            // Half a unit in the last place of 400 or so.
            assert!(back.iter().zip(row).all(|(a, b)| (a - b).abs() <= 2e-5), "{format:?}: {back:?}, {row:?}");
        }
    }
}

#[test]
fn what_lies_near_zero_or_loses_nothing_stays_where_it_is() {
    for text in [
        "0.1,0.2,0.3\n0.9,0.8,0.7\n",
        "-1000.1,-1000.2,0\n999.9,1000.3,0\n",
        // Single precision holds all of these.
        "500000,5400000,16777216\n500001,5400001.5,16777218\n",
        // In one place.
        "0.1,0.2,0.3\n0.1,0.2,0.3\n",
    ] {
        assert_eq!(load(PointsFormat::Csv, text).map(|cloud| cloud.origin), Ok([0.0; 3]), "{text}");
    }
    assert_eq!(load(PointsFormat::Csv, "3e38,1,1\n3.1e38,1,1\n").map(|cloud| cloud.points[0].is_finite()), Ok(true));
}

#[test]
fn rows_that_are_not_finite_are_skipped_and_counted() {
    let cloud = load(PointsFormat::Csv, "x,y,z\n1,2,3\nnan,0,0\n0,inf,0\n0,-Infinity,NaN\n1e39,0,0\n4,5,6\n").unwrap();
    assert_eq!((cloud.points.len(), cloud.skipped), (2, 4));
    let cloud = load(PointsFormat::Xyz, "1 2 3\nnan 0 0\n4 5 6\n").unwrap();
    assert_eq!((cloud.points.len(), cloud.skipped), (2, 1));
    let cloud = load(PointsFormat::Ply, format!("{PLY}1 2 3\nnan 0 0\n")).unwrap();
    assert_eq!((cloud.points.len(), cloud.skipped), (1, 1));
    let cloud =
        load(PointsFormat::Npy, npy("<f4", false, "(2, 3)", &f32s(&[1.0, 2.0, 3.0, f32::NAN, 0.0, 0.0]))).unwrap();
    assert_eq!((cloud.points.len(), cloud.skipped), (1, 1));
    let cloud = load(PointsFormat::Csv, "step,id,x,y\n0,0,nan,1\n1,0,2,3\n").unwrap();
    assert_eq!((cloud.points.len(), cloud.skipped, cloud.earlier), (1, 0, 1), "those of the last record");
}

#[test]
fn bad_tables_are_refused_with_row_and_value() {
    refused(
        PointsFormat::Csv,
        &[
            ("x,y,z\n1,2,3\n1,zwei,3\n", "f:3: `zwei` in column 2: expected a number as y"),
            ("1,2,3\n1,2\n", "f:2: `1,2`: 2 fields: expected z in column 3"),
            ("x,y,z\n1,2,\n", "f:2: `` in column 3: expected a number as z"),
            ("x;y\n1,5;2,5\n", "f:2: `1,5` in column 1: expected a number as x, with a decimal point"),
            ("x,z\n1,2\n", "f:1: `x,z`: expected columns x and y"),
            ("a,b,c\nd,e,f\n", "f:2: `d,e,f`: expected two or three columns of numbers"),
            ("5\n6\n", "f:1: `5`: expected two or three columns of numbers"),
            ("1.0,oops,3.0\n4,5,6\n", "f:1: `oops` in column 2: expected a number, as in line 2"),
            ("1.0,2,oops\n4,5,6\n", "f:1: `oops` in column 3: expected a number, as in line 2"),
            ("1,,3\n4,,6\n7,8,9\n", "f:1: `` in column 2: expected a number, as in line 3"),
            ("oops,1,2,3\n4,5,6,7\n", "f:1: `oops` in column 1: expected a number"),
            ("1,2,oops,3\n1,2,3,4\n", "f:1: `oops` in column 3: expected a number"),
            ("1,2\n3,4,5\n", "f:2: `3,4,5`: 3 fields: expected 2, as in line 1"),
            ("1.0m,2.0m,3.0m\n1,2,3\n", "f:1: `1.0m,2.0m,3.0m`: expected two or three columns of numbers"),
            ("x,y,z\n1 m,2 m,3 m\n", "f:2: `1 m` in column 1: expected a number as x"),
            ("x,y,z\r1,2,3\r", "f:1: lines end with \\r alone"),
            ("x\0,\0y\0", "f:1: is no text"),
            ("x,y,z\r\n1,2,3\r\n\r\n1,2,three\r\n", "f:4: `three` in column 3"),
            ("x,y,z\n1,2,\"3\n4,5,6\n", "f:2: `\"3` in column 3"),
            ("x,y,z\n\n\n1,2,\u{fffd}\n", "f:4: `\u{fffd}` in column 3"),
            ("", "f: is empty: expected points"),
        ],
    );
    assert!(load(PointsFormat::Csv, b"\xff\xfex\0,\0").is_err_and(|said| said.starts_with("f:1: is UTF-16")));
    assert!(load(PointsFormat::Csv, b"x,y,z\n1,2,\xff\n").is_err_and(|said| said.starts_with("f:2: ")));
}

#[test]
fn atoms_and_bare_lines_are_read() {
    for text in [
        "2\ncomment\nX 1 2 3 0 0 0\nHe -4.5 0.25 6\n",
        "1\nfirst\nX 9 9 9\n2\nsecond\nX 1 2 3\nX -4.5 0.25 6\n\n",
        "2\nProperties=id:I:1:species:S:1:pos:R:3 Time=1\n0 X 1 2 3\n1 X -4.5 0.25 6\n",
        "1 2 3\n-4.5 0.25 6\n",
        "# x y z\n\n1\t2\t3 255 0 0\r\n-4.5,0.25,6 1 2 3\r\n",
        "X 1 2 3\nHe -4.5 0.25 6\n",
    ] {
        assert_eq!(points(PointsFormat::Xyz, text), TWO, "{text}");
    }
    assert_eq!(points(PointsFormat::Xyz, "1 2\n3 4\n"), [[1.0, 2.0, 0.0], [3.0, 4.0, 0.0]]);
    assert_eq!(
        load(PointsFormat::Xyz, "1\na\nX 9 9 9\n0\nb\n").map(|cloud| (cloud.points.len(), cloud.earlier)),
        Ok((0, 1))
    );
    refused(
        PointsFormat::Xyz,
        &[
            ("1 2 3\n1 x 3\n", "f:2: `1 x 3`: expected the numbers x y z"),
            ("1 2 3\n4 5\n", "f:2: `4 5`: expected the numbers x y z"),
            ("1 2\n4 5 6\n", "f:2: `4 5 6`: expected the numbers x y z"),
            ("1 2 3\nX 4 5 6\n", "f:2: `X 4 5 6`: expected the numbers x y z"),
            ("1 2 3\n7\n", "f:2: `7`: expected the numbers x y z"),
            ("2\nc\nX 1 2 3\nX 1 2\n", "f:4: `X 1 2`: expected the numbers x y z"),
            ("3\nc\nX 1 2 3\n", "f:4: the file ends here: expected atom 2 of 3"),
            ("99999999999999999\nc\nX 1 2 3\n", "f:4: the file ends here"),
            ("1\nc\nX 1 2 3\nX 1 2 3\n", "f:4: `X 1 2 3`: expected the number of atoms of another record"),
            ("hello\n", "f:1: `hello`: expected the numbers x y z"),
        ],
    );
}

const PLY: &str =
    "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\nproperty float z\nend_header\n";

#[test]
fn clouds_of_both_kinds_are_read() {
    assert_eq!(points(PointsFormat::Ply, format!("{PLY}1 2 3\n-4.5 .25 6\n")), TWO);
    let mesh = PLY.replace("end", "element face 1\nproperty list uchar int vertex_index\nend")
        + "1 2 3\n-4.5 .25 6\n3 0 1 0\n";
    assert_eq!(points(PointsFormat::Ply, mesh), TWO);
    let flat = PLY.replace("property float z\n", "") + "1 2\n3 4\n";
    assert_eq!(points(PointsFormat::Ply, flat), [[1.0, 2.0, 0.0], [3.0, 4.0, 0.0]]);
    for (name, double, little) in [("binary_little_endian", false, true), ("binary_big_endian", true, false)] {
        let mut bytes = PLY.replace("ascii", name).into_bytes();
        if double {
            bytes = String::from_utf8(bytes).unwrap().replace("float", "double").into_bytes();
        }
        for x in TWO.as_flattened() {
            match (double, little) {
                (false, true) => bytes.extend(x.to_le_bytes()),
                _ => bytes.extend(f64::from(*x).to_be_bytes()),
            }
        }
        assert_eq!(points(PointsFormat::Ply, &bytes), TWO, "{name}");
        bytes.pop();
        assert!(
            load(PointsFormat::Ply, bytes).is_err_and(|said| said.starts_with("f: vertex 2 of 2: the file ends here"))
        );
    }
    let cases = [
        (format!("{PLY}1 2 3\n1 x 3\n"), "f:9: vertex 2 of 2: `1 x 3`: expected numbers for x, y, z"),
        (format!("{PLY}1 2 3\n"), "f:8: vertex 2 of 2: the file ends here"),
        (PLY.replace("float y", "float why"), "f: header: expected an element `vertex` with properties x, y and z"),
        ("OFF\n".into(), "f:1: expected `ply`"),
    ];
    refused(PointsFormat::Ply, &cases.each_ref().map(|(bytes, expected)| (bytes.as_str(), *expected)));
}

fn f32s(numbers: &[f32]) -> Vec<u8> {
    numbers.iter().flat_map(|x| x.to_le_bytes()).collect()
}

fn npy(kind: &str, fortran: bool, shape: &str, data: &[u8]) -> Vec<u8> {
    let order = if fortran { "True" } else { "False" };
    let head = format!("{{'descr': '{kind}', 'fortran_order': {order}, 'shape': {shape}, }}\n");
    let mut bytes = b"\x93NUMPY\x01\x00".to_vec();
    bytes.extend((head.len() as u16).to_le_bytes());
    bytes.extend(head.as_bytes());
    bytes.extend(data);
    bytes
}

#[test]
fn arrays_of_either_order_and_precision_are_read() {
    let rows = TWO.as_flattened();
    let columns: Vec<f32> = (0..3).flat_map(|axis| TWO.map(|row| row[axis])).collect();
    let little = |numbers: &[f32]| numbers.iter().flat_map(|x| f64::from(*x).to_le_bytes()).collect::<Vec<_>>();
    let big = |numbers: &[f32]| numbers.iter().flat_map(|x| x.to_be_bytes()).collect::<Vec<_>>();
    for bytes in [
        npy("<f4", false, "(2, 3)", &f32s(rows)),
        npy("<f8", false, "(2,3)", &little(rows)),
        npy(">f4", false, "(2, 3)", &big(rows)),
        npy("<f4", true, "(2, 3)", &f32s(&columns)),
        npy("<f8", true, "(2, 3)", &little(&columns)),
    ] {
        assert_eq!(points(PointsFormat::Npy, bytes), TWO);
    }
    assert_eq!(points(PointsFormat::Npy, npy("<f4", false, "(1, 2)", &f32s(&[1.0, 2.0]))), [[1.0, 2.0, 0.0]]);
    assert_eq!(points(PointsFormat::Npy, npy("<f4", true, "(1, 2)", &f32s(&[1.0, 2.0]))), [[1.0, 2.0, 0.0]]);
    // More than one chunk.
    let many: Vec<f32> = (0..30_000).map(|i| i as f32).collect();
    let read = points(PointsFormat::Npy, npy("<f4", false, "(10000, 3)", &f32s(&many)));
    assert!(read.iter().zip(0u16..).all(|(point, i)| point[2] == 3.0 * f32::from(i) + 2.0) && read.len() == 10_000);
    let read = points(PointsFormat::Npy, npy("<f4", true, "(10000, 3)", &f32s(&many)));
    assert!(read.iter().zip(0u16..).all(|(point, i)| point[2] == f32::from(i) + 20_000.0) && read.len() == 10_000);
}

#[test]
fn bad_arrays_are_refused() {
    let data = f32s(&[1.0; 6]);
    let cases = [
        (npy("<i4", false, "(2, 3)", &data), "f: head: type '<i4': expected float32 or float64"),
        (npy("<f4", false, "(3, 2, 1)", &data), "f: head: shape (3, 2, 1): expected (N, 3) or (N, 2)"),
        (npy("<f4", false, "(6,)", &data), "f: head: shape (6,): expected (N, 3) or (N, 2)"),
        (npy("<f4", false, "(3, 3)", &data), "f: the file ends before row 3 of 3: is it cut short?"),
        (npy("<f4", false, "(99999999999999, 3)", &data), "f: the file ends before row 4096 of 99999999999999"),
        (npy("<f4", true, "(99999999999999, 3)", &data), "f: the file ends before row 4096 of"),
        (npy("<f4", false, "(99999999999999999999999, 3)", &data), "f: head: shape "),
        (npy("<f4", false, "oops", &data), "f: head: "),
        (b"\x93NUMPY\x01\x00\xff\xff{".to_vec(), "f: the head ends early: is it cut short?"),
        (b"\x93NUMPY\x02\x00\xff\xff\xff\xff{".to_vec(), "f: has a head of 4294967295 bytes"),
        (b"x,y,z\n1,2,3\n".to_vec(), "f: expected an array as numpy.save writes it"),
        (b"\x93NUM".to_vec(), "f: the head ends early"),
    ];
    for (bytes, expected) in cases {
        let said = load(PointsFormat::Npy, bytes).map(|cloud| cloud.points.len());
        assert!(said.as_ref().is_err_and(|said| said.starts_with(expected)), "{said:?}, expected {expected}");
    }
}

/// A valid file of a format.
fn valid(format: PointsFormat) -> Vec<u8> {
    match format {
        PointsFormat::Csv => b"step,id,x,y,z\n0,7,1,2,3\n1,7,-4.5,0.25,6\n".to_vec(),
        PointsFormat::Ply => format!("{PLY}1 2 3\n-4.5 .25 6\n").into_bytes(),
        PointsFormat::Xyz => b"2\nProperties=species:S:1:pos:R:3\nX 1 2 3\nX -4.5 0.25 6\n".to_vec(),
        PointsFormat::Npy => npy("<f4", true, "(2, 3)", &f32s(TWO.as_flattened())),
    }
}

proptest::proptest! {
    #[test]
    fn whatever_the_bytes_are_nothing_panics(
        noise in proptest::collection::vec(proptest::num::u8::ANY, 0..200),
        at in 0usize..200,
        cut in 0usize..4,
    ) {
        for format in [PointsFormat::Csv, PointsFormat::Ply, PointsFormat::Xyz, PointsFormat::Npy] {
            let _ = load(format, &noise);
            let mut bytes = valid(format);
            let at = at % bytes.len();
            let end = (at + cut).min(bytes.len());
            bytes.splice(at..end, noise.iter().copied().take(3));
            let cloud = load(format, &bytes);
            assert!(cloud.is_err() || cloud.is_ok_and(|cloud| cloud.points.iter().all(|point| point.is_finite())));
        }
    }
}
