//! Numbered file names.

use std::path::Path;

/// A file name with a place for a number, such as `%04d.png`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Pattern {
    before: String,
    digits: usize,
    after: String,
}

impl Pattern {
    /// Reads the last part of a path; `None` if it has no place for a number.
    pub fn parse(path: &Path) -> Result<Option<Self>, String> {
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        let Some((before, rest)) = name.split_once('%') else { return Ok(None) };
        let place = rest.split_once('d').filter(|(_, after)| !after.contains('%'));
        match place.and_then(|(width, after)| Some((digits(width)?, after))) {
            Some((digits, after)) => Ok(Some(Self { before: before.to_owned(), digits, after: after.to_owned() })),
            None => Err("a % in a name must be the place of the number, as in %04d or %d".into()),
        }
    }

    /// The name of a path with a number of six digits before its end: `a.ply` becomes `a_000000.ply`.
    pub fn numbered(path: &Path) -> Self {
        let part = |part: Option<&std::ffi::OsStr>| part.unwrap_or_default().to_string_lossy().into_owned();
        Self { before: part(path.file_stem()) + "_", digits: 6, after: format!(".{}", part(path.extension())) }
    }

    /// The name of what all files of the pattern have in common, with another end: `a_%04d.vtp` becomes `a.pvd`.
    pub fn common(&self, extension: &str) -> String {
        let after = Path::new(&self.after).file_stem().unwrap_or_default().to_string_lossy();
        let after = if after.starts_with('.') { "".into() } else { after };
        let name = format!("{}{after}", self.before);
        match name.trim_matches(['_', '-', '.']) {
            "" => format!("records.{extension}"),
            name => format!("{name}.{extension}"),
        }
    }

    /// The name with a number in its place.
    pub fn name(&self, number: usize) -> String {
        let Self { before, digits, after } = self;
        format!("{before}{number:0digits$}{after}")
    }
}

/// The width between `%` and `d`: nothing, or 0 and a number that is not unreasonable.
fn digits(width: &str) -> Option<usize> {
    if width.is_empty() {
        return Some(1);
    }
    let digits = width.strip_prefix('0')?;
    let is_number = digits.bytes().all(|byte| byte.is_ascii_digit());
    digits.parse().ok().filter(|digits| is_number && (1..=20).contains(digits))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_find_their_place() {
        for (path, number, name) in [
            ("out/%04d.png", 7, "0007.png"),
            ("%d.png", 12, "12.png"),
            ("100%/frame-%02d-a.png", 345, "frame-345-a.png"),
            ("%012d", 1, "000000000001"),
        ] {
            let pattern = Pattern::parse(Path::new(path)).unwrap().unwrap();
            assert_eq!(pattern.name(number), name);
        }
        for path in ["a.png", "50%/a.png", ""] {
            assert_eq!(Pattern::parse(Path::new(path)), Ok(None));
        }
    }

    #[test]
    fn a_name_without_a_place_gets_one() {
        for (path, name) in [("out/a.b.ply", "a.b_000007.ply"), ("A.PLY", "A_000007.PLY")] {
            assert_eq!(Pattern::numbered(Path::new(path)).name(7), name);
        }
        for (path, name) in [("a-%02d.vtp", "a.pvd"), ("%d_b.vtp", "b.pvd"), ("o/%d.vtp", "records.pvd")] {
            let pattern = Pattern::parse(Path::new(path)).unwrap().unwrap();
            assert_eq!(pattern.common("pvd"), name);
        }
        assert_eq!(Pattern::numbered(Path::new("a.b.vtp")).common("pvd"), "a.b.pvd");
    }

    #[test]
    fn other_percent_signs_are_errors() {
        for name in ["%.png", "%4d.png", "%s.png", "%%d.png", "%d%d.png", "%0d.png", "%0x4d.png", "%099d.png"] {
            let error = Pattern::parse(Path::new(name)).unwrap_err();
            assert!(error.contains("%04d"), "{name}: {error}");
        }
    }
}
