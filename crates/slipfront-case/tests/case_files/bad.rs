use std::fs;
use std::path::Path;

use slipfront_case::case::{Case, Ranks};
use slipfront_case::case_file::CaseFile;

use super::{files, notes};

/// Every bad file has `# error:` lines with the expected parts of the message, and `# set:` lines with its
/// overrides.
#[test]
fn every_bad_file_is_refused_with_its_sentence() {
    let files = files("bad");
    assert!(files.len() >= 100, "only {} bad files", files.len());
    let complaints: Vec<String> = files.iter().filter_map(|path| complaint(path)).collect();
    assert!(complaints.is_empty(), "{}", complaints.join("\n\n"));
}

/// A complaint if the error of a bad file is not the expected one.
fn complaint(path: &Path) -> Option<String> {
    let name = path.file_name().unwrap().display();
    let text = fs::read_to_string(path).unwrap();
    let expected = notes(&text, "error");
    if expected.is_empty() {
        return Some(format!("{name} expects no error"));
    }
    let file = CaseFile::parse(&text, "bad.toml", &notes(&text, "set"));
    let case = file.and_then(|file| Case::new(file, "bad", Path::new(""), &mut |_| true, Ranks::ALONE));
    let Err(error) = case else {
        return Some(format!("{name} was accepted"));
    };
    let message = error.to_string();
    if let Some(part) = expected.iter().find(|part| !message.contains(*part)) {
        return Some(format!("{name}:\n{message}\nlacks\n{part}"));
    }
    let placed = message.starts_with("bad.toml:") || message.starts_with("--set ");
    (!placed).then(|| format!("{name} has no place:\n{message}"))
}
