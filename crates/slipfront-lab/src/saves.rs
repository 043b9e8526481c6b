//! Runs that are being saved. They belong to the server and not to a page: closing or reloading a page ends
//! none of them.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError, Weak};
use std::thread;
use std::time::Duration;

use slipfront_base::text::display_path;
use slipfront_session::{Document, refused, saved, saving};

use crate::outbox::Outbox;
use crate::{replay, save};

/// Largest number of runs that are saved at once.
const MAX_SAVES: usize = 4;

/// All runs that are being saved, and the pages that are notified of them.
pub(crate) struct Saves {
    list: Mutex<ActiveSaves>,
    /// Tells that a save has ended.
    ended: Condvar,
    /// Prints a sentence in the terminal.
    print: fn(&str),
}

#[derive(Default)]
struct ActiveSaves {
    under_way: Vec<ActiveSave>,
    pages: Vec<Weak<Outbox>>,
    /// Whether the server is ending.
    ends: bool,
}

struct ActiveSave {
    name: String,
    share: f64,
    stop: Arc<AtomicBool>,
}

impl ActiveSaves {
    fn find(&mut self, name: &str) -> Option<&mut ActiveSave> {
        self.under_way.iter_mut().find(|one| one.name == name)
    }

    fn pages(&mut self) -> Vec<Arc<Outbox>> {
        self.pages.retain(|page| page.strong_count() > 0);
        self.pages.iter().filter_map(Weak::upgrade).collect()
    }

    /// Sends the list of runs that are being saved to all pages.
    fn notify_pages(&mut self) {
        for page in self.pages() {
            page.reply(self.reply());
        }
    }

    fn reply(&self) -> String {
        saving(self.under_way.iter().map(|one| (&*one.name, one.share)))
    }
}

impl Saves {
    /// Starts with no run being saved.
    pub(crate) fn new(print: fn(&str)) -> Self {
        Self {
            list: Mutex::default(),
            ended: Condvar::new(),
            print,
        }
    }

    fn list(&self) -> MutexGuard<'_, ActiveSaves> {
        // Nothing panics while it is locked.
        self.list.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Notifies a page of all saves from now on, beginning with those under way.
    pub(crate) fn add_page(&self, page: &Arc<Outbox>) {
        let mut list = self.list();
        list.pages.push(Arc::downgrade(page));
        page.reply(list.reply());
    }

    /// Begins to save a run of a case into the folder of this name in the results, in a thread of its own.
    ///
    /// # Errors
    /// A sentence, if the name is taken or invalid, or too many runs are being saved.
    pub(crate) fn begin(
        self: &Arc<Self>,
        mut document: Document,
        name: &str,
        results: &Path,
        threads: usize,
    ) -> Result<(), String> {
        let out = save::folder(results, name)?;
        let mut list = self.list();
        if list.ends {
            return Err("the laboratory ends: nothing is saved any more".to_owned());
        }
        if list.find(name).is_some() {
            return Err(format!(
                "{} is being saved already: take another name",
                display_path(&out)
            ));
        }
        if list.under_way.len() == MAX_SAVES {
            return Err(format!(
                "{MAX_SAVES} runs are being saved already: wait until one of them is done, or stop it"
            ));
        }
        name.clone_into(&mut document.name);
        let stop = Arc::new(AtomicBool::new(false));
        list.under_way.push(ActiveSave {
            name: name.to_owned(),
            share: 0.0,
            stop: Arc::clone(&stop),
        });
        let saves = Arc::clone(self);
        let begun = thread::Builder::new().name("save".to_owned()).spawn(move || {
            let report_progress = |share| saves.advance(&document.name, share);
            let work = || save::save(&document, &out, threads, &stop, report_progress);
            let outcome = catch_unwind(AssertUnwindSafe(work))
                .unwrap_or_else(|_| Err("a defect of the simulation, which stands above".to_owned()));
            saves.finish(&document.name, &out, &outcome);
        });
        if let Err(error) = begun {
            list.under_way.retain(|one| one.name != name);
            return Err(format!("the system refuses a thread to save the run: {error}"));
        }
        list.notify_pages();
        Ok(())
    }

    /// Updates the completed fraction of a run, and sends it to all pages.
    fn advance(&self, name: &str, share: f64) {
        let mut list = self.list();
        if let Some(one) = list.find(name) {
            one.share = share;
        }
        list.notify_pages();
    }

    /// Reports to the terminal and all pages that a run is saved, or why it is not.
    fn finish(&self, name: &str, out: &Path, outcome: &Result<bool, String>) {
        let folder = display_path(out);
        let (share, ends) = {
            let mut list = self.list();
            (list.find(name).map_or(0.0, |one| one.share), list.ends)
        };
        let sentence = match outcome {
            Ok(true) => format!("the run is saved in {folder}"),
            Ok(false) => format!(
                "{folder} was not saved: {} after {:.0} % of the run, whose unfinished folder is removed",
                if ends {
                    "the laboratory ended"
                } else {
                    "it was stopped"
                },
                100.0 * share
            ),
            Err(error) => format!("{folder} was not saved: {error}"),
        };
        // Prints without holding the lock, because a terminal may block output.
        (self.print)(&sentence);
        let reply = match outcome {
            Ok(true) => {
                let folders = out.parent().map(replay::folders).unwrap_or_default();
                Some(saved(name, &folder, &folders))
            }
            Ok(false) => None,
            Err(_) => Some(refused("save", sentence)),
        };
        let mut list = self.list();
        list.under_way.retain(|one| one.name != name);
        self.ended.notify_all();
        for page in list.pages() {
            reply.iter().for_each(|reply| page.reply(reply.clone()));
        }
        list.notify_pages();
    }

    /// Stops saving a run, if it is under way.
    pub(crate) fn stop(&self, name: &str) {
        if let Some(one) = self.list().find(name) {
            one.stop.store(true, Ordering::Relaxed);
        }
    }

    /// Stops saving all runs, because the server ends.
    pub(crate) fn end(&self) {
        let mut list = self.list();
        list.ends = true;
        for one in &list.under_way {
            one.stop.store(true, Ordering::Relaxed);
        }
    }

    /// Waits until no run is being saved, for `most` at most.
    pub(crate) fn wait(&self, most: Duration) {
        let is_saving = |list: &mut ActiveSaves| !list.under_way.is_empty();
        drop(self.ended.wait_timeout_while(self.list(), most, is_saving));
    }

    /// Prints in the terminal which runs have not ended although they were stopped.
    pub(crate) fn print_unfinished(&self, results: &Path) {
        for one in &self.list().under_way {
            let folder = display_path(&results.join(&one.name));
            (self.print)(&format!(
                "{folder} is not whole: its run could not be ended in time; remove the folder"
            ));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::presets;

    /// A run that was stopped has removed its unfinished folder when the wait is over.
    #[test]
    fn the_end_waits_for_runs_that_are_being_saved() {
        let results = tempfile::tempdir().unwrap();
        let saves = Arc::new(Saves::new(|_| {}));
        let document = presets::all().document("single_block").unwrap();
        saves.begin(document, "one", results.path(), 1).unwrap();
        saves.end();
        saves.wait(Duration::from_secs(60));
        assert!(saves.list().under_way.is_empty());
    }
}
