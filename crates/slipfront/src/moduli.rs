//! Young's moduli of the blocks that a rank holds and of the neighbouring rows, and the springs that follow
//! from them.

use std::ops::Range;

use crate::communicator::Communicator;
use crate::lattice::{Edges, Lattice};
use crate::slider::Slider;

/// Moduli `E_i/E` of the blocks of some rows and of the rows below the first and above the last; 0 for blocks
/// that do not exist.
pub(crate) struct Moduli<'a> {
    slider: &'a Slider,
    lattice: Lattice,
    rows: Range<usize>,
    /// The row below and the row above, if other ranks hold them.
    beside: [Vec<f64>; 2],
}

impl<'a> Moduli<'a> {
    /// Moduli of the rows that this rank holds. All `ranks` must call this together, and exchange the moduli
    /// at the ends of their rows.
    pub(crate) fn new(
        slider: &'a Slider,
        lattice: &Lattice,
        rows: &Range<usize>,
        ranks: &dyn Communicator,
    ) -> Self {
        let mut moduli = Self {
            slider,
            lattice: *lattice,
            rows: rows.clone(),
            beside: Default::default(),
        };
        if ranks.size() == 1 || slider.has_equal_springs() {
            return moduli;
        }
        let wraps = lattice.edges[1] == Edges::Periodic;
        let has = [rows.start > 0 || wraps, rows.end < lattice.ny || wraps];
        let row = |side: usize| {
            let j = [rows.start, rows.end - 1][side];
            let columns = if has[side] { lattice.nx } else { 0 };
            (0..columns).map(|i| moduli.at(i, j)).collect::<Vec<f64>>()
        };
        let own = [row(0), row(1)];
        let mut beside = own.each_ref().map(|row| vec![0.0; row.len()]);
        let [below, above] = &mut beside;
        ranks.exchange(own.each_ref().map(|row| &**row), [below, above], &mut || ());
        moduli.beside = beside;
        moduli
    }

    /// Modulus of block (i, j) of the lattice, in these rows or next to them.
    pub(crate) fn at(&self, i: usize, j: usize) -> f64 {
        if self.slider.has_equal_springs() {
            return 1.0;
        }
        if self.rows.contains(&j) {
            return self.slider.modulus(self.lattice.block(i, j - self.rows.start));
        }
        let side = usize::from((j + 1) % self.lattice.ny != self.rows.start);
        self.beside[side].get(i).copied().unwrap_or(0.0)
    }

    /// Stiffness of the spring from block (i, j) of these rows to the block `offset` away, over the stiffness
    /// of its bond (see [`Slider::spring`]); 0 beyond a free edge.
    pub(crate) fn spring(&self, [i, j]: [usize; 2], offset: [isize; 2]) -> f64 {
        let Some(other) = self.lattice.neighbour(i, j, offset) else {
            return 0.0;
        };
        let (other_i, other_j) = self.lattice.column_row(other);
        let moduli = [self.at(i, j), self.at(other_i, other_j)];
        self.slider.spring(&self.lattice, [i, j], offset, moduli)
    }
}
