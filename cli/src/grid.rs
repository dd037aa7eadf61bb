//! Tables on a terminal.

use crate::words::{WIDTH, say};

/// A table whose rows have names. Columns that find no room beside the others come below them, behind the names again.
pub(crate) struct Grid<'a> {
    names: Vec<&'a str>,
    columns: Vec<Column>,
}

/// A column, and how wide it is.
struct Column {
    cells: Vec<String>,
    width: usize,
}

impl<'a> Grid<'a> {
    /// A table without columns.
    pub(crate) fn of(names: impl IntoIterator<Item = &'a str>) -> Self {
        Self { names: names.into_iter().collect(), columns: Vec::new() }
    }

    /// Adds a column with a cell for each row, `least` letters wide or more.
    pub(crate) fn column(&mut self, head: &str, least: usize, cells: impl IntoIterator<Item = String>) {
        let cells: Vec<_> = std::iter::once(head.to_string()).chain(cells).collect();
        let width = cells.iter().map(|cell| cell.chars().count()).max().unwrap_or(0).max(least);
        self.columns.push(Column { cells, width });
    }

    /// Writes it in lines that fit a terminal.
    pub(crate) fn write(&self, text: &mut String) {
        let longest = self.names.iter().map(|name| name.chars().count()).max().unwrap_or(0).max(10);
        let mut rest = &self.columns[..];
        while !rest.is_empty() {
            let mut taken = 2 + longest;
            let fitting = rest.iter().take_while(|column| {
                taken += 1 + column.width;
                taken <= WIDTH
            });
            let (now, later) = rest.split_at(fitting.count().max(1));
            for (row, name) in std::iter::once(&"").chain(&self.names).enumerate() {
                let mut line = format!("  {name:<longest$}");
                for Column { cells, width } in now {
                    let cell = cells.get(row).map_or("-", String::as_str);
                    line.push_str(&format!(" {cell:>width$}"));
                }
                say(text, &line);
            }
            rest = later;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_finds_no_room_comes_below() {
        let mut grid = Grid::of(["brute", "a long name"]);
        for (head, cell) in
            [("one", "1".repeat(30)), ("two", "2".repeat(30)), ("three", "3".repeat(90)), ("four", "4".into())]
        {
            grid.column(head, 8, [cell.clone(), cell]);
        }
        let mut text = String::new();
        grid.write(&mut text);
        let lines: Vec<_> = text.lines().collect();
        assert_eq!(lines.len(), 9, "{text}");
        for (row, words) in [(0, "one two"), (3, "three"), (6, "four"), (8, "a long name 4")] {
            assert_eq!(lines[row].split_whitespace().collect::<Vec<_>>().join(" "), words, "{text}");
        }
        assert_eq!((lines[8].len(), lines[6].len()), (22, 22), "{text}");
        assert!(
            lines.iter().all(|line| line.len() <= WIDTH || line.contains('3') || line.ends_with("three")),
            "{text}"
        );
    }
}
