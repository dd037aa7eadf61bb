//! What is drawn as lines: springs, the links of constraints, strands and ropes.

use super::{Cast, FULL_STRAIN};
use crate::show::Show;
use crate::style::Style;
use glam::Vec3;
use pointmass::draw::{Line, Lock, StrandLight, links_by_strain, springs, strands};
use pointmass::force::State;
use pointmass::scene::Model;

impl Cast<'_> {
    /// Tells whether springs and links are drawn whatever covers them.
    fn shows_springs(&self) -> bool {
        self.show.contains(&Show::Springs)
    }

    /// Tells whether nothing is to be seen of springs and links.
    fn hides_springs(&self) -> bool {
        self.style.is_some_and(|style| style != Style::Lines) && !self.shows_springs()
    }

    /// The strain at which lines are all red, or blue: grey whatever it is, unless it is asked for.
    fn full_strain(&self) -> f32 {
        let is_told = self.style.is_some() || self.shows_springs() || self.show.contains(&Show::Strain);
        if is_told { FULL_STRAIN } else { f32::INFINITY }
    }

    /// The springs as they are now, but for those of surfaces.
    pub(super) fn springs(&self, state: &State<'_>) -> Vec<Line> {
        if self.hides_springs() {
            return Vec::new();
        }
        let mut all = vec![Line::NONE; state.springs.springs.len()];
        let (count, _) = springs(state, self.full_strain(), &mut all);
        let is_covered = |number: &u32| self.covered.get(*number as usize).is_some_and(|&covered| covered);
        let held = state.springs.held().zip(all.iter().copied().take(count));
        held.filter(|(held, _)| self.shows_springs() || !held.spring.ends.iter().all(is_covered))
            .map(|(_, line)| line)
            .collect()
    }

    /// The links of constraints as they are now, but for those of ropes that are drawn as curves.
    pub(super) fn links(&self, state: &State<'_>, model: &Model) -> Vec<Line> {
        if self.hides_springs() {
            return Vec::new();
        }
        let curves = self.style.is_none() && !self.shows_springs();
        let ropes = if curves { model.ropes.len() } else { 0 };
        let ropes = &model.locks[model.locks.len() - ropes..];
        let kinds = model.constraints.0.iter();
        let pairs =
            kinds.flat_map(|kind| kind.links().zip(kind.lengths())).filter(|&(ends, _)| !is_segment(ropes, ends));
        let pairs: Vec<_> = pairs.collect();
        let mut all = vec![Line::NONE; pairs.len()];
        let (count, _) = links_by_strain(state, pairs.into_iter(), self.full_strain(), &mut all);
        all.truncate(count);
        all
    }

    /// Strands or a rope as curves: lit, or by their strain.
    pub(super) fn curves(&self, state: &State<'_>, lock: &Lock, light: &StrandLight, model: &Model) -> Vec<Line> {
        let mut all = vec![Line::NONE; (lock.count * lock.points) as usize];
        let (count, _) = if self.show.contains(&Show::Strain) {
            links_by_strain(state, at_rest(lock, model), FULL_STRAIN, &mut all)
        } else {
            strands(state, lock, light, &mut all)
        };
        all.truncate(count);
        all.iter_mut().for_each(|line| line.widths = [lock.width; 2]);
        all
    }
}

/// Tells whether a link is a segment of one of some ropes, of which each begins behind the one before.
fn is_segment(ropes: &[Lock], [a, b]: [u32; 2]) -> bool {
    let last = ropes.partition_point(|rope| rope.first <= a.min(b));
    let own = last.checked_sub(1).is_some_and(|last| a.max(b) - ropes[last].first < ropes[last].points);
    own && a.abs_diff(b) == 1
}

/// The segments of strands, and how long they are at rest: as the scene starts with them.
fn at_rest<'m>(lock: &'m Lock, model: &'m Model) -> impl Iterator<Item = ([u32; 2], f32)> + 'm {
    let segments = lock.points.saturating_sub(1);
    let roots = (0..lock.count).map(|strand| lock.first + strand * lock.points);
    roots.flat_map(move |root| (root..root + segments).map(|point| [point, point + 1])).map(|ends| {
        let [a, b] = ends.map(|end| model.particles.get(end as usize).map_or(Vec3::NAN, |particle| particle.position));
        (ends, a.distance(b))
    })
}
