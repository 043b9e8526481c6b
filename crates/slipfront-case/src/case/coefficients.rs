//! Friction coefficients of a case: drawn, or read from the files that it names.

use slipfront::Lattice;
use slipfront::surface::{Coefficients, Distribution};

use super::groups::Groups;
use super::inputs::Inputs;
use crate::arrays;
use crate::case_file::{CaseError, CaseFile, Friction};

pub(super) fn coefficients(
    file: &mut CaseFile,
    groups: &Groups,
    lattice: &Lattice,
    inputs: &mut Inputs,
) -> Result<Coefficients, CaseError> {
    let mean = file.friction.mu_static;
    let mut given = |key: &str, name: fn(&mut Friction) -> &mut Option<String>| -> Result<_, CaseError> {
        let Some(written) = name(&mut file.friction).clone() else {
            return Ok(None);
        };
        let given = inputs.read(file, key, &written, lattice)?;
        let field = arrays::field(&given.original, &given.bytes, lattice.nx, lattice.ny)
            .map_err(|error| file.source.error(key, error.to_string()))?;
        let kept = inputs.keep(file, given)?;
        *name(&mut file.friction) = Some(inputs.kept[kept].name.clone());
        Ok(Some(field))
    };
    let mu_static = given("friction.mu_static_field", |friction| {
        &mut friction.mu_static_field
    })?;
    let mu_kinetic = given("friction.mu_kinetic_field", |friction| {
        &mut friction.mu_kinetic_field
    })?;
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
