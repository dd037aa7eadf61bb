//! Whoever a scene may hold: its particles and what emitters bear, each with the extremes of its life.

use super::life::Ages;
use super::onset::Onset;
use super::part::place;
use super::words::plain;
use pointmass::scene::Model;
use pointmass::{Emitter, ForceKind, MaterialList, Particle, Varied};

/// A particle of the start, or any that an emitter may bear.
pub(crate) struct Body {
    /// The particle as it begins; of those that are born what they have in common, with the largest radius.
    pub(crate) particle: Particle,
    /// True if an emitter bears it.
    is_born: bool,
    /// Its number among the particles, or that of the emitter.
    number: usize,
    /// The least and the greatest mass of its life \[kg\].
    pub(crate) mass: [f64; 2],
    /// The least and the greatest coefficient by which drag and wind together brake it \[kg/s\].
    drag: [f64; 2],
    /// The coefficient and the mass when it is braked most.
    braked: [f64; 2],
    /// Some of that is how forces brake it as it starts, and may become more or less.
    starts: bool,
    /// Its life changes its drag or mass.
    ages: bool,
}

impl Body {
    /// All of a scene: first the particles in their order, then one for each emitter.
    pub(crate) fn all(model: &Model, onset: &Onset) -> Vec<Self> {
        let air = air(model);
        let least = |mass: Varied| f64::from(mass.mean - mass.half_width.abs());
        let start = model.particles.iter().enumerate().map(|(i, &particle)| {
            let [mass, drag, lifetime] = [particle.mass, particle.drag, particle.lifetime].map(Varied::exactly);
            let more = onset.of_particle(i, &particle, least(mass));
            Self::of(model, (air, more), (false, i), particle, [mass, drag, lifetime])
        });
        let births = model.emitters.iter().enumerate().map(|(i, emitter)| {
            let Emitter { radius, mass, drag, lifetime, fixed, material, .. } = *emitter;
            let radius = radius.mean + radius.half_width.abs();
            let particle = Particle { radius, fixed, material, ..Particle::REST };
            let more = onset.of_born(emitter, least(mass));
            Self::of(model, (air, more), (true, i), particle, [mass, drag, lifetime])
        });
        start.chain(births).collect()
    }

    fn of(
        model: &Model,
        ([own, all], more): ([f64; 2], f64),
        (is_born, number): (bool, usize),
        particle: Particle,
        [mass, drag, lifetime]: [Varied; 3],
    ) -> Self {
        let material = particle.material.and_then(|number| MaterialList::get(&model.materials, usize::from(number)));
        let life = material.map(|material| material.life).unwrap_or_default();
        let ages = Ages::of(lifetime);
        let ends = |x: Varied| [-1.0, 1.0].map(|side| f64::from(x.mean) + side * f64::from(x.half_width.abs()));
        let (masses, drags) = (ends(mass), ends(drag));
        let brake = |factor: f64| drags.map(|drag| own * drag * factor + all);
        let [loose, tight] = ages.range(life.drag).map(brake);
        let factors = ages.range(life.mass);
        Self {
            particle,
            is_born,
            number,
            mass: [masses[0] * factors[0], masses[1] * factors[1]],
            drag: [loose[0].min(tight[0]), loose[1].max(tight[1]) + more],
            braked: ages.most_braked(&life, |factor| brake(factor)[1] + more, masses[0]),
            starts: more > 0.0,
            ages: life.drag.is_some() || life.mass.is_some(),
        }
    }

    pub(crate) fn is_born(&self) -> bool {
        self.is_born
    }

    pub(crate) fn is_free(&self) -> bool {
        !self.particle.fixed
    }

    /// The rate at which it is braked at the most \[1/s\].
    pub(crate) fn rate(&self) -> f64 {
        self.braked[0] / self.braked[1]
    }

    /// Its place in the file.
    pub(crate) fn place(&self, model: &Model) -> String {
        if self.is_born { format!("emitters[{}]", self.number) } else { place(model, 0, self.number) }
    }

    /// The drag and the mass when it is braked most, in words.
    pub(crate) fn brake(&self) -> String {
        let [drag, mass] = self.braked.map(plain);
        let now = if self.starts { " as it starts" } else { "" };
        self.at_some_age(format!("of drag {drag} kg/s{now} and mass {mass} kg"))
    }

    /// What is odd about a drag that pushes, if it may.
    pub(crate) fn push(&self, model: &Model) -> Option<String> {
        let [least, _] = self.drag;
        (self.is_free() && least < 0.0).then(|| {
            let place = self.place(model);
            format!("{place} has a drag of {} kg/s: below zero it adds energy, take one of zero or above", plain(least))
        })
    }

    /// Its least weight in words, unless it is fixed.
    pub(crate) fn weight(&self) -> String {
        if self.is_free() { self.at_some_age(format!("{} kg", plain(self.mass[0]))) } else { "fixed".into() }
    }

    fn at_some_age(&self, text: String) -> String {
        if self.ages { text + " over its life" } else { text }
    }

    /// It as a particle of its least mass and of its least (0) or greatest (1) drag, though never braked more than it is.
    fn lightest(&self, drag: usize) -> Particle {
        let drag = self.drag[drag].min(self.rate() * self.mass[0]);
        Particle { mass: self.mass[0] as f32, drag: drag as f32, ..self.particle }
    }
}

/// The same particles at their lightest, most and least braked, each with what brakes it for its drag; once, if that is the
/// same. Whatever is heavier stands longer steps.
pub(crate) fn extremes(bodies: &[Body]) -> Vec<Vec<Particle>> {
    let mut extremes: Vec<Vec<_>> = [1, 0].map(|drag| bodies.iter().map(|body| body.lightest(drag)).collect()).into();
    extremes.dedup();
    extremes
}

/// Air's effect on a particle: so many times its own coefficient of drag, and a coefficient for all \[kg/s\].
fn air(model: &Model) -> [f64; 2] {
    model.forces.0.iter().fold([0.0, 0.0], |[own, all], force| match force {
        ForceKind::Drag(_) => [own + 1.0, all],
        ForceKind::Wind(wind) => wind.coefficient.map_or([own + 1.0, all], |k| [own, all + f64::from(k)]),
        _ => [own, all],
    })
}
