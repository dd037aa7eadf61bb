//! Findings as a page that stands alone: no scripts, nothing from the network.

use super::Report;
use super::origin::Origin;
use super::plot::Chart;
use super::table::{Cell, Column, Table};
use crate::outcome::Outcome;

/// How pages look, by day and by night; charts keep their colours' hues and change light for dark.
const STYLE: &str = "\
:root{color-scheme:light dark;--ink:#222;--paper:#fff;--soft:#666;--line:#ddd;--best:#e5f3ea;--code:#f3f3f3}
@media (prefers-color-scheme:dark){:root{--ink:#ddd;--paper:#181818;--soft:#aaa;--line:#444;--best:#1d3b29;--code:#2a2a2a}
.charts svg{filter:invert(.9) hue-rotate(180deg)}}
body{font:16px/1.5 system-ui,sans-serif;color:var(--ink);background:var(--paper);max-width:72rem;margin:2rem auto;padding:0 1.5rem}
h1{font-size:1.7rem;line-height:1.25}h2{margin-top:2.4rem;border-bottom:1px solid var(--line)}h3{margin:1.6rem 0 .4rem}
table{border-collapse:collapse;font-variant-numeric:tabular-nums;margin:.6rem 0;font-size:.9rem}
th,td{padding:.2rem .5rem;text-align:right;border-bottom:1px solid var(--line);white-space:nowrap}
th{border-bottom:2px solid var(--soft)}th.words,td.words{text-align:left}td.words+td.words{white-space:normal}
td.best{background:var(--best);font-weight:600}td.best::after{content:'*'}td small{color:var(--soft);font-weight:400}
.charts{display:grid;grid-template-columns:repeat(auto-fit,minmax(min(28rem,100%),1fr));gap:.5rem;align-items:start}
.charts svg{width:100%;height:auto;background:#fff}
dt{font-weight:600}dd{margin:0 0 .5rem 1.5rem}code{background:var(--code);padding:.1rem .3rem;overflow-wrap:anywhere}
.wide{overflow-x:auto}@media print{.charts svg{break-inside:avoid}body{margin:0}}";

/// HTML in the making.
pub(crate) struct Page(String);

/// Text as it may stand in HTML.
pub(crate) fn escape(text: &str) -> String {
    let mut escaped = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' => escaped.push_str("&amp;"),
            '<' => escaped.push_str("&lt;"),
            '>' => escaped.push_str("&gt;"),
            '"' => escaped.push_str("&quot;"),
            '\'' => escaped.push_str("&#39;"),
            c if c.is_control() => escaped.push(char::REPLACEMENT_CHARACTER),
            c => escaped.push(c),
        }
    }
    escaped
}

/// The same with a capital letter and a full stop.
fn sentence(words: &str) -> String {
    let mut letters = words.chars();
    let first: String = letters.next().map_or(String::new(), |first| first.to_uppercase().collect());
    let stop = if words.ends_with(['.', ':', '?']) { "" } else { "." };
    escape(&format!("{first}{}{stop}", letters.as_str()))
}

impl Page {
    /// The body of the page, under a title and what made it.
    pub(crate) fn told(title: &str, origin: &Origin, tell: impl FnOnce(&mut dyn Report) -> Outcome) -> Outcome<String> {
        let mut page = Self("<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">".into());
        page.add("<meta name=\"viewport\" content=\"width=device-width\">");
        page.add(&format!("<title>{title}</title>\n<style>\n{STYLE}\n</style></head>\n<body>\n<h1>{title}</h1>\n"));
        let Origin { version, command, machine } = origin;
        let told = format!("{}, {} cores, {}", machine.cpu, machine.cores, machine.os);
        page.facts(&[("Program", format!("pointmass {version}, {}", machine.build)), ("Machine", told)]);
        page.add(&format!("<dl><dt>Command</dt><dd><code>{}</code></dd></dl>\n", escape(command)));
        tell(&mut page)?;
        page.add("</body></html>\n");
        Ok(page.0)
    }

    fn add(&mut self, html: &str) {
        self.0.push_str(html);
    }
}

impl Report for Page {
    fn is_page(&self) -> bool {
        true
    }

    fn heading(&mut self, level: u8, words: &str) {
        self.add(&format!("<h{level}>{}</h{level}>\n", escape(words)));
    }

    fn paragraph(&mut self, words: &str) {
        self.add(&format!("<p>{}</p>\n", sentence(words)));
    }

    fn facts(&mut self, facts: &[(&str, String)]) {
        let facts: Vec<_> = facts.iter().map(|(name, fact)| (*name, fact.as_str())).collect();
        self.items(&facts);
    }

    fn items(&mut self, items: &[(&str, &str)]) {
        let item = |(name, words): &(&str, &str)| format!("<dt>{}</dt><dd>{}</dd>\n", escape(name), escape(words));
        self.add(&format!("<dl>\n{}</dl>\n", items.iter().map(item).collect::<String>()));
    }

    fn list(&mut self, sentences: &[String]) {
        if !sentences.is_empty() {
            let item = |words: &String| format!("<li>{}</li>\n", escape(words));
            self.add(&format!("<ul>\n{}</ul>\n", sentences.iter().map(item).collect::<String>()));
        }
    }

    fn table(&mut self, table: &Table) {
        self.add(&html(table));
    }

    fn charts(&mut self, charts: &[&Chart<'_>]) -> Outcome {
        self.add("<div class=\"charts\">\n");
        for chart in charts {
            self.add(&chart.svg()?);
        }
        self.add("</div>\n");
        Ok(())
    }
}

/// A table as HTML.
pub(crate) fn html(table: &Table) -> String {
    let class = |has_words: bool, is_best: bool| match (has_words, is_best) {
        (false, false) => "",
        (true, false) => " class=\"words\"",
        (false, true) => " class=\"best\"",
        (true, true) => " class=\"words best\"",
    };
    let head = |column: &Column| format!("<th{}>{}</th>", class(column.has_words, false), escape(&column.head));
    let cell = |(cell, column): (&Cell, &Column)| {
        let (class, text) = (class(column.has_words, cell.is_best), escape(column.shown(cell)));
        let aside = cell.aside.iter().map(|aside| format!(" <small>{}</small>", escape(aside))).collect::<String>();
        format!("<td{class}>{text}{aside}</td>")
    };
    let heads: String = table.0.iter().map(head).collect();
    let rows = table.rows().map(|row| format!("<tr>{}</tr>\n", row.zip(&table.0).map(cell).collect::<String>()));
    let rows: String = rows.collect();
    format!("<div class=\"wide\"><table><tr>{heads}</tr>\n{rows}</table></div>\n")
}
