//! A calibration of the case: how it begins, continues and ends.

use std::time::Duration;

use serde_json::Value;

use super::clock::is_due;
use super::distributed::Distributed;
use super::state::Session;
use crate::document::Document;
use crate::event::{EventKind, MadeRun};
use crate::host::{Host, Task};
use crate::job::{Job, JobKind};
use crate::protocol::{
    CalibrateRequest, CalibratedReply, CalibratingReply, CalibrationOutcome, CalibrationStage, Reply,
};

/// Time between two progress reports of a calibration.
const REPORT_INTERVAL: Duration = Duration::from_millis(250);

/// Smallest and largest number of unknown keys that a page may ask for.
const UNKNOWNS: [usize; 2] = [2, 4];

/// The error message of a calibration that crashes.
const LOST: &str = "the calibration failed by a defect of its own";

/// A calibration under way. Dropping it ends its jobs.
pub(super) struct Calibration {
    document: Document,
    request: Box<CalibrateRequest>,
    /// Runs that other jobs have made for it.
    made: Vec<MadeRun>,
    work: Work,
    progress: CalibratingReply,
}

/// The present work of a calibration.
enum Work {
    /// The calibration itself, as far as its runs allow.
    Finding(Box<dyn Task>),
    /// Runs that it wants.
    Making(Distributed<String>),
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
            work: find(&*self.host, &document, &request, &[])?,
            progress: CalibratingReply {
                stage: CalibrationStage::Training,
                runs: 0,
                of: request.runs as usize,
            },
            document,
            request,
            made: Vec::new(),
        });
        Ok(())
    }

    /// Ends the calibration under way, if there is one.
    pub(super) fn end_calibration(
        &mut self,
        outcome: CalibrationOutcome,
        sentence: Option<String>,
        results: Option<Value>,
    ) {
        if self.calibration.take().is_some() {
            let calibrated = CalibratedReply {
                outcome,
                sentence,
                results,
            };
            self.host.reply(Reply::Calibrated(calibrated).json());
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
            Ok(results) => self.end_calibration(CalibrationOutcome::Done, None, results),
            Err(sentence) => self.end_calibration(CalibrationOutcome::Failed, Some(sentence), None),
        }
    }
}

/// Begins the calibration of a case, or continues it with the runs that were made for it.
fn find(
    host: &dyn Host,
    document: &Document,
    request: &CalibrateRequest,
    made: &[MadeRun],
) -> Result<Work, String> {
    let kind = JobKind::Calibrate {
        request: Box::new(request.clone()),
        made: made.to_vec(),
        is_elsewhere: host.workers() > 1,
    };
    host.begin(Job::new(document.clone(), kind)).map(Work::Finding)
}

impl Calibration {
    /// Checks the jobs; returns the results once they are there.
    ///
    /// # Errors
    /// A sentence on why there are none.
    fn follow(&mut self, host: &dyn Host) -> Result<Option<Value>, String> {
        let Self {
            document, request, ..
        } = self;
        match &mut self.work {
            Work::Finding(task) => {
                while let Some(event) = task.next_event() {
                    match event.0 {
                        EventKind::Calibrating(progress) => self.progress = progress,
                        EventKind::Calibrated(results) => return results.map(Some),
                        EventKind::Wants(wanted) => {
                            let make = |wanted| JobKind::MakeRuns {
                                request: request.clone(),
                                wanted,
                            };
                            let runs = Distributed::begin(host, document, &wanted, make)?;
                            self.work = Work::Making(runs);
                            return Ok(None);
                        }
                        _ => return Err(LOST.to_owned()),
                    }
                }
            }
            Work::Making(runs) => {
                for (wanted, event) in runs.reported() {
                    let EventKind::Made(curves) = event else {
                        return Err(LOST.to_owned());
                    };
                    let curves = curves?;
                    self.made.push(MadeRun { wanted, curves });
                }
                self.progress.runs = self.made.len();
                if runs.is_done() {
                    self.work = find(host, document, request, &self.made)?;
                }
            }
        }
        Ok(None)
    }
}
