//! The lessons of the laboratory: the engine computes the numbers in their texts, and their files are
//! consistent with each other.
//!
//! `web/lessons.json` has their structure: a step opens its case from rest, applies the view of its `view`,
//! and offers the buttons of its `set`. A button changes keys of the case, which then runs from rest, or the
//! view, or both. `web/lessons.en.json` has the texts, by the ids of the structure; the `answer` of a step is
//! shown on request of the reader. `{id}` in a text is a number of `web/lesson_numbers.json`, and `*...*` is
//! emphasised; symbols use the character U+2217 for their star. The cases are in `web/lessons/`.

mod content;
mod measured;
mod numbers;
mod said;
mod structure;
mod words;
