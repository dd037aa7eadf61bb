//! The extremes of what materials make of drag and mass over the lives of particles.

use pointmass::Varied;
use pointmass::material::{Curve, Life, Over, Varying};

/// The ages that particles reach.
pub(super) struct Ages {
    /// The largest share of a life: 1, or 0 of those who live for ever.
    share: f32,
    /// The longest time \[s\].
    seconds: f32,
}

impl Ages {
    /// The extremes of particles that live so long.
    pub(super) fn of(lifetime: Varied) -> Self {
        let longest = lifetime.mean + lifetime.half_width.abs();
        let is_endless = lifetime.mean - lifetime.half_width.abs() <= 0.0;
        Self { share: if longest > 0.0 { 1.0 } else { 0.0 }, seconds: if is_endless { f32::INFINITY } else { longest } }
    }

    /// The last instant of a curve that they come to.
    fn end(&self, curve: &Curve<'_>) -> f32 {
        match curve.over {
            Over::Life => self.share,
            Over::Seconds => self.seconds,
        }
    }

    /// The instants of a curve's keys that they come to, and the first and the last of all.
    fn instants(&self, curve: &Curve<'_>) -> impl Iterator<Item = f32> {
        let end = self.end(curve);
        let keys = curve.keys.iter().map(|key| key[0]).filter(move |instant| (0.0..=end).contains(instant));
        keys.chain([0.0, end])
    }

    /// The least and the greatest value of a factor: one of those at its keys, since between them no curve is beyond both.
    pub(super) fn range(&self, factor: Option<Varying<'_>>) -> [f64; 2] {
        let Some(factor) = factor else { return [1.0; 2] };
        let sides = sides(&factor);
        let values = sides.iter().flat_map(|curve| {
            let end = self.end(curve);
            // A jump's keys are all at one instant, and all but the last are only come near to.
            let keys = curve.keys.iter().filter(move |key| (0.0..=end).contains(&key[0])).map(|key| key[1]);
            keys.chain(self.instants(curve).map(|instant| curve.at(instant)))
        });
        values.map(f64::from).fold([f64::INFINITY, f64::NEG_INFINITY], |[a, b], x| [a.min(x), b.max(x)])
    }

    /// The drag \[kg/s\] and the mass \[kg\] of a particle when it is braked most: `drag` says what a factor makes of its
    /// drag, `mass` is its own. Never less than that, and up to a hundredth more where curves are smooth.
    ///
    /// Between keys the quotient of straight curves only rises or only falls. Smooth ones only rise or fall themselves.
    pub(super) fn most_braked(&self, life: &Life<'_>, drag: impl Fn(f64) -> f64, mass: f64) -> [f64; 2] {
        const SLACK: f64 = 1.01;
        let worst = self.range(life.drag).map(&drag);
        let apart = [worst[0].max(worst[1]), mass * self.range(life.mass)[0]];
        let (Some(drags), Some(masses)) = (&life.drag, &life.mass) else { return apart };
        let (drags, masses) = (sides(drags), sides(masses));
        let curves: Vec<_> = drags.iter().chain(&masses).collect();
        if curves.iter().any(|curve| curve.over != curves[0].over) {
            return apart;
        }
        let last = curves.iter().filter_map(|curve| curve.keys.last()).map(|key| key[0]).fold(0.0, f32::max);
        let mut instants: Vec<_> =
            curves.iter().flat_map(|curve| self.instants(curve)).map(|at| at.min(last)).collect();
        instants.sort_by(f32::total_cmp);
        instants.dedup();
        let at = |instant: f32| {
            let of = |curve: &Curve<'_>| f64::from(curve.at(instant));
            let most = drags.iter().map(|curve| drag(of(curve))).fold(f64::NEG_INFINITY, f64::max);
            [most, mass * masses.iter().map(of).fold(f64::INFINITY, f64::min)]
        };
        let is_smooth = curves.iter().any(|curve| curve.smooth);
        let rate = |[drag, mass]: [f64; 2]| drag / mass;
        let worse = |a, b| if rate(b) > rate(a) { b } else { a };
        let mut seen = at(last.min(self.end(curves[0])));
        let mut bound = seen;
        let mut spans: Vec<_> = instants.windows(2).map(|ends| [ends[0], ends[1]]).collect();
        while let Some([from, to]) = spans.pop() {
            // Before a jump.
            let [a, b] = [at(from), at(to.next_down())];
            seen = worse(worse(seen, a), b);
            let most = if is_smooth { [a[0].max(b[0]), a[1].min(b[1])] } else { worse(a, b) };
            let middle = from + 0.5 * (to - from);
            if rate(most) > SLACK * rate(seen) && from < middle && middle < to.next_down() {
                spans.extend([[from, middle], [middle, to]]);
            } else {
                bound = worse(bound, most);
            }
        }
        bound
    }
}

/// The curve, or both sides between which particles have their places.
fn sides<'a>(factor: &Varying<'a>) -> Vec<Curve<'a>> {
    [Some(factor.from), factor.to].into_iter().flatten().collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn plain(keys: &[[f32; 2]], over: Over, smooth: bool) -> Varying<'_> {
        Varying { from: Curve { keys, over, smooth }, to: None }
    }

    #[test]
    fn factors_range_over_what_is_reached_of_both_sides() {
        let keys = [[0.0, 2.0], [0.5, 3.0], [0.5, 0.5], [1.0, 1.0]];
        let both = Varying {
            to: Some(plain(&[[0.0, 0.2], [9.0, 9.2]], Over::Seconds, false).from),
            ..plain(&keys, Over::Life, true)
        };
        let range = |factor, mean, half_width| {
            let [least, most] = Ages::of(Varied { mean, half_width }).range(factor);
            assert!(least <= most);
            [least, most].map(|value| (value * 1e3).round() / 1e3)
        };
        assert_eq!(range(None, 1.0, 0.0), [1.0, 1.0]);
        assert_eq!(range(Some(plain(&keys, Over::Life, false)), 7.0, 0.0), [0.5, 3.0]);
        // Who lives for ever stays at the beginning of a life, and comes to the end of all seconds.
        assert_eq!(range(Some(plain(&keys, Over::Life, false)), 0.0, 0.0), [2.0, 2.0]);
        assert_eq!(range(Some(plain(&keys, Over::Seconds, false)), 0.0, 0.0), [0.5, 3.0]);
        assert_eq!(range(Some(plain(&keys, Over::Seconds, false)), 0.25, 0.0), [2.0, 2.5]);
        assert_eq!(range(Some(both), 3.0, 1.0), [0.2, 4.2]);
        assert_eq!(range(Some(both), 3.0, 3.0), [0.2, 9.2]);
    }

    #[test]
    fn nobody_is_braked_more_and_somebody_is_almost_as_much() {
        let steep = [[0.0, 1.0], [0.3, 8.0], [0.3, 5.0], [0.8, 5.0], [1.0, 0.1]];
        let light = [[0.1, 2.0], [0.25, 1.0], [0.6, 1.0], [0.6, 0.2], [0.9, 4.0]];
        let rising = [[0.0, 1.0], [1.0, 9.0]];
        for (drag, mass) in
            [(steep, &light[..]), (light, &steep[..]), (steep, &rising), (light, &rising), (steep, &steep)]
        {
            for (smooth, slack) in [(false, 1.0 + 1e-6), (true, 1.01)] {
                for all in [0.0, 0.7] {
                    let brake = |factor: f64| 3.0 * factor + all;
                    let [drag, mass] = [&drag[..], mass].map(|keys| plain(keys, Over::Life, smooth));
                    let life = Life { drag: Some(drag), mass: Some(mass), ..Life::default() };
                    let [k, m] = Ages::of(Varied::exactly(2.0)).most_braked(&life, brake, 0.5);
                    let rate = |i: u16| {
                        let of = |factor: Varying<'_>| f64::from(factor.from.at(f32::from(i) / 20_000.0));
                        brake(of(drag)) / (0.5 * of(mass))
                    };
                    let most = (0..=20_000).map(rate).fold(0.0, f64::max);
                    // Just before a jump no sample may lie.
                    assert!((most..=most * slack * 1.002).contains(&(k / m)), "{k} / {m}, not {most}: {smooth} {all}");
                }
            }
        }
        // Sides are chosen apart, and of different measures nothing is known of the moment.
        let [low, high] = [[[0.0, 1.0]], [[0.0, 4.0]]];
        let both = Varying { to: Some(plain(&high, Over::Life, false).from), ..plain(&low, Over::Life, false) };
        let life = Life { drag: Some(both), mass: Some(both), ..Life::default() };
        assert_eq!(Ages::of(Varied::exactly(1.0)).most_braked(&life, |factor| factor, 2.0), [4.0, 2.0]);
        let mixed = Life {
            drag: Some(plain(&rising, Over::Life, false)),
            mass: Some(plain(&rising, Over::Seconds, false)),
            ..Life::default()
        };
        assert_eq!(Ages::of(Varied::exactly(1.0)).most_braked(&mixed, |factor| factor, 2.0), [9.0, 2.0]);
    }
}
