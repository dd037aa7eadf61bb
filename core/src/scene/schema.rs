//! The JSON Schema of scene files, with descriptions in plain words.

use super::SceneFile;
use super::json::compact_numbers;
use alloc::string::String;
use alloc::vec::Vec;
use schemars::Schema;
use schemars::transform::{RecursiveTransform, Transform};
use serde_json::Value;

/// The JSON Schema of scene files, as text.
#[must_use]
pub fn schema() -> String {
    let mut schema = schemars::schema_for!(SceneFile);
    RecursiveTransform(describe).transform(&mut schema);
    compact_numbers(&serde_json::to_string_pretty(&schema).unwrap_or_default())
}

/// Puts the description into plain words.
fn describe(schema: &mut Schema) {
    if let Some(Value::String(text)) = schema.get_mut("description") {
        *text = plain(text);
    }
}

/// A doc comment without its markup: examples left out, links by their names, paragraphs each on one line.
fn plain(comment: &str) -> String {
    let mut paragraphs: Vec<String> = Vec::new();
    let (mut is_example, mut is_new) = (false, true);
    for line in comment.lines().map(str::trim) {
        let is_fence = line.starts_with("```");
        is_example ^= is_fence;
        if is_fence || is_example || line.is_empty() {
            is_new = true;
            continue;
        }
        match paragraphs.last_mut().filter(|_| !is_new) {
            Some(paragraph) => {
                paragraph.push(' ');
                paragraph.push_str(line);
            }
            None => paragraphs.push(line.into()),
        }
        is_new = false;
    }
    let words = paragraphs.iter().map(|paragraph| about_files(&unmarked(paragraph)));
    words.filter(|words| !words.is_empty()).collect::<Vec<_>>().join("\n")
}

/// A paragraph without the sentences that name something of the program, which files do not have.
fn about_files(paragraph: &str) -> String {
    let sentences = paragraph.split_inclusive(". ").filter(|sentence| !sentence.contains("::"));
    sentences.collect::<String>().trim_end().into()
}

/// A paragraph without backslashes, backticks and the targets of links.
fn unmarked(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    let mut rest = text;
    while let Some(c) = rest.chars().next() {
        let after = &rest[c.len_utf8()..];
        rest = match (c, link(rest)) {
            ('\\', _) => {
                let escaped = after.chars().next();
                out.extend(escaped);
                &after[escaped.map_or(0, char::len_utf8)..]
            }
            ('`', _) => after,
            ('[', Some((name, behind))) => {
                out.push_str(&name.replace('`', ""));
                behind
            }
            _ => {
                out.push(c);
                after
            }
        };
    }
    out
}

/// The name of the link that a text begins with, and what follows it.
fn link(text: &str) -> Option<(&str, &str)> {
    let (name, behind) = text.strip_prefix('[')?.split_once(']')?;
    match behind.strip_prefix('(').and_then(|target| target.split_once(')')) {
        Some((_, behind)) => Some((name, behind)),
        None => name.starts_with('`').then_some((name, behind)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn markup_is_left_out() {
        for (comment, words) in [
            ("Speed \\[m/s\\].", "Speed [m/s]."),
            ("See [`Drag`](super::Drag)\nand [here](x). It is left out of [`Force::add_to`].", "See Drag and here."),
            ("In [0, sin c). It\nis `so`.", "In [0, sin c). It is so."),
            ("One\ntwo.\n\nThree.\n\n```\nlet x = [`1`];\n\n```\n\nFour.", "One two.\nThree.\nFour."),
            ("[a] b", "[a] b"),
        ] {
            assert_eq!(plain(comment), words);
        }
    }

    #[test]
    fn no_description_has_markup() {
        fn look(schema: &Value, count: &mut usize) {
            match schema {
                Value::Object(fields) => fields.iter().for_each(|(name, value)| match value {
                    Value::String(text) if name == "description" => {
                        *count += 1;
                        let has_markup = ["\\", "`", "](", "::", "<"].iter().any(|mark| text.contains(mark));
                        assert!(!has_markup && !text.is_empty(), "{text}");
                    }
                    value => look(value, count),
                }),
                Value::Array(list) => list.iter().for_each(|value| look(value, count)),
                _ => {}
            }
        }
        let (schema, mut count) = (serde_json::from_str(&schema()).expect("JSON"), 0);
        look(&schema, &mut count);
        assert!(count > 200, "{count}");
    }
}
