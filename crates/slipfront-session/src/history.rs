//! Successive versions of the edited case, for undo and redo.

use std::collections::HashSet;
use std::sync::Arc;

use crate::document::Document;
use crate::names::MAX_FILES;

/// Largest number of undo steps.
const MAX_STEPS: usize = 100;

/// Largest size of the keys and files of all cases together, bytes. It exceeds the limit for the files of one
/// case, so that a large case still has some undo steps.
const MAX_BYTES: usize = MAX_FILES as usize + (32 << 20);

/// The present case, those before it and those that were undone.
pub(crate) struct History {
    present: Document,
    before: Vec<Document>,
    undone: Vec<Document>,
    /// The gesture of the page that led from the previous case to the present one.
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

    /// Makes a changed case the present one; all changes of one gesture are undone together.
    pub(crate) fn change(&mut self, document: Document, gesture: u64) {
        let before = std::mem::replace(&mut self.present, document);
        if self.gesture != Some(gesture) {
            self.before.push(before);
        }
        self.gesture = Some(gesture);
        self.undone.clear();
        while self.before.len() > MAX_STEPS || (self.bytes() > MAX_BYTES && !self.before.is_empty()) {
            self.before.remove(0);
        }
    }

    /// Bytes of the keys and files of all cases; a file that several cases share counts once.
    fn bytes(&self) -> usize {
        let all = || self.before.iter().chain([&self.present]).chain(&self.undone);
        let mut counted = HashSet::new();
        let files = all().flat_map(|document| document.files().values());
        let files = files.filter(|file| counted.insert(Arc::as_ptr(file)));
        let in_files: usize = files.map(|file| file.len()).sum();
        in_files + all().map(Document::bytes_of_keys).sum::<usize>()
    }

    pub(crate) fn can_undo(&self) -> bool {
        !self.before.is_empty()
    }

    pub(crate) fn can_redo(&self) -> bool {
        !self.undone.is_empty()
    }

    /// Returns to the previous case, if there is one.
    pub(crate) fn undo(&mut self) -> bool {
        let Some(before) = self.before.pop() else {
            return false;
        };
        self.undone.push(std::mem::replace(&mut self.present, before));
        self.gesture = None;
        true
    }

    /// Returns to the case before the last undo, if there is one.
    pub(crate) fn redo(&mut self) -> bool {
        let Some(after) = self.undone.pop() else {
            return false;
        };
        self.before.push(std::mem::replace(&mut self.present, after));
        self.gesture = None;
        true
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Weak;

    use super::*;

    /// Number of these files that are still in memory.
    fn count_of_kept(versions: &[Weak<[u8]>]) -> usize {
        versions.iter().filter(|file| file.strong_count() > 0).count()
    }

    #[test]
    fn images_of_many_changes_are_bounded_together_and_files_that_no_case_names_are_dropped() {
        const IMAGE: usize = 3_900_000;
        let text = "slider.blocks = [2, 2]\nfriction.mu_static_field = 'mu.csv'\n";
        let first = Document::new("case", text, |_| Ok(b"1,1\n1,1\n".to_vec())).unwrap();
        let mut history = History::new(first);
        let mut images = Vec::new();
        for number in 0..60 {
            let image = history.present().with_image(&vec![number; IMAGE], 0.5).unwrap();
            images.extend(image.files().get("texture.png").map(Arc::downgrade));
            history.change(image, u64::from(number));
            assert!(history.bytes() <= MAX_BYTES);
            // Files that do not change are shared, not copied.
            let shared = &history.present().files()["mu.csv"];
            assert!(Arc::ptr_eq(shared, &history.before[0].files()["mu.csv"]));
        }
        assert_eq!(images.len(), 60);
        assert_eq!(count_of_kept(&images), MAX_BYTES / IMAGE);
        while history.undo() {}
        assert_eq!(history.undone.len(), MAX_BYTES / IMAGE - 1);
        while history.redo() {}
        assert_eq!(*history.present().files()["texture.png"], [59; IMAGE]);
        drop(history);
        assert_eq!(count_of_kept(&images), 0);
    }

    /// Cases without files have keys, which may be as long as a message.
    #[test]
    fn long_keys_are_bounded_as_well() {
        const WORDS: usize = 3000;
        const LETTERS: usize = 1000;
        let empty = Document::new("case", "", |_| Err(String::new())).unwrap();
        let document = |number: usize| {
            let words = toml::Value::from(vec![format!("{number:0LETTERS$}"); WORDS]);
            empty.with([("texture".to_owned(), Some(words))]).unwrap()
        };
        let mut history = History::new(document(0));
        for number in 1..=MAX_STEPS {
            history.change(document(number), number as u64);
            assert!(history.bytes() <= MAX_BYTES);
        }
        let each = WORDS * (size_of::<toml::Value>() + LETTERS);
        assert!(
            history.before.len() + 1 >= MAX_BYTES / each,
            "{}",
            history.before.len()
        );
        assert!(history.before.len() < MAX_STEPS);
    }
}
