//! Makes the case of a command, with progress and an ear for signals while its texture is laid over the blocks.

use slipfront_case::case::{Case, Watch};
use slipfront_case::case_file::CaseError;

use crate::failure::Failure;
use crate::progress::mesh::MeshProgress;
use crate::signals::Signals;

/// The case that `make` gives; it is handed what watches its texture.
pub(crate) fn make_case(
    signals: &Signals,
    quiet: bool,
    make: impl FnOnce(&mut Watch) -> Result<Case, CaseError>,
) -> Result<Case, Failure> {
    let mut progress = MeshProgress::new(quiet);
    let made = make(&mut |share| {
        progress.show(share);
        signals.stopped().is_none()
    });
    progress.finish();
    made.map_err(|error| match error {
        CaseError::Stopped => Failure::stopped(signals, error),
        error => Failure::input(error),
    })
}
