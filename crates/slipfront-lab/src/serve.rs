//! The loop of a session, in its own thread.

use std::iter::once;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::rc::Rc;
use std::sync::mpsc::{Receiver, RecvTimeoutError};
use std::time::{Duration, Instant};

use slipfront_session::{Host, Message, Session, failed};

use crate::outbox::Outbox;

/// Serves a page until it is gone. A panic of the simulation ends its run, not the session.
pub(crate) fn serve(host: &Rc<dyn Host>, outbox: &Outbox, messages: &Receiver<Message>) {
    loop {
        let converse = || converse(Session::new(Rc::clone(host)), outbox, messages);
        match catch_unwind(AssertUnwindSafe(converse)) {
            Ok(()) => return,
            Err(_) => outbox.reply(failed(
                "the simulation failed by a defect of its own, which the terminal tells; the case can be opened again"
                    .to_owned(),
            )),
        }
    }
}

fn converse(mut session: Session, outbox: &Outbox, messages: &Receiver<Message>) {
    let began = Instant::now();
    let mut due: Option<Duration> = None;
    loop {
        let first = match due {
            Some(due) => messages.recv_timeout(due.saturating_sub(began.elapsed())),
            None => messages.recv().map_err(|_| RecvTimeoutError::Disconnected),
        };
        match first {
            Ok(first) => {
                for message in once(first).chain(messages.try_iter()) {
                    if outbox.is_closed() {
                        return;
                    }
                    // A page that does not read its replies makes its next requests wait.
                    outbox.wait_for_room();
                    session.handle(message);
                }
            }
            Err(RecvTimeoutError::Timeout) => {}
            Err(RecvTimeoutError::Disconnected) => return,
        }
        due = session.advance(began.elapsed());
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;
    use std::sync::mpsc::sync_channel;

    use slipfront_session::{Document, Job, OpenedCase, Task};

    use super::*;
    use crate::host::{PageHost, Setting};
    use crate::outbox::Outgoing;
    use crate::presets;
    use crate::saves::Saves;
    use crate::start::Start;

    /// A host with a defect: it panics when asked for a certain preset.
    struct DefectiveHost(PageHost);

    impl Host for DefectiveHost {
        fn reply(&self, reply: String) {
            self.0.reply(reply);
        }

        fn picture(&self, picture: Vec<u8>) {
            self.0.picture(picture);
        }

        fn kymograph(&self, kymograph: Vec<u8>) {
            self.0.kymograph(kymograph);
        }

        fn is_full(&self) -> bool {
            self.0.is_full()
        }

        fn is_gone(&self) -> bool {
            self.0.is_gone()
        }

        fn threads(&self) -> usize {
            self.0.threads()
        }

        fn workers(&self) -> usize {
            self.0.workers()
        }

        fn opening(&self) -> Result<OpenedCase, String> {
            self.0.opening()
        }

        fn preset(&self, name: &str) -> Result<Document, String> {
            assert_ne!(name, "panic", "a defect that a test asks for");
            self.0.preset(name)
        }

        fn recorded_run(&self, name: &str) -> Result<OpenedCase, String> {
            self.0.recorded_run(name)
        }

        fn begin(&self, job: Job) -> Result<Box<dyn Task>, String> {
            self.0.begin(job)
        }

        fn save(&self, document: Document, name: &str) -> Result<(), String> {
            self.0.save(document, name)
        }

        fn stop_saving(&self, name: &str) {
            self.0.stop_saving(name);
        }
    }

    /// Waits for the next reply of this name.
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
        let (messages, waiting) = sync_channel(8);
        let session = {
            let outbox = Arc::clone(&outbox);
            std::thread::spawn(move || {
                let setting = Arc::new(Setting {
                    start: Start::default(),
                    results: "results".into(),
                    allow_files: Vec::new(),
                    saves: Arc::new(Saves::new(|_| {})),
                    threads: 1,
                    presets: presets::all(),
                });
                let host: Rc<dyn Host> = Rc::new(DefectiveHost(PageHost {
                    setting,
                    outbox: Arc::clone(&outbox),
                    working: None,
                }));
                serve(&host, &outbox, &waiting);
            })
        };
        let open = |preset: &str| {
            let text = format!("{{\"do\":\"open\",\"source\":{{\"preset\":\"{preset}\"}}}}");
            Message::parse(&text).unwrap()
        };
        messages.send(open("single_block")).unwrap();
        wait_for(&outbox, &runtime, "case");
        messages.send(open("panic")).unwrap();
        wait_for(&outbox, &runtime, "failed");
        messages.send(open("single_block")).unwrap();
        wait_for(&outbox, &runtime, "case");
        drop(messages);
        session.join().unwrap();
    }
}
