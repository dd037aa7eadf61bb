//! What a comparison makes of answers and figures that are known beforehand.

use super::bench::moved;
use super::contender::{Answer, Build, Contender, Own, Question, Scratch};
use super::study::{Case, Contestant, Figure};
use super::verify::{ASKED, Expected};
use super::workload::Workload;
use super::{Distribution, advice, chart, command, page, sheet, study, table};
use crate::Outcome;
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
    fn effort(&mut self, query: Workload, question: &Question<'_>, rows: &[usize]) -> Option<(f64, f64)> {
        self.honest.effort(query, question, rows)
    }
    fn answer(&mut self, query: Workload, question: &Question<'_>) -> Option<Answer> {
        let mut answer = self.honest.answer(query, question)?;
        let lies = query == self.about && (query != Workload::Moving || self.followed);
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
        Expected::exhaustive(&question, &ASKED)
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
    for about in ASKED.into_iter().filter(|about| *about != Workload::Moving) {
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
    for about in [Workload::Count, Workload::Within, Workload::Nearest] {
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
        let radius = super::radius::radius_for(&points, 12.0, 1, &mut memory).expect("there is a radius");
        let moved = moved(&points, radius, 1);
        let question = Question { points: &points, moved: &moved, radius, k: 7 };
        let expected = Expected::exhaustive(&question, &ASKED);
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
fn case(n: usize, times: &[(&str, f64)]) -> Case {
    let figure = |median: f64, workload| Figure::new(workload, vec![median; 5], Some([1.0, 40.0, 30.0]));
    let contestant = |(name, median): &(&str, f64)| Contestant {
        name: name.to_string(),
        left_out: None,
        build: Build { bytes_per_point: Some(20.0), ..Build::default() },
        figures: vec![figure(10.0, Workload::Build), figure(*median, Workload::Count)],
    };
    let mut case = Case {
        points: "a<b & \"c\"".into(),
        about: "made up".into(),
        n,
        radius: 0.1,
        neighbours: 30.0,
        verified: "verified".into(),
        rounds: 5,
        contestants: times.iter().map(contestant).collect(),
    };
    case.rank();
    case
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
fn growth_and_crossovers_are_those_of_the_figures() {
    // One linear and dear, one quadratic and cheap: equal at 10 000 points, where each point takes 100 ns.
    let cases = [case(1000, &[("tree", 100.0), ("brute", 10.0)]), case(100_000, &[("tree", 100.0), ("brute", 1000.0)])];
    let growth = study::growths(&cases);
    let of = |name: &str| growth.iter().find(|g| g.name == name && g.workload == Workload::Count).map(|g| g.exponent);
    assert!(of("tree").is_some_and(|p| (p - 1.0).abs() < 1e-9) && of("brute").is_some_and(|p| (p - 2.0).abs() < 1e-9));
    let crossovers = study::crossovers(&cases);
    let [one] = &crossovers[..] else { panic!("{crossovers:?}") };
    assert!((one.at - 10_000.0).abs() < 1e-6 && one.winner == "tree" && one.loser == "brute" && one.leads, "{one:?}");
    assert!(one.text().contains("tree overtakes brute at about 10 000 points"), "{}", one.text());
}

#[test]
fn advice_says_what_figures_say() {
    let clear = advice::advise(&[case(1000, &[("grid", 50.0), ("kd", 80.0)])]);
    assert!(clear[0].text.contains("use grid") && clear[0].text.contains("kd takes 1.60 times as long"), "{clear:?}");
    let tie = advice::advise(&[case(1000, &[("grid", 50.0), ("kd", 51.0)])]);
    assert!(tie[0].text.contains("use grid or kd") && tie[0].text.contains("within 2 %"), "{tie:?}");
    let sizes = [case(1000, &[("grid", 50.0), ("kd", 20.0)]), case(9000, &[("grid", 50.0), ("kd", 80.0)])];
    let both = advice::advise(&sizes);
    assert!(both[0].text.contains("Of 1 000 points, kd is 2.50 times as fast as grid"), "{both:?}");
}

#[test]
fn reports_escape_what_users_name() {
    let cases = vec![case(1000, &[("grid", 50.0), ("kd", 20.0)]), case(9000, &[("grid", 50.0), ("kd", 80.0)])];
    let study = super::Study {
        version: "0".into(),
        command: command(["x", "compare", "--points", "it's <b>.csv"].map(String::from).into_iter()),
        machine: super::Machine::this(),
        seed: 1,
        k: 8,
        growth: study::growths(&cases),
        crossovers: study::crossovers(&cases),
        advice: advice::advise(&cases),
        notes: vec!["<script>".into()],
        cases,
    };
    assert_eq!(study.command, r"pointmass compare --points 'it'\''s <b>.csv'");
    let html = page::html(&study).expect("the page can be drawn");
    for raw in ["a<b", "<script", "<b>", "http:", "https:", "NaN", "src="] {
        let html = html.replace("xmlns=\"http://www.w3.org/2000/svg\"", "");
        assert!(!html.contains(raw), "{raw}");
    }
    assert!(
        html.contains("a&lt;b &amp; &quot;c&quot;") && html.contains("kd overtakes") | html.contains("grid overtakes")
    );
    let svg = chart::all(&study).expect("the charts can be drawn");
    assert!(svg.contains("a&lt;b &amp; ") && svg.trim_end().ends_with("</svg>"));
    let sheet = sheet::csv(&study).expect("the table can be written");
    assert_eq!(sheet.lines().count(), 1 + 2 * 2 * 2);
    assert!(table::text(&study, true).contains("grid overtakes kd"));
}
