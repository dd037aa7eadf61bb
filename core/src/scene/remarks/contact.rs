//! Remarks on balls: how they bounce off each other where contacts by force do not ask them, and on what cannot hold them.

use crate::force::Penalty;
use crate::math::{angle, exp, length, sqrt};
use crate::particles::Particle;
use crate::scene::{Cloth, Response, SceneFile};
use alloc::format;
use alloc::string::String;

/// The difference of two shares of a speed that are given back, up to which there is no remark.
const ALIKE: f32 = 0.05;
/// How much wider than at rest the meshes of a sheet that bears a ball may be, as measured.
const WIDER: f32 = 1.4;

impl SceneFile {
    /// A remark on contacts by force that do not bounce as the scene's balls and materials say: the damping alone tells how.
    ///
    /// Where there is scenery, that takes the same elasticity: then it is one only where no damping has been said.
    #[must_use]
    pub fn unasked_elasticity(&self) -> Option<String> {
        let Some(Response::Force(Penalty { damping, .. })) = self.contacts else { return None };
        if damping != 0.0 && !self.scenery.is_empty() {
            return None;
        }
        let (at, meant) = self.said_elasticity()?;
        let kept = restitution(damping);
        let differs = || {
            format!(
                "{damping} gives back {kept:.2} of the speed, whatever {at}, {meant}, and other elasticities say, which contacts by force do not ask; for {meant} take {:.2}",
                damping_for(meant)
            )
        };
        ((meant - kept).abs() > ALIKE && (0.0..=1.0).contains(&meant)).then(differs)
    }

    /// A remark on a sheet with thickness through which the scene's balls slip, or may: it meets them by its particles alone.
    pub(super) fn lets_through(&self, cloth: &Cloth) -> Option<String> {
        let (thickness, sheet) = (cloth.thickness.filter(|&thickness| thickness > 0.0)?, cloth.sheet()?);
        self.contacts?;
        let balls = self.particles.iter().filter(|ball| !ball.fixed).map(|ball| ball.radius);
        let born = self.emitters.iter().filter(|emitter| !emitter.fixed).map(|emitter| emitter.radius.mean);
        let least = balls.chain(born).filter(|&radius| radius > 0.0).fold(f32::INFINITY, f32::min);
        let [a, b] = [0, 1].map(|i| sheet.sides[i] / sheet.cells[i] as f32);
        let own = if self.boxes.is_empty() { 0.0 } else { 0.5 * thickness };
        let needed = WIDER * 0.5 * length(a + b).max(length(a - b)) - own;
        let slips = || {
            format!(
                "balls of a radius of {least} m may slip through it: they meet its particles alone, which are {} m apart; from {needed} m on they do not, or in cells of {} m",
                length(a).max(length(b)),
                length(a).max(length(b)) * (least + own) / (needed + own)
            )
        };
        (least < needed).then(slips)
    }

    /// The first elasticity of balls that is said, and where: one like that of all who say nothing may not have been.
    fn said_elasticity(&self) -> Option<(String, f32)> {
        let usual = Particle::REST.elasticity;
        let of_material = |number: Option<u16>| {
            let number = number?;
            let elasticity = self.materials.get(usize::from(number))?.contact.elasticity?;
            Some((format!("materials[{number}].contact.elasticity"), elasticity))
        };
        let own = |list: &str, i: usize, elasticity: f32| {
            (elasticity != usual).then(|| (format!("{list}[{i}].elasticity"), elasticity))
        };
        let balls = self.particles.iter().enumerate().filter(|(_, ball)| ball.radius > 0.0 && !ball.fixed);
        let mut balls =
            balls.filter_map(|(i, ball)| own("particles", i, ball.elasticity).or_else(|| of_material(ball.material)));
        let born = self.emitters.iter().enumerate().filter(|(_, emitter)| emitter.radius.mean > 0.0 && !emitter.fixed);
        let mut born = born.filter_map(|(i, emitter)| {
            own("emitters", i, emitter.elasticity.mean).or_else(|| of_material(emitter.material))
        });
        balls.next().or_else(|| born.next())
    }
}

/// The share of the speed that a head-on hit gives back by a damping ζ, the push never being a pull: exp(−ζ φ / √(1 − ζ²)) with
/// φ = atan2(2 ζ √(1 − ζ²), 2 ζ² − 1). Schwager and Pöschel, "Coefficient of restitution and linear-dashpot model revisited", Granular Matter 9, 2007.
fn restitution(damping: f32) -> f32 {
    // From 1 on nothing swings, and little is given back.
    let damping = damping.clamp(0.0, 0.999);
    let swings = sqrt(1.0 - damping * damping);
    let lasts = angle(2.0 * damping * damping - 1.0, 2.0 * damping * swings);
    exp(-damping * lasts / swings)
}

/// The damping by which a hit gives back a share of the speed, or 1 where that leaves more.
fn damping_for(share: f32) -> f32 {
    if share < restitution(1.0) {
        return 1.0;
    }
    let [mut low, mut high] = [0.0, 1.0];
    for _ in 0..24 {
        let middle = 0.5 * (low + high);
        if restitution(middle) > share { low = middle } else { high = middle }
    }
    0.5 * (low + high)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The share that is given back as explicit steps of the contact's own equation have it.
    fn stepped(damping: f32) -> f32 {
        const H: f32 = 1e-4;
        let (mut overlap, mut speed) = (0.0f32, 1.0f32);
        loop {
            let push = overlap + 2.0 * damping * speed;
            if speed < 0.0 && push <= 0.0 {
                return -speed;
            }
            speed -= H * push;
            overlap += H * speed;
        }
    }

    #[test]
    fn damping_and_what_is_given_back_tell_each_other() {
        for damping in [0.0, 0.05, 0.1, 0.3, 0.6, 0.71, 0.9] {
            assert!((restitution(damping) - stepped(damping)).abs() < 2e-3, "{damping}: {}", restitution(damping));
            assert!((damping_for(restitution(damping)) - damping).abs() < 2e-3, "{damping}");
        }
        assert!((restitution(0.1) - 0.744).abs() < 1e-3);
        assert_eq!(damping_for(0.0), 1.0);
    }
}
