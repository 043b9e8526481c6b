//! The rows of a rank together with the rows beside them, which other ranks hold.

use std::ops::Range;
use std::sync::Arc;

use crate::communicator::Communicator;
use crate::lattice::{Bond, Edges, Lattice};
use crate::model::Model;
use crate::moduli::Moduli;
use crate::state::State;
use crate::vector_field::VectorField;

/// The blocks of a rank, and those of the row below and of the row above, if other ranks hold these: what the forces of the springs
/// between blocks are found from.
pub(super) struct Halo {
    ranks: Arc<dyn Communicator>,
    /// Of these rows alone. Nothing is known beyond them, so that it ends there.
    pub(super) lattice: Lattice,
    /// Whether there is a row below, and one above.
    has: [bool; 2],
    pub(super) state: State,
}

impl Halo {
    /// None where one rank holds the whole lattice.
    pub(super) fn new(model: &Model, ranks: &Arc<dyn Communicator>) -> Option<Self> {
        if ranks.size() == 1 {
            return None;
        }
        let (Lattice { nx, ny, edges }, rows) = (model.lattice, &model.rows);
        let has = [rows.start > 0, rows.end < ny].map(|inside| inside || edges[1] == Edges::Periodic);
        let n_beside = has.iter().filter(|&&has| has).count();
        let lattice = Lattice::with_edges(nx, rows.len() + n_beside, [edges[0], Edges::Free]);
        Some(Self {
            ranks: Arc::clone(ranks),
            lattice,
            has,
            state: State::at_rest(lattice.n_blocks()),
        })
    }

    /// Those of its rows that this rank holds.
    pub(super) fn own_rows(&self) -> Range<usize> {
        usize::from(self.has[0])..self.lattice.ny - usize::from(self.has[1])
    }

    /// Takes over the motion of the blocks of this rank, and that of the rows beside them from the ranks that hold these.
    pub(super) fn exchange(&mut self, state: &State) {
        let (nx, own) = (self.lattice.nx, self.own_rows());
        let blocks = self.lattice.blocks_of(&own);
        for (to, from) in components_mut(&mut self.state).into_iter().zip(components(state)) {
            to[blocks.clone()].copy_from_slice(from);
        }
        let row = |j: usize| -> Vec<f64> {
            let first = self.lattice.block(0, j);
            components(&self.state)
                .iter()
                .flat_map(|values| &values[first..first + nx])
                .copied()
                .collect()
        };
        let mut to = [row(own.start), row(own.end - 1)];
        for (row, has) in to.iter_mut().zip(self.has) {
            row.truncate(if has { row.len() } else { 0 });
        }
        let mut from = to.each_ref().map(|row| vec![0.0; row.len()]);
        let [below, above] = &mut from;
        self.ranks
            .exchange(to.each_ref().map(|row| &**row), [below, above], &mut || ());
        for (row, j) in from.iter().zip([0, own.end]) {
            let first = self.lattice.block(0, j);
            for (values, part) in components_mut(&mut self.state).into_iter().zip(row.chunks(nx)) {
                values[first..first + nx].copy_from_slice(part);
            }
        }
    }

    /// Keeps of the forces on all its blocks those on the blocks of this rank, at the beginning.
    pub(super) fn keep_own(&self, force: &mut VectorField) {
        let blocks = self.lattice.blocks_of(&self.own_rows());
        force.x.copy_within(blocks.clone(), 0);
        force.y.copy_within(blocks, 0);
    }

    /// [`Moduli::springs_along`] of the rows from which springs lead to a block of this rank, 0 of the row above.
    pub(super) fn springs_along(&self, moduli: &Moduli, model: &Model, bond: &Bond) -> Vec<f64> {
        let (Lattice { nx, ny, .. }, rows) = (model.lattice, &model.rows);
        let row_of = |j: usize| -> Vec<f64> {
            if j >= self.own_rows().end {
                return vec![0.0; nx];
            }
            let j = (rows.start + j + ny - self.own_rows().start) % ny;
            (0..nx).map(|i| moduli.spring([i, j], bond.offset)).collect()
        };
        (0..self.lattice.ny).flat_map(row_of).collect()
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
