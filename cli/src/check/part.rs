//! Parts of a scene, by where they stand in its file.

use pointmass::scene::Model;
use pointmass::stability::Mode;
use serde::Serialize;

/// A part of a scene that bounds the step.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct Part {
    /// Where it stands in the file.
    pub(crate) place: String,
    /// Its number among all springs, if it is one.
    #[serde(skip)]
    pub(crate) spring: Option<usize>,
    /// Its properties, in words.
    pub(crate) about: String,
    /// Its oscillation, were it alone.
    pub(crate) mode: Mode,
}

/// Where particle (0) or spring (1) number `number` stands in the file: in a list, in a cloth, in boxes, in strands, in ropes, or in soft bodies.
pub(crate) fn place(model: &Model, kind: usize, number: usize) -> String {
    let boxes = model.boxes.partition_point(|&begin| kind == 0 && begin <= number);
    let cloths = model.cloths.partition_point(|begin| begin[kind] <= number);
    let tufts = &model.locks[..model.locks.len() - model.ropes.len()];
    let strands = tufts.partition_point(|lock| kind == 0 && lock.first as usize <= number);
    let ropes = model.ropes.partition_point(|&begin| kind == 0 && begin <= number);
    let soft = model.soft_bodies.partition_point(|&begin| kind == 0 && begin <= number);
    match [soft, ropes, strands, boxes, cloths] {
        [0, 0, 0, 0, 0] => format!("{}[{number}]", ["particles", "springs"][kind]),
        [0, 0, 0, 0, after] => format!("cloths[{}]", after - 1),
        [0, 0, 0, after, _] => format!("boxes[{}]", after - 1),
        [0, 0, after, ..] => format!("strands[{}]", after - 1),
        [0, after, ..] => format!("ropes[{}]", after - 1),
        [after, ..] => format!("soft_bodies[{}]", after - 1),
    }
}
