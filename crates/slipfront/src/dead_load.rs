//! The dead load: constant forces on the blocks, whatever their motion.

use std::ops::Range;

use crate::communicator::Communicator;
use crate::slider::Slider;
use slipfront_kernel::fixed_point::sum_over;

/// Constant forces on the blocks from t = 0 on, in addition to the drive springs: a shear stress that loads
/// the contact without a spring.
///
/// ```
/// use slipfront::DeadLoad;
/// let load = DeadLoad::uniform([0.5, 0.0]);
/// assert!(load.acts() && !DeadLoad::default().acts());
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
pub struct DeadLoad {
    /// Force along x and y on every block, in units of `P mu_s l^2`.
    pub force: [f64; 2],
    /// Forces that differ from block to block.
    pub field: Option<LoadField>,
}

/// Forces of a [`DeadLoad`] that differ from block to block.
#[derive(Clone, Debug, PartialEq)]
pub struct LoadField {
    /// Ratio of the force on each block that this rank holds to [`DeadLoad::force`]; 0 where no block exists.
    pub relative: Vec<f64>,
    /// Sum of the relative forces over the whole lattice.
    pub sum: f64,
}

impl DeadLoad {
    /// Dead load with the same force along x and y on every block, in units of `P mu_s l^2`.
    pub fn uniform(force: [f64; 2]) -> Self {
        Self { force, field: None }
    }

    /// A force along x and y, in units of `P mu_s l^2`, times a `relative` force for each block of a slider
    /// that this rank holds. All `ranks` must call this together.
    pub fn of_blocks(
        force: [f64; 2],
        mut relative: Vec<f64>,
        slider: &Slider,
        ranks: &dyn Communicator,
    ) -> Self {
        for (b, relative) in relative.iter_mut().enumerate() {
            if !slider.exists(b) {
                *relative = 0.0;
            }
        }
        let sum = sum_over(ranks, relative.len(), |b| relative[b]);
        Self {
            force,
            field: Some(LoadField { relative, sum }),
        }
    }

    /// Whether any force acts.
    pub fn acts(&self) -> bool {
        self.force != [0.0, 0.0]
    }

    /// Ratio of the force on block `b`, which must exist, to [`force`](Self::force).
    pub fn relative(&self, b: usize) -> f64 {
        self.field.as_ref().map_or(1.0, |field| field.relative[b])
    }

    /// Forces on some of the blocks.
    pub(crate) fn of_some_blocks(&self, blocks: &Range<usize>) -> Self {
        let field = self.field.as_ref().map(|field| LoadField {
            relative: field.relative[blocks.clone()].to_vec(),
            sum: field.sum,
        });
        Self {
            force: self.force,
            field,
        }
    }
}
