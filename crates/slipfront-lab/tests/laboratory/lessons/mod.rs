//! The lessons of the laboratory: what they say is what the engine computes, and every file of them fits the
//! others.
//!
//! `web/lessons.json` has their structure: a step opens its case from rest, shows what its `view` says, and
//! offers the buttons of its `set`. A button changes keys of the case, which then runs from rest, or what is
//! seen, or both. `web/lessons.en.json` has the words by the ids of the former; the `answer` of a step is
//! shown when the reader asks for it. `{id}` in a word is a number of `web/lesson_numbers.json`, and `*...*`
//! is emphasised; symbols have the sign U+2217 for their star. Cases are in `web/lessons/`.

mod content;
mod measured;
mod numbers;
mod said;
mod structure;
mod words;
