//! Checks of the book and the code: every case can be read, every command line is valid, every link leads
//! somewhere, every `unsafe` is listed, and no number depends on the system's mathematical library.

use std::path::{Path, PathBuf};

use slipfront_case::case_file::CaseFile;
use slipfront_session::Document;

use crate::support::book::{blocks, pages, repository, without_machine};
use crate::support::process::{output, program, unset};
use crate::support::workspace::Workspace;

/// Splits a shell line into words, up to a pipe, a redirection or a comment.
fn words(line: &str) -> Vec<String> {
    let mut words = Vec::new();
    let mut word: Option<String> = None;
    let mut quote = None;
    for c in line.chars() {
        match quote {
            Some(end) if c == end => quote = None,
            Some(_) => word.get_or_insert_default().push(c),
            None if c == '\'' || c == '"' => {
                quote = Some(c);
                word.get_or_insert_default();
            }
            None if c == '|' || c == '>' || (c == '#' && word.is_none()) => break,
            None if c.is_whitespace() => words.extend(word.take()),
            None => word.get_or_insert_default().push(c),
        }
    }
    words.extend(word);
    words
}

/// Arguments in the `$` lines of the console blocks: of `slipfront`, of `cargo run --`, and of
/// `slipfront-mpi` with any launcher, because its `run` takes the same options.
fn commands(page: &str) -> Vec<Vec<String>> {
    let mut found = Vec::new();
    let consoles = blocks(page).into_iter().filter(|(info, _)| info == "console");
    let lines: Vec<String> = consoles.flat_map(|(_, lines)| lines).collect();
    for line in lines.iter().filter_map(|line| line.strip_prefix("$ ")) {
        let arguments = ["slipfront ", "cargo run -- "]
            .iter()
            .find_map(|program| line.strip_prefix(program))
            .or_else(|| line.split_once(" slipfront-mpi ").map(|(_, arguments)| arguments));
        found.extend(arguments.map(words));
    }
    found
}

/// Cases, or parts of cases with defaults for all other keys: the site opens them in the laboratory, except
/// those that name a file.
#[test]
fn every_case_in_the_book_can_be_read_and_shown() {
    let (mut read, mut shown, mut refused) = (0, 0, String::new());
    for page in pages() {
        for (info, lines) in blocks(&std::fs::read_to_string(&page).unwrap()) {
            if info != "toml" {
                continue;
            }
            let text = lines.join("\n");
            let result = if lines.iter().any(|line| line.starts_with("file = ")) {
                CaseFile::parse(&text, "the block", &[]).map(|_| read += 1)
            } else {
                let document = Document::new("the block", &text, |name| {
                    Err(format!("{name} is no file of a link"))
                });
                document
                    .and_then(|document| document.case_to_show(&mut |_| true))
                    .map(|_| shown += 1)
            };
            if let Err(error) = result {
                refused += &format!("{}:\n{text}\n{error}\n\n", page.display());
            }
        }
    }
    assert!(refused.is_empty(), "{refused}");
    assert!(read >= 3, "only {read} cases with a file were found");
    assert!(shown >= 30, "only {shown} other cases were found");
}

#[test]
fn fences_are_told_apart() {
    let page = "```toml\na = 1\n```\ntext\n```toml ignore\nb\n```\n```console\nc\n```\n";
    let block = |info: &str, line: &str| (info.to_owned(), vec![line.to_owned()]);
    assert_eq!(
        blocks(page),
        [
            block("toml", "a = 1"),
            block("toml ignore", "b"),
            block("console", "c")
        ]
    );
}

#[test]
fn every_command_in_the_book_is_understood() {
    let mut count = 0;
    for page in pages() {
        for arguments in commands(&std::fs::read_to_string(&page).unwrap()) {
            // With --help at its end, a line is parsed but nothing is run, and errors before --help are
            // reported first.
            let parsed = output(unset(program()).args(&arguments).arg("--help"));
            let message = String::from_utf8_lossy(&parsed.stderr);
            assert!(
                parsed.status.success(),
                "{}: {arguments:?}\n{message}",
                page.display()
            );
            count += 1;
        }
    }
    assert!(count >= 10, "only {count} commands were found");
}

#[test]
fn lines_are_split_as_a_shell_does() {
    assert_eq!(
        words("run --set 'drive.speed=1 mm/s' -o \"a b\"  # why"),
        ["run", "--set", "drive.speed=1 mm/s", "-o", "a b"]
    );
    assert_eq!(words("run --json | jq ."), ["run", "--json"]);
}

/// Lines of a page outside of fenced blocks.
fn prose(page: &str) -> impl Iterator<Item = &str> {
    let mut fenced = false;
    page.lines().filter(move |line| {
        let fence = line.trim_start().starts_with("```");
        fenced ^= fence;
        !fenced && !fence
    })
}

/// The anchor of a heading: lower case, hyphens for blanks, and otherwise only letters, digits, hyphens and
/// underscores.
fn anchor(heading: &str) -> String {
    heading
        .trim()
        .to_lowercase()
        .replace(' ', "-")
        .chars()
        .filter(|&c| c.is_alphanumeric() || c == '-' || c == '_')
        .collect()
}

fn anchors(page: &str) -> Vec<String> {
    prose(page)
        .filter(|line| line.starts_with('#'))
        .map(|line| anchor(line.trim_start_matches('#')))
        .collect()
}

#[test]
fn every_link_in_the_book_leads_somewhere() {
    let (mut count, mut broken) = (0, String::new());
    for page in pages() {
        let text = std::fs::read_to_string(&page).unwrap();
        let parts = prose(&text).flat_map(|line| line.split("](").skip(1));
        for target in parts.filter_map(|part| part.split(')').next()) {
            if target.starts_with("http") {
                continue;
            }
            count += 1;
            let (file, place) = target.split_once('#').unwrap_or((target, ""));
            let path = match file {
                "" => page.clone(),
                file => page.parent().unwrap().join(file),
            };
            let leads = match place {
                "" => path.exists(),
                place => std::fs::read_to_string(&path)
                    .is_ok_and(|text| anchors(&text).iter().any(|anchor| anchor == place)),
            };
            if !leads {
                broken += &format!("{}: {target}\n", page.display());
            }
        }
    }
    assert!(broken.is_empty(), "{broken}");
    assert!(count >= 50, "only {count} links were found");
    assert_eq!(anchor(" What 31 % means"), "what-31--means");
}

/// The site takes its pages and their order from `docs/README.md`.
#[test]
fn every_page_of_the_book_is_in_its_contents() {
    let docs = repository().join("docs");
    let contents = std::fs::read_to_string(docs.join("README.md")).unwrap();
    let listed: Vec<PathBuf> = contents
        .split("](")
        .skip(1)
        .filter_map(|part| part.split(')').next())
        .map(|target| docs.join(target))
        .collect();
    let own = pages().into_iter().filter(|page| page.starts_with(&docs));
    let missing: Vec<PathBuf> = own
        .filter(|page| *page != docs.join("README.md") && !listed.contains(page))
        .collect();
    assert!(missing.is_empty(), "docs/README.md has no link to {missing:?}");
}

/// The output in the guides is what `run` and `check` print, except for lines that depend on the machine.
#[test]
fn the_guides_show_what_run_and_check_print() {
    let guide = |name: &str| std::fs::read_to_string(repository().join("docs/guide").join(name)).unwrap();
    let workspace = Workspace::new();
    let cavity = "[slider]\nblocks = [50, 50]\n[[texture]]\nshape = 'cavity'\ncoverage = 10\n";
    workspace.write("cavity.toml", cavity);
    let page = guide("getting-started.md");
    for line in ["run", "check cavity.toml"] {
        let printed = workspace.succeed(line);
        assert!(printed.lines().count() > 10, "{line}: {printed}");
        for printed in printed.lines() {
            let of_the_machine = ["cost ", "memory ", "disk "];
            let same = without_machine(printed);
            let is_shown = page.lines().any(|shown| without_machine(shown) == same);
            assert!(
                is_shown || of_the_machine.iter().any(|name| printed.starts_with(name)),
                "docs/guide/getting-started.md lacks, of `{line}`:\n{printed}"
            );
        }
    }
    let page = guide("experiment.md");
    for case in ["sheet", "steel"] {
        let file = repository().join("cases").join(format!("{case}.toml"));
        let printed = workspace.succeed(&format!("check {}", file.display()));
        let start = printed.find("  length").unwrap();
        let end = printed.find("onset expected").unwrap();
        let lengths = &printed[start..end];
        assert!(
            page.contains(lengths),
            "docs/guide/experiment.md lacks:\n{lengths}"
        );
    }
}

/// Adds the Rust files in a folder to `found`, except those of tests.
fn rust_files(folder: &Path, found: &mut Vec<PathBuf>) {
    for entry in std::fs::read_dir(folder).unwrap().map(Result::unwrap) {
        let (path, name) = (entry.path(), entry.file_name());
        if path.is_dir()
            && !["tests", "benches", "examples", "target"]
                .iter()
                .any(|tests| name == *tests)
        {
            rust_files(&path, found);
        } else if path.extension().is_some_and(|extension| extension == "rs") {
            found.push(path);
        }
    }
}

/// Numbers of the lines, from 0 on, that have `unsafe` in the code and not only in a comment.
fn unsafe_lines(code: &str) -> Vec<usize> {
    let is_unsafe = |line: &str| {
        let code = line.split("//").next().unwrap_or_default();
        code.split(|c: char| !(c.is_alphanumeric() || c == '_'))
            .any(|word| word == "unsafe")
    };
    let lines = code.lines().enumerate();
    lines
        .filter(|(_, line)| is_unsafe(line))
        .map(|(k, _)| k)
        .collect()
}

/// Every `unsafe` in the programs of users has a SAFETY comment, and is listed in the book with its file.
#[test]
fn every_unsafe_has_its_reason_and_stands_in_the_book() {
    let repository = repository();
    let mut files = Vec::new();
    for folder in ["crates", "python"] {
        rust_files(&repository.join(folder), &mut files);
    }
    assert!(files.len() >= 100, "only {} files were found", files.len());
    let mut found = Vec::new();
    for file in &files {
        let code = std::fs::read_to_string(file).unwrap();
        let name = file.strip_prefix(&repository).unwrap().display().to_string();
        for k in unsafe_lines(&code) {
            // A line that allows `unsafe` may be between the comment and the block.
            let above: Vec<_> = code.lines().take(k).collect();
            let has_reason = above[k.saturating_sub(2)..]
                .iter()
                .any(|line| line.contains("// SAFETY: "));
            assert!(has_reason, "{name}:{}: `unsafe` lacks its SAFETY comment", k + 1);
            found.push(name.clone());
        }
    }
    found.sort();

    let book = std::fs::read_to_string(repository.join("docs/reliability.md")).unwrap();
    let (_, told) = book
        .split_once("- `unsafe` stands in ")
        .expect("the book tells it");
    let mut lines = told.lines();
    let number = lines.next().unwrap();
    let places = lines.take_while(|line| line.starts_with("  "));
    let mut listed: Vec<_> = places
        .filter_map(|line| line.strip_prefix("  - `")?.split_once('`').map(|(file, _)| file))
        .collect();
    listed.sort_unstable();
    assert_eq!(
        listed, found,
        "docs/reliability.md lists other places than the code has"
    );
    let words = [
        "no place",
        "one place",
        "two places",
        "three places",
        "four places",
        "five places",
        "six places",
        "seven places",
        "eight places",
        "nine places",
        "ten places",
        "eleven places",
        "twelve places",
        "thirteen places",
    ];
    assert!(
        number.starts_with(words[found.len()]),
        "{} are {number:?}",
        found.len()
    );
}

/// Functions of the standard library that use the system's mathematical library: their last digits depend on
/// the machine.
const OF_THE_SYSTEM: [&str; 25] = [
    "acos", "acosh", "asin", "asinh", "atan", "atan2", "atanh", "cbrt", "cos", "cosh", "exp", "exp2",
    "exp_m1", "hypot", "ln", "ln_1p", "log", "log10", "log2", "powf", "sin", "sin_cos", "sinh", "tan",
    "tanh",
];

/// Numbers of the lines, from 0 on, that call one of these functions in the code before its tests.
fn lines_of_the_system(code: &str) -> Vec<usize> {
    let calls = |line: &str| {
        let code = line.split("//").next().unwrap_or_default();
        OF_THE_SYSTEM.iter().any(|function| {
            let method = code.contains(&format!(".{function}("));
            method
                || ["f32", "f64"]
                    .iter()
                    .any(|float| code.contains(&format!("{float}::{function}")))
        })
    };
    let lines: Vec<&str> = code.lines().collect();
    let begins_tests =
        |k: &usize| lines[*k] == "#[cfg(test)]" && lines.get(k + 1).is_some_and(|line| line.ends_with('{'));
    let end = (0..lines.len()).find(begins_tests).unwrap_or(lines.len());
    (0..end).filter(|&k| calls(lines[k])).collect()
}

/// All sines, logarithms and similar functions in the results of slipfront come from libm, which is the same
/// on every system.
#[test]
fn no_number_is_left_to_the_system() {
    let repository = repository();
    let mut files = Vec::new();
    for folder in ["crates", "python/src"] {
        rust_files(&repository.join(folder), &mut files);
    }
    let mut found = String::new();
    for file in files.iter().filter(|file| !file.ends_with("tests.rs")) {
        for k in lines_of_the_system(&std::fs::read_to_string(file).unwrap()) {
            found += &format!("\n{}:{}", file.display(), k + 1);
        }
    }
    assert!(found.is_empty(), "take the function from libm:{found}");
}

#[test]
fn functions_of_the_system_are_found_in_code_and_not_in_tests() {
    let code = "use f64::consts::PI;\nx.sin()\n// x.sin()\nlibm::sin(x)\nxs.map(f64::ln)\n#[cfg(test)]\nmod tests;\nx.hypot(y)\n\
                #[cfg(test)]\nmod tests {\nx.exp()\n}\n";
    assert_eq!(lines_of_the_system(code), [1, 4, 7]);
}

/// Code blocks in documentation comments that `cargo test` may compile as examples: all blocks except texts.
fn examples(code: &str) -> Vec<String> {
    let comments = code.lines().map(str::trim_start);
    let comments = comments.filter_map(|line| line.strip_prefix("///").or_else(|| line.strip_prefix("//!")));
    let text: Vec<&str> = comments.collect();
    let examples = blocks(&text.join("\n"))
        .into_iter()
        .filter(|(language, _)| language != "text");
    examples.map(|(_, lines)| lines.join("\n")).collect()
}

/// Libraries without examples are excluded from doctests, because `cargo test` would compile each of them
/// again.
#[test]
fn libraries_whose_examples_are_not_run_have_none() {
    let repository = repository();
    let mut found = String::new();
    let folders = std::fs::read_dir(repository.join("crates")).unwrap();
    let folders = folders.map(|entry| entry.unwrap().path());
    for folder in folders.chain([repository.join("tests/fuzz")]) {
        let manifest = std::fs::read_to_string(folder.join("Cargo.toml")).unwrap();
        if !manifest.contains("doctest = false") {
            continue;
        }
        let mut files = Vec::new();
        rust_files(&folder.join("src"), &mut files);
        assert!(!files.is_empty());
        for file in files {
            for example in examples(&std::fs::read_to_string(&file).unwrap()) {
                found += &format!("\n{}:\n{example}", file.display());
            }
        }
    }
    assert!(
        found.is_empty(),
        "an example that is not run: take `doctest = false` out of Cargo.toml{found}"
    );
}

#[test]
fn examples_are_found_in_comments() {
    let code = "//! ```\n//! f();\n//! ```\n/// ```text\n/// a\n/// ```\n    /// ```no_run\n    /// g();\n    /// ```\nlet x = \"```\";\n";
    assert_eq!(examples(code), [" f();", " g();"]);
}

#[test]
fn unsafe_is_found_in_code_and_not_in_comments() {
    let code = "unsafe fn f() {}\n// unsafe\n#[allow(unsafe_code)]\nlet x = unsafe { g() };\nunsafe{h()} // unsafe\nunsafely();\n";
    assert_eq!(unsafe_lines(code), [0, 3, 4]);
}
