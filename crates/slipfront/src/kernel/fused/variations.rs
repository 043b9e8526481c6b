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
use crate::communicator::Communicator;
use crate::lattice::{Bond, SpringStiffness};
use crate::model::Model;
use crate::moduli::Moduli;
use crate::sheets::Sheet;

/// Properties of the elements of a band.
#[derive(Debug)]
pub(super) struct Variations {
    /// Stiffness of the springs to the east, north, north-east and north-west over the stiffness of their
    /// bonds; with the front halo.
    pub(super) springs: [Aligned; 4],
    /// Stiffness of the drive springs over `k_s`.
    pub(super) drive_springs: Aligned,
    pub(super) mass: Aligned,
    // Stored in addition to the mass, to avoid a division for every block in every step.
    pub(super) inverse_mass: Aligned,
    /// Dead load relative to that of [`Step`](super::step::Step), if it differs from block to block.
    pub(super) loads: Option<Aligned>,
}

/// [`Variations`] of some elements, in vectors of eight; empty if all blocks are equal.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Variation<'a> {
    pub(super) drive_springs: Chunks<'a>,
    pub(super) mass: Chunks<'a>,
    pub(super) inverse_mass: Chunks<'a>,
    /// Empty if all blocks have the same load.
    pub(super) loads: Chunks<'a>,
}

impl<'a> Variation<'a> {
    /// The first `n` vectors, if there are any.
    #[inline(always)]
    pub(super) fn first<const DIFFER: bool>(self, n: usize) -> Self {
        let n = if DIFFER { n } else { 0 };
        Self {
            drive_springs: &self.drive_springs[..n],
            mass: &self.mass[..n],
            inverse_mass: &self.inverse_mass[..n],
            loads: &self.loads[..n.min(self.loads.len())],
        }
    }
}

/// Whether the blocks of a model need [`Variations`].
pub(crate) fn blocks_differ(model: &Model, largest: &LargestFactors) -> bool {
    let slider = &model.slider;
    // Drive springs of 1 on every existing block are those of a plain slider.
    let drive_springs_differ = slider
        .drive_springs
        .as_ref()
        .is_some_and(|springs| largest.drive_spring > 1.0 || springs.sum != model.n_blocks() as f64);
    slider.stiffness.is_some()
        || slider.halves_edge_springs
        || slider.density.is_some()
        || drive_springs_differ
        || model.dead_load.field.is_some()
        || model.friction.needs().varies
}

/// Largest factors of any block of the lattice.
#[derive(Clone, Copy, Debug)]
pub(crate) struct LargestFactors {
    /// Largest Young's modulus, and so the largest factor of a spring between blocks.
    pub(super) modulus: f64,
    pub(super) drive_spring: f64,
    pub(super) mass: f64,
    pub(super) inverse_mass: f64,
    /// Largest dead load relative to that of [`Step`](super::step::Step).
    pub(super) load: f64,
    /// Springs between the blocks of a sheet of relative thickness 1.
    pub(super) springs: SpringStiffness,
    /// Largest relative thickness of a sheet of a stack; 1 for a single sheet.
    pub(super) thickness: f64,
    /// Largest inverse of a relative thickness.
    pub(super) inverse_thickness: f64,
    /// Largest stiffness of the springs between two sheets; 0 for a single sheet.
    pub(super) coupling: f64,
    /// Largest stiffness of the springs of a block to the sheets above and below, over the thickness of its
    /// own sheet.
    pub(super) couplings_over_thickness: f64,
    /// Stiffness of the foundation under an interface; 0 without one.
    pub(super) foundation: f64,
}

impl LargestFactors {
    /// Largest factors of all blocks of all ranks, which must call this together.
    pub(crate) fn of(model: &Model, communicator: &dyn Communicator) -> Self {
        let slider = &model.slider;
        let largest = |differs: bool, value: &dyn Fn(usize) -> f64| {
            if differs {
                (0..model.surface.n_blocks()).map(value).fold(0.0, f64::max)
            } else {
                1.0
            }
        };
        let mut found = [
            largest(slider.stiffness.is_some(), &|b| slider.modulus(b)),
            largest(slider.drive_springs.is_some(), &|b| slider.drive_spring(b)),
            largest(slider.density.is_some(), &|b| slider.mass(b)),
            largest(slider.density.is_some(), &|b| 1.0 / slider.mass(b)),
            largest(model.dead_load.field.is_some(), &|b| {
                model.dead_load.relative(b).abs()
            }),
        ];
        communicator.largest(&mut found);
        let [modulus, drive_spring, mass, inverse_mass, load] = found;
        let of_sheets = |value: &dyn Fn(&Sheet) -> f64, lowest: f64| {
            model.sheets.iter().map(value).fold(lowest, f64::max)
        };
        // The springs between two sheets pull on both: at most two such sets act on a sheet.
        let coupling = of_sheets(&|sheet| sheet.coupling, 0.0);
        let inverse_thickness = of_sheets(&|sheet| 1.0 / sheet.thickness, 1.0);
        Self {
            springs: model.springs,
            thickness: of_sheets(&|sheet| sheet.thickness, 1.0),
            inverse_thickness,
            coupling,
            couplings_over_thickness: 2.0 * coupling * inverse_thickness,
            foundation: model
                .friction
                .interface()
                .map_or(0.0, |interface| interface.foundation),
            modulus,
            drive_spring,
            mass,
            inverse_mass,
            load,
        }
    }
}

impl Variations {
    /// Variations of the elements from `first` on; the springs also of a `halo` of elements before.
    pub(super) fn new(
        layout: &Layout,
        model: &Model,
        moduli: &Moduli,
        halo: usize,
        elements: Range<usize>,
    ) -> Self {
        let len = elements.len();
        let ones = || Aligned::filled(len, 1.0);
        let mut variations = Self {
            springs: [(); 4].map(|()| Aligned::filled(halo + len, 0.0)),
            drive_springs: ones(),
            mass: ones(),
            inverse_mass: ones(),
            loads: model.dead_load.field.as_ref().map(|_| ones()),
        };
        let before = elements.start as isize - halo as isize;
        for k in 0..halo + len {
            for (springs, factor) in
                variations
                    .springs
                    .iter_mut()
                    .zip(springs(moduli, layout, before + k as isize))
            {
                springs[k] = factor;
            }
        }
        for k in 0..len {
            if let Some(b) = layout.block(elements.start + k) {
                variations.drive_springs[k] = model.slider.drive_spring(b);
                variations.mass[k] = model.slider.mass(b);
                variations.inverse_mass[k] = 1.0 / model.slider.mass(b);
                if let Some(loads) = &mut variations.loads {
                    loads[k] = model.dead_load.relative(b);
                }
            }
        }
        variations
    }
}

impl Variations {
    /// Variations of some elements, counted from the first of the band.
    #[inline(always)]
    pub(super) fn of(&self, elements: Range<usize>) -> Variation<'_> {
        let loads = self.loads.as_ref();
        Variation {
            loads: loads.map_or(&[], |loads| loads[elements.clone()].as_chunks().0),
            drive_springs: self.drive_springs[elements.clone()].as_chunks().0,
            mass: self.mass[elements.clone()].as_chunks().0,
            inverse_mass: self.inverse_mass[elements].as_chunks().0,
        }
    }
}

/// Whether the springs of an element to the east, north, north-east and north-west exist.
pub(super) fn present(moduli: &Moduli, model: &Model, layout: &Layout, element: isize) -> [bool; 4] {
    match &model.slider.outline {
        None => layout.springs(element),
        // A spring to a place without a block has stiffness 0.
        Some(_) => springs(moduli, layout, element).map(|factor| factor > 0.0),
    }
}

/// Stiffness of the springs of an element over the stiffness of their bonds; 0 for missing springs.
fn springs(moduli: &Moduli, layout: &Layout, element: isize) -> [f64; 4] {
    let mut springs = [0.0; 4];
    if let Some(place) = layout.place(element) {
        for ((spring, bond), present) in springs.iter_mut().zip(Bond::ALL).zip(layout.springs(element)) {
            if present {
                *spring = moduli.spring(place, bond.offset);
            }
        }
    }
    springs
}
