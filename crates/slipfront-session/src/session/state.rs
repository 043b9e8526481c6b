//! The state of a session.

use std::rc::Rc;

use super::calibrate::Calibration;
use super::clock::Clock;
use super::errands::Errand;
use super::find::TextureSearch;
use super::painting::Painting;
use super::repeat::Repetition;
use crate::document::Document;
use crate::history::History;
use crate::host::Host;
use crate::live::LiveRun;
use crate::picture::Painter;
use crate::protocol::Reply;
use crate::recorded::RecordedRun;
use crate::view::View;

/// The run of the slider without texture, and its case.
pub(super) struct Twin {
    pub(super) live: LiveRun,
    pub(super) document: Document,
}

/// An edit of the case that was not run yet.
pub(super) struct PendingEdit {
    pub(super) document: Document,
    pub(super) gesture: u64,
    pub(super) request: &'static str,
}

/// A case that is edited, its run, and their display on a page.
pub struct Session {
    pub(super) host: Rc<dyn Host>,
    pub(super) view: View,
    pub(super) history: Option<History>,
    pub(super) edited: Option<PendingEdit>,
    /// The texture while it is painted.
    pub(super) painting: Option<Painting>,
    pub(super) live: Option<LiveRun>,
    pub(super) twin: Option<Twin>,
    pub(super) recorded: Option<RecordedRun>,
    pub(super) shown_recording: Option<usize>,
    pub(super) painter: Painter,
    pub(super) clock: Clock,
    /// Whether steps that are due before the next picture are being taken.
    pub(super) is_stepping: bool,
    /// Number of steps still to take of those that requests have asked for while the run is paused.
    pub(super) single_steps: u64,
    /// The computation of static friction over several seeds, while it is under way.
    pub(super) repeating: Option<Repetition>,
    pub(super) search: Option<TextureSearch>,
    pub(super) calibration: Option<Calibration>,
    /// Jobs that end with one reply.
    pub(super) errands: Vec<Errand>,
    /// Updates to send with the next points of the curves.
    pub(super) pending: PendingUpdates,
}

/// Updates that were not sent to the page yet.
#[derive(Default)]
pub(super) struct PendingUpdates {
    /// Whether a picture must be drawn although nothing has moved.
    pub(super) redraw: bool,
    pub(super) from_rest: bool,
    pub(super) twin_reset: bool,
    pub(super) recorded: bool,
    /// Number of ends of the run and its twin that were sent.
    pub(super) ends_sent: usize,
    /// Number of stages of the transition that were sent.
    pub(super) stages_sent: usize,
}

impl Session {
    /// A session without an open case.
    pub fn new(host: Rc<dyn Host>) -> Self {
        Self {
            host,
            view: View::default(),
            history: None,
            edited: None,
            painting: None,
            live: None,
            twin: None,
            recorded: None,
            shown_recording: None,
            painter: Painter::default(),
            clock: Clock::default(),
            is_stepping: false,
            single_steps: 0,
            repeating: None,
            search: None,
            calibration: None,
            errands: Vec::new(),
            pending: PendingUpdates::default(),
        }
    }

    /// Number of runs that have ended: the run, its twin, or both.
    pub(super) fn count_ended(&self) -> usize {
        let runs = self.live.iter().chain(self.twin.as_ref().map(|twin| &twin.live));
        runs.filter(|run| run.ended.is_some()).count()
    }

    /// Number of blocks along x.
    pub(super) fn columns(&self) -> usize {
        self.live.as_ref().map_or(1, |live| live.case().model.lattice.nx)
    }

    /// Tells the page that a request of this name was refused, with the reason.
    pub(super) fn refuse(&self, request: &'static str, sentence: String) {
        self.host.reply(
            Reply::Refused {
                of: request,
                sentence,
            }
            .json(),
        );
    }

    /// The case with all edits up to now.
    pub(super) fn document(&self) -> Result<&Document, String> {
        let edited = self.edited.as_ref().map(|edited| &edited.document);
        edited
            .or(self.history.as_ref().map(History::present))
            .ok_or_else(|| "no case is open yet".to_owned())
    }

    /// Whether there are edits that were not run yet.
    pub(super) fn has_edits(&self) -> bool {
        self.edited.is_some() || self.painting.is_some()
    }
}
