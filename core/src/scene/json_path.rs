//! Where in a JSON text something is, by its path: to read the text into a scene once more, by a reader that keeps account of paths, would take all that code a
//! second time, which in WebAssembly is half of it.

use super::SceneFile;
use alloc::format;
use alloc::string::String;
use alloc::vec::Vec;

impl SceneFile {
    /// The path, such as `scenery[0].shape.plane.point`, of the value that the first so many bytes of a JSON text end in, or with.
    #[must_use]
    pub fn path_in_json(text: &str, end: usize) -> String {
        path(text, end)
    }
}

/// A list or an object that a place in a JSON text is in.
enum Level<'t> {
    /// An entry of a list, by its number.
    List(usize),
    /// A value in an object, by its key; none, where that is still to come.
    Object(Option<&'t str>),
}

fn path(text: &str, end: usize) -> String {
    let (bytes, mut levels) = (text.as_bytes(), Vec::new());
    let (mut at, end) = (0, end.min(text.len()));
    while at < end {
        match bytes[at] {
            b'{' => levels.push(Level::Object(None)),
            b'[' => levels.push(Level::List(0)),
            b'}' | b']' => drop(levels.pop()),
            b',' => match levels.last_mut() {
                Some(Level::List(number)) => *number += 1,
                Some(Level::Object(key)) => *key = None,
                None => {}
            },
            b'"' => {
                let close = closed(bytes, at);
                if let Some(Level::Object(key @ None)) = levels.last_mut() {
                    *key = text.get(at + 1..close);
                }
                at = close;
            }
            _ => {}
        }
        at += 1;
    }
    written(&levels)
}

/// Where the string ends that begins at a quotation mark.
fn closed(bytes: &[u8], open: usize) -> usize {
    let mut at = open + 1;
    while at < bytes.len() && bytes[at] != b'"' {
        at += if bytes[at] == b'\\' { 2 } else { 1 };
    }
    at
}

fn written(levels: &[Level<'_>]) -> String {
    let mut path = String::new();
    for level in levels {
        match level {
            Level::List(number) => path += &format!("[{number}]"),
            Level::Object(Some(key)) => {
                path += if path.is_empty() { "" } else { "." };
                path += key;
            }
            Level::Object(None) => {}
        }
    }
    path
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The path at the end of what comes before `|`.
    fn at(marked: &str) -> String {
        let end = marked.find('|').expect("a place");
        path(&marked.replacen('|', "", 1), end)
    }

    #[test]
    fn values_have_paths() {
        assert_eq!(at(r#"{"a":[{"b":{"c":[1,2|]}}]}"#), "a[0].b.c[1]");
        assert_eq!(at(r#"{"a":[{"b":{"c":[1,2]|}}]}"#), "a[0].b.c");
        assert_eq!(at(r#"{"a":[{"b":1}|,{"b":2}]}"#), "a[0]");
        assert_eq!(at(r#"{"a":[{"b":1},{"b":2|}]}"#), "a[1].b");
        assert_eq!(at(r#"{"a":[1,|[2]]}"#), "a[1]");
        assert_eq!(at(r#"{"a":7,"b":|{}}"#), "b");
        assert_eq!(at(r#"{"a":7,|"b":{}}"#), "");
    }

    #[test]
    fn strings_may_hold_whatever_they_like() {
        assert_eq!(at(r#"{"a":"{[,\"]","b\\":"x|"}"#), r"b\\");
        assert_eq!(at(r#"{"é":["é","\\",1|]}"#), "é[2]");
        for end in 0..40 {
            path(r#"{"é":["é","\"#, end);
            path(r#"]},,{"é":"#, end);
        }
    }
}
