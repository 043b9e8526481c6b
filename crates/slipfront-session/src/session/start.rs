//! Starts runs: from rest, or as the next leg of the present one.

use std::sync::Arc;

use slipfront_case::case::Case;

use super::state::{Session, Twin};
use crate::document::Document;
use crate::live::LiveRun;
use crate::sentence::sentence;

impl Session {
    /// Runs the present case again, from rest or from its present state.
    pub(super) fn run_present_case(&mut self, why: &'static str, from_rest: bool) -> Result<(), String> {
        let case = self.case_of(self.document()?)?;
        self.start_run(&case, why, from_rest)
    }

    /// Builds the case of a document for display, unless the page is gone.
    pub(super) fn case_of(&self, document: &Document) -> Result<Arc<Case>, String> {
        let case = document.case_to_show(&mut |_| !self.host.is_gone());
        case.map(Arc::new).map_err(sentence)
    }

    /// Runs a case made from the present document, from rest or from the present state of the run.
    pub(super) fn start_run(
        &mut self,
        case: &Arc<Case>,
        why: &'static str,
        from_rest: bool,
    ) -> Result<(), String> {
        if !from_rest {
            // A leg keeps only its own points, so unsent ones must be sent first.
            self.send_curve();
        }
        let went_on = match &mut self.live {
            // A run that cannot continue with this case begins again.
            Some(live) if !from_rest => live.change(case).is_ok(),
            _ => false,
        };
        if !went_on {
            self.live = Some(LiveRun::from_rest(case, self.host.threads()));
            self.painter.reset_scale();
            self.clock.due = 0.0;
        }
        self.pending.from_rest |= !went_on;
        self.pending.redraw = true;
        self.shown_recording = None;
        self.start_twin(!went_on)?;
        self.send_case(why);
        Ok(())
    }

    /// Starts the slider without texture next to the run, if the case has a texture to compare with.
    pub(super) fn start_twin(&mut self, from_rest: bool) -> Result<(), String> {
        let document = self.document()?;
        if !self.view.twin || !document.has_texture() {
            self.end_twin();
            return Ok(());
        }
        let document = document.twin()?;
        // The twin's own case has not changed: its run continues.
        if let Some(twin) = &self.twin
            && twin.document.is_same_case(&document)
            && (!from_rest || twin.live.leg == 0)
        {
            return Ok(());
        }
        let case = self.case_of(&document)?;
        let went_on = match &mut self.twin {
            Some(twin) if !from_rest => {
                twin.document.clone_from(&document);
                twin.live.change(&case).is_ok()
            }
            _ => false,
        };
        if !went_on {
            let live = LiveRun::from_rest(&case, self.host.threads());
            self.twin = Some(Twin { live, document });
            self.pending.twin_reset = true;
        }
        Ok(())
    }

    /// Ends the run of the slider without texture, if there is one.
    pub(super) fn end_twin(&mut self) {
        self.pending.twin_reset |= self.twin.take().is_some();
    }
}
