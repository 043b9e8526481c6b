//! The rows of a rank, and beside them those that other ranks hold.

use std::ops::Range;
use std::sync::Arc;

use crate::communicator::Communicator;
use crate::lattice::{Bond, Edges, Lattice};
use crate::model::Model;
use crate::moduli::Moduli;
use crate::state::State;

/// The rows of a rank with the row below and the row above, if other ranks hold these: what the forces of the springs between blocks
/// are found from. Where there is one rank, all of the lattice.
pub(super) struct Rows {
    ranks: Arc<dyn Communicator>,
    /// Of these rows alone. Nothing is known beyond them, so that it ends there.
    pub(super) lattice: Lattice,
    /// Those of its blocks that this rank holds.
    pub(super) own: Range<usize>,
    /// Rows of the whole lattice, and the first of them that this rank holds.
    n_rows: usize,
    first_row: usize,
    beside: Option<Beside>,
}

/// What a rank knows of the rows beside its own.
struct Beside {
    /// Whether there is a row below, and one above.
    has: [bool; 2],
    /// Of all blocks of the rows.
    state: State,
}

impl Rows {
    pub(super) fn new(model: &Model, ranks: Arc<dyn Communicator>) -> Self {
        let (Lattice { nx, ny, edges }, rows) = (model.lattice, &model.rows);
        let whole = Self {
            ranks,
            lattice: model.lattice,
            own: 0..model.lattice.n_blocks(),
            n_rows: ny,
            first_row: rows.start,
            beside: None,
        };
        if whole.ranks.size() == 1 {
            return whole;
        }
        let has = [rows.start > 0, rows.end < ny].map(|inside| inside || edges[1] == Edges::Periodic);
        let [below, above] = has.map(usize::from);
        let lattice = Lattice::with_edges(nx, below + rows.len() + above, [edges[0], Edges::Free]);
        Self {
            lattice,
            own: lattice.blocks_of(&(below..below + rows.len())),
            beside: Some(Beside {
                has,
                state: State::at_rest(lattice.n_blocks()),
            }),
            ..whole
        }
    }

    pub(super) fn ranks(&self) -> &dyn Communicator {
        &*self.ranks
    }

    /// Takes over the motion of the blocks of this rank, and that of the rows beside them from the ranks that hold these.
    pub(super) fn exchange(&mut self, own: &State) {
        let Some(Beside { has, state }) = &mut self.beside else {
            return;
        };
        for (to, from) in components_mut(state).into_iter().zip(components(own)) {
            to[self.own.clone()].copy_from_slice(from);
        }
        let nx = self.lattice.nx;
        let row = |first: usize| components(own).map(|values| &values[first..first + nx]).concat();
        let mut to = [row(0), row(self.own.len() - nx)];
        for (row, has) in to.iter_mut().zip(*has) {
            row.truncate(if has { row.len() } else { 0 });
        }
        let mut from = to.each_ref().map(|row| vec![0.0; row.len()]);
        let [below, above] = &mut from;
        self.ranks
            .exchange(to.each_ref().map(|row| &**row), [below, above], &mut || ());
        for (row, first) in from.iter().zip([0, self.own.end]) {
            for (values, part) in components_mut(state).into_iter().zip(row.chunks(nx)) {
                values[first..first + nx].copy_from_slice(part);
            }
        }
    }

    /// The motion of all blocks of these rows, given that of the blocks of this rank.
    pub(super) fn state<'a>(&'a self, own: &'a State) -> &'a State {
        self.beside.as_ref().map_or(own, |beside| &beside.state)
    }

    /// What some blocks of this rank are among all blocks of these rows.
    #[inline(always)]
    pub(super) fn among_all(&self, blocks: &Range<usize>) -> Range<usize> {
        self.own.start + blocks.start..self.own.start + blocks.end
    }

    /// Blocks behind the first of this rank along a bond, which no blocks before it are: those of the row below, or where a periodic
    /// axis begins those of the last row.
    pub(super) fn behind(&self) -> Range<usize> {
        let last_row = self.lattice.block(0, self.lattice.ny - 1)..self.lattice.n_blocks();
        match self.lattice.edges[1] {
            Edges::Periodic => last_row,
            Edges::Free => 0..self.own.start,
        }
    }

    /// Stiffness of the spring from every block along `bond` over that of its bond; 0 of the blocks of the row above.
    pub(super) fn springs_along(&self, moduli: &Moduli, bond: &Bond) -> Vec<f64> {
        let Lattice { nx, ny, .. } = self.lattice;
        let (below, end) = (self.own.start / nx, self.own.end / nx);
        let row_of = |row: usize| -> Vec<f64> {
            if row >= end {
                return vec![0.0; nx];
            }
            let j = (self.first_row + self.n_rows + row - below) % self.n_rows;
            (0..nx).map(|i| moduli.spring([i, j], bond.offset)).collect()
        };
        (0..ny).flat_map(row_of).collect()
    }

    /// Sum of numbers of all rows of the whole lattice, of which `of_row` gives those of this rank: in the same order for any number of
    /// ranks, and so with the same bits.
    #[inline(always)]
    pub(super) fn sum(&self, of_row: impl FnMut(usize) -> f64) -> f64 {
        let mut bits = vec![0; self.n_rows];
        let rows = self.own.start / self.lattice.nx..self.own.end / self.lattice.nx;
        for (bits, number) in bits[self.first_row..].iter_mut().zip(rows.map(of_row)) {
            *bits = number.to_bits() as i64;
        }
        self.ranks.sum(&mut bits);
        bits.into_iter().map(|bits| f64::from_bits(bits as u64)).sum()
    }
}

fn components(state: &State) -> [&[f64]; 4] {
    let State {
        displacement,
        velocity,
    } = state;
    [&displacement.x, &displacement.y, &velocity.x, &velocity.y]
}

fn components_mut(state: &mut State) -> [&mut [f64]; 4] {
    let State {
        displacement,
        velocity,
    } = state;
    [
        &mut displacement.x,
        &mut displacement.y,
        &mut velocity.x,
        &mut velocity.y,
    ]
}
