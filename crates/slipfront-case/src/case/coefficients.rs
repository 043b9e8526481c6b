//! Friction coefficients of a case, drawn or read from the files that it names, and what makes thresholds of them.

use slipfront::surface::{Adhesion, Coefficients, Contact, Distribution, Load, pressure_along};
use slipfront::{Lattice, Scales};

use super::groups::Groups;
use super::inputs::Inputs;
use crate::case_file::{CaseError, CaseFile};

pub(super) fn coefficients(
    file: &CaseFile,
    groups: &Groups,
    lattice: &Lattice,
    inputs: &Inputs,
) -> Result<Coefficients, CaseError> {
    let friction = &file.friction;
    let mean = friction.mu_static;
    let mu_static = inputs.read_field(file, "friction.mu_static_field", &friction.mu_static_field)?;
    let mu_kinetic = inputs.read_field(file, "friction.mu_kinetic_field", &friction.mu_kinetic_field)?;
    // A given field takes the place of its draws; the other stream is not shifted by it.
    let spread = |mean: f64, sigma_star: f64, given: bool| Distribution {
        mean,
        deviation: if given { 0.0 } else { sigma_star * mean },
    };
    let mut drawn = Coefficients::draw_blocks(
        lattice.blocks_of(&inputs.slab.rows),
        spread(mean, groups.sigma_static_star, mu_static.is_some()),
        spread(
            groups.r_star * mean,
            groups.sigma_kinetic_star,
            mu_kinetic.is_some(),
        ),
        friction.seed,
    );
    drawn.mu_static = mu_static.unwrap_or(drawn.mu_static);
    drawn.mu_kinetic = mu_kinetic.unwrap_or(drawn.mu_kinetic);
    Ok(drawn)
}

/// Load and adhesion.
pub(super) fn contact(
    file: &CaseFile,
    scales: &Scales,
    lattice: &Lattice,
    inputs: &Inputs,
) -> Result<Contact, CaseError> {
    let load = if file.load.redistribute {
        Load::Redistributed
    } else {
        Load::Kept
    };
    let given = inputs.read_field(file, "load.pressure_field", &file.load.pressure_field)?;
    let pressure = match &file.load.profile {
        Some(profile) => Some(pressure_along(
            lattice,
            inputs.slab.rows.clone(),
            profile.along as usize,
            profile.relative_slope,
        )),
        None => given,
    };
    let [of_static, of_kinetic] = [&file.friction.adhesion, &file.friction.adhesion_kinetic]
        .map(|strength| strength.si() / scales.stress());
    Ok(Contact {
        pressure,
        adhesion: Adhesion {
            of_static,
            of_kinetic,
        },
        ..Contact::new(load, scales.mu_static_mean)
    })
}
