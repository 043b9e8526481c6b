//! Runs what a study still lacks: one run per thread, every finished run recorded at once.
//!
//! What the tables hold does not depend on the order in which runs finish: how many replicates a point has is
//! decided from its first ones, in their order, however many have been run ahead.

use std::collections::{BTreeMap, HashMap};
use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{self, Receiver, RecvTimeoutError, Sender};
use std::sync::{Arc, Mutex};
use std::time::{Duration, Instant};

use slipfront::observe::Observer;
use slipfront::{RunError, Snapshot};

use super::error::StudyError;
use super::file::Keep;
use super::plan::{Plan, Role, RunKey};
use super::quantities::{REDUCTION, number, reduction_percent};
use super::record::{Outcome, Record, Records};
use super::statistics::Sample;
use crate::folder::RunFolder;
use crate::summary::Summary;
use crate::{results, run};

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
    /// Outcome of every run of the plan.
    pub outcomes: BTreeMap<RunKey, Arc<Outcome>>,
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
    /// Summary of a run, if it was done and did not fail.
    pub fn summary(&self, run: RunKey) -> Option<&Summary> {
        match self.outcomes.get(&run)?.as_ref() {
            Outcome::Done(summary) => Some(summary),
            Outcome::Failed(_) => None,
        }
    }

    /// A number of a run of a point, or its reduction against the reference of the same seed.
    pub fn value(&self, point: usize, replicate: usize, name: &str) -> Option<f64> {
        value(&self.outcomes, point, replicate, name)
    }

    /// Runs that failed and why.
    pub fn failures(&self) -> impl Iterator<Item = (RunKey, &str)> {
        self.outcomes
            .iter()
            .filter_map(|(run, outcome)| match outcome.as_ref() {
                Outcome::Failed(reason) => Some((*run, reason.as_str())),
                Outcome::Done(_) => None,
            })
    }
}

fn value(
    outcomes: &BTreeMap<RunKey, Arc<Outcome>>,
    point: usize,
    replicate: usize,
    name: &str,
) -> Option<f64> {
    let summary = |role| match outcomes
        .get(&RunKey {
            point,
            replicate,
            role,
        })?
        .as_ref()
    {
        Outcome::Done(summary) => Some(summary.as_ref()),
        Outcome::Failed(_) => None,
    };
    if name == REDUCTION {
        return Some(reduction_percent(
            summary(Role::Point)?,
            summary(Role::Reference)?,
        ));
    }
    number(summary(Role::Point)?, name)
}

/// Runs everything that the plan needs and the records lack.
///
/// `threads` runs go at once; `stop` ends them all, losing none that is finished; `folder` takes the run folders
/// that are kept; `watch` is told of every run.
///
/// # Errors
/// [`StudyError::Interrupted`] after `stop`, and when a record cannot be written. A run that fails is no error.
pub fn execute(
    plan: &Plan,
    records: &mut Records,
    folder: &Path,
    threads: usize,
    stop: &AtomicBool,
    watch: &mut dyn FnMut(&Progress),
) -> Result<Findings, StudyError> {
    let (to_workers, tasks) = mpsc::channel::<Task>();
    let (to_manager, finished) = mpsc::channel::<Finished>();
    let tasks = Arc::new(Mutex::new(tasks));
    // Workers stop on a signal, and when the manager cannot go on.
    let abandon = AtomicBool::new(false);
    let ends = || stop.load(Ordering::Relaxed) || abandon.load(Ordering::Relaxed);
    std::thread::scope(|scope| {
        for _ in 0..threads {
            let (tasks, to_manager) = (Arc::clone(&tasks), to_manager.clone());
            let work = move || work(plan, folder, &tasks, &to_manager, &ends);
            std::thread::Builder::new()
                .spawn_scoped(scope, work)
                .map_err(StudyError::Threads)?;
        }
        drop(to_manager);
        let mut manager = Manager::new(plan, records, to_workers, threads);
        let managed = manager.manage(&finished, stop, watch);
        abandon.store(true, Ordering::Relaxed);
        managed?;
        Ok(manager.findings())
    })
}

/// A run to be done.
struct Task {
    run: RunKey,
    id: String,
}

/// A run that is done; without an outcome if it was given up.
struct Finished {
    id: String,
    wall_time_s: f64,
    outcome: Option<Outcome>,
}

/// A thread that runs tasks until there are no more.
fn work(
    plan: &Plan,
    folder: &Path,
    tasks: &Mutex<Receiver<Task>>,
    done: &Sender<Finished>,
    ends: &(dyn Fn() -> bool + Sync),
) {
    loop {
        let task = match tasks.lock() {
            Ok(tasks) => tasks.recv(),
            Err(_) => return,
        };
        let Ok(Task { run, id }) = task else { return };
        let began = Instant::now();
        let outcome = if ends() {
            None
        } else {
            run_one(plan, folder, run, ends)
        };
        let wall_time_s = began.elapsed().as_secs_f64();
        if done
            .send(Finished {
                id,
                wall_time_s,
                outcome,
            })
            .is_err()
        {
            return;
        }
    }
}

/// Ends a run when the study ends.
struct Watchdog<'a>(&'a (dyn Fn() -> bool + Sync));

impl Observer for Watchdog<'_> {
    fn observe(&mut self, _: &Snapshot) -> Result<(), RunError> {
        if (self.0)() {
            Err(RunError::Observer("given up".to_owned()))
        } else {
            Ok(())
        }
    }
}

/// Block-steps between two looks at the watchdog: some milliseconds' worth.
const BLOCK_STEPS_PER_LOOK: usize = 200_000;

fn run_one(plan: &Plan, folder: &Path, run: RunKey, ends: &(dyn Fn() -> bool + Sync)) -> Option<Outcome> {
    let started = jiff::Timestamp::now();
    let failed = |error: &dyn std::fmt::Display| Some(Outcome::Failed(error.to_string()));
    let case = match plan.case(run) {
        Ok(case) => case,
        Err(error) => return failed(&error),
    };
    let look = (BLOCK_STEPS_PER_LOOK / case.model.lattice.n_blocks()).max(1) as u64;
    let record = run::run(&case, look, &mut Watchdog(ends));
    if ends() {
        return None;
    }
    let keeps = plan.settings.keep == Keep::All || (plan.settings.keep == Keep::Failed && record.is_err());
    let kept = if keeps {
        keep(
            &case,
            record.as_ref().ok(),
            &folder.join("runs").join(run.name()),
            started,
        )
    } else {
        Ok(())
    };
    match (record, kept) {
        (Ok(record), Ok(())) => Some(Outcome::Done(Box::new(record.summary))),
        (Err(error), _) => failed(&error),
        (Ok(_), Err(error)) => failed(&error),
    }
}

/// Keeps a run folder; of a failed run the case file, which repeats it.
fn keep(
    case: &crate::case::Case,
    record: Option<&run::Record>,
    path: &Path,
    started: jiff::Timestamp,
) -> Result<(), results::ResultsError> {
    let mut folder = RunFolder::prepare(path, true)?;
    match record {
        Some(record) => {
            results::write(case, record, folder, started, 1)?;
        }
        None => results::write_case(case, &mut folder)?,
    }
    Ok(())
}

/// Decides what is run and notes what came of it.
struct Manager<'a> {
    plan: &'a Plan,
    records: &'a mut Records,
    tasks: Sender<Task>,
    /// Replicates that are run ahead where one more may be needed.
    ahead: usize,
    outcomes: BTreeMap<RunKey, Arc<Outcome>>,
    /// Runs that wait for a task, by its identity: points may share one.
    waiting: HashMap<String, Vec<RunKey>>,
    /// Identities that belong to the study.
    belonging: HashMap<String, Arc<Outcome>>,
    points: Vec<PointState>,
    progress: Progress,
}

struct PointState {
    /// Replicates asked for so far.
    wanted: usize,
    found: Option<PointFindings>,
    half_width: Option<f64>,
}

impl<'a> Manager<'a> {
    fn new(plan: &'a Plan, records: &'a mut Records, tasks: Sender<Task>, threads: usize) -> Self {
        let state = || PointState {
            wanted: 0,
            found: None,
            half_width: None,
        };
        Self {
            plan,
            records,
            tasks,
            ahead: threads,
            outcomes: BTreeMap::new(),
            waiting: HashMap::new(),
            belonging: HashMap::new(),
            points: plan.points.iter().map(|_| state()).collect(),
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
        for point in 0..self.points.len() {
            self.want(point, self.plan.settings.min_replicates())?;
            self.decide(point)?;
        }
        watch(&self.progress);
        while !self.waiting.is_empty() {
            if stop.load(Ordering::Relaxed) {
                return Err(StudyError::Interrupted);
            }
            match finished.recv_timeout(Duration::from_millis(100)) {
                Ok(Finished {
                    id,
                    wall_time_s,
                    outcome: Some(outcome),
                }) => {
                    self.records.append(Record {
                        id: id.clone(),
                        wall_time_s,
                        outcome: outcome.clone(),
                    })?;
                    self.progress.here += 1;
                    self.note(id, Arc::new(outcome))?;
                    watch(&self.progress);
                }
                Ok(Finished { outcome: None, .. }) | Err(RecvTimeoutError::Timeout) => {}
                Err(RecvTimeoutError::Disconnected) => return Err(StudyError::Interrupted),
            }
        }
        Ok(())
    }

    /// Asks for replicates of a point up to `wanted`.
    fn want(&mut self, point: usize, wanted: usize) -> Result<(), StudyError> {
        let index = self.plan.points[point].index;
        for replicate in self.points[point].wanted..wanted {
            for role in self.plan.roles() {
                let run = RunKey {
                    point: index,
                    replicate,
                    role,
                };
                let id = self.plan.identity(run)?;
                if let Some(outcome) = self.known(&id) {
                    self.outcomes.insert(run, outcome);
                    continue;
                }
                let waiting = self.waiting.entry(id.clone()).or_default();
                waiting.push(run);
                if waiting.len() == 1 {
                    self.progress.total += 1;
                    // The workers live as long as this does.
                    let _ = self.tasks.send(Task { run, id });
                }
            }
        }
        self.points[point].wanted = wanted.max(self.points[point].wanted);
        Ok(())
    }

    /// What is known of a run already.
    fn known(&mut self, id: &str) -> Option<Arc<Outcome>> {
        if let Some(outcome) = self.belonging.get(id) {
            return Some(Arc::clone(outcome));
        }
        let outcome = Arc::new(self.records.get(id)?.clone());
        self.progress.total += 1;
        self.count(&outcome);
        self.belonging.insert(id.to_owned(), Arc::clone(&outcome));
        Some(outcome)
    }

    fn count(&mut self, outcome: &Outcome) {
        self.progress.done += 1;
        self.progress.failed += usize::from(matches!(outcome, Outcome::Failed(_)));
    }

    /// Notes how a run ended, for every point that waited for it.
    fn note(&mut self, id: String, outcome: Arc<Outcome>) -> Result<(), StudyError> {
        self.count(&outcome);
        let runs = self.waiting.remove(&id).unwrap_or_default();
        self.belonging.insert(id, Arc::clone(&outcome));
        for run in &runs {
            self.outcomes.insert(*run, Arc::clone(&outcome));
        }
        for run in runs {
            if let Ok(point) = self
                .plan
                .points
                .binary_search_by_key(&run.point, |point| point.index)
            {
                self.decide(point)?;
            }
        }
        Ok(())
    }

    /// Decides how many replicates a point has, once all that were asked for are there.
    fn decide(&mut self, point: usize) -> Result<(), StudyError> {
        let index = self.plan.points[point].index;
        while self.points[point].found.is_none() {
            let wanted = self.points[point].wanted;
            let there = |replicate| {
                self.plan.roles().all(|role| {
                    self.outcomes.contains_key(&RunKey {
                        point: index,
                        replicate,
                        role,
                    })
                })
            };
            if !(0..wanted).all(there) {
                return Ok(());
            }
            let (found, half_width) = self.judge(index, wanted);
            self.points[point].half_width = half_width;
            self.points[point].found = found;
            let widths = self.points.iter().filter_map(|point| point.half_width);
            self.progress.worst = widths.reduce(f64::max);
            if found.is_none() {
                let more = (wanted + self.ahead).min(self.plan.settings.max_replicates());
                self.want(point, more)?;
            }
        }
        Ok(())
    }

    /// Looks at the replicates of a point in their order: the first number that is enough is the one.
    fn judge(&self, point: usize, there: usize) -> (Option<PointFindings>, Option<f64>) {
        let settings = &self.plan.settings;
        let Some(until) = &settings.until else {
            return (
                Some(PointFindings {
                    replicates: there,
                    narrow: None,
                }),
                None,
            );
        };
        let values: Vec<Option<f64>> = (0..there)
            .map(|replicate| value(&self.outcomes, point, replicate, &until.key))
            .collect();
        let half_width = |replicates: usize| {
            let values: Vec<f64> = values[..replicates].iter().filter_map(|value| *value).collect();
            Sample::of(&values, until.confidence).and_then(|sample| sample.half_width)
        };
        let enough = (settings.min_replicates()..=there)
            .find(|&replicates| half_width(replicates).is_some_and(|half| half <= until.half_width));
        match enough {
            Some(replicates) => (
                Some(PointFindings {
                    replicates,
                    narrow: Some(true),
                }),
                half_width(replicates),
            ),
            None if there >= settings.max_replicates() => (
                Some(PointFindings {
                    replicates: there,
                    narrow: Some(false),
                }),
                half_width(there),
            ),
            None => (None, half_width(there)),
        }
    }

    fn findings(self) -> Findings {
        let points: Vec<PointFindings> = self.points.into_iter().filter_map(|point| point.found).collect();
        let counts: HashMap<usize, usize> = self
            .plan
            .points
            .iter()
            .zip(&points)
            .map(|(point, found)| (point.index, found.replicates))
            .collect();
        // What was run ahead and not needed stays in the records, out of the tables.
        let mut outcomes = self.outcomes;
        outcomes.retain(|run, _| counts.get(&run.point).is_some_and(|&count| run.replicate < count));
        Findings {
            outcomes,
            points,
            strangers: self.records.len() - self.belonging.len(),
        }
    }
}
