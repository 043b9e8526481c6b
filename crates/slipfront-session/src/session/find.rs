//! A search for a texture that is better than the painted one: how it begins, continues and ends, and how its
//! result becomes the texture of the case.

use std::time::Duration;

use super::clock::is_due;
use super::state::Session;
use crate::event::{EventKind, Mask, SearchUpdate};
use crate::host::Task;
use crate::job::{Job, JobKind};
use crate::protocol::{FindingReply, FoundOutcome, FoundReply, Reply};
use crate::search::{self, NOTHING_TRIED, SEARCH_TIME};
use crate::sentence::sentence;

/// Time between two progress reports of a search.
const REPORT_INTERVAL: Duration = Duration::from_millis(250);

/// The outcome of a search: the best texture and its comparison with the painted one, or why there is none.
type Outcome = Result<(Mask, FoundReply), String>;

/// A search for a better texture, and then the comparison of its result with the painted texture.
pub(super) struct TextureSearch {
    /// The gesture with which the page asked for the search.
    gesture: u64,
    /// Time of the host when the session first checked the search.
    began: Option<Duration>,
    /// Time that the search has taken up to now.
    elapsed: Duration,
    /// Whether the page has asked to end the search.
    is_enough: bool,
    /// The job under way: the search, or the comparison after it.
    pub(super) task: Box<dyn Task>,
    progress: SearchUpdate,
    /// The texture that is being compared; none while textures are tried.
    compared: Option<Mask>,
}

impl Session {
    /// Begins to search for a texture that is better than the painted one.
    pub(super) fn find(&mut self, gesture: u64) -> Result<(), String> {
        if self.search.is_some() {
            return Err(
                "a texture is being searched for already: wait until that is done, or stop it".to_owned(),
            );
        }
        self.apply_edits();
        let document = self.document()?.clone();
        self.search = Some(TextureSearch {
            gesture,
            began: None,
            elapsed: Duration::ZERO,
            is_enough: false,
            task: self.host.begin(Job::new(document, JobKind::Search))?,
            progress: SearchUpdate::default(),
            compared: None,
        });
        self.send_search();
        Ok(())
    }

    /// Ends the search, if there is one, and keeps its best texture so far.
    pub(super) fn stop_search(&mut self) {
        if let Some(search) = &mut self.search {
            search.is_enough = true;
        }
    }

    /// Abandons the search, if there is one, because its case is no longer the present one.
    pub(super) fn give_up_search(&mut self) {
        if self.search.take().is_some() {
            let given_up = FoundReply::without(FoundOutcome::GivenUp);
            self.host.reply(Reply::Found(given_up).json());
        }
    }

    /// Reports the progress of the search, or its result: a better texture replaces the painted one.
    pub(super) fn follow_search(&mut self, now: Duration) {
        let Some(search) = &mut self.search else { return };
        let began = *search.began.get_or_insert(now);
        search.elapsed = now.saturating_sub(began);
        let gesture = search.gesture;
        let Some(outcome) = self.outcome_of_search() else {
            if is_due(&mut self.clock.search, REPORT_INTERVAL, now) && !self.host.is_full() {
                self.send_search();
            }
            return;
        };
        let textures = self.search.take().map_or(0, |search| search.progress.textures);
        let found = outcome.and_then(|(best, found)| {
            if found.outcome == FoundOutcome::Replaced {
                self.adopt(&best, gesture)?;
            }
            Ok(FoundReply { textures, ..found })
        });
        let found = found.unwrap_or_else(|sentence| {
            self.refuse("find", sentence);
            FoundReply::without(FoundOutcome::Failed)
        });
        self.host.reply(Reply::Found(found).json());
    }

    /// Returns the outcome of the search once it has ended. Begins the comparison of the best texture when no
    /// more textures are tried.
    fn outcome_of_search(&mut self) -> Option<Outcome> {
        let search = self.search.as_mut()?;
        let mut searched = None;
        while let Some(event) = search.task.next_event() {
            match event.0 {
                EventKind::Tried(progress) => search.note(progress),
                // This is the last event of the task, which may have ended.
                EventKind::Searched(found) => {
                    searched = Some(found);
                    break;
                }
                EventKind::Compared(compared) => {
                    let best = search.compared.take()?;
                    return Some(compared.map(|found| (best, found)));
                }
                _ => {
                    let sentence = "the search failed by a defect of its own, which the terminal tells";
                    return Some(Err(sentence.to_owned()));
                }
            }
        }
        if search.compared.is_some() {
            return None;
        }
        if searched.is_none() && (search.is_enough || search.elapsed >= SEARCH_TIME) {
            let best = search.progress.best_texture.clone();
            searched = Some(best.ok_or_else(|| NOTHING_TRIED.to_owned()));
        }
        self.compare(searched?).err().map(Err)
    }

    /// Ends the search, and begins to compare its best texture with the painted one.
    ///
    /// # Errors
    /// A sentence, if the search has found nothing, or the system refuses the job.
    fn compare(&mut self, searched: Result<Mask, String>) -> Result<(), String> {
        let best = searched?;
        let document = self.document()?.clone();
        let task = self
            .host
            .begin(Job::new(document, JobKind::Compare(best.clone())))?;
        if let Some(search) = &mut self.search {
            search.task = task;
            search.compared = Some(best);
        }
        self.send_search();
        Ok(())
    }

    /// Makes the best texture of the search the texture of the case, and runs the case.
    fn adopt(&mut self, texture: &[bool], gesture: u64) -> Result<(), String> {
        let columns = self.columns();
        let document = self.document()?.with_mask(texture, columns);
        self.run_edited(document.map_err(sentence)?, gesture)
    }

    fn send_search(&self) {
        if let Some(search) = &self.search {
            let finding = search.progress(self.columns());
            self.host.reply(Reply::Finding(finding).json());
        }
    }
}

impl TextureSearch {
    /// Records the progress of the search.
    fn note(&mut self, progress: SearchUpdate) {
        self.progress.textures = progress.textures;
        if progress.best_texture.is_some() {
            self.progress = progress;
        }
    }

    /// Progress of the search; `columns` is the number of blocks along x.
    fn progress(&self, columns: usize) -> FindingReply {
        let texture = self.progress.best_texture.as_deref();
        FindingReply {
            seconds: self.elapsed.min(SEARCH_TIME).as_secs_f64(),
            of_seconds: SEARCH_TIME.as_secs_f64(),
            textures: self.progress.textures,
            compares: self.compared.is_some(),
            best_percent: self.progress.best_percent,
            best_texture: texture.map_or(Vec::new(), |texture| search::strips(texture, columns)),
        }
    }
}

impl FoundReply {
    /// The result of a search that has compared no textures.
    fn without(outcome: FoundOutcome) -> Self {
        Self {
            outcome,
            textures: 0,
            surfaces: 0,
            best: None,
            painted: None,
        }
    }
}
