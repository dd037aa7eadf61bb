//! Shells and strands of several pieces, or torn ones: none takes energy or momenta that another has.

use pointmass::constrain::{Hinge, Shell, ShellParams, StrandParams, Strands, mesh_hinges};
use pointmass::{Gravity, Id, Method, Particle, Scene, Sheet, Time, Vec3};
use pointmass_tests::points::shuffle;
use pointmass_tests::{Random, f64s, gap, often, started};

/// Sheets beside each other as one mesh, and which particles each has; the order of all of these is anyhow.
struct Sheets {
    places: Vec<Vec3>,
    triangles: Vec<[u32; 3]>,
    pieces: Vec<Vec<usize>>,
}

fn sheets(sizes: &[[u32; 2]], random: &mut Random) -> Sheets {
    let (mut places, mut triangles, mut pieces) = (vec![], vec![], vec![]);
    for (i, &cells) in sizes.iter().enumerate() {
        let sheet = Sheet { corner: Vec3::X * (3.0 * i as f32), sides: [Vec3::X, Vec3::Z], cells };
        let first = places.len() as u32;
        places.extend(sheet.positions());
        triangles.extend(sheet.triangles().map(|corners| corners.map(|corner| corner + first)));
        pieces.push((first as usize..places.len()).collect::<Vec<_>>());
    }
    let mut order: Vec<usize> = (0..places.len()).collect();
    shuffle(&mut order, random);
    let mut new = vec![0; order.len()];
    order.iter().enumerate().for_each(|(to, &from)| new[from] = to);
    Sheets {
        places: order.iter().map(|&from| places[from]).collect(),
        triangles: triangles
            .into_iter()
            .map(|corners: [u32; 3]| corners.map(|corner| new[corner as usize] as u32))
            .collect(),
        pieces: pieces.into_iter().map(|piece| piece.into_iter().map(|i| new[i]).collect()).collect(),
    }
}

impl Sheets {
    fn shell(&self, stretch: f32) -> Shell<Vec<u32>, Vec<[u32; 3]>, Vec<Hinge>> {
        Shell {
            particles: (0..self.places.len() as u32).collect(),
            triangles: self.triangles.clone(),
            hinges: mesh_hinges(&self.triangles),
            warp: Vec3::X,
            params: ShellParams { stretch: [stretch; 2], shear: 0.5 * stretch, bending: 1e-6 * stretch, damping: 0.0 },
        }
    }

    fn start(&self, mut velocity: impl FnMut(usize) -> Vec3) -> Vec<Particle> {
        let part =
            |(i, &position): (usize, &Vec3)| Particle { position, velocity: velocity(i), mass: 1e-3, ..Particle::REST };
        self.places.iter().enumerate().map(part).collect()
    }

    /// The energy by which triangles of living corners are stretched and sheared, of which all are in a piece \[J\].
    fn strained(&self, stretch: f32, piece: &[usize], place: impl Fn(usize) -> Option<[f64; 3]>) -> f64 {
        let dot = |a: [f64; 3], b: [f64; 3]| (0..3).map(|k| a[k] * b[k]).sum::<f64>();
        let minus = |a: [f64; 3], b: [f64; 3]| [0, 1, 2].map(|k| a[k] - b[k]);
        let one = |corners: &[u32; 3]| {
            let all = corners.map(|corner| corner as usize);
            if !all.iter().all(|corner| piece.contains(corner)) {
                return None;
            }
            let rest = all.map(|corner| f64s(self.places[corner]));
            let [a, b, c] = [place(all[0])?, place(all[1])?, place(all[2])?];
            let ([e, f], [g, h]) = ([minus(rest[1], rest[0]), minus(rest[2], rest[0])], [minus(b, a), minus(c, a)]);
            let ([p, q, r], [s, t, u]) = ([dot(e, e), dot(e, f), dot(f, f)], [dot(g, g), dot(g, h), dot(h, h)]);
            let square = p * r - q * q;
            let by =
                [[r * s - q * t, r * t - q * u], [p * t - q * s, p * u - q * t]].map(|row| row.map(|x| x / square));
            let [[i, j], [k, l]] = [[by[0][0] - 1.0, by[0][1]], [by[1][0], by[1][1] - 1.0]];
            Some(f64::from(stretch) / 8.0 * 0.5 * square.sqrt() * (i * i + 2.0 * j * k + l * l))
        };
        self.triangles.iter().filter_map(one).sum()
    }
}

/// The energy of motion beside that of the middle of particles of one mass, and their angular momentum about that.
fn moving(mass: f32, x: &[[f64; 3]], v: &[[f64; 3]]) -> (f64, [f64; 3]) {
    let mean = |of: &[[f64; 3]]| [0, 1, 2].map(|k| of.iter().map(|of| of[k]).sum::<f64>() / of.len() as f64);
    let ([middle, drift], mass) = ([mean(x), mean(v)], f64::from(mass));
    let (mut energy, mut spin) = (0.0, [0.0; 3]);
    for (x, v) in x.iter().zip(v) {
        let (r, v) = ([0, 1, 2].map(|k| x[k] - middle[k]), [0, 1, 2].map(|k| v[k] - drift[k]));
        energy += 0.5 * mass * gap(v, [0.0; 3]).powi(2);
        let own = [r[1] * v[2] - r[2] * v[1], r[2] * v[0] - r[0] * v[2], r[0] * v[1] - r[1] * v[0]];
        (0..3).for_each(|k| spin[k] += mass * own[k]);
    }
    (energy, spin)
}

/// One piece trembles, one turns, one does both and flies off: each keeps what it has, however stiff it is.
#[test]
fn no_piece_of_a_shell_takes_what_another_has() {
    let mut random = Random::new(9);
    for (stretch, substeps, method) in
        [(1e2f32, 1, Method::Symplectic), (1e4, 1, Method::Rk4), (1e4, 3, Method::Verlet), (1e5, 10, Method::Euler)]
    {
        let sheets = sheets(&[[5, 4], [4, 4], [6, 3]], &mut random);
        let (shell, pieces) = (sheets.shell(stretch), &sheets.pieces);
        let start = sheets.start(|i| {
            let arm = sheets.places[i];
            let trembling = random.vector(2.0);
            match pieces.iter().position(|piece| piece.contains(&i)) {
                Some(0) => trembling,
                Some(1) => Vec3::Y.cross(arm - Vec3::X * 3.5) * 2.0,
                _ => trembling * 0.1 + Vec3::new(1.0, 2.0, 0.0) + Vec3::Z.cross(arm - Vec3::X * 6.5),
            }
        });
        let scene =
            Scene { start: &start, constraints: &shell, substeps, integrator: method.integrator(), ..Scene::EMPTY };
        let mut system = started(&scene, start.len(), 0);
        let mut begun = vec![];
        for frame in 0..=often(240) as u64 {
            system.step_to(&scene, Time::frame(frame, 60));
            let there = system.particles();
            for (number, piece) in pieces.iter().enumerate() {
                let of = |column: &[Vec3]| piece.iter().map(|&i| f64s(column[i])).collect::<Vec<_>>();
                let (kinetic, spin) = moving(1e-3, &of(there.position), &of(there.velocity));
                let now = kinetic + sheets.strained(stretch, piece, |i| Some(f64s(there.position[i])));
                if frame == 0 {
                    begun.push((now, spin));
                }
                let name = format!("{method} in {substeps}, {stretch} N/m, piece {number}, frame {frame}");
                // Strain is told no finer than places are, some metres from the origin.
                let rounding = f64::from(stretch) * 1e-10 / begun[number].0;
                assert!(now < begun[number].0 * (1.0 + 1e-5 + rounding), "{name}: {}", now / begun[number].0);
                let lost = gap(spin, begun[number].1) / gap(begun[number].1, [0.0; 3]);
                // What trembles has hardly any, and places a few metres off are no finer than 5e-7 m.
                assert!(lost < if number == 0 { 5e-2 } else { 1e-3 }, "{name}: {lost}");
            }
        }
    }
}

/// A piece of a shell of which another hangs falls as if it were alone.
#[test]
fn a_free_piece_beside_one_that_hangs_falls_freely() {
    let mut random = Random::new(10);
    let down = Gravity { acceleration: Vec3::new(0.0, -9.81, 0.0) };
    for (method, substeps) in [(Method::Verlet, 1), (Method::Rk4, 5), (Method::Midpoint, 2)] {
        let sheets = sheets(&[[5, 4], [4, 4]], &mut random);
        let shell = sheets.shell(1e3);
        let mut start = sheets.start(|_| Vec3::ZERO);
        start[sheets.pieces[0][0]].fixed = true;
        let scene = Scene {
            start: &start,
            forces: &down,
            constraints: &shell,
            substeps,
            integrator: method.integrator(),
            ..Scene::EMPTY
        };
        let mut system = started(&scene, start.len(), 0);
        for frame in 1..=60 {
            system.step_to(&scene, Time::frame(frame, 60));
            let t = frame as f32 / 60.0;
            for &i in &sheets.pieces[1] {
                let off = system.particles().position[i].y + 0.5 * 9.81 * t * t;
                assert!(off.abs() < 2e-5, "{method} in {substeps}, frame {frame}: {off}");
            }
        }
    }
}

/// A sheet that loses its middle column is in two pieces, of which none gains energy or takes the other's
/// turning.
#[test]
fn halves_of_a_torn_sheet_gain_no_energy() {
    let mut random = Random::new(11);
    for (stretch, substeps, method) in
        [(1e2f32, 1, Method::Symplectic), (1e4, 2, Method::Verlet), (1e4, 10, Method::Rk4)]
    {
        let sheets = sheets(&[[6, 4]], &mut random);
        let shell = sheets.shell(stretch);
        let mut start = sheets.start(|i| Vec3::Y.cross(sheets.places[i] - 0.5) * 2.0 + random.vector(0.5));
        let side = |i: usize| (sheets.places[i].x * 6.0).round() as i32 - 3;
        start.iter_mut().enumerate().filter(|&(i, _)| side(i) == 0).for_each(|(_, p)| p.lifetime = 0.1);
        let halves = [-1, 1].map(|sign| (0..start.len()).filter(|&i| side(i) * sign > 0).collect::<Vec<_>>());
        let scene =
            Scene { start: &start, constraints: &shell, substeps, integrator: method.integrator(), ..Scene::EMPTY };
        let mut system = started(&scene, start.len(), 0);
        let ids: Vec<Id> = (0..start.len()).filter_map(|row| system.id(row)).collect();
        let mut begun = vec![];
        for frame in 1..=often(240).max(30) as u64 {
            system.step_to(&scene, Time::frame(frame, 60));
            if frame < 8 {
                continue;
            }
            assert_eq!(system.len(), start.len() - 5);
            let there = system.particles();
            let row = |i: usize| system.row(ids[i]);
            for (number, half) in halves.iter().enumerate() {
                let of = |column: &[Vec3]| half.iter().filter_map(|&i| Some(f64s(column[row(i)?]))).collect::<Vec<_>>();
                let (kinetic, spin) = moving(1e-3, &of(there.position), &of(there.velocity));
                let now = kinetic + sheets.strained(stretch, half, |i| Some(f64s(there.position[row(i)?])));
                if begun.len() < 2 {
                    begun.push((now, spin));
                }
                let name = format!("{method} in {substeps}, {stretch} N/m, half {number}, frame {frame}");
                let rounding = f64::from(stretch) * 1e-10 / begun[number].0;
                // Bending, which is not counted here, gives back what it has.
                assert!(now < begun[number].0 * (1.02 + rounding), "{name}: {}", now / begun[number].0);
                let lost = gap(spin, begun[number].1) / gap(begun[number].1, [0.0; 3]);
                assert!(lost < 1e-3, "{name}: {lost}");
            }
        }
    }
}

/// The halves of a strand whose middle has died gain none either.
#[test]
fn halves_of_a_torn_strand_gain_no_energy() {
    let mut random = Random::new(12);
    for (stretch, substeps) in [(None, 1), (Some(1e3), 1), (Some(1e4), 5), (Some(1e3), 20)] {
        let part = |i: usize| {
            let position = Vec3::X * (0.1 * i as f32);
            let velocity = Vec3::Z.cross(position - Vec3::X) * 3.0 + random.vector(0.5);
            let lifetime = if i == 12 { 0.1 } else { 0.0 };
            Particle { position, velocity, mass: 1e-3, lifetime, ..Particle::REST }
        };
        let start: Vec<Particle> = (0..24).map(part).collect();
        let params = StrandParams { stretch, bending: [1e-6; 2], twisting: 1e-6, damping: 0.0 };
        let strand = Strands::of((0..24).collect::<Vec<u32>>(), [24], params);
        let scene = Scene { start: &start, constraints: &strand, substeps, ..Scene::EMPTY };
        let mut system = started(&scene, start.len(), 0);
        let ids: Vec<Id> = (0..start.len()).filter_map(|row| system.id(row)).collect();
        let mut begun = vec![];
        for frame in 1..=often(600).max(30) as u64 {
            system.step_to(&scene, Time::frame(frame, 60));
            if frame < 8 {
                continue;
            }
            let there = system.particles();
            let row = |i: usize| system.row(ids[i]);
            for (number, half) in [0..12usize, 13..24].into_iter().enumerate() {
                let of = |column: &[Vec3]| half.clone().filter_map(|i| Some(f64s(column[row(i)?]))).collect::<Vec<_>>();
                let (x, v) = (of(there.position), of(there.velocity));
                let kinetic = moving(1e-3, &x, &v).0;
                let long = x.windows(2).map(|ends| gap(ends[0], ends[1]) - 0.1);
                // Of what is stiffer than it takes to be brought to its length in a sub-step, motion comes of no more than that.
                let shown = 0.5 * 1e-3 * (60.0 * f64::from(substeps)).powi(2);
                let stiff = stretch.map(|stretch| (f64::from(stretch) / 0.1).min(shown));
                let strained: f64 = stiff.map_or(0.0, |stiff| long.map(|long| 0.5 * stiff * long * long).sum());
                if begun.len() < 2 {
                    begun.push(kinetic + strained);
                }
                let now = (kinetic + strained) / begun[number];
                // Bending gives back what it has.
                assert!(now < 1.001, "{stretch:?} in {substeps}, half {number}, frame {frame}: {now}");
            }
        }
    }
}
