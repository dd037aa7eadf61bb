//! The graph of a shell's particles: who hangs together with whom; and coarser graphs of groups of these.

use crate::memory::take;

/// Particles from which on there are graphs: fewer are soon solved without.
const LEAST: usize = 16;
/// Graphs at the most.
pub(super) const LEVELS: usize = 8;
/// Members of a group.
const GROUP: usize = 6;
/// Whoever is in no group.
const NONE: u32 = u32::MAX;

/// The words that say how many graphs there are, and of each how many rows and links it has.
const HEAD: usize = 1 + 2 * LEVELS;

/// Room for graphs, by the numbers of particles, triangles and hinges.
#[derive(Clone, Copy)]
pub(super) struct Room {
    /// Rows of the finest, and of all others together.
    pub(super) rows: [usize; 2],
    /// Their links: each edge is two.
    pub(super) links: [usize; 2],
    /// Links of those of the finest that bend together.
    pub(super) far: usize,
}

/// Tells whether shells of so many particles, triangles and hinges are to be solved by graphs.
pub(super) fn asked([particles, triangles, _]: [usize; 3]) -> bool {
    particles >= LEAST && triangles > 0
}

impl Room {
    pub(super) fn of([particles, triangles, hinges]: [usize; 3]) -> Self {
        let all = [particles, triangles, hinges];
        if !asked(all) || all.iter().any(|&of| of > NONE as usize / 64) {
            return Self { rows: [0; 2], links: [0; 2], far: 0 };
        }
        // A hinge is an edge that two triangles share.
        let edges = 3 * triangles - hinges.min(triangles + triangles / 2);
        // Groups are a fifth of their members, and have about as many links each.
        // Edges, corners across a hinge, and those beyond two hinges of a triangle.
        let far = 2 * (edges + hinges + 3 * triangles.min(hinges));
        Self { rows: [particles, particles / 3 + 4], links: [2 * edges, edges / 2 + 16], far }
    }

    /// Words for the graphs.
    pub(super) fn words(&self) -> usize {
        let [rows, links] = [self.rows, self.links].map(|[fine, coarse]| fine + coarse);
        if rows == 0 { 0 } else { HEAD + 2 * rows + LEVELS + links }
    }
}

/// A graph.
#[derive(Clone, Copy, Default)]
pub(super) struct Graph<'m> {
    /// Where the links of each row begin, and where the last one's end.
    pub(super) starts: &'m [u32],
    /// The rows that they lead to: of each in ascending order.
    pub(super) links: &'m [u32],
    /// The row of the next graph that stands for each.
    pub(super) into: &'m [u32],
}

impl<'m> Graph<'m> {
    /// The graphs in words, finest first; none, where there are none.
    pub(super) fn all(words: &'m [u32]) -> [Self; LEVELS] {
        let (head, mut rest) = words.split_at(words.len().min(HEAD));
        let count = head.first().map_or(0, |&count| count as usize);
        let mut next = |len: usize| {
            let (first, others) = rest.split_at(rest.len().min(len));
            rest = others;
            first
        };
        core::array::from_fn(|level| match head.get(1 + 2 * level..3 + 2 * level) {
            Some(&[rows, links]) if level < count => {
                let rows = rows as usize;
                Self { starts: next(rows + 1), links: next(links as usize), into: next(rows) }
            }
            _ => Self::default(),
        })
    }

    pub(super) fn rows(&self) -> usize {
        self.into.len()
    }

    /// Where the links of each row lie.
    #[inline(always)]
    pub(super) fn ranges(&self) -> impl DoubleEndedIterator<Item = core::ops::Range<usize>> + ExactSizeIterator + 'm {
        self.starts.windows(2).map(|ends| ends[0] as usize..ends[1] as usize)
    }

    /// Where the links of a row lie.
    #[inline(always)]
    pub(super) fn range(&self, row: usize) -> core::ops::Range<usize> {
        match (self.starts.get(row), self.starts.get(row + 1)) {
            (Some(&from), Some(&to)) => from as usize..to as usize,
            _ => 0..0,
        }
    }

    /// The rows that a row is linked with.
    #[inline(always)]
    pub(super) fn row(&self, row: usize) -> &'m [u32] {
        self.links.get(self.range(row)).unwrap_or(&[])
    }

    /// The number of the link from one row to another.
    #[inline(always)]
    pub(super) fn link(&self, from: usize, to: u32) -> Option<usize> {
        let range = self.range(from);
        let links = self.links.get(range.clone())?;
        let at = if links.len() <= 8 {
            links.iter().position(|&link| link == to)?
        } else {
            links.binary_search(&to).ok()?
        };
        Some(range.start + at)
    }
}

/// Makes the graphs of a mesh in words of their own, with others to work with. Without room for the finest there is none; where there is none
/// for a coarser one, that and all others are left out.
pub(super) fn make(room: &Room, triangles: &[[u32; 3]], words: &mut [u32], work: &mut [u32]) {
    words.fill(0);
    if words.len() < HEAD {
        return;
    }
    let (head, mut rest) = words.split_at_mut(HEAD);
    let mut rows = room.rows[0];
    let mut left = room.links;
    let mut coarser = room.rows[1];
    let mut last: Option<Graph<'_>> = None;
    for level in 0..LEVELS {
        if rest.len() <= rows {
            return;
        }
        let (starts, others) = core::mem::take(&mut rest).split_at_mut(rows + 1);
        let links = &mut left[usize::from(level > 0)];
        let (columns, _) = others.split_at_mut((*links).min(others.len()));
        let made = match last {
            None => link_corners(triangles, starts, columns, work),
            Some(fine) => link_groups(&fine, starts, columns, work),
        };
        let Some(made) = made else { return };
        *links -= made;
        let (columns, others) = others.split_at_mut(made);
        let (into, others) = others.split_at_mut(rows.min(others.len()));
        rest = others;
        head[1 + 2 * level] = rows as u32;
        head[2 + 2 * level] = made as u32;
        head[0] = level as u32 + 1;
        let graph = Graph { starts, links: columns, into: &[] };
        let groups = group(&graph, into);
        if made == 0 || groups > coarser || 4 * groups > 3 * rows {
            return;
        }
        coarser -= groups;
        rows = groups;
        last = Some(Graph { into, ..graph });
    }
}

/// Puts all into groups of about so many who hang together, in the order of their first members, and tells how many there are. Whoever is left
/// alone joins the first group beside him.
fn group(graph: &Graph<'_>, into: &mut [u32]) -> usize {
    into.fill(NONE);
    let mut groups = 0;
    for first in 0..into.len() {
        if into[first] != NONE {
            continue;
        }
        let mut members = [first; GROUP];
        let mut count = 1;
        into[first] = groups;
        while let Some(next) = nearest(graph, into, &members[..count]).filter(|_| count < GROUP) {
            into[next] = groups;
            members[count] = next;
            count += 1;
        }
        let beside = graph.row(first).iter().filter_map(|&row| into.get(row as usize)).min();
        match beside {
            Some(&beside) if count == 1 => into[first] = beside,
            _ => groups += 1,
        }
    }
    groups as usize
}

/// The particle in no group that hangs together with most of one: the first of several.
fn nearest(graph: &Graph<'_>, into: &[u32], members: &[usize]) -> Option<usize> {
    let mut best = None;
    for &member in members {
        for &row in graph.row(member) {
            if into.get(row as usize) != Some(&NONE) {
                continue;
            }
            let with = members.iter().filter(|&&member| graph.link(member, row).is_some()).count();
            if best.is_none_or(|(most, first)| with > most || (with == most && row < first)) {
                best = Some((with, row));
            }
        }
    }
    best.map(|(_, row)| row as usize)
}

/// The numbers of what belongs to each of so many rows: of the first, of the second ... and where those of each begin.
pub(super) fn sorted(
    rows: usize,
    pairs: impl Iterator<Item = (usize, u32)> + Clone,
    work: &mut [u32],
) -> Option<(&[u32], &[u32])> {
    let mut rest = work;
    let starts = take(&mut rest, rows + 2);
    if starts.len() < rows + 2 {
        return None;
    }
    starts.fill(0);
    for (row, _) in pairs.clone() {
        *starts.get_mut(row + 2)? += 1;
    }
    for row in 1..starts.len() {
        starts[row] += starts[row - 1];
    }
    for (row, number) in pairs {
        let next = starts.get_mut(row + 1)?;
        *rest.get_mut(*next as usize)? = number;
        *next += 1;
    }
    Some((starts, rest))
}

/// Links the corners of triangles, and tells with how many links, if there is room.
fn link_corners(triangles: &[[u32; 3]], starts: &mut [u32], links: &mut [u32], work: &mut [u32]) -> Option<usize> {
    let rows = starts.len() - 1;
    let corners = triangles.iter().enumerate().flat_map(|(face, corners)| corners.map(|c| (c as usize, face as u32)));
    let corners = corners.filter(|&(corner, _)| corner < rows);
    let (begin, faces) = sorted(rows, corners, work)?;
    link(starts, links, |row, add| {
        let faces = faces.get(begin[row] as usize..begin[row + 1] as usize)?;
        for corner in faces.iter().filter_map(|&face| triangles.get(face as usize)).flatten() {
            if (*corner as usize) < rows {
                add(*corner)?;
            }
        }
        Some(())
    })
}

/// Links groups of a finer graph, and tells with how many links, if there is room.
fn link_groups(fine: &Graph<'_>, starts: &mut [u32], links: &mut [u32], work: &mut [u32]) -> Option<usize> {
    let members = fine.into.iter().enumerate().map(|(row, &group)| (group as usize, row as u32));
    let (begin, members) = sorted(starts.len() - 1, members, work)?;
    link(starts, links, |group, add| {
        for &member in members.get(begin[group] as usize..begin[group + 1] as usize)? {
            for &row in fine.row(member as usize) {
                add(*fine.into.get(row as usize)?)?;
            }
        }
        Some(())
    })
}

/// Links each row with those that `visit` names, each once and in ascending order, and tells with how many links.
pub(super) fn link(
    starts: &mut [u32],
    links: &mut [u32],
    mut visit: impl FnMut(usize, &mut dyn FnMut(u32) -> Option<()>) -> Option<()>,
) -> Option<usize> {
    let mut end = 0;
    for row in 0..starts.len() - 1 {
        let from = end;
        starts[row] = from as u32;
        visit(row, &mut |other| {
            if other as usize == row {
                return Some(());
            }
            if let Err(place) = links[from..end].binary_search(&other) {
                links.get(end)?;
                links.copy_within(from + place..end, from + place + 1);
                links[from + place] = other;
                end += 1;
            }
            Some(())
        })?;
    }
    *starts.last_mut()? = end as u32;
    Some(end)
}
