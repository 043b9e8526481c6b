//! Soak: ten times as many steps take no more memory and no more disk space, and the energy balance closes as
//! well as before.
//!
//! `cargo test` runs a million steps. Up to 10^8 steps, with the measured figures:
//!
//! ```console
//! $ SLIPFRONT_SOAK=long cargo test --release -p slipfront-cli --test torture soak -- --nocapture
//! ```

use std::collections::BTreeMap;
use std::thread::sleep;
use std::time::Duration;

use crate::support::workspace::Workspace;

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
    let mut child = workspace.start(&format!(
        "run --quiet --threads 1 --set slider.blocks=[6,5] --set drive.v_star=0.1 --set time.duration_star={duration_star} --out {out}"
    ));
    let mut peak_kib = 0;
    let status = loop {
        // The peak comes while the pictures are drawn, for some tenths of a second at the end.
        let status = std::fs::read_to_string(format!("/proc/{}/status", child.id())).unwrap_or_default();
        let peak = status.lines().find_map(|line| line.strip_prefix("VmHWM:"));
        let peak = peak.and_then(|peak| peak.trim().trim_end_matches(" kB").parse().ok());
        peak_kib = peak_kib.max(peak.unwrap_or(0));
        if let Some(status) = child.try_wait().unwrap() {
            break status;
        }
        sleep(Duration::from_millis(1));
    };
    assert!(status.success(), "{status}");
    let summary = workspace.read(&format!("{out}/summary.json"));
    let summary: serde_json::Value = serde_json::from_slice(&summary).unwrap();
    let files = std::fs::read_dir(workspace.path(&out)).unwrap().map(|entry| {
        let entry = entry.unwrap();
        let name = entry.file_name().into_string().unwrap();
        (name, entry.metadata().unwrap().len())
    });
    Soaked {
        steps: summary["steps"].as_u64().unwrap(),
        peak_kib,
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
