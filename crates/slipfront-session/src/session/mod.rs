//! A session: a case that is edited, and its run, which advances only while the page is visible.

mod advance;
mod brush;
mod calibrate;
mod calibration;
mod clock;
mod edit;
mod errands;
mod find;
mod painting;
mod repeat;
mod repetition;
mod requests;
mod start;
mod state;
mod steps;
#[cfg(test)]
mod tests;
mod updates;

pub use state::Session;
