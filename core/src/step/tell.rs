//! Whoever watches is told how far the step has come, and by forces of those who have come to touch.

use crate::collide::Tile;
use crate::constrain::Substep;
use crate::force::{State, Telling, Told, Watched};
use crate::memory::{Layout, Workspace};
use crate::observe::{Attention, Observer, Phase};
use crate::scene::Scene;
use glam::Vec3;

impl Workspace<'_> {
    /// Says how far the step has come, to whoever listens.
    #[inline(never)]
    pub(super) fn tell(&self, phase: Phase, scene: &Scene<'_>, observer: &mut dyn Observer) {
        if observer.attention() > Attention::Nothing {
            observer.after(phase, &self.state(scene));
        }
    }

    /// Lets forces tell of those who have come to touch in a sub-step that is over.
    #[inline(never)]
    pub(super) fn let_forces_tell(
        &mut self,
        scene: &Scene<'_>,
        layout: &Layout,
        substep: Substep,
        code: Telling,
        observer: &mut dyn Observer,
    ) {
        let (during, len) = (substep.during, self.len());
        let span = [during[0], during[1] - during[0]];
        let Tile { attributes, position, velocity, work, .. } = self.tile(scene, layout, span, len);
        let (attributes, custom, ends) = (&attributes, attributes.lives.custom, [&*position, &*velocity]);
        let (needs, index, substeps, step) = (scene.forces.needs(), scene.index, substep.count, substep.step.seconds());
        let add = &|state: &State<'_>, total: &mut [Vec3]| scene.forces.add_to(state, 0..total.len(), total);
        let tell = &|watched: &mut Watched<'_>| scene.forces.tell(watched);
        (code.0)(Told {
            needs,
            attributes,
            custom,
            index,
            ends,
            work,
            layout,
            during,
            substeps,
            step,
            observer,
            add,
            tell,
        });
    }
}
