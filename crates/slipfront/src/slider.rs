//! What may differ from block to block of the slider, and its internal viscosity.

use std::ops::Range;

use crate::communicator::Communicator;
use crate::fixed_point::{FixedPoint, join, split};
use crate::lattice::{Bond, Edge, Lattice};

/// What may differ from block to block; arrays have one value per block. Without any of it, as in the paper, all blocks are alike.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Slider {
    /// Young's modulus `E_i/E`. A spring between blocks takes the harmonic mean of its ends.
    pub stiffness: Option<Vec<f64>>,
    /// Density, and so mass, `rho_i/rho`.
    pub density: Option<Vec<f64>>,
    /// Drive springs that are not all alike.
    pub drive_springs: Option<DriveSprings>,
    /// The blocks that exist, if some do not.
    pub outline: Option<Outline>,
    /// Time of the dampers beside all springs between blocks, `tau_v = eta_ij/k_ij` (Kelvin-Voigt); 0 for none.
    pub viscosity_time: f64,
}

/// Drive springs that are not all alike.
#[derive(Clone, Debug, PartialEq)]
pub struct DriveSprings {
    /// Stiffness of each over [`Drive::k_drive`](crate::Drive::k_drive); 0 for a block that is not driven.
    pub relative: Vec<f64>,
    /// Sum of these over the whole lattice.
    pub sum: f64,
}

/// The outline of a slider. Blocks outside have no mass, springs or load.
#[derive(Clone, Debug, PartialEq)]
pub struct Outline {
    /// Which blocks exist.
    pub exists: Vec<bool>,
    /// Number of these in the whole lattice.
    pub n_blocks: usize,
}

impl DriveSprings {
    /// Equal springs on the blocks of one edge of the lattice, for the rank that holds these `rows`.
    pub fn at_edge(lattice: &Lattice, rows: &Range<usize>, edge: Edge) -> Self {
        let relative = |b: usize| f64::from(u8::from(edge.distance(lattice, b) == 0));
        Self {
            relative: lattice.blocks_of(rows).map(relative).collect(),
            sum: edge.n_blocks(lattice) as f64,
        }
    }

    /// Of the blocks that this rank holds, called by all `ranks` at once: the sum has the same bits however many they are.
    pub fn new(relative: Vec<f64>, ranks: &dyn Communicator) -> Self {
        let mut largest = [relative.iter().copied().fold(0.0, f64::max)];
        ranks.largest(&mut largest);
        let fixed_point = FixedPoint::new(largest[0]);
        let mut words = split(fixed_point.sum(relative.len(), |b| relative[b]));
        ranks.sum(&mut words);
        Self {
            sum: fixed_point.value(join(words)),
            relative,
        }
    }
}

impl Outline {
    /// Of the blocks that this rank holds, called by all `ranks` at once.
    pub fn new(exists: Vec<bool>, ranks: &dyn Communicator) -> Self {
        let mut count = [exists.iter().filter(|&&exists| exists).count() as i64];
        ranks.sum(&mut count);
        Self {
            n_blocks: count[0] as usize,
            exists,
        }
    }
}

impl Slider {
    /// Mass of block `b`, in units of `rho l^3`.
    pub fn mass(&self, b: usize) -> f64 {
        self.density.as_ref().map_or(1.0, |density| density[b])
    }

    /// Stiffness of the drive spring of block `b` over that of [`Drive`](crate::Drive); 0 for a block that does not exist.
    pub fn drive_spring(&self, b: usize) -> f64 {
        let relative = self
            .drive_springs
            .as_ref()
            .map_or(1.0, |springs| springs.relative[b]);
        if self.exists(b) { relative } else { 0.0 }
    }

    /// Number of blocks of the whole lattice that exist.
    pub fn n_blocks(&self, lattice: &Lattice) -> usize {
        self.outline
            .as_ref()
            .map_or(lattice.n_blocks(), |outline| outline.n_blocks)
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

    /// Whether all springs between blocks are those of the paper.
    pub fn has_equal_springs(&self) -> bool {
        self.stiffness.is_none() && self.outline.is_none()
    }

    /// Stiffness of the spring between two blocks over that of its [`Bond`]: the harmonic mean of their moduli, `2 E_i E_j/(E_i + E_j)`;
    /// 0 if one of them does not exist.
    pub fn spring(&self, b: usize, other: usize) -> f64 {
        if !self.exists(b) || !self.exists(other) {
            return 0.0;
        }
        self.stiffness.as_ref().map_or(1.0, |modulus| {
            2.0 * modulus[b] * modulus[other] / (modulus[b] + modulus[other])
        })
    }

    /// [`spring`](Self::spring) from every block along `bond`; 0 where a free edge leaves it out.
    pub fn springs_along(&self, lattice: &Lattice, bond: &Bond) -> Vec<f64> {
        let along = |b: usize| {
            let (i, j) = lattice.column_row(b);
            lattice
                .neighbour(i, j, bond.offset)
                .map_or(0.0, |other| self.spring(b, other))
        };
        (0..lattice.n_blocks()).map(along).collect()
    }
}
