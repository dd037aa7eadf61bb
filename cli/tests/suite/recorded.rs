//! What is read back from every format is the state, to the bit; and what happened is what events tell.

use crate::scenes::{BUSY, ONE};
use crate::tool::{Folder, number, tries};
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use npyz::NpyFile;
use ply_rs_bw::parser::Parser;
use ply_rs_bw::ply::{DefaultElement, Property};
use pointmass::draw::appearance;
use pointmass::scene::{Model, SceneFile};
use pointmass::{Heap, System, Time};
use pointmass_cli::load::Disk;
use proptest::prelude::*;
use quick_xml::Reader;
use quick_xml::events::Event;
use serde_json::{Value, json};
use std::collections::BTreeMap;
use std::fs::{self, File};
use std::io::{BufReader, Read};

/// A record: columns by name, the triangles, and the edges.
#[derive(Clone, Debug, Default)]
pub(crate) struct Record {
    step: u64,
    time: f64,
    pub(crate) columns: BTreeMap<String, Vec<f64>>,
    pub(crate) faces: Vec<Vec<u64>>,
    edges: Vec<Vec<u64>>,
}

const STEPS: u64 = 6;
const DT: f64 = 0.0625;

/// Scenes with all that varies.
#[derive(Clone, Debug)]
struct Varied {
    particles: usize,
    balls: bool,
    charged: bool,
    own: bool,
    springs: bool,
    cells: [u32; 2],
    rate: u32,
    lifetime: bool,
    materials: bool,
}

fn varied() -> impl Strategy<Value = Varied> {
    let flags = (any::<bool>(), any::<bool>(), any::<bool>(), any::<bool>(), any::<bool>(), any::<bool>());
    (0..4usize, flags, [0..3u32, 0..3u32], 0..40u32).prop_map(|(particles, flags, cells, rate)| {
        let (balls, charged, own, springs, lifetime, materials) = flags;
        Varied { particles, balls, charged, own, springs: springs && particles > 1, cells, rate, lifetime, materials }
    })
}

impl Varied {
    fn json(&self) -> Value {
        let mut scene = json!({
            "run": {"dt": DT, "integrator": "verlet", "capacity": 30, "seed": 5},
            "forces": [{"gravity": {"acceleration": [0, -9.8, 0]}}, {"drag": {}}],
            "scenery": [{"shape": {"plane": {"point": [0, 0, 0], "normal": [0, 1, 0]}}}],
        });
        let particle = |i: usize| {
            let mut particle = json!({"position": [i as f64 * 0.7, 0.1 + i as f64 * 0.3, 0.1], "fixed": i == 2});
            let mut set = |name: &str, value: Value, has: bool| has.then(|| particle[name] = value);
            set("radius", 0.05.into(), self.balls);
            set("charge", (0.3 * (i as f64 - 1.0)).into(), self.charged);
            set("lifetime", 0.2.into(), self.lifetime && i == 1);
            set("material", 1.into(), self.materials && i == 0);
            set("color", json!([10, 20 + i, 255, 200]), self.materials && i == 1);
            set("drag", 0.1.into(), self.charged && i == 1);
            particle
        };
        scene["particles"] = (0..self.particles).map(particle).collect();
        if self.charged && self.particles > 0 {
            // Charges that nobody looks at are remarked on.
            let law = json!({"strength": -1e-3, "exponent": 1, "reach": 0.1, "weight": "charge"});
            scene["forces"].as_array_mut().expect("a list").push(json!({"power_law": law}));
        }
        if self.own {
            scene["custom"] =
                json!([{"name": "heat", "start": [80.1], "newborn": 20}, {"name": "Heat"}, {"name": "X"}]);
        }
        if self.springs {
            scene["springs"] = json!([{"ends": [0, 1], "rest_length": 0.5, "ks": 10, "breaks_at": 1.9}]);
        }
        if self.materials {
            scene["materials"] = json!([{}, {"diffuse": [0.2, 0.6, 0.4]}]);
        }
        if self.cells != [0, 0] {
            let sheet = json!({"corner": [0, 1, 1], "sides": [[1, 0, 0], [0, 0, 1]], "cells": self.cells});
            let springs = json!({"structural": {"ks": 5, "kd": 0.1}, "bend": {"ks": 1}});
            scene["cloths"] = json!([{"form": {"sheet": sheet}, "mass": 1, "springs": springs, "fixed": [0]}]);
        }
        if self.rate > 0 {
            let shape = json!({"sphere": {"center": [3, 2, 0], "radius": 0.5}});
            let life = if self.lifetime { json!({"mean": 0.15, "half_width": 0.1}) } else { json!(0) };
            scene["emitters"] = json!([{"shape": shape, "rate": self.rate, "start": 0.1, "speed": 1, "lifetime": life,
                "elasticity": {"mean": 0.5, "half_width": 0.2}}]);
        }
        scene
    }
}

/// The state after each step, and its hash at the end, by an engine of our own.
fn truth(scene: &str) -> (Vec<Record>, String) {
    let file = SceneFile::from_json("a.json", scene).unwrap_or_else(|error| panic!("{error}"));
    let model = Model::load(&file, "a.json", &mut Disk).unwrap_or_else(|error| panic!("{error}"));
    let mut system = System::with(Heap::new(model.size(model.particles.len().max(file.run.capacity as usize))));
    system.start(&model.scene(), file.run.seed).expect("the memory is made for the scene");
    let mut records = vec![record(&file, &model, &system, 0)];
    for step in 1..=STEPS {
        system.step_to(&model.scene(), Time::from_seconds_f64(step as f64 * DT));
        records.push(record(&file, &model, &system, step));
    }
    (records, format!("{:016x}", system.hash()))
}

fn record(file: &SceneFile, model: &Model, system: &System<Heap>, step: u64) -> Record {
    let (all, state) = (system.particles(), system.state(&model.scene()));
    let mut rows: Vec<usize> = (0..all.serial.len()).collect();
    rows.sort_by_key(|&row| all.serial[row]);
    let mut columns = BTreeMap::new();
    let mut add = |name: &str, value: &dyn Fn(usize) -> f64| {
        columns.insert(name.to_string(), rows.iter().map(|&row| value(row)).collect::<Vec<f64>>());
    };
    let ns = |time: Time| (time.seconds_f64() * 1e9).round() / 1e9;
    let now = system.time();
    add("id", &|row| all.serial[row].into());
    for (axis, [place, speed]) in [["x", "vx"], ["y", "vy"], ["z", "vz"]].into_iter().enumerate() {
        add(place, &|row| all.position[row][axis].into());
        add(speed, &|row| all.velocity[row][axis].into());
    }
    add("mass", &|row| all.mass[row].into());
    add("radius", &|row| all.radius[row].into());
    add("drag", &|row| all.drag[row].into());
    add("charge", &|row| all.charge[row].into());
    add("elasticity", &|row| all.elasticity[row].into());
    add("fixed", &|row| (all.inverse_mass[row] == 0.0).into());
    add("age", &|row| ns(now - all.born[row]));
    add("remaining", &|row| if all.dies[row] == Time::NEVER { -1.0 } else { ns(all.dies[row] - now) });
    add("material", &|row| f64::from(all.material[row]) - 1.0);
    for (channel, name) in ["red", "green", "blue", "alpha"].into_iter().enumerate() {
        add(name, &|row| appearance(&state, row).expect("it lives").color[channel].into());
    }
    for custom in &file.custom {
        let values = system.custom(&model.scene());
        add(&custom.name, &|row| values.get(&custom.name).expect("it is there")[row].into());
    }
    let place = |serial: u32| rows.iter().position(|&row| all.serial[row] == serial).map(|place| place as u64);
    let all_places = |numbers: &[u32]| numbers.iter().map(|&number| place(number)).collect::<Option<Vec<u64>>>();
    let mut faces = Vec::new();
    for (cloth, &[first, _]) in file.cloths.iter().zip(&model.cloths) {
        let pointmass::scene::Form::Sheet(sheet) = &cloth.form else { panic!("a sheet") };
        faces.extend(sheet.triangles().filter_map(|t| all_places(&t.map(|corner| first as u32 + corner))));
    }
    let thread = file
        .cloths
        .iter()
        .all(|cloth| matches!(&cloth.form, pointmass::scene::Form::Sheet(sheet) if sheet.triangles().next().is_some()));
    let held = state.springs.held().filter(|held| !thread || held.number < file.springs.len());
    let ends = held.filter_map(|held| all_places(&held.spring.ends));
    let mut edges: Vec<_> = ends.collect();
    edges.sort_by_key(|pair| [pair[0].min(pair[1]), pair[0].max(pair[1])]);
    edges.dedup_by_key(|pair| [pair[0].min(pair[1]), pair[0].max(pair[1])]);
    Record { step, time: ns(now), columns, faces, edges }
}

/// What may be left out where it is so for all.
fn usual(name: &str) -> Option<f64> {
    match name {
        "radius" | "fixed" | "drag" | "charge" => Some(0.0),
        "remaining" | "material" => Some(-1.0),
        "elasticity" => Some(0.5),
        "red" | "green" | "blue" | "alpha" => Some(255.0),
        _ => None,
    }
}

/// Whether a number that was read is the one that was written: texts have the shortest digits that spell a single.
fn same(read: f64, written: f64) -> bool {
    read == written || f64::from(read as f32) == written || f64::from(written as f32) == read
}

/// Every column of the read record is that of the true one, and what is missing is usual.
#[track_caller]
fn agree(what: &str, read: &Record, truth: &Record, leaves_out: &[&str]) {
    for (name, written) in &truth.columns {
        match read.columns.get(name) {
            Some(read) => {
                let all = read.len() == written.len() && read.iter().zip(written).all(|(a, b)| same(*a, *b));
                assert!(all, "{what}, step {}, {name}: {read:?} instead of {written:?}", truth.step);
            }
            None if leaves_out.contains(&name.as_str()) => {}
            None => {
                let usual = usual(name).unwrap_or_else(|| panic!("{what} has no {name}"));
                assert!(written.iter().all(|value| *value == usual), "{what} leaves out {name}: {written:?}");
            }
        }
    }
    let unknown: Vec<_> = read.columns.keys().filter(|name| !truth.columns.contains_key(*name)).collect();
    assert!(unknown.is_empty(), "{what}: {unknown:?}");
}

#[track_caller]
fn agree_in_all(what: &str, read: &Record, truth: &Record, leaves_out: &[&str]) {
    agree(what, read, truth, leaves_out);
    assert_eq!((&read.faces, &read.edges), (&truth.faces, &truth.edges), "{what}, step {}", truth.step);
}

fn csv(text: &str) -> Vec<Record> {
    let mut table = csv::Reader::from_reader(text.as_bytes());
    let head: Vec<String> = table.headers().expect("a head").iter().map(String::from).collect();
    let mut records: BTreeMap<u64, Record> = BTreeMap::new();
    for row in table.records() {
        let row = row.expect("a row");
        let numbers: Vec<f64> = row.iter().map(|x| x.parse().unwrap_or_else(|_| panic!("{row:?}"))).collect();
        let record = records.entry(numbers[0] as u64).or_default();
        (record.step, record.time) = (numbers[0] as u64, numbers[1]);
        for (name, number) in head.iter().zip(&numbers).skip(2) {
            record.columns.entry(name.clone()).or_default().push(*number);
        }
    }
    records.into_values().collect()
}

fn lists(value: &Value) -> Vec<Vec<u64>> {
    serde_json::from_value(value.clone()).unwrap_or_default()
}

fn frames(text: &str) -> Vec<Record> {
    let frame = |line: &str| {
        let object: serde_json::Map<String, Value> = serde_json::from_str(line).expect("an object");
        let mut record = Record { step: object["step"].as_u64().expect("a step"), ..Record::default() };
        record.time = object["time"].as_f64().expect("an instant");
        for (name, value) in &object {
            match name.as_str() {
                "step" | "time" => {}
                "faces" => record.faces = lists(value),
                "edges" => record.edges = lists(value),
                _ => {
                    let numbers = value.as_array().expect("a list").iter().map(|x| x.as_f64().expect("a number"));
                    record.columns.insert(name.clone(), numbers.collect());
                }
            }
        }
        record
    };
    text.lines().map(frame).collect()
}

fn array(bytes: &[u8]) -> (Vec<u64>, Vec<f64>) {
    let file = NpyFile::new(bytes).expect("an array");
    let (shape, kind) = (file.shape().to_vec(), file.dtype().descr());
    let wide = |result: std::io::Result<Vec<f64>>| result.expect("numbers");
    let numbers = match kind.as_str() {
        "'<f4'" => file.into_vec::<f32>().map(|all| all.into_iter().map(f64::from).collect()),
        "'<f8'" => file.into_vec::<f64>(),
        "'<u4'" => file.into_vec::<u32>().map(|all| all.into_iter().map(f64::from).collect()),
        "'<i4'" => file.into_vec::<i32>().map(|all| all.into_iter().map(f64::from).collect()),
        "'<u8'" => file.into_vec::<u64>().map(|all| all.into_iter().map(|x| x as f64).collect()),
        "'|u1'" => file.into_vec::<u8>().map(|all| all.into_iter().map(f64::from).collect()),
        other => panic!("{other}"),
    };
    (shape, wide(numbers))
}

/// Puts an array where it belongs in a record.
fn place(record: &mut Record, name: &str, (shape, numbers): (Vec<u64>, Vec<f64>)) {
    let rows = || {
        let whole: Vec<u64> = numbers.iter().map(|x| *x as u64).collect();
        whole.chunks(shape[1] as usize).map(<[u64]>::to_vec).collect()
    };
    match name {
        "step" => record.step = numbers[0] as u64,
        "time" => record.time = numbers[0],
        "faces" => record.faces = rows(),
        "edges" => record.edges = rows(),
        _ => {
            record.columns.insert(name.to_string(), numbers);
        }
    }
}

fn npz(folder: &Folder, name: &str) -> Vec<Record> {
    let mut archive = zip::ZipArchive::new(File::open(folder.path(name)).expect("it is there")).expect("an archive");
    let mut records: BTreeMap<u64, Record> = BTreeMap::new();
    let (mut steps, mut times) = (Vec::new(), Vec::new());
    for i in 0..archive.len() {
        let mut entry = archive.by_index(i).expect("an entry");
        let name = entry.name().expect("a name").strip_suffix(".npy").expect("an array").to_string();
        let mut bytes = Vec::new();
        entry.read_to_end(&mut bytes).expect("its bytes");
        match name.split_once('/') {
            Some((step, name)) => place(records.entry(step.parse().expect("a step")).or_default(), name, array(&bytes)),
            None if name == "steps" => steps = array(&bytes).1,
            None => times = array(&bytes).1,
        }
    }
    let records: Vec<_> = records.into_iter().map(|(step, record)| Record { step, ..record }).collect();
    assert_eq!(steps, records.iter().map(|record| record.step as f64).collect::<Vec<_>>());
    records.into_iter().zip(times).map(|(record, time)| Record { time, ..record }).collect()
}

fn npy(folder: &Folder, stem: &str) -> Record {
    let mut record = Record::default();
    for name in folder.names() {
        let array_name = name.strip_prefix(stem).and_then(|rest| rest.strip_suffix(".npy"));
        let Some(array_name) = array_name.and_then(|rest| rest.strip_prefix('_')) else { continue };
        place(&mut record, array_name, array(&fs::read(folder.path(&name)).expect("it is there")));
    }
    record
}

pub(crate) fn ply(folder: &Folder, name: &str) -> Record {
    let mut file = BufReader::new(File::open(folder.path(name)).expect("it is there"));
    let cloud = Parser::<DefaultElement>::new().read_ply(&mut file).unwrap_or_else(|e| panic!("{name}: {e:?}"));
    let wide = |property: &Property| match property {
        Property::Float(x) => f64::from(*x),
        Property::Double(x) => *x,
        Property::UInt(x) => f64::from(*x),
        Property::Int(x) => f64::from(*x),
        Property::UChar(x) => f64::from(*x),
        other => panic!("{other:?}"),
    };
    let mut record = Record::default();
    for name in cloud.header.elements["vertex"].properties.keys() {
        let values = cloud.payload["vertex"].iter().map(|vertex| wide(&vertex[name])).collect();
        record.columns.insert(name.clone(), values);
    }
    let comment = &cloud.header.comments[0];
    let mut words = comment.split(' ');
    record.time = words.nth(1).and_then(|x| x.parse().ok()).expect("an instant");
    record.step = words.nth(1).and_then(|x| x.parse().ok()).expect("a step");
    let corners = |face: &DefaultElement| match &face["vertex_indices"] {
        Property::ListInt(corners) => corners.iter().map(|&corner| corner as u64).collect::<Vec<u64>>(),
        other => panic!("{other:?}"),
    };
    record.faces = cloud.payload.get("face").into_iter().flatten().map(corners).collect();
    let ends = |edge: &DefaultElement| ["vertex1", "vertex2"].map(|end| wide(&edge[end]) as u64).to_vec();
    record.edges = cloud.payload.get("edge").into_iter().flatten().map(ends).collect();
    record
}

fn xyz(text: &str) -> Vec<Record> {
    let mut lines = text.lines();
    let mut records = Vec::new();
    while let Some(count) = lines.next() {
        let comment = lines.next().expect("a comment");
        let entry = |key: &str| comment.split(' ').find_map(|word| word.strip_prefix(key)).expect("an entry");
        let mut record = Record { step: entry("Step=").parse().expect("a step"), ..Record::default() };
        record.time = entry("Time=").parse().expect("an instant");
        let parts: Vec<&str> = entry("Properties=").split(':').collect();
        let names = parts.chunks(3).flat_map(|part| match part[0] {
            "pos" => vec!["x", "y", "z"],
            "velo" => vec!["vx", "vy", "vz"],
            "color" => vec!["red", "green", "blue"],
            "transparency" => vec!["alpha"],
            name => vec![name],
        });
        let names: Vec<&str> = names.collect();
        names.iter().skip(1).for_each(|name| drop(record.columns.insert(name.to_string(), Vec::new())));
        for _ in 0..count.parse::<usize>().expect("a count") {
            for (name, word) in names.iter().zip(lines.next().expect("an atom").split(' ')).skip(1) {
                let number: f64 = word.parse().expect("a number");
                let number: f64 = match *name {
                    "red" | "green" | "blue" => (number * 255.0).round(),
                    "alpha" => ((1.0_f64 - number) * 255.0).round(),
                    _ => number,
                };
                record.columns.get_mut(*name).expect("a column").push(number);
            }
        }
        records.push(record);
    }
    records
}

/// The arrays of a file of VTK's, by the element they are in and their names.
pub(crate) fn vtk(text: &str) -> BTreeMap<(String, String), Vec<f64>> {
    let mut reader = Reader::from_str(text);
    let (mut path, mut arrays, mut kind) = (Vec::new(), BTreeMap::new(), (String::new(), String::new()));
    loop {
        match reader.read_event().expect("XML") {
            Event::Start(start) => {
                let name = start.name().as_ref().to_string();
                let get = |key: &str| {
                    let attribute = start.try_get_attribute(key).expect("attributes");
                    attribute.map(|a| a.value.to_string()).unwrap_or_default()
                };
                kind = (get("type"), get("Name"));
                path.push(name);
            }
            Event::Text(text) if path.last().is_some_and(|name| name == "DataArray") => {
                let bytes = STANDARD.decode(&*text).expect("base 64");
                let (length, bytes) = bytes.split_at(8);
                assert_eq!(length, (bytes.len() as u64).to_le_bytes());
                arrays.insert((path[path.len() - 2].clone(), kind.1.clone()), wide(&kind.0, bytes));
            }
            Event::End(_) => drop(path.pop()),
            Event::Eof => return arrays,
            _ => {}
        }
    }
}

fn wide(kind: &str, bytes: &[u8]) -> Vec<f64> {
    fn each<const N: usize>(bytes: &[u8], number: impl Fn([u8; N]) -> f64) -> Vec<f64> {
        bytes.as_chunks().0.iter().map(|bytes| number(*bytes)).collect()
    }
    match kind {
        "Float32" => each(bytes, |bytes| f32::from_le_bytes(bytes).into()),
        "Float64" => each(bytes, f64::from_le_bytes),
        "UInt32" => each(bytes, |bytes| u32::from_le_bytes(bytes).into()),
        "Int32" => each(bytes, |bytes| i32::from_le_bytes(bytes).into()),
        "Int64" => each(bytes, |bytes| i64::from_le_bytes(bytes) as f64),
        "UInt8" => each(bytes, |[byte]| byte.into()),
        other => panic!("{other}"),
    }
}

pub(crate) fn vtp(text: &str) -> Record {
    let mut record = Record::default();
    let parts = |names: &[&str], numbers: &[f64], record: &mut Record| {
        for (i, name) in names.iter().enumerate() {
            let column = numbers.iter().skip(i).step_by(names.len()).copied().collect();
            record.columns.insert(name.to_string(), column);
        }
    };
    for ((at, name), numbers) in vtk(text) {
        let cells =
            |n: usize| numbers.iter().map(|x| *x as u64).collect::<Vec<_>>().chunks(n).map(<[u64]>::to_vec).collect();
        match (at.as_str(), name.as_str()) {
            ("FieldData", "TimeValue") => record.time = numbers[0],
            ("Points", _) => parts(&["x", "y", "z"], &numbers, &mut record),
            ("PointData", "velocity") => parts(&["vx", "vy", "vz"], &numbers, &mut record),
            ("PointData", "color") => parts(&["red", "green", "blue", "alpha"], &numbers, &mut record),
            ("PointData", name) => drop(record.columns.insert(name.to_string(), numbers)),
            ("Polys", "connectivity") => record.faces = cells(3),
            ("Lines", "connectivity") => record.edges = cells(2),
            _ => {}
        }
    }
    record
}

/// An OBJ; colours to the nearest of 255 parts.
pub(crate) fn obj(text: &str) -> Record {
    let mut record = Record::default();
    let names = ["x", "y", "z", "red", "green", "blue"];
    names.iter().for_each(|name| drop(record.columns.insert(name.to_string(), Vec::new())));
    for line in text.lines() {
        let (kind, rest) = line.split_once(' ').expect("a word");
        let numbers = || rest.split(' ').map(|x| x.parse::<f64>().expect("a number"));
        let indices = || numbers().map(|x| x as u64 - 1).collect::<Vec<u64>>();
        match kind {
            "v" => names.iter().zip(numbers()).enumerate().for_each(|(i, (name, x))| {
                let x = if i < 3 { x } else { (x * 255.0).round() };
                record.columns.get_mut(*name).expect("a column").push(x);
            }),
            "f" => record.faces.push(indices()),
            "l" => record.edges.push(indices()),
            _ => {}
        }
    }
    record
}

/// The records of a glTF, its buffer being apart.
fn gltf(document: &Value, buffer: &[u8]) -> Vec<Record> {
    let accessor = |number: &Value| -> Vec<f64> {
        let accessor = &document["accessors"][number.as_u64().expect("a number") as usize];
        let view = &document["bufferViews"][accessor["bufferView"].as_u64().expect("a view") as usize];
        let [start, len] = ["byteOffset", "byteLength"].map(|key| view[key].as_u64().expect("bytes") as usize);
        let bytes = &buffer[start..start + len];
        if accessor["componentType"] == 5126 { wide("Float32", bytes) } else { wide("UInt32", bytes) }
    };
    let encode = |light: f64| {
        let encoded = if light <= 0.003_130_8 { light * 12.92 } else { 1.055 * light.powf(1.0 / 2.4) - 0.055 };
        (encoded * 255.0).round()
    };
    let record = |node: &Value| {
        let mut record = Record { step: node["extras"]["step"].as_u64().expect("a step"), ..Record::default() };
        record.time = node["extras"]["time"].as_f64().expect("an instant");
        let Some(mesh) = node["mesh"].as_u64() else { return record };
        let primitives = document["meshes"][mesh as usize]["primitives"].as_array().expect("a list");
        let mut add = |names: &[&str], numbers: &[f64]| {
            for (i, name) in names.iter().enumerate() {
                let column = numbers.iter().skip(i).step_by(names.len()).copied().collect();
                record.columns.insert(name.to_string(), column);
            }
        };
        for (name, number) in primitives[0]["attributes"].as_object().expect("attributes") {
            let numbers = accessor(number);
            match name.as_str() {
                "POSITION" => add(&["x", "y", "z"], &numbers),
                "_velocity" => add(&["vx", "vy", "vz"], &numbers),
                "COLOR_0" => {
                    let channel = |(i, x): (usize, &f64)| if i % 4 < 3 { encode(*x) } else { (x * 255.0).round() };
                    let channels: Vec<f64> = numbers.iter().enumerate().map(channel).collect();
                    add(&["red", "green", "blue", "alpha"], &channels);
                }
                name => add(&[name.trim_start_matches('_')], &numbers),
            }
        }
        for primitive in primitives {
            let indices: Vec<u64> = accessor(&primitive["indices"]).iter().map(|x| *x as u64).collect();
            match primitive["mode"].as_u64() {
                Some(1) => record.edges = indices.chunks(2).map(<[u64]>::to_vec).collect(),
                Some(4) => record.faces = indices.chunks(3).map(<[u64]>::to_vec).collect(),
                _ => {}
            }
        }
        record
    };
    document["nodes"].as_array().expect("a list").iter().map(record).collect()
}

/// The nodes that the animation of a glTF shows at an instant.
fn shown(document: &Value, buffer: &[u8], time: f64) -> Vec<u64> {
    let numbers = |number: &Value| {
        let accessor = &document["accessors"][number.as_u64().expect("a number") as usize];
        let view = &document["bufferViews"][accessor["bufferView"].as_u64().expect("a view") as usize];
        let [start, len] = ["byteOffset", "byteLength"].map(|key| view[key].as_u64().expect("bytes") as usize);
        wide("Float32", &buffer[start..start + len])
    };
    let animation = &document["animations"][0];
    let is_shown = |channel: &&Value| {
        let sampler = &animation["samplers"][channel["sampler"].as_u64().expect("a number") as usize];
        assert_eq!((&sampler["interpolation"], &channel["target"]["path"]), (&"STEP".into(), &"scale".into()));
        let (times, scales) = (numbers(&sampler["input"]), numbers(&sampler["output"]));
        assert!(times.is_sorted_by(|a, b| a < b) && scales.len() == 3 * times.len());
        // Before the first instant counts what is there at it.
        let key = times.iter().rposition(|start| *start <= time).unwrap_or(0);
        scales[3 * key..3 * key + 3] == [1.0; 3]
    };
    let channels = animation["channels"].as_array().expect("a list").iter().filter(is_shown);
    channels.filter_map(|channel| channel["target"]["node"].as_u64()).collect()
}

pub(crate) fn glb(bytes: &[u8]) -> Vec<Record> {
    let word = |at: usize| u32::from_le_bytes(bytes[at..at + 4].try_into().expect("four bytes")) as usize;
    assert_eq!((&bytes[..4], word(4), word(8)), (&b"glTF"[..], 2, bytes.len()));
    let end = 20 + word(12);
    let document: Value = serde_json::from_slice(&bytes[20..end]).expect("JSON");
    let buffer = if end < bytes.len() { &bytes[end + 8..] } else { &[] };
    assert!(end % 4 == 0 && buffer.len() % 4 == 0);
    gltf(&document, buffer)
}

proptest! {
    #![proptest_config(tries(60))]

    #[test]
    fn what_is_read_back_is_the_state(scene in varied()) {
        let text = scene.json().to_string();
        let (truth, hash) = truth(&text);
        let folder = Folder::with("a.json", &text);
        let outs: String = ["csv", "xyz", "npz", "npy", "ply", "obj", "vtp", "glb", "gltf"]
            .map(|end| format!(" --out a.{end}")).concat();
        let frames_out = format!("run a.json --steps {STEPS} --line record --out a.jsonl");
        prop_assert_eq!(&folder.hash(&format!("a.json --steps {STEPS}{outs} --events e.csv")), &hash, "{}", text);
        folder.run(&frames_out).fine();

        let living: Vec<&Record> = truth.iter().filter(|record| !record.columns["id"].is_empty()).collect();
        let tables = csv(&folder.read("a.csv"));
        prop_assert_eq!(tables.len(), living.len());
        for (read, truth) in tables.iter().zip(living) {
            agree("csv", read, truth, &[]);
        }
        let document: Value = serde_json::from_str(&folder.read("a.gltf")).expect("JSON");
        let inside = document["buffers"][0]["uri"].as_str().map(|uri| uri.split_once(',').expect("a comma").1);
        let buffer = STANDARD.decode(inside.unwrap_or_default()).expect("base 64");
        for (node, time) in (0..).zip(truth.iter().map(|record| record.time)) {
            prop_assert_eq!(shown(&document, &buffer, time), [node]);
            prop_assert_eq!(shown(&document, &buffer, time + 0.9 * DT), [node]);
        }
        let many = [
            ("jsonl", frames(&folder.read("a.jsonl"))),
            ("npz", npz(&folder, "a.npz")),
            ("glb", glb(&fs::read(folder.path("a.glb")).expect("it is there"))),
            ("gltf", gltf(&document, &buffer)),
        ];
        for (what, records) in many {
            prop_assert_eq!(records.len(), truth.len(), "{}", what);
            for (read, truth) in records.iter().zip(&truth) {
                prop_assert_eq!((read.step, read.time), (truth.step, truth.time), "{}", what);
                let is_gltf = what.starts_with('g');
                if is_gltf && truth.columns["id"].is_empty() {
                    continue;
                }
                let truth = if is_gltf { single(truth) } else { truth.clone() };
                agree_in_all(what, read, &truth, &[]);
            }
        }
        for (read, truth) in xyz(&folder.read("a.xyz")).iter().zip(&truth) {
            prop_assert_eq!((read.step, read.time), (truth.step, truth.time));
            agree("xyz", read, truth, &[]);
        }
        for (i, truth) in truth.iter().enumerate() {
            agree_in_all("ply", &ply(&folder, &format!("a_{i:06}.ply")), truth, &[]);
            agree_in_all("npy", &npy(&folder, &format!("a_{i:06}")), truth, &[]);
            agree_in_all("vtp", &vtp(&folder.read(&format!("a_{i:06}.vtp"))), truth, &[]);
            let others: Vec<&str> = truth.columns.keys().map(String::as_str).collect();
            agree_in_all("obj", &obj(&folder.read(&format!("a_{i:06}.obj"))), truth, &others);
        }
        let index = folder.read("a.pvd");
        for (i, truth) in truth.iter().enumerate() {
            let entry = format!(r#"<DataSet timestep="{}" part="0" file="a_{i:06}.vtp"/>"#, truth.time);
            prop_assert!(index.contains(&entry), "{} in {}", entry, index);
        }
    }
}

/// A record whose ages have been rounded to singles.
fn single(record: &Record) -> Record {
    let mut record = record.clone();
    for name in ["age", "remaining"] {
        let column = record.columns.get_mut(name).expect("a column");
        column.iter_mut().for_each(|value| *value = f64::from(*value as f32));
    }
    record
}

#[test]
fn every_format_takes_a_pattern() {
    let folder = Folder::with("busy.scn", BUSY);
    let ends = ["csv", "jsonl", "xyz", "npz", "npy", "ply", "obj", "vtp", "glb", "gltf"];
    let outs: String = ends.map(|end| format!(" --out o/{end}-%03d.{end}")).concat();
    folder.run(&format!("run busy.scn --steps 4 --every 2{outs} --out all.csv")).fine();
    let names = folder.names();
    for end in ends.into_iter().filter(|end| *end != "npy") {
        let made: Vec<_> =
            names.iter().filter(|name| name.ends_with(&format!(".{end}")) && name.starts_with("o/")).collect();
        assert_eq!(made, [0, 1, 2].map(|i| format!("o/{end}-{i:03}.{end}")).iter().collect::<Vec<_>>());
    }
    assert!(names.iter().any(|name| name == "o/vtp.pvd") && names.iter().any(|name| name == "o/npy-002_alpha.npy"));
    let parts: Vec<Record> = (0..3).flat_map(|i| csv(&folder.read(&format!("o/csv-{i:03}.csv")))).collect();
    let all = csv(&folder.read("all.csv"));
    assert_eq!(parts.len(), 3);
    for (i, (part, whole)) in parts.iter().zip(&all).enumerate() {
        agree("csv", part, whole, &[]);
        agree("xyz", &xyz(&folder.read(&format!("o/xyz-{i:03}.xyz")))[0], whole, &[]);
        agree("npz", &npz(&folder, &format!("o/npz-{i:03}.npz"))[0], whole, &[]);
        agree("ply", &ply(&folder, &format!("o/ply-{i:03}.ply")), whole, &[]);
    }
    let cases = [
        ("--events o/%d.csv", "events are one file"),
        ("--events o/%s.csv", "a % in a name must be the place of the number"),
        ("--out o/%s.csv", "a % in a name must be the place of the number"),
    ];
    folder.misuse("run busy.scn --steps 1", &cases);
}

#[test]
fn events_tell_what_happened_in_the_order_of_instants() {
    let folder = Folder::with("busy.scn", BUSY);
    let run = "busy.scn --dt 1/60 --steps 120 --capacity 20";
    let report = folder.report(&format!("{run} --events e.csv --out a.csv"));
    assert_eq!(report["hash"], folder.hash(run).as_str(), "who watches changes nothing");
    let told = folder.report(&format!("{run} --events e.jsonl --ledger"));
    assert_eq!(report["hash"], told["hash"]);
    let lines: Vec<Value> =
        folder.read("e.jsonl").lines().map(|line| serde_json::from_str(line).expect("JSON")).collect();
    let mut table = csv::Reader::from_reader(folder.read("e.csv").into_bytes().as_slice()).into_records_owned();
    let count = |event: &str| lines.iter().filter(|line| line["event"] == event).count() as f64;
    assert_eq!(count("birth"), number(&report, "born"));
    assert_eq!(count("hit"), number(&report, "hits") + 2.0 * number(&report, "contacts"));
    for cause in ["lifetime", "sink"] {
        let deaths = lines.iter().filter(|line| line["cause"] == cause).count() as f64;
        assert_eq!(deaths, number(&report, &format!("died/{cause}")), "{cause}");
    }
    let refused: f64 = lines.iter().filter_map(|line| line["count"].as_f64()).sum();
    assert_eq!(refused, number(&report, "refused"));
    assert_eq!(table.len(), lines.len());
    let mut before = 0.0;
    for line in &lines {
        let (step, time) = (line["step"].as_f64().expect("a step"), line["time"].as_f64().expect("an instant"));
        assert!(time >= before && time <= step / 60.0 + 1e-8 && time >= (step - 1.0) / 60.0 - 1e-8, "{line}");
        before = time;
        let row = table.remove(0);
        assert_eq!(row.get(2), line["event"].as_str());
        assert_eq!(row.get(5).and_then(|x| x.parse().ok()), line["x"].as_f64(), "{line}");
    }
    // Whoever was born and has not died is there at the end.
    let ids = |event: &str| {
        lines.iter().filter(|line| line["event"] == event).map(|line| line["id"].as_u64()).collect::<Vec<_>>()
    };
    let (born, died) = (ids("birth"), ids("death"));
    let mut live: Vec<_> = (0..3).map(Some).chain(born).filter(|id| !died.contains(id)).collect();
    live.sort_unstable();
    let end = csv(&folder.read("a.csv")).pop().expect("a record");
    assert_eq!(live, end.columns["id"].iter().map(|id| Some(*id as u64)).collect::<Vec<_>>());
}

/// The rows of a table, all at once.
trait Rows {
    fn into_records_owned(self) -> Vec<csv::StringRecord>;
}

impl Rows for csv::Reader<&[u8]> {
    fn into_records_owned(self) -> Vec<csv::StringRecord> {
        self.into_records().map(|row| row.expect("a row")).collect()
    }
}

#[cfg(unix)]
#[test]
fn standard_output_takes_a_recording_and_standard_input_gives_a_scene() {
    let folder = Folder::with("a.scn", ONE);
    folder.run("convert a.scn a.json").fine();
    folder.run("run a.scn --steps 3 --out a.csv --out a.xyz").fine();
    for scene in ["a.scn", "a.json"] {
        let answer = folder.shell(&format!("$POINTMASS run - --steps 3 --out - < {scene}"));
        assert_eq!((answer.code, answer.stdout), (0, folder.read("a.csv")));
        assert!(answer.stderr.contains("standard input") && answer.stderr.contains("particles"), "{}", answer.stderr);
    }
    let answer = folder.shell("$POINTMASS run a.scn --steps 3 --out - --format xyz --report json");
    assert_eq!((answer.code, answer.stdout), (0, folder.read("a.xyz")));
    assert!(serde_json::from_str::<Value>(&answer.stderr).is_ok(), "{}", answer.stderr);
    let answer = folder.shell("$POINTMASS run a.scn --steps 3 --out - --format npz > a.npz 2>/dev/null");
    assert_eq!((answer.code, npz(&folder, "a.npz").len()), (0, 4));
    // A reader that has gone away is no error.
    assert_eq!(folder.shell("$POINTMASS run a.scn --steps 9999 --out - 2>/dev/null | head -n 1").code, 0);

    let answer = folder.shell("$POINTMASS check - --report json < a.scn");
    assert_eq!(answer.code, 0, "{answer:?}");
    for (script, error) in [
        ("run a.scn --out - --format ply", "standard output: ply is one file a record; choose --format csv, jsonl"),
        ("run a.scn --out - --out -", "two --out would write standard output"),
        ("run - < /dev/null 2>&1 && echo 'particle x' | $POINTMASS run -", "standard input:1"),
        ("run - --steps 1 < a.npz", "standard input:2: not a text: byte"),
    ] {
        let answer = folder.shell(&format!("$POINTMASS {script}"));
        assert!(answer.code == 1 && answer.stderr.contains(error), "{script}: {answer:?}");
    }
    assert!(folder.names().iter().all(|name| !name.starts_with('.') && name != "-"), "{:?}", folder.names());
}

#[test]
fn a_record_without_anybody_is_a_whole_file_too() {
    let folder = Folder::with("a.json", "{}");
    folder.run("run a.json --steps 1 --out a.npz --out a.vtp --out a.obj --out a.glb --out a.npy").fine();
    assert_eq!(npz(&folder, "a.npz").len(), 2);
    assert_eq!(glb(&fs::read(folder.path("a.glb")).expect("it is there")).len(), 2);
    assert!(vtp(&folder.read("a_000001.vtp")).columns["x"].is_empty());
    assert_eq!(vtk(&folder.read("a_000001.vtp"))[&("FieldData".into(), "particles".into())], [0.0]);
    assert!(npy(&folder, "a_000001").columns["mass"].is_empty());
}

/// No column of a user's own can be taken for one of ours, in any format.
#[test]
fn names_of_columns_are_taken() {
    let varied = Varied {
        particles: 3,
        balls: true,
        charged: true,
        own: false,
        springs: true,
        cells: [1, 1],
        rate: 9,
        lifetime: true,
        materials: true,
    };
    let mut scene = varied.json();
    let folder = Folder::with("a.json", scene.to_string());
    folder.run("run a.json --steps 1 --line record --out a.jsonl --out a.vtp --out a.xyz").fine();
    let object: serde_json::Map<String, Value> =
        serde_json::from_str(folder.read("a.jsonl").lines().next().expect("a line")).expect("an object");
    let arrays = vtk(&folder.read("a_000000.vtp")).into_keys();
    let arrays = arrays.filter(|(at, _)| at == "PointData").map(|(_, name)| name);
    let atoms = folder.read("a.xyz");
    let atoms =
        atoms.split_once("Properties=").and_then(|(_, rest)| rest.split_once(' ')).expect("a list").0.split(':');
    for name in object.into_iter().map(|(name, _)| name).chain(arrays).chain(atoms.step_by(3).map(String::from)) {
        scene["custom"] = json!([{"name": name}]);
        folder.write("a.json", scene.to_string());
        let answer = folder.run("run a.json --steps 1");
        assert!(answer.error().contains(&format!("there is a \"{name}\" already")), "{name}: {answer:?}");
    }
}

/// A torn cloth loses the triangles beside what is torn, and a mesh is one as its file says.
#[test]
fn cloths_are_triangles_for_as_long_as_they_hold() {
    let sheet = r#"{"sheet": {"corner": [0, 0, 0], "sides": [[2, 0, 0], [0, 0, 2]], "cells": [2, 2]}}"#;
    let scene = |form: &str, breaks: &str| {
        format!(
            r#"{{"run": {{"dt": 0.01, "integrator": "symplectic"}},
            "forces": [{{"gravity": {{"acceleration": [0, -50, 0]}}}}],
            "cloths": [{{"form": {form}, "mass": 1, "fixed": [0], {breaks}
            "springs": {{"structural": {{"ks": 3}}}}}}]}}"#
        )
    };
    let folder = Folder::with("a.json", scene(sheet, r#""breaks_at": 1.05,"#));
    folder.run("run a.json --steps 100 --every 100 --out a.ply").fine();
    assert_eq!(ply(&folder, "a_000000.ply").faces.len(), 8);
    assert!(ply(&folder, "a_000001.ply").faces.len() < 8);
    folder.write("m/t.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nf 1 2 3\nf 3 2 4\n");
    folder.write("m/a.json", scene(r#"{"mesh": "t.obj"}"#, ""));
    folder.run("run m/a.json --steps 1 --out b.ply").fine();
    let record = ply(&folder, "b_000001.ply");
    assert_eq!((record.faces, record.edges), (vec![vec![0, 1, 2], vec![2, 1, 3]], vec![]));
}

/// Whoever reads a run finds the same arrays in all records, though all springs have broken.
#[test]
fn records_have_edges_and_faces_though_none_are_left() {
    // The sheet is held by two opposite corners, so that all its four sides stretch.
    let scene = r#"{"run": {"dt": 0.05}, "particles": [{}, {"position": [1, 0, 0], "velocity": [9, 0, 0]}],
        "springs": [{"ends": [0, 1], "rest_length": 1, "ks": 1, "breaks_at": 1.5}],
        "cloths": [{"form": {"sheet": {"corner": [0, 0, 9], "sides": [[1, 0, 0], [0, 1, 0]], "cells": [1, 1]}}, "mass": 1,
            "fixed": [0, 3], "breaks_at": 1.05, "springs": {"structural": {"ks": 3}}}],
        "forces": [{"gravity": {"acceleration": [0, 0, -50]}}]}"#;
    let folder = Folder::with("a.json", scene);
    folder.run("run a.json --steps 4 --out a.npz --out a.npy --out a.jsonl --line record").fine();
    let told = folder.read("a.jsonl");
    let objects: Vec<Value> = told.lines().map(|line| serde_json::from_str(line).expect("an object")).collect();
    assert_eq!(objects[0]["faces"].as_array().map(Vec::len), Some(2));
    assert_eq!(objects[0]["edges"], json!([[0, 1]]));
    assert_eq!((&objects[4]["faces"], &objects[4]["edges"]), (&json!([]), &json!([])));
    let mut archive = zip::ZipArchive::new(File::open(folder.path("a.npz")).expect("it is there")).expect("an archive");
    for (name, columns) in [("faces", 3), ("edges", 2)] {
        let mut bytes = Vec::new();
        archive.by_name(&format!("4/{name}.npy")).expect("an array").read_to_end(&mut bytes).expect("its bytes");
        assert_eq!(array(&bytes), (vec![0, columns], vec![]), "{name}");
        let bytes = fs::read(folder.path(&format!("a_000004_{name}.npy"))).expect("it is there");
        assert_eq!(array(&bytes), (vec![0, columns], vec![]), "{name}");
    }
    // Where there is nothing of the kind there are no such arrays.
    folder.write("b.json", r#"{"particles": [{}]}"#);
    folder.run("run b.json --steps 1 --out b.jsonl --line record").fine();
    assert!(!folder.read("b.jsonl").contains("edges") && !folder.read("b.jsonl").contains("faces"));
}

/// Bonds of constraints are told as edges and faces, of those who live; each once, whoever else binds it.
#[test]
fn what_constraints_bind_is_edges_and_faces() {
    let particle = |i: u32, rest: &str| format!(r#"{{"position": [{}, {}, {}]{rest}}}"#, i % 4, i / 4, (i * i) % 3);
    // The tenth dies in the second step, and so does its link.
    let particles: Vec<String> =
        (0..12).map(|i| particle(i, if i == 9 { r#", "lifetime": 0.015"# } else { "" })).collect();
    let scene = format!(
        r#"{{"run": {{"dt": 0.01}}, "particles": [{}],
        "springs": [{{"ends": [1, 0], "rest_length": 1, "ks": 1}}, {{"ends": [10, 11], "rest_length": 1, "ks": 1}}],
        "constraints": [
            {{"rope": {{"particles": [0, 1, 2, 3], "lengths": [1], "compliance": 1, "closed": true}}}},
            {{"distance": {{"ends": [3, 4], "length": 1, "compliance": 1}}}},
            {{"distance": {{"ends": [9, 4], "length": 1, "compliance": 1}}}},
            {{"strands": {{"particles": [5, 6, 7, 8, 10], "points": [2, 3], "params": {{"bending": [1, 1], "twisting": 1}}}}}},
            {{"shell": {{"particles": [0, 4, 5], "triangles": [[0, 1, 2]], "hinges": [],
                "warp": [1, 0, 0], "params": {{"stretch": [1, 1], "shear": 1, "bending": 0}}}}}}
        ]}}"#,
        particles.join(", ")
    );
    let folder = Folder::with("a.json", scene);
    folder.run("run a.json --steps 2 --out a.ply --out a.vtp --out a.jsonl --line record").fine();
    let bound: [[u64; 2]; 10] = [[0, 1], [3, 0], [1, 2], [2, 3], [3, 4], [9, 4], [5, 6], [7, 8], [8, 10], [10, 11]];
    for (step, gone) in [(0, false), (1, false), (2, true)] {
        let name = |end: &str| format!("a_{step:06}.{end}");
        let told = [
            ply(&folder, &name("ply")),
            vtp(&folder.read(&name("vtp"))),
            frames(&folder.read("a.jsonl"))[step].clone(),
        ];
        let lives = bound.iter().filter(|pair| !(gone && pair.contains(&9)));
        // Rows behind the dead one move up.
        let place = |number: u64| number - u64::from(gone && number > 9);
        let mut expected: Vec<_> = lives.map(|&[a, b]| [place(a.min(b)), place(a.max(b))]).collect();
        expected.sort_unstable();
        for record in told {
            let mut edges: Vec<_> =
                record.edges.iter().map(|ends| [ends[0].min(ends[1]), ends[0].max(ends[1])]).collect();
            edges.sort_unstable();
            assert_eq!(edges, expected, "step {step}");
            assert_eq!(record.faces, [[0, 4, 5]], "step {step}");
        }
    }
}
