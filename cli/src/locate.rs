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
