//! Replies that the host of a session sends itself, as JSON.

use slipfront_run::program::VERSION;

use crate::controls::CONTROLS;
use crate::document::MAX_BLOCKS;
use crate::presets::Presets;
use crate::protocol::{Reply, SavingEntry};

/// The first reply to a page, with its choices: cases, names of the recorded runs, and their folder
/// `results`, if there is one.
pub fn hello(presets: &Presets, folders: &[String], results: Option<&str>) -> String {
    let hello = Reply::Hello {
        version: VERSION,
        presets: &presets.entries(),
        folders,
        results,
        max_blocks: MAX_BLOCKS,
        controls: &CONTROLS,
    };
    hello.json()
}

/// The reply that lists all runs being saved, each with its name and completed fraction.
pub fn saving<'a>(under_way: impl IntoIterator<Item = (&'a str, f64)>) -> String {
    let entries = under_way.into_iter();
    let entries = entries.map(|(name, share)| SavingEntry { name, share });
    let saving = Reply::Saving {
        under_way: entries.collect(),
    };
    saving.json()
}

/// The reply that a run of this name was saved into a folder, with the names of all `folders` of runs.
pub fn saved(name: &str, folder: &str, folders: &[String]) -> String {
    let saved = Reply::Saved {
        name,
        folder,
        folders,
    };
    saved.json()
}

/// The reply that a request of this name was refused, with the reason.
pub fn refused(request: &'static str, sentence: String) -> String {
    Reply::Refused {
        of: request,
        sentence,
    }
    .json()
}

/// The reply that the run has failed, with the reason.
pub fn failed(sentence: String) -> String {
    Reply::Failed { sentence }.json()
}
