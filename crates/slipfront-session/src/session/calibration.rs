//! A calibration under way, distributed over tasks.

use std::vec;

use serde_json::Value;

use crate::document::Document;
use crate::event::{EventKind, MadeRun, WantedRun};
use crate::host::{Host, Task};
use crate::job::{Job, JobKind};
use crate::protocol::{CalibrateRequest, CalibratingReply, CalibrationStage};

/// The error message of a calibration that crashes.
const LOST: &str = "the calibration failed by a defect of its own";

/// A calibration under way. Dropping it ends its jobs.
pub(super) struct Calibration {
    document: Document,
    request: Box<CalibrateRequest>,
    /// Runs that other tasks have made for it.
    made: Vec<MadeRun>,
    work: Work,
    pub(super) progress: CalibratingReply,
}

/// The present work of a calibration.
enum Work {
    /// The calibration itself, as far as its runs allow.
    Finding(Box<dyn Task>),
    /// Runs that it wants, distributed over several tasks.
    Making(Vec<Part>),
}

/// The runs that one task makes.
struct Part {
    task: Box<dyn Task>,
    /// Runs that the task has not reported yet, in order.
    wanted: vec::IntoIter<WantedRun>,
}

impl Calibration {
    /// Begins the calibration of a case.
    ///
    /// # Errors
    /// A sentence, if the system refuses the job.
    pub(super) fn begin(
        host: &dyn Host,
        document: Document,
        request: Box<CalibrateRequest>,
    ) -> Result<Self, String> {
        let stage = CalibrationStage::Training;
        let (runs, of) = (0, request.runs as usize);
        Ok(Self {
            work: Work::Finding(Self::find(host, &document, &request, Vec::new())?),
            progress: CalibratingReply { stage, runs, of },
            document,
            request,
            made: Vec::new(),
        })
    }

    /// Begins the calibration of a case, or continues it with the runs that were made for it.
    fn find(
        host: &dyn Host,
        document: &Document,
        request: &CalibrateRequest,
        made: Vec<MadeRun>,
    ) -> Result<Box<dyn Task>, String> {
        let kind = JobKind::Calibrate {
            request: Box::new(request.clone()),
            made,
            is_elsewhere: host.workers() > 1,
        };
        host.begin(Job::new(document.clone(), kind))
    }

    /// Distributes runs over the workers of the host.
    fn make(&mut self, host: &dyn Host, wanted: &[WantedRun]) -> Result<(), String> {
        let workers = host.workers().clamp(1, wanted.len().max(1));
        let mut parts = Vec::new();
        for first in 0..workers {
            let wanted: Vec<WantedRun> = wanted.iter().skip(first).step_by(workers).cloned().collect();
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

    /// Checks the tasks; returns the results once they are there.
    ///
    /// # Errors
    /// A sentence on why there are none.
    pub(super) fn follow(&mut self, host: &dyn Host) -> Result<Option<Value>, String> {
        match &mut self.work {
            Work::Finding(task) => {
                while let Some(event) = task.next_event() {
                    match event.0 {
                        EventKind::Calibrating(progress) => self.progress = progress,
                        EventKind::Calibrated(results) => return results.map(Some),
                        EventKind::Wants(wanted) => {
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
    /// Collects the curves that the task has reported since the last call.
    fn follow(&mut self, made: &mut Vec<MadeRun>) -> Result<(), String> {
        while let Some(wanted) = self.wanted.as_slice().first().cloned()
            && let Some(event) = self.task.next_event()
        {
            let EventKind::Made(curves) = event.0 else {
                return Err(LOST.to_owned());
            };
            let curves = curves?;
            made.push(MadeRun { wanted, curves });
            self.wanted.next();
        }
        Ok(())
    }
}
