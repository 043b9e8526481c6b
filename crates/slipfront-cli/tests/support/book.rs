//! The pages of the repository in Markdown.

use std::path::{Path, PathBuf};

/// Folders without pages: for tools, for results, and for texts that become part of
/// `docs/validation/family.md`, to which their links are relative.
const WITHOUT_PAGES: [&str; 5] = [".git", "target", "results", "node_modules", "text"];

/// The folder of the repository.
pub(crate) fn repository() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// All pages of the repository.
pub(crate) fn pages() -> Vec<PathBuf> {
    let mut pages = Vec::new();
    add_pages(&repository(), &mut pages);
    pages
}

/// Adds the pages in a folder and in folders below it.
fn add_pages(folder: &Path, pages: &mut Vec<PathBuf>) {
    for entry in std::fs::read_dir(folder).expect("a folder of the repository can be listed") {
        let path = entry.expect("a folder of the repository can be listed").path();
        if path.is_dir() {
            let has_pages = path
                .file_name()
                .is_some_and(|name| WITHOUT_PAGES.iter().all(|without| name != *without));
            if has_pages {
                add_pages(&path, pages);
            }
        } else if path.extension().is_some_and(|extension| extension == "md") {
            pages.push(path);
        }
    }
}

/// Fenced blocks of a page: the words after the opening fence, and the lines.
pub(crate) fn blocks(page: &str) -> Vec<(String, Vec<String>)> {
    let mut blocks = Vec::new();
    let mut open: Option<(String, Vec<String>)> = None;
    for line in page.lines() {
        match (line.trim_start().strip_prefix("```"), &mut open) {
            (Some(_), Some(_)) => blocks.extend(open.take()),
            (Some(info), None) => open = Some((info.trim().to_owned(), Vec::new())),
            (None, Some((_, lines))) => lines.push(line.to_owned()),
            (None, None) => {}
        }
    }
    assert!(open.is_none(), "a fence is left open");
    blocks
}

/// Part of a line that is the same on every machine.
pub(crate) fn without_machine(line: &str) -> String {
    // There is a thread per core.
    if let Some((before, after)) = line.split_once(" thread") {
        let before = before.trim_end_matches(|c: char| c.is_ascii_digit());
        without_machine(&format!("{before}{}", after.trim_start_matches('s')))
    } else if line.starts_with("cost ") {
        line.split(',').next().unwrap_or_default().to_owned()
    } else if line.starts_with("memory ") {
        line.replace(|c: char| c.is_ascii_digit() || ".KMGT".contains(c), "")
    } else if ["second", "minute", "hour"]
        .iter()
        .any(|unit| line.contains(unit))
    {
        let is_of_time = |word: &&str| {
            let word = word.trim_end_matches([';', 's']);
            ["le", "than", "a", "about", "to", "second", "minute", "hour"].contains(&word)
                || word.parse::<u32>().is_ok_and(|number| number < 100)
        };
        let others: Vec<&str> = line.split_whitespace().filter(|word| !is_of_time(word)).collect();
        others.join(" ")
    } else {
        line.trim_end().to_owned()
    }
}
