//! pointmass for JavaScript. `wasm/build` makes the npm package of it.
//!
//! ```js
//! import init, { World } from "pointmass";
//! await init();
//! const world = new World(scene);              // an object, or a text: .json or .scn
//! let last;
//! requestAnimationFrame(function frame(now) {
//!   world.advance((now - (last ?? now)) / 1000);
//!   last = now;
//!   draw(world.positions(), world.count);      // Float32Array: x, y, z by x, y, z
//!   requestAnimationFrame(frame);
//! });
//! ```

mod arguments;
mod blows;
mod clock;
mod draw;
mod files;
mod json;
mod memory;
mod path;
mod saved;
mod scene;

pub use files::Files;

use arguments::{capacity, instant, place, seconds, seed, strain};
use blows::Blows;
use clock::Clock;
use js_sys::{Float32Array, Int32Array, JsString, Uint8Array, Uint32Array};
use pointmass::draw::{Appearance, Knot, Line, Looks, Ring, StrandLight, Trails, View};
use pointmass::scene::Model;
use pointmass::{Heap, Id, Likeness, Own, Storage, System, Time, Vec3};
use saved::{Saved, State};
use scene::Loaded;
use wasm_bindgen::prelude::*;

#[wasm_bindgen(typescript_custom_section)]
const PARTICLE: &str = r#"
/** A particle as `World.spawn` takes it: an entry of a scene's list `particles`. */
export interface Particle {
    /** Where it is [m]; [0, 0, 0], where nothing is said. */
    position?: readonly number[] | Float32Array | Float64Array;
    /** How it moves [m/s]; [0, 0, 0]. */
    velocity?: readonly number[] | Float32Array | Float64Array;
    /** Its radius [m]; 0, a point. */
    radius?: number;
    /** Its mass [kg], above zero; 1. */
    mass?: number;
    /** It never moves, but still attracts; false. */
    fixed?: boolean;
    /** Coefficient of linear drag [kg/s]; 0. */
    drag?: number;
    /** Electric charge [C]; 0. */
    charge?: number;
    /** The share of the normal speed it keeps when it hits something; 0.5. */
    elasticity?: number;
    /** How long it lives [s]; 0, for ever. */
    lifetime?: number;
    /** The number of its material in the scene, from 0; none. */
    material?: number;
    /** Red, green, blue and opacity, 0 to 255; those of its material. */
    color?: readonly number[] | Float32Array | Float64Array;
}
"#;

/// The version of this package.
#[wasm_bindgen]
#[must_use]
pub fn version() -> String {
    env!("CARGO_PKG_VERSION").to_owned()
}

/// A scene in motion. All its memory is taken when it is made, but for what `save` and `listen` ask for; stepping takes none.
///
/// `free()`, or `using`, gives the memory back at once; twice does no harm. Whoever is forgotten is freed when the engine collects garbage.
#[wasm_bindgen]
#[derive(Debug)]
pub struct World {
    model: Model,
    /// How far each of its pushes between balls reaches, for those that the scene has \[m\].
    reaches: Vec<f32>,
    state: State,
    saved: Saved,
    blows: Blows,
    seed: u64,
    warnings: Vec<String>,
    /// The light on strands, for an eye at the origin.
    light: StrandLight,
    /// True for each particle of the start that is drawn as part of something else.
    covered: Vec<bool>,
}

/// The places that are remembered of each trail.
const KNOTS: usize = 48;

/// The strain at which lines have their full colours, where nothing is said.
const FULL_STRAIN: f32 = 0.1;

/// The speed from which on blows are noted \[m/s\], and how many are at the most, where nothing is said.
const LISTENED: f32 = 0.1;
const NOTED: u32 = 256;

impl World {
    /// Something of how each of the living looks, as a list for `what`.
    fn appearances<T>(&self, what: &str, of: impl Fn(Appearance) -> T) -> Result<Vec<T>, JsError> {
        let mut list = memory::reserved(self.state.system.len(), what)?;
        let scene = self.model.scene();
        let state = self.state.system.state(&scene);
        let mut looks = Looks::of(&state);
        list.extend((0..self.state.system.len()).filter_map(|row| looks.appearance(row)).map(of));
        Ok(list)
    }

    /// Makes one step, to an instant.
    fn go_to(&mut self, end: Time) {
        self.state.system.step_to_observed(&self.model.scene(), end, self.blows.observer());
        self.remember();
    }

    /// Lets pushes between balls reach as far as those need that the scene has, and that have been put in.
    fn reach_all(&mut self) {
        for (push, &reach) in self.model.forces.2.iter_mut().zip(&self.reaches) {
            push.reach = reach.max(self.state.widest);
        }
    }

    /// Lets trails remember where everybody is.
    fn remember(&mut self) {
        if self.state.rings.is_empty() {
            return;
        }
        let scene = self.model.scene();
        Trails::new(&mut self.state.rings, &mut self.state.knots, None).look(&self.state.system.state(&scene));
    }
}

/// Memory for so many particles of a model.
fn heap(model: &Model, capacity: u32) -> Result<Heap, JsError> {
    // JavaScript may write where it looks, and put in particles that are like no others: no column of theirs may be shared.
    let likeness = model.scene().likeness();
    let own = Own { last_spring: likeness.own.last_spring, ..Own::ALL };
    Heap::alike(model.size(capacity as usize), &Likeness { own, ..likeness }).map_err(|_| {
        JsError::new(&format!("there is not enough memory for {capacity} particles: take a smaller capacity"))
    })
}

#[wasm_bindgen]
impl World {
    /// Loads a scene: an object as JSON has it, its text, or a text in `.scn`; with the files it names.
    ///
    /// `capacity` is how many particles may live at once and `seed` that of all randomness; by default both are what
    /// the scene says. What the scene begins with has room beyond its `run.capacity`, and none beyond this `capacity`: the
    /// last of it are refused then, which `warnings` tells.
    ///
    /// # Errors
    /// If the scene cannot be used, with the place and what was expected, or there is not enough memory.
    #[wasm_bindgen(constructor)]
    pub fn new(
        #[wasm_bindgen(unchecked_param_type = "string | object")] scene: &JsValue,
        #[wasm_bindgen(unchecked_optional_param_type = "Files | null")] files: &JsValue,
        #[wasm_bindgen(unchecked_optional_param_type = "number | null")] capacity: &JsValue,
        #[wasm_bindgen(unchecked_optional_param_type = "number | bigint | null")] seed: &JsValue,
    ) -> Result<World, JsError> {
        let mut files = arguments::files(files)?;
        let given = arguments::scene(scene)?;
        let (capacity, seed) = (self::capacity(capacity)?, self::seed(seed)?);
        let Loaded { file, model, mut warnings } = Loaded::new(&given, &mut files)?;
        let first = model.particles.len() as u32;
        let capacity = capacity.unwrap_or_else(|| file.run.capacity.max(first));
        if capacity < first {
            warnings.push(format!(
                "a capacity of {capacity} is less than the {first} particles that the scene begins with: the last of them are refused, and bodies that these are part of are cut"
            ));
        }
        let system = System::with(heap(&model, capacity)?);
        let has_trails = model.materials.iter().any(|material| material.trail.is_some());
        let slots = if has_trails { capacity as usize } else { 0 };
        let rings = memory::filled(Ring::NONE, slots, "the trails of the scene")?;
        let knots = memory::filled(Knot::NONE, slots.saturating_mul(KNOTS), "the trails of the scene")?;
        memory::room(model.particles.len(), "the scene")?;
        let covered = draw::covered(&model);
        let (seed, light) = (seed.unwrap_or(file.run.seed), file.light_on_strands(Vec3::ZERO));
        let clock = Clock::new(file.run.dt);
        let state = State { system, clock, widest: 0.0, rings, knots };
        let reaches = model.forces.2.iter().map(|push| push.reach).collect();
        let (saved, blows) = (Saved::default(), Blows::default());
        let mut world = Self { model, reaches, state, saved, blows, seed, warnings, light, covered };
        world.restart()?;
        Ok(world)
    }

    /// Back to the beginning; what was put in since is gone, and of the time that `advance` has been told nothing is left over.
    ///
    /// # Errors
    /// None that a loaded scene can meet.
    pub fn restart(&mut self) -> Result<(), JsError> {
        memory::room_for_little()?;
        self.state.system.start(&self.model.scene(), self.seed)?;
        (self.state.clock, self.state.widest) = (Clock::new(self.state.clock.dt), 0.0);
        self.reach_all();
        self.state.rings.fill(Ring::NONE);
        self.blows.clear();
        self.remember();
        Ok(())
    }

    /// Moves the world on by the time that has gone by \[s\], in steps of the scene's own length (`dt`): what a page calls every frame.
    ///
    /// Steps end at multiples of `dt`, as those of the command line do but for its last, which ends with `duration`; so a run does not
    /// depend on how long frames last. What is left over counts for the next call. There are `most` steps at the most, by default as many
    /// as make a tenth of a second, and no fewer than 8; time beyond that is dropped, so that a tab which was hidden, or a machine which is
    /// too slow, falls behind and does not freeze.
    ///
    /// Returns the share of the next step that has gone by, from 0 to 1: who draws what is between the places before the last step and
    /// those after it, by that share, has smooth pictures at any rate of frames.
    ///
    /// # Errors
    /// If the time is no finite number, or below zero, or would be beyond the end of time, 2^32 s; or `most` is no whole number above zero.
    pub fn advance(
        &mut self,
        #[wasm_bindgen(unchecked_param_type = "number")] elapsed: &JsValue,
        #[wasm_bindgen(unchecked_optional_param_type = "number | null")] most: &JsValue,
    ) -> Result<f64, JsError> {
        let elapsed = seconds("advance", elapsed)?;
        let most = arguments::most(most)?.unwrap_or_else(|| self.state.clock.usual());
        self.blows.clear();
        for _ in 0..self.state.clock.take(elapsed, most) {
            let end = instant("advance", self.state.clock.next(self.state.system.time()))?;
            self.go_to(end);
        }
        Ok(self.state.clock.share())
    }

    /// Moves the world on by `seconds` in ONE step of the method, whatever `dt` the scene says.
    ///
    /// A step that is too long is not divided: cloth, links and stacks fly apart or explode, quick balls pass each other. A page
    /// whose frames may last longer than `dt` wants `advance`.
    ///
    /// # Errors
    /// If that is no finite number, or below zero, or would be beyond the end of time, 2^32 s.
    pub fn step(&mut self, #[wasm_bindgen(unchecked_param_type = "number")] seconds: &JsValue) -> Result<(), JsError> {
        let seconds = self::seconds("step", seconds)?;
        instant("step", self.state.system.time().seconds_f64() + seconds)?;
        let dt = instant("step", seconds)?;
        self.blows.clear();
        self.state.system.step_observed(&self.model.scene(), dt, self.blows.observer());
        self.remember();
        Ok(())
    }

    /// Moves the world on, in ONE step of the method, to the instant `seconds`; not back. Stepping to n / 60 does not drift.
    ///
    /// A step that is too long is not divided, as of `step`: `advance` makes as many as are needed.
    ///
    /// # Errors
    /// If that is no finite number, or below zero, or would be beyond the end of time, 2^32 s.
    #[wasm_bindgen(js_name = stepTo)]
    pub fn step_to(
        &mut self,
        #[wasm_bindgen(unchecked_param_type = "number")] seconds: &JsValue,
    ) -> Result<(), JsError> {
        let end = instant("stepTo", self::seconds("stepTo", seconds)?)?;
        self.blows.clear();
        self.go_to(end);
        Ok(())
    }

    /// Saves the world as it is now, to go back to: returns the number of that state, which no other state of this world has.
    ///
    /// It takes as much memory again as the world, until `forget` or `free`. What has been put in and taken out, columns that have been written to, and what
    /// `advance` has left over are part of it. From there the world goes on to the same bits.
    ///
    /// # Errors
    /// If there is not enough memory.
    pub fn save(&mut self) -> Result<u32, JsError> {
        self.saved.save(&self.state)
    }

    /// Goes back to a state, or on to one, by its number out of `save`. It stays saved, and views stay what they are. No memory is asked for.
    ///
    /// # Errors
    /// If no state of that number is saved.
    pub fn restore(&mut self, #[wasm_bindgen(unchecked_param_type = "number")] state: &JsValue) -> Result<(), JsError> {
        self.saved.restore(arguments::state(state)?, &mut self.state)?;
        self.reach_all();
        self.blows.clear();
        Ok(())
    }

    /// Gives back the memory of a state, by its number out of `save`; returns whether there was one.
    ///
    /// # Errors
    /// If that is no number that a state can have.
    pub fn forget(
        &mut self,
        #[wasm_bindgen(unchecked_param_type = "number")] state: &JsValue,
    ) -> Result<bool, JsError> {
        Ok(self.saved.forget(arguments::state(state)?))
    }

    /// Notes from now on who is struck: by scenery or by others, `least` m/s or faster, 0.1 by default, along the normal of what it meets. What
    /// lies still is slower than that.
    ///
    /// Each call of `advance`, `step` and `stepTo` begins a new list, of `most` blows at the most, 256 by default; `missedBlows` counts those beyond
    /// them. With 0 nothing is noted any more, and steps are as fast as before.
    ///
    /// # Errors
    /// If the speed is no number, or below zero, or `most` no whole number, or there is not enough memory.
    pub fn listen(
        &mut self,
        #[wasm_bindgen(unchecked_optional_param_type = "number | null")] least: &JsValue,
        #[wasm_bindgen(unchecked_optional_param_type = "number | null")] most: &JsValue,
    ) -> Result<(), JsError> {
        let (least, most) = (arguments::speed(least)?, arguments::blows(most)?);
        self.blows.listen(least.unwrap_or(LISTENED), most.unwrap_or(NOTED))
    }

    /// The blows of the last call of `advance`, `step` or `stepTo`, after `listen`: 12 numbers each. Where it was \[m\] (x, y, z: the middle of a
    /// ball, the place on a rigid body), the normal of what it met, toward it (x, y, z), by how much its velocity has changed (x, y, z, m/s), how fast
    /// the two came together along the normal \[m/s\], its mass \[kg\], and how long before `time` that was \[s\]. A copy.
    ///
    /// A pair that meets has a blow for each of both that can move.
    ///
    /// # Errors
    /// If there is not enough memory.
    #[wasm_bindgen(unchecked_return_type = "Float32Array<ArrayBuffer>")]
    pub fn blows(&self) -> Result<Float32Array, JsError> {
        memory::floats(&self.blows.numbers(self.state.system.time())?)
    }

    /// The ids of who was struck, for each of the `blows`: its own, as `ids` has it, and that of whom it met, 4294967295 for scenery. A rigid body
    /// goes by its first particle. A copy.
    ///
    /// # Errors
    /// If there is not enough memory.
    #[wasm_bindgen(unchecked_return_type = "Uint32Array<ArrayBuffer>")]
    pub fn struck(&self) -> Result<Uint32Array, JsError> {
        memory::words(&self.blows.ids()?)
    }

    /// The number of blows beyond those that `listen` made room for, in the last call of `advance`, `step` or `stepTo`.
    #[wasm_bindgen(getter, js_name = missedBlows)]
    #[must_use]
    pub fn missed_blows(&self) -> u32 {
        self.blows.missed()
    }

    /// The length of the scene's steps \[s\], `run.dt` there: that of the steps of `advance`.
    #[wasm_bindgen(getter)]
    #[must_use]
    pub fn dt(&self) -> f64 {
        self.state.clock.dt
    }

    /// The instant it has reached \[s\].
    #[wasm_bindgen(getter)]
    #[must_use]
    pub fn time(&self) -> f64 {
        self.state.system.time().seconds_f64()
    }

    /// Puts a particle in now: an object like an entry of the scene's list `particles`, read and checked as such. Its columns of a user's own
    /// are zero, it is bound by nothing, and rigid bodies meet it only if the scene has loose balls of its own.
    ///
    /// Returns its id, as `ids` has it; nothing, where there is no room for it, which the report counts as refused.
    ///
    /// # Errors
    /// If it cannot be used, with the path of what is wrong, or there is not enough memory.
    pub fn spawn(
        &mut self,
        #[wasm_bindgen(unchecked_param_type = "Particle")] particle: &JsValue,
    ) -> Result<Option<u32>, JsError> {
        let text = arguments::particle(particle)?;
        let particle = scene::particle(&text, &mut self.model)?;
        let id = self.state.system.spawn(&particle).ok().map(Id::serial);
        if id.is_some() {
            self.state.widest = self.state.widest.max(2.0 * particle.radius);
            self.reach_all();
        }
        Ok(id)
    }

    /// Takes a particle out, by its id out of `ids` or `spawn`; returns whether it was alive. Rows change as when one dies.
    ///
    /// # Errors
    /// If that is no number that an id can have.
    pub fn remove(&mut self, #[wasm_bindgen(unchecked_param_type = "number")] id: &JsValue) -> Result<bool, JsError> {
        let id = arguments::id(id)?;
        let row = self.state.system.particles().serial.iter().position(|&serial| serial == id);
        let id = row.and_then(|row| self.state.system.id(row));
        Ok(id.is_some_and(|id| self.state.system.remove(&self.model.scene(), id)))
    }

    /// Particles alive.
    #[wasm_bindgen(getter)]
    #[must_use]
    pub fn count(&self) -> u32 {
        self.state.system.len() as u32
    }

    /// The number of particles that may live at once.
    #[wasm_bindgen(getter)]
    #[must_use]
    pub fn capacity(&self) -> u32 {
        self.state.system.capacity() as u32
    }

    /// Positions \[m\], three numbers a particle: a view onto the module's memory, not a copy. It may be written to.
    ///
    /// It has room for `capacity` particles; the first `count` are alive, and what is behind them means nothing. `advance`, `step`, `stepTo`,
    /// `restart` and `restore` change what it shows and never detach it. All else may make the module's memory grow, lists that are copies, other
    /// worlds and files above all: its length is zero then, and it has to be asked for anew. That costs next to nothing, so a loop may do it
    /// every frame. A view does not keep its world: when that is freed, or collected as nobody holds it any more, the view shows whatever
    /// comes to lie there.
    #[must_use]
    pub fn positions(&self) -> Float32Array {
        view(bytemuck::cast_slice(self.state.system.memory().columns().position))
    }

    /// Velocities \[m/s\], as `positions`.
    #[must_use]
    pub fn velocities(&self) -> Float32Array {
        view(bytemuck::cast_slice(self.state.system.memory().columns().velocity))
    }

    /// Radii \[m\], one number a particle, zero for points: a view as `positions`.
    #[must_use]
    pub fn radii(&self) -> Float32Array {
        view(self.state.system.memory().columns().radius)
    }

    /// A column of the scene's list `custom`, one number a particle: a view as `positions`.
    ///
    /// # Errors
    /// If it is no string, or the scene has no column of that name.
    pub fn custom(&self, name: &JsString) -> Result<Float32Array, JsError> {
        let name = files::short("a column", name)?;
        let (columns, capacity) = (self.state.system.memory().columns(), self.state.system.capacity());
        let number = self.model.custom.iter().position(|custom| custom.name == name);
        let column = number.and_then(|number| columns.kept.get(number * capacity..(number + 1) * capacity));
        let column = column.ok_or_else(|| JsError::new(&format!("the scene has no column \"{name}\" in `custom`")))?;
        Ok(view(bytemuck::cast_slice(column)))
    }

    /// The number of each living particle's material in the scene, from 0; -1, where it has none. A copy.
    ///
    /// # Errors
    /// If there is not enough memory.
    #[wasm_bindgen(unchecked_return_type = "Int32Array<ArrayBuffer>")]
    pub fn materials(&self) -> Result<Int32Array, JsError> {
        draw::materials_of(&self.state.system.state(&self.model.scene()))
    }

    /// The rows of those that are to be drawn as points or balls: all that can be seen and are not drawn as `sprites`, `shapes`, `boxes`,
    /// `surfaces` or `strands`. Their places are in `positions`, the rest of how they look in `colors` and `looks`. A copy.
    ///
    /// # Errors
    /// If there is not enough memory.
    #[wasm_bindgen(unchecked_return_type = "Uint32Array<ArrayBuffer>")]
    pub fn points(&self) -> Result<Uint32Array, JsError> {
        let serial = self.state.system.particles().serial;
        draw::points_of(&self.state.system.state(&self.model.scene()), serial, &self.covered)
    }

    /// Colours of the living as they look now, four bytes a particle: red, green, blue, opacity, by materials and ages. A copy.
    ///
    /// # Errors
    /// If there is not enough memory.
    #[wasm_bindgen(unchecked_return_type = "Uint8Array<ArrayBuffer>")]
    pub fn colors(&self) -> Result<Uint8Array, JsError> {
        let colors = self.appearances("the colours", |look| look.color)?;
        memory::bytes(colors.as_flattened())
    }

    /// The rest of how the living look now, four numbers a particle: the diameter \[m\], zero for points, which take
    /// what suits the picture; the factor that is in it, for points; from 0, a lit ball, to 1, a glow; and the angle by
    /// which a picture of it is turned anticlockwise \[rad\]. A copy.
    ///
    /// # Errors
    /// If there is not enough memory.
    #[wasm_bindgen(unchecked_return_type = "Float32Array<ArrayBuffer>")]
    pub fn looks(&self) -> Result<Float32Array, JsError> {
        let looks = self.appearances("the looks", |look| [look.diameter, look.scale, look.glow, look.rotation])?;
        memory::floats(looks.as_flattened())
    }

    /// The pictures of the living whose material has a sprite, seen from `eye` with `up` upright (`[0, 1, 0]`, where nothing is said), the
    /// farthest first, 16 numbers each: centre, the ways to the middles of the right side and of the top \[m\], red, green, blue, opacity from
    /// 0 to 1, the material's number, the frame of its flipbook, and how it is laid on: 0 alpha, 1 premultiplied, 2 additive, 3 opaque. A copy.
    ///
    /// # Errors
    /// If these are not three finite numbers each, or there is not enough memory.
    #[wasm_bindgen(unchecked_return_type = "Float32Array<ArrayBuffer>")]
    pub fn sprites(
        &self,
        #[wasm_bindgen(unchecked_param_type = "readonly number[] | Float32Array | Float64Array")] eye: &JsValue,
        #[wasm_bindgen(unchecked_optional_param_type = "readonly number[] | Float32Array | Float64Array | null")]
        up: &JsValue,
    ) -> Result<Float32Array, JsError> {
        let up = if up.is_undefined() || up.is_null() { Vec3::Y } else { place("up", up)? };
        let (view, scene) = (View { eye: place("eye", eye)?, up }, self.model.scene());
        draw::sprites_of(&self.state.system.state(&scene), &view)
    }

    /// The living whose material has a shape, 17 numbers each: where the shape's origin is, the images of its three axes \[m\], red, green,
    /// blue, opacity from 0 to 1, the material's number. A copy.
    ///
    /// # Errors
    /// If there is not enough memory.
    #[wasm_bindgen(unchecked_return_type = "Float32Array<ArrayBuffer>")]
    pub fn shapes(&self) -> Result<Float32Array, JsError> {
        draw::shapes_of(&self.state.system.state(&self.model.scene()))
    }

    /// The rigid boxes of the scene that can be seen, 17 numbers each: the middle, the ways from there to the middles of three sides \[m\], red,
    /// green, blue, opacity from 0 to 1, and the material's number, -1 for none. A copy.
    ///
    /// # Errors
    /// If there is not enough memory.
    #[wasm_bindgen(unchecked_return_type = "Float32Array<ArrayBuffer>")]
    pub fn boxes(&self) -> Result<Float32Array, JsError> {
        draw::boxes_of(&self.state.system.state(&self.model.scene()), &self.model)
    }

    /// The surfaces of cloths and of rigid bodies that are no boxes, 30 numbers a triangle, which is seen anticlockwise from outside: for each
    /// corner its place \[m\], the normal there, red, green, blue, opacity from 0 to 1. Triangles where a cloth is torn are left out. A copy.
    ///
    /// # Errors
    /// If there is not enough memory.
    #[wasm_bindgen(unchecked_return_type = "Float32Array<ArrayBuffer>")]
    pub fn surfaces(&self) -> Result<Float32Array, JsError> {
        draw::surfaces_of(&self.state.system.state(&self.model.scene()), &self.model)
    }

    /// The segments of strands, and of the scene's `ropes`, as lines like `springs`, in the scene's light as it is seen from `eye`, each
    /// strand from root to tip. A copy.
    ///
    /// # Errors
    /// If that is not three finite numbers, or there is not enough memory.
    #[wasm_bindgen(unchecked_return_type = "Float32Array<ArrayBuffer>")]
    pub fn strands(
        &self,
        #[wasm_bindgen(unchecked_param_type = "readonly number[] | Float32Array | Float64Array")] eye: &JsValue,
    ) -> Result<Float32Array, JsError> {
        let light = StrandLight { eye: place("eye", eye)?, ..self.light };
        draw::strands_of(&self.state.system.state(&self.model.scene()), &self.model, &light)
    }

    /// The springs that hold, those of cloths as well, as lines of 16 numbers each: both ends \[m\], the widths there \[m\], zero for about a pixel, and the
    /// colours there, red, green, blue, opacity from 0 to 1: the redder the longer and the bluer the shorter than at rest, altogether at a strain of
    /// `full`, which is 0.1 where nothing is said. A copy.
    ///
    /// # Errors
    /// If `full` is no finite number above zero, or there is not enough memory.
    #[wasm_bindgen(unchecked_return_type = "Float32Array<ArrayBuffer>")]
    pub fn springs(
        &self,
        #[wasm_bindgen(unchecked_optional_param_type = "number | null")] full: &JsValue,
    ) -> Result<Float32Array, JsError> {
        let full = strain(full)?.unwrap_or(FULL_STRAIN);
        draw::springs_of(&self.state.system.state(&self.model.scene()), full)
    }

    /// The straight links of constraints (chains, bridges, bars), as lines like `springs`, by their strain as those are. Segments of the scene's
    /// `ropes` are among `strands`. A copy.
    ///
    /// # Errors
    /// As of `springs`.
    #[wasm_bindgen(unchecked_return_type = "Float32Array<ArrayBuffer>")]
    pub fn links(
        &self,
        #[wasm_bindgen(unchecked_optional_param_type = "number | null")] full: &JsValue,
    ) -> Result<Float32Array, JsError> {
        let full = strain(full)?.unwrap_or(FULL_STRAIN);
        draw::links_of(&self.state.system.state(&self.model.scene()), &self.model, full)
    }

    /// The trails that particles have left since `restart`, from step to step, as lines like `springs`, each trail from its particle
    /// backward. A copy.
    ///
    /// # Errors
    /// If there is not enough memory.
    #[wasm_bindgen(unchecked_return_type = "Float32Array<ArrayBuffer>")]
    pub fn trails(&mut self) -> Result<Float32Array, JsError> {
        let mut list = memory::filled(Line::NONE, self.state.knots.len() + self.state.rings.len(), "the trails")?;
        let scene = self.model.scene();
        let trails = Trails::new(&mut self.state.rings, &mut self.state.knots, None);
        let (count, _) = trails.lines(&self.state.system.state(&scene), &mut list);
        draw::lines("the trails", &list[..count])
    }

    /// Which of the living is in which row: numbers unique over the run, from 0. A copy.
    ///
    /// # Errors
    /// If there is not enough memory.
    #[wasm_bindgen(unchecked_return_type = "Uint32Array<ArrayBuffer>")]
    pub fn ids(&self) -> Result<Uint32Array, JsError> {
        memory::words(self.state.system.particles().serial)
    }

    /// The state's fingerprint, 16 hexadecimal digits: equal on every machine for equal scenes, seeds and steps.
    ///
    /// # Errors
    /// If there is not enough memory.
    pub fn hash(&self) -> Result<String, JsError> {
        memory::room_for_little()?;
        Ok(format!("{:016x}", self.state.system.hash()))
    }

    /// The report of what happened since the beginning, as JSON: counters of births, deaths, hits and bounds met.
    ///
    /// # Errors
    /// If there is not enough memory.
    pub fn report(&self) -> Result<String, JsError> {
        memory::room_for_little()?;
        Ok(serde_json::to_string(self.state.system.totals()).unwrap_or_default())
    }

    /// The remarks that reading the scene gave cause to: on old names, on what can be run but is hardly meant.
    ///
    /// # Errors
    /// If there is not enough memory.
    #[wasm_bindgen(getter)]
    pub fn warnings(&self) -> Result<Vec<String>, JsError> {
        let bytes: usize = self.warnings.iter().map(|warning| warning.len() + size_of::<String>()).sum();
        memory::room(2 * bytes, "the warnings")?;
        Ok(self.warnings.clone())
    }
}

/// Numbers where they lie.
#[allow(unsafe_code)]
fn view(numbers: &[f32]) -> Float32Array {
    let Some(first) = numbers.first() else { return Float32Array::new_with_length(0) };
    // SAFETY: the pointer and length are those of a slice.
    // JavaScript may keep the view: it then reads memory that belongs to the module as long as that lives, which
    // cannot break any invariant of Rust's, since every bit pattern is an `f32`.
    unsafe { Float32Array::view_mut_raw((&raw const *first).cast_mut(), numbers.len()) }
}
