//! Reports as pages that stand alone: no scripts, nothing from the network.

use crate::Outcome;
use crate::plot::Chart;
use std::fmt::Write;

/// How pages look.
pub(crate) const STYLE: &str = "\
body{font:16px/1.5 system-ui,sans-serif;color:#222;background:#fff;max-width:72rem;margin:2rem auto;padding:0 1.5rem}
h1{font-size:1.7rem;line-height:1.25}h2{margin-top:2.4rem;border-bottom:1px solid #ccc}h3{margin:1.6rem 0 .4rem}
table{border-collapse:collapse;font-variant-numeric:tabular-nums;margin:.6rem 0;font-size:.9rem}
th,td{padding:.2rem .5rem;text-align:right;border-bottom:1px solid #e4e4e4;white-space:nowrap}
th{border-bottom:2px solid #999}th:first-child,td:first-child{text-align:left}
td.best{background:#e5f3ea;font-weight:600}td small{color:#666;font-weight:400}td.why{text-align:left;white-space:normal}
.charts{display:grid;grid-template-columns:repeat(auto-fit,minmax(min(28rem,100%),1fr));gap:.5rem;align-items:start}
.charts svg{width:100%;height:auto;border:1px solid #eee}
dt{font-weight:600}dd{margin:0 0 .5rem 1.5rem}code{background:#f3f3f3;padding:.1rem .3rem;overflow-wrap:anywhere}
.wide{overflow-x:auto}@media print{.charts svg{break-inside:avoid}body{margin:0}}";

/// HTML in the making. What comes from users passes `escape`.
pub(crate) struct Page(pub(crate) String);

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

impl Page {
    /// Begins with a title.
    pub(crate) fn titled(title: &str) -> Self {
        let mut page = Self("<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">".into());
        page.raw("<meta name=\"viewport\" content=\"width=device-width\">");
        page.raw(&format!("<title>{title}</title>\n<style>\n{STYLE}\n</style></head>\n<body>\n<h1>{title}</h1>\n"));
        page
    }

    /// All of it.
    pub(crate) fn done(mut self) -> String {
        self.raw("</body></html>\n");
        self.0
    }

    /// Charts beside each other.
    ///
    /// # Errors
    /// If one cannot be drawn.
    pub(crate) fn pictures<'a>(&mut self, charts: impl IntoIterator<Item = &'a Chart<'a>>) -> Outcome {
        self.raw("<div class=\"charts\">\n");
        for chart in charts {
            self.raw(&chart.svg()?);
        }
        self.raw("</div>\n");
        Ok(())
    }

    pub(crate) fn raw(&mut self, html: &str) {
        self.0.push_str(html);
    }

    pub(crate) fn tagged(&mut self, tag: &str, text: &str) {
        // Writing to a string cannot fail.
        let _ = writeln!(self.0, "<{tag}>{}</{tag}>", escape(text));
    }

    pub(crate) fn items(&mut self, items: &[(String, String)]) {
        self.raw("<dl>\n");
        for (name, text) in items {
            let _ = writeln!(self.0, "<dt>{}</dt><dd>{}</dd>", escape(name), escape(text));
        }
        self.raw("</dl>\n");
    }

    pub(crate) fn cell(&mut self, tag: &str, class: &str, text: &str) {
        let class = if class.is_empty() { String::new() } else { format!(" class=\"{class}\"") };
        let _ = write!(self.0, "<{tag}{class}>{}</{tag}>", escape(text));
    }
}
