//! The declared scene as JSON.

use super::{SceneError, SceneFile};
use alloc::format;
use alloc::string::{String, ToString};
use alloc::vec::Vec;
use serde_json::{Error, Value};

impl SceneFile {
    /// Reads JSON; `name` is the file's name for messages.
    ///
    /// # Errors
    /// If the text is no JSON, or says something that a scene does not know, with line and column.
    pub fn from_json(name: &str, text: &str) -> Result<Self, SceneError> {
        let text = text.strip_prefix('\u{feff}').unwrap_or(text);
        if text.trim().is_empty() {
            return Err(SceneError::file(name, "there is nothing in it: a scene is an object, {} at the least"));
        }
        // Serde would take a list for the fields in order.
        if text.trim_start().starts_with('[') {
            return Err(SceneError::at(name, 1, 1, "a scene is an object, not a list"));
        }
        serde_json::from_str(text).map_err(|error| {
            let at = |error: &Error, message: &str| SceneError::at(name, error.line(), error.column(), message);
            let message = bare(&error);
            if message != NO_VALUE {
                return at(&error, &plain(&message));
            }
            // The parser says so too where an object has to have one name, and has another number of them, though that is JSON.
            match serde_json::from_str::<Value>(text) {
                Ok(_) => at(&error, ONE_NAME),
                Err(syntax) => at(&syntax, &plain(&bare(&syntax))),
            }
        })
    }

    /// Names in JSON that have been others for some time, each where it first stands: files may go on with them.
    #[must_use]
    pub fn former_names(text: &str) -> Vec<String> {
        let mut remarks = Vec::new();
        for (former, name) in FORMER {
            let key = format!("\"{former}\"");
            let is_key = |&(at, _): &(usize, &str)| text[at + key.len()..].trim_start().starts_with(':');
            let Some((at, _)) = text.match_indices(&key).find(is_key) else { continue };
            let before = &text[..at];
            let (line, column) =
                (before.matches('\n').count() + 1, before.len() - before.rfind('\n').map_or(0, |end| end + 1) + 1);
            remarks.push(format!("{line}:{column}: `{former}` is called `{name}` now"));
        }
        remarks
    }

    /// The names that one had in JSON before.
    pub fn former_names_of(name: &str) -> impl Iterator<Item = &'static str> {
        FORMER.into_iter().filter(move |(_, present)| *present == name).map(|(former, _)| former)
    }

    /// Writes JSON, indented, with a line end at the end.
    #[must_use]
    pub fn to_json(&self) -> String {
        // Numbers that JSON does not know (NaN, infinities) become null; a checked scene has none.
        let text = serde_json::to_string_pretty(self).unwrap_or_default();
        compact_numbers(&text)
    }
}

/// Former names, each with the present one.
const FORMER: [(&str, &str); 7] = [
    ("variance", "half_width"),
    ("color_variance", "color_half_width"),
    ("fabrics", "cloths"),
    ("threads", "springs"),
    ("grip", "contact"),
    ("resting", "static"),
    ("sliding", "kinetic"),
];

/// The parser's message where it expects a value.
const NO_VALUE: &str = "expected value";
/// The message where an object has no name, or two, that say what it is.
const ONE_NAME: &str = r#"expected one name with its settings, {"name": {...}}: in a list each has braces of its own, elsewhere there is one"#;

/// The parser's message without the place.
fn bare(error: &Error) -> String {
    let message = error.to_string();
    message.rsplit_once(" at line ").map_or(message.as_str(), |(what, _)| what).to_string()
}

/// The parser's message without the names of Rust's types.
fn plain(message: &str) -> String {
    if message == "trailing characters" {
        return "this goes on where it has to end: the list before has all the entries that its field takes, or the scene is over".to_string();
    }
    if message == NO_VALUE {
        return "expected a value: a number (JSON has no NaN and no infinity), a text in \"\", a list, an object, true, false or null".to_string();
    }
    if message == "number out of range" {
        return "number out of range: the largest is 3.4e38".to_string();
    }
    if message.starts_with("invalid type: unit variant, expected ") {
        return r#"a name alone, where its settings should follow: {"name": {...}}"#.to_string();
    }
    if let Some(what) =
        message.strip_prefix("invalid type: ").and_then(|rest| rest.strip_suffix(", expected struct SceneFile"))
    {
        return format!("a scene is an object, not {what}");
    }
    for (name, meaning) in [
        ("f32", "a number"),
        ("f64", "a number"),
        ("u8", "a whole number from 0 to 255"),
        ("u16", "a whole number from 0 to 65535"),
        ("u32", "a whole number from 0 to 4294967295"),
        ("u64", "a whole number from 0 to 18446744073709551615"),
        ("struct Friction", r#"{"static": ..., "kinetic": ...}"#),
    ] {
        if let Some(rest) = message.strip_suffix(name).filter(|rest| rest.ends_with(", expected ")) {
            return format!("{rest}{meaning}");
        }
    }
    if let Some(rest) = message.strip_suffix("a sequence of 3 f32 values") {
        return format!("{rest}a list of 3 numbers");
    }
    match message.rsplit_once(", expected struct ") {
        Some((what, name)) if name.chars().all(char::is_alphanumeric) => format!("{what}, expected an object"),
        _ => message.to_string(),
    }
}

/// Puts lists of plain numbers on one line: a vector is read as one thing.
///
/// The pretty printer puts every bracket and every entry at the end or on a line of its own, and no string spans lines.
pub(super) fn compact_numbers(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    let mut lines = text.lines();
    while let Some(line) = lines.next() {
        out.push_str(line);
        if line.ends_with('[') {
            let is_number = |line: &&str| line.trim().trim_end_matches(',').parse::<f64>().is_ok();
            let count = lines.clone().take_while(is_number).count();
            let closes = lines.clone().nth(count).is_some_and(|line| line.trim_start().starts_with(']'));
            if count > 0 && closes {
                for (i, number) in lines.by_ref().take(count).enumerate() {
                    out.push_str(if i == 0 { "" } else { " " });
                    out.push_str(number.trim());
                }
                out.push_str(lines.next().unwrap_or_default().trim_start());
            }
        }
        out.push('\n');
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn errors_name_line_and_column() {
        let error = SceneFile::from_json("a.json", "{\n  \"wind\": 1\n}").expect_err("unknown field");
        assert!(error.to_string().starts_with("a.json:2:8: unknown field `wind`, expected one of"), "{error}");
        let error = SceneFile::from_json("a.json", "{\"ambient\": [NaN, 0, 0]}").expect_err("no number");
        assert!(error.to_string().starts_with("a.json:1:14: "), "{error}");
        let error = SceneFile::from_json("a.json", "{\"ambient\": [0, 0").expect_err("cut off");
        assert!(error.to_string().contains("EOF"), "{error}");
    }

    #[test]
    fn no_value_and_a_name_too_many_are_told_apart() {
        for (text, at, message) in [
            (r#"{"forces": [{"drag": {}, "gravity": {"acceleration": [0, 1, 0]}}]}"#, "1:23", "expected one name"),
            (r#"{"forces": [{}, {"drag": {}}]}"#, "1:14", "expected one name"),
            (r#"{"scenery": [{"shape": {}}]}"#, "1:25", "expected one name"),
            (r#"{"scenery": [{"shape": {"mesh": "a", "box": 1}}]}"#, "1:35", "expected one name"),
            (r#"{"forces": [{"drag": {},}]}"#, "1:25", "trailing comma"),
            (r#"{"forces": [{"drag": {} "gravity": 1}]}"#, "1:25", "expected `,` or `}`"),
            (r#"{"ambient": [0, NaN, 0]}"#, "1:17", "expected a value: a number (JSON has no NaN"),
            (r#"{"about": }"#, "1:11", "expected a value"),
            (r#"{"forces": [{"drag": }]}"#, "1:22", "expected a value"),
        ] {
            let error = SceneFile::from_json("a.json", text).expect_err(text).to_string();
            assert!(error.starts_with(&format!("a.json:{at}: {message}")), "{text}: {error}");
        }
    }

    #[test]
    fn former_names_are_read_and_remarked_on() {
        let form = r#"{"sheet": {"corner": [0, 0, 0], "sides": [[1, 0, 0], [0, 0, 1]], "cells": [1, 1]}}"#;
        let shape = r#"{"sphere": {"center": [0, 0, 0], "radius": 1}}"#;
        let old = format!(
            r#"{{"fabrics": [{{"form": {form}, "mass": 1, "threads": {{"bend": {{"ks": 1, "kd": 0}}}}}}],
            "materials": [{{"grip": {{"friction": {{"resting": 0.5, "sliding": 0.25}}}}}}],
            "emitters": [{{"shape": {shape}, "speed": {{"mean": 2, "variance": 1}}, "color_variance": [1, 2, 3, 4]}}]}}"#
        );
        let mut new = old.clone();
        FORMER.iter().for_each(|(former, name)| new = new.replace(&format!("\"{former}\""), &format!("\"{name}\"")));
        assert!(SceneFile::from_json("", &new).is_ok_and(|scene| SceneFile::from_json("", &old) == Ok(scene)));
        assert_eq!(SceneFile::former_names(&new), [""; 0]);
        let remarks = SceneFile::former_names(&old);
        assert_eq!(remarks.len(), FORMER.len());
        assert!(remarks.contains(&"2:50: `resting` is called `static` now".to_string()), "{remarks:?}");
        assert_eq!(SceneFile::former_names(r#"{"about": "variance"}"#), [""; 0]);
    }

    #[test]
    fn vectors_stand_on_one_line_and_text_is_left_alone() {
        let mut scene = SceneFile::new();
        scene.about = "a [ b\n ] c".to_string();
        scene.ambient = [0.1, 2.0, 1e-7];
        let text = scene.to_json();
        assert!(text.contains("\"ambient\": [0.1, 2.0, 1e-7]"), "{text}");
        assert_eq!(SceneFile::from_json("", &text), Ok(scene));
    }
}
