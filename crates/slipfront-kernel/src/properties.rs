//! Properties of a slider, about which the kernel asks when it lays out its arrays.

use crate::lattice::Bond;
use crate::layout::Layout;
use crate::thresholds::ChangingLaw;

/// Properties of a place of the lattice with its block.
#[derive(Clone, Copy, Debug)]
pub struct Block {
    /// Whether there is a block at this place.
    pub exists: bool,
    /// Whether the block has no contact with the substrate.
    pub is_textured: bool,
    /// Static threshold `mu_s F_n`.
    pub static_limit: f64,
    /// Kinetic friction `mu_k F_n` at rest.
    pub kinetic_force: f64,
    /// Normal force `F_n` of the load.
    pub normal_force: f64,
    /// Mass over that of a plain block.
    pub mass: f64,
    /// Stiffness of the drive spring over `k_s`.
    pub drive_spring: f64,
    /// Dead load over that of [`Step`](crate::Step).
    pub relative_dead_load: f64,
    /// Displacement and velocity at the start; none at rest.
    pub motion: Option<[[f64; 2]; 2]>,
}

/// The blocks of a slider. They have the indices of [`Layout::block`].
pub trait Blocks: Sync {
    /// Properties of a block.
    fn block(&self, block: usize) -> Block;

    /// Stiffness of the spring from the block in a column and row to the one `offset` away over the stiffness
    /// of its bond; 0 where there is none.
    fn spring(&self, column_row: [usize; 2], offset: [isize; 2]) -> f64;
}

/// Properties of a slider.
pub struct Properties<'a> {
    /// Properties of each block.
    pub blocks: &'a dyn Blocks,
    /// Whether springs, masses or loads differ from block to block.
    pub blocks_differ: bool,
    /// Whether dead loads differ from block to block.
    pub dead_loads_differ: bool,
    /// Whether some places of the lattice have no block.
    pub has_gaps: bool,
    /// Law by which thresholds change; none where they are constant.
    pub changing: Option<ChangingLaw>,
    /// Stiffness of the foundation of an interface; none where friction acts in the plane.
    pub foundation: Option<f64>,
    /// Change of velocity per force of a plain block, `dt/(m c+)`.
    pub force_to_velocity: f64,
}

impl Properties<'_> {
    /// Whether the springs of an element to the east, north, north-east and north-west exist.
    pub(crate) fn has_springs(&self, layout: &Layout, element: isize) -> [bool; 4] {
        if self.has_gaps {
            // A spring to a place without a block has stiffness 0.
            self.springs(layout, element).map(|factor| factor > 0.0)
        } else {
            layout.springs(element)
        }
    }

    /// Stiffness of the springs of an element over the stiffness of their bonds; 0 for missing springs.
    pub(crate) fn springs(&self, layout: &Layout, element: isize) -> [f64; 4] {
        let mut springs = [0.0; 4];
        if let Some(place) = layout.place(element) {
            for ((spring, bond), present) in springs.iter_mut().zip(Bond::ALL).zip(layout.springs(element)) {
                if present {
                    *spring = self.blocks.spring(place, bond.offset);
                }
            }
        }
        springs
    }
}
