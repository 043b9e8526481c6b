//! A session without server and page, which is handed messages one by one: for fuzzing.

use std::path::PathBuf;
use std::sync::Arc;
use std::sync::mpsc::{Receiver, channel};

use super::state::{Session, Setting};
use crate::opening::Start;
use crate::outbox::Outbox;
use crate::presets;
use crate::protocol::Request;
use crate::saves::Saves;

/// A session that answers in the thread of whoever asks.
pub struct OfflineSession {
    session: Session,
    outbox: Arc<Outbox>,
    all_work: Receiver<()>,
}

impl OfflineSession {
    /// A session whose runs are saved in this folder; no case is open.
    pub fn new(results: PathBuf) -> Self {
        let (working, all_work) = channel();
        let outbox = Arc::new(Outbox::default());
        let setting = Arc::new(Setting {
            start: Start::default(),
            results,
            allow_files: Vec::new(),
            saves: Arc::new(Saves::new(|_| {})),
            threads: 1,
            presets: presets::entries(),
        });
        setting.saves.add_page(&outbox);
        Self {
            session: Session::new(&setting, &outbox, &working),
            outbox,
            all_work,
        }
    }

    /// Handles a message of the page, and runs until the next picture is due; gives the replies, each as JSON.
    ///
    /// # Errors
    /// A sentence, if it is no request: a page would lose its connection.
    pub fn handle(&mut self, message: &str) -> Result<Vec<String>, String> {
        let request: Request =
            serde_json::from_str(message).map_err(|error| format!("not a request: {error}"))?;
        self.session.handle(request);
        self.session.apply_edits();
        self.session.follow_search();
        self.session.run_until_next_picture();
        Ok(self.outbox.take_replies())
    }

    /// Ends the session and all that it has begun.
    pub fn end(self) {
        let Self {
            session, all_work, ..
        } = self;
        session.setting.saves.end();
        drop(session);
        // It never gets anything: it ends when the last thread that works has ended.
        let _ = all_work.recv();
    }
}
