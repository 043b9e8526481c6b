//! Makes the missing runs of a study: the scheduler on this thread, and one run at a time on each thread of
//! the pool.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{self, Sender};
use std::time::{Duration, Instant};

use crate::error::StudyError;
use crate::finished_run::{FinishedRun, Outcome, mark_of};
use crate::plan::{Plan, RunKey};
use crate::run_journal::RunJournal;
use crate::scheduler::{Scheduler, Task, TaskResult};
use crate::study_file::RetainRuns;
use crate::study_results::{Progress, StudyResults};
use slipfront_case::case::Case;
use slipfront_case::case_file::CaseError;
use slipfront_run::manifest::Processors;
use slipfront_run::names::RUNS;
use slipfront_run::pictures::error::RunPictureError;
use slipfront_run::run_folder::RunFolder;
use slipfront_run::{clock, pictures, results, running};

/// Returns whether runs should be aborted: after a signal, or when the study cannot continue.
type IsStopped<'a> = dyn Fn() -> bool + Sync + 'a;

/// Function that runs a case; no outcome if the run was aborted.
type RunCase<'a> = dyn Fn(RunKey, &IsStopped) -> Result<Option<MadeRun>, StudyError> + Sync + 'a;

/// Outcome of a run, and the mark of its folder if that was kept.
pub(crate) type MadeRun = (Outcome, Option<String>);

/// Callback that receives a finished run before its results are written, and returns whether the run counts
/// as done. If not, the run counts as stopped, not as failed.
pub type LookAtRun<'a> = dyn Fn(RunKey, &Arc<Case>, &running::RunData) -> bool + Sync + 'a;

/// Runs everything that the plan needs and the records lack.
///
/// Each thread of rayon's pool does one run at a time, of this study or of others that are executed at the
/// same time. This thread waits for them, and must not be the only thread of the pool. `stop` ends all runs;
/// finished ones stay recorded. Run folders that the study keeps are written to `folder`. `watch` is called
/// after every run. A failed run is not an error.
pub fn execute(
    plan: &Plan,
    records: &RunJournal,
    folder: &Path,
    stop: &AtomicBool,
    watch: &mut dyn FnMut(&Progress),
) -> Result<StudyResults, StudyError> {
    execute_and_look(plan, records, folder, stop, &|_, _, _| true, watch)
}

/// Executes a plan as [`execute`] does, and calls `look` for every run that ends, on the thread of the run.
pub fn execute_and_look(
    plan: &Plan,
    records: &RunJournal,
    folder: &Path,
    stop: &AtomicBool,
    look: &LookAtRun,
    watch: &mut dyn FnMut(&Progress),
) -> Result<StudyResults, StudyError> {
    let runs = folder.join(RUNS);
    let run_case = |run: RunKey, is_stopped: &IsStopped| run_one(plan, &runs, run, look, is_stopped);
    execute_with(plan, records, &run_case, stop, watch)
}

/// The results of a plan from the records alone, if all its runs are recorded.
pub fn collect(plan: &Plan, records: &RunJournal) -> Result<StudyResults, StudyError> {
    Scheduler::new(plan, records, &|_| {}, 1).collect()
}

fn execute_with(
    plan: &Plan,
    records: &RunJournal,
    run_case: &RunCase,
    stop: &AtomicBool,
    watch: &mut dyn FnMut(&Progress),
) -> Result<StudyResults, StudyError> {
    let (to_scheduler, finished) = mpsc::channel::<TaskResult>();
    let abandon = AtomicBool::new(false);
    let is_stopped = || stop.load(Ordering::Relaxed) || abandon.load(Ordering::Relaxed);
    // The scheduler stays on the thread of the caller: it mostly waits, and would occupy a thread of the
    // pool.
    rayon::in_place_scope(|scope| {
        let _abandon = SetOnDrop(&abandon);
        let start = |task| {
            let (is_stopped, to_scheduler) = (&is_stopped, to_scheduler.clone());
            scope.spawn(move |_| work(run_case, task, &to_scheduler, is_stopped));
        };
        // The threads of the working pool, so that idle threads get replicates ahead of need.
        let threads = rayon::current_num_threads();
        let finished = || {
            let first = finished.recv_timeout(Duration::from_millis(100));
            first.into_iter().chain(finished.try_iter()).collect()
        };
        Scheduler::new(plan, records, &start, threads).run(finished, stop, watch)
    })
}

/// Does a run.
fn work(run_case: &RunCase, Task { run, id }: Task, finished: &Sender<TaskResult>, is_stopped: &IsStopped) {
    let began = Instant::now();
    // The pool may hold many waiting tasks; after a stop, they end here.
    let outcome = if is_stopped() {
        Ok(None)
    } else {
        // A panic is recorded as a failed run; otherwise, the scheduler would wait for it forever.
        catch_unwind(AssertUnwindSafe(|| run_case(run, is_stopped)))
            .unwrap_or_else(|panic| Ok(Some((Outcome::Failed(panicked(panic.as_ref())), None))))
    };
    let record = |(outcome, kept)| FinishedRun {
        id,
        wall_time_s: began.elapsed().as_secs_f64(),
        outcome,
        kept,
    };
    // If the scheduler has ended, it needs no more results.
    let _ = finished.send(outcome.map(|outcome| outcome.map(record)));
}

/// The reason for a run that failed by a panic.
pub(crate) fn panicked(panic: &(dyn std::any::Any + Send)) -> String {
    let message = panic.downcast_ref::<String>().map(String::as_str);
    let message = message.or_else(|| panic.downcast_ref::<&str>().copied());
    format!("an error in the program: {}", message.unwrap_or("unknown"))
}

/// Runs the case of a run, and writes its folder to `runs` if the study keeps it.
pub(crate) fn run_one(
    plan: &Plan,
    runs: &Path,
    run: RunKey,
    look: &LookAtRun,
    is_stopped: &IsStopped,
) -> Result<Option<MadeRun>, StudyError> {
    let started = clock::now();
    // The point was valid when the study began. If it is invalid now, a file that it reads has changed. This
    // ends the study, and is not recorded as a failure of the run.
    let case = match plan.case(run, &mut |_| !is_stopped()) {
        Ok(case) => Arc::new(case),
        Err(CaseError::Stopped) => return Ok(None),
        Err(error) => return Err(error.into()),
    };
    let Some(mut record) = running::run_unless(&case, is_stopped) else {
        return Ok(None);
    };
    if let Ok(record) = &record
        && !look(run, &case, record)
    {
        return Ok(None);
    }
    let is_kept = match plan.settings.keep {
        RetainRuns::All => true,
        RetainRuns::None => false,
        RetainRuns::Failed => record.is_err(),
    };
    let mut kept = None;
    if is_kept {
        let path = runs.join(plan.folder_name(run));
        write_folder(&case, record.as_mut().ok(), &path, started)?;
        kept = mark_of(&path, record.is_ok());
    }
    let outcome = match record {
        Ok(record) => Outcome::from_summary(record.summary),
        Err(error) => Outcome::Failed(error.to_string()),
    };
    Ok(Some((outcome, kept)))
}

/// Writes a run folder. The folder of a failed run is marked as interrupted and contains only the case, from
/// which the run can be repeated.
fn write_folder(
    case: &Case,
    record: Option<&mut running::RunData>,
    path: &Path,
    started: jiff::Timestamp,
) -> Result<(), RunPictureError> {
    let mut folder = RunFolder::prepare(path, true, &case.inputs)?;
    results::write_case(case, &mut folder)?;
    if let Some(record) = record {
        pictures::write_run(case, record, folder, started, Processors::threads(1))?;
    }
    Ok(())
}

/// Sets a flag when it is dropped, also after an error or a panic: without a scheduler, the pool would run
/// cases that nobody records.
struct SetOnDrop<'a>(&'a AtomicBool);

impl Drop for SetOnDrop<'_> {
    fn drop(&mut self) {
        self.0.store(true, Ordering::Relaxed);
    }
}

#[cfg(test)]
mod tests {
    use std::time::Duration;

    use super::*;
    use crate::study_file::StudyFile;
    use crate::study_results::PointResult;
    use slipfront_run::summary::Summary;

    fn plan(text: &str) -> Plan {
        let file = StudyFile::parse(text, "study.toml", "study", Path::new("")).unwrap();
        Plan::new(&file, None).unwrap()
    }

    /// A simulated run: its result depends on seed and point, and its duration on neither.
    fn pretend(run: RunKey) -> MadeRun {
        let mixed = (run.replicate as u64 * 7919 + run.point as u64 * 104_729) % 1000;
        let summary = Summary {
            static_friction_star: 0.8 + 1e-4 * mixed as f64,
            transition: true,
            ..Summary::default()
        };
        (Outcome::Done(Box::new(summary)), None)
    }

    /// Executes a plan with `threads` simultaneous runs; the pool has one more thread, which waits for them.
    fn execute_on(
        threads: usize,
        plan: &Plan,
        records: &RunJournal,
        run_case: &RunCase,
        watch: &mut (dyn FnMut(&Progress) + Send),
    ) -> Result<StudyResults, StudyError> {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads + 1).build();
        let never = AtomicBool::new(false);
        pool.unwrap()
            .install(|| execute_with(plan, records, run_case, &never, watch))
    }

    fn run(plan: &Plan, run_case: &RunCase, threads: usize) -> (Result<StudyResults, StudyError>, usize) {
        let folder = tempfile::tempdir().unwrap();
        let records = RunJournal::open(folder.path()).unwrap();
        let found = execute_on(threads, plan, &records, run_case, &mut |_| {});
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
        // The case must be one in which the stopping rule matters.
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
            // No more runs than idle threads could do ahead of need.
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
        let records = RunJournal::open(folder.path()).unwrap();
        for threads in [16, 1] {
            let runner = |run, _: &IsStopped| Ok(Some(pretend(run)));
            let found = execute_on(threads, &plan, &records, &runner, &mut |_| {}).unwrap();
            assert_eq!(found.orphaned_runs, 0, "{threads} threads");
        }
        assert!(records.len() > 12);
    }

    #[test]
    fn failures_and_faults_do_not_stop_the_rest() {
        let plan = plan("base.slider.blocks = [2, 2]\nstudy.replicates = 6");
        let runner = |run: RunKey, _: &IsStopped| match run.replicate {
            1 => Ok(Some((Outcome::Failed("it diverged".to_owned()), None))),
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
            [(1, "it diverged"), (3, "an error in the program: out of bounds")]
        );
        assert_eq!((found.runs.len(), recorded), (6, 6));
    }

    /// Without a scheduler, further runs would not be recorded.
    #[test]
    fn a_fault_of_the_scheduler_ends_the_runs() {
        let plan = plan("base.slider.blocks = [2, 2]\nstudy.replicates = 100");
        let folder = tempfile::tempdir().unwrap();
        let records = RunJournal::open(folder.path()).unwrap();
        let forever = AtomicBool::new(false);
        let runner = |run: RunKey, is_stopped: &IsStopped| {
            if run.replicate < 5 {
                return Ok(Some(pretend(run)));
            }
            // Only the flag ends this run.
            let began = Instant::now();
            while !is_stopped() && began.elapsed() < Duration::from_secs(60) {
                std::thread::sleep(Duration::from_millis(1));
            }
            forever.fetch_or(!is_stopped(), Ordering::Relaxed);
            Ok(None)
        };
        let watch = &mut |now: &Progress| assert_eq!(now.here, 0, "a fault of the scheduler");
        let ended = catch_unwind(AssertUnwindSafe(|| {
            execute_on(2, &plan, &records, &runner, watch).map(|_| ())
        }));
        assert!(ended.is_err());
        assert!(!forever.into_inner(), "a run was not told to end");
    }

    #[test]
    fn a_study_that_cannot_go_on_keeps_what_is_finished() {
        let plan = plan("base.slider.blocks = [2, 2]\nstudy.replicates = 50");
        let runner = |run: RunKey, _: &IsStopped| match run.replicate {
            10 => Err(StudyError::NotJournal {
                path: "full disk".into(),
            }),
            _ => Ok(Some(pretend(run))),
        };
        let (found, recorded) = run(&plan, &runner, 1);
        assert!(matches!(found, Err(StudyError::NotJournal { .. })));
        assert!((10..50).contains(&recorded), "{recorded}");
    }
}
