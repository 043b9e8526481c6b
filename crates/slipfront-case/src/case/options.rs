//! The options of the model that a case file asks for: the memory that a run needs depends on them before there is a model.

use slipfront::{Friction, ModelOptions, SliderOptions};

use crate::case_file::{Attached, AttachedEdge, CaseFile, Motion, Outline};

/// The options of the model of a case file, with its law of friction.
pub(super) fn options(file: &CaseFile, friction: Friction) -> ModelOptions {
    let (slider, load) = (&file.slider, &file.load);
    ModelOptions {
        friction,
        slider: SliderOptions {
            has_moduli: slider.stiffness_field.is_some() || slider.stiffness_grade.is_some(),
            has_densities: slider.density_field.is_some() || slider.density_grade.is_some(),
            has_outline: slider.outline != Outline::Rectangle,
            drives_some: file.drive.attached != Attached::At(AttachedEdge::All),
            has_dampers: slider.viscosity_time_star > 0.0,
        },
        has_pressures: load.profile.is_some() || load.pressure_field.is_some(),
        rotates: file.drive.motion == Motion::Rotation,
    }
}

#[cfg(test)]
mod tests {
    use slipfront::{Kernel, Surface};

    use super::*;
    use crate::case::Case;

    /// The options of a file with one option set are those of the model made from it.
    #[test]
    fn options_are_those_of_the_model() {
        for set in [
            "friction.mu_static=0.5",
            "friction.law='reversal'",
            "friction={velocity={law='weakening',v_c_star=0.1,ratio=0.5}}",
            "friction={ageing={law='logarithmic',beta=0.1,time_star=1}}",
            "friction={contact='springs',contact_stiffness_star=0.1}",
            "friction={law='rate_and_state',a=0.01,b=0.02,d_c_star=0.5,v_0_star=0.03}",
            "slider.viscosity_time_star=0.1",
            "slider.outline='disc'",
            "slider.stiffness_grade={along='x',from=1,to=2}",
            "slider.density_grade={along='y',from=1,to=2}",
            "drive.attach='left'",
            "drive.motion='rotation'",
            "load.profile={along='x',relative_slope=0.5}",
        ] {
            let case = Case::parse("", "case", "", &[set.to_owned()]).unwrap();
            let friction = case.file.friction.in_model(case.groups.v_star, &case.scales);
            let (options, model) = (options(&case.file, friction), &case.model);
            assert_eq!(options.friction, model.friction, "{set}");
            let kernel = Kernel::Fused.for_model(model);
            assert_eq!(Kernel::Fused.for_options(&options), kernel, "{set}");
            // Bytes of the arrays that the model has.
            let (slider, surface) = (model.slider(), &model.surface);
            let bytes = |numbers: &Option<Vec<f64>>| numbers.as_ref().map_or(0, |numbers| 8 * numbers.len());
            let springs = slider
                .drive_springs
                .as_ref()
                .map(|springs| springs.relative.clone());
            let of_slider = bytes(&slider.stiffness)
                + bytes(&slider.density)
                + bytes(&springs)
                + slider.outline.as_ref().map_or(0, |outline| outline.exists.len());
            let n = surface.n_blocks();
            assert_eq!(n * options.slider.bytes_per_block(), of_slider, "{set}");
            assert_eq!(options.has_pressures, set.starts_with("load"), "{set}");
            let of_coefficients = 8 * (surface.mu_static.len() + surface.mu_kinetic.len());
            let of_surface = surface.textured.len() + of_coefficients;
            assert_eq!(n * Surface::bytes_per_block(false), of_surface, "{set}");
        }
    }
}
