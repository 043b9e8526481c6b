//! Which kernel computes a case, as its file alone tells: memory and ranks depend on it before there is a model.

use slipfront::{FrictionLaw, Kernel};

use crate::case_file::{Attached, AttachedEdge, CaseFile, DriveSpeed, Motion};

/// The kernel that [`Kernel::for_model`] chooses for the model of this file.
pub(super) fn kernel(file: &CaseFile) -> Kernel {
    let drive = &file.drive;
    let is_plain = file.friction.law == FrictionLaw::Projection
        && drive.attached == Attached::At(AttachedEdge::All)
        && drive.motion == Motion::Translation
        && !matches!(drive.speed, DriveSpeed::Program(_));
    if is_plain {
        Kernel::Fused
    } else {
        Kernel::Reference
    }
}
