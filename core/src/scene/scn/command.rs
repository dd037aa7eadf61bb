//! The commands of a `.scn` text.

use super::lex::{Index, Lexer, Place, Problem, ScnError};
use crate::particles::Particle;
use crate::shape::{Cone, Cuboid, Cylinder, Disc, Line, Shape, Sphere, Triangle};
use glam::Vec3;

/// A command with its arguments. Meshes are named by file.
#[derive(Clone, Debug, PartialEq)]
pub enum Command<'a> {
    /// `particle`; its material is not yet looked up.
    Particle {
        /// The particle.
        particle: Particle,
        /// Its material; −1: that of the group.
        material: Index,
    },
    /// `particle_source`.
    Source(Source<'a>),
    /// `particle_sink`.
    Sink(crate::force::Sink<&'a str>),
    /// `particle_spring`.
    Spring {
        /// The particles at its ends.
        ends: [Index; 2],
        /// Rest length \[m\].
        rest_length: f32,
        /// Stiffness \[N/m\].
        ks: f32,
        /// Damping \[N s/m\].
        kd: f32,
    },
    /// `particle_gravity` \[m/s²\].
    Gravity(Vec3),
    /// `tri`, `box`, `sphere`, `cylinder`, `cone`, `mesh` or `line`.
    Scenery(Scenery<'a>),
    /// `begin`: a material and a matrix of four rows.
    Begin {
        /// The material of everything inside that says −1.
        material: Index,
        /// Rows of the matrix; the shift stands in the last column.
        matrix: [[f32; 4]; 4],
    },
    /// `end`.
    End,
    /// `material`: ambient, diffuse, specular, transmitted, emitted colour; shininess, index of refraction; texture.
    Material {
        /// The five colours.
        colors: [[f32; 3]; 5],
        /// Exponent of the highlight.
        shininess: f32,
        /// Index of refraction.
        refraction: f32,
        /// The file of its texture.
        texture: Option<&'a str>,
    },
    /// `dir_light`: colour and direction.
    DirectionalLight([[f32; 3]; 2]),
    /// `point_light`: colour, position; ca, la, qa.
    PointLight([[f32; 3]; 3]),
    /// `spot_light`: colour, position, direction, attenuation; cutoff and drop-off.
    SpotLight([[f32; 3]; 4], [f32; 2]),
    /// `area_light`: colour, position, direction; radius; attenuation.
    AreaLight([[f32; 3]; 3], f32, [f32; 3]),
    /// `camera`: eye, direction, up; half angle, near, far.
    Camera([[f32; 3]; 4]),
    /// `ambient`: colour.
    Ambient([f32; 3]),
    /// `background`: colour.
    Background([f32; 3]),
    /// `include`: another scene.
    Include(&'a str),
}

/// The arguments of `particle_source`.
#[derive(Clone, Debug, PartialEq)]
pub struct Source<'a> {
    /// Mass, drag, elasticity, lifetime of what it gives birth to, and whether that is fixed; at rest in the origin.
    pub newborn: Particle,
    /// Its material; −1: that of the group.
    pub material: Index,
    /// Births per second.
    pub rate: f32,
    /// Speed along the direction of birth \[m/s\].
    pub velocity: f32,
    /// Cutoff of the angle about the surface's normal \[rad\].
    pub angle_cutoff: f32,
    /// Where births lie.
    pub shape: Shape<&'a str>,
}

/// The arguments of a shape of the scenery.
#[derive(Clone, Debug, PartialEq)]
pub struct Scenery<'a> {
    /// Its material; −1: that of the group.
    pub material: Index,
    /// The shape.
    pub shape: Shape<&'a str>,
}

/// A command and where it begins.
#[derive(Clone, Debug, PartialEq)]
pub struct Located<'a> {
    /// Where its name stands.
    pub place: Place,
    /// Its name.
    pub name: &'a str,
    /// The command.
    pub command: Command<'a>,
}

/// The commands of `text`, in order, until the first that is wrong.
#[must_use]
pub fn commands(text: &str) -> Commands<'_> {
    Commands { lexer: Lexer::new(text), failed: false }
}

/// Iterates over the commands of a text; ends after an error.
#[derive(Clone, Debug)]
pub struct Commands<'a> {
    lexer: Lexer<'a>,
    failed: bool,
}

/// The name of a command, as long as the program lasts.
#[cfg(feature = "alloc")]
pub(crate) fn known(name: &str) -> &'static str {
    NAMES.into_iter().find(|known| *known == name).unwrap_or("")
}

/// The names of all commands.
const NAMES: [&str; 23] = [
    "particle",
    "particle_source",
    "particle_sink",
    "particle_spring",
    "particle_gravity",
    "tri",
    "box",
    "sphere",
    "cylinder",
    "cone",
    "mesh",
    "line",
    "begin",
    "end",
    "material",
    "dir_light",
    "point_light",
    "spot_light",
    "area_light",
    "camera",
    "ambient",
    "background",
    "include",
];

impl Commands<'_> {
    /// Goes on after an unknown command, which stands at `place`, at the next line that begins with a command: a known one,
    /// or a word that may be the name of another and stands no further in. What lies between, such as arguments, is passed
    /// over.
    pub fn resume_after(&mut self, place: Place) {
        self.failed = false;
        let is_name = |word: &str| {
            word.starts_with(|c: char| c.is_ascii_alphabetic())
                && word.bytes().all(|b| b.is_ascii_alphanumeric() || b == b'_')
        };
        self.lexer.skip_to_line_of(|word, column| {
            NAMES.contains(&word) || (is_name(word) && column <= place.column as usize)
        });
    }
}

impl<'a> Iterator for Commands<'a> {
    type Item = Result<Located<'a>, ScnError<'a>>;

    fn next(&mut self) -> Option<Self::Item> {
        if self.failed {
            return None;
        }
        self.lexer.command = "";
        let (name, place) = self.lexer.next()?;
        let command = self.lexer.arguments(name, place);
        self.failed = command.is_err();
        Some(command.map(|command| Located { place, name, command }))
    }
}

type Parsed<'a, T> = Result<T, ScnError<'a>>;

impl<'a> Lexer<'a> {
    fn arguments(&mut self, name: &'a str, place: Place) -> Parsed<'a, Command<'a>> {
        let unknown = self.error(place, name, Problem::UnknownCommand);
        self.command = name;
        Ok(match name {
            "particle" => self.particle()?,
            "particle_source" => self.source()?,
            "particle_sink" => {
                let intensity = self.float("the intensity")?;
                let [ca, la, qa] = [self.float("ca")?, self.float("la")?, self.float("qa")?];
                Command::Sink(crate::force::Sink {
                    group: None,
                    intensity,
                    ca,
                    la,
                    qa,
                    softening: 0.0,
                    shape: self.any_shape()?,
                })
            }
            "particle_spring" => Command::Spring {
                ends: [self.index("the first particle")?, self.index("the second particle")?],
                rest_length: self.float("the rest length")?,
                ks: self.float("ks")?,
                kd: self.float("kd")?,
            },
            "particle_gravity" => Command::Gravity(self.vector("gravity")?),
            "tri" | "box" | "sphere" | "cylinder" | "cone" | "mesh" | "line" => {
                let material = self.index("the material")?;
                Command::Scenery(Scenery { material, shape: self.shape(name, unknown)? })
            }
            "begin" => {
                let material = self.index("the material")?;
                Command::Begin { material, matrix: self.rows("a number of the matrix")? }
            }
            "end" => Command::End,
            "material" => Command::Material {
                colors: self.rows("a colour")?,
                shininess: self.float("the shininess")?,
                refraction: self.float("the index of refraction")?,
                texture: Some(self.word("the texture, 0 for none")?.0).filter(|&file| file != "0"),
            },
            "dir_light" => Command::DirectionalLight(self.rows("a number of the light")?),
            "point_light" => Command::PointLight(self.rows("a number of the light")?),
            "spot_light" => {
                let vectors = self.rows("a number of the light")?;
                Command::SpotLight(vectors, [self.float("the cutoff")?, self.float("the drop-off")?])
            }
            "area_light" => {
                let vectors = self.rows("a number of the light")?;
                let radius = self.positive("the radius", "the radius has to be zero or more")?;
                let [attenuation] = self.rows("an attenuation")?;
                Command::AreaLight(vectors, radius, attenuation)
            }
            "camera" => Command::Camera(self.rows("a number of the camera")?),
            "ambient" => Command::Ambient(self.vector("a colour")?.to_array()),
            "background" => Command::Background(self.vector("a colour")?.to_array()),
            "include" => Command::Include(self.word("the name of a file")?.0),
            _ => return Err(unknown),
        })
    }

    fn particle(&mut self) -> Parsed<'a, Command<'a>> {
        let (position, velocity) = (self.vector("the position")?, self.vector("the velocity")?);
        let (particle, material) = self.properties()?;
        Ok(Command::Particle { particle: Particle { position, velocity, ..particle }, material })
    }

    fn source(&mut self) -> Parsed<'a, Command<'a>> {
        let (newborn, material) = self.properties()?;
        Ok(Command::Source(Source {
            newborn,
            material,
            rate: self.positive("the rate", "the rate has to be zero or more")?,
            velocity: self.float("the velocity")?,
            angle_cutoff: self.float("the angle cutoff")?,
            shape: self.any_shape()?,
        }))
    }

    /// mass fixed drag elasticity lifetime material
    fn properties(&mut self) -> Parsed<'a, (Particle, Index)> {
        let mut ahead = self.clone();
        let mass = self.float("the mass")?;
        let fixed = self.index("'fixed', 0 or 1")?.value != 0;
        let particle = Particle {
            mass,
            fixed,
            drag: self.float("the drag")?,
            elasticity: self.float("the elasticity")?,
            lifetime: self.float("the lifetime")?,
            ..Particle::REST
        };
        if !particle.is_sound() {
            let (word, place) = ahead.word("the mass")?;
            let must = "the mass has to be above zero (3e-39 kg at least) unless the particle is fixed";
            return Err(self.error(place, word, Problem::Must(must)));
        }
        Ok((particle, self.index("the material")?))
    }

    fn any_shape(&mut self) -> Parsed<'a, Shape<&'a str>> {
        let (name, place) = self.word("a shape")?;
        let unknown = self.error(place, name, Problem::UnknownShape);
        if name == "tri" { Err(unknown) } else { self.shape(name, unknown) }
    }

    fn shape(&mut self, name: &str, unknown: ScnError<'a>) -> Parsed<'a, Shape<&'a str>> {
        Ok(match name {
            "tri" => {
                let [a, b, c] = self.rows("a coordinate")?;
                Shape::Triangle(Triangle { corners: [a.into(), b.into(), c.into()] })
            }
            "box" => Shape::Box(Cuboid { min: self.vector("a corner")?, max: self.vector("a corner")? }),
            "sphere" => Shape::Sphere(Sphere { center: self.vector("the centre")?, radius: self.radius()? }),
            "cylinder" => Shape::Cylinder(Cylinder {
                center: self.vector("the centre")?,
                radius: self.radius()?,
                height: self.height()?,
            }),
            "cone" => {
                Shape::Cone(Cone { center: self.vector("the centre")?, radius: self.radius()?, height: self.height()? })
            }
            "mesh" => Shape::Mesh(self.word("the name of a mesh file")?.0),
            "line" => Shape::Line(Line { from: self.vector("an end")?, to: self.vector("an end")? }),
            "circle" => Shape::Circle(Disc {
                center: self.vector("the centre")?,
                normal: self.normal()?,
                radius: self.radius()?,
            }),
            _ => return Err(unknown),
        })
    }

    fn radius(&mut self) -> Parsed<'a, f32> {
        self.positive("the radius", "the radius has to be zero or more")
    }

    fn height(&mut self) -> Parsed<'a, f32> {
        self.positive("the height", "the height has to be zero or more")
    }

    fn normal(&mut self) -> Parsed<'a, Vec3> {
        let mut ahead = self.clone();
        let normal = self.vector("the normal")?;
        match ahead.next() {
            Some((word, place)) if crate::math::unit(normal) == Vec3::ZERO => {
                Err(self.error(place, word, Problem::Must("the normal has to have a direction")))
            }
            _ => Ok(normal),
        }
    }

    fn vector(&mut self, what: &'static str) -> Parsed<'a, Vec3> {
        Ok(Vec3::new(self.float(what)?, self.float(what)?, self.float(what)?))
    }

    fn rows<const N: usize, const M: usize>(&mut self, what: &'static str) -> Parsed<'a, [[f32; N]; M]> {
        let mut rows = [[0.0; N]; M];
        for number in rows.as_flattened_mut() {
            *number = self.float(what)?;
        }
        Ok(rows)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn error(text: &str) -> std::string::String {
        let error = commands(text).find_map(Result::err).expect("the text is wrong");
        std::format!("{}:{}: {error}", error.place.line, error.place.column)
    }

    #[test]
    fn numbers_are_as_c_reads_them() {
        let text = "particle_gravity 1E-6 .5 -0 particle_gravity +3 5. 1e+2";
        let all: std::vec::Vec<_> = commands(text).map(|c| c.expect("numbers").command).collect();
        assert_eq!(all[0], Command::Gravity(Vec3::new(1e-6, 0.5, -0.0)));
        assert_eq!(all[1], Command::Gravity(Vec3::new(3.0, 5.0, 100.0)));
    }

    #[test]
    fn comments_stand_anywhere_and_line_ends_mean_nothing() {
        let text = "\u{feff}#one\r\nparticle_gravity # two\r\n 0\r\n#three\r\n-1 0 # four";
        let all: std::vec::Vec<_> = commands(text).collect();
        assert_eq!(all.len(), 1);
        assert_eq!(all[0].as_ref().expect("gravity").command, Command::Gravity(-Vec3::Y));
    }

    #[test]
    fn every_name_is_a_command() {
        for name in NAMES {
            let problem = commands(name).find_map(Result::err).map(|error| error.problem);
            assert!(problem != Some(Problem::UnknownCommand), "{name}");
        }
        assert!(commands("player").find_map(Result::err).is_some_and(|e| e.problem == Problem::UnknownCommand));
    }

    #[test]
    fn what_is_unknown_ends_where_a_line_begins_with_a_command() {
        let text = "player 1 camera 2\n  3 # box\n\n red 4 end\n\t background 1 0 0\nenemy 1\nboss.off\nboss\rambient 0 1 0 \
                    player";
        let mut commands = commands(text);
        let (mut found, mut unknown) = (std::vec::Vec::new(), std::vec::Vec::new());
        while let Some(command) = commands.next() {
            match command {
                Ok(located) => found.push((located.name, located.place.line)),
                Err(error) => {
                    unknown.push(error.word);
                    commands.resume_after(error.place);
                }
            }
        }
        assert_eq!(found, [("background", 5), ("ambient", 8)]);
        assert_eq!(unknown, ["player", "enemy", "boss", "player"]);
    }

    #[test]
    fn errors_name_the_place_and_what_was_expected() {
        assert_eq!(error("ambient 0 0 0\n  wind 1"), "2:3: unknown command 'wind'");
        assert_eq!(error("particle_gravity 0 x 0"), "1:20: particle_gravity: expected gravity, a number, found 'x'");
        assert_eq!(error("camera 0 0"), "1:11: camera: the file ends where a number of the camera is expected");
        assert_eq!(error("ambient 0 0 nan"), "1:13: ambient: a colour has to be finite, not nan");
        assert!(error("ambient 0 0 1e39").ends_with("a colour 1e39 is beyond the range of a 32-bit float"));
        assert!(error("particle 0 0 0 0 0 0 0 0 0 0 0 -1").starts_with("1:22: particle: the mass has to be above"));
        assert!(error("particle_spring 0 1.5 1 1 1").ends_with("a whole number, found '1.5'"));
        assert!(error("particle_sink 1 1 1 1 torus").contains("unknown shape 'torus'; expected box"));
        assert!(error("sphere 0 0 0 0 -1").contains("the radius has to be zero or more, found '-1'"));
    }

    proptest! {
        #[test]
        fn no_text_makes_it_panic(text in "\\PC{0,200}", cut in 0usize..400) {
            let known = "particle_source 1 0 0 0 0 -1 10 0 0 box 0 0 0 1 1 1 material 1 2 3 4 5 6 7 8 9 1 2 3 4 5 6 7 8 0";
            let cut = cut.min(known.len());
            for text in [text.clone(), std::format!("{}{text}", &known[..cut])] {
                prop_assert!(commands(&text).count() <= text.len());
            }
        }
    }
}
