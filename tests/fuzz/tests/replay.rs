//! Every target on its seeds, on what fuzzing has found before, and on a fixed number of mutations of both.

// A helper that cannot do its work fails its test.
#![allow(clippy::unwrap_used)]

use slipfront::testing::alone;
use slipfront_fuzz::{LONG_BYTES, Mutator, TARGETS, Target};

/// Runs a target on all of its inputs.
fn replay(name: &str) {
    let target = slipfront_fuzz::named(name).unwrap();
    let inputs = [target.findings(), target.seeds()].concat();
    assert!(!inputs.is_empty(), "{name} has no seeds");
    for (name, bytes) in &inputs {
        run(target, bytes, name);
    }
    let seeds: Vec<Vec<u8>> = inputs.into_iter().map(|(_, bytes)| bytes).collect();
    let mut mutator = Mutator::new(1, &target.words(), target.max_bytes);
    for number in 0..target.mutations {
        run(target, &mutator.mutated(&seeds), &format!("mutation {number}"));
    }
    // Time or memory that grows with the square of the length is noticed only in long inputs.
    for (name, bytes) in target.long_inputs() {
        run(target, &bytes, &name);
    }
    for number in 0..target.repetitions {
        run(
            target,
            &mutator.repeated(&seeds, LONG_BYTES),
            &format!("repetition {number}"),
        );
    }
}

fn run(target: &Target, bytes: &[u8], name: &str) {
    let failed = std::panic::catch_unwind(|| target.run(bytes)).is_err();
    assert!(
        !failed,
        "{} fails on {name}: {:?}",
        target.name,
        String::from_utf8_lossy(&bytes[..bytes.len().min(10_000)])
    );
}

macro_rules! replay {
    ($($name:ident)*) => {
        $(#[test]
        fn $name() {
            // Memory and time are measured for the whole process.
            alone(stringify!($name), || replay(stringify!($name)));
        })*

        #[test]
        fn every_target_is_replayed() {
            let names: Vec<&str> = TARGETS.iter().map(|target| target.name).collect();
            assert_eq!(names, [$(stringify!($name)),*]);
        }
    };
}

replay! {
    case_file
    case
    study_file
    calibration_file
    quantity
    npy
    csv_table
    mask_png
    height_map
    svg
    dxf
    measured
    workbook
    run_journal
    figure_cache
    checkpoint
    fields
    kymograph
    summary
    series
    precursors
    events
    manifest
    journal
    plot
    requests
}
