//! The list of bodies that may touch each other, made anew when one has gone far.

use super::super::Bodies;
use super::ball::Ball;
use super::balls::{self, Around};
use super::beside::{Beside, Ways};
use super::body::Body;
use super::forms::Forms;
use super::kept::{Kept, Lists, Sizes, words};
use super::manifold::Manifold;
use super::narrow::are_near;
use super::scenery::max_travel;
use super::sleep;
use crate::lanes::{ABREAST, run_abreast};
use crate::least;
use crate::material::of_two;
use crate::math::{length, max};
use crate::memory::{take, take_vectors};
use glam::Vec3;

/// Lists all that may touch before one of them has gone as far as it may, and looks where they do; tells whether any body is awake or the list is
/// new.
pub(super) fn gather(
    bodies: &mut Bodies<'_>,
    kept: &mut Kept<'_>,
    forms: Forms<'_>,
    scratch: &mut [u32],
    is_news: bool,
) -> bool {
    let (h, step) = (bodies.substep.seconds(), bodies.substep.step.seconds());
    let mut is_over = is_news || kept.lists.known == 0;
    let first = kept.first_ball();
    let mut is_awake = kept.bodies[1..].iter().any(Body::is_awake);
    let awake = if is_awake { first } else { 0 };
    for body in kept.bodies[..awake].iter_mut().filter(|body| body.is_awake()) {
        body.whirl = length(body.omega) * body.radius;
        let way = (length(body.velocity) + body.whirl) * h;
        body.max_travel -= way;
        is_over |= !(body.max_travel >= way);
    }
    if !kept.balls.is_empty() {
        is_over |= bodies.substep.number == 0 || balls::are_far(bodies, kept, h);
    }
    if is_over {
        for (body, number) in kept.bodies[..first].iter_mut().zip(0..) {
            body.max_travel = if body.moves() { max_travel(body, forms.count(number) > 1, step) } else { 0.0 };
        }
        list(bodies, kept, forms, scratch);
        is_awake = kept.bodies[1..].iter().any(Body::is_awake);
    }
    let Kept { lists, bodies: all, pairs, .. } = kept;
    lists.awake = u32::from(is_awake);
    if !is_awake {
        return is_over;
    }
    look(all, &mut pairs[..lists.pairs as usize], forms, h);
    true
}

/// Looks where pairs touch that may have gone as far as they may without that, or will in a sub-step of `h` \[s\]: boxes as many at a time as go
/// side by side.
fn look(all: &[Body], pairs: &mut [Manifold], forms: Forms<'_>, h: f32) {
    let mut due = heapless::Vec::<(u32, f32), ABREAST>::new();
    let (mut some, mut number) = (heapless::Vec::<u32, ABREAST>::new(), 0);
    while number < pairs.len() {
        some.clear();
        while number < pairs.len() && !some.is_full() {
            if pairs[number].bodies.iter().any(|&number| all[number as usize].is_awake()) {
                let _ = some.push(number as u32);
            }
            number += 1;
        }
        let ways = run_abreast(Ways { bodies: all, pairs, numbers: &some, h });
        for (&number, way) in some.iter().zip(ways) {
            let pair = &mut pairs[number as usize];
            if !(pair.spare <= if pair.count == 0 { 2.0 * way } else { way }) {
                pair.spare -= way;
            } else if !forms.are_boxes(pair.bodies) {
                pair.find(pair.bodies.map(|number| &all[number as usize]), forms, 2.0 * way);
                pair.spare -= way;
            } else {
                if due.is_full() {
                    look_at_boxes(all, pairs, &due);
                    due.clear();
                }
                let _ = due.push((number, way));
            }
        }
    }
    look_at_boxes(all, pairs, &due);
}

/// Looks where pairs of boxes touch: those with some numbers, which go so far against each other \[m\].
fn look_at_boxes(all: &[Body], pairs: &mut [Manifold], due: &[(u32, f32)]) {
    let mut numbers = [[0; 2]; ABREAST];
    for (place, &(number, _)) in numbers.iter_mut().zip(due) {
        *place = pairs[number as usize].bodies;
    }
    let gaps = run_abreast(Beside { bodies: all, pairs: &numbers[..due.len()], bound: [f32::MAX; ABREAST] });
    for (lane, &(number, way)) in due.iter().enumerate() {
        let pair = &mut pairs[number as usize];
        pair.find_boxes(pair.bodies.map(|number| &all[number as usize]), (&gaps, lane), 2.0 * way);
        pair.spare -= way;
    }
}

/// Makes the list. Those that were in the list before go on with what they have.
fn list(bodies: &mut Bodies<'_>, kept: &mut Kept<'_>, forms: Forms<'_>, scratch: &mut [u32]) {
    let count = forms.boxes.len();
    let sizes = Sizes { bodies: count, particles: 0, balls: kept.balls.len(), more: 0 };
    let mut rest = scratch;
    let rows = take(&mut rest, if kept.balls.is_empty() { 0 } else { bodies.len() });
    let middles = take_vectors(&mut rest, count);
    let candidates: &mut [[u32; 2]] = bytemuck::cast_slice_mut(take(&mut rest, 2 * sizes.candidates()));
    let found = invite(bodies, kept, forms, (middles, rows), candidates);
    let candidates = &mut candidates[..found];
    mark_far(kept.bodies, forms, candidates);
    sort(candidates, kept.bodies.len(), rest);
    // The old list, beside the new one.
    let old = kept.lists.pairs as usize;
    let room = rest.len() - rest.len() % words::<Manifold>();
    let before: &mut [Manifold] = bytemuck::cast_slice_mut(&mut rest[..room]);
    let Some(before) = before.get_mut(..old) else { return };
    before.iter_mut().zip(&*kept.pairs).for_each(|(before, pair)| before.take(pair));
    let len = admit(bodies, kept, forms, candidates, before);
    sleep::miss(kept.bodies, before, &kept.pairs[..len]);
    *kept.lists = Lists { name: kept.lists.name, pairs: len as u32, known: 1, ..bytemuck::Zeroable::zeroed() };
}

/// Writes down the numbers of all two that may touch, in whatever order, and the lowest of more than there is room for; returns how many that are.
fn invite(
    bodies: &mut Bodies<'_>,
    kept: &mut Kept<'_>,
    forms: Forms<'_>,
    (middles, rows): (&mut [Vec3], &mut [u32]),
    candidates: &mut [[u32; 2]],
) -> usize {
    let (all, mut widest) = (&*kept.bodies, 0.0);
    for (middle, body) in middles.iter_mut().zip(&all[1..]) {
        *middle = if body.is_there() { body.center } else { Vec3::NAN };
        if body.is_there() && body.radius + body.max_travel < f32::INFINITY {
            widest = max(widest, body.radius + body.max_travel);
        }
    }
    let (mut found, is_less) = (0, |one: &[u32; 2], other: &[u32; 2]| one < other);
    let report = &mut *bodies.report;
    bodies.near.pairs(middles, 2.0 * widest, &mut |row, other| {
        let [a, b] = [row.min(other) + 1, row.max(other) + 1];
        let [one, two] = [a, b].map(|number| &all[number as usize]);
        let reach = one.radius + two.radius + one.max_travel + two.max_travel;
        if !(one.moves() || two.moves()) || !(length(one.center - two.center) <= reach) {
            return;
        }
        report.caps.contacts += u64::from(least::put(candidates, &mut found, [a, b], is_less));
    });
    if !kept.balls.is_empty() {
        let mut left_out = 0;
        balls::invite(bodies, kept, forms, Around { middles, widest, rows }, &mut |pair| {
            left_out += u64::from(least::put(candidates, &mut found, pair, is_less));
        });
        bodies.report.caps.contacts += left_out;
    }
    found
}

/// A bit of the second number of two boxes that are farther apart than they may go before the lists are made anew.
const FAR: u32 = 1 << 31;

/// Marks boxes that are farther apart than they may go before the lists are made anew.
fn mark_far(all: &[Body], forms: Forms<'_>, candidates: &mut [[u32; 2]]) {
    for some in candidates.chunks_mut(ABREAST) {
        let mut bound = [0.0; ABREAST];
        for (bound, numbers) in bound.iter_mut().zip(&*some) {
            let [a, b] = numbers.map(|number| &all[number as usize]);
            *bound = a.max_travel + b.max_travel;
        }
        let gaps = run_abreast(Beside { bodies: all, pairs: some, bound });
        for (lane, numbers) in some.iter_mut().enumerate() {
            if !gaps.is_near(lane) && forms.are_boxes(*numbers) {
                numbers[1] |= FAR;
            }
        }
    }
}

/// Brings candidates among so many bodies into the order of their numbers: by counting, if there is memory for that.
fn sort(candidates: &mut [[u32; 2]], bodies: usize, memory: &mut [u32]) {
    if let Some((starts, rest)) = memory.split_at_mut_checked(bodies + 1)
        && let Some(room) = rest.get_mut(..2 * candidates.len())
    {
        let other = bytemuck::cast_slice_mut(room);
        count_out(candidates, other, starts, |&[_, b]| b & !FAR);
        count_out(other, candidates, starts, |&[a, _]| a);
    } else {
        candidates.sort_unstable_by_key(|&[a, b]| u64::from(a) << 32 | u64::from(b & !FAR));
    }
}

/// Writes some down in the order of their keys, which are less than the number of `starts`; of those with one key as they come.
fn count_out(from: &[[u32; 2]], to: &mut [[u32; 2]], starts: &mut [u32], key: impl Fn(&[u32; 2]) -> u32) {
    starts.fill(0);
    for pair in from {
        if let Some(count) = starts.get_mut(key(pair) as usize) {
            *count += 1;
        }
    }
    let mut next = 0;
    for start in &mut *starts {
        next += core::mem::replace(start, next);
    }
    for pair in from {
        let Some(start) = starts.get_mut(key(pair) as usize) else { continue };
        if let Some(place) = to.get_mut(*start as usize) {
            *place = *pair;
        }
        *start += 1;
    }
}

/// Takes into the list who of the candidates is near enough; returns how many that are. Those that were in it before go on with what they have.
fn admit(
    bodies: &mut Bodies<'_>,
    kept: &mut Kept<'_>,
    forms: Forms<'_>,
    candidates: &[[u32; 2]],
    before: &[Manifold],
) -> usize {
    let Kept { bodies: all, pairs, balls, .. } = kept;
    let (mut before, mut len) = (before.iter().peekable(), 0);
    for &[a, b] in candidates {
        let (numbers, is_far) = ([a, b & !FAR], b & FAR != 0);
        let ball = (numbers[1] as usize).checked_sub(forms.boxes.len() + 1).and_then(|ball| balls.get(ball));
        let pair = numbers.map(|number| &all[number as usize]);
        let [a, b] = pair;
        let counts = numbers.map(|number| forms.count(number));
        for pieces in (0..counts[0]).flat_map(|a| (0..counts[1]).map(move |b| [a, b])) {
            let key = (numbers, pieces);
            while before.next_if(|pair| pair.key() < key).is_some() {}
            let known = before.peek().filter(|pair| pair.key() == key && !ball.is_some_and(Ball::is_new));
            let holds = known.is_some_and(|pair| pair.count > 0);
            let are_apart = || {
                let both = [0, 1].map(|side| forms.piece(numbers[side], pieces[side]));
                is_far || !forms.are_boxes(numbers) && !are_near(pair, both, a.max_travel + b.max_travel)
            };
            let is_near_ball = ball.is_some() && counts == [1; 2];
            if !is_near_ball && !holds && are_apart() {
                continue;
            }
            let Some(place) = pairs.get_mut(len) else {
                bodies.report.caps.contacts += 1;
                continue;
            };
            len += 1;
            match known {
                Some(known) => place.take(known),
                None => {
                    let materials = [a.material, b.material].map(|number| (number as u16).checked_sub(1));
                    place.take(&Manifold::of(key, of_two(bodies.materials, [a.elasticity, b.elasticity], materials)));
                }
            }
            if ball.is_some() {
                // Whatever else has moved the ball: where it touches is looked for again.
                place.spare = 0.0;
            }
        }
    }
    len
}
