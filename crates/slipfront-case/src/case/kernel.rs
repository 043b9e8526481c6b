//! Which kernel computes a case, as its file alone tells: memory and ranks depend on it before there is a model.

use slipfront::Kernel;

use crate::case_file::{Attached, CaseFile, Contact, Law, Motion, Outline};

/// The kernel that [`Kernel::for_model`] chooses for the model of this file.
pub(super) fn kernel(file: &CaseFile) -> Kernel {
    match beyond_fused(file) {
        None => Kernel::Fused,
        Some(_) => Kernel::Reference,
    }
}

/// The first key of this file that asks for what ranks cannot share: what the fused kernel cannot compute, and blocks that differ, of
/// which the stable time step depends on the rows beside those of a rank.
pub(super) fn beyond_ranks(file: &CaseFile) -> Option<&'static str> {
    let (slider, drive) = (&file.slider, &file.drive);
    let keys = [
        (slider.outline != Outline::Rectangle, "slider.outline"),
        (slider.stiffness_field.is_some(), "slider.stiffness_field"),
        (slider.stiffness_grade.is_some(), "slider.stiffness_grade"),
        (slider.density_field.is_some(), "slider.density_field"),
        (slider.density_grade.is_some(), "slider.density_grade"),
        (matches!(drive.attached, Attached::File(_)), "drive.attach_file"),
        (drive.edge().is_some(), "drive.attach"),
    ];
    beyond_fused(file).or_else(|| first(&keys))
}

fn first(keys: &[(bool, &'static str)]) -> Option<&'static str> {
    keys.iter().find(|(is_asked, _)| *is_asked).map(|(_, key)| *key)
}

/// The first key of this file that asks for what the fused kernel cannot compute.
fn beyond_fused(file: &CaseFile) -> Option<&'static str> {
    let (slider, friction) = (&file.slider, &file.friction);
    let keys = [
        (friction.law != Law::Projection, "friction.law"),
        (friction.contact != Contact::Rigid, "friction.contact"),
        (friction.ageing.is_some(), "friction.ageing"),
        (slider.viscosity_time_star > 0.0, "slider.viscosity_time_star"),
        (file.drive.motion != Motion::Translation, "drive.motion"),
    ];
    first(&keys)
}
