//! Every case under `cases/` loads, runs, and gives the numbers pinned in `pinned.toml` next to this file.
//!
//! A new case fails until its pin is added: the failure prints the lines to add.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use rayon::prelude::*;
use serde::Deserialize;
use slipfront_case::case::{Case, Ranks};
use slipfront_run::running;
use slipfront_run::summary::Summary;

/// Relative deviation that is accepted.
///
/// A run gives the same bits every time and on every machine: the order of all sums is fixed, and no result
/// depends on the system's mathematical library. So no deviation has to be accepted today; 1e-9 leaves room
/// for another order of summation, and is far below the effect of any change of physics, scheme or random
/// numbers.
///
/// After the onset the motion is chaotic, and a change of rounding changes kinetic friction by its
/// statistical scatter, a few percent. Kinetic friction has the same tolerance nevertheless, because rounding
/// does not change by itself. After a sum was reordered on purpose, the pins of kinetic friction may be
/// renewed if all other pins hold.
const TOLERANCE: f64 = 1e-9;

/// Folders of other tests, and of files that are not single cases.
const ELSEWHERE: [&str; 4] = ["calibrations", "designs", "paper", "studies"];

/// The pinned results of one case.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct Pin {
    static_friction_star: f64,
    onset_time_star: f64,
    first_slip_time_star: f64,
    /// Kinetic friction; none for a run that has no kinetic window.
    kinetic_friction_star: Option<f64>,
    texture_percent: f64,
}

impl Pin {
    /// Pins of a summary; missing results are NaN, which equals no pin.
    fn from_summary(summary: &Summary) -> Self {
        Self {
            static_friction_star: summary.static_friction_star,
            onset_time_star: summary.onset_time_star,
            first_slip_time_star: summary.first_slip_time_star.unwrap_or(f64::NAN),
            kinetic_friction_star: summary.kinetic_friction_star,
            texture_percent: summary.texture_percent,
        }
    }

    /// The pin as written in `pinned.toml`.
    fn lines(&self, name: &str) -> String {
        let kinetic = self.kinetic_friction_star;
        let kinetic = kinetic.map_or(String::new(), |mu| format!("kinetic_friction_star = {mu:?}\n"));
        format!(
            "[{name:?}]\nstatic_friction_star = {:?}\nonset_time_star = {:?}\nfirst_slip_time_star = {:?}\n\
             {kinetic}texture_percent = {:?}\n",
            self.static_friction_star, self.onset_time_star, self.first_slip_time_star, self.texture_percent
        )
    }

    fn holds(&self, found: &Pin) -> bool {
        let close = |pinned: f64, found: f64| (found - pinned).abs() <= TOLERANCE * pinned.abs();
        close(self.static_friction_star, found.static_friction_star)
            && close(self.onset_time_star, found.onset_time_star)
            && close(self.first_slip_time_star, found.first_slip_time_star)
            && match (self.kinetic_friction_star, found.kinetic_friction_star) {
                (Some(pinned), Some(found)) => close(pinned, found),
                (pinned, found) => pinned == found,
            }
            // Exact, because this is a count of blocks.
            && self.texture_percent == found.texture_percent
    }
}

fn cases() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../cases")
}

/// Every case file below `folder`, by its path without the ending.
fn case_files(folder: &Path, prefix: &str) -> Vec<(String, PathBuf)> {
    let mut files = Vec::new();
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        let name = path.file_stem().unwrap().to_string_lossy().into_owned();
        if path.is_dir() && !ELSEWHERE.contains(&name.as_str()) {
            files.extend(case_files(&path, &format!("{prefix}{name}/")));
        } else if path.extension().is_some_and(|ending| ending == "toml") {
            files.push((format!("{prefix}{name}"), path));
        }
    }
    files.sort();
    files
}

#[test]
fn every_case_gives_its_pinned_results() {
    let text = include_str!("pinned.toml");
    let mut pinned: BTreeMap<String, Pin> = toml::from_str(text).unwrap();
    let found: Vec<(String, Pin)> = case_files(&cases(), "")
        .into_par_iter()
        .map(|(name, path)| {
            let case = Arc::new(
                Case::load(&path, &[], &mut |_| true, Ranks::ALONE).unwrap_or_else(|error| panic!("{error}")),
            );
            let record = running::run(&case, 1).unwrap();
            (name, Pin::from_summary(&record.summary))
        })
        .collect();
    assert!(!found.is_empty(), "no case in {}", cases().display());
    let mut complaints = String::new();
    for (name, found) in &found {
        match pinned.remove(name) {
            Some(pin) if pin.holds(found) => {}
            Some(pin) => {
                complaints += &format!(
                    "\n{name} has changed: it was\n\n{}\nand is now\n\n{}",
                    pin.lines(name),
                    found.lines(name)
                );
            }
            None => {
                complaints += &format!("\n{name} is new: add to pinned.toml\n\n{}", found.lines(name));
            }
        }
    }
    for name in pinned.keys() {
        complaints += &format!("\n{name} is pinned but is no case any more\n");
    }
    assert!(complaints.is_empty(), "{complaints}");
}

#[test]
fn every_case_says_first_what_it_shows() {
    for (name, path) in case_files(&cases(), "") {
        let text = std::fs::read_to_string(path).unwrap();
        assert!(text.starts_with("# "), "{name} opens without a comment");
    }
}
