//! Intermediate results of a sweep, and the ring buffer of the springs between two rows.

use super::aligned::{Aligned, Vectors};
use super::layout::TILE;
use super::vector::LANES;

// A spring to the next row acts on the block at its lower end now, and on the block at its upper end a row
// later. It is computed once and kept in a ring buffer until then, the only intermediate result that is
// longer than a tile. For element k, its neighbours and the places of their springs are:
//
//   k-stride-1  k-stride  k-stride+1 ............ k ............ k+stride-1  k+stride  k+stride+1
//   springs from these to k, computed             its own,       the row above, which has moved
//   when the row below was the present one        computed now   before
//
//   | 0 .. 15 .......... behind ................. own ......................... | 0 .. 15 |
//                        read from here on        written, then read              mirror of the beginning
//
// Element k has the place k modulo the length of the ring. This length is a row and a block, a tile, and a
// vector for rounding to whole vectors, so that a tile overwrites nothing that it reads. Own places are whole
// vectors, so that none of them wraps around. Places behind begin anywhere, and may extend over the end: the
// mirror repeats the beginning there.
/// Intermediate results of a sweep over the tiles, which are not needed later.
#[derive(Debug, Default)]
pub(crate) struct Scratch {
    /// Forces of the latest springs to the next row: a ring buffer over the elements.
    pub(crate) upward: [Vectors; 3],
    /// Lattice forces `F_c` of the present tile.
    pub(crate) lattice: Vectors,
    /// Drive forces `F_s` of the present tile.
    pub(crate) drive: Vectors,
    /// Velocities without friction of the present tile.
    pub(crate) free: Vectors,
    /// Magnitudes of the velocities without friction of the present tile.
    pub(crate) free_speed: Aligned,
}

/// Number of elements that are repeated after the end of the ring buffer, for vectors that extend over the
/// end.
pub(crate) const MIRROR: usize = 2 * LANES;

/// Number of elements in the fewest whole vectors that hold `elements`.
pub(crate) fn whole_vectors(elements: usize) -> usize {
    elements.next_multiple_of(LANES)
}

impl Scratch {
    /// Room for a tile, with `stride` elements per row.
    pub(crate) fn new(stride: usize) -> Self {
        let ring = whole_vectors(stride + 1 + TILE + LANES) + MIRROR;
        Self {
            upward: [(); 3].map(|()| Vectors::zeros(ring)),
            lattice: Vectors::zeros(TILE),
            drive: Vectors::zeros(TILE),
            free: Vectors::zeros(TILE),
            free_speed: Aligned::filled(TILE, 0.0),
        }
    }

    /// Number of elements in the ring buffer.
    #[inline(always)]
    pub(crate) fn ring_buffer_len(&self) -> usize {
        self.upward[0].x.len() - MIRROR
    }

    /// Divides the elements `from..to` at the end of the ring buffer, where their own springs or those of the
    /// row below, `stride` elements before, wrap around: first element, end, and the two positions in the
    /// buffer.
    #[inline(always)]
    pub(crate) fn ring_segments(
        &self,
        stride: usize,
        from: usize,
        to: usize,
    ) -> impl Iterator<Item = (usize, usize, usize, usize)> + use<> {
        let ring = self.ring_buffer_len();
        let mut first = from;
        std::iter::from_fn(move || {
            if first >= to {
                return None;
            }
            let own = first % ring;
            let behind = (first + ring - stride - 1) % ring;
            // The row below is read from `behind` on, and from one and two elements after it.
            let room = (ring - own).min((ring + MIRROR - 2 - behind) / LANES * LANES);
            let end = to.min(first + room);
            Some((std::mem::replace(&mut first, end), end, own, behind))
        })
    }
}
