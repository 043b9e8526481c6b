//! The blocks of a band in a sheet above the lowest one.

use super::aligned::{Vectors, chunks};
use super::blocks::Sums;
use super::pull::Above;
use super::scratch::Scratch;
use crate::properties::Sheet;

/// The elements of a band in a sheet above the lowest one.
#[derive(Debug)]
pub struct UpperSheet {
    /// Thickness and coupling.
    pub sheet: Sheet,
    /// Displacements at t_n, with halos.
    pub displacement: Vectors,
    /// Velocities at t_n + dt/2.
    pub velocity: Vectors,
    /// Springs of the sheet, and their sums in the present tile.
    pub(crate) scratch: Scratch,
    /// Sums over the tiles in the latest sweep.
    pub sums: Sums<i128, f64, u64>,
    /// Energy of the springs to the sheet below times 2, in quanta, at steps at which energies are needed.
    pub energy_below: i128,
}

impl UpperSheet {
    /// A sheet at rest with the given numbers of elements per row, in a band, and in a halo.
    pub fn new(sheet: Sheet, stride: usize, len: usize, halo: usize) -> Self {
        Self {
            sheet,
            displacement: Vectors::zeros(halo + len + halo),
            velocity: Vectors::zeros(len),
            scratch: Scratch::of_springs(stride),
            sums: Sums::default(),
            energy_below: 0,
        }
    }

    /// Blocks of the sheet above those of the sheet below, at some elements, counted from the front halo.
    #[inline(always)]
    pub(crate) fn above(&self, first: usize, n: usize) -> Above<'_> {
        Above {
            coupling: self.sheet.coupling,
            displacement: chunks(&self.displacement, first, n),
        }
    }

    /// Force of the sheet on a block below it at displacement `below`; `k`: index of the displacements.
    pub fn pull_on(&self, k: usize, below: [f64; 2]) -> [f64; 2] {
        let above = self.displacement.at(k);
        [0, 1].map(|axis| self.sheet.coupling * (above[axis] - below[axis]))
    }
}
