//! A small study, and checks of the folders of its results.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

use crate::support::process::wait_for;
use crate::support::workspace::Workspace;

/// Six points on a lattice of 36 blocks, three surfaces and their references: 36 runs of about a millisecond.
pub(crate) const SMALL: &str = r#"
[base.slider]
blocks = [6, 6]
[base.time]
stop = "after_onset"
[[base.texture]]
shape = "groove"
coverage = 17
[study]
replicates = 3
reference = { texture = [] }
[[axes]]
key = "drive.v_star"
list = [0.08, 0.1, 0.12, 0.14, 0.16, 0.18]
"#;

/// Number of runs of [`SMALL`].
pub(crate) const SMALL_RUNS: usize = 36;

impl Workspace {
    /// A workspace with `study.toml`.
    pub(crate) fn with_study(study: &str) -> Self {
        let workspace = Self::new();
        workspace.write("study.toml", study);
        workspace
    }

    /// Runs `study.toml` into a folder.
    pub(crate) fn study(&self, out: &str) -> Results {
        self.succeed(&format!("study study.toml -o {out}"));
        self.results(out)
    }

    /// The results in a folder, which need not exist yet.
    pub(crate) fn results(&self, out: &str) -> Results {
        Results { path: self.path(out) }
    }
}

/// A folder with the results of a study.
pub(crate) struct Results {
    pub(crate) path: PathBuf,
}

impl Results {
    /// Tables and pictures by name: all files that must not depend on how they were made.
    pub(crate) fn answer(&self) -> BTreeMap<String, Vec<u8>> {
        let files = std::fs::read_dir(&self.path)
            .unwrap()
            .map(|entry| entry.unwrap().path());
        let shown = files.filter(|path| {
            path.extension()
                .is_some_and(|ending| ending == "csv" || ending == "svg" || ending == "png")
        });
        let answer: BTreeMap<String, Vec<u8>> = shown
            .map(|path| {
                let name = path.file_name().unwrap().to_string_lossy().into_owned();
                (name, std::fs::read(path).unwrap())
            })
            .collect();
        assert!(answer.contains_key("runs.csv") && answer.contains_key("points.csv"));
        assert!(answer.len() >= 4, "no pictures: {:?}", answer.keys());
        answer
    }

    pub(crate) fn assert_same(&self, other: &Self) {
        let (one, other) = (self.answer(), other.answer());
        let names: Vec<&String> = one.keys().collect();
        assert_eq!(names, other.keys().collect::<Vec<_>>());
        for (name, bytes) in &one {
            assert!(*bytes == other[name], "{name} differs");
        }
    }

    pub(crate) fn records(&self) -> PathBuf {
        self.path.join("runs.jsonl")
    }

    /// Identities of the recorded runs, in order; none if there is no journal yet.
    pub(crate) fn recorded(&self) -> Vec<String> {
        if !self.records().exists() {
            return Vec::new();
        }
        let text = String::from_utf8_lossy(&std::fs::read(self.records()).unwrap()).into_owned();
        let whole = text.split_inclusive('\n').filter(|line| line.ends_with('\n'));
        whole
            .filter_map(|line| serde_json::from_str::<serde_json::Value>(line.get(17..)?).ok())
            // A damaged line may have lost its identity.
            .filter_map(|record| Some(record["id"].as_str()?.to_owned()))
            .collect()
    }

    /// Waits until `more` further runs are recorded.
    pub(crate) fn wait_for_runs(&self, more: usize) {
        let before = self.recorded().len();
        wait_for("new record of a run", || self.recorded().len() >= before + more);
    }

    /// Asserts that `count` runs were made, each once.
    pub(crate) fn assert_each_run_once(&self, count: usize) {
        let recorded = self.recorded();
        let different: BTreeSet<&String> = recorded.iter().collect();
        assert_eq!((recorded.len(), different.len()), (count, count));
    }

    /// Rows of a table, by column names.
    pub(crate) fn table(&self, name: &str) -> Vec<BTreeMap<String, String>> {
        let mut table = csv::Reader::from_path(self.path.join(name)).unwrap();
        table.deserialize().map(|row| row.unwrap()).collect()
    }

    /// Numbers of a column of `runs.csv` at one point and role, by replicate.
    pub(crate) fn numbers(&self, point: usize, role: &str, column: &str) -> Vec<f64> {
        self.table("runs.csv")
            .iter()
            .filter(|row| row["point"] == point.to_string() && row["role"] == role)
            .map(|row| row[column].parse().unwrap())
            .collect()
    }

    pub(crate) fn has(&self, name: &str) -> bool {
        self.path.join(name).exists()
    }
}

pub(crate) fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

pub(crate) fn deviation(values: &[f64]) -> f64 {
    let mean = mean(values);
    let squares: f64 = values.iter().map(|value| (value - mean).powi(2)).sum();
    (squares / (values.len() - 1) as f64).sqrt()
}

/// A mask file of exactly `nx` by `ny` blocks; `textured` says which blocks are textured.
pub(crate) fn mask(nx: usize, ny: usize, textured: impl Fn(usize, usize) -> bool) -> Vec<u8> {
    let header = format!("{{'descr': '|b1', 'fortran_order': False, 'shape': ({ny}, {nx}), }}");
    let padded = format!("{header:<117}\n");
    let mut bytes = b"\x93NUMPY\x01\x00\x76\x00".to_vec();
    assert_eq!(padded.len(), 0x76);
    bytes.extend(padded.as_bytes());
    for j in 0..ny {
        bytes.extend((0..nx).map(|i| u8::from(textured(i, j))));
    }
    bytes
}

/// A table of numbers with one line per row of blocks.
pub(crate) fn field(nx: usize, ny: usize, value: impl Fn(usize, usize) -> f64) -> String {
    let row = |j: usize| {
        let cells: Vec<String> = (0..nx).map(|i| value(i, j).to_string()).collect();
        cells.join(",") + "\n"
    };
    (0..ny).map(row).collect()
}

/// Whether a folder exists and has something in it.
pub(crate) fn filled(path: &Path) -> bool {
    path.read_dir().is_ok_and(|mut entries| entries.next().is_some())
}
