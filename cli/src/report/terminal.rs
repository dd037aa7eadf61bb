//! Findings for those who sit at a terminal.

use super::Report;
use super::plot::Chart;
use super::table::{Cell, Column, Table};
use super::words::WIDTH;
use crate::outcome::Outcome;
use comfy_table::{CellAlignment, ContentArrangement};
use textwrap::{Options, WordSplitter};

/// Lines of text in the making.
#[derive(Debug, Default)]
pub(crate) struct Terminal(String);

impl Terminal {
    /// The report that is told.
    pub(crate) fn told(tell: impl FnOnce(&mut dyn Report) -> Outcome) -> Outcome<String> {
        let mut terminal = Self::default();
        tell(&mut terminal)?;
        Ok(terminal.0)
    }

    /// Words in lines that fit, behind a mark; what follows the first line stands as far in as said.
    fn fill(&mut self, mark: &str, indent: usize, words: &str) {
        let indent = " ".repeat(indent);
        let options = Options::new(WIDTH).initial_indent(mark).subsequent_indent(&indent);
        // Options keep their names.
        let options = options.word_splitter(WordSplitter::NoHyphenation);
        for line in textwrap::wrap(&words.split_whitespace().collect::<Vec<_>>().join(" "), options) {
            self.0.push_str(line.trim_end());
            self.0.push('\n');
        }
    }
}

impl Report for Terminal {
    fn is_page(&self) -> bool {
        false
    }

    fn heading(&mut self, _: u8, words: &str) {
        if !self.0.is_empty() && !self.0.ends_with("\n\n") {
            self.0.push('\n');
        }
        self.fill("", 4, words);
    }

    fn paragraph(&mut self, words: &str) {
        self.fill("  ", 4, words);
    }

    fn facts(&mut self, facts: &[(&str, String)]) {
        for (name, fact) in facts {
            self.fill(&format!("{name:>10}  "), 12, fact);
        }
    }

    fn items(&mut self, items: &[(&str, &str)]) {
        for (name, words) in items {
            self.fill(&format!("  {name}: "), 4, words);
        }
    }

    fn list(&mut self, sentences: &[String]) {
        for sentence in sentences {
            self.fill("  - ", 4, sentence);
        }
    }

    fn table(&mut self, table: &Table) {
        self.0.push_str(&text(table));
    }

    fn charts(&mut self, _: &[&Chart<'_>]) -> Outcome {
        Ok(())
    }
}

/// A table in lines that fit. Columns that find no room beside the others come below them, behind the names again.
fn text(table: &Table) -> String {
    let Some((names, mut rest)) = table.0.split_first() else { return String::new() };
    let mut text = String::new();
    while !rest.is_empty() {
        let mut taken = width(names);
        let fitting = rest.iter().take_while(|column| {
            taken += width(column);
            taken <= WIDTH
        });
        let (now, later) = rest.split_at(fitting.count().max(1));
        text.push_str(&laid_out(std::iter::once(names).chain(now)));
        text.push('\n');
        rest = later;
    }
    text
}

/// A cell for a terminal; where some are marked, the others keep the mark's place.
fn told(column: &Column, cell: &Cell) -> String {
    let aside = cell.aside.iter().map(|aside| format!(" {aside:>4}")).collect::<String>();
    let mark = match column.cells.iter().any(|cell| cell.is_best) {
        true if cell.is_best => "*",
        true => "\u{a0}",
        false => "",
    };
    format!("{}{aside}{mark}", column.shown(cell))
}

/// Letters of its widest line, and the blanks before it. Words may be broken.
fn width(column: &Column) -> usize {
    let cells = column.cells.iter().map(|cell| told(column, cell));
    let width = cells.chain([column.head.clone()]).map(|cell| cell.chars().count()).max().unwrap_or(0);
    2 + if column.has_words { width.min(WIDTH / 3) } else { width }
}

/// Columns beside each other, in lines that fit a terminal.
fn laid_out<'a>(columns: impl Iterator<Item = &'a Column>) -> String {
    let columns: Vec<_> = columns.collect();
    let mut table = comfy_table::Table::new();
    table
        .load_style(comfy_table::presets::NOTHING)
        .set_content_arrangement(ContentArrangement::Dynamic)
        .set_width(WIDTH as u16);
    table.set_header(columns.iter().map(|column| &column.head));
    for row in 0..columns[0].cells.len() {
        table.add_row(
            columns.iter().map(|column| column.cells.get(row).map_or(String::new(), |cell| told(column, cell))),
        );
    }
    for (laid, column) in table.column_iter_mut().zip(&columns) {
        laid.set_padding((2, 0));
        laid.set_cell_alignment(if column.has_words { CellAlignment::Left } else { CellAlignment::Right });
    }
    table.trim_fmt().replace('\u{a0}', " ").lines().map(|line| format!("{}\n", line.trim_end())).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn table() -> Table {
        let mut table = Table::default();
        table.column("", ["brute", "a, \"long\" name"]);
        for (head, cell) in [("one", "1".repeat(30)), ("two", "2".repeat(26)), ("<three>", "3".repeat(70))] {
            table.column(head, [Some(cell), None]);
        }
        table.column("four", [Cell::with("4".into(), "1.0".into()).best(true), Cell::from(0.5)]);
        table
    }

    #[test]
    fn what_finds_no_room_comes_below() {
        let text = text(&table());
        let lines: Vec<_> = text.lines().map(|line| line.split_whitespace().collect::<Vec<_>>().join(" ")).collect();
        for (row, words) in [(0, "one two"), (2, "a, \"long\" name - -"), (4, "<three>"), (10, "brute 4 1.0*")] {
            assert_eq!(lines.get(row).map(String::as_str), Some(words), "{text}");
        }
        assert!(text.lines().all(|line| line.chars().count() <= WIDTH), "{text}");
    }

    #[test]
    fn every_format_escapes_what_it_has_to() -> Outcome {
        let (csv, html) = (table().csv()?, super::super::page::html(&table()));
        assert!(csv.starts_with(",one,two,<three>,four\nbrute,111"), "{csv}");
        assert!(csv.ends_with("\n\"a, \"\"long\"\" name\",,,,0.5\n"), "{csv}");
        for cell in ["<th>&lt;three&gt;</th>", "<td class=\"best\">4 <small>1.0</small></td>", "<td>-</td>"] {
            assert!(html.contains(cell), "{html}");
        }
        Ok(())
    }
}
