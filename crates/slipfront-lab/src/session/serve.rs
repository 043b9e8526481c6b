//! The loop of a session: requests, steps, pictures.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Arc;
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender};
use std::time::{Duration, Instant};

use slipfront_case::text::display_path;
use slipfront_run::program::VERSION;

use super::state::{Session, Setting};
use crate::controls;
use crate::document::MAX_BLOCKS;
use crate::outbox::Outbox;
use crate::protocol::{Reply, Request};
use crate::replay;

/// Time between two looks after a search while nothing moves.
const SEARCH_INTERVAL: Duration = Duration::from_millis(100);

/// Serves a page until it is gone. A defect of the simulation ends its run, not the session.
pub(crate) fn serve(
    setting: &Arc<Setting>,
    outbox: &Arc<Outbox>,
    requests: &Receiver<Request>,
    working: &Sender<()>,
) {
    Session::send_hello(setting, outbox);
    setting.saves.add_page(outbox);
    loop {
        let mut session = Session::new(setting, outbox, working);
        match catch_unwind(AssertUnwindSafe(|| session.serve(requests))) {
            Ok(()) => return,
            Err(_) => outbox.reply(&Reply::Failed {
                sentence: "the simulation failed by a defect of its own, which the terminal tells; the case can be opened again"
                    .to_owned(),
            }),
        }
    }
}

impl Session {
    /// Sends what a page can choose from: presets, recorded runs, quantities.
    fn send_hello(setting: &Setting, outbox: &Outbox) {
        outbox.reply(&Reply::Hello {
            version: VERSION,
            presets: &setting.presets,
            folders: replay::folders(&setting.results),
            results: display_path(&setting.results),
            max_blocks: MAX_BLOCKS,
            controls: &controls::CONTROLS,
        });
    }

    fn serve(&mut self, requests: &Receiver<Request>) {
        loop {
            let is_idle = self.is_idle();
            let first = if is_idle {
                self.next_while_idle(requests)
            } else {
                requests.recv_timeout(self.time_to_wait())
            };
            match first {
                Ok(request) => self.handle_when_room(request),
                Err(RecvTimeoutError::Timeout) if is_idle => {
                    self.follow_search();
                    continue;
                }
                Err(RecvTimeoutError::Timeout) => {}
                Err(RecvTimeoutError::Disconnected) => return,
            }
            while let Ok(request) = requests.try_recv() {
                self.handle_when_room(request);
            }
            self.apply_edits();
            self.follow_search();
            self.run_until_next_picture();
        }
    }

    /// Waits for the next request while nothing moves: until there is one, or until it is time to look after a search.
    fn next_while_idle(&self, requests: &Receiver<Request>) -> Result<Request, RecvTimeoutError> {
        if self.search.is_some() {
            requests.recv_timeout(SEARCH_INTERVAL)
        } else {
            requests.recv().map_err(|_| RecvTimeoutError::Disconnected)
        }
    }

    /// Handles a request once there is room for its replies: a page that reads none leaves none.
    fn handle_when_room(&mut self, request: Request) {
        self.outbox.wait_for_room();
        self.handle(request);
    }

    /// Whether there is nothing to do before the page asks for something.
    fn is_idle(&self) -> bool {
        if !self.view.visible {
            return true;
        }
        let runs = usize::from(self.live.is_some()) + usize::from(self.twin.is_some());
        let moves = self.count_ended() < runs && (!self.view.paused || self.single_steps > 0);
        !(moves || self.pending.redraw || self.pending.ends_sent != self.count_ended())
    }

    fn time_to_wait(&self) -> Duration {
        let next = self.clock.picture + Duration::from_secs_f64(1.0 / self.view.frames_per_second);
        if self.pending.redraw || self.clock.due >= 1.0 {
            Duration::ZERO
        } else {
            next.saturating_duration_since(Instant::now())
        }
    }
}

#[cfg(test)]
mod tests {
    use std::sync::mpsc::sync_channel;

    use super::*;
    use crate::opening::Start;
    use crate::outbox::Outgoing;
    use crate::protocol::Source;
    use crate::saves::Saves;

    /// The next reply of this name.
    fn wait_for(outbox: &Outbox, runtime: &tokio::runtime::Runtime, name: &str) {
        let is = format!("{{\"is\":\"{name}\"");
        runtime.block_on(async {
            let found = async {
                loop {
                    if let Outgoing::Reply(text) = outbox.next().await
                        && text.starts_with(&is)
                    {
                        return;
                    }
                }
            };
            let most = Duration::from_secs(30);
            assert!(tokio::time::timeout(most, found).await.is_ok(), "no {name} came");
        });
    }

    #[test]
    fn a_defect_of_the_simulation_ends_the_run_and_not_the_session() {
        let runtime = tokio::runtime::Builder::new_current_thread()
            .enable_all()
            .build()
            .unwrap();
        let outbox = Arc::new(Outbox::default());
        let (requests, waiting) = sync_channel(8);
        let session = {
            let outbox = Arc::clone(&outbox);
            std::thread::spawn(move || {
                let setting = Arc::new(Setting {
                    start: Start::default(),
                    results: "results".into(),
                    allow_files: Vec::new(),
                    saves: Arc::new(Saves::new(|_| {})),
                    threads: 1,
                    presets: Vec::new(),
                });
                serve(&setting, &outbox, &waiting, &std::sync::mpsc::channel().0);
            })
        };
        let open = || Request::Open {
            source: Source {
                preset: Some("single_block".to_owned()),
                ..Source::default()
            },
        };
        requests.send(open()).unwrap();
        wait_for(&outbox, &runtime, "case");
        requests.send(Request::Panic).unwrap();
        wait_for(&outbox, &runtime, "failed");
        requests.send(open()).unwrap();
        wait_for(&outbox, &runtime, "case");
        drop(requests);
        session.join().unwrap();
    }
}
