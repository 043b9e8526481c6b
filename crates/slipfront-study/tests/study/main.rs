//! Studies, designs and calibrations. What a study takes of memory is in `budget`.

#![allow(clippy::unwrap_used)] // A helper that cannot do its work fails its test.

mod calibrations;
mod designs;
mod study_files;
