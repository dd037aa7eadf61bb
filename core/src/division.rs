//! How rows are divided among threads.

/// So many rows, in parts of about the same size.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Division {
    rows: usize,
    parts: usize,
}

impl Division {
    /// So many parts, at least one.
    pub(crate) fn new(rows: usize, parts: usize) -> Self {
        Self { rows, parts: parts.max(1) }
    }

    /// A part for each thread of the pool that this one belongs to, or fewer, so that each has so many rows at least; one part if there is no
    /// pool.
    #[cfg(feature = "rayon")]
    pub(crate) fn among_threads(rows: usize, share: usize) -> Self {
        let threads = rayon::current_thread_index().map_or(1, |_| rayon::current_num_threads());
        Self::new(rows, threads.min(rows / share.max(1)))
    }

    /// The number of parts.
    pub(crate) fn parts(self) -> usize {
        self.parts
    }

    /// The row with which a part begins, or at which the last one ends: so many parts' share of the rows, rounded down.
    pub(crate) fn start(self, part: usize) -> usize {
        let (each, more) = (self.rows / self.parts, self.rows % self.parts);
        each * part + more * part / self.parts
    }
}

#[cfg(test)]
mod tests {
    use super::Division;

    #[test]
    fn parts_are_even_and_make_up_the_whole() {
        for (rows, parts) in (0..70).flat_map(|rows| (0..12).map(move |parts| (rows, parts))) {
            let division = Division::new(rows, parts);
            assert_eq!((division.start(0), division.start(division.parts())), (0, rows));
            for part in 0..division.parts() {
                let len = division.start(part + 1) - division.start(part);
                assert!(len == rows / division.parts() || len == rows.div_ceil(division.parts()), "{rows} in {parts}");
            }
        }
    }

    #[test]
    fn twice_as_many_parts_divide_each_in_two() {
        for (rows, parts) in (0..70).flat_map(|rows| (1..12).map(move |parts| (rows, parts))) {
            let (coarse, fine) = (Division::new(rows, parts), Division::new(rows, 2 * parts));
            (0..=parts).for_each(|part| assert_eq!(coarse.start(part), fine.start(2 * part)));
        }
    }
}
