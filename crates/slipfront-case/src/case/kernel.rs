//! Which kernel computes a case, as its file alone tells: memory and ranks depend on it before there is a model.

use slipfront::{FrictionLaw, Kernel};

use crate::case_file::CaseFile;

/// The kernel that [`Kernel::for_model`] chooses for the model of this file.
pub(super) fn kernel(file: &CaseFile) -> Kernel {
    match file.friction.law {
        FrictionLaw::Projection => Kernel::Fused,
        _ => Kernel::Reference,
    }
}
