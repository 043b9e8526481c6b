//! The host of a session: the page behind a connection, and the threads and folders of this machine.

use std::path::PathBuf;
use std::sync::Arc;
use std::sync::mpsc::Sender;

use slipfront_session::{Document, Host, Job, OpenedCase, Presets, Task};

use crate::background::BackgroundTask;
use crate::outbox::Outbox;
use crate::saves::Saves;
use crate::start::Start;
use crate::{presets, replay};

/// Start, folders, threads, presets and running saves, shared by all sessions.
pub(crate) struct Setting {
    pub(crate) start: Start,
    /// The folder of results.
    pub(crate) results: PathBuf,
    /// Folders, besides the folder of the case, in which files that cases name may lie.
    pub(crate) allow_files: Vec<PathBuf>,
    pub(crate) saves: Arc<Saves>,
    pub(crate) threads: usize,
    pub(crate) presets: Presets,
}

/// The host of the session of one page.
pub(crate) struct PageHost {
    pub(crate) setting: Arc<Setting>,
    pub(crate) outbox: Arc<Outbox>,
    /// A sender that every job holds, for those who wait for the end of all jobs. A server does not, because
    /// jobs write no files.
    pub(crate) working: Option<Sender<()>>,
}

impl Host for PageHost {
    fn reply(&self, reply: String) {
        self.outbox.reply(reply);
    }

    fn picture(&self, picture: Vec<u8>) {
        self.outbox.picture(picture.into());
    }

    fn kymograph(&self, kymograph: Vec<u8>) {
        self.outbox.kymograph(kymograph.into());
    }

    fn is_full(&self) -> bool {
        self.outbox.is_full()
    }

    fn is_gone(&self) -> bool {
        self.outbox.is_closed()
    }

    fn threads(&self) -> usize {
        self.setting.threads
    }

    /// One worker, which uses all threads.
    fn workers(&self) -> usize {
        1
    }

    fn opening(&self) -> Result<OpenedCase, String> {
        match &self.setting.start {
            Start::Preset => presets::opening(&self.setting.presets).map(OpenedCase::from),
            Start::Case(document) => Ok(Document::clone(document).into()),
            Start::Folder(path) => replay::read(path, &self.setting.allow_files),
        }
    }

    fn preset(&self, name: &str) -> Result<Document, String> {
        self.setting.presets.document(name)
    }

    fn recorded_run(&self, name: &str) -> Result<OpenedCase, String> {
        let allowed = &self.setting.allow_files;
        replay::read(&replay::folder(&self.setting.results, name, allowed)?, allowed)
    }

    fn begin(&self, job: Job) -> Result<Box<dyn Task>, String> {
        let task = BackgroundTask::begin(job, self.setting.threads, self.working.clone())?;
        Ok(Box::new(task))
    }

    fn save(&self, document: Document, name: &str) -> Result<(), String> {
        let setting = &self.setting;
        setting
            .saves
            .begin(document, name, &setting.results, setting.threads)
    }

    fn stop_saving(&self, name: &str) {
        self.setting.saves.stop(name);
    }
}
