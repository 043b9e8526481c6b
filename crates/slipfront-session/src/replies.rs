//! Replies that the host of a session gives by itself, as JSON.

use slipfront_run::program::VERSION;

use crate::controls::CONTROLS;
use crate::document::MAX_BLOCKS;
use crate::presets::Presets;
use crate::protocol::{Reply, SavingEntry};

/// The first reply to a page, with what it can choose from: cases, names of the runs that were recorded, and
/// the folder `results` of these, if there is one.
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

/// The reply that tells of all runs that are being saved, each with its name and the share of it that is
/// done.
pub fn saving<'a>(under_way: impl IntoIterator<Item = (&'a str, f64)>) -> String {
    let entries = under_way.into_iter();
    let entries = entries.map(|(name, share)| SavingEntry { name, share });
    let saving = Reply::Saving {
        under_way: entries.collect(),
    };
    saving.json()
}

/// The reply that tells that a run of this name was saved into a folder, beside the names of all `folders` of
/// runs.
pub fn saved(name: &str, folder: &str, folders: &[String]) -> String {
    let saved = Reply::Saved {
        name,
        folder,
        folders,
    };
    saved.json()
}

/// The reply that tells why a request of this name was refused.
pub fn refused(of: &'static str, sentence: String) -> String {
    Reply::Refused { of, sentence }.json()
}

/// The reply that tells why the run has failed.
pub fn failed(sentence: String) -> String {
    Reply::Failed { sentence }.json()
}
