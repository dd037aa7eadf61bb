//! The laboratory's findings as a page that stands alone.

use super::chart::charts;
use super::remark::step;
use super::study::{Case, Row, Steps, Study};
use super::table::{error, order};
use crate::Outcome;
use crate::page::Page;

/// The page.
///
/// # Errors
/// If a chart cannot be drawn.
pub(crate) fn html(study: &Study) -> Outcome<String> {
    let mut page = Page::titled("How exact are the integrators?");
    summary(&mut page, study);
    let charts = charts(study);
    for case in &study.cases {
        page.tagged("h2", &case.problem);
        page.tagged("p", &format!("{}. {}.", case.about, sentence(&case.held_against())));
        by_step(&mut page, case);
        energies(&mut page, case);
        by_tolerance(&mut page, case);
        case.notes.iter().for_each(|note| page.tagged("p", &format!("Note: {note}.")));
        page.pictures(charts.iter().filter(|chart| chart.of == case.problem))?;
    }
    method(&mut page);
    Ok(page.done())
}

/// The same with a capital letter.
fn sentence(words: &str) -> String {
    let mut letters = words.chars();
    letters.next().map_or(String::new(), |first| first.to_uppercase().chain(letters).collect())
}

fn summary(page: &mut Page, study: &Study) {
    let items = [
        ("Program".to_string(), format!("pointmass {}; every figure is the same on each run", study.version)),
        ("Command".to_string(), study.command.clone()),
    ];
    page.items(&items);
    page.tagged("h2", "How to read it");
    let read = study.explanations().into_iter().map(|(name, words)| (name.to_string(), words.to_string()));
    page.items(&read.collect::<Vec<_>>());
}

fn by_step(page: &mut Page, case: &Case) {
    let rows: Vec<_> = case.rows.iter().filter(|row| row.steps != Steps::Tolerance).collect();
    let Some(first) = rows.first() else { return };
    head(page, "order", first.points.iter().map(|point| step(point.dt)));
    for row in rows {
        errors(page, row);
        page.raw("</tr>\n");
    }
    page.raw("</table></div>\n");
    page.tagged("p", "By the step [s]. Green: the errors that the order is fitted to.");
}

fn energies(page: &mut Page, case: &Case) {
    page.tagged("p", &format!("{}.", sentence(&case.energies())));
    head(page, "work/s", ["worst", "drift/s", ""].map(String::from).into_iter());
    for row in &case.rows {
        let Some(energy) = &row.energy else { continue };
        page.raw("<tr>");
        let (work, drift) = (format!("{:.0}", energy.work_per_second), format!("{:+.0e}", energy.trend.per_second));
        [&row.name, &work, &format!("{:.1e}", energy.worst), &drift].iter().for_each(|text| page.cell("td", "", text));
        page.cell("td", "why", &row.remark);
        page.raw("</tr>\n");
    }
    page.raw("</table></div>\n");
}

fn by_tolerance(page: &mut Page, case: &Case) {
    let rows: Vec<_> = case.rows.iter().filter(|row| row.steps == Steps::Tolerance).collect();
    let Some(first) = rows.first() else { return };
    page.tagged("h3", &format!("By tolerance [m], within steps of {} s", step(first.points[0].dt)));
    let tolerances =
        first.points.iter().filter_map(|point| point.tolerance).map(|tolerance| format!("{tolerance:.0e}"));
    head(page, "power", tolerances);
    for row in rows {
        errors(page, row);
        page.raw("</tr>\n<tr>");
        ["", "work"].iter().for_each(|text| page.cell("td", "", text));
        row.points.iter().for_each(|point| page.cell("td", "", &point.work().to_string()));
        page.raw("</tr>\n");
    }
    page.raw("</table></div>\n");
}

fn head(page: &mut Page, order: &str, names: impl Iterator<Item = String>) {
    page.raw("<div class=\"wide\"><table><tr><th></th>");
    page.cell("th", "", order);
    names.for_each(|name| page.cell("th", "", &name));
    page.raw("</tr>\n");
}

/// A row's name, order and errors.
fn errors(page: &mut Page, row: &Row) {
    page.raw("<tr>");
    page.cell("td", "", &row.name);
    page.cell("td", "", &order(row));
    for point in &row.points {
        page.cell("td", if point.is_fitted { "best" } else { "" }, &error(point));
    }
}

fn method(page: &mut Page) {
    page.tagged("h2", "What is to be seen");
    let items = [
        (
            "Error against the step",
            "A method of order p is a line of slope p. Lines end to the right where the method is no longer stable, and \
          turn up to the left where more steps only bring more rounding: the engine computes in single precision.",
        ),
        (
            "Error against work",
            "What counts in the end: for an error that will do, take the line that is the farthest to the left there.",
        ),
        (
            "Energy over time",
            "The largest error in each of sixty parts of the time. Methods that are symplectic (symplectic Euler, \
          Verlet) swing but do not drift, so their lines stay level, if not low; explicit Euler's climbs, implicit Euler's as \
          well, since it damps. Where forces dissipate, what the ledger says they took is no error.",
        ),
        ("Rounding", "How far two solutions come apart that differ by the last bit of the starting coordinates."),
    ];
    page.items(&items.map(|(name, words)| (name.to_string(), words.to_string())));
}
