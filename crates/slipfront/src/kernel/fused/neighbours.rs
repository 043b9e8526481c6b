//! The rows next to those of a rank, which other ranks hold.

use std::sync::Arc;

use slipfront_kernel::Layout;

use crate::communicator::Communicator;

/// Displacements of the row below the first row of this rank and of the row above the last, ghosts included;
/// none beyond a free edge.
#[derive(Debug)]
pub(super) struct Neighbours {
    pub(super) communicator: Arc<dyn Communicator>,
    /// The first and the last row of this rank, which are sent to the ranks below and above.
    pub(super) own: [Vec<[f64; 2]>; 2],
    /// The rows of the ranks below and above.
    rows: [Vec<[f64; 2]>; 2],
    /// Rows of the ranks below and above before the latest exchange.
    before: [Vec<[f64; 2]>; 2],
    /// Elements of the neighbouring rows that have moved in the latest exchange, counted
    /// from the first element of this rank.
    pub(super) moved: Vec<isize>,
}

impl Neighbours {
    pub(super) fn new(communicator: Arc<dyn Communicator>, layout: &Layout) -> Self {
        let rows = || {
            layout
                .has_neighbours()
                .map(|has| vec![[0.0; 2]; if has { layout.stride } else { 0 }])
        };
        Self {
            communicator,
            own: rows(),
            rows: rows(),
            before: rows(),
            moved: Vec::with_capacity(2 * layout.stride),
        }
    }

    /// Whether this rank holds the whole lattice.
    pub(super) fn is_alone(&self) -> bool {
        self.communicator.size() == 1
    }

    /// Sends the rows in `own` to the neighbours and receives theirs, while `meanwhile` runs.
    pub(super) fn exchange(&mut self, layout: &Layout, meanwhile: &mut dyn FnMut()) {
        // Reuses the memory of the exchange before the latest.
        std::mem::swap(&mut self.rows, &mut self.before);
        let [below, above] = &mut self.rows;
        self.communicator.exchange(
            self.own.each_ref().map(|row| row.as_flattened()),
            [below.as_flattened_mut(), above.as_flattened_mut()],
            meanwhile,
        );
        self.moved.clear();
        let firsts = [-(layout.stride as isize), layout.n_elements() as isize];
        for (first, (row, before)) in firsts.into_iter().zip(self.rows.iter().zip(&self.before)) {
            for (element, (u, before)) in (first..).zip(row.iter().zip(before).take(layout.stride)) {
                // Compared with the previous exchange, so that the other rank need not send which elements
                // moved.
                if u != before {
                    self.moved.push(element);
                }
            }
        }
    }

    /// Displacement of an element in the row below or above, counted from the first element of this rank.
    pub(super) fn displacement(&self, layout: &Layout, element: isize) -> Option<[f64; 2]> {
        let ([below, above], stride) = (&self.rows, layout.stride);
        let (row, k) = match element {
            ..0 => (below, stride.checked_add_signed(element)?),
            _ => (above, (element as usize).checked_sub(layout.n_elements())?),
        };
        row.get(k).copied()
    }
}
