//! Coverage, width and cost of the intervals of a calibration, on synthetic records.
//!
//! ```console
//! $ cargo run --release -p slipfront-calibrate --example calibration_coverage -- 1000 1000 5000
//! ```
//!
//! The arguments are the number of training runs, the number of records, and the number of the first record;
//! another first number selects other records. The slider has 30 x 30 blocks and six unknowns. The records
//! come from surfaces that training has not used, with 1 % and 5 % of noise. For every unknown, the program
//! prints the share of records with the true value in the interval of 90 %, in total and for each quarter of
//! the range; the median width of the interval over 0.9 of the range; and the probability that the ranks of
//! the true values are uniform (Kolmogorov-Smirnov test). It then prints the share of records that the check
//! refuses, without and with a drift, and processor times.

#[path = "support/random.rs"]
mod random;

use std::error::Error;
use std::path::Path;
use std::sync::atomic::AtomicBool;

use rayon::prelude::*;
use slipfront_calibrate::{
    Calibration, CalibrationStage, Conditions, Curves, Estimate, RunMaker, SamplePoints, SetUp, Training,
};
use slipfront_case::case::Case;
use slipfront_case::case_file::Override;
use slipfront_run::measured::{Measure, MeasuredRecord};
use slipfront_study::{Base, StudyFile, Unknown};

use crate::random::{normal, uniform};

/// Values of a record, one per t*.
const VALUES: usize = 399;

/// First seed of the surfaces of records; the seeds of training runs are smaller.
const FIRST_SEED: u64 = 3_000_000_000;

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().collect();
    let number = |k: usize| -> Result<usize, Box<dyn Error>> {
        Ok(arguments
            .get(k)
            .ok_or("usage: calibration_coverage RUNS RECORDS FIRST")?
            .parse()?)
    };
    let (runs, records, first) = (number(1)?, number(2)?, number(3)?);
    let (set_up, unit) = set_up()?;
    let began = processor_seconds()?;
    let go_on = AtomicBool::new(false);
    let training = Training::run(
        &mut RunMaker::new(&go_on, 0, &mut |_| {}),
        CalibrationStage::Training,
        &set_up,
        runs,
    )?;
    let trained = processor_seconds()? - began;
    println!("training: {runs} runs in {trained:.1} s of processor time");
    let truths: Vec<Vec<f64>> = (first..first + records)
        .map(|record| uniform(record, set_up.unknowns.len()))
        .collect();
    let curves: Vec<Vec<f64>> = records_of(&set_up, &truths, first)?;
    println!("{records} records made; a unit of time is {unit:.3e} s");
    let grids: Vec<SamplePoints> = set_up
        .conditions
        .iter()
        .map(|conditions| conditions.grid.clone())
        .collect();
    for noise in [0.01, 0.05] {
        let began = processor_seconds()?;
        let calibration = Calibration::new(&training, &grids, noise);
        let learnt = processor_seconds()? - began;
        println!(
            "\nnoise {noise}: learning took {learnt:.1} s of processor time, training and learning {:.1} s",
            trained + learnt
        );
        let fits = |drift: f64| -> Vec<Estimate> {
            let all = curves.par_iter().enumerate();
            all.map(|(record, curve)| calibration.estimate(&[noisy(curve, noise, drift, first + record)]))
                .collect()
        };
        let began = processor_seconds()?;
        let good = fits(0.0);
        let fitted = processor_seconds()? - began;
        println!("a fit takes {:.4} s of processor time", fitted / records as f64);
        report(&set_up.unknowns, &truths, &good);
        let refused = |fits: &[Estimate]| {
            let share = |is: &dyn Fn(&Estimate) -> bool| {
                100.0 * fits.iter().filter(|fit| is(fit)).count() as f64 / fits.len() as f64
            };
            let (all, drift, far) = (
                share(&|fit| fit.misfit.is_refused()),
                share(&|fit| fit.misfit.has_drift),
                share(&|fit| fit.misfit.distance > 1.0),
            );
            format!("{all:.1} % (drift {drift:.1} %, far {far:.1} %)")
        };
        println!("refused as they are: {}", refused(&good));
        for drift in [0.02, 0.05, -0.05] {
            println!("refused with a drift of {drift}: {}", refused(&fits(drift)));
        }
    }
    Ok(())
}

/// The six unknowns of a slider of 30 x 30 blocks, and the unit of time in s.
fn set_up() -> Result<(SetUp, f64), Box<dyn Error>> {
    let plain = Case::parse("", "plain", "", &[])?;
    let (time, speed) = (
        plain.scales.time(),
        0.018 * plain.scales.speed() / plain.scales.mu_static_mean,
    );
    let base = format!(
        "base.slider.blocks = [30, 30]\nbase.drive.speed = '{speed:?} m/s'\nbase.time = {{ duration_star = 400, step = 0.4 }}"
    );
    let base: Base = StudyFile::parse(&base, "base", "base", Path::new(""))?.base;
    let unknowns = vec![
        Unknown::new("friction.mu_static", 0.3, 0.9, false)?,
        Unknown::new("friction.r_star", 0.3, 0.9, false)?,
        Unknown::new("friction.sigma_static_star", 0.01, 0.15, false)?,
        Unknown::new("friction.sigma_kinetic_star", 0.01, 0.15, false)?,
        Unknown::new("slider.omega_star", 0.03, 0.5, true)?,
        Unknown::new("drive.stiffness_star", 0.2625, 0.525, true)?,
    ];
    let x: Vec<f64> = (0..VALUES).map(|k| k as f64 * time).collect();
    let record = MeasuredRecord::new(x.clone(), x, Measure::Time, Measure::Coefficient);
    let grid = SamplePoints::from_record(&record).ok_or("no grid")?;
    let conditions = vec![Conditions {
        overrides: Vec::<Override>::new(),
        grid,
    }];
    Ok((
        SetUp {
            base,
            unknowns,
            conditions,
            instrument: None,
            is_finer: false,
            halvings: 0,
        },
        time,
    ))
}

/// Friction of records without noise, each on its own surface.
fn records_of(set_up: &SetUp, truths: &[Vec<f64>], first: usize) -> Result<Vec<Vec<f64>>, Box<dyn Error>> {
    let go_on = AtomicBool::new(false);
    let curves: Vec<_> = truths
        .par_iter()
        .enumerate()
        .map(|(record, truth)| set_up.curves(truth, FIRST_SEED + (first + record) as u64, &go_on))
        .collect();
    let curves: Option<Vec<Curves>> = curves.into_iter().collect::<Result<_, _>>()?;
    Ok(curves.ok_or("given up")?.into_iter().flatten().collect())
}

/// A record with added noise, as a share of its mean, and a linear drift, as a share of friction over the
/// record.
fn noisy(curve: &[f64], noise: f64, drift: f64, record: usize) -> Vec<f64> {
    let mut state = (record as u64 + 7).wrapping_mul(0xE703_7ED1_A0B4_28DB) ^ noise.to_bits();
    let deviation = noise * curve.iter().sum::<f64>() / curve.len() as f64;
    let last = (curve.len() - 1) as f64;
    let values = curve.iter().enumerate();
    values
        .map(|(i, y)| y * (1.0 + drift * i as f64 / last) + deviation * normal(&mut state))
        .collect()
}

fn report(unknowns: &[Unknown], truths: &[Vec<f64>], fits: &[Estimate]) {
    println!(
        "{:28} cover  by quarter of the range   width/0.9   uniform ranks   undetermined",
        "unknown"
    );
    for (j, unknown) in unknowns.iter().enumerate() {
        let mut held = [0.0; 4];
        let mut all = [0.0; 4];
        let (mut widths, mut ranks) = (Vec::new(), Vec::new());
        let mut undetermined = 0.0;
        for (truth, fit) in truths.iter().zip(fits) {
            let [low, high] = fit.distributions[j].interval(0.9);
            let quarter = ((4.0 * truth[j]) as usize).min(3);
            all[quarter] += 1.0;
            held[quarter] += f64::from(u8::from((low..=high).contains(&truth[j])));
            widths.push((high - low) / 0.9);
            ranks.push(fit.distributions[j].below(truth[j]));
            undetermined += f64::from(u8::from(fit.undetermined.contains(&j)));
        }
        widths.sort_by(f64::total_cmp);
        let n = truths.len() as f64;
        let quarters: Vec<String> = (0..4)
            .map(|k| format!("{:.1}", 100.0 * held[k] / all[k]))
            .collect();
        println!(
            "{:28} {:.1} %  {}   {:.4}   p = {:.4}   {:.1} %",
            unknown.key(),
            100.0 * held.iter().sum::<f64>() / n,
            quarters.join(" "),
            widths[widths.len() / 2],
            uniformity(&mut ranks),
            100.0 * undetermined / n
        );
    }
    let pairs: usize = fits.iter().map(|fit| fit.pairs.len()).sum();
    println!("pairs told: {pairs} in {} records", fits.len());
}

/// Probability that uniform ranks have at least this Kolmogorov-Smirnov distance:
/// `2 sum (-1)^(k-1) exp(-2 k^2 x^2)`.
fn uniformity(ranks: &mut [f64]) -> f64 {
    ranks.sort_by(f64::total_cmp);
    let n = ranks.len() as f64;
    let distances = ranks.iter().enumerate();
    let distance = distances.fold(0.0_f64, |largest, (i, rank)| {
        largest.max(rank - i as f64 / n).max((i as f64 + 1.0) / n - rank)
    });
    let x = distance * (n.sqrt() + 0.12 + 0.11 / n.sqrt());
    let terms = (1..100).map(|k| f64::from(k % 2 * 4 - 2) * (-2.0 * f64::from(k * k) * x * x).exp());
    terms.sum::<f64>().clamp(0.0, 1.0)
}

/// Processor time of this process, all threads, in s.
fn processor_seconds() -> Result<f64, Box<dyn Error>> {
    let stat = std::fs::read_to_string("/proc/self/stat")?;
    let behind = stat.rsplit(')').next().unwrap_or_default();
    let ticks: Vec<f64> = behind
        .split_whitespace()
        .skip(11)
        .take(2)
        .map(str::parse)
        .collect::<Result<_, _>>()?;
    Ok(ticks.iter().sum::<f64>() / 100.0)
}
