//! Pictures as SVG: strokes, areas, marks and words, at places in pixels.

use super::page::escape;

/// The colour of words.
pub(super) const INK: &str = "#222222";

/// Width of lines, and size of the dots that mark them.
const STROKE: f64 = 2.0;
const DOT: f64 = 4.0;

/// A place from the left and from the top \[pixels\].
pub(super) type Place = (f64, f64);

/// A picture in the making.
#[derive(Default)]
pub(super) struct Svg(String);

impl Svg {
    /// The whole picture, of so many pixels.
    pub(super) fn picture(self, (width, height): Place) -> String {
        format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\" \
             viewBox=\"0 0 {width} {height}\" font-family=\"sans-serif\" font-size=\"14\" fill=\"{INK}\">\n{}</svg>\n",
            self.0
        )
    }

    /// Another picture with its corner at a place.
    pub(super) fn add(&mut self, (x, y): Place, picture: &Self) {
        self.0.push_str(&format!("<g transform=\"translate({x} {y})\">\n{}</g>\n", picture.0));
    }

    /// A line of the usual width through places.
    pub(super) fn line(&mut self, places: impl IntoIterator<Item = Place>, color: &str) {
        self.stroke(places, color, STROKE);
    }

    /// A thin one.
    pub(super) fn hairline(&mut self, places: impl IntoIterator<Item = Place>, color: &str) {
        self.stroke(places, color, 0.5 * STROKE);
    }

    fn stroke(&mut self, places: impl IntoIterator<Item = Place>, color: &str, width: f64) {
        let points = points(places);
        let line =
            format!("<polyline fill=\"none\" stroke=\"{color}\" stroke-width=\"{width}\" points=\"{points}\"/>\n");
        self.0.push_str(&line);
    }

    /// An area between corners, filled so much.
    pub(super) fn area(&mut self, corners: impl IntoIterator<Item = Place>, color: &str, fill: f64) {
        let points = points(corners);
        self.0.push_str(&format!("<polygon fill=\"{color}\" fill-opacity=\"{fill}\" points=\"{points}\"/>\n"));
    }

    /// A filled dot.
    pub(super) fn dot(&mut self, at: Place, color: &str, fill: f64) {
        self.circle(at, &format!("fill=\"{color}\" fill-opacity=\"{fill}\""));
    }

    /// One of four marks.
    pub(super) fn mark(&mut self, which: usize, at: Place, color: &str) {
        let beside = |(x, y): Place| (at.0 + DOT * x, at.1 + DOT * y);
        match which % 4 {
            0 => self.dot(at, color, 1.0),
            1 => self.area([(0.0, -1.2), (1.1, 0.7), (-1.1, 0.7)].map(beside), color, 1.0),
            2 => {
                self.line([(-1.0, -1.0), (1.0, 1.0)].map(beside), color);
                self.line([(-1.0, 1.0), (1.0, -1.0)].map(beside), color);
            }
            _ => self.circle(at, &format!("fill=\"none\" stroke=\"{color}\" stroke-width=\"{STROKE}\"")),
        }
    }

    fn circle(&mut self, (x, y): Place, style: &str) {
        self.0.push_str(&format!("<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"{DOT}\" {style}/>\n"));
    }

    /// Words whose `anchor` (start, middle or end) is at a place.
    pub(super) fn words(&mut self, words: &str, at: Place, anchor: &str) {
        self.text(words, at, &format!("text-anchor=\"{anchor}\""));
    }

    /// Words with their middle at a place, read upwards.
    pub(super) fn upwards(&mut self, words: &str, (x, y): Place) {
        self.text(words, (x, y), &format!("text-anchor=\"middle\" transform=\"rotate(-90 {x:.1} {y:.1})\""));
    }

    /// Larger words that begin at a place.
    pub(super) fn title(&mut self, words: &str, at: Place) {
        self.text(words, at, "font-size=\"17\"");
    }

    fn text(&mut self, words: &str, (x, y): Place, style: &str) {
        let text = format!("<text x=\"{x:.1}\" y=\"{y:.1}\" dy=\".35em\" {style}>{}</text>\n", escape(words));
        self.0.push_str(&text);
    }
}

fn points(places: impl IntoIterator<Item = Place>) -> String {
    places.into_iter().map(|(x, y)| format!("{x:.1},{y:.1}")).collect::<Vec<_>>().join(" ")
}
