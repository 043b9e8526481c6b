//! Reasons why a command fails, and its exit status.

use slipfront_run::agree::RankFailure;
use slipfront_study::StudyError;

use crate::print_stderr::print_stderr;
use crate::signals::Signals;
use crate::wrap::for_stderr;

/// Table of the exit statuses of all commands, in lines that a terminal of 80 columns does not wrap.
pub(crate) const STATUSES: &str = "Exit status:
  0        success
  1        failure: a run failed, a disk is full, a file was changed after it was
           written, a claim or an exact answer is missed, no run has the quantity
           of the study, or the model cannot reproduce the records
  2        wrong input or command line: the message says what to change
  128 + N  stopped by signal N: 129, 130, 143 for SIGHUP, SIGINT, SIGTERM";

/// Reason why a command failed.
pub(crate) enum Failure {
    /// Bad input or usage: status 2.
    Input(String),
    /// An error while running, or a negative result: status 1.
    Running(String),
    /// Stopped by the signal with this number: status 128 + number.
    Stopped(i32, String),
}

#[allow(clippy::needless_pass_by_value)] // `map_err` passes errors by value.
impl Failure {
    pub(crate) fn input(error: impl ToString) -> Self {
        Self::Input(error.to_string())
    }

    pub(crate) fn running(error: impl ToString) -> Self {
        Self::Running(error.to_string())
    }

    /// The failure of a command that a signal has stopped.
    pub(crate) fn stopped(signals: &Signals, error: impl ToString) -> Self {
        Self::Stopped(signals.stopped().unwrap_or_default(), error.to_string())
    }

    /// The failure of a results folder that could not be opened.
    pub(crate) fn from_folder(error: StudyError) -> Self {
        match error {
            StudyError::Write { .. } | StudyError::Journal { .. } => Self::running(error),
            error => Self::input(error),
        }
    }

    /// The failure of a command that could not make or keep results.
    pub(crate) fn from_results(signals: &Signals, error: StudyError) -> Self {
        match error {
            StudyError::Interrupted => Self::stopped(signals, error),
            StudyError::Edited { .. } | StudyError::Checksums { .. } => Self::input(error),
            error => Self::running(error),
        }
    }

    /// Fails if a signal that stops the program has arrived.
    pub(crate) fn if_stopped(signals: &Signals) -> Result<(), Self> {
        match signals.stopped() {
            Some(_) => Err(Self::stopped(signals, "stopped by a signal")),
            None => Ok(()),
        }
    }

    /// Prints the error to stderr, and returns the exit status.
    pub(crate) fn report(self) -> u8 {
        report(&RankFailure::from(self))
    }
}

impl From<Failure> for RankFailure {
    fn from(failure: Failure) -> Self {
        let (status, sentence) = match failure {
            Failure::Input(sentence) => (2, sentence),
            Failure::Running(sentence) => (1, sentence),
            Failure::Stopped(signal, sentence) => (128 + signal as u8, sentence),
        };
        Self { status, sentence }
    }
}

/// Prints a failure to stderr, and returns the exit status.
pub(crate) fn report(failure: &RankFailure) -> u8 {
    print_stderr(&for_stderr(&format!("error: {failure}")));
    failure.status
}
