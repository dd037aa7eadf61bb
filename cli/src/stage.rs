//! A scene as the renderer sees it: scenery, and what moves.

use crate::outcome::{Failure, Outcome};
use crate::show::Show;
use crate::style::Style;
use crate::viewpoint::Viewpoint;
use glam::Vec3;
use pointmass::Time;
use pointmass::material::Blend;
use pointmass::motion::Script;
use pointmass::scene::{Camera, Fog, Light, Material, Model, SceneFile, Sky, Solid};
use pointmass::shape::{Aabb, Affine, HeightField, MeshBuf, Shape, Surface as _};
use pointmass_draw::{self as draw, Background, Flipbook, Line, Piece, Stage, Surface, shapes};
use std::path::Path;
use std::sync::Arc;

/// The scenery as it stands at an instant, and sources and sinks as glass if they are to be seen.
pub(crate) fn stage(file: &SceneFile, model: &Model, show: &[Show], instant: Time) -> Stage {
    let bounds = bounds(file, model);
    let mut stage = Stage {
        camera: camera(file.camera.as_ref(), bounds),
        lights: lights(&file.lights),
        ambient: file.ambient.into(),
        background: background(file),
        fog: file.fog.map(|Fog { color, density, from }| draw::Fog { color: color.map(Vec3::from), density, from }),
        ..Stage::default()
    };
    let default = Material::default();
    let reach = 40.0 * bounds.radius().clamp(1.0, 1e6);
    for Solid { shape, to_world, material, motion } in &model.scenery {
        let material = material.and_then(|i| file.materials.get(usize::from(i))).unwrap_or(&default);
        let to_world = if motion.is_still() { *to_world } else { motion.at(instant).after(to_world) };
        place(&mut stage, shape, &to_world, look(material), reach);
    }
    let sources = model.emitters.iter().map(|e| (Show::Sources, &e.shape, e.color.unwrap_or([120, 200, 120, 255])));
    let sinks = model.forces.1.iter().map(|s| (Show::Sinks, &s.shape, [200, 90, 90, 255]));
    for (_, shape, [r, g, b, _]) in sources.chain(sinks).filter(|(what, ..)| show.contains(what)) {
        let tint = Vec3::new(f32::from(r), f32::from(g), f32::from(b)) / 255.0;
        let glass = draw::Material { ambient: tint, diffuse: tint, opacity: 0.35, ..draw::Material::default() };
        place(&mut stage, shape, &Affine::IDENTITY, glass, reach);
    }
    stage
}

/// The sky, or the one colour behind everything.
fn background(file: &SceneFile) -> Background {
    match file.sky {
        None => Background::Plain(file.background.into()),
        Some(Sky { zenith, horizon, ground }) => {
            let ground = ground.unwrap_or(horizon).into();
            Background::Gradient { zenith: zenith.into(), horizon: horizon.into(), ground }
        }
    }
}

/// The pictures of particles, by the numbers of their materials; `path` is the scene's. In the style of sprites those that have none
/// are puffs, as are those of particles without a material, under the last number.
pub(crate) fn pictures(file: &SceneFile, path: &Path, style: Option<Style>) -> Outcome<Arc<[Flipbook]>> {
    let otherwise = if style == Some(Style::Sprites) { Flipbook::named("puff") } else { None };
    let otherwise = otherwise.unwrap_or_default();
    let picture = |(i, material): (usize, &Material)| {
        let Some(sprite) = &material.sprite else { return Ok(otherwise.clone()) };
        if let Some(book) = Flipbook::named(&sprite.picture) {
            return Ok(book);
        }
        let from = path.parent().unwrap_or(Path::new("")).join(&sprite.picture);
        let refuse = |why: String| Failure::new(format!("{}: materials[{i}].sprite.picture: {why}", from.display()));
        let picture = image::open(&from).map_err(|error| refuse(error.to_string()))?.into_rgba8();
        let [columns, rows] = sprite.grid;
        if picture.width() < columns.into() || picture.height() < rows.into() {
            let (width, height) = picture.dimensions();
            return Err(refuse(format!("has {width} x {height} pixels, too few for {columns} x {rows} frames")));
        }
        Ok(Flipbook::new(&picture, sprite.grid, sprite.blend == Blend::Premultiplied))
    };
    file.materials.iter().enumerate().map(picture).chain([Ok(otherwise.clone())]).collect()
}

/// Whether some of the scenery moves.
pub(crate) fn moves(model: &Model) -> bool {
    model.scenery.iter().any(|solid| !solid.motion.is_still())
}

/// How large a scene is \[m\]: the radius of all that stays put and of the particles that it begins with.
pub(crate) fn size(file: &SceneFile, model: &Model) -> f64 {
    f64::from(bounds(file, model).radius())
}

/// The scene's view of itself: by its camera, or by one that looks down −z at all that stays put.
pub(crate) fn viewpoint(file: &SceneFile, model: &Model) -> Viewpoint {
    let bounds = bounds(file, model);
    Viewpoint::new(camera(file.camera.as_ref(), bounds), bounds.center())
}

/// A box around all that stays put, for a camera that nobody placed.
fn bounds(file: &SceneFile, model: &Model) -> Aabb {
    let particles = Aabb::around(file.particles.iter().map(|p| p.position));
    let all = boxes(model).into_iter().fold(particles, Aabb::join);
    if all.radius().is_finite() && all.radius() > 0.0 {
        return all;
    }
    let center = if all.center().is_finite() { all.center() } else { Vec3::ZERO };
    Aabb { min: center - 0.5, max: center + 0.5 }
}

/// Boxes around scenery, sources and sinks, of those that end somewhere.
pub(crate) fn boxes(model: &Model) -> Vec<Aabb> {
    let corners = |shape: &Shape<Arc<MeshBuf>>, to_world: &Affine| {
        let Aabb { min, max } = shape.bounds();
        let corner = |i: u8| Vec3::new(pick(i, 1, min.x, max.x), pick(i, 2, min.y, max.y), pick(i, 4, min.z, max.z));
        Aabb::around((0..8).map(corner).filter(|c| c.is_finite()).map(|c| to_world.point(c)))
    };
    let scenery = model.scenery.iter().map(|s| corners(&s.shape, &s.to_world));
    let sources = model.emitters.iter().map(|e| corners(&e.shape, &Affine::IDENTITY));
    let sinks = model.forces.1.iter().map(|s| corners(&s.shape, &Affine::IDENTITY));
    scenery.chain(sources).chain(sinks).filter(|all| all.min.is_finite() && all.max.is_finite()).collect()
}

fn pick(i: u8, bit: u8, low: f32, high: f32) -> f32 {
    if i & bit == 0 { low } else { high }
}

/// The scene's camera, or one that looks down −z at everything from three radii away.
fn camera(camera: Option<&Camera>, bounds: Aabb) -> draw::Camera {
    let looking = camera.map(|c| draw::Camera {
        eye: c.eye.into(),
        towards: c.towards.into(),
        up: c.up.into(),
        xfov: c.xfov,
        near: c.near,
        far: c.far,
    });
    looking.unwrap_or_else(|| {
        let radius = bounds.radius();
        draw::Camera {
            eye: bounds.center() + Vec3::Z * (3.0 * radius),
            towards: Vec3::NEG_Z,
            up: Vec3::Y,
            xfov: 0.25,
            near: 0.01 * radius,
            far: 100.0 * radius,
        }
    })
}

/// The scene's lights, or the two that a scene without any has.
fn lights(lights: &[Light]) -> Vec<draw::Light> {
    let directional = |color: Vec3, direction: Vec3| draw::Light::Directional { color, direction };
    if lights.is_empty() {
        let (main, fill) = (Vec3::new(-3.0, -4.0, -5.0), Vec3::new(3.0, 2.0, 3.0));
        return vec![directional(Vec3::ONE, main), directional(Vec3::splat(0.5), fill)];
    }
    let light = |light: &Light| match *light {
        Light::Directional { color, direction } => directional(color.into(), direction.into()),
        // An area light is drawn as the point in its middle.
        Light::Point { color, position, attenuation } | Light::Area { color, position, attenuation, .. } => {
            draw::Light::Point { color: color.into(), position: position.into(), attenuation }
        }
        Light::Spot { color, position, direction, attenuation, cutoff, dropoff } => draw::Light::Spot {
            color: color.into(),
            position: position.into(),
            direction: direction.into(),
            attenuation,
            cutoff,
            dropoff,
        },
    };
    lights.iter().map(light).collect()
}

pub(crate) fn look(material: &Material) -> draw::Material {
    let [r, g, b] = material.transmission;
    draw::Material {
        ambient: material.ambient.into(),
        diffuse: material.diffuse.into(),
        specular: material.specular.into(),
        emission: material.emission.into(),
        shininess: material.shininess,
        opacity: (1.0 - (r + g + b) / 3.0).clamp(0.0, 1.0),
    }
}

fn place(stage: &mut Stage, shape: &Shape<Arc<MeshBuf>>, to_world: &Affine, material: draw::Material, reach: f32) {
    if let Shape::Line(line) = shape {
        let (a, b) = (to_world.point(line.from), to_world.point(line.to));
        stage.lines.push(Line { a, b, material });
        return;
    }
    let surface = tessellate(shape, reach).transformed(to_world.linear, to_world.shift);
    stage.pieces.push(Piece { surface, material, endless: matches!(shape, Shape::Plane(_)), lift: 0.0 });
}

/// A height field as a mesh.
fn ground(field: &HeightField<'_>) -> Surface {
    let [columns, rows] = field.size();
    let vertices: Vec<Vec3> = (0..rows).flat_map(|j| (0..columns).map(move |i| field.vertex(i, j))).collect();
    let corner = |i: usize, j: usize| (j * columns + i) as u32;
    let cell = |i, j| {
        let [a, b, c, d] = [corner(i, j), corner(i, j + 1), corner(i + 1, j), corner(i + 1, j + 1)];
        [[a, b, c], [c, b, d]]
    };
    let triangles: Vec<_> = (0..rows - 1).flat_map(|j| (0..columns - 1).flat_map(move |i| cell(i, j))).collect();
    shapes::mesh(&vertices, &triangles)
}

pub(crate) fn tessellate(shape: &Shape<Arc<MeshBuf>>, reach: f32) -> Surface {
    match shape {
        Shape::Line(_) => Surface::default(),
        Shape::Box(s) => {
            let Aabb { min, max } = s.bounds();
            shapes::cuboid((min + max) * 0.5, max - min)
        }
        Shape::Circle(s) => shapes::disc(s.center, s.normal, s.radius),
        Shape::Sphere(s) => shapes::sphere(s.center, s.radius),
        Shape::Cylinder(s) => shapes::cylinder(s.center, s.radius, s.height),
        Shape::Cone(s) => shapes::cone(s.center, s.radius, s.height),
        Shape::Capsule(s) => shapes::capsule(s.from, s.to, s.radius),
        Shape::Mesh(mesh) => shapes::mesh(mesh.view().vertices(), mesh.view().triangles()),
        Shape::Triangle(s) => shapes::mesh(&s.corners, &[[0, 1, 2]]),
        Shape::Plane(s) => shapes::plane(s.point, s.normal, reach),
        Shape::HeightField(field) => ground(&field.view()),
    }
}
