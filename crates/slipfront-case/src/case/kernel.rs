//! Which kernel computes a case, as its file alone tells: memory and ranks depend on it before there is a model.

use slipfront::Kernel;

use crate::case_file::{CaseFile, Contact, Law};

/// The kernel that [`Kernel::for_model`] chooses for the model of this file.
pub(super) fn kernel(file: &CaseFile) -> Kernel {
    let friction = &file.friction;
    let is_plain = friction.law == Law::Projection
        && friction.contact == Contact::Rigid
        && friction.velocity.is_none()
        && friction.ageing.is_none();
    if is_plain {
        Kernel::Fused
    } else {
        Kernel::Reference
    }
}
