//! The state in which a run of a case begins.

use slipfront::{Lattice, Scales, Slider, State};

use super::files::Watch;
use super::inputs::Inputs;
use crate::case_file::{CaseError, CaseFile, Loading};
use slipfront_base::number_format::four_digits;

/// Displacements and velocities of the blocks of these rows, in units of u* and V*; none if the case begins at
/// rest.
pub(super) fn state(
    file: &CaseFile,
    scales: &Scales,
    (lattice, slider): (&Lattice, &Slider),
    inputs: &Inputs,
    watch: &mut Watch,
) -> Result<Option<State>, CaseError> {
    let initial = &file.initial;
    let [displacements, velocities] = initial.files();
    if displacements.iter().chain(&velocities).all(|(_, name)| name.is_none()) {
        return Ok(None);
    }
    let unit = initial.displacement_unit.as_ref();
    let per_displacement = unit.map_or(1.0, |unit| unit.si() / scales.displacement());
    let unit = initial.velocity_unit.as_ref();
    let per_velocity = unit.map_or(1.0, |unit| unit.si() / scales.speed());
    let mut state = State::at_rest(inputs.slab.n_blocks());
    let first = inputs.slab.rows.start * lattice.nx;
    let State {
        displacement: u,
        velocity: v,
    } = &mut state;
    for ((key, name), values, factor) in [
        (displacements[0], &mut u.x, per_displacement),
        (displacements[1], &mut u.y, per_displacement),
        (velocities[0], &mut v.x, per_velocity),
        (velocities[1], &mut v.y, per_velocity),
    ] {
        let key = format!("initial.{key}");
        let Some(mut given) = inputs.read_signed_field(file, &key, name, watch)? else {
            continue;
        };
        given.iter_mut().for_each(|value| *value *= factor);
        let refuse = |is_wrong: &dyn Fn(usize) -> bool, why: &str| {
            let Some(b) = (0..given.len()).find(|&b| is_wrong(b)) else {
                return Ok(());
            };
            let (i, j) = lattice.column_row(first + b);
            let sentence = format!("block ({i}, {j}) has {} in units of the model: {why}", four_digits(given[b]));
            Err(file.source.error(&key, sentence))
        };
        refuse(
            &|b| !given[b].is_finite(),
            "it must be finite; look at the unit of the file",
        )?;
        refuse(
            &|b| given[b] != 0.0 && !slider.exists(b),
            "it does not exist, so that it must be 0; look at `slider.outline`",
        )?;
        if file.drive.loading == Loading::Held && key.starts_with("initial.velocity") {
            refuse(
                &|b| given[b] != 0.0,
                "a held drive begins over blocks at rest, so that it must be 0; leave velocities out, or take `drive.loading` = \"constant\"",
            )?;
        }
        *values = given;
    }
    Ok(Some(state))
}
