//! From the declared scene to a `.scn` text.

use super::{Form, Item, Light, Material, Run, SceneFile};
use crate::emit::{Emitter, Spread, Varied};
use crate::force::{ForceKind, MutualGravity, Sink, Spring};
use crate::motion::{MotionBuf, Script};
use crate::particles::Particle;
use crate::shape::Shape;
use alloc::format;
use alloc::string::{String, ToString};
use alloc::vec::Vec;
use core::fmt::Write;
use glam::Vec3;

/// Writes a scene as `.scn`; the warnings say what that format cannot.
#[must_use]
pub fn write_scn(scene: &SceneFile) -> (String, Vec<String>) {
    let mut writer = Writer { out: String::new(), warnings: Vec::new() };
    writer.settings(scene);
    scene.materials.iter().for_each(|material| writer.material(material));
    writer.look(scene);
    writer.scenery(scene);
    writer.forces(scene);
    let (particles, springs) = writer.start(scene);
    particles.iter().for_each(|particle| writer.particle(particle));
    if springs.iter().any(|spring| spring.drive.is_some() || spring.breaks_at.is_some()) {
        writer.warn("springs: in .scn they neither swing nor break; that is left out");
    }
    for spring in &springs {
        let [a, b] = spring.ends;
        let numbers = Numbers(&[spring.rest_length, spring.ks, spring.kd]);
        writer.line(format_args!("particle_spring {a} {b} {numbers}"));
    }
    scene.emitters.iter().enumerate().for_each(|(i, emitter)| writer.source(i, emitter));
    scene.sinks.iter().enumerate().for_each(|(i, sink)| writer.sink(i, sink));
    (writer.out, writer.warnings)
}

struct Writer {
    out: String,
    warnings: Vec<String>,
}

/// Numbers with blanks between them, each in the shortest form that reads back the same.
struct Numbers<'a>(&'a [f32]);

impl core::fmt::Display for Numbers<'_> {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        for (i, &x) in self.0.iter().enumerate() {
            f.write_str(if i == 0 { "" } else { " " })?;
            if x == 0.0 || (1e-4..1e7).contains(&x.abs()) { write!(f, "{x}")? } else { write!(f, "{x:e}")? }
        }
        Ok(())
    }
}

impl Writer {
    fn line(&mut self, text: core::fmt::Arguments<'_>) {
        // Writing to a string cannot fail.
        let _ = writeln!(self.out, "{text}");
    }

    fn warn(&mut self, what: impl ToString) {
        let what = what.to_string();
        if !self.warnings.contains(&what) {
            self.warnings.push(what);
        }
    }

    fn settings(&mut self, scene: &SceneFile) {
        if scene.schema.is_some() {
            self.warn("$schema: .scn has no schema; it is left out");
        }
        if scene.contacts.is_some() {
            self.warn("contacts: in .scn particles pass through each other; that is left out");
        }
        if !scene.constraints.is_empty() {
            self.warn("constraints: .scn binds by springs alone; they are left out");
        }
        if !scene.custom.is_empty() {
            self.warn("custom: in .scn particles have no further columns; they are left out");
        }
        if !scene.goals.is_empty() {
            self.warn("goals: .scn leads particles nowhere; they are left out");
        }
        if scene.room.is_some() {
            self.warn("room: in .scn space goes on without end; that is left out");
        }
        if !scene.reapers.is_empty() {
            self.warn("reapers: in .scn particles die of age and at sinks alone; that is left out");
        }
        if !scene.about.is_empty() {
            scene.about.split(['\n', '\r']).for_each(|text| self.line(format_args!("# {text}")));
            self.warn("about: kept as a comment");
        }
        if scene.run != Run::default() {
            let Run { duration, dt, substeps, integrator, tuning, index, collision_index, max_bounces, seed, capacity } =
                &scene.run;
            self.line(format_args!(
                "# run with --duration {duration} --dt {dt} --integrator {integrator} --seed {seed} --capacity {capacity}"
            ));
            self.warn("run: .scn has no settings of a run; they are kept as a comment");
            let usual = Run::default();
            let left_out = (*tuning, *index, *collision_index, *max_bounces, *substeps);
            if left_out != (usual.tuning, usual.index, usual.collision_index, usual.max_bounces, usual.substeps) {
                self.warn("run: its tuning, its indices, its max_bounces and its substeps are left out");
            }
        }
    }

    /// The particles and springs that it begins with, sheets taken apart.
    fn start(&mut self, scene: &SceneFile) -> (Vec<Particle>, Vec<Spring>) {
        let (mut particles, mut springs) = (scene.particles.clone(), scene.springs.clone());
        for (i, cloth) in scene.cloths.iter().enumerate() {
            if let Form::Mesh(name) = &cloth.form {
                self.warn(format!(
                    "cloths[{i}]: .scn has no cloths, and '{name}' cannot be taken apart; it is left out"
                ));
                continue;
            }
            let lost = if cloth.is_shell() { ", without its shell" } else { "" };
            let lost = if cloth.thickness.is_some() { format!("{lost}, without its thickness") } else { lost.into() };
            let lost = if cloth.air.is_some() { format!("{lost}, without the air around it") } else { lost };
            self.warn(format!("cloths[{i}]: .scn has no cloths; it is written as particles and springs{lost}"));
            let (woven, threads) = cloth.make(None, particles.len() as u32);
            particles.extend(woven);
            springs.extend(threads);
        }
        if !scene.boxes.is_empty() {
            self.warn("boxes: .scn has no rigid bodies; they are left out");
        }
        if !scene.strands.is_empty() {
            self.warn("strands: .scn has none; they are left out");
        }
        if !scene.ropes.is_empty() {
            self.warn("ropes: .scn has none; they are left out");
        }
        if !scene.soft_bodies.is_empty() {
            self.warn("soft_bodies: .scn has none; they are left out");
        }
        if !scene.ties.is_empty() {
            self.warn("ties: .scn has none; they are left out");
        }
        (particles, springs)
    }

    fn material(&mut self, material: &Material) {
        let Material { ambient, diffuse, specular, transmission, emission, .. } = material;
        let colors = [*ambient, *diffuse, *specular, *transmission, *emission];
        let texture = match material.texture.as_deref() {
            Some(file) if !is_word(file) || file == "0" => {
                self.warn(format!("materials: .scn cannot name the texture '{file}'; it is left out"));
                "0"
            }
            file => file.unwrap_or("0"),
        };
        if material.size != 0.0 || material.glow != 0.0 {
            self.warn("materials: .scn has neither size nor glow of particles; they are left out");
        }
        if material.sprite.is_some() {
            self.warn("materials: .scn has no sprites; they are left out");
        }
        if material.shape.is_some() {
            self.warn("materials: .scn has no shapes of particles; they are left out");
        }
        if material.trail.is_some() {
            self.warn("materials: .scn has no trails; they are left out");
        }
        if !material.life.is_plain() {
            self.warn("materials: .scn has no lives of particles; they are left out");
        }
        if !material.contact.is_plain() {
            self.warn("materials: .scn knows no friction and no elasticity of surfaces; they are left out");
        }
        let numbers = Numbers(colors.as_flattened());
        let rest = Numbers(&[material.shininess, material.refraction]);
        self.line(format_args!("material {numbers} {rest} {texture}"));
    }

    fn look(&mut self, scene: &SceneFile) {
        if let Some(c) = &scene.camera {
            let rows = [c.eye, c.towards, c.up, [c.xfov, c.near, c.far]];
            self.line(format_args!("camera {}", Numbers(rows.as_flattened())));
            if c.shutter.is_some() {
                self.warn("camera: .scn has no shutter; it is left out");
            }
        }
        if scene.sky.is_some() || scene.fog.is_some() {
            self.warn("sky and fog: .scn has a background of one colour and clear air; they are left out");
        }
        for (name, color) in [("ambient", scene.ambient), ("background", scene.background)] {
            if color != [0.0; 3] {
                self.line(format_args!("{name} {}", Numbers(&color)));
            }
        }
        for light in &scene.lights {
            match *light {
                Light::Directional { color, direction } => {
                    self.line(format_args!("dir_light {}", Numbers([color, direction].as_flattened())));
                }
                Light::Point { color, position, attenuation } => {
                    self.line(format_args!("point_light {}", Numbers([color, position, attenuation].as_flattened())));
                }
                Light::Spot { color, position, direction, attenuation, cutoff, dropoff } => {
                    let rows = [color, position, direction, attenuation];
                    let angles = Numbers(&[cutoff, dropoff]);
                    self.line(format_args!("spot_light {} {angles}", Numbers(rows.as_flattened())));
                }
                Light::Area { color, position, direction, radius, attenuation } => {
                    let rows = [color, position, direction];
                    let rest = Numbers(&attenuation);
                    self.line(format_args!("area_light {} {radius} {rest}", Numbers(rows.as_flattened())));
                }
            }
        }
    }

    /// Opens and closes groups as the list of scenery enters and leaves them; each first in the order of its number,
    /// so that those of nothing are not lost.
    fn scenery(&mut self, scene: &SceneFile) {
        let (mut open, mut next): (Vec<u32>, u32) = (Vec::new(), 0);
        for (i, Item { shape, material, group, motion }) in scene.scenery.iter().enumerate() {
            let Some(shape) = self.shape(&format!("scenery[{i}]"), shape, true) else { continue };
            if motion.is_some() {
                self.warn(format!("scenery[{i}].motion: .scn has none; it is left out"));
            }
            self.open_until(scene, &mut open, &mut next, group.map_or(0, |group| group + 1));
            self.enter(scene, &mut open, &scene.chain(*group));
            let (name, arguments) = shape.split_once(' ').unwrap_or((&shape, ""));
            self.line(format_args!("{name} {} {arguments}", number(*material)));
        }
        self.open_until(scene, &mut open, &mut next, scene.groups.len() as u32);
        self.enter(scene, &mut open, &[]);
    }

    /// Opens every group below `end` that never was.
    fn open_until(&mut self, scene: &SceneFile, open: &mut Vec<u32>, next: &mut u32, end: u32) {
        for group in *next..end {
            self.enter(scene, open, &scene.chain(Some(group)));
        }
        *next = end.max(*next);
    }

    fn enter(&mut self, scene: &SceneFile, open: &mut Vec<u32>, wanted: &[u32]) {
        let shared = open.iter().zip(wanted).take_while(|(a, b)| a == b).count();
        while open.len() > shared {
            open.pop();
            self.line(format_args!("end"));
        }
        for &index in &wanted[shared..] {
            let group = &scene.groups[index as usize];
            self.line(format_args!("begin {} {}", number(group.material), Numbers(group.matrix.as_flattened())));
            open.push(index);
        }
    }

    /// `.scn` knows one gravity, and has drag and Newton's law always.
    fn forces(&mut self, scene: &SceneFile) {
        let mut gravity: Option<Vec3> = None;
        let (mut drag, mut newton, mut order) = (0, 0, Vec::new());
        for force in &scene.forces {
            match force {
                ForceKind::Gravity(force) => gravity = Some(gravity.unwrap_or(Vec3::ZERO) + force.acceleration),
                ForceKind::Drag(_) => drag += 1,
                ForceKind::MutualGravity(force) if *force == MutualGravity::NEWTON => newton += 1,
                ForceKind::MutualGravity(_) => {
                    self.warn("forces: .scn has mutual gravity with G = 6.67428e-11 and no softening only");
                }
                other => self.warn(format!("forces: .scn does not have '{}'; it is left out", other.kind())),
            }
            order.extend(match force {
                ForceKind::Gravity(_) => Some(0),
                ForceKind::Drag(_) => Some(1),
                ForceKind::MutualGravity(_) => Some(2),
                _ => None,
            });
        }
        if !order.is_sorted_by(|a, b| a < b) {
            self.warn("forces: .scn adds them up as one gravity, drag, mutual gravity: sums may round in another way");
        }
        match gravity {
            Some(g) if g.is_finite() => self.line(format_args!("particle_gravity {}", Numbers(&g.to_array()))),
            Some(_) => self.warn("forces: the sum of all gravities is beyond a 32-bit float; it is left out"),
            None => {}
        }
        if newton != 1 {
            self.warn("forces: in .scn all particles always attract each other with G = 6.67428e-11, once");
        }
        if drag != 1 {
            self.warn("forces: in .scn drag always acts, once");
        }
    }

    fn particle(&mut self, particle: &Particle) {
        let Particle { position, velocity, radius, mass, fixed, drag, charge, elasticity, lifetime, material, color } =
            particle;
        if color.is_some() {
            self.warn("particles: .scn has no colours of single particles; they are left out");
        }
        if *radius != 0.0 {
            self.warn("particles: .scn has no radii; they are left out");
        }
        if *charge != 0.0 {
            self.warn("particles: .scn has no charges; they are left out");
        }
        let place = [position.to_array(), velocity.to_array()];
        let (place, rest) = (Numbers(place.as_flattened()), Numbers(&[*drag, *elasticity, *lifetime]));
        let (mass, fixed) = (Numbers(&[*mass]), u8::from(*fixed));
        self.line(format_args!("particle {place} {mass} {fixed} {rest} {}", number(*material)));
    }

    fn source(&mut self, index: usize, emitter: &Emitter<Shape<String>, Option<MotionBuf>>) {
        let at = format!("emitters[{index}]");
        self.warn_of_group(&at, emitter.group);
        let Some(shape) = self.shape(&at, &emitter.shape, false) else { return };
        let cutoff = match emitter.spread {
            Spread::Lecture(cutoff) | Spread::Uniform(cutoff @ 0.0) => cutoff,
            Spread::Uniform(cutoff) => {
                self.warn(format!("{at}.spread: .scn knows the lecture's law only, which favours the middle"));
                cutoff
            }
        };
        let varied = [emitter.speed, emitter.mass, emitter.drag, emitter.elasticity, emitter.lifetime];
        if varied.iter().any(|v| v.half_width != 0.0) {
            self.warn(format!("{at}: .scn has no variances; the means are kept"));
        }
        if emitter.burst.is_some() || emitter.start != 0.0 || emitter.stop.is_some() {
            self.warn(format!("{at}: .scn has neither bursts nor start and stop; they are left out"));
        }
        if emitter.inside || emitter.where_sparse.is_some() {
            self.warn(format!(
                "{at}: in .scn births lie on surfaces, whoever is there; inside and where_sparse are left out"
            ));
        }
        if emitter.direction.is_some() || emitter.velocity != Vec3::ZERO || !emitter.motion.is_still() {
            self.warn(format!(
                "{at}: .scn has neither a direction nor a velocity or motion of sources; they are left out"
            ));
        }
        if emitter.radius != Varied::default() {
            self.warn(format!("{at}: .scn has no radii; they are left out"));
        }
        if emitter.charge != Varied::default() {
            self.warn(format!("{at}: .scn has no charges; they are left out"));
        }
        if emitter.color.is_some() || emitter.color_half_width != [0; 4] {
            self.warn(format!("{at}: .scn has no colours of sources; they are left out"));
        }
        let [speed, mass, drag, elasticity, lifetime] = varied.map(|v| v.mean);
        let (mass, rest) = (Numbers(&[mass]), Numbers(&[drag, elasticity, lifetime]));
        let (fixed, material) = (u8::from(emitter.fixed), number(emitter.material));
        let motion = Numbers(&[emitter.rate, speed, cutoff]);
        self.line(format_args!("particle_source {mass} {fixed} {rest} {material} {motion} {shape}"));
    }

    /// Sources and sinks of `.scn` stand where they say, in whichever group.
    fn warn_of_group(&mut self, at: &str, group: Option<u32>) {
        if group.is_some() {
            self.warn(format!("{at}.group: .scn transforms scenery only; it is left out"));
        }
    }

    fn sink(&mut self, index: usize, sink: &Sink<String>) {
        self.warn_of_group(&format!("sinks[{index}]"), sink.group);
        if sink.softening != 0.0 {
            self.warn(format!("sinks[{index}].softening: .scn has none; it is left out"));
        }
        if let Some(shape) = self.shape(&format!("sinks[{index}]"), &sink.shape, false) {
            let numbers = Numbers(&[sink.intensity, sink.ca, sink.la, sink.qa]);
            self.line(format_args!("particle_sink {numbers} {shape}"));
        }
    }

    /// Name and arguments of a shape; `None`, with a warning, if `.scn` does not have it there.
    fn shape(&mut self, at: &str, shape: &Shape<String>, is_scenery: bool) -> Option<String> {
        let with = |name: &str, rows: &[Vec3], rest: &[f32]| {
            let numbers: Vec<f32> = rows.iter().flat_map(Vec3::to_array).chain(rest.iter().copied()).collect();
            Some(format!("{name} {}", Numbers(&numbers)))
        };
        let kind = match shape {
            Shape::Line(s) => return with("line", &[s.from, s.to], &[]),
            Shape::Box(s) => return with("box", &[s.min, s.max], &[]),
            Shape::Sphere(s) => return with("sphere", &[s.center], &[s.radius]),
            Shape::Cylinder(s) => return with("cylinder", &[s.center], &[s.radius, s.height]),
            Shape::Cone(s) => return with("cone", &[s.center], &[s.radius, s.height]),
            Shape::Circle(s) if !is_scenery => return with("circle", &[s.center, s.normal], &[s.radius]),
            Shape::Triangle(s) if is_scenery => return with("tri", &s.corners, &[]),
            Shape::Mesh(file) if is_word(file) => return Some(format!("mesh {file}")),
            Shape::Mesh(_) => "a mesh of such a name",
            Shape::Circle(_) => "a circle that is solid",
            Shape::Triangle(_) => "a triangle that gives birth or takes away",
            Shape::Plane(_) => "a plane",
            Shape::Capsule(_) => "a capsule",
            Shape::HeightField(_) => "a height field",
        };
        self.warn(format!("{at}: .scn does not have {kind}; it is left out"));
        None
    }
}

/// Tells whether a name is a word of `.scn`: not empty, without blanks, no comment.
fn is_word(name: &str) -> bool {
    !name.is_empty() && !name.contains(char::is_whitespace) && !name.starts_with('#')
}

/// A material's number as `.scn` writes it.
fn number(material: Option<u16>) -> i32 {
    material.map_or(-1, i32::from)
}
