//! The material frames of edges, and how two of them that follow one another are bent and twisted.

use crate::constrain::turn::Turn;
use crate::math::{dot, length, sin_cos, sqrt};
use glam::{Mat3, Vec3};

/// The cosine of how far an edge may turn in a sub-step to be pulled along the direction of the beginning: by 60°.
const COSINE: f32 = 0.5;

/// An edge in a sub-step.
#[derive(Clone, Copy)]
pub(super) struct Edge {
    /// How long it is along the direction in which forces act \[m\].
    pub(super) length: f32,
    /// The direction in which forces act: that of the sub-step's beginning, as far as the method has not gone beyond it.
    pub(super) along: Vec3,
    /// Its frame now, and in that direction; the third axis is along the edge.
    pub(super) frame: [Turn; 2],
    /// True if both its ends are fixed: it is embedded, and what joins it is clamped.
    pub(super) embedded: bool,
}

impl Edge {
    /// The edge with these ways from end to end: now, less what its velocities make of it in a sub-step, and as the sub-step began, when
    /// its frame was this one; none if it has no direction. Something may turn it about itself on its way.
    pub(super) fn of(kept: Turn, [now, back, before]: [Vec3; 3], embedded: bool, spun: Option<Spin>) -> Option<Self> {
        let direction = |way: Vec3| {
            let far = length(way);
            (far > 0.0 && far < f32::INFINITY).then(|| (way / far, far))
        };
        let (to, far) = direction(now)?;
        let (from, _) = direction(before).unwrap_or((to, far));
        // What turns farther, or had no direction, is pulled along where it is.
        let (along, length) = direction(back).filter(|&(back, _)| dot(back, to) > COSINE).unwrap_or((to, far));
        let frame = bring(bring(kept, from), along);
        let frame = spun.map_or(frame, |spin| spin.about(along).after(frame));
        Some(Self { length, along, frame: [bring(frame, to), frame], embedded })
    }
}

/// A rotation about an edge: the sine and the cosine of half its angle.
#[derive(Clone, Copy)]
pub(super) struct Spin([f32; 2]);

impl Spin {
    /// That by an angle \[rad\]; none by zero, nor by what is none.
    pub(super) fn by(angle: f32) -> Option<Self> {
        let (sin, cos) = if angle.is_finite() { sin_cos(0.5 * angle) } else { (0.0, 1.0) };
        (angle != 0.0 && sin.is_finite() && cos.is_finite()).then_some(Self([sin, cos]))
    }

    /// It, right-handed about a direction.
    fn about(self, direction: Vec3) -> Turn {
        let (Self([sin, cos]), Vec3 { x, y, z }) = (self, direction);
        Turn([x * sin, y * sin, z * sin, cos])
    }
}

/// A frame, turned on the shortest way so that its third axis gets into a direction: parallel transport, in space and in time.
pub(super) fn bring(frame: Turn, direction: Vec3) -> Turn {
    let Turn([x, y, z, w]) = frame;
    let third = Vec3::new(2.0 * (x * z + w * y), 2.0 * (y * z - w * x), 1.0 - 2.0 * (x * x + y * y));
    // Right behind there is no shortest way; half a turn about the first axis is one.
    let frame = if dot(third, direction) < -0.999 { Turn([w, z, -y, -x]) } else { frame };
    frame.bring(Vec3::Z, direction)
}

/// The frame of an edge in a direction whose first axis is across, as far as that is upright on it; where that is along the edge, any.
pub(super) fn frame(direction: Vec3, across: Vec3) -> Turn {
    let plain = bring(Turn::NONE, direction);
    let (first, second) = (plain.matrix().x_axis, plain.matrix().y_axis);
    let (along, aside) = (dot(first, across), dot(second, across));
    let size = sqrt(along * along + aside * aside);
    // The tangent of half the angle; where that is half a turn, nearly that.
    let half = aside / (size + along);
    let half = if size > 1e-6 * length(across) && !(half.abs() < 1e6) { 1e6 } else { half };
    if size > 1e-6 * length(across) { plain.on(direction * (2.0 * half)) } else { plain }
}

/// How the second of two frames is turned against the first, in its own axes: twice the tangent of half the angle, along the axis. The first
/// two numbers are the bending about the frame's first two axes, the third is the twist.
///
/// That is the discrete curvature of Bergou et al. ("Discrete Elastic Rods", SIGGRAPH 2008, equation 1) with the twist as its third component.
pub(super) fn strain(first: Turn, second: Turn) -> Vec3 {
    let split = |Turn([x, y, z, w]): Turn| (Vec3::new(x, y, z), w);
    let ((u, a), (v, b)) = (split(first), split(second));
    let real = a * b + dot(u, v);
    (v * a - u * b - u.cross(v)) * (2.0 / real)
}

/// What the three strains make of a small rotation of the second frame against the first: dot products with these.
///
/// Of g = 2 tan(φ/2) n and a rotation dψ in the second frame's own axes, dg = dψ + ½ g × dψ + ¼ g (g · dψ).
pub(super) fn gradients(second: Turn, strain: Vec3) -> [Vec3; 3] {
    let matrix: Mat3 = second.matrix();
    [(Vec3::X, strain.x), (Vec3::Y, strain.y), (Vec3::Z, strain.z)]
        .map(|(axis, own)| matrix * (axis + axis.cross(strain) * 0.5 + strain * (0.25 * own)))
}
