//! Lines that pictures show on top of what is seen: how things work.

mod contacts;
mod sheets;

pub(crate) use contacts::Blows;

use clap::ValueEnum;
use pointmass::draw::{Line, arrows, cells, velocities};
use pointmass::force::State;
use pointmass::index::{SpatialIndex, Structure};
use pointmass::scene::Model;

/// Something that works unseen.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum Show {
    /// Boxes around the points of each cell or leaf of the scene's index
    Index,
    /// Where particles would be a tenth of a second later
    Velocities,
    /// Springs and the links of constraints by their strain, red where longer than at rest, blue where shorter
    Springs,
    /// Whatever is drawn of cloth, strands, ropes, links and springs by its strain, in the same colours
    Strain,
    /// Surfaces that particles come from, with arrows their way
    Sources,
    /// Surfaces that particles vanish at, with arrows toward them
    Sinks,
    /// Blows since the picture before, as red arrows; and lines where something lies on scenery, orange, or on balls, bodies and cloth, blue
    Contacts,
}

/// The time that velocities are drawn for \[s\].
const AHEAD: f32 = 0.1;

/// The number of arrows that a surface has, and of the lines of each.
const ARROWS: u32 = 8;
const STROKES: usize = 5;

/// All lines that are to be shown of a state, but for springs and contacts; arrows as long as `length` says \[m\].
pub(crate) fn lines(show: &[Show], state: &State<'_>, model: &Model, index: Structure, length: f32) -> Vec<Line> {
    let mut all = Vec::new();
    // They are always drawn in one order, whatever that of the asking.
    for what in Show::value_variants().iter().filter(|what| show.contains(what)) {
        match what {
            Show::Index => all.extend(boxes(state, index)),
            Show::Velocities => {
                let count = state.position.len();
                all.extend(written(count, |into| velocities(state, AHEAD, into)));
            }
            Show::Sources => {
                for emitter in &model.emitters {
                    let color = emitter.color.unwrap_or([120, 200, 120, 255]);
                    let draw =
                        |into: &mut [Line]| arrows(&emitter.shape, emitter.direction, length, ARROWS, color, into);
                    all.extend(written(ARROWS as usize * STROKES, draw));
                }
            }
            Show::Sinks => {
                for sink in &model.forces.1 {
                    let draw = |into: &mut [Line]| arrows(&sink.shape, None, -length, ARROWS, [200, 90, 90, 255], into);
                    all.extend(written(ARROWS as usize * STROKES, draw));
                }
            }
            Show::Springs | Show::Strain | Show::Contacts => {}
        }
    }
    all
}

/// The boxes of an index that is built of the points as they are, its cells as large as their density suggests.
fn boxes(state: &State<'_>, structure: Structure) -> Vec<Line> {
    let mut memory = vec![0; structure.words(state.position.len())];
    let mut index = structure.in_room(&mut memory, state.near.room());
    if index.build(state.position, 0.0).is_err() {
        return Vec::new();
    }
    let mut parts = 0;
    index.parts(&mut |_| parts += 1);
    written(12 * parts, |into| cells(&index, state.position, [110, 150, 200, 110], into))
}

/// The lines that are written into room for so many.
fn written(room: usize, write: impl FnOnce(&mut [Line]) -> (usize, usize)) -> Vec<Line> {
    let mut lines = vec![Line::NONE; room];
    let (count, _) = write(&mut lines);
    lines.truncate(count);
    lines
}
