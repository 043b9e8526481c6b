//! What a page asks for.

use std::sync::Arc;

use super::state::Session;
use crate::background::BackgroundTask;
use crate::files::TemporaryFile;
use crate::history::History;
use crate::protocol::{Reply, Request};
use crate::repeat::repeat;
use crate::{base64, zip};

/// Most seeds of a repetition.
const MAX_SEEDS: u64 = 32;

impl Session {
    /// Does what a request asks for, and tells the page if it is refused.
    pub(super) fn handle(&mut self, request: Request) {
        let of = request.name();
        if let Err(sentence) = self.perform(request) {
            self.outbox.reply(&Reply::Refused { of, sentence });
        }
    }

    /// Does what a request asks for.
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
            Request::Save { name } => self.save(&name),
            Request::SaveStop { name } => {
                self.setting.saves.stop(&name);
                Ok(())
            }
            Request::Export => self.export(),
            Request::FramesOf { index } => {
                self.shown_recording = index;
                self.painter.reset_scale();
                self.pending.redraw = true;
                Ok(())
            }
            #[cfg(test)]
            Request::Panic => panic!("a defect that a test asks for"),
        }
    }

    fn repeat(&mut self, seeds: u64) -> Result<(), String> {
        self.repeating = None;
        if seeds == 0 {
            return Ok(());
        }
        if !(2..=MAX_SEEDS).contains(&seeds) {
            return Err(format!(
                "{seeds} seeds were asked for, where there may be 2 to {MAX_SEEDS}"
            ));
        }
        self.apply_edits();
        let (document, outbox) = (self.document()?.clone(), Arc::clone(&self.outbox));
        let work = BackgroundTask::spawn(&self.working, move |stop| repeat(&document, seeds, &outbox, stop));
        self.repeating = Some(work.map_err(|error| error.to_string())?);
        Ok(())
    }

    fn save(&mut self, name: &str) -> Result<(), String> {
        self.apply_edits();
        let (document, setting) = (self.document()?.clone(), &self.setting);
        setting
            .saves
            .begin(document, name, &setting.results, setting.threads, &self.working)
    }

    fn export(&mut self) -> Result<(), String> {
        self.apply_edits();
        let document = self.document()?;
        let toml = document.toml();
        let read = |(name, file): (&String, &Arc<TemporaryFile>)| match file.read() {
            Ok(contents) => Ok((name.clone(), contents)),
            Err(error) => Err(format!(
                "{name} cannot be read from the temporary folder any more: {error}"
            )),
        };
        let files: Vec<(String, Vec<u8>)> = document.files().iter().map(read).collect::<Result<_, _>>()?;
        let files = files
            .iter()
            .map(|(name, contents)| (name.as_str(), contents.as_slice()));
        let all = [("case.toml", toml.as_bytes())].into_iter().chain(files.clone());
        let archive = zip::archive(all).map_err(|error| format!("the archive cannot be made: {error}"))?;
        self.outbox.reply(&Reply::Exported {
            toml: &toml,
            files: files.map(|(name, bytes)| (name, base64::encode(bytes))).collect(),
            zip: base64::encode(&archive),
        });
        Ok(())
    }
}
