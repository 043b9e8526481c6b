//! Friction coefficients of a case: drawn, or read from the files that it names.

use slipfront::Lattice;
use slipfront::surface::{Coefficients, Distribution};

use super::groups::Groups;
use super::inputs::Inputs;
use crate::arrays;
use crate::case_file::{CaseError, CaseFile};

pub(super) fn coefficients(
    file: &CaseFile,
    groups: &Groups,
    lattice: &Lattice,
    inputs: &Inputs,
) -> Result<Coefficients, CaseError> {
    let friction = &file.friction;
    let mean = friction.mu_static;
    let given = |key: &str, name: &Option<String>| -> Result<_, CaseError> {
        let read = |name: &String| {
            inputs.read(file, key, name, |path, source, slab| {
                arrays::field(path, source, slab)
            })
        };
        name.as_ref().map(read).transpose()
    };
    let mu_static = given("friction.mu_static_field", &friction.mu_static_field)?;
    let mu_kinetic = given("friction.mu_kinetic_field", &friction.mu_kinetic_field)?;
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
