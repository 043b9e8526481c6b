//! Messages of a session that wait for its page: all replies in order, but only the newest picture.

use std::collections::VecDeque;
use std::sync::{Condvar, Mutex, MutexGuard, PoisonError};

use axum::body::Bytes;
use tokio::sync::Notify;

/// Number of waiting replies from which on the run waits.
const MAX_WAITING_REPLIES: usize = 64;

/// Bytes of waiting replies from which on the next request waits: replies to a page that does not read them
/// must not fill the memory.
const MAX_WAITING_BYTES: usize = 4 << 20;

/// Messages that wait for a page. The session and its jobs fill the outbox, and the connection empties it.
#[derive(Default)]
pub(crate) struct Outbox {
    waiting: Mutex<Queue>,
    filled: Notify,
    /// Signals that there is room again.
    taken: Condvar,
}

#[derive(Default)]
struct Queue {
    replies: VecDeque<String>,
    /// Whether the page is gone.
    closed: bool,
    picture: Option<Bytes>,
    kymograph: Option<Bytes>,
}

/// A message of the server.
pub(crate) enum Outgoing {
    Reply(String),
    Picture(Bytes),
}

impl Outbox {
    fn waiting(&self) -> MutexGuard<'_, Queue> {
        // Nothing panics while it is locked, and waiting messages are complete in any case.
        self.waiting.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Adds a reply, which is JSON, to the waiting ones.
    pub(crate) fn reply(&self, reply: String) {
        self.waiting().replies.push_back(reply);
        self.filled.notify_one();
    }

    /// Waits until there is room for the answer to another request, or the page is gone.
    pub(crate) fn wait_for_room(&self) {
        let is_full = |waiting: &mut Queue| {
            let bytes: usize = waiting.replies.iter().map(String::len).sum();
            bytes >= MAX_WAITING_BYTES && !waiting.closed
        };
        drop(self.taken.wait_while(self.waiting(), is_full));
    }

    /// Whether the page is gone.
    pub(crate) fn is_closed(&self) -> bool {
        self.waiting().closed
    }

    /// Marks the page as gone, so that nobody waits for it.
    pub(crate) fn close(&self) {
        self.waiting().closed = true;
        self.taken.notify_all();
    }

    /// Sets the next picture, and replaces one that has not been sent yet.
    pub(crate) fn picture(&self, picture: Bytes) {
        self.waiting().picture = Some(picture);
        self.filled.notify_one();
    }

    /// Sets the next kymograph, and replaces one that has not been sent yet.
    pub(crate) fn kymograph(&self, kymograph: Bytes) {
        self.waiting().kymograph = Some(kymograph);
        self.filled.notify_one();
    }

    /// Whether the page is so far behind that it gets only answers.
    pub(crate) fn is_full(&self) -> bool {
        self.waiting().replies.len() >= MAX_WAITING_REPLIES
    }

    /// Takes all waiting replies, but no pictures.
    pub(crate) fn take_replies(&self) -> Vec<String> {
        self.waiting().replies.drain(..).collect()
    }

    /// The next message, as soon as there is one.
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
        if let Some(reply) = waiting.replies.pop_front() {
            self.taken.notify_all();
            return Some(Outgoing::Reply(reply));
        }
        let picture = waiting.picture.take().or_else(|| waiting.kymograph.take());
        picture.map(Outgoing::Picture)
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;
    use std::sync::mpsc::channel;
    use std::thread;
    use std::time::Duration;

    use super::*;

    /// Far longer than a reply takes, so that it ends only a test that fails.
    const TIMEOUT: Duration = Duration::from_secs(30);

    #[test]
    fn answers_to_a_page_that_does_not_read_wait_until_it_reads_or_is_gone() {
        let outbox = Arc::new(Outbox::default());
        let (done, replied) = channel();
        let filled = Arc::clone(&outbox);
        let session = thread::spawn(move || {
            // Two of these are more than may wait.
            let sentence = "x".repeat(MAX_WAITING_BYTES / 2);
            for number in 0..6 {
                filled.wait_for_room();
                filled.reply(sentence.clone());
                done.send(number).unwrap();
            }
        });
        let next = || replied.recv_timeout(TIMEOUT).unwrap();
        assert_eq!([next(), next()], [0, 1]);
        // Waiting sends no signal; a session that did not wait would be done by now.
        thread::sleep(Duration::from_millis(50));
        assert!(replied.try_recv().is_err());
        assert!(outbox.take().is_some());
        assert_eq!(next(), 2);
        outbox.close();
        assert_eq!([next(), next(), next()], [3, 4, 5]);
        session.join().unwrap();
    }
}
