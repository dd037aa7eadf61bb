//! `pointmass compare` from outside: its reports, the points it reads, what it refuses.

use crate::scenes::SOURCE;
use crate::tool::Folder;
use pointmass::index::Structure;
use serde_json::Value;

/// The fewest measurements there can be.
const QUICK: &str = "--repeat 1 --neighbours 5 --k 3";

/// The only case of a comparison that goes well, as its JSON tells it.
fn case(folder: &Folder, args: &str) -> Value {
    folder.run(&format!("compare {args} {QUICK} --structures brute --queries count --out case.json")).fine();
    let study: Value = serde_json::from_str(&folder.read("case.json")).expect("JSON");
    study["cases"][0].clone()
}

/// The places of points in a circle, of which each has two others within 1.
fn circle(n: u32) -> impl Iterator<Item = [f32; 3]> {
    let place = move |i| (f64::from(i) / f64::from(n) * std::f64::consts::TAU).sin_cos();
    let radius = 0.9 * f64::from(n) / std::f64::consts::TAU;
    (0..n).map(place).map(move |(sin, cos)| [(radius * cos) as f32, (radius * sin) as f32, 0.5])
}

#[test]
fn a_small_comparison_is_told_in_every_format() {
    let folder = Folder::new();
    let files = "--out a.csv --out a.json --out a.html --out a.svg";
    let said = folder.run(&format!("compare --n 60,200 --distribution uniform,mixed {QUICK} {files}")).fine().stdout;
    let names: Vec<&str> = Structure::ALL.iter().map(|structure| structure.name()).collect();
    for name in &names {
        assert!(said.contains(&format!("\n  {name} ")), "{name} in {said}");
    }
    for word in [
        "uniform, 200 points: radius ",
        "mixed, 60 points: ",
        "  verified against an exhaustive search",
        "Advice for mixed",
        "nearest: use ",
    ] {
        assert!(said.contains(word), "{word} in {said}");
    }

    let study: Value = serde_json::from_str(&folder.read("a.json")).expect("JSON");
    let cases = study["cases"].as_array().expect("cases");
    assert_eq!(cases.len(), 4);
    for case in cases {
        let mean = case["neighbours"].as_f64().expect("a number");
        assert!((mean - 5.0).abs() < 0.5, "{mean} neighbours");
        let contestants = case["contestants"].as_array().expect("contestants");
        assert_eq!(contestants.iter().filter_map(|one| one["name"].as_str()).collect::<Vec<_>>(), names);
        for one in contestants {
            let figures: Vec<_> = one["figures"].as_array().expect("figures").iter().collect();
            let workloads: Vec<_> = figures.iter().filter_map(|figure| figure["workload"].as_str()).collect();
            assert_eq!(workloads, ["build", "refit", "count", "within", "nearest", "pairs", "moving"]);
            assert!(figures.iter().all(|figure| figure["median"].as_f64().is_some_and(|ns| ns > 0.0)), "{one}");
            let found: Vec<_> = figures.iter().map(|figure| figure["found"].as_f64()).collect();
            assert_eq!((found[2], found[3], found[4]), (Some(mean), Some(mean), Some(3.0)), "{one}");
            assert_eq!(found[5], Some(mean / 2.0), "each pair once");
        }
    }

    let sheet = folder.read("a.csv");
    let mut rows = sheet.lines();
    let head: Vec<_> = rows.next().expect("a head").split(',').collect();
    assert!(head.contains(&"median_ns_per_point") && head.contains(&"distance_tests_per_point"), "{head:?}");
    assert_eq!(rows.clone().count(), 4 * names.len() * 7);
    assert!(rows.all(|row| row.split(',').count() == head.len()), "{sheet}");

    let page = folder.read("a.html");
    assert!(page.starts_with("<!doctype html>") && page.trim_end().ends_with("</html>"));
    // 7 charts of lines, 5 of bars and one of memory for either distribution.
    assert_eq!((page.matches("<svg").count(), page.matches("<script").count()), (26, 0));
    assert!(page.contains("pointmass compare --n 60,200 --distribution uniform,mixed --repeat 1"));
    let links = page.replace("http://www.w3.org/2000/svg", "");
    assert!(!links.contains("http"), "nothing from the network");
    assert!(folder.read("a.svg").starts_with("<svg"));
    assert_eq!(folder.names(), ["a.csv", "a.html", "a.json", "a.svg"]);
}

#[test]
fn the_same_points_are_compared_whatever_they_come_in() {
    let folder = Folder::new();
    let rows: Vec<_> = circle(40).collect();
    let lines = |parts: &str, end: &str| {
        rows.iter().map(|[x, y, z]| format!("{x}{parts}{y}{parts}{z}{end}\n")).collect::<String>()
    };
    folder.write("a.csv", format!("x,y,z\n{}", lines(",", "")));
    folder.write("b.csv", lines("; ", ";word"));
    folder.write("a.xyz", lines(" ", ""));
    folder.write(
        "b.xyz",
        format!("40\n\n{}", lines(" ", "").replace('\n', "\nX ").replacen("", "X ", 1).trim_end_matches("X ")),
    );
    let head =
        "ply\nformat ascii 1.0\nelement vertex 40\nproperty float x\nproperty float y\nproperty float z\nend_header\n";
    folder.write("a.ply", format!("{head}{}", lines(" ", "")));
    let mut npy = b"\x93NUMPY\x01\x00\x76\x00".to_vec();
    npy.extend(format!("{:<117}\n", "{'descr': '<f4', 'fortran_order': False, 'shape': (40, 3), }").as_bytes());
    npy.extend(rows.as_flattened().iter().flat_map(|x| x.to_le_bytes()));
    folder.write("a.npy", npy);
    for name in ["a.csv", "b.csv", "a.xyz", "b.xyz", "a.ply", "a.npy"] {
        let case = case(&folder, &format!("--points {name}"));
        assert_eq!((&case["of"], &case["n"]), (&name.into(), &40.into()), "{case}");
        let once = folder.run(&format!("compare --points {name} --radius 1 --repeat 1 --out r.json")).fine();
        assert!(once.stdout.contains("radius 1.00, 2.00 others within it on average"), "{name}: {}", once.stdout);
    }
}

#[test]
fn recordings_can_be_compared_the_last_record_counts() {
    let folder = Folder::with("a.scn", SOURCE);
    folder.run("run a.scn --steps 30 --every 10 --out a.csv --out a.xyz --out a.ply").fine();
    let live = folder.report("a.scn --steps 30")["live"].clone();
    assert_eq!(live, 150);
    // Nobody lives at step 0, of which a table has no row.
    for (name, records) in [("a.csv", 3), ("a.xyz", 4)] {
        let case = case(&folder, &format!("--points {name}"));
        assert_eq!(case["n"], live, "{name}");
        assert!(
            case["about"].as_str().is_some_and(|about| about.ends_with(&format!("the last of {records} records"))),
            "{case}"
        );
    }
    assert_eq!(case(&folder, "--points a_000003.ply")["n"], live);
    assert_eq!(case(&folder, "--scene a.scn --at 0.5")["n"], live);
    assert_eq!(case(&folder, "--scene a.scn --at 0.5 --n 100")["n"], 100);
}

#[test]
fn surveys_are_moved_to_the_origin_and_it_is_told() {
    let folder = Folder::new();
    let far: String =
        circle(30).map(|[x, y, z]| format!("{},{},{z}\n", f64::from(x) + 5e5, f64::from(y) + 5.4e6)).collect();
    folder.write("utm.csv", far);
    let said = folder.run("compare --points utm.csv --radius 1 --repeat 1 --out a.json").fine().stdout;
    // In single precision, northings are rounded to half a metre.
    assert!(said.contains("radius 1.00, 2.00 others within it on average"), "{said}");
    let study: Value = serde_json::from_str(&folder.read("a.json")).expect("JSON");
    let about = study["cases"][0]["about"].as_str().expect("text");
    assert!(about.contains("no head names x, y and z, columns 1, 2, 3 were taken"), "{about}");
    assert!(about.contains("; (500000, 5400000, 0) was subtracted before rounding to single precision"), "{about}");
}

#[test]
fn few_points_and_many_in_one_place_are_compared_too() {
    let folder = Folder::new();
    for (rows, n, note) in [
        ("1,2,3\n4,5,6\n".into(), 2, "2 points: there is no radius with 5.00 others"),
        ("1,2,3\n".repeat(300), 300, "300 points: there is no radius with 5.00 others"),
        (circle(10).map(|[x, y, _]| format!("{x},{y}\n")).collect::<String>(), 10, "Advice for a.csv, 10 points"),
    ] {
        folder.write("a.csv", rows);
        let said = folder.run(&format!("compare --points a.csv {QUICK} --out a.json --out a.html --out a.svg")).fine();
        assert!(said.stdout.contains(note), "{note} in {}", said.stdout);
        let study: Value = serde_json::from_str(&folder.read("a.json")).expect("JSON");
        let contestants = study["cases"][0]["contestants"].as_array().expect("contestants");
        assert_eq!((&study["cases"][0]["n"], contestants.len()), (&n.into(), Structure::ALL.len()));
        assert!(contestants.iter().all(|one| one["figures"].as_array().is_some_and(|all| all.len() == 7)), "{study}");
        assert!(!folder.read("a.html").contains("NaN") && !folder.read("a.svg").contains("NaN"));
    }
}

#[test]
fn what_is_read_is_not_written_over() {
    let folder = Folder::with("a.csv", "1,2,3\n4,5,6\n");
    for out in ["a.csv", "./a.csv"] {
        let answer = folder.run(&format!("compare --points a.csv --out {out}"));
        assert!(answer.error().contains("a.csv: is read, so it cannot be written"), "{answer:?}");
    }
    assert_eq!((folder.read("a.csv").as_str(), folder.names()), ("1,2,3\n4,5,6\n", vec!["a.csv".to_string()]));
}

#[test]
fn rows_that_are_not_finite_are_skipped_and_told() {
    let folder = Folder::new();
    let rows: String = circle(30).map(|[x, y, z]| format!("{x},{y},{z}\n")).collect();
    folder.write("a.csv", format!("x,y,z\nnan,0,0\n{rows}0,inf,0\n"));
    let said = folder.run(&format!("compare --points a.csv {QUICK}")).fine().stdout;
    assert!(said.contains("30 points of a.csv; 2 rows skipped, not finite"), "{said}");
}

#[test]
fn what_is_no_set_of_points_is_refused() {
    let folder = Folder::new();
    for (name, content, expected) in [
        ("a.csv", "x,y,z\n1,2,3\n1,two,3\n", "a.csv:3: `two` in column 2: expected a number as y"),
        ("a.csv", "x,y,z\n", "a.csv: has no finite point: expected two or more"),
        ("a.csv", "1,2,3\nnan,2,3\n", "a.csv: has one finite point and 1 that are not: expected two or more"),
        ("a.csv", "1,oops,3\n4,5,6\n", "a.csv:1: `oops` in column 2: expected a number, as in line 2"),
        ("a.csv", "", "a.csv: is empty: expected points"),
        ("a.xyz", "1 2 3\n1 2 x\n", "a.xyz:2: `1 2 x`: expected the numbers x y z"),
        ("a.ply", "ply\nformat ascii 1.0\nend_header\n", "a.ply: header: expected an element `vertex`"),
        ("a.npy", "1,2,3\n4,5,6\n", "a.npy: expected an array as numpy.save writes it"),
    ] {
        folder.write(name, content);
        let answer = folder.run(&format!("compare --points {name} --out out.html"));
        assert!(answer.error().starts_with(expected), "{answer:?}");
    }
    folder.write("a.csv", "1,2,3\n4,5,6\n7,8,9\n");
    let answer = folder.run("compare --points a.csv --n 2,9");
    assert!(
        answer.error().contains("has 3 points: expected --n 9 or more") || answer.error().contains("9"),
        "{answer:?}"
    );
    assert!(folder.run("compare --points b.csv").error().starts_with("b.csv: "));
    folder.write("empty.scn", "ambient 0 0 0\n");
    let answer = folder.run("compare --scene empty.scn --at 0");
    assert!(answer.error().starts_with("empty.scn: 0 particles live at 0 s: expected two or more"), "{answer:?}");
    assert_eq!(folder.names(), ["a.csv", "a.npy", "a.ply", "a.xyz", "empty.scn"], "nothing half-written");
}

#[test]
fn the_command_line_says_what_it_wants() {
    let folder = Folder::with("a.csv", "1,2,3\n4,5,6\n");
    let cases = [
        ("--structures grid,nonsense", "unknown structure; there are brute grid"),
        ("--queries fly", "[possible values: count, within, nearest, pairs, moving, ray]"),
        ("--distribution galaxy", "uniform, plummer, sphere, plane, line, clusters, mixed"),
        ("--n 1e9", "expected a whole number of points, from 2 to 1e8"),
        ("--radius 0", "expected a positive, finite radius"),
        ("--k 0", "1..=64"),
        ("--points a.txt", "expected a name that ends in .csv, .ply, .xyz or .npy"),
        ("--out a.pdf", "expected a name that ends in .html, .svg, .csv or .json"),
        ("--points a.csv --scene a.scn", "cannot be used with"),
        ("--points a.csv --distribution uniform", "cannot be used with"),
        ("--radius 1 --neighbours 5", "cannot be used with"),
        ("--at 3", "--scene"),
    ];
    folder.misuse("compare", &cases);
    let answer = folder.run("compare --points a.csv --n 2,5000");
    assert!(answer.error().ends_with("a.csv: has 2 points, --n asks for 5000: lower --n"), "{answer:?}");
    let answer = folder.run("compare --n 4e4 --structures brute");
    assert!(answer.error().contains("nobody is left to compare: every query would compute about 2e9 distances"));
    assert!(folder.run("compare --n 50 --out no/a.html").error().contains("there is no folder no"));
    let answer = folder.run("compare --n 50 --peers");
    assert!(answer.error().contains("cargo run --release -p pointmass-peers -- compare --peers"));
}

#[test]
fn tables_fit_eighty_columns() {
    let folder = Folder::with(
        "a_very_long_name_of_a_file_with_points_that_goes_on_and_on_until_it_ends.csv",
        "x,y,z\n1,2,3\n4,5,6\n7,8,8\n",
    );
    for args in [
        "--distribution uniform,plummer --n 300,900 --repeat 3 --detail",
        "--points a_very_long_name_of_a_file_with_points_that_goes_on_and_on_until_it_ends.csv --repeat 3",
        "--queries ray --triangles 100,400 --segments 50 --repeat 3 --detail",
        "--queries count --n 300 --repeat 3",
    ] {
        let answer = folder.run(&format!("compare {args}"));
        assert_eq!(answer.code, 0, "{answer:?}");
        for line in answer.stdout.lines() {
            assert!(line.chars().count() <= 80, "{args}: {} columns: {line}", line.chars().count());
        }
        for name in ["brute", "kd", "bytes", "spread"] {
            assert!(answer.stdout.contains(name), "{args}: no {name}: {}", answer.stdout);
        }
    }
}

#[test]
#[cfg(unix)]
fn clouds_of_points_are_no_larger_than_other_files() {
    let folder = Folder::with(
        "small.ply",
        "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\nproperty float z\nend_header\n0 0 0\n1 1 1\n",
    );
    // Only its length is real.
    let file = std::fs::File::create(folder.path("large.ply")).expect("a file");
    file.set_len((256 << 20) + 1).expect("a sparse file");
    let error = folder.run("compare --points large.ply --repeat 1").error().to_string();
    assert!(error.starts_with("large.ply: is larger than 256 MiB"), "{error}");
    assert_eq!(folder.run("compare --points small.ply --repeat 1 --structures kd").code, 0);
}
