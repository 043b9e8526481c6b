//! Which kernel computes a case, as its file alone tells: memory and ranks depend on it before there is a model.

use slipfront::{FrictionLaw, Kernel};

use crate::case_file::{Attached, AttachedEdge, CaseFile, DriveSpeed, Motion, Outline};

/// The kernel that [`Kernel::for_model`] chooses for the model of this file.
pub(super) fn kernel(file: &CaseFile) -> Kernel {
    match beyond_fused(file) {
        None => Kernel::Fused,
        Some(_) => Kernel::Reference,
    }
}

/// The first key of this file that asks for what the fused kernel cannot compute.
pub(super) fn beyond_fused(file: &CaseFile) -> Option<&'static str> {
    let (slider, drive) = (&file.slider, &file.drive);
    let attached = match drive.attached {
        Attached::At(edge) => (edge != AttachedEdge::All, "drive.attach"),
        Attached::File(_) => (true, "drive.attach_file"),
    };
    let keys = [
        attached,
        (matches!(drive.speed, DriveSpeed::Program(_)), "drive.program"),
        (drive.motion != Motion::Translation, "drive.motion"),
        (file.friction.law != FrictionLaw::Projection, "friction.law"),
        (slider.outline != Outline::Rectangle, "slider.outline"),
        (slider.viscosity_time_star > 0.0, "slider.viscosity_time_star"),
        (slider.stiffness_field.is_some(), "slider.stiffness_field"),
        (slider.stiffness_grade.is_some(), "slider.stiffness_grade"),
        (slider.density_field.is_some(), "slider.density_field"),
        (slider.density_grade.is_some(), "slider.density_grade"),
    ];
    keys.into_iter()
        .find(|(is_asked, _)| *is_asked)
        .map(|(_, key)| key)
}
