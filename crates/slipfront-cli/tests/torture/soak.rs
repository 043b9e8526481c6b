//! Soak: ten times as many steps take no more memory and no more disk space, and the energy balance closes as
//! well as before.
//!
//! `cargo test` runs a million steps. Up to 10^8 steps, with the measured figures:
//!
//! ```console
//! $ SLIPFRONT_SOAK=long cargo test -p slipfront-long-tests --test torture soak -- --nocapture
//! ```

use std::collections::BTreeMap;
use std::process::Stdio;

use crate::support::process::{MAX_TIME, Running, program, stdout, unset};
use crate::support::workspace::Workspace;

/// A Python program that runs a command and prints the peak of its memory in KiB, as Linux counts it to the
/// end: the peak comes while the pictures are drawn, shortly before it.
const PRINT_PEAK: &str = "import resource, subprocess, sys
status = subprocess.call(sys.argv[1:])
print(resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss)
sys.exit(status)";

/// Time, memory, disk space and energy error of a run.
struct Soaked {
    steps: u64,
    peak_kib: u64,
    energy_error: f64,
    files: BTreeMap<String, u64>,
}

fn soak(workspace: &Workspace, duration_star: f64) -> Soaked {
    let out = format!("{duration_star:e}");
    // On one thread the peak is reproducible to a hundredth. On two threads, one run in four took a fifth
    // less, depending on which thread drew which picture.
    let line = format!(
        "run --quiet --threads 1 --set slider.blocks=[6,5] --set drive.v_star=0.1 --set time.duration_star={duration_star} --out {out}"
    );
    let mut python = unset("python3");
    python.args(["-c", PRINT_PEAK, program()]).args(line.split(' '));
    python.current_dir(workspace.path("")).stdout(Stdio::piped());
    // The shortest run takes less than a second.
    let limit = MAX_TIME.mul_f64(duration_star / 1e4);
    let output = Running::start(&mut python).ended_within(limit).unwrap();
    assert!(output.status.success(), "{}", output.status);
    let summary = workspace.read(&format!("{out}/summary.json"));
    let summary: serde_json::Value = serde_json::from_slice(&summary).unwrap();
    let files = std::fs::read_dir(workspace.path(&out)).unwrap().map(|entry| {
        let entry = entry.unwrap();
        let name = entry.file_name().into_string().unwrap();
        (name, entry.metadata().unwrap().len())
    });
    Soaked {
        steps: summary["steps"].as_u64().unwrap(),
        peak_kib: stdout(&output).trim().parse().unwrap(),
        energy_error: summary["energy_error"].as_f64().unwrap(),
        files: files.collect(),
    }
}

#[test]
fn a_longer_run_takes_no_more() {
    let workspace = Workspace::new();
    let long = std::env::var("SLIPFRONT_SOAK").is_ok_and(|form| form == "long");
    let durations: &[f64] = if long { &[1e4, 1e5, 1e6, 1e7] } else { &[1e4, 1e5] };
    let runs: Vec<Soaked> = durations
        .iter()
        .map(|&duration| soak(&workspace, duration))
        .collect();
    for run in &runs {
        let bytes: u64 = run.files.values().sum();
        let (steps, peak_kib, error) = (run.steps, run.peak_kib, run.energy_error);
        println!("{steps:>11} steps: {peak_kib} KiB at most, {bytes} bytes of files, energy to {error:.4e}");
    }
    let first = &runs[0];
    assert_eq!(first.steps, 100_000);
    for (before, run) in runs.iter().zip(&runs[1..]) {
        assert_eq!(run.steps, 10 * before.steps);
        // Variations of the allocator are some per cent; a byte kept for every step would double the memory.
        let peak = run.peak_kib as f64 / first.peak_kib as f64;
        assert!(peak < 1.1, "{} KiB after {} KiB", run.peak_kib, first.peak_kib);
        // Numbers and labels have more digits, and pictures have other curves.
        for (name, &bytes) in &run.files {
            let (most, was) = (1.25 * first.files[name] as f64 + 1024.0, first.files[name]);
            assert!((bytes as f64) < most, "{name}: {bytes} bytes after {was}");
        }
        // Every step adds the same share to the energy input and to the error. Rounding alone, without
        // cancellation, would add 1e-16 per step: 1e-8 in 10^8 steps.
        let drift = (run.energy_error - first.energy_error).abs();
        assert!(
            drift < 0.1 * first.energy_error.abs(),
            "{} after {}",
            run.energy_error,
            first.energy_error
        );
    }
}
