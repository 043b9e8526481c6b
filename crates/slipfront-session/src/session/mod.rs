//! A session: a case that is edited, and its run, which advances only while the page is visible.

mod advance;
mod brush;
mod calibrate;
mod clock;
mod distributed;
mod edit;
mod errands;
mod find;
mod painting;
mod repeat;
mod requests;
mod start;
mod state;
mod steps;
#[cfg(test)]
mod tests;
mod updates;

pub use state::Session;
