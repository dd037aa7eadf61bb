//! Limits of strain: how far triangles of cloth stretch, shrink and shear at the most.

mod cell;

#[cfg(feature = "alloc")]
use super::declared::Declared;
use super::{Bodies, Constraint, Demand, Share, Words};
use crate::math::{clamp, dot, max, sin_cos};
use cell::{Cell, Held, NEARLY, Past};
use glam::Vec3;

/// How far warp and weft may stretch and shrink, and turn against each other. A limit that is none does not hold.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(default, deny_unknown_fields))]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct StrainLimitParams {
    /// The least and the greatest length of the warp, as shares of its length at rest: `[0.9, 1.02]` lets it shrink by 10 % and stretch by
    /// 2 %.
    #[cfg_attr(feature = "serde", serde(skip_serializing_if = "Option::is_none"))]
    pub warp: Option<[f32; 2]>,
    /// The same of the weft.
    #[cfg_attr(feature = "serde", serde(skip_serializing_if = "Option::is_none"))]
    pub weft: Option<[f32; 2]>,
    /// By how much the angle between warp and weft may differ from a right one, either way \[rad\], up to π/2.
    #[cfg_attr(feature = "serde", serde(skip_serializing_if = "Option::is_none"))]
    pub shear: Option<f32>,
    /// How far the limits give way \[m/N\]: a strip of that width is stretched beyond its limit by a share s of its length with a pull of
    /// s over this for each metre of its width. Zero is rigid.
    pub compliance: f32,
    /// The pull for each metre of width, for the rate of strain beyond a limit \[N s/m\].
    pub damping: f32,
}

impl StrainLimitParams {
    /// The first of its numbers that cannot be used, and what it has to be.
    #[must_use]
    pub fn fault(&self) -> Option<(&'static str, &'static str)> {
        const RANGE: &str = "has to be the least and the greatest length as shares of that at rest, with 1 between them, such as [0.9, 1.02]";
        let not_negative = |x: f32| (0.0..f32::INFINITY).contains(&x);
        let holds_rest = |range: Option<[f32; 2]>| {
            range.is_none_or(|[low, high]| (0.0..=1.0).contains(&low) && (1.0..f32::INFINITY).contains(&high))
        };
        let all = self.warp.is_none() && self.weft.is_none() && self.shear.is_none();
        let faults = [
            (all, "warp", "has to be limited, or weft, or shear, such as {\"warp\": [0.9, 1.02]}"),
            (!holds_rest(self.warp), "warp", RANGE),
            (!holds_rest(self.weft), "weft", RANGE),
            (
                !self.shear.is_none_or(|angle| (0.0..=QUARTER).contains(&angle)),
                "shear",
                "has to be from 0 to π/2, in rad",
            ),
            (!not_negative(self.compliance), "compliance", "must not be below zero, in m/N"),
            (!not_negative(self.damping), "damping", "must not be below zero, in N s/m"),
        ];
        faults.into_iter().find(|&(wrong, ..)| wrong).map(|(_, name, message)| (name, message))
    }
}

/// A quarter of a turn \[rad\], and what rounds to it.
const QUARTER: f32 = core::f32::consts::FRAC_PI_2;

/// Keeps the strain of triangles within limits, beyond which cloth hardly gives way: springs or other forces give it the softness that it has
/// within.
///
/// What warp and weft have become are the columns u and v of a triangle's deformation gradient. Their lengths are held within a range
/// each, and the sine of the angle of shear, u·v / (|u| |v|), within what the limit's is (Provot, "Deformation Constraints in a Mass-Spring
/// Model", Graphics Interface 1995; Thomaszewski, Pabst and Straßer, "Continuum-based Strain Limiting", Computer Graphics Forum 28, 2009;
/// Müller, Chentanez, Kim and Macklin, "Strain Based Dynamics", SCA 2014). Each is a constraint of one side of extended position-based dynamics
/// with the compliance over the triangle's area (Macklin, Müller and Chentanez, "XPBD", MIG 2016), so that what it gives does not
/// depend on the mesh.
///
/// Triangles are gone through one after the other, there and back, until all are within 0.01 % of their limits, but 16 times at the most; what is
/// cut off then is counted as capped in [`Effort`](crate::Effort), and stretched farther for a while. From the second time on all go on as far again
/// in the direction of the times before as is good (Silcowitz, Niebe and Erleben, "A nonsmooth nonlinear conjugate gradient method
/// for interactive contact force problems", Visual Computer 26, 2010). Heavy loads on light cloth ask for sub-steps that resolve how fast it swings
/// under them. Within limits nothing acts.
///
/// Stresses act along the directions of the sub-step's beginning, by which both momenta are kept to rounding; those of triangles that turn by
/// more than 60° in a sub-step along those of its end, which keep linear momentum alone. What scenery or others
/// have put beyond rigid limits gets a part of that back in each sub-step by places alone: it is not thrown. A triangle that has lost a corner is gone, whoever is
/// fixed stays, and what is degenerate does nothing. A [`Shell`](super::Shell) follows its particles past the scenery by itself: limits of the
/// same particles go before it in a list.
///
/// ```
/// use pointmass::constrain::{StrainLimitParams, StrainLimits};
/// use pointmass::{ClothSprings, Gravity, Heap, Particle, Scene, Sheet, SpringParams, System, Time, Vec3};
///
/// // A soft net that hangs by its upper edge.
/// let sheet = Sheet { corner: Vec3::ZERO, sides: [Vec3::X * 0.4, Vec3::NEG_Y * 0.4], cells: [4, 4] };
/// let knot = Particle { mass: 0.02, drag: 0.05, ..Particle::REST };
/// let mut start: Vec<Particle> = sheet.particles(knot).collect();
/// start[..5].iter_mut().for_each(|particle| particle.fixed = true);
/// let soft = Some(SpringParams { ks: 5.0, kd: 0.02 });
/// let springs: Vec<_> = sheet.springs(&ClothSprings { structural: soft, ..ClothSprings::default() }, 0).collect();
/// let limits = StrainLimits {
///     triangles: sheet.triangles().collect::<Vec<_>>(),
///     warp: Vec3::X,
///     params: StrainLimitParams { weft: Some([0.0, 1.05]), ..StrainLimitParams::default() },
/// };
/// let forces = (Gravity::EARTH, pointmass::Drag {});
/// let scene =
///     Scene { start: &start, springs: &springs, forces: &forces, constraints: &limits, substeps: 4, ..Scene::EMPTY };
/// let mut system = System::with(Heap::new(scene.size()));
/// system.start(&scene, 1)?;
/// for frame in 1..=120 {
///     system.step_to(&scene, Time::frame(frame, 60));
/// }
/// let edge = system.particles().position[22];
/// assert!(edge.y > -0.4 * 1.051, "springs alone would let it hang half as deep again: {edge}");
/// # Ok::<(), pointmass::InsufficientMemory>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct StrainLimits<T> {
    /// The triangles, at rest in the form in which they begin: particles by their place in the scene's start.
    pub triangles: T,
    /// The direction of the warp in that form; each triangle takes it in its own plane.
    #[cfg_attr(feature = "schema", schemars(with = "[f32; 3]"))]
    pub warp: Vec3,
    /// The limits.
    pub params: StrainLimitParams,
}

/// How often all triangles are gone through at the most.
const ROUNDS: u32 = 16;
/// So many rounds bring what is neither crushed nor squeezed within its limits.
const CALM: u32 = 4;
/// The share that a sub-step gives back of how far a strain was beyond its limit already.
const RECOVERY: f32 = 0.2;

/// The words of a cell, and of what it was as a sub-step began.
const KEPT: usize = size_of::<Cell>() / 4;
const SCRATCH: usize = size_of::<Past>() / 4;

impl<T: AsRef<[[u32; 3]]>> StrainLimits<T> {
    /// The first of its numbers that cannot be used, and what it has to be.
    #[must_use]
    pub fn fault(&self) -> Option<(&'static str, &'static str)> {
        let params = self.params.fault();
        let square = self.warp.dot(self.warp);
        let is_direction = square > 0.0 && square < f32::INFINITY;
        params.or_else(|| (!is_direction).then_some(("warp", "has to be a direction: finite, and not zero")))
    }

    /// The ranges of its three strains; everything, where there is no limit.
    fn ranges(&self) -> [[f32; 2]; 3] {
        const ALL: [f32; 2] = [f32::NEG_INFINITY, f32::INFINITY];
        let StrainLimitParams { warp, weft, shear, .. } = self.params;
        let shear = shear.map_or(ALL, |angle| {
            let (sine, _) = sin_cos(clamp(angle, 0.0, QUARTER));
            [-sine, sine]
        });
        [warp.unwrap_or(ALL), weft.unwrap_or(ALL), shear]
    }

    /// The rows of a triangle's corners, if all live and are somewhere.
    fn rows(&self, bodies: &Bodies<'_>, number: usize) -> Option<[usize; 3]> {
        let corners = self.triangles.as_ref().get(number)?;
        let [a, b, c] = corners.map(|corner| bodies.row_of_start(corner));
        let rows = [a?, b?, c?];
        rows.iter().all(|&row| bodies.position[row].is_finite()).then_some(rows)
    }

    /// What is kept of all triangles, behind the word that tells whose it is.
    fn cells<'m>(&self, kept: &'m mut [u32]) -> &'m mut [Cell] {
        let cells = kept.get_mut(1..).unwrap_or_default();
        let whole = cells.len() - cells.len() % KEPT;
        bytemuck::cast_slice_mut(&mut cells[..whole])
    }

    /// Notes what all triangles were as the sub-step began. None has any stress yet.
    fn begin(&self, bodies: &Bodies<'_>, cells: &mut [Cell], memory: &mut [Past]) {
        let (ranges, h) = (self.ranges(), bodies.substep.seconds());
        for (number, (cell, past)) in cells.iter_mut().zip(memory).enumerate() {
            (cell.stress, *past) = ([0.0; 3], Past::NONE);
            if let Some(rows) = self.rows(bodies, number) {
                let [x, y, z] = rows.map(|row| bodies.position[row] - bodies.velocity[row] * h);
                past.then = cell.deform([y - x, z - x]);
                // Soft limits pull for it, as springs do.
                if self.params.compliance == 0.0 {
                    let [x, y, z] = rows.map(|row| bodies.before[0][row]);
                    cell.owe([y - x, z - x], ranges);
                }
            }
        }
    }

    /// Goes through all triangles, there or back, and tells how far the worst was beyond its limits, and the kinetic energy that has come of it.
    fn sweep(&self, bodies: &mut Bodies<'_>, cells: &mut [Cell], memory: &[Past], back: bool) -> [f32; 2] {
        let (ranges, h) = (self.ranges(), bodies.substep.seconds());
        let (soft, mut worst, mut gain) = (self.params.compliance / (h * h), 0.0, 0.0);
        for at in 0..cells.len() {
            let number = if back { cells.len() - 1 - at } else { at };
            let (Some(rows), Some(past)) = (self.rows(bodies, number), memory.get(number)) else { continue };
            let mut held = Held::new(rows, &mut cells[number], past.then);
            if held.cell.area == 0.0 {
                continue;
            }
            for (kind, range) in ranges.into_iter().enumerate() {
                if range[1] < f32::INFINITY {
                    let range = held.cell.wider(kind, range, 1.0);
                    worst = max(worst, held.hold(bodies, kind, range, soft));
                }
            }
            gain += held.gain;
        }
        [worst, gain]
    }

    /// Takes back of velocities, by a share of all stresses, what these have brought of kinetic energy. What is crushed or turns far in a sub-step
    /// may be brought within its limits by places that take more than it had.
    fn calm(&self, bodies: &mut Bodies<'_>, cells: &mut [Cell], memory: &[Past], gain: f32) {
        // The gain of a share s of all is a s + b s², and its slope at the end a + 2 b.
        let mut slope = 0.0;
        self.impulses(bodies, cells, memory, &mut |bodies, row, impulse| slope += dot(bodies.velocity[row], impulse));
        let [first, second] = [2.0 * gain - slope, slope - gain];
        let share = clamp(-first / second, 0.0, 1.0);
        if second > 0.0 && share < 1.0 {
            self.impulses(bodies, cells, memory, &mut |bodies, row, impulse| {
                bodies.velocity[row] -= impulse * (bodies.inverse_mass[row] * (1.0 - share));
            });
        }
    }

    /// Visits the impulses on the corners of all triangles.
    fn impulses(
        &self,
        bodies: &mut Bodies<'_>,
        cells: &mut [Cell],
        memory: &[Past],
        visit: &mut dyn FnMut(&mut Bodies<'_>, usize, Vec3),
    ) {
        for (number, (cell, past)) in cells.iter_mut().zip(memory).enumerate() {
            if let Some(rows) = self.rows(bodies, number) {
                Held::new(rows, cell, past.then).impulses(bodies, visit);
            }
        }
    }

    /// Gives back a part of what others have taken beyond limits, by places alone, and notes how all are left.
    fn bring_back(&self, bodies: &mut Bodies<'_>, cells: &mut [Cell], memory: &[Past]) {
        let ranges = self.ranges();
        for (number, (cell, past)) in cells.iter_mut().zip(memory).enumerate() {
            let Some(rows) = self.rows(bodies, number).filter(|_| cell.owed != [0.0; 3]) else { continue };
            let held = Held::new(rows, cell, past.then);
            for (kind, range) in ranges.into_iter().enumerate() {
                if held.cell.owed[kind] != 0.0 {
                    held.bring_back(bodies, kind, held.cell.wider(kind, range, 1.0 - RECOVERY));
                }
            }
            cell.owed = cell.owed.map(|owed| owed * (1.0 - RECOVERY));
        }
        for (number, cell) in cells.iter_mut().enumerate() {
            if let Some([a, b, c]) = self.rows(bodies, number) {
                let x = &bodies.position;
                cell.leave([x[b] - x[a], x[c] - x[a]]);
            }
        }
    }

    /// Goes on in the direction of the last rounds (nonsmooth nonlinear conjugate gradients), `last` being the square of the last one's change;
    /// returns that of this one, and the kinetic energy that has come of it.
    fn accelerate(&self, bodies: &mut Bodies<'_>, cells: &mut [Cell], memory: &mut [Past], last: f32) -> [f32; 2] {
        let (mut square, mut gain) = (0.0, 0.0);
        for (cell, past) in cells.iter().zip(&*memory) {
            for (now, before) in cell.stress.iter().zip(past.stress) {
                square += (now - before) * (now - before);
            }
        }
        let share = square / last;
        // Farther than the last time: it begins anew.
        let share = if share <= 1.0 { share } else { 0.0 };
        for (number, (cell, past)) in cells.iter_mut().zip(memory).enumerate() {
            let Some(rows) = self.rows(bodies, number) else { continue };
            let mut held = Held::new(rows, cell, past.then);
            for kind in 0..3 {
                let on = share * past.direction[kind];
                past.direction[kind] = held.cell.stress[kind] - past.stress[kind] + on;
                held.press(bodies, kind, on);
            }
            past.stress = held.cell.stress;
            gain += held.gain;
        }
        [square, gain]
    }
}

impl<T: AsRef<[[u32; 3]]> + Sync> Constraint for StrainLimits<T> {
    fn demand(&self) -> Demand {
        let words = |each: usize, more| Words {
            per_row: 0,
            fixed: self.triangles.as_ref().len().saturating_mul(each).saturating_add(more),
        };
        Demand { kept: words(KEPT, 1), scratch: words(SCRATCH, 0), ..Demand::NONE }
    }

    fn is_empty(&self) -> bool {
        self.triangles.as_ref().is_empty()
    }

    /// Takes the shape at rest from where all are, at the first of all.
    fn prepare(&self, bodies: &mut Bodies<'_>, share: &mut Share<'_>) {
        if !share.claim(*b"limi", &[self.triangles.as_ref().len()]) {
            return;
        }
        let cells = self.cells(share.kept.fixed);
        for (number, cell) in cells.iter_mut().enumerate() {
            if let Some([a, b, c]) = self.rows(bodies, number) {
                let x = &bodies.position;
                *cell = Cell::at_rest([x[b] - x[a], x[c] - x[a]], self.warp);
                bodies.report.caps.degenerate += u64::from(cell.area == 0.0);
            }
        }
    }

    fn project(&self, bodies: &mut Bodies<'_>, share: &mut Share<'_>) {
        let cells = self.cells(share.kept.fixed);
        let whole = share.scratch.len() - share.scratch.len() % SCRATCH;
        let memory: &mut [Past] = bytemuck::cast_slice_mut(&mut share.scratch[..whole]);
        if !(bodies.substep.seconds() > 0.0) || memory.len() < cells.len() {
            return;
        }
        self.begin(bodies, cells, memory);
        let (mut rounds, mut worst, mut last, mut gain) = (0, f32::INFINITY, f32::INFINITY, 0.0);
        while worst > NEARLY && rounds < ROUNDS {
            if rounds > 0 {
                let [square, more] = self.accelerate(bodies, cells, memory, last);
                (last, gain) = (square, gain + more);
            }
            let [there, more] = self.sweep(bodies, cells, memory, false);
            let [back, rest] = self.sweep(bodies, cells, memory, true);
            (worst, gain) = (max(there, back), gain + more + rest);
            rounds += 1;
        }
        // What is brought within its limits in a few rounds keeps both momenta and hardly gains anything.
        if gain > 0.0 && (rounds > CALM || cells.iter().any(|cell| cell.owed != [0.0; 3])) {
            self.calm(bodies, cells, memory, gain);
        }
        self.bring_back(bodies, cells, memory);
        bodies.report.effort.solved(rounds, 0.0, worst > NEARLY);
    }

    fn settle(&self, bodies: &mut Bodies<'_>, share: &mut Share<'_>) {
        let brake = self.params.damping * bodies.substep.seconds();
        if !(brake > 0.0) {
            return;
        }
        let cells = self.cells(share.kept.fixed);
        for (number, cell) in cells.iter_mut().enumerate() {
            let Some(rows) = self.rows(bodies, number).filter(|_| cell.stress != [0.0; 3]) else { continue };
            let now = cell.deform([1, 2].map(|i| bodies.position[rows[i]] - bodies.position[rows[0]]));
            let held = Held::new(rows, cell, now);
            for kind in 0..3 {
                let Some((_, slopes, weight)) = held.line(bodies, kind) else { continue };
                let rate: f32 = rows.iter().zip(slopes).map(|(&row, slope)| dot(bodies.velocity[row], slope)).sum();
                let share = brake * held.cell.area;
                let taken = rate * (share / (1.0 + share * weight));
                if held.cell.stress[kind] == 0.0 || !taken.is_finite() {
                    continue;
                }
                for (row, slope) in rows.into_iter().zip(slopes) {
                    bodies.velocity[row] -= slope * (taken * bodies.inverse_mass[row]);
                }
            }
        }
    }
}

#[cfg(feature = "alloc")]
impl<T: AsRef<[[u32; 3]]> + Sync> Declared for StrainLimits<T> {
    fn name(&self) -> &'static str {
        "strain_limits"
    }

    fn solved(&self) -> &'static str {
        "triangle by triangle, there and back, 16 times at most"
    }

    fn fault(&self) -> Option<(&'static str, &'static str)> {
        Self::fault(self)
    }

    fn ends(&self) -> [&[u32]; 3] {
        [self.triangles.as_ref().as_flattened(), &[], &[]]
    }

    fn straight(&self) -> Option<&'static str> {
        Some("surfaces of particles")
    }

    fn compliance(&self) -> f32 {
        self.params.compliance
    }
}
