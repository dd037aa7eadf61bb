//! Scene files with walls that move, ground and balls.

use pointmass::scene::{Files, Model, SceneFile, write_scn};
use pointmass::shape::MeshBuf;
use pointmass::{Heap, System, Time, Vec3};

struct NoFiles;

impl Files for NoFiles {
    fn text(&mut self, path: &str) -> Result<String, String> {
        Err(format!("there is no {path}"))
    }
    fn mesh(&mut self, path: &str) -> Result<MeshBuf, String> {
        Err(format!("there is no {path}"))
    }
    fn exists(&mut self, _: &str) -> bool {
        false
    }
}

fn load(text: &str) -> Result<Model, String> {
    let file = SceneFile::from_json("test.json", text).map_err(|error| error.to_string())?;
    Model::load(&file, "test.json", &mut NoFiles).map_err(|error| error.to_string())
}

const MILL: &str = r#"{
  "particles": [{"position": [0.5, 3, 0.5], "radius": 0.1}, {"position": [3, 1, 0], "velocity": [0, 0, 0]}],
  "forces": [{"gravity": {"acceleration": [0, -9.8, 0]}}],
  "scenery": [
    {"shape": {"heightfield": {"origin": [-4, 0, -4], "spacing": 4, "columns": 3, "heights": [0, 1, 0, 1, 2, 1, 0, 1, 0]}}},
    {"shape": {"box": {"min": [-3.5, 0.9, -0.1], "max": [3.5, 1.6, 0.1]}}, "motion": {"spin": 0.5, "axis": [0, 1, 0]}}
  ]
}"#;

#[test]
fn a_scene_with_a_mill_on_a_hill_runs() {
    let model = load(MILL).expect("nothing is wrong with it");
    let mut system = System::with(Heap::new(model.size(4)));
    system.start(&model.scene(), 0).expect("the memory is made for it");
    for i in 1..=60 {
        system.step(&model.scene(), Time::frame(i, 60) - system.time());
    }
    let p = system.particles();
    assert_eq!(p.position.len(), 2);
    // The ball lies on the hill or rolls down it; the point was taken by the blade.
    assert!(p.position[0].y > 1.0 && (p.position[0] - Vec3::new(0.5, 3.0, 0.5)).length() > 0.5, "{}", p.position[0]);
    assert!(system.totals().hits > 0);
}

#[test]
fn what_scn_cannot_say_is_warned_of() {
    let file = SceneFile::from_json("test.json", MILL).expect("it is a scene");
    assert_eq!(SceneFile::from_json("again.json", &file.to_json()).expect("it was written"), file);
    let (text, warnings) = write_scn(&file);
    assert!(warnings.iter().any(|w| w.contains("scenery[1].motion")), "{warnings:?}");
    assert!(warnings.iter().any(|w| w.contains("scenery[0]") && w.contains("a height field")), "{warnings:?}");
    assert!(!text.contains("heightfield") && text.contains("box"));
}

#[test]
fn what_cannot_be_used_is_refused() {
    let grid = |columns: u32| {
        format!(
            r#"{{"scenery": [{{"shape": {{"heightfield":
            {{"origin": [0, 0, 0], "spacing": 1, "columns": {columns}, "heights": [0, 0, 0, 0]}}}}}}]}}"#
        )
    };
    assert!(load(&grid(2)).is_ok());
    assert!(load(&grid(3)).expect_err("no full rows").contains("full rows"));
    let still = r#"{"scenery": [{"shape": {"sphere": {"center": [0, 0, 0], "radius": 1}}, "motion": {"spin": 1, "axis": [0, 0, 0]}}]}"#;
    assert!(load(still).expect_err("no axis").contains("scenery[0].motion"));
    let squashed = |radius: f32| {
        format!(
            r#"{{"particles": [{{"position": [0, 5, 0], "radius": {radius}}}],
            "groups": [{{"matrix": [[2, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]}}],
            "scenery": [{{"shape": {{"sphere": {{"center": [0, 0, 0], "radius": 1}}}}, "group": 0}}]}}"#
        )
    };
    assert!(load(&squashed(0.0)).is_ok(), "points meet an ellipsoid");
    assert!(load(&squashed(0.1)).expect_err("balls do not").contains("scenery[0].group"));
}
