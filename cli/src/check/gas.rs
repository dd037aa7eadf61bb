//! Bounds that gas in closed meshes puts on the step.

use super::body::Body;
use super::net::wide;
use super::part::{Part, place};
use super::words::{plain, time};
use pointmass::force::Pressure;
use pointmass::scene::Model;
use pointmass::stability::{Limit, Mode};
use pointmass::{ForceKind, Method};

/// The share of its mesh's radius by which gas may push particles in a step: beyond it triangles turn over before their material holds them.
const SHARE: f64 = 0.25;

/// The gas of a scene that allows the shortest steps.
pub(crate) struct Gas {
    pub(crate) part: Part,
    /// The longest step in which it pushes particles by so little \[s\].
    push: f64,
}

impl Gas {
    /// None where there is none, or nobody that it moves.
    pub(crate) fn of(model: &Model, bodies: &[Body]) -> Option<Self> {
        let gas = |force: &ForceKind| {
            if let ForceKind::Pressure(gas) = force { Self::in_mesh(gas, model, bodies) } else { None }
        };
        model.forces.0.iter().filter_map(gas).min_by(|a, b| a.shortest().total_cmp(&b.shortest()))
    }

    /// That of a mesh as it starts: how the volume V changes with each particle's place, A, gives the stiffness n R T / V² A Aᵀ.
    fn in_mesh(gas: &Pressure<Vec<[u32; 3]>>, model: &Model, bodies: &[Body]) -> Option<Self> {
        let origin = wide(model.particles.get(*gas.triangles.first()?.first()? as usize)?.position);
        let mut slopes = vec![nalgebra::Vector3::zeros(); model.particles.len()];
        let (mut volume, mut surface) = (0.0, 0.0);
        for corners in &gas.triangles {
            let [a, b, c] = corners.map(|corner| wide(model.particles[corner as usize].position) - origin);
            let slope = (b - a).cross(&(c - a)) / 6.0;
            volume += slope.dot(&a);
            surface += 3.0 * slope.norm();
            corners.iter().for_each(|&corner| slopes[corner as usize] += slope);
        }
        let free = || slopes.iter().zip(bodies).filter(|(_, body)| body.is_free());
        let answers: f64 = free().map(|(slope, body)| slope.norm_squared() / body.mass[0]).sum();
        let lightest = free().map(|(slope, body)| slope.norm() / body.mass[0]).fold(0.0, f64::max);
        let [amount, outside] = [gas.amount, gas.outside].map(f64::from);
        let pressure = (amount / volume - outside).abs();
        let push = (SHARE * 3.0 * volume / surface / (pressure * lightest)).sqrt();
        let mode = Mode { omega2: amount.max(0.0) / (volume * volume) * answers, damping: 0.0 };
        let about = format!(
            "whose gas of {} Pa beyond those outside moves particles by a quarter of its radius within {}",
            plain(pressure),
            time(push)
        );
        let part = Part { place: place(model, 0, gas.triangles[0][0] as usize), spring: None, about, mode };
        (push > 0.0 && push < f64::INFINITY).then_some(Self { part, push })
    }

    /// The step in which it pushes so little, or that explicit methods stand.
    fn shortest(&self) -> f64 {
        self.push.min(2.0 / self.part.mode.omega2.sqrt())
    }

    /// The largest step. What the mesh is made of damps what explicit methods would make grow in any.
    pub(crate) fn largest_step(&self, method: Method) -> Limit {
        let stands = match self.part.mode.largest_step(method) {
            Limit::Never => self.part.mode.largest_step(Method::Symplectic),
            stands => stands,
        };
        stands.and(Limit::Step(self.push))
    }
}
