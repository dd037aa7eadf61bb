//! The answers that an index has to give, and checks that it does.

use super::INF;
use core::fmt::Display;
use pointmass::Vec3;
use pointmass::index::{AnyIndex, Cost, Neighbour, SpatialIndex, Structure};
use pointmass_tests::Random;
use pointmass_tests::fields::used;
use pointmass_tests::points::{Oracle, extent};

/// The numbers of nearest points that are asked for.
const SOME: [usize; 3] = [0, 1, 8];

/// The answers that an index of some points has to give.
pub(crate) struct Expected<'a> {
    oracle: &'a Oracle,
    radius: f32,
    near: Vec<(Vec3, Vec<Neighbour>)>,
    others: Vec<Vec<Neighbour>>,
}

impl<'a> Expected<'a> {
    pub(crate) fn new(oracle: &'a Oracle, radius: f32, centers: &[Vec3]) -> Self {
        let near = centers.iter().map(|&center| (center, oracle.near(center, radius))).collect();
        Self { oracle, radius, near, others: oracle.all_near(radius) }
    }

    /// Asks everything.
    pub(crate) fn compare(&self, index: &dyn SpatialIndex, what: &dyn Display) {
        let what = format!("{what}, radius {:e}", self.radius);
        self.compare_points(index, &what);
        for (center, near) in &self.near {
            self.compare_one(index, *center, near, &format!("{what}, center {center}"));
        }
        self.compare_counts(index, &what);
        self.compare_neighbours(index, &what);
        self.compare_pairs(index, &what);
        for n in SOME.into_iter().chain([self.oracle.rows() + 1]) {
            self.compare_all_nearest(index, n, &what);
        }
    }

    fn compare_points(&self, index: &dyn SpatialIndex, what: &str) {
        let sound: Vec<u32> = self.oracle.sound().collect();
        let stats = index.stats();
        assert_eq!([stats.points, stats.skipped], [sound.len(), self.oracle.rows() - sound.len()], "{what}");
        assert!(stats.fullest <= stats.points, "{what}: {stats:?}");
        assert_eq!(sorted(index.order()), sound, "{what}: order");
    }

    fn compare_one(&self, index: &dyn SpatialIndex, center: Vec3, near: &[Neighbour], what: &str) {
        let cost = index.count(center, self.radius);
        found(cost, near.len(), &format!("{what}: count"));
        let mut rows = vec![];
        let cost = index.within(center, self.radius, &mut |run| {
            assert!(!run.is_empty(), "{what}: within: an empty run");
            rows.extend_from_slice(run);
        });
        assert_eq!(sorted(&rows), rows_of(near), "{what}: within");
        found(cost, near.len(), &format!("{what}: within"));
        for n in SOME.into_iter().chain([self.oracle.rows() + 1]) {
            let mut list = vec![Neighbour { row: 77, distance: f32::NAN }; n];
            let cost = index.nearest(center, self.radius, &mut list);
            let expected = &near[..near.len().min(n)];
            assert_eq!(&list[..(cost.found as usize).min(n)], expected, "{what}: nearest {n}");
            found(cost, expected.len(), &format!("{what}: nearest {n}"));
        }
    }

    fn compare_counts(&self, index: &dyn SpatialIndex, what: &str) {
        let expected: Vec<u32> = self.others.iter().map(|others| others.len() as u32).collect();
        let total = expected.iter().sum::<u32>() as usize;
        // Room for too few rows, for all, and for others that do not exist.
        for room in [expected.len() / 2, expected.len(), expected.len() + 3] {
            let mut counts = vec![u32::MAX; room];
            let cost = index.counts(self.radius, &mut counts);
            let padded: Vec<u32> = expected.iter().copied().chain([0; 3]).take(room).collect();
            assert_eq!(counts, padded, "{what}: counts of {room} rows");
            found(cost, total, &format!("{what}: counts"));
        }
    }

    fn compare_neighbours(&self, index: &dyn SpatialIndex, what: &str) {
        let mut lists: Vec<(u32, Vec<u32>)> = vec![];
        let cost = index.neighbours(self.radius, &mut |row, others| {
            assert!(!others.is_empty(), "{what}: neighbours of {row}: an empty run");
            match lists.last_mut() {
                Some((last, rows)) if *last == row => rows.extend_from_slice(others),
                _ => lists.push((row, others.to_vec())),
            }
        });
        // The runs of each row in one piece, the rows in the index's order.
        let rows: Vec<u32> = lists.iter().map(|(row, _)| *row).collect();
        let with_others = |row: &u32| !self.others[*row as usize].is_empty();
        assert_eq!(rows, index.order().iter().copied().filter(with_others).collect::<Vec<_>>(), "{what}: neighbours");
        for (row, others) in &lists {
            assert_eq!(sorted(others), rows_of(&self.others[*row as usize]), "{what}: neighbours of {row}");
        }
        found(cost, lists.iter().map(|(_, others)| others.len()).sum(), &format!("{what}: neighbours"));
    }

    /// Asks for the neighbours of some points after the other, in order, and says whether that has been answered to the end.
    pub(crate) fn compare_in_order(&self, index: &dyn SpatialIndex, what: &dyn Display) -> bool {
        let (order, what) = (index.order(), format!("{what}, radius {:e}: in order", self.radius));
        let mut lists = vec![None; order.len()];
        let cuts = [0, order.len() / 7, order.len() / 3, order.len() / 2, order.len() + 7];
        let whole = cuts.windows(2).all(|cut| {
            index.in_order(cut[0]..cut[1], self.radius, &mut |place, others| {
                assert!((cut[0]..cut[1]).contains(&place) && lists[place].is_none(), "{what}: {place} of {cut:?}");
                lists[place] = Some(others.iter().map(|&other| order[other as usize]).collect::<Vec<_>>());
            })
        });
        for (list, &row) in lists.iter().zip(order).filter(|(list, _)| whole || list.is_some()) {
            let expected = rows_of(&self.others[row as usize]);
            assert_eq!(list.as_deref().unwrap_or_default(), expected, "{what}: row {row}");
        }
        whole
    }

    fn compare_pairs(&self, index: &dyn SpatialIndex, what: &str) {
        let mut pairs = vec![];
        let cost = index.pairs(self.radius, &mut |row, others| {
            assert!(!others.is_empty(), "{what}: pairs of {row}: an empty run");
            pairs.extend(others.iter().map(|&other| (row.min(other), row.max(other))));
        });
        pairs.sort_unstable();
        assert_eq!(pairs, self.pairs(), "{what}: pairs");
        found(cost, pairs.len(), &format!("{what}: pairs"));
    }

    fn compare_all_nearest(&self, index: &dyn SpatialIndex, n: usize, what: &str) {
        let what = format!("{what}: all_nearest {n}");
        let mut lists = vec![vec![]; self.oracle.rows()];
        let (mut room, mut total) = (vec![Neighbour::default(); n], 0);
        let cost = index.all_nearest(self.radius, &mut room, &mut |row, nearest| {
            assert!(lists[row as usize].is_empty(), "{what}: row {row} twice");
            lists[row as usize] = nearest.to_vec();
            total += nearest.len();
        });
        for (row, others) in self.others.iter().enumerate() {
            assert_eq!(lists[row], others[..others.len().min(n)], "{what}: row {row}");
        }
        found(cost, total, &what);
        assert!(n > 0 || cost == Cost::default(), "{what}: {cost:?} for nothing");
    }

    fn pairs(&self) -> Vec<(u32, u32)> {
        let mut pairs = vec![];
        for (row, others) in (0..).zip(&self.others) {
            pairs.extend(others.iter().filter(|other| row < other.row).map(|other| (row, other.row)));
        }
        pairs.sort_unstable();
        pairs
    }
}

fn found(cost: Cost, n: usize, what: &str) {
    assert_eq!(cost.found, n as u64, "{what}: {cost:?}");
    assert!(cost.tests >= cost.found, "{what}: {cost:?}");
}

fn sorted(rows: &[u32]) -> Vec<u32> {
    let mut rows = rows.to_vec();
    rows.sort_unstable();
    rows
}

fn rows_of(near: &[Neighbour]) -> Vec<u32> {
    let mut rows: Vec<u32> = near.iter().map(|near| near.row).collect();
    rows.sort_unstable();
    rows
}

/// Places to ask at: at points, between them, around them, far away and nowhere.
pub(crate) fn centers(points: &[Vec3], seed: u64) -> Vec<Vec3> {
    let mut random = Random::new(seed);
    let sound: Vec<Vec3> = points.iter().copied().filter(|point| point.is_finite()).collect();
    let (first, size) = (sound.first().copied().unwrap_or_default(), extent(&sound));
    let mut pick = || sound.get(random.word() as usize % sound.len().max(1)).copied().unwrap_or_default();
    let mut centers = vec![pick(), pick() * 0.5 + pick() * 0.5, first + Vec3::X * size * 1e3];
    centers.extend([first + random.vector(size.min(1e37)), Vec3::splat(-1e30), Vec3::Y * f32::MAX]);
    centers.extend([Vec3::NAN, Vec3::Z * INF]);
    centers
}

/// Builds every structure in just enough memory and asks it everything.
pub(crate) fn check(points: &[Vec3], reaches: &[f32], radii: &[f32]) {
    let (oracle, centers) = (Oracle::new(points), centers(points, 1));
    let expected: Vec<_> = radii.iter().map(|&radius| Expected::new(&oracle, radius, &centers)).collect();
    for &structure in Structure::ALL {
        let mut memory = used(structure.words(points.len()));
        let mut index = structure.index(&mut memory);
        for reach in reaches {
            index.build(points, *reach).expect("the memory is made for so many");
            for expected in &expected {
                let what = format!("{structure} of reach {reach:e}");
                expected.compare(&index, &what);
                assert!(expected.compare_in_order(&index, &what) || points.len() > 100, "{what}");
            }
            assert!(index.stats().bytes <= 4 * structure.words(points.len()), "{structure}: {:?}", index.stats());
        }
    }
}

/// Holds an index that has been built already against brute force.
pub(crate) fn compare(index: &AnyIndex<'_>, oracle: &Oracle, radii: &[f32], centers: &[Vec3], what: &dyn Display) {
    for &radius in radii {
        let expected = Expected::new(oracle, radius, centers);
        expected.compare(index, what);
        expected.compare_in_order(index, what);
    }
}
