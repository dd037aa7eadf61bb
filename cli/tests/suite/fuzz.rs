//! Whatever the files say: an error or a scene, and a scene runs; nothing panics.

use crate::random::{Memory, any_scene, scene};
use crate::scenes::BUSY;
use crate::scn::EVERYTHING;
use crate::tool::tries;
use pointmass::scene::{Model, SceneFile, read_scn, write_scn};
use pointmass::{Heap, Measures, System, Time};
use proptest::prelude::*;
use proptest::sample::{Index, select};

/// Runs a scene, if it can be used, with few particles and steps of all lengths.
fn run(scene: &SceneFile, capacity: usize) {
    let Ok(model) = Model::load(scene, "scene", &mut Memory::default()) else { return };
    let mut system = System::with(Heap::new(model.size(capacity)));
    system.start(&model.scene(), scene.run.seed).expect("the memory is made for the scene");
    for seconds in [1.0 / 60.0, 1e-9, 0.0, 0.3, 5.0, 1e4, 1.0 / 60.0] {
        system.step(&model.scene(), Time::from_seconds(seconds));
        let particles = system.particles();
        let finite = particles.position.iter().chain(particles.velocity).all(|v| v.is_finite());
        assert!(finite, "numbers that are none outlive a step: {particles:?}");
        let totals = system.totals();
        assert_eq!(totals.initial + totals.born, system.len() as u64 + totals.died.total());
    }
    let _ = (Measures::of(&system, &model.scene()), system.hash());
}

/// The messages of errors are one line that names the file.
fn is_told_well(message: &str) {
    assert!(message.starts_with("scene.") && !message.contains('\n') && message.len() < 2000, "{message:?}");
}

fn try_scn(text: &str) {
    match read_scn("scene.scn", text, &mut Memory::default()) {
        Ok((scene, _)) => {
            run(&scene, 20);
            let (again, _) = write_scn(&scene);
            assert!(read_scn("scene.scn", &again, &mut Memory::default()).is_ok(), "{again}");
        }
        Err(error) => is_told_well(&error.to_string()),
    }
}

fn try_json(text: &str) {
    match SceneFile::from_json("scene.json", text) {
        Ok(scene) => run(&scene, 20),
        Err(error) => is_told_well(&error.to_string()),
    }
}

const NASTY: [&str; 24] = [
    "nan",
    "inf",
    "1e39",
    "-1e39",
    "1e-46",
    "3.4028235e38",
    "-3.4028235e38",
    "-1",
    "0",
    "1e38",
    "1e-38",
    "99999999999999999999",
    "65536",
    "#",
    "begin",
    "end",
    "include",
    "mesh",
    "box",
    "particle",
    "material",
    "\u{0}",
    "''",
    "\u{feff}",
];

#[test]
fn every_beginning_of_a_text_is_read_or_refused() {
    for text in [BUSY, EVERYTHING] {
        for (end, _) in text.char_indices().filter(|(i, _)| !cfg!(debug_assertions) || i % 7 == 0) {
            try_scn(&text[..end]);
        }
    }
    let (scene, _) = read_scn("scene.scn", BUSY, &mut Memory::default()).expect("a good scene");
    let text = scene.to_json();
    for (end, _) in text.trim_end().char_indices() {
        let error = SceneFile::from_json("scene.json", &text[..end]).expect_err("a part of JSON is none");
        is_told_well(&error.to_string());
    }
}

proptest! {
    #![proptest_config(tries(1500))]

    #[test]
    fn no_scene_makes_a_step_panic(scene in any_scene(), capacity in 0usize..40) {
        run(&scene, capacity);
    }

    #[test]
    fn no_words_make_scn_panic(
        changes in prop::collection::vec((any::<Index>(), select(NASTY.to_vec()), 0..3), 1..4),
        scene in scene(),
        known in any::<bool>(),
    ) {
        let text = if known { BUSY.to_string() } else { write_scn(&scene).0 };
        let mut words: Vec<&str> = text.split(' ').collect();
        for (at, word, how) in changes {
            let at = at.index(words.len());
            match how {
                0 => words[at] = word,
                1 => words.insert(at, word),
                _ => drop(words.drain(at..(at + 3).min(words.len()))),
            }
            if words.is_empty() {
                words.push(word);
            }
        }
        try_scn(&words.join(" "));
    }

    #[test]
    fn no_bytes_make_json_panic(
        changes in prop::collection::vec((any::<Index>(), any::<char>(), 0..4), 1..4),
        scene in any_scene(),
    ) {
        let mut text: Vec<char> = scene.to_json().chars().collect();
        for (at, c, how) in changes {
            let at = at.index(text.len());
            match how {
                0 => text[at] = c,
                1 => text.insert(at, c),
                2 => text[at] = ['0', '9', 'e', '-', '"', '[', '}', ','][at % 8],
                _ => drop(text.remove(at)),
            }
        }
        try_json(&text.into_iter().collect::<String>());
    }

    #[test]
    fn no_text_makes_either_panic(text in "(\\PC|\\s){0,80}") {
        try_scn(&text);
        try_json(&text);
    }
}
