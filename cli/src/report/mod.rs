//! Findings, told once and read at a terminal or as a page; tables of them also go to other programs, charts to pictures.

pub(crate) mod origin;
pub(crate) mod page;
pub(crate) mod plot;
pub(crate) mod table;
pub(crate) mod terminal;
pub(crate) mod words;

use crate::outcome::Outcome;
use plot::Chart;
use table::Table;

/// A place where findings are told. Words may begin in lower case and lack a full stop: a page puts that right.
pub(crate) trait Report {
    /// True if there is room for what a reader at a terminal does without.
    fn is_page(&self) -> bool;

    /// Begins a part of the second level or the third.
    fn heading(&mut self, level: u8, words: &str);

    fn paragraph(&mut self, words: &str);

    /// Facts, each line behind its name.
    fn facts(&mut self, facts: &[(&str, String)]);

    /// Explanations, each behind what it explains.
    fn items(&mut self, items: &[(&str, &str)]);

    /// Sentences that stand for themselves.
    fn list(&mut self, sentences: &[String]);

    fn table(&mut self, table: &Table);

    /// Charts, which only a page shows.
    fn charts(&mut self, charts: &[&Chart<'_>]) -> Outcome;
}
