//! Makes the runs of a calibration on a device.

use std::sync::atomic::{AtomicBool, Ordering};

use rayon::prelude::*;
use slipfront::device::{Device, DeviceError};
use slipfront_run::device::device_curves;
use slipfront_run::run_curve::CurveCase;
use slipfront_study::TrainingError;

use crate::set_up::{Curves, SetUp};

/// Curves of one run; none after a stop.
type Made = Result<Option<Curves>, TrainingError>;

/// Curves of the runs at these points of the ranges, each over the surface of its number, as
/// [`SetUp::curves`] finds them.
///
/// # Errors
/// When the device fails.
pub(crate) fn curves_on_device(
    set_up: &SetUp,
    points: &[(&[f64], u64)],
    device: &dyn Device,
    stop: &AtomicBool,
) -> Result<Vec<Made>, DeviceError> {
    let cases_of = |&(shares, seed): &(&[f64], u64)| -> Result<Vec<CurveCase>, TrainingError> {
        let conditions = set_up.conditions.iter();
        conditions
            .map(|conditions| set_up.curve_case(shares, seed, conditions))
            .collect()
    };
    let cases: Vec<Result<Vec<CurveCase>, TrainingError>> = points.par_iter().map(cases_of).collect();
    let valid: Vec<&CurveCase> = cases.iter().flatten().flatten().collect();
    let mut runs = device_curves(&valid, device, &|| stop.load(Ordering::Relaxed))?.into_iter();
    let made = cases.into_iter().zip(points).map(|(cases, &(shares, _))| {
        let runs = runs.by_ref().take(cases?.len()).enumerate();
        let curves =
            runs.map(|(record, run)| run.map(|run| set_up.recorded(shares, record, run)).transpose());
        // All runs of the point are taken before the first error counts.
        let curves: Vec<Result<Option<Vec<f64>>, TrainingError>> = curves.collect();
        let curves: Vec<Option<Vec<f64>>> = curves.into_iter().collect::<Result<_, _>>()?;
        Ok(curves.into_iter().collect())
    });
    Ok(made.collect())
}
