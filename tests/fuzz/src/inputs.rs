//! Inputs of the targets: seeds, and findings of earlier fuzzing.

use std::collections::BTreeSet;
use std::path::Path;

use slipfront_case::case_file::{KeyKind, SECTIONS};

use crate::scratch::repository;
use crate::target::Target;

/// An input and the name by which a failure calls it.
pub type Input = (String, Vec<u8>);

impl Target {
    /// Valid and invalid inputs to begin with.
    pub fn seeds(&self) -> Vec<Input> {
        let mut seeds: Vec<Input> = (self.generated)()
            .into_iter()
            .enumerate()
            .map(|(k, bytes)| (format!("made {k}"), bytes))
            .collect();
        for name in self.files {
            match name.split_once("*.") {
                Some((folder, ending)) => seeds.extend(files_of(&repository(folder), ending)),
                None => seeds.push(((*name).to_owned(), std::fs::read(repository(name)).unwrap())),
            }
        }
        seeds.extend(files_of(&own_folder("seeds", self.name), ""));
        seeds
    }

    /// Inputs on which the check has failed before.
    pub fn findings(&self) -> Vec<Input> {
        files_of(&own_folder("findings", self.name), "")
    }

    /// Long inputs that are made in code.
    pub fn long_inputs(&self) -> Vec<Input> {
        let made = (self.long)().into_iter().enumerate();
        made.map(|(k, bytes)| (format!("long {k}"), bytes)).collect()
    }

    /// The text of the target's dictionary in the format of libFuzzer, for case and study files and requests
    /// with the keys of a case; empty without one.
    pub fn words(&self) -> String {
        let Some(name) = self.dictionary else {
            return String::new();
        };
        let mut text = std::fs::read_to_string(own_folder("dictionaries", name)).unwrap();
        if ["case.dict", "study.dict", "requests.dict"].contains(&name) {
            for word in words_of_cases() {
                text += &format!("\"{}\"\n", word.replace('"', "\\x22"));
            }
        }
        text
    }
}

/// Keys, headers and words of a case file.
fn words_of_cases() -> BTreeSet<String> {
    let mut words = BTreeSet::new();
    for section in &SECTIONS {
        words.insert(format!("{} = ", section.table()));
        if section.is_shape {
            words.insert(format!("\"{}\"", section.name));
        } else {
            words.insert(format!("[{}]\\x0a", section.name));
        }
        for key in section.keys {
            words.insert(format!("{} = ", key.name));
            let values = match key.kind {
                KeyKind::Words(words) => words(),
                KeyKind::Number { words, .. } => words,
                _ => &[],
            };
            words.extend(values.iter().map(|word| format!("\"{word}\"")));
        }
    }
    words
}

fn own_folder(folder: &str, name: &str) -> std::path::PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join(folder).join(name)
}

/// The files of a folder with this ending, in order; none if there is no folder.
fn files_of(folder: &Path, ending: &str) -> Vec<Input> {
    let entries = std::fs::read_dir(folder).into_iter().flatten();
    let mut paths: Vec<_> = entries.map(|entry| entry.unwrap().path()).collect();
    paths.retain(|path| {
        path.is_file() && (ending.is_empty() || path.extension().is_some_and(|e| e == ending))
    });
    paths.sort();
    let input = |path: &std::path::PathBuf| (path.display().to_string(), std::fs::read(path).unwrap());
    paths.iter().map(input).collect()
}
