//! What a session has for its page: replies in their order, and of pictures the newest alone.

use std::collections::VecDeque;
use std::sync::{Mutex, MutexGuard, PoisonError};

use axum::body::Bytes;
use tokio::sync::Notify;

use crate::protocol::Reply;

/// Replies that may wait before the run does.
const MANY: usize = 64;

/// Filled by the session and the work it has begun, emptied by the connection.
#[derive(Default)]
pub(crate) struct Outbox {
    waiting: Mutex<Waiting>,
    filled: Notify,
}

#[derive(Default)]
struct Waiting {
    replies: VecDeque<String>,
    picture: Option<Bytes>,
    kymograph: Option<Bytes>,
}

/// What is sent next.
pub(crate) enum Outgoing {
    Reply(String),
    Picture(Bytes),
}

impl Outbox {
    fn waiting(&self) -> MutexGuard<'_, Waiting> {
        // Nothing panics while it is locked; what waits is whole in any case.
        self.waiting.lock().unwrap_or_else(PoisonError::into_inner)
    }

    pub(crate) fn reply(&self, reply: &Reply) {
        // Texts and finite or infinite numbers, which become null: nothing that JSON does not have.
        let text = serde_json::to_string(reply).expect("replies are JSON");
        self.waiting().replies.push_back(text);
        self.filled.notify_one();
    }

    /// A picture in place of one that has not been sent yet.
    pub(crate) fn picture(&self, picture: Bytes) {
        self.waiting().picture = Some(picture);
        self.filled.notify_one();
    }

    /// The same of the kymograph.
    pub(crate) fn kymograph(&self, kymograph: Bytes) {
        self.waiting().kymograph = Some(kymograph);
        self.filled.notify_one();
    }

    /// Whether the page is so far behind that it is given no more than answers.
    pub(crate) fn is_full(&self) -> bool {
        self.waiting().replies.len() >= MANY
    }

    /// All replies that wait; pictures are left out.
    pub(crate) fn take_replies(&self) -> Vec<String> {
        self.waiting().replies.drain(..).collect()
    }

    /// What comes next, as soon as there is something.
    pub(crate) async fn next(&self) -> Outgoing {
        loop {
            if let Some(outgoing) = self.take() {
                return outgoing;
            }
            self.filled.notified().await;
        }
    }

    fn take(&self) -> Option<Outgoing> {
        let mut waiting = self.waiting();
        let reply = waiting.replies.pop_front().map(Outgoing::Reply);
        reply
            .or_else(|| waiting.picture.take().map(Outgoing::Picture))
            .or_else(|| waiting.kymograph.take().map(Outgoing::Picture))
    }
}
