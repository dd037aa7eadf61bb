//! Thin sheets that stretch, shear and bend by the numbers of their material: cloth, paper, sails, leaves, foil.

mod assemble;
mod bounded;
mod corners;
mod cycle;
#[cfg(feature = "alloc")]
mod declared;
mod eights;
mod finest;
mod fold;
mod folded;
mod linear;
mod membrane;
mod mesh;
mod params;
mod parts;
mod pieces;
mod plate;
mod resist;
mod solver;
mod step;
mod stored;
mod strips;
mod sweep;
mod taut;
mod words;

pub use params::ShellParams;

use super::{Bodies, Constraint, Demand, Share, Words, walls};
use crate::cloth::Hinge;
use crate::memory::take;
use cycle::Levels;
use finest::Links;
use fold::{Fold, RestFold};
use glam::Vec3;
use membrane::{Cell, Strain};
use mesh::{Graph, Room};
use pieces::Roll;
use plate::{Plate, Shape};
use solver::Solver;
use step::Step;
use words::structs;

/// A thin shell of triangles, in the shape in which it begins at rest.
///
/// A shell that is clamped, by triangles whose corners are all fixed as it begins, bends from their edge on.
///
/// In its plane each triangle resists Green's strain along warp, weft and between them; out of it the curvature that the angles
/// over its three edges make, less that at rest: ½ B A |S − S₀|², with S = Σ θ n nᵀ / height (Grinspun, Gingold, Reisman and Zorin,
/// "Computing discrete shape operators on general meshes", Computer Graphics Forum 25, 2006, without Poisson's ratio). On sheets of
/// cells that is exact for every uniform curvature, so that a mesh twice as fine bends alike. Energies of single edges
/// with weights of 3 length² / area (Bergou et al., "A quadratic bending model for inextensible surfaces", SGP 2006) are three times that
/// where such a sheet bends along its cells, and nine times along one of their diagonals.
///
/// Stretching and bending are solved as one, by conjugate gradients for the positions at the sub-step's end, as often as it takes to be as stiff
/// as the numbers say: at rest the forces are those of the material, whatever the sub-steps, and that does not depend on the order of triangles. Where it is damped
/// and ties or contacts move the ends of edges against each other by more than an eighth of their length in a sub-step, the damping of what takes them back
/// adds to the load. Damping that lasts for more than four sub-steps multiplies what strains have of second order in a sub-step's way: a second step of
/// Newton's method, if it is the shorter one, takes that back.
/// From 16 particles on, a cycle through coarser meshes of groups of particles (algebraic multigrid by plain aggregation: Vaněk, Mandel and
/// Brezina, Computing 56, 1996; symmetric Gauss-Seidel sweeps) goes before each iteration, so that about ten are enough however fine and stiff it
/// is; where bending resists more than stretching, some dozens. They end where what is left is 0.3 % of the whole in the norm of energy (a tenth
/// of that below 1,024 particles, and where rough scenery presses), or 0.01 % of the residual of fewer than 16 particles. Needles, as there are where
/// hundreds of spokes meet in a hub, take several times as many. Iterations are counted in [`Effort`](crate::Effort), and what is cut off after
/// 400 of them as capped: it is then softer for a while. Of a mesh whose hinges are there twice, or are not edges of two of its triangles, there may be no
/// room for graphs: it takes dozens of iterations and more, and that is counted in [`Caps`](crate::Caps).
///
/// Whatever is laid on particles ([`Bodies::lay_on`]) counts as mass of theirs while it is solved: what hangs from it by ties.
///
/// Where particles meet the scenery in a sub-step, that presses and brakes them while the material is solved (an active set of planes, one a
/// particle, with Coulomb's cone), so that a hit on a few of them is one on all that hangs on them, and a sheet that falls stretches little
/// more than its material gives. Edges that turn so far in a sub-step that what is solved along the directions of its beginning leaves them too
/// long are shortened. The sweep at the step's end is left to those whose way may have passed through something.
///
/// Forces act along the directions of the sub-step's beginning, and what the turning of tense triangles would take of the angular
/// momentum is given back, so that both momenta are kept to rounding, and motion without damping loses little. What nothing holds
/// gains no energy, of motion and strain together, however long its sub-steps: what would be too much is taken from how it deforms. What walls
/// press that stand still gains no more than forces do on its way and a thousandth in a sub-step (what bending alone gives is not looked for), but for what
/// the elasticity of its hits gives back: what would be too much is taken of its way, but for how all of it goes along smooth walls. What is fixed
/// somewhere, or pressed by what moves, has no such bound. That
/// holds for each piece that hangs together by triangles and folds, from the beginning or when it has been torn: none takes what another has.
/// It does not act through the sides of a periodic room. Whoever is fixed stays. Where a particle has died, its triangles and folds are gone. What is degenerate at rest does nothing, and is counted in [`Caps`](crate::Caps).
///
/// [`Observer`](crate::Observer)s are told of particles that come together with the scenery ([`touched`](crate::Observer::touched)), once, as that begins.
///
/// ```
/// use pointmass::constrain::{Shell, ShellParams};
/// use pointmass::{Gravity, Heap, Particle, Scene, Sheet, System, Time, Vec3};
///
/// // A strip of stiff paper, clamped where it begins.
/// let sheet = Sheet { corner: Vec3::ZERO, sides: [Vec3::X * 0.21, Vec3::Z * 0.03], cells: [14, 2] };
/// let gram = Particle { mass: 0.08 * 0.21 * 0.03 / 45.0, ..Particle::REST };
/// let mut start: Vec<Particle> = sheet.particles(gram).collect();
/// start.iter_mut().filter(|p| p.position.x < 0.02).for_each(|p| p.fixed = true);
/// let paper = ShellParams { stretch: [1e4; 2], shear: 5e3, bending: 1e-2, damping: 1e-3 };
/// let shell = Shell {
///     particles: (0..45).collect::<Vec<u32>>(),
///     triangles: sheet.triangles().collect::<Vec<_>>(),
///     hinges: sheet.hinges().collect::<Vec<_>>(),
///     warp: Vec3::X,
///     params: paper,
/// };
/// let scene = Scene { start: &start, forces: &Gravity::EARTH, constraints: &shell, substeps: 10, ..Scene::EMPTY };
/// let mut system = System::with(Heap::new(scene.size()));
/// system.start(&scene, 1)?;
/// for frame in 1..=30 {
///     system.step_to(&scene, Time::frame(frame, 60));
/// }
/// let end = system.particles().position[14];
/// assert!(end.y < -0.005 && end.y > -0.04, "it bends, and does not hang: {end}");
/// # Ok::<(), pointmass::InsufficientMemory>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Shell<P, T, H> {
    /// The particles, by their place in the scene's start.
    pub particles: P,
    /// The triangles, by places in `particles`.
    pub triangles: T,
    /// The edges over which it bends. They come from [`Sheet::hinges`](crate::Sheet::hinges) or [`mesh_hinges`](super::mesh_hinges).
    pub hinges: H,
    /// The direction of the warp in the shape in which it begins; each triangle takes it in its own plane.
    #[cfg_attr(feature = "schema", schemars(with = "[f32; 3]"))]
    pub warp: Vec3,
    /// Its material.
    pub params: ShellParams,
}

/// The words that it keeps of each triangle and each fold, and works with; and with each particle.
const KEPT: [usize; 2] = [size_of::<Cell>() / 4, size_of::<RestFold>() / 4];
const WORK: [usize; 3] = [size_of::<Strain>() / 4, size_of::<Fold>() / 4, 18];
/// Steps of Newton's method at the most, where the first gains energy on walls.
const STEPS: u32 = 4;

impl<P: AsRef<[u32]>, T: AsRef<[[u32; 3]]>, H: AsRef<[Hinge]>> Shell<P, T, H> {
    /// The numbers of its particles, triangles and hinges.
    fn counts(&self) -> [usize; 3] {
        [self.particles.as_ref().len(), self.triangles.as_ref().len(), self.hinges.as_ref().len()]
    }

    /// The first of its numbers that cannot be used, and what it has to be.
    #[must_use]
    pub fn fault(&self) -> Option<(&'static str, &'static str)> {
        let [particles, triangles, _] = self.counts();
        let stranger = |number: u32, count: usize| number as usize >= count;
        let mut corners = self.triangles.as_ref().iter().flatten();
        let mut hinges = self.hinges.as_ref().iter();
        let faults = [
            (corners.any(|&c| stranger(c, particles)), "triangles", "have to name places in particles, from 0"),
            (
                hinges.any(|hinge| {
                    hinge.corners().into_iter().any(|c| stranger(c, particles))
                        || hinge.faces.into_iter().any(|face| stranger(face, triangles))
                }),
                "hinges",
                "have to name places in particles, and triangles, from 0",
            ),
            (!self.warp.is_finite(), "warp", "has to be finite"),
        ];
        let wrong = faults.into_iter().find(|&(wrong, ..)| wrong).map(|(_, name, message)| (name, message));
        wrong.or_else(|| self.params.fault())
    }

    /// All that it keeps, in words.
    fn rest<'m>(&self, kept: &'m mut [u32]) -> Rest<'m> {
        let [_, triangles, hinges] = self.counts();
        let mut rest = kept;
        let _name = take(&mut rest, 1);
        let cells = structs(take(&mut rest, triangles.saturating_mul(KEPT[0])));
        let bends = structs(take(&mut rest, hinges.saturating_mul(KEPT[1])));
        let room = Room::of(self.counts());
        let graphs = take(&mut rest, room.words());
        let links = take(&mut rest, finest::pattern(&room, triangles));
        let plate = take(&mut rest, plate::words(&room));
        let roll = take(&mut rest, pieces::KEPT.saturating_mul(self.counts()[0]));
        let last = structs(take(&mut rest, 3 * room.rows[0]));
        Rest { cells, bends, graphs, links, plate, roll, last, left: structs(take(&mut rest, self.left())) }
    }

    /// The words in which it keeps where it has left its particles, if it is damped.
    fn left(&self) -> usize {
        if self.params.damping > 0.0 { self.particles.as_ref().len().saturating_mul(3) } else { 0 }
    }

    fn shape<'s>(&'s self, cells: &'s [Cell], bends: &'s [RestFold]) -> Shape<'s> {
        Shape { triangles: self.triangles.as_ref(), cells, hinges: self.hinges.as_ref(), bends }
    }

    /// Makes the matrix of bending of those who are there, if these are others than before.
    fn update(&self, bodies: &Bodies<'_>, kept: &mut [u32], work: &mut [u32]) {
        let Rest { cells, bends, graphs, links, plate, .. } = self.rest(kept);
        let ([finest, ..], room) = (Graph::all(graphs), Room::of(self.counts()));
        let edges = Links::of(&room, cells.len(), links).strips;
        let particles = self.particles.as_ref().iter().map(|&particle| bodies.row_of_start(particle).is_some());
        Plate::of(&room, plate).update(&finest, &edges, &self.shape(cells, bends), particles, work);
    }

    /// Takes the shape at rest from where all are, at the first of all.
    fn learn(&self, bodies: &mut Bodies<'_>, kept: &mut [u32], work: &mut [u32]) {
        let (Rest { cells, bends, graphs, links, plate, left, .. }, room) = (self.rest(kept), Room::of(self.counts()));
        mesh::make(&room, self.triangles.as_ref(), graphs, work);
        let all = Graph::all(graphs);
        if all[0].rows() > 0 {
            let made = Links::make(&room, &all, self.triangles.as_ref(), links, work)
                .and_then(|()| plate::find(&room, &self.shape(&[], &[]), plate, work));
            if made.is_none() {
                // Without room for all that hangs or bends together everything goes triangle by triangle.
                graphs.fill(0);
            }
        }
        let place = |corner: u32| {
            let row = bodies.row_of_start(*self.particles.as_ref().get(corner as usize)?)?;
            Some(bodies.position[row])
        };
        for (left, corner) in left.iter_mut().zip(0..) {
            *left = place(corner).unwrap_or(Vec3::NAN);
        }
        let is_fixed = |corner: u32| {
            let row = self.particles.as_ref().get(corner as usize).and_then(|&particle| bodies.row_of_start(particle));
            row.is_some_and(|row| bodies.inverse_mass[row] == 0.0)
        };
        let mut degenerate = 0;
        for (&corners, cell) in self.triangles.as_ref().iter().zip(&mut *cells) {
            *cell = Cell::NONE;
            if let [Some(a), Some(b), Some(c)] = corners.map(place) {
                *cell = Cell::at_rest([b - a, c - a], self.warp);
                degenerate += u64::from(cell.area == 0.0);
            }
        }
        for (hinge, bend) in self.hinges.as_ref().iter().zip(bends) {
            let triangles = hinge.faces.map(|face| self.triangles.as_ref().get(face as usize));
            let corners = hinge.corners().map(place);
            let ([Some(first), Some(second)], [Some(a), Some(b), Some(c), Some(d)]) = (triangles, corners) else {
                continue;
            };
            let signs = [hinge.sign(*first), -hinge.sign(*second)];
            let fixed = [first, second].map(|face| face.iter().all(|&corner| is_fixed(corner)));
            *bend = RestFold::at_rest([b - a, c - a, d - a], self.warp, signs, fixed);
            degenerate += u64::from(!bend.acts());
        }
        bodies.report.caps.degenerate += degenerate;
    }
}

/// All that a shell keeps behind the word that tells whose it is: its triangles and folds at rest, its graphs, how it bends, its pieces, and where it went
/// last and left its particles.
struct Rest<'m> {
    cells: &'m mut [Cell],
    bends: &'m mut [RestFold],
    graphs: &'m mut [u32],
    links: &'m mut [u32],
    plate: &'m mut [u32],
    roll: &'m mut [u32],
    last: &'m mut [Vec3],
    left: &'m mut [Vec3],
}

impl<P, T, H> Constraint for Shell<P, T, H>
where
    P: AsRef<[u32]> + Sync,
    T: AsRef<[[u32; 3]]> + Sync,
    H: AsRef<[Hinge]> + Sync,
{
    fn demand(&self) -> Demand {
        let [particles, triangles, hinges] = self.counts();
        let sum = |parts: &[usize]| parts.iter().copied().fold(0, usize::saturating_add);
        let room = Room::of(self.counts());
        let kept = sum(&[
            1,
            pieces::KEPT.saturating_mul(particles),
            room.words(),
            finest::pattern(&room, triangles),
            plate::words(&room),
            3 * room.rows[0],
            self.left(),
            triangles.saturating_mul(KEPT[0]),
            hinges.saturating_mul(KEPT[1]),
        ]);
        let work = sum(&[
            triangles.saturating_mul(WORK[0]),
            hinges.saturating_mul(WORK[1]),
            particles.saturating_mul(WORK[2]),
        ]);
        let solving = cycle::words(&room).max(pieces::words(self.counts()));
        let work = work.saturating_add(solving).max(plate::scratch(&room, self.counts()));
        let words = |fixed| Words { per_row: 0, fixed };
        let step = particles.saturating_mul(walls::WORDS);
        Demand { kept: words(kept), step: words(step), scratch: words(work), ..Demand::NONE }
    }

    fn is_empty(&self) -> bool {
        self.triangles.as_ref().is_empty() && self.hinges.as_ref().is_empty()
    }

    fn prepare(&self, bodies: &mut Bodies<'_>, share: &mut Share<'_>) {
        if share.claim(*b"shel", &self.counts()) {
            self.learn(bodies, share.kept.fixed, share.scratch);
        }
        self.update(bodies, share.kept.fixed, share.scratch);
        bodies.bear_all(self.particles.as_ref());
    }

    fn project(&self, bodies: &mut Bodies<'_>, share: &mut Share<'_>) {
        let h = bodies.substep.seconds();
        if !(h > 0.0) {
            return;
        }
        let [particles, triangles, hinges] = self.counts();
        let room = Room::of(self.counts());
        let Rest { cells, bends, graphs, links, plate, roll, last, left } = self.rest(share.kept.fixed);
        let mut rest = &mut *share.scratch;
        let strains = structs(take(&mut rest, triangles.saturating_mul(WORK[0])));
        let folds = structs(take(&mut rest, hinges.saturating_mul(WORK[1])));
        let vectors = take(&mut rest, particles.saturating_mul(WORK[2]));
        let vectors = solver::Vectors::of(bodies, self.particles.as_ref(), vectors);
        let mut roll = Roll::of(roll, particles);
        roll.update(vectors.rows, &self.shape(cells, bends));
        roll.catch_up(bodies, &vectors, rest);
        let walls = walls::of(share.step, particles);
        walls::gather(walls, self.particles.as_ref(), bodies);
        let mut solver = Solver {
            params: &self.params,
            step: Step { h, lag: self.params.damping, rate: 1.0 + self.params.damping / h },
            triangles: self.triangles.as_ref(),
            cells,
            strains,
            hinges: self.hinges.as_ref(),
            bends,
            folds,
            vectors,
            thin: false,
            walls,
            last,
            left,
        };
        solver.each_laden(bodies, |bodies, row| {
            bodies.take_up(row);
        });
        solver.list_walls();
        solver.meet(bodies);
        for step in 1..=STEPS {
            let (links, plate) = (Links::of(&room, triangles, links), Plate::of(&room, plate));
            let mut levels = Levels::of(Graph::all(graphs), links, plate, rest);
            bodies.report.caps.graphs += u64::from(step == 1 && mesh::asked(self.counts()) && levels.is_empty());
            solver.thin = !levels.is_empty() && levels.finest.plate.is_thin(&self.params) && self.params.bending > 0.0;
            match step {
                1 => solver.linearise(bodies),
                _ => solver.go_on_from(bodies),
            }
            solver.assemble(&mut levels);
            solver.solve(bodies, &mut levels, step == 1);
            solver.tighten(bodies);
            if solver.act_within(bodies, &mut roll, rest, step) {
                break;
            }
        }
        solver.each_laden(bodies, |bodies, row| {
            bodies.put_down(row);
        });
        solver.leave(bodies);
    }

    fn settle(&self, bodies: &mut Bodies<'_>, share: &mut Share<'_>) {
        let [particles, ..] = self.counts();
        if bodies.substep.seconds() > 0.0 {
            let walls = walls::of(share.step, particles);
            walls::settle(walls, bodies);
            walls::follow(walls, bodies);
        }
    }
}
