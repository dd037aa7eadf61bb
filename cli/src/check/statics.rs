//! The pull in links that hang at rest under their own weight.
//!
//! Dynamic relaxation with kinetic damping: particles move by the forces on them, with masses that suit the stiffness of their links,
//! and all are stopped whenever their kinetic energy begins to fall (Cundall 1976; Barnes, "Form Finding and Analysis of Tension
//! Structures by Dynamic Relaxation", Int. J. Space Structures 14, 1999).

use super::net::wide;
use crate::stall::gravity;
use nalgebra::Vector3;
use pointmass::ConstraintKind;
use pointmass::scene::Model;
use std::collections::{BTreeMap, BTreeSet};

/// The share by which a rigid link may be longer here, pulled by all the weight that hangs together.
const SOFT: f64 = 1e-3;
/// The share of that weight which may be out of balance in the end.
const BALANCED: f64 = 1e-4;
/// Pulls of links that may be worked out, and the rounds in which those of a group of links are: a chain takes some for each of its links.
const MOST: usize = 20_000_000;
const ROUNDS: [usize; 2] = [4_000, 200];

/// A link between two particles of the start.
pub(super) struct Link {
    pub(super) ends: [usize; 2],
    /// Its length at rest \[m\].
    pub(super) length: f64,
    /// α \[m/N\].
    pub(super) compliance: f64,
    /// Its stiffness here: what is rigid gives way a little \[N/m\].
    stiffness: f64,
    /// It only pulls.
    tether: bool,
    /// The constraint that it is a part of; none of a spring.
    pub(super) of: Option<usize>,
}

/// A particle that links hold.
struct Node {
    place: Vector3<f64>,
    is_held: bool,
    load: Vector3<f64>,
    /// The stiffness of all its links \[N/m\], its mass here.
    stiffness: f64,
    velocity: Vector3<f64>,
    force: Vector3<f64>,
}

/// Links that hang at rest.
pub(super) struct Hanging {
    pub(super) links: Vec<Link>,
    /// The pull in each \[N\], below zero where it is pressed; zero of what falls freely.
    pub(super) pull: Vec<f64>,
    /// The direction of each, from its first end to its second.
    along: Vec<Vector3<f64>>,
    /// True if all came to rest.
    pub(super) is_at_rest: bool,
}

impl Hanging {
    /// The links of constraints, and springs, hung from all that is fixed or led by a script.
    pub(super) fn of(model: &Model) -> Self {
        let mut links = links(model);
        let mut nodes = nodes(model, &links);
        let (mut is_at_rest, mut budget) = (true, MOST);
        for group in together(&nodes, &links) {
            let ends = group.iter().flat_map(|&i| links[i].ends).filter(|&end| !nodes[end].is_held);
            let own: Vec<usize> = ends.collect::<BTreeSet<_>>().into_iter().collect();
            let weight: f64 = own.iter().map(|&node| nodes[node].load.norm()).sum();
            let hangs = group.iter().any(|&i| links[i].ends.iter().any(|&end| nodes[end].is_held));
            if !(hangs && weight > 0.0) {
                own.iter().for_each(|&node| nodes[node].load = Vector3::zeros());
                continue;
            }
            for &i in &group {
                let link = &mut links[i];
                link.stiffness = 1.0 / link.compliance.max(SOFT * link.length.max(1e-6) / weight);
                link.ends.iter().for_each(|&end| nodes[end].stiffness += link.stiffness);
            }
            let group: Vec<&Link> = group.iter().map(|&i| &links[i]).collect();
            is_at_rest &= relax(&mut nodes, &own, &group, weight, &mut budget);
        }
        let (pull, along) = links.iter().map(|link| link.pull(&nodes)).unzip();
        Self { links, pull, along, is_at_rest }
    }

    /// By how much each link ends longer than its compliance lets it, for each s² of a sub-step \[m/s²\]. Links of constraints that
    /// come later in the list move its ends once more, each by h² / m times its pull, and nobody asks this one again.
    pub(super) fn owed(&self, model: &Model) -> Vec<f64> {
        let mut at: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
        for (i, link) in self.links.iter().enumerate().filter(|(_, link)| link.of.is_some()) {
            link.ends.iter().for_each(|&end| at.entry(end).or_default().push(i));
        }
        let away = |i: usize, end: usize| if self.links[i].ends[0] == end { self.along[i] } else { -self.along[i] };
        let of = |(i, link): (usize, &Link)| {
            let ends = link.ends.iter().filter(|&&end| link.of.is_some() && !model.particles[end].fixed);
            let owed = ends.flat_map(|&end| {
                let later = at[&end].iter().filter(move |&&other| self.links[other].of > link.of);
                let mass = f64::from(model.particles[end].mass);
                later.map(move |&other| -self.pull[other] * away(i, end).dot(&away(other, end)) / mass)
            });
            owed.sum()
        };
        self.links.iter().enumerate().map(of).collect()
    }
}

impl Link {
    /// Its pull and its direction.
    fn pull(&self, nodes: &[Node]) -> (f64, Vector3<f64>) {
        let way = nodes[self.ends[1]].place - nodes[self.ends[0]].place;
        let distance = way.norm();
        let pull = self.stiffness * (distance - self.length);
        let along = if distance > 0.0 { way / distance } else { Vector3::zeros() };
        (if self.tether { pull.max(0.0) } else { pull }, along)
    }
}

/// All links, those of constraints in their order.
fn links(model: &Model) -> Vec<Link> {
    let mut all = Vec::new();
    for (of, kind) in model.constraints.0.iter().enumerate() {
        all.extend(kind.links().zip(kind.lengths()).map(|(ends, length)| Link {
            ends: ends.map(|end| end as usize),
            length: f64::from(length),
            compliance: f64::from(kind.compliance()),
            stiffness: 0.0,
            tether: kind.is_tether(),
            of: Some(of),
        }));
    }
    // Where nothing else hangs, nobody asks how springs do.
    if !all.is_empty() {
        let springs = model.springs.iter().filter(|spring| spring.ks > 0.0);
        all.extend(springs.map(|spring| Link {
            ends: spring.ends.map(|end| end as usize),
            length: f64::from(spring.rest_length),
            compliance: 1.0 / f64::from(spring.ks),
            stiffness: 0.0,
            tether: false,
            of: None,
        }));
    }
    all
}

/// All particles, with the weight of those that links hold. Bodies leave the weight of the rest of them to these.
fn nodes(model: &Model, links: &[Link]) -> Vec<Node> {
    let linked: BTreeSet<usize> = links.iter().flat_map(|link| link.ends).collect();
    let mass = |i: usize| f64::from(model.particles[i].mass);
    let mut load = vec![0.0; if links.is_empty() { 0 } else { model.particles.len() }];
    linked.iter().for_each(|&i| load[i] = mass(i));
    for body in model.constraints.0.iter().filter(|kind| kind.is_body()) {
        let ends = body.ends().map(|&i| i as usize);
        let (holding, rest): (Vec<usize>, Vec<_>) = ends.partition(|i| linked.contains(i));
        let share = rest.into_iter().map(mass).sum::<f64>() / holding.len().max(1) as f64;
        holding.iter().for_each(|&i| load[i] += share);
    }
    let leading = model.constraints.0.iter().filter(|kind| kind.leads());
    let led: BTreeSet<u32> = leading.flat_map(ConstraintKind::ends).copied().collect();
    let of = |(i, mass): (usize, f64)| Node {
        place: wide(model.particles[i].position),
        is_held: model.particles[i].fixed || led.contains(&(i as u32)),
        load: wide(gravity(model)) * mass,
        stiffness: 0.0,
        velocity: Vector3::zeros(),
        force: Vector3::zeros(),
    };
    load.into_iter().enumerate().map(of).collect()
}

/// The links in groups that nothing but what is held joins to others.
fn together(nodes: &[Node], links: &[Link]) -> Vec<Vec<usize>> {
    /// The first of all that a node is joined to, as far as is known; ways to it are halved.
    fn first(known: &mut [usize], mut node: usize) -> usize {
        while known[node] != node {
            known[node] = known[known[node]];
            node = known[node];
        }
        node
    }
    let mut known: Vec<usize> = (0..nodes.len()).collect();
    for link in links.iter().filter(|link| link.ends.iter().all(|&end| !nodes[end].is_held)) {
        let [a, b] = link.ends.map(|end| first(&mut known, end));
        known[a.max(b)] = a.min(b);
    }
    let mut groups: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
    for (i, link) in links.iter().enumerate() {
        let free = link.ends.into_iter().find(|&end| !nodes[end].is_held);
        free.into_iter().for_each(|end| groups.entry(first(&mut known, end)).or_default().push(i));
    }
    groups.into_values().collect()
}

/// Brings the particles of a group to rest. False, if the budget of pulls ran out before.
fn relax(nodes: &mut [Node], own: &[usize], links: &[&Link], weight: f64, budget: &mut usize) -> bool {
    let mut energy = 0.0;
    for _ in 0..ROUNDS[0] + ROUNDS[1] * links.len() {
        if *budget <= links.len() {
            break;
        }
        *budget -= links.len();
        own.iter().for_each(|&i| nodes[i].force = nodes[i].load);
        for link in links {
            let (pull, along) = link.pull(nodes);
            nodes[link.ends[0]].force += along * pull;
            nodes[link.ends[1]].force -= along * pull;
        }
        let before = std::mem::take(&mut energy);
        let mut uneven = 0.0f64;
        for &i in own {
            let node = &mut nodes[i];
            uneven = uneven.max(node.force.norm());
            node.velocity += node.force / node.stiffness;
            energy += node.stiffness * node.velocity.norm_squared();
        }
        if uneven < BALANCED * weight {
            return true;
        }
        for &i in own {
            let node = &mut nodes[i];
            node.velocity *= if energy < before { 0.0 } else { 1.0 };
            node.place += node.velocity;
        }
        energy = if energy < before { 0.0 } else { energy };
    }
    false
}
