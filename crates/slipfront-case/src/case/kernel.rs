//! Which kernel computes a case, as its file alone tells: the memory that a run needs depends on it before there is a model.

use slipfront::Kernel;

use crate::case_file::{CaseFile, Contact, Law, Motion};

/// The kernel that [`Kernel::for_model`] chooses for the model of this file.
pub(super) fn kernel(file: &CaseFile) -> Kernel {
    let (slider, friction) = (&file.slider, &file.friction);
    let is_swept = friction.law == Law::Projection
        && friction.contact == Contact::Rigid
        && friction.ageing.is_none()
        && slider.viscosity_time_star == 0.0
        && file.drive.motion == Motion::Translation;
    if is_swept { Kernel::Fused } else { Kernel::General }
}
