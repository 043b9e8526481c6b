//! Which kernel computes a case, as its file alone tells: memory and ranks depend on it before there is a model.

use slipfront::Kernel;

use crate::case_file::{CaseFile, Contact, Law, Motion};

/// The kernel that [`Kernel::for_model`] chooses for the model of this file.
pub(super) fn kernel(file: &CaseFile) -> Kernel {
    match beyond_fused(file) {
        None => Kernel::Fused,
        Some(_) => Kernel::Reference,
    }
}

/// The first key of this file that asks for what the fused kernel cannot compute.
pub(super) fn beyond_fused(file: &CaseFile) -> Option<&'static str> {
    let (slider, friction) = (&file.slider, &file.friction);
    let keys = [
        (friction.law != Law::Projection, "friction.law"),
        (friction.contact != Contact::Rigid, "friction.contact"),
        (friction.ageing.is_some(), "friction.ageing"),
        (slider.viscosity_time_star > 0.0, "slider.viscosity_time_star"),
        (file.drive.motion != Motion::Translation, "drive.motion"),
    ];
    keys.into_iter()
        .find(|(is_asked, _)| *is_asked)
        .map(|(_, key)| key)
}
