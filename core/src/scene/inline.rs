//! A `.scn` scene in inline arrays: what firmware reads at start, without a heap.

use super::Scene;
use super::color::shown;
use super::scn::{Command, Located, Place, Scenery, ScnError, Source, commands};
use crate::collide::Meetings;
use crate::emit::{Emitter, Spread, Varied};
use crate::force::{AllPairs, Drag, Gravity, Sink, Spring};
use crate::integrate::Rk4;
use crate::particles::{Color, Particle};
use crate::shape::{Aabb, Affine, Collider, Hit, Mapped, Placed, Segment, Shape, Spot, Surface};
use glam::{Mat3, Vec3};
use heapless::Vec;

/// A scene in memory of its own: at most `PARTICLES` to begin with, `SPRINGS` between them, and `OTHERS` emitters,
/// sinks, solids, materials and groups in each other, each.
///
/// ```
/// use pointmass::scene::InlineScene;
/// use pointmass::{Inline, System, Time};
///
/// let text = "particle_gravity 0 -9.8 0   particle 0 2 0  1 0 0  1 0 0 0.8 0 -1   box -1 -9 -1 -9  9 0 9";
/// let mut scene = InlineScene::<1, 0, 2>::new();
/// scene.read(text)?;
/// let mut system = System::with(Inline::<1, 0, 0, 5>::new());
/// system.start(&scene.scene(), 1)?;
/// system.step(&scene.scene(), Time::frame(1, 60));
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct InlineScene<const PARTICLES: usize, const SPRINGS: usize, const OTHERS: usize> {
    particles: Vec<Particle, PARTICLES>,
    springs: Vec<Spring, SPRINGS>,
    emitters: Vec<Emitter<Shape<NoMesh>>, OTHERS>,
    forces: (Vec<Gravity, 1>, Drag, Vec<AllPairs, 1>, Vec<Sink<NoMesh>, OTHERS>),
    colliders: Vec<Placed<Shape<NoMesh>>, OTHERS>,
}

/// The mesh of a scene that has none: it takes no room.
#[derive(Clone, Copy, Debug)]
enum NoMesh {}

impl Surface for NoMesh {
    fn area(&self) -> f32 {
        match *self {}
    }
    fn sample(&self, _: [f32; 3]) -> Spot {
        match *self {}
    }
    fn nearest(&self, _: Vec3) -> Vec3 {
        match *self {}
    }
    fn bounds(&self) -> Aabb {
        match *self {}
    }
}

impl Collider for NoMesh {
    fn moves(&self) -> bool {
        false
    }

    fn first_hit(&self, _: &Segment) -> Option<Hit> {
        match *self {}
    }
}

impl Mapped for NoMesh {}

/// Why a scene cannot be read into inline arrays.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum InlineError<'a> {
    /// The text is wrong.
    Text(ScnError<'a>),
    /// The command at this place does not go: what is wrong with it.
    At(Place, &'static str),
}

impl core::fmt::Display for InlineError<'_> {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        let (Self::Text(ScnError { place, .. }) | Self::At(place, _)) = self;
        write!(f, "{}:{}: ", place.line, place.column)?;
        match self {
            Self::Text(error) => error.fmt(f),
            Self::At(_, message) => f.write_str(message),
        }
    }
}

impl core::error::Error for InlineError<'_> {}

impl<const P: usize, const S: usize, const N: usize> InlineScene<P, S, N> {
    /// A scene that says nothing: all zeros.
    #[must_use]
    pub const fn new() -> Self {
        Self {
            particles: Vec::new(),
            springs: Vec::new(),
            emitters: Vec::new(),
            forces: (Vec::new(), Drag {}, Vec::new(), Vec::new()),
            colliders: Vec::new(),
        }
    }

    /// Becomes what a `.scn` text says. Cameras, lights and lines, which nothing moves by, are passed over.
    ///
    /// # Errors
    /// If the text is wrong, a list is longer than its array, or it names a mesh or includes a file; the scene is then
    /// what was read so far.
    // Apart, so that a program which goes on to step has its stack back.
    #[inline(never)]
    pub fn read<'a>(&mut self, text: &'a str) -> Result<(), InlineError<'a>> {
        self.particles.clear();
        self.springs.clear();
        self.emitters.clear();
        self.forces.0.clear();
        self.forces.2.clear();
        self.forces.3.clear();
        self.colliders.clear();
        let mut reader = Reader { scene: self, colors: Vec::new(), groups: Vec::new(), gravity: None };
        let mut place = Place { line: 1, column: 1 };
        for command in commands(text) {
            let located = command.map_err(InlineError::Text)?;
            place = located.place;
            reader.command(located).map_err(|message| InlineError::At(place, message))?;
        }
        reader.finish().map_err(|message| InlineError::At(place, message))
    }

    /// The scene, for a system to step through by rk4.
    #[must_use]
    pub fn scene(&self) -> Scene<'_> {
        Scene {
            start: &self.particles,
            springs: &self.springs,
            emitters: &self.emitters,
            forces: &self.forces,
            colliders: &self.colliders,
            sinks: &self.forces.3,
            reapers: &(),
            custom: &(),
            materials: &(),
            constraints: &(),
            substeps: 1,
            paths: Scene::EMPTY.paths,
            meetings: Meetings::Through,
            max_bounces: Scene::EMPTY.max_bounces,
            integrator: &Rk4,
            index: &(),
        }
    }
}

impl<const P: usize, const S: usize, const N: usize> Default for InlineScene<P, S, N> {
    fn default() -> Self {
        Self::new()
    }
}

struct Reader<'s, const P: usize, const S: usize, const N: usize> {
    scene: &'s mut InlineScene<P, S, N>,
    colors: Vec<Color, N>,
    /// The open groups: where they put things, and the colour they give.
    groups: Vec<(Affine, Option<u16>), N>,
    gravity: Option<Gravity>,
}

type Done = Result<(), &'static str>;

impl<const P: usize, const S: usize, const N: usize> Reader<'_, P, S, N> {
    fn command(&mut self, Located { command, .. }: Located<'_>) -> Done {
        match command {
            Command::Particle { mut particle, material } => {
                particle.material = self.material(material.value)?;
                particle.color = self.color(particle.material);
                self.scene.particles.push(particle).map_err(|_| "too many particles for this array")
            }
            Command::Source(source) => self.source(source),
            Command::Sink(sink) => {
                let Sink { group, intensity, ca, la, qa, softening, .. } = sink;
                let sink = Sink { shape: plain(&sink.shape)?, group, intensity, ca, la, qa, softening };
                self.scene.forces.3.push(sink).map_err(|_| "too many sinks for this array")
            }
            Command::Spring { ends, rest_length, ks, kd } => {
                let [a, b] = ends.map(|end| u32::try_from(end.value).unwrap_or(u32::MAX));
                let spring = Spring { kd, ..Spring::new([a, b], rest_length, ks) };
                self.scene.springs.push(spring).map_err(|_| "too many springs for this array")
            }
            Command::Gravity(acceleration) => {
                self.gravity = Some(Gravity { acceleration });
                Ok(())
            }
            Command::Scenery(Scenery { shape: Shape::Line(_), material }) => self.material(material.value).map(drop),
            Command::Scenery(Scenery { shape, material }) => {
                self.material(material.value)?;
                let placed = Placed::new(plain(&shape)?, self.place()).ok_or("its groups flatten space")?;
                self.scene.colliders.push(placed).map_err(|_| "too many solids for this array")
            }
            Command::Begin { material, matrix } => self.begin(material.value, matrix),
            Command::End => self.groups.pop().map(drop).ok_or("there is no 'begin' it could end"),
            Command::Material { colors: [_, diffuse, _, _, emission], .. } => {
                let color = shown(diffuse, emission);
                self.colors.push(color).map_err(|_| "too many materials for this array")
            }
            Command::Include(_) => Err("files cannot be included here"),
            Command::DirectionalLight(_)
            | Command::PointLight(_)
            | Command::SpotLight(..)
            | Command::AreaLight(..)
            | Command::Camera(_)
            | Command::Ambient(_)
            | Command::Background(_) => Ok(()),
        }
    }

    fn source(&mut self, source: Source<'_>) -> Done {
        let Source { newborn, material, rate, velocity, angle_cutoff, shape } = source;
        let material = self.material(material.value)?;
        let emitter = Emitter {
            speed: Varied::exactly(velocity),
            spread: Spread::Lecture(angle_cutoff),
            material,
            color: self.color(material),
            ..Emitter::new(plain(&shape)?, rate).giving_birth_to(&newborn)
        };
        self.scene.emitters.push(emitter).map_err(|_| "too many sources for this array")
    }

    fn begin(&mut self, material: i64, rows: [[f32; 4]; 4]) -> Done {
        let inner = affine(rows)?;
        let inherited = self.groups.last().and_then(|group| group.1);
        let group = (self.place().after(&inner), self.material(material)?.or(inherited));
        self.groups.push(group).map_err(|_| "groups too deep in each other for this array")
    }

    fn place(&self) -> Affine {
        self.groups.last().map_or(Affine::IDENTITY, |group| group.0)
    }

    fn material(&self, number: i64) -> Result<Option<u16>, &'static str> {
        match u16::try_from(number) {
            Ok(number) if usize::from(number) < self.colors.len() => Ok(Some(number)),
            Err(_) if number == -1 => Ok(self.groups.last().and_then(|group| group.1)),
            _ => Err("there is no such material above it"),
        }
    }

    fn color(&self, material: Option<u16>) -> Option<Color> {
        self.colors.get(usize::from(material?)).copied()
    }

    fn finish(self) -> Done {
        if !self.groups.is_empty() {
            return Err("a 'begin' is without its 'end'");
        }
        let count = self.scene.particles.len();
        if self.scene.springs.iter().any(|spring| spring.ends.iter().any(|&end| end as usize >= count)) {
            return Err("a spring names a particle that is not there");
        }
        self.scene.forces.0.extend(self.gravity);
        self.scene.forces.2.extend([AllPairs::NEWTON]);
        Ok(())
    }
}

/// A shape that is no mesh.
fn plain(shape: &Shape<&str>) -> Result<Shape<NoMesh>, &'static str> {
    shape.with_mesh(|_| Err("meshes cannot be read here"))
}

/// Four rows of a matrix as a map of space.
///
/// # Errors
/// If the last row is not 0 0 0 1, or the map cannot be undone.
pub(super) fn affine([a, b, c, last]: [[f32; 4]; 4]) -> Result<Affine, &'static str> {
    if last != [0.0, 0.0, 0.0, 1.0] {
        return Err("the last row of the matrix has to be 0 0 0 1");
    }
    let column = |i: usize| Vec3::new(a[i], b[i], c[i]);
    let affine = Affine { linear: Mat3::from_cols(column(0), column(1), column(2)), shift: column(3) };
    let sound = affine.shift.is_finite() && affine.inverse().is_some();
    if sound { Ok(affine) } else { Err("the matrix flattens space: it has no inverse") }
}
