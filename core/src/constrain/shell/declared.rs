//! The facts that scene files, checks and pictures ask of a shell.

use super::super::declared::{Declared, twice};
use super::Shell;
use crate::cloth::Hinge;
use crate::math::{length, max};
use crate::particles::Particle;
use crate::shape::Aabb;
use alloc::boxed::Box;
use glam::Vec3;

impl<P, T, H> Declared for Shell<P, T, H>
where
    P: AsRef<[u32]> + Sync,
    T: AsRef<[[u32; 3]]> + Sync,
    H: AsRef<[Hinge]> + Sync,
{
    fn name(&self) -> &'static str {
        "shell"
    }

    fn solved(&self) -> &'static str {
        "as one: exact at rest"
    }

    fn fault(&self) -> Option<(&'static str, &'static str)> {
        Self::fault(self).or_else(|| twice(self.particles.as_ref()))
    }

    fn ends(&self) -> [&[u32]; 3] {
        [self.particles.as_ref(), &[], &[]]
    }

    fn triangles(&self) -> Box<dyn Iterator<Item = [u32; 3]> + '_> {
        let particle = |corner: u32| self.particles.as_ref().get(corner as usize).copied();
        let triangles = self.triangles.as_ref().iter();
        Box::new(triangles.filter_map(move |&[a, b, c]| Some([particle(a)?, particle(b)?, particle(c)?])))
    }

    fn straight(&self) -> Option<&'static str> {
        Some("surfaces of particles")
    }

    fn is_body(&self) -> bool {
        true
    }

    fn iterates(&self) -> bool {
        true
    }

    fn stiffness(&self, _start: &[Particle]) -> Option<f64> {
        let [warp, weft] = self.params.stretch;
        Some(f64::from(max(warp, weft)))
    }

    // That at the top, hung from the box around what is fixed: density × g × length / stretch. What nothing holds hangs by its longest extent.
    fn hung(&self, start: &[Particle], gravity: f32) -> Option<f64> {
        let own = || self.particles.as_ref().iter().filter_map(|&number| start.get(number as usize));
        let place = |number: u32| start.get(number as usize).map_or(Vec3::NAN, |particle| particle.position);
        let area = |[a, b, c]: [u32; 3]| {
            let [a, b, c] = [a, b, c].map(place);
            f64::from(0.5 * length((b - a).cross(c - a)))
        };
        let area: f64 = Declared::triangles(self).map(area).sum();
        let mass: f64 = own().map(|particle| f64::from(particle.mass)).sum();
        let held = Aabb::around(own().filter(|particle| particle.fixed).map(|particle| particle.position));
        let from = |x: Vec3| length(x - x.max(held.min).min(held.max));
        let extent = if own().any(|particle| particle.fixed) {
            own().map(|particle| from(particle.position)).fold(0.0, max)
        } else {
            let Aabb { min, max } = Aabb::around(own().map(|particle| particle.position));
            (max - min).max_element()
        };
        let [warp, weft] = self.params.stretch.map(f64::from);
        let strain = mass / area * f64::from(gravity) * f64::from(extent) / warp.min(weft);
        Some(if strain.is_finite() { strain } else { 0.0 })
    }
}
