//! Changes of the case.

use std::path::Path;

use slipfront_base::text::truncated;
use toml::Value;

use super::painting::Painting;
use super::state::{PendingEdit, Session};
use crate::base64;
use crate::document::Document;
use crate::history::History;
use crate::host::OpenedCase;
use crate::names::is_plain_name;
use crate::protocol::{Reply, Source};
use crate::run_files::recorded_run;
use crate::sentence::sentence;
use crate::view::AfterChange;

impl Session {
    pub(super) fn open(&mut self, source: Source) -> Result<(), String> {
        let OpenedCase { document, recorded } = self.opened(source)?;
        // A case that cannot be run is refused before anything is dropped.
        let case = self.case_of(&document)?;
        self.give_up_work();
        (self.edited, self.painting) = (None, None);
        self.shown_recording = None;
        self.history = Some(History::new(document));
        self.recorded = recorded;
        self.pending.recorded = self.recorded.is_some();
        self.start_run(&case, "open", true)?;
        if let Some(snapshots) = self
            .recorded
            .as_ref()
            .and_then(|recorded| recorded.snapshots.as_ref())
        {
            let times_star = snapshots.frames.iter().map(|frame| frame.time_star).collect();
            self.host.reply(Reply::Recorded { times_star }.json());
        }
        Ok(())
    }

    /// Reads the case that a source names.
    fn opened(&self, source: Source) -> Result<OpenedCase, String> {
        if let Some(name) = source.preset {
            return self.host.preset(&name).map(OpenedCase::from);
        }
        if let Some(name) = source.folder {
            return self.host.recorded_run(&name);
        }
        if let Some(files) = source.run {
            let name = source.name.filter(|name| is_plain_name(name));
            let name = name.unwrap_or_else(|| "run".to_owned());
            let read = |file: &str| files.get(file).map(|text| base64::decode(text)).transpose();
            return recorded_run(&name, Path::new(&name), read);
        }
        if source.toml.is_none() {
            return self.host.opening();
        }
        Document::try_from(source).map(OpenedCase::from)
    }

    pub(super) fn set(
        &mut self,
        keys: serde_json::Map<String, serde_json::Value>,
        gesture: u64,
    ) -> Result<(), String> {
        self.apply_painting();
        let mut changes = Vec::new();
        for (key, value) in keys {
            let value = match value {
                serde_json::Value::Null => None,
                value => Some(
                    Value::try_from(value)
                        .map_err(|error| format!("`{}` is no value of TOML: {error}", truncated(&key)))?,
                ),
            };
            changes.push((key, value));
        }
        let document = self.document()?.with(changes)?;
        self.edited = Some(PendingEdit {
            document,
            gesture,
            request: "set",
        });
        Ok(())
    }

    pub(super) fn paint(
        &mut self,
        points: &[[f64; 2]],
        radius: f64,
        textured: bool,
        gesture: u64,
    ) -> Result<(), String> {
        self.apply_edited_document();
        let case = self.live.as_ref().ok_or("no case is open yet")?.case();
        let mut painting = match self.painting.take() {
            Some(painting) => painting,
            None => Painting::begin(self.document()?, case, gesture)?,
        };
        painting.gesture = gesture;
        let done = painting.stroke(case, points, radius, textured);
        self.painting = Some(painting);
        done
    }

    pub(super) fn image(&mut self, text: &str, threshold: f64, gesture: u64) -> Result<(), String> {
        self.apply_painting();
        let image = base64::decode(text)?;
        let document = self.document()?.with_image(&image, threshold).map_err(sentence)?;
        self.edited = Some(PendingEdit {
            document,
            gesture,
            request: "image",
        });
        Ok(())
    }

    /// Undoes or redoes a change of the case with `go`, and runs the case that results.
    pub(super) fn move_in_history(
        &mut self,
        why: &'static str,
        go: fn(&mut History) -> bool,
    ) -> Result<(), String> {
        self.apply_edits();
        if self.history.as_mut().is_some_and(go) {
            self.give_up_work();
            self.run_present_case(why, self.view.after_change == AfterChange::Rest)
        } else {
            Ok(())
        }
    }

    /// Runs the case with all pending edits.
    pub(super) fn apply_edits(&mut self) {
        self.apply_painting();
        self.apply_edited_document();
    }

    /// Makes the painted layer a texture of the case, and runs it.
    fn apply_painting(&mut self) {
        let Some(painting) = self.painting.take() else {
            return;
        };
        let made = self
            .document()
            .and_then(|document| painting.document(document, self.columns()));
        match made {
            Ok(document) => {
                self.edited = Some(PendingEdit {
                    document,
                    gesture: painting.gesture,
                    request: "paint",
                });
                self.apply_edited_document();
            }
            Err(sentence) => self.refuse("paint", sentence),
        }
    }

    /// Runs the edited case, or sends why it cannot be run.
    fn apply_edited_document(&mut self) {
        let Some(PendingEdit {
            document,
            gesture,
            request,
        }) = self.edited.take()
        else {
            return;
        };
        if let Err(sentence) = self.run_edited(document, gesture) {
            self.refuse(request, sentence);
            // The page shows its own change, which was refused.
            self.send_case("refused");
        }
    }

    /// Makes a changed case the present one, and runs it.
    ///
    /// # Errors
    /// A sentence, if it cannot be run; in that case the present case stays.
    pub(super) fn run_edited(&mut self, mut document: Document, gesture: u64) -> Result<(), String> {
        let from_rest = self.view.after_change == AfterChange::Rest;
        let case = self.case_of(&document)?;
        document.drop_unnamed_files().map_err(sentence)?;
        self.give_up_work();
        if let Some(history) = &mut self.history {
            history.change(document, gesture);
        }
        self.start_run(&case, "change", from_rest)
    }
}
