//! Labels of quantities in pictures, as in `slipfront plot` and studies.

use numpy::PyReadonlyArray2;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use slipfront_case::case_file::Motion;
use slipfront_case::field_info::field_named;
use slipfront_plot::{FIRST_SLIP, FrictionAxes, SLIDING_SHARE};
use slipfront_run::pictures::friction::dimensionless_axes;
use slipfront_run::pictures::{title_of_field as titled, title_of_place};

use crate::case::Case;

/// The title of a number of runs; its name if it has none.
#[pyfunction]
pub(crate) fn title(quantity: &str) -> String {
    slipfront_study::title(quantity)
}

/// Titles in pictures of a run of a slider that is pulled or turned, by the columns of its series, its fields
/// and its kymograph. The character after an underscore is a subscript.
#[pyfunction]
pub(crate) fn titles_of_run(is_rotation: bool) -> [(&'static str, String); 5] {
    let FrictionAxes { x, friction, .. } = dimensionless_axes(is_rotation);
    let motion = is_rotation.then_some(Motion::Rotation);
    [
        ("time_star", x),
        ("mu_star", friction),
        ("first_slip_time_star", FIRST_SLIP.to_owned()),
        ("sliding_share", SLIDING_SHARE.to_owned()),
        ("place", title_of_place(motion).to_owned()),
    ]
}

/// The title of maps of a field of a run of this case with these values, in the unit of `fields.nc`, and the
/// unit in which they are drawn. The character after an underscore is a subscript.
#[pyfunction]
pub(crate) fn title_of_field(
    case: &Case,
    name: &str,
    values: PyReadonlyArray2<'_, f32>,
) -> PyResult<(String, f32)> {
    let field = field_named(name);
    let field = field.ok_or_else(|| PyValueError::new_err(format!("there is no field `{name}`")))?;
    Ok(titled(
        field,
        Some(&case.0.file),
        values.as_array().iter().copied(),
    ))
}
