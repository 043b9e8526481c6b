//! Numbers of blocks as arrays of numpy.

use numpy::ndarray::ArrayView2;
use numpy::{Element, IntoPyArray, PyArray2, PyArray3, PyArrayMethods};
use pyo3::prelude::*;

/// Numbers as an array with rows of `columns`, passed on without a copy.
pub(crate) fn rows<T: Element>(
    py: Python<'_>,
    values: Vec<T>,
    columns: usize,
) -> PyResult<Bound<'_, PyArray2<T>>> {
    let count = values.len().checked_div(columns).unwrap_or(0);
    values.into_pyarray(py).reshape([count, columns])
}

/// Numbers of several arrays of equal size as one array, one after the other.
pub(crate) fn stacked<'py, T: Element + Copy>(
    py: Python<'py>,
    arrays: &[&[T]],
    [rows, columns]: [usize; 2],
) -> PyResult<Bound<'py, PyArray3<T>>> {
    let shape = [arrays.len(), rows, columns];
    arrays.concat().into_pyarray(py).reshape(shape)
}

/// Numbers of `owner`, which never change as long as it lives, as a read-only array without a copy.
#[allow(unsafe_code, reason = "numpy cannot know how long memory of others lives")]
pub(crate) fn borrowed<'py, T: Element>(
    owner: Bound<'py, PyAny>,
    values: &[T],
    columns: usize,
) -> PyResult<Bound<'py, PyArray2<T>>> {
    let rows = values.len().checked_div(columns).unwrap_or(0);
    let view = ArrayView2::from_shape((rows, columns), values).map_err(crate::errors::folder_error)?;
    // SAFETY: callers pass numbers that `owner` holds behind an `Arc` and never changes; the array keeps
    // `owner` alive.
    let array = unsafe { PyArray2::borrow_from_array(&view, owner) };
    array.readwrite().make_nonwriteable();
    Ok(array)
}
