//! The device that computes the steps of runs.

use std::sync::{Arc, Mutex};

use pyo3::exceptions::{PyRuntimeError, PyValueError};
use pyo3::prelude::*;
use slipfront::device::{Device, DeviceError};

use crate::process::locked;

/// Opens a device by its name, or gives the one that was opened before; none for the processor.
pub(crate) fn device(name: &str) -> PyResult<Option<Arc<dyn Device>>> {
    static OPENED: Mutex<Option<Arc<dyn Device>>> = Mutex::new(None);
    match name {
        "cpu" => Ok(None),
        "gpu" => {
            let mut opened = locked(&OPENED);
            if opened.is_none() {
                *opened = Some(slipfront_cli::open_gpu().map_err(device_error)?);
            }
            Ok(opened.clone())
        }
        _ => Err(PyValueError::new_err(format!(
            "the device is `cpu` or `gpu`, not `{name}`"
        ))),
    }
}

/// The failure of a device, or its refusal of a run.
pub(crate) fn device_error(error: DeviceError) -> PyErr {
    PyRuntimeError::new_err(format!("{error}; `device=\"cpu\"` gives the same results"))
}
