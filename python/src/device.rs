//! The device that computes the steps of runs.

use std::sync::Arc;

use pyo3::exceptions::{PyRuntimeError, PyValueError};
use pyo3::prelude::*;
use slipfront::device::{Device, DeviceError};

use crate::errors::in_words_of_python;

/// Opens a device by its name: none for the processor.
pub(crate) fn device(name: &str) -> PyResult<Option<Arc<dyn Device>>> {
    match name {
        "cpu" => Ok(None),
        "gpu" => slipfront_cli::open_gpu().map(Some).map_err(device_error),
        _ => Err(PyValueError::new_err(format!(
            "the device is `cpu` or `gpu`, not `{name}`"
        ))),
    }
}

/// The failure of a device, or its refusal of a run.
pub(crate) fn device_error(error: DeviceError) -> PyErr {
    PyRuntimeError::new_err(in_words_of_python(error))
}
