//! Where a film is seen from.

use crate::parse::number;
use glam::{Quat, Vec3};
use pointmass::shape::Aabb;
use pointmass::{Heap, Particle, System};
use pointmass_draw::Camera;
use std::f64::consts::TAU;

/// How a film is looked at.
#[derive(Debug, Default, clap::Args)]
pub(crate) struct Looking {
    /// Look from X,Y,Z, in metres, at TX,TY,TZ; without these at the middle of the scene
    #[arg(long, value_name = "X,Y,Z[:TX,TY,TZ]", conflicts_with = "fit", allow_hyphen_values = true, value_parser = seat)]
    pub(crate) camera: Option<Seat>,
    /// Go round the middle of the picture so often while the film lasts, such as 1 or -0.25
    #[arg(long, value_name = "TURNS", allow_hyphen_values = true, value_parser = turns)]
    pub(crate) orbit: Option<f64>,
    /// Stand where the whole run fits into the picture, but for stray particles, and look as the scene's camera does; what
    /// is done where a scene has no camera
    #[arg(long)]
    pub(crate) fit: bool,
}

/// An eye, and what it looks at.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Seat {
    eye: Vec3,
    target: Option<Vec3>,
}

/// A camera, and the place that is in the middle of its picture.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Viewpoint {
    pub(crate) camera: Camera,
    pub(crate) middle: Vec3,
}

impl Looking {
    /// Whether the run has to be known before it can be looked at.
    pub(crate) fn needs_run(&self, has_camera: bool) -> bool {
        self.fit || self.camera.is_none() && !has_camera
    }
}

impl Viewpoint {
    /// A camera that looks at a scene, given the scene's middle.
    pub(crate) fn new(camera: Camera, middle: Vec3) -> Self {
        Self { camera, middle }
    }

    /// The same as seen from a seat.
    pub(crate) fn from(self, seat: Seat) -> Self {
        let middle = seat.target.unwrap_or(self.middle);
        let up = if self.camera.up.cross(middle - seat.eye).length_squared() > 0.0 { self.camera.up } else { Vec3::Z };
        let distance = seat.eye.distance(middle);
        let (near, far) = (self.camera.near.min(0.01 * distance), self.camera.far.max(100.0 * distance));
        Self { camera: Camera { eye: seat.eye, towards: middle - seat.eye, up, near, far, ..self.camera }, middle }
    }

    /// The camera after a part of a turn around the upright line through what it looks at.
    pub(crate) fn turned(&self, turns: f64) -> Camera {
        let camera = self.camera;
        let angle = (turns.fract() * TAU) as f32;
        let (Some(axis), Some(ahead)) = (camera.up.try_normalize(), camera.towards.try_normalize()) else {
            return camera;
        };
        if angle == 0.0 {
            return camera;
        }
        // The place on the line of sight that is nearest to the middle.
        let distance = (self.middle - camera.eye).dot(ahead);
        let pivot = if distance > 0.0 { camera.eye + distance * ahead } else { self.middle };
        let turn = Quat::from_axis_angle(axis, angle);
        Camera { eye: pivot + turn * (camera.eye - pivot), towards: turn * camera.towards, ..camera }
    }
}

/// Places that a run comes by, a bounded number of them.
#[derive(Debug)]
pub(crate) struct Crowd {
    /// Particles that the scene begins with and that are fixed: whoever puts one somewhere means it to be seen.
    placed: Balls,
    /// Balls and bodies that the scene begins with, which are held against each other alone: however many sparks there are, these are no strays.
    bodies: Balls,
    /// All others.
    loose: Balls,
}

/// Balls, of which one of `every` is kept.
#[derive(Debug)]
struct Balls {
    balls: Vec<(Vec3, f32)>,
    every: usize,
    met: usize,
}

impl Balls {
    /// How many are kept at most.
    const MOST: usize = 1 << 17;

    const fn new() -> Self {
        Self { balls: Vec::new(), every: 1, met: 0 }
    }

    fn meet(&mut self, place: Vec3, radius: f32) {
        if place.is_finite() && self.met.is_multiple_of(self.every) {
            self.balls.push((place, radius));
        }
        self.met += 1;
        if self.balls.len() > Self::MOST {
            self.balls = self.balls.iter().copied().step_by(2).collect();
            self.every *= 2;
        }
    }
}

impl Crowd {
    pub(crate) fn new() -> Self {
        Self { placed: Balls::new(), bodies: Balls::new(), loose: Balls::new() }
    }

    /// Takes note of where particles are. The scene begins with `start`, of which so many are its own `particles`, and the others parts of bodies.
    pub(crate) fn meet(&mut self, system: &System<Heap>, start: &[Particle], own: usize) {
        let particles = system.particles();
        let places = particles.position.iter().zip(particles.radius);
        for ((&place, &radius), &serial) in places.zip(particles.serial) {
            let group = match start.get(serial as usize) {
                Some(Particle { fixed: true, .. }) => &mut self.placed,
                Some(_) if radius > 0.0 || serial as usize >= own => &mut self.bodies,
                _ => &mut self.loose,
            };
            group.meet(place, radius);
        }
    }

    /// The view of all that was met and of the boxes of scenery, in the direction of a camera and with its angle, for
    /// pictures `aspect` times as wide as high. `around` is whether it has to be so from all sides.
    pub(crate) fn view(self, camera: Camera, scenery: &[Aabb], aspect: f32, around: bool) -> Viewpoint {
        let [mut fixed, bodies, loose] = [self.placed, self.bodies, self.loose].map(|group| group.balls);
        let all = fixed.iter().chain(&bodies).chain(&loose);
        let reach = Aabb::around(all.map(|&(place, _)| place)).radius();
        let is_small = |scenery: &&Aabb| !(reach > 0.0) || scenery.radius() <= 4.0 * reach;
        let corners = scenery.iter().filter(is_small).flat_map(|&Aabb { min, max }| {
            (0..8).map(move |i| Vec3::select(glam::BVec3::new(i & 1 > 0, i & 2 > 0, i & 4 > 0), min, max))
        });
        fixed.extend(corners.map(|corner| (corner, 0.0)));
        if fixed.is_empty() && bodies.is_empty() && loose.is_empty() {
            fixed.extend([(Vec3::splat(-0.5), 0.0), (Vec3::splat(0.5), 0.0)]);
        }
        let mut all = [bodies, loose, fixed];
        if around {
            let axis = camera.up.try_normalize().unwrap_or(Vec3::Y);
            let pivot = fit(camera, &all, aspect).middle;
            all = all.map(|balls| round(&balls, pivot, axis));
        }
        fit(camera, &all, aspect)
    }
}

/// The same balls after all parts of a turn.
fn round(balls: &[(Vec3, f32)], pivot: Vec3, axis: Vec3) -> Vec<(Vec3, f32)> {
    const PARTS: u16 = 16;
    let turn = |part: u16| Quat::from_axis_angle(axis, f32::from(part) / f32::from(PARTS) * TAU as f32);
    let turned = |turn: Quat| balls.iter().map(move |&(place, radius)| (pivot + turn * (place - pivot), radius));
    (0..PARTS).map(turn).flat_map(turned).collect()
}

/// Moves a camera to where the four sides of its picture just hold everything: two groups of balls but for the strays of each, and fixed
/// ones whatever they are.
fn fit(camera: Camera, balls: &[Vec<(Vec3, f32)>; 3], aspect: f32) -> Viewpoint {
    /// How much is left free at the edges.
    const MARGIN: f32 = 1.06;
    let back = -camera.towards.try_normalize().unwrap_or(Vec3::NEG_Z);
    let right = camera.up.cross(back).try_normalize().unwrap_or_else(|| back.any_orthonormal_vector());
    let up = back.cross(right);
    let slope = camera.xfov.clamp(0.01, 1.5).tan() / MARGIN;
    // A ball is on the inner side of a side's plane as long as this is less than the eye's.
    let side = |way: Vec3, slope: f32| {
        let height = |&(place, radius): &(Vec3, f32)| {
            place.dot(way) + slope * place.dot(back) + radius * (1.0 + slope * slope).sqrt()
        };
        let [bodies, loose, fixed] = balls.each_ref().map(|balls| balls.iter().map(height));
        let fixed = fixed.fold(f32::NEG_INFINITY, f32::max);
        fixed.max(most(bodies.collect())).max(most(loose.collect()))
    };
    let [left_most, right_most] = [-right, right].map(|way| side(way, slope));
    let [low_most, high_most] = [-up, up].map(|way| side(way, slope / aspect));
    let across = 0.5 * (right_most - left_most);
    let upright = 0.5 * (high_most - low_most);
    let wide = 0.5 * (right_most + left_most) / slope;
    let high = 0.5 * (high_most + low_most) / slope * aspect;
    let depths = balls.iter().flatten().map(|&(place, _)| place.dot(back)).collect::<Vec<_>>();
    let middle_depth = median(depths);
    // A single point is looked at from a metre away.
    let distance = (wide.max(high) - middle_depth).max(1e-3);
    let distance = if distance > 2e-3 { distance } else { 1.0 };
    let middle = across * right + upright * up + middle_depth * back;
    let camera = Camera {
        eye: middle + distance * back,
        towards: -back,
        near: (0.01 * distance).min(camera.near.max(1e-3 * distance)),
        far: camera.far.max(100.0 * distance),
        ..camera
    };
    Viewpoint { camera, middle }
}

/// The largest value, but for those that are far beyond nearly all others.
fn most(mut values: Vec<f32>) -> f32 {
    values.retain(|value| value.is_finite());
    values.sort_unstable_by(f32::total_cmp);
    let at = |part: f32| values.get((part * values.len() as f32) as usize).copied();
    let stray = match (at(0.5), at(0.99)) {
        // Of few, no one is a stray.
        (Some(middle), Some(nearly)) if values.len() >= 200 => nearly + (nearly - middle),
        _ => f32::INFINITY,
    };
    values.into_iter().rfind(|&value| value <= stray).unwrap_or(f32::NEG_INFINITY)
}

fn median(mut values: Vec<f32>) -> f32 {
    values.retain(|value| value.is_finite());
    values.sort_unstable_by(f32::total_cmp);
    values.get(values.len() / 2).copied().unwrap_or(0.0)
}

fn seat(text: &str) -> Result<Seat, String> {
    const EXPECTED: &str = "expected X,Y,Z or X,Y,Z:TX,TY,TZ in metres, such as 0,2,10:0,1,0";
    let place = |text: &str| {
        let numbers: Vec<f32> = text.split(',').map(|n| Ok(number(n)? as f32)).collect::<Result<_, String>>().ok()?;
        let place = Vec3::from_array(numbers.try_into().ok()?);
        (place.is_finite() && place.abs().max_element() <= 1e9).then_some(place)
    };
    let (eye, target) = match text.split_once(':') {
        Some((eye, target)) => (place(eye), Some(place(target).ok_or(EXPECTED)?)),
        None => (place(text), None),
    };
    let eye = eye.ok_or(EXPECTED)?;
    if target == Some(eye) { Err("the eye cannot look at where it is".into()) } else { Ok(Seat { eye, target }) }
}

fn turns(text: &str) -> Result<f64, String> {
    let value = number(text)?;
    if value.abs() <= 1e6 { Ok(value) } else { Err("expected turns, such as 1 or -0.25".into()) }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Where a place is in the picture: −1 and 1 are its edges.
    fn seen(camera: &Camera, place: Vec3, aspect: f32) -> [f32; 2] {
        let ahead = camera.towards.normalize();
        let right = ahead.cross(camera.up).normalize();
        let way = place - camera.eye;
        let depth = way.dot(ahead);
        assert!((camera.near..camera.far).contains(&depth), "{depth}");
        let scale = 1.0 / (depth * camera.xfov.tan());
        [scale * way.dot(right), scale * aspect * way.dot(right.cross(ahead))]
    }

    /// A cloud of balls somewhere, longer than it is wide.
    fn crowd() -> Crowd {
        let mut crowd = Crowd::new();
        let part = |i: u32, k: u32| (i.wrapping_mul(k) >> 8) as f32 / 8_388_608.0 - 1.0;
        let ball =
            |i: u32| (Vec3::new(40.0 * part(i, 1_664_525), 3.0 * part(i, 22_695_477), part(i, 134_775_813)), 0.1);
        crowd.loose.balls = (0..2000).map(|i| (Vec3::new(100.0, -7.0, 3.0) + ball(i).0, ball(i).1)).collect();
        crowd
    }

    #[test]
    fn everything_fits_and_the_picture_is_full() {
        let askew = Camera { towards: Vec3::new(0.3, -0.4, -1.0), xfov: 0.4, ..Camera::default() };
        for (camera, aspect) in [(Camera::default(), 4.0 / 3.0), (askew, 1.0), (askew, 0.3)] {
            let balls = crowd().loose.balls;
            let Viewpoint { camera, .. } = crowd().view(camera, &[], aspect, false);
            let seen = || balls.iter().map(|&(place, _)| seen(&camera, place, aspect));
            assert!(seen().flatten().all(|at| at.abs() < 1.0), "{camera:?}");
            let edge = seen().flatten().fold(0.0, |most: f32, at| most.max(at.abs()));
            assert!(edge > 0.85, "{edge}");
        }
    }

    #[test]
    fn everything_fits_from_all_sides() {
        let balls = crowd().loose.balls;
        let from = crowd().view(Camera::default(), &[], 1.5, true);
        for step in 0..50 {
            let camera = from.turned(0.02 * f64::from(step));
            let mut seen = balls.iter().flat_map(|&(place, _)| seen(&camera, place, 1.5));
            assert!(seen.all(|at| at.abs() < 1.0), "{step}");
        }
    }

    #[test]
    fn strays_and_horizons_do_not_count() {
        let calm = crowd().view(Camera::default(), &[], 1.5, false).camera;
        let mut stray = crowd();
        stray.loose.balls.push((Vec3::new(1e6, 1e6, 0.0), 0.1));
        let stray = stray.view(Camera::default(), &[], 1.5, false).camera;
        assert!(stray.eye.distance(calm.eye) < 0.3 * calm.eye.z, "{stray:?} {calm:?}");
        let horizon = Aabb { min: Vec3::splat(-1e5), max: Vec3::splat(1e5) };
        assert_eq!(crowd().view(Camera::default(), &[horizon], 1.5, false).camera, calm);
        let shelf = Aabb { min: Vec3::new(100.0, 10.0, 0.0), max: Vec3::new(101.0, 60.0, 1.0) };
        let camera = crowd().view(Camera::default(), &[shelf], 1.5, false).camera;
        assert!(seen(&camera, shelf.max, 1.5)[1] < 1.0 && seen(&camera, shelf.max, 1.5)[1] > 0.85);
    }

    #[test]
    fn what_the_scene_begins_with_is_no_stray_among_sparks() {
        let (left, right) = (Vec3::new(-300.0, 0.0, 0.0), Vec3::new(600.0, 0.0, 0.0));
        let mut begun = crowd();
        begun.placed.balls.push((left, 1.0));
        begun.bodies.balls.push((right, 1.0));
        let camera = begun.view(Camera::default(), &[], 1.5, false).camera;
        for place in [left, right] {
            assert!((0.85..1.0).contains(&seen(&camera, place, 1.5)[0].abs()), "{camera:?}");
        }
        // Of many bodies one may be, but not what is fixed.
        let mut many = Crowd::new();
        many.bodies.balls = crowd().loose.balls;
        let calm = crowd().view(Camera::default(), &[], 1.5, false).camera;
        many.bodies.balls.push((1e6 * Vec3::X, 0.1));
        let camera = many.view(Camera::default(), &[], 1.5, false).camera;
        assert!(camera.eye.distance(calm.eye) < 0.3 * calm.eye.z, "{camera:?}");
    }

    #[test]
    fn nothing_at_all_can_be_looked_at() {
        for balls in [vec![], vec![(Vec3::ONE, 0.0)]] {
            let mut crowd = Crowd::new();
            crowd.loose.balls = balls;
            let Viewpoint { camera, .. } = crowd.view(Camera::default(), &[], 1.0, true);
            assert!(camera.eye.is_finite() && camera.near > 0.0 && camera.near < camera.far, "{camera:?}");
        }
    }

    #[test]
    fn a_whole_turn_changes_nothing_and_half_a_turn_looks_back() {
        let from = Viewpoint::new(Camera { eye: Vec3::new(0.0, 2.0, 5.0), ..Camera::default() }, Vec3::ZERO);
        assert_eq!([from.turned(0.0), from.turned(-3.0)], [from.camera; 2]);
        let behind = from.turned(0.5);
        assert!(behind.eye.distance(Vec3::new(0.0, 2.0, -5.0)) < 1e-5 && behind.towards.distance(Vec3::Z) < 1e-5);
    }
}
