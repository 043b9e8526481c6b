//! Names and files that were probably meant by misspelt ones.

use std::io::{Error, ErrorKind};
use std::path::{Path, PathBuf};

use slipfront_base::text::display_path;

/// Largest length of a name that is compared with the known ones, in bytes.
const MAX_NAME: usize = 100;

/// Length in bytes of the shortest word that matches a longer name as a part of it, such as "stress" in
/// "contact_stress_star".
const MIN_PART: usize = 4;

/// Largest number of entries of a folder that are searched for a similar name.
const MAX_ENTRIES: usize = 10_000;

/// The closest match for `word` among the `known` words.
pub fn nearest<'k>(word: &str, known: &[&'k str]) -> Option<&'k str> {
    // The time and memory for the distance grow with the length of the word, which may be as long as the
    // file.
    if word.len() > MAX_NAME {
        return None;
    }
    let distances = known
        .iter()
        .map(|key| (strsim::damerau_levenshtein(word, key), *key));
    let (distance, key) = distances.min()?;
    let mut around = known
        .iter()
        .filter(|key| word.len() >= MIN_PART && key.contains(word));
    match (around.next(), around.next()) {
        _ if distance <= (key.len() / 3).max(1) => Some(key),
        (Some(only), None) => Some(only),
        _ => None,
    }
}

/// Reason why a file was not read, for a sentence that names it; of a missing one, with the file that was
/// probably meant.
pub fn why_unread(path: &Path, source: &Error) -> String {
    if source.kind() != ErrorKind::NotFound {
        return source.to_string();
    }
    let near = similar_file(path).map(|near| format!(" (did you mean {}?)", display_path(&near)));
    format!("there is no such file{}", near.unwrap_or_default())
}

/// The file that was probably meant by a missing path: a file with a similar name and the same extension, by
/// default .toml, in the same folder, or otherwise in its folder `cases`, `cases/studies`, `cases/designs` or
/// `cases/calibrations`.
pub(crate) fn similar_file(path: &Path) -> Option<PathBuf> {
    let folder = path.parent().unwrap_or(Path::new(""));
    let name = path.file_name()?.to_str()?;
    let (stem, extension) = name.rsplit_once('.').unwrap_or((name, "toml"));
    let ending = format!(".{extension}");
    let within = [
        "",
        "cases",
        "cases/studies",
        "cases/designs",
        "cases/calibrations",
    ]
    .map(|inner| folder.join(inner));
    within.iter().find_map(|folder| {
        let listed = if folder.as_os_str().is_empty() {
            Path::new(".")
        } else {
            folder
        };
        let entries = std::fs::read_dir(listed).ok()?.take(MAX_ENTRIES).flatten();
        let mut stems: Vec<String> = entries
            .filter_map(|entry| Some(entry.file_name().to_str()?.strip_suffix(&ending)?.to_owned()))
            .collect();
        // The order of a folder is not sorted by name.
        stems.sort();
        let stems: Vec<&str> = stems.iter().map(String::as_str).collect();
        let near = folder.join(format!("{}{ending}", nearest(stem, &stems)?));
        // A dangling link is listed under its own name.
        (near != path).then_some(near)
    })
}
