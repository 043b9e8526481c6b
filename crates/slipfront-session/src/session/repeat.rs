//! Static friction over several seeds: begun, followed, told.

use super::state::Session;
use crate::event::EventKind;
use crate::protocol::Reply;
use crate::work::Work;

/// Most seeds of a repetition.
const MAX_SEEDS: u64 = 32;

impl Session {
    /// Begins to compute static friction of the case over so many seeds; 0 ends a computation under way.
    pub(super) fn repeat(&mut self, seeds: u64) -> Result<(), String> {
        self.repeating = None;
        if seeds == 0 {
            return Ok(());
        }
        if !(2..=MAX_SEEDS).contains(&seeds) {
            return Err(format!(
                "{seeds} seeds were asked for, where there may be 2 to {MAX_SEEDS}"
            ));
        }
        self.apply_edits();
        let work = Work::repeat(self.document()?.clone(), seeds);
        self.repeating = Some(self.host.begin(work)?);
        Ok(())
    }

    /// Tells the page what was found over seeds since the last look.
    pub(super) fn follow_repetition(&mut self) {
        while let Some(event) = self.repeating.as_mut().and_then(|task| task.next_event()) {
            let sentence = match event.0 {
                EventKind::Repeated(repeated) => {
                    if repeated.finished {
                        self.repeating = None;
                    }
                    self.host.reply(Reply::Repeated(repeated).json());
                    continue;
                }
                EventKind::NotRepeated(sentence) => sentence,
                _ => "the runs over seeds failed by a defect of their own".to_owned(),
            };
            self.repeating = None;
            let of = "repeat";
            self.host.reply(Reply::Refused { of, sentence }.json());
        }
    }
}
