//! Where in an object something is, by its text: nobody but this package has seen that.

use pointmass::scene::SceneFile;

/// The path of a place that is told as `line:column` of a text of one line; nothing, if it is told otherwise.
pub(crate) fn of_place(text: &str, place: &str) -> Option<String> {
    let column = place.strip_prefix("1:")?.parse().ok()?;
    Some(SceneFile::path_in_json(text, column))
}

/// The path of the text that ends last before such a place.
pub(crate) fn before_quote(text: &str, place: &str) -> Option<String> {
    let column: usize = place.strip_prefix("1:")?.parse().ok()?;
    let close = text.get(..column.min(text.len()))?.rfind('"')?;
    Some(SceneFile::path_in_json(text, close + 1))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_alone_are_where_they_end() {
        assert_eq!(before_quote(r#"{"forces":[{"drag":{}},"drag",{"a":1}]}"#, "1:30").as_deref(), Some("forces[1]"));
        assert_eq!(before_quote(r#"{"contacts":"impulse"}"#, "1:22").as_deref(), Some("contacts"));
        assert_eq!(before_quote(r#"{"forces":["drag"]}"#, "1:18").as_deref(), Some("forces[0]"));
        assert_eq!(before_quote("{}", "1:2"), None);
    }
}
