//! The native part of the Python module `slipfront`: cases, simulations and their results, studies and the
//! command.
//!
//! The Python files next to it in the package give its names their public form. While the engine works, other
//! Python threads continue; signals are checked between two calls, or every 50 ms within one.

#![expect(
    clippy::needless_pass_by_value,
    reason = "what Python hands over is taken as it comes, as values"
)]

mod arrays;
mod calibrate;
mod case;
mod design;
mod device;
mod errors;
mod export;
mod folder;
mod labels;
mod map;
mod pickle;
mod process;
mod run_data;
mod simulation;
mod study;

use std::ffi::OsString;
use std::path::PathBuf;

use pyo3::prelude::*;

/// Runs the command with these arguments, the first of which is the name of the program, and returns its exit
/// status. The command needs a process of its own. The folder `package` has the session of the laboratory as
/// WebAssembly.
#[pyfunction]
fn command(py: Python<'_>, arguments: Vec<OsString>, package: PathBuf) -> PyResult<u8> {
    process::detached(py, || slipfront_cli::main(arguments, Some(&package)))
}

#[pymodule]
fn _slipfront(module: &Bound<'_, PyModule>) -> PyResult<()> {
    let py = module.py();
    module.add("__version__", env!("CARGO_PKG_VERSION"))?;
    module.add("IN_MEMORY", errors::IN_MEMORY)?;
    let case_error = py.get_type::<errors::CaseError>();
    // Values of an error that has no place in a file.
    case_error.setattr("line", py.None())?;
    case_error.setattr("column", py.None())?;
    module.add("CaseError", case_error)?;
    module.add("RunError", py.get_type::<errors::RunError>())?;
    module.add("ForkError", py.get_type::<errors::ForkError>())?;
    module.add("FolderError", py.get_type::<errors::FolderError>())?;
    module.add_class::<case::Case>()?;
    module.add_class::<simulation::Simulation>()?;
    module.add_class::<run_data::RunData>()?;
    module.add_class::<study::Study>()?;
    module.add_class::<design::Design>()?;
    module.add_class::<calibrate::Calibration>()?;
    module.add_class::<folder::TemporaryParent>()?;
    module.add_function(wrap_pyfunction!(map::run_summaries, module)?)?;
    module.add_function(wrap_pyfunction!(folder::kind_of, module)?)?;
    module.add_function(wrap_pyfunction!(folder::read_run, module)?)?;
    module.add_function(wrap_pyfunction!(folder::interrupted, module)?)?;
    module.add_function(wrap_pyfunction!(folder::verify, module)?)?;
    module.add_function(wrap_pyfunction!(folder::make_ready, module)?)?;
    module.add_function(wrap_pyfunction!(export::ro_crate, module)?)?;
    module.add_function(wrap_pyfunction!(export::citation, module)?)?;
    module.add_function(wrap_pyfunction!(labels::title, module)?)?;
    module.add_function(wrap_pyfunction!(labels::titles_of_run, module)?)?;
    module.add_function(wrap_pyfunction!(labels::title_of_field, module)?)?;
    module.add_function(wrap_pyfunction!(pickle::with_checksum, module)?)?;
    module.add_function(wrap_pyfunction!(pickle::verified, module)?)?;
    module.add_function(wrap_pyfunction!(process::check_process, module)?)?;
    module.add_function(wrap_pyfunction!(command, module)?)
}
