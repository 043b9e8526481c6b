//! Identity of a run, a hash of everything that determines its numbers: runs with equal identities are made
//! once.

use slipfront_case::case::Case;
use slipfront_case::case_file::{CaseError, NamedFile, Source};

use slipfront_run::program;

/// BLAKE3 hash of the sources of this crate: a part of the identity of the runs that it records.
pub const SOURCE_HASH: &str = env!("SLIPFRONT_SOURCE_HASH");

/// Hash of everything except the seed that determines the numbers of a run: the physics of the case, the
/// contents of its files and the program; not the names of files or the output.
pub fn physics(case: &Case) -> Result<blake3::Hash, CaseError> {
    let mut file = case.file.clone();
    // The text that the case was read from has no effect.
    file.source = Source::default();
    file.friction.seed = 0;
    for NamedFile { name, .. } in file.files_mut().0 {
        let input = case.inputs.iter().find(|input| input.name == *name);
        let hash = input.map(|input| input.hash.to_hex());
        let ending = name.rsplit('.').next().unwrap_or_default();
        *name = format!("{}.{ending}", hash.unwrap_or_default());
    }
    let tables = (
        &file.slider,
        &file.load,
        &file.drive,
        &file.friction,
        &file.texture,
        &file.initial,
        &file.time,
    );
    let tables = serde_json::to_vec(&tables).map_err(|error| CaseError::invalid(None, error.to_string()))?;
    let mut hasher = blake3::Hasher::new();
    hasher.update(program::this_build().as_bytes());
    // This crate computes the recorded numbers from the output of a run, so its sources count, too.
    hasher.update(SOURCE_HASH.as_bytes());
    Ok(hasher.update(&tables).finalize())
}
