//! pointmass for JavaScript. `wasm/build` makes the npm package of it.
//!
//! ```js
//! import init, { World } from "pointmass";
//! await init();
//! const world = new World(scene);              // an object, or a text: .json or .scn
//! const start = performance.now();
//! requestAnimationFrame(function frame(now) {
//!   world.stepTo(Math.max(0, now - start) / 1000);
//!   draw(world.positions(), world.count);      // Float32Array: x, y, z by x, y, z
//!   requestAnimationFrame(frame);
//! });
//! ```

mod arguments;
mod draw;
mod files;
mod memory;

pub use files::Files;

use arguments::{capacity, place, seconds, seed, text};
use js_sys::{Float32Array, JsString, Uint8Array, Uint32Array};
use pointmass::draw::{Appearance, Knot, Line, Ring, StrandLight, Trails, View, appearance};
use pointmass::scene::{Model, SceneFile, read_scn};
use pointmass::{Heap, Storage, System, Vec3};
use wasm_bindgen::prelude::*;

/// The version of this package.
#[wasm_bindgen]
#[must_use]
pub fn version() -> String {
    env!("CARGO_PKG_VERSION").to_owned()
}

/// A scene in motion. All its memory is taken when it is made; stepping takes none.
#[wasm_bindgen]
#[derive(Debug)]
pub struct World {
    model: Model,
    system: System<Heap>,
    seed: u64,
    warnings: Vec<String>,
    /// The light on strands, for an eye at the origin.
    light: StrandLight,
    /// The memory of trails, where some material leaves one.
    rings: Vec<Ring>,
    knots: Vec<Knot>,
}

/// The places that are remembered of each trail.
const KNOTS: usize = 48;

impl World {
    /// Something of how each of the living looks.
    fn appearances<T>(&self, of: impl Fn(Appearance) -> T) -> Vec<T> {
        let scene = self.model.scene();
        let state = self.system.state(&scene);
        (0..self.system.len()).filter_map(|row| appearance(&state, row)).map(of).collect()
    }

    /// Lets trails remember where everybody is.
    fn remember(&mut self) {
        if self.rings.is_empty() {
            return;
        }
        let scene = self.model.scene();
        Trails::new(&mut self.rings, &mut self.knots, None).look(&self.system.state(&scene));
    }
}

#[wasm_bindgen]
impl World {
    /// Loads a scene: an object as JSON has it, its text, or a text in `.scn`; with the files it names.
    ///
    /// `capacity` is how many particles may live at once and `seed` that of all randomness; by default both are what
    /// the scene says.
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
        let text = text(scene)?;
        let (capacity, seed) = (self::capacity(capacity)?, self::seed(seed)?);
        memory::room_to_read(&text)?;
        let (file, warnings) = if text.trim_start_matches('\u{feff}').trim_start().starts_with('{') {
            (SceneFile::from_json("scene", &text)?, Vec::new())
        } else {
            read_scn("scene", &text, &mut files)?
        };
        memory::room_to_build(&file, &files)?;
        let model = Model::load(&file, "scene", &mut files)?;
        let capacity = capacity.unwrap_or_else(|| file.run.capacity.max(model.particles.len() as u32));
        let mut likeness = model.scene().likeness();
        // JavaScript may write where it looks: that must not be shared with other columns.
        likeness.own.radius = true;
        let heap = Heap::alike(model.size(capacity as usize), &likeness).map_err(|_| {
            JsError::new(&format!("there is not enough memory for {capacity} particles: take a smaller capacity"))
        })?;
        let has_trails = model.materials.iter().any(|material| material.trail.is_some());
        let slots = if has_trails { capacity as usize } else { 0 };
        memory::room(slots.saturating_mul(size_of::<[Knot; KNOTS]>() + size_of::<Ring>()), "the trails of the scene")?;
        let (rings, knots) = (vec![Ring::NONE; slots], vec![Knot::NONE; slots * KNOTS]);
        let (seed, light) = (seed.unwrap_or(file.run.seed), file.light_on_strands(Vec3::ZERO));
        let mut world = Self { model, system: System::with(heap), seed, warnings, light, rings, knots };
        world.restart()?;
        Ok(world)
    }

    /// Back to the beginning.
    ///
    /// # Errors
    /// None that a loaded scene can meet.
    pub fn restart(&mut self) -> Result<(), JsError> {
        self.system.start(&self.model.scene(), self.seed)?;
        self.rings.fill(Ring::NONE);
        self.remember();
        Ok(())
    }

    /// Moves the world on by `seconds`.
    ///
    /// # Errors
    /// If that is no finite number, or below zero.
    pub fn step(&mut self, seconds: f64) -> Result<(), JsError> {
        let dt = self::seconds("step", seconds)?;
        self.system.step(&self.model.scene(), dt);
        self.remember();
        Ok(())
    }

    /// Moves the world on, in one step, to the instant `seconds`; not back. Stepping to n / 60 does not drift.
    ///
    /// # Errors
    /// If that is no finite number, or below zero.
    #[wasm_bindgen(js_name = stepTo)]
    pub fn step_to(&mut self, seconds: f64) -> Result<(), JsError> {
        let dt = self::seconds("stepTo", seconds)? - self.system.time();
        self.system.step(&self.model.scene(), dt);
        self.remember();
        Ok(())
    }

    /// The instant it has reached \[s\].
    #[wasm_bindgen(getter)]
    #[must_use]
    pub fn time(&self) -> f64 {
        self.system.time().seconds_f64()
    }

    /// Particles alive.
    #[wasm_bindgen(getter)]
    #[must_use]
    pub fn count(&self) -> u32 {
        self.system.len() as u32
    }

    /// The number of particles that may live at once.
    #[wasm_bindgen(getter)]
    #[must_use]
    pub fn capacity(&self) -> u32 {
        self.system.capacity() as u32
    }

    /// Positions \[m\], three numbers a particle: a view into the module's memory, not a copy.
    ///
    /// It has room for `capacity` particles; the first `count` are alive, and what is behind them means nothing. It stays
    /// where it is while the world lives, and `step`, `stepTo` and `restart` do not detach it. All else may make the
    /// module's memory grow, other worlds and files above all: its length is zero then, and it has to be asked for anew.
    /// That costs next to nothing, so a loop may do it every frame.
    #[must_use]
    pub fn positions(&self) -> Float32Array {
        view(bytemuck::cast_slice(self.system.memory().columns().position))
    }

    /// Velocities \[m/s\], as `positions`.
    #[must_use]
    pub fn velocities(&self) -> Float32Array {
        view(bytemuck::cast_slice(self.system.memory().columns().velocity))
    }

    /// Radii \[m\], one number a particle, zero for points: a view as `positions`.
    #[must_use]
    pub fn radii(&self) -> Float32Array {
        view(self.system.memory().columns().radius)
    }

    /// A column of the scene's list `custom`, one number a particle: a view as `positions`.
    ///
    /// # Errors
    /// If it is no string, or the scene has no column of that name.
    pub fn custom(&self, name: &JsString) -> Result<Float32Array, JsError> {
        let name = name.as_string().ok_or_else(|| JsError::new("the name of a column has to be a string"))?;
        let (columns, capacity) = (self.system.memory().columns(), self.system.capacity());
        let number = self.model.custom.iter().position(|custom| custom.name == name);
        let column = number.and_then(|number| columns.kept.get(number * capacity..(number + 1) * capacity));
        let column = column.ok_or_else(|| JsError::new(&format!("the scene has no column \"{name}\" in `custom`")))?;
        Ok(view(bytemuck::cast_slice(column)))
    }

    /// Colours of the living as they look now, four bytes a particle: red, green, blue, opacity, by materials and ages. A copy.
    #[must_use]
    pub fn colors(&self) -> Uint8Array {
        let colors: Vec<_> = self.appearances(|look| look.color);
        Uint8Array::from(colors.as_flattened())
    }

    /// The rest of how the living look now, four numbers a particle: the diameter \[m\], zero for points, which take
    /// what suits the picture; the factor that is in it, for points; from 0, a lit ball, to 1, a glow; and the angle by
    /// which a picture of it is turned anticlockwise \[rad\]. A copy.
    #[must_use]
    pub fn looks(&self) -> Float32Array {
        let looks: Vec<_> = self.appearances(|look| [look.diameter, look.scale, look.glow, look.rotation]);
        Float32Array::from(looks.as_flattened())
    }

    /// The pictures of the living whose material has a sprite, seen from `eye` with `up` upright (`[0, 1, 0]`, where nothing is said), the
    /// farthest first, 16 numbers each: centre, the ways to the middles of the right side and of the top \[m\], red, green, blue, opacity from
    /// 0 to 1, the material's number, the frame of its flipbook, and how it is laid on: 0 alpha, 1 premultiplied, 2 additive, 3 opaque. A copy.
    ///
    /// # Errors
    /// If these are not three finite numbers each.
    pub fn sprites(
        &self,
        #[wasm_bindgen(unchecked_param_type = "ArrayLike<number>")] eye: &JsValue,
        #[wasm_bindgen(unchecked_optional_param_type = "ArrayLike<number> | null")] up: &JsValue,
    ) -> Result<Float32Array, JsError> {
        let up = if up.is_undefined() || up.is_null() { Vec3::Y } else { place("up", up)? };
        let (view, scene) = (View { eye: place("eye", eye)?, up }, self.model.scene());
        Ok(draw::sprites_of(&self.system.state(&scene), &view))
    }

    /// The living whose material has a shape, 17 numbers each: where the shape's origin is, the images of its three axes \[m\], red, green,
    /// blue, opacity from 0 to 1, the material's number. A copy.
    #[must_use]
    pub fn shapes(&self) -> Float32Array {
        draw::shapes_of(&self.system.state(&self.model.scene()))
    }

    /// The rigid boxes of the scene that can be seen, 17 numbers each: the middle, the ways from there to the middles of three sides \[m\], red,
    /// green, blue, opacity from 0 to 1, and the material's number. A copy.
    #[must_use]
    pub fn boxes(&self) -> Float32Array {
        draw::boxes_of(&self.system.state(&self.model.scene()), &self.model)
    }

    /// The surfaces of cloths and of rigid bodies that are no boxes, 30 numbers a triangle, which is seen anticlockwise from outside: for each
    /// corner its place \[m\], the normal there, red, green, blue, opacity from 0 to 1. Triangles where a cloth is torn are left out. A copy.
    #[must_use]
    pub fn surfaces(&self) -> Float32Array {
        draw::surfaces_of(&self.system.state(&self.model.scene()), &self.model)
    }

    /// The segments of strands as lines like `springs`, in the scene's light as it is seen from `eye`, each strand from root to tip. A copy.
    ///
    /// # Errors
    /// If that is not three finite numbers.
    pub fn strands(
        &self,
        #[wasm_bindgen(unchecked_param_type = "ArrayLike<number>")] eye: &JsValue,
    ) -> Result<Float32Array, JsError> {
        let light = StrandLight { eye: place("eye", eye)?, ..self.light };
        Ok(draw::strands_of(&self.system.state(&self.model.scene()), &self.model, &light))
    }

    /// The springs that hold, as lines of 16 numbers each: both ends \[m\], the widths there \[m\], zero for about a pixel, and the colours there,
    /// red, green, blue, opacity from 0 to 1: the redder the longer and the bluer the shorter than at rest, altogether at a strain of
    /// `full`, which is 0.1 where nothing is said. A copy.
    #[must_use]
    pub fn springs(&self, full: Option<f32>) -> Float32Array {
        draw::springs_of(&self.system.state(&self.model.scene()), full.unwrap_or(0.1))
    }

    /// The trails that particles have left since `restart`, from step to step, as lines like `springs`, each trail from its particle
    /// backward. A copy.
    #[must_use]
    pub fn trails(&mut self) -> Float32Array {
        let mut list = vec![Line::NONE; self.knots.len() + self.rings.len()];
        let scene = self.model.scene();
        let trails = Trails::new(&mut self.rings, &mut self.knots, None);
        let (count, _) = trails.lines(&self.system.state(&scene), &mut list);
        draw::lines(&list[..count])
    }

    /// Which of the living is in which row: numbers unique over the run, from 0. A copy.
    #[must_use]
    pub fn ids(&self) -> Uint32Array {
        Uint32Array::from(self.system.particles().serial)
    }

    /// The state's fingerprint, 16 hexadecimal digits: equal on every machine for equal scenes, seeds and steps.
    #[must_use]
    pub fn hash(&self) -> String {
        format!("{:016x}", self.system.hash())
    }

    /// The report of what happened since the beginning, as JSON: counters of births, deaths, hits and bounds met.
    #[must_use]
    pub fn report(&self) -> String {
        serde_json::to_string(self.system.totals()).unwrap_or_default()
    }

    /// The remarks that reading the scene gave cause to.
    #[wasm_bindgen(getter)]
    #[must_use]
    pub fn warnings(&self) -> Vec<String> {
        self.warnings.clone()
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
