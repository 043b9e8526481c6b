//! The lessons of the laboratory: what they say is what the engine computes, and every file of them fits the others.

mod content;
mod measured;
mod numbers;
mod said;
mod structure;
mod words;
