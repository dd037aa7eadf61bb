//! Arguments that JavaScript passes, checked: they may be anything, and reading them may run anything. Whatever is thrown then is caught here.

use crate::files::{Files, long};
use crate::json::json;
use js_sys::{BigInt, Function, JsString, Reflect};
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

/// A scene as it was given.
pub(crate) enum Given {
    /// A text, JSON or `.scn`.
    Text(String),
    /// An object, as JSON in one line.
    Object(String),
}

/// A scene that was given: a text, or an object.
///
/// # Errors
/// If it is neither, is empty, or has no text.
pub(crate) fn scene(scene: &JsValue) -> Result<Given, JsError> {
    if let Some(text) = scene.dyn_ref::<JsString>() {
        let text = long(text)?;
        if text.trim_start_matches('\u{feff}').trim().is_empty() {
            return Err(JsError::new("the text is empty: a scene is an object, or its text"));
        }
        return Ok(Given::Text(text));
    }
    if !is_plain(scene) {
        return Err(JsError::new(&format!("a scene has to be an object, or its text, not {}", named(scene))));
    }
    json(scene, "scene", ':').map(Given::Object)
}

/// A particle that was given, as JSON in one line.
///
/// # Errors
/// If it is no object, or has no text.
pub(crate) fn particle(particle: &JsValue) -> Result<String, JsError> {
    if !is_plain(particle) {
        return Err(JsError::new(&format!("a particle has to be an object, not {}", named(particle))));
    }
    json(particle, "particle", '.')
}

/// A property of a value, if it has that and it can be read.
pub(crate) fn property(value: &JsValue, name: &str) -> Option<JsValue> {
    let value = value.is_object().then_some(value)?;
    Reflect::get(value, &name.into()).ok()
}

/// Tells whether a value is an object that says what it is by its fields, or by `toJSON`: a promise, say, would be an object without fields.
pub(crate) fn is_plain(value: &JsValue) -> bool {
    if !value.is_object() {
        return false;
    }
    let parent = |of: &JsValue| Reflect::get_prototype_of(of).map(JsValue::from);
    // Objects of other windows have an `Object.prototype` of their own, which has no prototype either.
    let is_top = parent(value).is_ok_and(|kind| kind.is_null() || parent(&kind).is_ok_and(|top| top.is_null()));
    is_top || property(value, "toJSON").is_some_and(|method| method.is_function())
}

/// Numbers that JSON does not know, by name.
pub(crate) const UNWRITTEN: [&str; 3] = ["NaN", "Infinity", "-Infinity"];

/// The name of a number that JSON does not know.
pub(crate) fn unwritten(number: f64) -> Option<&'static str> {
    let kind = if number.is_nan() { 0 } else { 1 + usize::from(number < 0.0) };
    (!number.is_finite()).then_some(UNWRITTEN[kind])
}

/// The kind of a value, in a message, and what to do about it.
pub(crate) fn named(value: &JsValue) -> String {
    const LONGEST: usize = 60;
    if value.is_null() || value.is_undefined() {
        return if value.is_null() { "null" } else { "undefined" }.to_owned();
    }
    let class = property(value, "constructor").filter(JsValue::is_function);
    let class = class.and_then(|class| Reflect::get(&class, &"name".into()).ok()).and_then(|name| name.as_string());
    let class = class.filter(|name| (1..=LONGEST).contains(&name.len()));
    let name = class.unwrap_or_else(|| value.js_typeof().as_string().unwrap_or_default());
    let article = if name.starts_with(['A', 'E', 'I', 'O', 'U', 'a', 'e', 'i', 'o', 'u']) { "an" } else { "a" };
    let has = |method: &str| property(value, method).is_some_and(|method| method.is_instance_of::<Function>());
    let hint = match () {
        () if has("then") => ": await it",
        () if has("json") => ": await its json()",
        () => "",
    };
    format!("{article} {name}{hint}")
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
    let number = |key: JsValue| Reflect::get(value, &key).ok()?.as_f64();
    let three = || {
        let length = value.is_object().then(|| number("length".into())).flatten()?;
        let [x, y, z] = [0, 1, 2].map(|i| (length == 3.0).then(|| number(i.into())).flatten());
        Some(Vec3::new(x? as f32, y? as f32, z? as f32))
    };
    three()
        .filter(|place| place.is_finite())
        .ok_or_else(|| JsError::new(&format!("{name} has to be three finite numbers")))
}

/// The number of particles that may live at once, if it is said.
///
/// # Errors
/// If it is no whole number, or too large.
pub(crate) fn capacity(capacity: &JsValue) -> Result<Option<u32>, JsError> {
    whole_number("the capacity", 0, capacity)
}

/// The most steps of a frame, if that is said.
///
/// # Errors
/// If it is no whole number above zero, or too large.
pub(crate) fn most(most: &JsValue) -> Result<Option<u32>, JsError> {
    whole_number("the most steps", 1, most)
}

/// The id of a particle.
///
/// # Errors
/// If it is no whole number, or too large.
pub(crate) fn id(id: &JsValue) -> Result<u32, JsError> {
    let number = whole_number("an id", 0, id)?;
    number.ok_or_else(|| JsError::new(&format!("an id has to be a number out of ids(), not {}", shown(id))))
}

/// The number of a saved state.
///
/// # Errors
/// If it is no whole number, or too large.
pub(crate) fn state(state: &JsValue) -> Result<u32, JsError> {
    let number = whole_number("a state", 0, state)?;
    number.ok_or_else(|| JsError::new(&format!("a state has to be a number out of save(), not {}", shown(state))))
}

/// The most blows of a call, if that is said.
///
/// # Errors
/// If it is no whole number, or too large.
pub(crate) fn blows(most: &JsValue) -> Result<Option<u32>, JsError> {
    whole_number("the most blows", 0, most)
}

/// The speed of a blow, if it is said.
///
/// # Errors
/// If it is no number, or below zero.
pub(crate) fn speed(value: &JsValue) -> Result<Option<f32>, JsError> {
    if value.is_undefined() || value.is_null() {
        return Ok(None);
    }
    let speed = value.as_f64().map(|speed| speed as f32).filter(|speed| *speed >= 0.0);
    let refuse = || format!("the speed of a blow has to be a number, zero or more, not {}", shown(value));
    speed.map(Some).ok_or_else(|| JsError::new(&refuse()))
}

fn whole_number(what: &str, least: u32, value: &JsValue) -> Result<Option<u32>, JsError> {
    const MOST: u32 = u32::MAX;
    match whole(value, f64::from(MOST)) {
        Whole::Absent => Ok(None),
        Whole::Number(number) if number >= f64::from(least) => Ok(Some(number as u32)),
        _ => {
            let shown = shown(value);
            Err(JsError::new(&format!("{what} has to be a whole number from {least} to {MOST}, not {shown}")))
        }
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

/// A span of time, or an instant \[s\]. A number alone will do: what else becomes one may run anything on the way, and hardly means it.
///
/// # Errors
/// If it is no finite number, or below zero.
pub(crate) fn seconds(what: &str, value: &JsValue) -> Result<f64, JsError> {
    let seconds = value.as_f64().filter(|seconds| (0.0..f64::INFINITY).contains(seconds));
    seconds.ok_or_else(|| {
        let shown = shown(value);
        JsError::new(&format!("{what} has to be given a finite number of seconds, zero or more, not {shown}"))
    })
}

/// An instant, of seconds that are not below zero.
///
/// # Errors
/// If it is at the end of time or beyond, where nothing moves any more.
pub(crate) fn instant(what: &str, seconds: f64) -> Result<Time, JsError> {
    const END: f64 = 4_294_967_296.0;
    if seconds < END {
        return Ok(Time::from_seconds_f64(seconds));
    }
    Err(JsError::new(&format!("{what} would reach the end of time, which is {END} s, 136 years, after the beginning")))
}

/// The strain at which lines have their full colours, if it is said.
///
/// # Errors
/// If it is no finite number above zero.
pub(crate) fn strain(value: &JsValue) -> Result<Option<f32>, JsError> {
    if value.is_undefined() || value.is_null() {
        return Ok(None);
    }
    let full = value.as_f64().map(|full| full as f32).filter(|full| *full > 0.0 && full.is_finite());
    let refuse = || format!("the full strain has to be a finite number above zero, not {}", shown(value));
    full.map(Some).ok_or_else(|| JsError::new(&refuse()))
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
    let Some(number) = value.as_f64() else { return named(value) };
    match unwritten(number) {
        Some(name) => name.to_owned(),
        None if number.abs() >= 1e21 => format!("{number:e}"),
        None => number.to_string(),
    }
}
