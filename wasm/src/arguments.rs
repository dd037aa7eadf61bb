//! Arguments that JavaScript passes, checked: they may be anything.

use crate::files::{Files, long};
use js_sys::{BigInt, JSON, JsString};
use pointmass::{Time, Vec3};
use wasm_bindgen::JsCast;
use wasm_bindgen::prelude::*;

#[wasm_bindgen]
extern "C" {
    /// The JavaScript side of [`Files`]; passing that itself would take it away from the caller.
    type JsFiles;

    #[wasm_bindgen(method, catch)]
    fn clone(this: &JsFiles) -> Result<Files, JsValue>;
}

/// The text of a scene: the text itself, or that of an object.
///
/// # Errors
/// If it is neither, or has no text.
pub(crate) fn text(scene: &JsValue) -> Result<String, JsError> {
    if let Some(text) = scene.dyn_ref::<JsString>() {
        return long(text);
    }
    if !scene.is_object() || js_sys::Array::is_array(scene) {
        return Err(JsError::new("a scene has to be an object, or its text"));
    }
    let text = JSON::stringify(scene).map_err(|error| {
        let why = error.dyn_ref::<js_sys::Error>().and_then(|error| JsValue::from(error.message()).as_string());
        // Engines draw a picture of what is circular, on further lines.
        let why = why.as_deref().and_then(|why| why.lines().next()).unwrap_or("it cannot be written");
        JsError::new(&format!("the scene has no JSON: {why}"))
    })?;
    long(&text)
}

/// A copy of the files that were given, if any were.
///
/// # Errors
/// If that is something else, or has been freed.
pub(crate) fn files(files: &JsValue) -> Result<Files, JsError> {
    if files.is_undefined() || files.is_null() {
        return Ok(Files::default());
    }
    let copy = files.is_object().then(|| files.unchecked_ref::<JsFiles>().clone().ok()).flatten();
    copy.ok_or_else(|| JsError::new("files have to be Files of this package that have not been freed"))
}

/// A place or a direction: three numbers in an array of any kind.
///
/// # Errors
/// If it is something else, or they are not finite.
pub(crate) fn place(name: &str, value: &JsValue) -> Result<Vec3, JsError> {
    let numbers = js_sys::try_iter(value).ok().flatten().map(|list| list.take(4).map(|n| n.ok()?.as_f64()));
    let numbers: Option<Vec<f32>> = numbers.and_then(|list| list.map(|n| n.map(|n| n as f32)).collect());
    let place = numbers.and_then(|list| <[f32; 3]>::try_from(list).ok()).map(Vec3::from_array);
    place
        .filter(|place| place.is_finite())
        .ok_or_else(|| JsError::new(&format!("{name} has to be three finite numbers")))
}

/// The number of particles that may live at once, if it is said.
///
/// # Errors
/// If it is no whole number, or too large.
pub(crate) fn capacity(capacity: &JsValue) -> Result<Option<u32>, JsError> {
    const MOST: f64 = u32::MAX as f64;
    match whole(capacity, MOST) {
        Whole::Absent => Ok(None),
        Whole::Number(number) => Ok(Some(number as u32)),
        Whole::Other => Err(JsError::new(&format!(
            "the capacity has to be a whole number from 0 to {MOST}, not {}",
            shown(capacity)
        ))),
    }
}

/// The seed, if it is said.
///
/// # Errors
/// If it is no whole number, not exact as a number, or no BigInt of 64 bits.
pub(crate) fn seed(seed: &JsValue) -> Result<Option<u64>, JsError> {
    const MOST: f64 = 9_007_199_254_740_991.0;
    match whole(seed, MOST) {
        Whole::Absent => return Ok(None),
        Whole::Number(number) => return Ok(Some(number as u64)),
        Whole::Other => {}
    }
    if let Some(number) = seed.dyn_ref::<BigInt>().and_then(|big| u64::try_from(JsValue::from(big.clone())).ok()) {
        return Ok(Some(number));
    }
    Err(JsError::new(&format!(
        "the seed has to be a whole number from 0 to {MOST}, or a BigInt from 0n to 18446744073709551615n, not {}",
        shown(seed)
    )))
}

/// An instant, or a span of time.
///
/// # Errors
/// If it is no finite number, or below zero.
pub(crate) fn seconds(what: &str, seconds: f64) -> Result<Time, JsError> {
    if (0.0..f64::INFINITY).contains(&seconds) {
        return Ok(Time::from_seconds_f64(seconds));
    }
    Err(JsError::new(&format!("{what} has to be given a finite number of seconds, zero or more, not {seconds}")))
}

/// A value where a whole number is expected.
enum Whole {
    Absent,
    Number(f64),
    Other,
}

fn whole(value: &JsValue, most: f64) -> Whole {
    match value.as_f64() {
        _ if value.is_undefined() || value.is_null() => Whole::Absent,
        Some(number) if (0.0..=most).contains(&number) && number.trunc() == number => Whole::Number(number),
        _ => Whole::Other,
    }
}

/// A value in a message.
fn shown(value: &JsValue) -> String {
    match value.as_f64() {
        Some(number) => number.to_string(),
        None => format!("a {}", value.js_typeof().as_string().unwrap_or_default()),
    }
}
