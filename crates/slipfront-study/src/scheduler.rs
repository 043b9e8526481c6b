//! Decides on the runs that a study needs, and records each as soon as it is finished.
//!
//! The results do not depend on the order in which runs finish: the number of replicates of a point is
//! determined by its first replicates in their order, however many more have been run.

use std::collections::{HashMap, HashSet};
use std::sync::atomic::{AtomicBool, Ordering};

use crate::error::StudyError;
use crate::finished_run::{FinishedRun, RunResult};
use crate::plan::{Plan, RunKey};
use crate::run_journal::RunJournal;
use crate::statistics::Sample;
use crate::study_results::{PointResult, Progress, StudyResults};
use crate::summary_values::RunQuantity;

/// A run to do.
pub(crate) struct Task {
    pub(crate) run: RunKey,
    /// [`Plan::identity`] of the run.
    pub(crate) id: String,
}

/// The record of a finished run; none if it was aborted.
pub(crate) type TaskResult = Result<Option<FinishedRun>, StudyError>;

/// Starts runs and decides on the number of replicates.
pub(crate) struct Scheduler<'a> {
    plan: &'a Plan,
    records: &'a RunJournal,
    start: &'a dyn Fn(Task),
    /// Number of simultaneous runs.
    threads: usize,
    /// The runs known so far; the points are added at the end.
    results: StudyResults,
    /// Requested runs that are not finished, by identity. Points may share a run.
    waiting: HashMap<String, Vec<RunKey>>,
    /// Identities of the recorded runs that belong to the study.
    belonging: HashSet<String>,
    points: Vec<PointState>,
    /// The quantity that decides on replication.
    decisive: Option<RunQuantity>,
    progress: Progress,
}

/// Replication of a point while the study runs.
#[derive(Clone, Default)]
struct PointState {
    /// Number of replicates requested so far.
    requested: usize,
    /// Number of runs of these replicates that are not finished.
    missing: usize,
    /// Number of leading replicates that the stopping rule has been evaluated with.
    evaluated: usize,
    /// Half width of the interval of the replicates evaluated last.
    half_width: Option<f64>,
    /// Result of the point, set once the number of replicates is decided.
    result: Option<PointResult>,
}

impl<'a> Scheduler<'a> {
    /// A scheduler; `start` passes a run to another thread.
    pub(crate) fn new(
        plan: &'a Plan,
        records: &'a RunJournal,
        start: &'a dyn Fn(Task),
        threads: usize,
    ) -> Self {
        let until = plan.settings.until.as_ref();
        Self {
            plan,
            records,
            start,
            threads,
            results: StudyResults::default(),
            waiting: HashMap::new(),
            belonging: HashSet::new(),
            points: vec![PointState::default(); plan.points.len()],
            decisive: until.and_then(|until| RunQuantity::named(&until.key)),
            progress: Progress::default(),
        }
    }

    /// The results from the records alone, if no run is missing.
    pub(crate) fn collect(mut self) -> Result<StudyResults, StudyError> {
        self.begin();
        match self.waiting.len() {
            0 => Ok(self.results()),
            runs => Err(StudyError::Missing {
                runs,
                others: self.orphaned_runs(),
            }),
        }
    }

    /// Records finished runs and requests more, until no run is missing. `finished` waits for runs, not for
    /// long, and returns those that have finished since its last call.
    pub(crate) fn run(
        mut self,
        finished: impl Fn() -> Vec<TaskResult>,
        stop: &AtomicBool,
        watch: &mut dyn FnMut(&Progress),
    ) -> Result<StudyResults, StudyError> {
        self.begin();
        self.report(watch);
        while !self.waiting.is_empty() {
            // Checked before waiting, so runs that have finished by the stop are still recorded.
            let stopped = stop.load(Ordering::Relaxed);
            // All runs that have finished meanwhile are written together, since every write waits for the
            // disk.
            self.record(finished())?;
            if stopped {
                return Err(StudyError::Interrupted);
            }
            self.report(watch);
        }
        Ok(self.results())
    }

    /// Requests the fewest replicates of every point, and more if all of these are recorded already.
    fn begin(&mut self) {
        for point in 0..self.points.len() {
            self.request(point, self.plan.settings.min_replicates());
            self.decide(point);
        }
    }

    /// Writes finished runs to the journal, then ingests them.
    fn record(&mut self, finished: Vec<TaskResult>) -> Result<(), StudyError> {
        let (mut records, mut failure) = (Vec::new(), None);
        for ended in finished {
            match ended {
                Ok(record) => records.extend(record),
                Err(error) => failure = Some(error),
            }
        }
        // Runs are on disk before any decision depends on them. Runs that finished together with one that
        // ends the study are kept, too.
        self.records.append(&records)?;
        self.progress.here += records.len();
        for record in records {
            self.ingest(record.id);
        }
        failure.map_or(Ok(()), Err)
    }

    /// Requests the replicates of a point up to the number `requested`: recorded runs are taken as they are,
    /// the others are started.
    fn request(&mut self, point: usize, requested: usize) {
        let plan = self.plan;
        for run in plan.runs_of(point, self.points[point].requested..requested) {
            let id = plan.identity(run);
            let Some(result) = self.records.get(&id) else {
                self.send(run, id);
                continue;
            };
            if !self.belonging.contains(&id) {
                self.progress.total += 1;
                self.count(id, &result);
            }
            self.results.runs.insert(run, result);
        }
        self.points[point].requested = requested;
    }

    fn send(&mut self, run: RunKey, id: String) {
        self.points[run.point].missing += 1;
        let waiting = self.waiting.entry(id.clone()).or_default();
        waiting.push(run);
        // Other points that need the same run wait for the one that is in progress.
        if waiting.len() == 1 {
            self.progress.total += 1;
            (self.start)(Task { run, id });
        }
    }

    fn count(&mut self, id: String, result: &RunResult) {
        self.progress.done += 1;
        self.progress.failed += usize::from(result.is_err());
        self.belonging.insert(id);
    }

    /// Adds the result of a recorded run to every point that waits for it.
    fn ingest(&mut self, id: String) {
        let Some(result) = self.records.get(&id) else {
            return;
        };
        let runs = self.waiting.remove(&id).unwrap_or_default();
        self.count(id, &result);
        // All points get the result before one of them decides, since a decision may request runs that are
        // recorded by now.
        for run in &runs {
            self.results.runs.insert(*run, result.clone());
            self.points[run.point].missing -= 1;
        }
        for run in runs {
            self.decide(run.point);
        }
    }

    /// Decides on the number of replicates of a point once all requested ones are finished, and requests more
    /// if they are not enough.
    fn decide(&mut self, point: usize) {
        // Repeats if all requested runs are recorded already, as when a study is continued.
        while self.points[point].missing == 0 && self.points[point].result.is_none() {
            self.points[point].result = self.evaluate_stopping(point);
            if self.points[point].result.is_none() {
                // Request more than one at a time only for idle threads.
                let idle = self.threads.saturating_sub(self.waiting.len());
                let more = self.points[point].requested + idle.max(1);
                let more = more.min(self.plan.settings.max_replicates());
                self.request(point, more);
            }
        }
    }

    /// Evaluates the stopping rule with the first replicates of a point, one more at a time: the smallest
    /// number that satisfies it is the number of replicates.
    fn evaluate_stopping(&mut self, point: usize) -> Option<PointResult> {
        let settings = &self.plan.settings;
        let state = &mut self.points[point];
        let decided = |replicates, narrow| Some(PointResult { replicates, narrow });
        let (Some(until), Some(decisive)) = (&settings.until, self.decisive) else {
            return decided(state.requested, None);
        };
        let values: Vec<Option<f64>> = (0..state.requested)
            .map(|replicate| self.results.value(point, replicate, decisive))
            .collect();
        for replicates in settings.min_replicates().max(state.evaluated + 1)..=state.requested {
            let values: Vec<f64> = values[..replicates].iter().filter_map(|value| *value).collect();
            state.half_width =
                Sample::from_values(&values, until.confidence).and_then(|sample| sample.half_width);
            state.evaluated = replicates;
            // Some runs may lack the quantity, and the interval of very few values can be narrow by chance.
            let enough = values.len() >= settings.min_replicates();
            if enough && state.half_width.is_some_and(|half| half <= until.half_width) {
                return decided(replicates, Some(true));
            }
            // If none of the fewest replicates has the quantity, such as the speed of a front, no more are
            // tried.
            if values.is_empty() {
                return decided(replicates, Some(false));
            }
        }
        if state.requested < settings.max_replicates() {
            None
        } else {
            decided(state.requested, Some(false))
        }
    }

    /// Calls `watch` with the progress of the study.
    fn report(&mut self, watch: &mut dyn FnMut(&Progress)) {
        let widths = self.points.iter().filter_map(|point| point.half_width);
        self.progress.worst = widths.reduce(f64::max);
        watch(&self.progress);
    }

    /// The results of the study. Replicates that were run but not needed stay only in the records.
    fn results(self) -> StudyResults {
        let orphaned_runs = self.orphaned_runs();
        let points: Vec<PointResult> = self.points.into_iter().filter_map(|point| point.result).collect();
        let mut runs = self.results.runs;
        let replicates = |point: usize| points.get(point).map_or(0, |point| point.replicates);
        runs.retain(|run, _| run.replicate < replicates(run.point));
        StudyResults {
            runs,
            points,
            orphaned_runs,
        }
    }

    /// Number of recorded runs that no point could request, even with the most replicates.
    fn orphaned_runs(&self) -> usize {
        // The usual case; it avoids computing the identities of all possible runs.
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
