//! Makes the runs of a calibration on a device, and on the CPU those that a device does not compute.

use std::sync::atomic::{AtomicBool, Ordering};

use rayon::prelude::*;
use slipfront::device::{Device, DeviceError};
use slipfront_run::device_curves::{CurveCase, device_curves};
use slipfront_run::device_runs::refusal;
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
    let ends = || stop.load(Ordering::Relaxed);
    let cases = |&(shares, seed): &(&[f64], u64)| -> Result<Vec<CurveCase>, TrainingError> {
        let conditions = set_up.conditions.iter();
        let cases = conditions.map(|conditions| {
            Ok(CurveCase {
                case: set_up.training_case(shares, seed, conditions)?,
                along: conditions.grid.along(),
                end: conditions.grid.end(),
            })
        });
        cases.collect()
    };
    let cases: Vec<Result<Vec<CurveCase>, TrainingError>> = points.par_iter().map(cases).collect();
    let (on_device, on_cpu): (Vec<&CurveCase>, Vec<&CurveCase>) = cases
        .iter()
        .flatten()
        .flatten()
        .partition(|one| refusal(&one.case, device).is_none());
    let (on_device, on_cpu) = rayon::join(
        || device_curves(&on_device, device, &ends),
        || -> Vec<_> {
            let runs = on_cpu.par_iter().with_max_len(1);
            runs.map(|one| one.curve_unless(&ends)).collect()
        },
    );
    let (mut on_device, mut on_cpu) = (on_device?.into_iter(), on_cpu.into_iter());
    let made = cases.into_iter().zip(points).map(|(cases, &(shares, _))| {
        let mut curves = Some(Vec::new());
        let cases = cases?;
        // Every run is taken from its place, also behind a run with an error.
        let runs = cases.iter().map(|one| match refusal(&one.case, device) {
            None => on_device.next().flatten(),
            Some(_) => on_cpu.next().flatten(),
        });
        for (record, run) in runs.collect::<Vec<_>>().into_iter().enumerate() {
            curves = match (curves, run) {
                (Some(mut curves), Some(run)) => {
                    curves.push(set_up.recorded(shares, record, run)?);
                    Some(curves)
                }
                _ => None,
            };
        }
        Ok(curves)
    });
    Ok(made.collect())
}
