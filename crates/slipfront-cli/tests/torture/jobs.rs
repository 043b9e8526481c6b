//! Commands that write folders: their inputs, how they continue, and the required contents of their folders.

use std::collections::BTreeMap;
use std::sync::{LazyLock, Mutex};

use serde_json::Value;

use crate::support::workspace::{Files, Workspace};

/// A command that writes the folder `out`.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Job {
    pub(crate) name: &'static str,
    /// Folder of a finished run that the job gets, in addition to an empty folder `out`; none for a job
    /// without such a folder.
    pub(crate) given_run: Option<&'static str>,
    /// Command line of the first call.
    pub(crate) line: &'static str,
    /// Command line after a stop of any kind.
    pub(crate) again: &'static str,
    /// Command line after a stop before there was anything to continue.
    pub(crate) anew: &'static str,
    /// Whether SIGUSR1 makes the command save its state.
    pub(crate) saves: bool,
    /// Whether `slipfront verify` can check such folders.
    pub(crate) verified: bool,
}

/// All jobs.
pub(crate) const JOBS: [Job; 13] = [
    Job {
        name: "run",
        given_run: None,
        line: "run case.toml --quiet --threads 1 -o out",
        again: "run case.toml --quiet --threads 1 -o out --force",
        anew: "run case.toml --quiet --threads 1 -o out --force",
        saves: false,
        verified: true,
    },
    into_a_folder("study", "study study.toml --quiet --threads 1 -o out"),
    into_a_folder("paper", "paper fig02 fig13 --reduced --quiet --threads 1 -o out"),
    Job {
        name: "resumed run",
        given_run: None,
        line: "run slow.toml --quiet --threads 1 --checkpoint 0s -o out",
        again: "run --resume out --quiet --threads 1 --checkpoint 0s",
        anew: "run slow.toml --quiet --threads 1 --checkpoint 0s -o out --force",
        saves: true,
        verified: true,
    },
    on_a_run("plot", "plot done --force -o out"),
    on_a_run("movie", "movie done --force -o out/movie.gif"),
    on_a_run("texture", "texture case.toml --force -o out/texture.png"),
    // It works in the folder for temporary files.
    on_a_run("repeated run", "verify --rerun --quiet --threads 1 done"),
    Job {
        given_run: Some("out"),
        verified: true,
        ..on_a_run("export", "export out --ro-crate --force")
    },
    into_a_folder("merge", "study merge shard-1 shard-2 --quiet -o out"),
    into_a_folder(
        "calibrate",
        "calibrate fit.toml record.csv --quiet --threads 1 -o out",
    ),
    into_a_folder("converge", "converge sheet.toml --quiet --threads 1 -o out"),
    into_a_folder("design", "design wish.toml --quiet --threads 1 -o out"),
];

/// A job with the same command line for every call.
const fn on_a_run(name: &'static str, line: &'static str) -> Job {
    Job {
        given_run: Some("done"),
        verified: false,
        ..into_a_folder(name, line)
    }
}

/// A job that makes the folder `out` and continues there with the same command line.
const fn into_a_folder(name: &'static str, line: &'static str) -> Job {
    Job {
        name,
        given_run: None,
        line,
        again: line,
        anew: line,
        saves: false,
        verified: true,
    }
}

/// A case that reads every kind of input file.
const CASE: &str = r#"# A small and quick one.
[slider]
blocks = [6, 5]
[drive]
v_star = 0.1
[friction]
mu_static_field = "mu_s.csv"
mu_kinetic_field = "mu_k.npy"
[[texture]]
shape = "mask"
file = "mask.png"
[[texture]]
shape = "mask"
file = "mask.npy"
[time]
duration_star = 60
[output]
snapshots = [30, 50]
series = 1
"#;

/// Takes some tenths of a second, also on a fast machine, in which checkpoints are saved.
const SLOW: &str = r#"
[slider]
blocks = [40, 30]
[drive]
v_star = 0.05
[[texture]]
shape = "mask"
file = "mask.png"
[time]
duration_star = 2400
[output]
snapshots = [30, 500]
series = 5
"#;

const STUDY: &str = r#"# Two points, three surfaces of each.
[base.slider]
blocks = [4, 4]
[base.time]
duration_star = 40
[base.output]
snapshots = []
series = 1
[[base.texture]]
shape = "mask"
file = "dot.npy"
[study]
replicates = 3
[[axes]]
key = "drive.v_star"
list = [0.1, 0.2]
"#;

/// A study that keeps its run folders.
const KEPT: &str = r#"
[study]
keep = "all"
[[axes]]
key = "drive.v_star"
list = [0.2]
[base]
slider = { blocks = [3, 3] }
time = { duration_star = 20 }
output = { snapshots = [], series = 1 }
"#;

/// The smallest number of runs of a calibration.
const FIT: &str = r#"
[base]
slider.blocks = [2, 2]
drive.v_star = 0.2
time.step = 0.4
[calibrate]
x = "time_s"
y = "friction_force_n"
noise = 0.02
runs = 200
finer_runs = 0
[calibrate.unknowns]
"friction.mu_static" = [0.3, 0.9]
"#;

const SHEET: &str = r#"
[slider]
blocks = [8, 8]
block_size = "50 um"
thickness = "20 um"
[drive]
v_star = 0.05
stiffness_per_area = "1875 MPa/um"
[friction]
sigma_static_star = 0
sigma_kinetic_star = 0
slip_weakening = { length_star = 0.4 }
[time]
stop = "after_onset"
"#;

/// A search with few runs, followed by the verdict.
const WISH: &str = r#"
[base]
slider.blocks = [4, 4]
drive.v_star = 0.2
[design]
wish = { least = "static_friction" }
coverage = [0, 15]
runs = 20
"#;

/// Inputs of jobs that other commands make: two shards of the study, and a record of friction.
static MADE: LazyLock<Files> = LazyLock::new(|| {
    let workspace = given_workspace();
    for shard in [1, 2] {
        let line = format!("study study.toml --quiet --shard {shard}/2 -o made/shard-{shard}");
        workspace.succeed_bounded(&line).unwrap();
    }
    workspace.write(
        "truth.toml",
        "slider.blocks = [2, 2]\ndrive.v_star = 0.2\nfriction.mu_static = 0.6\n\
         time = { step = 0.4, duration_star = 60 }\noutput = { snapshots = [], series = 1 }\n",
    );
    workspace
        .succeed_bounded("run truth.toml --quiet --no-pictures -o truth")
        .unwrap();
    workspace.write("made/record.csv", workspace.read("truth/series.csv"));
    workspace.files("made")
});

/// A numpy array: `ny` rows of `nx` values of a type such as `|b1`.
fn npy(kind: &str, nx: usize, ny: usize, data: &[u8]) -> Vec<u8> {
    let header = format!("{{'descr': '{kind}', 'fortran_order': False, 'shape': ({ny}, {nx}), }}");
    let mut bytes = b"\x93NUMPY\x01\x00\x76\x00".to_vec();
    bytes.extend(format!("{header:<117}\n").into_bytes());
    bytes.extend(data);
    bytes
}

/// A workspace with all inputs of the jobs.
pub(crate) fn workspace() -> Workspace {
    let workspace = given_workspace();
    for (name, bytes) in MADE.iter() {
        workspace.write(name, bytes);
    }
    workspace
}

/// A workspace with the files that a user would provide.
fn given_workspace() -> Workspace {
    let workspace = Workspace::new();
    std::fs::create_dir(workspace.path("temporary")).unwrap();
    let numbers: Vec<u8> = (0..30)
        .flat_map(|k| (0.4 + 0.01 * f64::from(k % 7)).to_le_bytes())
        .collect();
    workspace.write("mu_k.npy", npy("<f8", 6, 5, &numbers));
    workspace.write("mu_s.csv", "1.0, 0.9, 1.1, 0.95, 1.05, 1.0\n".repeat(5));
    workspace.write(
        "mask.npy",
        npy(
            "|b1",
            6,
            5,
            &std::array::from_fn::<u8, 30, _>(|k| u8::from(k == 3)),
        ),
    );
    workspace.write(
        "dot.npy",
        npy(
            "|b1",
            4,
            4,
            &std::array::from_fn::<u8, 16, _>(|k| u8::from(k == 5)),
        ),
    );
    workspace.write(
        "spot.toml",
        "[slider]\nblocks = [6, 5]\n[[texture]]\nshape = 'cavity'\ncoverage = 15\n",
    );
    workspace
        .succeed_bounded("texture spot.toml -o mask.png")
        .unwrap();
    workspace.write("case.toml", CASE);
    workspace.write("slow.toml", SLOW);
    workspace.write("study.toml", STUDY);
    workspace.write("kept.toml", KEPT);
    workspace.write("fit.toml", FIT);
    workspace.write("sheet.toml", SHEET);
    workspace.write("wish.toml", WISH);
    workspace
}

impl Job {
    /// Prepares the state before the job.
    pub(crate) fn prepare(&self, workspace: &Workspace) {
        workspace.remove("out");
        workspace.remove("temporary");
        std::fs::create_dir(workspace.path("temporary")).unwrap();
        if let Some(folder) = self.given_run {
            workspace.fill(folder, &JOBS[0].undisturbed());
            std::fs::create_dir_all(workspace.path("out")).unwrap();
        }
    }

    /// The folder `out` of an undisturbed job.
    pub(crate) fn undisturbed(&self) -> Files {
        static WHOLE: Mutex<BTreeMap<&str, Files>> = Mutex::new(BTreeMap::new());
        let known = WHOLE.lock().unwrap().get(self.name).cloned();
        known.unwrap_or_else(|| {
            let workspace = workspace();
            self.prepare(&workspace);
            workspace.succeed_bounded(self.line).unwrap();
            let whole = workspace.files_if_any("out");
            WHOLE.lock().unwrap().insert(self.name, whole.clone());
            whole
        })
    }
}

/// Whether the name is that of a file that is being written, or of an incomplete run.
fn unfinished(name: &str) -> bool {
    name.split('/').any(|part| part.starts_with('.'))
}

/// Whether the contents of a file depend on the time at which it was made.
fn told_by_time(name: &str) -> bool {
    name.ends_with("manifest.json") || name.ends_with(".jsonl") || name == RO_CRATE
}

/// The description of a run, which is written after its manifest.
const RO_CRATE: &str = "ro-crate-metadata.json";

/// Files made from a complete folder, which is complete even without them.
const MADE_LAST: [&str; 3] = [RO_CRATE, "convergence.json", "convergence.txt"];

/// Outcomes of recorded runs, by identity. A run that is recorded twice is a finding.
fn records(bytes: &[u8]) -> Result<BTreeMap<String, Value>, String> {
    let mut found = BTreeMap::new();
    for line in bytes.split(|&byte| byte == b'\n') {
        let Some((sum, json)) = line.split_at_checked(17) else {
            continue;
        };
        if !sum.starts_with(&blake3::hash(json).to_hex().as_bytes()[..16]) {
            continue;
        }
        let record: Value = serde_json::from_slice(json).map_err(|error| error.to_string())?;
        let id = record["id"].as_str().unwrap_or_default().to_owned();
        if found.insert(id, record["outcome"].clone()).is_some() {
            return Err("a run is recorded twice".to_owned());
        }
    }
    Ok(found)
}

/// Asserts that a folder contains only correct files, some of which may be missing.
pub(crate) fn expect_sound(now: &Files, whole: &Files) -> Result<(), String> {
    for (name, bytes) in now {
        if name.ends_with(".json") && serde_json::from_slice::<Value>(bytes).is_err() {
            return Err(format!("{name} is not whole"));
        }
        // The list of results grows with them.
        if unfinished(name) || told_by_time(name) || name == "checksums.json" {
            continue;
        }
        match whole.get(name) {
            Some(whole) if whole == bytes => {}
            Some(_) => return Err(format!("{name} is wrong")),
            None => return Err(format!("{name} should not be there")),
        }
    }
    // A manifest promises that all other files exist.
    let is_missing = |name: &str| !MADE_LAST.contains(&name) && !now.contains_key(name);
    for manifest in now.keys().filter(|name| name.ends_with("manifest.json")) {
        let folder = manifest.trim_end_matches("manifest.json");
        let missing = whole
            .keys()
            .find(|name| name.starts_with(folder) && is_missing(name));
        if let Some(missing) = missing {
            return Err(format!("{manifest} is there, and {missing} is not"));
        }
    }
    Ok(())
}

/// Asserts that a folder contains exactly the expected files.
pub(crate) fn expect_complete(now: &Files, whole: &Files) -> Result<(), String> {
    expect_nothing_unfinished(now)?;
    expect_all(now, whole)
}

/// Asserts that a folder contains no file that is being written.
pub(crate) fn expect_nothing_unfinished(now: &Files) -> Result<(), String> {
    match now.keys().find(|name| unfinished(name)) {
        Some(left) => Err(format!("{left} is left behind")),
        None => Ok(()),
    }
}

/// Asserts that the folder for temporary files is empty.
pub(crate) fn expect_nothing_temporary(workspace: &Workspace) -> Result<(), String> {
    let mut left = std::fs::read_dir(workspace.path("temporary")).unwrap();
    match left.next() {
        Some(left) => Err(format!("{:?} is left behind", left.unwrap().path())),
        None => Ok(()),
    }
}

/// The list of result files of a folder, without the checksum of the journal, which tells times.
fn listed(files: &Files) -> Option<Value> {
    let mut list: Value = serde_json::from_slice(files.get("checksums.json")?).ok()?;
    list.as_object_mut()?
        .retain(|key, _| !["sources", "seal"].contains(&key.as_str()));
    Some(list)
}

/// Asserts that a folder contains all expected files; it may also contain unfinished ones.
pub(crate) fn expect_all(now: &Files, whole: &Files) -> Result<(), String> {
    if let Some(missing) = whole.keys().find(|name| !now.contains_key(*name)) {
        return Err(format!("{missing} is missing"));
    }
    expect_sound(now, whole)?;
    if listed(now) != listed(whole) {
        return Err("checksums.json is wrong".to_owned());
    }
    if let (Some(now), Some(whole)) = (now.get("runs.jsonl"), whole.get("runs.jsonl")) {
        let now = records(now)?;
        // The records may also contain runs of another study.
        if records(whole)?
            .iter()
            .any(|(id, outcome)| now.get(id) != Some(outcome))
        {
            return Err("a run is not recorded, or otherwise".to_owned());
        }
    }
    Ok(())
}

impl Job {
    /// Next command line, from the state of the folder.
    pub(crate) fn next(&self, workspace: &Workspace, whole: &Files) -> &'static str {
        // A run can be resumed if its case and all inputs are there.
        let read = |name: &&String| *name == "case.toml" || name.starts_with("inputs/");
        let whole_case = whole
            .keys()
            .filter(read)
            .all(|name| workspace.path("out").join(name).exists());
        let complete = workspace.path("out/manifest.json").exists();
        match workspace.path("out").exists() {
            false => self.line,
            // Resuming a complete run does nothing.
            true if whole_case && !(complete && self.saves) => self.again,
            true => self.anew,
        }
    }

    /// Lets the job continue to its end, and asserts the right answer.
    pub(crate) fn finish(&self, workspace: &Workspace, whole: &Files) -> Result<(), String> {
        workspace.succeed_bounded(self.next(workspace, whole))?;
        expect_complete(&workspace.files_if_any("out"), whole)?;
        expect_nothing_temporary(workspace)?;
        if self.verified {
            let ended = workspace.succeed_bounded("verify out")?;
            if ended.stdout.contains("note: ") {
                return Err(format!("verify finds more: {}", ended.stdout));
            }
        }
        Ok(())
    }

    /// Asserts that the files in the folder are correct so far, and that the folder looks complete only if it
    /// is.
    pub(crate) fn expect_honest(&self, workspace: &Workspace, whole: &Files) -> Result<(), String> {
        let now = workspace.files_if_any("out");
        expect_sound(&now, whole)?;
        if self.verified && workspace.path("out").exists() && workspace.run_bounded("verify out")?.status == 0
        {
            let mut whole = whole.clone();
            whole.retain(|name, _| !MADE_LAST.contains(&name.as_str()) || now.contains_key(name));
            expect_all(&now, &whole)?;
        }
        Ok(())
    }
}
