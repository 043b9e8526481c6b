//! Runs what a study lacks: the scheduler on this thread, and one run at a time on each worker thread.

use std::path::Path;
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc;

use super::error::StudyError;
use super::journal::Records;
use super::plan::{Plan, RunKey};
use super::scheduler::Scheduler;
use super::study_results::{Progress, StudyResults};
use super::worker::{Ended, IsStopped, RunCase, Task, run_one, work};
use crate::names::RUNS;

/// Runs everything that the plan needs and the records lack.
///
/// `threads` runs are done at once. `stop` ends them all; finished runs stay recorded. Run folders that the study keeps are
/// written to `folder`. `watch` is called after every run.
///
/// # Errors
/// [`StudyError::Interrupted`] after `stop`, and when a record or a run folder cannot be written. A run that fails
/// is no error.
pub fn execute(
    plan: &Plan,
    records: &mut Records,
    folder: &Path,
    threads: usize,
    stop: &AtomicBool,
    watch: &mut dyn FnMut(&Progress),
) -> Result<StudyResults, StudyError> {
    let runs = folder.join(RUNS);
    let run_case = |run: RunKey, is_stopped: &IsStopped| run_one(plan, &runs, run, is_stopped);
    execute_with(plan, records, &run_case, threads, stop, watch)
}

/// The results of a plan from the records alone.
///
/// # Errors
/// [`StudyError::Missing`] if a run is not recorded.
pub fn collect(plan: &Plan, records: &mut Records) -> Result<StudyResults, StudyError> {
    let (to_workers, _tasks) = mpsc::channel();
    let mut scheduler = Scheduler::new(plan, records, to_workers, 1);
    scheduler.begin();
    match scheduler.n_waiting() {
        0 => Ok(scheduler.results()),
        runs => Err(StudyError::Missing {
            runs,
            others: scheduler.orphaned_runs(),
        }),
    }
}

fn execute_with(
    plan: &Plan,
    records: &mut Records,
    run_case: &RunCase,
    threads: usize,
    stop: &AtomicBool,
    watch: &mut dyn FnMut(&Progress),
) -> Result<StudyResults, StudyError> {
    let (to_workers, tasks) = mpsc::channel::<Task>();
    let (to_scheduler, finished) = mpsc::channel::<Ended>();
    let tasks = Mutex::new(tasks);
    let abandon = AtomicBool::new(false);
    let is_stopped = || stop.load(Ordering::Relaxed) || abandon.load(Ordering::Relaxed);
    std::thread::scope(|scope| {
        let _abandon = SetOnDrop(&abandon);
        for _ in 0..threads {
            let (tasks, is_stopped, to_scheduler) = (&tasks, &is_stopped, to_scheduler.clone());
            let spawned = std::thread::Builder::new()
                .spawn_scoped(scope, move || work(run_case, tasks, &to_scheduler, is_stopped));
            spawned.map_err(StudyError::Threads)?;
        }
        drop(to_scheduler);
        let mut scheduler = Scheduler::new(plan, records, to_workers, threads);
        scheduler.run(&finished, stop, watch)?;
        Ok(scheduler.results())
    })
}

/// Sets a flag when it is dropped, on an error and a panic as well: without a scheduler the workers would run cases that
/// nobody records.
struct SetOnDrop<'a>(&'a AtomicBool);

impl Drop for SetOnDrop<'_> {
    fn drop(&mut self) {
        self.0.store(true, Ordering::Relaxed);
    }
}

#[cfg(test)]
mod tests {
    use std::panic::{AssertUnwindSafe, catch_unwind};
    use std::time::{Duration, Instant};

    use super::*;
    use crate::study::record::Outcome;
    use crate::study::study_file::StudyFile;
    use crate::study::study_results::PointResult;
    use crate::summary::Summary;

    fn plan(text: &str) -> Plan {
        let file = StudyFile::parse(text, "study.toml", "study", Path::new("")).unwrap();
        Plan::new(&file, None).unwrap()
    }

    /// A run whose number depends on its seed and point, and whose duration on neither.
    fn pretend(run: RunKey) -> Outcome {
        let mixed = (run.replicate as u64 * 7919 + run.point as u64 * 104_729) % 1000;
        Outcome::Done(Box::new(Summary {
            static_friction_star: 0.8 + 1e-4 * mixed as f64,
            ..Summary::default()
        }))
    }

    fn run(plan: &Plan, run_case: &RunCase, threads: usize) -> (Result<StudyResults, StudyError>, usize) {
        let folder = tempfile::tempdir().unwrap();
        let mut records = Records::open(folder.path()).unwrap();
        let found = execute_with(
            plan,
            &mut records,
            run_case,
            threads,
            &AtomicBool::new(false),
            &mut |_| {},
        );
        (found, records.len())
    }

    const ADAPTIVE: &str = "base.slider.blocks = [2, 2]\n[study]\nuntil = { key = 'static_friction_star', \
                            half_width = 0.02, min = 3, max = 20 }\n[[axes]]\nkey = 'drive.v_star'\n\
                            list = [0.01, 0.02, 0.03, 0.04]";

    #[test]
    fn replicates_are_decided_in_their_order_whatever_finishes_first() {
        let plan = plan(ADAPTIVE);
        let (expected, _) = run(&plan, &|run, _| Ok(Some(pretend(run))), 1);
        let expected = expected.unwrap();
        let counts: Vec<usize> = expected.points.iter().map(|point| point.replicates).collect();
        // The case must be one in which something is decided.
        assert!(counts.iter().any(|&count| count > 3 && count < 20), "{counts:?}");
        for threads in [2, 5, 16] {
            let late_first = |run: RunKey, _: &IsStopped| {
                std::thread::sleep(Duration::from_millis(3 * (2 - run.replicate as u64 % 3)));
                Ok(Some(pretend(run)))
            };
            let (found, recorded) = run(&plan, &late_first, threads);
            let found = found.unwrap();
            assert_eq!(found.points, expected.points, "{threads} threads");
            assert_eq!(found.runs, expected.runs, "{threads} threads");
            // No more than what idle threads could run ahead.
            assert!(recorded < found.runs.len() + 4 * threads, "{recorded}");
        }
    }

    #[test]
    fn where_the_interval_stays_wide_it_is_said() {
        let wide = ADAPTIVE.replace("0.02, min", "1e-9, min");
        let (found, recorded) = run(&plan(&wide), &|run, _| Ok(Some(pretend(run))), 2);
        let narrow = PointResult {
            replicates: 20,
            narrow: Some(false),
        };
        assert_eq!(found.unwrap().points, [narrow; 4]);
        assert_eq!(recorded, 80);
    }

    #[test]
    fn runs_ahead_of_need_are_not_orphaned() {
        let plan = plan(ADAPTIVE);
        let folder = tempfile::tempdir().unwrap();
        let mut records = Records::open(folder.path()).unwrap();
        let never = AtomicBool::new(false);
        for threads in [16, 1] {
            let runner = |run, _: &IsStopped| Ok(Some(pretend(run)));
            let found = execute_with(&plan, &mut records, &runner, threads, &never, &mut |_| {}).unwrap();
            assert_eq!(found.orphaned_runs, 0, "{threads} threads");
        }
        assert!(records.len() > 12);
    }

    #[test]
    fn failures_and_faults_do_not_stop_the_rest() {
        let plan = plan("base.slider.blocks = [2, 2]\nstudy.replicates = 6");
        let runner = |run: RunKey, _: &IsStopped| match run.replicate {
            1 => Ok(Some(Outcome::Failed("it diverged".to_owned()))),
            3 => panic!("out of bounds"),
            _ => Ok(Some(pretend(run))),
        };
        let (found, recorded) = run(&plan, &runner, 2);
        let found = found.unwrap();
        let failures: Vec<(usize, &str)> = found
            .failures()
            .map(|(run, reason)| (run.replicate, reason))
            .collect();
        assert_eq!(
            failures,
            [(1, "it diverged"), (3, "a fault of the program: out of bounds")]
        );
        assert_eq!((found.runs.len(), recorded), (6, 6));
    }

    /// Without a scheduler, further runs would not be recorded.
    #[test]
    fn a_fault_of_the_manager_ends_the_workers() {
        let plan = plan("base.slider.blocks = [2, 2]\nstudy.replicates = 100");
        let folder = tempfile::tempdir().unwrap();
        let mut records = Records::open(folder.path()).unwrap();
        let forever = AtomicBool::new(false);
        let runner = |run: RunKey, is_stopped: &IsStopped| {
            if run.replicate < 5 {
                return Ok(Some(pretend(run)));
            }
            // Nothing else ends this one.
            let began = Instant::now();
            while !is_stopped() && began.elapsed() < Duration::from_secs(60) {
                std::thread::sleep(Duration::from_millis(1));
            }
            forever.fetch_or(!is_stopped(), Ordering::Relaxed);
            Ok(None)
        };
        let never = AtomicBool::new(false);
        let watch = &mut |now: &Progress| assert_eq!(now.here, 0, "a fault of the scheduler");
        let ended = catch_unwind(AssertUnwindSafe(|| {
            execute_with(&plan, &mut records, &runner, 2, &never, watch).map(|_| ())
        }));
        assert!(ended.is_err());
        assert!(!forever.into_inner(), "a worker was not told to end");
    }

    #[test]
    fn a_study_that_cannot_go_on_keeps_what_is_finished() {
        let plan = plan("base.slider.blocks = [2, 2]\nstudy.replicates = 50");
        let runner = |run: RunKey, _: &IsStopped| match run.replicate {
            10 => Err(StudyError::Threads(std::io::Error::other("the disk is full"))),
            _ => Ok(Some(pretend(run))),
        };
        let (found, recorded) = run(&plan, &runner, 1);
        assert!(matches!(found, Err(StudyError::Threads(_))));
        assert!((10..50).contains(&recorded), "{recorded}");
    }
}
