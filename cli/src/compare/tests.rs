//! Tests of what a comparison makes of answers and figures that are known beforehand.

use super::bench::{limit, moved};
use super::contender::{Answer, Build, Contender, Effort, Own, Question, Scratch};
use super::distribution::Distribution;
use super::source::Source;
use super::study::{Case, Contestant, Figure, Subject};
use super::verify::{ASKED, Expected};
use super::workload::Workload;
use super::{advice, chart, page, sheet, study, text};
use crate::outcome::Outcome;
use crate::report::origin::{Machine, Origin, command};
use crate::report::plot;
use pointmass::Vec3;
use pointmass::index::{Cost, SpatialIndex, Structure};

/// A contender that tells lies about one query.
struct Liar<'m> {
    honest: Own<'m>,
    about: Workload,
    exact: bool,
    followed: bool,
}

impl Contender for Liar<'_> {
    fn is_exact(&self) -> bool {
        self.exact
    }
    fn build(&mut self, points: &[Vec3], reach: f32) -> Outcome {
        self.followed = false;
        self.honest.build(points, reach)
    }
    fn follow(&mut self, points: &[Vec3], reach: f32) -> Outcome {
        self.followed = true;
        self.honest.follow(points, reach)
    }
    fn built(&self) -> Build {
        self.honest.built()
    }
    fn run(&mut self, query: Workload, question: &Question<'_>, scratch: &mut Scratch) -> Option<Option<Cost>> {
        self.honest.run(query, question, scratch)
    }
    fn effort(&mut self, query: Workload, question: &Question<'_>, rows: &[usize]) -> Option<Effort> {
        self.honest.effort(query, question, rows)
    }
    fn answer(&mut self, query: Workload, question: &Question<'_>) -> Option<Answer> {
        let mut answer = self.honest.answer(query, question)?;
        // What has moved is counted.
        let lies = match self.about {
            Workload::Moving => self.followed && matches!(query, Workload::Moving | Workload::Count),
            about => query == about,
        };
        match &mut answer {
            _ if !lies => {}
            Answer::Counts(counts) => counts[17] += 40,
            Answer::Links(links) => links[17..].iter_mut().for_each(|link| *link ^= 1),
            Answer::Distances(distances) => distances[17 * question.k + 1] *= 1.001,
            Answer::Total(total) => *total += 1,
        }
        Some(answer)
    }
}

/// Verifies a liar among some points; what is said about it.
fn caught(about: Workload, exact: bool, exhaustive: bool) -> Option<String> {
    let points = Distribution::Mixed.points(400, 2);
    let moved = moved(&points, 0.1, 2);
    let question = Question { points: &points, moved: &moved, radius: 0.1, k: 5 };
    let [mut one, mut other] = [(); 2].map(|()| vec![0; Structure::Grid.words(400)]);
    let expected = if exhaustive {
        Expected::exhaustive(&question, &ASKED, 0..points.len())
    } else {
        let mut leader = Own::new(Structure::Grid, 400, &mut one);
        Expected::by(&mut leader, "grid", &question, &ASKED, 1).expect("the leader is right")
    };
    let honest = Own::new(Structure::Grid, 400, &mut other);
    let mut liar = Liar { honest, about, exact, followed: false };
    expected.check(&mut liar, "liar", &question, &ASKED).err().map(|failure| failure.to_string())
}

#[test]
fn a_wrong_answer_is_caught_and_the_row_named() {
    for about in ASKED {
        for exhaustive in [true, false] {
            let said = caught(about, true, exhaustive).unwrap_or_else(|| panic!("{about:?} was not caught"));
            assert!(said.starts_with(&format!("liar gives a wrong answer to {}, row 17", about.name())), "{said}");
            assert!(said.contains("expected") && said.contains("nothing was measured"), "{said}");
        }
        assert!(caught(about, false, true).is_some(), "{about:?} is more than rounding");
    }
    assert_eq!(caught(Workload::Build, true, true), None, "an honest one passes");
    assert_eq!(caught(Workload::Build, true, false), None, "an honest one passes");
}

#[test]
fn a_wrong_leader_is_caught_by_the_sample() {
    let points = Distribution::Uniform.points(60, 2);
    let moved = moved(&points, 0.2, 2);
    let question = Question { points: &points, moved: &moved, radius: 0.2, k: 5 };
    for about in [Workload::Count, Workload::Within, Workload::Nearest, Workload::Moving] {
        let mut memory = vec![0; Structure::Brute.words(60)];
        // Of 60 rows, the sample takes all.
        let honest = Own::new(Structure::Brute, 60, &mut memory);
        let mut liar = Liar { honest, about, exact: true, followed: false };
        let said =
            Expected::by(&mut liar, "liar", &question, &ASKED, 1).map(drop).map_err(|failure| failure.to_string());
        assert!(said.as_ref().is_err_and(|said| said.contains(about.name())), "{about:?}: {said:?}");
    }
}

#[test]
fn every_structure_passes_on_every_distribution_small_and_far() {
    let clouds = [
        Distribution::Uniform.points(300, 3),
        Distribution::Mixed.points(300, 3),
        Distribution::Line.points(300, 3),
        vec![Vec3::ONE; 40],
        Distribution::Clusters.points(200, 3).iter().map(|point| *point * 1e30).collect(),
        Distribution::Clusters.points(200, 3).iter().map(|point| *point * 1e-30).collect(),
    ];
    for points in clouds {
        let mut memory = Vec::new();
        let radius = super::radius::radius_for(&points, 12.0, &mut memory).expect("there is a radius");
        let moved = moved(&points, radius, 1);
        let question = Question { points: &points, moved: &moved, radius, k: 7 };
        let expected = Expected::exhaustive(&question, &ASKED, 0..points.len());
        for &structure in Structure::ALL {
            memory.resize(memory.len().max(structure.words(points.len())), 0);
            let mut own = Own::new(structure, points.len(), &mut memory);
            let checked = expected.check(&mut own, structure.name(), &question, &ASKED);
            assert!(checked.is_ok(), "{:?}", checked.map_err(|failure| failure.to_string()));
            assert_eq!(own.index().stats().points, points.len());
        }
    }
}

/// A case in which everybody takes so long, for `count`.
pub(super) fn case(n: usize, times: &[(&str, f64)]) -> Case {
    let figure = |median: f64, workload| Figure::new(workload, vec![median; 5], Some([1.0, 40.0, 30.0]));
    let contestant = |(name, median): &(&str, f64)| Contestant {
        name: name.to_string(),
        left_out: None,
        mismatches: None,
        build: Build { bytes_each: Some(20.0), ..Build::default() },
        figures: vec![figure(10.0, Workload::Build), figure(*median, Workload::Count)],
    };
    let mut case = Case {
        subject: Subject::Points,
        of: "a<b & \"c\"".into(),
        about: "made up".into(),
        n,
        radius: 0.1,
        neighbours: Some(30.0),
        queries: None,
        verified: "verified".into(),
        rounds: 5,
        contestants: times.iter().map(contestant).collect(),
    };
    case.rank();
    case
}

fn study_of(cases: Vec<Case>) -> super::Study {
    super::Study {
        origin: Origin { version: "0".into(), command: String::new(), machine: Machine::this() },
        seed: 1,
        k: 8,
        growth: study::growths(&cases),
        crossovers: study::crossovers(&cases),
        advice: advice::advise(&cases),
        notes: Vec::new(),
        cases,
    }
}

#[test]
fn ratios_and_ties_are_held_against_the_best() {
    let case = case(100, &[("a", 102.0), ("b", 100.0), ("c", 150.0)]);
    let of = |name: &str| {
        let one = case.contestants.iter().find(|one| one.name == name);
        one.and_then(|one| one.figure(Workload::Count)).map(|figure| (figure.ratio, figure.ties))
    };
    assert_eq!([of("a"), of("b"), of("c")], [Some((1.02, true)), Some((1.0, true)), Some((1.5, false))]);
    // The same medians, but samples that are all over the place.
    let wild = |median: f64| Figure::new(Workload::Count, vec![median * 0.5, median, median * 1.5], None);
    assert!(wild(100.0).is_like(&wild(140.0)) && !wild(100.0).is_like(&wild(400.0)));
}

#[test]
fn nobody_slower_than_one_told_apart_ties_with_the_best() {
    let mut case = case(100, &[("bvh", 100.0), ("brute", 124.0), ("quadtree", 142.0)]);
    let advised = |case: &Case| advice::advise(std::slice::from_ref(case))[0].text.clone();
    case.contestants[2].figures[1] = Figure::new(Workload::Count, vec![100.0, 142.0, 190.0], None);
    case.rank();
    let ties: Vec<_> = case.ranking(Workload::Count).iter().map(|(_, figure)| figure.ties).collect();
    assert_eq!(ties, [true, false, false]);
    let text = advised(&case);
    assert!(text.starts_with("use bvh: 100 ns a point; brute takes 1.24 times as long"), "{text}");
    // Where brute cannot be told apart either, the share is that of the slowest of those named.
    case.contestants[1].figures[1] = Figure::new(Workload::Count, vec![90.0, 124.0, 160.0], None);
    case.rank();
    let text = advised(&case);
    assert!(text.starts_with("use any of bvh, brute, quadtree: 100 ns a point, and they are within 42 %"), "{text}");
}

#[test]
fn every_report_tells_the_same_figures() {
    let mut case = case(1000, &[]);
    for (name, scale) in [("grid", 1.0), ("kd", 2.0)] {
        let figure = Figure::new(Workload::Count, [90.0, 100.0, 140.0].map(|ns| ns * scale).to_vec(), None);
        let build = Build { bytes_each: Some(20.0 * scale), ..Build::default() };
        case.contestants.push(Contestant {
            name: name.into(),
            left_out: None,
            mismatches: None,
            build,
            figures: vec![figure],
        });
    }
    case.rank();
    let study = study_of(vec![case]);
    let table = text(&study, true).expect("it can be told");
    let words = table.split_whitespace().collect::<Vec<_>>().join(" ");
    // Median, ratio, mark; and in detail median, minimum, spread, ratio.
    for row in ["grid 100 1.00* 20 25 %", "kd 200 2.00 40 25 %"] {
        assert!(words.contains(row), "{row} in {table}");
    }
    for row in [["grid", "100", "90.0", "25", "%", "1.00"], ["kd", "200", "180", "25", "%", "2.00"]] {
        assert!(table.lines().any(|line| line.split_whitespace().collect::<Vec<_>>().starts_with(&row)), "{table}");
    }
    let sheet = sheet::sheet(&study).csv().expect("the table can be written");
    let mut rows = csv::Reader::from_reader(sheet.as_bytes());
    let head = rows.headers().expect("a head").clone();
    let rows: Vec<_> = rows.records().map(|row| row.expect("a row")).collect();
    let cell = |row: usize, name: &str| head.iter().position(|head| head == name).and_then(|at| rows[row].get(at));
    for (name, of_grid, of_kd) in [
        ("name", "grid", "kd"),
        ("median_ns_per_point", "100.0", "200.0"),
        ("min_ns_per_point", "90.0", "180.0"),
        ("spread_iqr_per_median", "0.25", "0.25"),
        ("ratio_to_best", "1.0", "2.0"),
        ("ties_with_best", "true", "false"),
        ("bytes_per_point", "20.0", "40.0"),
    ] {
        assert_eq!([cell(0, name), cell(1, name)], [Some(of_grid), Some(of_kd)], "{name}");
    }
    let html = page(&study, false).expect("the page can be drawn");
    for cell in
        ["<td class=\"best\">100 <small>1.00</small></td>", "<td>200 <small>2.00</small></td>", "100 + 0 ns  (1.00 x)"]
    {
        assert!(html.contains(cell), "{cell} in {html}");
    }
}

#[test]
fn who_would_take_too_long_is_left_out() {
    let limit =
        |n, efforts: &[(f64, f64)]| limit(n, efforts.iter().map(|&(distances, found)| Effort { distances, found }));
    assert_eq!(limit(1000, &[(1000.0, 30.0)]), 1e9, "few points take no time whatever is done");
    assert_eq!(limit(10_000_000, &[(1e7, 30.0), (150.0, 30.0)]), 1.5e10, "ten times the thriftiest");
    assert_eq!(
        limit(1_000_000, &[(1e6, 30.0)]),
        5e9,
        "five thousand a point at most, or twenty for each that is found"
    );
    assert_eq!(limit(1_000_000, &[(9000.0, 1000.0)]), 2e10);
    assert_eq!(limit(10_000_000, &[(1e7, 1e7)]), 1e11, "and no more than a person waits for");
    assert_eq!(limit(1_000_000, &[]), 5e9);
}

#[test]
fn a_move_is_small_and_a_subset_random() {
    let points = Distribution::Uniform.points(2000, 3);
    let moved = moved(&points, 0.2, 3);
    let farthest = points.iter().zip(&moved).map(|(a, b)| (*a - *b).abs().max_element()).fold(0.0, f32::max);
    // 5 % of the radius, of which the farthest of so many has nearly all.
    assert!((0.0099..0.010_001).contains(&farthest), "{farthest}");
    let points: Vec<_> = (0..1000u16).map(|row| Vec3::X * f32::from(row)).collect();
    let source = Source::Given { name: String::new(), about: String::new(), points: points.clone(), seed: 1 };
    let some = source.points(100);
    assert!(some.len() == 100 && some.is_sorted_by(|a, b| a.x < b.x) && some[99].x > 900.0, "{some:?}");
    assert_eq!(source.points(1000), points);
}

#[test]
fn growth_and_crossovers_are_those_of_the_figures() {
    // One linear and dear, one quadratic and cheap: equal at 10 000 points, where each point takes 100 ns.
    let cases = [case(1000, &[("tree", 100.0), ("brute", 10.0)]), case(100_000, &[("tree", 100.0), ("brute", 1000.0)])];
    let growth = study::growths(&cases);
    let of = |name: &str| growth.iter().find(|g| g.name == name && g.workload == Workload::Count).map(|g| g.exponent);
    assert!(of("tree").is_some_and(|p| (p - 1.0).abs() < 1e-9) && of("brute").is_some_and(|p| (p - 2.0).abs() < 1e-9));
    let crossovers = study::crossovers(&cases);
    let [one] = &crossovers[..] else { panic!("{crossovers:?}") };
    assert!((one.at - 10_000.0).abs() < 1e-6 && one.winner == "tree" && one.loser == "brute" && one.leads, "{one:?}");
    assert_eq!(one.size(), "10 000");
}

#[test]
fn advice_says_what_figures_say() {
    let clear = advice::advise(&[case(1000, &[("grid", 50.0), ("kd", 80.0)])]);
    assert!(clear[0].text.contains("use grid") && clear[0].text.contains("kd takes 1.60 times as long"), "{clear:?}");
    let mut counted = case(1000, &[("grid", 50.0), ("kd", 80.0)]);
    counted.contestants[1].figures[1] = Figure::new(Workload::Count, vec![80.0; 5], Some([2.0, 70.0, 30.0]));
    counted.rank();
    let why = advice::advise(&[counted]);
    assert!(
        why[0].text.contains("to find 30.0 it looks at 2.00 nodes and 70.0 distances a point, grid at 1.00 and 40.0")
    );
    let tie = advice::advise(&[case(1000, &[("grid", 50.0), ("kd", 51.0)])]);
    assert!(tie[0].text.contains("use grid or kd") && tie[0].text.contains("within 2 %"), "{tie:?}");
    assert!(
        clear[0].text.ends_with("as long, though both look at 1.00 nodes and 40.0 distances a point."),
        "{clear:?}"
    );
    // One is the best here and bad there, the other never far behind.
    let mixed = |counts: [f64; 3], nearest: [f64; 3]| {
        let mut case = case(1000, &[("a", counts[0]), ("b", counts[1]), ("c", counts[2])]);
        for (one, ns) in case.contestants.iter_mut().zip(nearest) {
            one.figures.push(Figure::new(Workload::Nearest, vec![ns; 5], None));
        }
        case.contestants[0].figures[0] = Figure::new(Workload::Build, vec![500.0; 5], None);
        case.rank();
        advice::advise(&[case])
    };
    let mixed = mixed([50.0, 60.0, 300.0], [300.0, 60.0, 50.0]);
    let [count, _, all] = &mixed[..] else { panic!("{mixed:?}") };
    assert!(all.best == "b" && all.text.contains("b: never more than 1.20 times the best (next: a, 6.00)"), "{all:?}");
    assert!(
        count.text.contains("Built anew for every query, b comes first: 70.0 ns with the build, a 550 ns"),
        "{count:?}"
    );
    let sizes = [case(1000, &[("grid", 50.0), ("kd", 20.0)]), case(9000, &[("grid", 50.0), ("kd", 80.0)])];
    let both = advice::advise(&sizes);
    assert!(both[0].text.contains("Of 1 000 points, kd is 2.50 times as fast as grid"), "{both:?}");
}

#[test]
fn reports_escape_what_users_name() {
    let cases = vec![case(1000, &[("grid", 50.0), ("kd", 20.0)]), case(9000, &[("grid", 50.0), ("kd", 80.0)])];
    let mut study = study_of(cases);
    study.origin.command = command(["x", "compare", "--points", "it's <b>.csv"].map(String::from).into_iter());
    study.notes = vec!["<script>".into()];
    assert_eq!(study.origin.command, r"pointmass compare --points 'it'\''s <b>.csv'");
    let html = page(&study, false).expect("the page can be drawn");
    for raw in ["a<b", "<script", "<b>", "http:", "https:", "NaN", "src="] {
        let html = html.replace("xmlns=\"http://www.w3.org/2000/svg\"", "");
        assert!(!html.contains(raw), "{raw}");
    }
    assert!(
        html.contains("a&lt;b &amp; &quot;c&quot;") && html.contains("kd overtakes") | html.contains("grid overtakes")
    );
    let svg = plot::all(&chart::charts(&study)).expect("the charts can be drawn");
    assert!(svg.contains("a&lt;b &amp; ") && svg.trim_end().ends_with("</svg>"));
    let sheet = sheet::sheet(&study).csv().expect("the table can be written");
    assert_eq!(sheet.lines().count(), 1 + 2 * 2 * 2);
    assert!(text(&study, true).is_ok_and(|text| text.contains("grid overtakes kd at about ")));
}
