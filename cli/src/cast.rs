//! The moving things, as the renderer sees them: particles in the looks of their materials, or in a style of the lecture's.

mod links;

use crate::show::{Show, lines};
use crate::shutter::Shutter;
use crate::stage::{look, moves, tessellate};
use crate::style::{Style, Styled};
use crate::viewpoint::Viewpoint;
use glam::Vec3;
use pointmass::draw::{
    Appearance, Instance, Knot, Line, Ring, Sprite, Trails, Vertex, View, appearance, body, solid, sprite, strained,
    strains, surface,
};
use pointmass::force::State;
use pointmass::scene::{Material, Model, PatchBuf, SceneFile};
use pointmass::{Color, Heap, RigidBox, System, Time};
use pointmass_draw::{self as draw, Billboard, Dot, Piece, Surface, shapes};
use std::collections::HashMap;

/// The part of the picture's width that a point without a size of its own takes up in the middle of the scene.
const DOT: f32 = 0.009;

/// The same of arrows.
const ARROW: f32 = 0.06;

/// The places that are remembered of each trail.
const KNOTS: usize = 48;

/// The strain at which all is red, or blue, where it is drawn by that.
const FULL_STRAIN: f32 = 0.1;

/// Pixels between places where a thing is seen while the shutter is open, how often that is at most, and at least where scenery moves.
const PACE: f32 = 2.0;
const MOST_EXPOSURES: u32 = 32;
const LEAST_EXPOSURES: u32 = 8;

/// How deep in a surface the pictures that a style draws still show whole, in their radii.
const SUNK: f32 = 2.5;

/// How far before what it lies on a cloth is drawn, in sides of its triangles.
const LIFT: f32 = 0.3;

/// A particle's way since the picture before, remembered by its serial, and how points are drawn.
pub(crate) struct Cast<'m> {
    before: HashMap<u32, Vec3>,
    /// The diameter of points whose material has none \[m\].
    size: f32,
    view: View,
    style: Option<Style>,
    show: Vec<Show>,
    /// The width of what the picture shows, in distances from the eye.
    width: f32,
    /// The length of arrows \[m\].
    arrow: f32,
    shutter: Option<Shutter>,
    trails: Option<Trails<'m>>,
    /// True for each particle of the start that is a corner of a surface, or in a body's box, which is drawn instead.
    covered: Vec<bool>,
    /// The shapes of particles, by their materials, about the origin.
    forms: Vec<Surface>,
}

/// The memory of trails, lent to whoever looks on.
#[derive(Default)]
pub(crate) struct Memory {
    rings: Vec<Ring>,
    knots: Vec<Knot>,
}

/// All that moves, at an instant.
#[derive(Default)]
pub(crate) struct Seen {
    pub(crate) instant: Time,
    pub(crate) dots: Vec<Dot>,
    pub(crate) billboards: Vec<Billboard>,
    pub(crate) segments: Vec<Line>,
    pub(crate) ribbons: Vec<Line>,
    /// Shapes and surfaces.
    pub(crate) pieces: Vec<Piece>,
}

/// Tells whether particles leave trails.
fn has_trails(file: &SceneFile, style: Option<Style>) -> bool {
    style == Some(Style::Trails) || style.is_none() && file.materials.iter().any(|material| material.trail.is_some())
}

impl Memory {
    /// As much as trails in a style take of as many particles as may live at once.
    pub(crate) fn new(file: &SceneFile, style: Option<Style>, capacity: usize) -> Self {
        let slots = if has_trails(file, style) { capacity } else { 0 };
        Self { rings: vec![Ring::NONE; slots], knots: vec![Knot::NONE; slots * KNOTS] }
    }
}

impl<'m> Cast<'m> {
    /// Nobody has been seen yet. `shutter` is how long it is open for each picture \[s\], if there is one.
    pub(crate) fn new(
        model: &Model,
        style: Option<Style>,
        show: &[Show],
        shutter: Option<f64>,
        from: &Viewpoint,
        memory: &'m mut Memory,
    ) -> Self {
        let mut covered = vec![false; model.particles.len()];
        for PatchBuf { first, count, .. } in model.patches.iter().filter(|_| style.is_none()) {
            covered[*first as usize..][..*count as usize].fill(true);
        }
        for RigidBox { first, count, .. } in model.constraints.1.boxes.iter().filter(|_| style.is_none()) {
            covered[*first as usize..][..*count as usize].fill(true);
        }
        for lock in model.locks.iter().filter(|_| style.is_none()) {
            covered[lock.first as usize..][..(lock.points * lock.count) as usize].fill(true);
        }
        let form = |shape: &Option<_>| shape.as_ref().map_or_else(Surface::default, |shape| tessellate(shape, 1.0));
        let forms = model.shapes.iter().map(form).collect();
        let Memory { rings, knots } = memory;
        let trails = (!rings.is_empty()).then(|| Trails::new(rings, knots, None));
        let Viewpoint { camera, middle } = from;
        let (width, distance) = (2.0 * camera.xfov.clamp(0.0, 1.5).tan(), (middle - camera.eye).length());
        let (size, arrow) = (DOT * width * distance, ARROW * width * distance);
        let view = View { eye: camera.eye, up: camera.up };
        let shutter = shutter.map(Shutter::new);
        let show = show.to_vec();
        Self { before: HashMap::new(), size, view, style, show, width, arrow, shutter, trails, covered, forms }
    }

    /// Tells whether particles are drawn along their ways.
    pub(crate) fn is_exposed(&self) -> bool {
        self.shutter.is_some()
    }

    /// Looks from elsewhere from now on; points keep their size.
    pub(crate) fn look(&mut self, camera: &draw::Camera) {
        self.view = View { eye: camera.eye, up: camera.up };
    }

    /// Tells whether there are shapes or surfaces, so that light and shadow change from picture to picture.
    pub(crate) fn has_pieces(&self, model: &Model) -> bool {
        let shapes = self.forms.iter().any(|form| !form.triangles.is_empty());
        let are_joined = !model.patches.is_empty() || !model.constraints.1.boxes.is_empty();
        shapes && matches!(self.style, None | Some(Style::Shapes)) || self.style.is_none() && are_joined
    }

    /// The length of arrows \[m\].
    pub(crate) fn arrow(&self) -> f32 {
        self.arrow
    }

    /// Waits for the picture at an instant \[s\].
    pub(crate) fn wait_for(&mut self, instant: f64) {
        if let Some(shutter) = &mut self.shutter {
            shutter.wait_for(instant);
        }
    }

    /// Looks on after a step: trails and shutters remember.
    pub(crate) fn remember(&mut self, system: &System<Heap>, model: &Model) {
        let scene = model.scene();
        if let Some(shutter) = &mut self.shutter {
            shutter.look(&system.state(&scene), system.particles().serial);
        }
        let Some(trails) = &mut self.trails else { return };
        styled(&system.state(&scene), self.style, self.size, |state| {
            trails.look(state);
        });
    }

    /// All as it is now; with an open shutter, as it has been at instants of that time, the last of them now, as many as it takes for what
    /// moves to come a few pixels farther each time. What is drawn along its way anyhow takes one.
    pub(crate) fn see(&mut self, system: &System<Heap>, file: &SceneFile, model: &Model, pixels: u32) -> Vec<Seen> {
        let scene = model.scene();
        let (state, serial) = (system.state(&scene), system.particles().serial);
        let begun: Vec<Vec3> = (0..serial.len()).map(|row| self.begun(&state, row, serial[row])).collect();
        let exposures = styled(&state, self.style, self.size, |state| self.exposures(state, &begun, model, pixels));
        let trails = self.trails(&state);
        let seen = (1..=exposures).map(|number| {
            let after = |number: u32| -> Vec<Vec3> {
                let share = number as f32 / exposures as f32;
                let ways = begun.iter().zip(state.position);
                let place = |(&from, &to): (&Vec3, &Vec3)| if number == exposures { to } else { from.lerp(to, share) };
                ways.map(place).collect()
            };
            let open = Time::from_seconds_f64(self.shutter.as_ref().map_or(0.0, Shutter::seconds));
            let left = open.ticks() / u64::from(exposures) * u64::from(exposures - number);
            let time = state.time - Time::from_ticks(left);
            let (begun, position) = (after(number - 1), &after(number));
            let begun: Vec<_> = serial.iter().copied().zip(begun).collect();
            self.seen_at(&State { time, position, ..state }, &begun, file, model)
        });
        let mut seen: Vec<_> = seen.collect();
        seen.iter_mut().for_each(|seen| seen.ribbons.extend_from_slice(&trails));
        self.close(&state, serial);
        seen
    }

    /// Where the way of the particle in a row begins in a picture.
    fn begun(&self, state: &State<'_>, row: usize, serial: u32) -> Vec3 {
        let position = state.position[row];
        let previous = match (&self.shutter, self.style) {
            (Some(shutter), _) => shutter.opening(state, row, serial),
            (None, None) => self.before.get(&serial).copied().unwrap_or(position),
            (None, Some(_)) => position,
        };
        // Whoever has come in at the other side of a room has come straight.
        state.near.room().map_or(previous, |room| position + room.between(position, previous))
    }

    /// The number of instants at which things are seen for a picture so many pixels wide.
    fn exposures(&self, state: &State<'_>, begun: &[Vec3], model: &Model, pixels: u32) -> u32 {
        let is_dot = |row: usize| sprite(state, row, &self.view).is_none() && solid(state, row).is_none();
        let are_joined = self.has_pieces(model) || !model.locks.is_empty() || !state.springs.springs.is_empty();
        let moved = |row: usize| {
            let (place, way) = (state.position[row], (state.position[row] - begun[row]).length());
            way * pixels as f32 / (self.width * (place - self.view.eye).length())
        };
        if self.shutter.as_ref().is_none_or(|shutter| shutter.seconds() == 0.0) {
            return 1;
        }
        let seen = (0..begun.len()).filter(|&row| are_joined || !is_dot(row)).map(moved);
        let scenery = if moves(model) { LEAST_EXPOSURES } else { 1 };
        // The cast sends what is no number to zero.
        ((seen.fold(0.0, f32::max) / PACE) as u32).clamp(scenery, MOST_EXPOSURES)
    }

    /// All in a state whose particles, by their serials, have come from other places.
    fn seen_at(&self, state: &State<'_>, begun: &[(u32, Vec3)], file: &SceneFile, model: &Model) -> Seen {
        let mut seen = Seen { instant: state.time, ..Seen::default() };
        styled(state, self.style, self.size, |state| {
            self.particles(state, begun, file, &mut seen);
            seen.segments = self.springs(state);
            seen.segments.extend(self.links(state, model));
            seen.segments.extend(lines(&self.show, state, model, file.run.index, self.arrow));
            if self.style.is_none() {
                let light = file.light_on_strands(self.view.eye);
                seen.ribbons.extend(model.locks.iter().flat_map(|lock| self.curves(state, lock, &light, model)));
                seen.pieces.extend(model.patches.iter().filter_map(|patch| self.cloth(state, patch, file, model)));
                let boxes = &model.constraints.1.boxes;
                let standing = boxes.iter().filter_map(|of| Some((of, body(state, of, &model.particles)?)));
                seen.pieces.extend(standing.map(|(of, instance)| rigid(&instance, (model, of), file)));
            }
        });
        seen
    }

    /// The trails as they are now.
    fn trails(&self, state: &State<'_>) -> Vec<Line> {
        let Some(trails) = &self.trails else { return Vec::new() };
        let mut ribbons = vec![Line::NONE; state.position.len() * (KNOTS + 1)];
        styled(state, self.style, self.size, |state| {
            let (count, _) = trails.lines(state, &mut ribbons);
            ribbons.truncate(count);
        });
        ribbons
    }

    fn particles(&self, state: &State<'_>, begun: &[(u32, Vec3)], file: &SceneFile, seen: &mut Seen) {
        for (row, &(serial, begun)) in begun.iter().enumerate() {
            if self.covered.get(serial as usize).is_some_and(|&covered| covered) {
                continue;
            }
            if let Some(sprite) = sprite(state, row, &self.view) {
                seen.billboards.push(self.billboard(&sprite, file));
            } else if let Some(piece) = self.shape(state, row, file) {
                seen.pieces.push(piece);
            } else if let Some(dot) = self.dot(state, row, begun) {
                seen.dots.push(dot);
            }
        }
    }

    /// A picture has been seen; the next one remembers where things were.
    fn close(&mut self, state: &State<'_>, serial: &[u32]) {
        match &mut self.shutter {
            Some(shutter) => shutter.close(state, serial),
            None => self.before = serial.iter().copied().zip(state.position.iter().copied()).collect(),
        }
    }

    fn billboard(&self, sprite: &Sprite, file: &SceneFile) -> Billboard {
        let Sprite { center, right, up, color, material, frame, blend } = *sprite;
        let picture = usize::from(material);
        // What a style makes a picture of is a point, which may lie on a surface.
        let is_own = file.materials.get(picture).is_some_and(|material| material.sprite.is_some());
        let sunk = if is_own { 0.0 } else { SUNK };
        Billboard { center, right, up, color, picture, frame, blend, sunk }
    }

    fn shape(&self, state: &State<'_>, row: usize, file: &SceneFile) -> Option<Piece> {
        let Instance { center, axes, color, material } = solid(state, row)?;
        let form = self.forms.get(usize::from(material)).filter(|form| !form.triangles.is_empty())?;
        let material = painted(file.materials.get(usize::from(material)), color);
        Some(Piece { surface: form.transformed(axes, center), material, endless: false, lift: 0.0 })
    }

    fn dot(&self, state: &State<'_>, row: usize, previous: Vec3) -> Option<Dot> {
        let Appearance { diameter, scale, solid, color, glow, .. } = appearance(state, row)?;
        let position = state.position[row];
        let is_point = state.radius[row] == 0.0 && !(diameter > 0.0) && scale > 0.0;
        let size = match self.style {
            Some(Style::Points | Style::Lines | Style::Trails) => 0.0,
            _ if is_point => self.size * scale,
            _ if diameter > 0.0 => diameter,
            _ => return None,
        };
        let glow = if matches!(self.style, None | Some(Style::Sprites)) { glow } else { 0.0 };
        (color[3] > 0).then_some(Dot { position, previous, color, size, glow, solid })
    }

    /// The surface of a cloth, lit.
    fn cloth(&self, state: &State<'_>, patch: &PatchBuf, file: &SceneFile, model: &Model) -> Option<Piece> {
        let mut vertices = vec![Vertex::NONE; patch.count as usize];
        let mut triangles = vec![[0; 3]; patch.triangles.len()];
        let (_, count) = surface(state, &patch.lend(), &mut vertices, &mut triangles);
        triangles.truncate(count);
        if self.show.contains(&Show::Strain) {
            let mut found = vec![0.0; vertices.len()];
            strains(&patch.lend(), &model.particles, &vertices, &triangles, &mut found);
            let colored = vertices.iter_mut().zip(found);
            colored.for_each(|(vertex, strain)| vertex.color = strained(strain / FULL_STRAIN));
        }
        let color = vertices.get(triangles.first()?[0] as usize)?.color;
        let places: Vec<_> = vertices.iter().map(|vertex| vertex.place).collect();
        let normals = vertices.iter().map(|vertex| vertex.normal).collect();
        let is_plain = vertices.iter().all(|vertex| vertex.color[..3] == color[..3]);
        let (color, tints) = match color {
            _ if is_plain => (color, Vec::new()),
            [.., opacity] => ([255, 255, 255, opacity], vertices.iter().map(|vertex| tint(vertex.color)).collect()),
        };
        let material = patch.material.and_then(|number| file.materials.get(usize::from(number)));
        let surface = Surface { normals, tints, ..shapes::mesh(&places, &triangles) };
        // Its corners lie on what it covers, its triangles behind that.
        let lift = LIFT * (surface.area() / count as f32).sqrt();
        Some(Piece { surface, material: painted(material, color), endless: false, lift })
    }
}

/// A state whose materials are drawn in a style; the pictures of points, which have no size, have this radius \[m\].
fn styled<T>(state: &State<'_>, style: Option<Style>, size: f32, see: impl FnOnce(&State<'_>) -> T) -> T {
    let Some(style) = style else { return see(state) };
    let materials = Styled { materials: state.materials, style };
    let material = materials.column(state.material);
    let least = if style == Style::Sprites { size } else { 0.0 };
    let radius: Vec<_> = state.radius.iter().map(|radius| radius.max(least)).collect();
    see(&State { material: &material, materials: &materials, radius: &radius, ..*state })
}

/// A rigid body: the box that it is, or its surface in a box of so much about its middle.
fn rigid(instance: &Instance, (model, of): (&Model, &RigidBox), file: &SceneFile) -> Piece {
    let Instance { center, axes, color, material } = *instance;
    let surface = match model.surface(of) {
        None => shapes::cuboid(Vec3::ZERO, Vec3::splat(2.0)),
        Some((corners, triangles)) => {
            let places: Vec<_> = triangles.iter().flatten().map(|&corner| corners[corner as usize] / of.half).collect();
            let triangles: Vec<_> = (0..places.len() as u32 / 3).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
            shapes::mesh(&places, &triangles)
        }
    };
    let material = painted(file.materials.get(usize::from(material)), color);
    Piece { surface: surface.transformed(axes, center), material, endless: false, lift: 0.0 }
}

/// Red, green and blue from 0 to 1.
fn tint([red, green, blue, _]: Color) -> Vec3 {
    Vec3::from([red, green, blue].map(|channel| f32::from(channel) / 255.0))
}

/// A material in the colour of a particle.
fn painted(material: Option<&Material>, color: Color) -> draw::Material {
    let (tint, opacity) = (tint(color), f32::from(color[3]) / 255.0);
    let own = material.map_or_else(draw::Material::default, look);
    draw::Material { ambient: tint, diffuse: tint, opacity: opacity * own.opacity, ..own }
}
