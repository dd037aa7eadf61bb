//! Sheets of cloth that touch each other, and the exact test of whether they pass.

use pointmass::constrain::{Hinge, SheetContacts, Shell, ShellParams};
use pointmass::{Particle, Sheet, Vec3};

pub(crate) const G: f32 = 9.81;

pub(crate) type Cloth = Shell<Vec<u32>, Vec<[u32; 3]>, Vec<Hinge>>;

/// Sheets of cloth that touch each other.
#[derive(Default)]
pub(crate) struct Cloths {
    pub(crate) start: Vec<Particle>,
    pub(crate) shells: Vec<Cloth>,
    pub(crate) triangles: Vec<[u32; 3]>,
}

impl Cloths {
    /// Adds a sheet, its particles where `place` puts them and as fast as `velocity` says.
    pub(crate) fn add(&mut self, sheet: &Sheet, params: ShellParams, place: impl Fn(Vec3) -> Vec3, velocity: Vec3) {
        let first = self.start.len() as u32;
        let mut all: Vec<Particle> =
            sheet.particles(Particle { mass: 0.0, elasticity: 0.0, velocity, ..Particle::REST }).collect();
        for corners in sheet.triangles() {
            let [a, b, c] = corners.map(|corner| all[corner as usize].position);
            let third = 0.2 * (b - a).cross(c - a).length() / 6.0;
            corners.iter().for_each(|&corner| all[corner as usize].mass += third);
        }
        all.iter_mut().for_each(|particle| particle.position = place(particle.position));
        self.shells.push(Shell {
            particles: (first..first + all.len() as u32).collect(),
            triangles: sheet.triangles().collect(),
            hinges: sheet.hinges().collect(),
            warp: sheet.sides[0],
            params,
        });
        self.triangles.extend(sheet.triangles().map(|corners| corners.map(|corner| first + corner)));
        self.start.extend(all);
    }

    pub(crate) fn contacts(&self, thickness: f32) -> SheetContacts<Vec<u32>, Vec<[u32; 3]>, [f32; 1]> {
        SheetContacts {
            particles: (0..self.start.len() as u32).collect(),
            triangles: self.triangles.clone(),
            thickness: [thickness],
        }
    }

    /// The edges, each once.
    fn edges(&self) -> Vec<[u32; 2]> {
        let of = |&[a, b, c]: &[u32; 3]| [[a, b], [b, c], [c, a]].map(|[a, b]| [a.min(b), a.max(b)]);
        let mut edges: Vec<_> = self.triangles.iter().flat_map(of).collect();
        edges.sort_unstable();
        edges.dedup();
        edges
    }

    /// Edges that go through triangles, exactly.
    pub(crate) fn crossings(&self, x: &[Vec3]) -> usize {
        let bounds = |of: &[u32]| {
            let all = of.iter().map(|&corner| x[corner as usize]);
            all.fold([Vec3::INFINITY, Vec3::NEG_INFINITY], |[low, high], x| [low.min(x), high.max(x)])
        };
        let triangles: Vec<_> = self.triangles.iter().map(|corners| (corners, bounds(corners))).collect();
        let mut count = 0;
        for edge in self.edges() {
            let [low, high] = bounds(&edge);
            for &(corners, [from, to]) in &triangles {
                let apart = low.cmpgt(to).any() || from.cmpgt(high).any();
                if !apart && !corners.iter().any(|corner| edge.contains(corner)) {
                    count += usize::from(crosses(edge.map(|i| x[i as usize]), corners.map(|i| x[i as usize])));
                }
            }
        }
        count
    }
}

/// The sign of the volume of a tetrahedron, without error.
fn side(all: [Vec3; 4]) -> i32 {
    let [a, b, c, d] = all.map(|x| {
        let [x, y, z] = x.to_array().map(f64::from);
        robust::Coord3D { x, y, z }
    });
    let volume = robust::orient3d(a, b, c, d);
    i32::from(volume > 0.0) - i32::from(volume < 0.0)
}

/// Tells whether an edge goes through a triangle.
pub(crate) fn crosses([p, q]: [Vec3; 2], [a, b, c]: [Vec3; 3]) -> bool {
    let sides = [side([a, b, c, p]), side([a, b, c, q])];
    let around = [side([p, q, a, b]), side([p, q, b, c]), side([p, q, c, a])];
    sides[0] * sides[1] <= 0 && sides != [0, 0] && (around.iter().all(|&s| s >= 0) || around.iter().all(|&s| s <= 0))
}

/// A soft cloth of a size \[m\]: it falls alike at every size.
pub(crate) fn cotton(size: f32) -> ShellParams {
    ShellParams { stretch: [200.0 * size; 2], shear: 60.0 * size, bending: 1e-5 * size * size * size, damping: 2e-3 }
}

/// A square of cloth about `center`.
pub(crate) fn square(center: Vec3, [u, v]: [Vec3; 2], cells: u32) -> Sheet {
    Sheet { corner: center - (u + v) * 0.5, sides: [u, v], cells: [cells; 2] }
}
