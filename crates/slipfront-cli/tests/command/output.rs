//! Files of a run, and the effects of `[output]`, `[time]` and `edges`.

use slipfront_run::fields::{FieldFrame, FieldsData, read_fields, read_kymograph};

use crate::fixtures::RUN_FILES;
use crate::support::process::{ended_with, output, stderr};
use crate::support::workspace::Workspace;

/// Keys that `summary.json` must contain (design, section 3).
const KEYS: [&str; 28] = [
    "static_friction_star",
    "static_friction",
    "onset_time_star",
    "first_slip_time_star",
    "kinetic_friction_star",
    "kinetic_friction",
    "kinetic_window_star",
    "sliding_percent_kinetic",
    "sliding_percent_max",
    "v_star",
    "r_star",
    "omega_star",
    "sigma_static_star",
    "epsilon",
    "n_blocks",
    "texture_percent",
    "texture_percent_asked",
    "dt_star",
    "steps",
    "seed",
    "energy_error",
    "transition",
    "static_lateral_friction_star",
    "kinetic_lateral_friction_star",
    "mu_star_max",
    "kinetic_friction_star_uncertainty",
    "warnings",
    "version",
];

fn fields(workspace: &Workspace, folder: &str) -> FieldsData {
    read_fields(workspace.path(&format!("{folder}/fields.nc"))).unwrap()
}

fn times(fields: &FieldsData) -> Vec<f64> {
    fields.frames.iter().map(|frame| frame.time_star).collect()
}

/// Rows of `series.csv`, without its header.
fn rows(workspace: &Workspace, folder: &str) -> usize {
    let text = String::from_utf8(workspace.read(&format!("{folder}/series.csv"))).unwrap();
    text.lines().count() - 1
}

#[test]
fn the_baseline_needs_no_file_and_writes_these() {
    let workspace = Workspace::small();
    workspace.succeed("run");
    let files = workspace.files("results/baseline");
    assert_eq!(
        files.keys().collect::<Vec<_>>(),
        RUN_FILES.iter().collect::<Vec<_>>()
    );
    let summary = workspace.summary("results/baseline");
    assert_eq!(summary["n_blocks"], 625);
    let instants: String = fields(&workspace, "results/baseline")
        .frames
        .iter()
        .map(|frame| frame.label.as_str())
        .collect();
    assert_eq!(instants, "ABCDEF");
    // The rows of the series without its header, one per step.
    assert_eq!(rows(&workspace, "results/baseline"), 2668);
    // The files are as readable as other files of the user, not private like temporary files.
    #[cfg(unix)]
    for name in RUN_FILES {
        use std::os::unix::fs::PermissionsExt;
        let path = workspace.path("results/baseline").join(name);
        let mode = |path| std::fs::metadata(path).unwrap().permissions().mode() & 0o777;
        assert_eq!(mode(path), mode(workspace.path("small.toml")), "{name}");
    }
}

#[test]
fn the_manifest_lists_every_other_file_and_its_length() {
    let workspace = Workspace::small();
    workspace.succeed("run small.toml -o a --threads 2");
    let manifest: serde_json::Value = serde_json::from_slice(&workspace.read("a/manifest.json")).unwrap();
    let cores = std::thread::available_parallelism().unwrap().get();
    assert_eq!(manifest["threads"], cores.min(2));
    let mut listed = manifest["files"].as_array().unwrap().clone();
    listed.sort_by_key(|file| file["name"].as_str().unwrap().to_owned());
    let names: Vec<_> = listed.iter().map(|file| file["name"].as_str().unwrap()).collect();
    let files = workspace.run_files("a");
    assert_eq!(names, files.keys().collect::<Vec<_>>());
    for (file, (name, bytes)) in listed.iter().zip(&files) {
        assert_eq!(file["bytes"], bytes.len(), "{name}");
    }
}

#[test]
fn vectors_can_be_limited_without_effect_on_results() {
    let workspace = Workspace::small();
    let limited = |line: &str, widest: &str| {
        let mut process = workspace.process(line);
        output(process.env("SLIPFRONT_SIMD", widest))
    };
    workspace.succeed("run small.toml -o widest");
    assert!(limited("run small.toml -o baseline", "baseline").status.success());
    let manifest: serde_json::Value =
        serde_json::from_slice(&workspace.read("baseline/manifest.json")).unwrap();
    assert_eq!(manifest["simd_width"], "baseline");
    for file in ["series.csv", "fields.nc", "summary.json"] {
        let [widest, baseline] = ["widest", "baseline"].map(|run| workspace.read(&format!("{run}/{file}")));
        assert!(widest == baseline, "{file}");
    }
    let refused = limited("--version", "MMX");
    let said = String::from_utf8_lossy(&refused.stderr).into_owned();
    assert_eq!(refused.status.code(), Some(2), "{said}");
    assert!(
        said.contains("`MMX` is not a vector instruction set of slipfront"),
        "{said}"
    );
}

/// The command that tests build lacks the feature `gpu`; one with that feature names the remedy as well.
#[test]
fn a_device_that_is_missing_is_refused_or_replaced_by_the_cpu() {
    let workspace = Workspace::small();
    let refused = workspace.fail("run small.toml -o out --device gpu", 2);
    assert!(
        refused.contains("; `--device cpu` gives the same results"),
        "{refused}"
    );
    assert!(!workspace.exists("out"));
    let output = workspace.output("run small.toml -o out --device auto");
    let printed = stderr(&output);
    let note = "note: the run is computed on the CPU: 30 blocks are too few for a GPU";
    assert!(output.status.success() && printed.contains(note), "{printed}");
    workspace.succeed("run small.toml -o cpu --device cpu --quiet");
    for folder in ["out", "cpu"] {
        let bytes = workspace.read(&format!("{folder}/manifest.json"));
        let manifest: serde_json::Value = serde_json::from_slice(&bytes).unwrap();
        assert_eq!(manifest.get("device"), None);
    }
    let [one, other] = ["out", "cpu"].map(|folder| workspace.read(&format!("{folder}/series.csv")));
    assert_eq!(one, other);
}

#[test]
fn the_manifest_says_how_the_run_came_about() {
    let workspace = Workspace::small();
    workspace.succeed("run small.toml -o a --threads 1 --seed 7");
    let manifest: serde_json::Value = serde_json::from_slice(&workspace.read("a/manifest.json")).unwrap();
    assert_eq!(manifest["version"], env!("CARGO_PKG_VERSION"));
    let case = blake3::hash(&workspace.read("a/case.toml")).to_hex();
    assert_eq!(manifest["case_blake3"], case.as_str());
    let random = serde_json::json!({
        "generator": "ChaCha8", "seed": 7, "streams": { "mu_static": 0, "mu_kinetic": 1 }
    });
    assert_eq!(manifest["random"], random);
    assert_eq!(manifest["kernel"], "fused");
    let width = manifest["simd_width"].as_str().unwrap();
    assert!(["AVX-512", "AVX2", "baseline"].contains(&width), "{width}");
    // A build outside of git has no revision.
    if let Some(revision) = manifest["revision"].as_str() {
        let commit = revision.strip_suffix("-dirty").unwrap_or(revision);
        assert!(
            commit.len() >= 40 && commit.bytes().all(|byte| byte.is_ascii_hexdigit()),
            "{revision}"
        );
    } else {
        assert!(manifest["revision"].is_null());
    }
    let time = |key: &str| -> jiff::Timestamp { manifest[key].as_str().unwrap().parse().unwrap() };
    let passed = time("finished").duration_since(time("started")).as_secs_f64();
    // Equal up to the digits of seconds in the file.
    assert!((manifest["wall_time_s"].as_f64().unwrap() - passed).abs() < 1e-6);
    assert!(!manifest["host"].as_str().unwrap().is_empty());
}

#[test]
fn json_is_the_summary_and_nothing_else() {
    let workspace = Workspace::small();
    let said = workspace.succeed("run small.toml -o a --json");
    let summary: serde_json::Value = serde_json::from_str(&said).unwrap();
    assert_eq!(said.as_bytes(), workspace.read("a/summary.json"));
    for key in KEYS {
        assert!(summary.get(key).is_some(), "{key} is missing");
    }
    let number = |key: &str| summary[key].as_f64().unwrap();
    assert!((0.5..1.1).contains(&number("static_friction_star")));
    assert!(number("first_slip_time_star") <= number("onset_time_star"));
    assert_eq!(summary["transition"], true);
}

#[test]
fn quiet_says_nothing() {
    let workspace = Workspace::small();
    let quiet = ended_with(&mut workspace.process("run small.toml --quiet"), 0);
    assert!(quiet.stdout.is_empty() && quiet.stderr.is_empty());
    assert!(workspace.exists("results/small/manifest.json"));
    let json = ended_with(&mut workspace.process("run small.toml -q --json -o b"), 0);
    assert_eq!(json.stdout, workspace.read("b/summary.json"));
}

#[test]
fn set_and_seed_change_the_case() {
    let workspace = Workspace::small();
    workspace.succeed("run small.toml -o a --set drive.v_star=0.2 --set friction.seed=7");
    workspace.succeed("run small.toml -o b --set drive.v_star=0.2 --seed 7");
    workspace.succeed("run small.toml -o c --set drive.v_star=0.2");
    let summary = workspace.summary("a");
    assert_eq!((&summary["v_star"], &summary["seed"]), (&0.2.into(), &7.into()));
    workspace.assert_same_run("a", "b");
    assert_ne!(workspace.read("a/series.csv"), workspace.read("c/series.csv"));
}

/// A number behind a word in a text.
fn number_after(text: &str, word: &str) -> f64 {
    let (_, rest) = text
        .split_once(word)
        .unwrap_or_else(|| panic!("no {word:?} in {text}"));
    let end = rest.find(|sign: char| !"0123456789.e-".contains(sign));
    rest[..end.unwrap_or(rest.len())].parse().unwrap()
}

/// A slower drive over the same path takes as much longer, and the mass of a rigid block is its volume times
/// its density.
#[test]
fn check_prints_numbers_of_its_case() {
    let workspace = Workspace::small();
    let said = workspace.succeed("check small.toml --set drive.v_star=0.1 --set time.duration_star=50");
    let path = number_after(&said, "`drive.v_star = ") * number_after(&said, "`time.duration_star = ");
    // Both numbers have some digits.
    assert!((path / 5.0 - 1.0).abs() < 1e-2, "{said}");
    workspace.write(
        "rigid.toml",
        "slider = { blocks = [1, 1], rigid = true, block_size = '40 mm', thickness = '12 mm', density = '1600 kg/m^3' }\n\
         drive.total_stiffness = '168 N/m'\n",
    );
    let said = workspace.succeed("check rigid.toml");
    assert!(said.contains("rigid, mass 30.72 g,"), "{said}");
}

/// The uncertainty of mu_k is that of mu_k*, times the mean static coefficient.
#[test]
fn coefficients_are_printed_with_their_uncertainty() {
    let workspace = Workspace::small();
    let line = "run small.toml -o run --set drive.v_star=0.1 --set time.duration_star=600 --set friction.mu_static=0.4";
    let said = workspace.succeed(line);
    let summary: serde_json::Value = serde_json::from_str(&workspace.read_text("run/summary.json")).unwrap();
    let uncertainty = summary["kinetic_friction_star_uncertainty"].as_f64().unwrap();
    let (_, of_mu) = said.split_once("   mu_k = ").unwrap();
    // Two digits are printed.
    let printed = number_after(of_mu, " \u{b1} ");
    assert!((printed / (0.4 * uncertainty) - 1.0).abs() < 0.1, "{said}");
}

#[test]
fn stop_after_onset_ends_the_run_there() {
    let workspace = Workspace::small();
    workspace.succeed("run small.toml -o whole");
    workspace.succeed("run small.toml -o onset --set time.stop=after_onset");
    let (whole, onset) = (workspace.summary("whole"), workspace.summary("onset"));
    assert_eq!(onset["static_friction_star"], whole["static_friction_star"]);
    assert_eq!(onset["onset_time_star"], whole["onset_time_star"]);
    assert!(onset["steps"].as_u64().unwrap() < whole["steps"].as_u64().unwrap() / 2);
    assert!(onset["kinetic_friction_star"].is_null() && onset["transition"] == true);
    assert_eq!(
        rows(&workspace, "onset") as u64,
        onset["steps"].as_u64().unwrap() + 1
    );
}

/// Static friction below kinetic friction does not count: the stiff edge of this slider slips first, mu*
/// pauses at 0.518, and then rises to 0.548 during sliding.
#[test]
fn a_peak_below_the_sliding_that_follows_is_no_transition() {
    let workspace = Workspace::small();
    workspace.write(
        "graded.toml",
        "slider.blocks = [50, 50]\nslider.stiffness_grade = { along = 'x', from = 1, to = 0.1 }\n",
    );
    let said = workspace.succeed("run graded.toml -o graded");
    let summary = workspace.summary("graded");
    let number = |key: &str| summary[key].as_f64().unwrap();
    assert_eq!(summary["transition"], false);
    assert_eq!(number("static_friction_star"), number("mu_star_max"));
    assert!(number("onset_time_star") > 400.0 && number("kinetic_friction_star") > 0.52);
    assert!(
        said.contains("at least mu_s* = 0.5485") && said.contains("after a first peak of 0.5180"),
        "{said}"
    );
}

/// A chain pulled at its end shows stick-slip, and a later peak is the highest.
#[test]
fn a_later_mu_star_above_the_first_peak_is_told() {
    let workspace = Workspace::small();
    workspace.write(
        "chain.toml",
        "slider = { blocks = [60, 1], viscosity_time_star = 0.3, omega_star = 0 }\nfriction.r_star = 0.1\n\
         drive = { attach = 'left', v_star = 1, total_stiffness_star = 0.004 }\n\
         time = { step = 0.6, duration_star = 20000 }\noutput.series = 100\n",
    );
    let said = workspace.succeed("run chain.toml -o chain");
    let summary = workspace.summary("chain");
    assert_eq!(summary["transition"], true);
    let [first, largest] = ["static_friction_star", "mu_star_max"].map(|key| summary[key].as_f64().unwrap());
    assert!(largest > 1.01 * first);
    assert!(
        said.contains("mu* becomes larger than at its first peak: 0.1470"),
        "{said}"
    );
}

/// With viscous drag, or a kinetic coefficient above the static one, steady sliding takes more than the
/// static strength of the blocks: a fall of mu* is then no transition.
#[test]
fn where_friction_loses_nothing_there_is_no_transition() {
    let workspace = Workspace::small();
    for (k, keys) in ["friction.r_star=0.9 --set drive.v_star=3", "friction.r_star=1.1"]
        .iter()
        .enumerate()
    {
        workspace.succeed(&format!(
            "run small.toml -o run{k} --set {keys} --set time.duration_star=auto"
        ));
        let summary = workspace.summary(&format!("run{k}"));
        assert_eq!(summary["transition"], false, "{keys}");
        assert_eq!(summary["static_friction_star"], summary["mu_star_max"], "{keys}");
        let warnings = summary["warnings"].to_string();
        assert!(
            !warnings.contains("above static_friction_star"),
            "{keys}: {warnings}"
        );
    }
}

/// The numbers of the front and its picture require a transition; sliding is recorded in every run.
#[test]
fn a_run_without_a_transition_has_no_front() {
    let workspace = Workspace::small();
    // Slip starts at the rim of a cavity: on such a small rough slider, blocks would slip one by one.
    let cavity =
        "--set friction.sigma_static_star=0 --set texture.0.shape=cavity --set texture.0.coverage=10";
    workspace.succeed(&format!(
        "run small.toml -o whole --set slider.blocks=[20,12] {cavity}"
    ));
    workspace.succeed("run small.toml -o short --set time.duration_star=2");
    let (whole, short) = (workspace.summary("whole"), workspace.summary("short"));
    let keys: Vec<&String> = whole
        .as_object()
        .unwrap()
        .keys()
        .filter(|key| key.starts_with("front_") || key.starts_with("nucleation"))
        .collect();
    assert_eq!(keys.len(), 13);
    for key in keys {
        let nothing = short[key].is_null() || short[key] == serde_json::json!([]);
        assert!(!whole[key].is_null() && nothing, "{key}");
    }
    assert_eq!(
        whole["nucleation_sites"],
        whole["nucleations"].as_array().unwrap().len()
    );
    assert_eq!(whole["nucleation_x_m"], whole["nucleations"][0]["x_m"]);
    // c_S is sqrt(3/8) blocks per l sqrt(rho/E), which is 1e-6 m per 1e-6/sqrt(1e7) s for the baseline.
    let [c_s, m_s] = ["front_speed_c_s", "front_speed_m_s"].map(|key| whole[key].as_f64().unwrap());
    assert!((m_s / c_s / (0.375 * 1e7_f64).sqrt() - 1.0).abs() < 1e-9);
    assert!(workspace.exists("whole/front.png") && !workspace.exists("short/front.svg"));

    let recorded = read_kymograph(workspace.path("short/kymograph.nc")).unwrap();
    assert_eq!(
        recorded.time_star,
        [0.0, 0.8, 1.6].map(|t| (t * 10.0_f64).round() * 0.1)
    );
    assert_eq!(recorded.sliding_share, [0.0; 18]);
    let recorded = read_kymograph(workspace.path("whole/kymograph.nc")).unwrap();
    assert_eq!(recorded.columns(), 20);
    // Blocks of 1e-6 m, up to rounding.
    assert!((recorded.places[1] - 20e-6).abs() < 1e-18 && recorded.places[0].abs() < 1e-18);
    assert!(recorded.sliding_share.contains(&1.0));
}

#[test]
fn snapshots_at_times_at_a_spacing_or_none() {
    let workspace = Workspace::small();
    workspace.succeed("run small.toml -o list --set output.snapshots=[0,12.34,80]");
    workspace.succeed("run small.toml -o every --set output.snapshots.every=30");
    workspace.succeed("run small.toml -o none --set output.snapshots=[]");
    assert_eq!(times(&fields(&workspace, "list")), [0.0, 123.0 * 0.1, 80.0]);
    // In addition to the regular snapshots there are the instants A-F, as without a spacing.
    workspace.succeed("run small.toml -o auto");
    let (auto, every) = (fields(&workspace, "auto"), fields(&workspace, "every"));
    let is_instant = |frame: &&FieldFrame| !frame.label.is_empty();
    let found: Vec<&FieldFrame> = every.frames.iter().filter(is_instant).collect();
    assert_eq!(found, auto.frames.iter().collect::<Vec<_>>());
    assert!(times(&every).is_sorted_by(|one, next| one < next));
    for time in [0.0, 30.0, 60.0] {
        assert!(times(&every).contains(&time), "{time}");
    }
    assert_eq!(every.frames.len(), auto.frames.len() + 3);
    assert_eq!(workspace.summary("every"), workspace.summary("auto"));
    assert!(fields(&workspace, "none").frames.is_empty());
    assert!(workspace.exists("list/stress.png") && workspace.exists("every/stress.svg"));
    assert!(!workspace.exists("none/stress.png") && !workspace.exists("none/stress.svg"));
    assert!(workspace.exists("none/manifest.json"));
    // The static fields are still there.
    assert_eq!(fields(&workspace, "none").mu_static.len(), 30);
}

/// Size and number of pictures of a GIF file, and their total duration in hundredths of a second.
fn shown(bytes: &[u8]) -> ([u16; 2], usize, u32) {
    let mut decoder = gif::DecodeOptions::new().read_info(bytes).unwrap();
    let size = [decoder.width(), decoder.height()];
    let (mut pictures, mut time) = (0, 0);
    while let Some(frame) = decoder.read_next_frame().unwrap() {
        (pictures, time) = (pictures + 1, time + u32::from(frame.delay));
    }
    (size, pictures, time)
}

#[test]
fn a_movie_shows_every_snapshot() {
    let workspace = Workspace::small();
    workspace.succeed("run small.toml -o run --set output.snapshots.every=20");
    workspace.succeed("movie run");
    let snapshots = fields(&workspace, "run").frames.len();
    let bytes = workspace.read("run/movie.gif");
    let (size, pictures, time) = shown(&bytes);
    assert_eq!((size, pictures), ([800, 400], snapshots));
    // Sixteen seconds, plus the additional time of the instants.
    assert!((1500..3500).contains(&time), "{time}");
    // An existing file is reported before anything is drawn, and before an unknown field.
    for line in ["movie run", "movie run --field velocity_x"] {
        let said = workspace.fail(line, 2);
        assert!(
            said.contains("movie.gif was changed after the run drew it: choose another place"),
            "{said}"
        );
    }
    workspace.succeed("movie run --force");
    assert_eq!(workspace.read("run/movie.gif"), bytes);
    workspace.succeed("movie run --field displacement_x -o other.gif");
    assert_ne!(workspace.read("other.gif"), bytes);
    // Duration, pace and size are as requested, and the duration is printed.
    let told = workspace.succeed("movie run --force");
    let told_as = format!(
        "{snapshots} pictures in {} s, 800 x 400 pixels\nrun/movie.gif\n",
        f64::from(time) / 100.0
    );
    assert_eq!(told, told_as);
    let told = workspace.succeed("movie run --seconds 20 --size 400x200 -o timed.gif");
    assert!(
        told.starts_with(&format!("{snapshots} pictures in 20 s, 400 x 200 pixels\n")),
        "{told}"
    );
    assert_eq!(shown(&workspace.read("timed.gif")), ([400, 200], snapshots, 2000));
    workspace.succeed("movie run --fps 10 --size 1600x800 -o paced.gif");
    assert_eq!(
        shown(&workspace.read("paced.gif")),
        ([1600, 800], snapshots, 10 * snapshots as u32)
    );
    workspace.write("empty/note.txt", "");
    for (line, sentence) in [
        ("movie run --seconds 0.1 -o none.gif", "pictures take at least"),
        (
            "movie run --fps 10 --seconds 3 -o none.gif",
            "cannot be used with",
        ),
        ("movie run --size 3x4 -o none.gif", "400x200, 800x400, 1600x800"),
        (
            "movie run --field velocity_x -o none.gif",
            "has no snapshots of velocity_x: choose a field with --field (its case writes",
        ),
        (
            "movie run --field pressure",
            "the fields are contact_stress_star, traction",
        ),
        ("movie run -o movie.avi", "use the extension .gif or .mp4"),
        (
            "movie empty",
            "contains no summary.json: give the folder of a finished run",
        ),
        ("movie nowhere", "there is no folder nowhere"),
    ] {
        let said = workspace.fail(line, 2);
        assert!(said.contains(sentence), "{line}: {said}");
    }
}

/// A run that has kept only the instants is repeated for its movie, which shows a hundred snapshots, and its
/// folder is unchanged.
#[test]
fn a_movie_has_a_hundred_snapshots() {
    let workspace = Workspace::small();
    workspace.succeed("run small.toml -o run");
    let before = workspace.files("run");
    workspace.succeed("movie run --size 400x200 -o usual.gif");
    let (_, usual, _) = shown(&workspace.read("usual.gif"));
    // The start and the instants are added to the hundred.
    assert!((100..=108).contains(&usual), "{usual}");
    // Fields that the run has not kept can also be shown.
    let told = workspace.succeed("movie run --frames 30 --field velocity_x --size 400x200 -o few.gif");
    let (_, few, _) = shown(&workspace.read("few.gif"));
    assert!(
        (30..=38).contains(&few) && told.starts_with(&format!("{few} pictures")),
        "{told}"
    );
    // The snapshots that the run has kept are sufficient.
    workspace.succeed("movie run --frames 1 --size 400x200 -o kept.gif");
    assert!(shown(&workspace.read("kept.gif")).1 <= 6);
    assert!(workspace.files("run") == before);
    let said = workspace.fail("movie run --frames 994 -o none.gif", 2);
    assert!(said.contains("1..=993"), "{said}");
}

#[test]
fn a_case_can_ask_for_its_movie() {
    let workspace = Workspace::small();
    workspace.succeed("run small.toml -o run --set output.movie=true");
    assert!(workspace.read_text("run/manifest.json").contains("movie.gif"));
    workspace.succeed("verify run");
    let bytes = workspace.read("run/movie.gif");
    workspace.succeed("movie run -o again.gif");
    assert_eq!(workspace.read("again.gif"), bytes);
    // The movie is removed with its run, and a run without snapshots has no movie.
    workspace.succeed("run small.toml -o run --force --set output.snapshots=[]");
    assert!(!workspace.exists("run/movie.gif"));
    let said = workspace.fail(
        "run small.toml -o other --set output.movie=true --set output.snapshots=[]",
        2,
    );
    assert!(
        said.contains("a movie shows the snapshots of a run, but this run has none"),
        "{said}"
    );
    assert!(!workspace.exists("other"));
}

/// ffmpeg makes an MP4 file; skipped without ffmpeg.
#[test]
fn ffmpeg_makes_an_mp4_file() {
    if std::process::Command::new("ffmpeg")
        .arg("-version")
        .output()
        .is_err()
    {
        eprintln!("skipped: there is no ffmpeg");
        return;
    }
    let workspace = Workspace::small();
    workspace.succeed("run small.toml -o run");
    workspace.succeed("movie run -o run.mp4");
    let bytes = workspace.read("run.mp4");
    assert_eq!(&bytes[4..8], b"ftyp");
    // The index comes before the pictures.
    let place = |tag: &[u8]| bytes.windows(4).position(|found| found == tag).unwrap();
    assert!(place(b"moov") < place(b"mdat"));
}

#[test]
fn a_stride_thins_the_fields_and_a_spacing_the_series() {
    let workspace = Workspace::small();
    workspace.succeed("run small.toml -o all");
    workspace.succeed("run small.toml -o thin --set output.stride=4 --set output.series=10");
    let (all, thin) = (fields(&workspace, "all"), fields(&workspace, "thin"));
    assert_eq!(
        (thin.frames[0].values[0].len(), all.frames[0].values[0].len()),
        (4, 30)
    );
    let taken: Vec<f32> = [0, 4, 24, 28].map(|block| all.frames[2].values[0][block]).into();
    assert_eq!(thin.frames[2].values[0], taken);
    assert_eq!(rows(&workspace, "thin"), 9);
    // Measured numbers do not depend on the options of the output.
    assert_eq!(workspace.summary("thin"), workspace.summary("all"));
    // A spacing beyond the end leaves the first and the last row.
    workspace.succeed("run small.toml -o ends --set output.series=1000 --set output.stride=100");
    assert_eq!(rows(&workspace, "ends"), 2);
}

#[test]
fn periodic_edges_are_told_and_change_the_result() {
    let workspace = Workspace::small();
    workspace.succeed("run small.toml -o free");
    let said = workspace.succeed("run small.toml -o ring --set slider.edges=['periodic','free']");
    assert!(said.contains("periodic in x, free in y edges"), "{said}");
    assert_ne!(
        workspace.read("free/series.csv"),
        workspace.read("ring/series.csv")
    );
    let said = workspace.fail(
        "run small.toml -o c --set slider.blocks=[2,9] --set slider.edges=periodic",
        2,
    );
    assert!(
        said.contains("2 blocks along x: periodic edges need at least 3"),
        "{said}"
    );
}
