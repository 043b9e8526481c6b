//! Files of the disk that a case may name.
#![cfg(unix)]

use std::os::unix::fs::symlink;
use std::path::{Path, PathBuf};

use serde_json::json;
use slipfront_lab::Start;
use tempfile::TempDir;

use crate::laboratory::Served;
use crate::page::Page;

const SECRET: &str = "0.5,0.25\n0.125,0.0625\n";

/// A folder `case` from somebody else, and next to it a folder with a file of the user.
fn folders() -> TempDir {
    let all = tempfile::tempdir().unwrap();
    for folder in ["case", "mine"] {
        std::fs::create_dir(all.path().join(folder)).unwrap();
    }
    std::fs::write(all.path().join("mine/secret.csv"), SECRET).unwrap();
    std::fs::write(all.path().join("case/own.csv"), SECRET).unwrap();
    symlink("../mine/secret.csv", all.path().join("case/link.csv")).unwrap();
    symlink("../mine", all.path().join("case/folder")).unwrap();
    all
}

fn write_case(all: &TempDir, name: &str) -> PathBuf {
    let path = all.path().join("case/evil.toml");
    std::fs::write(
        &path,
        format!("slider.blocks = [2, 2]\nfriction.mu_static_field = '{name}'\n"),
    )
    .unwrap();
    path
}

/// The error with which the laboratory does not start.
fn refused(path: &Path, allowed: &[PathBuf]) -> String {
    Start::read(path, allowed).err().unwrap().to_string()
}

#[test]
fn a_case_names_files_of_its_folder_and_of_those_that_are_allowed() {
    let all = folders();
    let mine = all.path().join("mine").canonicalize().unwrap();
    let absolute = mine.join("secret.csv").display().to_string();
    for name in [
        "../mine/secret.csv",
        "link.csv",
        "folder/secret.csv",
        "./folder/../mine/secret.csv",
        &absolute,
    ] {
        let path = write_case(&all, name);
        let said = refused(&path, &[]);
        let place = format!(
            "evil:2:28: {name} cannot be read: it lies in {}, outside of the folder of the case",
            mine.display()
        );
        assert!(said.contains(&place), "{said}");
        assert!(
            said.contains(&format!(
                "start `slipfront lab` with --allow-files {}",
                mine.display()
            )),
            "{said}"
        );
        assert!(Start::read(&path, &[all.path().join("mine")]).is_ok(), "{name}");
        // The allowed folder is not the one with the file.
        assert!(
            refused(&path, &[all.path().join("case")]).contains("outside"),
            "{name}"
        );
        assert!(
            refused(&path, &[all.path().join("none")]).contains("none cannot be found"),
            "{name}"
        );
    }
    for name in ["own.csv", "./own.csv", "../case/own.csv"] {
        assert!(Start::read(&write_case(&all, name), &[]).is_ok(), "{name}");
    }
    // The rule holds for every key that names a file, not only for those of coefficients.
    for ending in ["npy", "png"] {
        std::fs::write(mine.join(format!("secret.{ending}")), SECRET).unwrap();
    }
    for (start, ending) in [
        ("slider.outline = 'mask'\nslider.outline_file", "png"),
        ("slider.stiffness_field", "csv"),
        ("slider.density_field", "npy"),
        ("load.pressure_field", "csv"),
        ("drive.attach_file", "npy"),
        ("friction.mu_kinetic_field", "csv"),
        ("[[texture]]\nshape = 'mask'\nfile", "png"),
        (
            "[[texture]]\nshape = 'height_map'\nbearing_percent = 60\nfile",
            "csv",
        ),
    ] {
        let path = all.path().join("case/other.toml");
        std::fs::write(&path, format!("{start} = '../mine/secret.{ending}'\n")).unwrap();
        let said = refused(&path, &[]);
        assert!(
            said.contains("outside of the folder of the case"),
            "{start}: {said}"
        );
    }
}

/// Links and exports of a case contain the files in its folder or in an allowed one.
#[test]
fn links_and_exports_hold_the_files_that_were_read() {
    let all = folders();
    let start = Start::read(
        &write_case(&all, "../mine/secret.csv"),
        &[all.path().join("mine")],
    )
    .unwrap();
    let lab = Served::with(start);
    let mut page = Page::open(&lab);
    page.send(&json!({ "do": "open", "source": {} }));
    assert_eq!(page.reply("case")["files"], json!(["secret.csv"]));
    // A case that the page sends reads no file of the disk, allowed or not.
    let secret = all.path().join("mine/secret.csv").display().to_string();
    for name in [secret.as_str(), "../mine/secret.csv", "case/own.csv"] {
        let toml = format!("slider.blocks = [2, 2]\nfriction.mu_static_field = '{name}'\n");
        let said = page.refusal(&json!({ "do": "open", "source": { "toml": toml } }));
        assert!(
            said.contains("is not one of the files that came with the case"),
            "{said}"
        );
        let said =
            page.refusal(&json!({ "do": "set", "keys": { "load.pressure_field": name }, "gesture": 1 }));
        assert!(said.contains("is not one of the files of the case"), "{said}");
    }
    // A file that no key names any more is not exported either.
    page.send(&json!({ "do": "set", "keys": { "friction.mu_static_field": null }, "gesture": 2 }));
    page.wait_for("the change", |reply| reply["why"] == "change");
    page.send(&json!({ "do": "export" }));
    assert_eq!(page.reply("exported")["files"], json!({}));
    page.send(&json!({ "do": "undo" }));
    page.send(&json!({ "do": "export" }));
    assert!(page.reply("exported")["files"]["secret.csv"].is_string());
}

/// The cases of the repository name files in their own folder.
#[test]
fn the_cases_of_the_repository_can_be_opened() {
    let cases = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../cases");
    let mut with_files = 0;
    for entry in std::fs::read_dir(cases).unwrap() {
        let path = entry.unwrap().path();
        if path.extension().is_some_and(|ending| ending == "toml") {
            with_files += usize::from(std::fs::read_to_string(&path).unwrap().contains("file = "));
            if let Err(error) = Start::read(&path, &[]) {
                let too_large = "more than the 524288 that the laboratory shows";
                assert!(
                    error.to_string().contains(too_large),
                    "{}: {error}",
                    path.display()
                );
            }
        }
    }
    assert!(with_files > 0);
}

/// A run folder that is a link out of the results, and runs with files that are such links, are refused.
#[test]
fn run_folders_hold_their_files_themselves() {
    let lab = Served::new();
    let mut page = Page::with_case(&lab, "slider.blocks = [4, 4]\ntime.duration_star = 20\n");
    page.reply("case");
    page.send(&json!({ "do": "save", "name": "run" }));
    page.reply("saved");
    let elsewhere = tempfile::tempdir().unwrap();
    let moved = elsewhere.path().join("run");
    std::fs::rename(lab.results().join("run"), &moved).unwrap();
    symlink(&moved, lab.results().join("run")).unwrap();
    let said = page.refusal(&json!({ "do": "open", "source": { "folder": "run" } }));
    assert!(
        said.contains("outside of the folder of the results") && said.contains("--allow-files"),
        "{said}"
    );
    // The user may name such a run at the start.
    assert!(Start::read(&lab.results().join("run"), &[]).is_ok());
    for name in [
        "case.toml",
        "summary.json",
        "series.csv",
        "fields.nc",
        "manifest.json",
    ] {
        let away = elsewhere.path().join(name);
        std::fs::rename(moved.join(name), &away).unwrap();
        symlink(&away, moved.join(name)).unwrap();
        let said = refused(&moved, &[]);
        assert!(
            said.contains(name) && said.contains("outside of the folder of the run"),
            "{said}"
        );
        assert!(Start::read(&moved, &[elsewhere.path().to_owned()]).is_ok());
        std::fs::remove_file(moved.join(name)).unwrap();
        std::fs::rename(&away, moved.join(name)).unwrap();
    }
    assert!(Start::read(&moved, &[]).is_ok());
}
