//! A calibration: begun, shared out to tasks, followed.

use std::time::Duration;
use std::vec;

use serde_json::Value;

use super::clock::is_due;
use super::state::Session;
use crate::document::Document;
use crate::event::EventKind;
use crate::host::{Host, Task};
use crate::job::{Job, JobKind, MadeRuns, WantedRuns};
use crate::protocol::{
    CalibrateRequest, CalibratedReply, CalibratingReply, CalibrationOutcome, CalibrationStage, Reply,
};

/// Time between two reports of how far a calibration is.
const REPORT_INTERVAL: Duration = Duration::from_millis(250);

/// Unknown keys that a page may ask for.
const UNKNOWNS: [usize; 2] = [2, 4];

/// Runs of the calibrated model that follow those of the training.
const FURTHER_RUNS: usize = 160;

/// Why a calibration ends by a defect.
const LOST: &str = "the calibration failed by a defect of its own";

/// A calibration under way. Dropping it ends its work.
pub(super) struct Calibration {
    document: Document,
    request: Box<CalibrateRequest>,
    /// Runs that were made for it by other tasks.
    made: Vec<MadeRuns>,
    work: Work,
    progress: CalibratingReply,
}

/// Work of a calibration.
enum Work {
    /// The calibration itself, as far as its runs go.
    Finding(Box<dyn Task>),
    /// Runs that it wants, shared out to several tasks.
    Making(Vec<Part>),
}

/// The runs that one task makes.
struct Part {
    task: Box<dyn Task>,
    /// Runs of which the task has reported nothing yet, in its order.
    wanted: vec::IntoIter<WantedRuns>,
}

impl Calibration {
    /// Begins the calibration of a case, or goes on with the runs that were made for it.
    fn find(
        host: &dyn Host,
        document: &Document,
        request: &CalibrateRequest,
        made: Vec<MadeRuns>,
    ) -> Result<Box<dyn Task>, String> {
        let kind = JobKind::Calibrate {
            request: Box::new(request.clone()),
            made,
            is_elsewhere: host.workers() > 1,
        };
        host.begin(Job::new(document.clone(), kind))
    }

    /// Shares runs out to the workers of the host.
    fn make(&mut self, host: &dyn Host, wanted: &[WantedRuns]) -> Result<(), String> {
        let workers = host.workers().clamp(1, wanted.len().max(1));
        let mut parts = Vec::new();
        for first in 0..workers {
            let wanted: Vec<WantedRuns> = wanted.iter().skip(first).step_by(workers).cloned().collect();
            let kind = JobKind::MakeRuns {
                request: self.request.clone(),
                wanted: wanted.clone(),
            };
            let task = host.begin(Job::new(self.document.clone(), kind))?;
            let wanted = wanted.into_iter();
            parts.push(Part { task, wanted });
        }
        self.work = Work::Making(parts);
        Ok(())
    }

    /// Looks after the work; gives its results once they are there.
    ///
    /// # Errors
    /// A sentence on why there are none.
    fn follow(&mut self, host: &dyn Host) -> Result<Option<Value>, String> {
        match &mut self.work {
            Work::Finding(task) => {
                while let Some(event) = task.next_event() {
                    match event.0 {
                        EventKind::Calibrating(progress) => self.progress = progress,
                        EventKind::Calibrated(results) => return results.map(Some),
                        EventKind::Wants(stage, wanted) => {
                            self.progress.stage = stage;
                            self.make(host, &wanted)?;
                            return Ok(None);
                        }
                        _ => return Err(LOST.to_owned()),
                    }
                }
            }
            Work::Making(parts) => {
                for part in parts.iter_mut() {
                    part.follow(&mut self.made)?;
                }
                parts.retain(|part| part.wanted.len() > 0);
                self.progress.runs = self.made.len();
                if parts.is_empty() {
                    self.work = Work::Finding(Self::find(
                        host,
                        &self.document,
                        &self.request,
                        self.made.clone(),
                    )?);
                }
            }
        }
        Ok(None)
    }
}

impl Part {
    /// Notes the curves that the task has reported since the last look.
    fn follow(&mut self, made: &mut Vec<MadeRuns>) -> Result<(), String> {
        while let Some(wanted) = self.wanted.as_slice().first().cloned()
            && let Some(event) = self.task.next_event()
        {
            let EventKind::Made(curves) = event.0 else {
                return Err(LOST.to_owned());
            };
            let curves = curves?;
            made.push(MadeRuns { wanted, curves });
            self.wanted.next();
        }
        Ok(())
    }
}

impl Session {
    /// Begins to calibrate the case.
    pub(super) fn calibrate(&mut self, request: Box<CalibrateRequest>) -> Result<(), String> {
        if self.calibration.is_some() {
            return Err("a calibration is under way already: wait until it is done, or stop it".to_owned());
        }
        let [fewest, most] = UNKNOWNS;
        let unknowns = request.unknowns.len();
        if !(fewest..=most).contains(&unknowns) {
            return Err(format!(
                "{unknowns} unknown keys were asked for, where there may be {fewest} to {most}: \
                 `slipfront calibrate` takes more"
            ));
        }
        self.apply_edits();
        let document = self.document()?.clone();
        self.calibration = Some(Calibration {
            work: Work::Finding(Calibration::find(&*self.host, &document, &request, Vec::new())?),
            progress: CalibratingReply {
                stage: CalibrationStage::Training,
                runs: 0,
                of: request.runs as usize + FURTHER_RUNS,
            },
            document,
            request,
            made: Vec::new(),
        });
        Ok(())
    }

    /// Ends the calibration under way, if there is one.
    pub(super) fn end_calibration(&mut self, outcome: CalibrationOutcome) {
        if self.calibration.take().is_some() {
            self.tell_calibrated(outcome, None, None);
        }
    }

    /// Reports the progress of the calibration, or its end.
    pub(super) fn follow_calibration(&mut self, now: Duration) {
        let Some(calibration) = &mut self.calibration else {
            return;
        };
        match calibration.follow(&*self.host) {
            Ok(None) => {
                let progress = calibration.progress;
                if is_due(&mut self.clock.calibration, REPORT_INTERVAL, now) && !self.host.is_full() {
                    self.host.reply(Reply::Calibrating(progress).json());
                }
            }
            Ok(Some(results)) => {
                self.calibration = None;
                self.tell_calibrated(CalibrationOutcome::Done, None, Some(results));
            }
            Err(sentence) => {
                self.calibration = None;
                self.tell_calibrated(CalibrationOutcome::Failed, Some(sentence), None);
            }
        }
    }

    fn tell_calibrated(&self, outcome: CalibrationOutcome, sentence: Option<String>, results: Option<Value>) {
        let calibrated = CalibratedReply {
            outcome,
            sentence,
            results,
        };
        self.host.reply(Reply::Calibrated(calibrated).json());
    }
}
