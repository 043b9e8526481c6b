//! Tests of the server from the view of a page and of an attacker, and of the lessons of the page.
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
