//! A session without server and page, which gets messages one by one: for fuzzing.

use std::path::PathBuf;
use std::rc::Rc;
use std::sync::Arc;
use std::sync::mpsc::{Receiver, channel};
use std::time::{Duration, Instant};

use slipfront_session::{Message, Session};

use crate::host::{PageHost, Setting};
use crate::outbox::Outbox;
use crate::presets;
use crate::saves::Saves;
use crate::start::Start;

/// Longest time that a session works on a message.
const MESSAGE_TIME: Duration = Duration::from_millis(20);

/// Longest time to wait for a run that is being saved and was stopped.
const WORK_TIMEOUT: Duration = Duration::from_secs(60);

/// A session that answers in the calling thread.
pub struct OfflineSession {
    session: Session,
    setting: Arc<Setting>,
    outbox: Arc<Outbox>,
    all_work: Receiver<()>,
    began: Instant,
}

impl OfflineSession {
    /// Begins a session that saves runs in this folder; no case is open.
    pub fn new(results: PathBuf) -> Self {
        let (working, all_work) = channel();
        let outbox = Arc::new(Outbox::default());
        let setting = Arc::new(Setting {
            start: Start::default(),
            results,
            allow_files: Vec::new(),
            saves: Arc::new(Saves::new(|_| {})),
            threads: 1,
            presets: presets::all(),
        });
        setting.saves.add_page(&outbox);
        let host = PageHost {
            setting: Arc::clone(&setting),
            outbox: Arc::clone(&outbox),
            working: Some(working),
        };
        Self {
            session: Session::new(Rc::new(host)),
            setting,
            outbox,
            all_work,
            began: Instant::now(),
        }
    }

    /// Handles a message of the page, and does what is due at once. Returns the replies, each as JSON.
    ///
    /// # Errors
    /// A sentence, if the message is not a request: a page would lose its connection.
    pub fn handle(&mut self, message: &str) -> Result<Vec<String>, String> {
        self.session.handle(Message::parse(message)?);
        let until = self.began.elapsed() + MESSAGE_TIME;
        loop {
            let now = self.began.elapsed();
            let due = self.session.advance(now);
            if now >= until || due.is_none_or(|due| due > now) {
                return Ok(self.outbox.take_replies());
            }
        }
    }

    /// Ends the session and all work that it has begun.
    pub fn end(self) {
        let Self {
            session,
            setting,
            all_work,
            ..
        } = self;
        setting.saves.end();
        drop(session);
        // Nothing is ever sent: the channel closes when the last working thread has ended.
        let _ = all_work.recv();
        setting.saves.wait(WORK_TIMEOUT);
    }
}

#[cfg(test)]
mod tests {
    use std::sync::mpsc::RecvTimeoutError;

    use super::*;

    #[test]
    fn the_end_of_a_session_ends_its_search() {
        let mut offline = OfflineSession::new("results".into());
        for message in [
            r#"{"do":"view","paused":true}"#,
            r#"{"do":"open","source":{"toml":"slider.blocks = [60, 60]"}}"#,
            r#"{"do":"find","gesture":1}"#,
        ] {
            let replies = offline.handle(message).unwrap();
            assert!(
                replies.iter().all(|reply| !reply.contains("refused")),
                "{replies:?}"
            );
        }
        let OfflineSession {
            session, all_work, ..
        } = offline;
        drop(session);
        // Nothing is sent: the channel closes when the last working thread has ended.
        let ended = all_work.recv_timeout(Duration::from_secs(60));
        assert_eq!(ended, Err(RecvTimeoutError::Disconnected));
    }

    #[test]
    fn what_threads_tell_comes_in_its_order_and_then_nothing() {
        let mut offline = OfflineSession::new("results".into());
        let open = r#"{"do":"open","source":{"toml":"slider.blocks = [3, 3]\ndrive.v_star = 0.1"}}"#;
        offline.handle(open).unwrap();
        let mut said = offline.handle(r#"{"do":"repeat","seeds":2}"#).unwrap();
        let began = Instant::now();
        while said.iter().filter(|reply| reply.contains("\"repeated\"")).count() < 2 {
            assert!(began.elapsed() < Duration::from_secs(30), "{said:?}");
            said.extend(offline.handle(r#"{"do":"view"}"#).unwrap());
        }
        let after = offline.handle(r#"{"do":"view"}"#).unwrap();
        assert!(
            after
                .iter()
                .all(|reply| !reply.contains("\"repeated\"") && !reply.contains("refused"))
        );
        offline.end();
    }
}
