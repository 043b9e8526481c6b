//! The server as a page sees it, and as somebody who means harm does.
#![expect(clippy::unwrap_used, reason = "a test fails by a panic")]

mod attacks;
mod doors;
mod files;
mod find;
mod laboratory;
mod page;
mod pages;
mod saves;
