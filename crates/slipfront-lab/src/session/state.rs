//! What a session holds.

use std::path::PathBuf;
use std::sync::Arc;
use std::sync::mpsc::Sender;
use std::time::Duration;

use super::clock::Clock;
use crate::background::BackgroundTask;
use crate::document::Document;
use crate::find::{SEARCH_TIME, TextureSearch};
use crate::history::History;
use crate::live::LiveRun;
use crate::opening::Start;
use crate::outbox::Outbox;
use crate::picture::Painter;
use crate::protocol::PresetEntry;
use crate::replay::RecordedRun;
use crate::saves::Saves;
use crate::view::View;

/// What all sessions share.
pub(crate) struct Setting {
    pub(crate) start: Start,
    /// The folder of results.
    pub(crate) results: PathBuf,
    /// Other folders in which files that cases name may lie.
    pub(crate) allow_files: Vec<PathBuf>,
    pub(crate) saves: Arc<Saves>,
    pub(crate) threads: usize,
    pub(crate) presets: Vec<PresetEntry>,
}

/// The run of the slider without texture, and the text of its case.
pub(super) struct Twin {
    pub(super) live: LiveRun,
    pub(super) toml: String,
}

/// An edit of the case that is not run yet.
pub(super) struct PendingEdit {
    pub(super) document: Document,
    pub(super) gesture: u64,
    pub(super) of: &'static str,
}

pub(super) struct Session {
    pub(super) setting: Arc<Setting>,
    /// Held by every thread as long as it works.
    pub(super) working: Sender<()>,
    pub(super) outbox: Arc<Outbox>,
    pub(super) view: View,
    pub(super) history: Option<History>,
    pub(super) edited: Option<PendingEdit>,
    /// The texture while it is painted.
    pub(super) mask: Option<(Vec<bool>, u64)>,
    pub(super) live: Option<LiveRun>,
    pub(super) twin: Option<Twin>,
    pub(super) recorded: Option<RecordedRun>,
    pub(super) shown_recording: Option<usize>,
    pub(super) painter: Painter,
    pub(super) clock: Clock,
    /// Steps that were asked for one by one.
    pub(super) single_steps: u64,
    pub(super) repeating: Option<BackgroundTask>,
    /// The search for a better texture, and how long one may look.
    pub(super) search: Option<TextureSearch>,
    pub(super) search_time: Duration,
    /// What is to be sent with the next points.
    pub(super) pending: PendingUpdates,
}

/// What the page has not been sent yet.
#[derive(Default)]
pub(super) struct PendingUpdates {
    /// Something is to be drawn although nothing moved.
    pub(super) redraw: bool,
    pub(super) from_rest: bool,
    pub(super) twin_reset: bool,
    pub(super) recorded: bool,
    /// How many ends of the run and its twin have been sent.
    pub(super) ends_sent: usize,
}

impl Session {
    pub(super) fn new(setting: &Arc<Setting>, outbox: &Arc<Outbox>, working: &Sender<()>) -> Self {
        Self {
            setting: Arc::clone(setting),
            working: working.clone(),
            outbox: Arc::clone(outbox),
            view: View::default(),
            history: None,
            edited: None,
            mask: None,
            live: None,
            twin: None,
            recorded: None,
            shown_recording: None,
            painter: Painter::default(),
            clock: Clock::new(),
            single_steps: 0,
            repeating: None,
            search: None,
            search_time: SEARCH_TIME,
            pending: PendingUpdates::default(),
        }
    }

    /// How many of the run and its twin have ended.
    pub(super) fn count_ended(&self) -> usize {
        let runs = self.live.iter().chain(self.twin.as_ref().map(|twin| &twin.live));
        runs.filter(|run| run.ended.is_some()).count()
    }

    /// Number of blocks along x.
    pub(super) fn columns(&self) -> usize {
        self.live.as_ref().map_or(1, |live| live.case().model.lattice.nx)
    }

    /// The case as it is edited up to now.
    pub(super) fn document(&self) -> Result<&Document, String> {
        let edited = self.edited.as_ref().map(|edited| &edited.document);
        edited
            .or(self.history.as_ref().map(History::present))
            .ok_or_else(|| "no case is open yet".to_owned())
    }
}
