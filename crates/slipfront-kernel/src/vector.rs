//! Plane vectors of eight blocks at a time.
//!
//! Every function is `#[inline(always)]`, so that it is compiled for the vector width of its caller.
//! Multiplications and additions are never fused, so that all widths give the same bits.

use fearless_simd::{Level, Select, Simd, SimdBase, SimdMask, f64x8, i64x8, mask64x8};

/// Number of blocks in a vector, on every processor.
pub const LANES: usize = 8;

/// A plane vector, `[x, y]`, for each of eight blocks.
pub(crate) type Vec2x8<S> = [f64x8<S>; 2];

/// One number per element, in vectors of eight.
pub(crate) type Chunks<'a> = &'a [[f64; LANES]];
pub(crate) type ChunksMut<'a> = &'a mut [[f64; LANES]];

#[inline(always)]
pub(crate) fn splat<S: Simd>(simd: S, value: f64) -> f64x8<S> {
    f64x8::splat(simd, value)
}

#[inline(always)]
pub(crate) fn load<S: Simd>(simd: S, from: &[f64; LANES]) -> f64x8<S> {
    f64x8::load_array_ref(simd, from)
}

/// Both components of eight blocks.
#[inline(always)]
pub(crate) fn load_vec2<S: Simd>(simd: S, [x, y]: [&[[f64; LANES]]; 2], chunk: usize) -> Vec2x8<S> {
    [load(simd, &x[chunk]), load(simd, &y[chunk])]
}

#[inline(always)]
pub(crate) fn mask<S: Simd>(simd: S, bits: u8) -> mask64x8<S> {
    mask64x8::from_bitmask(simd, u64::from(bits))
}

/// One bit per lane. Where a vector is two registers, their masks are narrowed to one: compilers need more
/// instructions to join the bits of both.
#[inline(always)]
pub(crate) fn bits<S: Simd>(simd: S, mask: mask64x8<S>) -> u8 {
    if <S::f64s as SimdBase<S>>::LEN == LANES / 2 {
        let (low, high) = simd.split_mask64x8(mask);
        simd.narrow_mask64x4(low, high).to_bitmask() as u8
    } else {
        mask.to_bitmask() as u8
    }
}

#[inline(always)]
pub(crate) fn square<S: Simd>(a: Vec2x8<S>) -> f64x8<S> {
    a[0] * a[0] + a[1] * a[1]
}

#[inline(always)]
pub(crate) fn dot<S: Simd>(a: Vec2x8<S>, b: Vec2x8<S>) -> f64x8<S> {
    a[0] * b[0] + a[1] * b[1]
}

#[inline(always)]
pub(crate) fn add<S: Simd>(a: Vec2x8<S>, b: Vec2x8<S>) -> Vec2x8<S> {
    [a[0] + b[0], a[1] + b[1]]
}

#[inline(always)]
pub(crate) fn subtract<S: Simd>(a: Vec2x8<S>, b: Vec2x8<S>) -> Vec2x8<S> {
    [a[0] - b[0], a[1] - b[1]]
}

#[inline(always)]
pub(crate) fn scale<S: Simd>(factor: f64x8<S>, a: Vec2x8<S>) -> Vec2x8<S> {
    [factor * a[0], factor * a[1]]
}

#[inline(always)]
pub(crate) fn is_zero<S: Simd>(simd: S, a: Vec2x8<S>) -> mask64x8<S> {
    let zero = splat(simd, 0.0);
    a[0].simd_eq(zero) & a[1].simd_eq(zero)
}

#[inline(always)]
pub(crate) fn select<S: Simd>(first: mask64x8<S>, one: Vec2x8<S>, other: Vec2x8<S>) -> Vec2x8<S> {
    [first.select(one[0], other[0]), first.select(one[1], other[1])]
}

/// `a` where the mask is set, else zero.
#[inline(always)]
pub(crate) fn or_zero<S: Simd>(simd: S, mask: mask64x8<S>, a: Vec2x8<S>) -> Vec2x8<S> {
    let zero = splat(simd, 0.0);
    select(mask, a, [zero, zero])
}

/// Replaces components below `least` by zero of the same sign; keeps NaN.
#[inline(always)]
pub(crate) fn or_zero_below<S: Simd>(simd: S, least: f64, [x, y]: Vec2x8<S>) -> Vec2x8<S> {
    let (least, zero) = (splat(simd, least), splat(simd, 0.0));
    [
        x.abs().simd_lt(least).select(zero * x, x),
        y.abs().simd_lt(least).select(zero * y, y),
    ]
}

/// Shifts `a` by one block: the last of `before` and the first seven of `a`.
#[inline(always)]
pub(crate) fn shift_in<S: Simd>(before: Vec2x8<S>, a: Vec2x8<S>) -> Vec2x8<S> {
    [before[0].slide::<7>(a[0]), before[1].slide::<7>(a[1])]
}

/// Sum of the eight integers, modulo 2^64.
#[inline(always)]
pub(crate) fn lane_sum<S: Simd>(v: i64x8<S>) -> i64 {
    let [a, b, c, d, e, f, g, h] = v.to_array();
    let pairs = [
        a.wrapping_add(e),
        c.wrapping_add(g),
        b.wrapping_add(f),
        d.wrapping_add(h),
    ];
    pairs.into_iter().fold(0, i64::wrapping_add)
}

/// Largest of the eight numbers.
#[inline(always)]
pub(crate) fn lane_max<S: Simd>(v: f64x8<S>) -> f64 {
    let [a, b, c, d, e, f, g, h] = v.to_array();
    a.max(b).max(c.max(d)).max(e.max(f).max(g.max(h)))
}

/// Does work whose loops the compiler turns into vectors of two or four numbers. They are as fast as vectors
/// of eight in the passes of the general kernel, which wait for memory.
#[inline(always)]
pub fn vectorized<R>(level: Level, work: impl FnOnce() -> R) -> R {
    #[cfg(target_arch = "x86_64")]
    if let Some(avx2) = level.as_avx2() {
        return avx2.vectorize(work);
    }
    #[cfg(not(target_arch = "x86_64"))]
    let _ = level;
    work()
}
