//! Memory must not run out: WebAssembly cannot go on after an allocation that fails, so room is made sure of before.

use crate::files::Files;
use pointmass::scene::{BoxForm, Form, SceneFile};
use wasm_bindgen::JsError;

/// Bytes that an object of a scene takes at most, from its text to the running world, while lists of it grow.
const OBJECT: usize = 1536;

/// Bytes that a particle of a cloth takes at most, with its springs.
const WOVEN: usize = 2048;

/// Bytes that a rigid box takes at most, with its particles, and as many for each further piece of a body.
const BOX: usize = 9728;

/// Makes sure that so many bytes are to be had, for `what`.
///
/// # Errors
/// If they are not.
pub(crate) fn room(bytes: usize, what: &str) -> Result<(), JsError> {
    let mut probe = Vec::<u8>::new();
    let found = probe.try_reserve_exact(bytes);
    // An allocation that nobody looks at would be optimised away.
    std::hint::black_box(&mut probe);
    found.map_err(|_| JsError::new(&format!("there is not enough memory for {what}")))
}

/// Makes sure of the memory that reading a scene takes.
///
/// # Errors
/// If there is not so much.
pub(crate) fn room_to_read(text: &str) -> Result<(), JsError> {
    let objects = text.bytes().filter(|&byte| byte == b'{').count();
    room(objects.saturating_mul(OBJECT).saturating_add(text.len().saturating_mul(12)), "the scene")
}

/// Makes sure of the memory that the cloths, boxes, strands, ropes and soft boxes of a scene take.
///
/// # Errors
/// If there is not so much.
pub(crate) fn room_to_build(file: &SceneFile, files: &Files) -> Result<(), JsError> {
    let product = |counts: &[u32], more: usize| {
        counts.iter().fold(1_usize, |product, &n| product.saturating_mul((n as usize).saturating_add(more)))
    };
    let particles = file.cloths.iter().map(|cloth| match &cloth.form {
        Form::Sheet(sheet) => product(&sheet.cells, 1),
        Form::Mesh(name) => files.corners(name),
    });
    let particles = particles.fold(0_usize, usize::saturating_add);
    room(particles.saturating_mul(WOVEN), "the cloths of the scene")?;
    let boxes = file.boxes.iter().map(|boxes| {
        let pieces = match &boxes.form {
            BoxForm::Pieces(pieces) => pieces.len(),
            BoxForm::Solid(solid) => usize::from(solid.pieces),
            _ => 1,
        };
        product(&boxes.count, 0).saturating_mul(pieces)
    });
    let boxes = boxes.fold(0_usize, usize::saturating_add);
    room(boxes.saturating_mul(BOX), "the boxes of the scene")?;
    let strands = file.strands.iter().map(|tuft| tuft.particles() as usize).fold(0_usize, usize::saturating_add);
    room(strands.saturating_mul(WOVEN), "the strands of the scene")?;
    let ropes = file.ropes.iter().map(|cord| cord.particles() as usize).fold(0_usize, usize::saturating_add);
    room(ropes.saturating_mul(WOVEN), "the ropes of the scene")?;
    let soft = file.soft_bodies.iter().map(|body| body.particles().unwrap_or(0) as usize);
    room(soft.fold(0_usize, usize::saturating_add).saturating_mul(WOVEN), "the soft bodies of the scene")
}
