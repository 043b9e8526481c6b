//! The state in which a run of a case begins.

use super::inputs::Inputs;
use crate::arrays;
use crate::case_file::{CaseError, CaseFile, FileUse, Loading};
use slipfront::{Scales, Slider, State};
use slipfront_base::number_format::four_digits;

/// Displacements and velocities of the blocks of these rows, in units of u* and V*; none if the case begins
/// at rest.
pub(super) fn state(inputs: &mut Inputs, slider: &Slider) -> Result<Option<State>, CaseError> {
    let file = inputs.file;
    if file.initial.is_at_rest() {
        return Ok(None);
    }
    let mut state = State::at_rest(inputs.slab.n_blocks());
    let State {
        displacement: u,
        velocity: v,
    } = &mut state;
    let components = [&mut u.x, &mut u.y, &mut v.x, &mut v.y];
    let given = given(inputs)?;
    for ((number, (key, mut given)), values) in given.into_iter().enumerate().zip(components) {
        let is_velocity = number >= 2;
        let factor = over_units_of_model(file, inputs.scales)[usize::from(is_velocity)];
        given.iter_mut().for_each(|value| *value *= factor);
        check(inputs, (&key, &given), is_velocity, slider)?;
        if !given.is_empty() {
            *values = given;
        }
    }
    Ok(Some(state))
}

/// Displacements along x and y, and velocities along both, in the units of the files, each with its key;
/// without numbers where all are 0.
fn given(inputs: &mut Inputs) -> Result<[(String, Vec<f64>); 4], CaseError> {
    let initial = &inputs.file.initial;
    if let Some(name) = &initial.state_file {
        let (key, slab) = ("initial.state_file", inputs.slab.clone());
        let of_run = inputs.read(key, name, FileUse::State, |path, source| {
            arrays::state_npy(path, source, &slab)
        })?;
        return Ok(of_run.map(|values| (key.to_owned(), values)));
    }
    let [[ux, uy], [vx, vy]] = initial.files();
    let mut read = |(key, name): (&str, &Option<String>)| -> Result<_, CaseError> {
        let key = format!("initial.{key}");
        let values = inputs.read_signed_field(&key, name)?;
        Ok((key, values.unwrap_or_default()))
    };
    Ok([read(ux)?, read(uy)?, read(vx)?, read(vy)?])
}

/// The values 1 of displacement and velocity in the files, in units of the model: the last state of a run is
/// in metres and metres per second.
fn over_units_of_model(file: &CaseFile, scales: &Scales) -> [f64; 2] {
    let (initial, units) = (&file.initial, [scales.displacement(), scales.speed()]);
    if initial.state_file.is_some() {
        return units.map(|unit| 1.0 / unit);
    }
    let displacement = initial
        .displacement_unit
        .as_ref()
        .map(|unit| unit.si() / units[0]);
    let velocity = initial.velocity_unit.as_ref().map(|unit| unit.si() / units[1]);
    [displacement, velocity].map(|factor| factor.unwrap_or(1.0))
}

/// Refuses initial values that no block can have.
fn check(
    inputs: &Inputs,
    (key, values): (&str, &[f64]),
    is_velocity: bool,
    slider: &Slider,
) -> Result<(), CaseError> {
    let (file, lattice) = (inputs.file, inputs.lattice);
    let is_held = is_velocity && file.drive.loading == Loading::Held;
    let wrong: [(&dyn Fn(usize) -> bool, &str); 3] = [
        (
            &|b| !values[b].is_finite(),
            "it must be finite; check the unit of the file",
        ),
        (
            &|b| values[b] != 0.0 && !slider.exists(b),
            "it does not exist, so its value must be 0; check `slider.outline`",
        ),
        (
            &|b| values[b] != 0.0 && is_held,
            "a held drive starts with blocks at rest, so its velocity must be 0; use `drive.loading` = \"constant\", or start \
             without velocities",
        ),
    ];
    for (is_wrong, why) in wrong {
        if let Some(b) = (0..values.len()).find(|&b| is_wrong(b)) {
            let (i, j) = lattice.column_row(inputs.slab.rows.start * lattice.nx + b);
            let sentence = format!(
                "block ({i}, {j}) has {} in units of the model: {why}",
                four_digits(values[b])
            );
            return Err(file.source.error(key, sentence));
        }
    }
    Ok(())
}
