//! Constraints: how stiff each is, how it is solved, how far its own weight stretches it, and what sub-steps buy.

use super::part::place;
use super::statics::Hanging;
use super::words::{plain, time};
use crate::report::words::short;
use crate::stall::gravity;
use pointmass::constrain::{Hinge, RigidBox, Shell, TiedRope};
use pointmass::scene::Model;
use pointmass::shape::Aabb;
use pointmass::stability::Limit;
use pointmass::{ConstraintKind, Rope, Strands, Vec3};
use serde::Serialize;
use std::collections::BTreeSet;

/// The share by which a constraint may be off.
pub(crate) const FAULT: f64 = 0.01;

/// By how much a pile of ten boxes sinks where it does so most, for each m/s² of gravity and s² of a sub-step \[m\]: measured.
const SINKS: f64 = 4.13;
/// The turn of a box in a sub-step from which on it may be met too late \[rad\].
const TURN: f64 = 0.35;

/// Constraints of one kind that follow each other in a scene, or a sheet; with the worst of each figure.
#[derive(Debug, Serialize)]
pub(crate) struct Hold {
    /// Where the first stands in the file.
    pub(crate) place: String,
    pub(crate) kind: Kind,
    /// Their number, and that of their particles.
    pub(crate) count: usize,
    pub(crate) particles: usize,
    /// The stiffness of the stiffest \[N/m\]; none: rigid.
    pub(crate) stiffness: Option<f64>,
    /// The rate of the fastest oscillation, were it alone \[1/s\]; none where it is rigid.
    pub(crate) rate: Option<f64>,
    /// The share by which its own weight stretches it, were it hung from what is fixed: by its stiffness alone.
    pub(crate) gives: f64,
    /// The share by which it is off beyond that, for each s² of a sub-step \[1/s²\], as long as that does not change how it hangs.
    pub(crate) owes: f64,
    /// True if both are estimates, since what hangs did not come to rest in time.
    pub(crate) estimated: bool,
    /// Half the least side of boxes \[m\].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) half: Option<f64>,
}

/// Kinds of constraints.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub(crate) enum Kind {
    Distance,
    Rope,
    Cluster,
    Attach,
    Tie,
    Shell,
    Strands,
    StrainLimits,
    Boxes,
}

impl Kind {
    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::Distance => "distance",
            Self::Rope => "rope",
            Self::Cluster => "cluster",
            Self::Attach => "attach",
            Self::Tie => "tie",
            Self::Shell => "shell",
            Self::Strands => "strands",
            Self::StrainLimits => "strain limits",
            Self::Boxes => "boxes",
        }
    }
}

impl Hold {
    /// All of a scene, as its particles begin.
    pub(crate) fn all(model: &Model) -> Vec<Self> {
        let hanging = Hanging::of(model);
        let owed = hanging.owed(model);
        let kinds = &model.constraints.0;
        let is_body = |of: &ConstraintKind| matches!(kind(of), Kind::Shell | Kind::Strands);
        let alike = |a: &ConstraintKind, b: &ConstraintKind| kind(a) == kind(b) && !is_body(a);
        let mut first = 0;
        let mut all: Vec<_> = kinds
            .chunk_by(alike)
            .map(|group| {
                let of = first..first + group.len();
                let links = hanging.links.iter().zip(&hanging.pull).zip(&owed);
                let links = links.filter(|((link, _), _)| link.of.is_some_and(|number| of.contains(&number)));
                let shares = links
                    .filter(|((link, _), _)| link.length > 0.0)
                    .map(|((link, pull), owed)| [link.compliance * pull / link.length, owed / link.length]);
                let [gives, owes] = shares.fold([0.0; 2], |[a, b], [x, y]| [f64::max(a, x), f64::max(b, y)]);
                let estimated = !hanging.is_at_rest && owes + gives > 0.0;
                let of_group = Self::of(model, group, first);
                let hold = Self { gives: of_group.gives.max(gives), owes, estimated, ..of_group };
                first = of.end;
                hold
            })
            .collect();
        all.extend(model.constraints.1.boxes.chunk_by(|a, b| a.half == b.half).map(|group| Self::boxes(model, group)));
        all
    }

    /// Constraints of one kind, without what links are known for.
    fn of(model: &Model, group: &[ConstraintKind], first: usize) -> Self {
        let ends: BTreeSet<u32> = group.iter().flat_map(ConstraintKind::ends).copied().collect();
        let rates = group.iter().map(|constraint| rate(model, constraint));
        let stiffest = |a: Option<[f64; 2]>, b: Option<[f64; 2]>| Some([a?[0].max(b?[0]), a?[1].max(b?[1])]);
        let stiffest = rates.reduce(stiffest).flatten();
        let this = Self {
            place: format!("constraints[{first}]"),
            kind: kind(&group[0]),
            count: group.len(),
            particles: ends.len(),
            stiffness: stiffest.map(|[stiffness, _]| stiffness),
            rate: stiffest.map(|[_, rate]| rate),
            gives: 0.0,
            owes: 0.0,
            estimated: false,
            half: None,
        };
        match &group[0] {
            ConstraintKind::Shell(shell) => {
                let at = shell.particles.first().map(|&first| place(model, 0, first as usize));
                let place = at.filter(|at| at.starts_with("cloths")).unwrap_or(this.place);
                Self { place, gives: hung(model, shell), ..this }
            }
            ConstraintKind::StrainLimits(limits) => {
                let at = limits.triangles.first().map(|&[first, ..]| place(model, 0, first as usize));
                let place = at.filter(|at| at.starts_with("cloths")).unwrap_or(this.place);
                Self { place, ..this }
            }
            ConstraintKind::Strands(strands) => {
                let at = strands.particles.first().map(|&first| place(model, 0, first as usize));
                let place = at.filter(|at| at.starts_with("strands")).unwrap_or(this.place);
                Self { place, count: each(strands).count(), gives: weighed(model, strands), ..this }
            }
            // Ropes, and what is tied of bodies, stand there in the file.
            ConstraintKind::Rope(Rope { particles, .. })
            | ConstraintKind::TiedRope(TiedRope { rope: Rope { particles, .. }, .. }) => {
                let at = particles.first().map(|&first| place(model, 0, first as usize));
                Self { place: at.filter(|at| at.starts_with("ropes")).unwrap_or(this.place), ..this }
            }
            ConstraintKind::Cluster(cluster) => {
                let at = cluster.particles.first().map(|&first| place(model, 0, first as usize));
                Self { place: at.filter(|at| at.starts_with("soft")).unwrap_or(this.place), ..this }
            }
            ConstraintKind::Tie(tie) => {
                let at = place(model, 0, tie.particle as usize);
                Self { place: if at.starts_with("particles") { this.place } else { at }, ..this }
            }
            _ => this,
        }
    }

    /// Boxes of one size.
    fn boxes(model: &Model, group: &[RigidBox]) -> Self {
        let half = f64::from(group[0].half.min_element());
        let weight = f64::from(gravity(model).length());
        Self {
            place: place(model, 0, group[0].first as usize),
            kind: Kind::Boxes,
            count: group.len(),
            particles: group.iter().map(|of| of.count as usize).sum(),
            stiffness: None,
            rate: None,
            gives: 0.0,
            owes: SINKS * weight / (2.0 * half),
            estimated: false,
            half: Some(half),
        }
    }

    /// The share by which it is off in sub-steps of `h` \[s\], beyond what it gives way.
    pub(crate) fn fault(&self, h: f64) -> f64 {
        self.owes * h * h
    }

    /// The longest sub-step that leaves it off by one per cent at the most.
    pub(crate) fn largest_step(&self) -> Limit {
        if self.owes > 0.0 { Limit::Step((FAULT / self.owes).sqrt()) } else { Limit::Unconditional }
    }

    /// Its name: the first of it, and how many follow.
    pub(crate) fn name(&self) -> String {
        match (self.kind, self.count) {
            (Kind::Boxes | Kind::Strands, _) | (_, 1) => self.place.clone(),
            (_, count) => format!("{} and {} more", self.place, count - 1),
        }
    }

    /// The words for what it does in sub-steps of `h` \[s\].
    pub(crate) fn told(&self, h: f64) -> String {
        let about = if self.estimated { "about " } else { "" };
        let percent = |share: f64| format!("{about}{} %", short(100.0 * share));
        let fades = || match self.rate {
            Some(rate) if h * rate > 1.0 => format!("; swings below {} fade", time(std::f64::consts::TAU * h)),
            _ => String::new(),
        };
        match self.kind {
            Kind::Distance => format!("one after the other: {} too long at rest{}", percent(self.fault(h)), fades()),
            Kind::Rope => format!("link by link, directly: exact{}", fades()),
            Kind::Cluster => format!("as one: exact at rest{}", fades()),
            Kind::Attach => "go where the script says".into(),
            Kind::Tie => format!("one after the other, to places on other bodies{}", fades()),
            Kind::Strands => format!("each as one, directly{}", fades()),
            Kind::StrainLimits => format!("triangle by triangle, there and back, 16 times at most{}", fades()),
            Kind::Shell => format!("as one, {} iterations at most{}", self.iterations(h), fades()),
            Kind::Boxes => {
                let half = self.half.unwrap_or(0.0);
                let (sinks, speed, turn) = (percent(self.fault(h)), plain(half / h), plain(TURN / h));
                format!(
                    "a pile of ten sinks by {sinks} of a box; {speed} m/s go half through, {turn} rad/s are too fast"
                )
            }
        }
    }

    /// The number of iterations of a shell's conjugate gradients that take the error to 1e-4 in sub-steps of `h` \[s\]: ½ √κ ln(2/ε) at the
    /// most (Shewchuk, "An Introduction to the Conjugate Gradient Method Without the Agonizing Pain", 1994, section 9), with κ = 1 + h² ω².
    pub(crate) fn iterations(&self, h: f64) -> u64 {
        let rate = h * self.rate.unwrap_or(0.0);
        (0.5 * rate.hypot(1.0) * 2e4f64.ln()).ceil() as u64
    }

    /// The warning about sub-steps of `h` \[s\] that leave it too far off, or none.
    pub(crate) fn warning(&self, h: f64) -> Option<String> {
        let Limit::Step(enough) = self.largest_step() else { return None };
        let (name, off, now, enough_for) = (self.name(), short(100.0 * self.fault(h)), time(h), time(enough));
        (h > enough * (1.0 + 1e-6)).then(|| match self.kind {
            Kind::Boxes => {
                format!("in sub-steps of {now} a pile of ten of {name} sinks by {off} % of a box; {enough_for} leave 1 %")
            }
            _ => format!(
                "in sub-steps of {now} {name} hang up to {off} % longer than they are, since each is met once; {enough_for} leave \
                 1 %, and a rope does in any, unless a run says that it was cut short"
            ),
        })
    }
}

fn kind(constraint: &ConstraintKind) -> Kind {
    match constraint {
        ConstraintKind::Distance(_) => Kind::Distance,
        ConstraintKind::Rope(_) | ConstraintKind::TiedRope(_) => Kind::Rope,
        ConstraintKind::Cluster(_) => Kind::Cluster,
        ConstraintKind::Attach(_) => Kind::Attach,
        ConstraintKind::Shell(_) => Kind::Shell,
        ConstraintKind::Strands(_) => Kind::Strands,
        ConstraintKind::StrainLimits(_) => Kind::StrainLimits,
        ConstraintKind::Tie(_) => Kind::Tie,
    }
}

/// The stiffness of a constraint \[N/m\] and the rate of its fastest oscillation \[1/s\]; none where it is rigid.
fn rate(model: &Model, constraint: &ConstraintKind) -> Option<[f64; 2]> {
    let inverse = |&end: &u32| match model.particles[end as usize] {
        particle if particle.fixed => 0.0,
        particle => 1.0 / f64::from(particle.mass),
    };
    let lightest = || constraint.ends().map(inverse).fold(0.0, f64::max);
    let (compliance, weight) = match constraint {
        ConstraintKind::Distance(distance) => (distance.compliance, distance.ends.iter().map(inverse).sum()),
        // Beside a link that is stretched those beside it are pressed.
        ConstraintKind::Rope(rope) | ConstraintKind::TiedRope(TiedRope { rope, .. }) => {
            (rope.compliance, 4.0 * lightest())
        }
        ConstraintKind::Cluster(cluster) => {
            let masses = cluster.particles.iter().map(|&i| f64::from(model.particles[i as usize].mass));
            (cluster.compliance, 1.0 / masses.sum::<f64>())
        }
        ConstraintKind::Attach(_) => (0.0, 0.0),
        // The place gives way less than the lightest of what it is on.
        ConstraintKind::Tie(tie) => (tie.compliance, constraint.ends().map(inverse).sum()),
        ConstraintKind::StrainLimits(limits) => (limits.params.compliance, 4.0 * lightest()),
        ConstraintKind::Strands(strands) => {
            let at = |i: u32| model.particles[i as usize].position;
            let edges =
                each(strands).flat_map(|strand| strand.windows(2).map(|ends| at(ends[0]).distance(at(ends[1]))));
            let shortest = edges.filter(|length| *length > 0.0).fold(f32::INFINITY, f32::min);
            (strands.params.stretch.map_or(0.0, |stretch| shortest / stretch), 4.0 * lightest())
        }
        ConstraintKind::Shell(shell) => {
            let stretch = f64::from(shell.params.stretch[0].max(shell.params.stretch[1]));
            return Some([stretch, 2.0 * (stretch * lightest()).sqrt()]);
        }
    };
    let stiffness = 1.0 / f64::from(compliance);
    (compliance > 0.0).then(|| [stiffness, (stiffness * weight).sqrt()])
}

/// The points of each strand.
fn each(strands: &Strands<Vec<u32>, Vec<u32>>) -> impl Iterator<Item = &[u32]> {
    let mut left = &strands.particles[..];
    let mut counts = strands.points.iter().chain(std::iter::repeat(strands.points.last().unwrap_or(&1)));
    std::iter::from_fn(move || {
        let count = left.len().min((*counts.next()?).max(1) as usize);
        let (strand, rest) = left.split_at(count);
        left = rest;
        (count > 0).then_some(strand)
    })
}

/// The strain at the root of the heaviest strand that hangs from there: weight / stretch.
fn weighed(model: &Model, strands: &Strands<Vec<u32>, Vec<u32>>) -> f64 {
    let particle = |&i: &u32| model.particles[i as usize];
    let mass = |strand: &[u32]| {
        strand
            .iter()
            .map(particle)
            .filter(|particle| !particle.fixed)
            .map(|particle| f64::from(particle.mass))
            .sum::<f64>()
    };
    let heaviest = each(strands).map(mass).fold(0.0, f64::max);
    let strain = strands
        .params
        .stretch
        .map_or(0.0, |stretch| heaviest * f64::from(gravity(model).length()) / f64::from(stretch));
    if strain.is_finite() { strain } else { 0.0 }
}

/// The strain at the top of a sheet that hangs from the box around what is fixed of it: density × g × length / stretch. One that
/// nothing holds hangs by its longest extent.
fn hung(model: &Model, shell: &Shell<Vec<u32>, Vec<[u32; 3]>, Vec<Hinge>>) -> f64 {
    let at = |i: u32| model.particles[shell.particles[i as usize] as usize];
    let numbers = || 0..shell.particles.len() as u32;
    let area = |&[a, b, c]: &[u32; 3]| {
        let [a, b, c] = [a, b, c].map(|corner| at(corner).position);
        f64::from(0.5 * (b - a).cross(c - a).length())
    };
    let area: f64 = shell.triangles.iter().map(area).sum();
    let mass: f64 = numbers().map(|i| f64::from(at(i).mass)).sum();
    let places = || numbers().map(|i| at(i).position);
    let held = Aabb::around(numbers().map(at).filter(|particle| particle.fixed).map(|particle| particle.position));
    let from = |x: Vec3| x.distance(x.max(held.min).min(held.max));
    let length = if numbers().any(|i| at(i).fixed) {
        places().map(from).fold(0.0, f32::max)
    } else {
        let Aabb { min, max } = Aabb::around(places());
        (max - min).max_element()
    };
    let stretch = f64::from(shell.params.stretch[0].min(shell.params.stretch[1]));
    let strain = mass / area * f64::from(gravity(model).length()) * f64::from(length) / stretch;
    if strain.is_finite() { strain } else { 0.0 }
}
