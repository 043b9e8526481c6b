//! Heterogeneous properties of the slider, its outline, and its internal viscosity.

use std::ops::Range;

use crate::communicator::Communicator;
use crate::lattice::{Edge, Lattice, harmonic_mean};
use slipfront_kernel::fixed_point::sum_over;

/// Heterogeneous properties of the slider; arrays have one value per block. Without any of them, as in the
/// paper, all blocks are equal.
#[derive(Clone, Debug, PartialEq)]
pub struct Slider {
    /// Young's modulus `E_i/E`. A spring between two blocks has the harmonic mean of their moduli.
    pub stiffness: Option<Vec<f64>>,
    /// Density, and thus mass, `rho_i/rho`.
    pub density: Option<Vec<f64>>,
    /// Mean mass of all existing blocks of the whole lattice, in units of `rho l^3`.
    pub mean_mass: f64,
    /// Mean time in which a wave passes a block, over all existing blocks of the whole lattice,
    /// `sqrt(rho_i E/(rho E_i))`, relative to a block of `E` and `rho`.
    pub mean_slowness: f64,
    /// Drive springs of different stiffness.
    pub drive_springs: Option<DriveSprings>,
    /// Whether some existing blocks of the whole lattice have no drive spring.
    pub drives_some: bool,
    /// Outline of the slider, if some blocks do not exist.
    pub outline: Option<Outline>,
    /// Time `tau_v = eta_ij/k_ij` of the dampers in parallel with all springs between blocks (Kelvin-Voigt);
    /// 0 for none.
    pub viscosity_time: f64,
    /// Whether the springs along a free edge of the lattice are half as stiff as those inside, as in a
    /// continuum divided into squares between four blocks. They are not in the paper.
    pub halves_edge_springs: bool,
}

/// Drive springs of different stiffness.
#[derive(Clone, Debug, PartialEq)]
pub struct DriveSprings {
    /// Stiffness of each drive spring over [`Drive::k_drive`](crate::Drive::k_drive); 0 for a block that is
    /// not driven.
    pub relative: Vec<f64>,
    /// Sum of the relative stiffness over the whole lattice.
    pub sum: f64,
}

/// The outline of a slider. Blocks outside have no mass, springs or load.
#[derive(Clone, Debug, PartialEq)]
pub struct Outline {
    /// Whether each block exists.
    pub exists: Vec<bool>,
    /// Number of existing blocks in the whole lattice.
    pub n_blocks: usize,
}

impl Default for Slider {
    fn default() -> Self {
        Self {
            stiffness: None,
            density: None,
            mean_mass: 1.0,
            mean_slowness: 1.0,
            drive_springs: None,
            drives_some: false,
            outline: None,
            viscosity_time: 0.0,
            halves_edge_springs: false,
        }
    }
}

impl DriveSprings {
    /// Drive springs of the blocks that this rank holds. All `ranks` must call this together: the sum has the
    /// same bits for any number of ranks.
    pub fn new(relative: Vec<f64>, ranks: &dyn Communicator) -> Self {
        Self {
            sum: sum_over(ranks, relative.len(), |b| relative[b]),
            relative,
        }
    }
}

impl Outline {
    /// The outline of the blocks that this rank holds. All `ranks` must call this together.
    pub fn new(exists: Vec<bool>, ranks: &dyn Communicator) -> Self {
        Self {
            n_blocks: ranks.sum_of(exists.iter().filter(|&&exists| exists).count()),
            exists,
        }
    }

    /// Marks the blocks of some rows that belong to the largest disc in the lattice: those with centres
    /// within half the shorter side from the middle.
    ///
    /// ```
    /// use slipfront::{Lattice, Outline};
    /// let disc = Outline::disc(&Lattice::free(4, 4), 0..4);
    /// let corners = [0, 3, 12, 15];
    /// assert!((0..16).all(|b| disc[b] != corners.contains(&b)));
    /// ```
    pub fn disc(lattice: &Lattice, rows: Range<usize>) -> Vec<bool> {
        let (nx, ny) = (lattice.nx as isize, lattice.ny as isize);
        let diameter = nx.min(ny);
        // Twice the distances from the middle are integers.
        let distance = |place: usize, count: isize| 2 * place as isize + 1 - count;
        let is_inside = |b: usize| {
            let (i, j) = lattice.column_row(b);
            distance(i, nx).pow(2) + distance(j, ny).pow(2) <= diameter.pow(2)
        };
        lattice.blocks_of(&rows).map(is_inside).collect()
    }
}

impl Slider {
    /// A slider with the given moduli, densities and outline of the blocks that this rank holds. All `ranks`
    /// must call this together. The drive spring of each block is proportional to its modulus:
    /// `k_s,i = k_s E_i/E`.
    pub fn new(
        stiffness: Option<Vec<f64>>,
        mut density: Option<Vec<f64>>,
        outline: Option<Outline>,
        ranks: &dyn Communicator,
    ) -> Self {
        if let (Some(density), Some(outline)) = (&mut density, &outline) {
            // No force acts on missing blocks, but 0/0 with a mass of 0 would be NaN.
            let outside = density.iter_mut().zip(&outline.exists);
            outside
                .filter(|(_, exists)| !**exists)
                .for_each(|(density, _)| *density = 1.0);
        }
        let mut slider = Self {
            stiffness,
            density,
            outline,
            ..Self::default()
        };
        let stiffness = slider.stiffness.as_ref().map(Vec::len);
        if let Some(n) = stiffness.or(slider.density.as_ref().map(Vec::len)) {
            let sum = |of: &dyn Fn(usize) -> f64| {
                sum_over(ranks, n, |b| if slider.exists(b) { of(b) } else { 0.0 })
            };
            let blocks = sum(&|_| 1.0);
            let mean_mass = sum(&|b| slider.mass(b)) / blocks;
            let mean_slowness = sum(&|b| (slider.mass(b) / slider.modulus(b)).sqrt()) / blocks;
            (slider.mean_mass, slider.mean_slowness) = (mean_mass, mean_slowness);
        }
        if let Some(n) = stiffness.or(slider.outline.as_ref().map(|outline| outline.exists.len())) {
            let relative = (0..n).map(|b| slider.modulus(b)).collect();
            slider.drive_springs = Some(DriveSprings::new(relative, ranks));
        }
        slider
    }

    /// A property that changes linearly along an axis, at the centre of every block of some rows: `from` at
    /// the edge where the axis begins, `to` at the other edge.
    ///
    /// ```
    /// use slipfront::{Lattice, Slider};
    /// assert_eq!(Slider::grade(&Lattice::free(2, 2), 0..2, 0, [1.0, 3.0]), [1.5, 2.5, 1.5, 2.5]);
    /// assert_eq!(Slider::grade(&Lattice::free(2, 2), 1..2, 1, [1.0, 3.0]), [2.5, 2.5]);
    /// ```
    pub fn grade(lattice: &Lattice, rows: Range<usize>, axis: usize, [from, to]: [f64; 2]) -> Vec<f64> {
        let count = [lattice.nx, lattice.ny][axis];
        // Computed from integers, so that the opposite grade is the mirror image to the last bit.
        let at = |place: usize| {
            let (before, behind) = (2 * place + 1, 2 * (count - place) - 1);
            (from * behind as f64 + to * before as f64) / (2 * count) as f64
        };
        let columns = |j: usize| (0..lattice.nx).map(move |i| at([i, j][axis]));
        rows.flat_map(columns).collect()
    }

    /// Panics unless these are the properties of `n` blocks, with drive springs only on existing blocks.
    pub(crate) fn assert_fits(&self, n: usize) {
        let (springs, outline) = (self.drive_springs.as_ref(), self.outline.as_ref());
        for (what, length) in [
            ("moduli", self.stiffness.as_ref().map(Vec::len)),
            ("densities", self.density.as_ref().map(Vec::len)),
            ("drive springs", springs.map(|springs| springs.relative.len())),
            (
                "flags of the outline",
                outline.map(|outline| outline.exists.len()),
            ),
        ] {
            if let Some(length) = length {
                assert_eq!(
                    length, n,
                    "the slider has {length} {what} for {n} blocks: give one each"
                );
            }
        }
        let pulls_nothing =
            |b: usize| !self.exists(b) && springs.is_none_or(|springs| springs.relative[b] != 0.0);
        if let Some(b) = (0..n).find(|&b| pulls_nothing(b)) {
            panic!(
                "block {b} does not exist, but has a drive spring: make the slider by `Slider::new`, which takes it away"
            );
        }
    }

    /// Properties of some of the blocks.
    pub(crate) fn of_some_blocks(&self, blocks: &Range<usize>) -> Self {
        let part = |values: &Vec<f64>| values[blocks.clone()].to_vec();
        Self {
            stiffness: self.stiffness.as_ref().map(part),
            density: self.density.as_ref().map(part),
            drive_springs: self.drive_springs.as_ref().map(|springs| DriveSprings {
                relative: part(&springs.relative),
                sum: springs.sum,
            }),
            outline: self.outline.as_ref().map(|outline| Outline {
                exists: outline.exists[blocks.clone()].to_vec(),
                n_blocks: outline.n_blocks,
            }),
            ..*self
        }
    }

    /// Number of existing blocks of the whole lattice.
    pub fn n_blocks(&self, lattice: &Lattice) -> usize {
        self.outline
            .as_ref()
            .map_or(lattice.n_blocks(), |outline| outline.n_blocks)
    }

    /// Mass of block `b`, in units of `rho l^3`.
    pub fn mass(&self, b: usize) -> f64 {
        self.density.as_ref().map_or(1.0, |density| density[b])
    }

    /// Stiffness of the drive spring of block `b` over that of [`Drive`](crate::Drive); 0 for a missing
    /// block.
    pub fn drive_spring(&self, b: usize) -> f64 {
        match &self.drive_springs {
            _ if !self.exists(b) => 0.0,
            Some(springs) => springs.relative[b],
            None => 1.0,
        }
    }

    /// Young's modulus `E_i/E` of block `b`; 0 if it does not exist.
    pub fn modulus(&self, b: usize) -> f64 {
        match &self.stiffness {
            _ if !self.exists(b) => 0.0,
            Some(stiffness) => stiffness[b],
            None => 1.0,
        }
    }

    /// Removes the drive springs from all blocks that this rank holds except those for which `is_attached` is
    /// true. All `ranks` must call this together.
    pub fn attach(&mut self, n_blocks: usize, is_attached: impl Fn(usize) -> bool, ranks: &dyn Communicator) {
        let relative = |b: usize| if is_attached(b) { self.drive_spring(b) } else { 0.0 };
        let without = (0..n_blocks).filter(|&b| self.exists(b) && !is_attached(b));
        let n_without = ranks.sum_of(without.count());
        let springs = DriveSprings::new((0..n_blocks).map(relative).collect(), ranks);
        (self.drive_springs, self.drives_some) = (Some(springs), n_without > 0);
    }

    /// Attaches drive springs only to the blocks of one edge of the lattice, on the rank that holds these
    /// `rows`: see [`attach`](Self::attach).
    pub fn attach_edge(
        &mut self,
        lattice: &Lattice,
        rows: &Range<usize>,
        edge: Edge,
        ranks: &dyn Communicator,
    ) {
        let blocks = lattice.blocks_of(rows);
        let is_at_edge = |b: usize| edge.distance(lattice, blocks.start + b) == 0;
        self.attach(blocks.len(), is_at_edge, ranks);
    }

    /// Sum of [`drive_spring`](Self::drive_spring) over the whole lattice.
    pub fn sum_of_drive_springs(&self, lattice: &Lattice) -> f64 {
        self.drive_springs
            .as_ref()
            .map_or(self.n_blocks(lattice) as f64, |springs| springs.sum)
    }

    /// Whether block `b` exists.
    pub fn exists(&self, b: usize) -> bool {
        self.outline.as_ref().is_none_or(|outline| outline.exists[b])
    }

    /// Whether there are dampers in parallel with the springs between blocks.
    pub fn is_viscous(&self) -> bool {
        self.viscosity_time > 0.0
    }

    /// Whether all springs between blocks are those of the paper.
    pub fn has_equal_springs(&self) -> bool {
        self.stiffness.is_none() && self.outline.is_none() && !self.halves_edge_springs
    }

    /// Stiffness of the spring from block (i, j) of the lattice to the block `offset` away, from these
    /// moduli, over the stiffness of its bond: the harmonic mean of the moduli, and half of it along a free
    /// edge if [`halves_edge_springs`](Self::halves_edge_springs) is set.
    pub(crate) fn spring(
        &self,
        lattice: &Lattice,
        place: [usize; 2],
        offset: [isize; 2],
        moduli: [f64; 2],
    ) -> f64 {
        let mean = harmonic_mean(moduli[0], moduli[1]);
        if self.halves_edge_springs && lattice.is_along_edge(place, offset) {
            0.5 * mean
        } else {
            mean
        }
    }
}
