use std::fs;
use std::path::Path;

use slipfront_case::case::Case;
use slipfront_case::case_file::{CaseError, CaseFile};

fn refused(text: &str, overrides: &[&str]) -> String {
    let overrides: Vec<String> = overrides.iter().map(|&entry| entry.to_owned()).collect();
    let message = CaseFile::parse(text, "hostile.toml", &overrides)
        .unwrap_err()
        .to_string();
    assert!(message.len() < 2000, "a message of {} bytes", message.len());
    message
}

#[test]
fn deep_nesting_is_refused_without_overflow() {
    const DEPTH: usize = 100_000;
    const REFUSAL: &str = "brackets and the parts of keys lead more than 64 levels deep here";
    for (open, close) in [("[", "]"), ("{ a = ", "}")] {
        let nested = format!("{}1{}", open.repeat(DEPTH), close.repeat(DEPTH));
        assert!(refused(&format!("a = {nested}"), &[]).contains(REFUSAL));
        assert!(refused("", &[&format!("a={nested}")]).contains(REFUSAL));
        assert!(refused("", &[&format!("a={}", open.repeat(DEPTH))]).contains(REFUSAL));
    }
    // Brackets that close nothing must not count as the end of open ones.
    for piece in ["{ [], a = ", "{ b = 1 [x], a = ", "[ }, ", "{ a = ], b = "] {
        let nested = piece.repeat(DEPTH);
        assert!(refused(&format!("a = {nested}"), &[]).contains(REFUSAL));
        assert!(refused("", &[&format!("a={nested}")]).contains(REFUSAL));
    }
    let dotted = vec!["a"; DEPTH].join(".");
    for text in [
        format!("{dotted} = 1"),
        format!("[{dotted}]"),
        format!("[[{dotted}]]"),
    ] {
        assert!(refused(&text, &[]).contains(REFUSAL));
    }
    refused("", &[&format!("{dotted}=1")]);
    // Neither the keys nor the brackets alone are too deep for the TOML parser.
    let key = ["a"; 79].join(".");
    let nested = format!("{}1{}", format!("{{ {key} = ").repeat(75), "}".repeat(75));
    assert!(refused(&format!("[drive]\nv_star = {nested}"), &[]).contains(REFUSAL));
    assert!(refused("", &[&format!("drive.v_star={nested}")]).contains(REFUSAL));
    refused(
        &format!("[slider]\nblocks = {}1{}", "[".repeat(60), "]".repeat(60)),
        &[],
    );
}

#[test]
fn long_lines_and_odd_characters_make_short_messages() {
    let long = "x".repeat(1_000_000);
    refused(&format!("[load]\n{long} = 3"), &[]);
    refused(&format!("[load]\npressure = \"{long}\""), &[]);
    refused(&format!("[friction]\nlaw = \"{long}\""), &[]);
    refused(&format!("[[texture]]\nshape = \"{long}\""), &[]);
    refused(&format!("{long} = 3"), &[]);
    refused("", &[&format!("load.{long}=3")]);
    refused("", &[&format!("load.pressure={long}")]);
    refused("[load]\n\"pres\\nsure\" = 3", &[]);
    refused("[load]\n\"\\u0007\" = \"\u{1f600}\" # \u{1f600}", &[]);
    refused("\u{1f600}", &[]);
    refused("[load]\npressure = \"\u{1f600}", &[]);
    refused("a = 1979-05-27T07:32:00Z", &[]);
    refused("[load]\npressure = 1979-05-27", &[]);
    refused("[time]\nstep = 1979-05-27", &[]);
}

/// Long table names are not stored again for each of their keys: megabytes must not become terabytes.
#[test]
fn long_names_of_tables_are_not_repeated_for_every_key() {
    let keys: String = (0..100_000).map(|key| format!("k{key}=1\n")).collect();
    let message = refused(&format!("[{}]\n{keys}", "x".repeat(1_000_000)), &[]);
    assert!(message.contains("unknown table `xxx"), "{message}");
    let message = refused(&format!("[slider.{}]\n{keys}", "x".repeat(1_000_000)), &[]);
    assert!(message.contains("unknown key `xxx"), "{message}");
}

#[test]
fn files_that_cannot_be_read_say_why() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("case.toml");
    let load = |path: &Path| CaseFile::load(path, &[]).unwrap_err();
    assert!(matches!(load(&path), CaseError::Unreadable { .. }));
    assert!(load(&path).to_string().starts_with("cannot read "));
    assert!(
        load(folder.path())
            .to_string()
            .ends_with("is a folder: name the file in it")
    );
    fs::write(&path, b"[load]\n# \xff\n").unwrap();
    assert!(
        load(&path)
            .to_string()
            .ends_with("case.toml:2: the file is not UTF-8 text: save it again with the encoding UTF-8")
    );
    fs::write(&path, vec![b'\n'; (16 << 20) + 1]).unwrap();
    assert!(load(&path).to_string().contains("is larger than 16 MiB"));
    fs::write(&path, "[load]\npressure = 3\n").unwrap();
    assert!(
        load(&path)
            .to_string()
            .starts_with(&format!("{}:2:12: ", path.display()))
    );
}

/// The error about a misspelt name suggests the intended file: in the same folder, or in its folder `cases`.
#[test]
fn a_misspelt_file_is_named() {
    let folder = tempfile::tempdir().unwrap();
    fs::create_dir(folder.path().join("cases")).unwrap();
    for name in ["circle.toml", "cases/groove_across.toml"] {
        fs::write(folder.path().join(name), "").unwrap();
    }
    for (written, meant) in [
        ("circel.toml", Some("circle.toml")),
        ("circle", Some("circle.toml")),
        ("groove_across.toml", Some("cases/groove_across.toml")),
        ("cases/groove-across.toml", Some("cases/groove_across.toml")),
        ("something_else.toml", None),
    ] {
        let path = folder.path().join(written);
        let said = CaseFile::load(&path, &[]).unwrap_err().to_string();
        let expected = match meant {
            Some(meant) => format!(
                "there is no file {}: did you mean {}?",
                path.display(),
                folder.path().join(meant).display()
            ),
            None => format!("cannot read {}: ", path.display()),
        };
        assert!(said.starts_with(&expected), "{said}");
    }
    // Files of a case, too: with their own extension.
    fs::write(folder.path().join("mask.png"), "").unwrap();
    let text = "slider.blocks = [5, 5]\ntexture = [{ shape = 'mask', file = 'maskk.png' }]";
    let said = Case::parse(text, "case", folder.path(), &[])
        .unwrap_err()
        .to_string();
    let expected = format!(
        "there is no such file (did you mean {}?)",
        folder.path().join("mask.png").display()
    );
    assert!(said.contains(&expected), "{said}");
}
