//! A calibration of the case: how it begins, continues and ends.

use std::time::Duration;

use serde_json::Value;

use super::calibration::Calibration;
use super::clock::is_due;
use super::state::Session;
use crate::protocol::{CalibrateRequest, CalibratedReply, CalibrationOutcome, Reply};

/// Time between two progress reports of a calibration.
const REPORT_INTERVAL: Duration = Duration::from_millis(250);

/// Smallest and largest number of unknown keys that a page may ask for.
const UNKNOWNS: [usize; 2] = [2, 4];

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
        self.calibration = Some(Calibration::begin(&*self.host, document, request)?);
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
