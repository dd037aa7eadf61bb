//! Where in the text of a scene a value is written that an error names by its path.

use pointmass::scene::{SceneError, SceneFile};
use serde_json::value::RawValue;
use std::collections::BTreeMap;

/// The same error with the line on which the value stands that it names, or the innermost around it that is written, in its message.
pub(crate) fn located(error: SceneError, text: &str) -> SceneError {
    match line(text, &error.place) {
        Some(line) => SceneError { message: format!("{} (line {line})", error.message), ..error },
        None => error,
    }
}

/// An error that the JSON reader tells by line and column, with the path of the value there in its message if it is about a value.
pub(crate) fn with_path(error: SceneError, text: &str) -> SceneError {
    const ALONE: &str = "a name alone";
    const ABOUT_VALUES: [&str; 5] = ["invalid ", "missing field", "unknown variant", "number out of range", ALONE];
    if !ABOUT_VALUES.iter().any(|begin| error.message.starts_with(begin)) {
        return error;
    }
    let text = text.trim_start_matches('\u{feff}');
    let Some(end) = end_of(text, &error.place) else { return error };
    // Of a name that stands alone it is known only when what follows has been seen.
    let quote = text.get(..end).and_then(|before| before.rfind('"')).filter(|_| error.message.starts_with(ALONE));
    let path = SceneFile::path_in_json(text, quote.map_or(end, |quote| quote + 1));
    if path.is_empty() { error } else { SceneError { message: format!("{path}: {}", error.message), ..error } }
}

/// Bytes of a text up to a place that is told as `line:column`.
fn end_of(text: &str, place: &str) -> Option<usize> {
    let (line, column) = place.split_once(':')?;
    let (line, column) = (line.parse::<usize>().ok()?, column.parse::<usize>().ok()?);
    let before: usize = text.split_inclusive('\n').take(line.checked_sub(1)?).map(str::len).sum();
    Some((before + column).min(text.len()))
}

/// The line, from 1, of the value at a path such as `scenery[0].shape.plane`, or of the innermost around it that is written; none, if that is all.
fn line(text: &str, path: &str) -> Option<usize> {
    let mut value: &RawValue = serde_json::from_str(text.trim_start_matches('\u{feff}')).ok()?;
    let whole = value;
    for step in path.split(['.', '[']) {
        let Some(inner) = inside(value, step.trim_end_matches(']')) else { break };
        value = inner;
    }
    if std::ptr::eq(value, whole) {
        return None;
    }
    // What is borrowed from a text begins somewhere in it.
    let before = text.get(..value.get().as_ptr().addr().checked_sub(text.as_ptr().addr())?)?;
    Some(before.matches('\n').count() + 1)
}

/// The entry of a list with a number, or the value that an object has under a name: in `{"gravity": {...}}` too, which says by its only name what it is.
fn inside<'t>(value: &'t RawValue, step: &str) -> Option<&'t RawValue> {
    if let Ok(number) = step.parse::<usize>() {
        let list: Vec<&RawValue> = serde_json::from_str(value.get()).ok()?;
        return list.get(number).copied();
    }
    let object: BTreeMap<String, &RawValue> = serde_json::from_str(value.get()).ok()?;
    let former = || SceneFile::former_names_of(step).find_map(|name| object.get(name));
    match object.get(step).or_else(former) {
        None if object.len() == 1 => inside(object.values().next()?, step),
        found => found.copied(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn errors_of_the_reader_name_the_path() {
        for (text, told) in [
            (
                "{\"emitters\": [{\n\"shape\": {\"sphere\": {\"center\": [0, 0],\n",
                "a.json:2:37: emitters[0].shape.sphere.center: invalid length 2, expected a list of 3 numbers",
            ),
            (
                "\u{feff}{\"particles\": [{},\n{\"mass\": \"1\"}]}",
                "a.json:2:12: particles[1].mass: invalid type: string",
            ),
            (
                "{\"forces\": [{\"gravity\": 9.81}]}",
                "a.json:1:28: forces[0].gravity: invalid type: floating point `9.81`, expected an object",
            ),
            ("{\"springs\": [{\"ends\": [0, 1], \"rest_length\": 1}]}", "a.json:1:47: springs[0]: missing field `ks`"),
            ("{\"forces\": [\"drag\"]}", "a.json:1:19: forces[0]: a name alone"),
            ("{\"wind\": 1}", "a.json:1:7: unknown field"),
            ("{\"particles\": [{]}", "a.json:1:17: key must be"),
            (" \n", "a.json: there is nothing in it: a scene is an object"),
        ] {
            let error = SceneFile::from_json("a.json", text).expect_err(text);
            let error = with_path(error, text).to_string();
            assert!(error.starts_with(told), "{error}");
        }
    }

    #[test]
    fn values_are_found_by_their_paths() {
        let text = "{\n\"run\": {},\n\"a\": [7,\n{\"b\\u0020\": 1,\n\"c\": [[1,\n2]]}], \"fabrics\": [\n{}], \"forces\": [{\"wind\":\n{\"a\": 1,\n\"speed\": 2}}]}";
        for (path, found) in [
            ("a", Some(3)),
            ("a[0]", Some(3)),
            ("a[1]", Some(4)),
            ("a[1].b ", Some(4)),
            ("a[1].c[0][1]", Some(6)),
            ("a[1].c[0]", Some(5)),
            ("run.dt", Some(2)),
            ("a[2].c", Some(3)),
            ("cloths[0].mass", Some(7)),
            ("forces[0].speed", Some(9)),
            ("springs[3]", None),
            ("12:7", None),
            ("", None),
        ] {
            assert_eq!(line(text, path), found, "{path}");
        }
        assert_eq!(line("[1,", "a"), None);
    }
}
