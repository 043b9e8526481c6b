//! Many runs in one call; only their numbers are kept.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

use pyo3::prelude::*;
use rayon::prelude::*;
use slipfront_case::case::Case as SlipfrontCase;
use slipfront_run::device::device_summaries;
use slipfront_run::run_summary::run_summary_unless;
use slipfront_run::summary::summary_json;

use crate::case::Case;
use crate::device::{self, device_error};
use crate::errors::RunError;
use crate::process::{detached, on_pool};

/// Runs cases, one on each thread at a time, or all on a device, and returns `summary.json` of each in their
/// order. A signal ends all of them. A run that diverges ends those after it, so that the error is always
/// that of the first.
#[pyfunction]
pub(crate) fn run_summaries(
    py: Python<'_>,
    cases: Vec<Bound<'_, Case>>,
    threads: usize,
    device: &str,
) -> PyResult<Vec<String>> {
    let cases: Vec<Arc<SlipfrontCase>> = cases.iter().map(|case| Arc::clone(&case.get().0)).collect();
    let device = detached(py, || device::device(device))??;
    let first_diverged = AtomicUsize::new(usize::MAX);
    let run_all = |stop: &AtomicBool| {
        let stops = || stop.load(Ordering::Relaxed);
        let run = |index: usize| {
            let ends = || stops() || first_diverged.load(Ordering::Relaxed) < index;
            let ended = run_summary_unless(&cases[index], &ends)?;
            if ended.is_err() {
                first_diverged.fetch_min(index, Ordering::Relaxed);
            }
            Some(ended)
        };
        match &device {
            Some(device) => device_summaries(&cases, &**device, &stops),
            None => Ok((0..cases.len())
                .into_par_iter()
                .with_max_len(1)
                .map(run)
                .collect()),
        }
    };
    let ended = on_pool(py, "runs", threads, None, |()| (), |stop, _| Ok(run_all(stop)))?;
    let ended = ended.map_err(device_error)?;
    let named = ended.into_iter().zip(&cases).enumerate();
    let summaries = named.filter_map(|(index, (ended, case))| {
        let with_index = |error| RunError::new_err(format!("case {index} ({}): {error}", case.name));
        Some(ended?.map(|summary| summary_json(&summary)).map_err(with_index))
    });
    summaries.collect()
}
