//! Makes the missing runs of a study on a device, all waiting ones at once, and runs that the device cannot
//! compute on the thread pool.

use std::cell::RefCell;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Instant;

use rayon::prelude::*;
use slipfront::device::{Device, DeviceError};

use crate::error::StudyError;
use crate::execute::{panicked, run_one};
use crate::finished_run::{FinishedRun, Outcome};
use crate::plan::Plan;
use crate::run_journal::RunJournal;
use crate::scheduler::{Scheduler, Task, TaskResult};
use crate::study_results::{Progress, StudyResults};
use slipfront_case::case::Case;
use slipfront_case::case_file::CaseError;
use slipfront_run::device::device_summaries;
use slipfront_run::names::RUNS;

/// Largest number of simultaneous runs.
const AT_ONCE: usize = 4096;

/// Runs of a plan on a device.
struct DeviceRuns<'a> {
    plan: &'a Plan,
    runs: &'a Path,
    device: &'a dyn Device,
    is_stopped: &'a (dyn Fn() -> bool + Sync),
}

/// Executes a plan as [`execute`](crate::execute) does, with the same results, on a device.
///
/// # Panics
/// If the study keeps the folders of all runs, which a device cannot write.
pub fn execute_on_device(
    plan: &Plan,
    records: &RunJournal,
    folder: &Path,
    device: &dyn Device,
    stop: &AtomicBool,
    watch: &mut dyn FnMut(&Progress),
) -> Result<StudyResults, StudyError> {
    assert!(
        !plan.settings.keeps_all_runs(),
        "a device cannot write folders of runs"
    );
    let runs = DeviceRuns {
        plan,
        runs: &folder.join(RUNS),
        device,
        is_stopped: &|| stop.load(Ordering::Relaxed),
    };
    let waiting = RefCell::new(Vec::new());
    let start = |task| waiting.borrow_mut().push(task);
    let make = || {
        let mut waiting = waiting.borrow_mut();
        let n = waiting.len().min(AT_ONCE);
        let tasks: Vec<Task> = waiting.drain(..n).collect();
        catch_unwind(AssertUnwindSafe(|| runs.make_at_once(tasks)))
            .unwrap_or_else(|panic| vec![Err(DeviceError(panicked(panic.as_ref())).into())])
    };
    Scheduler::new(plan, records, &start, AT_ONCE).run(make, stop, watch)
}

impl DeviceRuns<'_> {
    /// Makes several runs at the same time.
    fn make_at_once(&self, tasks: Vec<Task>) -> Vec<TaskResult> {
        let made = tasks.into_par_iter().map(|task| (self.case(&task), task));
        let (mut cases, mut begun, mut results) = (Vec::new(), Vec::new(), Vec::new());
        for (case, task) in made.collect::<Vec<_>>() {
            match case {
                Ok(Some(case)) => {
                    cases.push(case);
                    begun.push(task);
                }
                Ok(None) => results.push(Ok(None)),
                Err(error) => results.push(Err(error)),
            }
        }
        let began = Instant::now();
        let summaries = match device_summaries(&cases, self.device, self.is_stopped) {
            Ok(summaries) => summaries,
            Err(error) => return vec![Err(error.into())],
        };
        let wall_time_s = began.elapsed().as_secs_f64() / cases.len().max(1) as f64;
        let ended = begun
            .into_par_iter()
            .zip(summaries)
            .map(|(task, ended)| match ended {
                None => Ok(None),
                Some(Ok(summary)) => Ok(Some(FinishedRun {
                    id: task.id,
                    wall_time_s,
                    outcome: Outcome::from_summary(summary),
                    kept: None,
                })),
                // A run that failed is repeated, which writes the folder that is kept of it.
                Some(Err(_)) => self.make_on_cpu(task),
            });
        results.par_extend(ended);
        results
    }

    /// The case of a run; none after a stop.
    fn case(&self, task: &Task) -> Result<Option<Arc<Case>>, StudyError> {
        match self.plan.case(task.run, &mut |_| !(self.is_stopped)()) {
            Ok(case) => Ok(Some(Arc::new(case))),
            Err(CaseError::Stopped) => Ok(None),
            Err(error) => Err(error.into()),
        }
    }

    fn make_on_cpu(&self, Task { run, id }: Task) -> TaskResult {
        let began = Instant::now();
        let made = run_one(self.plan, self.runs, run, &|_, _, _| true, self.is_stopped)?;
        Ok(made.map(|(outcome, kept)| FinishedRun {
            id,
            wall_time_s: began.elapsed().as_secs_f64(),
            outcome,
            kept,
        }))
    }
}

#[cfg(test)]
mod tests {
    use slipfront::device::DeviceLattice;
    use slipfront::testing::FusedDevice;

    use super::*;
    use crate::execute::execute;
    use crate::study_file::StudyFile;

    /// Plain runs, runs that only the CPU can compute, and runs that fail: all are recorded as on the CPU.
    const STUDY: &str = "base = { slider.blocks = [12, 10], time.stop = 'after_onset', drive.v_star = 0.1 }\n\
                         study = { replicates = 3, keep = 'failed', reference = { texture = [] } }\n\
                         [[axes]]\nkey = 'drive.loading'\nlist = ['constant', 'held']\n\
                         [[axes]]\nkey = 'time.step'\nlist = [0.1, 0.2]";

    fn plan(text: &str) -> Plan {
        let file = StudyFile::parse(text, "study.toml", "study", Path::new("")).unwrap();
        Plan::new(&file, None).unwrap()
    }

    fn executed(text: &str, device: Option<&dyn Device>) -> Result<StudyResults, StudyError> {
        let (plan, folder, never) = (plan(text), tempfile::tempdir().unwrap(), AtomicBool::new(false));
        let records = RunJournal::open(folder.path()).unwrap();
        match device {
            Some(device) => execute_on_device(&plan, &records, folder.path(), device, &never, &mut |_| {}),
            None => execute(&plan, &records, folder.path(), &never, &mut |_| {}),
        }
    }

    #[test]
    fn a_study_has_the_same_results_on_a_device() {
        let on_device = executed(STUDY, Some(&FusedDevice)).unwrap();
        let on_cpu = executed(STUDY, None).unwrap();
        assert_eq!(on_device.points, on_cpu.points);
        assert_eq!(on_device.runs, on_cpu.runs);
        // Each run has its reference.
        assert_eq!(on_cpu.runs.len(), 2 * 4 * 3);
    }

    /// A device that accepts no lattice of the study.
    #[derive(Debug)]
    struct Small;

    impl Device for Small {
        fn name(&self) -> String {
            "small".to_owned()
        }

        fn most_blocks(&self) -> usize {
            119
        }

        fn run(&self, _: &mut [&mut DeviceLattice], _: u32) -> Result<(), DeviceError> {
            panic!("a lattice is larger than the device takes")
        }
    }

    #[test]
    fn lattices_too_large_for_the_device_run_on_the_cpu() {
        let on_device = executed(STUDY, Some(&Small)).unwrap();
        assert_eq!(on_device.runs, executed(STUDY, None).unwrap().runs);
    }

    /// A device that returns an error, or panics.
    #[derive(Debug)]
    struct Broken {
        panics: bool,
    }

    impl Device for Broken {
        fn name(&self) -> String {
            "broken".to_owned()
        }

        fn most_blocks(&self) -> usize {
            usize::MAX
        }

        fn run(&self, _: &mut [&mut DeviceLattice], _: u32) -> Result<(), DeviceError> {
            assert!(!self.panics, "out of bounds");
            Err(DeviceError("the GPU failed: it is too hot".to_owned()))
        }
    }

    #[test]
    fn a_study_ends_with_the_sentence_of_a_device_that_fails() {
        for (panics, sentence) in [
            (false, "too hot"),
            (true, "an error in the program: out of bounds"),
        ] {
            let error = executed(STUDY, Some(&Broken { panics })).unwrap_err().to_string();
            assert!(error.contains(sentence), "{error}");
        }
    }
}
