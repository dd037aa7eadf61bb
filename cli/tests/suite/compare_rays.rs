//! `pointmass compare --queries ray` from outside: its reports, the meshes it reads, what it refuses.

use crate::tool::Folder;
use serde_json::Value;

/// The fewest measurements there can be.
const QUICK: &str = "--repeat 1 --segments 60";

const NAMES: [&str; 6] = ["brute", "grid", "octree", "kd", "bsp", "bvh"];
const KINDS: [&str; 5] = ["build", "short", "sorted", "long", "balls"];

fn json(folder: &Folder, name: &str) -> Value {
    serde_json::from_str(&folder.read(name)).expect("JSON")
}

/// A tetrahedron.
const OFF: &str = "OFF\n4 4 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n";

#[test]
fn a_small_comparison_on_meshes_is_told_in_every_format() {
    let folder = Folder::new();
    let files = "--out a.csv --out a.json --out a.html --out a.svg";
    let said = folder.run(&format!("compare --queries ray --triangles 50,200 {QUICK} {files}")).fine().stdout;
    for name in NAMES {
        assert!(said.contains(&format!("\n  {name} ")), "{name} in {said}");
    }
    for word in [
        "knot, 198 triangles: 60 segments of every kind, balls of radius 0.0029",
        "terrain, 50 triangles: 60 segments",
        "verified against each other, all segments, and every triangle, 60 of each kind",
        "in ns a query, of the build in ns a triangle",
        "boxes looked at (nodes, cells; by brute force the triangles' own)",
        "of a query, grows from 50 to 200 triangles",
        "Advice for terrain, 200 triangles",
        "  short: use ",
    ] {
        assert!(said.contains(word), "{word} in {said}");
    }

    let study = json(&folder, "a.json");
    let cases = study["cases"].as_array().expect("cases");
    assert_eq!(cases.len(), 4);
    for case in cases {
        assert_eq!((&case["subject"], &case["queries"]), (&"mesh".into(), &60.into()));
        let contestants = case["contestants"].as_array().expect("contestants");
        assert_eq!(contestants.iter().filter_map(|one| one["name"].as_str()).collect::<Vec<_>>(), NAMES);
        for one in contestants {
            let figures: Vec<_> = one["figures"].as_array().expect("figures").iter().collect();
            let kinds: Vec<_> = figures.iter().filter_map(|figure| figure["workload"].as_str()).collect();
            assert_eq!(kinds, KINDS);
            for (figure, all) in figures.iter().zip(contestants[0]["figures"].as_array().expect("figures")) {
                assert!(figure["median"].as_f64().is_some_and(|ns| ns > 0.0), "{one}");
                assert_eq!(figure["found"], all["found"], "as many hits as brute force: {one}");
            }
            assert!(one["build"]["bytes_each"].as_f64().is_some_and(|bytes| bytes > 0.0), "{one}");
        }
    }

    let sheet = folder.read("a.csv");
    let mut rows = sheet.lines();
    let head: Vec<_> = rows.next().expect("a head").split(',').collect();
    assert!(head.contains(&"median_ns") && head.contains(&"triangles_tested_per_query"), "{head:?}");
    assert_eq!(rows.clone().count(), 4 * NAMES.len() * KINDS.len());
    assert!(rows.all(|row| row.split(',').count() == head.len()), "{sheet}");

    let page = folder.read("a.html");
    assert!(page.starts_with("<!doctype html>") && page.trim_end().ends_with("</html>"));
    // 5 charts of lines, 4 of bars and one of memory for either surface.
    assert_eq!((page.matches("<svg").count(), page.matches("<script").count()), (20, 0));
    for word in ["pointmass compare --queries ray", "bytes a triangle", "Morton curve", "60 segments of every kind"] {
        assert!(page.contains(word), "{word}");
    }
    assert!(folder.read("a.svg").starts_with("<svg"));
    for (name, text) in [("a.html", &page), ("a.svg", &folder.read("a.svg")), ("said", &said)] {
        assert!(!text.contains("NaN") && !text.contains("inf "), "{name}");
    }
    assert_eq!(folder.names(), ["a.csv", "a.html", "a.json", "a.svg"]);
}

#[test]
fn the_same_mesh_is_compared_whatever_it_comes_in() {
    let folder = Folder::with("a.off", OFF);
    folder.write("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n");
    let head = "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n\
                element face 4\nproperty list uchar int vertex_indices\nend_header\n";
    folder.write("a.ply", format!("{head}{}", OFF.split_once("4 4 0\n").expect("a head").1));
    let mut counted = Vec::new();
    for name in ["a.off", "a.obj", "a.ply"] {
        folder.run(&format!("compare --mesh {name} --structures brute,bvh {QUICK} --out a.json")).fine();
        let case = json(&folder, "a.json")["cases"][0].clone();
        assert_eq!((&case["of"], &case["n"]), (&name.into(), &4.into()), "{case}");
        let about = case["about"].as_str().expect("text").replace(name, "");
        let figures = case["contestants"][1]["figures"].as_array().expect("figures").clone();
        let tests: Vec<_> = figures.iter().map(|figure| figure["tests"].clone()).collect();
        counted.push((about, tests));
    }
    assert!(counted[0].0.starts_with("4 triangles between 4 vertices of "), "{counted:?}");
    assert!(counted[1..].iter().all(|one| *one == counted[0]), "{counted:?}");
}

#[test]
fn a_seed_draws_other_segments_and_the_same_one_the_same() {
    let folder = Folder::new();
    let of = |args: &str| {
        folder
            .run(&format!("compare --surface knot --triangles 200 --structures bvh {QUICK} {args} --out a.json"))
            .fine();
        let case = json(&folder, "a.json")["cases"][0].clone();
        let figures = case["contestants"][0]["figures"].as_array().expect("figures").clone();
        figures.iter().map(|figure| figure["visits"].clone()).collect::<Vec<_>>()
    };
    assert_eq!(of("--seed 3"), of("--seed 3"));
    assert_ne!(of("--seed 3"), of("--seed 4"));
    assert_ne!(of("--radius 0.5")[4], of("--radius 0.01")[4], "balls are larger");
}

#[test]
fn what_is_no_mesh_is_refused() {
    let folder = Folder::with("a.off", "OFF\n3 1 0\n0 0 0\n1 0 oops\n0 1 0\n3 0 1 2\n");
    folder.write("b.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 7\n");
    folder.write("c.off", "OFF\n3 1 0\n1 1 1\n1 1 1\n1 1 1\n3 0 1 2\n");
    folder.write("d.off", "OFF\n3 1 0\n0 0 0\n1e30 0 0\n0 1 0\n3 0 1 2\n");
    folder.write("e.txt", OFF);
    for (args, expected) in [
        ("--mesh a.off", "a.off:4: `oops`: expected a"),
        ("--mesh b.off", "b.off:6: "),
        ("--mesh c.off", "c.off: the mesh is 0.0e0 across: expected from 1e-12 to 1e15; scale it"),
        ("--mesh d.off", "d.off: the mesh is 1.0e30 across"),
        ("--mesh e.txt", "e.txt: unknown extension .txt: a mesh is one of .off, .obj, .stl, .ply, .png"),
        ("--mesh no.off", "no.off: can't be read: "),
        ("--mesh .", "."),
        ("--queries ray --n 50", "--n is about points: --queries ray is asked of a mesh, see --mesh"),
        ("--queries ray --distribution plane", "--distribution is about points"),
        ("--queries ray --k 3", "--k is about points"),
        ("--queries ray,count", "--queries: ray is asked of a mesh, count of points; ask for one after the other"),
        ("--mesh a.off --queries pairs", "--mesh is about a mesh: pairs is asked of points; expected --queries ray"),
        ("--triangles 50 --n 50", "--n is about points, --triangles about a mesh; leave one of them out"),
        (
            "--queries ray --structures bvh,hash",
            "--structures hash: sorts points alone; of triangles there are brute, grid",
        ),
    ] {
        let answer = folder.run(&format!("compare {args} --out out.html"));
        assert!(answer.error().starts_with(expected), "{args}: {answer:?}");
    }
    let cases = [
        ("--triangles 3", "expected a whole number of triangles, from 12 to 2e7"),
        ("--segments 0", "expected a whole number of segments, from 1 to 1e7"),
        ("--surface moon", "[possible values: knot, terrain]"),
        ("--mesh a.off --triangles 50", "cannot be used with"),
        ("--mesh a.off --scene a.scn", "cannot be used with"),
    ];
    folder.misuse("compare", &cases);
    assert_eq!(folder.names(), ["a.off", "b.off", "c.off", "d.off", "e.txt"], "nothing half-written");
}
