//! Builds the case of a command, with progress and checks for signals while files are read and the texture is
//! meshed.

use slipfront_case::case::{self, Case, Watch};
use slipfront_case::case_file::CaseError;

use crate::failure::Failure;
use crate::progress::case::CaseProgress;
use crate::ranks::CommandRanks;
use crate::signals::Signals;

/// Builds a case with `make` on all ranks, and refuses it if a run of it needs too much memory; `make` gets
/// the function that watches its work.
pub(crate) fn make_case(
    ranks: &CommandRanks,
    signals: &Signals,
    quiet: bool,
    make: impl FnOnce(&mut Watch, case::Ranks) -> Result<Case, CaseError>,
) -> Result<Case, Failure> {
    let mut progress = CaseProgress::new(quiet);
    let communicator = ranks.communicator();
    let of_case = case::Ranks {
        communicator: &*communicator,
        on_node: ranks.on_node(),
    };
    let watch = &mut |share| {
        progress.show(share);
        signals.stopped().is_none()
    };
    let made = make(watch, of_case).and_then(|case| {
        of_case.agree(case.budget.check_memory(&case.file, false))?;
        Ok(case)
    });
    progress.finish();
    made.map_err(|error| match error {
        CaseError::Stopped => {
            // The signal may have reached only another rank.
            let signal = ranks.largest_of(f64::from(signals.stopped().unwrap_or_default()));
            Failure::Stopped(signal as i32, error.to_string())
        }
        error => Failure::input(error),
    })
}
