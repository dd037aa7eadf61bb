//! Objects as JSON. Of what JSON cannot say it would make an object without fields, or leave it out: here that is refused, with its path.

use crate::arguments::{is_plain, named, property, unwritten};
use crate::files::long;
use crate::memory::room_for_little;
use js_sys::{Array, ArrayBuffer, Boolean, Function, JSON, JsString, Number};
use wasm_bindgen::JsCast;
use wasm_bindgen::prelude::*;

#[wasm_bindgen]
extern "C" {
    /// `Array.from`, which may meet anything on its way, as all of these may.
    #[wasm_bindgen(js_namespace = Array, js_name = from, catch)]
    fn list_of(values: &JsValue) -> Result<Array, JsValue>;

    #[wasm_bindgen(js_namespace = Array, js_name = isArray, catch)]
    fn is_list(value: &JsValue) -> Result<bool, JsValue>;

    #[wasm_bindgen(js_namespace = Object, js_name = keys, catch)]
    fn keys(object: &JsValue) -> Result<Array, JsValue>;

    #[wasm_bindgen(js_namespace = Object, js_name = values, catch)]
    fn values(object: &JsValue) -> Result<Array, JsValue>;

    #[wasm_bindgen(extends = Array)]
    type List;

    #[wasm_bindgen(method, catch)]
    fn every(this: &List, is_so: &Function) -> Result<bool, JsValue>;

    #[wasm_bindgen(thread_local_v2, js_namespace = Number, js_name = isFinite)]
    static IS_FINITE: Function;

    #[wasm_bindgen(js_name = Object)]
    type Any;

    #[wasm_bindgen(method, getter, js_name = toJSON, catch)]
    fn to_json(this: &Any) -> Result<JsValue, JsValue>;
}

/// The JSON of an object in one line: typed arrays as lists, and numbers that JSON does not know as strings of their names. What is wrong in it is told by
/// `what` it is, a mark and the path.
///
/// # Errors
/// If it has none, or that is no object.
pub(crate) fn json(object: &JsValue, what: &str, mark: char) -> Result<String, JsError> {
    room_for_little()?;
    let mut walk = Walk::default();
    let replace = &mut |key: JsString, value: JsValue| walk.visit(key, value).map(Some);
    let written = match is_usual(object, DEEPEST) {
        true => JSON::stringify(object),
        false => JSON::stringify_with_replacer_func(object, replace, None),
    };
    let refuse = |why: &str| JsError::new(&format!("the {what} has no JSON: {why}"));
    let text = written.map_err(|error| match walk.why() {
        Some((path, why)) if path.is_empty() => refuse(&why),
        Some((path, why)) => JsError::new(&format!("{what}{mark}{path}: has no JSON: {why}")),
        None => {
            let why = property(&error, "message").and_then(|why| why.as_string());
            refuse(why.as_deref().and_then(|why| why.lines().next()).unwrap_or("it cannot be written"))
        }
    })?;
    if !text.is_string() {
        return Err(refuse("it is not to be written"));
    }
    let text = long(&text)?;
    if text.starts_with('{') { Ok(text) } else { Err(refuse("its toJSON gives no object")) }
}

/// Tells at a glance whether all in a value is what the engine writes as it is, numbers above all: to be asked about each of many takes longer than to
/// read them.
fn is_usual(value: &JsValue, deepest: usize) -> bool {
    if let Some(number) = value.as_f64() {
        return number.is_finite();
    }
    if !value.is_object() {
        return value.is_string() || value.as_bool().is_some() || value.is_undefined();
    }
    let Some(deepest) = deepest.checked_sub(1) else { return false };
    if is_list(value).unwrap_or(false) {
        let list: &List = value.unchecked_ref();
        return IS_FINITE.with(|is_finite| list.every(is_finite).unwrap_or(false))
            || list.iter().all(|value| is_usual(&value, deepest));
    }
    // What that gives is not known.
    let is_itself = value.unchecked_ref::<Any>().to_json().is_ok_and(|method| method.is_undefined());
    is_itself
        && !ArrayBuffer::is_view(value)
        && values(value).is_ok_and(|values| match values.length() {
            0 => is_plain(value),
            _ => values.iter().all(|value| is_usual(&value, deepest)),
        })
}

/// Objects within each other beyond which no text is read.
const DEEPEST: usize = 128;

/// An object or a list whose entries are being written.
struct Level {
    object: JsValue,
    /// What it is called in the one around it.
    key: JsString,
    is_list: bool,
    /// How many of its entries are still to come.
    left: u32,
}

/// The way through an object, which the engine goes.
#[derive(Default)]
struct Walk {
    levels: Vec<Level>,
    /// The path of what cannot be written, and why.
    refused: Option<(String, String)>,
}

impl Walk {
    /// What is to be written in place of a value.
    ///
    /// # Errors
    /// If it has no JSON.
    fn visit(&mut self, key: JsString, value: JsValue) -> Result<JsValue, JsError> {
        while self.levels.last().is_some_and(|level| level.left == 0) {
            self.levels.pop();
        }
        if let Some(level) = self.levels.last_mut() {
            level.left -= 1;
        }
        if let Some(number) = value.as_f64() {
            return Ok(unwritten(number).map_or(value, JsValue::from_str));
        }
        if value.is_object() {
            return self.enter(key, value);
        }
        match value.is_function() || value.is_symbol() || value.is_bigint() {
            true => Err(self.refuse(&key, &value, "")),
            false => Ok(value),
        }
    }

    /// Begins to write an object or a list.
    fn enter(&mut self, key: JsString, value: JsValue) -> Result<JsValue, JsError> {
        if self.levels.len() >= DEEPEST {
            return Err(self.refuse_as(&key, format!("it is {DEEPEST} objects deep")));
        }
        let length = |list: &JsValue| property(list, "length").and_then(|length| length.as_f64());
        let mut value = value;
        let mut is_list = self::is_list(&value).unwrap_or(false);
        if !is_list && ArrayBuffer::is_view(&value) && length(&value).is_some() {
            let Ok(list) = list_of(&value) else {
                return Err(self.refuse(&key, &value, " that cannot be read, as one that has been transferred"));
            };
            (value, is_list) = (list.into(), true);
        }
        let left = match is_list {
            true => length(&value).unwrap_or(0.0) as u32,
            false => keys(&value).map_or(0, |keys| keys.length()),
        };
        // Of these the engine writes what is in them.
        let is_boxed = || value.is_instance_of::<Number>() || value.is_instance_of::<Boolean>();
        if !is_list && value.is_instance_of::<JsString>() {
            return Ok(value);
        }
        // What says nothing by fields says it otherwise.
        if left == 0 && !is_list && !is_plain(&value) && !is_boxed() {
            return Err(self.refuse(&key, &value, ""));
        }
        self.levels.push(Level { object: value.clone(), key, is_list, left });
        Ok(value)
    }

    /// The path of what could not be written, and why, if that is known: where something is part of itself, the engine ends once that has been
    /// entered again.
    fn why(&mut self) -> Option<(String, String)> {
        let is_last = |level: &Level| self.levels.last().is_some_and(|last| level.object == last.object);
        if self.refused.is_none() && self.levels.iter().rev().skip(1).any(is_last) {
            let key = self.levels.pop()?.key;
            self.refuse_as(&key, "it is part of itself".into());
        }
        self.refused.take()
    }

    /// Notes what cannot be written, by its kind and more about it.
    fn refuse(&mut self, key: &JsString, value: &JsValue, more: &str) -> JsError {
        let hint = if value.is_bigint() { ": write it as a number" } else { "" };
        self.refuse_as(key, format!("it is {}{more}{hint}", named(value)))
    }

    fn refuse_as(&mut self, key: &JsString, why: String) -> JsError {
        let keys = self.levels.iter().skip(1).map(|level| &level.key).chain([key]);
        let mut path = String::new();
        for (level, key) in self.levels.iter().zip(keys) {
            let key = short(key);
            path += &match level.is_list {
                true => format!("[{key}]"),
                false if path.is_empty() => key,
                false => format!(".{key}"),
            };
        }
        self.refused = Some((path, why));
        JsError::new("")
    }
}

/// A key in a message: it may be of any length.
fn short(key: &JsString) -> String {
    const LONGEST: u32 = 60;
    let more = if key.length() > LONGEST { "…" } else { "" };
    String::from(key.slice(0, LONGEST)) + more
}
