//! The columns of a system, written once: views of them, and whoever owns their memory, are made from this table.

/// Hands the table to a macro: by row what each particle has (`particle`), what all may have in common (`common`, with where it comes from),
/// then what emitters, springs and constraints keep, and what a step works with.
macro_rules! columns {
    ($make:ident) => {
        $make! {
            particle {
                /// Where it is \[m\], by row.
                position: glam::Vec3 = glam::Vec3::ZERO,
                /// How it moves \[m/s\], by row.
                velocity: glam::Vec3 = glam::Vec3::ZERO,
                /// When it was born, by row.
                born: $crate::time::Time = $crate::time::Time::ZERO,
                /// When it dies of age, by row.
                dies: $crate::time::Time = $crate::time::Time::ZERO,
                /// Why it will be removed at the end of this step, by row.
                pending_death: $crate::reap::PendingDeath = $crate::reap::PendingDeath::Lives,
                /// The number of particles that came into the system before it, by row.
                serial: u32 = 0,
                /// The key by which its random numbers are drawn as long as it lives, by row.
                key: u32 = 0,
                /// The slot it holds, by row.
                slot: u32 = 0,
                /// Its row, by slot; of a free slot the next free one plus one, zero ending the list.
                row_of: u32 = 0,
            }
            common {
                /// Radius \[m\], by row; zero: a point.
                radius: f32 = 0.0, of |particle| particle.radius,
                /// Mass \[kg\], by row.
                mass: f32 = 0.0, of |particle| particle.mass,
                /// Inverse mass \[1/kg\], by row; zero pins the particle.
                inverse_mass: f32 = 0.0, of |particle| if particle.fixed { 0.0 } else { 1.0 / particle.mass },
                /// Coefficient of linear drag \[kg/s\], by row.
                drag: f32 = 0.0, of |particle| particle.drag,
                /// Electric charge \[C\], by row.
                charge: f32 = 0.0, of |particle| particle.charge,
                /// Share of the normal speed kept in a hit, by row.
                elasticity: f32 = 0.0, of |particle| particle.elasticity,
                /// Its colour, by row.
                color: $crate::particles::Color = [0; 4], of |particle| match particle.color { Some(color) => color, None => $crate::particles::WHITE },
                /// Number of its material plus one, by row; zero: none.
                material: u16 = 0, of |particle| match particle.material { Some(number) => number.saturating_add(1), None => 0 },
                /// The end of its list of springs, by number of the particle in the scene's start.
                last_spring: u32 = 0, of |_particle| 0,
            }
            emitter {
                /// The state of each emitter: its births so far.
                emitter_states: $crate::emit::EmitterState = $crate::emit::EmitterState::NEW,
            }
            spring {
                /// The springs at each particle of the start, one list behind the other.
                incident: u32 = 0,
            }
            kept {
                /// The words kept of particles beside all that: columns of a user's own, then those that constraints keep of
                /// each, then the other words that constraints keep, one behind the other.
                kept: u32 = 0,
            }
            work {
                /// Columns to work with, one behind the other.
                work: glam::Vec3 = glam::Vec3::ZERO,
            }
        }
    };
}
pub(crate) use columns;
