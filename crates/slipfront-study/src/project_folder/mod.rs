//! The folder of a project: what studies, designs and calibrations have in common.
//!
//! ```text
//! ProjectKind: names of files -> journal: a run on each line, one process at a time
//! Given: file, copies of inputs -> ResultFiles: batches of results, listed with their checksums -> verify
//! ```

mod checksums;
pub(crate) mod input_copies;
mod journal;
mod kept_inputs;
mod kind;
mod line;
mod notes;
mod read_numbers;
mod result_files;
pub(crate) mod verify;

pub use checksums::{CHECKSUMS, Checksums};
pub use input_copies::Copy;
pub(crate) use input_copies::plain_name;
pub use journal::Journal;
pub use kept_inputs::Given;
pub use kind::ProjectKind;
pub use line::JournalEntry;
#[cfg(test)]
pub(crate) use line::to_line;
pub use notes::notes_of_use;
pub use read_numbers::read_numbers;
pub use result_files::{Batch, Others, ResultFiles};
pub use verify::{Extent, FindAgain, Project, VerifyBeside, verify_complete};
