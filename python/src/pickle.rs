//! Checksums of pickles, which detect damage.

use pyo3::prelude::*;
use pyo3::types::PyBytes;
use slipfront_run::checksum;

/// Context of the checksum of a pickle, so that no other contents with a checksum are taken for a pickle.
const CONTEXT: &[u8] = b"slipfront pickle";

/// Contents with their checksum.
#[pyfunction]
pub(crate) fn with_checksum<'py>(py: Python<'py>, contents: &[u8]) -> Bound<'py, PyBytes> {
    PyBytes::new(py, &checksum::with_checksum(CONTEXT, contents))
}

/// The contents before their checksum; none if it does not match.
#[pyfunction]
pub(crate) fn verified<'py>(py: Python<'py>, sealed: &[u8]) -> Option<Bound<'py, PyBytes>> {
    checksum::verified(CONTEXT, sealed).map(|contents| PyBytes::new(py, contents))
}
