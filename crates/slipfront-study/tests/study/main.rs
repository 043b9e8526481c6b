//! Studies, designs and calibrations. What a study takes of memory is in `budget`.

#![allow(clippy::unwrap_used)] // A helper that cannot do its work fails its test.

#[path = "../../../slipfront-case/tests/support/reference_page.rs"]
mod reference_page;

mod calibrations;
mod designs;
mod study_files;
