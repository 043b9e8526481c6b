//! Requests of a page, and how a session handles them.

use slipfront_base::ordered::map_of;

use super::state::Session;
use crate::history::History;
use crate::protocol::{CalibrationOutcome, Message, Reply, Request};
use crate::{base64, zip};

impl Session {
    /// Handles a message, and reports to the page if its request is refused. Changed cases run when the
    /// session next [advances](Self::advance).
    pub fn handle(&mut self, message: Message) {
        let Message(request) = message;
        self.clock.disturb_slice();
        let name = request.name();
        if let Err(sentence) = self.perform(request) {
            self.refuse(name, sentence);
        }
    }

    /// Performs a request.
    ///
    /// # Errors
    /// A sentence, if the request is refused.
    fn perform(&mut self, request: Request) -> Result<(), String> {
        match request {
            Request::Open { source } => self.open(source),
            Request::Set { keys, gesture } => self.set(keys, gesture),
            Request::Paint {
                points,
                radius,
                textured,
                gesture,
            } => self.paint(&points, radius, textured, gesture),
            Request::Image {
                png,
                threshold,
                gesture,
            } => self.image(&png, threshold, gesture),
            Request::Undo => self.move_in_history("undo", History::undo),
            Request::Redo => self.move_in_history("redo", History::redo),
            Request::Rest => {
                self.apply_edits();
                self.run_present_case("rest", true)
            }
            Request::View(change) => {
                let had_twin = self.view.twin;
                self.view.change(&change)?;
                self.pending.redraw = true;
                self.clock.due = 0.0;
                if had_twin != self.view.twin && self.history.is_some() {
                    self.start_twin(true)?;
                }
                Ok(())
            }
            Request::Step { count } => {
                self.single_steps = count.clamp(1, 10_000);
                Ok(())
            }
            Request::Repeat { seeds } => self.repeat(seeds),
            Request::Find { gesture } => self.find(gesture),
            Request::FindStop => {
                self.stop_search();
                Ok(())
            }
            Request::ReadRecord { record } => self.read_record(record),
            Request::Calibrate(request) => self.calibrate(request),
            Request::CalibrateStop => {
                self.end_calibration(CalibrationOutcome::Stopped, None, None);
                Ok(())
            }
            Request::Sensitivity { control } => self.sensitivity(&control),
            Request::Drawing { format } => self.drawing(format),
            Request::Save { name } => self.save(&name),
            Request::SaveStop { name } => {
                self.host.stop_saving(&name);
                Ok(())
            }
            Request::Export => self.export(),
            Request::FramesOf { index } => {
                self.shown_recording = index;
                self.painter.reset_scale();
                self.pending.redraw = true;
                Ok(())
            }
        }
    }

    fn save(&mut self, name: &str) -> Result<(), String> {
        self.apply_edits();
        self.host.save(self.document()?.clone(), name)
    }

    fn export(&mut self) -> Result<(), String> {
        self.apply_edits();
        let document = self.document()?;
        let toml = document.toml();
        let files = document
            .files()
            .iter()
            .map(|(name, contents)| (name.as_str(), &**contents));
        let all = [("case.toml", toml.as_bytes())].into_iter().chain(files.clone());
        let archive = zip::archive(all).map_err(|error| format!("the archive cannot be made: {error}"))?;
        let exported = Reply::Exported {
            toml: &toml,
            files: map_of(files.map(|(name, bytes)| (name, base64::encode(bytes)))),
            zip: base64::encode(&archive),
        };
        self.host.reply(exported.json());
        Ok(())
    }
}
