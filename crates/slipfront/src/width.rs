//! One binary for all processors: loops are compiled for several SIMD widths, and the widest that the processor has
//! is taken at run time.
//!
//! Every width does the same operations in the same order on the same numbers (no fused multiply-add, and sums run
//! over eight fixed lanes), so that the bits of a result do not depend on it.

/// How wide the loops of this process are compiled.
#[derive(Clone, Copy)]
pub(crate) enum Width {
    #[cfg(target_arch = "x86_64")]
    Avx512,
    #[cfg(target_arch = "x86_64")]
    Avx2,
    Baseline,
}

/// The widest that the processor has: the one decision, which is looked up and not made anew after the first time.
#[inline]
pub(crate) fn width() -> Width {
    #[cfg(target_arch = "x86_64")]
    {
        if is_x86_feature_detected!("avx512f")
            && is_x86_feature_detected!("avx512vl")
            && is_x86_feature_detected!("avx512dq")
            && is_x86_feature_detected!("avx512bw")
        {
            return Width::Avx512;
        }
        if is_x86_feature_detected!("avx2") {
            return Width::Avx2;
        }
    }
    Width::Baseline
}

/// Name of the SIMD width at which runs of this process are computed: `AVX-512`, `AVX2`, or `baseline` for what every
/// processor of its kind has. Results do not depend on it.
pub fn simd_width() -> &'static str {
    match width() {
        #[cfg(target_arch = "x86_64")]
        Width::Avx512 => "AVX-512",
        #[cfg(target_arch = "x86_64")]
        Width::Avx2 => "AVX2",
        Width::Baseline => "baseline",
    }
}

/// Calls a function, which must be `#[inline(always)]`, compiled for the widest instructions at hand.
macro_rules! widest {
    ($function:ident($($argument:ident: $kind:ty),* $(,)?) -> $result:ty) => {{
        #[cfg(target_arch = "x86_64")]
        #[target_feature(enable = "avx512f,avx512vl,avx512dq,avx512bw,avx2")]
        fn avx512($($argument: $kind),*) -> $result {
            $function($($argument),*)
        }
        #[cfg(target_arch = "x86_64")]
        #[target_feature(enable = "avx2")]
        fn avx2($($argument: $kind),*) -> $result {
            $function($($argument),*)
        }
        match $crate::width::width() {
            // SAFETY: the processor has been found to have these instructions.
            #[cfg(target_arch = "x86_64")]
            #[allow(unsafe_code)]
            $crate::width::Width::Avx512 => unsafe { avx512($($argument),*) },
            // SAFETY: as above.
            #[cfg(target_arch = "x86_64")]
            #[allow(unsafe_code)]
            $crate::width::Width::Avx2 => unsafe { avx2($($argument),*) },
            $crate::width::Width::Baseline => $function($($argument),*),
        }
    }};
}

pub(crate) use widest;
