//! The server as a page sees it, and as somebody who means harm does; and the lessons of the page.
#![expect(clippy::unwrap_used, reason = "a test fails by a panic")]

mod attacks;
mod doors;
mod files;
mod find;
mod laboratory;
mod lessons;
mod page;
mod pages;
mod saves;
