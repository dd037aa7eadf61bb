//! Bounds that goals put on the step: springs that hold particles where they are led.

use super::body::{Body, extremes};
use super::part::Part;
use super::words::time;
use pointmass::force::Goal;
use pointmass::scene::Model;
use pointmass::stability::{Limit, Mode, Poses};
use pointmass::{Method, Particle, Spring};

/// The goals of a scene that lead somebody.
pub(crate) struct Goals {
    /// The one that holds the most stiffly.
    pub(crate) part: Part,
    /// Particles that may be led, and the springs among them, at each of the moments when goals may hold the most stiffly.
    poses: Vec<Poses>,
}

impl Goals {
    /// None where nobody is led.
    pub(crate) fn of(model: &Model, bodies: &[Body]) -> Option<Self> {
        let goals = &model.forces.3;
        let somebody = |goal: &Goal<_>| bodies.iter().any(|body| body.is_free() && leads(goal, &body.particle));
        let leading = goals.iter().enumerate().filter(|(_, goal)| somebody(goal));
        let (i, goal) = leading.min_by(|(_, a), (_, b)| a.settle.total_cmp(&b.settle))?;
        let about = format!("that settles in {}", time(f64::from(goal.settle)));
        let part = Part { place: format!("goals[{i}]"), spring: None, about, mode: pull(f64::from(goal.settle)) };
        // A goal pulls the more stiffly the later, until it lets go.
        let mut ends: Vec<_> = goals.iter().map(|goal| goal.release.unwrap_or(f32::INFINITY)).collect();
        ends.sort_by(f32::total_cmp);
        ends.dedup();
        let corners = extremes(bodies);
        let poses = ends.iter().flat_map(|&end| corners.iter().map(move |corner| held(model, corner, end)));
        Some(Self { part, poses: poses.collect() })
    }

    /// The largest step in which nobody who is led swings ever wider, in whatever pose.
    pub(crate) fn largest_step(&self, method: Method) -> Limit {
        self.poses.iter().fold(Limit::Unconditional, |least, poses| least.and(poses.largest_step(method)))
    }
}

fn leads<M>(goal: &Goal<M>, particle: &Particle) -> bool {
    goal.material.is_none_or(|material| particle.material == Some(material))
}

/// The pull of a goal while so much time is left \[s\].
fn pull(left: f64) -> Mode {
    Mode { omega2: 6.0 / (left * left), damping: 4.0 / left }
}

/// The pull of a goal just before `end` \[s\], if it has not let go.
fn last_pull<M>(goal: &Goal<M>, end: f32) -> Option<Mode> {
    let settle = f64::from(goal.settle);
    let left = f64::from(goal.arrive) - f64::from(end) - 4.0 * settle;
    (goal.start < end && goal.release.is_none_or(|release| end <= release)).then(|| pull(left.max(settle)))
}

/// All of them as they are held just before `end` \[s\]: each by a spring to what is fixed, and braked as if by drag.
fn held(model: &Model, particles: &[Particle], end: f32) -> Poses {
    let pulls: Vec<_> = model.forces.3.iter().filter_map(|goal| Some((goal, last_pull(goal, end)?))).collect();
    let (mut particles, mut springs) = (particles.to_vec(), model.springs.clone());
    let place = particles.len() as u32;
    for (i, particle) in (0..).zip(&mut particles) {
        let pulls = pulls.iter().filter(|(goal, _)| leads(goal, particle)).map(|(_, pull)| pull);
        let [omega2, damping] = pulls.fold([0.0, 0.0], |[k, c], pull| [k + pull.omega2, c + pull.damping]);
        let mass = f64::from(particle.mass);
        particle.drag += (damping * mass) as f32;
        springs.push(Spring::new([i, place], 0.0, (omega2 * mass) as f32));
    }
    particles.push(Particle { fixed: true, ..Particle::REST });
    Poses::of(&particles, &springs, true)
}
