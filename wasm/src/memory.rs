//! Memory must not run out: WebAssembly cannot go on after an allocation that fails, so room is made sure of before.

use crate::files::Files;
use js_sys::{ArrayBuffer, Float32Array, Int32Array, Reflect, Symbol, Uint8Array, Uint32Array};
use pointmass::scene::{BoxForm, Form, SceneFile};
use wasm_bindgen::prelude::*;

/// Bytes that an object of a scene takes at most, from its text to the running world, while lists of it grow.
const OBJECT: usize = 1536;

/// Bytes that a particle of a cloth takes at most, with its springs.
const WOVEN: usize = 2048;

/// Bytes that a rigid box takes at most, with its particles, and as many for each further piece of a body.
const BOX: usize = 9728;

/// Bytes that a scene takes which says nothing.
const SCENE: usize = 256 << 10;

/// Bytes that stay free whatever is asked for: nobody asks for messages and names, which are small.
const SLACK: usize = 64 << 10;

/// Tells whether so many bytes are to be had, and some more for what is small.
pub(crate) fn has_room(bytes: usize) -> bool {
    let mut probe = Vec::<u8>::new();
    let found = probe.try_reserve_exact(bytes.saturating_add(SLACK));
    // An allocation that nobody looks at would be optimised away.
    std::hint::black_box(&mut probe);
    found.is_ok()
}

/// Makes sure that so many bytes are to be had, for `what`.
///
/// # Errors
/// If they are not.
pub(crate) fn room(bytes: usize, what: &str) -> Result<(), JsError> {
    if has_room(bytes) { Ok(()) } else { Err(lacking(what)) }
}

/// Makes sure of the memory that a call takes whose result is small.
///
/// # Errors
/// If there is not so much.
pub(crate) fn room_for_little() -> Result<(), JsError> {
    room(SLACK, "that")
}

/// The error of what finds no room.
pub(crate) fn lacking(what: &str) -> JsError {
    JsError::new(&format!("there is not enough memory for {what}"))
}

/// An empty list with room for so many entries, for `what`.
///
/// # Errors
/// If there is not so much memory.
pub(crate) fn reserved<T>(most: usize, what: &str) -> Result<Vec<T>, JsError> {
    let mut list = Vec::new();
    list.try_reserve_exact(most).map_err(|_| lacking(what))?;
    room(0, what)?;
    Ok(list)
}

/// A copy of a list, for `what`.
///
/// # Errors
/// If there is not so much memory.
pub(crate) fn copied<T: Clone>(list: &[T], what: &str) -> Result<Vec<T>, JsError> {
    let mut copy = reserved(list.len(), what)?;
    copy.extend_from_slice(list);
    Ok(copy)
}

/// A list of so many equal entries to write over, for `what`.
///
/// # Errors
/// If there is not so much memory.
pub(crate) fn filled<T: Clone>(entry: T, count: usize, what: &str) -> Result<Vec<T>, JsError> {
    let mut list = reserved(count, what)?;
    list.resize(count, entry);
    Ok(list)
}

/// Makes sure of the memory that reading a scene takes.
///
/// # Errors
/// If there is not so much.
pub(crate) fn room_to_read(text: &str) -> Result<(), JsError> {
    let objects = text.bytes().filter(|&byte| byte == b'{').count();
    let bytes = objects.saturating_mul(OBJECT).saturating_add(text.len().saturating_mul(12));
    room(bytes.saturating_add(SCENE), "the scene")
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

/// The constructors of JavaScript's arrays. They throw where the engine has no memory, or is given what it cannot read: nobody else may
/// see that, as an exception that passes through a method would leave its object locked for ever.
mod engine {
    use wasm_bindgen::prelude::*;

    #[wasm_bindgen]
    extern "C" {
        #[wasm_bindgen(js_name = Float32Array)]
        pub(super) type Floats;
        #[wasm_bindgen(constructor, js_class = "Float32Array", catch)]
        pub(super) fn of(numbers: &[f32]) -> Result<Floats, JsValue>;
        #[wasm_bindgen(constructor, js_class = "Float32Array", catch)]
        pub(super) fn like(array: &JsValue) -> Result<Floats, JsValue>;

        #[wasm_bindgen(js_name = Uint32Array)]
        pub(super) type Words;
        #[wasm_bindgen(constructor, js_class = "Uint32Array", catch)]
        pub(super) fn of(numbers: &[u32]) -> Result<Words, JsValue>;
        #[wasm_bindgen(constructor, js_class = "Uint32Array", catch)]
        pub(super) fn like(array: &JsValue) -> Result<Words, JsValue>;

        #[wasm_bindgen(js_name = Int32Array)]
        pub(super) type Numbers;
        #[wasm_bindgen(constructor, js_class = "Int32Array", catch)]
        pub(super) fn of(numbers: &[i32]) -> Result<Numbers, JsValue>;

        #[wasm_bindgen(js_name = Uint8Array)]
        pub(super) type Bytes;
        #[wasm_bindgen(constructor, js_class = "Uint8Array", catch)]
        pub(super) fn of(numbers: &[u8]) -> Result<Bytes, JsValue>;
    }
}

/// A copy of numbers that JavaScript owns.
///
/// # Errors
/// If the engine has no memory for it.
pub(crate) fn floats(numbers: &[f32]) -> Result<Float32Array, JsError> {
    engine::Floats::of(numbers).map(JsCast::unchecked_into).map_err(|_| lacking("the list"))
}

/// The same of whole numbers, zero or more.
///
/// # Errors
/// As of [`floats`].
pub(crate) fn words(numbers: &[u32]) -> Result<Uint32Array, JsError> {
    engine::Words::of(numbers).map(JsCast::unchecked_into).map_err(|_| lacking("the list"))
}

/// The same of whole numbers.
///
/// # Errors
/// As of [`floats`].
pub(crate) fn integers(numbers: &[i32]) -> Result<Int32Array, JsError> {
    engine::Numbers::of(numbers).map(JsCast::unchecked_into).map_err(|_| lacking("the list"))
}

/// The same of bytes.
///
/// # Errors
/// As of [`floats`].
pub(crate) fn bytes(numbers: &[u8]) -> Result<Uint8Array, JsError> {
    engine::Bytes::of(numbers).map(JsCast::unchecked_into).map_err(|_| lacking("the list"))
}

/// An array that was given, as one of the engine's own: a caller's may be detached, or of a class that says what is not so. Nothing, where it
/// is none or cannot be read.
pub(crate) fn own_floats(array: &Float32Array) -> Option<Float32Array> {
    let given = is_array(array, "Float32Array").then_some(array)?;
    engine::Floats::like(given).ok().map(JsCast::unchecked_into)
}

/// The same of whole numbers, zero or more.
pub(crate) fn own_words(array: &Uint32Array) -> Option<Uint32Array> {
    let given = is_array(array, "Uint32Array").then_some(array)?;
    engine::Words::like(given).ok().map(JsCast::unchecked_into)
}

/// Tells whether a value is a typed array of such a name, which those of other windows have too.
fn is_array<T: JsCast>(value: &T, name: &str) -> bool {
    let tag = || Reflect::get(value.as_ref(), &Symbol::to_string_tag()).ok().and_then(|tag| tag.as_string());
    value.is_instance_of::<T>() || ArrayBuffer::is_view(value.as_ref()) && tag().as_deref() == Some(name)
}
