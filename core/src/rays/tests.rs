//! Words that pass for an index and are none: whatever they say, asking them ends and does not panic.

use super::header::Header;
use super::{Index, Structure, Visitor};
use crate::Vec3;
use crate::rng::Stream;
use crate::shape::{Aabb, MeshBuf, Segment};
use alloc::vec;
use alloc::vec::Vec;
use core::ops::ControlFlow;

#[test]
fn poisoned_words_are_refused_or_harmless() {
    let vertices: Vec<Vec3> = (0..120).map(|i| Vec3::from(draw(i, 0)) * 2.0 - 1.0).collect();
    let triangles: Vec<[u32; 3]> = (0..118).map(|i| [i, i + 1, i + 2]).collect();
    let mesh = MeshBuf::new(vertices, triangles).expect("it is a mesh");
    let view = mesh.view();
    let (mut refused, mut passed) = (0, 0);
    for &structure in Structure::ALL {
        let mut memory = vec![0; structure.words(118)];
        let words = structure.build(&view, &mut memory).expect("there is room").words().to_vec();
        for i in 0..if cfg!(debug_assertions) { 300 } else { 3000 } {
            let mut poisoned = words.clone();
            let stream = Stream::new(1, structure as u32, i);
            for k in 0..1 + i % 3 {
                let [at, what] = stream.words(k);
                let at = 2 + at as usize % (words.len() - 2);
                poisoned[at] = match i % 4 {
                    0 => what,
                    1 => what % words.len() as u32,
                    2 => poisoned[at] ^ (1 << (what % 32)),
                    _ => words[what as usize % words.len()],
                };
            }
            // Its sum says that nothing is wrong.
            let mut header = *Header::of(&poisoned).expect("there is one");
            header.words = words.len() as u32;
            header.write(&mut poisoned);
            let Ok(index) = Index::new(&poisoned) else {
                refused += 1;
                continue;
            };
            passed += 1;
            let path = Segment::new(Vec3::from(draw(i, 1)) * 3.0, Vec3::from(draw(i, 2)) * -3.0);
            let _ = index.first_hit_counted(&view, &path);
            let bounds = Aabb { min: Vec3::splat(-0.2), max: Vec3::ONE };
            index.near(&view, &bounds, &mut |_| {});
            index.visit(&view, &mut Into(bounds));
        }
    }
    assert!(refused > 100 && passed > 100, "{refused} {passed}");
}

/// Goes into boxes that share a point with its own.
struct Into(Aabb);

impl Visitor for Into {
    fn enters(&mut self, bounds: &Aabb) -> bool {
        bounds.min.cmple(self.0.max).all() && bounds.max.cmpge(self.0.min).all()
    }
    fn visit(&mut self, _: usize) -> ControlFlow<()> {
        ControlFlow::Continue(())
    }
}

fn draw(i: u32, k: u32) -> [f32; 3] {
    let stream = Stream::new(7, k, i);
    [stream.units(0)[0], stream.units(0)[1], stream.units(1)[0]]
}
