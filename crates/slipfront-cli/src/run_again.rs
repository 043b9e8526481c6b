//! Repeats the case of a run folder, in the folder for temporary files.

use std::path::Path;
use std::sync::Arc;

use slipfront::Execution;
use slipfront_base::unfinished::TemporaryFolder;
use slipfront_case::case::{Case, Ranks, Watch};
use slipfront_case::case_file::{CaseError, CaseFile};
use slipfront_run::results;
use slipfront_run::run_folder::RunFolder;
use slipfront_run::running::Running;
use slipfront_run::verify::VerifyError;

use crate::failure::Failure;
use crate::make_case::make_case;
use crate::progress::run::RunProgress;
use crate::ranks::CommandRanks;
use crate::signals::Signals;

/// A repeated run.
pub(crate) struct RunAgain {
    pub(crate) case: Arc<Case>,
    /// Folder of its results, inside the temporary folder.
    pub(crate) made: RunFolder,
    /// The temporary folder, which is removed in the end.
    pub(crate) temporary: TemporaryFolder,
}

/// Builds the case of a run folder, to be repeated by this process alone.
pub(crate) fn case_to_run(
    folder: &Path,
    signals: &Signals,
    quiet: bool,
    make: impl FnOnce(&mut Watch) -> Result<Case, CaseError>,
) -> Result<Case, Failure> {
    let case = folder.join("case.toml");
    // A user may pass a case through a pipe, but reading a pipe in a results folder would wait for ever.
    if !case.is_file() {
        let sentence = format!(
            "{} is not a regular file: there is nothing to repeat",
            case.display()
        );
        return Err(Failure::input(sentence));
    }
    make_case(&CommandRanks::alone(), signals, quiet, |watch, _| make(watch))
}

/// Builds the case of a file that was read from a run folder.
pub(crate) fn of_file(file: CaseFile, folder: &Path, watch: &mut Watch) -> Result<Case, CaseError> {
    Case::to_run(file, "case", folder, watch, Ranks::ALONE)
}

impl RunAgain {
    /// Repeats a case, unless a signal stops it, and writes its results except pictures and manifest.
    pub(crate) fn run(case: Case, folder: &Path, signals: &Signals, quiet: bool) -> Result<Self, Failure> {
        let case = Arc::new(case);
        let temporary =
            TemporaryFolder::new(folder).map_err(|error| Failure::input(VerifyError::Temporary(error)))?;
        case.budget
            .check_disk(&case.file, temporary.path(), 0, false)
            .map_err(Failure::input)?;
        let mut running = Running::start(&case, None, Execution::on_threads(rayon::current_num_threads()));
        let mut progress = RunProgress::new(&running, quiet);
        let reason = loop {
            if let Some(reason) = running.advance(case.steps_per_poll()).map_err(Failure::running)? {
                break reason;
            }
            progress.show(&running);
            Failure::if_stopped(signals)?;
        };
        progress.finish();
        let mut record = running.record(reason);
        let made = temporary.path().join("run");
        let mut made = RunFolder::prepare(&made, false, &case.inputs).map_err(Failure::running)?;
        results::write_case(&case, &mut made).map_err(Failure::running)?;
        results::write(&case, &mut record, &mut made).map_err(Failure::running)?;
        Ok(Self {
            case,
            made,
            temporary,
        })
    }
}
