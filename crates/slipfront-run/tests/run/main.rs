//! Tests of what one run computes and writes.

#![allow(clippy::unwrap_used)] // A helper that cannot do its work fails its test.

mod events;
mod expected_onset;
mod fields;
mod lateral_friction;
mod regression;
mod rigid;
mod slow_speeds;
