//! The cases that were edited one after the other, to go back to.

use crate::document::Document;

/// Most steps back.
const MAX_STEPS: usize = 100;

/// The present case, those before it and those that were undone.
pub(crate) struct History {
    present: Document,
    before: Vec<Document>,
    undone: Vec<Document>,
    /// The gesture of the page that made the present case of the one before it.
    gesture: Option<u64>,
}

impl History {
    /// Begins with a case.
    pub(crate) fn new(document: Document) -> Self {
        Self {
            present: document,
            before: Vec::new(),
            undone: Vec::new(),
            gesture: None,
        }
    }

    /// The present case.
    pub(crate) fn present(&self) -> &Document {
        &self.present
    }

    /// A changed case; the changes of one gesture are undone at once.
    pub(crate) fn change(&mut self, document: Document, gesture: u64) {
        let before = std::mem::replace(&mut self.present, document);
        if self.gesture != Some(gesture) {
            if self.before.len() == MAX_STEPS {
                self.before.remove(0);
            }
            self.before.push(before);
        }
        self.gesture = Some(gesture);
        self.undone.clear();
    }

    pub(crate) fn can_undo(&self) -> bool {
        !self.before.is_empty()
    }

    pub(crate) fn can_redo(&self) -> bool {
        !self.undone.is_empty()
    }

    /// Goes back, if there is a case before.
    pub(crate) fn undo(&mut self) -> bool {
        let Some(before) = self.before.pop() else {
            return false;
        };
        self.undone.push(std::mem::replace(&mut self.present, before));
        self.gesture = None;
        true
    }

    /// Goes forward again, if there is a case.
    pub(crate) fn redo(&mut self) -> bool {
        let Some(after) = self.undone.pop() else {
            return false;
        };
        self.before.push(std::mem::replace(&mut self.present, after));
        self.gesture = None;
        true
    }
}
