//! A search for a texture that is better than the painted one: begun, followed, and made the texture of the case.

use std::time::Duration;

use super::clock::is_due;
use super::state::Session;
use crate::find::{Comparison, SearchBounds, TextureSearch};
use crate::protocol::{FoundOutcome, FoundReply, Reply};

/// Time between two reports of how far a search is.
const REPORT_INTERVAL: Duration = Duration::from_millis(250);

impl Session {
    /// Begins to search for a texture that is better than the painted one.
    pub(super) fn find(&mut self, gesture: u64) -> Result<(), String> {
        if self.search.is_some() {
            return Err(
                "a texture is being searched for already: wait until that is done, or stop it".to_owned(),
            );
        }
        self.apply_edits();
        let case = self
            .document()?
            .case_to_show()
            .map_err(|error| error.to_string())?;
        let bounds = SearchBounds {
            time: self.search_time,
            threads: self.setting.threads,
        };
        self.search = Some(TextureSearch::begin(&case, gesture, &bounds, &self.working)?);
        self.send_search();
        Ok(())
    }

    /// Ends the search, if there is one; its best so far counts.
    pub(super) fn stop_search(&self) {
        if let Some(search) = &self.search {
            search.stop();
        }
    }

    /// Gives up the search, if there is one, since its case is no longer the present one.
    pub(super) fn give_up_search(&mut self) {
        if self.search.take().is_some() {
            self.outbox
                .reply(&Reply::Found(FoundReply::without(FoundOutcome::GivenUp)));
        }
    }

    /// Tells how far the search is, or what came of it: a texture that is better takes the place of the painted one.
    pub(super) fn follow_search(&mut self) {
        let Some(search) = &self.search else { return };
        search.stop_in_time();
        let gesture = search.gesture;
        let Some(outcome) = search.outcome() else {
            if is_due(&mut self.clock.search, REPORT_INTERVAL) && !self.outbox.is_full() {
                self.send_search();
            }
            return;
        };
        self.search = None;
        let found = outcome.and_then(|comparison| {
            if comparison.is_better {
                self.adopt(&comparison, gesture)?;
            }
            Ok(FoundReply::of(&comparison))
        });
        let found = found.unwrap_or_else(|sentence| {
            self.outbox.reply(&Reply::Refused { of: "find", sentence });
            FoundReply::without(FoundOutcome::Failed)
        });
        self.outbox.reply(&Reply::Found(found));
    }

    /// Makes what was found the texture of the case, and runs it.
    fn adopt(&mut self, comparison: &Comparison, gesture: u64) -> Result<(), String> {
        let columns = self.columns();
        let document = self.document()?.with_mask(&comparison.texture, columns);
        self.run_edited(document.map_err(|error| error.to_string())?, gesture)
    }

    fn send_search(&self) {
        if let Some(search) = &self.search {
            self.outbox
                .reply(&Reply::Finding(search.progress(self.columns())));
        }
    }
}

impl FoundReply {
    /// A search that has compared nothing.
    fn without(outcome: FoundOutcome) -> Self {
        Self {
            outcome,
            textures: 0,
            surfaces: 0,
            best: None,
            painted: None,
        }
    }

    /// What came of a search.
    fn of(comparison: &Comparison) -> Self {
        Self {
            outcome: if comparison.is_better {
                FoundOutcome::Replaced
            } else {
                FoundOutcome::Kept
            },
            textures: comparison.textures,
            surfaces: comparison.surfaces,
            best: comparison.best,
            painted: comparison.painted,
        }
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;
    use std::sync::mpsc::{Receiver, channel};
    use std::time::Instant;

    use serde_json::{Value, json};

    use super::super::state::Setting;
    use super::*;
    use crate::files::temporary;
    use crate::opening::Start;
    use crate::outbox::Outbox;
    use crate::saves::Saves;

    /// Longer than a search of these small sliders takes, so that it ends only a test that fails.
    const TIMEOUT: Duration = Duration::from_secs(60);

    const PLAIN: &str = "slider.blocks = [20, 20]\ndrive.v_star = 0.1\n";

    /// A session of a test, and what it has said.
    struct Tried {
        session: Session,
        outbox: Arc<Outbox>,
        all_work: Receiver<()>,
    }

    impl Tried {
        fn new() -> Self {
            let (working, all_work) = channel();
            let outbox = Arc::new(Outbox::default());
            let setting = Arc::new(Setting {
                start: Start::default(),
                results: "results".into(),
                allow_files: Vec::new(),
                saves: Arc::new(Saves::new(|_| {})),
                threads: 1,
                presets: Vec::new(),
            });
            Self {
                session: Session::new(&setting, &outbox, &working),
                outbox,
                all_work,
            }
        }

        fn with(case: &str) -> Self {
            let mut tried = Self::new();
            tried.ask(json!({ "do": "open", "source": { "toml": case } }));
            tried
        }

        /// The replies to a request.
        fn ask(&mut self, request: Value) -> Vec<Value> {
            self.session.handle(serde_json::from_value(request).unwrap());
            self.session.apply_edits();
            self.replies()
        }

        fn replies(&self) -> Vec<Value> {
            let replies = self.outbox.take_replies();
            replies
                .iter()
                .map(|text| serde_json::from_str(text).unwrap())
                .collect()
        }

        /// Begins a search, and gives the sentence if it is refused.
        fn find(&mut self) -> Option<String> {
            let replies = self.ask(json!({ "do": "find", "gesture": 1000 }));
            let refused = replies.iter().find(|reply| reply["is"] == "refused");
            refused.map(|reply| reply["sentence"].as_str().unwrap().to_owned())
        }

        /// Follows the search up to the first reply of this name for which this holds; all replies until then.
        fn follow(&mut self, is: &str, holds: impl Fn(&Value) -> bool) -> Vec<Value> {
            let began = Instant::now();
            let mut all = Vec::new();
            while began.elapsed() < TIMEOUT {
                self.session.follow_search();
                all.extend(self.replies());
                if all.last().is_some_and(|reply| reply["is"] == is && holds(reply)) {
                    return all;
                }
                std::thread::sleep(Duration::from_millis(5));
            }
            panic!("no {is} came after {all:?}");
        }

        /// What came of the search.
        fn found(&mut self) -> Value {
            self.follow("found", |_| true).pop().unwrap()
        }

        fn textured(&self) -> Vec<bool> {
            let live = self.session.live.as_ref().unwrap();
            live.case().model.surface.textured.clone()
        }
    }

    fn number(value: &Value) -> f64 {
        value.as_f64().unwrap_or_else(|| panic!("{value} is no number"))
    }

    #[test]
    fn the_best_of_a_stopped_search_replaces_the_painted_texture_and_undo_brings_it_back() {
        let mut tried = Tried::with(PLAIN);
        // A single row: no texture that a search would try.
        tried.ask(json!({
            "do": "paint", "points": [[0.5, 0.5], [4.5, 0.5]], "radius": 0.3, "textured": true, "gesture": 1,
        }));
        let painted = tried.textured();
        assert_eq!(painted.iter().filter(|block| **block).count(), 5);
        assert_eq!(tried.find(), None);
        let said = tried.find().unwrap();
        assert!(said.contains("is being searched for already"), "{said}");
        let seen = tried.follow("finding", |reply| !reply["best_percent"].is_null());
        let seen = seen.last().unwrap();
        assert!(
            number(&seen["textures"]) > 0.0 && number(&seen["best_percent"]) < 0.0,
            "{seen}"
        );
        assert!(!seen["best_texture"].as_array().unwrap().is_empty());
        assert_eq!(tried.textured(), painted);
        tried.ask(json!({ "do": "find_stop" }));
        let replies = tried.follow("found", |_| true);
        let [case, found] = replies.last_chunk().unwrap();
        assert_eq!(found["outcome"], "replaced", "{found}");
        assert!(
            number(&found["best"]["mean"]) < number(&found["painted"]["mean"]),
            "{found}"
        );
        assert!(
            number(&found["best"]["half_width"]) > 0.0 && found["surfaces"] == 8,
            "{found}"
        );
        assert_eq!((&case["is"], &case["why"]), (&json!("case"), &json!("change")));
        // 3 % are the most where less is painted.
        let percent = number(&case["texture_percent"]);
        assert!(percent > 1.25 && percent <= 3.0, "{percent}");
        assert_ne!(tried.textured(), painted);
        tried.ask(json!({ "do": "undo" }));
        assert_eq!(tried.textured(), painted);
        tried.ask(json!({ "do": "redo" }));
        assert_ne!(tried.textured(), painted);
    }

    #[test]
    fn a_search_ends_when_its_time_is_over() {
        let mut tried = Tried::with(PLAIN);
        tried.session.search_time = Duration::from_millis(800);
        let began = Instant::now();
        assert_eq!(tried.find(), None);
        let found = tried.found();
        assert!(began.elapsed() >= tried.session.search_time);
        // Nothing was painted.
        assert!(
            found["outcome"] == "replaced" && found["painted"].is_null(),
            "{found}"
        );
        assert!(number(&found["best"]["mean"]) < -1.0, "{found}");
    }

    /// There is room for one square in three places, of which a first search finds the best.
    #[test]
    fn a_texture_that_nothing_is_better_than_stays() {
        let mut tried = Tried::with("slider.blocks = [9, 3]\ndrive.v_star = 0.1\n");
        tried.ask(json!({
            "do": "paint", "points": [[1.5, 1.5]], "radius": 1.6, "textured": true, "gesture": 1,
        }));
        assert_eq!(tried.textured().iter().filter(|block| **block).count(), 9);
        assert_eq!(tried.find(), None);
        tried.found();
        let best = tried.textured();
        assert_eq!(tried.find(), None);
        let replies = tried.follow("found", |_| true);
        assert!(replies.iter().all(|reply| reply["is"] != "case"), "{replies:?}");
        let found = replies.last().unwrap();
        assert_eq!(found["outcome"], "kept", "{found}");
        assert_eq!(found["best"], found["painted"]);
        assert_eq!(tried.textured(), best);
    }

    #[test]
    fn a_change_by_hand_gives_a_search_up() {
        for change in [
            json!({ "do": "set", "keys": { "friction.r_star": 0.4 }, "gesture": 2 }),
            json!({ "do": "paint", "points": [[5, 5]], "radius": 2, "textured": true, "gesture": 3 }),
            json!({ "do": "undo" }),
            json!({ "do": "open", "source": { "toml": PLAIN } }),
        ] {
            let mut tried = Tried::with(PLAIN);
            tried.ask(json!({ "do": "set", "keys": { "friction.r_star": 0.3 }, "gesture": 1 }));
            assert_eq!(tried.find(), None);
            // What changes nothing leaves it alone.
            for other in [
                json!({ "do": "rest" }),
                json!({ "do": "redo" }),
                json!({ "do": "view", "pace": 3 }),
            ] {
                tried.ask(other);
            }
            tried.ask(json!({ "do": "set", "keys": { "friction.r_star": -1 }, "gesture": 1 }));
            assert!(tried.session.search.is_some());
            let replies = tried.ask(change.clone());
            assert!(tried.session.search.is_none(), "{change}");
            let found = replies.iter().find(|reply| reply["is"] == "found").unwrap();
            assert_eq!(found["outcome"], "given_up");
        }
    }

    #[test]
    fn what_cannot_be_searched_for_is_refused_with_the_reason() {
        let said = Tried::new().find().unwrap();
        assert_eq!(said, "no case is open yet");
        for (case, reason) in [
            (
                "slider.blocks = [1, 2]",
                "the slider has 1 x 2 blocks, where the narrowest feature",
            ),
            (
                "slider.blocks = [700, 700]\ndrive.v_star = 0.001",
                "the slider is too large for a search of a minute: to try a texture takes",
            ),
        ] {
            let said = Tried::with(case).find().unwrap();
            assert!(said.starts_with(reason), "{said}");
        }
        // Known once it is looked for.
        let mut narrow = Tried::with("slider.blocks = [7, 3]\ndrive.v_star = 0.1");
        assert_eq!(narrow.find(), None);
        let replies = narrow.follow("found", |found| found["outcome"] == "failed");
        let refused = replies.iter().find(|reply| reply["is"] == "refused").unwrap();
        let said = refused["sentence"].as_str().unwrap();
        assert!(
            said.starts_with("no texture whose features and gaps are 3 blocks wide covers as little"),
            "{said}"
        );
    }

    #[test]
    fn a_file_that_cannot_be_read_any_more_is_told() {
        let mut tried = Tried::new();
        tried.ask(json!({ "do": "open", "source": {
            "toml": "slider.blocks = [4, 4]\nfriction.mu_static_field = 'mu.csv'",
            "files": { "mu.csv": crate::base64::encode(&b"1,1,1,1\n".repeat(4)) },
        } }));
        let file = tried.session.document().unwrap().files()["mu.csv"].path();
        std::fs::remove_file(temporary().join(file)).unwrap();
        let said = tried.find().unwrap();
        assert!(said.contains("mu.csv"), "{said}");
    }

    #[test]
    fn the_end_of_a_session_ends_its_search() {
        let mut tried = Tried::with("slider.blocks = [60, 60]\n");
        assert_eq!(tried.find(), None);
        let Tried {
            session, all_work, ..
        } = tried;
        drop(session);
        // It gets nothing, and ends when the last thread that works has ended.
        let ended = all_work.recv_timeout(Duration::from_secs(5));
        assert_eq!(ended, Err(std::sync::mpsc::RecvTimeoutError::Disconnected));
    }
}
