//! Calibrations: their results for records with known true values, and equal results however the runs are
//! made.

#![allow(clippy::unwrap_used)] // A helper that cannot do its work fails its test.

mod rate_and_state;
#[path = "../../../slipfront-case/tests/support/reference_page.rs"]
mod reference_page;

use std::fs;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};

use serde_json::Value;
use slipfront::device::Device;
use slipfront::testing::FusedDevice;
use slipfront_calibrate::{CalibrationFile, CalibrationFolder, CalibrationKeys, CalibrationStage};
use slipfront_case::case::Case;
use slipfront_design::DesignFile;
use slipfront_run::instrument::InstrumentKeys;
use slipfront_run::measured::Measure;
use slipfront_run::run_curve::run_curve_unless;
use slipfront_study::StudyError;

use crate::reference_page::{expect_page, with_keys};

/// A small slider with two unknown keys.
const BASE: &str = "[base]\nslider.blocks = [6, 6]\ndrive.v_star = 0.1\ntime.step = 0.4\n";
const KEYS: &str = "[calibrate]\nx = 'time_s'\ny = 'force_n'\nnoise = 0.01\nruns = 200\nfiner_runs = 0\n\
    unknowns = { 'friction.mu_static' = [0.3, 0.9], 'drive.stiffness_star' = [0.3, 0.9] }\n";

/// True values of the unknowns.
const TRUTH: [f64; 2] = [0.55, 0.7];

fn file(text: &str) -> CalibrationFile {
    CalibrationFile::parse(text, "fit.toml", "fit", Path::new("")).unwrap_or_else(|error| panic!("{error}"))
}

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// A record of the small slider, with noise of 1 % of its mean.
fn write_record(path: &Path) {
    let [mu_static, stiffness] = TRUTH;
    let text = format!(
        "slider.blocks = [6, 6]\ntime.step = 0.4\ndrive = {{ v_star = 0.1, stiffness_star = {stiffness} }}\n\
         friction = {{ mu_static = {mu_static}, seed = 12345 }}\n"
    );
    let case = Case::parse(&text, "truth", "", &[]).unwrap();
    let end = 120.0 * case.scales.time();
    let curve = run_curve_unless(&case, Measure::Time, end, &|| false)
        .unwrap()
        .unwrap();
    let unit = curve.unit_force.unwrap();
    let mean = curve.coefficient.iter().sum::<f64>() / curve.coefficient.len() as f64;
    let lines = curve.time.iter().zip(&curve.coefficient).enumerate();
    let lines =
        lines.map(|(step, (time, mu))| format!("{time:e},{:e}\n", unit * (mu + 0.01 * mean * normal(step))));
    fs::write(path, format!("time_s,force_n\n{}", lines.collect::<String>())).unwrap();
}

/// A standard normal number for every step, by the Box-Muller transform of two numbers of SplitMix64.
fn normal(step: usize) -> f64 {
    let uniform = |k: u64| {
        let z = (2 * step as u64 + k + 1).wrapping_mul(0x9E37_79B9_7F4A_7C15);
        let z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        (((z ^ (z >> 31)) >> 11) as f64 + 0.5) / (1_u64 << 53) as f64
    };
    (-2.0 * uniform(0).ln()).sqrt() * (std::f64::consts::TAU * uniform(1)).cos()
}

/// Reads records, and opens a folder for them; training runs are kept in it, or in another one.
fn open(
    path: &Path,
    training: Option<&Path>,
    file: &CalibrationFile,
    records: &[PathBuf],
    force: bool,
) -> Result<CalibrationFolder, StudyError> {
    CalibrationFolder::open(path, training, file, file.read(records)?, force)
}

fn find(folder: &mut CalibrationFolder, threads: usize) -> Result<String, StudyError> {
    find_on(folder, None, threads)
}

fn find_on(
    folder: &mut CalibrationFolder,
    device: Option<&dyn Device>,
    threads: usize,
) -> Result<String, StudyError> {
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(threads)
        .build()
        .unwrap();
    pool.install(|| folder.find(device, &AtomicBool::new(false), &mut |_| {}))
}

fn numbers(folder: &Path) -> Value {
    serde_json::from_slice(&fs::read(folder.join("calibration.json")).unwrap()).unwrap()
}

/// The median of an unknown, and the ends of its interval.
fn told(found: &Value, number: usize) -> [f64; 3] {
    let unknown = &found["unknowns"][number];
    let value = |value: &Value| value.as_f64().unwrap();
    [
        value(&unknown["median"]),
        value(&unknown["interval"][0]),
        value(&unknown["interval"][1]),
    ]
}

/// The examples of the book and the files of `cases/calibrations` can be used, and every key is explained.
#[test]
fn calibration_files_are_true() {
    let mut seen = 0;
    for page in ["docs/reference/calibration-file.md", "docs/guide/calibrate.md"] {
        let text = fs::read_to_string(root().join(page)).unwrap();
        for rest in text.split("```toml calibration\n").skip(1) {
            let block = rest.split("```").next().unwrap();
            CalibrationFile::parse(block, page, "fit", &root().join("cases/calibrations"))
                .unwrap_or_else(|error| panic!("{page}: {error}\n{block}"));
            seen += 1;
        }
    }
    assert!(seen >= 3, "only {seen} examples");
    // The question about a texture takes the result of a calibration as its base.
    let folder = tempfile::tempdir().unwrap();
    let results = folder.path().join("results/sliding");
    fs::create_dir_all(&results).unwrap();
    fs::write(
        results.join("case.toml"),
        "slider.blocks = [30, 30]\nfriction.mu_static = 0.55\n",
    )
    .unwrap();
    let guide = fs::read_to_string(root().join("docs/guide/calibrate.md")).unwrap();
    let block = guide
        .split("```toml design\n")
        .nth(1)
        .unwrap()
        .split("```")
        .next()
        .unwrap();
    let design = DesignFile::parse(block, "texture.toml", "texture", folder.path())
        .unwrap_or_else(|error| panic!("{error}"));
    design.design().unwrap_or_else(|error| panic!("{error}"));
    for name in ["sliding", "tribometer", "basalt", "paper"] {
        let folder = tempfile::tempdir().unwrap();
        let example = root().join("cases/calibrations").join(name);
        let record = example.with_extension("csv");
        let file =
            CalibrationFile::load(&example.with_extension("toml")).unwrap_or_else(|error| panic!("{error}"));
        open(folder.path(), None, &file, &[record], false).unwrap_or_else(|error| panic!("{error}"));
    }
    let text = fs::read_to_string(root().join("docs/reference/calibration-file.md")).unwrap();
    for key in [
        "base",
        "unknowns",
        "noise",
        "x",
        "y",
        "x_unit",
        "y_unit",
        "against",
        "records",
        "runs",
        "finer_runs",
        "next",
    ] {
        assert!(text.contains(&format!("| `{key}` |")), "{key} is not explained");
    }
}

/// Every key has a row in the table of its section, as its struct declares it.
#[test]
fn the_reference_has_the_keys_of_the_struct() {
    expect_page("calibration-file.md", |page| {
        let page = with_keys(page, "`[calibrate]`", CalibrationKeys::KEYS);
        with_keys(&page, "`[instrument]`", InstrumentKeys::KEYS)
    });
}

/// The record of the tribometer is the run that the README next to it describes, after a filter that is
/// integrated here with the steps of the run, with noise of 1 % of its mean.
#[test]
fn the_record_of_the_tribometer_is_a_run_behind_a_filter() {
    let folder = root().join("cases/calibrations");
    let text = fs::read_to_string(folder.join("tribometer.csv")).unwrap();
    let rows = text.lines().filter_map(|line| {
        let (time, force) = line.split_once(';')?;
        let number = |text: &str| text.replace(',', ".").parse::<f64>().ok();
        Some([number(time)?, number(force)?])
    });
    let rows: Vec<[f64; 2]> = rows.collect();
    assert_eq!(rows.len(), 2001);
    let case = "slider = { blocks = [1, 1], block_size = '4 cm', density = '3125 kg/m^3', young_modulus = '66.7 kPa', damping_rate = '6 1/s' }\n\
        load.pressure = '1226 Pa'\ndrive = { speed = '2 mm/s', total_stiffness = '1150 N/m' }\ntime.step = 0.1\n\
        friction = { mu_static = 0.42, r_star = 0.7, sigma_static_star = 0, sigma_kinetic_star = 0 }";
    let case = Case::parse(case, "truth", "", &[]).unwrap();
    let curve = run_curve_unless(&case, Measure::Time, 4.01, &|| false)
        .unwrap()
        .unwrap();
    let unit = curve.unit_force.unwrap();
    let force: Vec<f64> = curve.coefficient.iter().map(|mu| unit * mu).collect();
    let constant = 1.0 / (std::f64::consts::TAU * 20.0);
    let mut filtered = vec![0.0];
    for k in 1..force.len() {
        let dt = curve.time[k] - curve.time[k - 1];
        let middle = 0.5 * (force[k] + force[k - 1]);
        filtered.push(middle + (filtered[k - 1] - middle) * (-dt / constant).exp());
    }
    let at = |time: f64| {
        let after = curve.time.partition_point(|t| *t <= time);
        let share = (time - curve.time[after - 1]) / (curve.time[after] - curve.time[after - 1]);
        filtered[after - 1] + share * (filtered[after] - filtered[after - 1])
    };
    let squares: f64 = rows.iter().map(|[time, force]| (force - at(*time)).powi(2)).sum();
    let mean = rows.iter().map(|row| row[1]).sum::<f64>() / rows.len() as f64;
    let noise = (squares / rows.len() as f64).sqrt() / mean;
    // 2001 values give a standard deviation to 1.6 %.
    assert!((noise / 0.01 - 1.0).abs() < 0.08, "{noise}");
}

/// The example is not refused, although its last interval is shorter than the others, as when a logger is
/// stopped.
#[test]
fn the_example_is_not_refused() {
    let cases = root().join("cases/calibrations");
    let text = fs::read_to_string(cases.join("sliding.toml")).unwrap();
    let file = file(&text.replace("next =", "runs = 200\nfiner_runs = 0\nnext ="));
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("checked");
    let mut folder = open(&out, None, &file, &[cases.join("sliding.csv")], false).unwrap();
    let check = folder.check(&AtomicBool::new(false), &mut |_| {}).unwrap();
    assert_eq!(check.reasons(), Vec::<String>::new());
}

/// The record of the example is the run that its comment describes, with noise of 1 % of its mean.
#[test]
fn the_record_of_the_example_is_a_run_with_noise() {
    let text = fs::read_to_string(root().join("cases/calibrations/sliding.csv")).unwrap();
    let rows: Vec<[f64; 2]> = text
        .lines()
        .filter_map(|line| {
            let (time, force) = line.split_once(',')?;
            Some([time.parse().ok()?, force.parse().ok()?])
        })
        .collect();
    let case = "slider = { blocks = [30, 30], omega_star = 0.15 }\ndrive = { v_star = 0.03, stiffness_star = 0.35 }\ntime.step = 0.4\n\
        friction = { mu_static = 0.55, r_star = 0.6, sigma_static_star = 0.06, sigma_kinetic_star = 0.08, seed = 777 }";
    let case = Case::parse(case, "truth", "", &[]).unwrap();
    let end = 1e-9 * rows.last().unwrap()[0];
    let curve = run_curve_unless(&case, Measure::Time, end, &|| false)
        .unwrap()
        .unwrap();
    let unit = 1e6 * curve.unit_force.unwrap();
    let (mut squares, mut sum) = (0.0, 0.0);
    for [time, force] in &rows {
        // Rows are at steps of the run.
        let step = curve
            .time
            .iter()
            .position(|t| (1e9 * t - time).abs() < 1e-3)
            .unwrap();
        let exact = unit * curve.coefficient[step];
        squares += (force - exact).powi(2);
        sum += exact;
    }
    let (n, mean) = (rows.len() as f64, sum / rows.len() as f64);
    let noise = (squares / n).sqrt() / mean;
    // The relative standard error for 335 values is 1/sqrt(2 n), 4 %; the bound is three times that.
    assert!((noise / 0.01 - 1.0).abs() < 0.12, "{noise}");
}

#[test]
fn the_truth_lies_within_the_intervals() {
    let folder = tempfile::tempdir().unwrap();
    let record = folder.path().join("record.csv");
    write_record(&record);
    let out = folder.path().join("found");
    let keys = KEYS.replace("runs = 200", "runs = 400");
    let mut found = open(&out, None, &file(&format!("{BASE}{keys}")), &[record], false).unwrap();
    let text = find(&mut found, 2).unwrap();
    let found = numbers(&out);
    for (number, truth) in TRUTH.into_iter().enumerate() {
        let [median, low, high] = told(&found, number);
        assert!(
            low <= truth && truth <= high && low < median && median < high,
            "{text}"
        );
    }
    // The level of friction, some micronewtons, determines the coefficient, and the slope of loading
    // determines the mount, within a tenth of the range.
    for number in [0, 1] {
        let [_, low, high] = told(&found, number);
        assert!(high - low < 0.06, "{text}");
    }
    assert!(!found["is_refused"].as_bool().unwrap(), "{text}");
    assert!(found["within_band_percent"][0].as_f64().unwrap() > 60.0, "{text}");
    // The case with the medians can be run.
    let case = Case::load(
        &out.join("case.toml"),
        &[],
        &mut |_| true,
        slipfront_case::case::Ranks::ALONE,
    )
    .unwrap();
    assert!((case.scales.mu_static_mean - told(&found, 0)[0]).abs() < 1e-12);
}

/// Number of runs of a calibration with 200 training runs, 200 on finer blocks and 200 for a further
/// experiment, 120 of the calibrated model, and 40 at half the time step.
const READY: usize = 3 * 200 + 120 + 40;

/// A calibration that was stopped, and the end of its journal cut off, gives the same files, on one thread
/// and on three.
#[test]
fn a_calibration_goes_on_to_the_same_bytes() {
    let folder = tempfile::tempdir().unwrap();
    let record = folder.path().join("record.csv");
    write_record(&record);
    let file = file(
        &format!("{BASE}{KEYS}next = [{{ drive.v_star = 0.2 }}]\n")
            .replace("finer_runs = 0", "finer_runs = 200"),
    );
    let open = |out: &str, training: Option<&Path>| {
        open(
            &folder.path().join(out),
            training,
            &file,
            std::slice::from_ref(&record),
            false,
        )
        .unwrap()
    };
    find(&mut open("whole", None), 1).unwrap();
    let stopped_at = |stage: CalibrationStage| {
        let mut stopped = open("stopped", None);
        let stop = AtomicBool::new(false);
        let ended = stopped.find(None, &stop, &mut |now| {
            stop.store(now.stage == stage, Ordering::Relaxed);
        });
        assert!(matches!(ended, Err(StudyError::Interrupted)));
        stopped.n_kept()
    };
    assert_eq!(stopped_at(CalibrationStage::FinerBlocks), 200);
    assert_eq!(stopped_at(CalibrationStage::OtherStep), READY - 40);
    let journal = folder.path().join("stopped/runs.jsonl");
    let lines = fs::read(&journal).unwrap();
    fs::write(&journal, &lines[..lines.len() - 1000]).unwrap();
    let mut again = open("stopped", None);
    assert!(
        (READY - 50..READY - 40).contains(&again.n_kept()),
        "{}",
        again.n_kept()
    );
    find(&mut again, 3).unwrap();
    drop(again);
    // A finished calibration repeats no run.
    let mut again = open("stopped", None);
    let known = again.n_kept();
    find(&mut again, 2).unwrap();
    assert_eq!((known, again.n_kept()), (READY, READY));
    drop(again);
    // Training runs in another folder give the same results.
    let shared = folder.path().join("shared");
    fs::create_dir(&shared).unwrap();
    fs::copy(folder.path().join("whole/runs.jsonl"), shared.join("runs.jsonl")).unwrap();
    let mut sharing = open("sharing", Some(&shared));
    let known = sharing.n_kept();
    find(&mut sharing, 2).unwrap();
    assert_eq!((known, sharing.n_kept()), (READY, READY));
    drop(sharing);
    find_on(&mut open("on_device", None), Some(&FusedDevice), 2).unwrap();
    let mut names: Vec<_> = fs::read_dir(folder.path().join("whole"))
        .unwrap()
        .map(|entry| entry.unwrap().file_name())
        .collect();
    // The journal has the order and the times of runs, and the list of files has its checksum.
    names.retain(|name| name != "runs.jsonl" && name != "checksums.json");
    assert!(names.len() >= 8, "{names:?}");
    for name in names {
        let read = |out: &str| fs::read(folder.path().join(out).join(&name)).unwrap();
        for out in ["stopped", "sharing", "on_device"] {
            assert!(read("whole") == read(out), "{name:?} in {out}");
        }
    }
}

/// Records of another friction law are refused. Conditions count: several records are fitted at once, and a
/// record at another speed is refused. A note warns of a slider that is too thick for a sheet under its
/// texture.
#[test]
fn records_of_another_law_are_refused_and_conditions_count() {
    let folder = tempfile::tempdir().unwrap();
    let (one, other) = (folder.path().join("one.csv"), folder.path().join("other.csv"));
    write_record(&one);
    write_record(&other);
    let out = folder.path().join("found");
    let keys = format!("{BASE}{KEYS}records = [{{ set = {{}} }}, {{ set = {{ drive.v_star = 0.1 }} }}]\n");
    let both = [one.clone(), other];
    let mut two = open(&out, None, &file(&keys), &both, false).unwrap();
    let text = find(&mut two, 2).unwrap();
    assert!(!text.contains("slider.thickness"), "{text}");
    assert_eq!(numbers(&out)["within_band_percent"].as_array().unwrap().len(), 2);
    let foreign = folder.path().join("foreign");
    let thick = "slider.thickness = '4 um'\ntexture = [{ shape = 'cavity', lambda = '1 um' }]\n";
    let keys = format!("{BASE}{thick}{KEYS}").replace("v_star = 0.1", "v_star = 0.3");
    let mut foreign_fit = open(&foreign, None, &file(&keys), &[one], false).unwrap();
    let text = find(&mut foreign_fit, 2).unwrap();
    assert!(
        text.starts_with("The model cannot reproduce these records"),
        "{text}"
    );
    assert!(
        text.contains("note: `slider.thickness` is 4 um, more than a third"),
        "{text}"
    );
    assert!(numbers(&foreign)["is_refused"].as_bool().unwrap());
    // Each number is marked, and nothing is said of how far they can be trusted.
    let marked = text.matches("does not describe the records").count();
    assert_eq!(
        marked,
        numbers(&foreign)["unknowns"].as_array().unwrap().len(),
        "{text}"
    );
    assert!(
        !text.contains("90 %. This") && !text.contains("determine"),
        "{text}"
    );
}

/// A record that was computed at the step of the case passes, although its slips begin at whole steps, unlike
/// those at a finer step.
#[test]
fn a_run_at_a_coarse_step_passes() {
    let folder = tempfile::tempdir().unwrap();
    let record = folder.path().join("record.csv");
    let block = "slider.blocks = [1, 1]\ntime.step = 0.4\ndrive.v_star = 0.05\n\
                 friction = { sigma_static_star = 0, sigma_kinetic_star = 0 }\n";
    let set = ["friction.r_star = 0.71", "slider.omega_star = 0.013"].map(str::to_owned);
    let case = Case::parse(block, "truth", "", &set).unwrap();
    let end = 600.0 * case.scales.time();
    let curve = run_curve_unless(&case, Measure::Time, end, &|| false)
        .unwrap()
        .unwrap();
    let mean = curve.coefficient.iter().sum::<f64>() / curve.coefficient.len() as f64;
    let lines = curve.time.iter().zip(&curve.coefficient).enumerate();
    let lines = lines.map(|(step, (time, mu))| format!("{time:e},{:e}\n", mu + 0.01 * mean * normal(step)));
    fs::write(&record, format!("t_s,mu_1\n{}", lines.collect::<String>())).unwrap();
    let keys = "[calibrate]\nx = 't_s'\ny = 'mu_1'\nnoise = 0.01\nruns = 300\nfiner_runs = 0\n\
                unknowns = { 'friction.r_star' = [0.5, 0.9], 'slider.omega_star' = [0.005, 0.05] }\n";
    let file = file(&format!("[base]\n{block}{keys}"));
    let out = folder.path().join("found");
    let mut folder = open(&out, None, &file, &[record], false).unwrap();
    let check = folder.check(&AtomicBool::new(false), &mut |_| {}).unwrap();
    assert!(!check.is_refused(), "{:?}", check.reasons());
    assert_eq!(check.closest.map(|closest| closest.halvings), Some(0));
}

/// A block on a spring with unknown damping and stiffness.
const BLOCK: &str = "[base]\nslider.blocks = [1, 1]\ndrive.v_star = 0.05\ntime.step = 0.2\n\
    friction = { sigma_static_star = 0, sigma_kinetic_star = 0 }\n";
const OF_BLOCK: &str = "[calibrate]\nx = 't_s'\ny = 'mu_1'\nnoise = 0.01\nruns = 300\nfiner_runs = 0\n\
    unknowns = { 'slider.omega_star' = [0.05, 0.5], 'drive.stiffness_star' = [0.1, 0.4] }\n";

/// A record of the block with an Omega* of 0.2 and a stiffness of 0.25, 400 values over 240 t*, after a
/// first-order filter with this time constant in t*, integrated by Euler's method in 50 steps per value.
fn write_filtered(path: &Path, constant: f64) {
    let text = "slider = { blocks = [1, 1], omega_star = 0.2 }\ndrive = { v_star = 0.05, stiffness_star = 0.25 }\n\
                time.step = 0.2\nfriction = { sigma_static_star = 0, sigma_kinetic_star = 0 }\n";
    let case = Case::parse(text, "truth", "", &[]).unwrap();
    let unit = case.scales.time();
    let curve = run_curve_unless(&case, Measure::Time, 241.0 * unit, &|| false)
        .unwrap()
        .unwrap();
    let friction = |star: f64| {
        let place = star / 0.2;
        let k = place as usize;
        curve.coefficient[k] + (place - k as f64) * (curve.coefficient[k + 1] - curve.coefficient[k])
    };
    let dt = 0.6 / 50.0;
    let mut x = 0.0;
    let mut values = Vec::new();
    for step in 0..400 * 50 {
        x += dt / (constant + dt) * (friction(f64::from(step) * dt) - x);
        if step % 50 == 0 {
            values.push(x);
        }
    }
    let mean = values.iter().sum::<f64>() / values.len() as f64;
    let lines = values.iter().enumerate();
    let lines =
        lines.map(|(k, y)| format!("{:e},{:e}\n", 0.6 * k as f64 * unit, y + 0.01 * mean * normal(k)));
    fs::write(path, format!("t_s,mu_1\n{}", lines.collect::<String>())).unwrap();
}

/// The filter of an instrument is part of the model. If the file has it, the intervals are around the true
/// values and the record passes. Without it, or with half of its time constant, the record is refused.
#[test]
fn a_filter_is_part_of_the_model() {
    let folder = tempfile::tempdir().unwrap();
    let record = folder.path().join("record.csv");
    write_filtered(&record, 2.0);
    let unit = Case::parse("", "unit", "", &[]).unwrap().scales.time();
    let found = |name: &str, instrument: &str| {
        let out = folder.path().join(name);
        let file = file(&format!("{BLOCK}{OF_BLOCK}{instrument}"));
        let mut fit = open(&out, None, &file, std::slice::from_ref(&record), false).unwrap();
        let text = find(&mut fit, 2).unwrap();
        (numbers(&out), text)
    };
    let filter = |constant: f64| {
        format!(
            "[instrument]\nfilter = 'first_order'\ntime = '{:e} s'\n",
            constant * unit
        )
    };
    let (told, text) = found("told", &filter(2.0));
    assert!(!told["is_refused"].as_bool().unwrap(), "{text}");
    for (number, truth) in [0.2, 0.25].into_iter().enumerate() {
        let unknown = &told["unknowns"][number];
        let end = |k: usize| unknown["interval"][k].as_f64().unwrap();
        // One interval in ten misses the true value, but hardly any by half of its width.
        let beyond = (end(0) - truth).max(truth - end(1));
        assert!(beyond < 0.5 * (end(1) - end(0)), "{text}");
    }
    assert!(text.contains("The instrument passes friction up to"), "{text}");
    for (name, instrument) in [("none", String::new()), ("half", filter(1.0))] {
        let (other, text) = found(name, &instrument);
        assert!(other["is_refused"].as_bool().unwrap(), "{name}: {text}");
        assert!(text.contains("the closest curve"), "{text}");
    }
}

/// An unknown gain can be calibrated like other unknowns.
#[test]
fn a_key_of_the_instrument_may_be_unknown() {
    let folder = tempfile::tempdir().unwrap();
    let record = folder.path().join("record.csv");
    write_filtered(&record, 1e-6);
    let keys = OF_BLOCK.replace(
        "'slider.omega_star' = [0.05, 0.5]",
        "'instrument.gain' = [0.8, 1.2]",
    );
    let block = BLOCK.replace(
        "slider.blocks = [1, 1]",
        "slider = { blocks = [1, 1], omega_star = 0.2 }",
    );
    let out = folder.path().join("found");
    let mut fit = open(&out, None, &file(&format!("{block}{keys}")), &[record], false).unwrap();
    let text = find(&mut fit, 2).unwrap();
    let of_gain = numbers(&out)["unknowns"].as_array().unwrap().clone();
    let of_gain = of_gain
        .iter()
        .find(|one| one["key"] == "instrument.gain")
        .unwrap();
    let end = |k: usize| of_gain["interval"][k].as_f64().unwrap();
    assert!(end(0) <= 1.0 && 1.0 <= end(1) && end(1) - end(0) < 0.05, "{text}");
    // The written case has no key of the instrument.
    assert!(
        !fs::read_to_string(out.join("case.toml"))
            .unwrap()
            .contains("gain")
    );
}

/// The block of the written case has the reported coefficients: a single block draws no random ones.
#[test]
fn the_block_of_the_written_case_has_the_medians() {
    let folder = tempfile::tempdir().unwrap();
    let record = folder.path().join("record.csv");
    write_record(&record);
    let found = |name: &str, friction: &str| {
        let out = folder.path().join(name);
        let keys = format!("{BASE}{friction}{KEYS}").replace("[6, 6]", "[1, 1]");
        let keys = keys.replace(
            "'drive.stiffness_star' = [0.3, 0.9]",
            "'friction.r_star' = [0.3, 0.9]",
        );
        let mut fit = open(&out, None, &file(&keys), std::slice::from_ref(&record), false).unwrap();
        let text = find(&mut fit, 2).unwrap();
        let text = text.split_whitespace().collect::<Vec<_>>().join(" ");
        let case = Case::parse(
            &fs::read_to_string(out.join("case.toml")).unwrap(),
            "found",
            "",
            &[],
        )
        .unwrap();
        let [mu_static, r_star] = [0, 1].map(|number| told(&numbers(&out), number)[0]);
        let surface = &case.model.surface;
        let of_block = [
            surface.mean_static_coefficient(),
            surface.mean_kinetic_coefficient(),
        ];
        (
            text,
            [
                of_block[0] / mu_static - 1.0,
                of_block[1] / (r_star * mu_static) - 1.0,
            ],
        )
    };
    let (text, differences) = found(
        "even",
        "friction = { sigma_static_star = 0, sigma_kinetic_star = 0 }\n",
    );
    assert!(!text.contains("at random"), "{text}");
    // A median is converted to a share of its range and back.
    assert!(
        differences.iter().all(|difference| difference.abs() < 1e-12),
        "{differences:?}"
    );
    // The block has a random coefficient that differs, as the text says.
    let (text, differences) = found("drawn", "");
    assert!(
        text.contains("note: 1 block in contact draws its static and kinetic coefficients at random"),
        "{text}"
    );
    assert!(
        differences.iter().all(|difference| difference.abs() > 1e-3),
        "{differences:?}"
    );
}

/// A record without friction is refused before a run: it has no share of its mean to scatter by.
#[test]
fn a_record_of_zeros_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let record = folder.path().join("zero.csv");
    let rows: String = (0..100).map(|k| format!("{k}e-10,0\n")).collect();
    fs::write(&record, format!("time_s,force_n\n{rows}")).unwrap();
    let out = folder.path().join("out");
    let refused = open(&out, None, &file(&format!("{BASE}{KEYS}")), &[record], false);
    let said = refused.unwrap_err().to_string();
    assert!(
        said.contains("zero.csv is 0 in each of its 100 values of friction"),
        "{said}"
    );
    assert!(!out.exists());
}

/// A file or record that cannot be calibrated is refused, with the name of the key.
#[test]
fn what_cannot_be_calibrated_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let record = folder.path().join("record.csv");
    write_record(&record);
    let whole = format!("{BASE}{KEYS}");
    let refused = |from: &str, to: &str| {
        assert!(whole.contains(from), "{from}");
        let whole = match to.contains("'held'") {
            true => format!("{whole}[instrument]\nfilter = 'first_order'\ncutoff = '1 GHz'\n"),
            false => whole.clone(),
        };
        let out = folder.path().join("out");
        let opened = CalibrationFile::parse(&whole.replace(from, to), "fit.toml", "fit", Path::new(""))
            .and_then(|file| open(&out, None, &file, std::slice::from_ref(&record), false));
        assert!(!out.exists(), "{from}");
        opened.unwrap_err().to_string()
    };
    for (from, to, sentence) in [
        (
            "noise = 0.01",
            "noise = 1",
            "`noise` = 1 must lie between 0 and 1",
        ),
        ("noise = 0.01", "noisy = 0.01", "unknown key `noisy`"),
        (
            "runs = 200\n",
            "runs = 100\n",
            "`runs` = 100 must lie between 200",
        ),
        (
            "finer_runs = 0",
            "finer_runs = 300",
            "`finer_runs` = 300 must be 0, or lie between 200 and `runs` = 200",
        ),
        (
            "[0.3, 0.9] }",
            "[0.9, 0.3] }",
            "the range of `drive.stiffness_star` is 0.9 to 0.3",
        ),
        ("[0.3, 0.9] }", "'x' }", "is written [0.3, 0.9]"),
        ("[0.3, 0.9] }", "[-1, 0.9] }", "must be more than 0 and at most"),
        ("'drive.stiffness_star'", "'drive.stifness_star'", "stifness_star"),
        (
            "'friction.mu_static'",
            "'friction.seed'",
            "it cannot be an unknown",
        ),
        ("y = 'force_n'", "y = 'load'", "has no column `load`"),
        (
            "y = 'force_n'",
            "y = 'force_n'\nrecords = [{ set = {} }, { set = {} }]",
            "one file for each",
        ),
        (
            "x = 'time_s'",
            "x = 'time_s'\nx_unit = 's'\ny_unit = 'N'\nagainst = 'displacement'",
            "unit",
        ),
        (
            "time.step = 0.4",
            "time.step = 1e-6",
            "more than 10000000: a step lasts",
        ),
        ("[calibrate]", "[other]\n[calibrate]", "other"),
        (
            "[calibrate]",
            "[instrument]\nfilter = 'first_order'\n[calibrate]",
            "`filter` of the instrument: give its `cutoff`",
        ),
        (
            "time.step",
            "drive.loading = 'held'\ntime.step",
            "a held drive has no time while blocks slide",
        ),
    ] {
        let error = refused(from, to);
        assert!(error.contains(sentence), "{from}: {error}");
    }
}
