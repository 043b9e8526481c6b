//! One binary for all processors: loops are compiled for several SIMD widths, and the widest that the processor has
//! is taken at run time.
//!
//! Every width does the same operations in the same order on the same numbers (no fused multiply-add, and sums run
//! over eight fixed lanes), so that the bits of a result do not depend on it.

/// Calls a function, which must be `#[inline(always)]`, compiled for the widest instructions at hand.
macro_rules! widest {
    ($function:ident($($argument:ident: $kind:ty),* $(,)?) -> $result:ty) => {
        'chosen: {
        #[cfg(target_arch = "x86_64")]
        {
            #[target_feature(enable = "avx512f,avx512vl,avx512dq,avx512bw,avx2")]
            fn avx512($($argument: $kind),*) -> $result {
                $function($($argument),*)
            }
            #[target_feature(enable = "avx2")]
            fn avx2($($argument: $kind),*) -> $result {
                $function($($argument),*)
            }
            if is_x86_feature_detected!("avx512f")
                && is_x86_feature_detected!("avx512vl")
                && is_x86_feature_detected!("avx512dq")
                && is_x86_feature_detected!("avx512bw")
            {
                // SAFETY: the processor has just been found to have these instructions.
                #[allow(unsafe_code)]
                break 'chosen unsafe { avx512($($argument),*) };
            }
            if is_x86_feature_detected!("avx2") {
                // SAFETY: as above.
                #[allow(unsafe_code)]
                break 'chosen unsafe { avx2($($argument),*) };
            }
        }
            $function($($argument),*)
        }
    };
}

pub(crate) use widest;
