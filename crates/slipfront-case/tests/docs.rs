//! Every case in the book can be read: the TOML blocks of README.md and docs/.

use std::path::{Path, PathBuf};

use slipfront_case::case_file::CaseFile;

fn repository() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

fn add_pages(folder: &Path, pages: &mut Vec<PathBuf>) {
    for entry in std::fs::read_dir(folder).expect("the book can be listed") {
        let path = entry.expect("the book can be listed").path();
        if path.is_dir() {
            add_pages(&path, pages);
        } else if path.extension().is_some_and(|extension| extension == "md") {
            pages.push(path);
        }
    }
}

/// A fenced block: the line of its first row, from 1, and its text.
struct Block {
    line: usize,
    text: String,
}

/// The blocks of a page whose fence says exactly `toml`; `toml ignore` keeps one out.
fn toml_blocks(page: &str) -> Vec<Block> {
    let mut blocks = Vec::new();
    let mut open: Option<(bool, Block)> = None;
    for (index, line) in page.lines().enumerate() {
        let info = line.trim_start().strip_prefix("```");
        match (&mut open, info) {
            (None, Some(info)) => {
                let block = Block {
                    line: index + 2,
                    text: String::new(),
                };
                open = Some((info.trim() == "toml", block));
            }
            (Some(_), Some(_)) => {
                let closed = open.take().filter(|(toml, _)| *toml);
                blocks.extend(closed.map(|(_, block)| block));
            }
            (Some((_, block)), None) => {
                block.text += line;
                block.text += "\n";
            }
            (None, None) => {}
        }
    }
    assert!(open.is_none(), "a fence is left open");
    blocks
}

#[test]
fn every_case_in_the_book_can_be_read() {
    let mut pages = vec![repository().join("README.md")];
    add_pages(&repository().join("docs"), &mut pages);
    let mut read = 0;
    let mut refused = String::new();
    for page in &pages {
        for block in toml_blocks(&std::fs::read_to_string(page).unwrap()) {
            // The name shows in the message, whose line then counts from the fence.
            let name = format!("{} (block at line {})", page.display(), block.line);
            match CaseFile::parse(&block.text, &name, &[]) {
                Ok(_) => read += 1,
                Err(error) => refused += &format!("{error}\n"),
            }
        }
    }
    assert!(refused.is_empty(), "{refused}");
    assert!(
        read >= 10,
        "only {read} cases were found in {} pages",
        pages.len()
    );
}

#[test]
fn fences_are_told_apart() {
    let page = "```toml\na = 1\n```\ntext\n```toml ignore\nb\n```\n```console\nc\n```\n";
    let blocks = toml_blocks(page);
    assert_eq!(blocks.len(), 1);
    assert_eq!((blocks[0].line, blocks[0].text.as_str()), (2, "a = 1\n"));
}
