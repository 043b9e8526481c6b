//! Rate-and-state friction of a block that is driven with velocity steps: a calibration is compared with an
//! independent maximum-likelihood fit.
//!
//! Records come from the rate-and-state equations, which `velocity_steps` integrates by the Runge-Kutta
//! method, and are fitted here by the Gauss-Newton method.

#[path = "../support/velocity_steps.rs"]
mod velocity_steps;

use std::sync::atomic::AtomicBool;

use chacha20::ChaCha8Rng;
use chacha20::rand_core::{Rng, SeedableRng};
use slipfront_calibrate::{
    Calibration, CalibrationStage, Conditions, RunMaker, SamplePoints, SetUp, Training,
};
use slipfront_case::case::Case;
use slipfront_run::measured::{Measure, MeasuredRecord};
use slipfront_study::Unknown;

use self::velocity_steps::{KEYS, RANGES, SPACING};

/// Standard deviation of the noise, over the mean of friction.
const NOISE: f64 = 0.01;

/// Friction of a block at these shares of the ranges, at every value of a record.
fn friction(shares: [f64; 3]) -> Vec<f64> {
    const STEPS: usize = 8;
    let fine = velocity_steps::friction(&shares, STEPS, false);
    fine.into_iter().step_by(STEPS).collect()
}

/// Maximum-likelihood estimate from a record with normal noise of this standard deviation, and the half width
/// of each interval of 90 %, `1.645 sqrt(s^2 (J^T J)^-1)`, both as shares of the ranges.
fn most_likely(record: &[f64], noise: f64) -> [[f64; 2]; 3] {
    let squares = |curve: &[f64]| -> f64 { curve.iter().zip(record).map(|(f, y)| (y - f).powi(2)).sum() };
    let mut shares = [0.5; 3];
    let mut found = friction(shares);
    for _ in 0..30 {
        const STEP: f64 = 1e-4;
        let slopes: [Vec<f64>; 3] = std::array::from_fn(|j| {
            let mut beside = shares;
            beside[j] += STEP;
            let beside = friction(beside);
            beside.iter().zip(&found).map(|(b, f)| (b - f) / STEP).collect()
        });
        let product = |a: &[f64], b: &[f64]| -> f64 { a.iter().zip(b).map(|(a, b)| a * b).sum() };
        let rest: Vec<f64> = record.iter().zip(&found).map(|(y, f)| y - f).collect();
        let matrix: [[f64; 3]; 3] =
            std::array::from_fn(|i| std::array::from_fn(|j| product(&slopes[i], &slopes[j])));
        let inverse = inverse(&matrix);
        let right: [f64; 3] = std::array::from_fn(|i| product(&slopes[i], &rest));
        let step: [f64; 3] = std::array::from_fn(|i| product(&inverse[i], &right));
        // A step that leaves the range or fits worse is halved.
        let mut share = 1.0;
        let (next, there) = loop {
            let next: [f64; 3] = std::array::from_fn(|j| (shares[j] + share * step[j]).clamp(-0.15, 1.3));
            let there = friction(next);
            if squares(&there) <= squares(&found) || share < 1e-3 {
                break (next, there);
            }
            share *= 0.5;
        };
        let moved = (0..3).map(|j| (next[j] - shares[j]).abs()).fold(0.0, f64::max);
        (shares, found) = (next, there);
        if moved < 1e-5 {
            return std::array::from_fn(|j| [shares[j], 1.645 * noise * inverse[j][j].sqrt()]);
        }
    }
    panic!("no maximum of the likelihood was found");
}

/// The inverse of a matrix, by its cofactors.
fn inverse(m: &[[f64; 3]; 3]) -> [[f64; 3]; 3] {
    let cofactor = |i: usize, j: usize| {
        let [a, b] = [(i + 1) % 3, (i + 2) % 3];
        let [c, d] = [(j + 1) % 3, (j + 2) % 3];
        m[a][c] * m[b][d] - m[a][d] * m[b][c]
    };
    let determinant: f64 = (0..3).map(|j| m[0][j] * cofactor(0, j)).sum();
    std::array::from_fn(|i| std::array::from_fn(|j| cofactor(j, i) / determinant))
}

fn set_up() -> SetUp {
    let unknowns = KEYS
        .into_iter()
        .zip(RANGES)
        .map(|(key, [from, to])| Unknown::new(key, from, to, false).unwrap());
    let time = Case::parse("", "unit", "", &[]).unwrap().scales.time();
    let count = friction([0.5; 3]).len();
    let x: Vec<f64> = (0..count).map(|k| time * SPACING * k as f64).collect();
    let record = MeasuredRecord::new(x.clone(), x, Measure::Time, Measure::Coefficient);
    SetUp {
        base: velocity_steps::base().unwrap(),
        unknowns: unknowns.collect(),
        conditions: vec![Conditions {
            overrides: Vec::new(),
            grid: SamplePoints::from_record(&record).unwrap(),
        }],
        instrument: None,
        is_finer: false,
        halvings: 0,
    }
}

/// A calibration is compared with maximum likelihood, which is the optimal estimate for many values:
///
/// - its intervals contain the maximum-likelihood estimate in about 90 % of the records;
/// - they contain the true value in about 90 % of the records;
/// - their widths are comparable: at most twice as wide, and not narrower, since narrower intervals would
///   miss true values too often. A width from some hundred residuals scatters by a tenth.
///
/// The bound of the share allows for three standard deviations of 30 records: 0.9 - 3 sqrt(0.09/30) = 0.74.
#[test]
fn rate_and_state_agrees_with_maximum_likelihood() {
    let set_up = set_up();
    let go_on = AtomicBool::new(false);
    let training = Training::run(
        &mut RunMaker::new(&go_on, 0, &mut |_| {}),
        CalibrationStage::Training,
        &set_up,
        400,
    )
    .unwrap_or_else(|error| panic!("{error}"));
    let grids = [set_up.conditions[0].grid.clone()];
    // Values of a record are not averaged, so a record can be used as a curve without change.
    assert_eq!(grids[0].places().len(), friction([0.5; 3]).len());
    let calibration = Calibration::new(&training, &grids, NOISE);
    let mut draws = ChaCha8Rng::from_seed(*b"records of a block at two speeds");
    let mut uniform = || (draws.next_u64() >> 11) as f64 / (1_u64 << 53) as f64;
    const RECORDS: usize = 30;
    let (mut truth_held, mut likely_held) = ([0; 3], [0; 3]);
    let mut ratios = [const { Vec::new() }; 3];
    for _ in 0..RECORDS {
        // Away from the ends of the ranges: near them, a calibration uses the bounds, which the likelihood
        // ignores.
        let truth: [f64; 3] = std::array::from_fn(|_| 0.2 + 0.6 * uniform());
        let plain = friction(truth);
        let noise = NOISE * plain.iter().sum::<f64>() / plain.len() as f64;
        let mut normal =
            || (-2.0 * (1.0 - uniform()).ln()).sqrt() * (std::f64::consts::TAU * uniform()).cos();
        let record: Vec<f64> = plain.iter().map(|y| y + noise * normal()).collect();
        let likely = most_likely(&record, noise);
        let found = calibration.estimate(&[record]);
        for j in 0..3 {
            let [low, high] = found.distributions[j].interval(0.9);
            truth_held[j] += usize::from((low..=high).contains(&truth[j]));
            likely_held[j] += usize::from((low..=high).contains(&likely[j][0]));
            ratios[j].push((high - low) / (2.0 * likely[j][1]));
        }
    }
    let told = format!("{truth_held:?} {likely_held:?} {ratios:?}");
    for j in 0..3 {
        ratios[j].sort_by(f64::total_cmp);
        let ratio = ratios[j][RECORDS / 2];
        assert!(truth_held[j] as f64 >= 0.74 * RECORDS as f64, "{j}: {told}");
        assert!(likely_held[j] as f64 >= 0.74 * RECORDS as f64, "{j}: {told}");
        assert!((0.9..=2.0).contains(&ratio), "{j}: {told}");
    }
}
