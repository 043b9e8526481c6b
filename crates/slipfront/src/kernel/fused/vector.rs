//! Eight numbers at a time: plane vectors of eight blocks, and sums that do not depend on the processor.
//!
//! Every function is `#[inline(always)]`, so that it is compiled with the instructions of the width that the sweep was
//! entered with. Nothing here fuses a multiplication with an addition: all widths round alike.

use fearless_simd::{Select, Simd, SimdBase, SimdMask, f64x8, mask64x8};

/// Blocks in a vector, on every processor.
pub(super) const LANES: usize = 8;

/// A number for each of eight blocks.
pub(super) type Eight<S> = f64x8<S>;
/// A plane vector for each of eight blocks.
pub(super) type Plane<S> = [Eight<S>; 2];
/// Yes or no for each of eight blocks.
pub(super) type Mask<S> = mask64x8<S>;

#[inline(always)]
pub(super) fn splat<S: Simd>(simd: S, value: f64) -> Eight<S> {
    f64x8::splat(simd, value)
}

#[inline(always)]
pub(super) fn load<S: Simd>(simd: S, from: &[f64; LANES]) -> Eight<S> {
    f64x8::load_array_ref(simd, from)
}

/// Both components of eight blocks.
#[inline(always)]
pub(super) fn load_plane<S: Simd>(simd: S, [x, y]: [&[[f64; LANES]]; 2], chunk: usize) -> Plane<S> {
    [load(simd, &x[chunk]), load(simd, &y[chunk])]
}

#[inline(always)]
pub(super) fn mask<S: Simd>(simd: S, bits: u8) -> Mask<S> {
    mask64x8::from_bitmask(simd, u64::from(bits))
}

#[inline(always)]
pub(super) fn bits<S: Simd>(mask: Mask<S>) -> u8 {
    mask.to_bitmask() as u8
}

#[inline(always)]
pub(super) fn square<S: Simd>(a: Plane<S>) -> Eight<S> {
    a[0] * a[0] + a[1] * a[1]
}

#[inline(always)]
pub(super) fn dot<S: Simd>(a: Plane<S>, b: Plane<S>) -> Eight<S> {
    a[0] * b[0] + a[1] * b[1]
}

#[inline(always)]
pub(super) fn add<S: Simd>(a: Plane<S>, b: Plane<S>) -> Plane<S> {
    [a[0] + b[0], a[1] + b[1]]
}

#[inline(always)]
pub(super) fn subtract<S: Simd>(a: Plane<S>, b: Plane<S>) -> Plane<S> {
    [a[0] - b[0], a[1] - b[1]]
}

#[inline(always)]
pub(super) fn scale<S: Simd>(factor: Eight<S>, a: Plane<S>) -> Plane<S> {
    [factor * a[0], factor * a[1]]
}

#[inline(always)]
pub(super) fn is_zero<S: Simd>(simd: S, a: Plane<S>) -> Mask<S> {
    let zero = splat(simd, 0.0);
    a[0].simd_eq(zero) & a[1].simd_eq(zero)
}

#[inline(always)]
pub(super) fn select<S: Simd>(first: Mask<S>, one: Plane<S>, other: Plane<S>) -> Plane<S> {
    [first.select(one[0], other[0]), first.select(one[1], other[1])]
}

/// Where `kept`, else zero.
#[inline(always)]
pub(super) fn keep<S: Simd>(simd: S, kept: Mask<S>, a: Plane<S>) -> Plane<S> {
    let zero = splat(simd, 0.0);
    select(kept, a, [zero, zero])
}

/// The last block of `before` and the first seven of `a`.
#[inline(always)]
pub(super) fn behind<S: Simd>(before: Plane<S>, a: Plane<S>) -> Plane<S> {
    [before[0].slide::<7>(a[0]), before[1].slide::<7>(a[1])]
}

/// Sum of the eight, in pairs.
#[inline(always)]
pub(super) fn total<S: Simd>(v: Eight<S>) -> f64 {
    total_of(v.to_array())
}

#[inline(always)]
pub(super) fn total_of([a, b, c, d, e, f, g, h]: [f64; LANES]) -> f64 {
    ((a + e) + (c + g)) + ((b + f) + (d + h))
}

/// Largest of the eight.
#[inline(always)]
pub(super) fn largest<S: Simd>(v: Eight<S>) -> f64 {
    let [a, b, c, d, e, f, g, h] = v.to_array();
    a.max(b).max(c.max(d)).max(e.max(f).max(g.max(h)))
}
