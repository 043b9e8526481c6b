//! The folder of a project: what studies, designs and calibrations have in common.
//!
//! ```text
//! ProjectKind: names of files -> journal: a run on each line, one process at a time
//! Given: file, copies of inputs -> ResultFiles: batches of results, listed with their checksums -> verify
//! ```

mod checksums;
mod given;
pub(crate) mod input_copies;
mod journal;
mod kind;
mod line;
mod notes;
mod result_files;
pub(crate) mod verify;
mod written_numbers;

pub use checksums::{CHECKSUMS, Checksums};
pub use given::Given;
pub use input_copies::Copy;
pub(crate) use input_copies::plain_name;
pub use journal::Journal;
pub use kind::ProjectKind;
pub use line::JournalRecord;
#[cfg(test)]
pub(crate) use line::to_line;
pub use notes::notes_of_use;
pub use result_files::{Batch, Others, ResultFiles};
pub use verify::{Derivation, Extent, VerifyStudyError, verify_checksums};
pub use written_numbers::read_numbers;
