//! The laboratory's findings for those who sit at a terminal.

use super::remark::step;
use super::study::{Case, Point, Row, Steps, Study};
use crate::words::{paragraph, say, short};

/// How many steps' errors a row has room for.
const COLUMNS: usize = 5;

/// The whole answer.
pub(crate) fn text(study: &Study, detail: bool) -> String {
    let mut text = String::new();
    for case in &study.cases {
        heading(&mut text, case);
        by_step(&mut text, case, detail);
        by_tolerance(&mut text, case);
        case.notes.iter().for_each(|note| paragraph(&mut text, "  note:", note));
        say(&mut text, "");
    }
    study.explanations().iter().for_each(|(name, words)| paragraph(&mut text, &format!("{name}:"), words));
    text
}

fn heading(text: &mut String, case: &Case) {
    paragraph(text, &format!("{}:", case.problem), &case.about);
    paragraph(text, " ", &case.held_against());
    paragraph(text, " ", &case.energies());
}

impl Case {
    /// What errors are.
    pub(crate) fn held_against(&self) -> String {
        let duration = short(self.duration);
        format!("errors [m]: places after {duration} s, root mean square, against {}", self.reference)
    }

    /// What errors of energy are.
    pub(crate) fn energies(&self) -> String {
        let (long, dt) = (short(self.energy_duration), step(self.energy_dt));
        format!("energy: error over {long} s in steps of {dt} s, as a share of {}", self.energy_scale_is)
    }
}

impl Study {
    /// How to read it.
    pub(crate) fn explanations(&self) -> Vec<(&'static str, &'static str)> {
        let mut all = vec![("order", ORDER), ("~", ROUNDING), ("work/s", WORK)];
        if self.cases.iter().flat_map(|case| &case.rows).any(|row| row.steps == Steps::Own) {
            all.push(("fixed", FIXED));
        }
        all
    }
}

const ORDER: &str = "the power of the step that errors go with, fitted to the three shortest steps whose errors are \
    clear of rounding (theory in brackets)";
const ROUNDING: &str = "an error that may be rounding, by a random walk of its steps or as far as moving the start by the \
    last bit of its coordinates tells, or the reference's own; left out of the fit";
const WORK: &str = "evaluations of all forces, and products with their Jacobian, for each second of the energy's run";
const FIXED: &str = "adaptive and embedded choose inner steps, so that their tolerance and not dt says how large errors \
    are; with an infinite tolerance, fixed, they take every step as it comes";

/// An error in so few letters.
pub(crate) fn error(point: &Point) -> String {
    match (point.error, point.blew_up_at) {
        (_, Some(_)) => "blew up".into(),
        (None, _) => "-".into(),
        (Some(0.0), _) => "~0".into(),
        (Some(error), _) => format!("{}{error:.1e}", if point.is_floor { "~" } else { "" }),
    }
}

/// An order with its theory.
pub(crate) fn order(row: &Row) -> String {
    match (row.order, row.expected) {
        (_, None) => "-".into(),
        (order, Some(expected)) => {
            format!("{} ({expected})", order.map_or("-".into(), |order| format!("{order:.2}")))
        }
    }
}

/// Which of `n` columns there is room for.
fn chosen(n: usize, detail: bool) -> Vec<usize> {
    if detail || n <= COLUMNS {
        return (0..n).collect();
    }
    (0..COLUMNS).map(|i| i * (n - 1) / (COLUMNS - 1)).collect()
}

fn by_step(text: &mut String, case: &Case, detail: bool) {
    let rows: Vec<_> = case.rows.iter().filter(|row| row.steps != Steps::Tolerance).collect();
    let Some(first) = rows.first() else { return };
    let columns = chosen(first.points.len(), detail);
    let mut head = format!("  {:<16} {:>8}", "", "order");
    columns.iter().for_each(|&i| head.push_str(&format!(" {:>7}", step(first.points[i].dt))));
    say(text, &format!("{head} {:>6} {:>7} {:>6}", "work/s", "energy", "drift/s"));
    for row in rows {
        let mut line = format!("  {:<16} {:>8}", row.name, order(row));
        columns.iter().for_each(|&i| line.push_str(&format!(" {:>7}", error(&row.points[i]))));
        let energy = row.energy.as_ref();
        let work = energy.map_or(String::new(), |energy| format!("{:.0}", energy.work_per_second));
        let worst = energy.map_or(String::new(), |energy| format!("{:.1e}", energy.worst));
        let drift = energy.map_or(String::new(), |energy| format!("{:+.0e}", energy.trend.per_second));
        say(text, &format!("{line} {work:>6} {worst:>7} {drift:>6}  {}", row.remark));
    }
}

fn by_tolerance(text: &mut String, case: &Case) {
    let rows: Vec<_> = case.rows.iter().filter(|row| row.steps == Steps::Tolerance).collect();
    let Some(first) = rows.first() else { return };
    let mut head = format!("  {:<16} {:>8}", "by tolerance [m]", "power");
    let tolerances = first.points.iter().filter_map(|point| point.tolerance);
    tolerances.for_each(|tolerance| head.push_str(&format!(" {:>7}", format!("{tolerance:.0e}"))));
    say(text, &format!("{head}  in steps of {} s", step(first.points[0].dt)));
    for row in rows {
        let mut line = format!("  {:<16} {:>8}", row.name, order(row));
        row.points.iter().for_each(|point| line.push_str(&format!(" {:>7}", error(point))));
        say(text, &line);
        let mut line = format!("  {:<16} {:>8}", "", "work");
        row.points.iter().for_each(|point| line.push_str(&format!(" {:>7}", point.work())));
        say(text, &line);
    }
}
