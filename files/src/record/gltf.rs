//! glTF 2.0: particles as points, cloths and rigid bodies as triangles, other springs, ropes, rods and strands as lines; each record a node of its own, which an
//! animation shows from its instant to the next record's. Binary (`.glb`), or text with its numbers inside (`.gltf`).

use super::{Frame, Out, Writer};
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use serde_json::{Map, Value, json};
use std::io::{self, Write};

/// The kind of single-precision numbers, as the format counts them.
const FLOAT: u32 = 5126;
/// The kind of whole numbers, likewise.
const INDEX: u32 = 5125;
/// The kind of primitives that are single vertices, likewise.
const POINTS: u32 = 0;
/// Pairs of vertices, likewise.
const LINES: u32 = 1;
/// Triples of vertices, likewise.
const TRIANGLES: u32 = 4;

/// One file of all records.
pub(super) struct Gltf {
    out: Out,
    binary: bool,
    /// The numbers.
    bytes: Vec<u8>,
    views: Vec<Value>,
    accessors: Vec<Value>,
    meshes: Vec<Value>,
    nodes: Vec<Value>,
    times: Vec<f32>,
    translucent: bool,
}

impl Gltf {
    /// A file that is binary or text.
    pub(super) fn new(out: Out, binary: bool) -> Self {
        let (bytes, views, accessors, meshes) = Default::default();
        Self { out, binary, bytes, views, accessors, meshes, nodes: Vec::new(), times: Vec::new(), translucent: false }
    }

    /// Puts in numbers, so many together, and returns the number of their accessor.
    fn numbers(&mut self, kind: &str, together: usize, values: &[f32]) -> usize {
        let bytes = values.iter().flat_map(|value| value.to_le_bytes());
        let columns = || (0..together).map(|i| values.iter().skip(i).step_by(together).copied());
        let least: Vec<f32> = columns().map(|column| column.fold(f32::INFINITY, f32::min)).collect();
        let most: Vec<f32> = columns().map(|column| column.fold(f32::NEG_INFINITY, f32::max)).collect();
        let count = values.len() / together;
        let accessor = json!({"componentType": FLOAT, "count": count, "type": kind, "min": least, "max": most});
        self.add(bytes, accessor)
    }

    /// Puts in indices of vertices.
    fn indices(&mut self, indices: &[u32]) -> usize {
        let bytes = indices.iter().flat_map(|index| index.to_le_bytes());
        self.add(bytes, json!({"componentType": INDEX, "count": indices.len(), "type": "SCALAR"}))
    }

    /// Puts in the bytes of an accessor, and returns its number.
    fn add(&mut self, bytes: impl Iterator<Item = u8>, mut accessor: Value) -> usize {
        let start = self.bytes.len();
        self.bytes.extend(bytes);
        accessor["bufferView"] = self.views.len().into();
        self.views.push(json!({"buffer": 0, "byteOffset": start, "byteLength": self.bytes.len() - start}));
        self.accessors.push(accessor);
        self.accessors.len() - 1
    }

    /// The mesh of a record, in which somebody lives.
    fn mesh(&mut self, frame: &Frame) -> Value {
        let attributes = self.attributes(frame);
        let points: Vec<u32> = frame.singletons().collect();
        let parts =
            [(POINTS, &points[..]), (LINES, frame.edges.as_flattened()), (TRIANGLES, frame.faces.as_flattened())];
        let mut primitives = Vec::new();
        for (mode, indices) in parts.into_iter().filter(|(_, indices)| !indices.is_empty()) {
            let indices = self.indices(indices);
            primitives.push(json!({"attributes": attributes, "indices": indices, "mode": mode, "material": 0}));
        }
        json!({"name": frame.step.to_string(), "primitives": primitives})
    }

    /// The attributes of each particle: numbers in single precision, names of ours behind an underscore.
    fn attributes(&mut self, frame: &Frame) -> Value {
        const PARTS: [&str; 10] = ["x", "y", "z", "vx", "vy", "vz", "red", "green", "blue", "alpha"];
        let mut attributes = Map::new();
        let places: Vec<f32> = frame.places().flatten().collect();
        attributes.insert("POSITION".into(), self.numbers("VEC3", 3, &places).into());
        self.translucent |= frame.colors.iter().any(|color| color[3] < u8::MAX);
        let colors: Vec<f32> = frame.colors.iter().flat_map(|&[r, g, b, a]| light([r, g, b], a)).collect();
        attributes.insert("COLOR_0".into(), self.numbers("VEC4", 4, &colors).into());
        let [vx, vy, vz] = frame.singles(["vx", "vy", "vz"]);
        let velocities: Vec<f32> = (0..frame.len).flat_map(|row| [vx[row], vy[row], vz[row]]).collect();
        attributes.insert("_velocity".into(), self.numbers("VEC3", 3, &velocities).into());
        for column in frame.others(&PARTS) {
            let values: Vec<f32> = (0..frame.len).map(|row| column.values.at(row).single()).collect();
            let number = self.numbers("SCALAR", 1, &values);
            attributes.insert(format!("_{}", column.name), number.into());
        }
        attributes.into()
    }

    /// The animation that shows one record after the other.
    fn animation(&mut self) -> Value {
        let (mut samplers, mut channels) = (Vec::new(), Vec::new());
        let [shown, hidden] = [[1.0; 3], [0.0; 3]];
        let scales = [vec![shown, hidden], vec![hidden, shown, hidden], vec![hidden, shown]];
        let scales = scales.map(|scale| self.numbers("VEC3", 3, scale.as_flattened()));
        let times = std::mem::take(&mut self.times);
        let last = times.len() - 1;
        for node in 0..times.len() {
            let (turns, scale) = match node {
                0 => (&times[..2], scales[0]),
                _ if node == last => (&[0.0, times[node]][..], scales[2]),
                _ => (&[0.0, times[node], times[node + 1]][..], scales[1]),
            };
            let input = self.numbers("SCALAR", 1, turns);
            channels.push(json!({"sampler": samplers.len(), "target": {"node": node, "path": "scale"}}));
            samplers.push(json!({"input": input, "output": scale, "interpolation": "STEP"}));
        }
        json!([{"name": "records", "samplers": samplers, "channels": channels}])
    }

    /// All but the numbers themselves, in the form that the format has.
    fn document(&mut self) -> Value {
        let animations = (self.nodes.len() > 1).then(|| self.animation());
        let blending = if self.translucent { "BLEND" } else { "OPAQUE" };
        let surface = json!({"metallicFactor": 0, "roughnessFactor": 1});
        let mut document = json!({
            "asset": {"version": "2.0", "generator": "pointmass"},
            "scene": 0,
            "scenes": [{"nodes": (0..self.nodes.len()).collect::<Vec<_>>()}],
            "materials": [{"doubleSided": true, "alphaMode": blending, "pbrMetallicRoughness": surface}],
        });
        let buffers = if self.bytes.is_empty() { vec![] } else { vec![json!({"byteLength": self.bytes.len()})] };
        let lists = [&mut self.nodes, &mut self.meshes, &mut self.accessors, &mut self.views].map(std::mem::take);
        let names = ["nodes", "meshes", "accessors", "bufferViews", "buffers"];
        // Empty lists are not allowed.
        for (name, list) in
            names.into_iter().zip(lists.into_iter().chain([buffers])).filter(|(_, list)| !list.is_empty())
        {
            document[name] = list.into();
        }
        if let Some(animations) = animations {
            document["animations"] = animations;
        }
        document
    }
}

/// A colour as the light that it stands for.
fn light(color: [u8; 3], alpha: u8) -> [f32; 4] {
    let channel = |encoded: u8| {
        let encoded = f64::from(encoded) / 255.0;
        (if encoded <= 0.04045 { encoded / 12.92 } else { ((encoded + 0.055) / 1.055).powf(2.4) }) as f32
    };
    let [red, green, blue] = color.map(channel);
    [red, green, blue, f32::from(alpha) / 255.0]
}

impl Writer for Gltf {
    fn record(&mut self, frame: &Frame) -> io::Result<()> {
        let frame = &*frame.with_surfaces();
        // Vertices behind the particles are corners of bodies.
        let extras = json!({"time": frame.time, "step": frame.step, "particles": frame.particles()});
        let mut node = json!({"name": format!("step {}", frame.step), "extras": extras});
        if frame.len > 0 {
            let mesh = self.mesh(frame);
            node["mesh"] = self.meshes.len().into();
            self.meshes.push(mesh);
        }
        // Who does not play the animation sees the first.
        if !self.nodes.is_empty() {
            node["scale"] = json!([0, 0, 0]);
        }
        self.nodes.push(node);
        self.times.push(frame.time as f32);
        if self.bytes.len() > u32::MAX as usize / 2 {
            let message = "more than 2 GB, which no viewer takes; record fewer steps (--every), or a file each (%04d)";
            return Err(io::Error::other(message));
        }
        Ok(())
    }

    fn close(mut self: Box<Self>) -> io::Result<()> {
        let mut document = self.document();
        if !self.binary {
            if !self.bytes.is_empty() {
                let inside = format!("data:application/octet-stream;base64,{}", STANDARD.encode(&self.bytes));
                document["buffers"][0]["uri"] = inside.into();
            }
            serde_json::to_writer(&mut self.out, &document)?;
            return self.out.flush();
        }
        let mut text = serde_json::to_vec(&document)?;
        text.resize(text.len().next_multiple_of(4), b' ');
        let chunks = [(b"JSON", &text), (b"BIN\0", &self.bytes)].map(|(kind, content)| (kind, content.as_slice()));
        let chunks = chunks.iter().filter(|(_, content)| !content.is_empty());
        let length = 12 + chunks.clone().map(|(_, content)| 8 + content.len()).sum::<usize>();
        let word = |number: usize| (number as u32).to_le_bytes();
        self.out.write_all(&[*b"glTF", word(2), word(length)].concat())?;
        for (kind, content) in chunks {
            self.out.write_all(&[word(content.len()), **kind].concat())?;
            self.out.write_all(content)?;
        }
        self.out.flush()
    }
}
