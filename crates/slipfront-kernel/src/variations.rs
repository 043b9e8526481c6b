//! Heterogeneous sliders: springs, drive springs, masses and dead loads that differ from block to block.
//!
//! None of this is stored or computed if all blocks are equal: the sweep is compiled for both kinds of slider
//! ([`Geometry`]). An outline does not need it either: places outside are elements that are no blocks, and
//! their springs are masked.
//!
//! [`Geometry`]: super::springs::Geometry

use std::ops::Range;

use super::aligned::Aligned;
use super::layout::Layout;
use super::vector::Chunks;
use crate::properties::Properties;

/// Properties of the elements of a band.
#[derive(Debug)]
pub(crate) struct Variations {
    /// Stiffness of the springs to the east, north, north-east and north-west over the stiffness of their
    /// bonds; with the front halo.
    pub(crate) springs: [Aligned; 4],
    /// Stiffness of the drive springs over `k_s`.
    pub(crate) drive_springs: Aligned,
    pub(crate) mass: Aligned,
    // Stored in addition to the mass, to avoid a division for every block in every step.
    pub(crate) inverse_mass: Aligned,
    /// Dead load relative to that of [`Step`](super::step::Step), if it differs from block to block.
    pub(crate) loads: Option<Aligned>,
}

/// [`Variations`] of some elements, in vectors of eight; empty if all blocks are equal.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Variation<'a> {
    pub(crate) drive_springs: Chunks<'a>,
    pub(crate) mass: Chunks<'a>,
    pub(crate) inverse_mass: Chunks<'a>,
    /// Empty if all blocks have the same load.
    pub(crate) loads: Chunks<'a>,
}

impl<'a> Variation<'a> {
    /// The first `n` vectors, if there are any.
    #[inline(always)]
    pub(crate) fn first<const DIFFER: bool>(self, n: usize) -> Self {
        let n = if DIFFER { n } else { 0 };
        Self {
            drive_springs: &self.drive_springs[..n],
            mass: &self.mass[..n],
            inverse_mass: &self.inverse_mass[..n],
            loads: &self.loads[..n.min(self.loads.len())],
        }
    }
}

/// Largest factors of any block of the lattice.
#[derive(Clone, Copy, Debug)]
pub struct LargestFactors {
    /// Largest Young's modulus, and so the largest factor of a spring between blocks.
    pub modulus: f64,
    /// Largest relative stiffness of a drive spring.
    pub drive_spring: f64,
    /// Largest relative mass.
    pub mass: f64,
    /// Largest inverse of a relative mass.
    pub inverse_mass: f64,
    /// Largest dead load relative to that of [`Step`](super::step::Step).
    pub load: f64,
    /// Stiffness of the foundation under an interface; 0 without one.
    pub foundation: f64,
}

impl Variations {
    /// Variations of the elements from `first` on; the springs also of a `halo` of elements before.
    pub(crate) fn new(layout: &Layout, properties: &Properties, halo: usize, elements: Range<usize>) -> Self {
        let len = elements.len();
        let ones = || Aligned::filled(len, 1.0);
        let mut variations = Self {
            springs: [(); 4].map(|()| Aligned::filled(halo + len, 0.0)),
            drive_springs: ones(),
            mass: ones(),
            inverse_mass: ones(),
            loads: properties.dead_loads_differ.then(ones),
        };
        let before = elements.start as isize - halo as isize;
        for k in 0..halo + len {
            let factors = properties.springs(layout, before + k as isize);
            for (springs, factor) in variations.springs.iter_mut().zip(factors) {
                springs[k] = factor;
            }
        }
        for k in 0..len {
            if let Some(b) = layout.block(elements.start + k) {
                let block = properties.blocks.block(b);
                variations.drive_springs[k] = block.drive_spring;
                variations.mass[k] = block.mass;
                variations.inverse_mass[k] = 1.0 / block.mass;
                if let Some(loads) = &mut variations.loads {
                    loads[k] = block.relative_dead_load;
                }
            }
        }
        variations
    }
}

impl Variations {
    /// Variations of some elements, counted from the first of the band.
    #[inline(always)]
    pub(crate) fn slice(&self, elements: Range<usize>) -> Variation<'_> {
        let loads = self.loads.as_ref();
        Variation {
            loads: loads.map_or(&[], |loads| loads[elements.clone()].as_chunks().0),
            drive_springs: self.drive_springs[elements.clone()].as_chunks().0,
            mass: self.mass[elements.clone()].as_chunks().0,
            inverse_mass: self.inverse_mass[elements].as_chunks().0,
        }
    }
}
