//! Runs what a study still lacks: one run per thread, every finished run recorded at once.
//!
//! What the tables hold does not depend on the order in which runs finish: how many replicates a point has is
//! decided from its first ones, in their order, however many have been run ahead.

use std::collections::{BTreeMap, HashMap, HashSet};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{self, Receiver, RecvTimeoutError, Sender};
use std::sync::{Arc, Mutex};
use std::time::{Duration, Instant};

use super::error::StudyError;
use super::journal::{Finding, Outcome, Record, Records};
use super::plan::{Plan, Role, RunKey};
use super::statistics::Sample;
use super::study_file::RetainRuns;
use super::summary_values::{Quantity, reduction_percent};
use crate::error::ResultsError;
use crate::names::RUNS;
use crate::run_folder::RunFolder;
use crate::{results, running};
use slipfront_case::case::Case;

/// How far a study has come.
#[derive(Clone, Debug, PartialEq)]
pub struct Progress {
    /// Runs done, earlier ones included.
    pub done: usize,
    /// Runs known to be needed; grows where intervals are still too wide.
    pub total: usize,
    /// Runs that this process has done.
    pub here: usize,
    /// Failed runs.
    pub failed: usize,
    /// Widest half width so far, of the quantity that decides on replication.
    pub worst: Option<f64>,
}

/// Everything that a study has found.
#[derive(Clone, Debug)]
pub struct Findings {
    /// What was found of every run that counts.
    pub runs: BTreeMap<RunKey, Arc<Finding>>,
    /// Per point of the plan: its number of replicates, and whether its interval became narrow enough.
    pub points: Vec<PointFindings>,
    /// Recorded runs that are not part of the study as it is now.
    pub strangers: usize,
}

/// What was decided of a point.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PointFindings {
    /// Replicates that count.
    pub replicates: usize,
    /// Whether the interval is as narrow as asked; none where nothing was asked.
    pub narrow: Option<bool>,
}

impl Findings {
    /// A number of a run of a point, or its reduction against the reference of the same seed.
    pub fn value(&self, point: usize, replicate: usize, quantity: Quantity) -> Option<f64> {
        value(&self.runs, point, replicate, quantity)
    }

    /// Runs that had no transition, so that their static friction is only the largest mu* of them.
    pub fn without_transition(&self) -> impl Iterator<Item = RunKey> {
        let runs = self.runs.iter();
        runs.filter_map(|(run, finding)| match finding.as_ref() {
            Finding::Done(numbers) => (!numbers.transition).then_some(*run),
            Finding::Failed(_) => None,
        })
    }

    /// Runs that failed and why.
    pub fn failures(&self) -> impl Iterator<Item = (RunKey, &str)> {
        self.runs
            .iter()
            .filter_map(|(run, finding)| match finding.as_ref() {
                Finding::Failed(reason) => Some((*run, reason.as_str())),
                Finding::Done(_) => None,
            })
    }
}

fn value(
    runs: &BTreeMap<RunKey, Arc<Finding>>,
    point: usize,
    replicate: usize,
    quantity: Quantity,
) -> Option<f64> {
    let numbers = |role| match runs
        .get(&RunKey {
            point,
            replicate,
            role,
        })?
        .as_ref()
    {
        Finding::Done(numbers) => Some(numbers),
        Finding::Failed(_) => None,
    };
    match quantity {
        Quantity::Number(position) => numbers(Role::Point)?.get(position),
        Quantity::Reduction => Some(reduction_percent(
            numbers(Role::Point)?,
            numbers(Role::Reference)?,
        )),
    }
}

/// Runs everything that the plan needs and the records lack.
///
/// `threads` runs go at once; `stop` ends them all, losing none that is finished; `folder` takes the run folders
/// that are kept; `watch` is told of every run.
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
) -> Result<Findings, StudyError> {
    let runs = folder.join(RUNS);
    let runner = |run: RunKey, ends: &Ends| run_one(plan, &runs, run, ends);
    execute_with(plan, records, &runner, threads, stop, watch)
}

/// Finds what the records hold of the plan, and runs nothing.
///
/// # Errors
/// [`StudyError::Missing`] when they do not hold all of it.
pub fn collect(plan: &Plan, records: &mut Records) -> Result<Findings, StudyError> {
    let (to_workers, _nobody) = mpsc::channel();
    let mut manager = Manager::new(plan, records, to_workers, 1);
    manager.begin()?;
    if manager.waiting.is_empty() {
        Ok(manager.findings())
    } else {
        Err(StudyError::Missing {
            runs: manager.waiting.len(),
            others: manager.strangers(),
        })
    }
}

/// Whether a run should be given up: after a signal, and when the study cannot go on.
type Ends<'a> = dyn Fn() -> bool + Sync + 'a;

/// Makes a run; no outcome if it was given up.
type Runner<'a> = dyn Fn(RunKey, &Ends) -> Result<Option<Outcome>, StudyError> + Sync + 'a;

fn execute_with(
    plan: &Plan,
    records: &mut Records,
    runner: &Runner,
    threads: usize,
    stop: &AtomicBool,
    watch: &mut dyn FnMut(&Progress),
) -> Result<Findings, StudyError> {
    let (to_workers, tasks) = mpsc::channel::<Task>();
    let (to_manager, finished) = mpsc::channel::<Finished>();
    let tasks = Mutex::new(tasks);
    let abandon = AtomicBool::new(false);
    let ends = || stop.load(Ordering::Relaxed) || abandon.load(Ordering::Relaxed);
    std::thread::scope(|scope| {
        let _abandon = SetWhenLeft(&abandon);
        for _ in 0..threads {
            let (tasks, ends, to_manager) = (&tasks, &ends, to_manager.clone());
            let spawned = std::thread::Builder::new()
                .spawn_scoped(scope, move || work(runner, tasks, &to_manager, ends));
            spawned.map_err(StudyError::Threads)?;
        }
        drop(to_manager);
        let mut manager = Manager::new(plan, records, to_workers, threads);
        manager.manage(&finished, stop, watch)?;
        Ok(manager.findings())
    })
}

/// Set when the scope that holds this is left in whatever way, a panic included: nobody records what is run from then on.
struct SetWhenLeft<'a>(&'a AtomicBool);

impl Drop for SetWhenLeft<'_> {
    fn drop(&mut self) {
        self.0.store(true, Ordering::Relaxed);
    }
}

/// A run to be done.
struct Task {
    run: RunKey,
    id: String,
}

/// A run that has ended; without an outcome if it was given up.
struct Finished {
    id: String,
    wall_time_s: f64,
    outcome: Result<Option<Outcome>, StudyError>,
}

/// A thread that makes runs until there are no more.
fn work(runner: &Runner, tasks: &Mutex<Receiver<Task>>, done: &Sender<Finished>, ends: &Ends) {
    loop {
        let task = match tasks.lock() {
            Ok(tasks) => tasks.recv(),
            Err(_) => return,
        };
        let Ok(Task { run, id }) = task else { return };
        let began = Instant::now();
        let outcome = if ends() {
            Ok(None)
        } else {
            // A fault of the program in one run must not keep the others waiting for ever.
            catch_unwind(AssertUnwindSafe(|| runner(run, ends)))
                .unwrap_or_else(|panic| Ok(Some(Outcome::Failed(panicked(panic.as_ref())))))
        };
        let wall_time_s = began.elapsed().as_secs_f64();
        let finished = Finished {
            id,
            wall_time_s,
            outcome,
        };
        if done.send(finished).is_err() {
            return;
        }
    }
}

fn panicked(panic: &(dyn std::any::Any + Send)) -> String {
    let message = panic
        .downcast_ref::<String>()
        .map(String::as_str)
        .or_else(|| panic.downcast_ref::<&str>().copied());
    format!("a fault of the program: {}", message.unwrap_or("unknown"))
}

fn run_one(plan: &Plan, runs: &Path, run: RunKey, ends: &Ends) -> Result<Option<Outcome>, StudyError> {
    let started = jiff::Timestamp::now();
    // The point was valid when the study began: a file that it reads has gone, which is no fault of the run.
    let case = Arc::new(plan.case(run)?);
    let Some(mut record) = running::run_unless(&case, ends) else {
        return Ok(None);
    };
    if plan.settings.keep == RetainRuns::All || (plan.settings.keep == RetainRuns::Failed && record.is_err())
    {
        let path = runs.join(plan.folder_name(run));
        keep(&case, record.as_mut().ok(), &path, started)?;
    }
    Ok(Some(match record {
        Ok(record) => Outcome::Done(Box::new(record.summary)).or_not_finite(),
        Err(error) => Outcome::Failed(error.to_string()),
    }))
}

/// Keeps a run folder; of a failed run the case file, which repeats it.
fn keep(
    case: &Case,
    record: Option<&mut running::Record>,
    path: &Path,
    started: jiff::Timestamp,
) -> Result<(), ResultsError> {
    let mut folder = RunFolder::prepare(path, true, &case.inputs)?;
    results::write_case(case, &mut folder)?;
    match record {
        Some(record) => drop(results::write(case, record, folder, started, 1)?),
        None => folder.leave(),
    }
    Ok(())
}

/// Decides what is run and notes what came of it.
struct Manager<'a> {
    plan: &'a Plan,
    records: &'a mut Records,
    tasks: Sender<Task>,
    threads: usize,
    runs: BTreeMap<RunKey, Arc<Finding>>,
    /// Runs that wait for a task, by its identity: points may share one.
    waiting: HashMap<String, Vec<RunKey>>,
    /// Identities of recorded runs that the study has asked for.
    belonging: HashSet<String>,
    points: Vec<PointState>,
    /// The quantity that decides on replication.
    decisive: Option<Quantity>,
    progress: Progress,
}

#[derive(Clone, Default)]
struct PointState {
    /// Replicates asked for so far.
    wanted: usize,
    /// Runs of these that are not there yet.
    missing: usize,
    /// Replicates that were not enough.
    judged: usize,
    found: Option<PointFindings>,
    half_width: Option<f64>,
}

impl<'a> Manager<'a> {
    fn new(plan: &'a Plan, records: &'a mut Records, tasks: Sender<Task>, threads: usize) -> Self {
        let until = plan.settings.until.as_ref();
        Self {
            plan,
            records,
            tasks,
            threads,
            runs: BTreeMap::new(),
            waiting: HashMap::new(),
            belonging: HashSet::new(),
            points: vec![PointState::default(); plan.points.len()],
            decisive: until.and_then(|until| Quantity::named(&until.key)),
            progress: Progress {
                done: 0,
                total: 0,
                here: 0,
                failed: 0,
                worst: None,
            },
        }
    }

    fn manage(
        &mut self,
        finished: &Receiver<Finished>,
        stop: &AtomicBool,
        watch: &mut dyn FnMut(&Progress),
    ) -> Result<(), StudyError> {
        self.begin()?;
        self.tell(watch);
        while !self.waiting.is_empty() {
            let stopped = stop.load(Ordering::Relaxed);
            let first = match finished.recv_timeout(Duration::from_millis(100)) {
                Ok(first) => Some(first),
                Err(RecvTimeoutError::Timeout) => None,
                Err(RecvTimeoutError::Disconnected) => return Err(StudyError::Interrupted),
            };
            // What has finished meanwhile goes to the disk with it: waiting for the disk is what takes long.
            self.take(first.into_iter().chain(finished.try_iter()))?;
            if stopped {
                return Err(StudyError::Interrupted);
            }
            self.tell(watch);
        }
        Ok(())
    }

    /// Asks for the replicates that every point has at the least, and for more where these are known already.
    fn begin(&mut self) -> Result<(), StudyError> {
        for point in 0..self.points.len() {
            self.want(point, self.plan.settings.min_replicates());
            self.decide(point);
        }
        Ok(())
    }

    /// Records finished runs, then notes them.
    fn take(&mut self, finished: impl Iterator<Item = Finished>) -> Result<(), StudyError> {
        let mut records = Vec::new();
        let mut broken = None;
        for Finished {
            id,
            wall_time_s,
            outcome,
        } in finished
        {
            match outcome {
                Ok(Some(outcome)) => records.push(Record {
                    id,
                    wall_time_s,
                    outcome,
                }),
                Ok(None) => {}
                Err(error) => broken = Some(error),
            }
        }
        self.records.append(&records)?;
        self.progress.here += records.len();
        for record in records {
            self.note(record.id);
        }
        broken.map_or(Ok(()), Err)
    }

    /// Asks for replicates of a point up to `wanted`.
    fn want(&mut self, point: usize, wanted: usize) {
        for replicate in self.points[point].wanted..wanted {
            for role in self.plan.roles() {
                let run = RunKey {
                    point,
                    replicate,
                    role,
                };
                let id = self.plan.identity(run);
                if let Some(finding) = self.records.get(&id).cloned() {
                    self.runs.insert(run, Arc::clone(&finding));
                    if !self.belonging.contains(&id) {
                        self.progress.total += 1;
                        self.count(id, &finding);
                    }
                    continue;
                }
                self.points[point].missing += 1;
                let waiting = self.waiting.entry(id.clone()).or_default();
                waiting.push(run);
                if waiting.len() == 1 {
                    self.progress.total += 1;
                    // Nobody listens where records are only collected.
                    let _ = self.tasks.send(Task { run, id });
                }
            }
        }
        self.points[point].wanted = wanted;
    }

    fn count(&mut self, id: String, finding: &Finding) {
        self.progress.done += 1;
        self.progress.failed += usize::from(matches!(finding, Finding::Failed(_)));
        self.belonging.insert(id);
    }

    /// Notes a run that has been recorded, for every point that waited for it.
    fn note(&mut self, id: String) {
        let Some(finding) = self.records.get(&id).cloned() else {
            return;
        };
        let runs = self.waiting.remove(&id).unwrap_or_default();
        self.count(id, &finding);
        for run in &runs {
            self.runs.insert(*run, Arc::clone(&finding));
            self.points[run.point].missing -= 1;
        }
        for run in runs {
            self.decide(run.point);
        }
    }

    /// Decides how many replicates a point has, once all that were asked for are there.
    fn decide(&mut self, point: usize) {
        while self.points[point].missing == 0 && self.points[point].found.is_none() {
            self.judge(point);
            let PointState { wanted, found, .. } = self.points[point];
            if found.is_none() {
                // Further ones are run ahead only where threads would have nothing to do.
                let idle = self.threads.saturating_sub(self.waiting.len());
                let more = (wanted + idle.max(1)).min(self.plan.settings.max_replicates());
                self.want(point, more);
            }
        }
    }

    /// Looks at the replicates of a point in their order: the first number that is enough is the one.
    fn judge(&mut self, point: usize) {
        let settings = &self.plan.settings;
        let PointState { wanted, judged, .. } = self.points[point];
        let found = |replicates, narrow| Some(PointFindings { replicates, narrow });
        let (Some(until), Some(decisive)) = (&settings.until, self.decisive) else {
            self.points[point].found = found(wanted, None);
            return;
        };
        let values: Vec<Option<f64>> = (0..wanted)
            .map(|replicate| value(&self.runs, point, replicate, decisive))
            .collect();
        let state = &mut self.points[point];
        for replicates in settings.min_replicates().max(judged + 1)..=wanted {
            let values: Vec<f64> = values[..replicates].iter().filter_map(|value| *value).collect();
            state.half_width = Sample::of(&values, until.confidence).and_then(|sample| sample.half_width);
            state.judged = replicates;
            // A run may have no such number, and few values are soon close together.
            let enough = values.len() >= settings.min_replicates();
            if enough && state.half_width.is_some_and(|half| half <= until.half_width) {
                state.found = found(replicates, Some(true));
                break;
            }
            if values.is_empty() {
                state.found = found(replicates, Some(false));
                break;
            }
        }
        if state.found.is_none() && wanted >= settings.max_replicates() {
            state.found = found(wanted, Some(false));
        }
    }

    /// Tells how far the study has come.
    fn tell(&mut self, watch: &mut dyn FnMut(&Progress)) {
        let widths = self.points.iter().filter_map(|point| point.half_width);
        self.progress.worst = widths.reduce(f64::max);
        watch(&self.progress);
    }

    fn findings(self) -> Findings {
        let strangers = self.strangers();
        let points: Vec<PointFindings> = self.points.into_iter().filter_map(|point| point.found).collect();
        // What was run ahead and not needed stays in the records, out of the tables.
        let mut runs = self.runs;
        runs.retain(|run, _| {
            points
                .get(run.point)
                .is_some_and(|found| run.replicate < found.replicates)
        });
        Findings {
            runs,
            points,
            strangers,
        }
    }

    /// Recorded runs that no point could ask for, however many replicates it had.
    fn strangers(&self) -> usize {
        if self.records.len() == self.belonging.len() {
            return 0;
        }
        let mut belonging = self.belonging.clone();
        for run in self.plan.runs(self.plan.settings.max_replicates()) {
            let id = self.plan.identity(run);
            if self.records.get(&id).is_some() {
                belonging.insert(id);
            }
        }
        self.records.len() - belonging.len()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::study::StudyFile;
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

    fn find(plan: &Plan, runner: &Runner, threads: usize) -> (Result<Findings, StudyError>, usize) {
        let folder = tempfile::tempdir().unwrap();
        let mut records = Records::open(folder.path()).unwrap();
        let found = execute_with(
            plan,
            &mut records,
            runner,
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
        let (expected, _) = find(&plan, &|run, _| Ok(Some(pretend(run))), 1);
        let expected = expected.unwrap();
        let counts: Vec<usize> = expected.points.iter().map(|point| point.replicates).collect();
        // The case must be one in which something is decided.
        assert!(counts.iter().any(|&count| count > 3 && count < 20), "{counts:?}");
        for threads in [2, 5, 16] {
            let late_first = |run: RunKey, _: &Ends| {
                std::thread::sleep(Duration::from_millis(3 * (2 - run.replicate as u64 % 3)));
                Ok(Some(pretend(run)))
            };
            let (found, recorded) = find(&plan, &late_first, threads);
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
        let (found, recorded) = find(&plan(&wide), &|run, _| Ok(Some(pretend(run))), 2);
        let narrow = PointFindings {
            replicates: 20,
            narrow: Some(false),
        };
        assert_eq!(found.unwrap().points, [narrow; 4]);
        assert_eq!(recorded, 80);
    }

    #[test]
    fn what_was_run_ahead_is_no_stranger() {
        let plan = plan(ADAPTIVE);
        let folder = tempfile::tempdir().unwrap();
        let mut records = Records::open(folder.path()).unwrap();
        let never = AtomicBool::new(false);
        for threads in [16, 1] {
            let runner = |run, _: &Ends| Ok(Some(pretend(run)));
            let found = execute_with(&plan, &mut records, &runner, threads, &never, &mut |_| {}).unwrap();
            assert_eq!(found.strangers, 0, "{threads} threads");
        }
        assert!(records.len() > 12);
    }

    #[test]
    fn failures_and_faults_do_not_stop_the_rest() {
        let plan = plan("base.slider.blocks = [2, 2]\nstudy.replicates = 6");
        let runner = |run: RunKey, _: &Ends| match run.replicate {
            1 => Ok(Some(Outcome::Failed("it diverged".to_owned()))),
            3 => panic!("out of bounds"),
            _ => Ok(Some(pretend(run))),
        };
        let (found, recorded) = find(&plan, &runner, 2);
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

    /// Nobody would record what else is run.
    #[test]
    fn a_fault_of_the_manager_ends_the_workers() {
        let plan = plan("base.slider.blocks = [2, 2]\nstudy.replicates = 100");
        let folder = tempfile::tempdir().unwrap();
        let mut records = Records::open(folder.path()).unwrap();
        let forever = AtomicBool::new(false);
        let runner = |run: RunKey, ends: &Ends| {
            if run.replicate < 5 {
                return Ok(Some(pretend(run)));
            }
            // Nothing else ends this one.
            let began = Instant::now();
            while !ends() && began.elapsed() < Duration::from_secs(60) {
                std::thread::sleep(Duration::from_millis(1));
            }
            forever.fetch_or(!ends(), Ordering::Relaxed);
            Ok(None)
        };
        let never = AtomicBool::new(false);
        let watch = &mut |now: &Progress| assert_eq!(now.here, 0, "a fault of the manager");
        let ended = catch_unwind(AssertUnwindSafe(|| {
            execute_with(&plan, &mut records, &runner, 2, &never, watch).map(|_| ())
        }));
        assert!(ended.is_err());
        assert!(!forever.into_inner(), "a worker was not told to end");
    }

    #[test]
    fn a_study_that_cannot_go_on_keeps_what_is_finished() {
        let plan = plan("base.slider.blocks = [2, 2]\nstudy.replicates = 50");
        let runner = |run: RunKey, _: &Ends| match run.replicate {
            10 => Err(StudyError::Threads(std::io::Error::other("the disk is full"))),
            _ => Ok(Some(pretend(run))),
        };
        let (found, recorded) = find(&plan, &runner, 1);
        assert!(matches!(found, Err(StudyError::Threads(_))));
        assert!((10..50).contains(&recorded), "{recorded}");
    }
}
