//! A plank on what is round rocks: its place of contact rolls along as it turns, and the more it hangs over the other way.

use pointmass::Vec3;
use pointmass::scene::{Model, SceneFile};
use pointmass_tests::started;
use serde_json::{Value, json};

/// A plank across something round with such a radius, and how it is laid on.
struct Rock {
    shape: fn(f64) -> Value,
    radius: f64,
    size: f64,
    /// Where the top is, in m.
    top: [f64; 3],
    /// By how much it is turned about the vertical.
    about: f64,
    substeps: u32,
    integrator: &'static str,
}

/// How thick the plank is, which is 1 long, and how far it is tilted as it begins.
const THICK: f64 = 0.05;
const TILT: f64 = 0.1;
const G: f64 = 9.81;

fn sphere(radius: f64) -> Value {
    json!({"sphere": {"center": [0, 0, 0], "radius": radius}})
}

fn capsule(radius: f64) -> Value {
    json!({"capsule": {"from": [0, -1, 0], "to": [0, 1, 0], "radius": radius}})
}

fn barrel(radius: f64) -> Value {
    json!({"cylinder": {"center": [0, 0, 0], "radius": radius, "height": 2}})
}

impl Rock {
    /// The scene, in which all times are those of a plank of 1 m.
    fn model(&self) -> Model {
        let Self { shape, radius, size, top, about, substeps, integrator } = *self;
        let (sin, cos) = TILT.sin_cos();
        // It has rolled there from where it lay level, on its middle.
        let (over, along) = ([-sin, cos], [cos, sin]);
        let rolled = [0, 1].map(|k| (radius + 0.5 * THICK) * over[k] + radius * TILT * along[k]);
        let [x, y] = [rolled[0], rolled[1] - radius].map(|x| x * size);
        let (around, forth) = about.sin_cos();
        let half = |angle: f64| (0.5 * angle).sin_cos();
        let ((a, b), (c, d)) = (half(about), half(TILT));
        // About the vertical behind the tilt: the angle and the axis of both turns together.
        let (w, v) = (b * d, [a * c, a * d, b * c]);
        let sine = v.iter().map(|x| x * x).sum::<f64>().sqrt();
        let turn = v.map(|x| x / sine * 2.0 * sine.atan2(w));
        let scene = json!({
            "run": {"duration": 10, "dt": 1.0 / 60.0, "substeps": substeps, "integrator": integrator},
            "forces": [{"gravity": {"acceleration": [0, -G * size, 0]}}],
            "materials": [{"contact": {"friction": {"static": 0.9, "kinetic": 0.9}, "elasticity": 0}}],
            // Axes lie along z.
            "groups": [{"matrix": [[size, 0, 0, top[0]], [0, 0, -size, top[1] - radius * size], [0, size, 0, top[2]], [0, 0, 0, 1]]}],
            "scenery": [{"shape": shape(radius), "group": 0, "material": 0}],
            "boxes": [{"sides": [size, THICK * size, 0.2 * size], "mass": 1, "turn": turn, "material": 0,
                "position": [top[0] + x * forth, top[1] + y, top[2] - x * around]}],
        });
        let file = SceneFile::from_json("it.json", &scene.to_string()).unwrap_or_else(|error| panic!("{error}"));
        Model::load(&file, "it.json", &mut ()).unwrap_or_else(|error| panic!("{error}"))
    }

    /// How long it takes from one side to the other \[s\]. Its middle is as high as (R + d / 2) cos θ + R θ sin θ, and it turns about the place of contact, R θ beside that.
    fn half(&self) -> f64 {
        let height = |tilt: f64| (self.radius + 0.5 * THICK) * tilt.cos() + self.radius * tilt * tilt.sin();
        let inertia = |tilt: f64| (1.0 + THICK * THICK) / 12.0 + 0.25 * THICK * THICK + (self.radius * tilt).powi(2);
        let speed = |tilt: f64| (2.0 * G * (height(TILT) - height(tilt)) / inertia(tilt)).sqrt();
        let step = std::f64::consts::PI / 1000.0;
        let phases = (0..1000).map(|i| (f64::from(i) + 0.5) * step - 0.5 * std::f64::consts::PI);
        phases.map(|phase| step * TILT * phase.cos() / speed(TILT * phase.sin())).sum()
    }

    /// Rocks for two seconds, to and fro as long as its inertia says, and as far as before.
    fn rocks(&self) {
        let model = self.model();
        let scene = model.scene();
        let mut system = started(&scene, model.particles.len(), 1);
        let (mut tilts, mut crossings) = (Vec::new(), Vec::new());
        for frame in 1..=120u64 {
            system.step_to(&scene, pointmass::Time::frame(frame, 60));
            let places = system.particles().position;
            let ends = [0, 1].map(|end| (0..8).filter(|i| i & 1 == end).map(|i| places[i]).sum::<Vec3>() * 0.25);
            let way = ends[1] - ends[0];
            let tilt = f64::from((way.y / way.length()).asin());
            if let Some(&last) = tilts.last().filter(|&&last| last * tilt < 0.0) {
                crossings.push((frame as f64 - tilt / (tilt - last)) / 60.0);
            }
            tilts.push(tilt);
        }
        let half = self.half();
        let Self { radius, size, substeps, integrator, about, top, .. } = self;
        let name = format!("{radius} {size} m at {top:?}, turned by {about}, {integrator} x{substeps}");
        assert!(crossings.len() > 1, "{name}: it rocks: {tilts:?}");
        let took = (crossings[crossings.len() - 1] - crossings[0]) / (crossings.len() - 1) as f64;
        // How far it swings in a sub-step, in radians of its oscillation.
        let swing = std::f64::consts::PI / half / 60.0 / f64::from(*substeps);
        assert!((took / half - 1.0).abs() < 0.005 + 0.3 * swing, "{name}: {took} s for {half}");
        let far = |part: &[f64]| part.iter().fold(0.0, |far: f64, tilt| far.max(tilt.abs()));
        let kept = far(&tilts[120 - (60.0 * half * 1.1) as usize..]) / TILT;
        assert!((0.98 - 2.6 * swing..1.01).contains(&kept), "{name}: {kept} of its tilt");
    }
}

/// On spheres and on drums of every size, in any direction, anywhere.
#[test]
fn planks_rock_on_what_is_round() {
    let mut number = 0;
    for shape in [sphere, capsule, barrel] {
        for radius in [0.2, 0.5, 2.0] {
            for size in [0.02, 1.0, 30.0] {
                let substeps = [1, 4, 20][number % 3];
                let integrator = ["verlet", "symplectic", "midpoint", "rk4", "euler"][number % 5];
                // Drums lie across.
                let about = if number % 2 == 0 || shape(1.0).get("sphere").is_none() { 0.0 } else { 0.7 };
                let top = if number % 4 == 3 { [30.0 * size, -20.0 * size, 10.0 * size] } else { [0.0; 3] };
                Rock { shape, radius, size, top, about, substeps, integrator }.rocks();
                number += 1;
            }
        }
    }
}
