//! Every index against looking at every pair: the same rows, the same distances, to the last bit.

use core::fmt::Display;
use pointmass::Vec3;
use pointmass::index::{AnyIndex, Cost, Neighbour, SpatialIndex, Structure, TooSmall};
use pointmass_tests::points::{Oracle, Spread, extent, shuffle};
use pointmass_tests::{Random, f64s, gap, often};
use proptest::prelude::*;
use proptest::sample::select;

const INF: f32 = f32::INFINITY;

/// How many of the nearest are asked for.
const SOME: [usize; 3] = [0, 1, 8];

/// Memory that was in use before.
fn memory(words: usize) -> Vec<u32> {
    (0..words).map(|i| 0xdead_beef ^ (i as u32).wrapping_mul(0x9e37_79b9)).collect()
}

/// What an index of some points has to answer.
struct Expected<'a> {
    oracle: &'a Oracle,
    radius: f32,
    near: Vec<(Vec3, Vec<Neighbour>)>,
    others: Vec<Vec<Neighbour>>,
}

impl<'a> Expected<'a> {
    fn new(oracle: &'a Oracle, radius: f32, centers: &[Vec3]) -> Self {
        let near = centers.iter().map(|&center| (center, oracle.near(center, radius))).collect();
        Self { oracle, radius, near, others: oracle.all_near(radius) }
    }

    /// Asks everything.
    fn compare(&self, index: &dyn SpatialIndex, what: &dyn Display) {
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
fn centers(points: &[Vec3], seed: u64) -> Vec<Vec3> {
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
fn check(points: &[Vec3], reaches: &[f32], radii: &[f32]) {
    let (oracle, centers) = (Oracle::new(points), centers(points, 1));
    let expected: Vec<_> = radii.iter().map(|&radius| Expected::new(&oracle, radius, &centers)).collect();
    for &structure in Structure::ALL {
        let mut memory = memory(structure.words(points.len()));
        let mut index = structure.index(&mut memory);
        for reach in reaches {
            index.build(points, *reach).expect("the memory is made for so many");
            expected.iter().for_each(|expected| expected.compare(&index, &format!("{structure} of reach {reach:e}")));
            assert!(index.stats().bytes <= 4 * structure.words(points.len()), "{structure}: {:?}", index.stats());
        }
    }
}

/// Holds an index that has been built already against brute force.
fn compare(index: &AnyIndex<'_>, oracle: &Oracle, radii: &[f32], centers: &[Vec3], what: &dyn Display) {
    radii.iter().for_each(|&radius| Expected::new(oracle, radius, centers).compare(index, what));
}

/// A set of points that fits into a line of a failed test's message.
#[derive(Clone, Copy, Debug)]
struct Set {
    spread: Spread,
    n: usize,
    seed: u64,
    /// Factor.
    size: f32,
    /// How far from the origin, in sizes: coordinates are rounded the more.
    offset: f32,
    /// One in so many rows is the same as another, or not finite; zero: none.
    copies: usize,
    unsound: usize,
}

impl Set {
    fn points(self) -> Vec<Vec3> {
        let mut points = self.spread.points(self.n, self.seed);
        let mut random = Random::new(!self.seed);
        let offset = random.vector(self.offset);
        points.iter_mut().for_each(|point| *point = (*point + offset) * self.size);
        let mut one_in = |n: usize| n > 0 && (random.word() as usize).is_multiple_of(n);
        for row in 0..self.n {
            if one_in(self.copies) {
                points[row] = points[row / 2];
            }
            if one_in(self.unsound) {
                points[row][row % 3] = [f32::NAN, INF, -INF][row / 3 % 3];
            }
        }
        points
    }
}

fn sets(most: usize) -> impl Strategy<Value = Set> {
    let size = prop_oneof![4 => Just(1.0f32), 1 => select(&[0.1, 1e-12, 1e-30, 1e-41, 1e12, 1e30, 1e38][..])];
    let offset = select(&[0.0f32, 0.0, 0.0, 3.0, 1e3, 1e6][..]);
    let one_in = || select(&[0usize, 0, 30, 3][..]);
    (select(&Spread::ALL[..]), 0..most, any::<u64>(), size, offset, one_in(), one_in()).prop_map(
        |(spread, n, seed, size, offset, copies, unsound)| {
            // The largest stay finite.
            let offset = if size > 1e37 { offset.min(2.0) } else { offset };
            Set { spread, n, seed, size, offset, copies, unsound }
        },
    )
}

/// A radius for a set of points.
#[derive(Clone, Copy, Debug)]
enum Radius {
    Is(f32),
    /// This part of the set's extent.
    Part(f32),
    /// The distance between two of its points, and so many units in the last place more.
    Gap(usize, usize, i32),
}

impl Radius {
    fn of(self, points: &[Vec3]) -> f32 {
        let at = |i: usize| points.get(i % points.len().max(1)).copied().unwrap_or_default();
        match self {
            Self::Is(radius) => radius,
            Self::Part(part) => extent(points) * part,
            Self::Gap(a, b, ulps) => {
                let gap = gap(f64s(at(a)), f64s(at(b))) as f32;
                if gap > 0.0 && gap < 1e38 { f32::from_bits(gap.to_bits().saturating_add_signed(ulps)) } else { 0.5 }
            }
        }
    }
}

fn radii() -> impl Strategy<Value = Radius> {
    prop_oneof![
        1 => select(&[0.0, 1e-30, 1e-3, INF][..]).prop_map(Radius::Is),
        3 => (-3.0f32..0.5).prop_map(|power| Radius::Part(10f32.powf(power))),
        2 => (any::<usize>(), any::<usize>(), -1..=1).prop_map(|(a, b, ulps)| Radius::Gap(a, b, ulps)),
    ]
}

/// Reaches to build with: none, the radius itself, and others.
fn reaches() -> impl Strategy<Value = f32> {
    select(&[0.0f32, 1.0, 1.0, 0.1, 10.0][..])
}

fn config(cases: usize) -> ProptestConfig {
    ProptestConfig { cases: often(cases) as u32, failure_persistence: None, ..ProptestConfig::default() }
}

proptest! {
    #![proptest_config(config(1000))]

    #[test]
    fn all_answer_like_brute_force(set in sets(200), radius in radii(), reach in reaches()) {
        let points = set.points();
        let radius = radius.of(&points);
        check(&points, &[reach * radius], &[radius]);
    }
}

proptest! {
    #![proptest_config(config(400))]

    /// The same memory takes one set after another, and follows points wherever they go.
    #[test]
    fn the_past_leaves_no_trace(
        sets in prop::collection::vec((sets(120), any::<bool>()), 2..5), radius in radii(), reach in reaches()
    ) {
        let sets: Vec<_> = sets.into_iter().map(|(set, build)| (set.points(), build)).collect();
        for &structure in Structure::ALL {
            let most = sets.iter().map(|(points, _)| points.len()).max().unwrap_or(0);
            let mut memory = memory(structure.words(most));
            let mut index = structure.index(&mut memory);
            for (i, (points, build)) in sets.iter().enumerate() {
                let radius = radius.of(points);
                let done = if *build { index.build(points, reach * radius) } else { index.refit(points) };
                prop_assert_eq!(done, Ok(()));
                let what = format!("{structure}, set {i}");
                compare(&index, &Oracle::new(points), &[radius], &centers(points, 2), &what);
            }
        }
    }

    /// Points that drift, jump, vanish and come back.
    #[test]
    fn refitting_is_as_good_as_building(
        set in sets(120),
        moves in prop::collection::vec((select(&Move::ALL[..]), any::<u64>()), 1..5),
        radius in radii(),
        reach in reaches(),
    ) {
        let start = set.points();
        for &structure in Structure::ALL {
            let mut memory = memory(structure.words(start.len()));
            let mut index = structure.index(&mut memory);
            let mut points = start.clone();
            index.build(&points, reach * radius.of(&points)).expect("the memory is made for so many");
            for (by, seed) in &moves {
                by.apply(&mut points, &start, *seed);
                index.refit(&points).expect("the memory is made for so many");
                let what = format!("{structure} after {by:?}");
                compare(&index, &Oracle::new(&points), &[radius.of(&points)], &centers(&points, 3), &what);
            }
        }
    }

    /// What is found does not depend on the rows that points are in.
    #[test]
    fn rows_may_be_in_any_order(set in sets(150), radius in radii(), reach in reaches()) {
        let points = set.points();
        let radius = radius.of(&points);
        let mut row_of: Vec<usize> = (0..points.len()).collect();
        shuffle(&mut row_of, &mut Random::new(set.seed));
        let shuffled: Vec<Vec3> = row_of.iter().map(|&row| points[row]).collect();
        for &structure in Structure::ALL {
            let (mut pairs, gaps) = pairs_and_gaps(structure, &points, reach * radius, radius);
            let (mut others, other_gaps) = pairs_and_gaps(structure, &shuffled, reach * radius, radius);
            others.iter_mut().for_each(|pair| *pair = pair.map(|row| row_of[row]));
            for pairs in [&mut pairs, &mut others] {
                pairs.iter_mut().for_each(|pair| pair.sort_unstable());
                pairs.sort_unstable();
            }
            prop_assert_eq!(pairs, others, "{}", structure);
            for (gap, &row) in other_gaps.iter().zip(&row_of) {
                prop_assert_eq!(*gap, gaps[row], "{}", structure);
            }
        }
    }
}

/// All pairs, and for every row how far the nearest other is.
fn pairs_and_gaps(structure: Structure, points: &[Vec3], reach: f32, radius: f32) -> (Vec<[usize; 2]>, Vec<f32>) {
    let mut memory = memory(structure.words(points.len()));
    let mut index = structure.index(&mut memory);
    index.build(points, reach).expect("the memory is made for so many");
    let (mut pairs, mut gaps) = (vec![], vec![-1.0; points.len()]);
    let _ = index.pairs(radius, &mut |row, others| {
        pairs.extend(others.iter().map(|&other| [row as usize, other as usize]));
    });
    let _ = index.all_nearest(radius, &mut [Neighbour::default()], &mut |row, found| {
        gaps[row as usize] = found[0].distance;
    });
    (pairs, gaps)
}

/// What may happen to points between two looks.
#[derive(Clone, Copy, Debug)]
enum Move {
    Nothing,
    Drift,
    Shuffle,
    Grow,
    Explode,
    Collapse,
    Spoil,
    Restore,
    Lose,
    Empty,
}

impl Move {
    const ALL: [Self; 10] = [
        Self::Nothing,
        Self::Drift,
        Self::Shuffle,
        Self::Grow,
        Self::Explode,
        Self::Collapse,
        Self::Spoil,
        Self::Restore,
        Self::Lose,
        Self::Empty,
    ];

    fn apply(self, points: &mut Vec<Vec3>, start: &[Vec3], seed: u64) {
        let mut random = Random::new(seed);
        let size = extent(points);
        match self {
            Self::Nothing => {}
            Self::Drift => points.iter_mut().for_each(|point| *point += random.vector(0.01 * size.min(1e37))),
            Self::Shuffle => shuffle(points, &mut random),
            Self::Grow => points.iter_mut().for_each(|point| *point *= 3.0),
            // As far as it stays finite.
            Self::Explode => points.iter_mut().for_each(|point| *point *= (1e37 / size).min(1e25)),
            Self::Collapse => {
                let one = points.first().copied().unwrap_or_default();
                points.fill(one);
            }
            Self::Spoil => points.iter_mut().step_by(7).for_each(|point| point.y = f32::NAN),
            Self::Restore => points.clone_from(&start.to_vec()),
            Self::Lose => points.truncate(points.len() / 2),
            Self::Empty => points.clear(),
        }
    }
}

/// Numbers that no square of an `f32` can hold, equal points, points in a line, none at all, and the like.
fn awkward() -> Vec<(&'static str, Vec<Vec3>)> {
    let cube = |n: usize, half: f32, seed: u64| -> Vec<Vec3> {
        let mut random = Random::new(seed);
        (0..n).map(|_| random.vector(half)).collect()
    };
    let with = |points: Vec<Vec3>, more: &[Vec3]| [&points[..20], more, &points[20..]].concat();
    let powers = || (-126..=126).step_by(6).map(|power| 2f32.powi(power));
    let extremes = [Vec3::splat(f32::MAX), Vec3::splat(f32::MIN), Vec3::X * f32::MAX, Vec3::ZERO];
    vec![
        ("none", vec![]),
        ("one", vec![Vec3::new(1.0, -2.0, 3.0)]),
        ("nothing sound", vec![Vec3::NAN, Vec3::X * INF, Vec3::new(0.0, 0.0, -INF)]),
        ("one sound", vec![Vec3::NAN, Vec3::ONE, Vec3::NAN]),
        ("two equal", vec![Vec3::ONE; 2]),
        ("all at the origin", vec![Vec3::ZERO; 50]),
        ("all equal", vec![Vec3::new(0.1, 0.2, 0.3); 150]),
        ("all equal and huge", vec![Vec3::new(1e30, -3e38, 0.3); 50]),
        ("all equal and tiny", vec![Vec3::new(1e-40, 0.0, 1e-45); 50]),
        ("two places", [[Vec3::ZERO; 60], [Vec3::X; 60]].concat()),
        ("neighbours in the last place", [[Vec3::ONE; 40], [Vec3::new(1.0, 1.0, 1.000_000_1); 40]].concat()),
        ("most equal", with(cube(40, 1.0, 1), &[Vec3::splat(0.25); 60])),
        ("five times each", cube(14, 1.0, 2).repeat(5)),
        ("zeros of both signs", [Vec3::ZERO, -Vec3::ZERO, Vec3::X, Vec3::new(-0.0, 1.0, 0.0)].repeat(6)),
        ("on an axis", cube(60, 1.0, 3).iter().map(|point| Vec3::Z * point.z).collect()),
        ("on a diagonal", cube(60, 1.0, 4).iter().map(|point| Vec3::splat(point.z)).collect()),
        ("on a plane", cube(60, 1.0, 5).iter().map(|point| Vec3 { x: 0.7, ..*point }).collect()),
        ("huge", cube(60, 1e30, 6)),
        ("as huge as can be", cube(60, 3.4e38, 7)),
        ("tiny", cube(60, 1e-30, 8)),
        ("subnormal", cube(60, 1e-40, 9)),
        ("hardly there", cube(60, 1e-44, 10)),
        ("far from the origin", cube(60, 1.0, 11).iter().map(|point| *point + Vec3::splat(3e5)).collect()),
        ("close but for one", with(cube(60, 1.0, 12), &[Vec3::splat(1e3)])),
        ("close but for some", with(cube(60, 1.0, 13), &[Vec3::X * 1e9, Vec3::Y * -1e8, Vec3::ONE * 1e7])),
        ("close but for a huge one", with(cube(60, 1.0, 14), &[Vec3::X * 1e30])),
        ("close but for the hugest", with(cube(60, 1.0, 15), &extremes)),
        ("beside what is not finite", with(cube(60, 1.0, 16), &[Vec3::NAN, Vec3::X * INF, Vec3::Y * -INF])),
        ("closer than a square can tell", with(cube(40, 1e-22, 17), &[Vec3::X, Vec3::Y])),
        ("powers of two", powers().map(|x| Vec3::new(x, 0.0, 0.0)).collect()),
        ("powers of two on a diagonal", powers().flat_map(|x| [Vec3::splat(x), Vec3::splat(-x)]).collect()),
        ("ever closer", (0..100).map(|i| Vec3::new(0.7f32.powi(i), 1.0, 0.9f32.powi(i))).collect()),
    ]
}

#[test]
fn awkward_points_are_points() {
    for (name, points) in awkward() {
        println!("{name}");
        let size = extent(&points).min(1e38);
        let spacing = size / (points.len().max(1) as f32).cbrt();
        check(&points, &[0.0, 0.1 * spacing], &[0.0, spacing, INF]);
        check(&points, &[spacing, 1e-6 * spacing], &[1e-30, 0.3 * spacing, size]);
    }
}

#[test]
fn senseless_lengths_find_nothing_and_harm_nobody() {
    let points = Spread::Cube.points(50, 1);
    check(&points, &[f32::NAN, -1.0, INF, -INF, f32::MAX, f32::MIN_POSITIVE, 1e-45, -0.0], &[0.3]);
    check(&points, &[0.3], &[f32::NAN, -0.1, -INF, -0.0, -1e-45, f32::MAX, 1e-45]);
}

/// Enough points for whatever only happens in large sets.
#[test]
fn many_points_are_found_too() {
    let n = if cfg!(debug_assertions) { 250 } else { 2000 };
    for spread in Spread::ALL {
        println!("{spread:?}");
        let points = spread.points(n, 5);
        let spacing = extent(&points) / (n as f32).cbrt();
        check(&points, &[spacing], &[spacing, 0.2]);
        check(&points, &[0.1 * spacing], &[2.0 * spacing]);
        check(&points, &[0.0], &[0.01]);
    }
}

#[test]
fn an_index_that_was_not_built_is_empty() {
    let (oracle, points) = (Oracle::new(&[]), Spread::Cube.points(10, 0));
    for &structure in Structure::ALL {
        let mut memory = memory(structure.words(10));
        let mut index = structure.index(&mut memory);
        compare(&index, &oracle, &[0.0, 1.0, INF], &centers(&points, 0), &structure);
        index.refit(&points).expect("the memory is made for so many");
        compare(&index, &Oracle::new(&points), &[0.3], &centers(&points, 0), &structure);
    }
}

/// Whatever the memory: it is too small and the index is empty, or every answer is right.
#[test]
fn memory_is_enough_or_said_to_be_too_small() {
    let mut points = Spread::Cube.points(24, 3);
    points[7] = Vec3::NAN;
    points.extend([points[3]; 6]);
    let (sound, centers) = (points.len() - 1, [points[0], Vec3::ZERO]);
    let [none, all] = [&[][..], &points].map(Oracle::new);
    let [none, all] = [&none, &all].map(|oracle| [0.2, INF].map(|radius| Expected::new(oracle, radius, &centers)));
    for &structure in Structure::ALL {
        let mut least = 0;
        for words in 0..structure.words(points.len()) + 20 {
            let mut memory = memory(words);
            let mut index = structure.index(&mut memory);
            for reach in [0.2, 0.0] {
                let what = format!("{structure} in {words} words, reach {reach}");
                match index.build(&points, reach) {
                    Ok(()) => {
                        all.iter().for_each(|expected| expected.compare(&index, &what));
                        assert!(index.stats().bytes <= 4 * words, "{what}: {:?}", index.stats());
                    }
                    Err(TooSmall { points: wanted, room }) => {
                        assert_eq!(wanted, sound, "{what}");
                        assert!(
                            room < wanted && room >= least && words < structure.words(points.len()),
                            "{what}: {room}"
                        );
                        least = room;
                        none.iter().for_each(|expected| expected.compare(&index, &what));
                        assert_eq!(index.build(&points[..room], reach), Ok(()), "{what}: {room} points");
                        assert_eq!(index.refit(&points), Err(TooSmall { points: wanted, room }), "{what}");
                        none.iter().for_each(|expected| expected.compare(&index, &what));
                    }
                }
            }
        }
        // The next point takes a few words, not many.
        assert!(least >= sound / 2, "{structure}: room for {least} at the most");
    }
}

#[test]
fn the_more_memory_the_more_points() {
    for &structure in Structure::ALL {
        for n in [0, 1, 2, 3, 7, 8, 9, 63, 64, 65, 100] {
            let words = structure.words(n);
            assert!(words <= structure.words(n + 1), "{structure}");
            let points = Spread::Clusters.points(n, 9);
            let mut memory = memory(words);
            assert_eq!(structure.index(&mut memory).build(&points, 0.1), Ok(()), "{structure} of {n}");
        }
    }
}

/// A box whose opposite faces are one.
#[derive(Clone, Copy, Debug)]
struct Torus {
    low: Vec3,
    sides: Vec3,
    n: usize,
    seed: u64,
}

impl Torus {
    fn shortest(self) -> f32 {
        self.sides.to_array().into_iter().filter(|&side| side > 0.0).fold(INF, f32::min)
    }

    /// A third of the points close together, some on the faces and next to them, many outside.
    fn points(self) -> Vec<Vec3> {
        let mut random = Random::new(self.seed);
        let around = Vec3::select(self.sides.cmpgt(Vec3::ZERO), self.sides, Vec3::ONE);
        let mut point = |i: usize| match i % 6 {
            0 | 1 => self.low + random.vector(0.1) * around,
            2 => self.low + around * (random.vector(1.5) * 2.0).round(),
            3 => self.low + around * random.vector(1.5).round() * (1.0 + random.between(-3e-7, 3e-7)),
            4 => self.low + around * (random.vector(0.5) + 0.5),
            _ => self.low + around * random.vector(4.0),
        };
        (0..self.n).map(&mut point).collect()
    }

    fn check(self, parts: &[f32], reach: f32) {
        let (points, shortest) = (self.points(), self.shortest());
        let radii: Vec<f32> = parts.iter().map(|part| if shortest < INF { part * shortest } else { *part }).collect();
        let oracle = Oracle::periodic(&points, self.low, self.sides);
        let centers =
            [centers(&points, 4), vec![self.low, self.low + self.sides, self.low + self.sides * 0.5]].concat();
        let expected: Vec<_> = radii.iter().map(|&radius| Expected::new(&oracle, radius, &centers)).collect();
        for &structure in Structure::ALL {
            let mut memory = memory(structure.words(points.len()));
            let mut index = structure.periodic(&mut memory, self.low, self.sides);
            index.build(&points, reach * radii[0]).expect("the memory is made for so many");
            expected.iter().for_each(|expected| expected.compare(&index, &format!("periodic {structure}")));
            let moved: Vec<Vec3> = points.iter().map(|point| *point + self.sides * 0.3).collect();
            index.refit(&moved).expect("the memory is made for so many");
            let oracle = Oracle::periodic(&moved, self.low, self.sides);
            compare(&index, &oracle, &radii[..1], &centers, &format!("periodic {structure}, moved"));
        }
    }
}

proptest! {
    #![proptest_config(config(500))]

    #[test]
    fn opposite_faces_are_one(
        low in prop_oneof![Just(Vec3::ZERO), Just(Vec3::new(-0.3, 7.1, 0.01)), Just(Vec3::splat(1e3))],
        sides in prop::array::uniform3(select(&[0.0f32, 1.0, 1.0, 2.0, 0.25, 0.7, 3.3, 11.0][..])),
        size in prop_oneof![6 => Just(1.0f32), 1 => select(&[1e-30f32, 1e-12, 1e12, 1e30][..])],
        n in 0usize..120,
        seed in any::<u64>(),
        part in prop_oneof![4 => (-2.0f32..0.3).prop_map(|power| 10f32.powf(power)), 1 => select(&[0.0, 0.5, 0.499_999_97, INF][..])],
        reach in reaches(),
    ) {
        Torus { low: low * size, sides: Vec3::from(sides) * size, n, seed }.check(&[part], reach);
    }
}

#[test]
fn boxes_may_be_open_and_flat() {
    for sides in [[1.0, 1.0, 1.0], [1.0, 0.0, 0.0], [0.0, 4.0, 0.5], [1e-3, 1.0, 1e3], [0.0; 3]] {
        let torus = Torus { low: Vec3::ZERO, sides: sides.into(), n: 80, seed: 6 };
        torus.check(&[0.1, 0.0, 0.49, 0.5, 0.51, 2.0, INF, f32::NAN, -1.0], 1.0);
    }
}

/// Sides that are not lengths are no sides.
#[test]
fn senseless_sides_are_open() {
    let points = Spread::Cube.points(40, 2);
    for (low, side) in [(0.0, 0.0), (0.0, -1.0), (0.0, f32::NAN), (0.0, INF), (f32::NAN, 1.0), (-INF, 1.0)] {
        for &structure in Structure::ALL {
            let mut memory = memory(structure.words(points.len()));
            let mut index = structure.periodic(&mut memory, Vec3::splat(low), Vec3::splat(side));
            index.build(&points, 0.2).expect("the memory is made for so many");
            let what = format!("{structure}, a side of {side} from {low} on");
            compare(&index, &Oracle::new(&points), &[0.2, 2.0], &centers(&points, 5), &what);
        }
    }
}

#[test]
fn structures_go_by_their_names() {
    for &structure in Structure::ALL {
        assert_eq!(structure.to_string().parse(), Ok(structure));
        assert_eq!(structure.index(&mut []).stats().points, 0, "{structure}");
        assert_eq!(structure.index(&mut []).build(&[], 1.0), Ok(()), "{structure}");
    }
    let unknown = "kdtree".parse::<Structure>().expect_err("there is none").to_string();
    assert!(Structure::ALL.iter().all(|structure| unknown.contains(structure.name())), "{unknown}");
}
