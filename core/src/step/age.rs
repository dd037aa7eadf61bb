//! Age: materials change drags and masses over the lives of particles.

use super::Workspace;
use super::workspace::Inertias;
use crate::material::Ageing;
use crate::memory::Layout;
use crate::scene::Scene;
use crate::time::Time;

impl Workspace<'_> {
    /// Gives all what they have in the middle of a step, of which the newborn see a part.
    #[inline(never)]
    pub(super) fn age(&mut self, scene: &Scene<'_>, [now, dt]: [Time; 2]) {
        let Some(code) = scene.materials.code().filter(|code| (code.kept)(scene.materials) > 0) else { return };
        let (len, capacity) = (self.len(), self.capacity());
        self.status.inertias = Inertias::VARIOUS;
        let m = &mut self.memory;
        let rows = Ageing {
            during: [now, now + dt],
            born: &m.born[..len],
            dies: &m.dies[..len],
            material: &m.material[..len],
            key: &m.key[..len],
            drag: &mut m.drag.own()[..len],
            mass: &mut m.mass.own()[..len],
            inverse_mass: &mut m.inverse_mass.own()[..len],
            own: Layout::of(scene.plan(), capacity).ageing(m.kept),
        };
        (code.age)(scene.materials, rows);
    }
}
