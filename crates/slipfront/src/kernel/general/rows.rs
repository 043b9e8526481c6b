//! The rows of a band, and the neighbouring rows that other bands or ranks hold.

use std::ops::Range;

use crate::forces::{part, part_mut};
use crate::lattice::{Bond, Edges, Lattice};
use crate::model::Model;
use crate::moduli::Moduli;
use crate::state::State;
use crate::vector_field::VectorField;

/// The rows of a band, and the row below and the row above if other bands hold these: the input for the
/// forces of the springs between blocks. With one band, all rows of the lattice.
pub(super) struct Rows {
    /// Lattice of these rows, with free ends.
    pub(super) lattice: Lattice,
    /// Blocks of this lattice that the band holds.
    own: Range<usize>,
    /// Rows of the whole lattice, and the first row that this band holds.
    n_rows: usize,
    first_row: usize,
    beside: Option<Beside>,
}

/// Data of a band about the rows next to its own.
struct Beside {
    /// Whether there is a row below, and one above.
    has: [bool; 2],
    /// Displacements of all blocks of the rows; velocities only with dampers.
    state: State,
    has_dampers: bool,
}

impl Rows {
    pub(super) fn new(model: &Model) -> Self {
        let (Lattice { nx, ny, edges }, rows) = (model.lattice, &model.rows);
        let whole = Self {
            lattice: model.lattice,
            own: 0..model.lattice.n_blocks(),
            n_rows: ny,
            first_row: rows.start,
            beside: None,
        };
        if rows.len() == ny {
            return whole;
        }
        let has = [rows.start > 0, rows.end < ny].map(|inside| inside || edges[1] == Edges::Periodic);
        let ([below, above], has_dampers) = (has.map(usize::from), model.slider.is_viscous());
        let lattice = Lattice::with_edges(nx, below + rows.len() + above, [edges[0], Edges::Free]);
        Self {
            lattice,
            own: lattice.blocks_of(&(below..below + rows.len())),
            beside: Some(Beside {
                has,
                state: State {
                    displacement: VectorField::zeros(lattice.n_blocks()),
                    velocity: VectorField::zeros(if has_dampers { lattice.n_blocks() } else { 0 }),
                },
                has_dampers,
            }),
            ..whole
        }
    }

    /// Rows of this lattice that the band holds.
    pub(super) fn own_rows(&self) -> Range<usize> {
        self.own.start / self.lattice.nx..self.own.end / self.lattice.nx
    }

    /// Copies the motion of some blocks of this band.
    #[inline(always)]
    pub(super) fn take_over(&mut self, own: &State, blocks: &Range<usize>) {
        // Copied into the array of the neighbouring rows, so that springs find both ends in one array; a
        // single band reads its own state.
        let among_all = self.among_all(blocks);
        if let Some(Beside {
            state, has_dampers, ..
        }) = &mut self.beside
        {
            for (to, from) in fields_mut(state, *has_dampers).zip(fields(own, *has_dampers)) {
                let [to_x, to_y] = part_mut(to, &among_all);
                let [x, y] = part(from, blocks);
                to_x.copy_from_slice(x);
                to_y.copy_from_slice(y);
            }
        }
    }

    /// Adds the motion of the first and the last row of this band to `ends`, one component after the other,
    /// for the bands below and above; nothing for a missing band.
    pub(super) fn read_ends(&self, own: &State, ends: &mut [Vec<f64>; 2]) {
        let Some(Beside { has, has_dampers, .. }) = &self.beside else {
            return;
        };
        let nx = self.lattice.nx;
        for ((end, first), has) in ends.iter_mut().zip([0, self.own.len() - nx]).zip(has) {
            if *has {
                for values in fields(own, *has_dampers).flat_map(|field| [&field.x, &field.y]) {
                    end.extend_from_slice(&values[first..first + nx]);
                }
            }
        }
    }

    /// Sets the motion of the row below and of the row above, see [`read_ends`](Self::read_ends).
    pub(super) fn set_beside(&mut self, rows: [&[f64]; 2]) {
        let (nx, firsts) = (self.lattice.nx, [0, self.own.end]);
        let Some(Beside {
            state, has_dampers, ..
        }) = &mut self.beside
        else {
            return;
        };
        for (row, first) in rows.into_iter().zip(firsts) {
            let components = fields_mut(state, *has_dampers).flat_map(|field| [&mut field.x, &mut field.y]);
            for (values, part) in components.zip(row.chunks(nx)) {
                values[first..first + nx].copy_from_slice(part);
            }
        }
    }

    /// The motion of all blocks of these rows, given the motion of the blocks of this band.
    pub(super) fn state<'a>(&'a self, own: &'a State) -> &'a State {
        self.beside.as_ref().map_or(own, |beside| &beside.state)
    }

    /// Place of some blocks of this band among all blocks of these rows.
    #[inline(always)]
    pub(super) fn among_all(&self, blocks: &Range<usize>) -> Range<usize> {
        self.own.start + blocks.start..self.own.start + blocks.end
    }

    /// Blocks behind the first of this band along a bond that are not earlier blocks of this band: those of
    /// the row below, or at the beginning of a periodic axis those of the last row.
    pub(super) fn behind(&self) -> Range<usize> {
        let last_row = self.lattice.block(0, self.lattice.ny - 1)..self.lattice.n_blocks();
        match self.lattice.edges[1] {
            Edges::Periodic => last_row,
            Edges::Free => 0..self.own.start,
        }
    }

    /// Stiffness of the spring from every block along `bond` over the stiffness of the bond; 0 for the blocks
    /// of the row above.
    pub(super) fn springs_along(&self, moduli: &Moduli, bond: &Bond) -> Vec<f64> {
        let Lattice { nx, ny, .. } = self.lattice;
        let Range { start: below, end } = self.own_rows();
        let row_of = |row: usize| -> Vec<f64> {
            if row >= end {
                return vec![0.0; nx];
            }
            let j = (self.first_row + self.n_rows + row - below) % self.n_rows;
            (0..nx).map(|i| moduli.spring([i, j], bond.offset)).collect()
        };
        let mut springs = Vec::with_capacity(nx * ny);
        (0..ny).for_each(|row| springs.extend(row_of(row)));
        springs
    }
}

/// Fields that determine the forces between blocks: displacements, and velocities with dampers.
#[inline(always)]
fn fields(state: &State, has_dampers: bool) -> impl Iterator<Item = &VectorField> {
    std::iter::once(&state.displacement).chain(has_dampers.then_some(&state.velocity))
}

/// Fields that determine the forces between blocks, to be filled.
#[inline(always)]
fn fields_mut(state: &mut State, has_dampers: bool) -> impl Iterator<Item = &mut VectorField> {
    std::iter::once(&mut state.displacement).chain(has_dampers.then_some(&mut state.velocity))
}
