//! `--out`: which records are made, and what CSV, JSON lines, PLY and XYZ tell of them; the rest is in `recorded`.

use crate::scenes::{BUSY, ONE};
use crate::tool::{Folder, number};
use ply_rs_bw::parser::Parser;
use ply_rs_bw::ply::{DefaultElement, Property};
use std::collections::BTreeMap;
use std::fs::File;
use std::io::BufReader;

const HEAD: &str = "step,time,id,x,y,z,vx,vy,vz,mass,age";

/// A table's rows, as they stand there, in the columns that every recording has.
fn table(folder: &Folder, name: &str) -> Vec<[f64; 11]> {
    let text = folder.read(name);
    let mut lines = text.lines();
    assert!(lines.next().is_some_and(|head| head.starts_with(HEAD)));
    assert!(text.ends_with('\n') && !text.contains('\r') && !text.contains("NaN"));
    lines
        .map(|line| {
            let numbers: Vec<f64> =
                line.split(',').take(11).map(|x| x.parse().unwrap_or_else(|_| panic!("{line}"))).collect();
            assert!(line.split(',').nth(2).is_some_and(|id| id.bytes().all(|b| b.is_ascii_digit())), "{line}");
            numbers.try_into().unwrap_or_else(|_| panic!("{line}"))
        })
        .collect()
}

/// The steps at which there are records, each once.
fn steps(rows: &[[f64; 11]]) -> Vec<f64> {
    let mut steps: Vec<f64> = rows.iter().map(|row| row[0]).collect();
    steps.dedup();
    steps
}

#[test]
fn records_are_made_at_the_beginning_every_k_steps_and_at_the_end() {
    let folder = Folder::with("a.scn", ONE);
    for (count, every, expected) in [
        (10, 4, &[0.0, 4.0, 8.0, 10.0][..]),
        (10, 5, &[0.0, 5.0, 10.0]),
        (10, 10, &[0.0, 10.0]),
        (10, 100, &[0.0, 10.0]),
        (10, u64::MAX, &[0.0, 10.0]),
        (3, 1, &[0.0, 1.0, 2.0, 3.0]),
        (1, 2, &[0.0, 1.0]),
        (0, 1, &[0.0]),
        (0, 9, &[0.0]),
    ] {
        folder.run(&format!("run a.scn --steps {count} --every {every} --out a.csv")).fine();
        assert_eq!(steps(&table(&folder, "a.csv")), expected, "{count} steps, every {every}");
    }
    folder.run("run a.scn --steps 3 --out b.csv").fine();
    assert_eq!(steps(&table(&folder, "b.csv")), [0.0, 1.0, 2.0, 3.0], "K is 1 unless told");
}

#[test]
fn a_table_tells_the_state() {
    let folder = Folder::with("a.scn", "particle 1 2 3  0.5 -0.25 4  2 0 0 0 0 -1\nparticle 9 9 9 1 1 1 3 1 0 0 0 -1");
    folder.run("run a.scn --dt 0.5 --steps 2 --out a.csv").fine();
    let rows = table(&folder, "a.csv");
    assert_eq!(rows.len(), 6);
    assert_eq!(rows[0], [0.0, 0.0, 0.0, 1.0, 2.0, 3.0, 0.5, -0.25, 4.0, 2.0, 0.0]);
    assert_eq!(rows[1], [0.0, 0.0, 1.0, 9.0, 9.0, 9.0, 0.0, 0.0, 0.0, 3.0, 0.0], "what is fixed does not move");
    // The masses attract each other, by less than a millionth of what is told here.
    let expected = [2.0, 1.0, 0.0, 1.5, 1.75, 7.0, 0.5, -0.25, 4.0, 2.0, 1.0];
    assert!(rows[4].iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-6), "{:?}", rows[4]);
}

/// Every format has the columns that a scene adds, under their names, and the file that cannot be meant is refused.
#[test]
fn columns_of_a_users_own_are_recorded() {
    let scene = r#"{"run": {"dt": 0.25}, "particles": [{}, {"lifetime": 0.3}, {"radius": 1}],
        "custom": [{"name": "heat", "start": [80], "newborn": 20}, {"name": "worn", "newborn": 0.5}],
        "forces": [{"relaxation": {"column": "heat", "toward": 20, "rate": 1.5}}]}"#;
    let folder = Folder::with("a.json", scene);
    folder.run("run a.json --steps 4 --out a.csv --out a.jsonl --out a.xyz --out a.ply").fine();
    let csv = folder.read("a.csv");
    assert_eq!(csv.lines().next(), Some(&*format!("{HEAD},radius,heat,worn,remaining,red,green,blue,alpha")));
    let last: Vec<&str> = csv.lines().last().expect("it is not empty").split(',').collect();
    assert_eq!(last[11..14], ["1.0", "20.0", "0.5"]);
    let first = csv.lines().rev().nth(1).expect("two live");
    let heat: f64 = first.split(',').nth(12).and_then(|x| x.parse().ok()).expect("a number");
    assert!((heat - (20.0 + 60.0 * (-1.5f64).exp())).abs() < 1e-4, "{heat}");
    let lines: Vec<serde_json::Value> =
        folder.read("a.jsonl").lines().map(|line| serde_json::from_str(line).expect("JSON")).collect();
    assert_eq!((lines.len(), &lines[0]["heat"], &lines[1]["worn"]), (3 + 3 + 2 * 3, &80.0.into(), &0.5.into()));
    assert!(folder.read("a.xyz").contains("id:I:1:radius:R:1:heat:R:1:worn:R:1"));
    let mut cloud = BufReader::new(File::open(folder.path("a_000000.ply")).expect("it is there"));
    let cloud = Parser::<DefaultElement>::new().read_ply(&mut cloud).expect("PLY");
    let heat: Vec<_> = cloud.payload["vertex"].iter().map(|vertex| vertex["heat"].clone()).collect();
    assert_eq!(heat, [80.0, 20.0, 20.0].map(Property::Float));
    for (from, to, error) in [
        ("\"column\": \"heat\"", "\"column\": \"fuel\"", "a.json:forces[0].column: there is no \"fuel\""),
        ("\"name\": \"worn\"", "\"name\": \"heat\"", "a.json:custom[1].name: there is a \"heat\" already"),
        ("\"name\": \"worn\"", "\"name\": \"age\"", "a.json:custom[1].name: there is a \"age\" already"),
        ("\"name\": \"worn\"", "\"name\": \"a,b\"", "a.json:custom[1].name: has to begin with a letter"),
        ("[80]", "[1e39]", "a.json:"),
    ] {
        folder.write("a.json", scene.replace(from, to));
        let answer = folder.run("run a.json --steps 1");
        assert!(answer.error().contains(error), "{}", answer.error());
    }
}

#[test]
fn ids_count_the_first_particles_and_are_never_given_twice() {
    let folder = Folder::with("busy.scn", BUSY);
    let report = folder.report("busy.scn --dt 1/60 --steps 120 --capacity 20 --out a.csv");
    let rows = table(&folder, "a.csv");
    let first: Vec<f64> = rows.iter().take_while(|row| row[0] == 0.0).map(|row| row[2]).collect();
    assert_eq!(first, [0.0, 1.0, 2.0]);
    let mut lives: BTreeMap<u64, Vec<&[f64; 11]>> = BTreeMap::new();
    for row in &rows {
        lives.entry(row[2] as u64).or_default().push(row);
    }
    assert!(number(&report, "died/lifetime") > 5.0 && number(&report, "died/sink") > 0.0, "{report}");
    for (id, life) in &lives {
        for pair in life.windows(2) {
            assert_eq!(pair[1][0], pair[0][0] + 1.0, "{id} comes back from the dead");
            let aged = pair[1][10] - pair[0][10];
            assert!((aged - 1.0 / 60.0).abs() < 2e-9, "{id} ages by {aged} in a step");
            assert_eq!(pair[0][9], pair[1][9], "{id} changes its mass");
        }
        let born = life[0][1] - life[0][10];
        assert!(*id < 3 || life[0][10] < 1.0 / 60.0 + 2e-9, "{id} was born at {born}, not in the step it appears in");
    }
    // What was born and died within one step leaves no trace; nothing does so here.
    assert_eq!(lives.len() as f64, number(&report, "initial") + number(&report, "born"));
    let alive = rows.iter().filter(|row| row[0] == 120.0).count();
    assert_eq!(alive as f64, number(&report, "live"));
    for step in 0..=120 {
        let ids: Vec<f64> = rows.iter().filter(|row| row[0] == f64::from(step)).map(|row| row[2]).collect();
        assert!(ids.is_sorted_by(|a, b| a < b), "step {step}: in the order of ids, each once: {ids:?}");
    }
}

#[test]
fn every_format_says_the_same() {
    let folder = Folder::with("busy.scn", BUSY);
    folder.run("run busy.scn --steps 40 --every 15 --out a.csv --out a.jsonl --out a.ply --out a.xyz").fine();
    let rows = table(&folder, "a.csv");
    assert_eq!(steps(&rows), [0.0, 15.0, 30.0, 40.0]);

    let names: Vec<&str> = HEAD.split(',').collect();
    let text = folder.read("a.jsonl");
    assert_eq!(text.lines().count(), rows.len());
    for (line, row) in text.lines().zip(&rows) {
        let object: serde_json::Map<String, serde_json::Value> = serde_json::from_str(line).expect("an object");
        for (name, x) in names.iter().zip(row) {
            assert_eq!(object.get(*name).and_then(serde_json::Value::as_f64), Some(*x), "{name} of {line}");
        }
        assert!(object["id"].is_u64() && object["step"].is_u64(), "{line}");
    }

    let text = folder.read("a.xyz");
    let mut lines = text.lines();
    for step in steps(&rows) {
        let frame: Vec<_> = rows.iter().filter(|row| row[0] == step).collect();
        assert_eq!(lines.next(), Some(frame.len().to_string().as_str()));
        assert!(lines.next().is_some_and(|comment| comment.contains(&format!("Step={step}"))));
        for row in frame {
            let line = lines.next().expect("an atom");
            let mut words = line.split(' ');
            assert!(words.next().is_some_and(|species| species.bytes().all(|b| b.is_ascii_alphabetic())), "{line}");
            let place: Vec<f64> = words.take(3).map(|x| x.parse().expect("a number")).collect();
            assert_eq!(place, row[3..6], "{line}");
        }
    }
    assert_eq!(lines.next(), None);

    let clouds: Vec<String> = folder.names().into_iter().filter(|name| name.ends_with(".ply")).collect();
    assert_eq!(clouds, ["a_000000.ply", "a_000001.ply", "a_000002.ply", "a_000003.ply"]);
    for (name, step) in clouds.iter().zip(steps(&rows)) {
        let cloud = cloud(&folder, name);
        let frame: Vec<_> = rows.iter().filter(|row| row[0] == step).collect();
        assert_eq!(cloud.len(), frame.len(), "{name}");
        for (point, row) in cloud.iter().zip(frame) {
            for (i, field) in names.iter().enumerate().skip(3) {
                let told = match point.get(*field) {
                    Some(Property::Float(x)) => f64::from(*x),
                    Some(Property::Double(x)) => *x,
                    other => panic!("{field} of {name} is {other:?}"),
                };
                // The table has the shortest digits that spell the same single.
                let same = told == row[i] || (told as f32).to_bits() == (row[i] as f32).to_bits();
                assert!(same, "{field} of {name}: {told}, {}", row[i]);
            }
            assert!(matches!(point.get("id"), Some(Property::UInt(id)) if f64::from(*id) == row[2]), "{name}");
        }
    }
}

fn cloud(folder: &Folder, name: &str) -> Vec<DefaultElement> {
    let mut file = BufReader::new(File::open(folder.path(name)).expect("the cloud is there"));
    let mut cloud = Parser::<DefaultElement>::new().read_ply(&mut file).unwrap_or_else(|e| panic!("{name}: {e:?}"));
    cloud.payload.swap_remove("vertex").unwrap_or_default()
}

#[test]
fn atoms_have_the_cell_of_their_room() {
    let scene = |sides: &str, particles: &str| {
        format!(r#"{{"room": {{"low": [-1, -2, 0.5], "sides": {sides}}}, "particles": [{particles}]}}"#)
    };
    let folder = Folder::with("a.json", r#"{"particles": [{}]}"#);
    folder.run("run a.json --steps 1 --out a.xyz");
    assert!(!folder.read("a.xyz").contains("Lattice"));
    let three = r#"{"position": [0, -1, 2]}, {"position": [1, 2.5, 2]}, {"position": [2, 0, 2]}"#;
    for (sides, particles, told) in [
        ("[4, 5, 6.25]", three, r#"Lattice="4 0 0 0 5 0 0 0 6.25" Origin="-1 -2 0.5" pbc="T T T""#),
        // Where space goes on the particles' own extent is told, or a metre.
        ("[4, 0, 0]", three, r#"Lattice="4 0 0 0 3.5 0 0 0 1" Origin="-1 -1 2" pbc="T F F""#),
        ("[4, 5, 0]", "", r#"Lattice="4 0 0 0 5 0 0 0 1" Origin="-1 -2 0" pbc="T T F""#),
    ] {
        folder.write("a.json", scene(sides, particles));
        folder.run("run a.json --steps 1 --out a.xyz");
        let text = folder.read("a.xyz");
        assert!(text.lines().filter(|line| line.contains("Properties=")).all(|line| line.ends_with(told)), "{text}");
        let points = folder.run("compare --points a.xyz --repeat 1");
        assert_eq!(points.code, i32::from(particles.is_empty()), "{points:?}");
    }
}

#[test]
fn recordings_of_nothing_are_whole_files_too() {
    let folder = Folder::with("a.json", "{}");
    folder.run("run a.json --steps 1 --out a.csv --out a.jsonl --out a.ply --out a.xyz").fine();
    assert_eq!(folder.read("a.csv"), format!("{HEAD}\n"));
    assert_eq!(folder.read("a.jsonl"), "");
    assert_eq!(folder.read("a.xyz").lines().filter(|line| *line == "0").count(), 2);
    assert!(cloud(&folder, "a_000001.ply").is_empty());
}

#[test]
fn names_may_have_dots_folders_and_capitals() {
    let folder = Folder::with("A.SCN", ONE);
    folder.write("o/keep", "");
    folder.run("run A.SCN --steps 1 --out o/a.b.ply --out o/A.CSV --out ./o/../c.xyz").fine();
    let names = folder.names();
    for name in ["o/a.b_000000.ply", "o/a.b_000001.ply", "o/A.CSV", "c.xyz"] {
        assert!(names.iter().any(|n| n == name), "{name} of {names:?}");
    }
    assert_eq!(names.len(), 7, "{names:?}");
}

#[test]
fn files_can_be_read_by_whoever_may() {
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        let folder = Folder::with("a.scn", ONE);
        folder.shell("umask 027; $POINTMASS run a.scn --steps 1 --out a.csv --out a.ply").fine();
        folder.shell("umask 027; $POINTMASS convert a.scn a.json").fine();
        for name in ["a.csv", "a_000000.ply", "a.json"] {
            let mode = folder.path(name).metadata().expect("the file is there").permissions().mode();
            assert_eq!(mode & 0o777, 0o640, "{name}");
        }
    }
}

#[test]
fn records_of_balls_have_their_radii() {
    let scene = r#"{"particles": [{"radius": 0.25}, {"position": [9, 0, 0]}]}"#;
    let folder = Folder::with("a.json", scene);
    folder.run("run a.json --steps 0 --out a.csv --out a.jsonl --out a.xyz --out a.ply").fine();
    let csv = folder.read("a.csv");
    let last: Vec<_> = csv.lines().filter_map(|line| line.rsplit(',').next()).collect();
    assert_eq!((csv.lines().next(), &last[..]), (Some(&*format!("{HEAD},radius")), &["radius", "0.25", "0.0"][..]));
    assert!(folder.read("a.jsonl").lines().next().is_some_and(|line| line.ends_with(r#","radius":0.25}"#)));
    let xyz = folder.read("a.xyz");
    assert!(
        xyz.contains(":id:I:1:radius:R:1:age:R:1 ")
            && xyz.lines().nth(2).is_some_and(|line| line.ends_with(" 0 0.25 0"))
    );
    let radii: Vec<_> = cloud(&folder, "a_000000.ply").iter().map(|vertex| vertex["radius"].clone()).collect();
    assert_eq!(radii, [Property::Float(0.25), Property::Float(0.0)]);
}
