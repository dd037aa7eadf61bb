//! Thrift: of the indices that look right in each pixel, those that pack well.
//!
//! GIF files pack runs of indices that were there before into one code each. So which of two colours that look alike
//! stands for a pixel is up to which of them goes on with a known run.

use super::palette::{Color, Palette, distance};
use std::mem;

/// Codes in a dictionary of the packing; once it is full, a new one begins.
const CODES: usize = 4096;

/// The longest run that is looked for, in pixels.
const LONGEST: usize = 256;

/// No run: that of the first index is no other's child.
const NONE: u16 = 0;

/// The colours that may stand for a pixel.
#[derive(Clone, Copy, Debug)]
pub(super) enum Wish {
    /// This index alone.
    Exactly(u8),
    /// Whatever is no farther from a colour than a distance.
    About(Color, i32),
}

/// Fulfils wishes with indices of a palette.
pub(super) fn fulfil(wishes: &[Wish], palette: &Palette) -> Vec<u8> {
    let mut indices = Vec::with_capacity(wishes.len());
    let mut runs = Runs::new();
    while indices.len() < wishes.len() {
        let mut search = Search { palette, wishes: &wishes[indices.len()..], runs: &runs.known, path: Vec::new() };
        let (best, run) = search.longest();
        indices.extend_from_slice(&best);
        runs.take(run, best[0]);
    }
    indices
}

/// The runs of indices that have a code, as a tree: the children of a run are those longer by one.
#[derive(Debug)]
struct Runs {
    known: Vec<Run>,
    /// The one taken last, which gets a child with what comes after it.
    last: Option<u16>,
}

/// A run, of which it knows the last index.
#[derive(Clone, Copy, Debug)]
struct Run {
    index: u8,
    first_child: u16,
    next_sibling: u16,
}

impl Runs {
    /// The table at the beginning: every index by itself, and two codes for the packing's own ends.
    fn new() -> Self {
        let single = |index: usize| Run { index: index as u8, first_child: NONE, next_sibling: NONE };
        Self { known: (0..258).map(single).collect(), last: None }
    }

    /// Takes a run that begins with some index.
    fn take(&mut self, run: u16, begins: u8) {
        if let Some(last) = self.last {
            let code = self.known.len() as u16;
            let next_sibling = mem::replace(&mut self.known[usize::from(last)].first_child, code);
            self.known.push(Run { index: begins, first_child: NONE, next_sibling });
        }
        self.last = Some(run);
        if self.known.len() == CODES {
            *self = Self::new();
        }
    }
}

/// A search for the longest run that fulfils the next wishes.
struct Search<'a> {
    palette: &'a Palette,
    wishes: &'a [Wish],
    runs: &'a [Run],
    /// The indices of the run that is being looked at.
    path: Vec<u8>,
}

/// The best run that a search has found: the longest, and of those the one that is least far off in all.
struct Found {
    path: Vec<u8>,
    error: i32,
    run: u16,
}

impl Search<'_> {
    /// The indices and the number of the longest run.
    fn longest(&mut self) -> (Vec<u8>, u16) {
        let mut best = Found { path: Vec::new(), error: 0, run: NONE };
        match self.wishes[0] {
            Wish::Exactly(index) => self.follow(u16::from(index), 0, &mut best),
            Wish::About(color, most) => {
                let distances = self.palette.distances(color);
                let least = distances.iter().fold(f32::INFINITY, |a, &b| if b < a { b } else { a });
                // Where nothing is near enough, the nearest has to do.
                let most = least.max(most as f32);
                for (index, &distance) in distances.iter().enumerate() {
                    if distance <= most {
                        self.follow(index as u16, distance as i32, &mut best);
                    }
                }
            }
        }
        (best.path, best.run)
    }

    /// Goes on along a run whose indices, up to its last one, are wished for.
    fn follow(&mut self, run: u16, error: i32, best: &mut Found) {
        let Run { index, first_child, .. } = self.runs[usize::from(run)];
        self.path.push(index);
        let (length, longest) = (self.path.len(), best.path.len());
        if length > longest || length == longest && error < best.error {
            (best.error, best.run) = (error, run);
            best.path.clone_from(&self.path);
        }
        if let Some(&wish) = self.wishes.get(length).filter(|_| length < LONGEST) {
            let mut child = first_child;
            while child != NONE {
                let Run { index, next_sibling, .. } = self.runs[usize::from(child)];
                if let Some(more) = self.error(wish, index) {
                    self.follow(child, error.saturating_add(more), best);
                }
                child = next_sibling;
            }
        }
        self.path.pop();
    }

    /// How far an index is from what is wished for; nothing if it is too far.
    fn error(&self, wish: Wish, index: u8) -> Option<i32> {
        match wish {
            Wish::Exactly(wanted) => (index == wanted).then_some(0),
            Wish::About(color, most) => {
                let &other = self.palette.colors().get(usize::from(index))?;
                Some(distance(color, other)).filter(|&distance| distance <= most)
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn wishes_are_fulfilled_with_runs_that_repeat() {
        let greys: Vec<Color> = [100, 104, 108, 200].into_iter().map(|grey| [grey; 3]).collect();
        let palette = Palette::new(greys.iter().copied());
        let noise = |at: u32| [100 + 4 * ((at.wrapping_mul(2_654_435_761) >> 16) % 3) as u8; 3];
        let most = distance([100; 3], [104; 3]);
        let [loose, exact] = [most, 0].map(|most| {
            let wishes: Vec<Wish> = (0..3000).map(|at| Wish::About(noise(at), most)).collect();
            let indices = fulfil(&wishes, &palette);
            for (at, &index) in (0..).zip(&indices) {
                assert!(distance(noise(at), palette.colors()[usize::from(index)]) <= most, "{at}");
            }
            let mut frame = gif::Frame { buffer: indices.into(), ..gif::Frame::default() };
            frame.make_lzw_pre_encoded();
            frame.buffer.len()
        });
        assert!(4 * loose < 3 * exact, "{loose} {exact}");
    }

    #[test]
    fn what_must_be_is_and_what_cannot_be_is_near() {
        let palette = Palette::new([[0; 3], [255; 3]].into_iter());
        let black = palette.colors().iter().position(|color| *color == [0; 3]).unwrap() as u8;
        let wishes = [Wish::Exactly(2), Wish::Exactly(2), Wish::About([30; 3], 0), Wish::Exactly(1)];
        assert_eq!(fulfil(&wishes, &palette), [2, 2, black, 1]);
        assert!(fulfil(&[], &palette).is_empty());
        let many: Vec<Wish> = (0..20_000u32).map(|at| Wish::Exactly((at * (at % 257) % 251) as u8)).collect();
        let same = |(index, wish): (u8, &Wish)| matches!(wish, Wish::Exactly(wanted) if *wanted == index);
        assert!(fulfil(&many, &palette).into_iter().zip(&many).all(same));
    }
}
