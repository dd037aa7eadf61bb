//! A check as a page that stands alone: no scripts, nothing from the network.

use super::plot::{Scenery, svg};
use super::text::{facts, heads, limits, verdict};
use super::words::time;
use crate::Outcome;
use crate::page::{STYLE, escape};
use std::fmt::Write;

/// What the figures mean.
const NOTES: [&str; 5] = [
    "A step is stable while nothing that should swing or come to rest grows. It is not accurate yet.",
    "At rest: the oscillations of the springs where the scene begins, as if each had its rest length there, without gravity \
     and other forces; what only drifts is left out.",
    "Every pose: the stiffness at each particle over its mass, as if all its springs pulled in one line, which no pose \
     exceeds near the springs' rest lengths. Springs that are damped more or less than others are taken at their worst.",
    "Contact: hits of balls that push each other apart give back no more energy than they take, however the steps fall \
     within them, nor does a ball grow restless among as many of its size as can touch it.",
    "Taut springs pull across themselves as well, and their damping does not act there: explicit Euler and the midpoint \
     method make that grow at any step, however slowly.",
];

/// The page.
///
/// # Errors
/// If the picture cannot be drawn.
pub(crate) fn html(scenery: &Scenery<'_>) -> Outcome<String> {
    let check = scenery.check;
    let mut page = String::new();
    let title = "Which step?";
    page.push_str("<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">");
    page.push_str("<meta name=\"viewport\" content=\"width=device-width\">");
    // Writing to a string cannot fail.
    let _ = write!(page, "<title>{title}</title>\n<style>\n{STYLE}\n</style></head>\n<body>\n<h1>{title}</h1>\n<dl>\n");
    for (name, text) in facts(check) {
        let _ = writeln!(page, "<dt>{}</dt><dd>{}</dd>", escape(name), escape(&text));
    }
    page.push_str("</dl>\n<h2>What to do</h2>\n<ul>\n");
    for advice in &check.advice {
        let _ = writeln!(page, "<li>{}</li>", escape(advice));
    }
    page.push_str("</ul>\n<h2>The largest steps</h2>\n<div class=\"wide\"><table><tr><th></th>");
    let head = heads(check).into_iter().chain([format!("at {}", time(check.dt))]);
    head.into_iter().for_each(|name| page.push_str(&format!("<th>{}</th>", escape(&name))));
    page.push_str("</tr>\n");
    for stand in &check.methods {
        let class = if stand.method == check.integrator { " class=\"best\"" } else { "" };
        let _ = write!(page, "<tr><td{class}>{}</td>", escape(&stand.method));
        let cells = limits(check, stand).into_iter().chain([verdict(stand)]);
        cells.into_iter().for_each(|cell| page.push_str(&format!("<td{class}>{}</td>", escape(&cell))));
        page.push_str("</tr>\n");
    }
    page.push_str("</table></div>\n<h2>Where methods are stable</h2>\n<div class=\"charts\">\n");
    page.push_str(&svg(scenery)?);
    page.push_str("</div>\n<h2>What it means</h2>\n");
    NOTES.iter().for_each(|note| page.push_str(&format!("<p>{}</p>\n", escape(note))));
    page.push_str("</body></html>\n");
    Ok(page)
}
