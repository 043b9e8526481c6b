//! What a session holds.

use std::path::PathBuf;
use std::sync::Arc;
use std::sync::mpsc::Sender;

use super::clock::Clock;
use crate::background::Stoppable;
use crate::document::Document;
use crate::history::History;
use crate::live::Live;
use crate::opening::Start;
use crate::outbox::Outbox;
use crate::picture::Painter;
use crate::protocol::PresetEntry;
use crate::replay::Recorded;
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

/// Whose untextured twin it is, as the text of its case.
pub(super) struct Twin {
    pub(super) live: Live,
    pub(super) toml: String,
}

/// An edited case that is not run yet.
pub(super) struct Edited {
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
    pub(super) edited: Option<Edited>,
    /// The texture while it is painted.
    pub(super) mask: Option<(Vec<bool>, u64)>,
    pub(super) live: Option<Live>,
    pub(super) twin: Option<Twin>,
    pub(super) recorded: Option<Recorded>,
    pub(super) shown_recording: Option<usize>,
    pub(super) painter: Painter,
    pub(super) clock: Clock,
    /// Steps that were asked for one by one.
    pub(super) single_steps: u64,
    pub(super) repeating: Option<Stoppable>,
    /// What is to be told with the next points.
    pub(super) news: News,
}

/// What the page has not been told yet.
#[derive(Default)]
pub(super) struct News {
    /// Something is to be drawn although nothing moved.
    pub(super) redraw: bool,
    pub(super) from_rest: bool,
    pub(super) twin_reset: bool,
    pub(super) recorded: bool,
    /// How many ends of the run and its twin were told.
    pub(super) ends_told: usize,
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
            news: News::default(),
        }
    }

    /// How many of the run and its twin have ended.
    pub(super) fn count_ended(&self) -> usize {
        let runs = self.live.iter().chain(self.twin.as_ref().map(|twin| &twin.live));
        runs.filter(|run| run.ended.is_some()).count()
    }

    /// The case as it is edited up to now.
    pub(super) fn document(&self) -> Result<&Document, String> {
        let edited = self.edited.as_ref().map(|edited| &edited.document);
        edited
            .or(self.history.as_ref().map(History::present))
            .ok_or_else(|| "no case is open yet".to_owned())
    }
}
