//! Kernels in the registers of the machine that a program finds itself on.

#[cfg(one_by_one)]
use super::One;
use super::{BroadKernel, Kernel};

/// Runs a kernel in the widest registers that it is compiled for.
#[inline(always)]
pub(crate) fn run<K: Kernel>(kernel: K) -> K::Output {
    #[cfg(widest_found)]
    if let Some(avx2) = fearless_simd::Level::new().as_avx2() {
        return fearless_simd::Simd::vectorize(
            avx2,
            #[inline(always)]
            || kernel.run(super::avx2::Wide::zero(avx2)),
        );
    }
    kernel.run(wide::f32x8::ZERO)
}

/// The same for one that keeps more numbers at hand than there are registers, where there may be twice as many of these.
#[inline(always)]
pub(crate) fn run_at_length<K: Kernel>(kernel: K) -> K::Output {
    #[cfg(widest_found)]
    if let Some((avx512, avx2)) = fearless_simd::Level::new().as_avx512().zip(fearless_simd::Level::new().as_avx2()) {
        return fearless_simd::Simd::vectorize(
            avx512,
            #[inline(always)]
            || kernel.run(super::avx2::Wide::zero(avx2)),
        );
    }
    run(kernel)
}

#[cfg(test)]
std::thread_local! {
    /// True if this thread's kernels go over eight numbers at once, whatever registers hold.
    pub(crate) static NARROW: core::cell::Cell<bool> = const { core::cell::Cell::new(false) };
}

/// Runs a kernel on as many numbers at once as registers hold.
#[inline(always)]
pub(crate) fn run_broad<K: BroadKernel>(kernel: K) -> K::Output {
    #[cfg(test)]
    if NARROW.get() {
        return kernel.run(wide::f32x8::ZERO);
    }
    #[cfg(widest_found)]
    match (fearless_simd::Level::new().as_avx512(), fearless_simd::Level::new().as_avx2()) {
        (Some(avx512), Some(avx2)) => {
            return fearless_simd::Simd::vectorize(
                avx512,
                #[inline(always)]
                || kernel.run(super::avx512::Broad::zero(avx512, avx2)),
            );
        }
        (None, Some(avx2)) => {
            return fearless_simd::Simd::vectorize(
                avx2,
                #[inline(always)]
                || kernel.run(super::avx2::Wide::zero(avx2)),
            );
        }
        _ => {}
    }
    kernel.run(wide::f32x8::ZERO)
}

/// Calls a loop over columns that compilers make vectors of, compiled for the widest ones as well.
#[inline(always)]
pub(crate) fn widest<R>(f: impl FnOnce() -> R) -> R {
    #[cfg(widest_found)]
    if let Some(avx2) = fearless_simd::Level::new().as_avx2() {
        return fearless_simd::Simd::vectorize(avx2, f);
    }
    f()
}

/// Runs a kernel that goes over so many at a time in the first lanes.
#[inline(always)]
pub(crate) fn run_abreast<K: Kernel>(kernel: K) -> K::Output {
    #[cfg(one_by_one)]
    return kernel.run(One(0.0));
    #[cfg(not(one_by_one))]
    run(kernel)
}
