//! Small cases, and checks of the folders of their runs.

use std::io::Write;

use slipfront_study::project_folder::{Others, ResultFiles};

use crate::support::workspace::{Files, Workspace};

/// A small and quick case: 30 blocks, 800 steps.
pub(crate) const SMALL: &str = "[slider]\nblocks = [6, 5]\n[drive]\nv_star = 0.1\n";

/// [`SMALL`] with a mask.
pub(crate) const MASKED: &str =
    "[slider]\nblocks = [6, 5]\n[drive]\nv_star = 0.1\n[[texture]]\nshape='mask'\nfile='spot.png'\n";

/// Every file of a run without inputs (design, section 3).
pub(crate) const RUN_FILES: [&str; 12] = [
    "case.toml",
    "fields.nc",
    "friction.png",
    "friction.svg",
    "front.png",
    "front.svg",
    "kymograph.nc",
    "manifest.json",
    "series.csv",
    "stress.png",
    "stress.svg",
    "summary.json",
];

/// Updates the checksum of a file in a results folder to its present contents, as a forger would. The journal
/// is not listed, as in lists of earlier versions.
pub(crate) fn list_as_written(workspace: &Workspace, folder: &str, name: &str) {
    let bytes = workspace.read(&format!("{folder}/{name}"));
    let list = workspace.read_text(&format!("{folder}/checksums.json"));
    let of = ["study", "design", "calibration", "paper"]
        .into_iter()
        .find(|of| list.contains(&format!("\"of\": \"{of}\"")));
    let mut batch = ResultFiles::new(&workspace.path(folder), of.unwrap(), true).begin();
    batch.write(name, |to| to.write_all(&bytes)).unwrap();
    batch.place(Others::Stay, Vec::new()).unwrap();
}

impl Workspace {
    /// A workspace with `small.toml`.
    pub(crate) fn small() -> Self {
        let workspace = Self::new();
        workspace.write("small.toml", SMALL);
        workspace
    }

    /// A workspace with `small.toml`, and with `masked.toml` and its mask `spot.png`.
    pub(crate) fn masked() -> Self {
        let workspace = Self::small();
        workspace.succeed("texture small.toml -o spot.png --set texture.0={shape=\"cavity\",coverage=15}");
        workspace.write("masked.toml", MASKED);
        workspace
    }

    pub(crate) fn summary(&self, folder: &str) -> serde_json::Value {
        serde_json::from_slice(&self.read(&format!("{folder}/summary.json"))).unwrap()
    }

    /// Every file of a run except the manifest, which may differ between repetitions.
    pub(crate) fn run_files(&self, folder: &str) -> Files {
        let mut files = self.files(folder);
        assert!(files.remove("manifest.json").is_some(), "{folder} is incomplete");
        files
    }

    /// Turns the folder of a complete run into one of a run that was killed before it wrote its manifest: a
    /// journal lists the files instead of the manifest.
    pub(crate) fn interrupt(&self, folder: &str) {
        let manifest = format!("{folder}/manifest.json");
        let listed: serde_json::Value = serde_json::from_slice(&self.read(&manifest)).unwrap();
        let lines = listed["files"].as_array().unwrap().iter();
        let lines: String = lines.map(|file| format!("{file}\n")).collect();
        self.write(&format!("{folder}/.slipfront/journal.jsonl"), lines);
        self.remove(&manifest);
    }

    /// Asserts that two runs have the same bytes, file by file.
    pub(crate) fn assert_same_run(&self, one: &str, other: &str) {
        let (one_files, other_files) = (self.run_files(one), self.run_files(other));
        let names: Vec<_> = one_files.keys().collect();
        assert_eq!(names, other_files.keys().collect::<Vec<_>>(), "{one}, {other}");
        for (name, bytes) in &one_files {
            assert!(
                bytes == &other_files[name],
                "{name} differs between {one} and {other}"
            );
        }
    }
}

/// Printed text with every wrapped note joined to one line.
pub(crate) fn unwrapped(text: &str) -> String {
    text.replace("\n      ", " ")
}
