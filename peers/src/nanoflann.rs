//! C++ nanoflann's `KDTreeSingleIndexAdaptor`, with leaves of up to 20 points and result sets of our own that count or
//! push, through the C functions of `nanoflann.cpp`.
#![allow(unsafe_code, reason = "C++ is called; the functions keep to the lengths they are given")]

use crate::{Peer, room};

/// The index on the other side; its points are its own.
#[repr(C)]
struct Index([u8; 0]);

unsafe extern "C" {
    fn pointmass_nanoflann_new(xyz: *const f32, n: usize) -> *mut Index;
    fn pointmass_nanoflann_delete(index: *mut Index);
    fn pointmass_nanoflann_bytes(index: *mut Index) -> usize;
    fn pointmass_nanoflann_counts(index: *const Index, radius: f32, counts: *mut u32);
    fn pointmass_nanoflann_lists(index: *mut Index, radius: f32) -> u64;
    fn pointmass_nanoflann_nearest(index: *const Index, k: usize, distances: *mut f32);
}

#[derive(Default)]
pub(crate) struct Nanoflann {
    built: Option<Built>,
}

struct Built {
    index: *mut Index,
    points: usize,
}

impl Drop for Built {
    fn drop(&mut self) {
        // SAFETY: `index` is from `new` and deleted here alone.
        unsafe { pointmass_nanoflann_delete(self.index) }
    }
}

impl Peer for Nanoflann {
    fn name(&self) -> &'static str {
        "nanoflann"
    }

    fn build(&mut self, points: &[[f32; 3]], _: f32) {
        self.built = None;
        if !points.is_empty() {
            // SAFETY: three numbers a point are read and copied.
            let index = unsafe { pointmass_nanoflann_new(points.as_flattened().as_ptr(), points.len()) };
            self.built = Some(Built { index, points: points.len() });
        }
    }

    fn bytes(&self) -> Option<usize> {
        // SAFETY: the index lives.
        self.built.as_ref().map(|built| unsafe { pointmass_nanoflann_bytes(built.index) })
    }

    fn counts(&mut self, radius: f32, counts: &mut [u32]) -> bool {
        if let Some(built) = &self.built {
            let counts = &mut counts[..built.points];
            // SAFETY: one number is written for each point.
            unsafe { pointmass_nanoflann_counts(built.index, radius, counts.as_mut_ptr()) }
        }
        true
    }

    fn lists(&mut self, radius: f32) -> Option<u64> {
        // SAFETY: the index lives, and nothing else uses it meanwhile.
        Some(self.built.as_ref().map_or(0, |built| unsafe { pointmass_nanoflann_lists(built.index, radius) }))
    }

    fn pairs(&mut self, _: f32, _: &mut dyn FnMut(u32, u32)) -> Option<u64> {
        None
    }

    fn nearest(&mut self, k: usize, distances: &mut Vec<f32>) -> bool {
        if let Some(built) = &self.built {
            let (distances, k) = room(distances, built.points, k);
            // SAFETY: there are more than `k` points, and `k` numbers are written for each.
            unsafe { pointmass_nanoflann_nearest(built.index, k, distances.as_mut_ptr()) }
        }
        true
    }
}
