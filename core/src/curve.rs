//! Numbers that change over a particle's life: keys, and a way from each to the next.

use crate::time::Time;

/// The measure of a curve's instants.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "snake_case"))]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub enum Over {
    /// The share of its life that a particle has behind it, 0 to 1. Whoever lives for ever stays at 0.
    #[default]
    Life,
    /// Its age \[s\].
    Seconds,
}

/// A curve through keys. Each is an instant, then its values: one of a plain curve, three of a colour.
///
/// It is constant up to the first key and from the last key on; of keys at one instant the last counts from it on. Keys
/// are in the order of their instants; without any a curve is 1. The cost is a search among them.
///
/// ```
/// use pointmass::material::{Curve, Over};
///
/// let fades = Curve { keys: &[[0.0, 0.0], [0.1, 1.0], [1.0, 0.0]], over: Over::Life, smooth: false };
/// assert_eq!([fades.at(0.05), fades.at(0.1), fades.at(2.0)], [0.5, 1.0, 0.0]);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Curve<'a, const N: usize = 2> {
    /// An instant and values each.
    pub keys: &'a [[f32; N]],
    /// The measure of the instants.
    pub over: Over,
    /// True if it goes from key to key along cubics instead of straight: through all keys, nowhere beyond two that
    /// follow each other (Steffen, "A simple method for monotonic interpolation in one dimension", A&A 239, 1990).
    pub smooth: bool,
}

/// A curve, or a way between two: each particle has its own place between them, the same as long as it lives.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Varying<'a, const N: usize = 2> {
    /// The curve, or the one side of what there is to choose from.
    pub from: Curve<'a, N>,
    /// The other side.
    pub to: Option<Curve<'a, N>>,
}

/// How far a particle has come in its life.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Age {
    /// The share of its life that it has behind it, 0 to 1; 0 for those who live for ever.
    pub life: f32,
    /// The time since its birth \[s\].
    pub seconds: f32,
}

impl Age {
    /// That of a particle at an instant.
    #[must_use]
    pub fn of(born: Time, dies: Time, now: Time) -> Self {
        let seconds = (now - born).seconds();
        let whole = (dies - born).seconds();
        let life = if dies == Time::NEVER || !(seconds > 0.0) {
            0.0
        } else if seconds < whole {
            seconds / whole
        } else {
            1.0
        };
        Self { life, seconds }
    }
}

impl Curve<'_, 2> {
    /// Its value at an instant in its measure.
    #[must_use]
    pub fn at(&self, instant: f32) -> f32 {
        self.value(1, instant)
    }
}

impl<'a, const N: usize> Curve<'a, N> {
    /// The same value all the time.
    #[must_use]
    pub const fn constant(key: &'a [[f32; N]; 1]) -> Self {
        Self { keys: key, over: Over::Life, smooth: false }
    }

    /// The instant of an age in its measure.
    fn instant(&self, age: Age) -> f32 {
        match self.over {
            Over::Life => age.life,
            Over::Seconds => age.seconds,
        }
    }

    /// The `number`-th entry of keys, from 1, at an instant.
    fn value(&self, number: usize, instant: f32) -> f32 {
        let next = self.keys.partition_point(|key| key[0] <= instant);
        let since = next.checked_sub(1).map_or(0.0, |from| instant - self.keys[from][0]);
        self.piece(number, next, since).value()
    }

    /// The way of the `number`-th entry from the key before `next` to that one, so long after the former.
    pub(crate) fn piece(&self, number: usize, next: usize, since: f32) -> Piece {
        let value = |at: usize| self.keys.get(at).map(|key| key[number]);
        let Some(from) = next.checked_sub(1) else { return Piece::still(value(0).unwrap_or(1.0)) };
        let (Some(a), Some(b)) = (value(from), value(next)) else { return Piece::still(value(from).unwrap_or(1.0)) };
        let width = self.keys[next][0] - self.keys[from][0];
        let (share, way) = (since / width, b - a);
        if !self.smooth {
            return Piece { from: a, powers: [way, 0.0, 0.0], share, width };
        }
        Piece::smooth([a, b], [self.slope(number, from), self.slope(number, next)], width, share)
    }

    /// Steffen's slope at a key.
    fn slope(&self, number: usize, key: usize) -> f32 {
        let before = key.checked_sub(1).and_then(|from| self.secant(number, from));
        match (before, self.secant(number, key)) {
            (Some(s), Some(t)) => inner_slope(s, t),
            (None, Some((s, width))) => end_slope((s, width), self.secant(number, key + 1)),
            (Some((s, width)), None) => {
                let further = key.checked_sub(2).and_then(|from| self.secant(number, from));
                end_slope((s, width), further)
            }
            (None, None) => 0.0,
        }
    }

    /// How steep the straight line from a key to the next is, and how long that takes; none over a jump.
    fn secant(&self, number: usize, from: usize) -> Option<(f32, f32)> {
        let (a, b) = (self.keys.get(from)?, self.keys.get(from + 1)?);
        let width = b[0] - a[0];
        (width > 0.0).then(|| ((b[number] - a[number]) / width, width))
    }
}

/// A cubic from a key to the next, and how far along it an instant is.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Piece {
    from: f32,
    /// The factors of the share, its square and its cube.
    powers: [f32; 3],
    share: f32,
    width: f32,
}

impl Piece {
    pub(crate) const fn still(value: f32) -> Self {
        Self { from: value, powers: [0.0; 3], share: 0.0, width: 1.0 }
    }

    /// The cubic between two values with these slopes, and an instant at a share of the width between them.
    #[inline]
    pub(crate) fn smooth([from, to]: [f32; 2], slopes: [f32; 2], width: f32, share: f32) -> Self {
        let (way, [rise, fall]) = (to - from, [slopes[0] * width, slopes[1] * width]);
        Self { from, powers: [rise, 3.0 * way - 2.0 * rise - fall, rise + fall - 2.0 * way], share, width }
    }

    #[inline]
    pub(crate) fn value(&self) -> f32 {
        let ([rise, square, cube], share) = (self.powers, self.share);
        self.from + (rise + (square + cube * share) * share) * share
    }

    /// Its first derivative by the instant.
    #[inline]
    pub(crate) fn slope(&self) -> f32 {
        let ([rise, square, cube], share) = (self.powers, self.share);
        (rise + (2.0 * square + 3.0 * cube * share) * share) / self.width
    }

    /// Its second derivative: here, at its first key and at its second, between which that goes straight.
    #[inline]
    pub(crate) fn bends(&self) -> [f32; 3] {
        let [_, square, cube] = self.powers;
        let factor = 2.0 / (self.width * self.width);
        let at = |share: f32| (square + 3.0 * cube * share) * factor;
        [at(self.share), at(0.0), at(1.0)]
    }
}

/// Steffen's slope at a key between two others, of the lines on both sides of it.
#[inline]
pub(crate) fn inner_slope((s, width): (f32, f32), (t, next): (f32, f32)) -> f32 {
    let middle = (s * next + t * width) / (width + next);
    let steepest = s.abs().min(t.abs()).min(0.5 * middle.abs());
    if s * t > 0.0 { 2.0 * steepest.copysign(s) } else { 0.0 }
}

/// Steffen's slope at an end, of the line beside it and the one after.
fn end_slope((s, width): (f32, f32), further: Option<(f32, f32)>) -> f32 {
    let Some((t, next)) = further else { return s };
    let share = width / (width + next);
    let slope = s * (1.0 + share) - t * share;
    if slope * s <= 0.0 {
        0.0
    } else if slope.abs() > 2.0 * s.abs() {
        2.0 * s
    } else {
        slope
    }
}

impl<const N: usize> Varying<'_, N> {
    /// The `number`-th entry of keys, from 1, at an age, for whoever is so far from the one side to the other, 0 to 1.
    pub(crate) fn value(&self, number: usize, age: Age, between: f32) -> f32 {
        let from = self.from.value(number, self.from.instant(age));
        let Some(to) = self.to else { return from };
        from + (to.value(number, to.instant(age)) - from) * between
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn curve(keys: &[[f32; 2]], smooth: bool) -> Curve<'_> {
        Curve { keys, over: Over::Seconds, smooth }
    }

    #[test]
    fn curves_go_through_their_keys_and_stay_at_the_ends() {
        let keys = [[-1.0, 2.0], [0.0, 5.0], [0.5, 5.5], [2.0, -1.0], [3.0, 0.0]];
        for smooth in [false, true] {
            for [at, value] in keys {
                assert_eq!(curve(&keys, smooth).at(at), value, "{at}");
            }
            assert_eq!([curve(&keys, smooth).at(-9.0), curve(&keys, smooth).at(9.0)], [2.0, 0.0]);
            assert_eq!(curve(&[], smooth).at(0.5), 1.0);
            assert_eq!(curve(&[[0.5, 3.0]], smooth).at(f32::NAN), 3.0);
        }
        assert_eq!(curve(&keys, false).at(1.25), 2.25);
        // A jump: the last of two at one instant counts from it on.
        let jump = [[0.0, 1.0], [1.0, 1.0], [1.0, 3.0], [2.0, 3.0]];
        assert_eq!([0.999, 1.0].map(|t| curve(&jump, true).at(t)), [1.0, 3.0]);
    }

    #[test]
    fn smooth_curves_are_smooth_and_never_overshoot() {
        let keys = [[0.0, 0.0], [0.1, 1.0], [0.4, 1.0], [0.5, 0.25], [0.9, 0.2], [1.0, 0.0]];
        let smooth = curve(&keys, true);
        let mut before = (0.0, 0.0);
        for i in 1..=10_000u16 {
            let t = f32::from(i) / 10_000.0;
            let value = smooth.at(t);
            let segment = keys.partition_point(|key| key[0] < t);
            let (a, b) = (keys[segment - 1][1], keys[segment][1]);
            assert!((a.min(b) - 1e-6..=a.max(b) + 1e-6).contains(&value), "{t}: {value}");
            // The slope has no jumps: its change over a step is that of the second derivative.
            let slope = (value - before.0) * 10_000.0;
            assert!(i < 2 || (slope - before.1).abs() < 0.5, "{t}: {} to {slope}", before.1);
            before = (value, slope);
        }
        // Keys on a parabola have the parabola between them as well.
        let parabola: [[f32; 2]; 9] = core::array::from_fn(|i| [i as f32, (i * i) as f32]);
        for t in [1.5f32, 3.25, 6.75] {
            assert!((curve(&parabola, true).at(t) - t * t).abs() < 0.02, "{t}");
        }
        // Two keys have a straight line between them.
        assert!((curve(&[[0.0, 1.0], [2.0, 3.0]], true).at(0.5) - 1.5).abs() < 1e-6);
    }

    #[test]
    fn ages_are_shares_of_the_life() {
        let at = |seconds: f32| Time::from_seconds(seconds);
        let age = |now| Age::of(at(1.0), at(5.0), at(now));
        assert_eq!(
            [age(0.5).life, age(1.0).life, age(2.0).life, age(5.0).life, age(9.0).life],
            [0.0, 0.0, 0.25, 1.0, 1.0]
        );
        assert_eq!(age(3.0).seconds, 2.0);
        assert_eq!(Age::of(at(1.0), Time::NEVER, at(99.0)), Age { life: 0.0, seconds: 98.0 });
    }
}
