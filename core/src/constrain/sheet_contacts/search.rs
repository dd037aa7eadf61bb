//! Who comes near whom in a sub-step.

use super::super::Bodies;
use super::super::contacts::Touch;
use super::closest::{Kind, MARGIN};
use super::contact::Contact;
use super::lists::{Kept, Work};
use super::look::{Look, SHARE};
use super::near::pushed;
use super::renew::ready;
use super::rest::Rest;
use super::tree::Ways;
use crate::lanes::{ABREAST, LANES};
use crate::material::of_two;
use crate::math::max;
use glam::Vec3;

/// Lists whatever comes near on the way from where all were to where they are now, and says how far each may be pushed from there
/// before that changes. Contacts known before keep what they have done. Returns how many would pass each other.
pub(super) fn search(rest: &Rest<'_>, kept: &mut Kept<'_>, work: &mut Work<'_>, bodies: &mut Bodies<'_>) -> u32 {
    let known = kept.counts.contacts as usize;
    work.old[..known].copy_from_slice(&kept.contacts[..known]);
    let drift = drift(work);
    let astray = ready(rest, kept, work, bodies, drift);
    let found = look(rest, kept, work, astray);
    let has_room = kept.near.as_ref().is_some_and(|near| !near.facts.is_full());
    bodies.report.effort.streamed += u64::from(astray.is_none() && !has_room);
    bodies.report.caps.contacts += found.lost;
    let contacts = &mut kept.contacts[..found.count];
    let meetings = found.meetings - let_be(contacts, kept.weight);
    arrange(contacts, bytemuck::cast_slice_mut(work.searched));
    let count = thin(contacts, work.now);
    kept.counts.contacts = count as u32;
    let mut old = work.old[..known].iter().peekable();
    for contact in &mut kept.contacts[..count] {
        let key = contact.key();
        while old.next_if(|old| old.key() < key).is_some() {}
        match old.peek().filter(|old| old.key() == key) {
            Some(old) => (contact.touch, contact.tangent) = (old.touch, old.tangent),
            None => contact.touch = touch(bodies, contact.sides().map(|side| kept.rows[side] as usize)),
        }
    }
    meetings
}

/// Says of those that would pass each other and can do nothing about it, since all of them is fixed, that they do not; returns their number.
fn let_be(contacts: &mut [Contact], weight: &[f32]) -> u32 {
    let stuck = contacts.iter_mut().filter(|contact| contact.meets() && !(contact.ease(weight) > 0.0));
    stuck.map(|contact| contact.meets = 0).count() as u32
}

/// The numbers of what a search finds: contacts, those that find no room, and those who would pass each other.
struct Found {
    count: usize,
    lost: u64,
    meetings: u32,
    /// Those that are close, if they have been listed.
    close: Option<usize>,
}

/// Looks at all who may come near each other: by lists and at the triangles astray, of which there are so many, or all anew without lists.
fn look(rest: &Rest<'_>, kept: &mut Kept<'_>, work: &mut Work<'_>, astray: Option<usize>) -> Found {
    let found = look_at(rest, kept, work, astray, ABREAST < LANES);
    if let Some((near, count)) = kept.near.as_mut().zip(found.close) {
        near.close(count, work.now);
    }
    // Which of them find room is for the order to say in which a search of all meets them one by one.
    let is_said = ABREAST < LANES && astray.is_none();
    if found.lost > 0 && !is_said { look_at(rest, kept, work, None, true) } else { found }
}

/// The same, one by one or side by side.
fn look_at(rest: &Rest<'_>, kept: &mut Kept<'_>, work: &mut Work<'_>, astray: Option<usize>, alone: bool) -> Found {
    let budget = rest.facts.budget;
    work.room.fill(2.0 * SHARE * budget);
    let (from, now) = (&*work.from, &*work.now);
    let uniform = kept.counts.uniform();
    let (near, free, more): (_, &mut [_], _) = match &mut kept.near {
        Some(near) if astray.is_some() => (Some(&*near), &mut [], 0.0),
        Some(near) if !alone => (None, near.pairs, 2.0 * pushed(rest)),
        _ => (None, &mut [], 0.0),
    };
    let mut look = Look::new((rest, uniform), [from, now], work.room, kept.contacts, (free, more), alone);
    if let Some(near) = near {
        let all = near.pairs(rest, work.tree.strays());
        all.for_each(|listed| look.at(listed.pair, listed.pair.corners(rest.faces), listed.wanted));
        look.finish();
    }
    if astray != Some(0) {
        work.tree.fit((rest, uniform), Ways { from, to: now }, |half| (half + budget) * (1.0 + MARGIN) + 0.5 * more);
        work.tree.pairs(rest.faces, astray.is_none(), |pair, corners| look.at(pair, corners, f32::NAN));
        look.finish();
    }
    Found { count: look.count, lost: look.lost, meetings: look.meetings, close: look.closed() }
}

/// Puts contacts in the order of their keys: those of each first corner to their places first, as their numbers tell (McIlroy, Bostic and McIlroy,
/// "Engineering Radix Sort", Computing Systems 6, 1993), then these few among themselves. It takes two words for each particle, lent to it.
fn arrange(contacts: &mut [Contact], words: &mut [u32]) {
    let first = |contact: &Contact| contact.corners[0] as usize;
    let (next, ends) = words.split_at_mut(words.len() / 2);
    ends.fill(0);
    contacts.iter().for_each(|contact| ends[first(contact)] += 1);
    let mut sum = 0;
    for (next, end) in next.iter_mut().zip(&mut *ends) {
        *next = sum;
        sum += *end;
        *end = sum;
    }
    for corner in 0..next.len() {
        while next[corner] < ends[corner] {
            let place = next[corner] as usize;
            let own = first(&contacts[place]);
            contacts.swap(place, next[own] as usize);
            next[own] += 1;
        }
    }
    contacts.chunk_by_mut(|a, b| first(a) == first(b)).for_each(|some| some.sort_unstable_by_key(Contact::key));
}

/// Leaves out points at the rim of a triangle that are nearer to another one there: in a plane they are over that one, and pushes askew
/// would brake them from triangle to triangle. Returns how many contacts are left.
fn thin(contacts: &mut [Contact], now: &[Vec3]) -> usize {
    let (mut left, mut first) = (0, 0);
    while first < contacts.len() {
        let point = contacts[first].corners[0];
        let count = contacts[first..].iter().take_while(|contact| contact.corners[0] == point).count();
        let group = &contacts[first..first + count];
        // What more there is stays.
        let idle = (0..count.min(64)).fold(0u64, |idle, i| idle | u64::from(is_idle(&group[i], group, now)) << i);
        for i in 0..count {
            if i >= 64 || idle >> i & 1 == 0 {
                contacts[left] = contacts[first + i];
                left += 1;
            }
        }
        first += count;
    }
    left
}

/// Tells whether a point is nearer to another triangle that has the corner or edge of this one which it is nearest to.
fn is_idle(contact: &Contact, others: &[Contact], now: &[Vec3]) -> bool {
    let points = |contact: &Contact| contact.split == Kind::PointTriangle.split() as u32 && !contact.meets();
    let rim = || contact.corners.iter().zip(contact.weights).skip(1).filter(|&(_, weight)| weight != 0.0);
    if !points(contact) || rim().count() == 3 {
        return false;
    }
    let far = |contact: &Contact| contact.between(|i| now[i]).dot(contact.normal);
    let own = far(contact);
    others
        .iter()
        .any(|other| points(other) && rim().all(|(corner, _)| other.corners[1..].contains(corner)) && far(other) < own)
}

/// The touch of particles in two rows, which does nothing as yet.
fn touch(bodies: &Bodies<'_>, [a, b]: [usize; 2]) -> Touch {
    let of_both = [a, b].map(|row| bodies.material[row].checked_sub(1));
    let mut touch = Touch::new(of_two(bodies.materials, [bodies.elasticity[a], bodies.elasticity[b]], of_both));
    touch.begin(0.0);
    touch
}

/// The mean way of all \[m\].
fn drift(work: &Work<'_>) -> Vec3 {
    let ways = work.now.iter().zip(&*work.from).map(|(now, from)| *now - *from);
    let (sum, count) =
        ways.filter(|way| way.is_finite()).fold((Vec3::ZERO, 0.0), |(sum, count), way| (sum + way, count + 1.0));
    sum / max(count, 1.0)
}

#[cfg(test)]
mod tests {
    use super::super::lists;
    use super::*;
    use alloc::{vec, vec::Vec};
    use bytemuck::Zeroable;

    const COUNTS: [usize; 2] = [61, 48];

    /// A heap of triangles of two sheets that move on a little, some of them through each other, all of whose corners and edges are their own.
    fn heap(rest: &mut Rest<'_>, work: &mut Work<'_>, seed: u32) {
        let mut state = seed;
        let mut next = |most: u32| {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            (state >> 16) % most
        };
        let mut vector = |size: f32| Vec3::from([0; 3].map(|_| size * (next(1000) as f32 / 1000.0 - 0.5)));
        rest.facts.budget = 0.01;
        for i in 0..COUNTS[0] {
            rest.places[i] = vector(10.0);
            work.from[i] = vector(0.5);
            work.now[i] = work.from[i] + vector(0.1);
            (rest.half[i], rest.sheet[i]) = (0.02, (i / 30) as u32);
        }
        for face in &mut *rest.faces {
            // The last particle is no corner.
            let first = next(COUNTS[0] as u32 - 3);
            *face = bytemuck::cast([first, first + 1, first + 2, 63]);
        }
    }

    /// The outcome of a search where so many have room: by `look`, or one by one; as bits, contacts in their order or in that of their keys.
    fn found(seed: u32, room: usize, alone: bool, astray: bool, sorted: bool) -> (usize, u64, u32, Vec<u32>) {
        let demand = lists::demand(COUNTS);
        let [mut fixed, mut step, mut scratch] =
            [demand.kept, demand.step, demand.scratch].map(|words| vec![0u32; words.fixed]);
        let mut rest = Rest::of(&mut fixed, COUNTS).expect("the memory is asked for");
        let mut kept = Kept::of(&mut step, COUNTS).expect("the memory is asked for");
        let mut work = Work::of(&mut scratch, COUNTS).expect("the memory is asked for");
        heap(&mut rest, &mut work, seed);
        kept.counts.compare(&rest);
        let mut contacts = vec![Contact::zeroed(); room];
        kept.contacts = &mut contacts;
        let all = work.tree.mark(rest.faces, |_| f32::INFINITY);
        let Found { count, lost, meetings, .. } = if alone {
            look_at(&rest, &mut kept, &mut work, None, true)
        } else {
            look(&rest, &mut kept, &mut work, astray.then_some(all))
        };
        let mut bits: Vec<u32> = work.room.iter().map(|room| room.to_bits()).collect();
        if sorted {
            contacts[..count].sort_by_key(Contact::key);
        }
        bits.extend_from_slice(bytemuck::cast_slice(&contacts[..count]));
        (count, lost, meetings, bits)
    }

    #[test]
    fn side_by_side_the_same_contacts_find_room_as_one_by_one() {
        let mut unsure = 0;
        for seed in 0..6 {
            let (all, lost, meetings, _) = found(seed, 10_000, true, false, true);
            assert!(all > 100 && lost == 0, "{all} {lost}");
            unsure += meetings;
            for room in [0, 1, 7, 8, 9, 40, all / 2, all - 1, all, all + 1] {
                let one_by_one = found(seed, room, true, false, room >= all);
                assert_eq!(one_by_one.0, room.min(all));
                for astray in [false, true] {
                    let side_by_side = found(seed, room, false, astray, room >= all);
                    assert!(one_by_one == side_by_side, "{seed}, room for {room} of {all}, {astray}");
                }
            }
        }
        assert!(unsure > 10, "{unsure}");
    }

    // Who goes one by one lists nobody.
    #[cfg(not(one_by_one))]
    #[test]
    fn who_is_close_is_known_after_pushes() {
        let (mut close, mut astray_most, mut meetings_most) = (0, 0, 0);
        for seed in 0..12 {
            let demand = lists::demand(COUNTS);
            let [mut fixed, mut step, mut scratch] =
                [demand.kept, demand.step, demand.scratch].map(|words| vec![0u32; words.fixed]);
            let mut rest = Rest::of(&mut fixed, COUNTS).expect("the memory is asked for");
            let mut kept = Kept::of(&mut step, COUNTS).expect("the memory is asked for");
            let mut work = Work::of(&mut scratch, COUNTS).expect("the memory is asked for");
            heap(&mut rest, &mut work, seed);
            let mut contacts = vec![Contact::zeroed(); 10_000];
            let mut pairs = vec![super::super::near::Listed::zeroed(); 100_000];
            kept.contacts = &mut contacts;
            kept.counts.compare(&rest);
            kept.near.as_mut().expect("the memory is asked for").pairs = &mut pairs;
            close += look(&rest, &mut kept, &mut work, None).close.expect("there is room");
            let far = pushed(&rest);
            for pushes in 1..4 {
                // Most are pushed by less than brings anybody near who is not close, some by more.
                for (i, now) in work.now.iter_mut().enumerate() {
                    let far = if (i + seed as usize).is_multiple_of(7) { 5.0 * far } else { 0.3 * far };
                    *now += Vec3::new(1.0, -1.0, 1.0) * [far, -far][(i + pushes) % 2] / 1.8;
                }
                let drift = drift(&work);
                let near = kept.near.as_ref().expect("the memory is asked for");
                let astray = near.follow_close(&rest, &mut work, drift);
                let mut outcome = |kept: &mut Kept<'_>, alone: bool| {
                    let found = match alone {
                        true => look_at(&rest, kept, &mut work, None, true),
                        false => look(&rest, kept, &mut work, Some(astray)),
                    };
                    let contacts = &mut kept.contacts[..found.count];
                    contacts.sort_by_key(Contact::key);
                    let mut bits: Vec<u32> = work.room.iter().map(|room| room.to_bits()).collect();
                    bits.extend_from_slice(bytemuck::cast_slice(contacts));
                    (found.count, found.lost, found.meetings, bits)
                };
                let (of_close, of_all) = (outcome(&mut kept, false), outcome(&mut kept, true));
                assert!(of_close == of_all, "{seed}, {pushes} pushes, {astray} astray: {} of {}", of_close.0, of_all.0);
                astray_most = astray.max(astray_most);
                meetings_most = of_all.2.max(meetings_most);
                assert!(astray < COUNTS[1], "{astray}");
            }
        }
        assert!(close > 1000 && astray_most > 5 && meetings_most > 0, "{close} {astray_most} {meetings_most}");
    }
}
