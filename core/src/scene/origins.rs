//! Where in `.scn` texts the parts of a scene stand, so that remarks by their paths name line and column.

use super::scn::Place;
use alloc::collections::BTreeMap;
use alloc::format;
use alloc::string::{String, ToString};
use alloc::vec::Vec;

/// The command that a part of a scene comes from.
#[derive(Clone, Copy, Debug)]
pub(super) struct Origin {
    /// The number of its file, in the order of their reading.
    pub(super) file: u32,
    /// Where its name stands.
    pub(super) place: Place,
    /// Its name.
    pub(super) name: &'static str,
}

/// The commands that the parts of a scene come from, list by list, by the names of these.
#[derive(Debug, Default)]
pub(super) struct Origins {
    files: Vec<String>,
    lists: BTreeMap<&'static str, Vec<Origin>>,
}

impl Origins {
    /// Takes in a file, by the name that messages have for it; its number.
    pub(super) fn open(&mut self, path: &str) -> u32 {
        self.files.push(path.to_string());
        (self.files.len() - 1) as u32
    }

    /// Notes where the next entry of a list comes from, or the latest of what there is but one of.
    pub(super) fn note(&mut self, list: &'static str, origin: Origin) {
        self.lists.entry(list).or_default().push(origin);
    }

    /// Remarks on a scene, each by its path, as remarks on commands, in the order of these. Forces are none, as nobody has written them.
    pub(super) fn place(&self, remarks: &[String]) -> Vec<String> {
        let mut placed: Vec<_> = remarks.iter().filter_map(|remark| self.placed(remark)).collect();
        placed.sort_by_key(|(at, _)| *at);
        placed.into_iter().map(|(_, text)| text).collect()
    }

    /// A remark with the place that it is sorted by.
    fn placed(&self, remark: &str) -> Option<([u32; 3], String)> {
        let (path, text) = remark.split_once(": ")?;
        let (list, rest) = path.split_once('[').map_or((path, None), |(list, rest)| (list, Some(rest)));
        if list == "forces" {
            return None;
        }
        let (number, field) = rest.map_or((None, ""), |rest| {
            let (number, field) = rest.split_once(']').unwrap_or((rest, ""));
            (number.parse::<usize>().ok(), field.trim_start_matches('.'))
        });
        let all = self.lists.get(list).map_or(&[][..], Vec::as_slice);
        let origin = if rest.is_some() { all.get(number?) } else { all.last() };
        let Some(Origin { file, place, name }) = origin else {
            let file = self.files.first().map_or("", String::as_str);
            return Some(([0; 3], format!("{file}: {remark}")));
        };
        let argument = match field {
            "spread" => "angle_cutoff: ".into(),
            // The argument has no name of its own.
            "" | "position" => String::new(),
            field if field.starts_with("shape") => String::new(),
            field => format!("{field}: "),
        };
        let path = self.files.get(*file as usize).map_or("", String::as_str);
        let text = format!("{path}:{}:{}: {name}: {argument}{text}", place.line, place.column);
        Some(([*file, place.line, place.column], text))
    }
}
