//! Friction coefficients of a case: drawn, or read from the files that it names.

use slipfront::Lattice;
use slipfront::surface::{Coefficients, Distribution};

use super::groups::Groups;
use super::inputs::Inputs;
use crate::arrays;
use crate::case_file::{CaseError, CaseFile};

pub(super) fn coefficients(
    file: &mut CaseFile,
    groups: &Groups,
    lattice: &Lattice,
    inputs: &mut Inputs,
) -> Result<Coefficients, CaseError> {
    let mean = file.friction.mu_static;
    let mut given = |key: &str, name: &mut Option<String>, file: &CaseFile| -> Result<_, CaseError> {
        let Some(written) = name.as_ref() else {
            return Ok(None);
        };
        let given = inputs.read(file, key, written, lattice)?;
        let field = arrays::field(&given.path, &given.bytes, lattice.nx, lattice.ny)
            .map_err(|error| file.source.error(key, error.to_string()))?;
        *name = Some(inputs.keep(file, given)?);
        Ok(Some(field))
    };
    let (mut static_name, mut kinetic_name) = (
        file.friction.mu_static_field.clone(),
        file.friction.mu_kinetic_field.clone(),
    );
    let mu_static = given("friction.mu_static_field", &mut static_name, file)?;
    let mu_kinetic = given("friction.mu_kinetic_field", &mut kinetic_name, file)?;
    file.friction.mu_static_field = static_name;
    file.friction.mu_kinetic_field = kinetic_name;
    // A given field takes the place of its draws; the other stream is not shifted by it.
    let spread = |mean: f64, sigma_star: f64, given: bool| Distribution {
        mean,
        deviation: if given { 0.0 } else { sigma_star * mean },
    };
    let mut drawn = Coefficients::draw(
        lattice.n_blocks(),
        spread(mean, groups.sigma_static_star, mu_static.is_some()),
        spread(
            groups.r_star * mean,
            groups.sigma_kinetic_star,
            mu_kinetic.is_some(),
        ),
        file.friction.seed,
    );
    drawn.mu_static = mu_static.unwrap_or(drawn.mu_static);
    drawn.mu_kinetic = mu_kinetic.unwrap_or(drawn.mu_kinetic);
    Ok(drawn)
}
