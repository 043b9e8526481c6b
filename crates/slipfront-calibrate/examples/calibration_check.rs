//! Power of the check of a calibration: the share of refused records among records that were changed in one
//! way.
//!
//! ```console
//! $ cargo run --release -p slipfront-calibrate --example calibration_check -- one_block 200 1
//! ```
//!
//! The arguments are the set-up (`one_block`, `lattice` or `rate_and_state`), the number of records of each
//! kind, and the number of the first record: other numbers are other records. Further arguments select kinds
//! by a part of their name. Records do not use the instruments of the library, but filters of this file, and
//! rate and state is integrated separately. Noise is 1 % of the mean.
//!
//! Prints for every kind: the root mean square of what a filter changes in a record, over the noise; the
//! share of refused records, by either part of the check; the share of records with an interval that misses
//! the truth by more than its half width; the refused share of these; and of the records that pass, the root
//! mean square of the differences from the closest curve beyond the noise, in units of the noise, and for
//! each unknown the share of intervals that contain the truth. Calibrations of kinds that are "described", or
//! described "as" another filter, have this filter in their file, and the truth is anywhere in the ranges.
//! For other kinds it is at least a tenth of a range away from the ends.

#[path = "support/random.rs"]
mod random;
#[path = "../tests/support/velocity_steps.rs"]
mod velocity_steps;

use std::collections::HashMap;
use std::error::Error;
use std::path::Path;
use std::sync::atomic::AtomicBool;

use rayon::prelude::*;
use slipfront_calibrate::{
    Calibration, CalibrationStage, Clipped, Closest, Conditions, Predicted, RunMaker, SamplePoints, SetUp,
    Training, closest,
};
use slipfront_case::case::Case;
use slipfront_case::case_file::Override;
use slipfront_run::measured::{Measure, MeasuredRecord};
use slipfront_run::run_curve::run_curve_unless;
use slipfront_study::{Base, StudyFile, Unknown};

use crate::random::{normal, uniform};
use crate::velocity_steps::{KEYS, RANGES, SPACING, friction};

/// Standard deviation of the noise, over the mean of friction.
const NOISE: f64 = 0.01;

/// Time step of the runs that become records. An experiment has none: this one is a twelfth of the finest of
/// a calibration of these cases.
const RECORD_STEP: f64 = 0.001;

/// Runs that are drawn from an estimate.
const PREDICTED: usize = 120;

/// Seeds of the surfaces of records; those of training runs are small.
const FIRST_SEED: u64 = 3_000_000_000;

/// Change of friction before it is a record.
#[derive(Clone, Copy)]
enum Change {
    Nothing,
    /// First order low-pass with this time constant, s.
    Lag(f64),
    /// Mean over the last of this time, s.
    Mean(f64),
    /// Noise times this.
    Noise(f64),
    /// Keys of the case that differ.
    Law(&'static str),
    /// Values above this quantile of the record are written as it.
    Clipped(f64),
    /// A number is added, as a share of the mean.
    Offset(f64),
    /// Friction rises by this share over the record.
    Drift(f64),
    /// Slip law in place of ageing.
    SlipLaw,
}

/// A kind of records.
#[derive(Clone, Copy)]
struct Kind {
    name: &'static str,
    change: Change,
    /// Table `[instrument]` of the calibration file; empty for a file without it.
    described: &'static str,
}

/// A kind of records of which the calibration file knows nothing.
const fn kind(name: &'static str, change: Change) -> Kind {
    Kind {
        name,
        change,
        described: "",
    }
}

struct Experiment {
    set_up: SetUp,
    runs: usize,
    kinds: Vec<Kind>,
    /// Whether records come from the integration of this file.
    is_rate_and_state: bool,
    /// Number of values of a record.
    count: usize,
    /// Distance of values, s.
    spacing: f64,
}

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().collect();
    let usage = "usage: calibration_check one_block|lattice|rate_and_state RECORDS FIRST [KIND]";
    let [_, name, records, first, kinds @ ..] = arguments.as_slice() else {
        return Err(usage.into());
    };
    let (records, first): (usize, usize) = (records.parse()?, first.parse()?);
    let experiment = match name.as_str() {
        "one_block" => one_block()?,
        "lattice" => lattice()?,
        "rate_and_state" => rate_and_state()?,
        _ => return Err(usage.into()),
    };
    let unknowns: Vec<&str> = experiment.set_up.unknowns.iter().map(Unknown::key).collect();
    println!(
        "{name}: {records} records of each kind from {first} on, {} training runs; intervals of {}",
        experiment.runs,
        unknowns.join(", ")
    );
    if name == "lattice" {
        println!(
            "curves of two surfaces differ by {:.1} times the noise",
            scatter(&experiment)?
        );
    }
    println!(
        "kind                         filter  refused compared  closest   misses   caught  beyond   held, of those that pass, %  differs most in"
    );
    let is_wanted =
        |kind: &str| kinds.is_empty() || kinds.iter().any(|wanted| kind.contains(wanted.as_str()));
    let wanted: Vec<&Kind> = experiment
        .kinds
        .iter()
        .filter(|kind| is_wanted(kind.name))
        .collect();
    let mut described: Vec<&str> = wanted.iter().map(|kind| kind.described).collect();
    described.sort_unstable();
    described.dedup();
    for described in described {
        let trained = Trained::new(&experiment, described)?;
        for kind in wanted.iter().filter(|kind| kind.described == described) {
            let judged: Vec<Judged> = (first..first + records)
                .into_par_iter()
                .with_max_len(1)
                .map(|record| trained.judge(&experiment, kind.change, record))
                .collect::<Result<_, String>>()?;
            report(kind.name, &judged);
        }
    }
    Ok(())
}

/// A calibration whose file describes an instrument.
struct Trained {
    set_up: SetUp,
    calibration: Calibration,
}

impl Trained {
    fn new(experiment: &Experiment, described: &str) -> Result<Self, Box<dyn Error>> {
        let go_on = AtomicBool::new(false);
        let instrument = if described.is_empty() {
            None
        } else {
            Some(described.parse()?)
        };
        let set_up = SetUp {
            instrument,
            ..experiment.set_up.clone()
        };
        let training = Training::run(
            &mut RunMaker::new(&go_on, 0, &mut |_| {}),
            CalibrationStage::Training,
            &set_up,
            experiment.runs,
        )?;
        let grids: Vec<SamplePoints> = set_up.conditions.iter().map(|one| one.grid.clone()).collect();
        Ok(Self {
            calibration: Calibration::new(&training, &grids, NOISE),
            set_up,
        })
    }
}

struct Judged {
    is_refused: bool,
    by_comparison: bool,
    by_closest: bool,
    misses: bool,
    /// Ratio of the differences from the closest curve to the noise, where that was looked for.
    noise_ratio: Option<f64>,
    /// Root mean square of what a filter changes, over the standard deviation of the noise.
    filtered_by: f64,
    /// Whether the interval of every unknown holds the truth.
    held: Vec<bool>,
    differs: &'static str,
}

impl Trained {
    fn judge(&self, experiment: &Experiment, change: Change, record: usize) -> Result<Judged, String> {
        let go_on = AtomicBool::new(false);
        let Self { set_up, calibration } = self;
        let truth = uniform(record, set_up.unknowns.len());
        // Intervals promise their share over the whole ranges. What a change does to them is clearer inside.
        let margin = if set_up.instrument.is_some() { 0.0 } else { 0.1 };
        let truth: Vec<f64> = truth.iter().map(|u| margin + (1.0 - 2.0 * margin) * u).collect();
        let (measured, filtered_by) = record_of(experiment, change, &truth, record)?;
        let clipped = Clipped::find(0, &measured);
        let values = [set_up.conditions[0].grid.record(&measured)];
        let estimate = calibration.estimate(&values);
        let points = calibration.sample(&estimate, PREDICTED);
        let failed = |error: slipfront_study::StudyError| error.to_string();
        let mut watch = |_: &_| {};
        let maker = &mut RunMaker::new(&go_on, 0, &mut watch);
        let stage = CalibrationStage::Prediction;
        // The search for the closest curve takes most of the time, and a record that is refused needs none.
        let is_refused = clipped.is_some() || estimate.misfit.is_refused();
        let found = if is_refused {
            None
        } else {
            closest(maker, set_up, &points, &values, NOISE).map_err(failed)?
        };
        let (of_step, closest) = found.unzip();
        let judged_by = of_step.as_ref().unwrap_or(set_up);
        let predicted = Predicted::run(maker, stage, judged_by, points, NOISE).map_err(failed)?;
        let comparison = predicted.compare(&values);
        let intervals = estimate
            .distributions
            .iter()
            .map(|one| one.interval(0.9))
            .zip(&truth);
        let (held, misses): (Vec<bool>, Vec<bool>) = intervals
            .map(|([low, high], truth)| {
                let beyond = (low - truth).max(truth - high);
                (beyond <= 0.0, beyond > 0.5 * (high - low))
            })
            .unzip();
        let by_comparison = comparison.is_refused();
        let by_closest = closest.as_ref().is_some_and(Closest::is_refused);
        Ok(Judged {
            is_refused: is_refused || by_comparison || by_closest,
            by_comparison,
            by_closest,
            misses: misses.contains(&true),
            noise_ratio: closest.map(|closest| closest.noise_ratio),
            filtered_by,
            held,
            differs: comparison.differs_in[0].0,
        })
    }
}

/// Root mean square of the difference of the curves of two surfaces with equal unknowns, over the noise.
fn scatter(experiment: &Experiment) -> Result<f64, String> {
    const PAIRS: usize = 50;
    let squares = (0..PAIRS).into_par_iter().map(|pair| {
        let truth = uniform(pair, experiment.set_up.unknowns.len());
        let curve = |surface| run(experiment, Change::Nothing, &truth, surface);
        let ((_, one), (_, other)) = (curve(2 * pair)?, curve(2 * pair + 1)?);
        let mean = one.iter().sum::<f64>() / one.len() as f64;
        let squares: f64 = one.iter().zip(&other).map(|(a, b)| (a - b).powi(2)).sum();
        Ok(squares / one.len() as f64 / (NOISE * mean).powi(2))
    });
    let squares: Vec<f64> = squares.collect::<Result<_, String>>()?;
    Ok((squares.iter().sum::<f64>() / PAIRS as f64).sqrt())
}

fn report(kind: &str, judged: &[Judged]) {
    let share = |of: &[&Judged], is: &dyn Fn(&Judged) -> bool| {
        100.0 * of.iter().filter(|one| is(one)).count() as f64 / of.len() as f64
    };
    let all: Vec<&Judged> = judged.iter().collect();
    let missing: Vec<&Judged> = judged.iter().filter(|one| one.misses).collect();
    let passing: Vec<&Judged> = judged.iter().filter(|one| !one.is_refused).collect();
    let held = (0..judged[0].held.len()).map(|j| format!("{:5.1}", share(&passing, &|one| one.held[j])));
    let held = held.collect::<Vec<_>>().join(" ");
    let ratios: Vec<f64> = passing.iter().filter_map(|one| one.noise_ratio).collect();
    let mean_square = ratios.iter().map(|ratio| ratio * ratio).sum::<f64>() / ratios.len() as f64;
    let beyond = if ratios.is_empty() {
        "-".to_owned()
    } else {
        format!("{:.2}", (mean_square - 1.0).max(0.0).sqrt())
    };
    let mut counts: HashMap<&str, usize> = HashMap::new();
    for one in judged.iter().filter(|one| one.by_comparison) {
        *counts.entry(one.differs).or_default() += 1;
    }
    let most = counts.into_iter().max_by_key(|(name, count)| (*count, *name));
    let square = |one: &Judged| one.filtered_by * one.filtered_by;
    let filtered_by = (judged.iter().map(square).sum::<f64>() / judged.len() as f64).sqrt();
    println!(
        "{kind:28} {filtered_by:6.2} {:6.1} % {:6.1} % {:6.1} % {:6.1} % {:6.1} % {:>7}   {held:28} {}",
        share(&all, &|one| one.is_refused),
        share(&all, &|one| one.by_comparison),
        share(&all, &|one| one.by_closest),
        share(&all, &|one| one.misses),
        share(&missing, &|one| one.is_refused),
        beyond,
        most.map_or("", |(name, _)| name)
    );
}

/// A record of this truth, changed, with noise; and the root mean square of what a filter changes, over the
/// standard deviation of the noise.
fn record_of(
    experiment: &Experiment,
    change: Change,
    truth: &[f64],
    record: usize,
) -> Result<(MeasuredRecord, f64), String> {
    let (times, fine) = if experiment.is_rate_and_state {
        let fine = friction(truth, STEPS, matches!(change, Change::SlipLaw));
        let dt = experiment.spacing / STEPS as f64;
        ((0..fine.len()).map(|k| k as f64 * dt).collect(), fine)
    } else {
        run(experiment, change, truth, record)?
    };
    let dt = times[1] - times[0];
    let filtered = match change {
        Change::Lag(constant) => lagged(&fine, dt, constant),
        Change::Mean(width) => running_mean(&fine, (width / dt).round() as usize),
        _ => fine.clone(),
    };
    let x: Vec<f64> = (0..experiment.count)
        .map(|k| k as f64 * experiment.spacing)
        .collect();
    let at_values = |curve: &[f64]| -> Vec<f64> {
        let at = |time: &f64| {
            let place = (time / dt).min((curve.len() - 1) as f64);
            let before = (place as usize).min(curve.len() - 2);
            curve[before] + (place - before as f64) * (curve[before + 1] - curve[before])
        };
        x.iter().map(at).collect()
    };
    let plain = at_values(&filtered);
    let mean = plain.iter().sum::<f64>() / plain.len() as f64;
    let changes = plain.iter().zip(at_values(&fine));
    let squares: f64 = changes.map(|(after, before)| (after - before).powi(2)).sum();
    let filtered_by = (squares / plain.len() as f64).sqrt() / (NOISE * mean);
    let factor = if let Change::Noise(factor) = change {
        factor
    } else {
        1.0
    };
    let offset = if let Change::Offset(offset) = change {
        offset * mean
    } else {
        0.0
    };
    let drift = if let Change::Drift(drift) = change {
        drift
    } else {
        0.0
    };
    let mut state = (record as u64 + 7).wrapping_mul(0xE703_7ED1_A0B4_28DB);
    let last = (plain.len() - 1) as f64;
    let mut y: Vec<f64> = plain
        .iter()
        .enumerate()
        .map(|(i, y)| {
            y * (1.0 + drift * i as f64 / last) + offset + factor * NOISE * mean * normal(&mut state)
        })
        .collect();
    if let Change::Clipped(quantile) = change {
        let mut sorted = y.clone();
        sorted.sort_by(f64::total_cmp);
        let bound = sorted[(quantile * last) as usize];
        y.iter_mut().for_each(|y| *y = y.min(bound));
    }
    Ok((measured(x, y), filtered_by))
}

/// Times and friction of every step of a run of this truth.
fn run(
    experiment: &Experiment,
    change: Change,
    truth: &[f64],
    record: usize,
) -> Result<(Vec<f64>, Vec<f64>), String> {
    let set_up = &experiment.set_up;
    let mut conditions = set_up.conditions[0].clone();
    let fine = Override::new("time.step", &toml::Value::from(RECORD_STEP));
    conditions.overrides.push(fine);
    if let Change::Law(keys) = change {
        let table: toml::Table = keys.parse().map_err(|error: toml::de::Error| error.to_string())?;
        conditions
            .overrides
            .extend(slipfront_study::axis::overrides(&table));
    }
    let case = set_up
        .case(truth, FIRST_SEED + record as u64, &conditions)
        .map_err(|error| error.to_string())?;
    let curve = run_curve_unless(&case, Measure::Time, conditions.grid.end(), &|| false).ok_or("given up")?;
    let curve = curve.map_err(|error| error.to_string())?;
    Ok((curve.time, curve.coefficient))
}

/// A record of coefficients over time.
fn measured(x: Vec<f64>, y: Vec<f64>) -> MeasuredRecord {
    MeasuredRecord::new(x, y, Measure::Time, Measure::Coefficient)
}

/// A low-pass of first order with this cutoff in Hz.
const fn low_pass(cutoff: f64) -> Change {
    Change::Lag(1.0 / (std::f64::consts::TAU * cutoff))
}

/// A low-pass of first order by Euler's backward method.
fn lagged(y: &[f64], dt: f64, constant: f64) -> Vec<f64> {
    let mut x = y[0];
    y.iter()
        .map(|y| {
            x += dt / (constant + dt) * (y - x);
            x
        })
        .collect()
}

fn running_mean(y: &[f64], width: usize) -> Vec<f64> {
    let mut sum = 0.0;
    (0..y.len())
        .map(|i| {
            // Before the drive begins there is no friction.
            sum += y[i] - i.checked_sub(width).map_or(0.0, |left| y[left]);
            sum / width as f64
        })
        .collect()
}

fn base(text: &str) -> Result<Base, Box<dyn Error>> {
    Ok(StudyFile::parse(text, "base", "base", Path::new(""))?.base)
}

/// An experiment with records of so many values at this distance in s.
fn experiment(
    base: Base,
    unknowns: Vec<Unknown>,
    count: usize,
    spacing: f64,
) -> Result<Experiment, Box<dyn Error>> {
    let x: Vec<f64> = (0..count).map(|k| k as f64 * spacing).collect();
    let grid = SamplePoints::from_record(&measured(x, vec![0.0; count])).ok_or("no places")?;
    let conditions = vec![Conditions {
        overrides: Vec::<Override>::new(),
        grid,
    }];
    Ok(Experiment {
        set_up: SetUp {
            base,
            unknowns,
            conditions,
            instrument: None,
            is_finer: false,
            halvings: 0,
        },
        runs: 600,
        kinds: Vec::new(),
        is_rate_and_state: false,
        count,
        spacing,
    })
}

/// Changes that any record can have.
const COMMON: [Kind; 6] = [
    kind("good", Change::Nothing),
    kind("noise three times", Change::Noise(3.0)),
    kind("clipped at the 90 % quantile", Change::Clipped(0.9)),
    kind("offset of 10 %", Change::Offset(0.1)),
    kind("drift of 3 %", Change::Drift(0.03)),
    kind("drift of -3 %", Change::Drift(-0.03)),
];

/// Stick-slip of a rigid slider on a spring: the case of the paper on paper.
fn one_block() -> Result<Experiment, Box<dyn Error>> {
    let text = "[base]\nslider = { blocks = [1, 1], block_size = '4 cm', density = '479.7 kg/m^3', young_modulus = '11.2 kPa' }\n\
                load.pressure = '188.2 Pa'\ndrive.speed = '1.1 mm/s'\ntime.step = 0.4\n\
                friction = { sigma_static_star = 0, sigma_kinetic_star = 0 }";
    let unknowns = vec![
        Unknown::new("friction.mu_static", 0.2, 0.6, false)?,
        Unknown::new("friction.r_star", 0.5, 0.98, false)?,
        Unknown::new("slider.damping_rate", 1.0, 100.0, true)?.in_unit("1/s"),
        Unknown::new("drive.total_stiffness", 80.0, 350.0, true)?.in_unit("N/m"),
    ];
    // 4 s, 200 values a second, which become means of two.
    let mut made = experiment(base(text)?, unknowns, 800, 0.005)?;
    made.kinds = COMMON.to_vec();
    made.kinds.extend([
        kind("low-pass 20 Hz", low_pass(20.0)),
        kind("low-pass 10 Hz", low_pass(10.0)),
        kind("mean over 0.1 s", Change::Mean(0.1)),
        Kind {
            name: "20 Hz, described",
            change: low_pass(20.0),
            described: "filter = 'first_order'\ncutoff = '20 Hz'",
        },
        Kind {
            name: "20 Hz as 10 Hz",
            change: low_pass(20.0),
            described: "filter = 'first_order'\ncutoff = '10 Hz'",
        },
        Kind {
            name: "20 Hz as 40 Hz",
            change: low_pass(20.0),
            described: "filter = 'first_order'\ncutoff = '40 Hz'",
        },
        Kind {
            name: "10 Hz, described",
            change: low_pass(10.0),
            described: "filter = 'first_order'\ncutoff = '10 Hz'",
        },
        Kind {
            name: "10 Hz as 5 Hz",
            change: low_pass(10.0),
            described: "filter = 'first_order'\ncutoff = '5 Hz'",
        },
        Kind {
            name: "10 Hz as 20 Hz",
            change: low_pass(10.0),
            described: "filter = 'first_order'\ncutoff = '20 Hz'",
        },
        Kind {
            name: "mean over 0.1 s, described",
            change: Change::Mean(0.1),
            described: "filter = 'moving_mean'\ntime = '0.1 s'",
        },
        Kind {
            name: "mean over 0.1 s as 0.05 s",
            change: Change::Mean(0.1),
            described: "filter = 'moving_mean'\ntime = '0.05 s'",
        },
        Kind {
            name: "mean over 0.1 s as 0.2 s",
            change: Change::Mean(0.1),
            described: "filter = 'moving_mean'\ntime = '0.2 s'",
        },
        kind(
            "ageing",
            Change::Law("friction.ageing = { law = 'logarithmic', beta = 0.03, time_star = 1 }"),
        ),
        kind(
            "velocity weakening",
            Change::Law("friction.velocity = { law = 'weakening', v_c_star = 0.1, ratio = 0.5 }"),
        ),
    ]);
    Ok(made)
}

/// A lattice whose strength falls with slip.
fn lattice() -> Result<Experiment, Box<dyn Error>> {
    let plain = Case::parse("", "plain", "", &[])?;
    let time = plain.scales.time();
    let text = "[base]\nslider.blocks = [16, 8]\ndrive.v_star = 0.03\ntime = { step = 0.4, duration_star = 400 }\n\
                friction.slip_weakening = { length_star = 1 }";
    let unknowns = vec![
        Unknown::new("friction.mu_static", 0.3, 0.9, false)?,
        Unknown::new("friction.r_star", 0.3, 0.9, false)?,
        Unknown::new("slider.omega_star", 0.03, 0.5, true)?,
        Unknown::new("drive.stiffness_star", 0.26, 0.53, true)?,
    ];
    let mut made = experiment(base(text)?, unknowns, 400, time)?;
    made.runs = 1000;
    made.kinds = COMMON.to_vec();
    made.kinds.extend([
        // The lattice swings with a period of some 10 t*.
        kind("low-pass over 1 t*", Change::Lag(time)),
        kind("low-pass over 3 t*", Change::Lag(3.0 * time)),
        kind("mean over 8 t*", Change::Mean(8.0 * time)),
    ]);
    Ok(made)
}

/// Steps of the integration from one value of a record to the next.
const STEPS: usize = 16;

/// Steps of speed of one block under rate and state.
fn rate_and_state() -> Result<Experiment, Box<dyn Error>> {
    let unknowns = KEYS
        .into_iter()
        .zip(RANGES)
        .map(|(key, [from, to])| Unknown::new(key, from, to, false))
        .collect::<Result<_, _>>()?;
    let time = Case::parse("", "unit", "", &[])?.scales.time();
    let count = friction(&[0.5; 3], STEPS, false).len().div_ceil(STEPS);
    let mut made = experiment(velocity_steps::base()?, unknowns, count, SPACING * time)?;
    made.is_rate_and_state = true;
    made.kinds = COMMON.to_vec();
    made.kinds.extend([
        kind("slip law", Change::SlipLaw),
        // At V_0 the drive moves by one unit of displacement in 200 t*.
        kind("lag of a displacement of 0.1", Change::Lag(20.0 * time)),
        kind("lag of a displacement of 0.3", Change::Lag(60.0 * time)),
    ]);
    Ok(made)
}
